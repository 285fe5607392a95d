#include "image/picture_hash.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace luciole {

static_assert(std::endian::native == std::endian::little, "hashes are of little-endian numbers");

PictureHash::PictureHash(int width, int height, const std::vector<std::string>& channels) {
  for (const char* name : {"R", "G", "B", "A"})
    if (const auto place = std::find(channels.begin(), channels.end(), name); place != channels.end())
      places_.push_back(std::size_t(place - channels.begin()));
  const std::uint32_t head[] = {std::uint32_t(width), std::uint32_t(height), std::uint32_t(places_.size())};
  hash_.add(head, sizeof head);
}

void PictureHash::add(const Image& rows) {
  const std::size_t channels = rows.channels.size();
  std::vector<float> row(std::size_t(rows.width) * places_.size());
  for (int y = 0; y < rows.height; ++y) {
    const float* pixel = rows.pixels.data() + std::size_t(y) * rows.width * channels;
    float* next = row.data();
    for (int x = 0; x < rows.width; ++x, pixel += channels)
      for (const std::size_t place : places_) *next++ = pixel[place];
    hash_.add(row.data(), row.size() * sizeof(float));
  }
}

std::string pictureHash(const Image& image) {
  PictureHash hash(image.width, image.height, image.channels);
  hash.add(image);
  return hash.hex();
}

}  // namespace luciole
