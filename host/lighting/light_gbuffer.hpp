#pragma once

#include <cstdint>

#include "lighting/lighting.hpp"
#include "luciole/gbuffer.hpp"
#include "shade/clustered_light.hpp"
#include "shadow/exact/pair_rays.hpp"

namespace luciole {

/// What lightGBuffer() shall count in addition. Each costs time.
struct PixelCounts {
  bool evaluated = false;    ///< LitPlanes::evaluated
  bool in_range = false;     ///< LitPlanes::light_count
  bool list_length = false;  ///< LitPlanes::list_length
};

/// A lit G-buffer: planes of pixels() floats.
struct LitPlanes {
  Plane color;  ///< r g b, then with Feature::kOutputShadow the shadow layer
  /// Bounds of the error of `color` that clusters of lights make, r g b; 0 for background. Empty where none
  /// do.
  Plane light_error;
  ClusteredLightCounts clustered;
  Plane light_count;  ///< lights in range of each pixel, if asked for
  Plane
      list_length;  ///< lights in the list of each pixel's square, if asked for; all where there are no lists
  std::uint64_t list_entries =
      0;                        ///< of Lighting::lists, or where none were made, of those that shading found
  PairShadows pairs;            ///< with Feature::kExact: the shadows of the entries of Lighting::lists
  TracedPairs traced;           ///< of these, the pairs of a pixel and a light that took rays
  std::uint64_t evaluated = 0;  ///< pixel-light pairs that the shade kernel went through, if asked for
  std::uint64_t by_beams = 0;   ///< of these, with lights whose shadows are exact
  std::uint64_t by_maps = 0;    ///< and with lights that have shadow maps
};

/// What is lit, and by what.
struct LightPass {
  const LightSet& lights;      ///< those of the lighting, or of a layer
  const FeatureSet& features;  ///< those that the lighting was prepared for, or fewer
  const GBuffer& gbuffer;
  PixelCounts counts = {};
  Plane recycled = {};  ///< a plane that is done with, whose memory the colours take
};

/// Culls and shades one G-buffer: together where there are many lights and nothing but shading reads their
/// lists, that is without shadows and without counting how long lists are. Draws those parts of the scene's
/// shadow maps that it looks up and that weren't drawn before. Adds the times of its stages to `stats`, and
/// raises stats.device_bytes to what it needs. Throws MachineError.
LitPlanes lightGBuffer(OpenedDevice& device, const Scene& scene, Lighting& lighting, LightPass pass,
                       Stats& stats);

}  // namespace luciole
