#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "scene/scene.hpp"

namespace luciole {

enum class FieldShape : std::uint8_t {
  kBox,     ///< uniform in the box from `low` to `high`
  kBall,    ///< uniform in the ball around `center`
  kSphere,  ///< uniform on its surface
};

/// Point lights spread at random. The same seed gives the same lights on every machine, to the bit, and a
/// smaller count gives the first lights of a larger one. Positions don't depend on the other members.
struct LightField {
  std::uint64_t count = 0;
  std::uint64_t seed = 0;
  FieldShape shape = FieldShape::kBox;
  glm::dvec3 low{0.0};  ///< world, metres
  glm::dvec3 high{1.0};
  glm::dvec3 center{0.0};
  double radius = 1.0;
  std::vector<glm::vec3> colors{glm::vec3(1.0f)};  ///< each light picks one; never empty
  glm::vec2 intensity{1.0f};                       ///< multiplies the colour; uniform from x to y
  glm::vec2 range{
      std::numeric_limits<float>::infinity()};  ///< metres, uniform from x to y; or infinite, both
  glm::vec3 attenuation{1.0f, 0.0f, 0.0f};
  bool shadow = false;
};

/// The most lights a scene may have.
inline constexpr std::uint64_t kMostLights = 100'000'000;

/// Appends the field's lights. Throws InputError when there would be more than kMostLights, MachineError when
/// they don't fit in memory.
void expandLightField(const LightField& field, std::vector<Light>& lights);

}  // namespace luciole
