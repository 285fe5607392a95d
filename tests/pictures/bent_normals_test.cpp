// Pictures of surfaces whose normals a map bends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "luciole/gbuffer_file.hpp"
#include "rays/shadow_rays.hpp"
#include "reference/reference_picture.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

constexpr glm::ivec2 kBentSize(96, 64);

/// A floor and a ball, both of steep bumps (a ramp of 8 texels that repeats) and seen at a low angle.
/// `lights` as JSON.
Scene bumpyScene(const std::string& lights,
                 const char* map = R"("bump_map": "ramp.pgm", "normal_scale": 10,)") {
  const TemporaryFolder folder;
  std::ofstream(folder / "ramp.pgm") << "P2 8 2 255 0 30 60 90 120 150 200 255 255 200 150 120 90 60 30 0";
  std::ofstream(folder / "scene.json")
      << R"({"camera": {"eye": [0, 0.6, 5], "target": [0, 0.4, 0], "fov_y": 35},
             "materials": {"m": {)"
      << map << R"("diffuse": 0.7, "specular": 0.3, "shininess": 20, "double_sided": true}},
             "objects": [{"primitive": "plane", "scale": 8, "uv_scale": 40, "material": "m"},
                         {"primitive": "sphere", "segments": 16, "translate": [0, 0.8, 0], "scale": 0.7, "uv_scale": 3,
                          "material": "m"}], "lights": [)"
      << lights << "]}";
  return loadScene(folder / "scene.json");
}
constexpr const char* kSun = R"({"type": "directional", "direction": [-1, -0.3, -0.4], "shadow": true})";
constexpr const char* kBelow = R"({"type": "point", "position": [0, -0.3, 2], "intensity": 3})";

float brightest(const Image& image) { return *std::max_element(image.pixels.begin(), image.pixels.end()); }

TEST(BentNormals, LightFromBelowTheSurfaceDoesNotLeak) {
  Scene scene = bumpyScene(kBelow);
  scene.objects.resize(1);
  const RenderSettings settings = settingsFor(scene, kBentSize);
  EXPECT_EQ(brightest(picture(scene, settings)), 0.0f);
  // From above the bumps show.
  Scene lit = bumpyScene(R"({"type": "point", "position": [0, 0.3, 2], "intensity": 3})");
  EXPECT_GT(brightest(picture(lit, settings)), 0.1f);
}

/// Every light and shadow is exact but for floats' rounding: 2⁻²⁰ of 8, which is more than any pixel shows.
TEST(BentNormals, PicturesAreTheReferences) {
  const Scene scene = bumpyScene(std::string(kSun) + "," + kBelow);
  RenderSettings settings = settingsFor(scene, kBentSize);
  const View view = cameraView(settings.camera, kBentSize);
  const RayScene rays = buildShadowRays(scene, glm::dvec3(settings.camera.camera_to_world[3]));
  std::vector<glm::ivec2> pixels;
  for (int i = 0; i < kBentSize.x * kBentSize.y; ++i) pixels.emplace_back(i % kBentSize.x, i / kBentSize.x);
  const auto truth = referencePicture(scene, view, Shading::kPhong, 1, pixels, {.shadow_rays = &rays});
  settings.shade.shadows = ShadowMethod::kExact;
  const Image image = picture(scene, settings);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (int c = 0; c < 3; ++c)
      wrong += std::abs(image.pixels[3 * i + std::size_t(c)] - truth[i][c]) > 0x1p-17;
  EXPECT_EQ(wrong, 0u);
}

TEST(BentNormals, AGBufferFileGivesTheSamePicture) {
  const Scene scene = bumpyScene(std::string(kSun) + "," + kBelow);
  const TemporaryFolder folder;
  for (const ShadowMethod method : {ShadowMethod::kOff, ShadowMethod::kHard, ShadowMethod::kExact}) {
    RenderSettings settings = settingsFor(scene, kBentSize);
    settings.shade.shadows = method;
    Stats stats;
    writeGBuffer(rasterizeScene(nullptr, scene, settings, stats), folder / "g.exr", {}, "", "");
    const GBuffer read = readGBuffer(folder / "g.exr");
    EXPECT_EQ(read.unbent_normal.size(), read.pixels());
    EXPECT_TRUE(read.geometric_normal.empty());
    EXPECT_EQ(shadeGBuffer(testDevice(), scene, read, settings, stats).pixels,
              picture(scene, settings).pixels);
  }
}

TEST(BentNormals, ScenesWithoutMapsHaveNeitherPlaneNorFeature) {
  const Scene scene = bumpyScene(kBelow, "");
  const auto traits = materialTraits(scene);
  EXPECT_FALSE(traits.normal_maps);
  const FeatureSet features = neededFeatures(scene, scene.cameras[0], traits, {});
  EXPECT_FALSE(features.has(Feature::kNormalMaps));
  EXPECT_FALSE(neededPlanes(features).geometric_normal || neededPlanes(features).unbent_normal);
  for (const Mesh& mesh : scene.meshes) EXPECT_TRUE(mesh.tangents.empty());
}

}  // namespace
}  // namespace luciole::test
