// The table that the command line and other doors make a picture's options from.
#include <gtest/gtest.h>

#include <set>

#include "luciole/error.hpp"
#include "luciole/image.hpp"
#include "luciole/settings.hpp"

namespace luciole {
namespace {

std::string faultOf(const SettingValues& values) {
  RenderSettings settings;
  try {
    applySettings(values, settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(NamedSettings, EachNameStandsOnceAndItsInitialValueIsRight) {
  std::set<std::string> names;
  for (const NamedSetting& setting : namedSettings()) {
    EXPECT_TRUE(names.insert(setting.name).second) << setting.name;
    EXPECT_FALSE(setting.help.empty()) << setting.name;
    if (!setting.initial.empty()) {
      EXPECT_EQ(settingFault(setting, setting.initial), "") << setting.name;
    }
  }
}

TEST(NamedSettings, InitialValuesMeanThePicturesOfTheCommandLine) {
  RenderSettings settings;
  applySettings(initialSettings(), settings);
  EXPECT_EQ(settings.shade.shadows, ShadowMethod::kAuto);
  EXPECT_EQ(settings.shade.tile_size, ShadeSettings{}.tile_size);
  EXPECT_EQ(settings.shade.light_error, 0);
  EXPECT_EQ(settings.shade.light_error_floor, 1);
  EXPECT_EQ(settings.shade.shadow_limits.bytes, ShadowLimits{}.bytes);
  EXPECT_EQ(settings.size, RenderSettings{}.size);
  EXPECT_TRUE(settings.aovs.empty());
  WriteOptions file;
  applySettings(initialSettings(), file);
  EXPECT_TRUE(file.dither);
  EXPECT_EQ(file.bits, 0);
}

TEST(NamedSettings, TextsBecomeValues) {
  RenderSettings settings{.size{1600, 900}};
  applySettings({{"size", "640"},
                 {"crop", "1,2,3,4"},
                 {"samples", "16"},
                 {"light_error", "1/256"},
                 {"seed", "4294967295"},
                 {"aov", "depth,cryptomatte,depth"},
                 {"alpha", "on"},
                 {"exposure", "+0.5"}},
                settings);
  EXPECT_EQ(settings.size, glm::ivec2(640, 360)) << "as wide as asked, and of the shape that it had";
  EXPECT_EQ(settings.crop->height, 4);
  EXPECT_EQ(settings.samples, 16);
  EXPECT_EQ(settings.shade.light_error, 1.0f / 256);
  EXPECT_EQ(settings.shade.seed, 4294967295u);
  EXPECT_EQ(settings.aovs, (std::vector{Aov::kDepth, Aov::kCryptoObject, Aov::kCryptoMaterial}));
  EXPECT_TRUE(settings.alpha);
  EXPECT_EQ(settings.exposure, 0.5f);
}

TEST(NamedSettings, WrongValuesAreRefusedByName) {
  EXPECT_EQ(faultOf({{"samples", "0"}}), "samples: expected a whole number from 1 to 1024, got 0");
  EXPECT_EQ(faultOf({{"samples", "1.5"}}), "samples: expected a whole number from 1 to 1024, got 1.5");
  EXPECT_EQ(faultOf({{"shadows", "exakt"}}),
            "shadows: 'exakt' is none of auto, off, hard, pcf, soft, exact, soft-exact; did you mean exact?");
  EXPECT_EQ(faultOf({{"size", "0x4"}}), "size: 0x4 pixels, expected 1 to 32768 a side");
  EXPECT_EQ(faultOf({{"confidence", "nan"}}), "confidence: expected 0.5 to 0.9999, got nan");
  EXPECT_EQ(faultOf({{"light_error", "1/0"}}),
            "light_error: expected a number or a fraction from 0 to 1, such as 1/256, got 1/0");
  EXPECT_EQ(faultOf({{"crop", "1,2,3"}}), "crop: expected X,Y,W,H, such as 0,0,64,64, got 1,2,3");
  RenderSettings narrow{.size{1, 32768}};
  EXPECT_THROW(applySettings({{"size", "4"}}, narrow), InputError) << "4x131072, by the shape that it has";
  EXPECT_THROW(namedSetting("sample"), InputError);
}

TEST(NamedSettings, CastersAreTheMarkedOrAllWhereNoneIs) {
  const auto casters = [](const std::string& who, bool asked_for, std::vector<bool> marks) {
    Scene scene;
    for (const bool mark : marks) scene.lights.push_back({.shadow = mark});
    castShadows(who, asked_for, scene);
    for (std::size_t i = 0; i < marks.size(); ++i) marks[i] = scene.lights[i].shadow;
    return marks;
  };
  EXPECT_EQ(casters("", true, {false, false}), (std::vector{true, true}));
  EXPECT_EQ(casters("", false, {false, false}), (std::vector{false, false}));
  EXPECT_EQ(casters("", true, {true, false}), (std::vector{true, false}));
  EXPECT_EQ(casters("all", false, {true, false}), (std::vector{true, true}));
  EXPECT_EQ(casters("none", true, {true, false}), (std::vector{false, false}));
  EXPECT_EQ(casters("marked", true, {false, false}), (std::vector{false, false}));
}

}  // namespace
}  // namespace luciole
