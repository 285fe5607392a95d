#include "tools/info/estimate.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/shared.h"
#include "render/memory.hpp"

namespace luciole {

// Of each sum the parts are in the order of their stages. Costs are milliseconds a pixel, triangle, light …
double estimatedStart(const PictureWork& work) {
  const double start = 80, rays = work.frames_scene ? 25 : 0;
  return start + rays + 4e-4 * work.mesh_triangles + 9e-6 * work.texels + 17e-5 * work.lights;
}

double estimatedMilliseconds(const PictureWork& work) {
  const double tree = work.beam_pairs + work.sampling > 0 ? 2e-4 * work.triangles : 0;
  const double raster = 14e-6 * work.pixels + 25e-6 * work.textured + 2e-4 * work.bands * work.triangles;
  const double cull = 3e-5 * work.list_entries +
                      work.shadings * work.pixels * (2e-6 + 4e-4 / double(kTilePixels) * work.tree_levels);
  const double of_shadow_pair = work.shadows == ShadowMethod::kSoft  ? 50e-6
                                : work.shadows == ShadowMethod::kPcf ? 10e-6
                                                                     : 7e-6;
  // A walk for a third of the pairs, and its samples.
  const double of_beam_pair = 12e-6 + (work.soft_samples > 0 ? 2e-4 + 2e-6 * work.soft_samples : 0);
  const double shade = work.shadings * 3e-6 * work.pixels + 6e-7 * work.pairs +
                       of_shadow_pair * work.shadow_pairs + of_beam_pair * work.beam_pairs + work.sampling;
  const double shadow_maps = 3e-6 * work.shadow_texels + 0.1 * work.shadow_faces +
                             (work.shadow_texels > 0 ? 1e-4 * work.bands * work.triangles : 0);
  const double write = (17e-6 + 2e-6 * (work.passes - 1)) * work.pixels;
  // A pass over several samples draws them all, but sets up and resolves once, and looks for those that
  // share.
  const int together = work.samples - work.passes;
  const double drawings = work.passes + (together > 0 ? 1.5 + 0.08 * together : 0);
  return estimatedStart(work) + tree + drawings * raster + cull + shade + shadow_maps + write;
}

double estimatedBytes(const PictureWork& work) {
  const double loaded = 95e6 + work.scene_bytes + double(kBytesPerLight) * work.lights;
  const double tree = work.beam_pairs + work.sampling > 0 ? 200 * work.triangles : 0;
  // What is freed between passes is not all used again.
  const double raster = (100 + 120 * std::log2(work.passes)) * work.triangles;
  const double picture = raster + work.pixel_bytes +
                         double(sizeof(ListEntry)) * work.list_entries / work.shadings +
                         work.shadow_map_bytes + tree;
  return loaded + std::max(picture, 30 * work.decoded_texels);
}

}  // namespace luciole
