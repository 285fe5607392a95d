#include "scene/gltf/gltf_resources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "base/base64.hpp"
#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "scene/find_file.hpp"

namespace luciole {
namespace {

constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinChunk = 0x004e4942;

/// A number of four bytes, which must be there.
std::uint32_t wordAt(std::string_view bytes, std::size_t place) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word |= std::uint32_t{static_cast<unsigned char>(bytes[place + i])} << 8 * i;
  return word;
}

bool startsChunk(std::string_view bytes, std::size_t place, std::uint32_t kind) {
  return place + 8 <= bytes.size() && wordAt(bytes, place + 4) == kind;
}

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// A URI's text with each %41 as the byte that it stands for. What is no such escape stays, as browsers have
/// it.
std::string withoutEscapes(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hexDigit(uri[i + 1]) : -1;
    const int low = high >= 0 ? hexDigit(uri[i + 2]) : -1;
    text += low >= 0 ? static_cast<char>(high * 16 + low) : uri[i];
    if (low >= 0) i += 2;
  }
  return text;
}

bool isData(std::string_view uri) { return uri.size() >= 5 && equalIgnoringCase(uri.substr(0, 5), "data:"); }

std::string_view withoutBlanks(std::string_view text) {
  constexpr const char* kBlanks = " \t\r\n";
  const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

/// Whether what stands before a data URI's comma has the parameter base64. It should be the last one.
bool saysBase64(std::string_view header) {
  for (std::size_t at = header.find(';'); at != std::string_view::npos; at = header.find(';')) {
    header.remove_prefix(at + 1);
    if (equalIgnoringCase(withoutBlanks(header.substr(0, header.find(';'))), "base64")) return true;
  }
  return false;
}

/// What a data URI holds (RFC 2397), whatever its media type says. Throws InputError.
std::string dataOf(std::string_view uri, const std::string& place, const GltfModel& model) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) failGltf(model, place, "is a data URI without a comma");
  const std::string_view data = uri.substr(comma + 1);
  if (!saysBase64(uri.substr(0, comma))) return withoutEscapes(data);
  std::optional<std::string> bytes =
      data.find('%') == std::string_view::npos ? fromBase64(data) : fromBase64(withoutEscapes(data));
  if (!bytes) failGltf(model, place, "its data is not base64");
  return std::move(*bytes);
}

/// A name in UTF-8 as Latin-1; nothing where it has letters that are none of Latin-1's.
std::optional<std::string> latin1Of(std::string_view name) {
  std::string text;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto byte = static_cast<unsigned char>(name[i]);
    if (byte >= 0x80 && byte != 0xc2 && byte != 0xc3) return {};
    if (byte >= 0x80 && ++i == name.size()) return {};
    text += static_cast<char>(byte == 0xc3 ? name[i] | 0x40 : name[i]);
  }
  return text;
}

/// The file that a URI means: without escapes, or as it is written, or without what only the web has. Names
/// of a file in Latin-1 are UTF-8 here (parseGltf()), and on its disk Latin-1.
std::optional<std::string> findUri(const std::string& uri, const SearchFolders& where) {
  std::string_view path = withoutBlanks(uri);
  path = path.substr(0, path.find_first_of("?#"));
  constexpr std::string_view kFile = "file://";
  if (equalIgnoringCase(path.substr(0, kFile.size()), kFile)) path.remove_prefix(kFile.size());
  const std::string plain = withoutEscapes(path);
  for (const std::string& name : {withoutEscapes(uri), uri, plain, latin1Of(plain).value_or("")}) {
    if (name.empty() || name.find('\0') != std::string::npos) continue;
    if (std::optional<std::string> found = findFile(name, where)) return found;
  }
  return {};
}

bool isEmptyFile(const std::string& path) {
  std::error_code failed;
  return std::filesystem::file_size(path, failed) == 0;
}

std::span<const std::byte> asBytes(std::string_view text) { return std::as_bytes(std::span(text)); }

/// Keeps bytes for as long as the model lives.
std::span<const std::byte> keep(std::string bytes, GltfModel& model) {
  return asBytes(model.kept.emplace_back(std::move(bytes)));
}

void findBuffer(std::size_t index, std::string_view binary, const SearchFolders& where, GltfModel& model) {
  GltfBuffer& buffer = model.file.buffers[index];
  const std::string place = fmt::format("buffers[{}]", index);
  if (buffer.uri && buffer.uri->empty()) {
    warnRepaired(model, place, "uri is '', taken for none", "empty uri");
    buffer.uri.reset();
  }
  if (!buffer.uri) {
    // No other buffer may be the GLB's. Without data there may be a buffer that an extension gives a meaning.
    // Who reads from it is told.
    if (index == 0) buffer.bytes = asBytes(binary);
  } else if (isData(*buffer.uri)) {
    buffer.bytes = keep(dataOf(*buffer.uri, place + ".uri", model), model);
    buffer.uri->clear();
  } else {
    const std::optional<std::string> file = findUri(*buffer.uri, where);
    if (!file) failGltf(model, place, fmt::format("there is no file '{}'", forMessage(*buffer.uri)));
    buffer.bytes = keep(readFile(*file), model);
  }
}

/// Warns of buffers whose data is shorter or longer than they say, and of which that matters not. Throws
/// InputError where a view misses data.
void checkLengths(const GltfModel& model) {
  const std::vector<GltfBuffer>& buffers = model.file.buffers;
  const auto fits = [](const GltfView& view, std::size_t bytes) {
    return view.offset <= bytes && view.length <= bytes - view.offset;
  };
  std::vector<bool> misses(buffers.size(), false);
  for (std::size_t i = 0; i < model.file.views.size(); ++i) {
    const GltfView& view = model.file.views[i];
    if (view.buffer < 0 || std::size_t(view.buffer) >= buffers.size()) continue;
    const GltfBuffer& buffer = buffers[std::size_t(view.buffer)];
    if (!fits(view, buffer.bytes.size()))
      misses[std::size_t(view.buffer)] = true;
    else if (!fits(view, buffer.length))
      warnRepaired(
          model, fmt::format("bufferViews[{}]", i),
          fmt::format("{} bytes from {} on reach past its buffer's byteLength {}, but not past its data",
                      view.length, view.offset, buffer.length),
          "view past byteLength");
  }
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const GltfBuffer& buffer = buffers[i];
    const bool has_none = !buffer.uri && buffer.bytes.empty();
    if (has_none || buffer.bytes.size() >= buffer.length) continue;
    const std::string place = fmt::format("buffers[{}]", i),
                      what = fmt::format("byteLength is {}, but there are only {} bytes", buffer.length,
                                         buffer.bytes.size());
    if (misses[i]) failGltf(model, place, what);
    warnRepaired(model, place, what, "byteLength");
  }
}

/// place: the image's, for errors.
void findImage(const std::string& place, const SearchFolders& where, GltfModel& model, GltfImage& image) {
  if (image.uri.empty()) return;
  if (isData(image.uri)) {
    image.bytes = keep(dataOf(image.uri, place + ".uri", model), model);
    image.uri.clear();
    return;
  }
  const std::optional<std::string> file = findUri(image.uri, where);
  if (file && !isEmptyFile(*file)) image.file = *file;
}

}  // namespace

GltfParts splitGltf(std::string_view bytes, const GltfModel& model) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  if (!bytes.starts_with("glTF")) return {bytes, {}};
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format("{}: is no GLB file: {}", model.path, what));
  };
  if (bytes.size() < kHeader + kChunkHeader) fail("it is cut short");
  if (wordAt(bytes, 4) != 2) fail(fmt::format("version {}, expected 2", wordAt(bytes, 4)));
  if (wordAt(bytes, 8) != bytes.size())
    warnRepaired(model, "its header",
                 fmt::format("length is {}, the file's {}", wordAt(bytes, 8), bytes.size()), "GLB length");
  const bool knows_its_end = wordAt(bytes, 8) == bytes.size();
  GltfParts parts;
  bool has_json = false;
  std::size_t place = kHeader;
  while (place + kChunkHeader <= bytes.size()) {
    const std::size_t length = wordAt(bytes, place), begin = place + kChunkHeader;
    const std::uint32_t kind = wordAt(bytes, place + 4);
    const bool is_json = kind == kJsonChunk && !has_json, is_binary = kind == kBinChunk;
    if (is_json && length > bytes.size() - begin)
      fail(fmt::format("its JSON has {} bytes, but only {} follow", length, bytes.size() - begin));
    if (is_json && place != kHeader) warnRepaired(model, "its JSON chunk", "is not the first", "GLB order");
    // One that is cut short is refused where a buffer needs more.
    if (is_json) parts.json = bytes.substr(begin, length);
    if (is_binary && parts.binary.empty()) parts.binary = bytes.substr(begin, length);
    has_json = has_json || is_json;
    place = begin + length;
    if (length % 4 == 0 || place > bytes.size() || !(is_json || is_binary)) continue;
    warnRepaired(model, is_json ? "its JSON chunk" : "its BIN chunk",
                 fmt::format("{} bytes, expected a multiple of 4", length), "GLB padding");
    const std::size_t padded = (place + 3) / 4 * 4;
    if (!startsChunk(bytes, place, kBinChunk) &&
        (startsChunk(bytes, padded, kBinChunk) || padded == bytes.size()))
      place = padded;
  }
  if (!has_json) fail("it has no JSON chunk");
  if (knows_its_end && place != bytes.size())
    warnRepaired(model, "its chunks", fmt::format("end at byte {}, the file at {}", place, bytes.size()),
                 "GLB length");
  return parts;
}

void findResources(std::string_view binary, const std::vector<std::string>& search, GltfModel& model) {
  const SearchFolders where{std::filesystem::path(model.path).parent_path().string(), search};
  for (std::size_t i = 0; i < model.file.buffers.size(); ++i) findBuffer(i, binary, where, model);
  for (std::size_t i = 0; i < model.file.images.size(); ++i)
    findImage(fmt::format("images[{}]", i), where, model, model.file.images[i]);
  for (std::size_t i = 0; i < model.file.profiles.size(); ++i)
    findImage(profilePlace(i), where, model, model.file.profiles[i]);
  checkLengths(model);
}

}  // namespace luciole
