#include "image/file_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <limits>

#include "base/write_file.hpp"
#include "image/cryptomatte.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

constexpr int kAnyChannels = 1024;
const FileFormat kFormats[] = {
    {"png", false, 4},
    {"tga", false, 4},
    {"jpg", false, 3},
    {"jpeg", false, 3},
    {"bmp", false, 3},
    {"ppm", false, 3},
    {"hdr", true, 3},
    {"pfm", true, 3},
    {"npy", true, 4},
    {"exr", true, kAnyChannels},
    {"tif", true, kAnyChannels},
    {"tiff", true, kAnyChannels},
};

std::string lowerCase(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

std::string formatName(const std::string& path, const std::string& named) {
  if (!named.empty()) return lowerCase(named);
  const std::string extension = lowerCase(std::filesystem::path(path).extension().string());
  return extension.empty() ? "" : extension.substr(1);
}

FileFormat outputFormat(const std::string& path, const std::string& named) {
  if (path == "-" && named.empty()) return kFormats[0];
  const std::string extension = formatName(path, named);
  for (const FileFormat& format : kFormats) {
    if (extension == format.extension) return format;
  }
  if (openImageIOWrites(extension)) return {extension, false, 3};
  std::string known;
  for (const FileFormat& format : kFormats) known += fmt::format(" {}", format.extension);
  throw InputError(fmt::format("{}: unknown {} '{}', expected one of{} or another that OpenImageIO writes{}",
                               path, named.empty() ? "extension" : "format", extension, known,
                               extension.empty() ? " (or options.format)" : ""));
}

FileFormat pictureFormat(const std::string& path, const WriteOptions& options) {
  FileFormat format = outputFormat(path, options.format);
  const auto refuse = [&](const std::string& what, const std::string& expected) {
    throw InputError(fmt::format("{}: .{} has no {}, expected {}", path, format.extension, what, expected));
  };
  const bool is_exr = format.extension == "exr";
  const bool is_tiff = format.extension == "tif" || format.extension == "tiff";
  if (options.half && !is_exr) refuse("16-bit floats (options.half)", ".exr");
  if (!options.compression.empty()) {
    const bool is_of_png = std::any_of(kPngCompressions.begin(), kPngCompressions.end(),
                                       [&](const char* name) { return options.compression == name; });
    if (format.extension != (is_of_png ? "png" : "exr"))
      refuse(fmt::format("such compression (options.compression {})", options.compression),
             is_of_png ? ".png" : ".exr");
  }
  if (options.alpha && format.max_channels < 4)
    refuse("coverage (options.alpha)", ".exr, .png, .tif, .tga or .npy");
  if (options.bits == 0) return format;
  const bool has_codes = options.bits == 8    ? !format.is_float || is_tiff
                         : options.bits == 16 ? format.extension == "png" || is_tiff
                                              : false;
  if (!has_codes) refuse(fmt::format("{}-bit codes (options.bits)", options.bits), ".png or .tif");
  format.is_float = false;
  format.bits = options.bits;
  format.max_channels = std::min(format.max_channels, 4);
  return format;
}

float largestColor(const WriteOptions& options) {
  if (options.compression == "dwaa" || options.compression == "dwab") return kLargestHalf / 2;
  return options.half ? kLargestHalf : std::numeric_limits<float>::infinity();
}

bool isColorChannel(const std::string& name) {
  if (name == "Y") return true;
  if (name.starts_with(kCryptoObject) || name.starts_with(kCryptoMaterial)) return false;
  const std::size_t dot = name.rfind('.');
  const std::string component = dot == std::string::npos ? name : name.substr(dot + 1);
  return component == "R" || component == "G" || component == "B" || component == "A";
}

void checkWritable(const std::string& path, const WriteOptions& options) {
  pictureFormat(path, options);
  checkPlace(path);
}

}  // namespace luciole
