#include "render/exact_shadows.hpp"

#include <tbb/parallel_for.h>

#include <array>
#include <bit>
#include <numeric>

#include "rays/shadow_rays.hpp"

namespace luciole {
namespace {

constexpr std::size_t kHalf = kPairWords / 2;

/// Traces the unsure pixels of an entry as one block of rays, and sets the bits of the lit ones.
void traceEntry(const RayScene& rays, const GBuffer& gbuffer, const Light& light, std::size_t tile,
                std::span<uint> words) {
  std::array<ShadowRay, kTilePixels> block;
  std::array<std::uint8_t, kTilePixels> blocked, pixels;
  std::size_t count = 0;
  for (std::size_t word = 0; word < kHalf; ++word) {
    for (uint left = words[kHalf + word]; left != 0; left &= left - 1) {
      const std::size_t pixel = word * 32 + std::size_t(std::countr_zero(left));
      block[count] = shadowRay(light, shadowStart(gbuffer, tile * kTilePixels + pixel));
      pixels[count++] = std::uint8_t(pixel);
    }
  }
  areBlocked(rays, std::span(block).first(count), std::span(blocked).first(count));
  for (std::size_t i = 0; i < count; ++i)
    if (!blocked[i]) words[pixels[i] / 32] |= 1u << pixels[i] % 32;
}

}  // namespace

std::uint64_t traceUnsure(Device& device, const Scene& scene, const RayScene& rays, const GBuffer& gbuffer,
                          std::span<const std::uint32_t> order, const LightLists& lists, PairBits& bits) {
  const std::size_t tiles = gbuffer.pixels() / kTilePixels;
  std::vector<uint> starts(tiles + 1);
  std::vector<ListEntry> list(lists.entries);
  if (lists.tiles > 0) {
    download(device, lists.starts, starts);
    download(device, lists.list, list);
  }
  std::vector<std::uint64_t> unsure(tiles);
  tbb::parallel_for(std::size_t(0), tiles, [&](std::size_t tile) {
    const bool lists_all = lists.tiles == 0;
    const std::size_t first = lists_all ? tile * order.size() : starts[tile];
    const std::size_t end = lists_all ? first + order.size() : starts[tile + 1];
    for (std::size_t entry = first; entry < end; ++entry) {
      const Light& light = scene.lights[order[lists_all ? entry - first : list[entry].light]];
      const auto words = std::span(bits).subspan(entry * kPairWords, kPairWords);
      std::uint64_t count = 0;
      for (std::size_t word = kHalf; word < kPairWords; ++word)
        count += std::uint64_t(std::popcount(words[word]));
      if (count > 0) traceEntry(rays, gbuffer, light, tile, words);
      unsure[tile] += count;
    }
  });
  return std::accumulate(unsure.begin(), unsure.end(), std::uint64_t(0));
}

}  // namespace luciole
