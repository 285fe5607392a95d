#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "cl/device.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/settings.hpp"
#include "luciole/stats.hpp"
#include "scene/lights/light_field.hpp"
#include "tools/bench/speed_table.hpp"

namespace luciole {

/// What is lit, and where lights are put.
struct LitStage {
  Scene scene;
  GBuffer gbuffer;
  std::vector<glm::dvec3> seen;    ///< points that the camera sees
  std::vector<glm::ivec2> judged;  ///< pixels that are compared with the truth
};

/// The time of all lights one by one, by the most in some places that were measured.
struct ExactTime {
  double lights = 0, milliseconds = 0;
};
inline const NoValue kTooLong{"so many lights one by one would take too long"};

/// What the scene's first camera sees, and about so many judged pixels. Throws InputError if it sees nothing.
LitStage setStage(Scene scene, glm::ivec2 size, std::size_t judged_pixels);

/// Replaces the scene's lights by point lights without range, where the shape says.
void placeLights(LitStage& stage, FieldShape shape, std::uint64_t lights);

/// Milliseconds of all that lighting a G-buffer took or takes, the trees of lights and triangles included.
double lightingTime(const Stats& stats);
double lightingTime(OpenedDevice& device, const LitStage& stage, const RenderSettings& settings);

}  // namespace luciole
