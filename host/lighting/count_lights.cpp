#include "lighting/count_lights.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "kernels/shared.h"
#include "lights/count_in_range.hpp"

namespace luciole {
namespace {

/// The index, among all tiles' squares, of the square that holds the pixel at a place in the planes.
std::size_t squareOf(std::size_t place) {
  return place / kTilePixels * kSquaresPerTile + SQUARE_OF_PIXEL(place);
}

/// For each square the number of lights in its list, or without lists of all lights, for which `counts` is
/// true.
template <class Predicate>
std::vector<std::uint32_t> squareLengths(const StageInput& input, Predicate&& counts) {
  const RawArray<ShadeLight>& lights = input.pass.lights.lights;
  const LightLists& lists = input.lists;
  const std::size_t tiles = input.points.stride / kTilePixels;
  if (lists.tiles == 0)
    return std::vector<std::uint32_t>(tiles * kSquaresPerTile,
                                      std::uint32_t(std::count_if(lights.begin(), lights.end(), counts)));
  std::vector<std::uint32_t> lengths(tiles * kSquaresPerTile);
  std::vector<uint> starts(lists.tiles + 1);
  std::vector<ListEntry> entries(lists.entries);
  download(input.device, lists.starts, starts);
  download(input.device, lists.list, entries);
  for (std::size_t tile = 0; tile < tiles; ++tile)
    for (std::size_t entry = starts[tile]; entry < starts[tile + 1]; ++entry)
      for (int square = 0; square < kSquaresPerTile && counts(lights[entries[entry].light]); ++square)
        lengths[tile * kSquaresPerTile + square] += entries[entry].squares >> square & 1;
  return lengths;
}

/// Number of pixel-light pairs that the shade kernel computes: a row of lanes with a covered pixel goes
/// through the lights of its square in all its lanes.
std::uint64_t evaluatedPairs(const GBuffer& gbuffer, const std::vector<std::uint32_t>& square_lengths,
                             int lanes) {
  const float* depth = gbuffer.position.data() + 2 * gbuffer.pixels();
  std::uint64_t pairs = 0;
  for (std::size_t row = 0; row < gbuffer.pixels(); row += lanes) {
    bool covered = false;
    for (int lane = 0; lane < lanes; ++lane)
      covered |= depth[row + lane] > -std::numeric_limits<float>::infinity();
    if (covered) pairs += std::uint64_t(lanes) * square_lengths[squareOf(row)];
  }
  return pairs;
}

/// How many lights have each pixel in their range.
Plane lightsInRange(const StageInput& input, LightLists& lists) {
  const LightSet& lights = input.pass.lights;
  cull(input.device, cullArguments(input.points, lights, input.lighting.group_log2, kByRange), lists);
  Plane result(input.points.stride);
  const Buffer<float> counts = borrowedForOutput(input.device, result);
  countInRange(input.device, {.position = input.points.buffers.position,
                              .plane_stride = input.points.stride,
                              .lights = lights.light_buffer,
                              .lists = lists,
                              .counts = counts});
  download(input.device, counts, result);
  return result;
}

}  // namespace

void countLights(const StageInput& input, const PixelCounts& counts, LightLists& in_range, LitPlanes& lit) {
  if (counts.in_range) lit.light_count = lightsInRange(input, in_range);
  if (!counts.evaluated && !counts.list_length) return;
  const auto lengthsOf = [&](auto&& counted) { return squareLengths(input, counted); };
  const std::vector<std::uint32_t> square_lengths = lengthsOf([](const ShadeLight&) { return true; });
  if (counts.evaluated) {
    const auto pairsOf = [&](const std::vector<std::uint32_t>& lengths) {
      return evaluatedPairs(input.pass.gbuffer, lengths, input.device.description.lanes);
    };
    lit.evaluated = pairsOf(square_lengths);
    if (input.lighting.features.has(Feature::kExact))
      lit.by_beams = pairsOf(lengthsOf([](const ShadeLight& light) { return light.shadow == kExactShadow; }));
    if (input.lighting.features.shadowMaps())
      lit.by_maps = pairsOf(lengthsOf([](const ShadeLight& light) { return light.shadow < kExactShadow; }));
  }
  if (!counts.list_length) return;
  lit.list_length.resize(input.points.stride);
  for (std::size_t i = 0; i < lit.list_length.size(); ++i)
    lit.list_length[i] = float(square_lengths[squareOf(i)]);
}

}  // namespace luciole
