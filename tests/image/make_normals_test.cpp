#include "image/make_normals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/glm.hpp>

#include "image/srgb.hpp"

namespace luciole {
namespace {

Texture picture(int width, int height, const std::function<glm::vec3(int, int)>& number) {
  MipLevel level{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::vec3 rgb = number(x, y);
      for (int c = 0; c < 3; ++c) level.texels.push_back(std::uint16_t(rgb[c] * 65535.0f + 0.5f));
      level.texels.push_back(30000);
    }
  return {.name = "", .levels = {level}};
}

/// What a lookup in the middle of a texel gives, as a vector. A code is off by half of 2⁻¹⁶, a number by at
/// most 2.3 times as much, the slope of sRGB at 1.
glm::vec3 vectorAt(const Texture& texture, int level, int x, int y) {
  const MipLevel& mip = texture.levels[std::size_t(level)];
  const std::uint16_t* texel = &mip.texels[(std::size_t(y) * mip.width + x) * 4];
  glm::vec3 vector;
  for (int c = 0; c < 3; ++c)
    vector[c] = 2 * (level == 0 ? linearOfSrgb16()[texel[c]] : linearOfRoot16(texel[c])) - 1;
  return vector;
}
constexpr float kCodeError = 2.3f * 0x1p-16f;

void expectNear(const glm::vec3& a, const glm::vec3& b, float error) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], error);
}

TEST(MakeNormals, NumbersOfAFileStayAsTheyAre) {
  Texture texture =
      picture(2, 1, [](int x, int) { return x ? glm::vec3(1, 0.25f, 0.75f) : glm::vec3(0, 0.5f, 1); });
  makeNormals(TextureKind::kNormals, texture);
  expectNear(vectorAt(texture, 0, 0, 0), {-1, 0, 1}, kCodeError);
  expectNear(vectorAt(texture, 0, 1, 0), {1, -0.5f, 0.5f}, kCodeError);
  // The mean of both: a root's code is off by half of 2⁻¹⁶ too, and its square's slope is 2.
  expectNear(vectorAt(texture, 1, 0, 0), {0, -0.25f, 0.75f}, 2 * kCodeError);
  EXPECT_FALSE(texture.alpha_varies);
}

TEST(MakeNormals, HeightsBecomeTheirSlopes) {
  // Rising to the right by 0.01 a texel: 100 texels are 1, and the picture is 50 wide, so that white is half
  // a texel up.
  Texture texture = picture(50, 20, [](int x, int) { return glm::vec3(0.01f * float(x)); });
  makeNormals(TextureKind::kBump, texture);
  const float slope = 0.01f * float(kBumpHeight) * 50;
  expectNear(vectorAt(texture, 0, 20, 10), glm::normalize(glm::vec3(-slope, 0, 1)), 2 * kCodeError);
  // Downwards, heights rise: the surface leans upwards in the picture.
  texture = picture(20, 50, [](int, int y) { return glm::vec3(0.02f * float(y)); });
  makeNormals(TextureKind::kBump, texture);
  expectNear(vectorAt(texture, 0, 10, 20), glm::normalize(glm::vec3(0, 2 * slope, 1)), 2 * kCodeError);
  // Around the edge it falls by all that it rose: half of 49 steps less one on either side.
  expectNear(vectorAt(texture, 0, 10, 0), glm::normalize(glm::vec3(0, -48.0f / 2 * 2 * slope, 1)),
             2 * kCodeError);
}

TEST(MakeNormals, ABumpMapThatLooksLikeNormalsHoldsThem) {
  const auto blue = [](int x, int y) {
    return glm::vec3(0.4f + 0.1f * float(x), 0.4f + 0.2f * float(y), 0.9f);
  };
  Texture bump = picture(2, 2, blue), normals = bump;
  makeNormals(TextureKind::kBump, bump);
  makeNormals(TextureKind::kNormals, normals);
  EXPECT_EQ(bump.levels[0].texels, normals.levels[0].texels);
}

}  // namespace
}  // namespace luciole
