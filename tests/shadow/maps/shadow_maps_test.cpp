#include "shadow/maps/shadow_maps.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shadow/maps/shadow_scenes.hpp"

namespace luciole::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

void askForShadows(RenderSettings& settings) { settings.aovs = {Aov::kShadow, Aov::kPosition, Aov::kDepth}; }

/// Pixels of the shadow layer darker than fully lit, where something was hit.
int darkPixels(const Image& image) {
  const std::size_t shadow = channelIndex(image, "shadow"), channels = image.channels.size();
  int dark = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += channels) dark += image.pixels[i + shadow] < 1.0f;
  return dark;
}

TEST(ShadowMaps, PlaneUnderTheSunHasNoAcneAtAnyAngle) {
  for (const auto method : {ShadowMethod::kHard, ShadowMethod::kPcf})
    for (const double degrees : {0.0, 10.0, 30.0, 45.0, 60.0, 75.0, 80.0, 84.0}) {
      const double angle = degrees * kPi / 180;
      const std::string light =
          fmt::format(R"({{"type": "directional", "direction": [{}, {}, {}], "shadow": true}})",
                      std::sin(angle) * 0.8, -std::cos(angle), std::sin(angle) * 0.6);
      const Image image = renderJson(planeScene(light), {160, 90}, [&](RenderSettings& settings) {
        askForShadows(settings);
        settings.shade.shadows = method;
      });
      EXPECT_EQ(darkPixels(image), 0) << degrees << " degrees";
    }
}

TEST(ShadowMaps, PlaneUnderSpotsAndPointLightsHasNoAcne) {
  for (const auto method : {ShadowMethod::kHard, ShadowMethod::kPcf})
    for (const char* light :
         {R"({"type": "point", "position": [0, 2, 0], "shadow": true})",
          R"({"type": "point", "position": [3, 0.4, 1], "range": 30, "shadow": true})",
          R"({"type": "spot", "position": [2, 3, 1], "target": [0, 0, 0], "cutoff": 40, "shadow": true})",
          R"({"type": "spot", "position": [2, 1, 1], "target": [0, 0, 0], "cutoff": 85, "shadow": true})"}) {
      const Image image = renderJson(planeScene(light), {160, 90}, [&](RenderSettings& settings) {
        askForShadows(settings);
        settings.shade.shadows = method;
      });
      EXPECT_EQ(darkPixels(image), 0) << light;
    }
}

TEST(ShadowMaps, RoomAroundAPointLightIsLitWithoutSeams) {
  const Image image =
      renderJson(R"({"camera": {"eye": [0.5, 0.3, 0.9], "target": [-1, -0.4, -1], "fov_y": 100},
    "materials": {"wall": {"double_sided": true}},
    "objects": [{"primitive": "box", "scale": 4, "material": "wall"}],
    "lights": [{"type": "point", "position": [0.1, 0.2, 0], "shadow": true}]})",
                 {256, 144}, askForShadows);
  // Where walls meet too: a bend towards the light never shadows itself.
  const std::size_t channels = image.channels.size(), shadow = channelIndex(image, "shadow");
  for (std::size_t i = 0; i < image.pixels.size(); i += channels)
    EXPECT_EQ(image.pixels[i + shadow], 1.0f) << "pixel " << i / channels;
}

/// A square of side 1 hovers at height 1 over a plane; what it hides from the light is known by similar
/// triangles.
struct HoverCase {
  const char* name;
  const char* light;
  double low, high;  ///< the shadow on the plane: [low, high]² in x and z
};

class HoveringSquare : public testing::TestWithParam<HoverCase> {};

TEST_P(HoveringSquare, ShadowFallsWhereGeometrySaysWithinTexels) {
  const HoverCase& hover = GetParam();
  const std::string json =
      fmt::format(R"({{"camera": {{"eye": [0, 6, 0.01], "target": [0, 0, 0], "up": [0, 0, -1], "fov_y": 40}},
    "materials": {{"m": {{"double_sided": true}}}},
    "objects": [{{"primitive": "plane", "scale": 8}}, {{"primitive": "plane", "translate": [0, 1, 0], "material": "m"}}],
    "lights": [{}]}})",
                  hover.light);
  const Scene scene = sceneFromJson(json);
  const ShadowMaps maps =
      planShadowMaps(scene, cameraView(scene.cameras.front(), {128, 128}), ShadowMethod::kPcf, {});
  // The lookup's filter reaches the centres of texels one away along either axis, which are those of x and z
  // here. The floor sees the coarsest cascade at the most, and other lights from 4 m.
  double side = 0;
  for (const ShadowFace& face : maps.faces)
    side = std::max(side, (maps.maps.front().kind == kParallelMap ? 1 : 4) / double(face.scale));
  const double blur = side * 1.01;
  EXPECT_LT(blur, 6 * 2 * std::tan(20 * kPi / 180) / 128);  // a pixel on the floor
  const Image image = renderJson(json, {128, 128}, askForShadows);
  const std::size_t channels = image.channels.size(), shadow = channelIndex(image, "shadow"),
                    place = channelIndex(image, "P.X");
  int checked = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += channels) {
    const float x = image.pixels[i + place], y = image.pixels[i + place + 1], z = image.pixels[i + place + 2];
    if (y > 0.5f || !std::isfinite(image.pixels[i + channelIndex(image, "Z")]))
      continue;  // the square itself
    const double inside =
        std::min(std::min(x - hover.low, hover.high - x), std::min(z - hover.low, hover.high - z));
    if (std::abs(inside) < blur) continue;
    EXPECT_EQ(image.pixels[i + shadow], inside > 0 ? 0.0f : 1.0f) << x << " " << z;
    ++checked;
  }
  EXPECT_GT(checked, 128 * 128 / 2);
}

INSTANTIATE_TEST_SUITE_P(
    Lights, HoveringSquare,
    testing::Values(
        HoverCase{"Sun", R"({"type": "directional", "direction": [0, -1, 0], "shadow": true})", -0.5, 0.5},
        HoverCase{
            "Spot",
            R"({"type": "spot", "position": [0, 4, 0], "direction": [0, -1, 0], "cutoff": 35, "shadow": true})",
            -0.5 * 4 / 3, 0.5 * 4 / 3},
        HoverCase{"Point", R"({"type": "point", "position": [0, 4, 0], "shadow": true})", -0.5 * 4 / 3,
                  0.5 * 4 / 3}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(ShadowMaps, AlphaMaskedHolesLetLightThrough) {
  // A hovering square whose opacity is below the cutoff casts nothing.
  const Image image = renderJson(R"({"camera": {"eye": [0, 6, 0.01], "target": [0, 0, 0], "up": [0, 0, -1]},
    "materials": {"gone": {"alpha": 0.2, "alpha_cutoff": 0.5}},
    "objects": [{"primitive": "plane", "scale": 8}, {"primitive": "plane", "translate": [0, 1, 0], "material": "gone"}],
    "lights": [{"type": "directional", "direction": [0, -1, 0], "shadow": true}]})",
                                 {64, 64}, askForShadows);
  EXPECT_EQ(darkPixels(image), 0);
}

TEST(ShadowMaps, OccludersNearALightOfAHugeRangeCastShadows) {
  // A sheet 10 cm under a lamp hides 2 m of the floor, 1 m below, to each side.
  const Image image = renderJson(R"({"camera": {"eye": [0, 0.5, 4], "target": [0, 0, 0], "fov_y": 40},
    "materials": {"m": {"double_sided": true}},
    "objects": [{"primitive": "plane", "scale": 10},
                {"primitive": "plane", "scale": 0.4, "translate": [0, 0.9, 0], "material": "m"}],
    "lights": [{"type": "point", "position": [0, 1, 0], "range": 1e6, "shadow": true}]})",
                                 {160, 90}, askForShadows);
  const std::size_t channels = image.channels.size(), shadow = channelIndex(image, "shadow"),
                    place = channelIndex(image, "P.X");
  int dark = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += channels) {
    const float* p = image.pixels.data() + i + place;
    if (!std::isfinite(image.pixels[i + channelIndex(image, "Z")]) || std::abs(p[0]) > 1.9f ||
        std::abs(p[1]) > 0.01f || std::abs(p[2]) > 1.9f)
      continue;
    EXPECT_EQ(image.pixels[i + shadow], 0.0f) << p[0] << " " << p[2];
    ++dark;
  }
  EXPECT_GT(dark, 1000);
}

TEST(ShadowMaps, PlanDoesNotDependOnTheCrop) {
  const Scene scene = terrainScene();
  View view = cameraView(scene.cameras.front(), {200, 100});
  const ShadowMaps whole = planShadowMaps(scene, view, ShadowMethod::kHard, {});
  view.crop_origin = {50, 20};
  view.crop_size = {10, 10};
  const ShadowMaps part = planShadowMaps(scene, view, ShadowMethod::kHard, {});
  EXPECT_TRUE(sameBits(whole.maps, part.maps));
  EXPECT_TRUE(sameBits(whole.faces, part.faces));
  ASSERT_EQ(whole.planned.size(), part.planned.size());
  for (std::size_t i = 0; i < whole.planned.size(); ++i) {
    EXPECT_EQ(whole.planned[i].view.world_to_view, part.planned[i].view.world_to_view);
    EXPECT_EQ(whole.planned[i].view.projection, part.planned[i].view.projection);
    EXPECT_EQ(whole.planned[i].view.size, part.planned[i].view.size);
  }
}

TEST(ShadowMaps, LightsWithoutShadowHaveNoMap) {
  const ShadowMaps maps = planFor(sceneFromJson(planeScene(R"({"type": "point", "position": [0, 1, 0]})")));
  EXPECT_TRUE(maps.maps.empty() && maps.faces.empty() && maps.planned.empty());
  EXPECT_EQ(maps.map_of_light.front(), kNoShadow);
}

TEST(ShadowMaps, EmptySceneHasNone) {
  Scene scene = terrainScene();
  scene.objects.clear();
  const ShadowMaps maps = planFor(scene);
  EXPECT_TRUE(maps.maps.empty());
  EXPECT_EQ(maps.map_of_light, std::vector<std::uint32_t>(scene.lights.size(), kNoShadow));
}

}  // namespace
}  // namespace luciole::test
