#include "image/dither.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "image/srgb.hpp"
#include "luciole/image.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

using test::TemporaryFolder;

/// A picture whose colours are these parts of the 8-bit scale, 0 to 255, not only whole ones.
template <class Code>
Image pictureOfCodes(int width, int height, Code code) {
  Image image{width, height, {"R", "G", "B"}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) image.pixels.push_back(float(decodeSrgb(code(x, y, c) / 255.0)));
  return image;
}

/// The 8-bit codes of a file, channel by channel.
std::vector<int> codesOf(const std::string& path) {
  const Image image = readImage(path);
  std::vector<int> codes;
  for (const float value : image.pixels) codes.push_back(int(std::lround(encodeSrgb(value) * 255.0)));
  return codes;
}

std::vector<int> dithered(const Image& image, glm::ivec2 crop_origin = {}) {
  const TemporaryFolder folder;
  writeImage(image, folder / "a.png", {}, {.dither = true, .crop_origin = crop_origin});
  return codesOf(folder / "a.png");
}

TEST(Dither, KeepsTheMeanOfWhatLiesBetweenTwoSteps) {
  // 271/359 is a convergent of 1/ρ = 0.7548777: so many pixels in a row have any interval's share of
  // thresholds to within 2/359, and the thresholds are rounded to 1/256.
  constexpr int kWidth = 359, kHeight = 8;
  for (const double code : {0.25, 17.1, 17.5, 17.9, 100.75, 254.5}) {
    const std::vector<int> codes =
        dithered(pictureOfCodes(kWidth, kHeight, [&](int, int, int) { return code; }));
    double sum = 0;
    for (const int c : codes) {
      EXPECT_GE(c, std::floor(code));
      EXPECT_LE(c, std::ceil(code));
      sum += c;
    }
    EXPECT_NEAR(sum / double(codes.size()), code, 2.0 / kWidth + 1.0 / 256);
  }
}

TEST(Dither, NeighboursHaveEvenGrain) {
  // Of 8 x 8 pixels anywhere, half lie above a half-way value, give or take a few: white noise would be off
  // by 12 somewhere (three of its standard deviations of 4).
  for (int y = 0; y < 200; y += 3)
    for (int x = 0; x < 200; x += 3) {
      int above = 0;
      for (int i = 0; i < 64; ++i) above += ditherThreshold(x + i % 8, y + i / 8) > 0.5f;
      EXPECT_NEAR(above, 32, 4) << x << "," << y;
    }
}

TEST(Dither, WhatLiesOnAStepStaysOnIt) {
  const auto code = [](int x, int y, int c) { return (x + 7 * y + 85 * c) % 256; };
  const Image image = pictureOfCodes(256, 64, code);
  const std::vector<int> codes = dithered(image);
  for (int y = 0, i = 0; y < 64; ++y)
    for (int x = 0; x < 256; ++x)
      for (int c = 0; c < 3; ++c, ++i) ASSERT_EQ(codes[i], code(x, y, c));
}

TEST(Dither, LeavesAlphaAlone) {
  const TemporaryFolder folder;
  Image image{64, 64, {"R", "G", "B", "A"}, {}};
  for (int i = 0; i < 64 * 64; ++i) image.pixels.insert(image.pixels.end(), {0.5f, 0.5f, 0.5f, 0.501f});
  writeImage(image, folder / "a.png", {}, {.dither = true});
  const Image read = readImage(folder / "a.png");
  for (int i = 0; i < 64 * 64; ++i) ASSERT_EQ(read.pixels[i * 4 + 3], 128 * 257 / 65535.0f);
}

TEST(Dither, GreyStaysGrey) {
  const std::vector<int> codes =
      dithered(pictureOfCodes(64, 64, [](int x, int y, int) { return 10 + (x + y) / 16.0; }));
  for (std::size_t i = 0; i < codes.size(); i += 3) {
    ASSERT_EQ(codes[i], codes[i + 1]);
    ASSERT_EQ(codes[i], codes[i + 2]);
  }
}

TEST(Dither, CropsAndPiecesHaveTheWholesGrain) {
  const TemporaryFolder folder;
  const Image whole = pictureOfCodes(64, 48, [](int x, int y, int c) { return 20 + (x + y + c) / 30.0; });
  const std::vector<int> codes = dithered(whole);
  Image crop{20, 17, whole.channels, {}};
  const glm::ivec2 origin(13, 9);
  const auto place = [&](int x, int y) { return std::size_t(3) * ((origin.y + y) * 64 + origin.x + x); };
  for (int y = 0; y < crop.height; ++y)
    crop.pixels.insert(crop.pixels.end(), whole.pixels.begin() + place(0, y),
                       whole.pixels.begin() + place(crop.width, y));
  const std::vector<int> of_crop = dithered(crop, origin);
  for (int y = 0, i = 0; y < crop.height; ++y)
    for (int x = 0; x < crop.width; ++x)
      for (int c = 0; c < 3; ++c, ++i) ASSERT_EQ(of_crop[i], codes[place(x, y) + c]) << x << "," << y;

  ImageWriter writer(folder / "pieces.png", 64, 48, whole.channels, {}, {.dither = true});
  for (int y = 0; y < 48; y += 11) {
    const int rows = std::min(11, 48 - y);
    writer.write({64,
                  rows,
                  whole.channels,
                  {whole.pixels.begin() + y * 64 * 3, whole.pixels.begin() + (y + rows) * 64 * 3}});
  }
  writer.close();
  EXPECT_EQ(codesOf(folder / "pieces.png"), codes);
}

TEST(Dither, IsTheSameInEveryIntegerFormat) {
  const TemporaryFolder folder;
  const Image image = pictureOfCodes(64, 48, [](int x, int y, int c) { return 20 + (x + y + c) / 30.0; });
  const std::vector<int> codes = dithered(image);
  for (const char* name : {"a.tga", "a.bmp", "a.ppm", "a.sgi"}) {
    writeImage(image, folder / name, {}, {.dither = true});
    EXPECT_EQ(codesOf(folder / name), codes) << name;
  }
  for (const char* name : {"a.exr", "a.hdr"}) {
    writeImage(image, folder / name, {}, {.dither = true});
    const Image with = readImage(folder / name);
    writeImage(image, folder / name, {}, {});
    EXPECT_EQ(readImage(folder / name).pixels, with.pixels) << name;
  }
}

}  // namespace
}  // namespace luciole
