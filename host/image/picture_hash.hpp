#pragma once

#include <nettle/sha2.h>

#include <string>

#include "image/image.hpp"

namespace luciole {

/// The SHA-256 (FIPS 180-4) of a picture's floats, which says of two pictures whether they have the same
/// bits. What is hashed: the line "WIDTHxHEIGHT CHANNEL CHANNEL …" with a line feed, then the pixels in rows
/// from the top down, their channels in that order, each in the four bytes of a float, the lowest first.
class PictureHash {
 public:
  /// Of a picture of so many rows. width, channels: as those of the rows to come.
  PictureHash(int width, int height, const std::vector<std::string>& channels);

  /// The next rows.
  void add(const Image& rows);

  /// After the last row: 64 digits of base 16.
  std::string digits();

 private:
  sha256_ctx state_;
};

/// The hash of a whole picture.
std::string pictureHash(const Image& image);

}  // namespace luciole
