#include "tools/models/check_model.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "luciole/error.hpp"
#include "scene/models.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

const ModelCheck& checkOf(Model model) {
  static std::map<Model, ModelCheck> checks;
  if (!checks.contains(model)) checks[model] = checkModel({modelName(model), model, {}}, "");
  return checks.at(model);
}

ModelCheck checkOf(const std::string& body) {
  return checkModel(
      {"mine.clh",
       {},
       Shader{"mine.clh",
              "INLINE Reflection reflect_light(const Surface *s, vec3L to_light, floatL n_dot_l) {\n" + body +
                  "}\n"}},
      "");
}

double largestOf(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

TEST(CheckModel, EveryBuiltInModelKeepsItsPromises) {
  for (const Model model : kAllModels) {
    const ModelCheck& check = checkOf(model);
    EXPECT_THAT(check.broken, IsEmpty()) << modelName(model);
    EXPECT_THAT(check.lanes, testing::ElementsAre(1, 4, 8, 16));
    EXPECT_FALSE(check.other_bits);
    EXPECT_GT(check.pairs, 4000u);
  }
}

// Lambert's light is what arrives: 1/π ∫ N·L dω = 1. Midpoints of 128 angles are within (π/256)²/6 of it.
TEST(CheckModel, DiffuseEnergyOfLambertsModelIsOne) {
  for (const AlbedoCurve& curve : checkOf(Model::kPhong).albedo)
    for (const double albedo : curve.diffuse) EXPECT_NEAR(albedo, 1, 5e-5);
}

// Of Phong's lobe around the normal, 1/π ∫ cos^n dω = 2/(n + 1). Midpoints h apart are off by h²/24 of the
// difference between the slopes at both ends, twice 2 at most, and of a narrow lobe by h²/24·n of it.
TEST(CheckModel, EnergyOfPhongsLobeAheadIsWhatItsIntegralSays) {
  constexpr double h = std::numbers::pi / 2 / 128;
  for (const AlbedoCurve& curve : checkOf(Model::kPhong).albedo)
    EXPECT_NEAR(curve.specular[0], 2 / (curve.shininess + 1),
                2 / (curve.shininess + 1) * h * h / 24 * (5 + 1.1 * curve.shininess))
        << curve.shininess;
}

TEST(CheckModel, ReciprocityIsToldApart) {
  EXPECT_GT(checkOf(Model::kPhong).reciprocity.value, 0.5);  // its lobe lacks the cosines' symmetry
  EXPECT_LT(checkOf(Model::kCookTorrance).reciprocity.value, 1e-9);
  EXPECT_LT(checkOf(Model::kWard).reciprocity.value, 1e-9);
  EXPECT_LT(checkOf(Model::kOrenNayar).diffuse_reciprocity.value, 1e-9);
  EXPECT_GT(checkOf(Model::kToon).diffuse_reciprocity.value, 0.1);
}

TEST(CheckModel, WardAsCorrectedGivesNoMoreThanArrives) {
  for (const AlbedoCurve& curve : checkOf(Model::kWard).albedo) EXPECT_LT(largestOf(curve.specular), 1.002);
}

TEST(CheckModel, NumbersThatAreNoLightBreakAPromise) {
  const ModelCheck nan = checkOf("  Reflection r = {n_dot_l > 0.9f ? NAN : n_dot_l};\n  return r;\n");
  EXPECT_GT(nan.nan, 0u);
  EXPECT_EQ(nan.negative + nan.infinite, 0u);
  ASSERT_TRUE(nan.first_faulty);
  EXPECT_LT(nan.first_faulty->light, 30);
  ASSERT_FALSE(nan.broken.empty());
  EXPECT_THAT(nan.broken.front(), HasSubstr("NaN"));
  EXPECT_GT(checkOf("  Reflection r = {-n_dot_l};\n  return r;\n").negative, 1000u);
  EXPECT_GT(checkOf("  Reflection r = {1e30f * n_dot_l * 1e30f};\n  return r;\n").infinite, 1000u);
}

TEST(CheckModel, AnErrorThatRoundingDoesNotExplainBreaksAPromise) {
  // 1 + x − 1 has lost x's digits.
  const ModelCheck lossy =
      checkOf("  floatL lost = (1e4f + n_dot_l) - 1e4f;\n  Reflection r = {lost};\n  return r;\n");
  ASSERT_FALSE(lossy.broken.empty());
  EXPECT_THAT(lossy.broken.front(), HasSubstr("rounding explains"));
}

TEST(CheckModel, EnergyAboveOneIsToldWithItsAngle) {
  const std::string text = modelCheckText(checkOf("  Reflection r = {1.5f * n_dot_l};\n  return r;\n"));
  EXPECT_THAT(text, HasSubstr("diffuse 1.500 at 0 degrees"));
  EXPECT_THAT(text, HasSubstr("MORE than arrives"));
  EXPECT_THAT(text, HasSubstr("All promises hold."));
}

TEST(CheckModel, ReportsHaveAllFiguresAndPlotsAllLobes) {
  const ModelCheck& check = checkOf(Model::kOrenNayar);
  const nlohmann::json json = nlohmann::json::parse(modelCheckJson(check));
  EXPECT_EQ(json["errors"].size(), check.errors.size());
  EXPECT_EQ(json["albedo"].size(), 5u);
  EXPECT_GT(json["nanoseconds_a_pair"]["model"]["median"].get<double>(), 0);
  const std::string svg = modelPlot(check);
  EXPECT_TRUE(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
  for (const char* light : {"light at 0°", "light at 20°", "light at 40°", "light at 60°", "light at 80°"})
    EXPECT_THAT(svg, HasSubstr(light));
  EXPECT_THAT(svg, testing::Not(HasSubstr("nan")));
}

TEST(CheckModel, WhatDoesNotCompileIsToldByItsPlace) {
  EXPECT_THROW(
      {
        try {
          checkOf("  return undeclared;\n");
        } catch (const InputError& error) {
          EXPECT_THAT(error.what(), HasSubstr("mine.clh:2:10: "));
          throw;
        }
      },
      InputError);
}

}  // namespace
}  // namespace luciole::test
