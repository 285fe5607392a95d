#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "kernels/probe.hpp"
#include "kernels/shade_bounds.hpp"
#include "kernels/shared.h"
#include "luciole/gbuffer.hpp"
#include "reference/reference.hpp"
#include "render/render.hpp"

// Cases that break renderers are easiest to say as a few surface points, some lights, and what must be seen.
namespace luciole::test {

/// What a pixel shows, in view space.
struct SurfaceSeen {
  glm::vec3 position{0, 0, -4};
  glm::vec3 normal{0, 0, 1};
  glm::vec3 diffuse{1.0f}, specular{0.0f}, ambient{0.0f}, emission{0.0f};
  float shininess = 0;
};

inline constexpr int kSeenPerRow = 64;

/// A G-buffer of these points, kSeenPerRow a row, background after the last. Its camera stands at the world's
/// origin, so that view space is world space and nothing is rounded on its way to the kernels.
inline GBuffer gbufferOf(const std::vector<SurfaceSeen>& points) {
  const int count = static_cast<int>(points.size());
  GBuffer gbuffer;
  gbuffer.width = std::min(count, kSeenPerRow);
  gbuffer.height = (count + kSeenPerRow - 1) / kSeenPerRow;
  gbuffer.tiles_x = (gbuffer.width + kTileSize - 1) / kTileSize;
  gbuffer.tiles_y = (gbuffer.height + kTileSize - 1) / kTileSize;
  gbuffer.picture_size = {gbuffer.width, gbuffer.height};
  const std::size_t n = gbuffer.pixels();
  gbuffer.position.assign(3 * n, 0.0f);
  std::fill(gbuffer.position.begin() + std::ptrdiff_t(2 * n), gbuffer.position.end(),
            -std::numeric_limits<float>::infinity());
  for (Plane* group : {&gbuffer.normal, &gbuffer.diffuse, &gbuffer.ambient, &gbuffer.emission})
    group->assign(3 * n, 0.0f);
  gbuffer.specular.assign(4 * n, 0.0f);
  for (int i = 0; i < count; ++i) {
    const SurfaceSeen& seen = points[std::size_t(i)];
    const std::size_t place = gbuffer.index(i % kSeenPerRow, i / kSeenPerRow);
    for (int c = 0; c < 3; ++c) {
      gbuffer.position[place + c * n] = seen.position[c];
      gbuffer.normal[place + c * n] = seen.normal[c];
      gbuffer.diffuse[place + c * n] = seen.diffuse[c];
      gbuffer.specular[place + c * n] = seen.specular[c];
      gbuffer.ambient[place + c * n] = seen.ambient[c];
      gbuffer.emission[place + c * n] = seen.emission[c];
    }
    gbuffer.specular[place + 3 * n] = seen.shininess;
  }
  return gbuffer;
}

/// The colours of the points of such a picture.
inline std::vector<glm::vec3> pointColors(const Image& image, std::size_t points) {
  std::vector<glm::vec3> colors;
  for (std::size_t i = 0; i < points; ++i)
    colors.emplace_back(image.pixels[3 * i], image.pixels[3 * i + 1], image.pixels[3 * i + 2]);
  return colors;
}

inline std::vector<glm::vec3> shadedPoints(int lanes, const Scene& scene,
                                           const std::vector<SurfaceSeen>& points,
                                           const ShadeSettings& shade = {}) {
  RenderSettings settings;
  settings.shade = shade;
  Stats stats;
  return pointColors(shadeGBuffer(deviceWithLanes(lanes), scene, gbufferOf(points), settings, stats),
                     points.size());
}

/// The colour that one point shows, the same on the widest and the narrowest device.
inline glm::vec3 shadedPoint(const Scene& scene, const SurfaceSeen& point) {
  const glm::vec3 color = shadedPoints(16, scene, {point})[0];
  EXPECT_EQ(color, shadedPoints(1, scene, {point})[0]);
  return color;
}

inline std::vector<glm::vec3> referencePoints(const Scene& scene, const std::vector<SurfaceSeen>& points,
                                              Model model = Model::kPhong) {
  return pointColors(referenceShade(scene, gbufferOf(points), {.model = model}), points.size());
}

/// The points are shaded to the same bits with light lists and without, and to what float may make of the
/// equation (see shade_bounds.hpp); the reference lies there too.
inline void expectRight(const Scene& scene, const std::vector<SurfaceSeen>& points,
                        Model model = Model::kPhong) {
  const GBuffer gbuffer = gbufferOf(points);
  const auto truth = referencePoints(scene, points, model);
  for (const int lanes : {1, 16}) {
    const auto all = shadedPoints(lanes, scene, points, {.model = model, .culling = Culling::kNone});
    ASSERT_EQ(all, shadedPoints(lanes, scene, points, {.model = model})) << "culling changes the picture";
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t place = gbuffer.index(int(i) % kSeenPerRow, int(i) / kSeenPerRow);
      for (int c = 0; c < 3; ++c) {
        // A rounding for the exact value, which the reference stores as float, and one for the comparison;
        // what is below the normal numbers may be 0.
        Interval bounds = shadeInterval(scene, gbuffer, place, c, model).widened(2 * kUnit);
        bounds = {bounds.low - 0x1p-126, bounds.high + 0x1p-126};
        ASSERT_TRUE(all[i][c] >= bounds.low && all[i][c] <= bounds.high)
            << "point " << i << " channel " << c << ", " << lanes << " lanes: " << all[i][c] << " outside "
            << bounds.low << " … " << bounds.high;
        ASSERT_TRUE(truth[i][c] >= bounds.low && truth[i][c] <= bounds.high)
            << "point " << i << " channel " << c << ": the reference's " << truth[i][c] << " outside "
            << bounds.low << " … " << bounds.high;
      }
    }
  }
}

inline Light pointLight(const glm::dvec3& position) {
  Light light;
  light.position = position;
  return light;
}

inline Scene sceneWith(std::vector<Light> lights) {
  Scene scene;
  scene.name = "hard case";
  scene.lights = std::move(lights);
  return scene;
}

}  // namespace luciole::test
