#include "image/exposure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace luciole {
namespace {

/// A colour's luminance is put at the middle of its bin, 1/128 of an octave's lower end wide: log2(1 + 1/256)
/// stops off at most. Then the stops are rounded to hundredths.
const double kCoarseness = std::log2(1 + 1.0 / 256) + 0.005 + 1e-9;

std::vector<glm::vec3> greys(std::size_t count, float grey) {
  return std::vector<glm::vec3>(count, glm::vec3(grey));
}

/// Colours whose luminances spread over about 12 stops.
std::vector<glm::vec3> manyColors(std::size_t count) {
  std::mt19937 random(7);
  std::normal_distribution<float> stops(-3, 2), tint(0, 0.3f);
  std::vector<glm::vec3> colors;
  for (std::size_t i = 0; i < count; ++i) {
    const float s = stops(random);
    colors.emplace_back(std::exp2(s + tint(random)), std::exp2(s + tint(random)),
                        std::exp2(s + tint(random)));
  }
  return colors;
}

TEST(SuitableExposure, BringsGreyToMiddleGrey) {
  for (const float grey : {1e-6f, 0.01f, 0.18f, 0.5f, 1.0f, 37.0f, 1e9f})
    EXPECT_NEAR(suitableExposure(greys(100, grey)), std::log2(0.18 / double(grey)), kCoarseness) << grey;
}

TEST(SuitableExposure, IsTheLogarithmicMeanOfAllButATenthAtEachEnd) {
  for (const std::size_t count : {1u, 9u, 10u, 1000u, 4999u}) {
    const std::vector<glm::vec3> colors = manyColors(count);
    std::vector<double> luminances;
    for (const glm::vec3& c : colors) luminances.push_back(0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b);
    std::sort(luminances.begin(), luminances.end());
    double sum = 0;
    const std::size_t first = count / 10;
    for (std::size_t i = first; i < count - first; ++i) sum += std::log2(luminances[i]);
    EXPECT_NEAR(suitableExposure(colors), std::log2(0.18) - sum / double(count - 2 * first), kCoarseness);
  }
}

TEST(SuitableExposure, IsInHundredthsOfAStop) {
  for (const std::size_t count : {1u, 50u, 777u}) {
    const double hundredths = 100 * suitableExposure(manyColors(count));
    // A hundredth is no binary fraction: 100 times the nearest double is off by its own rounding.
    EXPECT_NEAR(hundredths, std::round(hundredths), 1e-12 * std::abs(hundredths));
  }
}

TEST(SuitableExposure, DoesNotDependOnTheOrder) {
  std::vector<glm::vec3> colors = manyColors(3000);
  const double stops = suitableExposure(colors);
  std::mt19937 random(11);
  for (int i = 0; i < 5; ++i) {
    std::shuffle(colors.begin(), colors.end(), random);
    EXPECT_EQ(suitableExposure(colors), stops);
  }
}

TEST(SuitableExposure, FallsByAStopWhereLightDoubles) {
  std::vector<glm::vec3> colors = manyColors(3000);
  const double stops = suitableExposure(colors);
  for (glm::vec3& color : colors) color *= 2.0f;
  // Every colour moves by exactly an octave of bins; what remains is the rounding of sums of 3000.
  EXPECT_NEAR(suitableExposure(colors), stops - 1, 1e-9);
}

TEST(SuitableExposure, FewSparksAndFewNearlyBlackPixelsChangeNothingAndManyDo) {
  for (const float outlier : {1e30f, 1e-30f}) {
    std::vector<glm::vec3> few = greys(91, 0.3f), many = greys(80, 0.3f);
    few.resize(100, glm::vec3(outlier));
    many.resize(100, glm::vec3(outlier));
    EXPECT_EQ(suitableExposure(few), suitableExposure(greys(100, 0.3f)));
    EXPECT_GT(std::abs(suitableExposure(many) - suitableExposure(greys(100, 0.3f))), 1);
  }
}

TEST(SuitableExposure, BlackDoesNotCount) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const glm::vec3& black : {glm::vec3(0), glm::vec3(-1), glm::vec3(0.3f, nan, 0.3f)}) {
    std::vector<glm::vec3> colors = greys(10, 0.3f);
    colors.resize(1000, black);
    EXPECT_EQ(suitableExposure(colors), suitableExposure(greys(10, 0.3f)));
    EXPECT_EQ(suitableExposure(std::vector<glm::vec3>(100, black)), 0);
  }
  EXPECT_EQ(suitableExposure({}), 0);
}

TEST(SuitableExposure, StaysWithinWhatTheOptionTakes) {
  constexpr float kLargest = std::numeric_limits<float>::max(),
                  kInfinite = std::numeric_limits<float>::infinity();
  EXPECT_EQ(suitableExposure(greys(9, kLargest)), -100);
  EXPECT_EQ(suitableExposure(greys(9, kInfinite)), -100);
  EXPECT_EQ(suitableExposure(greys(9, std::numeric_limits<float>::min())), 100);
  EXPECT_EQ(suitableExposure(greys(9, std::numeric_limits<float>::denorm_min())), 100);
  EXPECT_FALSE(std::signbit(suitableExposure(greys(9, 0.1802f))));
}

TEST(MeasuringSize, KeepsTheShapeAndIsSmall) {
  EXPECT_EQ(measuringSize({96, 54}), glm::ivec2(96, 54));
  EXPECT_EQ(measuringSize({1280, 720}), glm::ivec2(256, 144));
  EXPECT_EQ(measuringSize({480, 270}), measuringSize({3840, 2160}));
  EXPECT_EQ(measuringSize({720, 1280}), glm::ivec2(144, 256));
  EXPECT_EQ(measuringSize({32768, 1}), glm::ivec2(256, 1));
}

TEST(Expose, MultipliesColoursAloneAndStaysFinite) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  Image image{2, 1, {"R", "G", "B", "Z"}, {0.25f, 1, kLargest, 5, -kLargest, 0, 3, 6}};
  expose(image, 2);
  EXPECT_EQ(image.pixels, (std::vector<float>{1, 4, kLargest, 5, -kLargest, 0, 12, 6}));
}

}  // namespace
}  // namespace luciole
