#include "shadow/exact/pair_rays.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "kernels/probe.hpp"
#include "long_run.hpp"
#include "raster/opacity.hpp"
#include "shade/features.hpp"
#include "shadow/exact/exact_ray.hpp"
#include "shadow/exact/loose_triangles.hpp"

// Rays to samples of lights say on the device what countUnblocked() says.
namespace luciole::test {
namespace {

constexpr std::size_t kTiles = 2;

/// Points, and lights for all of them, all pairs unsure.
struct PairStage {
  std::shared_ptr<const TriangleTree> tree;
  std::shared_ptr<const HoleMasks> masks;
  Scene scene;
  GBuffer gbuffer;
  LightSet lights;

  PairStage(Scene made, bool holes, const std::vector<glm::vec3>& points) : scene(std::move(made)) {
    tree = std::make_shared<const TriangleTree>(buildTriangleTree(scene, glm::dvec3(0)));
    if (holes) masks = std::make_shared<const HoleMasks>(makeHoleMasks(scene, *tree));
    gbuffer.tiles_x = int(kTiles);
    gbuffer.tiles_y = 1;
    gbuffer.position.resize(3 * gbuffer.pixels());
    gbuffer.normal.resize(3 * gbuffer.pixels());
    for (std::size_t i = 0; i < gbuffer.pixels(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        gbuffer.position[i + std::size_t(axis) * gbuffer.pixels()] = points[i % points.size()][axis];
  }

  /// place: in metres; w = 0 for a direction. size: in metres, or how far directions are off.
  void addLight(const glm::vec3& place, float w, float size) {
    BeamLight light = lightAt(w == 0 ? glm::normalize(place) : tree->scale * place, w);
    light.size = w == 0 ? size : tree->scale * size;
    light.number = uint(7 * lights.beam_lights.size());
    lights.beam_lights.push_back(light);
  }

  /// Lifts the starts of rays above their points, along normals of length 1.
  void liftPoints(RandomVectors& vector) {
    gbuffer.lift.resize(gbuffer.pixels());
    for (std::size_t i = 0; i < gbuffer.pixels(); ++i) {
      gbuffer.lift[i] = 0.1f * std::abs(vector().x);
      const glm::vec3 normal = glm::normalize(vector());
      for (int axis = 0; axis < 3; ++axis)
        gbuffer.normal[i + std::size_t(axis) * gbuffer.pixels()] = normal[axis];
    }
  }

  glm::vec3 start(std::size_t pixel) const {
    glm::vec3 start;
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t place = pixel + std::size_t(axis) * gbuffer.pixels();
      start[axis] = gbuffer.lift.empty()
                        ? gbuffer.position[place]
                        : std::fma(gbuffer.lift[pixel], gbuffer.normal[place], gbuffer.position[place]);
    }
    return tree->scale * start;
  }
};

/// The shares of all pairs, tile by tile, of each its lights, of each its pixels.
std::vector<float> sharesOnDevice(OpenedDevice& device, const PairStage& stage, int samples,
                                  const std::string& more_defines) {
  BeamScene beams;
  prepareBeams(device, {}, stage.tree, stage.masks, samples, beams);
  FeatureSet features;
  features.set(Feature::kExact, true);
  features.set(Feature::kSoftExact, true);
  features.set(Feature::kHoles, stage.masks != nullptr);
  features.set(Feature::kLift, !stage.gbuffer.lift.empty());
  const std::string defines = featureDefines(features) + more_defines;
  const std::size_t lights = stage.lights.beam_lights.size();
  const LightLists no_lists;
  const BeamArguments arguments{.plane_stride = stage.gbuffer.pixels(),
                                .position = borrowed(device, stage.gbuffer.position),
                                .normal = borrowed(device, stage.gbuffer.normal),
                                .lift = borrowed(device, stage.gbuffer.lift),
                                .lists = no_lists,
                                .lights = borrowed(device, stage.lights.beam_lights),
                                .beams = beams,
                                .holes = stage.masks != nullptr,
                                .soft = true};
  PairShadows shadows;
  shadows.lit = makeBuffer<uint>(device, kTiles * lights * kPairWords);
  shadows.unsure = makeBuffer<uint>(device, kTiles * lights * kPairWords);
  fill(device, shadows.unsure, 0xffffffff);
  const uint pairs = uint(lights) * kTilePixels;
  shadows.counts = makeBuffer<TilePairs>(device, kTiles);
  fill(device, shadows.counts, {pairs, pairs, 0, 0});
  tracePairs({device, defines, arguments, stage.scene, stage.lights, stage.gbuffer}, shadows);
  std::vector<float> shares(kTiles * pairs);
  std::vector<uint> first(shadows.unsure.count);
  download(device, shadows.shares, shares);
  download(device, shadows.first_share, first);
  for (std::size_t word = 0; word < first.size(); ++word) EXPECT_EQ(first[word], 32 * word);
  return shares;
}

std::vector<float> sharesByHost(const PairStage& stage, int samples) {
  const std::vector<LightSample> all = makeLightSamples();
  const std::vector<PlacedObject> objects = placeObjects(stage.scene, allObjects(stage.scene), glm::dmat4(1));
  const HoleTest is_hole = [&](std::uint32_t triangle, const glm::dvec3& weights) {
    return isHoleAt(stage.scene, objectOfTriangle(objects, triangle), triangle, weights);
  };
  std::vector<float> shares;
  std::vector<float4> places(static_cast<std::size_t>(samples));
  for (std::size_t tile = 0; tile < kTiles; ++tile)
    for (const BeamLight& light : stage.lights.beam_lights)
      for (std::size_t pixel = 0; pixel < kTilePixels; ++pixel) {
        const glm::vec3 start = stage.start(tile * kTilePixels + pixel);
        std::span<float4> to = places;
        std::optional<std::size_t> likely;
        bool outside = true;
        if (light.size > 0)
          outside = placeSamples(light, start, patternOf(all, samples, start, light.number), to);
        else
          to = to.first(1), to[0] = light.place;
        shares.push_back(outside ? float(countUnblocked(*stage.tree, start, to, is_hole, likely)) /
                                       float(to.size())
                                 : 1.0f);
      }
  return shares;
}

/// Every number of lanes, and devices that leave something to us, give the host's shares. Returns how many
/// of them are neither 0 nor 1.
std::size_t expectTheHostsShares(const PairStage& stage, int samples) {
  const std::vector<float> truth = sharesByHost(stage, samples);
  const auto expectSame = [&](int lanes, const std::string& defines) {
    const std::vector<float> shares = sharesOnDevice(deviceWithLanes(lanes), stage, samples, defines);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) wrong += shares[i] != truth[i];
    EXPECT_EQ(wrong, 0u) << "of " << truth.size() << " pairs, " << lanes << " lanes" << defines;
  };
  for (const int lanes : widths()) expectSame(lanes, "");
  for (const char* defines : {" -DNO_DOUBLES", " -DOWN_QUOTIENTS", " -DSTANDARD_ONLY"})
    expectSame(8, defines);
  return std::size_t(
      std::count_if(truth.begin(), truth.end(), [](float share) { return share > 0 && share < 1; }));
}

/// Lights of each kind and of many sizes: near and far, around points, and without a size.
void addLights(RandomVectors& vector, PairStage& stage) {
  for (int i = 0; i < 9; ++i) {
    const float size = std::exp(std::log(1e-4f) + float(i) / 8 * std::log(1e4f));
    stage.addLight(2.0f * vector(), 1, size);
    stage.addLight(vector(), 0, size);
  }
  stage.addLight(1e6f * vector(), 1, 1e5f);
  stage.addLight({0, 1, 0}, 0, 0.3f);
  stage.addLight({0, 0, -1}, 0, 1.2f);
  stage.addLight(vector(), 1, 0);
}

TEST(PairRays, AreTheHostsAmidTriangles) {
  RandomVectors vector(3);
  const std::size_t point_count = longRun() ? 256 : 96;
  std::size_t part = 0;
  int round = 0;
  for (const auto& [count, side] : {std::pair(40, 0.8f), std::pair(700, 0.2f), std::pair(3000, 0.02f)}) {
    const std::vector<Triangle> triangles = randomTriangles(count, side, unsigned(count));
    std::vector<glm::vec3> points;
    for (std::size_t i = 0; i < point_count; ++i)
      points.push_back(i % 4 == 0 ? triangles[i % triangles.size()][i % 3] : 1.3f * vector());
    PairStage stage(looseScene(triangles), false, points);
    addLights(vector, stage);
    if (round == 1) stage.liftPoints(vector);
    part += expectTheHostsShares(stage, std::array{16, 5, 33}[std::size_t(round++)]);
  }
  EXPECT_GT(part, 5000 * point_count / 256);
}

// Where lights and points are on the triangles' grid rays meet corners and edges, and run in planes.
TEST(PairRays, AreTheHostsOnAGridOfIntegers) {
  std::mt19937 random(4);
  std::uniform_int_distribution<int> place(-4, 4);
  const auto vector = [&] { return glm::vec3(place(random), place(random), place(random)); };
  std::vector<Triangle> triangles;
  for (int i = 0; i < 100; ++i) triangles.push_back({vector(), vector(), vector()});
  std::vector<glm::vec3> points;
  for (int i = 0; i < 512; ++i) points.push_back(vector());
  PairStage stage(looseScene(triangles), false, points);
  // So small that all samples round to the light's own place, or nearly all.
  for (int i = 0; i < 12; ++i) stage.addLight(vector(), 1, i % 3 == 0 ? 0.5f : 1e-8f);
  for (const glm::vec3& direction : {glm::vec3(0, 1, 0), glm::vec3(0, 0, -1), glm::vec3(1, 1, 0)})
    stage.addLight(direction, 0, 1e-9f);
  for (const int samples : {1, 16}) expectTheHostsShares(stage, samples);
}

// Of few triangles rays through a corner touch its box at an edge, and the boxes of its block: near the
// origin, and where coordinates are large beside the boxes.
TEST(PairRays, AreTheHostsThroughCornersOfFewTriangles) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> place(-4, 4);
  const auto vector = [&] { return glm::vec3(place(random), place(random), place(random)); };
  for (const glm::vec3& centre : {glm::vec3(0), glm::vec3(3001, -2003, 997)})
    for (const int count : {1, 2, 3, 5, 20, 80}) {
      std::vector<Triangle> triangles;
      for (int i = 0; i < count; ++i) {
        const glm::vec3 middle = centre + 2.0f * vector();
        const auto near = [&] { return middle + glm::trunc(vector() / 2.0f); };
        triangles.push_back({near(), near(), near()});
      }
      std::vector<glm::vec3> lights, points;
      for (int i = 0; i < 16; ++i) lights.push_back(vector() + 2.0f * vector());
      for (std::size_t i = 0; i < 512; ++i) {
        const glm::vec3 corner = triangles[i % triangles.size()][i / 16 % 3];
        points.push_back(corner + float(1 + i % 5) * (corner - centre - lights[i % 16]));
      }
      PairStage stage(looseScene(triangles), false, points);
      for (const glm::vec3& light : lights) {
        stage.addLight(centre + light, 1, 1e-8f);
        if (light != glm::vec3(0)) stage.addLight(light, 0, 1e-9f);
      }
      expectTheHostsShares(stage, 1);
    }
}

// A start that lies in a triangle's plane but for rounding isn't blocked by it. Of triangles that are large
// beside the start's coordinates the plane's own rounding decides that.
TEST(PairRays, AreTheHostsInPlanesOfLargeTriangles) {
  RandomVectors vector(8);
  for (int i = 0; i < 20; ++i) {
    const glm::vec3 a = 1e3f * vector(), b = 1e3f * vector(), middle = 1e-2f * vector();
    std::vector<glm::vec3> points;
    for (int k = 0; k < 512; ++k) points.push_back(middle + float(k) * 1e-7f * vector());
    PairStage stage(looseScene({{a, b, 3.0f * middle - a - b}}), false, points);
    for (int k = 0; k < 8; ++k) stage.addLight(30.0f * vector(), 1, 0.01f);
    expectTheHostsShares(stage, 4);
  }
}

TEST(PairRays, AreTheHostsFarAwayAndOfManySamples) {
  RandomVectors vector(5);
  const glm::vec3 far(3e3f, -2e3f, 1e3f);
  std::vector<Triangle> triangles = randomTriangles(300, 0.4f, 5);
  std::vector<glm::vec3> points;
  for (Triangle& triangle : triangles)
    for (glm::vec3& corner : triangle) corner += far;
  for (int i = 0; i < 256; ++i) points.push_back(far + 1.3f * vector());
  PairStage stage(looseScene(triangles), false, points);
  for (int i = 0; i < 4; ++i) stage.addLight(far + 2.0f * vector(), 1, 0.5f);
  EXPECT_GT(expectTheHostsShares(stage, 300), 500u);
}

// Of triangles whose opacity is their cutoff nothing but the textures can tell.
TEST(PairRays, AreTheHostsBehindHoles) {
  RandomVectors vector(6);
  const std::vector<Triangle> triangles = randomTriangles(300, 0.4f, 6);
  Scene scene = looseScene(triangles, 1);
  MipLevel level{8, 8, {}};
  for (int i = 0; i < 8 * 8; ++i)
    level.texels.insert(level.texels.end(), {65535, 65535, 65535, std::uint16_t(vector.random() & 0xffff)});
  Texture texture;
  texture.levels = {level};
  texture.alpha_varies = true;
  scene.textures = {texture};
  scene.materials[1].diffuse_map.texture = 0;
  scene.materials.push_back(scene.materials[1]);
  scene.materials[2].diffuse_map = {};
  scene.materials[2].alpha = scene.materials[2].alpha_cutoff;
  Mesh& mesh = scene.meshes[0];
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.uvs.push_back(glm::vec2(2.0f * vector()));
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 4) mesh.triangle_materials[i] = i % 8 == 0 ? 0 : 2;
  std::vector<glm::vec3> points;
  for (int i = 0; i < 512; ++i) points.push_back(1.3f * vector());
  PairStage stage(scene, true, points);
  addLights(vector, stage);
  EXPECT_GT(expectTheHostsShares(stage, 7), 2000u);
}

}  // namespace
}  // namespace luciole::test
