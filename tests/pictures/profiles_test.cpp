// Luminaires with profiles, through the whole pipeline.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <numbers>

#include "kernels/probe.hpp"
#include "luciole/error.hpp"
#include "pictures/closed_form.hpp"
#include "pictures/shot.hpp"
#include "scene/json/write_scene.hpp"
#include "scene/profiles/profile_files.hpp"

namespace luciole::test {
namespace {

/// A folder with a profile, and scenes that name it.
struct LampFolder {
  explicit LampFolder(const LampText& lamp) { std::ofstream(folder / "lamp.ies") << iesText(lamp); }
  Scene load(const std::string& json) const {
    std::ofstream(folder / "scene.json") << json;
    return loadScene(folder / "scene.json");
  }
  TemporaryFolder folder;
};

double cosine(double degrees) { return std::cos(glm::radians(degrees)); }

/// Candela of an uneven lamp, by γ and C in degrees: between its angles, every 5 and 15 degrees, its table
/// gives something else.
double lampCandela(double gamma, double c) {
  return 1000 * std::max(cosine(gamma), 0.0) * (1.5 + cosine(c)) + 3 * gamma;
}
LampText unevenLamp() {
  return {.vertical = evenAngles(0, 180, 36), .horizontal = evenAngles(0, 180, 12), .candela = lampCandela};
}

/// The table's value: bilinear by hand.
double tableCandela(double gamma, double c) {
  c = c > 180 ? 360 - c : c;
  const double g0 = std::min(std::floor(gamma / 5), 35.0) * 5, c0 = std::min(std::floor(c / 15), 11.0) * 15;
  const double g = (gamma - g0) / 5, h = (c - c0) / 15;
  return (1 - g) * ((1 - h) * lampCandela(g0, c0) + h * lampCandela(g0, c0 + 15)) +
         g * ((1 - h) * lampCandela(g0 + 5, c0) + h * lampCandela(g0 + 5, c0 + 15));
}

// CIE 171:2006, 5.2: the direct light of a point source with a profile on a plane is I(γ, C) cos³γ / h². Here
// a surface of diffuse ½ shows half of it.
TEST(Profiles, APlaneUnderALampShowsItsCandelaOverTheSquaredDistance) {
  const LampFolder lamp(unevenLamp());
  const glm::dvec3 light(0.3, 1.5, -0.2);
  const Scene scene = lamp.load(floorScene(fmt::format(
      R"({}, "lights": [{{"type": "point", "position": [0.3, 1.5, -0.2], "profile": "lamp.ies"}}])",
      kMatte)));
  const Image image = picture(scene, settingsFor(scene, {kSide, kSide}));
  double worst = 0, brightest = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const glm::dvec3 way = floorPoint(x, y) - light;
      // C 0 lies towards +x, and C 90 to the left of it as the lamp sees it, with its way down ahead: towards
      // −z.
      const double gamma = glm::degrees(std::acos(-way.y / glm::length(way)));
      const double c = glm::degrees(std::atan2(-way.z, way.x));
      const double expected =
          0.5 * tableCandela(gamma, c < 0 ? c + 360 : c) * std::pow(cosine(gamma), 3) / (light.y * light.y);
      worst = std::max(worst, std::abs(image.pixels[(y * kSide + x) * 3] - expected));
      brightest = std::max(brightest, expected);
    }
  EXPECT_LT(worst, 1e-5 * brightest);
}

TEST(Profiles, AnEvenProfileChangesNoBit) {
  const LampFolder lamp({.vertical = {0, 77, 180}, .candela = [](double, double) { return 2; }});
  const auto light = [&](const std::string& rest) {
    return lamp.load(floorScene(fmt::format(
        R"({}, "lights": [{{"type": "point", "position": [0.3, 1.5, -0.2], "attenuation": [0, 0, 1], {}}}])",
        kMatte, rest)));
  };
  const Scene with = light(R"("profile": "lamp.ies", "direction": [1, 2, 3])"),
              without = light(R"("intensity": 2)");
  const RenderSettings settings = settingsFor(with, {kSide, kSide});
  EXPECT_EQ(picture(with, settings).pixels, picture(without, settings).pixels);
  EXPECT_NE(with.lights[0].luminaire, without.lights[0].luminaire);
}

/// A torus and a sphere on a floor, under lights of every kind that a profile may have.
std::string lampScene(const std::string& more = "") {
  return R"({"camera": {"eye": [3, 2.5, 4], "target": [0, 0.5, 0], "fov_y": 45}, "ambient": 0.02,
    "materials": {"m": {"diffuse": [0.5, 0.4, 0.3], "specular": 0.5, "shininess": 20}},
    "objects": [{"primitive": "plane", "scale": 20, "material": "m"},
                {"primitive": "sphere", "translate": [0.8, 0.5, 0.6], "scale": 0.5, "material": "m"},
                {"primitive": "torus", "translate": [-0.6, 0.5, 0], "material": "m"}],
    "lights": [{"type": "point", "position": [0, 3, 0], "profile": "lamp.ies", "lumens": 30, "shadow": true},
               {"type": "spot", "position": [2, 2, -1], "target": [0, 0, 0], "cutoff": 50, "exponent": 3,
                "profile": "lamp.ies", "candela": 4, "color": [1, 0.5, 0.2], "up": [1, 1, 1], "group": "b"},
               {"type": "point", "position": [-2, 1, 2], "profile": "lamp.ies", "direction": [1, 0.2, -1],
                "candela": 3, "range": 6, "ambient": [0, 0, 0.01], "shadow": true},
               {"type": "point", "position": [2, 3, 3], "intensity": 0.5}])" +
         more + "}";
}

LampText lampOfType(int type) {
  LampText lamp{.type = type};
  if (type == 1) {
    lamp.vertical = {0, 5, 15, 25, 35.3, 60, 90, 180};
    lamp.horizontal = evenAngles(0, 360, 24);
  } else {
    lamp.vertical = evenAngles(-90, 90, 36);
    lamp.horizontal = evenAngles(0, 90, 12);
  }
  lamp.candela = [](double v, double h) { return 300 + 150 * cosine(2 * v) + 40 * cosine(h) + 0.2 * v; };
  return lamp;
}

class ProfileTypes : public testing::TestWithParam<int> {};

TEST_P(ProfileTypes, ArriveAsTheReferenceSays) {
  const LampFolder lamp(lampOfType(GetParam()));
  const Scene scene = lamp.load(lampScene());
  const Shot shot = shoot(scene, {96, 64});
  const Image reference = referenceShade(scene, shot.gbuffer, {});
  double brightest = 0;
  for (const float value : reference.pixels) brightest = std::max(brightest, double(value));
  for (std::size_t i = 0; i < reference.pixels.size(); ++i)
    ASSERT_NEAR(shot.image.pixels[i], reference.pixels[i], 1e-5 * brightest)
        << i / 3 % 96 << ", " << i / 3 / 96;
  expectCullingChangesNothing(shot);
}

TEST_P(ProfileTypes, GiveTheSameBitsByAnyLanesAndMethods) {
  const LampFolder lamp(lampOfType(GetParam()));
  const Scene scene = lamp.load(lampScene());
  for (const ShadowMethod method : {ShadowMethod::kOff, ShadowMethod::kPcf, ShadowMethod::kExact}) {
    RenderSettings settings = settingsFor(scene, {72, 48});
    settings.shade.shadows = method;
    const Image one = picture(scene, settings, deviceWithLanes(1));
    for (const int lanes : {4, 8, 16})
      EXPECT_EQ(picture(scene, settings, deviceWithLanes(lanes)).pixels, one.pixels) << lanes << " lanes";
  }
}

TEST_P(ProfileTypes, GiveVerticesTheirLightToo) {
  const LampFolder lamp(lampOfType(GetParam()));
  const Scene scene = lamp.load(lampScene());
  RenderSettings settings = settingsFor(scene, {72, 48});
  settings.shading = Shading::kGouraud;
  settings.shade.shadows = ShadowMethod::kOff;
  const Image with = picture(scene, settings);
  Scene plain = scene;
  for (Light& light : plain.lights) light.luminaire = -1;
  EXPECT_NE(picture(plain, settings).pixels, with.pixels);
}

INSTANTIATE_TEST_SUITE_P(Types, ProfileTypes, testing::Values(1, 2, 3));

TEST(Profiles, LayersOfLightAddUpToThePicture) {
  const LampFolder lamp(unevenLamp());
  const Scene scene = lamp.load(lampScene());
  RenderSettings settings = settingsFor(scene, {48, 32});
  settings.shade.shadows = ShadowMethod::kExact;
  settings.light_groups = true;
  const Image image = picture(scene, settings);
  const std::size_t channels = image.channels.size();
  const std::size_t sum = channelIndex(image, "R"), a = channelIndex(image, "light_groups.default.R"),
                    b = channelIndex(image, "light_groups.b.R"),
                    rest = channelIndex(image, "light_groups.rest.R");
  double of_b = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += channels) {
    const float* pixel = &image.pixels[i];
    of_b += pixel[b];
    ASSERT_NEAR(pixel[a] + pixel[b] + pixel[rest], pixel[sum], 8 * kUnit * pixel[sum] + 1e-12);
  }
  EXPECT_GT(of_b, 1);
}

TEST(Profiles, AreWhatTheirScaleSays) {
  const LampFolder lamp(unevenLamp());
  const auto light = [&](const std::string& rest) {
    return lamp.load(
        R"({"objects": [{"primitive": "plane"}], "lights": [{"type": "point", "position": [0, 1, 0],
      "color": [1, 0.5, 0], )" +
        rest + "}]}");
  };
  const auto red = [](const Scene& scene) { return scene.lights.front().diffuse.r; };
  const Scene scene = light(R"("profile": "lamp.ies")");
  const LightProfile& profile = *scene.luminaires.front().profile;
  EXPECT_EQ(profile.peak, *std::max_element(profile.candela.begin(), profile.candela.end()));
  EXPECT_EQ(red(scene), float(profile.peak));
  EXPECT_EQ(scene.lights[0].attenuation, glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.lights[0].direction, glm::dvec3(0, -1, 0));
  EXPECT_EQ(red(light(R"("profile": "lamp.ies", "candela": 10, "intensity": 2)")), 20);
  EXPECT_NEAR(red(light(R"("profile": "lamp.ies", "lumens": 10)")), 10 * profile.peak / profile.lumens, 1e-6);
  EXPECT_NEAR(red(light(R"("lumens": 10)")), 10 / (4 * std::numbers::pi), 1e-6);
  // A spot: ∫ cosⁿ over its cone.
  const auto spot = [&](const std::string& rest) {
    return red(
        lamp.load(R"({"objects": [{"primitive": "plane"}], "lights": [{"type": "spot", "position": [0, 1, 0],
      "direction": [0, -1, 0], "lumens": 10, )" +
                  rest + "}]}"));
  };
  EXPECT_NEAR(spot(R"("cutoff": 60, "exponent": 1)"), 10 / (std::numbers::pi * 0.75), 1e-5);
  EXPECT_NEAR(spot(R"("inner_cone": 60, "outer_cone": 90)"), 10 / (2 * std::numbers::pi * (0.5 + 0.5 / 3)),
              1e-5);
}

TEST(Profiles, OneFileIsReadOnceForAllLights) {
  const LampFolder lamp(unevenLamp());
  std::string lights;
  for (int i = 0; i < 50; ++i)
    lights += fmt::format(
        R"({}{{"type": "point", "position": [{}, 1, 0], "profile": "lamp.ies", "up": [{}, 0, 1]}})",
        i ? "," : "", i, i % 2);
  const Scene scene = lamp.load(R"({"objects": [{"primitive": "plane"}], "lights": [)" + lights + "]}");
  ASSERT_EQ(scene.luminaires.size(), 2);
  EXPECT_EQ(scene.luminaires[0].profile, scene.luminaires[1].profile);
}

TEST(Profiles, AMovingDirectionTurnsTheLamp) {
  const LampFolder lamp(unevenLamp());
  const auto at = [&](const std::string& keys, double frame) {
    std::ofstream(lamp.folder / "scene.json") << floorScene(fmt::format(
        R"({}, "lights": [{{"type": "point", "position": [0.3, 1.5, -0.2], "profile": "lamp.ies", "up": [0, 0, 1], {}}}])",
        kMatte, keys));
    const Scene scene = loadScene(lamp.folder / "scene.json", frame);
    return picture(scene, settingsFor(scene, {kSide, kSide})).pixels;
  };
  const std::string moving =
      R"("direction": [1, 0, 0], "keys": [{"frame": 1, "direction": [0, -1, 0], "intensity": 1},
                                          {"frame": 3, "direction": [1, 0, 0], "intensity": 3}])";
  EXPECT_EQ(at(moving, 1), at(R"("direction": [0, -1, 0])", 1));
  EXPECT_EQ(at(moving, 3), at(R"("direction": [1, 0, 0], "intensity": 3)", 1));
}

TEST(Profiles, AreWrittenAsTheyAreRead) {
  const LampFolder lamp(unevenLamp());
  const Scene scene = lamp.load(lampScene());
  std::ofstream(lamp.folder / "written.json") << pictureScene(
      lamp.folder / "scene.json", lamp.folder.path().string(), scene, scene.cameras[0], {72, 48});
  const Scene again = loadScene(lamp.folder / "written.json");
  ASSERT_EQ(again.lights.size(), scene.lights.size());
  const RenderSettings settings = settingsFor(scene, {72, 48});
  EXPECT_EQ(picture(again, settings).pixels, picture(scene, settings).pixels);
}

TEST(Profiles, WhatMeansNothingIsRefused) {
  const LampFolder lamp(unevenLamp());
  const auto fault = [&](const std::string& rest) {
    try {
      lamp.load(R"({"lights": [{"type": "point", "position": [0, 1, 0], )" + rest + "}]}");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_THAT(fault(R"("candela": 3)"),
              testing::HasSubstr("candela: means nothing for a light without a profile"));
  EXPECT_THAT(fault(R"("direction": [0, -1, 0])"), testing::HasSubstr("for a point light without a profile"));
  EXPECT_THAT(fault(R"("profile": "lamp.ies", "candela": 3, "lumens": 3)"),
              testing::HasSubstr("beside lumens"));
  EXPECT_THAT(fault(R"("profile": "none.ies")"), testing::HasSubstr("none.ies"));
  EXPECT_THAT(fault(R"("profile": "scene.json")"), testing::HasSubstr("TILT"));
}

}  // namespace
}  // namespace luciole::test
