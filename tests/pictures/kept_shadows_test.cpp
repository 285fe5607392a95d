#include "render/kept_picture.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "kernels/random_scene.hpp"
#include "render_json.hpp"

// Pictures of a scene that moves, one after another with what the one before left, and each by itself.
namespace luciole::test {
namespace {

constexpr const char* kKeptScene = R"({
  "camera": {"eye": [3, 2.5, 6], "target": [0, 0.5, 0]}, "ambient": [0.02, 0.02, 0.03],
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4]}},
  "objects": [{"primitive": "plane", "scale": 20, "material": "m"}, {"primitive": "sphere", "translate": [0, 1, 0], "material": "m"},
              {"primitive": "torus", "translate": [1, 0.5, 2], "rotate": [60, 0, 20], "material": "m"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "intensity": 0.5, "angle": 3, "shadow": true},
             {"type": "point", "position": [1, 2, 2], "range": 4, "radius": 0.1, "shadow": true},
             {"type": "point", "position": [-1, 3, 1], "radius": 0.1, "shadow": true},
             {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 40, "radius": 0.1, "shadow": true}]})";

/// Moves something, or nothing.
void moveSomething(Scene& scene, Camera& camera, Random& random) {
  const auto step = [&] { return glm::dvec4(0.3 * random.direction(), 0); };
  switch (random.below(6)) {
    case 0:
      camera.camera_to_world[3] += step();
      break;
    case 1:
      scene.lights[1].position += glm::dvec3(step());
      break;
    case 2:
      scene.objects[2].object_to_world[3] += step();
      break;
    case 3:
      scene.objects[1].object_to_world[3] += 10.0 * step();
      break;
    case 4:
      std::swap(scene.objects[1].mesh, scene.objects[2].mesh);
      break;
    default:
      break;
  }
}

/// Makes pictures one after another, and each by itself.
void expectSamePictures(OpenedDevice& device, const RenderSettings& given, int frames) {
  Random random(17);
  Scene scene = sceneFromJson(kKeptScene);
  RenderSettings settings = given;
  settings.camera = scene.cameras.front();
  KeptPicture kept;
  for (int frame = 0; frame < frames; ++frame) {
    Stats stats;
    std::vector<float> pixels;
    const auto take = [&](const Image& rows) {
      pixels.insert(pixels.end(), rows.pixels.begin(), rows.pixels.end());
    };
    renderBands(device, scene, settings, take, stats, &kept);
    ASSERT_EQ(pixels, picture(scene, settings).pixels)
        << "frame " << frame << ", samples " << settings.samples;
    moveSomething(scene, settings.camera, random);
  }
}

RenderSettings keptSettings(ShadowMethod method, int samples) {
  RenderSettings settings;
  settings.size = {80, 60};
  settings.shade.shadow_limits.size = 256;
  settings.shade.shadows = method;
  settings.samples = samples;
  return settings;
}

class KeptPictures : public testing::TestWithParam<ShadowMethod> {};

TEST_P(KeptPictures, AreThoseThatAreMadeByThemselves) {
  for (const int samples : {1, 4}) expectSamePictures(testDevice(), keptSettings(GetParam(), samples), 14);
}

TEST_P(KeptPictures, AreSoOnADeviceWithMemoryOfItsOwn) {
  OpenedDevice device;
  openDevice("", device);
  device.shares_host_memory = false;
  expectSamePictures(device, keptSettings(GetParam(), 1), 8);
}

INSTANTIATE_TEST_SUITE_P(Methods, KeptPictures,
                         testing::Values(ShadowMethod::kHard, ShadowMethod::kPcf, ShadowMethod::kSoft,
                                         ShadowMethod::kExact, ShadowMethod::kSoftExact, ShadowMethod::kAuto),
                         shadowMethodName);

}  // namespace
}  // namespace luciole::test
