#pragma once

#include <cstdint>
#include <span>

#include "gbuffer/gbuffer.hpp"
#include "rays/ray_cast.hpp"
#include "render/classify.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// Decides the pairs that are unsure by rays (see buildShadowRays): the bits of those that are lit are set
/// too. order: the scene's index of each of the device's lights. Returns how many there were.
std::uint64_t traceUnsure(Device& device, const Scene& scene, const RayScene& rays, const GBuffer& gbuffer,
                          std::span<const std::uint32_t> order, const LightLists& lists, PairBits& bits);

}  // namespace luciole
