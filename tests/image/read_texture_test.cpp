#include "image/read_texture.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <span>
#include <string>

#include "image/srgb.hpp"
#include "luciole/error.hpp"
#include "luciole/image.hpp"
#include "png_chunk.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

using test::pngChunk;
using test::pngFile;
using test::TemporaryFolder;
using Texel = std::array<std::uint16_t, 4>;

Texel texel(const MipLevel& level, int x, int y) {
  const std::size_t at = (std::size_t(y) * level.width + x) * 4;
  return {level.texels[at], level.texels[at + 1], level.texels[at + 2], level.texels[at + 3]};
}

std::uint16_t codeOf(double linear) {
  const double code = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return std::uint16_t(std::lround(code * 65535));
}

/// Of a level that is not the finest.
std::uint16_t rootCodeOf(double linear) { return std::uint16_t(std::lround(std::sqrt(linear) * 65535)); }

/// A 16-bit code made by float arithmetic: a relative error of some 2⁻²⁴ in each of the additions of a mean
/// of up to 9 and in the root, over a chain of 7 levels, is below 100 × 2⁻²⁴ × 65535 < 0.4 code; with the
/// rounding to an integer, 1.
constexpr int kCodeTolerance = 1;

TEST(ReadTexture, EveryEightBitCodeIsKeptExactly) {
  const TemporaryFolder folder;
  Image image{256, 1, {"R", "G", "B"}, {}};
  for (int code = 0; code < 256; ++code)
    image.pixels.insert(image.pixels.end(), 3, float(decodeSrgb(code / 255.0)));
  writeImage(image, folder / "a.png", {});
  const Texture texture = readTexture(folder / "a.png");
  for (int code = 0; code < 256; ++code) {
    const auto value = std::uint16_t(code * 257);
    ASSERT_EQ(texel(texture.levels[0], code, 0), (Texel{value, value, value, 65535}));
  }
}

TEST(ReadTexture, ChainsHalveDownToOneTexel) {
  const TemporaryFolder folder;
  writeImage({144, 17, {"R", "G", "B"}, std::vector<float>(144 * 17 * 3, 0.5f)}, folder / "a.png", {});
  const Texture texture = readTexture(folder / "a.png");
  std::vector<std::pair<int, int>> sizes;
  for (const MipLevel& level : texture.levels) {
    sizes.emplace_back(level.width, level.height);
    ASSERT_EQ(level.texels.size(), std::size_t(level.width) * level.height * 4);
  }
  EXPECT_EQ(sizes, (std::vector<std::pair<int, int>>{
                       {144, 17}, {72, 8}, {36, 4}, {18, 2}, {9, 1}, {4, 1}, {2, 1}, {1, 1}}));
}

TEST(ReadTexture, AUniformPictureStaysUniform) {
  const TemporaryFolder folder;
  writeImage({7, 93, {"R", "G", "B"}, std::vector<float>(7 * 93 * 3, float(decodeSrgb(100 / 255.0)))},
             folder / "a.png", {});
  int expected = 100 * 257;
  for (const MipLevel& level : readTexture(folder / "a.png").levels) {
    for (std::size_t i = 0; i < level.texels.size(); ++i) {
      if (i % 4 == 3) {
        ASSERT_EQ(level.texels[i], 65535);
      } else {
        ASSERT_NEAR(level.texels[i], expected, kCodeTolerance);
      }
    }
    expected = rootCodeOf(decodeSrgb(100 / 255.0));
  }
}

TEST(ReadTexture, MeansAreTakenInLinearLight) {
  const TemporaryFolder folder;
  writeImage({2, 2, {"R", "G", "B"}, {1, 1, 1, 0, 0, 0, 0, 0, 0, 1, 1, 1}}, folder / "a.png", {});
  const Texture texture = readTexture(folder / "a.png");
  ASSERT_EQ(texture.levels.size(), 2u);
  EXPECT_NEAR(texture.levels[1].texels[0], rootCodeOf(0.5), kCodeTolerance);
}

TEST(ReadTexture, OddSidesAreWeightedByTheAreaCovered) {
  const TemporaryFolder folder;
  // One row of 5 texels to 2: each covers two and a half. White is texel 2 (shared), then texel 0.
  for (const auto& [white, expected] :
       {std::pair{2, std::array{0.2, 0.2}}, std::pair{0, std::array{0.4, 0.0}}}) {
    Image image{5, 1, {"R", "G", "B"}, std::vector<float>(15, 0.0f)};
    for (int c = 0; c < 3; ++c) image.pixels[white * 3 + c] = 1.0f;
    writeImage(image, folder / "a.png", {});
    const MipLevel level = readTexture(folder / "a.png").levels[1];
    ASSERT_EQ(level.width, 2);
    for (int x = 0; x < 2; ++x) EXPECT_NEAR(texel(level, x, 0)[0], rootCodeOf(expected[x]), kCodeTolerance);
  }
}

TEST(ReadTexture, TheCoarsestTexelIsTheMeanOfAllForAnySize) {
  const TemporaryFolder folder;
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 93}, {144, 17}, {64, 64}}) {
    Image image{width, height, {"R", "G", "B"}, {}};
    double sum = 0;
    for (int i = 0; i < width * height; ++i) {
      const double linear = decodeSrgb((i * 37 % 256) / 255.0);
      sum += linear;
      image.pixels.insert(image.pixels.end(), 3, float(linear));
    }
    writeImage(image, folder / "a.png", {});
    const Texture texture = readTexture(folder / "a.png");
    const double mean = sum / (width * height);
    EXPECT_NEAR(texture.levels.back().texels[0], texture.levels.size() == 1 ? codeOf(mean) : rootCodeOf(mean),
                kCodeTolerance);
  }
}

TEST(ReadTexture, HolesDoNotBleedTheirColor) {
  const TemporaryFolder folder;
  // A red texel beside three that are transparent and black.
  Image image{2, 2, {"R", "G", "B", "A"}, std::vector<float>(16, 0.0f)};
  image.pixels[0] = 1.0f;
  image.pixels[3] = 1.0f;
  writeImage(image, folder / "a.png", {});
  EXPECT_EQ(texel(readTexture(folder / "a.png").levels[1], 0, 0), (Texel{65535, 0, 0, 16384}));
}

TEST(ReadTexture, TransparentColorsAreKept) {
  const TemporaryFolder folder;
  writeImage({2, 1, {"R", "G", "B", "A"}, {1, 1, 1, 0, 1, 1, 1, 0}}, folder / "a.png", {});
  const Texture texture = readTexture(folder / "a.png");
  EXPECT_EQ(texel(texture.levels[0], 1, 0), (Texel{65535, 65535, 65535, 0}));
  EXPECT_EQ(texel(texture.levels[1], 0, 0), (Texel{65535, 65535, 65535, 0}));
}

TEST(ReadTexture, WhetherAlphaVariesIsTold) {
  const TemporaryFolder folder;
  for (const auto& [first, second] : {std::pair{1.0f, 1.0f}, {0.0f, 0.0f}, {0.0f, 1.0f}}) {
    writeImage({2, 1, {"R", "G", "B", "A"}, {1, 0, 1, first, 0, 1, 0, second}}, folder / "a.png", {});
    EXPECT_EQ(readTexture(folder / "a.png").alpha_varies, first != second);
  }
}

TEST(ReadTexture, FloatPicturesAreClampedAndEncoded) {
  const TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  writeImage({2, 1, {"R", "G", "B"}, {-1.0f, 0.5f, 9.0f, nan, 0.001f, 1.0f}}, folder / "a.exr", {});
  const MipLevel level = readTexture(folder / "a.exr").levels[0];
  EXPECT_EQ(texel(level, 0, 0), (Texel{0, codeOf(0.5), 65535, 65535}));
  EXPECT_EQ(texel(level, 1, 0), (Texel{0, codeOf(0.001), 65535, 65535}));
}

TEST(ReadTexture, GreyIsSpreadOverColors) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.pgm", std::ios::binary) << "P5\n2 1\n255\n" << char(10) << char(200);
  const MipLevel level = readTexture(folder / "a.pgm").levels[0];
  EXPECT_EQ(texel(level, 0, 0), (Texel{2570, 2570, 2570, 65535}));
  EXPECT_EQ(texel(level, 1, 0), (Texel{51400, 51400, 51400, 65535}));
}

TEST(ReadTexture, WhatAPictureOfGltfSaysOfItsSpaceIsIgnored) {
  const auto number = [](std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
    return bytes;
  };
  const auto first = [](const std::string& bytes) {
    const Texels texels = readTexture(std::as_bytes(std::span(bytes)), "it").levels[0].texels;
    return texels[0];
  };
  for (const int gamma : {100000, 45455, 55556})
    for (const bool interlaced : {false, true}) {
      const std::string chunks = pngChunk("gAMA", number(std::uint32_t(gamma)));
      EXPECT_EQ(first(pngFile(1, 1, 8, 0, interlaced, chunks, std::string("\0\x80", 2))), 128 * 257);
      EXPECT_EQ(first(pngFile(1, 1, 16, 0, interlaced, chunks, std::string("\0\x80\x81", 3))), 0x8081);
    }
}

TEST(ReadTexture, AFileInMemoryReadsAsOnDisk) {
  const TemporaryFolder folder;
  Image image{7, 5, {"R", "G", "B"}, {}};
  for (int i = 0; i < 105; ++i) image.pixels.push_back(float(i) / 105);
  for (const char* name : {"a.png", "a.jpg"}) {
    writeImage(image, folder / name, {});
    const std::string bytes = test::readText(folder / name);
    const Texture in_memory = readTexture(std::as_bytes(std::span(bytes)), "a.glb: image 3");
    const Texture on_disk = readTexture(folder / name);
    EXPECT_EQ(in_memory.name, "a.glb: image 3");
    ASSERT_EQ(in_memory.levels.size(), on_disk.levels.size());
    EXPECT_EQ(in_memory.levels[0].texels, on_disk.levels[0].texels);
  }
}

TEST(ReadTexture, ErrorsNameThePicture) {
  const std::array<std::byte, 3> bytes{};
  try {
    readTexture(bytes, "a.glb: image 3");
    FAIL() << "threw nothing";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("a.glb: image 3: ", 0), 0u) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
  EXPECT_THROW(readTexture({}, "empty"), InputError);
}

TEST(ReadTexture, JunkIsRefusedByTheNameThatPeopleKnow) {
  // The last one's decoder throws.
  for (const std::string& junk : {std::string("RIFF\x10\0\0\0WEBPVP8 junkjunkjunk", 28), std::string("junk"),
                                  std::string("GIF89ajunkjunkjunkjunkjunkjunkjunk")}) {
    try {
      readTexture(std::as_bytes(std::span(junk)), "a.gltf: images[0] 'x.webp'");
      ADD_FAILURE() << "threw nothing";
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.rfind("a.gltf: images[0] 'x.webp': can't read as a picture: ", 0), 0u) << message;
      EXPECT_EQ(message.find("/proc"), std::string::npos) << message;
    }
  }
}

TEST(ReadTexture, EveryTextureOfTheSharedScenesLoads) {
  LUCIOLE_NEEDS_SHARED();
  int count = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(test::sharedScenes() / "sponza_crytek_obj")) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".png" && extension != ".jpg") continue;
    const Texture texture = readTexture(entry.path().string());
    EXPECT_EQ(texture.levels.back().width * texture.levels.back().height, 1) << entry.path();
    ++count;
  }
  EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace luciole
