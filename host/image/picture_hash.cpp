#include "image/picture_hash.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>

namespace luciole {

PictureHash::PictureHash(int width, int height, const std::vector<std::string>& channels) {
  const std::string head = fmt::format("{}x{} {}\n", width, height, fmt::join(channels, " "));
  sha256_init(&state_);
  sha256_update(&state_, head.size(), reinterpret_cast<const std::uint8_t*>(head.data()));
}

void PictureHash::add(const Image& rows) {
  static_assert(std::endian::native == std::endian::little, "floats are hashed as they lie in memory");
  sha256_update(&state_, rows.pixels.size() * sizeof(float),
                reinterpret_cast<const std::uint8_t*>(rows.pixels.data()));
}

std::string PictureHash::digits() {
  std::uint8_t bytes[SHA256_DIGEST_SIZE];
  sha256_digest(&state_, sizeof bytes, bytes);
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

std::string pictureHash(const Image& image) {
  PictureHash hash(image.width, image.height, image.channels);
  hash.add(image);
  return hash.digits();
}

}  // namespace luciole
