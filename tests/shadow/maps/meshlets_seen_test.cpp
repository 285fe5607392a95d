#include "shadow/maps/meshlets_seen.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "raster/rasterize.hpp"
#include "shadow/maps/shadow_scenes.hpp"

namespace luciole::test {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

/// What the crop of a face shows of some meshlets.
std::vector<ShadowTexel> drawn(const Scene& scene, const Meshlets& meshlets, const View& view,
                               const std::vector<std::uint32_t>& chosen) {
  std::vector<ShadowTexel> texels(std::size_t(view.crop_size.x) * view.crop_size.y);
  rasterizeDepth(scene, meshlets, chosen, view, {}, texels);
  return texels;
}

TEST(MeshletsSeen, WhatIsLeftOutDoesNotShowInTheCrop) {
  const Scene scene = terrainScene();
  const ShadowMaps maps = planFor(scene);
  std::size_t left_out = 0;
  for (const PlannedFace& face : maps.planned) {
    Light light = scene.lights[face.light];
    light.range = std::numeric_limits<float>::infinity();  // in rasterizeDepth lights have none
    View view = face.view;
    view.crop_origin = {kBinSize, 0};
    view.crop_size = glm::min(view.size - view.crop_origin, glm::ivec2(kBinSize, 2 * kBinSize));
    if (view.crop_size.x <= 0) continue;
    WantedBins bins{binGrid(view), {}};
    bins.farthest.assign(bins.size(), 0.0f);
    const std::vector<std::uint32_t> seen = meshletsSeen(maps.meshlets, view, bins, light);
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    left_out += maps.meshlets.items.size() - seen.size();
    EXPECT_TRUE(sameBits(drawn(scene, maps.meshlets, view, seen),
                         drawn(scene, maps.meshlets, view, allMeshlets(maps.meshlets))));
  }
  EXPECT_GT(left_out, maps.meshlets.items.size());
}

TEST(MeshletsSeen, NothingMattersWhereNoBinIsWanted) {
  const Scene scene = terrainScene();
  const ShadowMaps maps = planFor(scene);
  const PlannedFace& cascade = maps.planned.front();
  WantedBins bins{binGrid(cascade.view), {}};
  bins.farthest.assign(bins.size(), kNever);
  EXPECT_TRUE(meshletsSeen(maps.meshlets, cascade.view, bins, scene.lights[cascade.light]).empty());
}

TEST(MeshletsSeen, NothingBeyondALightsRangeMatters) {
  const Scene scene = terrainScene();
  const ShadowMaps maps = planFor(scene);
  const PlannedFace& spot = maps.planned.back();
  Light light = scene.lights[spot.light];
  light.range = 1.0f;  // it hangs 4 m high
  WantedBins bins{binGrid(spot.view), {}};
  bins.farthest.assign(bins.size(), 0.0f);
  EXPECT_TRUE(meshletsSeen(maps.meshlets, spot.view, bins, light).empty());
}

}  // namespace
}  // namespace luciole::test
