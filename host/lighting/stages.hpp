#pragma once

#include <cstdint>
#include <vector>

#include "lighting/draw_maps.hpp"
#include "lighting/light_gbuffer.hpp"
#include "shade/points.hpp"
#include "shade/sampled_light.hpp"
#include "shade/shade_tiles.hpp"

// The stages that light a G-buffer, in their order: cull, draw maps, decide beams, sum clusters, sample
// lights, shade. lightGBuffer() composes them. All throw MachineError.
namespace luciole {

/// The input of all stages.
struct StageInput {
  OpenedDevice& device;
  const Scene& scene;
  const Lighting& lighting;
  const LightPass& pass;
  const FeatureSet& compiled;  ///< the features of the programs: those of the pass, or more
  const Points& points;
  const LightLists& lists;  ///< of the lights that matter to the points; without tiles: all do
};

/// Makes the lists.
void cullLights(const StageInput& input, LightLists& lists);

/// For each bin of the shadow maps the depth to which drawMaps() must draw it: see findNeeded.
std::vector<std::uint32_t> findTexels(const StageInput& input);

/// The exact shadows of all entries of the lists. PairShadows::unsure are left to traceUnsurePairs().
PairShadows decideBeams(const StageInput& input);

/// Decides the unsure pairs by rays.
TracedPairs traceUnsurePairs(const StageInput& input, PairShadows& pairs);

/// Light of clusters and of sampled lights: planes r g b, or empty where there are neither.
struct BoundedLight {
  Plane light;  ///< as it leaves the surface, and the G-buffer's emission with it
  Plane bound;  ///< half widths of each value's interval, seen through the fog; 0 for background
  Plane
      half_width;  ///< the part of `bound` that is sampled; the rest is proven. Empty without sampled lights
  ClusteredLightCounts cluster_counts;
  SampledLightCounts sample_counts;
};

/// The light of clusters, or 0 without any, and the emission.
BoundedLight sumClusters(const StageInput& input, const ShadeFrame& frame);

/// Adds the light of sampled lights, and their intervals.
void sampleLights(const StageInput& input, const ShadeFrame& frame, BoundedLight& result);

/// What shading writes.
struct ShadedBuffers {
  Buffer<float> image;         ///< see LitPlanes::color
  Buffer<uint> faulty_pixels;  ///< LitPlanes::faulty_pixels, to be raised, with Feature::kUserModels only
};

/// Shades by lists, or by all lights where there are none.
void shadeByLists(const StageInput& input, const ShadeFrame& frame, const PairShadows& pairs,
                  const ShadedBuffers& out);

/// Culls and shades in one kernel, without lists in memory.
TileCounts shadeByTiles(const StageInput& input, const ShadeFrame& frame, const ShadedBuffers& out);

}  // namespace luciole
