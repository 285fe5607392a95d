#include "image/cryptomatte.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "base/dump_utf8.hpp"

namespace luciole {

std::vector<std::string> cryptomatteChannels(const std::string& type_name) {
  std::vector<std::string> channels;
  for (int level = 0; level < kCryptomatteRanks / 2; ++level)
    for (const char component : {'R', 'G', 'B', 'A'})
      channels.push_back(fmt::format("{}{:02}.{}", type_name, level, component));
  return channels;
}

std::uint32_t murmurHash(std::string_view text) {
  const auto byte = [&](std::size_t i) { return std::uint32_t(static_cast<unsigned char>(text[i])); };
  const auto scrambled = [](std::uint32_t word) { return std::rotl(word * 0xcc9e2d51u, 15) * 0x1b873593u; };
  std::uint32_t hash = 0;
  std::size_t at = 0;
  for (; at + 4 <= text.size(); at += 4) {
    const std::uint32_t word = byte(at) | byte(at + 1) << 8 | byte(at + 2) << 16 | byte(at + 3) << 24;
    hash = std::rotl(hash ^ scrambled(word), 13) * 5 + 0xe6546b64u;
  }
  std::uint32_t rest = 0;
  for (std::size_t i = text.size(); i > at; --i) rest = rest << 8 | byte(i - 1);
  hash ^= scrambled(rest);
  hash ^= std::uint32_t(text.size());
  hash = (hash ^ hash >> 16) * 0x85ebca6bu;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
  return hash ^ hash >> 16;
}

float cryptomatteId(std::string_view name) {
  const std::uint32_t hash = murmurHash(name), exponent = hash >> 23 & 255;
  return std::bit_cast<float>(exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash);
}

Metadata cryptomatteTexts(const std::string& type_name, const std::vector<std::string>& names) {
  nlohmann::json manifest = nlohmann::json::object();
  for (const std::string& name : names)
    manifest[name] = fmt::format("{:08x}", std::bit_cast<std::uint32_t>(cryptomatteId(name)));
  const std::string key = fmt::format("cryptomatte/{:.7}/", fmt::format("{:08x}", murmurHash(type_name)));
  return {{key + "name", type_name},
          {key + "hash", "MurmurHash3_32"},
          {key + "conversion", "uint32_to_float32"},
          {key + "manifest", dumpUtf8(std::move(manifest))}};
}

}  // namespace luciole
