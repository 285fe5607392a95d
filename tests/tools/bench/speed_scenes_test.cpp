// The scenes that speed is measured on are what the measurements say of them.
#include "tools/bench/speed_scenes.hpp"

#include <gtest/gtest.h>

#include "kernels/probe.hpp"
#include "kernels/shade_bounds.hpp"
#include "kernels/shared.h"
#include "lighting/stats.hpp"
#include "render/render.hpp"
#include "tools/bench/shading_rate.hpp"

namespace luciole::test {
namespace {

double lightsInRangePerPixel(const Scene& scene, const GBuffer& gbuffer) {
  RenderSettings settings;
  settings.count_lights = true;
  Stats stats;
  shadeGBuffer(deviceWithLanes(16), scene, gbuffer, settings, stats);
  return double(countOf(stats, "pixel_lights_in_range")) / double(countOf(stats, "pixels_lit"));
}

/// Lights whose sphere touches the box around a tile's points, on average over the tiles.
double lightsPerTile(const Scene& scene, const GBuffer& gbuffer) {
  const glm::dmat4 to_view = worldToView(scene.cameras.front());
  std::vector<glm::dvec3> places;
  for (const Light& light : scene.lights) places.emplace_back(to_view * glm::dvec4(light.position, 1));
  const std::size_t n = gbuffer.pixels();
  std::uint64_t sum = 0;
  for (std::size_t tile = 0; tile < n; tile += kTilePixels) {
    glm::dvec3 low(1e300), high(-1e300);
    for (std::size_t i = tile; i < tile + kTilePixels; ++i) {
      const glm::dvec3 point(gbuffer.position[i], gbuffer.position[i + n], gbuffer.position[i + 2 * n]);
      low = glm::min(low, point);
      high = glm::max(high, point);
    }
    for (std::size_t i = 0; i < places.size(); ++i)
      sum += glm::distance(glm::clamp(places[i], low, high), places[i]) < scene.lights[i].range;
  }
  const std::size_t tiles = n / kTilePixels;
  return double(sum) / double(tiles);
}

TEST(SpeedScenes, HallHasTheStatisticsOfTheBestKnownTiledShader) {
  const Scene hall = makeHall();
  EXPECT_EQ(hall.lights.size(), 1024u);
  const GBuffer gbuffer = gbufferOf(hall, {1280, 720});
  EXPECT_NEAR(lightsInRangePerPixel(hall, gbuffer), 4.2, 0.03 * 4.2);
  EXPECT_NEAR(lightsPerTile(hall, gbuffer), 12.5, 0.03 * 12.5);
}

TEST(SpeedScenes, SphereIsSeenAllOverAndItsLightsReachIt) {
  const Scene sphere = makeLightSphere(100'000);
  const GBuffer gbuffer = gbufferOf(sphere, {480, 270});
  for (std::size_t i = 0; i < gbuffer.pixels(); ++i) {
    if (std::isinf(gbuffer.position[i + 2 * gbuffer.pixels()])) continue;
    const glm::dvec3 point(gbuffer.position[i], gbuffer.position[i + gbuffer.pixels()],
                           gbuffer.position[i + 2 * gbuffer.pixels()]);
    // A flat triangle between corners on the sphere lies inside it by up to 2 mm.
    ASSERT_NEAR(glm::length(point), 50.1, 0.002);
  }
  for (const Light& light : sphere.lights) {
    ASSERT_NEAR(glm::length(light.position), 50, 1e-9);
    ASSERT_EQ(light.range, 0.3f);
  }
  // 10⁵ caps of radius 0.3 at height 0.1 over a sphere: π (0.3² − 0.1²) of 4 π 50² each. Of the seen 13 % of
  // them, n = 10⁴ or so, the mean scatters by 1 / √n; four times that is allowed.
  EXPECT_NEAR(lightsInRangePerPixel(sphere, gbuffer), 0.8, 0.8 * 4 * 0.01);
}

TEST(SpeedScenes, OfAMillionLightsEightReachAPixelOfTheCity) {
  const Scene city = makeCity(1'000'000);
  const GBuffer gbuffer = gbufferOf(city, {480, 270});
  EXPECT_NEAR(lightsInRangePerPixel(city, gbuffer), 8, 0.4);
  EXPECT_EQ(city.lights.size(), 1'000'000u);
}

TEST(SpeedScenes, CityHasTheSamePixelsForAnyLights) {
  EXPECT_EQ(gbufferOf(makeCity(1), {48, 27}).position, gbufferOf(makeCity(1000), {48, 27}).position);
}

/// What plain.cl may make of channel `c` of a pixel. See shade_bounds.hpp, whose constants are for our
/// kernel; here built-in functions round: normalize's result is taken to be within 4 ulp, 8 roundings, of its
/// own and as many of the eye's, and pow within 16 ulp.
Interval plainInterval(const AllPairs& pairs, std::size_t place, int c) {
  const GBuffer& gbuffer = pairs.gbuffer;
  const std::size_t n = gbuffer.pixels();
  const auto triple = [&](const Plane& group) {
    return glm::dvec3(group[place], group[place + n], group[place + 2 * n]);
  };
  const glm::dvec3 position = triple(gbuffer.position), normal = glm::normalize(triple(gbuffer.normal));
  const glm::dvec3 to_eye = -glm::normalize(position);
  Interval seen;
  for (const Light& light : pairs.scene.lights) {
    WayToLight way = wayToLight(light, glm::dmat4(1), position);
    way.error += 8 * kUnit;
    const double n_dot_l = glm::dot(normal, way.unit);
    const Interval cosine = growing(n_dot_l, way.error + 6 * kUnit, [](double x) { return x; });
    const double mirrored = glm::dot(2 * n_dot_l * normal - way.unit, to_eye);
    const Interval lobe =
        powerInterval(mirrored, way.error + (24 + 16) * kUnit, gbuffer.specular[place + 3 * n])
            .widened(32 * kUnit);
    const Interval reflected =
        cosine * (double(light.diffuse[c]) * gbuffer.diffuse[place + std::size_t(c) * n]) +
        lobe * (double(light.specular[c]) * gbuffer.specular[place + std::size_t(c) * n]);
    seen = seen + windowInterval(light, way) * reflected;
  }
  return seen.widened((double(pairs.scene.lights.size()) + 12) * kUnit);
}

TEST(AllPairs, EveryLightReachesAndFacesEveryPixel) {
  const AllPairs pairs = makeAllPairs({64, 32}, 64);
  const GBuffer& gbuffer = pairs.gbuffer;
  const std::size_t n = gbuffer.pixels();
  ASSERT_EQ(n, 64u * 32);
  for (std::size_t i = 0; i < n; ++i) {
    const glm::dvec3 position(gbuffer.position[i], gbuffer.position[i + n], gbuffer.position[i + 2 * n]);
    const glm::dvec3 normal(gbuffer.normal[i], gbuffer.normal[i + n], gbuffer.normal[i + 2 * n]);
    for (const Light& light : pairs.scene.lights) {
      ASSERT_LT(glm::distance(light.position, position), light.range);
      ASSERT_GT(glm::dot(normal, light.position - position), 0);
    }
  }
}

TEST(AllPairs, ThePlainKernelAndOursMakeTheSamePicture) {
  const AllPairs pairs = makeAllPairs({64, 32}, 64);
  OpenedDevice& device = deviceWithLanes(16);
  RenderSettings settings;
  settings.shade.culling = Culling::kNone;
  Stats stats;
  const Image ours = shadeGBuffer(device, pairs.scene, pairs.gbuffer, settings, stats);
  const Image plain = shadePlainly(device, pairs);
  ASSERT_EQ(plain.pixels.size(), ours.pixels.size());
  for (int y = 0; y < plain.height; ++y) {
    for (int x = 0; x < plain.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const Interval bounds = plainInterval(pairs, pairs.gbuffer.index(x, y), c);
        const std::size_t i = (std::size_t(y) * plain.width + x) * 3 + c;
        for (const float value : {plain.pixels[i], ours.pixels[i]})
          ASSERT_TRUE(value >= bounds.low && value <= bounds.high)
              << "pixel " << x << "," << y << ": " << value << " outside " << bounds.low << " … "
              << bounds.high;
        // Exponents to 100 multiply some 60 roundings of a cosine, which make 4e-4.
        ASSERT_LT(bounds.high - bounds.low, 1e-3 * bounds.high) << "the bounds judge little";
      }
    }
  }
}

}  // namespace
}  // namespace luciole::test
