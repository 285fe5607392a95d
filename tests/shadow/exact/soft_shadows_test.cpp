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
struct Penumbra {
  double width;       ///< as a share of the true one
  double difference;  ///< mean of |seen − true|
  double brighter;    ///< mean of seen − true
  int pixels;
};
Penumbra penumbraOf(const Edge& edge, double tilt, ShadowMethod method, int samples = 16) {
  // A roof over x < 0 at height 1, without thickness; what is under it can be seen from the side.
  const std::string json = fmt::format(R"({{
    "camera": {{"eye": [0.2, 0.7, 2], "target": [0, 0, 0], "fov_y": 30}},
    "materials": {{"m": {{"double_sided": true}}}},
    "objects": [{{"primitive": "plane", "scale": 12, "rotate": [{}, 0, 0]}},
                {{"primitive": "plane", "scale": [6, 1, 12], "translate": [-3, 1, 0], "material": "m"}}],
    "lights": [{}]}})",
                                       tilt, edge.light);
  const Image image = renderJson(json, {320, 180}, [&](RenderSettings& settings) {
    settings.shade.shadows = method;
    settings.shade.soft_samples = samples;
    settings.aovs = {Aov::kShadow, Aov::kPosition, Aov::kDepth};
  });
  const std::size_t channels = image.channels.size(), shadow = channelIndex(image, "shadow"),
                    place = channelIndex(image, "P.X"), depth = channelIndex(image, "Z");
  // v (1 − v) summed over the pixels is proportional to the penumbra's width, and the same for both.
  double width = 0, true_width = 0, difference = 0, brighter = 0;
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
    brighter += seen - truth;
    ++pixels;
  }
  fmt::print("{}: width {:.3f} of the true one, mean difference {:.4f}, brighter by {:.5f}\n", edge.name,
             width / true_width, difference / pixels, brighter / pixels);
  return {width / true_width, difference / pixels, brighter / pixels, pixels};
}

void expectTruePenumbra(const Edge& edge, double tilt) {
  const Penumbra penumbra = penumbraOf(edge, tilt, ShadowMethod::kSoft);
  ASSERT_GT(penumbra.pixels, 2000);
  EXPECT_NEAR(penumbra.width, 1, 0.15);  // what the project promises
  EXPECT_LT(penumbra.difference, 0.03);  // half of what a sharp edge in the right place would give
}

TEST_P(SoftEdge, PenumbraIsAsWideAsTheLightMakesIt) { expectTruePenumbra(GetParam(), 0); }

TEST_P(SoftEdge, PenumbraOnGroundThatLeansALittleIsToo) { expectTruePenumbra(GetParam(), 0.7); }

// What a pattern says of a share is off by the squares of its net that the edge cuts, of √N × √N, in each of
// which the one sample may be on the wrong side: an edge is two pieces that rise or fall alone, of 2·√N − 1
// squares each, over N. Pixels have patterns of their own, which together fill the light: the mean over them
// is 0 but for chance, with a standard deviation of at most half of 1/√pixels for one sample each. The closed
// form itself is for a disc: a sphere seen from 3 m is one but for (radius/3)²/2, its middle for the sun's 5
// degrees is off by their tangent's third order, below 1/400 of the width.
TEST_P(SoftEdge, ExactPenumbraIsTheTrueOneButForTheSamples) {
  const Penumbra one = penumbraOf(GetParam(), 0, ShadowMethod::kSoftExact, 1);
  ASSERT_GT(one.pixels, 2000);
  EXPECT_EQ(one.width, 0) << "each pixel sees its sample or doesn't";
  EXPECT_NEAR(one.brighter, 0, 4 * 0.5 / std::sqrt(one.pixels) + 0.0025);
  for (const int samples : {16, 256, 1024}) {
    const Penumbra many = penumbraOf(GetParam(), 0, ShadowMethod::kSoftExact, samples);
    EXPECT_LT(many.difference, 2 * (2 * std::sqrt(samples) - 1) / samples + 0.0025);
    EXPECT_NEAR(many.brighter, 0, 4 * 0.5 / std::sqrt(one.pixels) + 0.0025);
  }
}

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
