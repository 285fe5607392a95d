#pragma once

#include <cstdint>
#include <string>

#include "lighting/light_gbuffer.hpp"
#include "lighting/stats.hpp"
#include "raster/rasterize.hpp"

// What a picture's statistics count.
namespace luciole {

/// Adds to a count, which begins at 0.
void addCount(Stats& stats, const std::string& name, std::uint64_t count);

/// Adds what clusters of lights cost a pass.
void countClusters(const ClusteredLightCounts& counts, Stats& stats);

/// Says how many lights clusters stand for, and why not for the others. Nothing where that wasn't asked for.
void countLightUses(const Scene& scene, const ShadeSettings& settings, const Lighting& lighting,
                    Stats& stats);

/// Pixels that show a surface.
std::uint64_t coveredPixels(const GBuffer& gbuffer);

/// Adds a pass that lit the G-buffer. counted: whether lit.evaluated was counted.
void countPass(const GBuffer& gbuffer, const LitPlanes& lit, bool counted, Stats& stats);

/// Adds what became of the triangles.
void countTriangles(const RasterCounts& counts, Stats& stats);

/// Says how many lights cast shadows, and by what.
void countShadows(const Lighting& lighting, Stats& stats);

}  // namespace luciole
