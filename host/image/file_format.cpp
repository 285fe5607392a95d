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

FileFormat outputFormat(const std::string& path, const std::string& named) {
  if (path == "-" && named.empty()) return kFormats[0];
  std::string extension = lowerCase(named);
  if (named.empty()) {
    extension = lowerCase(std::filesystem::path(path).extension().string());
    if (!extension.empty()) extension.erase(0, 1);
  }
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
