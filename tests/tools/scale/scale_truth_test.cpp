#include "tools/scale/scale_truth.hpp"

#include <gtest/gtest.h>

namespace luciole::test {
namespace {

std::string truthOf(const std::vector<std::pair<std::string, std::string>>& choices) {
  ScaleDescription description;
  ScalePoint point;
  for (const auto& [axis, value] : choices) {
    description.axes.push_back({axis, {value}});
    point.values.push_back(value);
  }
  return truthName(description, point);
}

TEST(ScaleTruth, ShadowsByAnyMethodHaveOneAndNoShadowsAnother) {
  for (const char* method : {"hard", "pcf", "soft", "exact"})
    EXPECT_EQ(truthOf({{"shadows", method}}), "shadows by rays") << method;
  EXPECT_EQ(truthOf({{"shadows", "off"}}), "no shadows");
}

TEST(ScaleTruth, WaysToMakeThePictureDoNotChangeIt) {
  for (const char* axis : {"culling", "tile", "samples", "pcf-width", "shadow-memory", "shadow-size",
                           "light-error", "confidence"})
    EXPECT_EQ(truthOf({{axis, "4"}}), "") << axis;
  EXPECT_EQ(
      truthOf({{"culling", "none"}, {"shadows", "pcf"}, {"pcf-width", "6"}, {"shadow-size", "512"}}),
      truthOf({{"culling", "tiles"}, {"shadows", "exact"}, {"pcf-width", "2"}, {"shadow-size", "2048"}}));
}

TEST(ScaleTruth, WhatChangesThePictureIsNamedWithItsValue) {
  for (const char* axis :
       {"model", "shading", "field", "density", "range", "cutoff", "no-range", "intensity"}) {
    EXPECT_EQ(truthOf({{axis, "a"}}), std::string(axis) + " a");
    EXPECT_NE(truthOf({{axis, "a"}}), truthOf({{axis, "b"}}));
  }
  EXPECT_EQ(truthOf({{"shadows", "hard"}, {"tile", "4"}, {"model", "toon"}}), "shadows by rays, model toon");
}

TEST(ScaleTruth, AnOptionLeftToAnotherOneIsNotNamed) {
  EXPECT_EQ(truthOf({{"density", "-"}, {"range", "2"}}), "range 2");
}

}  // namespace
}  // namespace luciole::test
