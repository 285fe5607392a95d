#include "raster/opacity.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace luciole::test
