// Files of luminaires: what their tables mean, and what bad ones get.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <random>

#include "luciole/error.hpp"
#include "luciole/light.hpp"
#include "scene/profiles/profile_files.hpp"
#include "scene/profiles/profile_table.hpp"

namespace luciole::test {
namespace {

constexpr double kPi = std::numbers::pi;

LightProfile parsed(const std::string& text, const std::string& name = "lamp.ies") {
  std::vector<Warning> warnings;
  const LightProfile profile = *parseLightProfile(text, name, warnings);
  EXPECT_TRUE(warnings.empty()) << warnings.front().text;
  return profile;
}

std::string faultOf(const std::string& text, const std::string& name = "lamp.ies") {
  std::vector<Warning> warnings;
  try {
    parseLightProfile(text, name, warnings);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

std::vector<std::string> warningsOf(const std::string& text, const std::string& name = "lamp.ies") {
  std::vector<Warning> warnings;
  parseLightProfile(text, name, warnings);
  std::vector<std::string> texts;
  for (const Warning& warning : warnings) texts.push_back(warning.text);
  return texts;
}

/// The table's value at two of its angles, radians; −1 where there is none.
double entryAt(const LightProfile& profile, double polar, double azimuth) {
  for (std::size_t i = 0; i < profile.polar.size(); ++i)
    for (std::size_t j = 0; j < profile.azimuth.size(); ++j)
      if (std::abs(profile.polar[i] - polar) < 1e-9 &&
          std::abs(std::remainder(profile.azimuth[j] - azimuth, 2 * kPi)) < 1e-9)
        return double(profile.candela[i * profile.azimuth.size() + j]);
  return -1;
}

/// Every entry is what the function gives for the table's angles in degrees, and C goes all around.
void expectTypeC(const LightProfile& profile, const std::function<double(double, double)>& candela) {
  EXPECT_EQ(profile.type, PhotometricType::kC);
  EXPECT_NEAR(profile.azimuth.back() - profile.azimuth.front(), 2 * kPi, 1e-12);
  for (std::size_t i = 0; i < profile.polar.size(); ++i)
    for (std::size_t j = 0; j < profile.azimuth.size(); ++j) {
      const double gamma = glm::degrees(profile.polar[i]), c = glm::degrees(profile.azimuth[j]);
      ASSERT_NEAR(profile.candela[i * profile.azimuth.size() + j], candela(gamma, c), 1e-4)
          << gamma << ", " << c;
    }
}

double cosine(double degrees) { return std::cos(glm::radians(degrees)); }

TEST(LightProfile, HorizontalAnglesOfTypeCAreMirroredAsTheStandardSays) {
  LampText lamp;
  lamp.vertical = evenAngles(0, 180, 12);
  const auto any = [](double gamma, double c) {
    return 100 + gamma + 10 * cosine(c) + 3 * std::sin(glm::radians(c));
  };
  const auto about_c0 = [](double gamma, double c) { return 100 + gamma + 10 * cosine(c); };
  const auto about_c90 = [](double gamma, double c) { return 100 + gamma + 10 * std::sin(glm::radians(c)); };
  const auto about_both = [](double gamma, double c) { return 100 + gamma + 10 * cosine(2 * c); };
  const auto round = [](double gamma, double) { return 100 + gamma; };
  struct Case {
    std::vector<double> horizontal;
    std::function<double(double, double)> candela;
  };
  for (const Case& one : {Case{{0}, round},
                          {evenAngles(0, 90, 6), about_both},
                          {evenAngles(0, 180, 8), about_c0},
                          {evenAngles(90, 270, 8), about_c90},
                          {evenAngles(0, 360, 16), any}}) {
    lamp.horizontal = one.horizontal;
    lamp.candela = one.candela;
    expectTypeC(parsed(iesText(lamp)), one.candela);
  }
}

TEST(LightProfile, SymmetriesOfEulumdatAreItsOwn) {
  const std::vector<double> planes{0, 45, 90, 135, 180, 225, 270, 315}, angles = evenAngles(0, 180, 6);
  const auto any = [](double gamma, double c) {
    return 100 + gamma + 10 * cosine(c) + 3 * std::sin(glm::radians(c));
  };
  const auto about_c0 = [](double gamma, double c) { return 100 + gamma + 10 * cosine(c); };
  const auto about_c90 = [](double gamma, double c) { return 100 + gamma + 10 * std::sin(glm::radians(c)); };
  const auto about_both = [](double gamma, double c) { return 100 + gamma + 10 * cosine(2 * c); };
  const auto round = [](double gamma, double) { return 100 + gamma; };
  const auto read = [](const std::string& text) { return parsed(text, "lamp.LDT"); };
  expectTypeC(read(ldtText(0, planes, {0, 1, 2, 3, 4, 5, 6, 7}, angles, any)), any);
  expectTypeC(read(ldtText(1, planes, {0}, angles, round)), round);
  expectTypeC(read(ldtText(2, planes, {0, 1, 2, 3, 4}, angles, about_c0)), about_c0);
  expectTypeC(read(ldtText(3, planes, {6, 7, 0, 1, 2}, angles, about_c90)), about_c90);
  expectTypeC(read(ldtText(4, planes, {0, 1, 2}, angles, about_both)), about_both);
  EXPECT_EQ(read(ldtText(1, planes, {0}, angles, round)).lamp_lumens, 2000);
}

TEST(LightProfile, TypesAAndBAreTurnedToTheirPoles) {
  LampText lamp;
  lamp.vertical = evenAngles(-90, 90, 12);
  lamp.horizontal = evenAngles(-90, 90, 6);
  lamp.candela = [](double v, double h) { return 200 + v + 0.1 * h; };
  lamp.type = 3;
  const LightProfile a = parsed(iesText(lamp));
  EXPECT_EQ(a.type, PhotometricType::kA);
  EXPECT_NEAR(entryAt(a, glm::radians(90 - 30.0), glm::radians(60.0)), 236, 1e-4);
  lamp.type = 2;
  const LightProfile b = parsed(iesText(lamp));
  EXPECT_EQ(b.type, PhotometricType::kB);
  EXPECT_NEAR(entryAt(b, glm::radians(90 - 60.0), glm::radians(30.0)), 236, 1e-4);
  // Half of them stand for both halves.
  lamp.vertical = evenAngles(0, 90, 6);
  lamp.horizontal = evenAngles(0, 90, 3);
  const LightProfile halves = parsed(iesText(lamp));
  EXPECT_NEAR(entryAt(halves, glm::radians(90 + 60.0), glm::radians(-30.0)), 236, 1e-4);
  EXPECT_NEAR(entryAt(halves, glm::radians(90 - 60.0), glm::radians(30.0)), 236, 1e-4);
}

TEST(LightProfile, LumensAreTheTablesIntegral) {
  LampText lamp;
  // Even light: 4π. Light that falls linearly from 1 to 0 over γ from 0 to a right angle: 2π ∫ (1 − 2γ/π) sin
  // γ dγ = 2π − 4. Rounding: candela are floats.
  lamp.vertical = {0, 180};
  lamp.candela = [](double, double) { return 1; };
  EXPECT_NEAR(parsed(iesText(lamp)).lumens, 4 * kPi, 1e-12);
  lamp.vertical = {0, 13, 90};
  lamp.candela = [](double gamma, double) { return 1 - gamma / 90; };
  EXPECT_NEAR(parsed(iesText(lamp)).lumens, 2 * kPi - 4, 1e-6);
  // A cosine, whose table lies below it by the step squared over 8 of its bend: π.
  lamp.vertical = evenAngles(0, 90, 180);
  lamp.horizontal = evenAngles(0, 360, 5);
  lamp.candela = [](double gamma, double) { return cosine(gamma); };
  const double step = glm::radians(0.5);
  const double lumens = parsed(iesText(lamp)).lumens;
  EXPECT_LT(lumens, kPi);
  EXPECT_NEAR(lumens, kPi, kPi * step * step / 8);
  // The same by types A and B: light that is even over the half-sphere ahead.
  lamp = {};
  lamp.vertical = lamp.horizontal = evenAngles(-90, 90, 4);
  lamp.candela = [](double, double) { return 3; };
  for (const int type : {2, 3}) {
    lamp.type = type;
    EXPECT_NEAR(parsed(iesText(lamp)).lumens, 6 * kPi, 1e-12) << type;
  }
}

TEST(LightProfile, FactorsMultiplyByTheStandardsYear) {
  LampText lamp;
  lamp.multiplier = 2;
  lamp.ballast = 0.5;
  lamp.factor = 3;
  for (const auto& [head, peak] : {std::pair("", 300.0),
                                   {"IESNA91\n", 300.0},
                                   {"IESNA:LM-63-1995\n", 100.0},
                                   {"IESNA:LM-63-2002\n", 100.0},
                                   {"IES:LM-63-2019\n", 100.0}}) {
    lamp.head = std::string(head) + "a line of any text\n";
    EXPECT_EQ(parsed(iesText(lamp)).peak, peak) << head;
  }
  EXPECT_EQ(parsed(iesText(lamp)).lamp_lumens, 1800);
}

TEST(LightProfile, WhatProgramsWriteIsRead) {
  LampText lamp;
  std::string text = iesText(lamp);
  // Commas between numbers, pluses, DOS lines, a mark of the end, lower case.
  for (std::size_t at = text.find("TILT"); (at = text.find(' ', at)) != text.npos;) text.replace(at, 1, ",");
  for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += 2) text.replace(at, 1, "\r\n");
  text.replace(text.find("TILT=NONE"), 9, " Tilt=None  ");
  text.replace(text.find(",45"), 3, ",+45.0E0");
  text += "\x1a";
  EXPECT_EQ(parsed(text).candela, parsed(iesText(lamp)).candela);
}

TEST(LightProfile, WhatIsLeftOutOrRepairedIsTold) {
  using testing::ElementsAre;
  LampText lamp;
  lamp.tilt = "TILT=INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8\n";
  EXPECT_THAT(
      warningsOf(iesText(lamp)),
      ElementsAre("lamp.ies: line 4: TILT=INCLUDE, left out: light doesn't depend on the lamp's tilt"));
  lamp.tilt = "TILT=lamp.tlt\n";
  EXPECT_THAT(
      warningsOf(iesText(lamp)),
      ElementsAre("lamp.ies: line 4: TILT=lamp.tlt, left out: light doesn't depend on the lamp's tilt"));
  lamp = {};
  lamp.candela = [](double gamma, double) { return 20 - gamma; };
  EXPECT_THAT(warningsOf(iesText(lamp)), ElementsAre("lamp.ies: line 9: negative candela, taken for 0"));
  EXPECT_THAT(warningsOf(ldtText(1, {0}, {0}, {0, 45, 90}, lamp.candela), "lamp.ldt"),
              ElementsAre("lamp.ldt: line 48: negative candela, taken for 0"));
  lamp = {};
  EXPECT_THAT(warningsOf(iesText(lamp) + "17\n"),
              ElementsAre("lamp.ies: line 10: more than its 1 times 3 candela values; left out"));
  lamp.horizontal = evenAngles(0, 345, 23);
  EXPECT_THAT(warningsOf(iesText(lamp)),
              ElementsAre("lamp.ies: horizontal angles end at 345, taken for all around"));
}

TEST(LightProfile, BadFilesAreRefusedInOneLine) {
  LampText lamp;
  const std::string good = iesText(lamp);
  const auto with = [&](const std::string& what, const std::string& instead) {
    std::string text = good;
    text.replace(text.rfind(what), what.size(), instead);
    return faultOf(text);
  };
  EXPECT_EQ(
      faultOf(""),
      "lamp.ies: line 0: no line TILT= up to the end, expected a file of IES LM-63, or EULUMDAT named .ldt");
  EXPECT_EQ(
      faultOf("a\nb\n"),
      "lamp.ies: line 2: no line TILT= up to the end, expected a file of IES LM-63, or EULUMDAT named .ldt");
  EXPECT_EQ(with("0 45 90", "0 45 nan"),
            "lamp.ies: line 7: vertical angle 3 is 'nan', expected a number from -360 to 360");
  EXPECT_EQ(with("0 45 90", "0 45 45"), "lamp.ies: line 7: vertical angle 3 is 45, expected more than 45");
  EXPECT_EQ(with("0 45 90", "0 45 190"),
            "lamp.ies: vertical angles go from 0 to 190, expected 0 to 180 at most");
  EXPECT_EQ(with("100 100 100", "100 100"),
            "lamp.ies: line 10: candela value 3 is missing, expected a number from -1000000000000 to "
            "1000000000000");
  EXPECT_EQ(
      with("100 100 100", "100 1e400 100"),
      "lamp.ies: line 9: candela value 2 is '1e400', expected a number from -1000000000000 to 1000000000000");
  EXPECT_EQ(with("1 3 1 1 2", "1 3 1 4 2"),
            "lamp.ies: line 5: the photometric type is '4', expected a number from 1 to 3");
  EXPECT_EQ(with("1 3 1 1 2", "1 3000 1000 1 2"),
            "lamp.ies: line 6: 3000 vertical and 1000 horizontal angles, more than the file has numbers for");
  EXPECT_EQ(with("1 3 1 1 2", "1 1e9 1 1 2"),
            "lamp.ies: line 5: the number of vertical angles is '1e9', expected a number from 1 to 4194304");
  EXPECT_EQ(with("1 3 1 1 2", "1 2.5 1 1 2"),
            "lamp.ies: line 5: the number of vertical angles is 2.5, expected a whole number");
  lamp.horizontal = evenAngles(0, 120, 4);
  EXPECT_EQ(faultOf(iesText(lamp)),
            "lamp.ies: horizontal angles go from 0 to 120, expected 0 to 0, 90, 180 or 360, or 90 to 270");
  lamp.type = 2;
  EXPECT_EQ(faultOf(iesText(lamp)),
            "lamp.ies: horizontal angles go from 0 to 120, expected -90 to 90 at most");
  lamp = {};
  lamp.vertical = {0};
  EXPECT_EQ(
      faultOf(iesText(lamp)),
      "lamp.ies: has one angle, expected 2 or more vertical ones, and of types A and B horizontal ones");

  const std::string ldt = ldtText(1, {0}, {0}, {0, 45, 90}, [](double, double) { return 100; });
  EXPECT_EQ(faultOf("", "a.ldt"),
            "a.ldt: line 3: the symmetry Isym is missing, expected a number from 0 to 4");
  EXPECT_EQ(faultOf(ldt.substr(0, ldt.size() - 4), "a.ldt"),
            "a.ldt: line 48: the file ends, expected 49 lines for 1 planes of 3 angles");
  std::string text = ldt;
  text.replace(text.find("\n1\n1\n0\n"), 7, "\n4\n6\n0\n");
  EXPECT_EQ(faultOf(text, "a.ldt"), "a.ldt: line 4: 6 planes, expected a multiple of 4 for the symmetry 4");
  EXPECT_EQ(
      faultOf(ldtText(2, {0, 90, 170, 270}, {0, 1, 2}, {0, 90}, [](double, double) { return 1; }), "a.ldt"),
      "a.ldt: horizontal angles go from 0 to 170, expected 0 to 0, 90, 180 or 360, or 90 to 270");
}

TEST(LightProfile, DamagedFilesAreReadOrRefused) {
  LampText lamp;
  lamp.horizontal = evenAngles(0, 90, 3);
  const auto one = [](double, double) { return 1.0; };
  std::mt19937 random(1);
  for (const auto& [text, name] : {std::pair(iesText(lamp), "a.ies"),
                                   {ldtText(4, {0, 90, 180, 270}, {0, 1}, {0, 45, 90}, one), "a.ldt"}})
    for (int i = 0; i < 20000; ++i) {
      std::string damaged = text;
      for (int change = 0; change < 1 + i % 4; ++change) {
        const std::size_t at = random() % damaged.size();
        switch (random() % 4) {
          case 0:
            damaged[at] = char(random());
            break;
          case 1:
            damaged.erase(at, random() % 20);
            break;
          case 2:
            damaged.insert(at, std::vector<std::string>{"-", "9", "1e9", "\n", "nan", "0 "}[random() % 6]);
            break;
          case 3:
            damaged[at] = "0123456789-.e \n"[random() % 15];
            break;
        }
        if (damaged.empty()) break;
      }
      std::vector<Warning> warnings;
      try {
        const auto profile = parseLightProfile(damaged, name, warnings);
        ASSERT_TRUE(std::isfinite(profile->lumens) && profile->lumens >= 0) << damaged;
        ASSERT_EQ(profile->candela.size(), profile->polar.size() * profile->azimuth.size());
      } catch (const InputError& error) {
        ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
}

}  // namespace
}  // namespace luciole::test
