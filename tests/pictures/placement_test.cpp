#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "luciole/error.hpp"
#include "pictures/shot.hpp"

namespace luciole::test {
namespace {

/// A sphere and a box over a floor under all kinds of light, one of them close above the sphere, all lengths
/// `k` times as long.
std::string scaledScene(double k) {
  return fmt::format(
      R"({{"camera": {{"eye": [{}, {}, {}], "target": [0, {}, 0], "near": {}, "far": {}}}, "ambient": [0.1, 0.1, 0.15],
      "fog": {{"mode": "exp2", "density": {}, "color": [0.3, 0.4, 0.5]}},
      "materials": {{"m": {{"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}}}},
      "objects": [{{"primitive": "plane", "scale": {}, "material": "m"}},
                  {{"primitive": "sphere", "segments": 32, "scale": {}, "translate": [{}, {}, 0], "material": "m"}},
                  {{"primitive": "box", "scale": {}, "rotate": [20, 30, 40], "translate": [{}, {}, {}], "material": "m"}}],
      "lights": [{{"type": "directional", "direction": [-1, -2, -1.5], "intensity": 0.5, "shadow": true}},
                 {{"type": "point", "position": [{}, {}, {}], "range": {}, "attenuation": [0.5, {}, {}], "shadow": true}},
                 {{"type": "spot", "position": [{}, {}, {}], "direction": [1, -2, -1], "inner_cone": 10, "outer_cone": 40, "shadow": true}},
                 {{"type": "spot", "position": [{}, {}, 0], "direction": [0, -1, 0], "cutoff": 60, "shadow": true}}]}})",
      3 * k, 2 * k, 5 * k, 0.5 * k, 0.125 * k, 128 * k, 0.05 / k, 8 * k, 0.75 * k, 0.5 * k, 1.25 * k, k, -k,
      1.5 * k, 0.5 * k, k, 3 * k, 2 * k, 8 * k, 0.25 / k, 0.125 / (k * k), -2 * k, 4 * k, 2 * k, 0.5 * k,
      2.25 * k);
}

TEST(HardPlacement, TinyAndHugeScenesLookTheSame) {
  const glm::ivec2 size(96, 54);
  const auto with_shadows = [](RenderSettings& settings) {
    settings.shade.shadows = ShadowMethod::kPcf;
    settings.shade.shadow_limits.size = 256;
  };
  const Shot plain = shoot(sceneFromJson(scaledScene(1)), size, with_shadows);
  // A power of two changes exponents only, all the way through: not a bit of the picture, shadows and all.
  for (const double k : {0x1p-20, 0x1p20}) {
    const Shot scaled = shoot(sceneFromJson(scaledScene(k)), size, with_shadows);
    EXPECT_EQ(scaled.image.pixels, plain.image.pixels) << k;
  }
  // Powers of ten round on their way.
  for (const double k : {1e-6, 1e6}) {
    const Shot scaled = shoot(scaledScene(k), size);
    EXPECT_NEAR(coveredPixels(scaled.gbuffer), coveredPixels(plain.gbuffer), 2) << k;
    expectAsTheReference(scaled);
    expectCullingChangesNothing(scaled);
  }
}

TEST(HardPlacement, ObjectsScaledAMillionfold) {
  const auto box = [](double vertices, double scale) {
    const TemporaryFolder folder;
    std::ofstream obj(folder / "box.obj");
    for (int i = 0; i < 8; ++i)
      obj << fmt::format("v {} {} {}\n", i & 1 ? vertices : -vertices, i & 2 ? vertices : -vertices,
                         i & 4 ? vertices : -vertices);
    obj << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    obj.close();
    std::ofstream(folder / "scene.json") << fmt::format(
        R"({{"camera": {{"eye": [3, 2, 5], "target": [0, 0, 0]}}, "materials": {{"m": {{"specular": 0.5, "shininess": 9}}}},
            "objects": [{{"mesh": "box.obj", "material": "m", "rotate": [10, 20, 30], "scale": {}}}],
            "lights": [{{"type": "point", "position": [4, 5, 6]}}]}})",
        scale);
    return shoot(loadScene(folder / "scene.json"), {70, 50});
  };
  const Shot plain = box(1, 1);
  EXPECT_GT(coveredPixels(plain.gbuffer), 500);
  for (const double k : {0x1p-20, 0x1p20}) EXPECT_EQ(box(k, 1 / k).image.pixels, plain.image.pixels) << k;
  // 10⁻⁶ isn't a float: vertices lie beside by its rounding, and so do the positions, seen at a slope of 1 :
  // 10 at most, that are floats themselves.
  const Shot decimal = box(1e-6, 1e6);
  expectAsTheReference(decimal);
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 70; ++x) {
      const glm::vec3 a = positionAt(plain.gbuffer, x, y), b = positionAt(decimal.gbuffer, x, y);
      if (!std::isfinite(a.z) || !std::isfinite(b.z)) {
        EXPECT_EQ(a.z, b.z);
        continue;
      }
      EXPECT_LE(glm::length(glm::dvec3(a) - glm::dvec3(b)),
                kUnit * (10 * std::sqrt(3.0) + 2 * glm::length(a)));
    }
}

/// `side` 1, or −1 for the mirror image in the plane x = 0.
std::string mirrorScene(int side) {
  return fmt::format(
      R"({{"camera": {{"eye": [0, 2, 5], "target": [0, 0.5, 0]}}, "ambient": 0.1,
      "materials": {{"m": {{"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}}}},
      "objects": [{{"primitive": "cone", "segments": 24, "scale": [{0}, 1.5, 0.7], "rotate": [0, 0, {1}], "translate": [{2}, 0.3, 0.4], "material": "m"}},
                  {{"primitive": "torus", "segments": 24, "scale": [{3}, 0.8, 1.1], "rotate": [50, {4}, {5}], "translate": [{6}, 1, -0.3], "material": "m"}}],
      "lights": [{{"type": "directional", "direction": [{7}, -2, -1], "intensity": 0.5}},
                 {{"type": "point", "position": [{8}, 3, 2], "range": 8}}]}})",
      0.9 * side, 20.3 * side, 0.61 * side, 0.7 * side, 35.2 * side, 12.7 * side, -0.93 * side, -1 * side,
      1.3 * side);
}

TEST(HardPlacement, MirroredObjectsAreTheMirrorImage) {
  // Negative scales turn triangles over and mirror normals; everything else mirrored too, the picture is the
  // plain one with left and right exchanged. 97 columns: the middle one mirrors onto itself.
  const glm::ivec2 size(97, 60);
  const Shot plain = shoot(mirrorScene(1), size), mirrored = shoot(mirrorScene(-1), size);
  ASSERT_LT(glm::determinant(glm::dmat3(mirrored.scene.objects[0].object_to_world)), 0);
  EXPECT_GT(coveredPixels(plain.gbuffer), 600);
  expectAsTheReference(mirrored);
  expectCullingChangesNothing(mirrored);
  int beside = 0;
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const glm::dvec3 a(positionAt(plain.gbuffer, x, y)), b(positionAt(mirrored.gbuffer, size.x - 1 - x, y));
      const glm::vec3 n = valueAt(plain.gbuffer.normal, plain.gbuffer, x, y),
                      m = valueAt(mirrored.gbuffer.normal, mirrored.gbuffer, size.x - 1 - x, y);
      // Snapped corners mirror exactly but for a corner in the middle between two of them; samples on the
      // very edge go to the other side. What is seen in the same place lies there to the rounding of its 10
      // operations in double and of the float, and its normal likewise.
      const bool same =
          std::isfinite(a.z) == std::isfinite(b.z) &&
          (!std::isfinite(a.z) || glm::length(a - b * glm::dvec3(-1, 1, 1)) <= 2.01 * kUnit * glm::length(a));
      beside += !same;
      if (!same || !std::isfinite(a.z)) continue;
      ASSERT_LE(glm::length(glm::dvec3(n) - glm::dvec3(m) * glm::dvec3(-1, 1, 1)),
                2 * std::sqrt(3.0) * kUnit);
      const std::size_t place = plain.gbuffer.index(x, y);
      for (int c = 0; c < 3; ++c) {
        // Positions apart by their floats' rounding, which widens each bound by about as much as it allows
        // for.
        const Interval bounds = shadeInterval(plain.scene, plain.gbuffer, place, c, Model::kPhong);
        ASSERT_NEAR(colorAt(plain.image, x, y)[c], colorAt(mirrored.image, size.x - 1 - x, y)[c],
                    2 * (bounds.high - bounds.low));
      }
    }
  }
  EXPECT_EQ(beside, 0);
}

TEST(HardPlacement, LookingAlongUpIsRefusedAndBesideItIsNot) {
  const auto looking = [](double aside, const char* up) {
    return fmt::format(R"({{"camera": {{"eye": [0, 5, {}], "target": [0, 0, 0], "up": [{}]}},
      "objects": [{{"primitive": "torus", "rotate": [30, 0, 0]}}], "lights": [{{"type": "point", "position": [1, 4, 2]}}]}})",
                       aside, up);
  };
  for (const double aside : {0.0, 1e-8}) {
    try {
      sceneFromJson(looking(aside, "0, 1, 0"));
      FAIL() << "accepted " << aside;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("scene.json: camera: up is parallel to the view"),
                std::string::npos)
          << error.what();
    }
  }
  // A sine of 2 · 10⁻⁷: what is up on the picture is known to 2⁻⁵³ · 4 over that, 2.2e-9. Looking down with
  // −z upwards is the same view but for rounding; positions turn by 2.2e-9 of at most 6 m.
  const glm::ivec2 size(60, 60);
  const Shot beside = shoot(looking(1e-6, "0, 1, 0"), size), plain = shoot(looking(1e-6, "0, 0, -1"), size);
  EXPECT_GT(coveredPixels(plain.gbuffer), 300);
  const glm::dmat3 turn = glm::transpose(glm::dmat3(plain.settings.camera.camera_to_world)) *
                          glm::dmat3(beside.settings.camera.camera_to_world);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(turn[i][j], i == j, 2.3e-9);
  EXPECT_EQ(coveredPixels(beside.gbuffer), coveredPixels(plain.gbuffer));
  expectAsTheReference(beside);
}

/// A wall across the view, `distance` ahead, lit from the eye, and a ball a fifth of the picture's height in
/// radius.
Shot wideView(double fov, double distance, glm::ivec2 size) {
  const double half = distance * std::tan(glm::radians(fov) / 2);
  return shoot(fmt::format(R"({{"camera": {{"eye": [0, 0, 0], "target": [0, 0, -1], "fov_y": {}, "far": {}}},
      "materials": {{"m": {{"diffuse": [0.5, 0.25, 1]}}}},
      "objects": [{{"primitive": "plane", "rotate": [90, 0, 0], "scale": {}, "translate": [0, 0, {}], "material": "m"}}],
      "lights": [{{"type": "point", "position": [0, 0, 0]}}]}})",
                           fov, 10 * distance, 8 * half, -distance),
               size);
}

TEST(HardPlacement, FieldsOfViewFromAThousandthTo179Degrees) {
  const glm::ivec2 size(64, 48);
  for (const auto& [fov, distance] :
       {std::pair(0.001, 1e5), {0.001, 5.0}, {1.0, 3.0}, {120.0, 3.0}, {179.0, 2.0}}) {
    const Shot shot = wideView(fov, distance, size);
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const glm::dvec3 expected =
            distance * pixelRay(shot.settings.camera, size, x + 0.5, y + 0.5).direction;
        const glm::dvec3 got(positionAt(shot.gbuffer, x, y));
        // Each component is rounded to a float; before, some 20 operations in double on the wall's corners,
        // which are 8 times as far out as the picture's edge.
        const double reach = 16 * std::max(distance, distance * std::tan(glm::radians(fov) / 2));
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(got[c], expected[c], kUnit * std::abs(expected[c]) + 20 * 0x1p-53 * reach)
              << "fov " << fov << " pixel " << x << "," << y;
        // The way to the eye has 10 roundings (see wayToLight), the normal 1, the product 3, the colour 3
        // more.
        const double cosine = distance / glm::length(expected);
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(colorAt(shot.image, x, y)[c], glm::dvec3(0.5, 0.25, 1)[c] * cosine, 17 * kUnit);
      }
    }
    expectAsTheReference(shot);
    expectCullingChangesNothing(shot);
  }
}

TEST(HardPlacement, MeshesFarFromTheirOwnOriginHaveTheirFloatsRounding) {
  // Vertices at 10⁵ m are floats 2⁻⁷ m apart: a wall at 100000.3 lies 1.6 mm beside, at 100000.296875, and
  // nothing after that adds to it. At the origin it lies where the file says.
  for (const double home : {1e5, 0.0}) {
    const TemporaryFolder folder;
    std::ofstream(folder / "wall.obj")
        << fmt::format("v {0} {0} {1}\nv {2} {0} {1}\nv {2} {2} {1}\nv {0} {2} {1}\nf 1 2 3 4\n", home - 8,
                       home + 0.3, home + 8);
    std::ofstream(folder / "scene.json") << fmt::format(
        R"({{"camera": {{"eye": [0, 0, 4.7], "target": [0, 0, 0]}},
            "objects": [{{"mesh": "wall.obj", "translate": [{0}, {0}, {0}]}}], "lights": []}})",
        -home);
    const Shot shot = shoot(loadScene(folder / "scene.json"), {40, 30});
    const double depth = 4.7 - (double(float(home + 0.3)) - home);
    EXPECT_NEAR(depth, 4.4, home == 0 ? 0x1p-26 : 0x1p-8);
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 40; ++x) {
        const glm::dvec3 expected =
            depth * pixelRay(shot.settings.camera, {40, 30}, x + 0.5, y + 0.5).direction;
        // The float's rounding, and a few of a double's at 10⁵ m.
        ASSERT_LE(glm::length(glm::dvec3(positionAt(shot.gbuffer, x, y)) - expected),
                  kUnit * glm::length(expected) + 20 * 0x1p-53 * home + 1e-12);
      }
  }
}

}  // namespace
}  // namespace luciole::test
