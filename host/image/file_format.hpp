#pragma once

#include <array>
#include <string>
#include <vector>

#include "luciole/image.hpp"

namespace luciole {

/// How a file of some extension stores pictures.
struct FileFormat {
  std::string extension;  ///< in lower case, without the dot
  bool is_float;
  int max_channels;  ///< 3: R G B; 4: and A; more: any channels under any names
  int bits = 8;      ///< of an integer format's codes: 8 or 16
};

/// What `named` or else the path's extension says, in lower case and without the dot; may be empty.
std::string formatName(const std::string& path, const std::string& named = "");

/// A way to compress an EXR, by the name that OpenEXR gives it.
struct ExrCompression {
  const char* name;
  bool is_lossless;
};
inline constexpr std::array<ExrCompression, 10> kExrCompressions{{{"none", true},
                                                                  {"rle", true},
                                                                  {"zips", true},
                                                                  {"zip", true},
                                                                  {"piz", true},
                                                                  {"pxr24", false},
                                                                  {"b44", false},
                                                                  {"b44a", false},
                                                                  {"dwaa", false},
                                                                  {"dwab", false}}};
/// What EXRs are compressed by unless something else is asked for. Of the lossless ones zip and piz have the
/// least product of bytes and time, to write, flush to a disk and read again, over G-buffers and pictures of
/// 16 and 32 bits of three scenes; the files of zip are smaller.
inline constexpr const char* kExrCompression = "zip";

/// How PNGs may be compressed, without loss as all PNGs are. Over pictures of five scenes the files of fast
/// have 1.14 times the bytes that zlib's usual level makes, and those of small 0.94 times, for some 50 times
/// the time of fast.
inline constexpr std::array<const char*, 2> kPngCompressions{"fast", "small"};

/// The largest finite 16-bit float.
inline constexpr float kLargestHalf = 65504.0f;

/// The largest magnitude of a colour that a file of these options holds: infinity, for halves kLargestHalf,
/// and half of that for dwaa and dwab. Those make halves of colours whatever the channels' type is, and what
/// they lose may make a value larger.
float largestColor(const WriteOptions& options);

/// Whether an EXR's channel holds a colour or a coverage, which 16-bit floats show well enough: R, G, B, A
/// and Y, and R, G, B, A of layers but Cryptomattes. Others, as positions, depths and counts, are data and
/// need all their bits.
bool isColorChannel(const std::string& name);

/// The format of a file to write. `named` is an extension; where it is empty the path's own counts, and for
/// "-" PNG. A format that only OpenImageIO knows is taken for 8-bit R G B. Throws InputError for one that
/// OpenImageIO doesn't write.
FileFormat outputFormat(const std::string& path, const std::string& named = "");

/// The format of a picture with these options. Throws as outputFormat does, and InputError for an option that
/// the format has no place for.
FileFormat pictureFormat(const std::string& path, const WriteOptions& options);

/// Whether OpenImageIO writes files of this extension (lower case, no dot).
bool openImageIOWrites(const std::string& extension);

}  // namespace luciole
