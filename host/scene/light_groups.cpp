#include "scene/light_groups.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace luciole {
namespace {

/// OpenEXR's names of channels have 255 bytes at most, of which the layer's prefix and component take some.
constexpr std::size_t kLongestName = 200;

}  // namespace

std::string faultOfGroupName(std::string_view name) {
  if (name == kRestOfLight) return fmt::format("\"{}\" is the light that no light gives", name);
  const bool is_plain = std::none_of(name.begin(), name.end(), [](char c) {
    return static_cast<unsigned char>(c) < ' ' || c == '\x7f' ||
           std::string_view(".,=:").find(c) != std::string_view::npos;
  });
  if (is_plain && !name.empty() && name.size() <= kLongestName) return "";
  return fmt::format("expected a group's name of 1 to {} bytes, without . , = : and control characters",
                     kLongestName);
}

LightGroupNumbers lightGroupNumbers(const Scene& scene) {
  LightGroupNumbers numbers;
  for (std::uint32_t i = 0; i < scene.light_groups.size(); ++i) numbers.emplace(scene.light_groups[i], i);
  return numbers;
}

std::uint32_t lightGroupNumber(const std::string& name, LightGroupNumbers& numbers, Scene& scene) {
  const auto [found, is_new] = numbers.emplace(name, static_cast<std::uint32_t>(scene.light_groups.size()));
  if (is_new) scene.light_groups.push_back(name);
  return found->second;
}

}  // namespace luciole
