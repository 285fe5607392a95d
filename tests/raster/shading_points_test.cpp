#include "raster/shading_points.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <map>
#include <random>
#include <tuple>

#include "kernels/shared.h"
#include "raster/raster_scenes.hpp"

namespace luciole::test {
namespace {

/// The points of one pixel: the first, if it shows something, and the others.
struct PixelPoints {
  int first_samples = 0;
  std::vector<ShadingPoint> further;

  int count() const { return (first_samples > 0 ? 1 : 0) + int(further.size()); }
  int samples() const {
    int sum = first_samples;
    for (const ShadingPoint& point : further) sum += int(point.samples);
    return sum;
  }
};

struct Shared {
  SharedSamples samples;
  RasterCounts counts;
  GBuffer further;  ///< of samples.further

  std::vector<PixelPoints> byPixel() const {
    std::vector<PixelPoints> pixels(samples.samples.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i].first_samples = samples.samples[i];
    for (const std::vector<ShadingPoint>& list : samples.further)
      for (const ShadingPoint& point : list) pixels[point.pixel].further.push_back(point);
    return pixels;
  }
};

Shared share(const Scene& scene, const View& view, int samples, Shading shading = Shading::kPhong,
             PlaneSet planes = {}) {
  const std::vector<std::uint32_t> objects = allObjects(scene);
  const SampledView sampled =
      setupSamples(scene, objects, view, Margin::kPixel, samples, shading, planes, {});
  Shared shared;
  shared.samples = shareSamples(sampled, shared.counts);
  shared.further = gatherPoints(sampled, shared.samples.further, 0, shared.samples.further.size());
  return shared;
}

/// How many samples of each pixel see a surface, each drawn in a picture of its own.
std::vector<int> samplesCovered(const Scene& scene, View view, int samples) {
  std::vector<int> covered(std::size_t(view.crop_size.x) * view.crop_size.y);
  for (int sample = 0; sample < samples; ++sample) {
    view.sample = samplePoint(sample, samples);
    const GBuffer gbuffer = draw(scene, view);
    for (int y = 0; y < gbuffer.height; ++y)
      for (int x = 0; x < gbuffer.width; ++x)
        covered[std::size_t(y) * gbuffer.width + x] += isCovered(gbuffer, x, y);
  }
  return covered;
}

/// Triangles of all sizes at random.
Scene randomScene(int triangles, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  const auto vector = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> corners;
  for (int i = 0; i < triangles; ++i) {
    const glm::vec3 center = 5.0f * vector() + glm::vec3(0, 0, -7);
    const float radius = i % 10 == 0 ? 9.0f : 0.3f;
    const std::uint32_t first = std::uint32_t(positions.size());
    for (int k = 0; k < 3; ++k) positions.push_back(center + radius * vector());
    corners.push_back({first, first + 1, first + 2});
  }
  return meshScene(positions, corners);
}

TEST(SamplePattern, PlacesAreThoseOfWholeSamples) {
  for (const int count : {2, 3, 4, 8, 16, 17, 64, 1000}) {
    const SamplePattern pattern = samplePattern(count);
    ASSERT_EQ(pattern.x.size(), std::size_t(pattern.stride));
    EXPECT_GE(pattern.stride, count);
    EXPECT_EQ(16 % std::min(pattern.stride, 16), 0);
    EXPECT_EQ(pattern.stride % std::min(pattern.stride, 16), 0);
    for (int i = 0; i < pattern.stride; ++i) {
      const glm::dvec2 place = pattern.origin + glm::dvec2(pattern.x[i], pattern.y[i]) / 256.0;
      const glm::dvec2 wanted = samplePoint(std::min(i, count - 1), count);
      // Half a unit of rounding; the last unit before 1 is a whole one away from it.
      EXPECT_LE(std::abs(place.x - wanted.x), 1.0 / 256) << count << ' ' << i;
      EXPECT_LE(std::abs(place.y - wanted.y), 1.0 / 256) << count << ' ' << i;
      EXPECT_GE(std::min(pattern.x[i], pattern.y[i]), 0);
      EXPECT_LE(pattern.x[i], pattern.reach.x);
      EXPECT_LE(pattern.y[i], pattern.reach.y);
      EXPECT_LT(place.x, 1.0);
      EXPECT_LT(place.y, 1.0);
    }
  }
}

TEST(ShadingPoints, CoverageIsThatOfWholeSamplesExactly) {
  // Points of powers of two up to 64 lie at multiples of 2/256 pixel. Then snapping moves all corners alike.
  const Scene scene = randomScene(300, 3);
  const View view = cameraView(frontCamera(), {75, 67});
  for (const int samples : {2, 4, 8, 16, 32, 64}) {
    const std::vector<int> wanted = samplesCovered(scene, view, samples);
    const std::vector<PixelPoints> pixels = share(scene, view, samples).byPixel();
    for (std::size_t i = 0; i < pixels.size(); ++i)
      ASSERT_EQ(pixels[i].samples(), wanted[i]) << samples << ' ' << i;
  }
}

TEST(ShadingPoints, AHalfCoveredPixelWeighsHalf) {
  // The right half plane from x = 0.25 pixel on, of a picture whose pixels are units: the pixel from 0 to 1
  // is covered by three quarters.
  const Scene scene =
      meshScene({{0.25f, -50, -1}, {50, -50, -1}, {50, 50, -1}, {0.25f, 50, -1}}, {{0, 1, 2}, {0, 2, 3}});
  for (const int samples : {4, 16, 64}) {
    const std::vector<PixelPoints> pixels = share(scene, pixelView({8, 8}), samples).byPixel();
    for (int y = 0; y < 8; ++y) {
      EXPECT_EQ(pixels[y * 8 + 3].samples(), 0);
      EXPECT_EQ(pixels[y * 8 + 4].samples(), samples * 3 / 4);
      EXPECT_EQ(pixels[y * 8 + 5].samples(), samples);
    }
  }
}

TEST(ShadingPoints, APlaneOfManyTrianglesIsShadedOnceAPixel) {
  constexpr int kCells = 30;  // of 0.77 pixels
  std::vector<glm::vec3> positions;
  for (int y = 0; y <= kCells; ++y)
    for (int x = 0; x <= kCells; ++x)
      positions.push_back({0.77f * (x - 0.5f * kCells), 0.77f * (y - 0.5f * kCells), -1.0f});
  const Scene scene = meshScene(positions, gridTriangles(kCells));
  for (const Shading shading : {Shading::kPhong, Shading::kFlat}) {
    const Shared shared = share(scene, pixelView({20, 20}), 16, shading);
    for (const PixelPoints& pixel : shared.byPixel()) {
      ASSERT_EQ(pixel.count(), 1);
      ASSERT_EQ(pixel.samples(), 16);
    }
  }
}

/// A ball of radius 1 at the origin, in rings; its normals point outwards.
Scene ballScene(int rings) {
  Scene scene = meshScene({}, {});
  Mesh& mesh = scene.meshes[0];
  const int columns = 2 * rings;
  for (int row = 0; row <= rings; ++row)
    for (int column = 0; column <= columns; ++column) {
      const double polar = M_PI * row / rings, around = 2 * M_PI * column / columns;
      mesh.positions.push_back(
          {std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around)});
    }
  mesh.normals = mesh.positions;
  for (int row = 0; row < rings; ++row)
    for (int column = 0; column < columns; ++column) {
      const std::uint32_t a = row * (columns + 1) + column, b = a + columns + 1;
      mesh.triangles.push_back({a, a + 1, b});
      mesh.triangles.push_back({a + 1, b + 1, b});
    }
  mesh.triangle_materials.assign(mesh.triangles.size(), 0);
  scene.materials[0].double_sided = false;
  return scene;
}

TEST(ShadingPoints, AFineBallIsShadedOnceAPixel) {
  const Scene scene = ballScene(200);
  Camera camera = frontCamera();
  camera.camera_to_world[3] = {0, 0, 4, 1};
  camera.fov_y = 0.55;  // 2 · atan(1 / 4) = 0.49
  const glm::ivec2 size(240, 240);
  const std::vector<PixelPoints> pixels = share(scene, cameraView(camera, size), 16).byPixel();
  int inside = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      // Away from the silhouette, where a pixel shows so long a piece of the ball that its normals differ.
      const glm::dvec2 from_middle(x + 0.5 - 120, y + 0.5 - 120);
      if (glm::length(from_middle) > 80) continue;
      const PixelPoints& pixel = pixels[y * size.x + x];
      ASSERT_EQ(pixel.count(), 1) << x << ',' << y;
      ASSERT_EQ(pixel.samples(), 16);
      ++inside;
    }
  EXPECT_GT(inside, 20000);
}

TEST(ShadingPoints, FacetsAndMaterialsAndObjectsStayApart) {
  // A roof of two planes that meet at x = 0.5 in the middle of a column of pixels, at 90 degrees.
  const auto roof = [] {
    return meshScene(
        {{-9, -9, -10}, {0.5f, -9, -1}, {0.5f, 9, -1}, {-9, 9, -10}, {9.5f, -9, -10}, {9.5f, 9, -10}},
        {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}});
  };
  const auto pointsAtRidge = [](const Scene& scene, Shading shading) {
    const std::vector<PixelPoints> pixels = share(scene, pixelView({8, 8}), 16, shading).byPixel();
    return pixels[4 * 8 + 4].count();
  };
  EXPECT_EQ(pointsAtRidge(roof(), Shading::kFlat), 2);
  // With normals that go on over the ridge it is one surface.
  EXPECT_EQ(pointsAtRidge(roof(), Shading::kPhong), 1);
  Scene two_materials = roof();
  two_materials.materials.push_back(two_materials.materials[0]);
  two_materials.meshes[0].triangle_materials = {0, 0, 1, 1};
  EXPECT_EQ(pointsAtRidge(two_materials, Shading::kPhong), 2);
}

TEST(ShadingPoints, APointLiesAtTheMeanOfItsSamples) {
  const Scene scene = rectangleScene(100, 100, -1);
  for (const int samples : {2, 16, 100}) {
    const Shared shared = share(scene, pixelView({8, 8}), samples);
    glm::dvec2 mean(0);
    for (int i = 0; i < samples; ++i) mean += samplePoint(i, samples) / double(samples);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        const glm::vec3 at = positionAt(shared.samples.gbuffer, x, y);
        // Samples are rounded to 1/256 pixel, half a unit each; places to floats of at most 4.
        EXPECT_NEAR(at.x, x - 4 + mean.x, 0.5 / 256 + 4 * kFloatRounding);
        EXPECT_NEAR(at.y, 4 - y - mean.y, 0.5 / 256 + 4 * kFloatRounding);
      }
  }
}

TEST(ShadingPoints, APointOnAMaskedTriangleLiesWhereItHasNoHole) {
  // A rectangle that is the picture's only pixel, with a hole from a quarter to three quarters of its width:
  // there opacity, interpolated between the middles of four texels, is below a half.
  Scene scene = rectangleScene(0.5f, 0.5f, -1);
  Texture texture;
  texture.alpha_varies = true;
  MipLevel level{4, 1, {}};
  for (const std::uint16_t alpha : {65535, 0, 0, 65535})
    for (const std::uint16_t value :
         {std::uint16_t(65535), std::uint16_t(65535), std::uint16_t(65535), alpha})
      level.texels.push_back(value);
  texture.levels.push_back(level);
  scene.textures.push_back(texture);
  scene.materials[0].diffuse_map = {0, Wrap::kClampToEdge, Wrap::kClampToEdge};
  scene.materials[0].alpha_cutoff = 0.5f;
  const Shared shared = share(scene, pixelView({1, 1}), 16);
  const PixelPoints pixel = shared.byPixel()[0];
  EXPECT_EQ(pixel.count(), 1);
  EXPECT_EQ(pixel.samples(), 8);
  EXPECT_GT(std::abs(positionAt(shared.samples.gbuffer, 0, 0).x), 0.25f);
}

TEST(ShadingPoints, TrianglesAreCountedAsWithWholeSamples) {
  const Scene scene = randomScene(300, 5);
  View view = cameraView(frontCamera(), {128, 64});  // whole bins
  RasterCounts wanted;
  for (int sample = 0; sample < 16; ++sample) {
    view.sample = samplePoint(sample, 16);
    draw(scene, view, Shading::kPhong, {}, &wanted);
  }
  const RasterCounts counts = share(scene, view, 16).counts;
  EXPECT_EQ(counts.submitted, wanted.submitted);
  EXPECT_EQ(counts.back_facing, wanted.back_facing);
  EXPECT_EQ(counts.outside, wanted.outside);
  EXPECT_GT(counts.outside, 0u);
}

TEST(ShadingPoints, EverySampleOfAChosenPixelIsAPointWhereItIsAsked) {
  const Scene scene = randomScene(300, 11);
  const View view = cameraView(frontCamera(), {75, 67});
  const std::vector<std::uint32_t> objects = allObjects(scene);
  const SampledView sampled = setupSamples(scene, objects, view, Margin::kPixel, 16, Shading::kPhong, {}, {});
  const std::vector<int> covered = samplesCovered(scene, view, 16);
  std::vector<std::uint8_t> chosen(covered.size());
  for (std::size_t i = 0; i < chosen.size(); i += 7) chosen[i] = 1;
  RasterCounts counts;
  const SharedSamples shared = shareSamples(sampled, counts);
  const PointLists points = everySample(sampled, shared.labels, chosen, 0, sampled.bins.size());
  std::size_t in_bins = 0;
  for (const std::size_t count : chosenInBins(sampled, chosen)) in_bins += count;
  EXPECT_EQ(in_bins, std::size_t(std::count(chosen.begin(), chosen.end(), 1)));
  std::vector<int> found(covered.size());
  for (const std::vector<ShadingPoint>& list : points)
    for (const ShadingPoint& point : list) {
      found[point.pixel] += int(point.samples);
      EXPECT_EQ(point.samples, 1u);
    }
  for (std::size_t i = 0; i < chosen.size(); ++i) ASSERT_EQ(found[i], chosen[i] ? covered[i] : 0) << i;
}

/// All that is known of each pixel's points, from the whole picture's numbers.
using Facts = std::map<std::tuple<int, int, std::uint32_t>, std::vector<float>>;

Facts factsOf(const Scene& scene, const View& view, int samples, Margin margin = Margin::kPixel) {
  const PlaneSet all{.specular = true,
                     .ambient = true,
                     .emission = true,
                     .geometric_normal = true,
                     .lift = true,
                     .tangent = true,
                     .uv = true,
                     .object = true,
                     .material = true};
  const std::vector<std::uint32_t> objects = allObjects(scene);
  const SampledView sampled = setupSamples(scene, objects, view, margin, samples, Shading::kPhong, all, {});
  RasterCounts counts;
  const SharedSamples shared = shareSamples(sampled, counts);
  const PointLists& points = shared.further;
  const GBuffer further = gatherPoints(sampled, points, 0, points.size());
  Facts facts;
  const auto valuesAt = [](const GBuffer& gbuffer, std::size_t place) {
    std::vector<float> values;
    for (const Plane* group : {&gbuffer.position, &gbuffer.normal, &gbuffer.diffuse, &gbuffer.specular,
                               &gbuffer.ambient, &gbuffer.emission, &gbuffer.lift, &gbuffer.uv})
      for (std::size_t i = place; i < group->size(); i += gbuffer.pixels()) values.push_back((*group)[i]);
    for (const std::uint32_t packed : {gbuffer.geometric_normal[place], gbuffer.tangent[place],
                                       gbuffer.object[place], gbuffer.material[place]}) {
      values.push_back(float(packed & 0xffff));
      values.push_back(float(packed >> 16));
    }
    return values;
  };
  // A margin is drawn, too.
  const glm::ivec2 drawn = sampled.view.crop_origin;
  const int width = sampled.view.crop_size.x;
  for (int y = view.crop_origin.y; y < view.crop_origin.y + view.crop_size.y; ++y)
    for (int x = view.crop_origin.x; x < view.crop_origin.x + view.crop_size.x; ++x) {
      std::vector<float> values = valuesAt(shared.gbuffer, shared.gbuffer.index(x - drawn.x, y - drawn.y));
      const std::size_t number = std::size_t(y - drawn.y) * width + x - drawn.x;
      values.push_back(float(shared.samples[number]));
      values.push_back(float(shared.objects[number]));
      facts[{x, y, kNoTriangle}] = values;
    }
  std::size_t tiles = 0;
  for (std::size_t list = 0; list < points.size(); tiles += tilesOf(points[list++]))
    for (std::size_t i = 0; i < points[list].size(); ++i) {
      const ShadingPoint& point = points[list][i];
      std::vector<float> values = valuesAt(further, tiles * kTilePixels + i);
      values.push_back(float(point.samples));
      facts[{drawn.x + int(point.pixel) % width, drawn.y + int(point.pixel) / width, point.triangle}] =
          values;
    }
  return facts;
}

TEST(ShadingPoints, ACropHasThePointsOfTheWholeBitForBit) {
  const Scene scene = randomScene(600, 7);
  const View view = cameraView(frontCamera(), {150, 137});
  for (const int samples : {3, 16, 40}) {
    const Facts whole = factsOf(scene, view, samples);
    for (const glm::ivec4& crop :
         {glm::ivec4(0, 0, 150, 137), {17, 23, 100, 90}, {63, 1, 2, 136}, {149, 136, 1, 1}}) {
      View part = view;
      part.crop_origin = {crop.x, crop.y};
      part.crop_size = {crop.z, crop.w};
      Facts wanted;
      for (const auto& [where, values] : whole) {
        const auto& [x, y, triangle] = where;
        if (x >= crop.x && y >= crop.y && x < crop.x + crop.z && y < crop.y + crop.w) wanted[where] = values;
      }
      for (const Margin margin : {Margin::kPixel, Margin::kTiles})
        EXPECT_TRUE(factsOf(scene, part, samples, margin) == wanted)
            << samples << " samples, crop at " << crop.x << ", margin " << int(margin);
    }
  }
}

// Pixels are lit in groups of those of a tile.
TEST(ShadingPoints, MarginsOfTilesAreThePicturesTilesAroundThePixels) {
  const Scene scene = randomScene(10, 7);
  const std::vector<std::uint32_t> objects = allObjects(scene);
  View view = cameraView(frontCamera(), {150, 137});
  const auto drawn = [&](const glm::ivec2& origin, const glm::ivec2& size) {
    view.crop_origin = origin;
    view.crop_size = size;
    const View& of = setupSamples(scene, objects, view, Margin::kTiles, 4, Shading::kPhong, {}, {}).view;
    return glm::ivec4(of.crop_origin, of.crop_origin + of.crop_size);
  };
  EXPECT_EQ(drawn({0, 0}, {150, 137}), glm::ivec4(0, 0, 150, 137));
  EXPECT_EQ(drawn({17, 33}, {14, 14}), glm::ivec4(16, 32, 32, 48));
  EXPECT_EQ(drawn({16, 32}, {16, 16}), glm::ivec4(0, 16, 48, 64));
  EXPECT_EQ(drawn({149, 136}, {1, 1}), glm::ivec4(144, 128, 150, 137));
}

TEST(ShadingPoints, TheNumberOfThreadsChangesNothing) {
  const Scene scene = randomScene(600, 9);
  const View view = cameraView(frontCamera(), {150, 137});
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return factsOf(scene, view, 16);
  };
  EXPECT_TRUE(with_threads(1) == with_threads(4));
}

}  // namespace
}  // namespace luciole::test
