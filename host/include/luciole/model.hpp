#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace luciole {

/// The reflection models. A picture's settings choose one, and a material may choose its own.
enum class Model : std::uint8_t {
  kPhong,         ///< highlights of (R·V)ⁿ
  kBlinnPhong,    ///< highlights of (N·H)ⁿ
  kToon,          ///< light in flat steps
  kCookTorrance,  ///< rough surfaces, D G F / (4 N·L N·V)
  kOrenNayar,     ///< rough matte surfaces, with Phong's highlights
  kWard,          ///< rough surfaces by Ward's highlights
};
inline constexpr std::size_t kNumberOfModels = 6;

/// Models from files of the user's (Scene::user_models) have the numbers after those.
inline constexpr std::size_t kMostUserModels = 16;
inline constexpr Model userModel(std::size_t index) { return Model(kNumberOfModels + index); }
inline constexpr bool isUserModel(Model model) { return std::size_t(model) >= kNumberOfModels; }

/// Whether the model's highlights are those of facets, of a roughness by the shininess: see takeFacets().
constexpr bool takesFacets(Model model) { return model == Model::kCookTorrance || model == Model::kWard; }

/// The model's name in scene files: "phong" …; "a file's" for a user's.
const char* modelName(Model model);

/// The number of a material's model in G-buffers: 0 if it has none of its own.
inline constexpr std::uint32_t modelNumber(const std::optional<Model>& chosen) {
  return chosen ? std::uint32_t(*chosen) + 1 : 0;
}
inline constexpr std::uint32_t kMostModelNumber = std::uint32_t(kNumberOfModels + kMostUserModels);
/// The model behind such a number, in a picture of this model.
inline constexpr Model modelOfNumber(std::uint32_t number, Model of_picture) {
  return number > 0 ? Model(number - 1) : of_picture;
}

/// The models that surfaces have: bit i is set if one has the modelNumber() i.
using ModelChoices = std::bitset<kNumberOfModels + kMostUserModels + 1>;

}  // namespace luciole
