#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "kernels/shade_bounds.hpp"
#include "raster/raster_scenes.hpp"
#include "reference/reference.hpp"
#include "render_json.hpp"

namespace luciole::test {

/// A scene, how it was looked at, and what came out. The picture and the G-buffer show the same samples.
struct Shot {
  Scene scene;
  RenderSettings settings;
  GBuffer gbuffer;
  Image image;
};

/// By the scene's first camera, without shadows unless the settings ask for them.
template <class Adjust>
Shot shoot(Scene scene, glm::ivec2 size, Adjust adjust) {
  Shot shot{std::move(scene), {}, {}, {}};
  shot.settings.size = size;
  shot.settings.camera = shot.scene.cameras.front();
  shot.settings.shade.shadows = ShadowMethod::kOff;
  adjust(shot.settings);
  Stats stats;
  shot.gbuffer = rasterizeScene(&testDevice(), shot.scene, shot.settings, stats);
  shot.image = renderScene(testDevice(), shot.scene, shot.settings, stats);
  return shot;
}
inline Shot shoot(Scene scene, glm::ivec2 size) {
  return shoot(std::move(scene), size, [](RenderSettings&) {});
}
inline Shot shoot(const std::string& json, glm::ivec2 size) { return shoot(sceneFromJson(json), size); }

inline int coveredPixels(const GBuffer& gbuffer) {
  int covered = 0;
  for (int y = 0; y < gbuffer.height; ++y)
    for (int x = 0; x < gbuffer.width; ++x) covered += isCovered(gbuffer, x, y);
  return covered;
}
inline glm::vec3 colorAt(const Image& image, int x, int y) {
  const float* pixel = &image.pixels[(std::size_t(y) * image.width + x) * image.channels.size()];
  return {pixel[0], pixel[1], pixel[2]};
}

/// Every value of a picture without shadows lies where shading in float may put it (see shade_bounds.hpp), as
/// does the reference in double; background is what the scene says. The largest distance from the reference,
/// and what would have been let pass, are recorded with the test.
inline void expectAsTheReference(const Shot& shot) {
  const Model model = shot.settings.shade.model;
  const Image reference = referenceShade(shot.scene, shot.gbuffer, {.model = model});
  double worst = 0, widest = 0;
  for (int y = 0; y < shot.image.height; ++y) {
    for (int x = 0; x < shot.image.width; ++x) {
      const glm::vec3 got = colorAt(shot.image, x, y), exact = colorAt(reference, x, y);
      if (!isCovered(shot.gbuffer, x, y)) {
        ASSERT_EQ(got, shot.scene.background) << "pixel " << x << "," << y;
        continue;
      }
      const std::size_t place = shot.gbuffer.index(x, y);
      for (int c = 0; c < 3; ++c) {
        // Two roundings more: the comparison's own, and the reference's on its way into a picture.
        const Interval bounds = shadeInterval(shot.scene, shot.gbuffer, place, c, model).widened(2 * kUnit);
        ASSERT_TRUE(got[c] >= bounds.low && got[c] <= bounds.high)
            << "pixel " << x << "," << y << " channel " << c << ": " << got[c] << " outside " << bounds.low
            << " … " << bounds.high;
        ASSERT_TRUE(exact[c] >= bounds.low && exact[c] <= bounds.high)
            << "pixel " << x << "," << y << " channel " << c << ": the reference's " << exact[c];
        worst = std::max(worst, std::abs(double(got[c]) - exact[c]));
        widest = std::max(widest, bounds.high - bounds.low);
      }
    }
  }
  testing::Test::RecordProperty("largest_error", fmt::format("{:.2g}", worst));
  testing::Test::RecordProperty("widest_bound", fmt::format("{:.2g}", widest));
}

/// The picture with every light sent to every pixel is the same to the last bit.
inline void expectCullingChangesNothing(const Shot& shot) {
  RenderSettings settings = shot.settings;
  for (const int tile_size : {0, 4, 8, 16}) {
    settings.shade.culling = tile_size == 0 ? Culling::kNone : Culling::kTiles;
    if (tile_size > 0) settings.shade.tile_size = tile_size;
    Stats stats;
    ASSERT_EQ(renderScene(testDevice(), shot.scene, settings, stats).pixels, shot.image.pixels)
        << "tiles of " << tile_size;
  }
}

}  // namespace luciole::test
