#include "image/heat_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <vector>

#include "image/srgb.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

using Codes = std::array<int, 3>;  ///< sRGB of 8 bits, as a viewer shows it

constexpr Codes kLowest{68, 1, 84}, kHighest{253, 231, 37};  // viridis's ends
constexpr Codes kBlack{0, 0, 0}, kWhite{255, 255, 255}, kRed{255, 0, 0};

ImageDifference differences(int width, int height, const std::vector<double>& of_pixel) {
  ImageDifference d;
  d.width = width;
  d.height = height;
  d.of_pixel = of_pixel;
  return d;
}

Codes codesAt(const Image& map, int x, int y) {
  Codes codes{};
  for (int c = 0; c < 3; ++c)
    codes[c] = int(std::lround(255 * encodeSrgb(map.pixels[(std::size_t(y) * map.width + x) * 3 + c])));
  return codes;
}

/// The map of one row of a few pixels, seen at the middle of each: a row of them fills a width of 480.
std::vector<Codes> colorsOf(const std::vector<double>& of_pixel) {
  const int count = int(of_pixel.size());
  const Image map = errorMap(differences(count, 1, of_pixel));
  const int side = 480 / count;
  std::vector<Codes> colors;
  for (int i = 0; i < count; ++i) colors.push_back(codesAt(map, i * side + side / 2, side / 2));
  return colors;
}

/// Where the scale bar lies: its first and last column, and its rows.
struct Bar {
  int left = -1, right = -1, top = -1, bottom = -1;
};
Bar barUnder(const Image& map, int picture_bottom) {
  Bar bar;
  for (int y = picture_bottom; y < map.height; ++y) {
    int left = -1, right = -1;
    for (int x = 0; x < map.width; ++x) {
      if (left < 0 && codesAt(map, x, y) == kLowest) left = x;
      if (codesAt(map, x, y) == kHighest) right = x;
    }
    if (left < 0 || right < 0) continue;
    if (bar.top < 0) bar = {left, right, y, y};
    bar.bottom = y;
  }
  return bar;
}

TEST(ErrorMap, DifferencesHaveViridisColorsByTheirLogarithm) {
  const std::vector<Codes> colors = colorsOf({1e-6, 1e-3, 1.0, 1e-9});
  EXPECT_EQ(colors[0], kLowest);
  EXPECT_EQ(colors[2], kHighest);
  EXPECT_EQ(colors[3], kLowest) << "six decades at most, and smaller ones as the lowest";
  // The middle lies between two entries of viridis's table, which are a code apart, and is rounded.
  const Codes middle{33, 145, 140};
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(colors[1][c], middle[c], 2) << c;
}

TEST(ErrorMap, TheScaleIsOfWholeDecadesAroundTheDifferences) {
  // From 10⁻⁶ to 10⁻², and the same shape a thousand times smaller. A logarithm's rounding can move a colour
  // by far less than a code, so by one at most once it is rounded.
  const std::vector<Codes> large = colorsOf({2e-6, 1e-4, 3e-4, 9e-3}),
                           small = colorsOf({2e-9, 1e-7, 3e-7, 9e-6});
  for (std::size_t i = 0; i < large.size(); ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(large[i][c], small[i][c], 1);
  }
  const std::vector<Codes> alone = colorsOf({2e-4});
  EXPECT_NE(alone[0], kLowest);
  EXPECT_NE(alone[0], kHighest);
}

TEST(ErrorMap, WhatHasNoPlaceOnTheScaleHasAColorOfItsOwn) {
  const std::vector<Codes> colors = colorsOf({0.0, kNotCompared, HUGE_VAL, 0.5});
  EXPECT_EQ(colors[0], kBlack);
  EXPECT_EQ(colors[2], kRed);
  EXPECT_EQ(colors[1][0], colors[1][1]);
  EXPECT_EQ(colors[1][1], colors[1][2]);
  EXPECT_GT(colors[1][0], 40);
  EXPECT_LT(colors[1][0], 90);
}

TEST(ErrorMap, EqualPicturesAreBlack) {
  for (const Codes& color : colorsOf({0, 0, 0, 0})) EXPECT_EQ(color, kBlack);
}

TEST(ErrorMap, SmallPicturesAreEnlargedByWholeFactors) {
  std::vector<double> checkers;
  for (int i = 0; i < 35; ++i) checkers.push_back(i % 2);
  const Image map = errorMap(differences(5, 7, checkers));
  // 480 / 7 is 68: a picture of 340 × 476, in the middle of 480.
  for (int y = 0; y < 476; ++y) {
    for (int x = 0; x < 480; ++x) {
      const bool inside = x >= 70 && x < 410;
      const bool differs = inside && (y / 68 * 5 + (x - 70) / 68) % 2 == 1;
      ASSERT_EQ(codesAt(map, x, y), !inside ? kWhite : differs ? kHighest : kBlack) << x << " " << y;
    }
  }
}

TEST(ErrorMap, WidePicturesFillTheMapsWidth) {
  for (const auto& [width, map_width] : {std::pair(320, 640), {479, 958}, {480, 480}, {481, 481}, {100, 500}})
    EXPECT_EQ(errorMap(differences(width, 2, std::vector<double>(std::size_t(width) * 2))).width, map_width);
}

TEST(ErrorMap, LargePicturesKeepTheirPixels) {
  std::vector<double> of_pixel(640 * 3);
  of_pixel[640 + 17] = 1.0;
  const Image map = errorMap(differences(640, 3, of_pixel));
  EXPECT_EQ(map.width, 640);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 640; ++x) ASSERT_EQ(codesAt(map, x, y), x == 17 && y == 1 ? kHighest : kBlack);
  }
}

TEST(ErrorMap, AScaleBarLiesUnderPicturesOfAnySize) {
  const std::vector<std::array<int, 3>> sizes{
      {1, 1, 480}, {16, 16, 480}, {7, 93, 465}, {700, 5, 5}, {3, 700, 700}};
  for (const auto& [width, height, picture_bottom] : sizes) {
    const Image map = errorMap(differences(width, height, std::vector<double>(std::size_t(width) * height)));
    const Bar bar = barUnder(map, picture_bottom);
    EXPECT_GT(bar.right - bar.left, map.width * 8 / 10) << width << " x " << height;
    EXPECT_GE(bar.bottom - bar.top, 12) << width << " x " << height;
    // Brighter and brighter towards the right, as viridis's green channel is.
    for (int x = bar.left; x < bar.right; ++x)
      ASSERT_LE(codesAt(map, x, bar.top)[1], codesAt(map, x + 1, bar.top)[1]) << x;
  }
}

TEST(ErrorMap, ATickMarksTheStepOfEightBits) {
  const Image map = errorMap(differences(2, 1, {1e-6, 1.0}));
  const Bar bar = barUnder(map, 240);
  const double expected = bar.left + (bar.right - bar.left) * (std::log10(1.0 / 255) + 6) / 6;
  int ink = 0;
  for (int x = 0; x < map.width; ++x) {
    if (codesAt(map, x, bar.top - 1) == kWhite) continue;
    ++ink;
    // Its width of a pixel or two, and the rounding of its place.
    EXPECT_NEAR(x, expected, 2.5);
  }
  EXPECT_GT(ink, 0);
}

TEST(ErrorMap, DecadesAreMarkedAndLabelled) {
  const Image map = errorMap(differences(2, 1, {1e-6, 1.0}));
  const Bar bar = barUnder(map, 240);
  int ticks = 0;
  for (int x = 1; x < map.width; ++x)
    ticks += codesAt(map, x, bar.bottom + 2) == kBlack && codesAt(map, x - 1, bar.bottom + 2) != kBlack;
  EXPECT_EQ(ticks, 7);
  // Below the ticks, 10 to 21 rows down, there is ink around each of the seven places and none between two.
  const auto inkIn = [&](int from, int to) {
    int ink = 0;
    for (int y = bar.bottom + 10; y < bar.bottom + 22; ++y) {
      for (int x = std::max(from, 0); x < std::min(to, map.width); ++x) ink += codesAt(map, x, y) != kWhite;
    }
    return ink;
  };
  const int decade = (bar.right - bar.left) / 6;
  for (int i = 0; i <= 6; ++i) {
    const int x = bar.left + decade * i;
    EXPECT_GT(inkIn(x - 6, x + 7), 0) << i;
    EXPECT_EQ(inkIn(x + decade / 2 - 3, x + decade / 2 + 4), 0) << i;
  }
}

/// The test's own folder in place of those where fonts are.
class FontFolder {
 public:
  FontFolder() {
    for (const char* name : {"XDG_DATA_DIRS", "XDG_DATA_HOME"}) setenv(name, folder_.path().c_str(), 1);
  }
  ~FontFolder() {
    for (const char* name : {"XDG_DATA_DIRS", "XDG_DATA_HOME"}) unsetenv(name);
  }
  std::filesystem::path fonts() const { return folder_.path() / "fonts"; }

 private:
  test::TemporaryFolder folder_;
};

TEST(ErrorMap, WithoutAFontThatCanBeReadItLacksOnlyItsLabels) {
  const ImageDifference difference = differences(2, 1, {1e-6, 1.0});
  const Image labelled = errorMap(difference);
  const FontFolder folder;
  for (const bool junk : {false, true}) {
    if (junk) {
      std::filesystem::create_directories(folder.fonts() / "truetype");
      std::ofstream(folder.fonts() / "truetype" / "DejaVuSans.ttf") << "not a font";
    }
    const Image map = errorMap(difference);
    ASSERT_EQ(map.width, labelled.width);
    ASSERT_EQ(map.height, labelled.height);
    const Bar bar = barUnder(map, 240);
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x)
        if (const Codes with = codesAt(labelled, x, y), without = codesAt(map, x, y); with != without) {
          ASSERT_TRUE(without == kWhite && y >= 240 && (y < bar.top || y > bar.bottom)) << x << " " << y;
        }
    EXPECT_EQ(codesAt(map, 0, 0), kLowest);
    EXPECT_EQ(barUnder(labelled, 240).left, bar.left);
  }
}

TEST(BoundMap, HasOneScaleForAllPicturesAndBlackWhereNothingIsBounded) {
  // 10⁻⁵ and less, 10⁻¹ and more, and whatever the others are.
  for (const float other : {1e-3f, 0.5f}) {
    const Image map = boundMap(4, 1, {1e-6f, 0.0f, 0.1f, other});
    EXPECT_EQ(codesAt(map, 60, 60), kLowest);
    EXPECT_EQ(codesAt(map, 180, 60), kBlack);
    EXPECT_EQ(codesAt(map, 300, 60), kHighest);
    EXPECT_EQ(codesAt(map, 420, 60) == kHighest, other > 0.1f);
  }
  EXPECT_GT(barUnder(boundMap(1, 1, {0.0f}), 480).right, 400);
}

TEST(ListMap, OneLightIsTheLowestColourAndThePowerOfTenAboveTheMostTheHighest) {
  const Image map = listMap(4, 1, {0, 1, 10, 100});
  EXPECT_EQ(codesAt(map, 60, 60), kBlack);
  EXPECT_EQ(codesAt(map, 180, 60), kLowest);
  EXPECT_EQ(codesAt(map, 420, 60), kHighest);
  // Half-way up the scale of viridis lies 33 145 140; OpenImageIO's table has 17 colours, between which it is
  // linear in light, so that a few codes differ.
  const Codes middle = codesAt(map, 300, 60);
  EXPECT_NEAR(middle[0], 33, 6);
  EXPECT_NEAR(middle[1], 145, 6);
  EXPECT_NEAR(middle[2], 140, 6);
}

TEST(ListMap, PicturesWithoutLightsAreBlackOnAScaleOfOneDecade) {
  const Image map = listMap(2, 2, {0, 0, 0, 0});
  for (const int x : {100, 300}) EXPECT_EQ(codesAt(map, x, 100), kBlack);
}

}  // namespace
}  // namespace luciole
