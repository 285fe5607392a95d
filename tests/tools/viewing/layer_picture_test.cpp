#include "tools/viewing/layer_picture.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "image/heat_map.hpp"
#include "image/side_by_side.hpp"
#include "image/srgb.hpp"

namespace luciole {
namespace {

using Codes = std::array<int, 3>;  ///< sRGB of 8 bits, as a viewer shows it

Codes codesOf(const Image& image, int x, int y) {
  Codes codes{};
  for (int c = 0; c < 3; ++c)
    codes[c] = int(std::lround(255 * encodeSrgb(image.pixels[(std::size_t(y) * image.width + x) * 3 + c])));
  return codes;
}

/// A row of pixels of three channels.
Image rowOf(const std::vector<std::array<float, 3>>& pixels) {
  Image image{int(pixels.size()), 1, {"X", "Y", "Z"}, {}};
  for (const auto& pixel : pixels) image.pixels.insert(image.pixels.end(), pixel.begin(), pixel.end());
  return image;
}

TEST(LayerPicture, UnitVectorsHaveTheCodesOfNormalMapsAndNothingIsBlack) {
  const LayerPicture picture =
      layerPicture("N", LayerKind::kVector, rowOf({{0, 0, 1}, {-1, 0, 0}, {0, 0.6f, -0.8f}, {0, 0, 0}}));
  EXPECT_EQ(codesOf(picture.image, 0, 0), (Codes{128, 128, 255}));
  EXPECT_EQ(codesOf(picture.image, 1, 0), (Codes{0, 128, 128}));
  EXPECT_EQ(codesOf(picture.image, 2, 0), (Codes{128, 204, 25}))
      << "-0.8f is a little below -0.8, so 25.5 is, too";
  EXPECT_EQ(codesOf(picture.image, 3, 0), (Codes{0, 0, 0}));
  EXPECT_TRUE(picture.notes.empty());
}

TEST(LayerPicture, PositionsRunBetweenTheirBoundsWhichAreTold) {
  const LayerPicture picture =
      layerPicture("P", LayerKind::kVector, rowOf({{-2, 5, 7}, {6, 5, 9}, {2, 5, 8}, {0, 0, 0}}));
  EXPECT_EQ(codesOf(picture.image, 0, 0), (Codes{0, 0, 0}));
  EXPECT_EQ(codesOf(picture.image, 1, 0), (Codes{255, 0, 255}));
  EXPECT_EQ(codesOf(picture.image, 2, 0), (Codes{128, 0, 128}));
  ASSERT_EQ(picture.notes.size(), 1u);
  EXPECT_EQ(picture.notes[0], "P: red, green and blue are x from -2 to 6, y from 5 to 5, z from 7 to 9");
}

TEST(LayerPicture, IdsHaveAColorEachAndNothingIsBlack) {
  Image ids{5, 1, {"object_id"}, {-1, 0, 1, 1, 70000}};
  const Image picture = layerPicture("object_id", LayerKind::kId, ids).image;
  EXPECT_EQ(codesOf(picture, 0, 0), (Codes{0, 0, 0}));
  EXPECT_EQ(codesOf(picture, 2, 0), codesOf(picture, 3, 0));
  for (const auto& [a, b] : {std::pair(0, 1), {1, 2}, {2, 4}, {1, 4}})
    EXPECT_NE(codesOf(picture, a, 0), codesOf(picture, b, 0)) << a << b;
}

TEST(LayerPicture, MattesMixTheColorsOfTheirIdsByTheirShares) {
  const auto matte = [](std::vector<float> pixel) {
    return layerPicture("CryptoObject00", LayerKind::kMatte, {1, 1, {"R", "G", "B", "A"}, std::move(pixel)})
        .image.pixels;
  };
  const std::vector<float> one = matte({1.5f, 1, 0, 0}), other = matte({2.5f, 1, 0, 0}),
                           both = matte({1.5f, 0.75f, 2.5f, 0.25f});
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(both[c], 0.75f * one[c] + 0.25f * other[c], 1e-6);
  EXPECT_EQ(matte({0, 1, 0, 0}), (std::vector<float>{0, 0, 0}));
}

TEST(LayerPicture, WhatIsNotFiniteIsRedAndTold) {
  const LayerPicture picture =
      layerPicture("L", LayerKind::kColor, rowOf({{0, NAN, 0}, {0.25f, 0.5f, HUGE_VALF}}));
  EXPECT_EQ(codesOf(picture.image, 0, 0), (Codes{255, 0, 0}));
  EXPECT_EQ(codesOf(picture.image, 1, 0), (Codes{255, 0, 0}));
  ASSERT_EQ(picture.notes.size(), 1u);
  EXPECT_EQ(picture.notes[0], "L: 2 pixels are not finite and shown red");
}

constexpr Codes kLowest{68, 1, 84}, kHighest{253, 231, 37};  // viridis's ends

TEST(ValueSheet, IsLinearFromTheLeastToTheMostWithInfinitiesAside) {
  const Image sheet = valueSheet(4, 1, {{"", {3, HUGE_VALF, 7, NAN}}}, 1, "Z");
  EXPECT_EQ(codesOf(sheet, 60, 60), kLowest);
  EXPECT_EQ(codesOf(sheet, 300, 60), kHighest);
  const Codes far = codesOf(sheet, 180, 60);
  EXPECT_TRUE(far[0] == far[1] && far[1] == far[2] && far[0] > 40 && far[0] < 90) << far[0];
  EXPECT_EQ(codesOf(sheet, 420, 60), (Codes{255, 0, 0}));
}

TEST(ValueSheet, IsLogarithmicWhereMostValuesWouldLookAlike) {
  // From 10⁰ to 10⁴; linear, 10 and 1 would be the same colour.
  const Image sheet = valueSheet(5, 1, {{"", {1, 1, 1, 10, 10000}}}, 1, "light_count");
  EXPECT_EQ(codesOf(sheet, 48, 48), kLowest);
  EXPECT_NE(codesOf(sheet, 336, 48), kLowest);
  EXPECT_EQ(codesOf(sheet, 432, 48), kHighest);
}

TEST(ValueSheet, ValuesThatAreAllTheSameOrNoneHaveAScaleToo) {
  EXPECT_EQ(codesOf(valueSheet(1, 1, {{"", {4}}}, 1, "Z"), 100, 100), kLowest);
  EXPECT_NO_THROW(valueSheet(1, 1, {{"", {HUGE_VALF}}}, 1, "Z"));
  EXPECT_NO_THROW(valueSheet(1, 1, {{"", {0}}}, 1, "Z"));
  EXPECT_EQ(codesOf(valueSheet(2, 1, {{"", {4, 4.000001f}}}, 1, "Z"), 300, 100), kLowest) << "rounding";
  EXPECT_EQ(codesOf(valueSheet(2, 1, {{"", {4, 4.00001f}}}, 1, "Z"), 300, 100), kHighest);
}

TEST(ValueSheet, PanelsShareOneScale) {
  const Image sheet = valueSheet(200, 100,
                                 {{"a", std::vector<float>(20000, 1)},
                                  {"b", std::vector<float>(20000, 5)},
                                  {"c", std::vector<float>(20000, 9)}},
                                 2, "Z");
  const int step = 200 * 2 + 14;  // enlarged twice, and the gap
  EXPECT_EQ(codesOf(sheet, 100, 100), kLowest);
  EXPECT_EQ(codesOf(sheet, 100, 230 + 100), kHighest);
  EXPECT_EQ(codesOf(sheet, 400 + 7, 100), (Codes{255, 255, 255})) << "the gap";
  EXPECT_NE(codesOf(sheet, step + 50, 100), kLowest);
  EXPECT_EQ(codesOf(sheet, step + 50, 230 + 100), (Codes{255, 255, 255})) << "no fourth panel";
}

TEST(LabelledSheet, LaysPicturesInRowsWithRoomForALabel) {
  const auto plain = [](float grey) {
    return Image{300, 40, {"R", "G", "B"}, std::vector<float>(300 * 40 * 3, grey)};
  };
  const Image sheet =
      labelledSheet({plain(0), plain(0.5f), plain(1)}, {"a=0", "a=1", "a=2"}, {"0", "1", "2"}, 2);
  EXPECT_EQ(sheet.width, 614);
  EXPECT_EQ(codesOf(sheet, 150, 20), (Codes{0, 0, 0}));
  EXPECT_EQ(codesOf(sheet, 300, 20), (Codes{255, 255, 255}));
  EXPECT_EQ(codesOf(sheet, 314 + 150, 20), (Codes{188, 188, 188}));
  EXPECT_EQ(sheet.height, 2 * (40 + 24));
}

TEST(LabelledSheet, WhereALabelHasNoRoomAllHaveTheirBriefOnes) {
  const Image grey{300, 40, {"R", "G", "B"}, std::vector<float>(300 * 40 * 3, 0.5f)};
  const std::string place(100, 'x');
  EXPECT_EQ(labelledSheet({grey, grey}, {"a=0", place + "=10"}, {"0", "10"}, 2).pixels,
            labelledSheet({grey, grey}, {"0", "10"}, {"", ""}, 2).pixels);
}

TEST(LabelledSheet, SmallPicturesAreEnlargedUntilLabelsCanBeRead) {
  const Image small{64, 36, {"R", "G", "B"}, std::vector<float>(64 * 36 * 3, 0.5f)};
  EXPECT_EQ(labelledSheet(std::vector(9, small), std::vector<std::string>(9, "intensity=10"),
                          std::vector<std::string>(9), 9)
                .width,
            9 * 192 + 8 * 14);
}

// OpenImageIO draws them as other characters.
TEST(LabelledSheet, CharactersBeyondAsciiAreQuestionMarks) {
  const Image grey{300, 40, {"R", "G", "B"}, std::vector<float>(300 * 40 * 3, 0.5f)};
  EXPECT_EQ(labelledSheet({grey}, {"L\u00e4mpchen \u20ac"}, {""}, 1).pixels,
            labelledSheet({grey}, {"L?mpchen ?"}, {""}, 1).pixels);
}

}  // namespace
}  // namespace luciole
