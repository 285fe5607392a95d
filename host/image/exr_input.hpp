#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "image/layers.hpp"
#include "luciole/array_memory.hpp"

namespace luciole {

/// Planes of pixels, uninitialized until they are read, so that rows that a damaged file claims but doesn't
/// hold take no memory.
using ChannelPlanes = RawArray<float>;

/// An EXR that is read channel by channel, by the OpenEXR library alone, without loading OpenImageIO.
class ExrInput {
 public:
  /// Reads the headers of all parts. Sizes are checked before anything is allocated. Throws InputError.
  explicit ExrInput(const std::string& path);
  ~ExrInput();
  ExrInput(const ExrInput&) = delete;
  ExrInput& operator=(const ExrInput&) = delete;

  /// A part of deep pixels has no channels here, nor are there channels of other than full resolution.
  const std::vector<PicturePart>& parts() const { return parts_; }

  /// The pixels of some of a part's channels as float, a plane after the other: `channels` are places in
  /// parts()[part].channels, each once. Throws InputError where the file is damaged or claims more than it
  /// can hold, and MachineError where the planes don't fit into memory. Not to be called by two threads.
  ChannelPlanes read(int part, const std::vector<int>& channels);

 private:
  struct File;
  std::string path_;
  std::uint64_t length_ = 0;  ///< bytes
  std::unique_ptr<File> file_;
  std::vector<PicturePart> parts_;
};

}  // namespace luciole
