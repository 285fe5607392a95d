#include "tools/bench/shadow_truth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include "kernels/shared.h"
#include "raster/rasterize.hpp"
#include "rays/shadow_rays.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

/// A floor at y = 0, and 1 m above it a square of 2 m a side.
constexpr const char* kSquare = R"({
  "camera": {"eye": [4, 6, 5], "target": [1, 0, 0.3]},
  "materials": {"white": {"double_sided": true}},
  "objects": [{"primitive": "plane", "scale": 200},
              {"primitive": "plane", "scale": 2, "translate": [0, 1, 0], "material": "white"}],
  "lights": []})";

constexpr const char* kFloor = R"({
  "camera": {"eye": [4, 6, 5], "target": [1, 0, 0.3]},
  "objects": [{"primitive": "plane", "scale": 200}],
  "lights": []})";

/// How far beside a limit a pixel must be for a float's rounding not to matter, metres and (for angles)
/// radians: G-buffers round to 6e-8 of about 10 m, Embree a few times in a row.
constexpr double kRounding = 2e-5;

Light sun(const glm::dvec3& direction) {
  Light light;
  light.kind = LightKind::kDirectional;
  light.direction = glm::normalize(direction);
  light.shadow = true;
  return light;
}

Light lamp(const glm::dvec3& position, float range) {
  Light light;
  light.position = position;
  light.range = range;
  light.shadow = true;
  return light;
}

Light spot(const glm::dvec3& position, const glm::dvec3& target, float range, double cutoff) {
  Light light = lamp(position, range);
  light.kind = LightKind::kSpot;
  light.direction = glm::normalize(target - position);
  light.cutoff = cutoff;
  return light;
}

/// One of each kind, and among them one without a shadow.
Scene squareScene() {
  Scene scene = sceneFromJson(kSquare);
  scene.lights = {sun({1.2, -1, 0.6}), lamp({0, 3, 0}, 9), lamp({-1, 3, 0.3}, 5),
                  spot({-1, 4, -1}, {1, 0, 0.5}, 6, 0.4)};
  scene.lights[1].shadow = false;
  return scene;
}

/// A scene with what the functions under test want to know of it.
struct Traced {
  explicit Traced(const Scene& scene_)
      : scene(scene_),
        view(cameraView(scene.cameras.front(), {319, 181})),
        gbuffer(rasterize(scene, allObjects(scene), view, Shading::kPhong, {})),
        flat(rasterize(scene, allObjects(scene), view, Shading::kFlat, {})),
        rays(buildShadowRays(scene, glm::dvec3(scene.cameras.front().camera_to_world[3]))),
        pairs(facingPairs(scene, gbuffer)),
        lit(traceTruth(scene, rays, gbuffer, pairs).lit) {}
  Traced(const Traced&) = delete;
  Traced& operator=(const Traced&) = delete;

  glm::dvec3 point(std::size_t place) const {
    const std::size_t n = gbuffer.pixels();
    const Plane& p = gbuffer.position;
    return glm::dvec3(gbuffer.camera.camera_to_world *
                      glm::dvec4(p[place], p[place + n], p[place + 2 * n], 1));
  }

  const Scene& scene;
  View view;
  GBuffer gbuffer, flat;
  RayScene rays;
  std::vector<LightPair> pairs;
  std::vector<std::uint8_t> lit;
};

glm::dvec3 vectorToLight(const Light& light, const glm::dvec3& point) {
  return light.kind == LightKind::kDirectional ? -light.direction : light.position - point;
}

/// How far inside its reach a light has a point: the least of what is left of its range and, in radians, of
/// its cutoff. Every surface of the scene faces up, every light is higher.
double insideReach(const Light& light, const glm::dvec3& point) {
  if (light.kind == LightKind::kDirectional) return 1;
  const glm::dvec3 way = light.position - point;
  const double left = light.range - glm::length(way);
  if (light.kind == LightKind::kPoint) return left;
  return std::min(left, light.cutoff - std::acos(-glm::dot(glm::normalize(way), light.direction)));
}

TEST(ShadowTruth, PairsAreWhereALightWithAShadowReaches) {
  const Scene scene = squareScene();
  const Traced traced(scene);
  std::set<std::pair<std::uint32_t, std::uint32_t>> found;
  for (const LightPair& pair : traced.pairs) EXPECT_TRUE(found.emplace(pair.pixel, pair.light).second);
  std::array<int, 4> reached{}, missed{};
  for (int y = 0; y < 181; ++y)
    for (int x = 0; x < 319; ++x)
      for (std::uint32_t light = 0; light < 4; ++light) {
        const auto place = static_cast<std::uint32_t>(traced.gbuffer.index(x, y));
        const double inside = insideReach(scene.lights[light], traced.point(place));
        if (std::abs(inside) < kRounding) continue;
        const bool reaches = scene.lights[light].shadow && inside > 0;
        ASSERT_EQ(found.erase({place, light}), std::size_t(reaches)) << x << ' ' << y << ' ' << light;
        ++(reaches ? reached : missed)[light];
      }
  // What is left lies on a limit, and no pixel beyond the picture's edge is among it.
  EXPECT_LT(found.size(), 10u);
  EXPECT_EQ(reached[1], 0);
  EXPECT_EQ(missed[0], 0);
  for (const int light : {2, 3}) EXPECT_TRUE(reached[light] > 1000 && missed[light] > 1000) << light;
}

TEST(ShadowTruth, PairsComeByTileThenLightThenPixel) {
  const Scene scene = squareScene();
  const Traced traced(scene);
  const auto key = [](const LightPair& pair) {
    return std::tuple(pair.pixel / kTilePixels, pair.light, pair.pixel);
  };
  EXPECT_TRUE(std::is_sorted(traced.pairs.begin(), traced.pairs.end(),
                             [&](const LightPair& a, const LightPair& b) { return key(a) < key(b); }));
}

TEST(ShadowTruth, NothingShowsNothingPairs) {
  Scene scene = squareScene();
  scene.objects.clear();
  const Traced traced(scene);
  EXPECT_TRUE(traced.pairs.empty() && traced.lit.empty());
}

/// Where a floor point's ray to the light passes the square's height, by similar triangles: how far inside
/// the square, metres there; negative outside.
double insideSquare(const Light& light, const glm::dvec3& point) {
  const glm::dvec3 way = vectorToLight(light, point);
  const glm::dvec3 there = point + way * ((1 - point.y) / way.y);
  return 1 - std::max(std::abs(there.x), std::abs(there.z));
}

TEST(ShadowTruth, SquaresShadowIsWhereSimilarTrianglesSayIt) {
  const Scene scene = squareScene();
  const Traced traced(scene);
  std::array<int, 4> lit{}, dark{};
  for (std::size_t i = 0; i < traced.pairs.size(); ++i) {
    const auto [pixel, light] = traced.pairs[i];
    const glm::dvec3 point = traced.point(pixel);
    const double inside = point.y > 0.5 ? -1 : insideSquare(scene.lights[light], point);
    if (std::abs(inside) < kRounding) continue;
    ASSERT_EQ(traced.lit[i], inside < 0) << point.x << ' ' << point.y << ' ' << point.z << ' ' << light;
    ++(inside < 0 ? lit : dark)[light];
  }
  for (const int light : {0, 2, 3}) EXPECT_TRUE(lit[light] > 1000 && dark[light] > 1000) << light;
}

/// How far a floor point is from each of the four planes that the light's rays through the square's rim make,
/// metres, positive towards the shadow. Across the rays, that is the way to the shadow's edge.
std::array<double, 4> wayInside(const Light& light, const glm::dvec3& point) {
  const glm::dvec3 middle(0, 1, 0);
  std::array<double, 4> ways{};
  for (int i = 0; i < 4; ++i) {
    const glm::dvec3 out = i < 2 ? glm::dvec3(1 - 2 * i, 0, 0) : glm::dvec3(0, 0, 5 - 2 * i);
    const glm::dvec3 rim = middle + out, along(out.z, 0, out.x);
    const glm::dvec3 normal = glm::normalize(glm::cross(along, vectorToLight(light, rim)));
    ways[i] = glm::dot(point - rim, normal) * (glm::dot(normal, out) < 0 ? 1 : -1);
  }
  return ways;
}

/// Eight points on a circle pass a straight line that is nearer than cos(π/8) of its radius, and none that is
/// farther than it. A point light's rays aren't parallel: from an edge 0.12 m away at 3 m, that takes or
/// gives 4 %.
constexpr double kSurely = 0.92 * 0.96, kAtMost = 1.04;

/// Different for every light, so that a mix-up shows.
double texelOf(std::uint32_t light) { return 0.03 * (light + 1); }

TEST(ShadowTruth, EdgesAreWithinATexelOfTheOutline) {
  const Scene scene = squareScene();
  const Traced traced(scene);
  const std::vector<std::uint8_t> edge =
      nearEdges(scene, traced.rays, traced.gbuffer, traced.flat, traced.pairs, traced.lit,
                [](std::uint32_t light, const glm::dvec3&) { return texelOf(light); });
  std::array<int, 4> inner_edges{}, outer_edges{}, others{};
  for (std::size_t i = 0; i < traced.pairs.size(); ++i) {
    const auto [pixel, light] = traced.pairs[i];
    const glm::dvec3 point = traced.point(pixel);
    if (point.y > 0.5) {  // nothing above, on the square or beyond its rim
      ASSERT_EQ(edge[i], 0) << point.x << ' ' << point.z << ' ' << light;
      continue;
    }
    std::array<double, 4> ways = wayInside(scene.lights[light], point);
    std::sort(ways.begin(), ways.end());
    const double texel = texelOf(light), nearest = ways[0];
    if (std::abs(nearest) > kAtMost * texel) {
      ASSERT_EQ(edge[i], 0) << point.x << ' ' << point.z << ' ' << light;
      ++others[light];
    } else if (std::abs(nearest) < kSurely * texel && (nearest > 0 || ways[1] > kAtMost * texel)) {
      // Outside, a corner may be missed by the eight.
      ASSERT_EQ(edge[i], 1) << point.x << ' ' << point.z << ' ' << light;
      ++(nearest > 0 ? inner_edges : outer_edges)[light];
    }
  }
  for (const int light : {0, 2, 3})
    EXPECT_TRUE(inner_edges[light] > 50 && outer_edges[light] > 50 && others[light] > 1000) << light;
}

TEST(ShadowTruth, TexelsSideIsAskedForWhereTheSurfaceIs) {
  const Scene scene = squareScene();
  const Traced traced(scene);
  std::vector<std::uint8_t> edge = nearEdges(scene, traced.rays, traced.gbuffer, traced.flat, traced.pairs,
                                             traced.lit, [](std::uint32_t, const glm::dvec3& point) {
                                               EXPECT_LT(std::abs(point.y - std::round(point.y)), kRounding);
                                               return point.x < 1.25 ? 1e-4 : 0.05;
                                             });
  int small = 0, large = 0;
  for (std::size_t i = 0; i < edge.size(); ++i)
    (traced.point(traced.pairs[i].pixel).x < 1.25 ? small : large) += edge[i];
  EXPECT_GT(large, 100);
  EXPECT_LT(small * 10, large);
}

/// Where the way back into the plane is cut short, some of the eight points stay under the plane, in its
/// shadow. Where it isn't, nothing shades any of them.
TEST(ShadowTruth, LightThatOnlyGrazesASurfaceMakesItAllEdge) {
  for (const double degrees : {1.0, 2.5, 3.5, 30.0, 90.0}) {
    Scene scene = sceneFromJson(kFloor);
    const double height = degrees * std::numbers::pi / 180;
    scene.lights = {sun({std::cos(height), -std::sin(height), 0})};
    const Traced traced(scene);
    ASSERT_GT(traced.pairs.size(), 10000u);
    const std::vector<std::uint8_t> edge =
        nearEdges(scene, traced.rays, traced.gbuffer, traced.flat, traced.pairs, traced.lit,
                  [](std::uint32_t, const glm::dvec3&) { return 0.01; });
    EXPECT_EQ(std::count(traced.lit.begin(), traced.lit.end(), 1), std::ptrdiff_t(edge.size()));
    const bool all = std::tan(height) * kLongestWayBack < 1;
    EXPECT_EQ(std::count(edge.begin(), edge.end(), 1), all ? std::ptrdiff_t(edge.size()) : 0) << degrees;
  }
}

TEST(ShadowTruth, JudgeCountsEdgesApart) {
  const std::vector<std::uint8_t> lit{1, 1, 1, 0, 0, 0, 0, 1, 0, 1}, edge{0, 0, 0, 0, 0, 0, 0, 1, 1, 1};
  const std::vector<float> visibility{1, 0.5f, 0.49f, 0, 0.49f, 0.5f, 1, 0, 1, 1};
  const ShadowErrors errors = judge(lit, edge, visibility);
  EXPECT_EQ(errors.lit, 3u);
  EXPECT_EQ(errors.dark, 4u);
  EXPECT_EQ(errors.wrongly_dark, 1u);
  EXPECT_EQ(errors.wrongly_lit, 2u);
  EXPECT_EQ(errors.edges, 3u);
  EXPECT_EQ(errors.wrong_edges, 2u);
}

}  // namespace
}  // namespace luciole::test
