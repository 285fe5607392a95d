#pragma once

#include <memory>
#include <string>
#include <vector>

#include "image/file_format.hpp"
#include "image/image.hpp"

namespace luciole {

/// A picture file that is written row by row, from the top down, and appears whole or not at all; "-" is
/// standard output.
class RowFile {
 public:
  virtual ~RowFile() = default;

  /// The next `rows` rows, channels interleaved, of the file's type of values. Throws MachineError.
  virtual void write(const void* values, int rows) = 0;

  /// After the last row: puts the file in place. Throws as writeImage does.
  virtual void close() = 0;
};

/// A PNG of 8-bit R G B, or R G B A, in sRGB. Not by OpenImageIO, which takes longer to load than a small
/// picture to make. Throws as writeImage does.
std::unique_ptr<RowFile> openPngFile(const std::string& path, int width, int height, int channels,
                                     const Metadata& metadata);

/// A file that OpenImageIO writes, of 32-bit float or 8-bit sRGB; of the options, those about an EXR's header
/// are heeded. Throws as writeImage does.
std::unique_ptr<RowFile> openPictureFile(const std::string& path, int width, int height,
                                         const std::vector<std::string>& channels, const FileFormat& format,
                                         const Metadata& metadata, const WriteOptions& options);

}  // namespace luciole
