#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "image/make_normals.hpp"
#include "image/read_texture.hpp"
#include "image/srgb.hpp"
#include "luciole/error.hpp"
#include "luciole/image.hpp"
#include "luciole/texture.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

constexpr int kTextureWidth = 7, kTextureHeight = 5;  // odd, so that levels have texels of unequal weights

/// 8-bit codes of a picture that has no two texels alike, RGBA.
std::vector<int> someCodes() {
  std::vector<int> codes;
  for (int i = 0; i < kTextureWidth * kTextureHeight; ++i)
    for (const int code : {7 * i, 255 - 5 * i, 90 + 3 * i, 255 - 2 * i}) codes.push_back(code);
  return codes;
}

std::vector<std::uint16_t> wideCodes(const std::vector<int>& codes) {
  std::vector<std::uint16_t> wide;
  for (const int code : codes) wide.push_back(std::uint16_t(code * 257));
  return wide;
}

/// What a reader makes of a PNG with these codes.
Texture readBack(const std::vector<int>& codes) {
  const test::TemporaryFolder folder;
  Image image{kTextureWidth, kTextureHeight, {"R", "G", "B", "A"}, {}};
  for (std::size_t i = 0; i < codes.size(); ++i)
    image.pixels.push_back(float(i % 4 == 3 ? codes[i] / 255.0 : decodeSrgb(codes[i] / 255.0)));
  writeImage(image, folder / "a.png", {});
  return readTexture(folder / "a.png");
}

void expectSameLevels(const Texture& a, const Texture& b) {
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.alpha_varies, b.alpha_varies);
  ASSERT_EQ(a.levels.size(), b.levels.size());
  for (std::size_t i = 0; i < a.levels.size(); ++i) {
    EXPECT_EQ(a.levels[i].width, b.levels[i].width);
    EXPECT_EQ(a.levels[i].height, b.levels[i].height);
    EXPECT_EQ(a.levels[i].texels, b.levels[i].texels) << "level " << i;
  }
}

std::string faultOf(int width, int height, std::size_t count, const std::string& name = "") {
  const std::vector<std::uint16_t> texels(count);
  try {
    makeTexture(width, height, texels, TextureKind::kColor, false, name);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(MakeTexture, OfCodesIsWhatAFileOfThemGives) {
  const std::vector<int> codes = someCodes();
  const Texture made =
      makeTexture(kTextureWidth, kTextureHeight, wideCodes(codes), TextureKind::kColor, false, "mine");
  EXPECT_EQ(made.name, "mine");
  EXPECT_TRUE(made.alpha_varies);
  expectSameLevels(made, readBack(codes));
}

TEST(MakeTexture, OfNormalsAndHeightsIsWhatAFileOfThemGives) {
  const std::vector<int> codes = someCodes();
  for (const TextureKind kind : {TextureKind::kNormals, TextureKind::kBump}) {
    Texture read = readBack(codes);
    makeNormals(kind, read);
    for (const bool linear : {false, true})
      expectSameLevels(makeTexture(kTextureWidth, kTextureHeight, wideCodes(codes), kind, linear), read);
  }
}

// A code is off by half of 2⁻¹⁶, the number that it decodes to by at most 2.3 times as much, the slope at 1.
TEST(MakeTexture, LinearNumbersAreWhatLookupsDecode) {
  std::vector<std::uint16_t> numbers;
  for (int i = 0; i < 64; ++i)
    for (const int number : {1000 * i, 65535 - i, 7 * i, 1030 * i}) numbers.push_back(std::uint16_t(number));
  const Texture made = makeTexture(8, 8, numbers, TextureKind::kColor, true);
  EXPECT_TRUE(made.linear);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::uint16_t texel = made.levels[0].texels[i];
    const double expected = numbers[i] / 65535.0;
    if (i % 4 == 3)
      EXPECT_EQ(texel, numbers[i]);
    else
      EXPECT_NEAR(linearOfSrgb16()[texel], expected, 1.15 * 0x1p-16);
  }
}

TEST(MakeTexture, RefusesSizesThatDontFit) {
  EXPECT_EQ(faultOf(0, 4, 0), "size: 0x4, expected 1 to 32768 a side");
  EXPECT_EQ(faultOf(4, -1, 0, "leaf"), "leaf: size: 4x-1, expected 1 to 32768 a side");
  EXPECT_EQ(faultOf(32769, 1, 4 * 32769), "size: 32769x1, expected 1 to 32768 a side");
  EXPECT_EQ(faultOf(2, 3, 23), "texels: has 23 elements, expected 24, 4 a texel");
  EXPECT_EQ(faultOf(32768, 32768, 4), "texels: has 4 elements, expected 4294967296, 4 a texel");
}

}  // namespace
}  // namespace luciole
