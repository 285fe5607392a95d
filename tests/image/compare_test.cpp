#include "image/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "error.hpp"

namespace luciole {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

Image grey(int width, int height, float value) {
  return {width, height, {"R", "G", "B"}, std::vector<float>(std::size_t(width) * height * 3, value)};
}

TEST(Compare, EqualPicturesDifferByNothing) {
  Image image = grey(7, 93, 0.5f);
  image.pixels[4] = kNaN;
  image.pixels[9] = kInf;
  const ImageDifference d = compareImages(image, image);
  EXPECT_EQ(d.max_abs, 0);
  EXPECT_EQ(d.rmse, 0);
  EXPECT_EQ(d.psnr, kInf);
  EXPECT_EQ(d.nonfinite, 0u);
  EXPECT_EQ(d.over, (std::array<std::uint64_t, 3>{}));
}

TEST(Compare, FiguresOfAKnownDifference) {
  const Image a = grey(10, 10, 0.5f);
  Image b = a;
  b.pixels[(3 * 10 + 7) * 3 + 1] = 0.75f;
  b.pixels[(9 * 10 + 9) * 3 + 2] = 0.375f;
  const ImageDifference d = compareImages(a, b);
  // All inputs are dyadic; what is left are a few roundings of double in each quotient and logarithm.
  constexpr double kTolerance = 1e-14;
  EXPECT_EQ(d.max_abs, 0.25);
  EXPECT_EQ(d.worst_pixel, (std::array<int, 2>{7, 3}));
  EXPECT_NEAR(d.mean_abs, 0.375 / 300, kTolerance);
  EXPECT_NEAR(d.mean_signed, 0.125 / 300, kTolerance);
  const double mse = (0.0625 + 0.015625) / 300;
  EXPECT_NEAR(d.rmse, std::sqrt(mse), kTolerance);
  EXPECT_NEAR(d.psnr, -10 * std::log10(mse), 100 * kTolerance);
  EXPECT_NEAR(d.relmse, mse / 0.26, kTolerance);
  EXPECT_EQ(d.over, (std::array<std::uint64_t, 3>{2, 2, 2}));
  // Of 100 pixels 98 are equal: 99 of them differ by at most the smaller difference, and all by at most the
  // larger.
  EXPECT_EQ(d.p99_abs, 0.125);
  EXPECT_EQ(d.p999_abs, 0.25);
}

TEST(Compare, BiasHasTheSignOfTheSecondPicture) {
  EXPECT_EQ(compareImages(grey(3, 3, 0.5f), grey(3, 3, 0.25f)).mean_signed, -0.25);
  EXPECT_EQ(compareImages(grey(3, 3, 0.25f), grey(3, 3, 0.5f)).mean_signed, 0.25);
}

TEST(Compare, PixelsOverEachLimitAreCounted) {
  const Image a = grey(4, 1, 0.0f);
  Image b = a;
  b.pixels[0] = float(0.4 / 255);
  b.pixels[3] = float(0.6 / 255);
  b.pixels[6] = float(3.9 / 255);
  b.pixels[9] = float(4.1 / 255);
  EXPECT_EQ(compareImages(a, b).over, (std::array<std::uint64_t, 3>{3, 2, 1}));
}

TEST(Compare, OneSidedNonFiniteValuesAreCountedApartAndNeverPass) {
  const Image a = grey(2, 2, 0.5f);
  for (const float bad : {kNaN, kInf, -kInf}) {
    Image b = a;
    b.pixels[3] = bad;
    b.pixels[0] = 0.75f;
    for (const ImageDifference& d : {compareImages(a, b), compareImages(b, a)}) {
      EXPECT_EQ(d.nonfinite, 1u);
      EXPECT_EQ(d.max_abs, kInf);
      EXPECT_EQ(d.worst_pixel, (std::array<int, 2>{1, 0}));
      EXPECT_NEAR(d.mean_abs, 0.25 / 11, 1e-15);
      EXPECT_EQ(d.over[2], 2u);
    }
  }
  Image plus = a, minus = a;
  plus.pixels[0] = kInf;
  minus.pixels[0] = -kInf;
  EXPECT_EQ(compareImages(plus, minus).nonfinite, 1u);
}

TEST(Compare, ChannelsAreMatchedByName) {
  const Image a{1, 1, {"R", "G", "B", "A"}, {1, 2, 3, 1}};
  const Image b{1, 1, {"depth", "B", "G", "R"}, {9, 3, 2, 1}};
  EXPECT_EQ(compareImages(a, b).max_abs, 0);
  const Image half_covered{1, 1, {"R", "G", "B", "A"}, {1, 2, 3, 0.5f}};
  EXPECT_EQ(compareImages(a, half_covered).max_abs, 0);
}

TEST(Compare, MismatchesAreErrors) {
  EXPECT_THROW(compareImages(grey(2, 2, 0), grey(2, 3, 0)), InputError);
  EXPECT_THROW(compareImages(grey(1, 1, 0), Image{1, 1, {"Y"}, {0}}), InputError);
  EXPECT_THROW(differencePicture(grey(2, 2, 0), grey(2, 3, 0), 1), InputError);
}

TEST(Compare, DifferencePictureScalesAndShowsNonFinite) {
  const Image a{2, 1, {"R", "G", "B"}, {0.5f, 0.5f, kInf, kNaN, 0, 0}};
  const Image b{2, 1, {"R", "G", "B"}, {0.25f, 0.5f, kInf, 0, kNaN, 0.125f}};
  EXPECT_EQ(differencePicture(a, b, 10).pixels, (std::vector<float>{2.5f, 0, 0, kInf, kInf, 1.25f}));
}

}  // namespace
}  // namespace luciole
