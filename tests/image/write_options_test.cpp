// What a file of a picture holds by choice: 16-bit floats, codes of 8 or 16 bits, compression, coverage, a
// place.
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/file_format.hpp"
#include "image/srgb.hpp"
#include "luciole/error.hpp"
#include "messages.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

using test::filesIn;
using test::messageOf;
using test::TemporaryFolder;
using ::testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

const std::vector<std::string> kManyChannels{"R",   "G",   "B", "A",      "diffuse.R", "specular.G",
                                             "P.X", "N.Y", "Z", "shadow", "shininess", "light_count"};

OIIO::ImageSpec headerOf(const std::string& path) {
  const auto input = OIIO::ImageInput::open(path);
  return input ? input->spec() : OIIO::ImageSpec();
}

/// Values from 2⁻³⁰ to 2¹⁵, both signs: halves that are subnormal, normal and large.
Image wideRange(int width, int height, const std::vector<std::string>& channels) {
  Image image{width, height, channels, {}};
  const std::size_t count = std::size_t(width) * height * channels.size();
  for (std::size_t i = 0; i < count; ++i) {
    const float magnitude = std::exp2(float(i % 451) / 10 - 30);
    image.pixels.push_back(i % 2 == 0 ? magnitude : -magnitude);
  }
  return image;
}

float valueOf(const Image& image, std::size_t pixel, const std::string& channel) {
  const auto found = std::find(image.channels.begin(), image.channels.end(), channel);
  EXPECT_NE(found, image.channels.end()) << channel;
  return image.pixels[pixel * image.channels.size() + std::size_t(found - image.channels.begin())];
}

TEST(WriteOptions, HalfRoundsColorsToNearestAndLeavesDataAlone) {
  const TemporaryFolder folder;
  const Image image = wideRange(41, 33, kManyChannels);
  EXPECT_EQ(writeImage(image, folder / "a.exr", {}, {.half = true}), 0u);
  const OIIO::ImageSpec header = headerOf(folder / "a.exr");
  for (int c = 0; c < header.nchannels; ++c) {
    const std::string name = header.channelnames[c];
    const bool is_color = name == "R" || name == "G" || name == "B" || name == "A" || name == "diffuse.R" ||
                          name == "specular.G";
    EXPECT_EQ(header.channelformat(c), is_color ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT) << name;
    EXPECT_EQ(isColorChannel(name), is_color) << name;
  }
  const Image read = readImage(folder / "a.exr");
  for (std::size_t pixel = 0; pixel < 41 * 33; ++pixel)
    for (const std::string& name : kManyChannels) {
      const float wrote = valueOf(image, pixel, name), got = valueOf(read, pixel, name);
      // A half has 11 bits, and no bit below 2⁻²⁴.
      const double bound = isColorChannel(name) ? std::max(0x1p-11 * std::abs(double(wrote)), 0x1p-25) : 0;
      ASSERT_LE(std::abs(double(got) - wrote), bound) << name << " " << wrote;
    }
}

TEST(WriteOptions, ColorsBeyondAHalfBecomeTheLargestAndAreCounted) {
  const TemporaryFolder folder;
  const Image image{5, 1, {"R", "G", "B", "Z"}, {65504, 1,     -65504, kInf,   // a half holds it
                                                 65505, 0,     0,      1e30f,  // just beyond
                                                 kInf,  -kInf, 1e30f,  -kInf,  // one pixel, three times
                                                 0,     -1e6f, 0,      0,     kNaN, 1, 1, 0}};
  for (const char* compression : {"zip", "none", "b44"}) {
    EXPECT_EQ(writeImage(image, folder / "a.exr", {}, {.half = true, .compression = compression}), 3u);
    const Image read = readImage(folder / "a.exr");
    for (std::size_t pixel = 0; pixel < 4; ++pixel)
      for (const char* name : {"R", "G", "B"}) EXPECT_TRUE(std::isfinite(valueOf(read, pixel, name)));
    EXPECT_EQ(valueOf(read, 1, "Z"), 1e30f);
    EXPECT_EQ(valueOf(read, 2, "Z"), -kInf);
  }
  writeImage(image, folder / "a.exr", {}, {.half = true});
  const Image read = readImage(folder / "a.exr");
  EXPECT_EQ(valueOf(read, 0, "R"), 65504);
  EXPECT_EQ(valueOf(read, 1, "R"), 65504);
  EXPECT_EQ(valueOf(read, 2, "R"), 65504);
  EXPECT_EQ(valueOf(read, 2, "G"), -65504);
  EXPECT_EQ(valueOf(read, 3, "G"), -65504);
  EXPECT_TRUE(std::isnan(valueOf(read, 4, "R")));
  // What overshoots has room to do so, of whatever type the channels are.
  for (const bool half : {false, true})
    EXPECT_EQ(writeImage({1, 1, {"R", "G", "B"}, {32752, 32753, 0}}, folder / "c.exr", {},
                         {.half = half, .compression = "dwaa"}),
              1u);
  // 32-bit floats keep all.
  EXPECT_EQ(writeImage(image, folder / "b.exr", {}), 0u);
  EXPECT_EQ(valueOf(readImage(folder / "b.exr"), 1, "R"), 65505);
}

TEST(WriteOptions, HalvesInPiecesAreThoseOfTheWhole) {
  const TemporaryFolder folder;
  Image image = wideRange(23, 40, kManyChannels);
  for (const std::size_t pixel : {3u, 500u, 900u}) image.pixels[pixel * kManyChannels.size()] = 1e6f;
  EXPECT_EQ(writeImage(image, folder / "whole.exr", {}, {.half = true}), 3u);
  ImageWriter writer(folder / "pieces.exr", image.width, image.height, image.channels, {}, {.half = true});
  const std::size_t row = image.width * image.channels.size();
  for (int y = 0; y < image.height; y += 11) {
    const int rows = std::min(11, image.height - y);
    writer.write({image.width,
                  rows,
                  image.channels,
                  {image.pixels.begin() + y * row, image.pixels.begin() + (y + rows) * row}});
  }
  EXPECT_EQ(writer.close(), 3u);
  EXPECT_EQ(readImage(folder / "pieces.exr").pixels, readImage(folder / "whole.exr").pixels);
}

TEST(WriteOptions, CompressionIsTheOneAskedForAndLosslessOnesKeepEveryBit) {
  const TemporaryFolder folder;
  const Image image = wideRange(67, 300, kManyChannels);  // higher than the 256 rows of a block of dwab
  for (const bool half : {false, true}) {
    writeImage(image, folder / "none.exr", {}, {.half = half, .compression = "none"});
    const Image exact = readImage(folder / "none.exr");
    for (const auto& [name, is_lossless] : kExrCompressions) {
      writeImage(image, folder / "a.exr", {}, {.half = half, .compression = name});
      // dwaa and dwab may have their level after the name.
      const std::string stored = readAttribute(folder / "a.exr", "compression");
      EXPECT_EQ(stored.substr(0, stored.find(':')), name);
      const Image read = readImage(folder / "a.exr");
      ASSERT_EQ(read.channels, exact.channels);
      EXPECT_TRUE(!is_lossless || read.pixels == exact.pixels) << name;
      for (const float value : read.pixels) ASSERT_TRUE(std::isfinite(value)) << name;
    }
  }
  writeImage(image, folder / "a.exr", {});
  EXPECT_EQ(readAttribute(folder / "a.exr", "compression"), kExrCompression);
}

TEST(WriteOptions, LossyCompressionLeavesNothingInfinite) {
  const TemporaryFolder folder;
  // The largest halves beside the smallest, where a transform overshoots most.
  Image image{64, 64, {"R", "G", "B"}, {}};
  for (unsigned i = 0, state = 1; i < 64 * 64 * 3; ++i) {
    state = state * 1664525u + 1013904223u;
    image.pixels.push_back(state >> 31 ? 1e9f : 0.0f);
  }
  for (const bool half : {false, true})
    for (const auto& [name, is_lossless] : kExrCompressions) {
      writeImage(image, folder / "a.exr", {}, {.half = half, .compression = name});
      const Image read = readImage(folder / "a.exr");
      EXPECT_TRUE(
          std::all_of(read.pixels.begin(), read.pixels.end(), [](float v) { return std::isfinite(v); }))
          << name << (half ? ", half" : ", float");
    }
}

/// All codes of 16 bits, one a value.
Image allCodes() {
  Image image{256, 256, {"R", "G", "B"}, {}};
  for (int code = 0; code < 65536; ++code)
    for (const int c : {code, 65535 - code, code ^ 0x5555}) image.pixels.push_back(linearOfSrgb16()[c]);
  return image;
}

TEST(WriteOptions, EverySixteenBitCodeSurvivesARoundTrip) {
  const TemporaryFolder folder;
  const Image image = allCodes();
  for (const char* name : {"a.png", "a.tif", "a.tiff"}) {
    for (const bool dither : {false, true}) {
      writeImage(image, folder / name, {}, {.dither = dither, .bits = 16});
      EXPECT_EQ(headerOf(folder / name).format, OIIO::TypeDesc::UINT16) << name;
      // A float holds a code to 2⁻²⁴ of itself, encoding adds few roundings more: far less than half a step.
      ASSERT_TRUE(readImage(folder / name).pixels == image.pixels) << name << dither;
    }
  }
}

TEST(WriteOptions, EightBitTiffsHoldTheCodesOfPngs) {
  const TemporaryFolder folder;
  Image image{64, 32, {"R", "G", "B"}, {}};
  for (int i = 0; i < 64 * 32 * 3; ++i) image.pixels.push_back(float(i * 37 % 1009) / 1000);
  for (const bool dither : {false, true}) {
    writeImage(image, folder / "usual.png", {}, {.dither = dither});
    const Image usual = readImage(folder / "usual.png");
    for (const char* name : {"a.png", "a.tif"}) {
      writeImage(image, folder / name, {}, {.dither = dither, .bits = 8});
      EXPECT_EQ(headerOf(folder / name).format, OIIO::TypeDesc::UINT8) << name;
      EXPECT_EQ(readImage(folder / name).pixels, usual.pixels) << name;
    }
  }
  writeImage(image, folder / "usual.tif", {});
  EXPECT_EQ(readImage(folder / "usual.tif").pixels, image.pixels);
}

TEST(WriteOptions, ColorsMultipliedByAlphaAreDividedInCodesAloneAndAllSaySo) {
  const TemporaryFolder folder;
  // Colours 0.5, 0.25 and 1 under alpha 1, ½, ¼ and 0, multiplied.
  Image image{4, 1, {"R", "G", "B", "A"}, {}};
  for (const float alpha : {1.0f, 0.5f, 0.25f, 0.0f})
    image.pixels.insert(image.pixels.end(), {0.5f * alpha, 0.25f * alpha, alpha, alpha});
  const std::vector<float> colors{0.5f, 0.25f, 1.0f};
  const auto expectDivided = [&](const std::string& name, double steps) {
    const Image read = readImage(folder / name);
    for (int pixel = 0; pixel < 4; ++pixel) {
      // Half a step either way, in codes; alpha's is linear. Each encoding rounds three times, 3 · 2⁻²⁴ ·
      // 65535 < 0.015 of the smaller step.
      EXPECT_NEAR(read.pixels[4 * pixel + 3], image.pixels[4 * pixel + 3], 0.53 / steps) << name;
      for (int c = 0; c < 3; ++c) {
        const float color = pixel < 3 ? colors[c] : 0;
        EXPECT_NEAR(encodeSrgb(read.pixels[4 * pixel + c]), encodeSrgb(color), 0.53 / steps) << name << pixel;
      }
    }
    EXPECT_EQ(headerOf(folder / name).alpha_channel, 3) << name;
  };
  for (const char* name : {"a.png", "a.tif"}) {
    for (const int bits : {8, 16}) {
      writeImage(image, folder / name, {}, {.bits = bits, .alpha = true});
      expectDivided(name, bits == 8 ? 255 : 65535);
    }
  }
  writeImage(image, folder / "a.tga", {}, {.alpha = true});
  expectDivided("a.tga", 255);
  for (const char* name : {"b.exr", "b.tif"}) {
    writeImage(image, folder / name, {}, {.alpha = true});
    EXPECT_EQ(readImage(folder / name).pixels, image.pixels) << name;
    EXPECT_EQ(headerOf(folder / name).get_int_attribute("oiio:UnassociatedAlpha"), 0) << name;
  }
  // What isn't said to be multiplied stays as it is.
  writeImage(image, folder / "c.png", {}, {.bits = 16});
  EXPECT_NEAR(encodeSrgb(readImage(folder / "c.png").pixels[4]), encodeSrgb(0.25f), 0.53 / 65535);
}

TEST(WriteOptions, WhatAFormatHasNoPlaceForIsRefusedBeforeAnyWork) {
  const TemporaryFolder folder;
  const Image image{1, 1, {"R", "G", "B", "A"}, {1, 1, 1, 1}};
  const auto refuses = [&](const std::string& name, const WriteOptions& options, const std::string& what) {
    EXPECT_THAT(messageOf<InputError>([&] { checkWritable(folder / name, options); }), HasSubstr(what))
        << name;
    EXPECT_THAT(messageOf<InputError>([&] { writeImage(image, folder / name, {}, options); }),
                HasSubstr(what));
  };
  for (const char* name : {"a.png", "a.tif", "a.hdr", "a.jpg", "a.webp"}) {
    refuses(name, {.half = true}, "16-bit floats (options.half), expected .exr");
    refuses(name, {.compression = "zip"}, "(options.compression zip), expected .exr");
  }
  for (const char* name : {"a.exr", "a.tif", "a.jpg"})
    refuses(name, {.compression = "small"}, "(options.compression small), expected .png");
  for (const char* name : {"a.jpg", "a.bmp", "a.ppm", "a.hdr", "a.webp"})
    refuses(name, {.alpha = true}, "coverage (options.alpha)");
  for (const char* name : {"a.exr", "a.hdr", "a.jpg", "a.tga", "a.bmp", "a.webp"})
    refuses(name, {.bits = 16}, "16-bit codes (options.bits), expected .png or .tif");
  for (const char* name : {"a.exr", "a.hdr"}) refuses(name, {.bits = 8}, "8-bit codes");
  refuses("a.png", {.bits = 10}, "10-bit codes");
  EXPECT_TRUE(filesIn(folder).empty());
  for (const char* name : {"a.png", "a.jpg", "a.tga", "a.tif"}) {
    EXPECT_NO_THROW(checkWritable(folder / name, {.bits = 8})) << name;
  }
}

TEST(WriteOptions, AnExrOfACropSaysWhereInThePictureItLies) {
  const TemporaryFolder folder;
  const Image image{5, 3, {"R", "G", "B"}, std::vector<float>(45, 0.5f)};
  const WriteOptions crop{.half = true, .picture_size = {40, 30}, .crop_origin = {7, 9}};
  writeImage(image, folder / "a.exr", {}, crop);
  const OIIO::ImageSpec header = headerOf(folder / "a.exr");
  EXPECT_EQ((std::vector<int>{header.x, header.y, header.width, header.height}),
            (std::vector<int>{7, 9, 5, 3}));
  EXPECT_EQ((std::vector<int>{header.full_x, header.full_y, header.full_width, header.full_height}),
            (std::vector<int>{0, 0, 40, 30}));
  const Image read = readImage(folder / "a.exr");
  EXPECT_EQ(read.picture_size, glm::ivec2(40, 30));
  EXPECT_EQ(read.crop_origin, glm::ivec2(7, 9));
  writeImage(image, folder / "a.png", {}, {.picture_size = {40, 30}, .crop_origin = {7, 9}});
  EXPECT_EQ(readImage(folder / "a.png").picture_size, glm::ivec2(5, 3));
  EXPECT_EQ(readImage(folder / "a.png").crop_origin, glm::ivec2(0));
}

}  // namespace
}  // namespace luciole
