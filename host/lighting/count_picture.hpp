#pragma once

#include <cstdint>
#include <string>

#include "lighting/light_gbuffer.hpp"
#include "lighting/stats.hpp"
#include "raster/rasterize.hpp"

// The counts of Stats::counts, by the names that --stats gives them.
namespace luciole {

/// The count of pixels to which a user's model gave NaN, or a number below 0 or of no sensible size.
constexpr const char* kFaultyPixels = "pixels_with_faulty_light";

/// The count of pixels of all samples to which the screen with this index gave no colour.
inline std::string faultyScreenPixels(std::size_t screen) {
  return "pixels_with_faulty_screen_" + std::to_string(screen);
}

/// The count of points to which a user's function of surfaces gave a number below 0, no number, or no
/// direction.
constexpr const char* kFaultySurfaces = "points_with_faulty_surface";

/// Adds to a count, which begins at 0.
void addCount(Stats& stats, const std::string& name, std::uint64_t count);

/// Adds the counts of clusters and of sampled lights.
void countStandIns(const LitPlanes& lit, Stats& stats);

/// Adds the numbers of lights in clusters, of sampled ones and of those summed by themselves, these by
/// LightUse. Adds nothing if ShadeSettings::light_error is 0.
void countLightUses(const Scene& scene, const ShadeSettings& settings, const Lighting& lighting,
                    Stats& stats);

/// Pixels that show a surface.
std::uint64_t coveredPixels(const GBuffer& gbuffer);

/// Adds the counts of a pass that lit the G-buffer. counted: lit.evaluated is known. least_value:
/// ShadeSettings::light_error_floor.
void countPass(const GBuffer& gbuffer, const LitPlanes& lit, bool counted, double least_value, Stats& stats);

/// Adds the rasterizer's counts of triangles.
void addRasterCounts(const RasterCounts& counts, Stats& stats);

/// Adds the numbers of lights that cast shadows, by exact shadows and by maps, and the size of the maps.
void countShadows(const Lighting& lighting, Stats& stats);

}  // namespace luciole
