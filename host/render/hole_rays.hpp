#pragma once

#include <cstdint>

#include "gbuffer/gbuffer.hpp"
#include "render/beam_shadows.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// Decides the pairs that beamShadows() left unsure, by rays that look textures up, and sets the bits of
/// those that are lit. Returns how many pairs were unsure. lists: those that it had. Works on all cores.
/// Throws MachineError if the device fails.
std::uint64_t traceHoles(Device& device, const Scene& scene, const BeamScene& beams, const GBuffer& gbuffer,
                         const LightLists& lists, PairShadows& shadows);

}  // namespace luciole
