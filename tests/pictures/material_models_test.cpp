// Materials that choose their models.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "kernels/probe.hpp"
#include "luciole/gbuffer_file.hpp"
#include "reference/reference.hpp"
#include "render/plan.hpp"
#include "render_json.hpp"
#include "scene/models.hpp"

namespace luciole::test {
namespace {

constexpr int kModels = int(std::size(kAllModels));
constexpr glm::ivec2 kBallsSize{90, 40};

/// A ball of each model in a row, before a floor that chooses none. Red of the diffuse colour tells them
/// apart: ball i has (i + 1)/16, the floor 1. `only`: the model of all surfaces.
std::string ballsOf(int lights, const char* only = nullptr) {
  std::string materials, objects;
  for (int i = 0; i < kModels; ++i) {
    materials += fmt::format(
        R"("m{0}": {{"diffuse": [{1}, 0.5, 0.4], "specular": 0.3, "shininess": {2}, "model": "{3}"}}, )", i,
        (i + 1) / 16.0, 1 << i, only ? only : kModelNames[std::size_t(i)]);
    objects += fmt::format(
        R"({{"primitive": "sphere", "segments": 16, "translate": [{}, 0.6, 0], "material": "m{}"}}, )",
        2.1 * (i - (kModels - 1) / 2.0), i);
  }
  const std::string floor = only ? fmt::format(R"(, "model": "{}")", only) : "";
  return fmt::format(
      R"({{"camera": {{"eye": [0, 2, 9], "target": [0, 0.5, 0], "fov_y": 28}}, "ambient": 0.1,
      "materials": {{{} "f": {{"diffuse": [1, 0.5, 0.4], "specular": 0.2, "shininess": 9{}}}}},
      "objects": [{} {{"primitive": "plane", "scale": 30, "segments": 9, "material": "f"}}],
      "lights": [{{"type": "directional", "direction": [-1, -2, -1.5], "intensity": 0.5, "shadow": true}},
                 {{"type": "point", "position": [1, 3, 3], "attenuation": [0, 0, 0.1]}}],
      "light_fields": [{{"count": {}, "seed": 3, "min": [-6, 0, -3], "max": [6, 3, 5], "range": 2}}]}})",
      materials, floor, objects, lights);
}

/// For each pixel the number of the ball that it shows, kModels for the floor, -1 for nothing.
std::vector<int> surfacesSeen(const GBuffer& gbuffer) {
  std::vector<int> seen;
  for (int y = 0; y < gbuffer.height; ++y)
    for (int x = 0; x < gbuffer.width; ++x) {
      const std::size_t at = gbuffer.index(x, y);
      const int number = int(std::lround(16 * gbuffer.diffuse[at])) - 1;
      seen.push_back(!std::isfinite(gbuffer.position[at + 2 * gbuffer.pixels()]) ? -1
                     : number >= kModels                                         ? kModels
                                                                                 : number);
    }
  return seen;
}

struct LitCase {
  const char* name;
  Shading shading;
  int lights;
  ShadowMethod shadows;
};

class MaterialModels : public testing::TestWithParam<LitCase> {
 protected:
  static RenderSettings settingsOf(const Scene& scene) {
    RenderSettings settings = settingsFor(scene, kBallsSize);
    settings.shading = GetParam().shading;
    settings.shade.shadows = GetParam().shadows;
    settings.shade.model = Model::kToon;  // the floor's
    return settings;
  }
};

TEST_P(MaterialModels, LightEachSurfaceAsAPictureOfItsModelAlone) {
  const LitCase of = GetParam();
  OpenedDevice& device = deviceWithLanes(16);
  const Scene mixed = sceneFromJson(ballsOf(of.lights));
  Stats stats;
  const Image shown = renderScene(device, mixed, settingsOf(mixed), stats);
  RenderSettings phong = settingsOf(mixed);
  phong.shading = Shading::kPhong;
  const std::vector<int> surfaces = surfacesSeen(rasterizeScene(&device, mixed, phong, stats));
  std::vector<int> pixels(kModels + 1);
  for (int model = 0; model < kModels; ++model) {
    const Scene alone = sceneFromJson(ballsOf(of.lights, kModelNames[std::size_t(model)]));
    const Image truth = picture(alone, settingsOf(alone), device);
    int different = 0;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      const int of_surface = surfaces[i] == kModels ? int(Model::kToon) : surfaces[i];
      if (of_surface != model) continue;
      ++pixels[std::size_t(surfaces[i])];
      for (std::size_t c = 0; c < 3; ++c) different += shown.pixels[3 * i + c] != truth.pixels[3 * i + c];
    }
    EXPECT_EQ(different, 0) << kModelNames[std::size_t(model)];
  }
  EXPECT_GT(*std::min_element(pixels.begin(), pixels.end()), 50) << "too few to tell";
}

// So at every width each surface is as a picture of its model alone, whose programs needn't be compiled for
// that.
TEST_P(MaterialModels, HaveTheSameBitsAtEveryWidth) {
  const Scene mixed = sceneFromJson(ballsOf(GetParam().lights));
  const Image widest = picture(mixed, settingsOf(mixed), deviceWithLanes(16));
  for (const int lanes : widths())
    EXPECT_EQ(picture(mixed, settingsOf(mixed), deviceWithLanes(lanes)).pixels, widest.pixels)
        << lanes << " lanes";
}
INSTANTIATE_TEST_SUITE_P(Cases, MaterialModels,
                         testing::Values(LitCase{"Lists", Shading::kPhong, 20, ShadowMethod::kExact},
                                         LitCase{"Tiles", Shading::kPhong, 200, ShadowMethod::kOff},
                                         LitCase{"Vertices", Shading::kGouraud, 20, ShadowMethod::kOff}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(MaterialModel, ThatAllSurfacesHaveIsThePicturesAndNeedsNoPlane) {
  const Scene toons = sceneFromJson(ballsOf(5, "toon"));
  RenderSettings settings = settingsFor(toons, kBallsSize);
  settings.shade.model = Model::kCookTorrance;  // of surfaces that choose none
  Stats stats;
  const Image shown = renderScene(testDevice(), toons, settings, stats);
  EXPECT_FALSE(planPicture(toons, settings).features.has(Feature::kMaterialModels));
  EXPECT_TRUE(rasterizeScene(&testDevice(), sceneFromJson(R"({"objects": [{"primitive": "box"}],
      "lights": [{"type": "point", "position": [3, 3, 3]}]})"),
                             settings, stats)
                  .model.empty());
  settings.shade.model = Model::kToon;
  EXPECT_EQ(shown.pixels, picture(toons, settings).pixels);
}

TEST(MaterialModel, GBufferFilesKeepThem) {
  const TemporaryFolder folder;
  const Scene mixed = sceneFromJson(ballsOf(20));
  RenderSettings settings = settingsFor(mixed, kBallsSize);
  settings.shade.shadows = ShadowMethod::kOff;
  Stats stats;
  writeGBuffer(rasterizeScene(&testDevice(), mixed, settings, stats), folder / "g.exr", {});
  const GBuffer read = readGBuffer(folder / "g.exr");
  EXPECT_EQ(shadeGBuffer(testDevice(), mixed, read, settings, stats).pixels, picture(mixed, settings).pixels);
}

TEST(MaterialModel, PicturesOfSeveralHaveNoClusters) {
  const Scene mixed = sceneFromJson(ballsOf(1)), phong = sceneFromJson(ballsOf(1, "phong"));
  RenderSettings settings = settingsFor(mixed, kBallsSize);
  settings.shade.light_error = 0.1f;
  settings.shade.always_clusters = true;
  EXPECT_FALSE(planPicture(mixed, settings).features.has(Feature::kClusteredLights));
  EXPECT_TRUE(planPicture(phong, settings).features.has(Feature::kClusteredLights));
}

}  // namespace
}  // namespace luciole::test
