#include "shadow/exact/pair_rays.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "base/machine_memory.hpp"
#include "cl/launch.hpp"
#include "kernels/shared.h"
#include "luciole/error.hpp"
#include "raster/opacity.hpp"
#include "shadow/exact/beam_frame.hpp"
#include "shadow/exact/exact_ray.hpp"
#include "shadow/exact/light_rays.hpp"
#include "shadow/exact/light_samples.hpp"

namespace luciole {
namespace {

/// A pixel's start point in the tree's space, by the operations of load_points() in
/// kernels/exact/beam_points.clh.
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

/// The state of a thread.
struct Tracer {
  const PairInput& in;
  const HoleTest& is_hole;
  std::optional<std::size_t> likely{};
  std::array<float4, kMostSoftSamples> places{};

  /// The share of a light that reaches a pixel.
  float share(const LightRay& pair) {
    const BeamScene& beams = in.arguments.beams;
    const BeamLight& light = in.lights.beam_lights[pair.light];
    const glm::vec3 start = startPoint(beams, in.gbuffer, pair.point);
    std::span<float4> to(places.data(), 1);
    if (light.size > 0) {
      const std::span<const LightSample> pattern =
          patternOf(beams.samples, beams.soft_samples, start, light.number);
      to = std::span(places.data(), pattern.size());
      if (!placeSamples(light, start, pattern, to)) return 1;
    } else {
      places[0] = light.place;
    }
    return float(countUnblocked(*beams.tree, start, to, is_hole, likely)) / float(to.size());
  }
};

/// The sum of the counts before each, and at last of all. Throws MachineError.
std::vector<uint> sumsOf(std::span<const uint> counts) {
  std::vector<uint> sums(counts.size() + 1);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    sum += counts[i];
    if (sum > 0xffffffffu)
      throw MachineError(
          "rays decide 2^32 or more pairs of a pixel and a light: use fewer lights or a smaller picture");
    sums[i + 1] = uint(sum);
  }
  return sums;
}

/// Launches kernels/exact/pair_rays.cl and sets first_share and shares. counts: of each tile its unsure
/// pairs. Returns how many of them are left open.
std::vector<uint> traceOnDevice(const PairInput& in, std::span<const uint> counts, PairShadows& shadows) {
  const BeamArguments& arguments = in.arguments;
  const BeamScene& beams = arguments.beams;
  const std::vector<uint> first = sumsOf(counts);
  std::vector<uint> open(counts.size());
  requireMemory(double(first.back()) * sizeof(float), "the soft shadows of all pixels");
  shadows.first_share = makeBuffer<uint>(in.device, shadows.unsure.count);
  shadows.shares = makeBuffer<float>(in.device, first.back());
  const Buffer<const uint> first_pair = borrowed(in.device, first);
  const Buffer<uint> left_open = borrowedForOutput(in.device, open);
  BeamFrame frame = beamFrame(beams, arguments.plane_stride);
  frame.light_count = uint(arguments.lights.count);
  Kernel kernel = makeKernel(in.device, "exact/pair_rays.cl", "pair_rays", in.defines);
  launch(in.device, kernel,
         withTriangleTree(beams, {{"frame", frame},
                                  {"samples", uint(beams.soft_samples)},
                                  {"position", arguments.position},
                                  {"normal", arguments.normal},
                                  {"lift", arguments.lift},
                                  {"lights", arguments.lights},
                                  {"list_starts", arguments.lists.starts},
                                  {"list", arguments.lists.list},
                                  {"quarter_cosines", beams.quarter_cosines},
                                  {"unsure", shadows.unsure},
                                  {"first_pair", first_pair},
                                  {"first_share", shadows.first_share},
                                  {"shares", shadows.shares},
                                  {"open", left_open}}),
         {.items = counts.size()});
  download(in.device, left_open, open);
  return open;
}

/// Decides the pairs that are open by rays on the host. counts: of each tile.
void settleOnHost(const PairInput& in, std::span<const uint> counts, PairShadows& shadows) {
  const std::vector<uint> first = sumsOf(counts);
  // Where textures may have to decide the kernel is compiled while others are.
  if (first.back() == 0 && !in.arguments.holes) return;
  std::vector<float> seen(first.back());
  std::vector<LightRay> pairs(first.back());
  const Buffer<const uint> first_open = borrowed(in.device, first);
  const Buffer<LightRay> open = borrowedForOutput(in.device, pairs);
  Kernel kernel = makeKernel(in.device, "exact/open_pairs.cl", "open_pairs", in.defines);
  const auto run = [&](bool settle, const Buffer<const float>& shares) {
    launch(in.device, kernel,
           {{"settle", uint(settle)},
            {"light_count", uint(in.arguments.lights.count)},
            {"list_starts", in.arguments.lists.starts},
            {"list", in.arguments.lists.list},
            {"unsure", shadows.unsure},
            {"first_share", shadows.first_share},
            {"first_open", first_open},
            {"open", open},
            {"seen", shares},
            {"lit", shadows.lit},
            {"shares", shadows.shares}},
           {.items = counts.size()});
  };
  run(false, {});
  download(in.device, open, pairs);
  const std::vector<PlacedObject> objects = placeObjects(in.scene, allObjects(in.scene), glm::dmat4(1));
  const HoleTest is_hole = [&](std::uint32_t triangle, const glm::dvec3& weights) {
    const PlacedObject& object = objectOfTriangle(objects, triangle);
    return isHoleAt(in.scene, object, triangle - object.first_triangle, weights);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pairs.size(), 64), [&](const auto& part) {
    Tracer tracer{in, is_hole};
    for (std::size_t i = part.begin(); i < part.end(); ++i) seen[i] = tracer.share(pairs[i]);
  });
  run(true, borrowed(in.device, seen));
  finish(in.device);
}

}  // namespace

TracedPairs tracePairs(const PairInput& in, PairShadows& shadows) {
  std::vector<TilePairs> counts(shadows.counts.count);
  download(in.device, shadows.counts, counts);
  TracedPairs traced;
  std::vector<uint> open;
  for (const TilePairs& of_tile : counts) {
    traced.pairs += of_tile.unsure;
    traced.soft += of_tile.soft_unsure;
    traced.soft_lit += of_tile.soft_lit;
    traced.soft_dark += of_tile.soft_dark;
    open.push_back(of_tile.unsure);
  }
  traced.rays = traced.pairs - traced.soft + traced.soft * std::uint64_t(in.arguments.beams.soft_samples);
  if (in.arguments.soft) open = traceOnDevice(in, open, shadows);
  settleOnHost(in, open, shadows);
  return traced;
}

}  // namespace luciole
