#include "image/png_bytes.hpp"

#include <png.h>

#include "luciole/error.hpp"

namespace luciole {

std::string pngBytes(int width, int height, std::span<const std::uint8_t> codes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = png_uint_32(width);
  image.height = png_uint_32(height);
  image.format = PNG_FORMAT_RGB;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, codes.data(), 0, nullptr))
    throw MachineError(std::string("a PNG in memory: ") + image.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace luciole
