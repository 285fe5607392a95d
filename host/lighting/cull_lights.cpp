#include "lighting/stages.hpp"

namespace luciole {

void cullLights(const StageInput& input, LightLists& lists) {
  // A light's own ambient light reaches surfaces that face away from it.
  const bool by_facing = !input.pass.features.has(Feature::kLightAmbient);
  cull(input.device,
       cullArguments(input.points, input.pass.lights, input.lighting.group_log2,
                     kByCone | (by_facing ? kByFacing : 0)),
       lists);
}

}  // namespace luciole
