// What relight and shade do with other programs' files, as a person types it. What is in the files and how it
// is found tests/gbuffer looks at.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

class RelightCommand : public ProgramTest {
 protected:
  RelightCommand() { writeText(folder / "scene.json", kSmallScene); }

  /// A wall of 8 × 6 pixels at z = −4, as another program might write it, and a grey picture of it.
  void writeWall(const std::string& position, const std::string& normal,
                 const std::string& components) const {
    Image wall{8, 6, {"R", "G", "B"}, {}};
    for (const std::string& layer : {position, normal})
      for (const char c : components) wall.channels.push_back(layer + "." + c);
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 8; ++x)
        for (const float value : {0.25f, 0.5f, 0.75f, float(x - 4), float(y - 3), -4.0f, 0.0f, 0.0f, 1.0f})
          wall.pixels.push_back(value);
    writeImage(wall, folder / "wall.exr", {});
    writeText(folder / "lamp.json", R"({"camera": {"eye": [0, 0, 5], "target": [0, 0, 0]}, "ambient": 0,
        "background": [1, 2, 3],
        "lights": [{"type": "point", "position": [0, 0, 0], "color": [1, 0.5, 0.25], "attenuation": [0, 0, 1], "intensity": 16}]})");
  }
};

TEST_F(RelightCommand, OfAGBufferFromHereDoesWhatShadeDoesAndSaysWhatItFound) {
  succeed(
      "luciole gbuffer scene.json --quiet -o g.exr && luciole shade g.exr --scene scene.json --quiet -o "
      "a.exr");
  const std::string told_lines = told("luciole relight g.exr --lights scene.json -o b.exr");
  EXPECT_THAT(told_lines,
              HasSubstr("g.exr: named as Luciole's: position = P, normal = N, depth = Z, diffuse = diffuse, "
                        "specular = specular, shininess = shininess"));
  EXPECT_THAT(told_lines, HasSubstr("g.exr: positions in world space, camera the file's"));
  expectSamePicture("a.exr", "b.exr");
  EXPECT_EQ(told("luciole relight g.exr --lights scene.json --quiet -o b.exr"), "");
  const std::string events = told("luciole relight g.exr --lights scene.json --log json -o b.exr");
  EXPECT_THAT(events, HasSubstr(R"("event":"layers")"));
  EXPECT_THAT(events, HasSubstr("named as Luciole's"));
}

TEST_F(RelightCommand, AGBufferOfAGltfHasTheCoefficientsOfItsModel) {
  writeText(folder / "metal.gltf",
            R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
      "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.6, 0.3, 1], "roughnessFactor": 0.3}}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"}]})");
  for (const std::string model : {"phong", "cook-torrance"}) {
    const std::string with = " --quiet --model " + model + " ";
    succeed("luciole render metal.gltf --size 64x36" + with + "-o " + model + ".exr");
    succeed("luciole gbuffer metal.gltf --size 64x36" + with + "-o g.exr");
    succeed("luciole shade g.exr --scene metal.gltf" + with + "-o shaded.exr");
    expectSamePicture(model + ".exr", "shaded.exr");
  }
  EXPECT_EQ(runLine(folder, "luciole compare phong.exr cook-torrance.exr --max-abs 1e-3").status, 1);
}

TEST_F(RelightCommand, BothCommandsUnderstandOtherProgramsNames) {
  writeWall("ViewLayer.Position", "ViewLayer.Normal", "XYZ");
  succeed("luciole relight wall.exr --lights lamp.json --quiet -o blender.exr");
  writeWall("P", "N", "rgb");
  succeed("luciole relight wall.exr --lights lamp.json --quiet -o python.exr");
  succeed("luciole shade wall.exr --scene lamp.json --quiet -o shaded.exr");
  writeWall("where", "facing", "xyz");
  succeed(
      "luciole relight wall.exr --lights lamp.json --channels position=where,normal=facing --quiet -o "
      "told.exr");
  for (const char* other : {"python.exr", "shaded.exr", "told.exr"}) expectSamePicture("blender.exr", other);
  // Straight ahead the lamp of 16 is 4 m away: 16 · 0.8 / 4².
  EXPECT_NEAR(readImage(folder / "told.exr").pixels[(3 * 8 + 4) * 3], 0.8f, 1e-6f);
}

TEST_F(RelightCommand, PixelsThatAreWiderThanHighAreSeenSo) {
  // A wall 4 m ahead, of which the file tells depth alone. The camera is the scene's, 45 degrees high.
  constexpr int kSide = 8;
  Image depth{kSide, kSide, {"Z"}, std::vector<float>(kSide * kSide, 4.0f)};
  const Display display{.origin = {3, -2}, .pixel_aspect = 2};
  writeImage(depth, folder / "depth.exr", {}, {.display = display});
  writeText(folder / "eye.json", R"({"camera": {"eye": [0, 0, 5], "target": [0, 0, 0]}, "ambient": 0,
      "lights": [{"type": "point", "position": [0, 0, 5], "color": 16, "attenuation": [0, 0, 1]}]})");
  const std::string said = told("luciole relight depth.exr --lights eye.json -o lit.exr");
  EXPECT_THAT(said, HasSubstr("depth.exr: pixels are 2 times as wide as high (pixelAspectRatio)"));
  EXPECT_THAT(said, HasSubstr("depth.exr: the display window begins at (3, -2)"));
  const Image lit = readImage(folder / "lit.exr");
  EXPECT_EQ(lit.display, display);
  const double half_height = std::tan(glm::radians(22.5));
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const glm::dvec3 to_point(4 * 2 * half_height * (2 * (x + 0.5) / kSide - 1),
                                4 * half_height * (1 - 2 * (y + 0.5) / kSide), -4);
      const double d = glm::length(to_point);
      // Some 30 roundings of 2^-24, with those of positions that normals are made of.
      EXPECT_NEAR(lit.pixels[std::size_t(3 * (y * kSide + x))], 16 * 0.8 * (4 / d) / (d * d), 2e-6)
          << x << ", " << y;
    }
  EXPECT_THAT(succeed("luciole info lit.exr --json -"), HasSubstr(R"("pixel_aspect": 2.0)"));
  EXPECT_THAT(succeed("luciole info lit.exr"),
              HasSubstr("8x8, pixels 2 times as wide as high, display window from (3, -2) on"));
}

TEST_F(RelightCommand, AddLaysTheLightAloneOverThePicture) {
  writeWall("P", "N", "XYZ");
  succeed("luciole relight wall.exr --lights lamp.json --quiet -o alone.exr");
  succeed("luciole relight wall.exr --lights lamp.json --add --quiet -o sum.exr");
  succeed("luciole relight wall.exr --lights lamp.json --add --exposure 1 --quiet -o bright.exr");
  const Image alone = readImage(folder / "alone.exr"), sum = readImage(folder / "sum.exr"),
              bright = readImage(folder / "bright.exr");
  ASSERT_EQ(sum.channels, (std::vector<std::string>{"R", "G", "B"}));
  for (std::size_t pixel = 0; pixel < 48; ++pixel)
    for (std::size_t c = 0; c < 3; ++c) {
      const float own = 0.25f * float(c + 1);
      EXPECT_EQ(sum.pixels[pixel * 3 + c], own + alone.pixels[pixel * 3 + c]);
      EXPECT_EQ(bright.pixels[pixel * 3 + c], 2 * sum.pixels[pixel * 3 + c]);
    }
}

// The picture goes to what no added light gives, unless its file has groups of its own: then they grow.
TEST_F(RelightCommand, AddedLightsAreLayersByTheirGroups) {
  writeWall("P", "N", "XYZ");
  writeText(folder / "lamps.json",
            R"({"camera": {"eye": [0, 0, 5], "target": [0, 0, 0]}, "ambient": 0.125, "lights": [
      {"type": "point", "position": [0, 0, 1], "intensity": 4, "attenuation": [0, 0, 1], "group": "key"},
      {"type": "point", "position": [1, 1, 1], "intensity": 3, "attenuation": [0, 0, 1]}]})");
  const std::string add = " --lights lamps.json --add --light-groups --quiet ";
  succeed("luciole relight wall.exr" + add + "-o first.exr");
  succeed("luciole relight wall.exr --lights lamps.json --light-groups --quiet -o alone.exr");
  const auto at = [](const Image& image, std::size_t pixel, const std::string& channel) {
    const auto found = std::find(image.channels.begin(), image.channels.end(), channel);
    EXPECT_NE(found, image.channels.end()) << channel;
    return double(image.pixels[pixel * image.channels.size() + std::size_t(found - image.channels.begin())]);
  };
  const Image wall = readImage(folder / "wall.exr"), first = readImage(folder / "first.exr"),
              alone = readImage(folder / "alone.exr");
  for (std::size_t pixel = 0; pixel < 48; ++pixel) {
    EXPECT_EQ(at(first, pixel, "light_groups.key.G"), at(alone, pixel, "light_groups.key.G"));
    EXPECT_EQ(at(first, pixel, "light_groups.default.G"), at(alone, pixel, "light_groups.default.G"));
    EXPECT_EQ(at(first, pixel, "light_groups.rest.G"),
              float(at(wall, pixel, "G") + at(alone, pixel, "light_groups.rest.G")));
    // Four sums of numbers below 8.
    EXPECT_NEAR(at(first, pixel, "G"),
                at(first, pixel, "light_groups.key.G") + at(first, pixel, "light_groups.default.G") +
                    at(first, pixel, "light_groups.rest.G"),
                4 * 4 * 0x1p-24 * 4);
  }
  succeed("luciole mix first.exr --light-mixer key=0,default=0 --quiet -o rest.exr");

  // A picture with groups: its G-buffer and layers in one file, as render writes them.
  writeText(folder / "box.json",
            R"({"camera": {"eye": [0, 0, 3], "target": [0, 0, 0]}, "size": [16, 9], "ambient": 0.25,
      "objects": [{"primitive": "box"}], "lights": [{"type": "point", "position": [0, 1, 3], "group": "key"},
                                                    {"type": "point", "position": [1, 0, 3], "group": "fill"}]})");
  succeed("luciole render box.json --aov position,normal,diffuse --light-groups --quiet -o box.exr");
  succeed("luciole relight box.exr --exposure 1" + add + "-o more.exr");
  const Image box = readImage(folder / "box.exr"), more = readImage(folder / "more.exr");
  succeed("luciole relight box.exr --lights lamps.json --light-groups --quiet -o lamps.exr");
  const Image lamps = readImage(folder / "lamps.exr");
  for (std::size_t pixel = 0; pixel < 144; ++pixel) {
    EXPECT_EQ(at(more, pixel, "light_groups.fill.R"), 2 * at(box, pixel, "light_groups.fill.R"));
    EXPECT_EQ(
        at(more, pixel, "light_groups.key.R"),
        2 * double(float(at(box, pixel, "light_groups.key.R") + at(lamps, pixel, "light_groups.key.R"))));
    EXPECT_EQ(at(more, pixel, "light_groups.default.R"), 2 * at(lamps, pixel, "light_groups.default.R"));
    double sum = 0;
    for (const char* group : {"fill", "key", "default", "rest"})
      sum += at(more, pixel, std::string("light_groups.") + group + ".R");
    EXPECT_NEAR(at(more, pixel, "R"), sum, 16 * 8 * 0x1p-24);
  }
}

TEST_F(RelightCommand, AddLeavesWhatThePictureHasAlready) {
  // Emission, background and the fog's own colour are in it.
  writeText(
      folder / "dark.json",
      R"({"ambient": 0, "background": [5, 5, 5], "fog": {"mode": "exp", "density": 0.5, "color": [3, 3, 3]},
      "lights": [{"type": "point", "position": [0, 900, 0], "range": 1}]})");

  Image file{
      96,
      54,
      {"R", "G", "B", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "emission.R", "emission.G", "emission.B"},
      {}};
  for (int i = 0; i < 96 * 54; ++i)
    for (const float value : {0.5f, 0.25f, 0.125f, 0.0f, 0.0f, i % 2 ? -3.0f : 0.0f, 0.0f, 0.0f,
                              i % 2 ? 1.0f : 0.0f, 7.0f, 7.0f, 7.0f})
      file.pixels.push_back(value);
  writeImage(file, folder / "in.exr", {});
  succeed("luciole relight in.exr --lights dark.json --add --quiet -o sum.exr");
  const Image sum = readImage(folder / "sum.exr");
  for (std::size_t pixel = 0; pixel < 96 * 54; ++pixel) {
    EXPECT_EQ(sum.pixels[pixel * 3], 0.5f);
    EXPECT_EQ(sum.pixels[pixel * 3 + 2], 0.125f);
  }
}

TEST_F(RelightCommand, TheScenesCameraCountsWhereTheFileHasNone) {
  writeWall("P", "N", "XYZ");
  EXPECT_THAT(told("luciole relight wall.exr --lights lamp.json -o a.exr"), HasSubstr("camera the scene's"));
  EXPECT_THAT(told("luciole relight wall.exr --lights lamp.json --camera-to-world "
                   "'1 0 0 0  0 1 0 0  0 0 1 5  0 0 0 1' -o b.exr"),
              HasSubstr("camera as told"));
  expectSamePicture("a.exr", "b.exr");
  succeed(
      "luciole relight wall.exr --lights lamp.json --camera-to-world '-1,0,0,0,0,1,0,0,0,0,-1,5,0,0,0,1' "
      "--quiet -o c.exr");
}

TEST_F(RelightCommand, WhatItCannotDoIsOneLine) {
  writeWall("where", "facing", "xyz");
  writeImage({2, 2, {"R", "G", "B"}, std::vector<float>(12, 0.5f)}, folder / "picture.exr", {});
  writeText(folder / "objects.json", R"({"objects": [{"primitive": "box"}]})");
  const std::string relight = "luciole relight wall.exr --lights lamp.json -o a.exr ";
  refuse("luciole relight picture.exr --lights lamp.json -o a.exr", 2,
         "picture.exr: no layer that is known to hold positions or depths among the channels B, G, R; "
         "luciole relight "
         "--channels ROLE=NAME,... says which layer is which");
  refuse("luciole shade picture.exr --scene lamp.json -o a.exr", 2, "among the channels B, G, R;");
  refuse("luciole relight missing.exr --lights lamp.json -o a.exr", 2, "missing.exr: no such file");
  refuse(relight + "--channels position=Pw", 2, "wall.exr: position Pw: no such layer among the channels");
  refuse(relight + "--channels postion=where", 2, "did you mean position?");
  refuse(relight + "--channels position", 2, "--channels position: expected ROLE=NAME");
  refuse(relight + "--camera-to-world '1 2 3'", 2, "--camera-to-world 1 2 3: expected 16 numbers");
  refuse(relight + "--camera-to-world '2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1'", 2,
         "of a rotation and a translation");
  refuse(relight + "--add --alpha", 2, "--add: keeps the picture's own A");
  refuse("luciole relight wall.exr --lights lamp.gltf --albedo -o a.exr", 2,
         "--albedo: the lights of lamp.gltf are");
  refuse("luciole relight wall.exr --lights objects.json -o a.exr", 2, "objects.json: no lights");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
}

}  // namespace
}  // namespace luciole::test
