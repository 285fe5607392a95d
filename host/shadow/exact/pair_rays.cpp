#include "shadow/exact/pair_rays.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "cl/launch.hpp"
#include "kernels/shared.h"
#include "luciole/error.hpp"
#include "raster/opacity.hpp"
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

/// The lists on the host. Without lists each tile has all lights.
struct HostLists {
  std::vector<uint> starts;
  std::vector<ListEntry> list;
  std::size_t lights;

  std::size_t first(std::size_t tile) const { return starts.empty() ? tile * lights : starts[tile]; }
  ListEntry at(std::size_t tile, std::size_t entry) const {
    return starts.empty() ? ListEntry{uint(entry - tile * lights), 0xffff} : list[entry];
  }
};

HostLists downloadLists(OpenedDevice& device, const LightLists& lists, std::size_t lights) {
  HostLists result{{}, {}, lights};
  if (lists.tiles == 0) return result;
  result.starts.resize(lists.tiles + 1);
  result.list.resize(lists.entries);
  download(device, lists.starts, result.starts);
  download(device, lists.list, result.list);
  return result;
}

/// Sets first_share. Returns the number of shares.
std::size_t placeShares(const HostLists& lists, std::span<const uint> first, std::span<const uint> unsure,
                        std::span<uint> first_share) {
  tbb::parallel_for(std::size_t(0), first.size() - 1, [&](std::size_t tile) {
    uint next = first[tile];
    for (std::size_t at = lists.first(tile) * kPairWords; at < lists.first(tile + 1) * kPairWords; ++at) {
      first_share[at] = next;
      next += uint(std::popcount(unsure[at]));
    }
  });
  return first.back();
}

/// The state of a thread.
struct Tracer {
  const BeamScene& beams;
  const LightSet& lights;
  const HoleTest& is_hole;
  std::optional<std::size_t> likely{};
  std::array<float4, kMostSoftSamples> places{};

  /// The share of a light, by its index on the device, that reaches a start point.
  float visibility(const glm::vec3& start, std::uint32_t index) {
    const BeamLight& light = lights.beam_lights[index];
    std::span<float4> to(places.data(), 1);
    if (light.size > 0) {
      const std::span<const LightSample> pattern =
          patternOf(beams.samples, beams.soft_samples, start, lights.order[index]);
      to = std::span(places.data(), pattern.size());
      if (!placeSamples(light, start, pattern, to)) return 1;
    } else {
      places[0] = light.place;
    }
    return float(countUnblocked(*beams.tree, start, to, is_hole, likely)) / float(to.size());
  }
};

/// The index of each tile's first unsure pair, and the number of all. Throws MachineError.
std::vector<uint> firstPairs(std::span<const TilePairs> counts) {
  std::vector<uint> first(counts.size() + 1);
  std::uint64_t sum = 0;
  for (std::size_t tile = 0; tile < counts.size(); ++tile) {
    first[tile] = uint(sum);
    sum += counts[tile].unsure;
  }
  if (sum > 0xffffffffu)
    throw MachineError(
        "rays decide 2^32 or more pairs of a pixel and a light: use fewer lights or a smaller picture");
  first.back() = uint(sum);
  return first;
}

/// Decides pairs with lights without a size by rays on the host.
void traceOpenPairs(const PairInput& in, const HoleTest& is_hole, PairShadows& shadows) {
  const std::vector<uint> first = firstPairs(shadows.counts);
  const Buffer<const uint> first_open = borrowed(in.device, first);
  const Buffer<LightRay> open = makeBuffer<LightRay>(in.device, first.back());
  std::vector<unsigned char> visible(first.back());
  std::vector<LightRay> rays(first.back());
  Kernel kernel = makeKernel(in.device, "exact/open_pairs.cl", "open_pairs", in.defines);
  const auto run = [&](bool settle, const Buffer<const unsigned char>& verdicts) {
    launch(in.device, kernel,
           {{"settle", uint(settle)},
            {"light_count", uint(in.lights.beam_lights.size())},
            {"list_starts", in.lists.starts},
            {"list", in.lists.list},
            {"unsure", shadows.unsure},
            {"first_open", first_open},
            {"open", open},
            {"visible", verdicts},
            {"lit", shadows.lit}},
           {.items = shadows.counts.size()});
  };
  run(false, {});
  download(in.device, open, rays);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size(), 64), [&](const auto& part) {
    Tracer tracer{in.beams, in.lights, is_hole};
    for (std::size_t i = part.begin(); i < part.end(); ++i)
      visible[i] = tracer.visibility(startPoint(in.beams, in.gbuffer, rays[i].point), rays[i].light) > 0;
  });
  run(true, borrowed(in.device, visible));
  finish(in.device);
}

/// Decides pairs with lights of any size by rays on the host.
void traceShares(const PairInput& in, const HoleTest& is_hole, PairShadows& shadows) {
  const std::vector<uint> first = firstPairs(shadows.counts);
  const HostLists lists = downloadLists(in.device, in.lists, in.lights.beam_lights.size());
  std::vector<uint> unsure(shadows.unsure.count), first_share(unsure.size());
  download(in.device, shadows.unsure, unsure);
  std::vector<float> shares(placeShares(lists, first, unsure, first_share));
  tbb::parallel_for(std::size_t(0), shadows.counts.size(), [&](std::size_t tile) {
    Tracer tracer{in.beams, in.lights, is_hole};
    std::size_t share = first[tile];
    for (std::size_t at = lists.first(tile) * kPairWords; at < lists.first(tile + 1) * kPairWords; ++at)
      for (uint left = unsure[at]; left != 0; left &= left - 1) {
        const std::size_t pixel =
            tile * kTilePixels + at % kPairWords * 32 + std::size_t(std::countr_zero(left));
        shares[share++] =
            tracer.visibility(startPoint(in.beams, in.gbuffer, pixel), lists.at(tile, at / kPairWords).light);
      }
  });
  shadows.first_share = makeBuffer<uint>(in.device, first_share.size());
  bytes::write(in.device, shadows.first_share.memory, first_share.data(),
               {0, first_share.size() * sizeof(uint)});
  shadows.shares = makeBuffer<float>(in.device, shares.size());
  bytes::write(in.device, shadows.shares.memory, shares.data(), {0, shares.size() * sizeof(float)});
}

}  // namespace

TracedPairs tracePairs(const PairInput& in, PairShadows& shadows) {
  const std::vector<PlacedObject> objects = placeObjects(in.scene, allObjects(in.scene), glm::dmat4(1));
  const HoleTest is_hole = [&](std::uint32_t triangle, const glm::dvec3& weights) {
    const PlacedObject& object = objectOfTriangle(objects, triangle);
    return isHoleAt(in.scene, object, triangle - object.first_triangle, weights);
  };
  if (in.soft)
    traceShares(in, is_hole, shadows);
  else
    traceOpenPairs(in, is_hole, shadows);
  TracedPairs traced;
  for (const TilePairs& of_tile : shadows.counts) {
    traced.pairs += of_tile.unsure;
    traced.soft += of_tile.soft_unsure;
    traced.soft_lit += of_tile.soft_lit;
    traced.soft_dark += of_tile.soft_dark;
  }
  traced.rays = traced.pairs - traced.soft + traced.soft * std::uint64_t(in.beams.soft_samples);
  return traced;
}

}  // namespace luciole
