#pragma once

#include <cstdint>

#include "lights/light_set.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"
#include "shadow/exact/beam_shadows.hpp"

namespace luciole {

/// The counts of tracePairs().
struct TracedPairs {
  std::uint64_t pairs = 0, rays = 0;
  std::uint64_t soft = 0;  ///< the pairs with a light of a size
};

/// Decides the pairs that beamShadows() left unsure, by rays that sample the textures of holes: one ray to a
/// light's position, BeamScene::soft_samples rays to a light of a size. Sets PairShadows::lit or, with
/// `soft`, first_share and shares. lights, lists, soft: those of the call of beamShadows(). Runs on all
/// cores. Throws MachineError if the device fails or memory doesn't suffice.
TracedPairs tracePairs(OpenedDevice& device, const Scene& scene, const BeamScene& beams,
                       const LightSet& lights, const GBuffer& gbuffer, const LightLists& lists, bool soft,
                       PairShadows& shadows);

}  // namespace luciole
