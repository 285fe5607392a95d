#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace luciole {

/// How surfaces reflect light. No scene says which; a picture's settings do.
enum class Model : std::uint8_t { kPhong, kBlinnPhong, kToon, kCookTorrance };

inline constexpr Model kAllModels[] = {Model::kPhong, Model::kBlinnPhong, Model::kToon, Model::kCookTorrance};

/// By Model, as people type them.
inline constexpr std::array kModelNames{"phong", "blinn-phong", "toon", "cook-torrance"};

inline constexpr const char* modelName(Model model) { return kModelNames[std::size_t(model)]; }

}  // namespace luciole
