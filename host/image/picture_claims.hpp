#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>

namespace luciole {

/// The sizes in a picture file's header, to be checked before anything is allocated.
struct PictureClaims {
  glm::i64vec2 size;          ///< of the pixels, to be read
  glm::i64vec2 whole;         ///< of the picture that they are part of
  std::uint64_t channels;     ///< that are read
  std::uint64_t bytes;        ///< of all pixels and channels, uncompressed
  std::uint64_t file_length;  ///< bytes
};

/// The length in bytes of a file that is to be read as a picture. Throws InputError where it isn't there, is
/// no regular file or can't be read. `name` is for messages.
std::uint64_t checkPictureFile(const std::string& path, const std::string& name);

/// Throws InputError where a picture is larger than kLargestSide a side, has more than 2³¹ values, or claims
/// more than a file of that length can hold. `name` is for messages.
void checkClaims(const PictureClaims& claims, const std::string& name);

}  // namespace luciole
