// The promise on the README's front: how far the default picture may lie from the double-precision reference.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "reference/reference_picture.hpp"
#include "render_json.hpp"
#include "scene/models.hpp"

namespace luciole::test {
namespace {

/// Holds a scene's default picture, shadows off, against the reference at 20,000 of its pixels. steepness:
/// what the model multiplies the errors of cosines by, in places.
void expectPromise(const std::string& path, Model model = Model::kPhong, double steepness = 1) {
  const Scene scene = loadScene(path);
  RenderSettings settings;
  settings.camera = scene.cameras.front();
  settings.size = scene.size.value_or(settings.size);
  settings.shade.shadows = ShadowMethod::kOff;
  settings.shade.model = model;
  Stats stats;
  const Image ours = renderScene(testDevice(), scene, settings, stats);
  std::mt19937 random(1);
  std::vector<glm::ivec2> pixels(20000);
  for (glm::ivec2& pixel : pixels)
    pixel = {int(random() % unsigned(ours.width)), int(random() % unsigned(ours.height))};
  const View view = cameraView(settings.camera, settings.size);
  const std::vector<glm::dvec3> truth =
      referencePicture(scene, view, Shading::kPhong, 1, pixels, {.model = model});

  double most = 0, worst = 0, sum = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const float* color =
        ours.pixels.data() + (std::size_t(pixels[i].y) * ours.width + pixels[i].x) * ours.channels.size();
    for (int c = 0; c < 3; ++c) {
      const double error = std::abs(color[c] - truth[i][c]);
      most = std::max(most, truth[i][c]);
      worst = std::max(worst, error);
      sum += error;
    }
  }
  const double mean = sum / double(3 * pixels.size());
  fmt::print("largest error {:.1e}, mean {:.1e} of the maximum\n", worst / most, mean / most);
  EXPECT_LE(worst, 1e-5 * steepness * most);
  EXPECT_LE(mean, 1e-7 * steepness * most);
}

class Promise : public testing::TestWithParam<const char*> {};
TEST_P(Promise, DefaultPictureIsTheReferences) {
  expectPromise(fmt::format("{}/scenes/{}.json", LUCIOLE_SOURCE_DIR, GetParam()));
}
INSTANTIATE_TEST_SUITE_P(Scenes, Promise,
                         testing::Values("fireflies", "underwater", "colonnade", "city", "spheres",
                                         "cornell"));

class PromiseOfModel : public testing::TestWithParam<std::tuple<Model, const char*>> {};
TEST_P(PromiseOfModel, PictureIsTheReferences) {
  const auto [model, scene] = GetParam();
  // Toon's ramps climb 1 in 1/32.
  expectPromise(fmt::format("{}/scenes/{}.json", LUCIOLE_SOURCE_DIR, scene), model,
                model == Model::kToon ? 32 : 1);
}
INSTANTIATE_TEST_SUITE_P(Scenes, PromiseOfModel,
                         testing::Combine(testing::ValuesIn(std::begin(kAllModels) + 1, std::end(kAllModels)),
                                          testing::Values("spheres", "cornell")));

class PromiseForShared : public testing::TestWithParam<const char*> {};
TEST_P(PromiseForShared, DefaultPictureIsTheReferences) {
  LUCIOLE_NEEDS_SHARED();
  expectPromise((sharedScenes() / GetParam()).string());
}
INSTANTIATE_TEST_SUITE_P(Scenes, PromiseForShared,
                         testing::Values("sponza_crytek_obj/sponza.obj", "quake_e1m1/e1m1.gltf"));

/// Vertices are lit by the same kernels, and their colours interpolated in floats: 8 more roundings of 2^-24.
class PromiseAtVertices : public testing::TestWithParam<Model> {};
TEST_P(PromiseAtVertices, HoldsForGouraudShadingToo) {
  const Scene scene = loadScene(LUCIOLE_SOURCE_DIR "/scenes/spheres.json");
  RenderSettings settings;
  settings.camera = scene.cameras.front();
  settings.size = {320, 180};
  settings.shading = Shading::kGouraud;
  settings.shade.model = GetParam();
  settings.shade.shadows = ShadowMethod::kOff;
  Stats stats;
  const Image ours = renderScene(testDevice(), scene, settings, stats);
  const std::vector<glm::ivec2> pixels = allPixels({320, 180});
  const auto truth = referencePicture(scene, cameraView(settings.camera, settings.size), Shading::kGouraud, 1,
                                      pixels, {.model = GetParam()});
  double most = 0, worst = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      most = std::max(most, truth[i][c]);
      worst = std::max(worst, std::abs(ours.pixels[3 * i + c] - truth[i][c]));
    }
  }
  EXPECT_LE(worst, 1e-5 * (GetParam() == Model::kToon ? 32 : 1) * most);
}
INSTANTIATE_TEST_SUITE_P(Models, PromiseAtVertices, testing::ValuesIn(kAllModels));

}  // namespace
}  // namespace luciole::test
