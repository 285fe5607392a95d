#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace luciole {

/// A place of the scene that gets one value after the other: "PATH=4,16,64".
struct Sweep {
  std::string place;
  std::vector<std::string> values;  ///< one or more
};

/// A picture of a sweep: what is set, as --set has it.
using SweepPicture = std::vector<std::string>;

/// Reads what --sweep says, once or twice. Values are divided by commas that are in no brackets or quotes.
/// Throws InputError.
std::vector<Sweep> readSweeps(const std::vector<std::string>& texts);

/// All pictures, row by row: the first sweep goes along a row, the second from row to row.
std::vector<SweepPicture> sweepPictures(const std::vector<Sweep>& sweeps);

/// What is set in few words: places without what is before their last dot.
std::string briefLabel(const SweepPicture& picture);

/// How many pictures a row of their sheet has: as many as the first of two sweeps; of one up to four, or else
/// as many as there are rows, about.
int sweepColumns(const std::vector<Sweep>& sweeps);

}  // namespace luciole
