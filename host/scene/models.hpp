#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "kernels/models.h"
#include "luciole/model.hpp"

namespace luciole {

#define MODEL_VALUE(name, typed, shown, meaning, diffuse, specular) Model::k##name,
inline constexpr Model kAllModels[] = {EACH_MODEL(MODEL_VALUE)};
#undef MODEL_VALUE

/// Whether luciole/model.hpp has the models of kernels/models.h, in its order.
constexpr bool hasRowsOfKernels() {
  for (std::size_t i = 0; i < std::size(kAllModels); ++i)
    if (kAllModels[i] != Model(i)) return false;
  return std::size(kAllModels) == kNumberOfModels;
}
static_assert(hasRowsOfKernels());

/// The models' names in options and scene files, by Model.
#define MODEL_NAME(name, typed, shown, meaning, diffuse, specular) typed,
inline constexpr std::array kModelNames{EACH_MODEL(MODEL_NAME)};
#undef MODEL_NAME

/// Upper bounds of a model's reflection of an unshadowed light of 1, for any directions, before rounding.
struct ModelBounds {
  double diffuse;   ///< a factor of the diffuse colour
  double specular;  ///< a channel of the highlight
};

/// Upper bound of Cook and Torrance's highlight. It is α²/facets² · N·L/smith(N·L) / smith(N·V) · F with
/// facets ≥ α², smith(x) ≥ 2x and smith(x) ≥ α (see kernels/shade/cook_torrance.clh), so at most 1/(2α³)
/// times the larger of F0 and F90.
inline double mostCookTorrance(double f0, double n) {
  const double alpha2 = std::max(1 / (0.5 * n + 1), 0x1p-40);
  return std::max(f0, std::min(50 * f0, 1.0)) / (2 * alpha2 * std::sqrt(alpha2));
}

/// Upper bound of Ward's highlight: 2^20/α² times the specular colour, see kernels/shade/ward.clh.
inline double mostWard(double f0, double n) { return f0 * 0x1p20 * std::min(0.5 * n + 1, 0x1p40); }

/// The bounds that a model's row in kernels/models.h states; none for a user's model. f0: a channel of the
/// specular colour, ≥ 0; n: the shininess, ≥ 0.
inline ModelBounds modelBounds(Model model, double f0, double n) {
  if (isUserModel(model))
    return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
#define MODEL_BOUNDS(name, typed, shown, meaning, diffuse, specular) ModelBounds{diffuse, specular},
  return std::array{EACH_MODEL(MODEL_BOUNDS)}[std::size_t(model)];
#undef MODEL_BOUNDS
}

}  // namespace luciole
