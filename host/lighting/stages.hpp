#pragma once

#include <cstdint>
#include <vector>

#include "lighting/draw_maps.hpp"
#include "lighting/light_gbuffer.hpp"
#include "shade/points.hpp"
#include "shade/shade_tiles.hpp"

// The five stages that light a G-buffer, in their order: cull, draw maps, decide beams, sum clusters, shade.
// lightGBuffer() composes them. All throw MachineError.
namespace luciole {

/// What all stages know: the points, their lights, and what a picture's G-buffers share.
struct StageInput {
  OpenedDevice& device;
  const Scene& scene;
  const Lighting& lighting;
  const LightPass& pass;
  const Points& points;
  const LightLists& lists;  ///< of the lights that matter to the points; without tiles: all do
};

/// Makes the lists.
void cullLights(const StageInput& input, LightLists& lists);

/// For each bin of the shadow maps what the points need of it: see findNeeded. drawMaps() draws it.
std::vector<std::uint32_t> findTexels(const StageInput& input);

/// The exact shadows of all entries of the lists, but for the pairs that rays decide.
PairShadows decideBeams(const StageInput& input);

/// Decides these by rays.
TracedPairs traceUnsurePairs(const StageInput& input, PairShadows& pairs);

/// These shadows on the device, borrowed. See ShadeArguments.
struct PairBuffers {
  Buffer<const uint> pair_bits, ray_bits, first_share;
  Buffer<const float> shares;
};
PairBuffers borrowPairs(OpenedDevice& device, const PairShadows& pairs);

/// The light of clusters: planes r g b.
struct ClusterLight {
  Plane light;  ///< as it leaves the surface, and the G-buffer's emission with it
  Plane bound;  ///< how far each value may be from the truth, seen through the fog; 0 for background
  ClusteredLightCounts counts;
};
ClusterLight sumClusters(const StageInput& input, const ShadeFrame& frame);

/// Shades by lists, or by all lights where there are none. image: out, see LitPlanes::color.
void shadeByLists(const StageInput& input, const ShadeFrame& frame, const PairBuffers& pairs,
                  const Buffer<float>& image);

/// Culls and shades tile by tile, without lists in memory, and counts what it does.
TileCounts shadeByTiles(const StageInput& input, const ShadeFrame& frame, const Buffer<float>& image);

}  // namespace luciole
