#include "cl/program_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <system_error>

#include "base/output_file.hpp"
#include "base/text_file.hpp"

namespace luciole {
namespace {

namespace files = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kExtension = ".program";

/// A file larger than this is none of ours.
constexpr std::uintmax_t kLargestFile = 256 << 20;

constexpr std::size_t kHashLength = 16;

files::path placeOf(const std::string& folder, const std::string& description) {
  return files::path(folder) / (hashOf(description) + kExtension);
}

/// A checksum, and then CBOR.
std::string packed(const std::string& description, const KeptProgram& program) {
  Json kernels = Json::object();
  for (const auto& [name, arguments] : program.arguments) {
    Json& list = kernels[name] = Json::array();
    for (const DeclaredArgument& one : arguments)
      list.push_back(Json::array({one.name, one.type, one.space, one.is_const}));
  }
  const Json all{
      {"description", description}, {"kernels", kernels}, {"binary", Json::binary(program.binary)}};
  std::string bytes;
  Json::to_cbor(all, bytes);
  return hashOf(bytes) + bytes;
}

std::optional<KeptProgram> unpacked(std::string_view file, const std::string& description) {
  if (file.size() < kHashLength) return std::nullopt;
  const std::string_view bytes = file.substr(kHashLength);
  if (file.substr(0, kHashLength) != hashOf(bytes)) return std::nullopt;
  const Json all = Json::from_cbor(bytes.begin(), bytes.end(), true, false);
  if (!all.is_object() || all.value("description", "") != description) return std::nullopt;
  KeptProgram program;
  program.binary = all.at("binary").get_binary();
  for (const auto& [name, list] : all.at("kernels").items())
    for (std::vector<DeclaredArgument>& arguments = program.arguments[name]; const Json& one : list)
      arguments.push_back({one.at(0).get<std::string>(), one.at(1).get<std::string>(),
                           one.at(2).get<cl_kernel_arg_address_qualifier>(), one.at(3).get<bool>()});
  return program;
}

/// Removes programs, those used longest ago first, until all take at most `most_bytes`.
void removeOldest(const std::string& folder, std::uintmax_t most_bytes) {
  struct Kept {
    files::file_time_type used;
    std::uintmax_t bytes;
    files::path path;
  };
  std::vector<Kept> all;
  std::uintmax_t total = 0;
  std::error_code gone;  // another process may be at it, too
  for (const files::directory_entry& entry : files::directory_iterator(folder)) {
    if (entry.path().extension() != kExtension) continue;
    const files::file_time_type used = entry.last_write_time(gone);
    if (gone) continue;
    const std::uintmax_t bytes = entry.file_size(gone);
    if (gone) continue;
    total += bytes;
    all.push_back({used, bytes, entry.path()});
  }
  std::sort(all.begin(), all.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
  for (const Kept& one : all) {
    if (total <= most_bytes) return;
    files::remove(one.path, gone);
    total -= one.bytes;
  }
}

}  // namespace

std::string hashOf(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return fmt::format("{:016x}", hash);
}

std::string userCache(const char* kind) {
  const char* const cache = std::getenv("XDG_CACHE_HOME");
  // A relative path there doesn't count (XDG Base Directory Specification 0.8).
  if (cache && files::path(cache).is_absolute()) return files::path(cache) / "luciole" / kind;
  const char* const home = std::getenv("HOME");
  if (home && *home) return files::path(home) / ".cache" / "luciole" / kind;
  return "";
}

std::string userProgramCache() { return userCache("programs"); }

std::optional<KeptProgram> findProgram(const std::string& folder, const std::string& description) {
  const files::path place = placeOf(folder, description);
  try {
    if (!isFile(place) || files::file_size(place) > kLargestFile) return std::nullopt;
    std::optional<KeptProgram> program = unpacked(readFile(place), description);
    std::error_code read_only;
    if (program) files::last_write_time(place, files::file_time_type::clock::now(), read_only);
    return program;
  } catch (const std::exception&) {  // it can't be read, or another version's wrote it
    return std::nullopt;
  }
}

void keepProgram(const std::string& folder, const std::string& description, const KeptProgram& program,
                 std::uintmax_t most_bytes) {
  try {
    files::create_directories(folder);
    const std::string bytes = packed(description, program);
    const std::string place = placeOf(folder, description);
    checkSizeLimit(bytes.size(), place);
    OutputFile file(place);
    file.writeAt(0, std::as_bytes(std::span(bytes)));
    file.putInPlace();
    removeOldest(folder, most_bytes);
  } catch (const std::exception&) {  // then the next run compiles again
  }
}

}  // namespace luciole
