#include "tools/figures/kept_bounds.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace luciole::test {
namespace {

/// A row of pixels, each with the same colour and bound in all channels, behind a layer of something else.
Image rowOf(const std::vector<std::pair<float, float>>& colors_and_bounds) {
  Image picture{int(colors_and_bounds.size()),
                1,
                {"R", "G", "B", "list_length", "light_error.R", "light_error.G", "light_error.B"},
                {}};
  for (const auto& [color, bound] : colors_and_bounds)
    picture.pixels.insert(picture.pixels.end(), {color, color, color, 99, bound, bound, bound});
  return picture;
}

TEST(KeptBounds, AreSharesOfTheLargerOfOneAndTheColor) {
  const Image picture = rowOf({{0.5f, 0.25f}, {4.0f, 0.5f}, {0.0f, 0.0f}});
  const std::vector<glm::ivec2> pixels{{0, 0}, {1, 0}};
  const std::vector<glm::dvec3> truth{glm::dvec3(0.625), glm::dvec3(4.5, 4.0, 4.0)};
  const KeptBounds kept = measureBounds(picture, 0, pixels, truth);
  EXPECT_EQ(kept.max_bound, 0.25);
  EXPECT_EQ(kept.mean_bound, (0.25 + 0.5 / 4) / 2) << "the last pixel shows no surface";
  EXPECT_EQ(kept.max_error, 0.125);
  EXPECT_EQ(kept.mean_error, (3 * 0.125 + 0.5 / 4) / 6);
  EXPECT_EQ(kept.max_used, 1);
  EXPECT_EQ(kept.mean_used, (3 * 0.5 + 1) / 6);
  EXPECT_EQ(kept.values, 6u);
  EXPECT_EQ(kept.violations, 0u) << "a bound may be used up";
}

TEST(KeptBounds, AreSharesBeforeExposure) {
  // A stop brighter: 2 is what was 1.
  const KeptBounds kept =
      measureBounds(rowOf({{1.0f, 0.5f}}), 1, std::vector{glm::ivec2(0)}, std::vector{glm::dvec3(0.75)});
  EXPECT_EQ(kept.max_bound, 0.25);
  EXPECT_EQ(kept.max_error, 0.125);
  EXPECT_EQ(kept.max_used, 0.5);
}

TEST(KeptBounds, CountEachChannelThatIsWrongByMoreAndWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<glm::ivec2> pixels{{0, 0}, {1, 0}, {2, 0}};
  const std::vector<glm::dvec3> truth{glm::dvec3(0.5, 0.7501, 0.2499), glm::dvec3(nan, 1, 1), glm::dvec3(9)};
  const KeptBounds kept = measureBounds(rowOf({{0.5f, 0.25f}, {1.0f, 0.5f}, {0.0f, 0.0f}}), 0, pixels, truth);
  EXPECT_EQ(kept.violations, 3u);
  EXPECT_EQ(kept.values, 6u);
  EXPECT_GT(kept.max_used, 1);
}

TEST(KeptBounds, APixelIsWithinByTheChannelOfTheMostLight) {
  const std::vector<glm::ivec2> pixels{{0, 0}, {1, 0}, {2, 0}};
  const std::vector<glm::dvec3> truth{{0.5, 0.75, 0.1}, {0.1, 0.5, 0.8}, glm::dvec3(9)};
  const KeptBounds kept =
      measureBounds(rowOf({{0.5f, 0.25f}, {0.5f, 0.25f}, {0.0f, 0.0f}}), 0, pixels, truth);
  EXPECT_EQ(kept.held, 0.5) << "of two that show something";
  EXPECT_EQ(kept.violations, 3u);
}

/// Of 1000 pixels.
KeptBounds heldBy(double held, double confidence, std::uint64_t violations) {
  return {.values = 3000, .violations = violations, .held = held, .confidence = confidence};
}

TEST(KeptBounds, WhatIsProvenIsBrokenByOneValueAndAConfidenceByMoreThanChance) {
  EXPECT_EQ(brokenPromise(heldBy(1, 1, 0)), "");
  EXPECT_EQ(brokenPromise(heldBy(1, 1, 1)), "1 of 3000 values are wrong by more than their bounds");
  EXPECT_EQ(brokenPromise(heldBy(0.985, 0.99, 50)), "");
  EXPECT_EQ(brokenPromise(heldBy(0.95, 0.99, 150)),
            "95.00 % of 1000 pixels are within intervals that shall hold for 99 %");
  EXPECT_EQ(brokenPromise(heldBy(0.45, 0.5, 1650)), "");
  EXPECT_NE(brokenPromise(heldBy(0.1, 0.5, 2700)), "");
  // One pixel in 10,000 is expected: some in 1000 are bad luck, and ten no luck.
  EXPECT_EQ(brokenPromise(heldBy(0.998, 0.9999, 6)), "");
  EXPECT_NE(brokenPromise(heldBy(0.99, 0.9999, 30)), "");
}

TEST(KeptBounds, ATruthBeyondTheLargestFloatEndsThere) {
  const float most = std::numeric_limits<float>::max();
  const KeptBounds kept =
      measureBounds(rowOf({{most, 1.0f}}), 0, std::vector{glm::ivec2(0)}, std::vector{glm::dvec3(1e300)});
  EXPECT_EQ(kept.violations, 0u);
  EXPECT_EQ(kept.max_error, 0);
}

TEST(KeptBounds, OfAPictureWithoutSurfacesAreNone) {
  const KeptBounds kept =
      measureBounds(rowOf({{0.5f, 0.0f}}), 0, std::vector{glm::ivec2(0)}, std::vector{glm::dvec3(0.5)});
  EXPECT_EQ(kept.max_bound, 0);
  EXPECT_EQ(kept.mean_bound, 0);
  EXPECT_EQ(kept.mean_used, 0);
  EXPECT_EQ(kept.values, 0u);
}

}  // namespace
}  // namespace luciole::test
