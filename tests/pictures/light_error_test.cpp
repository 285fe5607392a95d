// Scenes that are hard on --light-error, against sums of all lights in double precision.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "kernels/random_scene.hpp"
#include "pictures/light_certificate.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

/// A floor, a ball and 3000 lights that reach everywhere. `changes`: further keys of the scene; move: of
/// everything, metres.
std::string scene(const std::string& camera = R"("fov_y": 60)", const std::string& changes = "",
                  const std::string& material = R"("diffuse": [0.6, 0.5, 0.4])", double move = 0) {
  return fmt::format(
      R"({{"camera": {{"eye": [{0}, 2, 5], "target": [{1}, 0.5, 0], {2}}}, {3}
    "materials": {{"m": {{{4}}}}},
    "objects": [{{"primitive": "plane", "scale": 8, "translate": [{1}, 0, 0], "material": "m"}},
                {{"primitive": "sphere", "translate": [{1}, 1, 0], "material": "m"}}],
    "light_fields": [{{"count": 3000, "min": [{5}, 0.1, -4], "max": [{6}, 3, 4], "no_range": true}}]}})",
      move + 3, move, camera, changes, material, move - 4, move + 4);
}

/// Lights whose specular part nothing reflects, so that clusters may stand for them on all surfaces.
void expectCertified(Scene scene, glm::ivec2 size = {40, 30}, bool met = true) {
  for (Light& light : scene.lights) light.specular = glm::vec3(0.0f);
  const TrueLight truth = trueLight(scene, size, std::size_t(-1));
  ASSERT_GT(truth.pixels.size(), 0u);
  // Of less than 1/2048 floats know nothing where a bright light grazes a surface.
  for (const float light_error : {1.0f, 1.0f / 16, 1.0f / 256, 1.0f / 2048}) {
    SCOPED_TRACE(fmt::format("E = {}", light_error));
    const CertificateCheck check = checkCertificate(testDevice(), truth, light_error);
    EXPECT_GE(countOf(check.stats, "lights_stood_for"), 2000u);
    EXPECT_EQ(check.broken, 0u) << "error / bound " << check.worst << " at " << check.worst_pixel.x << ", "
                                << check.worst_pixel.y;
    if (met) {
      EXPECT_EQ(check.unmet, 0u) << "bound / allowed " << check.largest_bound;
    }
  }
}

TEST(HardLightError, OfAParallelView) { expectCertified(sceneFromJson(scene(R"("orthographic": 3)"))); }

TEST(HardLightError, OfOnePixel) { expectCertified(sceneFromJson(scene()), {1, 1}); }

// Lights and camera are known in double precision, and pixels relative to the camera.
TEST(HardLightError, TenMillionMetresFromTheOrigin) {
  for (const double move : {1e7, -1e7})
    expectCertified(sceneFromJson(scene(R"("fov_y": 60)", "", R"("diffuse": 0.5)", move)));
}

TEST(HardLightError, OfIntensitiesFortyOrdersApartAndColorsWithoutAChannel) {
  Scene lit = sceneFromJson(scene());
  Random random(1);
  for (Light& light : lit.lights) {
    light.diffuse = glm::vec3(std::pow(10.0, random.between(-20, 20)));
    light.diffuse[random.below(3)] = 0;
  }
  expectCertified(lit);
  for (Light& light : lit.lights) light.diffuse *= glm::vec3(1, 0, 1e-20f);
  expectCertified(lit);
}

// Lights at pixels' very places and down to a picometre away, where a cosine is rounding alone, so that of
// their light no more may be known than 1/d². The camera's axes are the world's, so places are the same in
// both.
TEST(HardLightError, OfLightsAtPixelsAndHardlyOffThem) {
  Scene lit = sceneFromJson(R"({"camera": {"eye": [0, 0, 0], "target": [0, 0, -1]},
    "objects": [{"primitive": "plane", "scale": 9, "rotate": [60, 0, 0], "translate": [0, -1, -5]}],
    "light_fields": [{"count": 3000, "min": [0, 0, 0], "max": [1, 1, 1], "attenuation": [0, 0, 1]}]})");
  const TrueLight seen = trueLight(lit, {40, 30}, 700);
  const std::size_t n = seen.gbuffer.pixels();
  Random random(3);
  for (std::size_t i = 0; i < lit.lights.size(); ++i) {
    const glm::ivec2 pixel = seen.pixels[i % seen.pixels.size()];
    const float* place = seen.gbuffer.position.data() + seen.gbuffer.index(pixel.x, pixel.y);
    const double distance = i % 4 == 0 ? 0 : std::pow(10.0, random.between(-12, 0));
    lit.lights[i].position = glm::dvec3(place[0], place[n], place[2 * n]) + distance * random.direction();
    lit.lights[i].diffuse = 1e-3f * glm::vec3(random.color());
  }
  expectCertified(lit, {40, 30}, false);
}

// All lights within a centimetre, inside the sphere around a group of pixels.
TEST(HardLightError, OfLightsAmidAGroupOfPixels) {
  Scene lit = sceneFromJson(scene());
  Random random(2);
  for (Light& light : lit.lights) {
    light.position = glm::dvec3(1.5, 0.02, 2) + random.between(0, 0.01) * random.direction();
    light.diffuse *= 1e-3f;
  }
  expectCertified(lit);
}

// What glows, and what ambient light there is, is rounded with the light of clusters.
TEST(HardLightError, OfLightBesideMuchBrighterEmission) {
  for (const char* glow :
       {R"("diffuse": 0.5, "emission": [1000, 0.3, 0])", R"("diffuse": 0.5, "ambient": [1000, 3, 0.7])"})
    expectCertified(sceneFromJson(scene(R"("fov_y": 60)", R"("ambient": [0.7, 0.3, 0.1],)", glow)));
}

// The share of thin fog rounds by more than the little that is seen of it.
TEST(HardLightError, OfBlackSurfacesInThinFog) {
  for (const char* fog :
       {R"("mode": "exp", "density": [0.003, 1e-5, 0.0007])",
        R"("mode": "exp2", "density": [0.01, 1e-4, 0.003])", R"("mode": "linear", "start": 0, "end": 3000)"})
    for (const char* distance : {"depth", "radial"})
      expectCertified(sceneFromJson(
          scene(R"("fov_y": 60)",
                fmt::format(R"("fog": {{{}, "distance": "{}", "color": [3, 2, 1]}},)", fog, distance),
                R"("diffuse": 0, "ambient": 0)")));
}

// Nor is a thick fog's share, whose exponent is large, known as well as a colour that has three roundings.
// Fog within a centimetre multiplies what a distance rounds by more than E allows.
TEST(HardLightError, OfBrightSurfacesInThickFog) {
  struct {
    const char* fog;
    bool met;
  } const fogs[] = {{R"("mode": "exp", "density": [2, 0.7, 0.1])", true},
                    {R"("mode": "exp2", "density": [0.4, 0.3, 0.1])", true},
                    {R"("mode": "linear", "start": 3, "end": 6)", true},
                    {R"("mode": "linear", "start": 4.9, "end": 4.91)", false}};
  for (const auto& [fog, met] : fogs)
    for (const char* distance : {"depth", "radial"})
      expectCertified(sceneFromJson(scene(
                          R"("fov_y": 60)",
                          fmt::format(R"("fog": {{{}, "distance": "{}", "color": 0.01}},)", fog, distance),
                          R"("diffuse": 0.2, "emission": [9, 2, 0.1])")),
                      {40, 30}, met);
}

}  // namespace
}  // namespace luciole::test
