// Cryptomattes, read by a program that knows their specification alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using Json = nlohmann::json;

class Cryptomatte : public ProgramTest {
 protected:
  /// A sheet "left" of x < 1, in front of one that fills the picture of 4 × 2 square metres, seen along −z by
  /// four pixels a metre and a half: so edges lie in pixels.
  Cryptomatte() {
    writeText(folder / "sheets.json",
              R"({"camera": {"eye": [0, 0, 5], "target": [0, 0, 0], "orthographic": 1}, "size": [6, 3],
          "materials": {"red": {"diffuse": [1, 0, 0]}, "Grün": {"diffuse": [0, 1, 0]}},
          "objects": [{"name": "left", "primitive": "plane", "rotate": [90, 0, 0], "scale": [4, 1, 4], "translate": [-1, 0, 1], "material": "red"},
                      {"name": "\"behind\" <all>", "primitive": "plane", "rotate": [90, 0, 0], "scale": 8, "material": "Grün"}]})");
  }
  Json read(const std::string& file) {
    return Json::parse(
        succeed("python3 '" LUCIOLE_SOURCE_DIR "/tests/tools/cli/cryptomatte_test.py' " + file));
  }
};

TEST_F(Cryptomatte, IsReadBySpecificationWithNamesAndTheirCoverage) {
  LUCIOLE_NEEDS_PROGRAM("python3", "python3");
  succeed(
      "luciole render sheets.json --samples 4 --aov cryptomatte --compression none --half --quiet -o "
      "mattes.exr");
  const Json mattes = read("mattes.exr");
  ASSERT_EQ(mattes.size(), 2u);
  const Json &objects = mattes["CryptoObject"]["pixels"], &materials = mattes["CryptoMaterial"]["pixels"];
  ASSERT_EQ(objects.size(), 18u);
  // A pixel is 2/3 metre wide. The edge at x = 1 lies in the middle of the fifth of six.
  for (std::size_t i = 0; i < 18; ++i) {
    std::map<std::string, double> shares, wanted{{"left", 0.5}, {"\"behind\" <all>", 0.5}};
    if (i % 6 < 4) wanted = {{"left", 1}};
    if (i % 6 > 4) wanted = {{"\"behind\" <all>", 1}};
    for (const Json& rank : objects[i]) shares[rank[0]] = rank[1];
    EXPECT_EQ(shares, wanted) << i;
    EXPECT_EQ(materials[i].size(), objects[i].size());
    for (std::size_t rank = 0; rank < objects[i].size(); ++rank)
      EXPECT_EQ(materials[i][rank][0], objects[i][rank][0] == "left" ? "red" : "Grün");
  }
}

TEST_F(Cryptomatte, OfAShippedSceneAreAsTheSpecificationSaysAtEveryPixel) {
  LUCIOLE_NEEDS_PROGRAM("python3", "python3");
  succeed("luciole render '" LUCIOLE_SOURCE_DIR
          "/scenes/city.json' --size 96x54 --samples 16 --aov cryptomatte_object --compression none --quiet "
          "-o city.exr");
  const Json mattes = read("city.exr");
  ASSERT_EQ(mattes.size(), 1u);
  std::size_t most = 0;
  for (const Json& ranks : mattes["CryptoObject"]["pixels"]) most = std::max(most, ranks.size());
  EXPECT_EQ(most, 6u);
}

TEST_F(Cryptomatte, IsRefusedWhereItsBitsWouldChangeOrNobodyKnowsNames) {
  refuse("luciole render sheets.json --aov cryptomatte --compression dwaa -o a.exr", 2,
         "Cryptomattes must keep them");
  succeed("luciole gbuffer sheets.json --quiet -o g.exr");
  refuse("luciole shade g.exr --scene sheets.json --aov object_id -o a.exr", 2,
         "a G-buffer knows no objects");
  refuse("luciole relight g.exr --lights sheets.json --aov cryptomatte -o a.exr", 2,
         "a G-buffer knows no objects");
}

}  // namespace
}  // namespace luciole::test
