// Cameras whose axis doesn't go through the picture's middle, and whose pixels aren't square.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "reference/reference.hpp"
#include "render/render.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

constexpr const char* kLensScene =
    R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0], "up": [0.1, 1, 0]}, "ambient": 0.1,
  "fog": {"mode": "exp", "density": [0.05, 0.02, 0.01], "color": [0.2, 0.3, 0.4], "distance": "radial"},
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}},
  "objects": [{"primitive": "plane", "scale": 10, "material": "m"}, {"primitive": "torus", "segments": 40, "translate": [0, 1, 0], "rotate": [60, 20, 0], "material": "m"},
              {"primitive": "sphere", "segments": 40, "translate": [-1.5, 1, 1], "material": "m"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "color": 0.5, "shadow": true},
             {"type": "point", "position": [1, 2, 2], "range": 4, "diffuse": [1, 0.5, 0.2], "shadow": true},
             {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "inner_cone": 10, "outer_cone": 30, "attenuation": [0, 0, 0.1], "shadow": true}]})";

/// What is seen through a part of a larger picture, as a picture of its own.
Camera cameraOfPart(Camera camera, glm::ivec2 whole, const Crop& part) {
  const glm::dvec2 size(part.width, part.height),
      middle = 0.5 * glm::dvec2(whole) - glm::dvec2(part.x, part.y);
  const double share = size.y / whole.y;
  camera.fov_y = 2 * std::atan(share * std::tan(camera.fov_y / 2));
  camera.half_height *= share;
  camera.shift = {2 * middle.x / size.x - 1, 1 - 2 * middle.y / size.y};
  return camera;
}

/// The largest difference between two pictures, and the share of pixels that differ by more than `least`.
std::pair<double, double> differenceOf(const Image& a, const Image& b, double least) {
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  double most = 0, more = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const double difference = std::abs(double(a.pixels[i]) - b.pixels[i]);
    most = std::max(most, difference);
    more += difference > least;
  }
  return {most, more / double(a.pixels.size())};
}

// Places in doubles differ by some 2^-50 and so, rounded to floats, at most by a float's last bit: 2^-23.
// From there on the arithmetic is the same; see the test of the reference below for what it makes of that
// error.
constexpr double kLensError = 2 * (40 + 4 * 32 * 1.4427) * 0x1p-24;

TEST(Lens, AShiftByWholePixelsIsAPartOfALargerPicture) {
  for (const bool orthographic : {false, true}) {
    Scene scene = sceneFromJson(kLensScene);
    scene.cameras.front().orthographic = orthographic;
    scene.cameras.front().half_height = 3;
    const Crop part{7, 60, 97, 61};
    for (const int samples : {1, 4}) {
      RenderSettings settings = settingsFor(scene, {200, 150});
      settings.shade.shadows = ShadowMethod::kExact;
      settings.samples = samples;
      settings.crop = part;
      const Image of_whole = picture(scene, settings);
      settings.camera = cameraOfPart(settings.camera, settings.size, part);
      settings.size = {part.width, part.height};
      settings.crop = {};
      const Image own = picture(scene, settings);
      EXPECT_LE(differenceOf(own, of_whole, 0).first, kLensError) << orthographic << ' ' << samples;
    }
  }
}

TEST(Lens, PicturesAreTheReferences) {
  for (const bool orthographic : {false, true}) {
    const Scene scene = sceneFromJson(kLensScene);
    RenderSettings settings = settingsFor(scene, {160, 90});
    settings.camera.orthographic = orthographic;
    settings.camera.half_height = 2;
    settings.camera.shift = {0.6, -0.9};
    settings.camera.pixel_aspect = 1.3;
    settings.shade.shadows = ShadowMethod::kOff;
    Stats stats;
    const GBuffer gbuffer = rasterizeScene(nullptr, scene, settings, stats);
    const Image ours = renderScene(testDevice(), scene, settings, stats);
    EXPECT_LE(differenceOf(ours, referenceShade(scene, gbuffer, {}), 0).first, kLensError) << orthographic;
    const Image shaded = shadeGBuffer(testDevice(), scene, gbuffer, settings, stats);
    EXPECT_EQ(shaded.pixels, ours.pixels);
  }
}

// A sun's maps are fitted to what the camera sees. Beside texels that an edge of a shadow crosses they say
// what exact shadows say: of 2048 texels a side and this scene's size that is a small share of the picture.
TEST(Lens, ShadowMapsAreRightWhereverThePictureIsShifted) {
  const Scene scene = sceneFromJson(kLensScene);
  for (const glm::dvec2& shift : {glm::dvec2(0), {1.5, 0.5}, {-1.5, -0.5}}) {
    RenderSettings settings = settingsFor(scene, {160, 90});
    settings.shade.shadow_limits.size = 2048;
    settings.camera.shift = shift;
    settings.shade.shadows = ShadowMethod::kHard;
    const Image by_maps = picture(scene, settings);
    settings.shade.shadows = ShadowMethod::kExact;
    EXPECT_LT(differenceOf(by_maps, picture(scene, settings), 1e-3).second, 0.01) << shift.x;
  }
}

}  // namespace
}  // namespace luciole::test
