#include "render/hole_rays.hpp"

#include <tbb/parallel_for.h>

#include <bit>
#include <cmath>
#include <numeric>

#include "raster/opacity.hpp"
#include "shadow/exact_ray.hpp"

namespace luciole {
namespace {

/// A pixel's start point in the tree's space, by the operations of load_points() in kernels/beam_points.clh.
glm::vec3 startPoint(const BeamScene& beams, const GBuffer& gbuffer, std::size_t place) {
  const std::size_t stride = gbuffer.pixels();
  glm::vec3 p(gbuffer.position[place], gbuffer.position[place + stride],
              gbuffer.position[place + 2 * stride]);
  if (!gbuffer.lift.empty())
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = std::fma(gbuffer.lift[place], gbuffer.normal[place + std::size_t(axis) * stride], p[axis]);
  glm::vec3 start;
  for (int axis = 0; axis < 3; ++axis) {
    const glm::mat3& m = beams.view_to_tree;
    start[axis] = std::fma(p.z, m[2][axis], std::fma(p.x, m[0][axis], p.y * m[1][axis])) * beams.tree->scale;
  }
  return start;
}

}  // namespace

std::uint64_t traceHoles(Device& device, const Scene& scene, const BeamScene& beams, const GBuffer& gbuffer,
                         const LightLists& lists, PairShadows& shadows) {
  const std::size_t tiles = gbuffer.pixels() / kTilePixels;
  std::vector<uint> starts(tiles + 1);
  std::vector<ListEntry> list(lists.entries);
  if (lists.tiles > 0) {
    download(device, lists.starts, starts);
    download(device, lists.list, list);
  }
  const std::vector<PlacedObject> objects = placeObjects(scene, allObjects(scene), glm::dmat4(1));
  const auto is_hole = [&](std::uint32_t triangle, const glm::dvec3& weights) {
    const PlacedObject& object = objectOfTriangle(objects, triangle);
    return isHoleAt(scene, object, triangle - object.first_triangle, weights);
  };
  std::vector<std::uint64_t> unsure(tiles);
  tbb::parallel_for(std::size_t(0), tiles, [&](std::size_t tile) {
    const bool lists_all = lists.tiles == 0;
    const std::size_t count = beams.lights.size(), first = lists_all ? tile * count : starts[tile];
    const std::size_t end = lists_all ? first + count : starts[tile + 1];
    for (std::size_t entry = first; entry < end; ++entry) {
      const BeamLight& light = beams.lights[lists_all ? entry - first : list[entry].light];
      for (std::size_t word = 0; word < kPairWords; ++word) {
        for (uint left = shadows.unsure[entry * kPairWords + word]; left != 0; left &= left - 1) {
          const int bit = std::countr_zero(left);
          const std::size_t pixel = tile * kTilePixels + word * 32 + std::size_t(bit);
          if (!isBlocked(*beams.tree, startPoint(beams, gbuffer, pixel), light, is_hole))
            shadows.lit[entry * kPairWords + word] |= 1u << bit;
          ++unsure[tile];
        }
      }
    }
  });
  return std::accumulate(unsure.begin(), unsure.end(), std::uint64_t(0));
}

}  // namespace luciole
