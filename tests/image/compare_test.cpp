#include "luciole/compare.hpp"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "luciole/error.hpp"

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
  for (const auto& [name, figure] : kImageMetrics)
    EXPECT_EQ(d.*figure, name == std::string("psnr") ? kInf : 0) << name;
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
  EXPECT_NEAR(d.mse, mse, kTolerance);
  EXPECT_NEAR(d.relmse, mse / 0.26, kTolerance);
  EXPECT_NEAR(d.mape, (0.25 + 0.125) / 0.51 / 300, kTolerance);
  EXPECT_NEAR(d.smape, (2 * 0.25 / (0.5 + 0.75 + 0.01) + 2 * 0.125 / (0.5 + 0.375 + 0.01)) / 300, kTolerance);
  EXPECT_EQ(d.over, (std::array<std::uint64_t, 3>{2, 2, 2}));
  // Of 100 pixels 98 are equal: 99 of them differ by at most the smaller difference, and all by at most the
  // larger.
  EXPECT_EQ(d.p99_abs, 0.125);
  EXPECT_EQ(d.p999_abs, 0.25);
  EXPECT_EQ(d.max_relative, 0.5);
  EXPECT_NEAR(d.mean_relative, 0.75 / 300, kTolerance);
  EXPECT_EQ(d.pixels, 100u);
  EXPECT_EQ(d.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(d.of_pixel[3 * 10 + 7], 0.25);
}

TEST(Compare, FiguresAgreeWithOpenImageIO) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  Image a = grey(37, 23, 0.0f), b = a;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    a.pixels[i] = unit(random);
    b.pixels[i] = unit(random);
  }
  const OIIO::ImageSpec spec(37, 23, 3, OIIO::TypeDesc::FLOAT);
  const auto theirs = OIIO::ImageBufAlgo::compare(OIIO::ImageBuf(spec, a.pixels.data()),
                                                  OIIO::ImageBuf(spec, b.pixels.data()), 0.0f, 0.0f);
  const ImageDifference ours = compareImages(a, b);
  // It subtracts in float, which rounds a difference below 1 by 2⁻²⁵ at most, and so the largest and the
  // mean; the mean of the squares by twice that, relative to a root of some 0.4, and the decibels by 20 / ln
  // 10 times.
  const double tolerance = std::ldexp(1.0, -25);
  EXPECT_NEAR(ours.max_abs, theirs.maxerror, tolerance);
  EXPECT_NEAR(ours.mean_abs, theirs.meanerror, tolerance);
  EXPECT_NEAR(ours.rmse, theirs.rms_error, 3 * tolerance);
  EXPECT_NEAR(ours.psnr, theirs.PSNR, 9 * 8 * tolerance);
  EXPECT_EQ(ours.worst_pixel, (std::array<int, 2>{theirs.maxx, theirs.maxy}));
}

TEST(Compare, RelativeFiguresAreSharesOfAsLargestFiniteMagnitude) {
  const Image a{2, 1, {"R", "G", "B"}, {1, -8, 2, kInf, 1, 1}};
  const Image b{2, 1, {"R", "G", "B"}, {3, -8, 2, kInf, 1, 32}};
  EXPECT_EQ(compareImages(a, b).max_relative, 31.0 / 8);
  EXPECT_EQ(compareImages(a, b).mean_relative, 33.0 / 6 / 8);
  const Image black = grey(2, 1, 0.0f);
  EXPECT_EQ(compareImages(black, black).max_relative, 0);
  EXPECT_EQ(compareImages(black, a).mean_relative, kInf);
}

TEST(Compare, SharesAreOfMagnitudesAndTheSymmetricOneIsTheSameBothWays) {
  // Negative values, as some filters leave them; against black each value counts for itself.
  const Image a{1, 1, {"R", "G", "B"}, {-1, 0, 2}}, b{1, 1, {"R", "G", "B"}, {1, 4, 2}};
  const double first = 2 / 1.01, second = 4 / 0.01;
  EXPECT_NEAR(compareImages(a, b).mape, (first + second) / 3, 1e-12);
  EXPECT_NEAR(compareImages(a, b).relmse, (4 / 1.01 + 16 / 0.01) / 3, 1e-11);
  const double symmetric = (2 * 2 / 2.01 + 2 * 4 / 4.01) / 3;
  EXPECT_NEAR(compareImages(a, b).smape, symmetric, 1e-15);
  EXPECT_EQ(compareImages(b, a).smape, compareImages(a, b).smape);
  EXPECT_LT(compareImages(grey(2, 2, 0), grey(2, 2, 1e30f)).smape, 2 + 1e-15);
}

TEST(Compare, WhatIsNotFiniteIsLeftOutOfEachMean) {
  Image a = grey(2, 2, 0.5f), b = grey(2, 2, 0.75f);
  const ImageDifference whole = compareImages(a, b);
  b.pixels[3] = kNaN;
  a.pixels[4] = b.pixels[4] = -kInf;  // the same value, which differs by 0
  const ImageDifference rest = compareImages(a, b);
  // Of twelve equal pairs ten are left as they were, and one differs by 0.
  for (const auto& [name, figure] : {std::pair("mse", &ImageDifference::mse),
                                     {"relmse", &ImageDifference::relmse},
                                     {"mape", &ImageDifference::mape},
                                     {"smape", &ImageDifference::smape}})
    EXPECT_NEAR(rest.*figure, whole.*figure * 10 / 11, 1e-15) << name;
}

TEST(Compare, OnlySampledPixelsAreCompared) {
  const Image plain{4, 1, {"R", "G", "B"}, {9, 9, 9, kNaN, 0, 0, 0.5f, 0.5f, 0.25f, 0.5f, 0.5f, 0.5f}};
  const Image sparse{
      4, 1, {"B", "G", "R", "sampled"}, {0, 0, 0, 0, 0, 0, 0, 0, 0.5f, 0.5f, 0.5f, 1, 0.5f, 0.5f, 0.5f, 1}};
  for (const auto& [a, b] : {std::pair{sparse, plain}, {plain, sparse}}) {
    const ImageDifference d = compareImages(a, b);
    EXPECT_EQ(d.pixels, 2u);
    EXPECT_EQ(d.channels.size(), 3u);
    EXPECT_EQ(d.nonfinite, 0u);
    EXPECT_EQ(d.max_abs, 0.25);
    EXPECT_EQ(d.max_relative, 0.5);
    EXPECT_EQ(d.mean_abs, 0.25 / 6);
    EXPECT_EQ(d.p99_abs, 0.25);
    EXPECT_EQ(d.over[2], 1u);
    EXPECT_EQ(d.worst_pixel, (std::array<int, 2>{2, 0}));
    EXPECT_EQ(d.of_pixel, (std::vector<double>{kNotCompared, kNotCompared, 0.25, 0}));
    const std::vector<float> shown = differencePicture(a, b, 1).pixels;
    EXPECT_EQ(std::vector<float>(shown.begin(), shown.begin() + 6), std::vector<float>(6, 0.0f));
  }
}

TEST(Compare, BothPicturesMayBeSparseAndTheirMasksAreNoDifference) {
  const Image a{3, 1, {"R", "G", "B", "sampled"}, {1, 1, 1, 1, 1, 1, 1, 0.5f, 1, 1, 1, 0}};
  const Image b{3, 1, {"R", "G", "B", "sampled"}, {2, 2, 2, 0, 1, 1, 1, 1, 2, 2, 2, 1}};
  EXPECT_EQ(compareImages(a, b).pixels, 1u);
  EXPECT_EQ(compareImages(a, b).max_abs, 0);
  EXPECT_EQ(compareImages(a, b).worst_pixel, (std::array<int, 2>{1, 0}));
}

TEST(Compare, NoSampledPixelIsAnError) {
  const Image nothing{1, 1, {"R", "G", "B", "sampled"}, {1, 1, 1, 0}};
  EXPECT_THROW(compareImages(nothing, grey(1, 1, 1)), InputError);
  EXPECT_THROW(differencePicture(grey(1, 1, 1), nothing, 1), InputError);
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

TEST(Compare, WhereNothingIsFiniteNoMeanIsSmall) {
  const ImageDifference d = compareImages(grey(2, 2, kNaN), grey(2, 2, 0));
  EXPECT_EQ(d.nonfinite, 12u);
  for (const auto& [name, figure] : kImageMetrics)
    EXPECT_EQ(d.*figure, name == std::string("psnr") ? -kInf : kInf) << name;
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
  EXPECT_THROW(compareImages(grey(1, 1, 0), Image{1, 1, {"R"}, {0}}), InputError);
  EXPECT_THROW(compareImages(Image{1, 1, {"R", "Z"}, {0, 0}}, Image{1, 1, {"Z"}, {0}}), InputError);
}

TEST(Compare, DifferencePictureScalesAndShowsNonFinite) {
  const Image a{2, 1, {"R", "G", "B"}, {0.5f, 0.5f, kInf, kNaN, 0, 0}};
  const Image b{2, 1, {"R", "G", "B"}, {0.25f, 0.5f, kInf, 0, kNaN, 0.125f}};
  EXPECT_EQ(differencePicture(a, b, 10).pixels, (std::vector<float>{2.5f, 0, 0, kInf, kInf, 1.25f}));
}

TEST(Compare, PartsOfAPictureMustStartAtTheSamePixel) {
  Image a = grey(4, 3, 0.5f), b = a;
  a.picture_size = b.picture_size = {40, 30};
  a.crop_origin = b.crop_origin = {7, 9};
  EXPECT_EQ(compareImages(a, b).max_abs, 0);
  b.crop_origin.y = 10;
  EXPECT_THROW(compareImages(a, b), InputError);
  EXPECT_THROW(differencePicture(a, b, 1), InputError);
  // A format that doesn't tell where a crop lies has it for a whole picture.
  b.picture_size = {4, 3};
  b.crop_origin = {0, 0};
  EXPECT_EQ(compareImages(a, b).max_abs, 0);
}

}  // namespace
}  // namespace luciole
