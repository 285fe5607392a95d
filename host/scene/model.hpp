#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "kernels/models.h"

namespace luciole {

/// The reflection models of kernels/models.h: kPhong … A picture's settings choose one, not the scene.
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

}  // namespace luciole
