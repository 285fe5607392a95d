#include "raster/opacity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "raster_scenes.hpp"

namespace luciole::test {
namespace {

// Bit for bit, for any mixture of maps and colours, inside the triangle and outside it.
TEST(Opacity, PlacesTogetherHaveTheHolesThatEachHasAlone) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::uniform_int_distribution<int> map(-1, 1), coin(0, 1);
  const auto point = [&](float reach) {
    return reach * (2.0f * glm::vec3(unit(random), unit(random), 0.5f) - 1.0f);
  };
  int holes = 0, solid = 0;
  for (int repeat = 0; repeat < 500; ++repeat) {
    Material material = doubleSided();
    material.alpha = 0.5f + unit(random);
    material.alpha_cutoff = 0.3f;
    material.blended = repeat % 2 == 1;
    material.diffuse_map = {map(random), Wrap::kRepeat, Wrap::kMirroredRepeat};
    material.alpha_map = {map(random), Wrap::kClampToEdge, Wrap::kRepeat};
    const float z = -1.0f - 9.0f * unit(random);
    Scene scene = meshScene({point(2.0f) + glm::vec3(0, 0, z), point(2.0f) + glm::vec3(0, 0, 1.5f * z),
                             point(2.0f) + glm::vec3(0, 0, z)},
                            {{0, 1, 2}}, material);
    scene.textures = {randomChain({8, 4}, random), randomChain({8, 4}, random)};
    scene.textures[0].alpha_varies = true;
    Mesh& mesh = scene.meshes[0];
    if (repeat % 5 != 0)
      for (int i = 0; i < 3; ++i) mesh.uvs.emplace_back(point(3.0f));
    if (coin(random))
      for (int i = 0; i < 3; ++i) mesh.colors.emplace_back(1.0f, 1.0f, 1.0f, unit(random));
    const View view = coin(random) ? cameraView(frontCamera(), {64, 48}) : pixelView({64, 48});
    const ViewPlane plane = viewPlane(view);
    const std::vector<PlacedObject> objects = placeObjects(scene, allObjects(scene), view.world_to_view);
    const Surface surface = makeSurface(scene, objects, 0, plane);
    Lanes<double> x, y;
    LaneMask wanted;
    for (int i = 0; i < kSquarePixels; ++i) {
      x[i] = double(64.0f * unit(random));
      y[i] = double(48.0f * unit(random));
      wanted[i] = coin(random);
    }
    const SampleNumber sample{repeat % 7, 7};
    const LaneMask seen = holesIn(scene, surface, plane, x, y, wanted, sample);
    for (int i = 0; i < kSquarePixels; ++i) {
      EXPECT_EQ(seen[i],
                wanted[i] && isHole(scene, surface, plane, {x[i], y[i]}, {int(x[i]), int(y[i])}, sample))
          << repeat << ", " << i;
      (seen[i] ? holes : solid) += wanted[i];
    }
  }
  EXPECT_GT(holes, 500);
  EXPECT_GT(solid, 500);
}

/// The share of samples that see a surface of 1024 x 1024 texels, of which in each square of 8 x 8 all but 4
/// x 4 are holes. It fills a picture of pixels x pixels.
double shareSeen(int pixels, int samples) {
  Material material = doubleSided();
  material.alpha_cutoff = 0.5f;
  material.diffuse_map = {0};
  Scene scene = meshScene({{-1, -1, -1}, {3, -1, -1}, {-1, 3, -1}}, {{0, 1, 2}}, material);
  scene.meshes[0].uvs = {{0, 4}, {8, 4}, {0, -4}};
  Texture texture;
  for (int side = 256; side >= 1; side /= 2) {
    MipLevel level{side, side, {}};
    const int block = side / 64;  // texels of a block's side, if any
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const bool solid = block > 0 && x / block % 2 == 0 && y / block % 2 == 0;
        const int alpha = block == 0 ? 65535 / 4 : solid ? 65535 : 0;
        level.texels.insert(level.texels.end(), {65535, 65535, 65535, std::uint16_t(alpha)});
      }
    texture.levels.push_back(level);
  }
  texture.alpha_varies = true;
  scene.textures = {texture};
  Camera camera = frontCamera();
  camera.fov_y = glm::half_pi<double>();
  const View view = cameraView(camera, {pixels, pixels});
  const ViewPlane plane = viewPlane(view);
  const std::vector<PlacedObject> objects = placeObjects(scene, allObjects(scene), view.world_to_view);
  const Surface surface = makeSurface(scene, objects, 0, plane);
  int seen = 0;
  for (int y = 0; y < pixels; ++y)
    for (int x = 0; x < pixels; ++x)
      for (int i = 0; i < samples; ++i) {
        const glm::dvec2 place = glm::dvec2(x, y) + samplePoint(i, samples) - 0.5;
        seen += !isHole(scene, surface, plane, place, {x, y}, {i, samples});
      }
  return double(seen) / (pixels * pixels * samples);
}

TEST(Opacity, HolesKeepTheirShareOfASurfaceWithDistance) {
  // Samples closer than texels: a quarter, but for the corners, which lookups between texels round.
  EXPECT_NEAR(shareSeen(1024, 4), 0.25, 0.01);
  // Far away all opacities are ¼. A threshold t is at ½ + s (t − ½), s = 1 − kTestedTexels / n for samples of
  // n texels, and below ¼ where t < ½ − ¼ / s. Of the 4 samples of a pixel one is kept or none.
  for (const int texels_across : {32, 64, 128}) {
    const int pixels = 1024 / texels_across;
    const double n = texels_across * texels_across / 4.0, share = 0.5 - 0.25 / (1 - kTestedTexels / n);
    const double deviation = std::sqrt(4 * share * (1 - 4 * share)) / 4 / pixels;
    EXPECT_NEAR(shareSeen(pixels, 4), share, 4 * deviation) << texels_across;
    EXPECT_NEAR(share, 0.25, 0.09);
  }
  // One sample is tested against the cutoff, and ¼ is below it.
  EXPECT_EQ(shareSeen(16, 1), 0);
}

}  // namespace
}  // namespace luciole::test
