// Fogs without depth, without density and with too much of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "luciole/error.hpp"
#include "pictures/surfaces_seen.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

/// A lit scene without objects in this fog; no fog if empty.
Scene foggyScene(const std::string& fog) {
  return sceneFromJson(R"({"lights": [{"type": "point", "position": [1, 2, 1], "color": [1, 0.5, 0.25]}])" +
                       (fog.empty() ? "" : R"(, "fog": {"color": [0.2, 0.3, 0.4], )" + fog + "}") + "}");
}
const glm::vec3 kFogColor(0.2f, 0.3f, 0.4f);

/// Points from 1 mm to 10⁶ m ahead, none at 10 m.
std::vector<SurfaceSeen> pointsAhead() {
  std::vector<SurfaceSeen> points;
  for (const float depth : {1e-3f, 0.5f, 1.0f, 3.0f, 9.99f, 10.01f, 40.0f, 1e3f, 1e6f})
    points.push_back({.position = {0.25f * depth, 0.125f * depth, -depth}, .specular = glm::vec3(0.5f)});
  return points;
}

TEST(HardFog, EndAtItsStartIsRefusedAndDrawnAsAWall) {
  try {
    foggyScene(R"("mode": "linear", "start": 10, "end": 10)");
    FAIL() << "the fog was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("scene.json: fog"));
    EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("\n")));
  }
  // A scene made by a program may hold it: clear up to there, and nothing seen from there on.
  Scene scene = foggyScene(R"("mode": "linear", "start": 9, "end": 10)");
  scene.fog.start = 10;
  auto points = pointsAhead();
  points.push_back({.position = {0, 0, -10}});
  const auto clear = shadedPoints(16, foggyScene(""), points);
  for (const int lanes : {1, 16}) {
    const auto seen = shadedPoints(lanes, scene, points);
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_EQ(seen[i], points[i].position.z > -10 ? clear[i] : kFogColor) << -points[i].position.z << " m";
  }
  const auto truth = referencePoints(scene, points);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_EQ(truth[i] == kFogColor, points[i].position.z <= -10) << -points[i].position.z << " m";
}

TEST(HardFog, DensityOf0LeavesEveryBit) {
  const auto points = pointsAhead();
  for (const int lanes : {1, 16}) {
    const auto clear = shadedPoints(lanes, foggyScene(""), points);
    for (const char* mode : {"exp", "exp2"}) {
      const std::string fog = std::string(R"("mode": ")") + mode + R"(", "density": )";
      EXPECT_EQ(shadedPoints(lanes, foggyScene(fog + "0"), points), clear) << mode;
      EXPECT_EQ(shadedPoints(lanes, foggyScene(fog + R"(0, "distance": "radial")"), points), clear) << mode;
      // So does one that floats don't tell from 0 over these distances: exp(−10⁶ · 10⁻¹⁸) = 1 − 10⁻¹².
      EXPECT_EQ(shadedPoints(lanes, foggyScene(fog + "1e-18"), points), clear) << mode;
    }
  }
}

TEST(HardFog, HugeDensityShowsTheFogsColourAlone) {
  const auto points = pointsAhead();
  for (const int lanes : {1, 16})
    for (const char* mode : {"exp", "exp2"})
      // 10⁵ /m at 1 mm is e^−100 or e^−10000, the first 10^-44 and flushed; the square of 10¹⁸ · 10⁶
      // overflows.
      for (const char* density : {"1e5", "1e18"})
        EXPECT_EQ(shadedPoints(lanes,
                               foggyScene(std::string(R"("mode": ")") + mode + R"(", "density": )" + density),
                               points),
                  std::vector<glm::vec3>(points.size(), kFogColor))
            << mode << " " << density;
}

TEST(HardFog, ChannelsHaveDensitiesFromNoneToOpaque) {
  const auto points = pointsAhead();
  for (const char* mode : {"exp", "exp2"}) {
    const Scene scene = foggyScene(std::string(R"("mode": ")") + mode + R"(", "density": [0, 0.05, 1e18])");
    ASSERT_NO_FATAL_FAILURE(expectRight(scene, points));
    const auto clear = shadedPoints(16, foggyScene(""), points), seen = shadedPoints(16, scene, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(seen[i].r, clear[i].r) << "red passes to the bit";
      EXPECT_EQ(seen[i].b, kFogColor.b) << "blue is gone to the bit";
    }
  }
}

TEST(HardFog, GlaringSurfacesStayFiniteAndFogHidesThemAll) {
  // The largest float in front of and behind a fog.
  std::vector<SurfaceSeen> points = pointsAhead();
  for (SurfaceSeen& seen : points) seen.emission = glm::vec3(std::numeric_limits<float>::max());
  for (const char* mode : {R"("mode": "linear", "start": 1, "end": 30)", R"("mode": "exp", "density": 1)"}) {
    const auto seen = shadedPoints(16, foggyScene(mode), points);
    for (const glm::vec3& color : seen)
      for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(color[c])) << mode;
    EXPECT_EQ(seen.back(), kFogColor) << mode;
  }
}

}  // namespace
}  // namespace luciole::test
