#include "image/exr_header.hpp"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <fstream>

#include "error.hpp"

// The layout: "OpenEXR File Layout", the OpenEXR project's technical documentation.
namespace luciole {
namespace {

constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kSeveralParts = 0x1000;  ///< a flag of the version field
constexpr std::size_t kLongestName = 255;

/// A file read from front to end. All numbers are little-endian, as the machines that this runs on.
struct Source {
  std::ifstream file;
  std::int64_t size;

  std::int64_t left() { return size - std::int64_t(file.tellg()); }
  template <class T>
  T number() {
    T value{};
    file.read(reinterpret_cast<char*>(&value), sizeof value);
    return value;
  }
  /// A text that ends with a zero byte.
  std::string text() {
    std::string read;
    for (char c; file.get(c) && c != 0 && read.size() <= kLongestName;) read += c;
    return read;
  }
};

/// What is wrong with an attribute's value, which starts here and has `length` bytes; empty if nothing is.
std::string faultOf(Source& source, const std::string& attribute, std::int64_t length,
                    std::int64_t largest_side) {
  if (length < 0 || length > source.left())
    return fmt::format("an attribute of {} bytes, and {} are left", length, source.left());
  if (attribute == "dataWindow" && length == 16) {
    const auto window = source.number<std::array<std::int32_t, 4>>();
    for (int axis = 0; axis < 2; ++axis) {
      const std::int64_t side = std::int64_t(window[axis + 2]) - window[axis] + 1;
      if (side < 1 || side > largest_side)
        return fmt::format("{} pixels a side, expected 1 to {}", side, largest_side);
    }
  } else if (attribute == "tiles" && length == 9) {
    for (const std::uint32_t side : source.number<std::array<std::uint32_t, 2>>())
      if (side < 1 || side > largest_side)
        return fmt::format("tiles of {} pixels a side, expected 1 to {}", side, largest_side);
  } else if (attribute == "preview" && length >= 8) {
    const auto [width, height] = source.number<std::array<std::uint32_t, 2>>();
    if (std::uint64_t(width) * height > std::uint64_t(length) / 4)
      return fmt::format("a preview of {} x {} pixels in {} bytes", width, height, length);
  } else if (attribute == "chunkCount" && length == 4) {
    const auto chunks = source.number<std::int32_t>();
    if (chunks < 0 || chunks > source.size / 8)
      return fmt::format("{} chunks in {} bytes", chunks, source.size);
  }
  return "";
}

}  // namespace

void checkExrHeader(const std::string& path, const std::string& name, std::int64_t largest_side) {
  Source source{std::ifstream(path, std::ios::binary | std::ios::ate), 0};
  source.size = source.file.tellg();
  source.file.seekg(0);
  if (source.number<std::uint32_t>() != kMagic || !source.file) return;
  const bool several = (source.number<std::uint32_t>() & kSeveralParts) != 0;
  bool header_is_empty = true;
  while (source.file) {
    const std::string attribute = source.text();
    if (attribute.empty()) {
      if (!several || header_is_empty) return;
      header_is_empty = true;
      continue;
    }
    header_is_empty = false;
    source.text();  // its type
    const std::int64_t length = source.number<std::int32_t>();
    if (!source.file) break;
    const std::streampos value = source.file.tellg();
    if (const std::string fault = faultOf(source, attribute, length, largest_side); !fault.empty())
      throw InputError(fmt::format("{}: {}, the header is damaged", name, fault));
    source.file.seekg(value + std::streamoff(length));
  }
  throw InputError(name + ": ends inside its header");
}

}  // namespace luciole
