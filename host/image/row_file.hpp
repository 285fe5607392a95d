#pragma once

#include <memory>
#include <string>
#include <vector>

#include "image/file_format.hpp"
#include "luciole/image.hpp"

namespace luciole {

/// A picture file that is written row by row, from the top down, and appears whole or not at all; "-" is
/// standard output.
class RowFile {
 public:
  virtual ~RowFile() = default;

  /// The next `rows` rows, channels interleaved, in the type of values that the file takes: 8- or 16-bit
  /// unsigned, or 32-bit float. Throws MachineError.
  virtual void write(const void* values, int rows) = 0;

  /// After the last row: puts the file in place. Throws as writeImage does.
  virtual void close() = 0;
};

/// A PNG of R G B (3 channels) or R G B A (4), in sRGB codes of 8 or 16 bits. Its rows are filtered and
/// compressed by all threads, which OpenImageIO and libpng don't do; its bytes don't depend on how many there
/// are. `compression` and `memory`: as in WriteOptions. Throws as writeImage does.
std::unique_ptr<RowFile> openPngFile(const std::string& path, int width, int height, int channels,
                                     const Metadata& metadata, int bits = 8,
                                     const std::string& compression = "", std::string* memory = nullptr);

/// A JPEG of R G B in memory, for pictures that are looked at for a moment: of quality 85. Throws
/// MachineError.
std::unique_ptr<RowFile> openJpegInMemory(int width, int height, std::string& memory);

/// An EXR of 32-bit float values, some of which it stores as halves where the options say so. The OpenEXR
/// library writes it. Throws as writeImage does.
std::unique_ptr<RowFile> openExrFile(const std::string& path, int width, int height,
                                     const std::vector<std::string>& channels, const Metadata& metadata,
                                     const WriteOptions& options);

/// A file of another format, which OpenImageIO writes, of 32-bit float values or of sRGB codes of
/// format.bits. Throws as writeImage does.
std::unique_ptr<RowFile> openPictureFile(const std::string& path, int width, int height,
                                         const std::vector<std::string>& channels, const FileFormat& format,
                                         const Metadata& metadata, const WriteOptions& options);

}  // namespace luciole
