#include "shadow/maps/draw_shadow_maps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "shadow/maps/shadow_scenes.hpp"
#include "shadow/maps/texel_place.hpp"

namespace luciole::test {
namespace {

TEST(DrawShadowMaps, AllThatWasPlannedFitsWhenDrawn) {
  const Scene scene = thousandLamps();
  ShadowMaps maps = planFor(scene, {1920, 1080}, {.bytes = std::size_t(16) << 20});
  drawNeeded(scene, everything(maps), maps);
  EXPECT_EQ(maps.texels.size(), maps.planned_texels);
}

/// What was drawn of some faces is what all of them drawn show, as far away as it was asked for; beyond it
/// there may be anything or nothing beyond it. Returns how many texels were compared.
std::size_t expectSameTexels(const ShadowMaps& some, const ShadowMaps& all) {
  std::size_t compared = 0;
  for (std::size_t f = 0; f < some.planned.size(); ++f) {
    const int size = some.planned[f].view.size.x;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const float down_to = drawnDownTo(some, f, {x, y});
        if (!std::isfinite(down_to)) continue;
        const ShadowTexel a = texelOf(some, f, x, y), b = texelOf(all, f, x, y);
        if (b.depth < down_to) {
          EXPECT_LT(a.depth, down_to) << "face " << f << " at " << x << ',' << y;
        } else {
          EXPECT_EQ(a.depth, b.depth) << "face " << f << " at " << x << ',' << y;
          EXPECT_EQ(a.slopes, b.slopes) << "face " << f << " at " << x << ',' << y;
          ++compared;
        }
        if (testing::Test::HasFailure()) return 0;
      }
  }
  return compared;
}

TEST(DrawShadowMaps, TexelsAreTheSameHoweverMuchIsDrawn) {
  const Scene scene = terrainScene();
  ShadowMaps all = planFor(scene, {200, 100}, {.size = 500}), some = all;  // not of whole bins
  drawNeeded(scene, everything(all), all);
  EXPECT_EQ(all.texels.size(), all.planned_texels);
  // Depths that are there, to ask for.
  std::vector<float> depths;
  for (std::size_t i = 0; i < all.texels.size(); i += 97)
    if (all.texels[i].depth > 0) depths.push_back(all.texels[i].depth);
  std::mt19937 random(31);
  std::size_t compared = 0;
  for (int round = 0; round < 12; ++round) {
    std::vector<std::uint32_t> needed = nothing(some);
    for (std::uint32_t& bin : needed) {
      if (random() % 8 != 0) continue;
      bin = random() % 2 ? 0u : std::bit_cast<std::uint32_t>(depths[random() % depths.size()]);
    }
    drawNeeded(scene, needed, some);
    ASSERT_LE(some.texels.size(), some.planned_texels);
    for (std::size_t f = 0; f < some.faces.size(); ++f)
      for (std::size_t bin = 0; bin < some.planned[f].farthest.size(); ++bin) {
        const std::uint32_t asked = needed[some.faces[f].first_bin + bin];
        if (asked != kNotNeeded) {
          EXPECT_LE(some.planned[f].farthest[bin], std::bit_cast<float>(asked)) << "face " << f;
        }
      }
    compared = expectSameTexels(some, all);
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
  EXPECT_GT(compared, all.texels.size() / 4);
}

TEST(DrawShadowMaps, ACopyOfWhatWasDrawnStaysUpToDate) {
  const Scene scene = terrainScene();
  ShadowMaps maps = planFor(scene, {200, 100}, {.size = 500});
  std::vector<ShadowTexel> copy;
  std::mt19937 random(31);
  for (int round = 0; round < 12; ++round) {
    std::vector<std::uint32_t> needed = nothing(maps);
    for (std::uint32_t& bin : needed)
      if (random() % 8 == 0) bin = 0;
    const std::vector<IndexRange> drawn = drawNeeded(scene, needed, maps);
    copy.resize(maps.texels.size());
    for (const IndexRange& range : drawn) {
      for (std::size_t row = 0; row < range.rows; ++row) {
        const std::size_t first = range.first + row * range.pitch;
        ASSERT_LE(first + range.count, copy.size());
        std::copy_n(maps.texels.data() + first, range.count, copy.data() + first);
      }
    }
    ASSERT_EQ(std::memcmp(copy.data(), maps.texels.data(), copy.size() * sizeof(ShadowTexel)), 0)
        << "round " << round;
  }
}

TEST(DrawShadowMaps, ABinInsideItsFacesRectangleIsToldByItself) {
  const Scene scene = terrainScene();
  ShadowMaps maps = planFor(scene, {200, 100}, {.size = 512});
  std::vector<std::uint32_t> needed = nothing(maps);
  const auto bin = [&](uint x, uint y) -> std::uint32_t& {
    return needed.at(maps.faces[2].first_bin + y * maps.faces[2].bins + x);
  };
  bin(1, 1) = bin(3, 2) = 0;
  drawNeeded(scene, needed, maps);
  EXPECT_TRUE(drawNeeded(scene, needed, maps).empty()) << "what is there already";
  bin(2, 2) = 0;
  const std::vector<IndexRange> drawn = drawNeeded(scene, needed, maps);
  ASSERT_EQ(drawn.size(), 1u);
  const std::size_t width = 3 * kShadowBin;
  EXPECT_EQ(drawn[0].first, kShadowBin * width + kShadowBin);
  EXPECT_EQ(drawn[0].count, std::size_t(kShadowBin));
  EXPECT_EQ(drawn[0].rows, std::size_t(kShadowBin));
  EXPECT_EQ(drawn[0].pitch, width);
}

TEST(DrawShadowMaps, OnlyNeededBinsAreDrawnAndOnlyOnce) {
  const Scene scene = terrainScene();
  ShadowMaps maps = planFor(scene, {200, 100}, {.size = 512});
  std::vector<std::uint32_t> needed = nothing(maps);
  drawNeeded(scene, needed, maps);
  EXPECT_TRUE(maps.texels.empty());
  // One bin of one face, and two that aren't neighbours of another: the rectangle around them.
  const auto bin = [&](std::size_t face, uint x, uint y) -> std::uint32_t& {
    return needed.at(maps.faces[face].first_bin + y * maps.faces[face].bins + x);
  };
  bin(1, 2, 3) = 0;
  bin(2, 1, 1) = 0;
  bin(2, 3, 2) = 0;
  drawNeeded(scene, needed, maps);
  constexpr std::size_t kBin = kShadowBin * kShadowBin;
  EXPECT_EQ(maps.texels.size(), (1 + 3 * 2) * kBin);
  for (std::size_t f = 0; f < maps.planned.size(); ++f) {
    EXPECT_EQ(maps.faces[f].width, f == 1 ? 64u : f == 2 ? 192u : 0u) << "face " << f;
    EXPECT_EQ(maps.planned[f].count.x > 0, f == 1 || f == 2) << "face " << f;
    for (const float farthest : maps.planned[f].farthest)
      EXPECT_TRUE(farthest == 0 || std::isinf(farthest)) << "face " << f;
  }
  EXPECT_EQ(std::count(maps.planned[2].farthest.begin(), maps.planned[2].farthest.end(), 0.0f), 2);
  // What is there already, and a part of it: what memory holds isn't touched.
  const std::vector<ShadowFace> before = maps.faces;
  for (ShadowTexel& texel : maps.texels) texel = {0.25f, 7};
  drawNeeded(scene, needed, maps);
  bin(1, 2, 3) = std::bit_cast<std::uint32_t>(0.5f);
  bin(2, 1, 1) = kNotNeeded;
  drawNeeded(scene, needed, maps);
  EXPECT_EQ(maps.texels.size(), (1 + 3 * 2) * kBin);
  EXPECT_TRUE(sameBits(maps.faces, before));
  for (const ShadowTexel& texel : maps.texels) ASSERT_TRUE(texel.depth == 0.25f && texel.slopes == 7);
}

TEST(DrawShadowMaps, WhereMoreIsExpectedLookupsALittleDeeperAndFartherFindWhatTheyNeed) {
  const Scene scene = terrainScene();
  ShadowMaps maps = planFor(scene, {200, 100}, {.size = 512});
  maps.expects_more = true;
  std::vector<std::uint32_t> needed = nothing(maps);
  const auto bin = [&](uint x, uint y) -> std::uint32_t& {
    return needed.at(maps.faces[2].first_bin + y * maps.faces[2].bins + x);
  };
  bin(2, 2) = std::bit_cast<std::uint32_t>(0.5f);
  drawNeeded(scene, needed, maps);
  bin(2, 2) = std::bit_cast<std::uint32_t>(0.25f);
  EXPECT_TRUE(drawNeeded(scene, needed, maps).empty());
  const std::size_t held = maps.texels.size();
  bin(3, 1) = std::bit_cast<std::uint32_t>(0.5f);
  EXPECT_EQ(drawNeeded(scene, needed, maps).size(), 1u);
  EXPECT_EQ(maps.texels.size(), held) << "the rectangle had room for it";
}

TEST(DrawShadowMaps, AFaceThatGrowsTakesItsTexelsAlong) {
  const Scene scene = terrainScene();
  ShadowMaps maps = planFor(scene, {200, 100}, {.size = 512});
  std::vector<std::uint32_t> needed = nothing(maps);
  const auto bin = [&](uint x, uint y) -> std::uint32_t& {
    return needed.at(maps.faces[2].first_bin + y * maps.faces[2].bins + x);
  };
  bin(2, 2) = 0;
  drawNeeded(scene, needed, maps);
  for (ShadowTexel& texel : maps.texels) texel = {0.25f, 7};
  bin(1, 3) = 0;
  drawNeeded(scene, needed, maps);
  ASSERT_EQ(maps.planned[2].first, glm::ivec2(kShadowBin, 2 * kShadowBin));
  for (int y = 0; y < kShadowBin; ++y)
    for (int x = 0; x < kShadowBin; ++x) {
      const uint place =
          maps.faces[2].first + uint(2 * kShadowBin + y) * maps.faces[2].width + uint(2 * kShadowBin + x);
      ASSERT_EQ(maps.texels[place].slopes, 7u) << x << ',' << y;
    }
}

TEST(DrawShadowMaps, FloorThatIsWideBeyondMeasureIsDrawn) {
  // Where a face's rim sees it, 10¹¹ m away, is a place of 10¹⁴ texels.
  Scene scene = terrainScene();
  scene.lights = {scene.lights[2]};
  scene.lights.front().position = {0, 1e-3, 0};
  scene.lights.front().range = 1.0f;
  scene.objects.resize(1);
  scene.objects.front().object_to_world = glm::scale(glm::dmat4(1), glm::dvec3(1e11));
  ShadowMaps maps = planFor(scene);
  drawNeeded(scene, everything(maps), maps);
  std::size_t drawn = 0;
  const std::size_t area = maps.texels.size() / 6;
  for (std::size_t i = 0; i < area; ++i) drawn += maps.texels[3 * area + i].depth > 0;  // −y
  EXPECT_EQ(drawn, area);
}

TEST(DrawShadowMaps, WhatIsBeyondALightsRangeCastsNothing) {
  // Lamps whose range ends below, and above, a slab that hangs between them and the floor.
  Scene scene = terrainScene();
  scene.lights = {scene.lights[2]};
  scene.lights.front().position = {0, 4, 0};
  for (const float range : {2.0f, 40.0f}) {
    scene.lights.front().range = range;
    ShadowMaps maps = planFor(scene);
    drawNeeded(scene, everything(maps), maps);
    std::size_t drawn = 0;
    for (const ShadowTexel& texel : maps.texels) drawn += texel.depth > 0;
    EXPECT_EQ(drawn > 0, range > 10) << range;
  }
}

}  // namespace
}  // namespace luciole::test
