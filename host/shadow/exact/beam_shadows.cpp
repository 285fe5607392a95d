#include "shadow/exact/beam_shadows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/machine_memory.hpp"
#include "cl/launch.hpp"
#include "kernels/shared.h"
#include "luciole/error.hpp"
#include "shadow/exact/beam_frame.hpp"

namespace luciole {
namespace {

/// The largest |x|, |y|, |z| in the tree: its root's boxes hold all of it.
float4 largestCoordinates(const TriangleTree& tree) {
  float most[3] = {0, 0, 0};
  const bool is_node = tree.root >= 0;
  const float* rows = is_node ? tree.nodes.data() : tree.blocks.data();
  const int count = is_node ? int(kNodeRows) : int(kPlaneRows);
  for (int row = 0; row < count; ++row)
    for (int i = 0; i < kTreeWidth; ++i)
      if (const float value = std::abs(rows[row * kTreeWidth + i]); std::isfinite(value)) {
        float& axis = most[is_node ? row / 2 : row % 3];
        axis = std::max(axis, value);
      }
  return {most[0], most[1], most[2], 0};
}

}  // namespace

void prepareBeams(OpenedDevice& device, const Camera& camera, std::shared_ptr<const TriangleTree> tree,
                  std::shared_ptr<const HoleMasks> masks, int soft_samples, BeamScene& beams) {
  beams.tree = std::move(tree);
  beams.masks = std::move(masks);
  beams.view_to_tree = glm::mat3(glm::dmat3(camera.camera_to_world));
  beams.largest_coordinates = largestCoordinates(*beams.tree);
  beams.soft_samples = soft_samples;
  if (soft_samples > 0) {
    beams.samples = makeLightSamples();
    beams.cosines = quarterCosines();
    beams.quarter_cosines = borrowed(device, beams.cosines);
  }
  beams.nodes = borrowed(device, beams.tree->nodes);
  beams.children = borrowed(device, beams.tree->children);
  beams.blocks = borrowed(device, beams.tree->blocks);
  beams.block_bits = borrowed(device, beams.masks ? beams.masks->block_bits : beams.tree->block_bits);
  if (beams.masks) {
    beams.hole_texels = borrowed(device, beams.masks->texels);
    beams.hole_triangles = borrowed(device, beams.masks->triangles);
    beams.first_hole_triangle = borrowed(device, beams.masks->first_triangle);
  }
}

BeamLight beamLight(const Light& light, bool casts, const BeamScene& beams) {
  // A light farther away becomes directional, because a beam's numbers would overflow. Radii are clamped to
  // the largest distance between points of the tree's space: larger lights contain all points anyway.
  constexpr double kFarthest = 0x1p40;
  const TriangleTree& tree = *beams.tree;
  BeamLight result{};
  result.casts = casts;
  const bool directional = light.kind == LightKind::kDirectional;
  const glm::dvec3 place = (light.position - tree.origin) * double(tree.scale);
  const double largest = std::max({std::abs(place.x), std::abs(place.y), std::abs(place.z)});
  const bool has_place = !directional && largest <= kFarthest;
  const glm::dvec3 towards = directional ? -light.direction : place / largest;
  const glm::dvec3 at = has_place ? place : glm::normalize(towards);
  result.place = {float(at.x), float(at.y), float(at.z), has_place ? 1.0f : 0.0f};
  result.reach = has_place ? light.range * tree.scale : std::numeric_limits<float>::infinity();
  if (beams.soft_samples == 0) return result;
  const double radius = light.radius * double(tree.scale),
               half_angle = directional ? light.half_angle : std::asin(std::min(radius / largest, 0.7));
  result.size = float(has_place ? std::min(radius, 4 * kFarthest) : 2 * std::sin(half_angle / 2));
  return result;
}

PairShadows beamShadows(OpenedDevice& device, const std::string& defines, const BeamArguments& arguments) {
  const BeamScene& beams = arguments.beams;
  const std::size_t tiles = arguments.plane_stride / kTilePixels;
  const std::size_t entries =
      arguments.lists.tiles > 0 ? arguments.lists.entries : tiles * arguments.lights.count;
  const bool soft = arguments.soft, unsure_pairs = arguments.holes || soft;
  const double words = kPairWords * (soft ? 3 : unsure_pairs ? 2 : 1) + (soft ? 1 : 0);
  requireMemory(double(entries) * words * sizeof(uint), "the exact shadows of all pixels");
  if (entries > 0xffffffffu / kPairWords)
    throw MachineError(
        "exact shadows of 2^29 or more pairs of a tile and a light: use fewer lights or a smaller picture");
  PairShadows result;
  result.lit = makeBuffer<uint>(device, entries * kPairWords);
  if (unsure_pairs) {
    result.unsure = makeBuffer<uint>(device, entries * kPairWords);
    result.counts = makeBuffer<TilePairs>(device, tiles);
  }
  BeamFrame frame = beamFrame(beams, arguments.plane_stride);
  frame.light_count = uint(arguments.lights.count);
  Kernel kernel = makeKernel(device, "exact/beam_shadows.cl", "beam_shadows", defines);
  launch(device, kernel,
         withTriangleTree(beams, {{"frame", frame},
                                  {"position", arguments.position},
                                  {"normal", arguments.normal},
                                  {"lift", arguments.lift},
                                  {"lights", arguments.lights},
                                  {"list_starts", arguments.lists.starts},
                                  {"list", arguments.lists.list},
                                  {"lit", result.lit},
                                  {"unsure", result.unsure},
                                  {"counts", result.counts}}),
         {.items = (tiles + kBeamRun - 1) / kBeamRun});
  finish(device);
  return result;
}

}  // namespace luciole
