#pragma once

#include <cstdint>

#include "lighting/lighting.hpp"
#include "luciole/gbuffer.hpp"
#include "shade/clustered_light.hpp"
#include "shade/sampled_light.hpp"
#include "shadow/exact/pair_rays.hpp"

namespace luciole {

/// The optional counts of lightGBuffer(). Each costs time.
struct PixelCounts {
  bool evaluated = false;    ///< LitPlanes::evaluated
  bool in_range = false;     ///< LitPlanes::light_count
  bool list_length = false;  ///< LitPlanes::list_length
};

/// A lit G-buffer: planes of pixels() floats.
struct LitPlanes {
  Plane color = {};  ///< r g b, then with Feature::kOutputShadow the shadow layer
  /// Half widths of the intervals that hold `color`, r g b; 0 for background. Empty without clusters and
  /// sampled lights.
  Plane light_error = {};
  Plane half_width = {};  ///< the part of light_error that isn't proven; empty without sampled lights
  ClusteredLightCounts clustered = {};
  SampledLightCounts sampled = {};
  Plane light_count = {};  ///< lights in range of each pixel, if asked for
  Plane list_length =
      {};  ///< lights in the list of each pixel's square, if asked for; without lists all lights
  std::uint64_t list_entries = 0;   ///< of Lighting::lists; without lists in memory, of the tile kernel
  PairShadows pairs = {};           ///< with Feature::kExact: the shadows of the entries of Lighting::lists
  TracedPairs traced = {};          ///< of these, the pairs of a pixel and a light that were decided by rays
  std::uint64_t evaluated = 0;      ///< pixel-light pairs that the shade kernel went through, if asked for
  std::uint64_t by_beams = 0;       ///< of these, with lights whose shadows are exact
  std::uint64_t by_maps = 0;        ///< and with lights that have shadow maps
  std::uint64_t faulty_pixels = 0;  ///< to which a user's model gave NaN or other numbers that are no light
};

/// The input of a pass: points and lights.
struct LightPass {
  const LightSet& lights;      ///< those of the lighting, or of a layer
  const FeatureSet& features;  ///< those that the lighting was prepared for, or fewer
  const GBuffer& gbuffer;
  PixelCounts counts = {};
  Plane recycled = {};  ///< a plane whose memory the colours take
};

/// The program by which this device lights G-buffers with these features: their own, or the general one.
FeatureSet programFor(const OpenedDevice& device, const FeatureSet& features);

/// Lights one G-buffer: culls lights, computes shadows and shades. Draws the texels of shadow maps that it
/// looks up, unless an earlier call did. Adds the times of its stages to `stats`, and raises
/// stats.device_bytes to the bytes of its buffers. Throws MachineError.
LitPlanes lightGBuffer(OpenedDevice& device, const Scene& scene, Lighting& lighting, LightPass pass,
                       Stats& stats);

}  // namespace luciole
