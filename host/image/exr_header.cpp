#include "image/exr_header.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <map>

#include "luciole/error.hpp"

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

/// Bytes of a value, by its type. The OpenEXR library reads that many whatever length the file states, and
/// would take what follows for the next attribute.
const std::map<std::string, std::int64_t> kLengths{
    {"box2i", 16},      {"box2f", 16},   {"chromaticities", 32},
    {"compression", 1}, {"double", 8},   {"envmap", 1},
    {"float", 4},       {"int", 4},      {"keycode", 28},
    {"lineOrder", 1},   {"m33d", 72},    {"m33f", 36},
    {"m44d", 128},      {"m44f", 64},    {"rational", 8},
    {"tiledesc", 9},    {"timecode", 8}, {"v2d", 16},
    {"v2f", 8},         {"v2i", 8},      {"v3d", 24},
    {"v3f", 12},        {"v3i", 12}};

/// Length in bytes of the list of channels that starts here: each a name and 16 bytes, then an empty name. −1
/// where the file ends first.
std::int64_t channelListLength(Source& source) {
  const std::int64_t before = source.left();
  while (source.file && !source.text().empty()) source.file.seekg(16, std::ios::cur);
  return source.file ? before - source.left() : -1;
}

/// Whether texts, each preceded by its length, fill exactly `length` bytes.
bool isTextList(Source& source, std::int64_t length) {
  while (source.file && length >= 4) {
    const std::int64_t of_text = source.number<std::int32_t>();
    length -= 4;
    if (of_text < 0 || of_text > length) return false;
    source.file.seekg(of_text, std::ios::cur);
    length -= of_text;
  }
  return source.file && length == 0;
}

/// What is wrong with an attribute's value, which starts here and has `length` bytes; empty if nothing is.
std::string faultOf(Source& source, const std::string& attribute, const std::string& type,
                    std::int64_t length, std::int64_t largest_side) {
  if (length < 0 || length > source.left())
    return fmt::format("an attribute of {} bytes, and {} are left", length, source.left());
  const auto known = kLengths.find(type);
  if ((known != kLengths.end() && known->second != length) ||
      (type == "chlist" && channelListLength(source) != length) ||
      (type == "stringvector" && !isTextList(source, length)))
    return fmt::format("an attribute whose value doesn't fill its {} bytes", length);
  if (attribute == "dataWindow" && type == "box2i") {
    const auto window = source.number<std::array<std::int32_t, 4>>();
    for (int axis = 0; axis < 2; ++axis) {
      const std::int64_t side = std::int64_t(window[axis + 2]) - window[axis] + 1;
      if (side < 1 || side > largest_side)
        return fmt::format("{} pixels a side, expected 1 to {}", side, largest_side);
    }
  } else if (type == "tiledesc") {
    for (const std::uint32_t side : source.number<std::array<std::uint32_t, 2>>())
      if (side < 1 || side > largest_side)
        return fmt::format("tiles of {} pixels a side, expected 1 to {}", side, largest_side);
  } else if (type == "preview") {
    const auto [width, height] = source.number<std::array<std::uint32_t, 2>>();
    if (length < 8 || std::uint64_t(width) * height != std::uint64_t(length - 8) / 4)
      return fmt::format("a preview of {} x {} pixels in {} bytes", width, height, length);
  } else if (attribute == "chunkCount" && type == "int") {
    const auto chunks = source.number<std::int32_t>();  // each has 8 bytes in a table
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
    const std::string type = source.text();
    const std::int64_t length = source.number<std::int32_t>();
    if (!source.file) break;
    const std::streampos value = source.file.tellg();
    if (const std::string fault = faultOf(source, attribute, type, length, largest_side); !fault.empty())
      throw InputError(fmt::format("{}: {}, the header is damaged", name, fault));
    source.file.seekg(value + std::streamoff(length));
  }
  throw InputError(name + ": ends inside its header");
}

}  // namespace luciole
