#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "luciole/error.hpp"
#include "luciole/render.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

Scene litFloor() {
  return sceneFromJson(
      R"({"camera": {"eye": [0, 2, 3], "target": [0, 0, 0]}, "ambient": 0.25, "background": 1,
    "fog": {"mode": "exp", "density": 1, "color": 1}, "materials": {"m": {"diffuse": 0.5, "specular": 0.5, "shininess": 8}},
    "objects": [{"primitive": "plane", "segments": 2, "scale": 2, "material": "m"}], "lights": [{"type": "point", "position": [0, 1, 0]}]})");
}

std::string bakeFault(const Scene& scene, std::uint32_t object, const BakeSettings& bake,
                      const RenderSettings& settings) {
  Device device = Device::open();
  try {
    bakeLight(device, scene, object, bake, settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// The light's cosine to a texel's middle, and the ambient light, of a surface without fog. Pictures are
// within 1e-5 of double precision.
TEST(BakeLight, IsTheLightAtATexelsPlace) {
  Device device = Device::open();
  const Scene scene = litFloor();
  RenderSettings settings{.size{16, 16}};
  for (const bool irradiance : {false, true}) {
    const Picture map = bakeLight(device, scene, 0, {.irradiance = irradiance}, settings);
    ASSERT_EQ(map.image.pixels.size(), 3u * 16 * 16);
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        const glm::dvec3 way((x + 0.5) / 8 - 1, 1, (y + 0.5) / 8 - 1);
        const double light = 0.25 + 1 / glm::length(way);
        EXPECT_NEAR(map.image.pixels[3 * std::size_t(16 * y + x)], irradiance ? light : 0.5 * light, 1e-5);
      }
  }
}

TEST(BakeLight, RefusesWhatAMapCantHave) {
  const Scene scene = litFloor();
  const RenderSettings settings{.size{16, 16}};
  EXPECT_EQ(bakeFault(scene, 1, {}, settings), "object: 1, but the number of objects is 1");
  RenderSettings layers = settings, maps = settings, small = settings;
  layers.aovs = {Aov::kObjectId};
  EXPECT_EQ(bakeFault(scene, 0, {}, layers),
            "settings.aovs: a map shows one object; render makes object_id, material_id and cryptomatte");
  maps.shade.shadows = ShadowMethod::kPcf;
  EXPECT_EQ(bakeFault(scene, 0, {.eye = glm::dvec3(0, 1, 1)}, maps),
            "settings.shade.shadows: maps of a sun follow a camera, which bake.eye isn't; expected kExact, "
            "kSoftExact or kOff");
  EXPECT_EQ(bakeFault(scene, 0, {}, maps), "");
  EXPECT_EQ(bakeFault(scene, 0, {.eye = glm::dvec3(0, std::nan(""), 1)}, settings),
            "bake.eye: (0, nan, 1), expected finite numbers");
  small.size = {0, 16};
  EXPECT_EQ(bakeFault(scene, 0, {}, small), "settings.size: 0x16 pixels, expected 1 to 32768 a side");
  Scene folded = scene;
  for (glm::vec2& uv : folded.meshes[0].uvs) uv.x = std::abs(2 * uv.x - 1);
  EXPECT_EQ(bakeFault(folded, 0, {}, settings),
            "256 of 256 texels of plane lie in more than one triangle: its charts overlap, expected texture "
            "coordinates of which no two places share one");
}

}  // namespace
}  // namespace luciole::test
