#include "image/side_by_side.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "image/heat_map.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

using Color = std::array<float, 3>;
constexpr Color kWhite{1, 1, 1};

Color colorAt(const Image& image, int x, int y) {
  const float* pixel = image.pixels.data() + (std::size_t(y) * image.width + x) * 3;
  return {pixel[0], pixel[1], pixel[2]};
}

Image row(const Image& a, const Image& b, const std::string& name_a = "a.png",
          const std::string& name_b = "b.png") {
  return sideBySide(a, b, compareImages(a, b), name_a, name_b);
}

/// The last column that anything is written in below a picture, of the columns from `left` to `right`; -1
/// where nothing is.
int writtenTo(const Image& image, int top, int left, int right) {
  int last = -1;
  for (int y = top; y < image.height; ++y)
    for (int x = left; x < right; ++x)
      if (colorAt(image, x, y) != kWhite) last = std::max(last, x);
  return last;
}

// Two pictures of 3 x 2 pixels: enlarged 160 times they are 480 x 320, and 14 pixels, a line of text, apart.
constexpr int kSide = 160, kStep = 480 + 14;
const Image kA{3, 2, {"R", "G", "B"}, {1, 0, 0, 0, 1, 0, 0, 0, 1, .5f, .5f, .5f, 4, 4, 4, 0, 0, 0}};
const Image kB{3, 2, {"R", "G", "B"}, {1, 0, 0, 0, 1, 0, 0, 0, .5f, .5f, .5f, .5f, 4, 4, 4, 0, 0, 0}};

TEST(SideBySide, PicturesKeepTheirColorsAndTheErrorMapIsTheThird) {
  const Image both = row(kA, kB), map = errorMap(compareImages(kA, kB));
  ASSERT_EQ(both.width, 2 * kStep + 480);
  ASSERT_EQ(both.height, map.height);
  for (int y = 0; y < 320; ++y) {
    for (int x = 0; x < 480; ++x) {
      ASSERT_EQ(colorAt(both, x, y), colorAt(kA, x / kSide, y / kSide)) << x << " " << y;
      ASSERT_EQ(colorAt(both, kStep + x, y), colorAt(kB, x / kSide, y / kSide)) << x << " " << y;
    }
    for (int x = 480; x < kStep; ++x) ASSERT_EQ(colorAt(both, x, y), kWhite);
  }
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < 480; ++x) ASSERT_EQ(colorAt(both, 2 * kStep + x, y), colorAt(map, x, y));
}

TEST(SideBySide, PicturesOfOneChannelAreGreyAndAlphaIsLeftOut) {
  const Image grey{3, 2, {"Y"}, {0, .25f, .5f, .75f, 1, 2}};
  Image with_alpha{3, 2, {"A", "Y"}, {}};
  for (const float value : grey.pixels) with_alpha.pixels.insert(with_alpha.pixels.end(), {0.5f, value});
  const Image both = row(grey, with_alpha);
  for (int i = 0; i < 6; ++i) {
    const float value = grey.pixels[i];
    const int x = i % 3 * kSide + 1, y = i / 3 * kSide + 1;
    EXPECT_EQ(colorAt(both, x, y), (Color{value, value, value}));
    EXPECT_EQ(colorAt(both, kStep + x, y), (Color{value, value, value}));
  }
}

TEST(SideBySide, NamesAndFiguresAreWrittenBelow) {
  const Image both = row(kA, kB);
  EXPECT_GT(writtenTo(both, 320, 0, 480), 0);
  EXPECT_GT(writtenTo(both, 320, kStep, kStep + 480), kStep);
  const Image renamed = row(kA, kB, "a.png", "c.png"), other = row(kA, kA);
  const auto captionOfSecond = [](const Image& image) {
    std::vector<float> pixels;
    for (int y = 320; y < image.height; ++y)
      for (int x = kStep; x < kStep + 480; ++x)
        for (const float value : colorAt(image, x, y)) pixels.push_back(value);
    return pixels;
  };
  EXPECT_NE(captionOfSecond(both), captionOfSecond(renamed));
  EXPECT_NE(captionOfSecond(both), captionOfSecond(other));
}

TEST(SideBySide, LongNamesLoseTheirMiddleAndStayInTheirColumn) {
  // Of one byte, of several, and of bytes that are no text.
  for (const std::string part : {"w", "ä", "光", "\xff"}) {
    std::string name;
    while (name.size() < 250) name += part;
    const Image both = row(kA, kB, name + "1\n.png", name + "2\t.png");
    for (const int left : {0, kStep}) {
      const int last = writtenTo(both, 320, left, left + kStep - 1);
      EXPECT_GT(last, left) << name;
      // The margin is 28 pixels wide; a glyph may reach over its advance, by less than its width of 14.
      EXPECT_LT(last, left + 480 - 28 + 14) << name;
    }
  }
}

TEST(SideBySide, WithoutAFontThePicturesAreThere) {
  for (const char* name : {"XDG_DATA_HOME", "XDG_DATA_DIRS"}) setenv(name, "/nonexistent", 1);
  const Image both = row(kA, kB);
  for (const char* name : {"XDG_DATA_HOME", "XDG_DATA_DIRS"}) unsetenv(name);
  EXPECT_EQ(colorAt(both, 1, 1), (Color{1, 0, 0}));
  EXPECT_EQ(writtenTo(both, 320, 0, kStep), -1);
}

TEST(SideBySide, WhatCannotBeShownIsRefused) {
  const Image depth{1, 1, {"Z"}, {1}};
  EXPECT_THROW(row(depth, depth), InputError);
  const Image wide{11000, 1, {"Y"}, std::vector<float>(11000)};
  EXPECT_THROW(row(wide, wide), InputError);
}

}  // namespace
}  // namespace luciole
