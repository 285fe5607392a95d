#include "image/file_format.hpp"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>

#include "base/error.hpp"
#include "base/write_file.hpp"
#include "image/image.hpp"

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
                               extension.empty() ? " (or --format)" : ""));
}

void checkWritable(const std::string& path, const std::string& format) {
  outputFormat(path, format);
  checkPlace(path);
}

}  // namespace luciole
