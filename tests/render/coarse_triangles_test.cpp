// Where Gouraud shading loses lights between the corners of triangles.
#include "render/coarse_triangles.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "render_json.hpp"

namespace luciole::test {
namespace {

double width(const std::string& light, const std::string& floor) {
  return coarseTriangleWidth(sceneFromJson(fmt::format(
      R"({{"camera": {{"eye": [0, 9, 9], "target": [0, 0, 0]}}, "objects": [{}], "lights": [{}]}})", floor,
      light)));
}

/// Two triangles whose long edges go from corner to corner, one below (1, 2).
const std::string kFloor = R"({"primitive": "plane", "segments": 1, "scale": 20})";
const double kDiagonal = 20 * std::sqrt(2.0);

TEST(CoarseTriangles, AreThoseThatALightShinesOnBetweenTheirCorners) {
  for (const char* light :
       {R"({"type": "point", "position": [1, 1, 2], "range": 3})",
        R"({"type": "point", "position": [1, 1, 2]})",
        R"({"type": "point", "position": [1, 5, 2], "attenuation": [0, 0, 1]})",
        R"({"type": "spot", "position": [1, 40, 2], "direction": [0, -1, 0], "cutoff": 5})",
        R"({"type": "spot", "position": [50, 40, 2], "target": [1, 0, 2], "cutoff": 5})"})
    EXPECT_NEAR(width(light, kFloor), kDiagonal, 1e-9) << light;
}

TEST(CoarseTriangles, AreNotThoseWhoseCornersSeeTheLight) {
  for (const char* light :
       {R"({"type": "directional", "direction": [0, -1, 0]})", R"({"type": "point", "position": [1, 30, 2]})",
        R"({"type": "point", "position": [1, 1, 2], "range": 0.9})",  // doesn't reach the floor
        R"({"type": "point", "position": [1, -1, 2], "range": 3})",   // from behind
        R"({"type": "point", "position": [30, 1, 2], "range": 3})",   // beside it
        R"({"type": "spot", "position": [1, 40, 2], "direction": [0, 1, 0], "cutoff": 5})",
        R"({"type": "spot", "position": [1, 40, 2], "direction": [0, -1, 0], "cutoff": 40})"})
    EXPECT_EQ(width(light, kFloor), 0) << light;
}

TEST(CoarseTriangles, SmallOnesHaveNone) {
  const std::string light = R"({"type": "point", "position": [1, 1, 2], "range": 3})";
  EXPECT_EQ(width(light, R"({"primitive": "plane", "segments": 64, "scale": 20})"), 0);
  EXPECT_EQ(width(light, R"({"primitive": "plane", "scale": 20})"), 0) << "Gouraud shading divides it";
  EXPECT_EQ(width("", kFloor), 0);
}

TEST(CoarseTriangles, OfAMirroredFloorAreTheSame) {
  const std::string light = R"({"type": "point", "position": [1, 1, 2], "range": 3})";
  EXPECT_NEAR(width(light, R"({"primitive": "plane", "segments": 1, "scale": [-20, 1, 20]})"), kDiagonal,
              1e-9);
  EXPECT_EQ(width(light, R"({"primitive": "plane", "segments": 1, "scale": [20, -1, 20]})"), 0)
      << "faces down";
}

TEST(CoarseTriangles, WidestCountsAmongMany) {
  std::string floors = kFloor;
  for (int i = 0; i < 3000; ++i)
    floors += fmt::format(R"(, {{"primitive": "plane", "segments": 1, "translate": [{}, -5, 0]}})", 30 + i);
  EXPECT_NEAR(width(R"({"type": "point", "position": [1, 1, 2], "range": 3})", floors), kDiagonal, 1e-9);
}

}  // namespace
}  // namespace luciole::test
