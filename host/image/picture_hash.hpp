#pragma once

#include <string>
#include <vector>

#include "base/sha256.hpp"
#include "luciole/image.hpp"

namespace luciole {

/// The SHA-256 by which pictures of several machines are compared: of linear light as floats, before a file's
/// format, its tone curve or its rounding changes it. Layers don't count. Hashed are, all little-endian,
/// - width, height and number of channels, 3 or 4, as unsigned integers of 32 bits;
/// - R, G, B, and A where the picture has it, of each pixel as IEEE floats of 32 bits, row by row from the
///   top, each row from the left.
/// A zero's sign counts.
class PictureHash {
 public:
  /// channels: of the rows to come, R, G and B among them.
  PictureHash(int width, int height, const std::vector<std::string>& channels);

  /// The next rows, from the top down.
  void add(const Image& rows);

  /// After the last row.
  std::string hex() { return hash_.hex(); }

 private:
  Sha256 hash_;
  std::vector<std::size_t> places_;  ///< of R, G, B and A among a pixel's channels
};

/// The same of a whole picture.
std::string pictureHash(const Image& image);

}  // namespace luciole
