// Where light grazes a smooth mesh of few facets (the shadow terminator), in
// whole pictures.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rays/shadow_rays.hpp"
#include "reference/reference_picture.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

constexpr glm::ivec2 kBallSize(160, 120);

/// Cosine of the angle to the light below which nothing is promised: a shadow
/// map takes no plane for steeper (LEAST_COSINE in kernels/maps/shadow.clh), and by
/// rays what rounding moves, 2⁻¹⁸ of 6 m, is less than that over the 0.02 m
/// that a pixel shows.
constexpr double kGrazing = 0.002;

constexpr const char* kLowSun = R"({"type": "directional", "direction": [-1, -0.4, 0.1], "shadow": true})";
constexpr const char* kNearLamp = R"({"type": "point", "position": [2.5, 1.5, -0.4], "shadow": true})";
constexpr double kLampDistance = 2.94;  // from the ball's middle

/// A ball of 16 segments and radius 1 in front of the camera.
std::string ballScene(const std::string& light, const std::string& placed = R"("primitive": "sphere")") {
  return fmt::format(
      R"({{"camera": {{"eye": [0, 0.5, 6], "target": [0, 0, 0], "fov_y": 25, "near": 0.1, "far": 50}},
      "materials": {{"m": {{"diffuse": 0.8, "double_sided": true}}}},
      "objects": [{{{}, "segments": 16, "material": "m"}}], "lights": [{}]}})",
      placed, light);
}

/// The ball's start points lie above its facets by no more than this. Its
/// longest chord is a quad's diagonal; with c its length a point of a facet
/// lies at a distance of √(1 − c²/3) or more from the middle (see
/// ClosedForm.SphereFadesWithItsRadiusSquared), and starts no farther out than
/// 1 + (1 − |n|)²/2|n|.
double highestStart() {
  const double side = 2 * std::sin(std::numbers::pi / 16), c2 = 2 * side * side;
  const double least = std::sqrt(1 - c2 / 3);
  return (1 - least * least) / (2 * least);
}

/// The smallest cosine, of the angle between the shading normal and the way to
/// the light, from which on the light is seen: a lamp lies above the tangent
/// plane at the start point only if it is as far above the facet.
double leastCosine(bool lamp) { return lamp ? kGrazing + highestStart() / (kLampDistance - 1) : kGrazing; }

glm::dvec3 wayToLight(const Light& light, const glm::dvec3& point) {
  return glm::normalize(light.kind == LightKind::kDirectional ? -light.direction : light.position - point);
}

struct Terminator {
  int facing = 0, grazing = 0;  ///< pixels that the light is to reach; of those
                                ///< that it does at a low angle
  int dark = 0;                 ///< of the former, that are darker than without shadows
};

Terminator compareWithUnshadowed(const Scene& scene, const Image& shadowed, const Image& plain, bool lamp) {
  Terminator found;
  const std::size_t channels = plain.channels.size(), at = channelIndex(plain, "P.X"),
                    facing = channelIndex(plain, "N.X");
  for (std::size_t i = 0; i < plain.pixels.size(); i += channels) {
    const float* pixel = plain.pixels.data() + i;
    const glm::dvec3 position(pixel[at], pixel[at + 1], pixel[at + 2]);
    const glm::dvec3 normal(pixel[facing], pixel[facing + 1], pixel[facing + 2]);
    if (normal == glm::dvec3(0)) continue;
    const double cosine = glm::dot(normal, wayToLight(scene.lights.front(), position));
    if (cosine < leastCosine(lamp)) continue;
    ++found.facing;
    found.grazing += cosine < leastCosine(lamp) + 0.2;
    // The texels' weights add up to 1 within some roundings.
    found.dark += shadowed.pixels[i] < pixel[0] * (1 - 0x1p-20f);
  }
  return found;
}

RenderSettings ballSettings(const Scene& scene, ShadowMethod method) {
  RenderSettings settings;
  settings.size = kBallSize;
  settings.camera = scene.cameras.front();
  settings.shade.shadows = method;
  settings.aovs = {Aov::kPosition, Aov::kNormal};
  return settings;
}

void expectSmooth(const std::string& json, ShadowMethod method, bool lamp) {
  const Scene scene = sceneFromJson(json);
  const Image plain = picture(scene, ballSettings(scene, ShadowMethod::kOff));
  const Image shadowed = picture(scene, ballSettings(scene, method));
  const Terminator found = compareWithUnshadowed(scene, shadowed, plain, lamp);
  EXPECT_GT(found.facing, 1000);
  EXPECT_GT(found.grazing, 300) << "the terminator is in sight";
  EXPECT_EQ(found.dark, 0) << "of " << found.facing;
}

class TerminatorOf : public testing::TestWithParam<ShadowMethod> {};

TEST_P(TerminatorOf, ABallOfSixteenSegmentsIsSmoothInTheSun) {
  expectSmooth(ballScene(kLowSun), GetParam(), false);
}

TEST_P(TerminatorOf, ABallOfSixteenSegmentsIsSmoothByALamp) {
  expectSmooth(ballScene(kNearLamp), GetParam(), true);
}

// The ball touches the walls from within, and start points beyond them would be
// lit from outside. Maps leak there by their texels' size, so only what is exact can tell.
TEST(TerminatorExact, NoLightLeaksThroughAThinWallThatABallTouches) {
  for (const char* light : {R"({"type": "point", "position": [4, 0.3, 0.2], "shadow": true})",
                            R"({"type": "directional", "direction": [0.1, 1, -0.1], "shadow": true})"}) {
    SCOPED_TRACE(light);
    const Scene scene = sceneFromJson(fmt::format(
        R"({{"camera": {{"eye": [0.95, 0.9, 0.92], "target": [0, 0, 0], "fov_y": 60, "near": 0.01, "far": 50}},
            "materials": {{"m": {{"diffuse": 0.8, "double_sided": true}}}},
            "objects": [{{"primitive": "sphere", "segments": 16, "material": "m"}},
                        {{"primitive": "box", "scale": 2, "material": "m"}}], "lights": [{}]}})",
        light));
    RenderSettings settings = ballSettings(scene, ShadowMethod::kOff);
    const auto lit = [&] {
      const Image image = picture(scene, settings);
      int count = 0;
      for (std::size_t i = 0; i < image.pixels.size(); i += image.channels.size())
        count += image.pixels[i] > 0;
      return count;
    };
    EXPECT_GT(lit(), 500) << "without shadows";
    settings.shade.shadows = ShadowMethod::kExact;
    EXPECT_EQ(lit(), 0);
  }
}

// A G-buffer whose facets aren't smooth says so by a lift of 0, or by none.
TEST_P(TerminatorOf, FlatShadingHasTheBitsThatItHasWithoutLifts) {
  const Scene scene = sceneFromJson(ballScene(fmt::format("{}, {}", kLowSun, kNearLamp)));
  RenderSettings settings = ballSettings(scene, GetParam());
  settings.aovs = {Aov::kShadow};
  settings.shading = Shading::kFlat;
  Stats stats;
  GBuffer gbuffer = rasterizeScene(nullptr, scene, settings, stats);
  EXPECT_TRUE(gbuffer.lift.empty());
  const Image rendered = picture(scene, settings);
  EXPECT_EQ(shadeGBuffer(testDevice(), scene, gbuffer, settings, stats).pixels, rendered.pixels);
  gbuffer.lift.assign(gbuffer.pixels(), 0.0f);
  EXPECT_EQ(shadeGBuffer(testDevice(), scene, gbuffer, settings, stats).pixels, rendered.pixels);
}

// The shading normals are the ellipsoid's, which a mirror and scales make of
// the ball.
TEST_P(TerminatorOf, AMirroredEllipsoidIsSmooth) {
  expectSmooth(
      ballScene(kLowSun, R"("primitive": "sphere", "scale": [-0.6, 1.1, 1.4], "rotate": [20, 50, 0])"),
      GetParam(), false);
}

TEST_P(TerminatorOf, FlatFacetsHaveTheirOwnShadows) {
  // A facet that faces away from the light is dark, and its own normal says so.
  const Scene scene = sceneFromJson(ballScene(kLowSun));
  RenderSettings settings = ballSettings(scene, ShadowMethod::kOff);
  settings.shading = Shading::kFlat;
  const Image plain = picture(scene, settings);
  settings.shade.shadows = GetParam();
  const Terminator found = compareWithUnshadowed(scene, picture(scene, settings), plain, false);
  EXPECT_GT(found.facing, 2000);
  EXPECT_EQ(found.dark, 0);
}

INSTANTIATE_TEST_SUITE_P(All, TerminatorOf,
                         testing::Values(ShadowMethod::kHard, ShadowMethod::kPcf, ShadowMethod::kSoft,
                                         ShadowMethod::kExact, ShadowMethod::kSoftExact),
                         shadowMethodName);

TEST(TerminatorByRays, ReferenceIsSmooth) {
  for (const bool lamp : {false, true}) {
    SCOPED_TRACE(lamp ? "lamp" : "sun");
    const Scene scene = sceneFromJson(ballScene(lamp ? kNearLamp : kLowSun));
    const RenderSettings settings = ballSettings(scene, ShadowMethod::kOff);
    const Image plain = picture(scene, settings);
    const View view = cameraView(settings.camera, kBallSize);
    const RayScene rays = buildShadowRays(scene, glm::dvec3(settings.camera.camera_to_world[3]));
    const std::vector<glm::ivec2> pixels = allPixels(kBallSize);
    const auto clear = referencePicture(scene, view, Shading::kPhong, 1, pixels, {});
    const auto shadowed = referencePicture(scene, view, Shading::kPhong, 1, pixels, {.shadow_rays = &rays});
    const std::size_t channels = plain.channels.size();
    Image by_rays = plain, without = plain;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      by_rays.pixels[i * channels] = float(shadowed[i].x);
      without.pixels[i * channels] = float(clear[i].x);
    }
    EXPECT_EQ(compareWithUnshadowed(scene, by_rays, without, lamp).dark, 0);
  }
}

}  // namespace
}  // namespace luciole::test
