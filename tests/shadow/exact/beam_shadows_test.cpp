#include "shadow/exact/beam_shadows.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"
#include "kernels/shared.h"
#include "lighting/light_gbuffer.hpp"
#include "luciole/pose.hpp"
#include "shadow/exact/brute_shadows.hpp"

namespace luciole::test {
namespace {

/// Enough pixels for points on every sheet.
constexpr glm::ivec2 kSheetsSize{80, 60};
constexpr int kSheets = 40;

/// Adds the parallelogram with these sides at the corner, wound so that its normal is cross(u, v).
void addSheet(const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v, Mesh& mesh) {
  const auto first = std::uint32_t(mesh.positions.size());
  for (const glm::dvec3& place : {corner, corner + u, corner + u + v, corner + v}) {
    mesh.positions.push_back(glm::vec3(place));
    mesh.normals.push_back(glm::vec3(glm::normalize(glm::cross(u, v))));
  }
  for (const glm::uvec3& corners : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) {
    mesh.triangles.push_back(corners + first);
    mesh.triangle_materials.push_back(0);
  }
}

/// Sheets that the eye, at the origin, sees, and covers that only the lights know. A cover lies over a half
/// of its sheet, at a distance that is 0.2 to 30 times the one up to which shadow rays ignore it.
struct Sheets {
  Mesh seen, covers;
  /// Whether the shadow maps hold what is seen, too. Surfaces of another program's G-buffer needn't be there.
  bool cast = true;
};

/// A mesh where it is, of one material.
Scene sceneOf(const Mesh& mesh) {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes = {mesh};
  scene.objects = {{0, glm::dmat4(1), -1}};
  return scene;
}

Sheets coveredSheets(Random& random) {
  Sheets sheets;
  for (int i = 0; i < kSheets; ++i) {
    const glm::dvec3 way =
        glm::normalize(glm::dvec3(random.between(-0.6, 0.6), random.between(-0.45, 0.45), -1));
    const glm::dvec3 center = random.between(2, 12) * way;
    const glm::dvec3 normal = glm::normalize(random.direction() * 0.7 - way);
    const double side = 0.2 * glm::length(center);
    const glm::dvec3 u = side * glm::normalize(glm::cross(normal, random.direction()));
    const glm::dvec3 v = glm::cross(normal, u);
    addSheet(center - 0.5 * (u + v), u, v, sheets.seen);
    const double times =
        random.chance(0.3) ? random.between(0.8, 1.2) : std::exp(random.between(std::log(0.2), std::log(30)));
    const double gap = times * double(POINT_ERROR) * glm::length(center);
    addSheet(center - 0.5 * (u + v) + gap * normal, 0.5 * u, v, sheets.covers);
  }
  return sheets;
}

std::vector<Light> lightsOverSheets(Random& random) {
  std::vector<Light> lights;
  for (const LightKind kind : {LightKind::kDirectional, LightKind::kPoint, LightKind::kSpot})
    for (int i = 0; i < 4; ++i) {
      Light light;
      light.kind = kind;
      light.shadow = true;
      light.position = glm::dvec3(random.between(-6, 6), random.between(-6, 6), random.between(-2, 3));
      light.direction = glm::normalize(glm::dvec3(random.between(-3, 3), random.between(-3, 3), -7) -
                                       glm::dvec3(light.position));
      light.cutoff = glm::radians(60.0);
      lights.push_back(light);
    }
  return lights;
}

struct Verdicts {
  std::uint64_t pairs = 0;  ///< of a pixel and a light that may brighten it
  std::uint64_t lit = 0;
  std::uint64_t part = 0;         ///< where a part of a light of a size is seen
  std::uint64_t soft_rays = 0;    ///< of which rays decide, because the light has a size
  std::uint64_t soft_others = 0;  ///< and those with such lights that rays needn't decide
  std::uint64_t before = 0;       ///< lit as the point is before a triangle that would hide it anywhere
  std::uint64_t wrong = 0;        ///< of which brute force says something else
};

/// Adds up the verdicts on what a camera sees: the G-buffer shows `seen`, and what casts shadows is `scene`.
/// move: moves the points; then Verdicts::before is counted.
void addVerdicts(const Scene& scene, const Scene& seen, const Camera& camera, glm::ivec2 size, int lanes,
                 Culling culling, Verdicts& verdicts, int soft_samples = 0,
                 const std::function<void(GBuffer&)>& move = {}) {
  const View view = cameraView(camera, size);
  ShadeSettings settings;
  settings.culling = culling;
  settings.shadows = soft_samples > 0 ? ShadowMethod::kSoftExact : ShadowMethod::kExact;
  if (soft_samples > 0) settings.soft_samples = soft_samples;
  const FeatureSet features = neededFeatures(scene, camera, materialTraits(scene), settings);
  GBuffer gbuffer = rasterize(seen, allObjects(seen), view, Shading::kPhong, neededPlanes(features));
  if (move) move(gbuffer);
  OpenedDevice& device = deviceWithLanes(lanes);
  Lighting lighting;
  Stats stats;
  prepareLighting(device, scene, camera, view, features, settings, lighting, stats);
  const LitPlanes lit = lightGBuffer(device, scene, lighting, {lighting.lights, features, gbuffer}, stats);

  const std::size_t stride = gbuffer.pixels(), tiles = stride / kTilePixels,
                    light_count = lighting.lights.beam_lights.size();
  std::vector<uint> starts(tiles + 1);
  std::vector<ListEntry> list(lighting.lists.entries);
  if (culling == Culling::kTiles) {
    download(device, lighting.lists.starts, starts);
    download(device, lighting.lists.list, list);
  }
  const PairWords words = downloadPairs(device, lit.pairs);
  const glm::dmat4 view_to_world = camera.camera_to_world;
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    const bool listed = culling == Culling::kTiles;
    const std::size_t first = listed ? starts[tile] : tile * light_count,
                      end = listed ? starts[tile + 1] : first + light_count;
    for (std::size_t entry = first; entry < end; ++entry) {
      const std::uint32_t light = listed ? list[entry].light : std::uint32_t(entry - first);
      const BeamLight& beam = lighting.lights.beam_lights[light];
      if (!beam.casts) continue;
      for (std::size_t pixel = 0; pixel < kTilePixels; ++pixel) {
        const std::size_t place = tile * kTilePixels + pixel;
        if (!std::isfinite(gbuffer.position[place + 2 * stride])) continue;
        const glm::dvec3 normal(gbuffer.normal[place], gbuffer.normal[place + stride],
                                gbuffer.normal[place + 2 * stride]);
        const glm::vec3 start = startInTree(lighting.beams, gbuffer, place);
        const glm::dvec3 at(beam.place.x, beam.place.y, beam.place.z);
        const glm::dvec3 way = beam.place.w == 0 ? at : at - glm::dvec3(start);
        if (glm::length(way) > beam.reach || glm::dot(glm::dmat3(view_to_world) * normal, way) <= 0) continue;
        // Squares that the list leaves out aren't shaded.
        if (listed && (list[entry].squares >> SQUARE_OF_PIXEL(pixel) & 1) == 0) continue;
        const float share = shareOf(words, entry, pixel);
        ++verdicts.pairs;
        verdicts.lit += share == 1;
        verdicts.part += share > 0 && share < 1;
        if (move && share == 1) verdicts.before += isBeforeOne(*lighting.beams.tree, start, beam);
        verdicts.wrong += share != shareSeen(lighting, start, light);
      }
    }
  }
  verdicts.soft_rays += lit.traced.soft;
  verdicts.soft_others += lit.traced.soft_lit + lit.traced.soft_dark;
}

/// A camera at the origin, and the sheets as it sees them.
void addVerdictsOnSheets(const Sheets& sheets, const std::vector<Light>& lights, int lanes,
                         Verdicts& verdicts, int soft_samples = 0) {
  Scene seen = sceneOf(sheets.seen);
  seen.lights = lights;
  Camera camera;
  camera.camera_to_world = glm::dmat4(1);
  seen.cameras = {camera};
  Scene scene = seen;
  scene.meshes.push_back(sheets.covers);
  if (!sheets.cast) scene.objects.clear();
  scene.objects.push_back({1, glm::dmat4(1), -1});
  addVerdicts(scene, seen, camera, kSheetsSize, lanes, Culling::kNone, verdicts, soft_samples);
}

// Hardest is a surface as close behind another as the points on it are uncertain: whether that is a shadow
// depends on the last bit of the distance.
TEST(BeamShadows, AgreeWithBruteForceOnSheetsThatNearlyTouch) {
  Random random(21);
  Verdicts verdicts;
  for (const int lanes : {1, 4, 8, 16}) {
    Sheets sheets = coveredSheets(random);
    sheets.cast = lanes != 8;
    addVerdictsOnSheets(sheets, lightsOverSheets(random), lanes, verdicts);
  }
  EXPECT_EQ(verdicts.wrong, 0u) << "of " << verdicts.pairs << " pairs";
  EXPECT_GT(verdicts.lit, verdicts.pairs / 10);
  EXPECT_LT(verdicts.lit, verdicts.pairs - verdicts.pairs / 10);
}

/// Triangles of very different sizes and shapes, some without area, before a camera that looks at them from z
/// = 8, and lights of each kind: among them, on a corner, in a plane, behind the camera, and far away.
Scene soup(Random& random, int count, double scale) {
  Scene scene;
  scene.materials.resize(1);
  Mesh& mesh = scene.meshes.emplace_back();
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 middle(random.between(-4, 4), random.between(-3, 3), random.between(-4, 4));
    const double size = std::exp(random.between(std::log(1e-3), std::log(i % 10 == 0 ? 6 : 1)));
    const bool thin = random.chance(0.2);
    const glm::dvec3 u = size * random.direction();
    glm::dvec3 v = (thin ? 1e-4 : 1.0) * size * random.direction();
    const glm::dvec3 normal = glm::normalize(glm::cross(u, v));
    // Some are lines, or points.
    if (i % 20 == 1) v = double(i % 3 - 1) * u;
    for (const glm::dvec3& corner : {middle, middle + u, middle + v}) {
      mesh.positions.push_back(glm::vec3(scale * corner));
      mesh.normals.push_back(glm::vec3(normal));
    }
    const auto first = std::uint32_t(3 * i);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.triangle_materials.push_back(0);
  }
  scene.materials[0].double_sided = true;
  scene.objects = {{0, glm::dmat4(1), -1}};
  const auto add = [&](LightKind kind, const glm::dvec3& position) {
    Light light;
    light.kind = kind;
    light.shadow = true;
    light.position = position;
    light.direction = glm::normalize(-position + 0.1 * random.direction());
    light.cutoff = glm::radians(70.0);
    scene.lights.push_back(light);
  };
  for (int i = 0; i < 3; ++i)
    add(i == 2 ? LightKind::kSpot : LightKind::kPoint,
        scale * glm::dvec3(random.between(-3, 3), random.between(-2, 2), random.between(-3, 3)));
  add(LightKind::kPoint, glm::dvec3(mesh.positions[30]));
  add(LightKind::kPoint,
      (glm::dvec3(mesh.positions[0]) + glm::dvec3(mesh.positions[1]) + glm::dvec3(mesh.positions[2])) / 3.0);
  add(LightKind::kPoint, scale * glm::dvec3(0, 1, 9));
  add(LightKind::kPoint, scale * glm::dvec3(1, 0, 4));
  scene.lights.back().range = 4 * scale;
  add(LightKind::kPoint, scale * glm::dvec3(3e5, 1e6, 2e5));
  add(LightKind::kDirectional, scale * glm::dvec3(1, 2, 3));
  add(LightKind::kDirectional, scale * glm::dvec3(-1, 0, 0));
  Camera camera;
  camera.camera_to_world = cameraToWorld(scale * glm::dvec3(0.3, 0.2, 8), glm::dvec3(0), {0, 1, 0});
  camera.near *= scale;
  camera.far *= scale;
  scene.cameras = {camera};
  return scene;
}

TEST(BeamShadows, AgreeWithBruteForceInASoupOfTriangles) {
  Random random(22);
  Verdicts verdicts;
  for (const double scale : {1.0, 1e-3, 2e17}) {
    const Scene scene = soup(random, 700, scale);
    const int lanes = scale == 1 ? 16 : 8;
    addVerdicts(scene, scene, scene.cameras[0], {64, 48}, lanes,
                scale == 1 ? Culling::kTiles : Culling::kNone, verdicts);
    EXPECT_EQ(verdicts.wrong, 0u) << "of " << verdicts.pairs << " pairs, scale " << scale;
  }
  EXPECT_GT(verdicts.pairs, 10000u);
  EXPECT_GT(verdicts.lit, verdicts.pairs / 10);
  EXPECT_LT(verdicts.lit, verdicts.pairs - verdicts.pairs / 10);
}

/// Adds lights near the planes of some leaves, from as near as a leaf is wide on, so that rays run along
/// leaves.
void lightAlongLeaves(Random& random, const glm::dvec3& away, Scene& scene) {
  const Mesh& mesh = scene.meshes[0];
  for (int i = 0; i < 24; ++i) {
    const glm::uvec3 leaf = mesh.triangles[random.below(mesh.triangles.size())];
    const glm::dvec3 a(mesh.positions[leaf.x]), ab = glm::dvec3(mesh.positions[leaf.y]) - a,
                                                ac = glm::dvec3(mesh.positions[leaf.z]) - a;
    const glm::dvec3 along = glm::normalize(random.between(-1, 1) * ab + random.between(-1, 1) * ac);
    Light light;
    light.kind = i % 4 == 0 ? LightKind::kDirectional : LightKind::kPoint;
    light.shadow = true;
    light.direction = along;
    light.position = away + a + 0.3 * (ab + ac) + std::exp(random.between(std::log(1e-3), 0)) * along;
    scene.lights.push_back(light);
  }
}

// Corners are rounded by so much that triangles turn, and rays run along them.
TEST(BeamShadows, AgreeWithBruteForceAmongLeavesThatRoundingTurns) {
  Random random(23);
  Scene scene = soup(random, 700, 1.0);
  for (glm::vec3& position : scene.meshes[0].positions) position *= 1e-3f;
  const glm::dvec3 away(50, 60, 70);
  scene.objects[0].object_to_world[3] = glm::dvec4(away, 1);
  for (Light& light : scene.lights) light.position = away + 1e-3 * light.position;
  lightAlongLeaves(random, away, scene);
  // Far away from them, and with so narrow a view that they fill the picture.
  Camera camera = scene.cameras[0];
  camera.camera_to_world = cameraToWorld(glm::dvec3(0), away, {0, 1, 0});
  camera.fov_y = 8e-5;
  camera.near = 1;
  camera.far = 1000;
  Verdicts verdicts;
  addVerdicts(scene, scene, camera, {48, 36}, 16, Culling::kNone, verdicts);
  EXPECT_EQ(verdicts.wrong, 0u) << "of " << verdicts.pairs << " pairs";
  EXPECT_GT(verdicts.pairs, 2000u);
  EXPECT_LT(verdicts.lit, verdicts.pairs - verdicts.pairs / 10);
}

// The corners of tiny triangles far from the origin are rounded by so much that a point beyond a triangle's
// plane may be before its corners. Each point lies on the ray from a light to a triangle that it is almost in
// the plane of.
TEST(BeamShadows, AgreeWithBruteForceBeforeTrianglesThatRoundingTurned) {
  Random random(26);
  const glm::dvec3 away(40, 50, -70);
  Verdicts verdicts;
  for (const int lanes : {1, 4, 8, 16, 16, 16, 16, 16}) {
    Sheets sheets;
    addSheet({-9, -9, -4}, {18, 0, 0}, {0, 18, 0}, sheets.seen);
    Scene seen = sceneOf(sheets.seen);
    for (int i = 0; i < 8; ++i) {
      Light light;
      light.kind = LightKind::kPoint;
      light.shadow = true;
      light.position = away + 0.05 * random.direction();
      seen.lights.push_back(light);
    }
    std::vector<glm::vec3> points;
    for (int i = 0; i < 2 * kTilePixels; ++i) {
      const glm::dvec3 light = seen.lights[std::size_t(random.below(8))].position - away;
      const double distance = std::exp(random.between(std::log(1e-2), std::log(5e-2)));
      const double side = std::exp(random.between(std::log(5e-6), std::log(2e-5)));
      const double angle = std::exp(random.between(std::log(0.03), std::log(0.3)));
      const glm::dvec3 way = random.direction(), across = glm::cross(way, random.direction());
      const glm::dvec3 u = side * glm::normalize(way + angle * random.direction());
      const glm::dvec3 corner = light + distance * way, v = side * glm::normalize(across);
      addSheet(corner, u, v, sheets.covers);
      // Of one of its triangles, as it is rounded.
      const double a = random.between(0, 1), b = random.between(0, 1 - a);
      const glm::dvec3 p(glm::vec3(away + corner)), q(glm::vec3(away + corner + u)),
          r(glm::vec3(away + corner + u + v));
      const glm::dvec3 met = p + a * (q - p) + b * (r - p), from = away + light;
      points.push_back(glm::vec3(from + random.between(0.1, 0.9) * (met - from)));
    }
    const auto move = [&](GBuffer& gbuffer) {
      const std::size_t stride = gbuffer.pixels();
      for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::vec3 normal(random.direction());
        for (int c = 0; c < 3; ++c) {
          gbuffer.position[i + std::size_t(c) * stride] = points[i][c];
          gbuffer.normal[i + std::size_t(c) * stride] = normal[c];
        }
      }
    };
    Camera camera;
    camera.camera_to_world = glm::dmat4(1);
    seen.cameras = {camera};
    Scene scene = seen;
    scene.meshes.push_back(sheets.covers);
    scene.objects.push_back({1, glm::translate(glm::dmat4(1), away), -1});
    addVerdicts(scene, seen, camera, {2 * kTileSize, kTileSize}, lanes, Culling::kNone, verdicts, 0, move);
  }
  EXPECT_EQ(verdicts.wrong, 0u) << "of " << verdicts.pairs << " pairs";
  EXPECT_GT(verdicts.before, 10u);
}

// Rays go through edges and corners exactly, and are stopped by the triangles on both sides.
TEST(BeamShadows, AgreeWithBruteForceWhereRaysGoThroughEdges) {
  constexpr int kSize = 64;
  Random random(25);
  Sheets sheets;
  addSheet({-1, -1, -4}, {2, 0, 0}, {0, 2, 0}, sheets.seen);
  // The middle of a pixel, as far from the axis as the light sees it at half of the floor's depth.
  const auto middle = [&](double share) { return share * ((random.below(kSize) + 0.5) * 2 / kSize - 1); };
  for (int i = 0; i < 60; ++i) {
    const double share = i % 2 == 0 ? 1 : 0.5, side = share * 2 / kSize * (1 + random.below(12));
    addSheet({middle(share), middle(share), -2}, {side, 0, 0}, {0, side, 0}, sheets.covers);
  }
  Scene seen = sceneOf(sheets.seen);
  for (const LightKind kind : {LightKind::kDirectional, LightKind::kPoint}) {
    Light light;
    light.kind = kind;
    light.shadow = true;
    light.direction = {0, 0, -1};
    seen.lights.push_back(light);
  }
  Camera camera;
  camera.orthographic = true;
  seen.cameras = {camera};
  Scene scene = seen;
  scene.meshes.push_back(sheets.covers);
  scene.objects.push_back({1, glm::dmat4(1), -1});
  Verdicts verdicts;
  for (const int lanes : {1, 16})
    addVerdicts(scene, seen, camera, {kSize, kSize}, lanes, Culling::kNone, verdicts);
  EXPECT_EQ(verdicts.wrong, 0u) << "of " << verdicts.pairs << " pairs";
  EXPECT_EQ(verdicts.pairs, 2u * 2 * kSize * kSize);
  EXPECT_GT(verdicts.lit, verdicts.pairs / 10);
  EXPECT_LT(verdicts.lit, verdicts.pairs - verdicts.pairs / 10);
}

// The plane of a triangle that is much larger than the distance of the points is less certain than they are.
TEST(BeamShadows, AgreeWithBruteForceCloseUnderTrianglesMuchLargerThanTheScene) {
  Random random(24);
  Verdicts verdicts;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(random.between(-1, 1), random.between(-1, 1), 2));
    const glm::dvec3 u = glm::normalize(glm::cross(normal, random.direction())), v = glm::cross(normal, u);
    const glm::dvec3 middle(0, 0, -4);
    Sheets sheets;
    addSheet(middle - 10.0 * (u + v), 20.0 * u, 20.0 * v, sheets.seen);
    const double side = std::exp(random.between(std::log(1e2), std::log(1e4)));
    const double gap = random.between(0.05, 1.5) * double(POINT_ERROR) * side;
    // A little tilted: some points are nearer to it than it is certain, some aren't.
    const glm::dvec3 tilted = glm::normalize(v + 0.2 * gap * normal);
    addSheet(middle - side * (0.4 * u + 0.3 * tilted) + gap * normal, side * u, side * tilted, sheets.covers);
    sheets.cast = i % 2 == 0;
    addVerdictsOnSheets(sheets, lightsOverSheets(random), i % 4 < 2 ? 16 : 4, verdicts);
  }
  EXPECT_EQ(verdicts.wrong, 0u) << "of " << verdicts.pairs << " pairs";
  EXPECT_GT(verdicts.lit, verdicts.pairs / 10);
  EXPECT_LT(verdicts.lit, verdicts.pairs - verdicts.pairs / 10);
}

// Which side of a huge triangle a light is on that all but touches it, floats can't tell. All rays from there
// go through the triangle's middle, so a wrong side would lose it whole.
TEST(BeamShadows, AgreeWithBruteForceWhereALightAllButTouchesAHugeTriangle) {
  Random random(31);
  Verdicts verdicts;
  for (int i = 0; i < 24; ++i) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(random.between(-1, 1), random.between(-1, 1), 3));
    const glm::dvec3 u = glm::normalize(glm::cross(normal, random.direction())), v = glm::cross(normal, u);
    const double side = std::exp(random.between(std::log(1e2), std::log(1e4)));
    Sheets sheets;
    addSheet({-8, -8, -4}, {16, 0, 0}, {0, 16, 0}, sheets.seen);
    addSheet(-side * (random.between(0.3, 0.4) * u + random.between(0.5, 0.6) * v), side * u, side * v,
             sheets.covers);
    std::vector<Light> lights;
    for (int j = 0; j < 6; ++j) {
      Light light;
      light.kind = LightKind::kPoint;
      light.shadow = true;
      light.position = random.between(-2e-8, 2e-8) * side * normal + random.between(-1e-3, 1e-3) * u;
      lights.push_back(light);
    }
    addVerdictsOnSheets(sheets, lights, i % 2 == 0 ? 16 : 4, verdicts);
  }
  EXPECT_EQ(verdicts.wrong, 0u) << "of " << verdicts.pairs << " pairs";
  EXPECT_GT(verdicts.lit, verdicts.pairs / 10);
  EXPECT_LT(verdicts.lit, verdicts.pairs - verdicts.pairs / 10);
}

// Points lie metres apart along a sun's rays and millimetres across, so their u and v, differences of the
// former, round more than the small triangles near them. Each ray runs by an edge, nearer than it is known.
TEST(BeamShadows, AgreeWithBruteForceWherePointsLieAlongASunsRays) {
  Random random(32);
  Verdicts verdicts;
  for (const int lanes : {4, 16}) {
    const glm::dvec3 towards = glm::normalize(glm::dvec3(1, 0.9, 0.8) + 0.1 * random.direction());
    Sheets sheets;
    addSheet({-9, -9, -4}, {18, 0, 0}, {0, 18, 0}, sheets.seen);
    Scene seen = sceneOf(sheets.seen);
    Light sun;
    sun.kind = LightKind::kDirectional;
    sun.shadow = true;
    sun.direction = -towards;
    seen.lights = {sun};
    std::vector<glm::vec3> points;
    for (int i = 0; i < 4 * kTilePixels; ++i) {
      const glm::dvec3 corner = random.between(0, 0.1) * random.direction();
      const glm::dvec3 u = random.between(1e-3, 5e-3) * random.direction(),
                       v = random.between(1e-3, 5e-3) * random.direction();
      addSheet(corner, u, v, sheets.covers);
      // Every fourth is on the sun's side: the triangles are amid the points.
      points.push_back(glm::vec3(corner + random.between(0, 1) * u +
                                 (i % 4 == 0 ? 9.0 : random.between(-9, -1)) * towards));
    }
    const auto move = [&](GBuffer& gbuffer) {
      const std::size_t stride = gbuffer.pixels();
      for (std::size_t i = 0; i < points.size(); ++i)
        for (int c = 0; c < 3; ++c) {
          gbuffer.position[i + std::size_t(c) * stride] = points[i][c];
          gbuffer.normal[i + std::size_t(c) * stride] = float(towards[c]);
        }
    };
    Camera camera;
    camera.camera_to_world = glm::dmat4(1);
    seen.cameras = {camera};
    Scene scene = seen;
    scene.meshes.push_back(sheets.covers);
    scene.objects = {{1, glm::dmat4(1), -1}};
    addVerdicts(scene, seen, camera, {4 * kTileSize, kTileSize}, lanes, Culling::kNone, verdicts, 0, move);
  }
  EXPECT_EQ(verdicts.wrong, 0u) << "of " << verdicts.pairs << " pairs";
  EXPECT_GT(verdicts.lit, verdicts.pairs / 10);
  EXPECT_LT(verdicts.lit, verdicts.pairs - verdicts.pairs / 10);
}

/// Gives lights sizes: of spheres from a hundredth of a metre to more than the whole scene, and of suns from
/// that in the sky to the largest; one light in eight has none.
void giveSizes(Random& random, std::vector<Light>& lights, double scale) {
  for (Light& light : lights) {
    const double most = random.chance(0.15) ? 100 : 1;
    if (random.chance(0.12)) continue;
    light.radius = scale * std::exp(random.between(std::log(0.01), std::log(most)));
    light.half_angle = glm::radians(std::exp(random.between(std::log(0.25), std::log(45))));
  }
}

TEST(SoftExact, AgreeWithBruteForceInASoupOfTriangles) {
  Random random(24);
  Verdicts verdicts;
  int round = 0;
  for (const double scale : {1.0, 1.0, 1e-3, 1e16}) {
    Scene scene = soup(random, 300, scale);
    const std::vector<Light> lights = scene.lights;
    for (int more = 0; more < 2; ++more)
      scene.lights.insert(scene.lights.end(), lights.begin(), lights.end());
    giveSizes(random, scene.lights, scale);
    const int lanes = std::array{16, 8, 4, 1}[round];
    addVerdicts(scene, scene, scene.cameras[0], {36, 27}, lanes,
                round % 2 == 0 ? Culling::kTiles : Culling::kNone, verdicts, std::array{5, 16, 1, 33}[round]);
    EXPECT_EQ(verdicts.wrong, 0u) << "of " << verdicts.pairs << " pairs, round " << round;
    ++round;
  }
  EXPECT_GT(verdicts.pairs, 10000u);
  EXPECT_GT(verdicts.part, verdicts.pairs / 20);
  EXPECT_GT(verdicts.soft_others, verdicts.soft_rays / 10);
}

TEST(SoftExact, AgreeWithBruteForceOnSheetsThatNearlyTouch) {
  Random random(25);
  Verdicts verdicts;
  for (const int lanes : {8, 16}) {
    std::vector<Light> lights = lightsOverSheets(random);
    giveSizes(random, lights, 0.1);
    addVerdictsOnSheets(coveredSheets(random), lights, lanes, verdicts, 4);
  }
  EXPECT_EQ(verdicts.wrong, 0u) << "of " << verdicts.pairs << " pairs";
  EXPECT_GT(verdicts.part, verdicts.pairs / 50);
  EXPECT_GT(verdicts.soft_others, verdicts.soft_rays);
}

// A sphere as large as it is far, or larger, and a sun of a quarter of the sky, have no sides, and what hides
// a part of them may lie on any side of their middle.
TEST(SoftExact, AgreeWithBruteForceOfLightsAsLargeAsTheyAreFar) {
  Random random(33);
  Verdicts verdicts;
  for (int i = 0; i < 4; ++i) {
    Sheets sheets;
    addSheet({-6, -6, -8}, {12, 0, 0}, {0, 12, 0}, sheets.seen);
    std::vector<Light> lights;
    for (int j = 0; j < 6; ++j) {
      Light light;
      light.kind = j < 4 ? LightKind::kPoint : LightKind::kDirectional;
      light.shadow = true;
      light.position = glm::dvec3(random.between(-3, 3), random.between(-3, 3), random.between(-7, -5));
      light.radius = random.between(0.6, 1.6) * (light.position.z + 8);
      const auto sign = [&] { return random.chance(0.5) ? 1.0 : -1.0; };
      light.direction = glm::normalize(glm::dvec3(sign(), sign(), -1) + 0.1 * random.direction());
      light.half_angle = glm::radians(random.between(35, 45));
      lights.push_back(light);
    }
    // In heaps, so that each block of the tree is one and its box is small.
    for (int heap = 0; heap < 8; ++heap) {
      const glm::dvec3 middle(random.between(-4, 4), random.between(-4, 4), random.between(-7.5, -4));
      for (int cover = 0; cover < 8; ++cover)
        addSheet(middle + 0.2 * random.direction(), random.between(0.1, 0.6) * random.direction(),
                 random.between(0.1, 0.6) * random.direction(), sheets.covers);
    }
    addVerdictsOnSheets(sheets, lights, i % 2 == 0 ? 16 : 4, verdicts, 6);
  }
  EXPECT_EQ(verdicts.wrong, 0u) << "of " << verdicts.pairs << " pairs";
  EXPECT_GT(verdicts.part, verdicts.pairs / 10);
}

}  // namespace
}  // namespace luciole::test
