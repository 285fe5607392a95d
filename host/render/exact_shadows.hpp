#pragma once

#include <cstdint>
#include <span>

#include "gbuffer/gbuffer.hpp"
#include "rays/ray_cast.hpp"
#include "render/classify.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// Decides by rays the pairs that classify() left unsure, and sets the bits of those that are lit. Returns
/// how many pairs were unsure. rays: by buildShadowRays(); order: the scene's index of each light on the
/// device; lists, bits: as classify() had and returned them. Works on all cores, and throws MachineError if
/// the device fails.
std::uint64_t traceUnsure(Device& device, const Scene& scene, const RayScene& rays, const GBuffer& gbuffer,
                          std::span<const std::uint32_t> order, const LightLists& lists, PairBits& bits);

}  // namespace luciole
