// --light-error's promise, with ten thousand lights at every pixel of the shipped scenes: a picture is within
// its bound of the sum of all lights in double precision, and the bound within what was allowed.
#include "render/light_certificate.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "render_json.hpp"

namespace luciole::test {
namespace {

class LightCertificate : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenes, LightCertificate, testing::ValuesIn(kCertifiedScenes),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(LightCertificate, HoldsAtEveryPixelForEachPlacementAndError) {
  constexpr std::size_t kLights = 10'000;
  constexpr glm::ivec2 kSize(96, 54);
  Scene scene = loadScene(fmt::format("{}/scenes/{}.json", LUCIOLE_SOURCE_DIR, GetParam()));
  for (const auto& [placement, shape] : kCertifiedPlacements) {
    lightWithoutRange(scene, shape, kLights, false);
    const TrueLight truth = trueLight(scene, kSize, std::size_t(-1));
    ASSERT_GT(truth.pixels.size(), std::size_t(kSize.x * kSize.y / 2));
    for (const float light_error : kCertifiedErrors) {
      SCOPED_TRACE(fmt::format("{}, E = {}", placement, light_error));
      const CertificateCheck check = checkCertificate(testDevice(), truth, light_error);
      EXPECT_EQ(countOf(check.stats, "lights_stood_for"), kLights);
      EXPECT_EQ(check.broken, 0u) << "error / bound " << check.worst << " at " << check.worst_pixel.x << ", "
                                  << check.worst_pixel.y;
      EXPECT_EQ(check.unmet, 0u) << "bound / allowed " << check.largest_bound;
      EXPECT_GT(check.largest_error, 0.01) << "the picture is as good as exact: nothing was tested";
    }
  }
}

}  // namespace
}  // namespace luciole::test
