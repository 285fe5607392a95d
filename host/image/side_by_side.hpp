#pragma once

#include <string>
#include <vector>

#include "luciole/compare.hpp"
#include "luciole/image.hpp"

namespace luciole {

/// Draws A, B and the error map of their difference (see errorMap) in a row, as linear R G B. All three are
/// enlarged by the map's factor. Colours are as the pictures have them; a picture of Y alone is grey. Below A
/// and B stand their names, A's size, and B's largest difference and PSNR; a name that is too long loses its
/// middle. difference: of A and B. Throws InputError where a picture has neither R, G and B nor Y, or the row
/// would be wider than kLargestSide, and MachineError where it doesn't fit into memory.
Image sideBySide(const Image& a, const Image& b, const ImageDifference& difference, const std::string& name_a,
                 const std::string& name_b);

/// Draws pictures of one size in rows of `columns`, each with a line of text below it, as linear R G B: its
/// label, or where not all labels have room, its brief one. Small pictures are enlarged by a whole factor.
/// Throws as sideBySide does.
Image labelledSheet(const std::vector<Image>& pictures, const std::vector<std::string>& labels,
                    const std::vector<std::string>& brief, int columns);

}  // namespace luciole
