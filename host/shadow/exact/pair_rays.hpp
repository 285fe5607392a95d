#pragma once

#include <cstdint>
#include <string>

#include "lights/light_set.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"
#include "shadow/exact/beam_shadows.hpp"

namespace luciole {

/// What tracePairs() reads: a G-buffer whose pairs beamShadows() has decided, on the device and on the host.
struct PairInput {
  OpenedDevice& device;
  const std::string& defines;      ///< those of the call of beamShadows()
  const BeamArguments& arguments;  ///< likewise
  const Scene& scene;
  const LightSet& lights;
  const GBuffer& gbuffer;
};

/// The counts of tracePairs().
struct TracedPairs {
  std::uint64_t pairs = 0, rays = 0;
  std::uint64_t soft = 0;  ///< the pairs with a light of a size
  /// Pairs with lights of a size that are decided without rays: fully lit, or fully dark.
  std::uint64_t soft_lit = 0, soft_dark = 0;
};

/// Decides the pairs that beamShadows() left unsure: those with lights of a size by
/// kernels/exact/pair_rays.cl, BeamScene::soft_samples rays each; those of which textures decide, and all on
/// a device without doubles, by rays on the host, on all cores. Sets PairShadows::lit or, with
/// BeamArguments::soft, first_share and shares. Throws MachineError if the device fails or memory doesn't
/// suffice.
TracedPairs tracePairs(const PairInput& in, PairShadows& shadows);

}  // namespace luciole
