// --light-error's promise, with ten thousand lights at every pixel of the shipped scenes: a picture is within
// its bound of the sum of all lights in double precision, and the bound within what was allowed.
#include "pictures/light_certificate.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "long_run.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

class LightCertificate : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenes, LightCertificate, testing::ValuesIn(kCertifiedScenes),
                         [](const auto& test) { return std::string(test.param); });

void expectCertified(const std::string& name, Model model, bool highlights, std::size_t lights,
                     glm::ivec2 size) {
  Scene scene = loadScene(fmt::format("{}/scenes/{}.json", LUCIOLE_SOURCE_DIR, name));
  for (const auto& [placement, shape] : kCertifiedPlacements) {
    lightWithoutRange(scene, shape, lights, highlights);
    const TrueLight truth = trueLight(scene, size, std::size_t(-1), model);
    ASSERT_GT(truth.pixels.size(), std::size_t(size.x * size.y / 2));
    for (const float light_error : kCertifiedErrors) {
      SCOPED_TRACE(fmt::format("{}, E = {}", placement, light_error));
      const CertificateCheck check = checkCertificate(testDevice(), truth, light_error);
      EXPECT_EQ(countOf(check.stats, "lights_stood_for"), lights);
      EXPECT_EQ(check.broken, 0u) << "error / bound " << check.worst << " at " << check.worst_pixel.x << ", "
                                  << check.worst_pixel.y;
      EXPECT_EQ(check.unmet, 0u) << "bound / allowed " << check.largest_bound;
      EXPECT_GT(check.largest_error, 0.01) << "the picture is as good as exact: nothing was tested";
    }
  }
}

TEST_P(LightCertificate, HoldsAtEveryPixelForEachPlacementAndError) {
  const glm::ivec2 size = longRun() ? glm::ivec2(96, 54) : glm::ivec2(56, 32);
  ASSERT_NO_FATAL_FAILURE(expectCertified(GetParam(), Model::kPhong, false, 10'000, size));
}

/// The scenes with shiny surfaces.
class HighlightCertificate : public testing::TestWithParam<std::pair<const char*, Model>> {};
INSTANTIATE_TEST_SUITE_P(
    Scenes, HighlightCertificate,
    testing::Values(std::pair("fireflies", Model::kPhong), std::pair("underwater", Model::kPhong),
                    std::pair("colonnade", Model::kPhong), std::pair("city", Model::kPhong),
                    std::pair("spheres", Model::kPhong), std::pair("city", Model::kBlinnPhong),
                    std::pair("spheres", Model::kBlinnPhong)),
    [](const auto& test) {
      return std::string(test.param.first) + (test.param.second == Model::kPhong ? "Phong" : "Blinn");
    });

TEST_P(HighlightCertificate, HoldsAtEveryPixelForEachPlacementAndError) {
  const auto& [scene, model] = GetParam();
  const glm::ivec2 size = longRun() ? glm::ivec2(48, 27) : glm::ivec2(32, 18);
  ASSERT_NO_FATAL_FAILURE(expectCertified(scene, model, true, 10'000, size));
}

}  // namespace
}  // namespace luciole::test
