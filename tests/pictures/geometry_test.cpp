#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "luciole/image.hpp"
#include "pictures/shot.hpp"

namespace luciole::test {
namespace {

/// A scene that shows `obj`, and the top-level members of `rest` ("…,").
Scene objScene(const std::string& rest, const std::string& obj) {
  const TemporaryFolder folder;
  std::ofstream(folder / "mesh.obj") << obj;
  std::ofstream(folder / "scene.json")
      << "{" << rest << R"("objects": [{"mesh": "mesh.obj", "material": "m"}]})";
  return loadScene(folder / "scene.json");
}

TEST(HardGeometry, TrianglesWithoutAreaChangeNothing) {
  // Vertex 4 is vertex 1 again, 5 lies on the line from 1 to 2, 6 is on its own.
  const std::string vertices = "v -1 -1 0\nv 1 -1 0\nv 0.2 1 0.3\nv -1 -1 0\nv 0.5 -1 0\nv 7 7 -7\n";
  const std::string rest =
      R"("camera": {"eye": [0.3, 0.2, 4], "target": [0, 0, 0]}, "ambient": 0.1,
         "materials": {"m": {"diffuse": [0.7, 0.5, 0.3], "specular": 0.4, "shininess": 20, "double_sided": true}},
         "lights": [{"type": "point", "position": [1, 2, 3]}], )";
  const glm::ivec2 size(93, 70);
  // Normals are averaged over the triangles around a vertex, so those without area share the good one's
  // vertices: a normal of theirs that is no number would spoil it.
  const Shot alone = shoot(objScene(rest, vertices + "f 1 2 3\n"), size);
  const Shot among = shoot(objScene(rest, vertices + "f 1 1 2\nf 3 3 3\nf 1 2 5\nf 1 4 3\nf 1 2 3\nf 2 5 1\n"
                                                     "f 6 6 6\nf 2 4 1\n"),
                           size);
  EXPECT_GT(coveredPixels(alone.gbuffer), size.x * size.y / 10);
  EXPECT_EQ(among.image.pixels, alone.image.pixels);
  EXPECT_EQ(among.gbuffer.position, alone.gbuffer.position);
  EXPECT_EQ(among.gbuffer.normal, alone.gbuffer.normal);
  expectAsTheReference(among);
}

/// By how much a point lies inside a convex polygon's edge from a to b (counter-clockwise, y up), in units of
/// length.
double inside(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
  const glm::dvec2 along = glm::normalize(b - a);
  return along.x * (p.y - a.y) - along.y * (p.x - a.x);
}

TEST(HardGeometry, NeedlesCoverWhatTheirEdgesSay) {
  // A needle of 1 µm by 1 m, seen so near that a pixel is 1/16 µm: its tip lies 16 million pixels away, a
  // thousand times beyond where triangles are cut. And so far that it is a thousandth of a pixel wide.
  const std::string obj = "v 0 0 0\nv 1e-6 0 0\nv 3e-7 1 0\nf 1 2 3\n";
  const glm::dvec2 a(0, 0), b(double(1e-6f), 0), c(double(3e-7f), 1);
  const glm::ivec2 size(48, 32);
  for (const double pixel : {1e-6 / 16, 1e-3}) {
    const double half = 0.5 * size.y * pixel;
    const glm::dvec2 middle =
        pixel < 1e-5 ? glm::dvec2(6.1e-7, 5.3e-7) : glm::dvec2(2.1e-4, 1.0 - 0.6 * half);
    const Shot shot = shoot(
        objScene(
            fmt::format(R"("camera": {{"eye": [{0}, {1}, 2], "target": [{0}, {1}, 0], "orthographic": {2}}},
                                "materials": {{"m": {{"diffuse": [1, 0.5, 0.25]}}}},
                                "lights": [{{"type": "directional", "direction": [0, 0, -1]}}], )",
                        middle.x, middle.y, half),
            obj),
        size);
    int covered = 0;
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const glm::dvec2 p =
            middle + glm::dvec2(pixelRay(shot.settings.camera, size, x + 0.5, y + 0.5).origin);
        // In pixels; edges may move by kEdgeShift where corners are cut and snapped.
        const double in = std::min({inside(a, b, p), inside(b, c, p), inside(c, a, p)}) / pixel;
        const bool shown = isCovered(shot.gbuffer, x, y);
        if (in > kEdgeShift) {
          ASSERT_TRUE(shown) << x << "," << y << " lies inside by " << in;
        }
        if (in < -kEdgeShift) {
          ASSERT_FALSE(shown) << x << "," << y << " lies outside by " << -in;
        }
        // Lit head on: exactly the diffuse colour, as a normal of (0, 0, 1) takes no rounding.
        ASSERT_EQ(colorAt(shot.image, x, y), shown ? glm::vec3(1, 0.5f, 0.25f) : glm::vec3(0))
            << x << "," << y;
        covered += shown;
      }
    }
    // Near, 16 pixels wide in most rows; far, it may fall between all samples.
    if (pixel < 1e-5) {
      EXPECT_GT(covered, 15 * size.y / 2);
    }
  }
}

TEST(HardGeometry, AWallWithNeedlesInItHasNoHoles) {
  // A square cut from top to bottom at x = 0, 1 µm, 2 µm … 20 µm: pieces a hundred-thousandth of a pixel
  // wide.
  std::string cut = "v -1 -1 0\nv -1 1 0\n";
  constexpr int kCuts = 21;
  for (int i = 0; i < kCuts; ++i) cut += fmt::format("v {0} -1 0\nv {0} 1 0\n", i * 1e-6);
  cut += "v 1 -1 0\nv 1 1 0\n";
  for (int i = 0; i <= kCuts; ++i)
    cut += fmt::format("f {0} {1} {2}\nf {0} {2} {3}\n", 2 * i + 1, 2 * i + 3, 2 * i + 4, 2 * i + 2);
  const std::string whole = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\n";
  for (const char* eye : {"0, 0, 3", "1.1, 0.7, 2", "5e-6, 0, 0.01"}) {
    const std::string rest = fmt::format(
        R"("camera": {{"eye": [{}], "target": [0, 0, 0], "near": 0.001}}, "materials": {{"m": {{"diffuse": 1}}}},
           "lights": [{{"type": "directional", "direction": [0, 0, -1]}}], )",
        eye);
    const glm::ivec2 size(93, 71);
    const Shot one = shoot(objScene(rest, whole), size), many = shoot(objScene(rest, cut), size);
    ASSERT_GT(coveredPixels(one.gbuffer), size.x * size.y / 6);
    // Outline and colour (a flat wall under parallel light) are the same to the last bit.
    ASSERT_EQ(many.image.pixels, one.image.pixels) << eye;
  }
}

/// A square of 2 m in the plane z = 0, seen head on so that it fills the picture, unlit, with a map of two
/// texels, black and white. `uvs`: of its corners, bottom left and on counter-clockwise.
Shot mappedSquare(const std::string& uvs, glm::ivec2 size) {
  const TemporaryFolder folder;
  writeImage({2, 1, {"R", "G", "B"}, {0, 0, 0, 1, 1, 1}}, folder / "map.png", {});
  std::ofstream(folder / "mesh.obj") << "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                                     << uvs << "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
  std::ofstream(folder / "scene.json") << R"({"lighting": false,
    "camera": {"eye": [0, 0, 2], "target": [0, 0, 0], "orthographic": 1},
    "materials": {"m": {"diffuse": 1, "diffuse_map": "map.png"}}, "objects": [{"mesh": "mesh.obj", "material": "m"}]})";
  return shoot(loadScene(folder / "scene.json"), size);
}

TEST(HardGeometry, TextureCoordinatesWithoutAreaShowAPointOrALine) {
  const glm::ivec2 size(31, 31);
  // All corners at one point: a quarter of the way from the black texel's centre to the white one's.
  const Shot point = mappedSquare("vt 0.375 0.5\nvt 0.375 0.5\nvt 0.375 0.5\nvt 0.375 0.5\n", size);
  for (const float value : point.image.pixels) ASSERT_EQ(value, 0.25f);
  // All on a line, u from 1/4 to 3/4 along x: between the texels' centres the shares, in linear light, are
  // x's own. The map is read at its finest level, as a pixel is less than a texel.
  const Shot line = mappedSquare("vt 0.25 0.5\nvt 0.75 0.5\nvt 0.75 0.5\nvt 0.25 0.5\n", size);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      // u rounds to a float (2⁻²⁵ below 1), counts twice as the map is two texels wide, and the share and the
      // mix round once more each.
      ASSERT_NEAR(colorAt(line.image, x, y).x, (x + 0.5) / size.x, 2 * 0x1p-25 + 2 * 0x1p-24);
  // On a slanted line the same, with v beyond the map; and far from it, where floats are 2⁻⁷ apart.
  const Shot slanted = mappedSquare("vt 0.25 4\nvt 0.75 5\nvt 0.75 5\nvt 0.25 4\n", size);
  EXPECT_EQ(slanted.image.pixels, line.image.pixels);
  const Shot far =
      mappedSquare("vt 100000.25 77777\nvt 100000.75 77777\nvt 100000.75 77777\nvt 100000.25 77777\n", size);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      ASSERT_NEAR(colorAt(far.image, x, y).x, (x + 0.5) / size.x, 2 * 0x1p-8 + 0x1p-22);
}

TEST(HardGeometry, FloorsWithCornersInTheEyesPlane) {
  // A floor 1 m below the eye, from `start` to 100 m ahead: w = −z of its near corners is 0, or 10⁻¹² m, a
  // quarter micron or an eighth of the near distance to either side of it, or just in the near plane.
  const glm::ivec2 size(61, 47);
  for (const double start : {0.0, 1e-12, -1e-12, 2.5e-7, -2.5e-7, 0.0125, -0.0125, 0.1}) {
    const std::string obj =
        fmt::format("v -50 -1 {0}\nv 50 -1 {0}\nv 50 -1 -100\nv -50 -1 -100\nf 1 2 3\nf 1 3 4\n", -start);
    const Shot shot = shoot(objScene(R"("camera": {"eye": [0, 0, 0], "target": [0, 0, -1], "fov_y": 120},
        "materials": {"m": {"diffuse": [0.6, 0.8, 0.4], "specular": 0.3, "shininess": 12}}, "ambient": 0.05,
        "lights": [{"type": "point", "position": [0.5, 1, -2], "range": 30},
                   {"type": "point", "position": [0, -0.5, 0.5], "range": 2, "color": [1, 0, 0]}], )",
                                     obj),
                            size);
    const glm::dmat3 to_world(shot.settings.camera.camera_to_world);
    int compared = 0;
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const glm::dvec3 way = to_world * pixelRay(shot.settings.camera, size, x + 0.5, y + 0.5).direction;
        // As a ray meets y = −1: from 0.58 m on, at the picture's lower edge, so beyond the near plane.
        const glm::dvec3 hit = way * (-1 / way.y);
        // A pixel at the far end is 3 m deep and 2 m wide, of which edges may move by kEdgeShift.
        const bool on_floor = way.y < 0 && -hit.z < 99 && std::abs(hit.x) < 49;
        if (way.y >= 0 || -hit.z > 101 || std::abs(hit.x) > 51) {
          ASSERT_FALSE(isCovered(shot.gbuffer, x, y));
        }
        if (!on_floor) continue;
        ASSERT_TRUE(isCovered(shot.gbuffer, x, y)) << start << ": " << x << "," << y;
        const glm::dvec3 expected = glm::transpose(to_world) * hit;
        // Rounded to a float; the double's own rounding, 100 m over the 1 m above the floor times 2⁻⁵³ for
        // each of some ten operations, is far below the 0.1 % allowed for it.
        ASSERT_LE(glm::length(glm::dvec3(positionAt(shot.gbuffer, x, y)) - expected),
                  kUnit * 1.001 * glm::length(expected));
        ++compared;
      }
    }
    EXPECT_GT(compared, size.x * size.y / 3);
    expectAsTheReference(shot);
    expectCullingChangesNothing(shot);
  }
}

/// A camera in the middle of a box of 2 × 2 × 2 m, and a ball outside it.
std::string insideABox(const char* box) {
  return fmt::format(
      R"({{"camera": {{"eye": [0, 0, 0], "target": [0.3, 0.2, -1], "fov_y": 100}}, "background": [0.1, 0.2, 0.3],
    "materials": {{"one": {{"diffuse": [0.5, 0.25, 1]}}, "two": {{"diffuse": [0.5, 0.25, 1], "double_sided": true}}}},
    "objects": [{{"primitive": "sphere", "translate": [1, 0.5, -5]}}{}],
    "lights": [{{"type": "point", "position": [0, 0, 0]}}]}})",
      box);
}

TEST(HardGeometry, FromInsideASingleSidedObjectIsNotThere) {
  const glm::ivec2 size(60, 45);
  const Shot without = shoot(insideABox(""), size);
  const Shot with = shoot(insideABox(R"(, {"primitive": "box", "scale": 2, "material": "one"})"), size);
  EXPECT_GT(coveredPixels(without.gbuffer), 30);
  EXPECT_EQ(with.image.pixels, without.image.pixels);
}

TEST(HardGeometry, FromInsideADoubleSidedObjectItsInsideIsLit) {
  const glm::ivec2 size(60, 45);
  const Shot shot = shoot(insideABox(R"(, {"primitive": "box", "scale": 2, "material": "two"})"), size);
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      ASSERT_TRUE(isCovered(shot.gbuffer, x, y));
      // The light is at the eye, and walls lie 1 m away: N·L is the way's largest share along an axis.
      const glm::dvec3 way =
          glm::abs(glm::dmat3(shot.settings.camera.camera_to_world) *
                   glm::normalize(pixelRay(shot.settings.camera, size, x + 0.5, y + 0.5).direction));
      const double cosine = std::max({way.x, way.y, way.z});
      // The unit vector has 10 roundings (see wayToLight), the normal 1, the product 3, the colour 3 more.
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(colorAt(shot.image, x, y)[c], glm::dvec3(0.5, 0.25, 1)[c] * cosine, 17 * kUnit);
    }
  }
  expectAsTheReference(shot);
  expectCullingChangesNothing(shot);
}

/// Two rectangles, each the one before the other in half of the picture, that fill a view of near 10⁻⁶ m and
/// far 10⁸ m: the red one at `depth`, the green one `gap` of that behind it on the left and before it on the
/// right. Turned out of the view's plane by `turn` degrees.
std::string twoWalls(double depth, double gap, double turn, bool green_first) {
  const auto wall = [&](const char* material, double side, double shift) {
    // The plane primitive faces +y: turned to face the camera, then about y.
    return fmt::format(
        R"({{"primitive": "plane", "material": "{}", "rotate": [90, {}, 0], "scale": [{}, 1, {}], "translate": [{}, 0, {}]}})",
        material, turn, 3 * depth, 9 * depth, side * 1.5 * depth * std::cos(glm::radians(turn)),
        -depth * (1 + shift) - side * 1.5 * depth * std::sin(glm::radians(turn)));
  };
  const std::string red = wall("red", -1, 0) + ", " + wall("red", 1, 0);
  const std::string green = wall("green", -1, gap) + ", " + wall("green", 1, -gap);
  return fmt::format(
      R"({{"lighting": false, "camera": {{"eye": [0, 0, 0], "target": [0, 0, -1], "near": 1e-6, "far": 1e8}},
    "materials": {{"red": {{"diffuse": [1, 0, 0]}}, "green": {{"diffuse": [0, 1, 0]}}, "blue": {{"diffuse": [0, 0, 1]}}}},
    "objects": [{}, {}, {{"primitive": "sphere", "material": "blue", "scale": 4e-7, "translate": [0, 0, -2.2e-6]}}]}})",
      green_first ? green : red, green_first ? red : green);
}

TEST(HardGeometry, FourteenDecadesOfDepthAreOrdered) {
  // Reversed depth near·(far/z − 1)/(far − near) is a float, whose rounding is 2⁻²⁴ of itself, so that it
  // keeps order where 1/z does: at z = 10⁷ of far = 10⁸ a gap g of z is g·(far/z)/(far/z − 1) = 1.11 g of the
  // depth. A wall straight ahead is rounded once, so that of two of them gaps from 2 · 2⁻²⁴ = 1.2e-7 are
  // kept; a slanted one up to 3 times (at a row's start, the step, the sum), so from 3.6e-7: 3.6 m in 10 000
  // km, and both below 10⁻⁶.
  const glm::ivec2 size(64, 48);
  for (const auto& [turn, gap] :
       {std::pair(0.0, 1e-6), {0.0, 1.2e-7}, {30.0, 1e-6}, {30.0, 3.7e-7}, {-50.0, 1e-6}}) {
    for (const double depth : {1e7, 1.0, 1e-3}) {
      for (const bool green_first : {false, true}) {
        const Shot shot = shoot(twoWalls(depth, gap, turn, green_first), size);
        for (int y = 0; y < size.y; ++y) {
          for (int x = 0; x < size.x; ++x) {
            // A ball of 0.4 µm, 2.2 µm ahead, hides the walls near the middle; left out with its outline.
            const glm::dvec2 way(pixelRay(shot.settings.camera, size, x + 0.5, y + 0.5).direction);
            const double tangent = glm::length(way);
            if (tangent < 0.17) {
              ASSERT_EQ(colorAt(shot.image, x, y), glm::vec3(0, 0, 1));
            } else if (tangent > 0.2) {
              ASSERT_EQ(colorAt(shot.image, x, y), way.x < 0 ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0))
                  << x << "," << y << " turn " << turn << " gap " << gap << " depth " << depth;
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace luciole::test
