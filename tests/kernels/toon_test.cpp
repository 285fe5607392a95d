#include <gtest/gtest.h>

#include "kernels/probe.hpp"
#include "reference/models.hpp"

namespace luciole::test {
namespace {

Column manyCosines() {
  Column cosines;
  for (int i = -1000; i <= 1000; ++i) cosines.push_back(float(i) / 1000);
  return cosines;
}

TEST(ToonKernels, TonesAreTheReferencesAtEveryWidth) {
  const Column cosines = manyCosines();
  for (const int lanes : kAllLanes) {
    const Column tones = probe(deviceWithLanes(lanes), "toon_probe.cl", "probe_toon", {cosines}, 2)[0];
    for (std::size_t i = 0; i < tones.size(); ++i)
      // On a ramp x - edge is exact (P. Sterbenz), and so is 32 times it. What rounds is its height's product
      // and two sums, none above 1.
      EXPECT_NEAR(tones[i], toonTone(cosines[i]), 3 * 0x1p-24) << cosines[i] << ", " << lanes << " lanes";
  }
}

TEST(ToonKernels, HighlightsAreExactlyTheRamp) {
  const Column lobes = manyCosines();
  for (const int lanes : kAllLanes) {
    const Column lit = probe(deviceWithLanes(lanes), "toon_probe.cl", "probe_toon", {lobes}, 2)[1];
    for (std::size_t i = 0; i < lit.size(); ++i)
      EXPECT_EQ(lit[i], toonHighlight(lobes[i])) << lobes[i] << ", " << lanes << " lanes";
  }
}

// Culling leaves out lights that a surface faces away from.
TEST(ToonKernels, WhatFacesAwayIsExactlyBlack) {
  const Column away{-1, -0.5f, -1e-30f, -0.0f, 0};
  for (const int lanes : kAllLanes)
    EXPECT_EQ(probe(deviceWithLanes(lanes), "toon_probe.cl", "probe_toon", {away}, 2)[0], Column(5, 0.0f));
}

}  // namespace
}  // namespace luciole::test
