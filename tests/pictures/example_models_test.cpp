// The models of kernels/examples/ in pictures.
#include <gtest/gtest.h>

#include "kernels/probe.hpp"
#include "reference/reference_picture.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

constexpr glm::ivec2 kExampleSize{80, 60};

std::string exampleModel(const std::string& name) {
  return LUCIOLE_SOURCE_DIR "/kernels/examples/" + name + ".clh";
}

/// The lesson's scene, with so many lights more that each pixel has many.
Scene lessonScene(int lights) {
  Scene scene = loadScene(LUCIOLE_SOURCE_DIR "/scenes/lesson/shaders.json");
  for (int i = 0; i < lights; ++i) {
    Light light;
    light.position = {3 * std::sin(i), 1 + 0.01f * float(i), 3 * std::cos(i)};
    light.range = 4;
    light.diffuse = light.specular = glm::vec3(0.02f);
    scene.lights.push_back(light);
  }
  return scene;
}

// 200 lights without shadows are summed by another kernel.
TEST(ExampleModels, WardsFileHasTheBitsOfTheBuiltInModelAtEveryWidth) {
  for (const int lights : {0, 200}) {
    Scene scene = lessonScene(lights);
    RenderSettings settings = settingsFor(scene, kExampleSize);
    if (lights > 0) settings.shade.shadows = ShadowMethod::kOff;
    settings.shade.model = Model::kWard;
    const Image built_in = picture(scene, settings);
    settings.shade.model = addUserModel(exampleModel("ward"), scene);
    for (const int lanes : widths())
      EXPECT_EQ(picture(scene, settings, deviceWithLanes(lanes)).pixels, built_in.pixels)
          << lights << " lights, " << lanes << " lanes";
  }
}

class ExampleModel : public testing::TestWithParam<const char*> {};

// Within what the README promises of built-in models.
TEST_P(ExampleModel, IsItsOwnTextInDoubleAndAnotherPictureThanPhongs) {
  Scene scene = lessonScene(0);
  RenderSettings settings = settingsFor(scene, kExampleSize);
  settings.shade.shadows = ShadowMethod::kOff;
  const Image phong = picture(scene, settings);
  settings.shade.model = addUserModel(exampleModel(GetParam()), scene);
  const Image shown = picture(scene, settings);
  std::vector<glm::ivec2> pixels;
  for (int y = 0; y < kExampleSize.y; ++y)
    for (int x = 0; x < kExampleSize.x; ++x) pixels.push_back({x, y});
  const std::vector<glm::dvec3> truth =
      referencePicture(scene, cameraView(settings.camera, settings.size), Shading::kPhong, 1, pixels,
                       {.model = settings.shade.model});
  double most = 0, worst = 0, from_phong = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double color = shown.pixels[3 * i + std::size_t(c)];
      most = std::max(most, truth[i][c]);
      worst = std::max(worst, std::abs(color - truth[i][c]));
      from_phong = std::max(from_phong, std::abs(color - phong.pixels[3 * i + std::size_t(c)]));
    }
  EXPECT_LE(worst, 1e-5 * most);
  EXPECT_GT(from_phong, 0.1);
}
INSTANTIATE_TEST_SUITE_P(Each, ExampleModel,
                         testing::Values("ward", "ward_anisotropic", "minnaert", "cloth", "rim"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, '_');
                           return name;
                         });

}  // namespace
}  // namespace luciole::test
