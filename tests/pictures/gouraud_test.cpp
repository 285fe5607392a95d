// Gouraud shading: colours lit at vertices, of which what is flat has enough too.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "reference/reference_picture.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

/// A floor seen from straight above, 8 m of which are in the picture, with a spot of 1.5 m around its middle
/// and nothing else but a box that floats above x = 0.75, 0.5 m wide, and keeps the light off x = 1.2 or so.
std::string spotOn(const std::string& floor) {
  return R"({"camera": {"eye": [0, 20, 0], "target": [0, 0, 0], "up": [0, 0, -1], "orthographic": 4},
    "materials": {"white": {"diffuse": 1}},
    "objects": [)" +
         floor + R"(, {"primitive": "box", "scale": [0.5, 0.1, 0.5], "translate": [0.75, 2, 0]}],
    "lights": [{"type": "spot", "position": [0, 8, 0], "target": [0, 0, 0], "cutoff": 10.62, "shadow": true}]})";
}

constexpr const char* kPlane = R"({"primitive": "plane", "scale": 12, "material": "white"})";
constexpr const char* kBox =
    R"({"primitive": "box", "scale": [3, 1, 3], "translate": [0, -0.5, 0], "material": "white"})";

Image floorPicture(const std::string& json, Shading shading, Stats* stats = nullptr) {
  const Scene scene = sceneFromJson(json);
  RenderSettings settings;
  settings.size = {81, 81};  // the middle one's centre is at the origin
  settings.camera = scene.cameras.front();
  settings.shading = shading;
  settings.shade.shadows = ShadowMethod::kExact;
  Stats own;
  return renderScene(testDevice(), scene, settings, stats ? *stats : own);
}

/// The brightness of the floor at x and z metres.
float at(const Image& image, double x, double z) {
  const auto pixel = [&](double metres) { return std::size_t(40.5 + metres * 81 / 8); };
  return image.pixels[(pixel(z) * std::size_t(image.width) + pixel(x)) * image.channels.size()];
}

TEST(Gouraud, WhatIsFlatShowsSpotsAndShadows) {
  for (const char* floor : {kPlane, kBox}) {
    const Image phong = floorPicture(spotOn(floor), Shading::kPhong),
                gouraud = floorPicture(spotOn(floor), Shading::kGouraud);
    // The middle is lit as by Phong: of the squares of 0.19 m the corners at most 0.27 m away are too, at
    // which the light falls on the floor by an angle whose cosine is 8 / |(8, 0.27)|, which is above 0.999.
    EXPECT_NEAR(at(gouraud, 0, 0), at(phong, 0, 0), 1e-3) << floor;
    EXPECT_GT(at(phong, 0, 0), 0.99) << floor;
    // Outside the spot, and in the shadow: the box's edges at x = 0.5 and 1, 2.05 m up, are projected from 8
    // m to 0.67 and 1.34 m on the floor, of which the box hides what is below 1.
    EXPECT_EQ(at(gouraud, 1.45, -1.45), 0) << floor;
    EXPECT_EQ(at(phong, 1.2, 0), 0) << floor;
    EXPECT_EQ(at(gouraud, 1.2, 0), 0) << floor;
    EXPECT_NEAR(at(gouraud, -1.0, 0), at(phong, -1.0, 0), 1e-2) << floor;
  }
}

TEST(Gouraud, ReferenceDividesTheSame) {
  const Scene scene = sceneFromJson(spotOn(kPlane));
  const glm::ivec2 size(81, 81);
  const std::vector<glm::dvec3> truth = referencePicture(scene, cameraView(scene.cameras.front(), size),
                                                         Shading::kGouraud, 1, allPixels(size), {});
  // The middle is lit by 1 in both.
  EXPECT_NEAR(truth[40 * 81 + 40].x, at(floorPicture(spotOn(kPlane), Shading::kGouraud), 0, 0), 1e-5);
}

TEST(Gouraud, OtherShadingsAndShadowsKeepTheTwoTriangles) {
  Stats phong, flat, gouraud;
  floorPicture(spotOn(kPlane), Shading::kPhong, &phong);
  floorPicture(spotOn(kPlane), Shading::kFlat, &flat);
  floorPicture(spotOn(kPlane), Shading::kGouraud, &gouraud);
  const auto submitted = [](const Stats& stats) { return countOf(stats, "triangles_submitted"); };
  EXPECT_EQ(submitted(phong), 2u + 12u);
  EXPECT_EQ(submitted(flat), 2u + 12u);
  EXPECT_EQ(submitted(gouraud), 64u * 64 * 2 + 6u * 16 * 16 * 2);
  for (const Stats* stats : {&phong, &flat, &gouraud}) EXPECT_EQ(stats->triangles, 14u);
}

TEST(Gouraud, SegmentsThatAreAskedForAreThose) {
  const Scene scene =
      sceneFromJson(R"({"objects": [{"primitive": "plane", "segments": 1}, {"primitive": "plane"},
      {"primitive": "plane", "segments": 3}, {"primitive": "sphere"}]})");
  ASSERT_EQ(scene.meshes.size(), 4u);
  EXPECT_EQ(scene.meshes[0].divided, nullptr);
  ASSERT_NE(scene.meshes[1].divided, nullptr);
  EXPECT_EQ(scene.meshes[1].divided->triangles.size(), 64u * 64 * 2);
  EXPECT_EQ(scene.meshes[2].divided, nullptr);
  EXPECT_EQ(scene.meshes[3].divided, nullptr);
}

}  // namespace
}  // namespace luciole::test
