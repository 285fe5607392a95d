// Triangles that are too wide for Gouraud shading.
#include "raster/coarse_triangles.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "render_json.hpp"

namespace luciole::test {
namespace {

constexpr const char* kLamp = R"({"type": "point", "position": [1, 1, 2], "range": 3})";
constexpr const char* kBareBulb = R"({"type": "point", "position": [1, 1, 2]})";

/// An edge's ends are floats of up to 1, rounded by 2⁻²⁵ on two axes, of a floor 20 m wide.
constexpr double kRounding = 20 * 4 * 0x1p-25;

/// Of such a floor under these lights.
double width(const std::string& lights, const std::string& segments, const std::string& more = "") {
  return coarseTriangleWidth(sceneFromJson(fmt::format(
      R"({{"camera": {{"eye": [0, 9, 9], "target": [0, 0, 0]}}, "lights": [{}],
           "objects": [{{"primitive": "plane", {} "scale": 20}}{}]}})",
      lights, segments, more)));
}

TEST(CoarseTriangles, AreWiderThanALightReachesOrThanAQuarterOfTheScene) {
  const double diagonal = 20 * std::sqrt(2.0);
  EXPECT_NEAR(width(kLamp, R"("segments": 1,)"), diagonal, kRounding);
  EXPECT_NEAR(width(kBareBulb, R"("segments": 1,)"), diagonal, kRounding);
  EXPECT_NEAR(width(kLamp, R"("segments": 5,)"), diagonal / 5, kRounding);
  EXPECT_EQ(width(kBareBulb, R"("segments": 5,)"), 0) << "a fifth of the scene";
}

TEST(CoarseTriangles, AreTheWidestOfAll) {
  const std::string small = R"(, {"primitive": "box", "translate": [9, 0, 9]})";
  EXPECT_NEAR(width(kLamp, R"("segments": 1,)", small), 20 * std::sqrt(2.0), kRounding);
}

TEST(CoarseTriangles, AreNoneWhereTheyAreSmallOrNoLightHasAPlace) {
  EXPECT_EQ(width(kLamp, R"("segments": 64,)"), 0);
  EXPECT_EQ(width(kLamp, ""), 0) << "Gouraud shading divides it";
  EXPECT_EQ(width("", R"("segments": 1,)"), 0);
  EXPECT_EQ(width(R"({"type": "directional", "direction": [0, -1, 0]})", R"("segments": 1,)"), 0);
}

}  // namespace
}  // namespace luciole::test
