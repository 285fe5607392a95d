#include "shade/clustered_light.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"

namespace luciole::test {
namespace {

using Lights = std::vector<UnboundedLight>;

struct Lit {
  Plane light, bound;
  ClusteredLightCounts counts;
};

Lit lightBy(OpenedDevice& device, const GBuffer& gbuffer, const Lights& lights, float light_error,
            const Fog& fog = {}, bool highlights = false) {
  const LightClusters clusters = buildLightClusters(lights);
  ShadeFrame frame{};
  frame.plane_stride = uint(gbuffer.pixels());
  frame.eye = {0, 0, 0, 1};
  frame.model = kPhongModel;
  frame.fog_mode = uint(fog.mode);
  frame.fog_density = {fog.density.x, fog.density.y, fog.density.z, 0};
  FeatureSet features;
  features.set(Feature::kFogExp, fog.mode == FogMode::kExp);
  features.set(Feature::kFogPerChannel);
  features.set(Feature::kClusteredHighlights, highlights);
  features.set(Feature::kPhong);
  Lit lit;
  lit.light.assign(3 * gbuffer.pixels(), -1.0f);
  lit.bound.assign(3 * gbuffer.pixels(), -1.0f);
  const GBufferBuffers buffers = borrowedGBuffer(device, gbuffer, {}, {}, {}, {}, false);
  const Buffer<float> light = borrowedForOutput(device, lit.light);
  const Buffer<float> bound = borrowedForOutput(device, lit.bound);
  lit.counts = clusteredLight(device, featureDefines(features) + mathDefines({}),
                              {.frame = frame,
                               .gbuffer = buffers,
                               .tiles_x = gbuffer.tiles_x,
                               .tiles_y = gbuffer.tiles_y,
                               .clusters = clusters,
                               .highlights = clusters,
                               .light_error = light_error,
                               .light = light,
                               .bound = bound});
  download(device, light, lit.light);
  download(device, bound, lit.bound);
  return lit;
}

glm::dvec3 vectorAt(const Plane& plane, std::size_t place, std::size_t stride) {
  return {plane[place], plane[place + stride], plane[place + 2 * stride]};
}

/// The sum over the lights in double precision. highlights: with Phong's lobes of the same lights.
glm::dvec3 truthAt(const GBuffer& gbuffer, std::size_t place, const Lights& lights, bool highlights = false) {
  const std::size_t n = gbuffer.pixels();
  const glm::dvec3 position = vectorAt(gbuffer.position, place, n);
  const glm::dvec3 normal = glm::normalize(vectorAt(gbuffer.normal, place, n));
  const glm::dvec3 eye = -glm::normalize(position);
  const double shininess = highlights ? gbuffer.specular[place + 3 * n] : 0;
  glm::dvec3 sum(0.0), specular(0.0);
  for (const UnboundedLight& light : lights) {
    const glm::dvec3 way = light.position - position;
    const double d2 = glm::dot(way, way), z = glm::dot(normal, way);
    if (!(z > 0)) continue;
    const glm::dvec3 light_here = light.color / std::max(light.quadratic * d2, 0x1p-100);
    sum += light_here * (z / std::sqrt(d2));
    if (!highlights) continue;
    const double cosine = glm::dot(2 * glm::dot(normal, eye) * normal - eye, way) / std::sqrt(d2);
    specular += light_here * std::pow(std::max(cosine, 0.0), shininess);
  }
  sum *= vectorAt(gbuffer.diffuse, place, n);
  return highlights ? sum + specular * vectorAt(gbuffer.specular, place, n) : sum;
}

/// The light at every pixel is within its bound of the truth, and where `met` the bound within what is
/// allowed.
void expectCertified(const GBuffer& gbuffer, const Lights& lights, const Lit& lit, double light_error,
                     bool met = true, bool highlights = false) {
  const std::size_t n = gbuffer.pixels();
  for (std::size_t i = 0; i < n; ++i) {
    if (!(gbuffer.position[i + 2 * n] > -std::numeric_limits<float>::infinity())) {
      ASSERT_EQ(vectorAt(lit.light, i, n), glm::dvec3(0.0)) << "background " << i;
      ASSERT_EQ(vectorAt(lit.bound, i, n), glm::dvec3(0.0)) << "background " << i;
      continue;
    }
    const glm::dvec3 truth = truthAt(gbuffer, i, lights, highlights), light = vectorAt(lit.light, i, n),
                     bound = vectorAt(lit.bound, i, n);
    for (int c = 0; c < 3; ++c) {
      ASSERT_LE(std::abs(light[c] - truth[c]), bound[c])
          << "pixel " << i << ", channel " << c << ", " << truth[c];
      if (!met) continue;
      ASSERT_LE(bound[c], light_error * std::max(1.0, light[c])) << "pixel " << i << ", channel " << c;
    }
  }
}

/// A wavy surface some 6 m ahead, its normals bent by up to `bend`, a share of it background.
GBuffer wavySurface(int width, int height, double bend, Random& random, double background = 0.05) {
  GBuffer gbuffer = randomGBuffer(Camera{}, width, height, background, random);
  const std::size_t n = gbuffer.pixels();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t place = gbuffer.index(x, y);
      if (!std::isfinite(gbuffer.position[place + 2 * n])) continue;
      const double u = 8.0 * x / 128, v = 8.0 * y / 128;
      const glm::dvec3 position(u - 4, 3 - v, -6 - bend * std::sin(2 * u) * std::cos(v));
      const glm::dvec3 normal = glm::normalize(
          glm::dvec3(2 * bend * std::cos(2 * u) * std::cos(v), bend * std::sin(2 * u) * std::sin(v), 1.0));
      for (int c = 0; c < 3; ++c) {
        gbuffer.position[place + c * n] = float(position[c]);
        gbuffer.normal[place + c * n] = float(normal[c]);
        gbuffer.diffuse[place + c * n] = float(random.between(0, 1));
      }
    }
  return gbuffer;
}

/// Lights that give a surface amid them about `exposure` together.
Lights lightsIn(const glm::dvec3& low, const glm::dvec3& high, int count, Random& random,
                double exposure = 1) {
  Lights lights;
  const double side = glm::length(high - low);
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 place(random.between(low.x, high.x), random.between(low.y, high.y),
                           random.between(low.z, high.z));
    lights.push_back({place, exposure * side * side / count * random.color(), random.between(0.5, 2)});
  }
  return lights;
}

class ClusteredLight : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Lanes, ClusteredLight, testing::ValuesIn(widths()),
                         testing::PrintToStringParamName());

TEST_P(ClusteredLight, IsWithinItsBoundOfTheTruthAtEveryPixel) {
  OpenedDevice& device = deviceWithLanes(GetParam());
  Random random(3);
  for (const double bend : {0.0, 0.3}) {
    const GBuffer gbuffer = wavySurface(48, 40, bend, random);
    const Lights around = lightsIn({-6, -5, -10}, {6, 5, 4}, 3000, random);
    const Lights plane = lightsIn({-6, -5, -4.01}, {6, 5, -4}, 3000, random);
    for (const Lights& lights : {around, plane})
      for (const float light_error : {1.0f / 16, 1.0f / 256, 1.0f / 1024})
        ASSERT_NO_FATAL_FAILURE(
            expectCertified(gbuffer, lights, lightBy(device, gbuffer, lights, light_error), light_error))
            << "bend " << bend << ", E " << light_error;
  }
}

TEST_P(ClusteredLight, HasTheSameBitsAtEveryWidth) {
  Random random(4);
  const GBuffer gbuffer = wavySurface(70, 33, 0.2, random);
  const Lights lights = lightsIn({-6, -5, -10}, {6, 5, 4}, 5000, random);
  const Lit widest = lightBy(deviceWithLanes(16), gbuffer, lights, 1.0f / 256);
  const Lit lit = lightBy(deviceWithLanes(GetParam()), gbuffer, lights, 1.0f / 256);
  EXPECT_EQ(std::memcmp(lit.light.data(), widest.light.data(), widest.light.size() * sizeof(float)), 0);
  EXPECT_EQ(std::memcmp(lit.bound.data(), widest.bound.data(), widest.bound.size() * sizeof(float)), 0);
  EXPECT_EQ(lit.counts.far, widest.counts.far);
  EXPECT_EQ(lit.counts.lights, widest.counts.lights);
}

TEST_P(ClusteredLight, OfHighlightsIsCertifiedAndHasTheSameBitsAtEveryWidth) {
  Random random(9);
  GBuffer gbuffer = wavySurface(48, 33, 0.2, random);
  const std::size_t n = gbuffer.pixels();
  // Rounding alone is more than the smaller error for the largest exponents.
  for (std::size_t i = 3 * n; i < 4 * n; ++i) gbuffer.specular[i] = std::min(gbuffer.specular[i], 128.0f);
  const Lights lights = lightsIn({-6, -5, -10}, {6, 5, 4}, 3000, random);
  for (const float light_error : {1.0f / 16, 1.0f / 256}) {
    const Lit widest = lightBy(deviceWithLanes(16), gbuffer, lights, light_error, {}, true);
    const Lit lit = lightBy(deviceWithLanes(GetParam()), gbuffer, lights, light_error, {}, true);
    ASSERT_NO_FATAL_FAILURE(expectCertified(gbuffer, lights, lit, light_error, true, true));
    EXPECT_EQ(std::memcmp(lit.light.data(), widest.light.data(), widest.light.size() * sizeof(float)), 0);
    EXPECT_EQ(std::memcmp(lit.bound.data(), widest.bound.data(), widest.bound.size() * sizeof(float)), 0);
  }
}

TEST(ClusteredLights, StandForMostLightsThatAreFar) {
  Random random(5);
  const GBuffer gbuffer = wavySurface(64, 64, 0.1, random, 0);
  const Lights lights = lightsIn({-6, -5, -10}, {6, 5, 4}, 20000, random);
  const Lit lit = lightBy(deviceWithLanes(16), gbuffer, lights, 1.0f / 64);
  EXPECT_LT(double(lit.counts.lights), 0.1 * 20000 * 64 * 64);
  ASSERT_NO_FATAL_FAILURE(expectCertified(gbuffer, lights, lit, 1.0f / 64));
}

TEST(ClusteredLights, BlackPixelsTakeNone) {
  Random random(8);
  GBuffer gbuffer = wavySurface(64, 48, 0.2, random);
  const Lights lights = lightsIn({-6, -5, -10}, {6, 5, 4}, 3000, random);
  const std::size_t n = gbuffer.pixels();
  for (std::size_t i = 0; i < n; i += 3)
    for (std::size_t c = 0; c < 3; ++c) gbuffer.diffuse[i + c * n] = 0;
  const Lit some = lightBy(deviceWithLanes(16), gbuffer, lights, 1.0f / 256);
  ASSERT_NO_FATAL_FAILURE(expectCertified(gbuffer, lights, some, 1.0f / 256));
  gbuffer.diffuse.assign(3 * n, 0.0f);
  const Lit none = lightBy(deviceWithLanes(16), gbuffer, lights, 1.0f / 256);
  ASSERT_NO_FATAL_FAILURE(expectCertified(gbuffer, lights, none, 1.0f / 256));
  EXPECT_EQ(none.counts.far + none.counts.lights + none.counts.redone, 0u);
}

// Bands of a picture are whole rows of tiles.
TEST(ClusteredLights, OfARowOfTilesDontDependOnOtherRows) {
  Random random(6);
  const GBuffer both = wavySurface(150, 32, 0.2, random);
  GBuffer lower = both;
  lower.height = 16;
  lower.tiles_y = 1;
  const std::size_t n = both.pixels(), half = n / 2;
  for (auto [from, to] : {std::pair(&both.position, &lower.position), std::pair(&both.normal, &lower.normal),
                          std::pair(&both.diffuse, &lower.diffuse)}) {
    to->resize(3 * half);
    for (std::size_t c = 0; c < 3; ++c)
      std::copy_n(from->begin() + std::ptrdiff_t(c * n + half), half, to->begin() + std::ptrdiff_t(c * half));
  }
  ASSERT_EQ(lower.pixels(), half);
  const Lights lights = lightsIn({-6, -5, -10}, {6, 5, 4}, 4000, random);
  const Lit all = lightBy(deviceWithLanes(16), both, lights, 1.0f / 256);
  const Lit some = lightBy(deviceWithLanes(16), lower, lights, 1.0f / 256);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(std::memcmp(&all.light[c * n + half], &some.light[c * half], half * sizeof(float)), 0);
    EXPECT_EQ(std::memcmp(&all.bound[c * n + half], &some.bound[c * half], half * sizeof(float)), 0);
  }
}

TEST(ClusteredLights, BoundIsSeenThroughTheFog) {
  Random random(7);
  const GBuffer gbuffer = wavySurface(32, 16, 0.2, random, 0);
  const Lights lights = lightsIn({-6, -5, -10}, {6, 5, 4}, 3000, random);
  Fog fog;
  fog.mode = FogMode::kExp;
  fog.density = glm::vec3(0.1f, 0.2f, 0.0f);
  const Lit clear = lightBy(deviceWithLanes(16), gbuffer, lights, 1.0f / 256);
  const Lit foggy = lightBy(deviceWithLanes(16), gbuffer, lights, 1.0f / 256, fog);
  EXPECT_EQ(foggy.light, clear.light) << "light is fogged where it is shaded";
  const std::size_t n = gbuffer.pixels();
  for (std::size_t i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) {
      const double share = std::exp(double(fog.density[c]) * gbuffer.position[i + 2 * n]);
      // exp_lanes() is within 23 roundings, and the product has one.
      EXPECT_NEAR(foggy.bound[i + c * n], share * clear.bound[i + c * n],
                  24 * 0x1p-24 * clear.bound[i + c * n]);
    }
}

/// Lights and surfaces that are hard on the bound.
class HardClusteredLight : public testing::Test {
 protected:
  void expectCertifiedOf(const Lights& lights, double bend = 0.2, bool met = true) {
    const GBuffer gbuffer = wavySurface(40, 24, bend, random);
    for (const float light_error : {1.0f / 16, 1.0f / 256})
      ASSERT_NO_FATAL_FAILURE(expectCertified(
          gbuffer, lights, lightBy(deviceWithLanes(16), gbuffer, lights, light_error), light_error, met))
          << "E " << light_error;
  }
  Random random{8};
};

TEST_F(HardClusteredLight, OfAllLightsAtOnePoint) {
  expectCertifiedOf(Lights(3000, {{0.1, 0.2, -3}, glm::dvec3(0.003, 0.001, 0), 1}));
}

TEST_F(HardClusteredLight, OfLightsAHundredMillionMetresApart) {
  Lights lights = lightsIn({-6, -5, -10}, {6, 5, 4}, 2000, random);
  for (const double far : {1e8, -1e8}) lights.push_back({{far, 0, 10}, glm::dvec3(1e15), 1});
  expectCertifiedOf(lights);
}

TEST_F(HardClusteredLight, OfFewLightsOfOneAndOfNone) {
  for (const int count : {0, 1, 2, 8, 9, 16, 17}) {
    SCOPED_TRACE(count);
    expectCertifiedOf(lightsIn({-6, -5, -4}, {6, 5, 4}, count, random));
  }
}

TEST_F(HardClusteredLight, OfIntensitiesFortyOrdersApart) {
  Lights lights = lightsIn({-60, -50, -4}, {60, 50, 100}, 3000, random);
  for (UnboundedLight& light : lights) {
    light.color *= std::pow(10.0, random.between(-20, 20));
    light.quadratic = 1;
  }
  expectCertifiedOf(lights);
}

TEST_F(HardClusteredLight, OfColouredLights) {
  Lights lights = lightsIn({-6, -5, -10}, {6, 5, 4}, 3000, random);
  for (UnboundedLight& light : lights) {
    const int channel = random.below(3);
    for (int c = 0; c < 3; ++c) light.color[c] *= c == channel;
  }
  expectCertifiedOf(lights);
}

// On a surface, at a pixel's very place, inside the sphere around a group of pixels: light is as bright there
// as it gets.
TEST_F(HardClusteredLight, OfLightsOnSurfaces) {
  const GBuffer gbuffer = wavySurface(40, 24, 0.1, random, 0);
  const std::size_t n = gbuffer.pixels();
  Lights lights;
  for (int i = 0; i < 2000; ++i) {
    const std::size_t place = gbuffer.index(random.below(40), random.below(24));
    const double height = std::pow(10.0, random.between(-6, 0)) * random.below(4);
    lights.push_back({vectorAt(gbuffer.position, place, n) + height * vectorAt(gbuffer.normal, place, n),
                      0.01 * random.color(), 1});
  }
  // What a light at a grazing angle and a micrometre's distance gives is known within a share of 1/d² only.
  ASSERT_NO_FATAL_FAILURE(expectCertified(
      gbuffer, lights, lightBy(deviceWithLanes(16), gbuffer, lights, 1.0f / 16), 1.0f / 16, false));
}

TEST_F(HardClusteredLight, OfAPlaneFacingAPlaneOfLights) {
  expectCertifiedOf(lightsIn({-20, -20, -5.5}, {20, 20, -5.5}, 4000, random), 0);
}

TEST_F(HardClusteredLight, OfLightsAllNearTheHorizon) {
  expectCertifiedOf(lightsIn({-50, -50, -6.1}, {50, 50, -5.9}, 4000, random), 0);
}

TEST_F(HardClusteredLight, AtOnePixelAndAtNormalsInAllDirections) {
  const Lights lights = lightsIn({-6, -5, -20}, {6, 5, 4}, 3000, random);
  for (const glm::ivec2& size : {glm::ivec2(1, 1), glm::ivec2(33, 20)}) {
    const GBuffer gbuffer = randomGBuffer(Camera{}, size.x, size.y, 0, random);
    ASSERT_NO_FATAL_FAILURE(expectCertified(
        gbuffer, lights, lightBy(deviceWithLanes(16), gbuffer, lights, 1.0f / 256), 1.0f / 256));
  }
}

// Each light is less than half the last bit of the sum that it is added to, so sums lose them all. Two
// pixels, because for a single one a series is exact.
TEST_F(HardClusteredLight, OfManyLightsTooDimToCountBesideOne) {
  GBuffer gbuffer = wavySurface(2, 1, 0, random, 0);
  const std::size_t n = gbuffer.pixels(), place = gbuffer.index(0, 0);
  for (std::size_t c = 0; c < 3; ++c) gbuffer.diffuse[place + c * n] = 1;
  const glm::dvec3 above = vectorAt(gbuffer.position, place, n) + glm::dvec3(0, 0, 1);
  // The leftmost light comes first in the tree.
  Lights lights{{above, glm::dvec3(1.02), 1}};
  for (int i = 1; i < 64; ++i)
    lights.push_back({above + glm::dvec3(1e-3 * i, 0, 0), glm::dvec3(0.96 * 0x1p-24), 1});
  const Lit lit = lightBy(deviceWithLanes(16), gbuffer, lights, 1e-7f);
  ASSERT_NO_FATAL_FAILURE(expectCertified(gbuffer, lights, lit, 1e-7, false));
  EXPECT_GT(truthAt(gbuffer, place, lights).x - vectorAt(lit.light, place, n).x, 50 * 0x1p-24)
      << "they are lost";
}

// A cosine near 0 is rounding and little else, in whichever block of a sum.
TEST_F(HardClusteredLight, OfLightsThatGraze) {
  const glm::dvec3 place(0.3, 0.2, -3);
  for (const auto& [before, after] : {std::pair(0, 0), std::pair(0, 300), std::pair(300, 0)}) {
    SCOPED_TRACE(std::to_string(before) + " dim lights before, " + std::to_string(after) + " after");
    GBuffer gbuffer = wavySurface(40, 24, 0.2, random, 0);
    const std::size_t n = gbuffer.pixels();
    for (int y = 0; y < gbuffer.height; ++y)
      for (int x = 0; x < gbuffer.width; ++x) {
        const std::size_t i = gbuffer.index(x, y);
        const glm::dvec3 way = glm::normalize(place - vectorAt(gbuffer.position, i, n));
        const double height = random.between(-1, 1) * std::pow(10.0, random.between(-9, -6));
        const glm::dvec3 normal = glm::normalize(glm::cross(way, random.direction())) + height * way;
        for (int c = 0; c < 3; ++c) gbuffer.normal[i + c * n] = float(normal[c]);
      }
    Lights lights(before, {place, glm::dvec3(1e-30), 1});
    lights.insert(lights.end(), 8, {place, glm::dvec3(1), 1});
    lights.insert(lights.end(), after, {place, glm::dvec3(1e-30), 1});
    ASSERT_NO_FATAL_FAILURE(
        expectCertified(gbuffer, lights, lightBy(deviceWithLanes(16), gbuffer, lights, 1e-7f), 1e-7, false));
    // A lobe of exponent 0 is 1 up to the horizon.
    for (std::size_t c = 0; c < 4; ++c)
      std::fill_n(gbuffer.specular.begin() + std::ptrdiff_t(c * n), n, c < 3 ? 1.0f : 0.0f);
    const Lit shiny = lightBy(deviceWithLanes(16), gbuffer, lights, 1e-7f, {}, true);
    ASSERT_NO_FATAL_FAILURE(expectCertified(gbuffer, lights, shiny, 1e-7, false, true));
  }
}

/// A flat surface 6 m ahead that shines and has no colour of its own. size: its side.
GBuffer shinySurface(double size, float exponent, Random& random) {
  GBuffer gbuffer = wavySurface(16, 16, 0, random, 0);
  const std::size_t n = gbuffer.pixels();
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const std::size_t place = gbuffer.index(x, y);
      gbuffer.position[place] = float(size / 16 * x);
      gbuffer.position[place + n] = float(size / 16 * y);
      for (std::size_t c = 0; c < 3; ++c) gbuffer.diffuse[place + c * n] = 0;
      for (std::size_t c = 0; c < 3; ++c) gbuffer.specular[place + c * n] = 1;
      gbuffer.specular[place + 3 * n] = exponent;
    }
  return gbuffer;
}

// What is counted of lights that are listed: 164 roundings of their highlights, and what each lobe's may be.
TEST_F(HardClusteredLight, OfHighlightsCountsTheRoundingOfEachLight) {
  for (const float exponent : {4.0f, 32.0f, 1000.0f}) {
    const GBuffer gbuffer = shinySurface(0.5, exponent, random);
    const std::size_t n = gbuffer.pixels();
    const Lights lights = lightsIn({-2, -2, -5}, {2, 2, 4}, 300, random);
    const Lit lit = lightBy(deviceWithLanes(16), gbuffer, lights, 1e-8f, {}, true);
    const double p = exponent, e = 0x1p-24 * (13.1 * std::sqrt(p) + 36 + 141 / p);
    for (std::size_t i = 0; i < n; ++i) {
      const glm::dvec3 position = vectorAt(gbuffer.position, i, n), eye = -glm::normalize(position);
      const glm::dvec3 mirrored(-eye.x, -eye.y, eye.z);
      glm::dvec3 of_light(0.0);
      double of_lobes = 0;
      for (const UnboundedLight& light : lights) {
        const glm::dvec3 way = light.position - position, q = light.color / light.quadratic;
        const double d2 = glm::dot(way, way), cosine = glm::dot(mirrored, way) / std::sqrt(d2);
        const double lobe = std::pow(std::max(cosine, 0.0), p);
        of_light += q * (lobe / d2);
        of_lobes += std::max({q.x, q.y, q.z}) / d2 * e * std::sqrt(lobe);
      }
      for (int c = 0; c < 3; ++c)
        ASSERT_GE(vectorAt(lit.bound, i, n)[c], 0.999 * (164 * 0x1p-24 * of_light[c] + of_lobes))
            << "exponent " << exponent << ", pixel " << i << ", channel " << c;
    }
  }
}

/// Lights so far away, in a direction, that each pixel sees them at the same place.
Lights farLights(const glm::dvec3& direction, double exposure, Random& random) {
  const double distance = 1e4;
  Lights lights;
  for (int i = 0; i < 2000; ++i)
    lights.push_back(
        {distance * direction + random.direction(), glm::dvec3(exposure * distance * distance / 2000), 1});
  return lights;
}

TEST_F(HardClusteredLight, OfHighlightsCountsTheRoundingOfTheSeries) {
  const GBuffer gbuffer = shinySurface(1e-3, 32, random);
  const std::size_t n = gbuffer.pixels();
  const Lit lit = lightBy(deviceWithLanes(16), gbuffer, farLights({0, 0, 1}, 1, random), 1.0f / 16, {}, true);
  EXPECT_EQ(lit.counts.lights, 0u) << "all join the series";
  for (std::size_t i = 0; i < n; ++i)
    ASSERT_GE(vectorAt(lit.bound, i, n).x,
              0.999 * (32 * 32 + 128 + 16) * 0x1p-24 * vectorAt(lit.light, i, n).x);
}

// Normals that turn the mirrored eye by 0.02 to both sides, towards the lights and from them.
TEST_F(HardClusteredLight, OfAxesThatTurnWithinAGroup) {
  GBuffer gbuffer = shinySurface(1e-3, 64, random);
  const std::size_t n = gbuffer.pixels();
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const glm::dvec3 normal = glm::normalize(glm::dvec3(x % 2 == 0 ? 0.01 : -0.01, 0, 1));
      for (int c = 0; c < 3; ++c) gbuffer.normal[gbuffer.index(x, y) + std::size_t(c) * n] = float(normal[c]);
    }
  const Lights lights = farLights({0.3, 0, std::sqrt(1 - 0.09)}, 5, random);
  const Lit lit = lightBy(deviceWithLanes(16), gbuffer, lights, 1.0f / 16, {}, true);
  EXPECT_EQ(lit.counts.lights, 0u) << "all join the series";
  ASSERT_NO_FATAL_FAILURE(expectCertified(gbuffer, lights, lit, 1.0 / 16, true, true));
}

// Steps that one group of pixels holds both of: the lights between them light the lower one alone.
TEST_F(HardClusteredLight, OfLightsBetweenTheStepsOfAStair) {
  GBuffer gbuffer = wavySurface(40, 24, 0, random, 0);
  for (int y = 0; y < gbuffer.height; ++y)
    for (int x = 0; x < gbuffer.width; ++x)
      gbuffer.position[gbuffer.index(x, y) + 2 * gbuffer.pixels()] = x % 2 == 0 ? -6.0f : -5.9f;
  const Lights lights = lightsIn({-20, -20, -5.94}, {20, 20, -5.94}, 3000, random, 10);
  ASSERT_NO_FATAL_FAILURE(expectCertified(
      gbuffer, lights, lightBy(deviceWithLanes(16), gbuffer, lights, 1.0f / 16), 1.0f / 16, false));
}

// Walks that list more lights, and more than once, than a list holds; cut clusters too.
TEST_F(HardClusteredLight, OfMoreLightsThanAListHolds) {
  const GBuffer gbuffer = wavySurface(16, 16, 0, random, 0);
  const Lights lights = lightsIn({-6, 1, -6.5}, {0, 5, -5.5}, 20000, random);
  const Lit lit = lightBy(deviceWithLanes(16), gbuffer, lights, 1.0f / 512);
  EXPECT_GT(double(lit.counts.lights), 3000.0 * 16 * 16);
  EXPECT_GT(double(lit.counts.clusters), 50.0 * 16 * 16);
  ASSERT_NO_FATAL_FAILURE(expectCertified(gbuffer, lights, lit, 1.0 / 512));
}

// Float has seven digits: a bound that can't be met is given as it is, and nothing is looked for forever.
TEST_F(HardClusteredLight, ThatFloatsCantHoldTellsHowFarItMayBeOff) {
  const Lights lights = lightsIn({-6, -5, -10}, {6, 5, 4}, 500, random);
  const GBuffer gbuffer = wavySurface(20, 20, 0.2, random);
  const Lit lit = lightBy(deviceWithLanes(16), gbuffer, lights, 1e-7f);
  ASSERT_NO_FATAL_FAILURE(expectCertified(gbuffer, lights, lit, 1e-7, false));
  EXPECT_GT(*std::max_element(lit.bound.begin(), lit.bound.end()), 1e-7f);
  EXPECT_LT(*std::max_element(lit.bound.begin(), lit.bound.end()), 1e-2f);
}

}  // namespace
}  // namespace luciole::test
