#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "luciole/error.hpp"
#include "luciole/image.hpp"
#include "pictures/shot.hpp"
#include "png_chunk.hpp"

namespace luciole::test {
namespace {

/// A colour code's linear light, by IEC 61966-2-1; `code` in [0, 1].
double linear(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }

/// A square of 2 m with the map once over it, seen head on so that it fills a square picture; unlit, so that
/// a pixel shows the map's own colour. The background is magenta. `write` makes the file.
Shot mapped(const std::string& file, glm::ivec2 size,
            const std::function<void(const std::string& path)>& write, const std::string& material = "") {
  const TemporaryFolder folder;
  write(folder / file);
  std::ofstream(folder / "scene.json") << fmt::format(
      R"({{"lighting": false, "background": [1, 0, 1], "camera": {{"eye": [0, 2, 0], "target": [0, 0, 0], "up": [0, 0, -1], "orthographic": 1}},
          "materials": {{"m": {{"diffuse": 1, "diffuse_map": "{}"{}}}}}, "objects": [{{"primitive": "plane", "scale": 2, "material": "m"}}]}})",
      file, material);
  return shoot(loadScene(folder / "scene.json"), size);
}

/// A binary file: text, then bytes.
std::function<void(const std::string&)> pnm(const std::string& header,
                                            const std::vector<std::uint8_t>& bytes) {
  return [=](const std::string& path) {
    std::ofstream file(path, std::ios::binary);
    file << header;
    file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  };
}

/// The map between two texels' centres along an axis, `place` in texels from the first one's.
double between(const std::vector<double>& texels, double place) {
  const int n = int(texels.size()), first = int(std::floor(place));
  const double share = place - first;
  return texels[std::size_t((first + n) % n)] * (1 - share) + texels[std::size_t((first + 1) % n)] * share;
}

// What a value of at most 1 may lose: the decoded code is a float (2⁻²⁵), as are the shares and the mixes
// along two axes (2⁻²⁵ each, the shares' times the difference of two texels), and the product with the
// diffuse colour of 1 nothing. A texture coordinate is a float in [0, 1], off by 2⁻²⁵, which moves the place
// by as much of the side in texels, and the colour by no more than that times the step between texels, 1 at
// most.
double tolerance(int texels) { return (6 + texels) * 0x1p-25; }

TEST(HardTextures, OneTexelIsOneColour) {
  const Shot shot = mapped("map.ppm", {17, 17}, pnm("P6 1 1 255\n", {200, 100, 3}));
  const glm::vec3 expected(linear(200 / 255.0), linear(100 / 255.0), linear(3 / 255.0));
  for (int y = 0; y < 17; ++y)
    for (int x = 0; x < 17; ++x)
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(colorAt(shot.image, x, y)[c], expected[c], tolerance(1));
}

TEST(HardTextures, GreyIsGreyAndBlendsInLinearLight) {
  // Three texels across, one down, repeated: 64, 128, 255 of 255.
  const Shot shot = mapped("map.pgm", {60, 60}, pnm("P5 3 1 255\n", {64, 128, 255}));
  const std::vector<double> texels{linear(64 / 255.0), linear(128 / 255.0), 1};
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) {
      const double expected = between(texels, 3 * (x + 0.5) / 60 - 0.5);
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(colorAt(shot.image, x, y)[c], expected, tolerance(3)) << x << "," << y;
    }
  // By hand: pixel 29 looks at 3 · 29.5 / 60 − 0.5 = 0.975 texels.
  EXPECT_NEAR(colorAt(shot.image, 29, 7).x, 0.025 * 0.0512695 + 0.975 * 0.2158605, 1e-6);
}

/// One row of R G B A in 16 bits.
std::string rowOfPng(const std::vector<std::array<std::uint16_t, 4>>& texels) {
  std::string row(1, '\0');  // unfiltered
  for (const auto& texel : texels)
    for (const std::uint16_t value : texel) row += {char(value >> 8), char(value)};
  return pngFile(std::uint32_t(texels.size()), 1, 16, 6, false, "", row);
}

TEST(HardTextures, SixteenBitsAreKept) {
  // Codes that differ in their low bytes only, or from white by one.
  const std::vector<std::array<std::uint16_t, 4>> codes{{0x1234, 0x8001, 3, 0xffff},
                                                        {0x1235, 0x8002, 2, 0xffff},
                                                        {0xfffe, 0x7fff, 1, 0xffff},
                                                        {0x1134, 0xff00, 0, 0xffff}};
  const Shot shot = mapped("map.png", {4, 4}, [&](const std::string& path) {
    std::ofstream(path, std::ios::binary) << rowOfPng(codes);
  });
  for (int x = 0; x < 4; ++x)  // a pixel a texel, seen at its centre
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(colorAt(shot.image, x, 2)[c], linear(codes[std::size_t(x)][std::size_t(c)] / 65535.0),
                  tolerance(4));
  EXPECT_LT(colorAt(shot.image, 0, 0).x, colorAt(shot.image, 1, 0).x);
  EXPECT_LT(colorAt(shot.image, 2, 0).x, 1.0f);
}

TEST(HardTextures, AlphaMakesHolesAndLeavesColourAlone) {
  // Codes of alpha: 0, 127, 128, 255 from left to right; the cutoff is one half. 127/255 is below it.
  const auto write = [](const std::string& path) {
    Image image{4, 1, {"R", "G", "B", "A"}, {}};
    for (const int alpha : {0, 127, 128, 255})
      for (const float value : {1.0f, 0.25f, 0.0f, float(alpha) / 255.0f}) image.pixels.push_back(value);
    writeImage(image, path, {});
  };
  // 0.25 is sRGB code 136.96, in eight bits 137.
  const glm::vec3 color(1, linear(137 / 255.0), 0), behind(1, 0, 1);
  const Shot holes = mapped("map.png", {4, 4}, write, R"(, "alpha_cutoff": 0.5)"),
             opaque = mapped("map.png", {4, 4}, write);
  for (int x = 0; x < 4; ++x) {
    const glm::vec3 seen = colorAt(holes.image, x, 1), whole = colorAt(opaque.image, x, 1);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(seen[c], (x < 2 ? behind : color)[c], tolerance(4)) << x;
      EXPECT_NEAR(whole[c], color[c], tolerance(4)) << x;
    }
  }
}

TEST(HardTextures, SixteenThousandTexelsAcrossAreTold) {
  // 16384 × 4 texels, dark but for texel 9999 of each row. A pixel is a texel: the picture is a crop of one
  // of 16384 pixels a side.
  constexpr int kWidth = 16384, kBright = 9999;
  std::vector<std::uint8_t> bytes(std::size_t(kWidth) * 4, 64);
  for (int row = 0; row < 4; ++row) bytes[std::size_t(row) * kWidth + kBright] = 255;
  const TemporaryFolder folder;
  pnm(fmt::format("P5 {} 4 255\n", kWidth), bytes)(folder / "map.pgm");
  std::ofstream(folder / "scene.json") <<
      R"({"lighting": false, "camera": {"eye": [0, 2, 0], "target": [0, 0, 0], "up": [0, 0, -1], "orthographic": 1},
          "materials": {"m": {"diffuse": 1, "diffuse_map": "map.pgm"}}, "objects": [{"primitive": "plane", "scale": 2, "material": "m"}]})";
  const Scene scene = loadScene(folder / "scene.json");
  ASSERT_EQ(scene.textures.at(0).levels.size(), 15u);
  const Shot shot = shoot(scene, glm::ivec2(kWidth), [](RenderSettings& settings) {
    settings.crop = Crop{kBright - 4, 8000, 9, 3};
  });
  for (int x = 0; x < 9; ++x) {
    // A coordinate near 0.61 is a float 2⁻²⁴ apart: off by 2⁻²⁵ · 16384 = 2⁻¹¹ of a texel, which lets in as
    // much of the neighbour. A pixel's width is a texel's to rounding, which the next level's share of log2(1
    // + 10⁻⁸) doesn't matter to.
    EXPECT_NEAR(colorAt(shot.image, x, 1).x, x == 4 ? 1 : linear(64 / 255.0), 0x1p-11 + 1e-6) << x;
  }
  // From afar the whole is the coarsest level's mean.
  const Shot small = shoot(scene, {1, 1});
  EXPECT_NEAR(small.image.pixels[0], linear(64 / 255.0), 2e-3);
}

TEST(HardTextures, HeadersThatPromiseMoreThanTheFileHoldsAreRefused) {
  // 16384 × 16384 in a few bytes; one texel too wide; and one that is what it says, but cut short.
  for (const auto& [header, expected] : {std::pair("P5 16384 16384 255\n", "claims 16384 x 16384 pixels"),
                                         {"P6 32769 1 255\n", "expected 1 to 32768 a side"},
                                         {"P5 16 16 255\n", "map.pgm: "}}) {
    try {
      mapped("map.pgm", {4, 4}, pnm(header, {1, 2, 3}));
      FAIL() << "read " << header;
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("map.pgm: "), std::string::npos) << message;
      EXPECT_NE(message.find(expected), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
}

}  // namespace
}  // namespace luciole::test
