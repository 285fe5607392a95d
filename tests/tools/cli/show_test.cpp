// Intermediate results as pictures: luciole show, --aov and shadow-map of a picture, --set and --sweep.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "image/srgb.hpp"
#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

/// A wall 4 m ahead that a spot 1 m in front of it lights, a lamp, and a sun.
constexpr const char* kWall = R"({
  "camera": {"eye": [0, 0, 4], "target": [0, 0, 0], "fov_y": 30}, "size": [64, 64],
  "materials": {"wall": {"diffuse": [0.5, 0.25, 0], "specular": 0.2}},
  "objects": [{"primitive": "plane", "rotate": [90, 0, 0], "scale": 4, "material": "wall", "name": "wall"}],
  "lights": [{"name": "near", "type": "spot", "position": [0, 0, 1], "direction": [0, 0, -1], "cutoff": 20, "shadow": true},
             {"name": "lamp", "type": "point", "position": [0, 0, 2], "shadow": true},
             {"type": "directional", "direction": [0, 0, -1], "shadow": true},
             {"type": "point", "position": [0, 0, 3]}]})";

class ShowCommand : public ProgramTest {
 protected:
  ShowCommand() { writeText(folder / "wall.json", kWall); }
  /// The sRGB codes at a share of the width and height.
  std::vector<int> codesAt(const std::string& file, double x = 0.5, double y = 0.5) const {
    const Image image = readImage(folder / file);
    const std::size_t at =
        (std::size_t(y * image.height) * image.width + std::size_t(x * image.width)) * image.channels.size();
    std::vector<int> codes;
    for (std::size_t c = 0; c < 3; ++c)
      codes.push_back(int(std::lround(255 * encodeSrgb(image.pixels[at + c]))));
    return codes;
  }
};

using Codes = std::vector<int>;

TEST_F(ShowCommand, ShowsLayersOfAGBufferByTheirNameOrByWhatTheyHold) {
  succeed("luciole gbuffer wall.json --quiet -o g.exr");
  succeed(
      "luciole show g.exr --layer N --quiet -o n.png && luciole show g.exr --layer normal --quiet -o "
      "normal.png");
  EXPECT_EQ(codesAt("n.png"), (Codes{128, 128, 255}));
  EXPECT_EQ(codesAt("normal.png"), (Codes{128, 128, 255}));
  EXPECT_EQ(readImage(folder / "n.png").width, 64);
  succeed("luciole show g.exr --layer diffuse --dither off --quiet -o d.png");
  EXPECT_EQ(codesAt("d.png"), (Codes{188, 137, 0}));
  succeed("luciole show g.exr --layer diffuse --exposure 1 --quiet -o bright.png");
  EXPECT_EQ(codesAt("bright.png")[0], 255);
  EXPECT_THAT(told("luciole show g.exr --layer P -o p.png"),
              HasSubstr("p.png: P: red, green and blue are x from"));
  succeed("luciole show g.exr --layer depth --quiet -o z.jpg");
  EXPECT_GT(readImage(folder / "z.jpg").height, readImage(folder / "z.jpg").width) << "a bar below it";
}

TEST_F(ShowCommand, ALayerThatIsNotThereIsToldWithThoseThatAre) {
  succeed("luciole gbuffer wall.json --quiet -o g.exr");
  refuse("luciole show g.exr -o x.png", 2, "g.exr: which layer? Expected one of ");
  refuse("luciole show g.exr --layer difuse -o x.png", 2, "no layer difuse; did you mean diffuse?");
  refuse("luciole show g.exr --layer nothing -o x.png", 2, "expected one of ");
  refuse("luciole show wall.json -o x.png", 2, "wall.json: not an EXR file");
  refuse("luciole show none.exr -o x.png", 2, "none.exr");
  EXPECT_FALSE(std::filesystem::exists(folder / "x.png"));
}

TEST_F(ShowCommand, ShowsLayersOfAPictureAndItsColorsWithoutAName) {
  succeed(
      "luciole render wall.json --aov object_id,light_count,cryptomatte,light_error --light-error 1/4 "
      "--quiet -o p.exr");
  for (const char* layer : {"object_id", "light_count", "CryptoObject00", "light_error", "color"})
    succeed(std::string("luciole show p.exr --quiet -o x.png --layer ") + layer);
  succeed(
      "luciole show p.exr --dither off --quiet -o shown.png && luciole render wall.json --dither off --quiet "
      "-o rendered.png");
  EXPECT_EQ(codesAt("shown.png"), codesAt("rendered.png"));
}

TEST_F(ShowCommand, AovOfAPictureIsThatLayer) {
  succeed("luciole render wall.json --aov normal --samples 4 --quiet -o n.png");
  EXPECT_EQ(codesAt("n.png"), (Codes{128, 128, 255}));
  // Light's parts have the picture's exposure, once.
  succeed(
      "luciole render wall.json --aov diffuse_light --exposure -1 --quiet -o d.exr && luciole show d.exr "
      "--layer "
      "diffuse_light --dither off --quiet -o shown.png");
  succeed("luciole render wall.json --aov diffuse_light --exposure -1 --dither off --quiet -o d.png");
  EXPECT_EQ(codesAt("d.png"), codesAt("shown.png"));
  succeed("luciole render wall.json --aov cryptomatte_object --samples 2 --quiet -o m.png");
  succeed("luciole render wall.json --aov depth --crop 8,8,32,16 --frames 1-2 --quiet -o z.#.png");
  EXPECT_TRUE(std::filesystem::exists(folder / "z.2.png"));
  succeed(
      "luciole gbuffer wall.json --quiet -o g.exr && luciole shade g.exr --scene wall.json --aov normal "
      "--quiet -o s.png");
  EXPECT_EQ(codesAt("s.png"), (Codes{128, 128, 255}));
  for (const char* several : {"normal,depth", "material", "cryptomatte"})
    refuse(std::string("luciole render wall.json -o x.png --aov ") + several, 2,
           "several layers, and x.png shows one, such as --aov normal");
}

TEST_F(ShowCommand, WithoutALayerShowsTheColorsByTheNamesOfOtherPrograms) {
  const std::string show = "luciole show '" LUCIOLE_SOURCE_DIR "/tests/fuzz/corpus/blender.exr' --quiet ";
  succeed(show + "-o colors.exr && " + show + "--layer Combined -o combined.exr");
  EXPECT_EQ(readImage(folder / "colors.exr").pixels, readImage(folder / "combined.exr").pixels);
}

TEST_F(ShowCommand, GBufferShowsALayer) {
  succeed("luciole gbuffer wall.json --aov normal --quiet -o n.png");
  EXPECT_EQ(codesAt("n.png"), (Codes{128, 128, 255}));
  succeed("luciole gbuffer wall.json --aov specular --quiet -o s.png");
  refuse("luciole gbuffer wall.json -o n.png", 2, "--aov to say which to show");
  refuse("luciole gbuffer wall.json --aov normal -o n.exr", 2, "n.exr has all layers");
  refuse("luciole gbuffer wall.json --aov normals -o x.png", 2, "--aov: no layer normals");
}

TEST_F(ShowCommand, ParallelViewsHaveDepthsAndIdsToo) {
  writeText(folder / "flat.json",
            std::string(kWall).replace(std::string(kWall).find("\"fov_y\": 30"), 11, "\"orthographic\": 1"));
  succeed(
      "luciole render flat.json --aov object_id,depth --quiet -o p.exr && luciole show p.exr --layer Z "
      "--quiet -o z.png && "
      "luciole show p.exr --layer object_id --quiet -o id.png");
}

class ShadowMapCommand : public ShowCommand {
 protected:
  std::vector<float> channel(const std::string& file, const std::string& name) const {
    const Image image = readImage(folder / file);
    std::vector<float> values;
    for (std::size_t c = 0; c < image.channels.size(); ++c)
      if (image.channels[c] == name)
        for (std::size_t at = c; at < image.pixels.size(); at += image.channels.size())
          values.push_back(image.pixels[at]);
    return values;
  }
};

TEST_F(ShadowMapCommand, HoldsMetresFromTheLight) {
  succeed("luciole shadow-map wall.json --light near --shadow-size 32 --quiet -o near.exr");
  const std::vector<float> near = channel("near.exr", "Z");
  ASSERT_FALSE(near.empty());
  // Along the cone's axis, wherever on the wall.
  for (const float metres : near) EXPECT_NEAR(metres, 1, 1e-5);
}

TEST_F(ShadowMapCommand, HasSixFacesOfAPointLightAndCascadesOfASun) {
  succeed("luciole shadow-map wall.json --light 1 --shadow-size 64 --quiet -o lamp.exr");
  // Up to the border, the plane's edge, of which lookups read a little more.
  const std::vector<float> ahead = channel("lamp.exr", "negative_z.Z");
  ASSERT_FALSE(ahead.empty());
  const std::size_t side = std::size_t(std::lround(std::sqrt(double(ahead.size()))));
  EXPECT_NEAR(ahead[side * side / 2 + side / 2], 2, 1e-5);
  const std::vector<float> behind = channel("lamp.exr", "positive_z.Z");
  ASSERT_FALSE(behind.empty());
  for (const float metres : behind) EXPECT_EQ(metres, std::numeric_limits<float>::infinity());
  succeed("luciole shadow-map wall.json --light 2 --shadow-size 64 --quiet -o sun.exr");
  const std::vector<float> sun = channel("sun.exr", "cascade0.Z");
  ASSERT_FALSE(sun.empty());
  EXPECT_LT(*std::min_element(sun.begin(), sun.end()), 1e-3) << "the wall is the first thing that it meets";
  for (const char* light : {"near", "lamp", "2"})
    succeed(std::string("luciole shadow-map wall.json --shadow-size 64 --quiet -o x.png --light ") + light);
  succeed("luciole show lamp.exr --layer negative_z --quiet -o face.png");
}

TEST_F(ShadowMapCommand, LightsWithoutShadowsOrThatAreNotThereAreTold) {
  refuse("luciole shadow-map wall.json --light 3 -o x.png", 2,
         "casts no shadow in wall.json; with --cast-shadows all it does");
  succeed("luciole shadow-map wall.json --light 3 --cast-shadows all --shadow-size 64 --quiet -o x.png");
  refuse("luciole shadow-map wall.json --light 4 -o x.png", 2, "wall.json has the lights 0 to 3");
  refuse("luciole shadow-map wall.json --light lmap -o x.png", 2, "did you mean lamp?");
  writeText(folder / "empty.json",
            R"({"lights": [{"type": "point", "position": [0, 0, 0], "shadow": true}]})");
  refuse("luciole shadow-map empty.json --light 0 -o x.png", 2, "empty.json: has no surface");
}

using SetOption = ShowCommand;

TEST_F(SetOption, EqualsAFileThatSaysIt) {
  writeText(folder / "green.json",
            std::string(kWall).replace(std::string(kWall).find("[0.5, 0.25, 0]"), 14, "[0, 0.5, 0]"));
  const std::string made = succeed("luciole render green.json --hash --quiet -o a.png");
  const std::string set =
      succeed("luciole render wall.json --set 'materials.wall.diffuse=[0,0.5,0]' --hash --quiet -o a.png");
  EXPECT_EQ(made, set);
  EXPECT_THAT(succeed("luciole info wall.json --set lights=[]"), HasSubstr("lights       0"));
  for (const char* command :
       {"gbuffer wall.json", "reference wall.json", "render wall.json", "info wall.json"})
    refuse(std::string("luciole ") + command + " --set materials.wal.diffuse=1" +
               (command[0] == 'i' ? "" : " -o x.exr"),
           2, "did you mean wall?");
}

using SweepOption = ShowCommand;

TEST_F(SweepOption, MakesASheetOfTheSamePicturesAsSet) {
  const std::string line = told(
      "luciole render wall.json --sweep 'materials.wall.diffuse=[0,0,0],[1,0,0],0.25' --dither off -o s.png");
  EXPECT_THAT(line, HasSubstr("s.png: 3 pictures of 64x64"));
  EXPECT_TRUE(isOneLine(line)) << line;
  const Image sheet = readImage(folder / "s.png");
  EXPECT_GE(sheet.width, 480);
  succeed("luciole render wall.json --set 'materials.wall.diffuse=[1,0,0]' --dither off --quiet -o one.png");
  EXPECT_EQ(codesAt("s.png", 0.5, 0.4), codesAt("one.png", 0.5, 0.4));
}

TEST_F(SweepOption, OfTwoMakesRowsAndColumns) {
  succeed(
      "luciole render wall.json --sweep materials.wall.specular=0,1 --sweep lights[1].intensity=0,1,2 "
      "--quiet -o s.png");
  const Image sheet = readImage(folder / "s.png");
  EXPECT_GT(sheet.height, sheet.width) << "two columns, three rows";
}

TEST_F(SweepOption, WithAPlaceForANumberMakesAFileEach) {
  succeed(
      "luciole render wall.json --sweep materials.wall.shininess=1,8 --stats s.#.json --aov depth --hash "
      "--quiet -o s.#.exr");
  for (const char* file : {"s.1.exr", "s.2.exr", "s.1.json", "s.2.json"})
    EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
}

TEST_F(SweepOption, AllPicturesHaveTheExposureOfTheFirst) {
  const std::string line =
      told("luciole render wall.json --exposure auto --sweep lights[1].intensity=1,4 -o s.png");
  EXPECT_THAT(line, HasSubstr("all with the exposure of the first"));
  EXPECT_LT(codesAt("s.png", 0.4, 0.2), codesAt("s.png", 0.9, 0.2));
}

TEST_F(SweepOption, WhatMakesNoSenseIsTold) {
  const std::string render = "luciole render wall.json -o s.png --sweep materials.wall.shininess=1,8 ";
  refuse(render + "--stats -", 2, "--stats: is of one picture");
  refuse(render + "--frames 1-2", 2, "--sweep: makes pictures of one frame");
  refuse(render + "--probe 3,3", 2, "--probe: is of one picture");
  refuse(render + "--sweep ambient=1 --sweep ambient=2", 2, "expected one, or two");
  refuse("luciole render wall.json -o s.png --sweep materials.wall.shininess", 2,
         "--sweep materials.wall.shininess: expected PATH=VALUE");
  refuse("luciole render wall.json -o s.png --sweep ambient=1,", 2, "a value is empty");
  refuse("luciole render wall.json -o s.png --sweep materials.wal.shininess=1,2", 2, "did you mean wall?");
  refuse("luciole render wall.json -o s.png --sweep 'size=[64,64],[32,32]'", 2,
         "the pictures differ in size");
}

TEST_F(ShowCommand, DrawsALampsProfile) {
  // 100 cd within 60 degrees of straight down, and nothing above.
  writeText(folder / "lamp.ies",
            "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 4 1 1 2 0 0 0\n1 1 50\n0 59.9 60.1 180\n0\n100 100 0 0\n");
  const auto shown = run("luciole show " + (folder / "lamp.ies") + " -o " + (folder / "lamp.png"));
  EXPECT_EQ(shown.status, 0) << shown.err;
  const Image image = readImage(folder / "lamp.png");
  EXPECT_GT(image.width, 960);
  const auto at = [&](int x, int y) {
    return &image.pixels[(std::size_t(y) * image.width + x) * image.channels.size()];
  };
  // Halfway down the left picture it is filled, amber; halfway up it is white paper.
  EXPECT_GT(at(250, 340)[0] - at(250, 340)[2], 0.4f);
  EXPECT_GT(at(250, 130)[2], 0.5f);
  // On the wall light is below the lamp, which hangs 0.8 m below the upper edge.
  const int wall = image.width - 240;
  EXPECT_GT(at(wall, 240)[1], 0.05f);
  EXPECT_EQ(at(wall, 40)[1], 0.0f);
}

}  // namespace
}  // namespace luciole::test
