// Several devices make one picture. It has the bits that one of them gives.
#include "render/share_picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "lighting/count_picture.hpp"
#include "luciole/error.hpp"
#include "luciole/pose.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

/// A ball that moves, lights of every kind, shadows, fog, and many small lights.
constexpr const char* kScene =
    R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0], "fov_y": 60}, "background": [0, 0, 0.25], "ambient": 0.1,
  "fog": {"mode": "exp2", "density": 0.05, "color": [0.2, 0.3, 0.4]},
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}},
  "objects": [{"primitive": "plane", "scale": 20, "segments": 9, "material": "m"},
              {"primitive": "sphere", "translate": [0, 1, 0], "material": "m",
               "keys": [{"frame": 1, "translate": [0, 1, 0]}, {"frame": 5, "translate": [1, 1, 1]}]},
              {"primitive": "torus", "translate": [1, 0.5, 2], "rotate": [60, 0, 20], "material": "m"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "intensity": 0.5, "shadow": true, "angle": 3},
             {"type": "point", "position": [1, 2, 2], "radius": 0.1, "range": 4, "shadow": true, "color": [1, 0.5, 0.2]},
             {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 40, "exponent": 4, "shadow": true}],
  "light_fields": [{"count": 200, "seed": 3, "min": [-4, 0, -4], "max": [4, 2, 4], "range": 0.8, "intensity": 0.5}]})";

/// Two devices of different widths.
class SharedPictures : public testing::Test {
 protected:
  SharedPictures() {
    for (const char* selector : {",lanes=16", ",lanes=4"}) {
      openDevice(selector, devices.emplace_back());
      sharers.push_back({&devices.back()});
    }
  }

  Image shared(const Scene& scene, const RenderSettings& settings, Stats& stats, bool keeps = false) {
    Image picture;
    if (!keeps)
      for (Sharer& sharer : sharers) sharer.kept = {};
    renderShared(
        sharers, scene, settings,
        [&](const Image& rows) {
          picture.channels = rows.channels;
          picture.height += rows.height;
          picture.pixels.insert(picture.pixels.end(), rows.pixels.begin(), rows.pixels.end());
        },
        stats);
    return picture;
  }

  void expectBitsOfOne(const Scene& scene, const RenderSettings& settings, bool keeps = false) {
    Stats alone, together;
    const Image one = renderScene(testDevice(), scene, settings, alone);
    const Image several = shared(scene, settings, together, keeps);
    ASSERT_EQ(several.channels, one.channels);
    ASSERT_EQ(several.height, one.height);
    EXPECT_TRUE(several.pixels == one.pixels);
    EXPECT_EQ(together.lights, alone.lights);
    EXPECT_EQ(together.triangles, alone.triangles);
    EXPECT_EQ(together.features, alone.features);
    EXPECT_EQ(together.height, alone.height);
    if (settings.samples == 1) {  // else bands overlap by a pixel
      EXPECT_EQ(countOf(together, "pixels_lit"), countOf(alone, "pixels_lit"));
    }
    EXPECT_EQ(countOf(together, "shadow_lights"), countOf(alone, "shadow_lights"));
    std::uint64_t rows = 0;
    for (const DeviceShare& share : together.shares) rows += share.rows;
    EXPECT_EQ(rows, std::uint64_t(one.height));
  }

  std::list<OpenedDevice> devices;
  std::list<Sharer> sharers;
};

TEST_F(SharedPictures, HaveTheBitsOfOneByEveryShadow) {
  const Scene scene = sceneFromJson(kScene);
  RenderSettings settings = settingsFor(scene, {120, 500});
  for (const auto method : {ShadowMethod::kOff, ShadowMethod::kHard, ShadowMethod::kPcf, ShadowMethod::kSoft,
                            ShadowMethod::kExact, ShadowMethod::kSoftExact, ShadowMethod::kAuto}) {
    settings.shade.shadows = method;
    expectBitsOfOne(scene, settings);
  }
}

TEST_F(SharedPictures, HaveTheBitsOfOneWithSamplesLayersAndACrop) {
  const Scene scene = sceneFromJson(kScene);
  RenderSettings settings = settingsFor(scene, {160, 400});
  settings.samples = 4;
  settings.alpha = true;
  settings.aovs = {Aov::kPosition, Aov::kMaterial, Aov::kShadow, Aov::kDiffuseLight, Aov::kObjectId};
  settings.crop = Crop{21, 37, 90, 321};
  expectBitsOfOne(scene, settings);
  settings.sample_shading = SampleShading::kAll;
  expectBitsOfOne(scene, settings);
}

TEST_F(SharedPictures, HaveTheBitsOfOneWithLightsThatClustersStandFor) {
  const Scene scene = sceneFromJson(kScene);
  RenderSettings settings = settingsFor(scene, {120, 400});
  settings.shade.light_error = 0.01f;
  expectBitsOfOne(scene, settings);
  settings.shading = Shading::kGouraud;
  expectBitsOfOne(scene, settings);
}

TEST_F(SharedPictures, HaveTheBitsOfOneWithSampledLights) {
  Scene scene = sceneFromJson(kScene);
  for (Light& light : scene.lights) {
    if (light.kind != LightKind::kPoint) continue;
    light.range = INFINITY;
    light.radius = 0;
    light.attenuation = {0, 0, 1};
    light.shadow = true;
  }
  RenderSettings settings = settingsFor(scene, {80, 300});
  settings.shade.shadows = ShadowMethod::kExact;
  settings.shade.light_error = 0.1f;
  settings.shade.always_clusters = true;
  settings.aovs = {Aov::kLightError, Aov::kLightProof};
  expectBitsOfOne(scene, settings);
}

TEST_F(SharedPictures, KeepShadowsFromPoseToPose) {
  Scene scene = sceneFromJson(kScene);
  RenderSettings settings = settingsFor(scene, {100, 300});
  for (const auto method : {ShadowMethod::kHard, ShadowMethod::kExact}) {
    settings.shade.shadows = method;
    for (const int frame : {1, 2, 5}) {
      poseScene(scene, frame);
      expectBitsOfOne(scene, settings, true);
    }
  }
}

TEST_F(SharedPictures, ComeFromTheTopDownAndAreReported) {
  const Scene scene = sceneFromJson(kScene);
  RenderSettings settings = settingsFor(scene, {60, 700});
  std::vector<int> done;
  settings.on_pass = [&](int rows, int all) {
    EXPECT_EQ(all, 700);
    done.push_back(rows);
  };
  Stats stats;
  shared(scene, settings, stats);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_EQ(done.back(), 700);
}

TEST_F(SharedPictures, EndWithWhatTheirTakerThrows) {
  const Scene scene = sceneFromJson(kScene);
  const RenderSettings settings = settingsFor(scene, {60, 700});
  Stats stats;
  EXPECT_THROW(
      renderShared(
          sharers, scene, settings, [](const Image&) { throw MachineError("disk full"); }, stats),
      MachineError);
}

TEST_F(SharedPictures, EndWithAnInputErrorThatNoOtherDeviceMends) {
  const Scene scene = sceneFromJson(kScene);
  RenderSettings settings = settingsFor(scene, {60, 70});
  settings.crop = Crop{0, 0, 61, 70};
  Stats stats;
  EXPECT_THROW(shared(scene, settings, stats), InputError);
}

TEST_F(SharedPictures, AreMadeByThoseThatAreLeft) {
  const Scene scene = sceneFromJson(kScene);
  const RenderSettings settings = settingsFor(scene, {60, 300});
  sharers.front().error = "gone";
  expectBitsOfOne(scene, settings);
  for (Sharer& sharer : sharers) sharer.error = "gone";
  Stats stats;
  try {
    shared(scene, settings, stats);
    FAIL();
  } catch (const MachineError& error) {
    EXPECT_THAT(error.what(), HasSubstr("gone"));
  }
}

}  // namespace
}  // namespace luciole::test
