#pragma once

#include <cstdint>
#include <string>

#include "lights/light_set.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"
#include "shadow/exact/beam_shadows.hpp"

namespace luciole {

struct PairInput {
  OpenedDevice& device;
  const std::string& defines;  ///< of featuresFor(kForBeams)
  const Scene& scene;
  const BeamScene& beams;
  const LightSet& lights;
  const GBuffer& gbuffer;
  const LightLists& lists;
  bool soft;  ///< with Feature::kSoftExact
};

/// The counts of tracePairs().
struct TracedPairs {
  std::uint64_t pairs = 0, rays = 0;
  std::uint64_t soft = 0;  ///< the pairs with a light of a size
  /// Pairs with lights of a size that are decided without rays: fully lit, or fully dark.
  std::uint64_t soft_lit = 0, soft_dark = 0;
};

/// Decides the pairs that beamShadows() left unsure, by rays that sample the textures of holes: one ray to a
/// light's position, BeamScene::soft_samples rays to a light of a size. Sets PairShadows::lit or, with
/// `soft`, first_share and shares. The input is that of the call of beamShadows(). Runs on all cores. Throws
/// MachineError if the device fails or memory doesn't suffice.
TracedPairs tracePairs(const PairInput& in, PairShadows& shadows);

}  // namespace luciole
