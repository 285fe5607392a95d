#include "shade/shade.hpp"

#include <gtest/gtest.h>

#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"
#include "kernels/shade_bounds.hpp"
#include "lighting/light_gbuffer.hpp"
#include "reference/reference.hpp"
#include "scene/bounds.hpp"
#include "scene/models.hpp"

namespace luciole::test {
namespace {

/// All of shading but shadows, which the reference leaves to rays; the frame and the lights choose.
FeatureSet unshadowed(Culling culling) {
  FeatureSet features = everyFeature();
  for (const Feature shadow :
       {Feature::kParallelShadows, Feature::kPerspectiveShadows, Feature::kCubeShadows, Feature::kPcf,
        Feature::kSoft, Feature::kExact, Feature::kSoftExact, Feature::kOutputShadow})
    features.set(shadow, false);
  features.set(Feature::kLightLists, culling == Culling::kTiles);
  return features;
}

Plane shadeOn(OpenedDevice& device, const Scene& scene, const GBuffer& gbuffer, Model model,
              Culling culling) {
  Lighting lighting;
  Stats stats;
  const FeatureSet features = unshadowed(culling);
  prepareLighting(device, scene, gbuffer.camera, View{}, features, {.model = model}, lighting, stats);
  return lightGBuffer(device, scene, lighting, {lighting.lights, features, gbuffer}, stats).color;
}

/// How the bounds did over some pictures.
struct Tightness {
  std::size_t values = 0, loose = 0;
};

/// The kernel's picture lies within the bounds, and so does the reference's.
void expectShaded(const Scene& scene, const GBuffer& gbuffer, Model model, const Plane& result,
                  Tightness& tightness) {
  const Image reference = referenceShade(scene, gbuffer, {.model = model});
  const std::size_t n = gbuffer.pixels();
  for (int y = 0; y < gbuffer.height; ++y) {
    for (int x = 0; x < gbuffer.width; ++x) {
      const std::size_t place = gbuffer.index(x, y);
      for (int c = 0; c < 3; ++c) {
        const float got = result[place + c * n];
        const float exact = reference.pixels[(std::size_t(y) * gbuffer.width + x) * 3 + c];
        if (std::isinf(gbuffer.position[place + 2 * n])) {
          ASSERT_EQ(got, scene.background[c]);
          ASSERT_EQ(exact, scene.background[c]);
          continue;
        }
        const Interval bounds = shadeInterval(scene, gbuffer, place, c, model).widened(2 * kUnit);
        ASSERT_TRUE(got >= bounds.low && got <= bounds.high)
            << "pixel " << x << "," << y << " channel " << c << ": " << got << " outside " << bounds.low
            << " … " << bounds.high;
        ASSERT_TRUE(exact >= bounds.low && exact <= bounds.high)
            << "pixel " << x << "," << y << " channel " << c << ": the reference's " << exact << " outside "
            << bounds.low << " … " << bounds.high;
        ++tightness.values;
        tightness.loose += bounds.high - bounds.low > 1e-3 * bounds.high;
      }
    }
  }
}

class ShadeKernel : public testing::TestWithParam<int> {};

TEST_P(ShadeKernel, MatchesTheReference) {
  OpenedDevice& device = deviceWithLanes(GetParam());
  Random random{unsigned(GetParam())};
  Tightness tightness;
  int round = 0;
  for (const glm::ivec2& size : {glm::ivec2(1, 1), glm::ivec2(7, 93), glm::ivec2(144, 17)}) {
    for (const int lights : {0, 1, 17, 1000}) {
      for (const FogMode fog : {FogMode::kNone, FogMode::kLinear, FogMode::kExp, FogMode::kExp2}) {
        if (lights == 1000 && (size.x == 144 || fog == FogMode::kExp)) continue;  // to keep the test short
        Camera camera = randomCamera(random);
        camera.orthographic = round % 3 == 1;
        Scene scene = randomScene(camera, lights, random);
        scene.fog = randomFog(fog, random);
        scene.lighting = round % 11 != 5;
        const Model model = kAllModels[round % std::size(kAllModels)];
        const GBuffer gbuffer = randomGBuffer(camera, size.x, size.y, 0.1, random);
        SCOPED_TRACE(testing::Message() << size.x << "x" << size.y << ", " << lights << " lights, fog "
                                        << int(fog) << ", round " << round);
        const Plane color = shadeOn(device, scene, gbuffer, model, Culling::kNone);
        ASSERT_NO_FATAL_FAILURE(expectShaded(scene, gbuffer, model, color, tightness));
        ASSERT_EQ(color, shadeOn(device, scene, gbuffer, model, Culling::kTiles))
            << "culling changes nothing, bit for bit";
        ++round;
      }
    }
  }
  // Bounds are wide for exponents of 10⁶, whose lobe ends within the last bits of a cosine, and at the edges
  // of spots.
  EXPECT_LT(tightness.loose, tightness.values / 50)
      << "of " << tightness.values << ": the bounds judge little";
}

/// A spot whose cone's side passes by a point of the G-buffer, almost.
Light spotPast(const glm::dvec3& point, Random& random) {
  Light light;
  light.kind = LightKind::kSpot;
  const glm::dvec3 way = random.direction(), aside = glm::normalize(glm::cross(way, random.direction()));
  light.position = point + random.between(0.1, 10) * way;
  light.cutoff = random.between(0.001, 1.57);
  const double angle = light.cutoff + 2e-3 * random.between(-1, 1);
  light.direction = -std::cos(angle) * way + std::sin(angle) * aside;
  light.diffuse = random.color(4);
  return light;
}

/// A point light that a point of the G-buffer almost faces, or almost doesn't; its range ends there, almost.
Light grazing(const glm::dvec3& point, const glm::dvec3& normal, Random& random) {
  Light light;
  const glm::dvec3 way = glm::normalize(glm::cross(normal, random.direction()));
  const double distance = random.between(0.1, 10);
  light.position = point + distance * (way + 1e-6 * random.between(-1, 1) * normal);
  light.diffuse = random.color(1e6);
  if (random.chance(0.5)) light.range = float(distance * (1 + 1e-6 * random.between(-1, 1)));
  return light;
}

// Few pixels are covered, so that many lists show one: what bounds a list then leaves nothing to spare.
TEST_P(ShadeKernel, CullingChangesNoBitOfScatteredPixelsAtTheEdgesOfLights) {
  OpenedDevice& device = deviceWithLanes(GetParam());
  Random random(11);
  const Camera camera = randomCamera(random);
  const GBuffer gbuffer = randomGBuffer(camera, 61, 47, 0.93, random);
  const std::size_t n = gbuffer.pixels();
  Scene scene = randomScene(camera, 0, random);
  while (scene.lights.size() < 1000) {
    const std::size_t i = gbuffer.index(random.below(gbuffer.width), random.below(gbuffer.height));
    if (std::isinf(gbuffer.position[i + 2 * n])) continue;
    const auto inWorld = [&](const Plane& plane, double w) {
      return glm::dvec3(camera.camera_to_world * glm::dvec4(plane[i], plane[i + n], plane[i + 2 * n], w));
    };
    const glm::dvec3 point = inWorld(gbuffer.position, 1);
    scene.lights.push_back(random.chance(0.5) ? spotPast(point, random)
                                              : grazing(point, inWorld(gbuffer.normal, 0), random));
  }
  ShadeSettings settings{.culling = Culling::kNone};
  const auto shaded = [&] {
    const FeatureSet features = neededFeatures(scene, camera, {.specular = true, .emission = true}, settings);
    Lighting lighting;
    Stats stats;
    prepareLighting(device, scene, camera, View{}, features, settings, lighting, stats);
    return lightGBuffer(device, scene, lighting, {lighting.lights, features, gbuffer}, stats).color;
  };
  const Plane all = shaded();
  settings.culling = Culling::kTiles;
  for (const int tile_size : {4, 8, 16}) {
    settings.tile_size = tile_size;
    EXPECT_EQ(shaded(), all) << "tiles of " << tile_size;
  }
}

TEST_P(ShadeKernel, PicturesOfOnlyBackground) {
  OpenedDevice& device = deviceWithLanes(GetParam());
  Random random(1);
  const Camera camera = randomCamera(random);
  Scene scene = randomScene(camera, 5, random);
  scene.fog = randomFog(FogMode::kExp, random);
  const GBuffer gbuffer = randomGBuffer(camera, 33, 18, 1, random);
  for (const Culling culling : {Culling::kNone, Culling::kTiles}) {
    const Plane color = shadeOn(device, scene, gbuffer, Model::kPhong, culling);
    for (std::size_t i = 0; i < color.size(); ++i)
      ASSERT_EQ(color[i], scene.background[int(i / gbuffer.pixels())]);
  }
}

TEST_P(ShadeKernel, OnlyFiniteColoursLeave) {
  OpenedDevice& device = deviceWithLanes(GetParam());
  Random random(1);
  const Camera camera;
  GBuffer gbuffer = randomGBuffer(camera, 16, 16, 0, random);
  const std::size_t n = gbuffer.pixels();
  Scene scene = randomScene(camera, 3, random);
  // Lights at a pixel, too bright for a float's range in sum, and too far for a float's square.
  for (Light& light : scene.lights) {
    light.kind = LightKind::kPoint;
    light.diffuse = light.specular = glm::vec3(3e38f);
    light.ambient = glm::vec3(1);
    light.range = std::numeric_limits<float>::infinity();
    light.attenuation = {0, 0, 1};
  }
  scene.lights[0].position = {gbuffer.position[0], gbuffer.position[n], gbuffer.position[2 * n]};
  scene.lights[1].position = {1e30, 0, 0};
  for (int c = 0; c < 3; ++c) gbuffer.normal[5 + c * n] = 0;
  for (const float value : shadeOn(device, scene, gbuffer, Model::kPhong, Culling::kTiles)) {
    ASSERT_TRUE(std::isfinite(value));
    ASSERT_GE(value, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Lanes, ShadeKernel, testing::ValuesIn(kAllLanes), testing::PrintToStringParamName());

}  // namespace
}  // namespace luciole::test
