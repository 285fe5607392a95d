// What makes a pixel, light by light: render --probe.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/glm.hpp>
#include <sstream>
#include <string>

#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The three numbers that follow `what` at the beginning of a line.
glm::dvec3 after(const std::string& text, const std::string& what) {
  const std::size_t at = text.find("\n" + what);
  EXPECT_NE(at, std::string::npos) << what << " in\n" << text;
  if (at == std::string::npos) return {};
  std::istringstream numbers(text.substr(at + 1 + what.size()));
  glm::dvec3 v;
  numbers >> v.x >> v.y >> v.z;
  return v;
}

/// The sum in the last line of the table.
glm::dvec3 lastSum(const std::string& text) {
  const std::size_t end = text.rfind(" |\n"), begin = text.rfind("| ", end - 1) + 2;
  std::istringstream numbers(text.substr(begin, end - begin));
  glm::dvec3 v;
  numbers >> v.x >> v.y >> v.z;
  return v;
}

class Probe : public ProgramTest {
 protected:
  /// Probes a pixel, and compares its colour with that pixel of the whole picture: the same bits.
  std::string probed(const std::string& scene, const std::string& options, int x, int y) {
    const std::string line = "luciole render '" + scene + "' --size 64x36 --quiet " + options;
    const std::string text = succeed(line + " --probe " + std::to_string(x) + "," + std::to_string(y));
    succeed(line + " -o whole.exr");
    const Image whole = readImage(folder / "whole.exr");
    const glm::vec3 picture(after(text, "picture: "));
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(picture[c], whole.pixels[(std::size_t(y) * 64 + x) * whole.channels.size() + c]) << text;
    return text;
  }
};

const std::string kScenes = LUCIOLE_SOURCE_DIR "/scenes/";

TEST_F(Probe, TellsThePicturesOwnBitsAndTheSumThatTheReferenceMakesOfThem) {
  for (const char* options : {"--shadows exact", "--shadows off --model oren-nayar", "--exposure 1.5"})
    for (const auto& [x, y] : {std::pair{32, 18}, std::pair{5, 30}, std::pair{0, 0}, std::pair{63, 35}}) {
      const std::string text = probed(kScenes + "cornell.json", options, x, y);
      const glm::dvec3 picture = after(text, "picture: "), reference = after(text, "reference: ");
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture[c], reference[c], 1e-5 * (1 + reference[c])) << text;
    }
}

TEST_F(Probe, ListsLightsByWhatTheyAddAndAddsThemUp) {
  writeText(folder / "two.json",
            R"({"camera": {"eye": [0, 0, 5], "target": [0, 0, 0]}, "ambient": 0.125,
                "materials": {"m": {"ambient": 1, "diffuse": 0.5, "specular": 0, "emission": [0.25, 0, 0]}},
                "objects": [{"primitive": "box", "material": "m"}],
                "lights": [{"type": "directional", "direction": [0, 0, -1], "intensity": 0.25, "group": "dim"},
                           {"type": "point", "position": [0, 0, 2.5], "attenuation": [0, 1, 0], "group": "key"},
                           {"type": "point", "position": [0, 0, 9], "range": 2, "group": "far"},
                           {"type": "directional", "direction": [0, 0, 1], "group": "behind"}]})");
  const std::string text = succeed("luciole render two.json --size 33x33 --shadows off --probe 16,16");
  // The box's front is at z = 0.5: the point light is 2 m away, and gives 0.5 · ½.
  EXPECT_THAT(text, HasSubstr("lights: 3 of 4 reach it"));
  EXPECT_LT(text.find("1 key"), text.find("0 dim"));
  EXPECT_LT(text.find("0 dim"), text.find("3 behind"));
  EXPECT_THAT(text, Not(HasSubstr("2 far")));
  const glm::dvec3 sum = lastSum(text);
  EXPECT_NEAR(sum.x, 0.25 + 0.125 + 0.25 + 0.125, 1e-4) << text;
  EXPECT_NEAR(sum.y, 0.125 + 0.25 + 0.125, 1e-4) << text;
  const glm::dvec3 picture = after(text, "picture: ");
  EXPECT_NEAR(picture.x, sum.x, 1e-4) << text;
}

TEST_F(Probe, SaysWhatFogAndSamplesDo) {
  writeText(folder / "fog.json",
            R"({"camera": {"eye": [0, 0, 5], "target": [0, 0, 0]}, "objects": [{"primitive": "sphere"}],
                "fog": {"mode": "exp", "density": 0.1, "color": [0, 0, 1]},
                "lights": [{"type": "directional", "direction": [-1, -1, -1]}]})");
  EXPECT_THAT(probed(folder / "fog.json", "", 32, 18), HasSubstr("\nfog: 0.67"));
  const std::string text = probed(folder / "fog.json", "--samples 8", 32, 18);
  EXPECT_THAT(text, HasSubstr("mean of 8 samples"));
  EXPECT_THAT(probed(folder / "fog.json", "", 0, 0), HasSubstr("surface: none"));
}

TEST_F(Probe, TakesAnyNumberOfLightsAndShowsTheBrightest) {
  writeText(
      folder / "many.json",
      R"({"camera": {"eye": [0, 4, 4], "target": [0, 0, 0]}, "objects": [{"primitive": "plane", "scale": 9}],
                "light_fields": [{"count": 20000, "seed": 1, "min": [-4, 0, -4], "max": [4, 1, 4],
                                  "range": 1, "intensity": 0.01}]})");
  const std::string text = probed(folder / "many.json", "--shadows off", 32, 18);
  EXPECT_THAT(text, HasSubstr(" dimmer"));
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 40);
  const glm::dvec3 sum = lastSum(text), picture = after(text, "picture: ");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], picture[c], 1e-4 * (1 + sum[c])) << text;
}

TEST_F(Probe, RefusesWhatItCantTell) {
  const std::string line = "luciole render '" + kScenes + "cornell.json' --size 64x36 ";
  refuse(line + "--probe 64,0", 2, "--probe 64,0: the picture has 64x36 pixels");
  refuse(line + "--probe 1", 2, "--probe");
  refuse(line + "--probe 1,1 --shading gouraud", 2, "gouraud");
  refuse(line + "--probe 1,1 --frames 1-2", 2, "one frame");
  refuse(line + "--probe 1,1 --stats s.json", 2, "--stats: is of a picture");
  refuse(line + "--probe 1,1 --hash", 2, "--hash: is of a picture");
  refuse(line + "--probe 1,1 -o -", 2, "standard output");
  refuse(line, 2, "-o is required");
}

}  // namespace
}  // namespace luciole::test
