// Blended surfaces, which are dithered by the samples of a pixel.
#include "raster/blend.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "raster/raster_scenes.hpp"
#include "raster/shading_points.hpp"

namespace luciole::test {
namespace {

constexpr glm::ivec2 kSize{64, 48};
constexpr double kPixels = double(kSize.x) * kSize.y;

/// Quads that fill the picture, of these opacities, each behind the one before.
Scene layers(const std::vector<float>& opacities) {
  Scene scene = meshScene({{-40, -40, 0}, {40, -40, 0}, {40, 40, 0}, {-40, 40, 0}}, {{0, 1, 2}, {2, 3, 0}});
  scene.objects.clear();
  for (std::size_t i = 0; i < opacities.size(); ++i) {
    scene.materials.push_back(doubleSided());
    scene.materials.back().alpha = opacities[i];
    scene.materials.back().blended = true;
    Object object{.mesh = 0, .material = int(i) + 1};
    object.object_to_world[3].z = -5.0 - double(i);
    scene.objects.push_back(object);
  }
  return scene;
}

/// What the samples of all pixels see, pixel by pixel: the object's number, or −1.
std::vector<int> seen(const Scene& scene, const View& view, int samples,
                      const std::vector<std::uint32_t>& objects) {
  const SampledView sampled =
      setupSamples(scene, objects, view, Margin::kPixel, samples, Shading::kPhong, {}, {});
  std::vector<int> result(std::size_t(view.crop_size.x) * view.crop_size.y * samples, -1);
  visitSamples(sampled, [&](const glm::ivec2& at, std::span<const std::uint32_t> triangles) {
    const glm::ivec2 in_crop = at - view.crop_origin;
    for (int i = 0; i < samples; ++i)
      if (triangles[i] != kNoTriangle)
        result[(std::size_t(in_crop.y) * view.crop_size.x + in_crop.x) * samples + i] =
            int(objectOfTriangle(sampled.objects, triangles[i]).number);
  });
  return result;
}

std::vector<int> seen(const Scene& scene, int samples) {
  return seen(scene, cameraView(frontCamera(), kSize), samples, allObjects(scene));
}

int countOf(const std::vector<int>& values, int value) {
  return int(std::count(values.begin(), values.end(), value));
}

// Each pixel keeps as many samples as its opacity says, rounded up or down; and which of the two is as likely
// as makes the mean right. A pixel's number has a deviation of ½ at most, and the mean of all a deviation of
// 1/√pixels of that: 5 of them are met once in two million.
TEST(Blended, EachPixelKeepsAsManySamplesAsItsOpacitySays) {
  for (const float opacity : {0.3f, 0.5f, 0.9f, 0.01f})
    for (const int samples : {1, 2, 3, 4, 16, 64, 100}) {
      const std::vector<int> all = seen(layers({opacity}), samples);
      for (std::size_t first = 0; first < all.size(); first += std::size_t(samples)) {
        const auto kept = std::count(all.begin() + long(first), all.begin() + long(first) + samples, 0);
        ASSERT_LT(std::abs(double(kept) - double(opacity) * samples), 1) << opacity << " " << samples;
      }
      EXPECT_NEAR(countOf(all, 0) / kPixels, double(opacity) * samples, 5 * 0.5 / std::sqrt(kPixels))
          << opacity << " " << samples;
    }
}

// Of layers behind each other each covers its share of what those before it leave. The samples that show one
// of them are drawn without repetition, of a variance below ¼ · samples a pixel.
TEST(Blended, LayersCoverEachOtherAsTheirOpacitiesSay) {
  const std::vector<float> opacities{0.3f, 0.6f, 0.5f};
  for (const int samples : {1, 2, 4, 16, 25}) {
    const std::vector<int> all = seen(layers(opacities), samples);
    double left = 1;
    for (int layer = 0; layer < 3; ++layer) {
      const double share = left * double(opacities[std::size_t(layer)]);
      EXPECT_NEAR(countOf(all, layer) / kPixels / samples, share, 5 * 0.5 / std::sqrt(kPixels * samples))
          << samples << " " << layer;
      left -= share;
    }
    EXPECT_NEAR(countOf(all, -1) / kPixels / samples, left, 5 * 0.5 / std::sqrt(kPixels * samples))
        << samples;
  }
}

// The same of one object's triangles, and of both sides of a mesh: a pixel converges, not only the mean of
// many.
TEST(Blended, EachPixelConvergesBehindTheLayersOfOneMesh) {
  Scene scene =
      meshScene({{-40, -40, -5}, {40, -40, -5}, {0, 40, -5}, {-40, -40, -6}, {40, -40, -6}, {0, 40, -6}},
                {{0, 1, 2}, {5, 4, 3}});
  scene.materials[0].alpha = 0.5f;
  scene.materials[0].blended = true;
  constexpr int kSamples = 1024;
  const std::vector<int> all = seen(scene, kSamples);
  for (std::size_t first = 0; first < all.size(); first += kSamples) {
    const auto bare = std::count(all.begin() + long(first), all.begin() + long(first) + kSamples, -1);
    // Half of the samples are drawn by each layer: the number left to both has the variance n / 16 of a
    // hypergeometric distribution. 6 deviations.
    ASSERT_NEAR(double(bare), kSamples / 4.0, 6 * std::sqrt(kSamples / 16.0));
  }
}

TEST(Blended, OpacityOneIsAlwaysDrawnAndOpacityZeroNever) {
  for (const int samples : {1, 3, 16, 1000}) {
    const std::vector<int> all = seen(layers({0.0f, 1.0f, 0.5f}), samples);
    EXPECT_EQ(std::size_t(countOf(all, 1)), all.size()) << samples;
  }
}

TEST(Blended, ASamplesThresholdIsBelowOne) {
  for (std::uint64_t surface = 0; surface < 1000; ++surface)
    for (const int count : {1, 3, 1024}) {
      std::vector<int> steps;
      for (int i = 0; i < count; ++i) {
        const double threshold = blendThreshold(surface, {int(surface) % 7, 3}, {i, count});
        ASSERT_GE(threshold, 0);
        ASSERT_LT(threshold, 1);
        steps.push_back(int(threshold * count));
      }
      std::sort(steps.begin(), steps.end());
      std::vector<int> all(std::size_t(count), 0);
      std::iota(all.begin(), all.end(), 0);
      ASSERT_EQ(steps, all);
    }
}

// What is seen depends on the pixel, the sample and the surface alone: not on the crop, on other objects, or
// on whether samples are drawn together.
TEST(Blended, NothingElseChangesWhichSamplesAreKept) {
  const Scene scene = layers({0.3f, 0.6f, 0.5f});
  View view = cameraView(frontCamera(), kSize);
  constexpr int kSamples = 5;
  const std::vector<int> all = seen(scene, kSamples);
  view.crop_origin = {17, 9};
  view.crop_size = {30, 20};
  const std::vector<int> part = seen(scene, view, kSamples, allObjects(scene));
  const std::vector<int> last = seen(scene, view, kSamples, {2});
  for (int y = 0; y < view.crop_size.y; ++y)
    for (int x = 0; x < view.crop_size.x; ++x)
      for (int i = 0; i < kSamples; ++i) {
        const std::size_t at = (std::size_t(y) * view.crop_size.x + x) * kSamples + i;
        const int whole =
            all[(std::size_t(y + view.crop_origin.y) * kSize.x + x + view.crop_origin.x) * kSamples + i];
        ASSERT_EQ(part[at], whole);
        if (whole == 2 || whole == -1) {
          ASSERT_EQ(last[at], whole);
        }
      }
  for (int i = 0; i < kSamples; ++i) {
    takeSample(view, {i, kSamples});
    const GBuffer alone = draw(scene, view);
    for (int y = 0; y < view.crop_size.y; ++y)
      for (int x = 0; x < view.crop_size.x; ++x) {
        const float z = alone.position[alone.index(x, y) + 2 * alone.pixels()];
        const int object = std::isfinite(z) ? int(std::lround(-z)) - 5 : -1;
        ASSERT_EQ(object, part[(std::size_t(y) * view.crop_size.x + x) * kSamples + i]);
      }
  }
}

// Shadows know a threshold alone: what is above it casts them whole.
TEST(Blended, ADepthMapHoldsWhatIsAboveTheCutoff) {
  Scene scene = layers({0.3f, 0.6f});
  for (Material& material : scene.materials) material.alpha_cutoff = 0.5f;
  const View view = cameraView(frontCamera(), kSize);
  const std::vector<ShadowTexel> depth = depthOf(scene, view);
  scene.objects.erase(scene.objects.begin());
  scene.materials[2].blended = false;
  const std::vector<ShadowTexel> expected = depthOf(scene, view);
  for (std::size_t i = 0; i < depth.size(); ++i) ASSERT_EQ(depth[i].depth, expected[i].depth);
}

}  // namespace
}  // namespace luciole::test
