#include "scene/json/plain_lights.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/random.hpp"
#include "luciole/error.hpp"
#include "scene/json/json_scene.hpp"

namespace luciole::test {
namespace {

/// Enough for a text of more than a megabyte, and for several pieces of it.
constexpr int kCount = 20000;

double between(double low, double high, std::uint64_t& state) {
  return low + (high - low) * nextUniform(state);
}

/// Point lights of every member that a plain one may have, in changing order and spelling.
std::vector<std::string> plainLights() {
  std::uint64_t state = 7;
  std::vector<std::string> lights;
  for (int i = 0; i < kCount; ++i) {
    std::vector<std::string> members{
        R"("type" : "point")", fmt::format(R"("position":[{}, {:e},{}])", between(-1e3, 1e3, state),
                                           between(-1, 1, state), i % 7 == 0 ? "-0" : "123456789012345678")};
    const auto add = [&](int every, const std::string& member) {
      if (i % every == 0) members.push_back(member);
    };
    add(2, fmt::format(R"("color": [{}, 1, 0.1e-5])", between(0, 2, state)));
    add(3, fmt::format("\"diffuse\"\t:{:.17g}", between(0, 2, state)));
    add(5, R"("sp\u0065cular": [0.25,0.5,1e18])");
    add(7, R"("ambient": 0.1)");
    add(4, fmt::format(R"("intensity": {})", between(0, 9, state)));
    add(3, fmt::format("\"attenuation\": [0 ,\t{},1]", between(0, 1, state)));
    add(6, R"("range": 1e-18)");
    add(8, R"("radius": 0.5)");
    add(9, i % 2 ? R"("shadow": true)" : R"("shadow":false)");
    std::swap(members[0], members[std::size_t(i) % members.size()]);
    lights.push_back(fmt::format("{{{}}}", fmt::join(members, ", ")));
  }
  return lights;
}

/// Before and behind the lights are their name and brackets where they mean nothing.
std::string sceneWithLights(const std::vector<std::string>& lights) {
  return fmt::format(
      R"({{"$schema": "a \"lights\": [ \\", "materials": {{"lights": {{"diffuse": [1, 0, 1]}}}},
    "lights" : [ {} ], "objects": [{{"primitive": "box", "material": "lights", "name": "}}]{{[\\\""}}]}})",
      fmt::join(lights, ",\n"));
}

Scene readScene(const std::string& text) { return parseJsonScene(text, "s.json", {}).scene; }

std::string faultOfScene(const std::string& text) {
  try {
    readScene(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PlainLights, AreReadAsInAShortFile) {
  const std::vector<std::string> lights = plainLights();
  const std::string text = sceneWithLights(lights);
  const auto plain = readPlainLights(text);
  ASSERT_TRUE(plain);
  EXPECT_LT(plain->rest.size(), 300u);
  const Scene scene = readScene(text);
  EXPECT_EQ(scene.objects.size(), 1u);
  ASSERT_EQ(scene.lights.size(), lights.size());
  for (std::size_t begin = 0; begin < lights.size(); begin += 1000) {
    const std::string shorter = sceneWithLights(
        {lights.begin() + std::ptrdiff_t(begin), lights.begin() + std::ptrdiff_t(begin) + 1000});
    EXPECT_FALSE(readPlainLights(shorter));
    const Scene part = readScene(shorter);
    for (std::size_t i = 0; i < 1000; ++i) ASSERT_EQ(scene.lights[begin + i], part.lights[i]) << begin + i;
  }
}

TEST(PlainLights, OnesThatArentAreLeftToTheOrdinaryReaderWithAllOthers) {
  std::vector<std::string> lights = plainLights();
  for (const char* other :
       {R"({"type": "directional", "direction": [0, -1, 0]})",
        R"({"type": "spot", "position": [0, 0, 0], "direction": [0, -1, 0], "cutoff": 20})",
        R"({"type": "point", "position": [0, 0, 0], "name": "a, [b"})",
        R"({"type": "point", "position": [0, 0, 0], "group": "key"})",
        R"({"type": "point", "position": [0, 0, 0], "enabled": true})"}) {
    lights[kCount / 2] = other;
    EXPECT_FALSE(readPlainLights(sceneWithLights(lights))) << other;
    const Scene all = readScene(sceneWithLights(lights));
    ASSERT_EQ(all.lights.size(), lights.size()) << other;
    EXPECT_EQ(all.lights[kCount / 2], readScene(sceneWithLights({other})).lights[0]);
  }
}

// Each fault as the reader of short files tells it, but for the light's number.
TEST(PlainLights, FaultsAreToldWithTheirPlace) {
  std::vector<std::string> lights = plainLights();
  for (const char* wrong : {R"({"type": "point"})",
                            R"({"position": [0, 0, 0]})",
                            R"({"type": "dot", "position": [0, 0, 0]})",
                            R"({"type": "point", "position": [0, 0]})",
                            R"({"type": "point", "position": [0, 0, 0, 0]})",
                            R"({"type": "point", "position": [0, 0, 1e19]})",
                            R"({"type": "point", "position": [0, 0, 1e999]})",
                            R"({"type": "point", "position": [0, 0, "1"]})",
                            R"({"type": "point", "position": [0, 0, 01]})",
                            R"({"type": "point", "position": [0, 0, 0], "color": -1})",
                            R"({"type": "point", "position": [0, 0, 0], "range": 0})",
                            R"({"type": "point", "position": [0, 0, 0], "attenuation": [0, 0, 0]})",
                            R"({"type": "point", "position": [0, 0, 0], "position": [0, 0, 0]})",
                            R"({"type": "point", "position": [0, 0, 0], "shadow": 1})",
                            R"({"type": "point", "position": [0, 0, 0], "colour": 1})",
                            R"({"type": "point", "position": [0, 0, 0],})",
                            R"({"type": "point" "position": [0, 0, 0]})",
                            R"({"type": "point", "position": [0, 0, 0]} x)",
                            R"({"type": "point", "position": [0, 0, 0]}])",
                            "[0, 0]",
                            "1",
                            "",
                            "\"\xff\"",
                            "{",
                            "}",
                            "]"}) {
    lights[kCount - 1] = wrong;
    const std::string fault = faultOfScene(sceneWithLights(lights)),
                      brief = faultOfScene(sceneWithLights({lights[0], wrong}));
    EXPECT_NE(fault, "") << wrong;
    // Faults of syntax name lines, others lights.
    if (brief.find("lights[1]") != std::string::npos) {
      std::string expected = brief;
      expected.replace(expected.find("lights[1]"), 9, fmt::format("lights[{}]", kCount - 1));
      EXPECT_EQ(fault, expected);
    }
  }
}

TEST(PlainLights, FaultsBesideThemAreToldAsEver) {
  const std::string good = sceneWithLights(plainLights());
  EXPECT_THAT(faultOfScene(good.substr(0, good.size() - 1) + R"(, "lights": []})"),
              testing::HasSubstr("given twice"));
  EXPECT_THAT(faultOfScene(good + "x"), testing::HasSubstr(fmt::format("line {}", kCount + 1)))
      << "the line in the whole text, one a light";
  EXPECT_THAT(faultOfScene(good.substr(0, good.size() - 1) + R"(, "light": []})"),
              testing::HasSubstr("light"));
}

}  // namespace
}  // namespace luciole::test
