#include "image/picture_claims.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "base/output_file.hpp"
#include "base/picture_size.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

constexpr std::uint64_t kMaxValues = std::uint64_t(1) << 31;
// Deflate, the best compressor of these formats on a constant picture, reaches 1 : 1032; JPEG's progressive
// mode can do better on empty pictures. A header that claims more than this is damaged.
constexpr std::uint64_t kMaxCompression = 65536;

bool sidesOk(const glm::i64vec2& size) {
  return size.x >= 1 && size.x <= kLargestSide && size.y >= 1 && size.y <= kLargestSide;
}

}  // namespace

std::uint64_t checkPictureFile(const std::string& path, const std::string& name) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(name + ": no such file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(name + ": not a file, expected a picture");
  if (access(path.c_str(), R_OK) != 0)
    throw InputError(fmt::format("{}: can't read: {}", name, systemReason()));
  return std::filesystem::file_size(path, error);
}

void checkClaims(const PictureClaims& claims, const std::string& name) {
  const glm::i64vec2 size = claims.size, whole = claims.whole;
  if (!sidesOk(size))
    throw InputError(
        fmt::format("{}: {} x {} pixels, expected 1 to {} a side", name, size.x, size.y, kLargestSide));
  if (!sidesOk(whole))
    throw InputError(fmt::format("{}: part of a picture of {} x {} pixels, expected 1 to {} a side", name,
                                 whole.x, whole.y, kLargestSide));
  if (claims.channels < 1 || claims.channels > kMaxValues / (std::uint64_t(size.x) * size.y))
    throw InputError(fmt::format("{}: {} x {} pixels of {} channels, expected at most {} values", name,
                                 size.x, size.y, claims.channels, kMaxValues));
  if (claims.bytes / kMaxCompression > claims.file_length)
    throw InputError(fmt::format("{}: claims {} x {} pixels in {} bytes, the header is damaged", name, size.x,
                                 size.y, claims.file_length));
}

}  // namespace luciole
