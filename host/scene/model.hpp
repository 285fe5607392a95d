#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>

#include "kernels/models.h"

namespace luciole {

/// The reflection models of kernels/models.h: kPhong … A picture's settings choose one, and a material may
/// choose its own.
#define MODEL_ENUMERATOR(name, typed, shown, meaning) k##name,
enum class Model : std::uint8_t { EACH_MODEL(MODEL_ENUMERATOR) };
#undef MODEL_ENUMERATOR

#define MODEL_VALUE(name, typed, shown, meaning) Model::k##name,
inline constexpr Model kAllModels[] = {EACH_MODEL(MODEL_VALUE)};
#undef MODEL_VALUE

/// The models' names in options, by Model.
#define MODEL_NAME(name, typed, shown, meaning) typed,
inline constexpr std::array kModelNames{EACH_MODEL(MODEL_NAME)};
#undef MODEL_NAME

inline constexpr const char* modelName(Model model) { return kModelNames[std::size_t(model)]; }

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
