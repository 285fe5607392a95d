#include "shadow/exact/pair_rays.hpp"

#include <tbb/parallel_for.h>

#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "base/machine_memory.hpp"
#include "kernels/shared.h"
#include "luciole/error.hpp"
#include "raster/opacity.hpp"
#include "shadow/exact/exact_ray.hpp"
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

/// Bits of a word's pixels in an entry's squares. Other pixels are never shaded with its light.
uint listedPixels(uint squares, std::size_t word) {
  const uint of_word = squares >> SQUARE_OF_PIXEL(word * 32);
  return ((of_word & 1) != 0 ? 0xffffu : 0) | ((of_word & 2) != 0 ? 0xffff0000u : 0);
}

/// Clears the bits of unsure pairs that aren't shaded, and sets first_share. Returns the number of shares.
std::size_t placeShares(const HostLists& lists, std::size_t tiles, PairShadows& shadows) {
  std::vector<std::size_t> first(tiles + 1);
  const auto forWords = [&](std::size_t tile, const auto& word_of_entry) {
    for (std::size_t entry = lists.first(tile); entry < lists.first(tile + 1); ++entry)
      for (std::size_t word = 0; word < kPairWords; ++word) word_of_entry(entry, word);
  };
  tbb::parallel_for(std::size_t(0), tiles, [&](std::size_t tile) {
    forWords(tile, [&](std::size_t entry, std::size_t word) {
      uint& unsure = shadows.unsure[entry * kPairWords + word];
      unsure &= listedPixels(lists.at(tile, entry).squares, word);
      first[tile + 1] += std::size_t(std::popcount(unsure));
    });
  });
  for (std::size_t tile = 0; tile < tiles; ++tile) first[tile + 1] += first[tile];
  if (first[tiles] > 0xffffffffu)
    throw MachineError(
        "soft shadows of 2^32 or more pairs of a pixel and a light: use fewer lights or a smaller picture");
  requireMemory(double(first[tiles]) * sizeof(float), "the soft shadows of all pixels");
  shadows.first_share.resize(shadows.unsure.size());
  tbb::parallel_for(std::size_t(0), tiles, [&](std::size_t tile) {
    std::size_t next = first[tile];
    forWords(tile, [&](std::size_t entry, std::size_t word) {
      shadows.first_share[entry * kPairWords + word] = uint(next);
      next += std::size_t(std::popcount(shadows.unsure[entry * kPairWords + word]));
    });
  });
  return first[tiles];
}

/// The state of a thread.
struct Tracer {
  const BeamScene& beams;
  const LightSet& lights;
  const HoleTest& is_hole;
  std::optional<std::size_t> likely{};
  std::array<float4, kMostSoftSamples> places{};

  /// The share of a light, by its index on the device, that reaches a start point.
  float visibility(const glm::vec3& start, std::uint32_t index, TracedPairs& traced) {
    const BeamLight& light = lights.beam_lights[index];
    ++traced.pairs;
    std::span<float4> to(places.data(), 1);
    if (light.size > 0) {
      ++traced.soft;
      const std::span<const LightSample> pattern =
          patternOf(beams.samples, beams.soft_samples, start, lights.order[index]);
      to = std::span(places.data(), pattern.size());
      if (!placeSamples(light, start, pattern, to)) return 1;
    } else {
      places[0] = light.place;
    }
    traced.rays += to.size();
    return float(countUnblocked(*beams.tree, start, to, is_hole, likely)) / float(to.size());
  }
};

}  // namespace

TracedPairs tracePairs(OpenedDevice& device, const Scene& scene, const BeamScene& beams,
                       const LightSet& lights, const GBuffer& gbuffer, const LightLists& lists, bool soft,
                       PairShadows& shadows) {
  const std::size_t tiles = gbuffer.pixels() / kTilePixels;
  const HostLists host_lists = downloadLists(device, lists, lights.beam_lights.size());
  if (soft) shadows.shares.resize(placeShares(host_lists, tiles, shadows));
  const std::vector<PlacedObject> objects = placeObjects(scene, allObjects(scene), glm::dmat4(1));
  const HoleTest is_hole = [&](std::uint32_t triangle, const glm::dvec3& weights) {
    const PlacedObject& object = objectOfTriangle(objects, triangle);
    return isHoleAt(scene, object, triangle - object.first_triangle, weights);
  };
  std::vector<TracedPairs> traced(tiles);
  tbb::parallel_for(std::size_t(0), tiles, [&](std::size_t tile) {
    Tracer tracer{beams, lights, is_hole};
    for (std::size_t entry = host_lists.first(tile); entry < host_lists.first(tile + 1); ++entry) {
      const std::uint32_t light = host_lists.at(tile, entry).light;
      for (std::size_t word = 0; word < kPairWords; ++word) {
        const std::size_t at = entry * kPairWords + word;
        std::size_t share = soft ? shadows.first_share[at] : 0;
        for (uint left = shadows.unsure[at]; left != 0; left &= left - 1) {
          const int bit = std::countr_zero(left);
          const std::size_t pixel = tile * kTilePixels + word * 32 + std::size_t(bit);
          const float visible = tracer.visibility(startPoint(beams, gbuffer, pixel), light, traced[tile]);
          if (soft)
            shadows.shares[share++] = visible;
          else if (visible > 0)
            shadows.lit[at] |= 1u << bit;
        }
      }
    }
  });
  TracedPairs sum;
  for (const TracedPairs& of_tile : traced) {
    sum.pairs += of_tile.pairs;
    sum.rays += of_tile.rays;
    sum.soft += of_tile.soft;
  }
  return sum;
}

}  // namespace luciole
