#pragma once

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>

#include "kernels/models.h"

namespace luciole {

/// The reflection models of kernels/models.h: kPhong … A picture's settings choose one, and a material may
/// choose its own.
#define MODEL_ENUMERATOR(name, typed, shown, meaning, diffuse, specular) k##name,
enum class Model : std::uint8_t { EACH_MODEL(MODEL_ENUMERATOR) };
#undef MODEL_ENUMERATOR

#define MODEL_VALUE(name, typed, shown, meaning, diffuse, specular) Model::k##name,
inline constexpr Model kAllModels[] = {EACH_MODEL(MODEL_VALUE)};
#undef MODEL_VALUE

/// The models' names in options, by Model.
#define MODEL_NAME(name, typed, shown, meaning, diffuse, specular) typed,
inline constexpr std::array kModelNames{EACH_MODEL(MODEL_NAME)};
#undef MODEL_NAME

inline constexpr const char* modelName(Model model) { return kModelNames[std::size_t(model)]; }

/// The most that a model makes of a light of 1 that nothing hides, whatever the directions, before rounding.
struct ModelBounds {
  double diffuse;   ///< a factor of the diffuse colour
  double specular;  ///< a channel of the highlight
};

/// The most of Cook and Torrance's highlight: α²/facets² · N·L/smith(N·L) / smith(N·V) · F with facets ≥ α²,
/// smith(x) ≥ 2x and smith(x) ≥ α (see kernels/cook_torrance.clh), so 1/(2α³) times the larger of F0 and F90.
inline double mostCookTorrance(double f0, double n) {
  const double alpha2 = std::max(1 / (0.5 * n + 1), 0x1p-40);
  return std::max(f0, std::min(50 * f0, 1.0)) / (2 * alpha2 * std::sqrt(alpha2));
}

/// The bounds that a model's row in kernels/models.h states. f0: a channel of the specular colour, ≥ 0; n:
/// the shininess, ≥ 0.
inline ModelBounds modelBounds(Model model, double f0, double n) {
#define MODEL_BOUNDS(name, typed, shown, meaning, diffuse, specular) ModelBounds{diffuse, specular},
  return std::array{EACH_MODEL(MODEL_BOUNDS)}[std::size_t(model)];
#undef MODEL_BOUNDS
}

/// A material's model as G-buffers have it: 0 where it chooses none.
inline constexpr std::uint32_t modelNumber(const std::optional<Model>& chosen) {
  return chosen ? std::uint32_t(*chosen) + 1 : 0;
}
/// The model behind such a number, in a picture of this model.
inline constexpr Model modelOfNumber(std::uint32_t number, Model of_picture) {
  return number > 0 ? Model(number - 1) : of_picture;
}

/// Which models surfaces choose: bit i is set if one has the modelNumber() i.
using ModelChoices = std::bitset<std::size(kAllModels) + 1>;

}  // namespace luciole
