#include "shadow/shadow_maps.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render_json.hpp"

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

std::string planeScene(const std::string& light) {
  return fmt::format(R"({{"camera": {{"eye": [0, 3, 6], "target": [0, 0, 0]}},
    "objects": [{{"primitive": "plane", "scale": 20}}], "lights": [{}]}})",
                     light);
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
  // Where two walls meet, the filter's texels on the one wall are truly nearer to the light than the other
  // wall's points: within 2 texels, each 1/508 of the distance of at most 2.2 m, along the diagonal.
  // Everywhere else, no shadow.
  const double corner = 2 * 2.2 / 508 * std::sqrt(2.0);
  const std::size_t channels = image.channels.size(), shadow = channelIndex(image, "shadow"),
                    place = channelIndex(image, "P.X");
  int checked = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += channels) {
    int walls_nearby = 0;
    for (int axis = 0; axis < 3; ++axis)
      walls_nearby += std::abs(image.pixels[i + place + axis]) > 2 - corner;
    if (walls_nearby > 1) continue;
    EXPECT_EQ(image.pixels[i + shadow], 1.0f);
    ++checked;
  }
  EXPECT_GT(checked, 256 * 144 * 9 / 10);
}

/// A square of side 1 hovers at height 1 over a plane; what it hides from the light is known by similar
/// triangles.
struct HoverCase {
  const char* name;
  const char* light;
  double low, high;  ///< the shadow on the plane: [low, high]² in x and z
  double
      blur;  ///< metres within which the map may be wrong: 4 texels (filter and offset) of that light's map
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
    if (std::abs(inside) < hover.blur) continue;
    EXPECT_EQ(image.pixels[i + shadow], inside > 0 ? 0.0f : 1.0f) << x << " " << z;
    ++checked;
  }
  EXPECT_GT(checked, 128 * 128 / 2);
}

// Blur: the sun's map covers at most the 8 m plane with 4096 texels, 2 mm each. The spot's is 2·4·tan 35°
// wide at the plane, 2048 texels of 2.8 mm; the point light's face is 8 m wide at the plane, 1024 texels of 8
// mm. The slant adds √2 at most.
INSTANTIATE_TEST_SUITE_P(
    Lights, HoveringSquare,
    testing::Values(
        HoverCase{"Sun", R"({"type": "directional", "direction": [0, -1, 0], "shadow": true})", -0.5, 0.5,
                  0.012},
        HoverCase{
            "Spot",
            R"({"type": "spot", "position": [0, 4, 0], "direction": [0, -1, 0], "cutoff": 35, "shadow": true})",
            -0.5 * 4 / 3, 0.5 * 4 / 3, 0.016},
        HoverCase{"Point", R"({"type": "point", "position": [0, 4, 0], "shadow": true})", -0.5 * 4 / 3,
                  0.5 * 4 / 3, 0.046}),
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

TEST(ShadowMaps, DirectionalMapDoesNotDependOnTheCrop) {
  const Scene scene =
      sceneFromJson(planeScene(R"({"type": "directional", "direction": [1, -2, 0], "shadow": true})"));
  View view = cameraView(scene.cameras.front(), {200, 100});
  const ShadowMaps whole = drawShadowMaps(scene, view, 4096);
  view.crop_origin = {50, 20};
  view.crop_size = {10, 10};
  EXPECT_EQ(whole.depths, drawShadowMaps(scene, view, 4096).depths);
}

TEST(ShadowMaps, EveryShadowedLightHasAMapWithinTheBudget) {
  Scene scene = sceneFromJson(planeScene(R"({"type": "point", "position": [0, 1, 0], "shadow": true})"));
  scene.lights.resize(300, scene.lights.front());
  const ShadowMaps maps = drawShadowMaps(scene, cameraView(scene.cameras.front(), {64, 64}), 4096);
  EXPECT_EQ(maps.maps.size(), 300u);
  EXPECT_LE(maps.depths.size() * sizeof(float), kShadowBudget);
  for (std::uint32_t i = 0; i < 300; ++i) EXPECT_EQ(maps.map_of_light[i], i);
}

TEST(ShadowMaps, LightsWithoutShadowHaveNoMap) {
  const Scene scene = sceneFromJson(planeScene(R"({"type": "point", "position": [0, 1, 0]})"));
  const ShadowMaps maps = drawShadowMaps(scene, cameraView(scene.cameras.front(), {64, 64}), 4096);
  EXPECT_TRUE(maps.maps.empty());
  EXPECT_EQ(maps.map_of_light.front(), kNoShadow);
}

}  // namespace
}  // namespace luciole::test
