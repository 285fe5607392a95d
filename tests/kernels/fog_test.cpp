#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <random>

#include "kernels/probe.hpp"
#include "kernels/shared.h"
#include "single_precision.hpp"

namespace luciole::test {
namespace {

struct FogCase {
  uint mode;
  const char* defines;  // a program for just this
};

/// Random colours at random places up to 60 m ahead, and at the eye itself.
std::vector<Column> coloursAndPlaces() {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> share(0, 1);
  std::vector<Column> in(6);
  for (int i = 0; i < 5000; ++i) {
    for (int c = 0; c < 3; ++c) in[c].push_back(4 * share(random));
    in[3].push_back(20 * share(random) - 10);
    in[4].push_back(20 * share(random) - 10);
    in[5].push_back(-60 * share(random));
  }
  for (Column& column : in) column.push_back(0);
  return in;
}

ShadeFrame foggyFrame() {
  ShadeFrame frame{};
  frame.fog_color = {0.5f, 0.25f, 2, 0};
  frame.fog_density = {0.03f, 0.1f, 0, 0};
  const float start = 5, end = 40;
  frame.fog_end = end;
  frame.fog_scale = 1 / (end - start);
  return frame;
}

/// The share that gets through, and how far float may be off.
struct Share {
  double exact, error;
};

// A distance by depth is exact; by radius it has 3 + 6 roundings and 1 of the product.
Share shareOf(const ShadeFrame& frame, double density, double distance) {
  const double distance_error = frame.fog_radial ? 10 * kUnit * distance : 0;
  if (frame.fog_mode == kFogLinear) {
    const double exact = std::clamp((frame.fog_end - distance) * double(frame.fog_scale), 0.0, 1.0);
    // A difference and a product round.
    return {exact, frame.fog_scale * (distance_error + 2 * kUnit * std::abs(frame.fog_end - distance))};
  }
  double depth = density * distance;
  double depth_error = density * distance_error + kUnit * depth;
  if (frame.fog_mode == kFogExp2) {
    depth_error = 2 * depth * depth_error + kUnit * depth * depth;
    depth *= depth;
  }
  const double exact = std::exp(-depth);
  // log2(e) and its product round; the power adds 3, and is 0 below 2^-125.5.
  return {exact, exact * (depth_error + 2 * kUnit * depth + 3 * kUnit) + 0x1p-125};
}

void expectFog(const ShadeFrame& frame, const char* defines) {
  const std::vector<Column> in = coloursAndPlaces();
  const float color_of_fog[3] = {frame.fog_color.x, frame.fog_color.y, frame.fog_color.z};
  const float density[3] = {frame.fog_density.x, frame.fog_density.y, frame.fog_density.z};
  for (const int lanes : lanesFor(defines)) {
    OpenedDevice& device = deviceWithLanes(lanes);
    const auto out = probe(device, "fog_probe.cl", "probe_fog", in, 3, {{"frame", frame}}, defines);
    for (std::size_t i = 0; i < in[0].size(); ++i) {
      const double distance =
          frame.fog_radial ? glm::length(glm::dvec3(in[3][i], in[4][i], in[5][i])) : -double(in[5][i]);
      for (int c = 0; c < 3; ++c) {
        const Share share = shareOf(frame, density[c], distance);
        const double exact = share.exact * in[c][i] + (1 - share.exact) * color_of_fog[c];
        // 1 − share, two products and a sum of positive terms round.
        const double error = (in[c][i] + color_of_fog[c]) * (share.error + 3 * kUnit);
        ASSERT_NEAR(out[c][i], exact, error)
            << "channel " << c << " at " << distance << " m, " << lanes << " lanes";
      }
    }
  }
}

TEST(FogKernels, EachModeAloneAndChosenAtRunTime) {
  const FogCase cases[] = {{kFogLinear, "-DFEATURES=ALL_FEATURES-FEATURE(FOG_EXP)-FEATURE(FOG_EXP2)"},
                           {kFogExp, "-DFEATURES=ALL_FEATURES-FEATURE(FOG_LINEAR)-FEATURE(FOG_EXP2)"},
                           {kFogExp2, "-DFEATURES=ALL_FEATURES-FEATURE(FOG_LINEAR)-FEATURE(FOG_EXP)"}};
  for (const FogCase& fog : cases) {
    for (const uint radial : {0u, 1u}) {
      ShadeFrame frame = foggyFrame();
      frame.fog_mode = fog.mode;
      frame.fog_radial = radial;
      expectFog(frame, "");
      expectFog(frame, fog.defines);
    }
  }
}

TEST(FogKernels, OneDensityServesAllChannels) {
  ShadeFrame frame = foggyFrame();
  frame.fog_density = {0.05f, 0.05f, 0.05f, 0};
  frame.fog_mode = kFogExp;
  expectFog(frame,
            "-DFEATURES=ALL_FEATURES-FEATURE(FOG_PER_CHANNEL)-FEATURE(FOG_RADIAL)-FEATURE(FOG_LINEAR)-"
            "FEATURE(FOG_EXP2)");
}

TEST(FogKernels, OutsideTheFogColoursStayAsTheyAre) {
  const std::vector<Column> in = coloursAndPlaces();
  const std::vector<Column> colors(in.begin(), in.begin() + 3);
  ShadeFrame none = foggyFrame(), before = foggyFrame(), thin = foggyFrame();
  none.fog_mode = kNoFog;
  before.fog_mode = kFogLinear;
  before.fog_end = 200;  // begins at 165 m
  thin.fog_mode = kFogExp2;
  thin.fog_density = {0, 0, 0, 0};
  for (const int lanes : kAllLanes) {
    OpenedDevice& device = deviceWithLanes(lanes);
    for (const ShadeFrame& frame : {none, before, thin}) {
      EXPECT_EQ(probe(device, "fog_probe.cl", "probe_fog", in, 3, {{"frame", frame}}), colors)
          << frame.fog_mode;
    }
  }
}

TEST(FogKernels, BeyondTheFogNothingIsLeft) {
  std::vector<Column> in = coloursAndPlaces();
  for (float& z : in[5]) z = -3000;
  ShadeFrame frame = foggyFrame();
  frame.fog_density = {1, 1, 1, 0};
  for (const uint mode : {kFogLinear, kFogExp, kFogExp2}) {
    frame.fog_mode = mode;
    for (const int lanes : kAllLanes) {
      OpenedDevice& device = deviceWithLanes(lanes);
      const auto out = probe(device, "fog_probe.cl", "probe_fog", in, 3, {{"frame", frame}});
      EXPECT_EQ(out[0], Column(in[0].size(), frame.fog_color.x)) << mode;
      EXPECT_EQ(out[2], Column(in[0].size(), frame.fog_color.z)) << mode;
    }
  }
}

}  // namespace
}  // namespace luciole::test
