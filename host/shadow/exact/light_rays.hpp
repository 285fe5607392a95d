#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "cl/buffer.hpp"
#include "cl/launch.hpp"
#include "kernels/exact/light_rays.h"
#include "kernels/shared.h"
#include "shadow/exact/beam_shadows.hpp"
#include "shadow/exact/exact_ray.hpp"

namespace luciole {

template <>
constexpr std::string_view kernelTypeName<LightRay>() {
  return "LightRay";
}
template <>
constexpr std::string_view kernelTypeName<RayFrame>() {
  return "RayFrame";
}

struct RayArguments {
  Buffer<const LightRay> rays;
  std::size_t ray_count;       ///< of these: the first ones; below 2³²
  Buffer<const float> starts;  ///< planes x, y, z, in the tree's space: rayStarts() has those of a G-buffer
  std::size_t start_stride;    ///< floats in a plane
  Buffer<const BeamLight> lights;
  const BeamScene& beams;
};

/// The words that hold a bit for each of so many rays.
constexpr std::size_t wordsForRays(std::size_t rays) { return (rays + 31) / 32; }

/// Queues kernels/exact/light_rays.cl, for rays in any order from points to lights without a size. Bit i of
/// `lit` becomes 1 where nothing blocks ray i: the answer of countUnblocked() to the bit, whatever the device
/// and the other rays are. With Feature::kHoles bit i of `unsure` is 1 where only a texture can tell
/// (settleRays); then that of `lit` is 0. Without it `unsure` isn't written. Both have wordsForRays() words;
/// bits beyond the last ray become 0. defines: of featuresFor(kForBeams). Fast where rays that follow each
/// other, 16 together from a multiple of 16 on, start and end near each other. Throws MachineError.
void traceLightRays(OpenedDevice& device, const std::string& defines, const RayArguments& arguments,
                    const Buffer<uint>& lit, const Buffer<uint>& unsure);

struct RayStartArguments {
  std::size_t plane_stride;      ///< floats in a plane
  Buffer<const float> position;  ///< G-buffer planes x, y, z; view space, metres
  Buffer<const float> normal;    ///< G-buffer planes x, y, z; view space, unit
  Buffer<const float> lift;      ///< a plane, metres, with Feature::kLift only
  const BeamScene& beams;
};

/// Queues kernels/exact/ray_starts.cl: writes the planes x, y, z of the points from which a G-buffer's
/// shadows are tested, as beams have them. Throws MachineError.
void rayStarts(OpenedDevice& device, const std::string& defines, const RayStartArguments& arguments,
               const Buffer<float>& starts);

/// Decides the rays that are unsure by countUnblocked(), and sets the bits of those that are lit. The spans
/// are what traceLightRays() had and wrote. Returns how many there were. On all cores.
std::size_t settleRays(const BeamScene& beams, std::span<const LightRay> rays, std::span<const float> starts,
                       std::span<const BeamLight> lights, const HoleTest& is_hole,
                       std::span<const uint> unsure, std::span<uint> lit);

}  // namespace luciole
