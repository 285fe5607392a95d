#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render_json.hpp"

// The penumbra of a straight edge over a plane, which geometry knows.
namespace luciole::test {
namespace {

/// Share of a disc of radius 1 where u > edge.
double discBeyond(double edge) {
  const double c = std::clamp(edge, -1.0, 1.0);
  return (std::acos(c) - c * std::sqrt(1 - c * c)) / std::numbers::pi;
}

struct Edge {
  const char* name;
  const char* light;
  /// The roof's edge, seen from the point x metres beside it on the plane, cuts the light's disc at −x / blur
  /// of its radius.
  double blur;
};

class SoftEdge : public testing::TestWithParam<Edge> {};

/// `tilt`: degrees that the ground leans along the edge, which changes heights by less than 1 % where it
/// counts, but makes a normal that packing rounds.
void expectTruePenumbra(const Edge& edge, double tilt) {
  // A roof over x < 0 at height 1, without thickness; what is under it can be seen from the side.
  const std::string json = fmt::format(R"({{
    "camera": {{"eye": [0.2, 0.7, 2], "target": [0, 0, 0], "fov_y": 30}},
    "materials": {{"m": {{"double_sided": true}}}},
    "objects": [{{"primitive": "plane", "scale": 12, "rotate": [{}, 0, 0]}},
                {{"primitive": "plane", "scale": [6, 1, 12], "translate": [-3, 1, 0], "material": "m"}}],
    "lights": [{}]}})",
                                       tilt, edge.light);
  const Image image = renderJson(json, {320, 180}, [](RenderSettings& settings) {
    settings.shade.shadows = ShadowMethod::kSoft;
    settings.aovs = {Aov::kShadow, Aov::kPosition, Aov::kDepth};
  });
  const std::size_t channels = image.channels.size(), shadow = channelIndex(image, "shadow"),
                    place = channelIndex(image, "P.X"), depth = channelIndex(image, "Z");
  // v (1 − v) summed over the pixels is proportional to the penumbra's width, and the same for both.
  double width = 0, true_width = 0, difference = 0;
  int pixels = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += channels) {
    const float* pixel = image.pixels.data() + i;
    if (!std::isfinite(pixel[depth]) || std::abs(pixel[place + 1]) > 0.01f || std::abs(pixel[place]) > 1 ||
        std::abs(pixel[place + 2]) > 0.5f)
      continue;
    const double seen = pixel[shadow], truth = discBeyond(-pixel[place] / edge.blur);
    width += seen * (1 - seen);
    true_width += truth * (1 - truth);
    difference += std::abs(seen - truth);
    ++pixels;
  }
  ASSERT_GT(pixels, 2000);
  fmt::print("{}: width {:.3f} of the true one, mean difference {:.4f}\n", edge.name, width / true_width,
             difference / pixels);
  EXPECT_NEAR(width / true_width, 1, 0.15);  // what the project promises
  EXPECT_LT(difference / pixels, 0.03);      // half of what a sharp edge in the right place would give
}

TEST_P(SoftEdge, PenumbraIsAsWideAsTheLightMakesIt) { expectTruePenumbra(GetParam(), 0); }

TEST_P(SoftEdge, PenumbraOnGroundThatLeansALittleIsToo) { expectTruePenumbra(GetParam(), 0.7); }

INSTANTIATE_TEST_SUITE_P(
    Lights, SoftEdge,
    testing::Values(
        // From height 3 the edge at height 1 cuts the disc at 2 x beside its middle.
        Edge{"Point",
             R"({"type": "point", "position": [0, 3, 0], "radius": 0.3, "range": 20, "shadow": true})", 0.15},
        Edge{
            "Spot",
            R"({"type": "spot", "position": [0, 3, 0], "target": [0, 0, 0], "cutoff": 40, "radius": 0.2, "shadow": true})",
            0.1},
        Edge{"Sun", R"({"type": "directional", "direction": [0, -1, 0], "angle": 10, "shadow": true})",
             std::tan(5 * std::numbers::pi / 180)}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace luciole::test
