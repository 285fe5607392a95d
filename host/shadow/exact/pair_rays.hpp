#pragma once

#include <cstdint>

#include "lights/light_set.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"
#include "shadow/exact/beam_shadows.hpp"

namespace luciole {

/// What tracePairs() did.
struct TracedPairs {
  std::uint64_t pairs = 0, rays = 0;
  std::uint64_t soft = 0;  ///< of the pairs, those with a light of a size
};

/// Decides the pairs that beamShadows() left unsure, by rays that look textures up: one to a light's place,
/// and BeamScene::soft_samples to a light of a size. It sets the bits of those that are lit, or with `soft`
/// PairShadows::first_share and shares. lights, lists, soft: those that beamShadows() had. Works on all
/// cores. Throws MachineError if the device fails or memory doesn't suffice.
TracedPairs tracePairs(OpenedDevice& device, const Scene& scene, const BeamScene& beams,
                       const LightSet& lights, const GBuffer& gbuffer, const LightLists& lists, bool soft,
                       PairShadows& shadows);

}  // namespace luciole
