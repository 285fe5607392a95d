// Where the program's files go, and what is written into them beside the picture.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "image/srgb.hpp"
#include "luciole/gbuffer_file.hpp"
#include "luciole/image.hpp"
#include "luciole/load_scene.hpp"
#include "luciole/pose.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using ::testing::HasSubstr;

class Outputs : public ProgramTest {
 protected:
  Outputs() { writeText(folder / "scene.json", kSmallScene); }
};

TEST_F(Outputs, FifosAreWrittenThrough) {
  succeed("luciole render scene.json --quiet -o file.png && luciole render scene.json --quiet -o file.exr");
  for (const std::string extension : {"png", "exr"}) {
    const std::string name = "fifo." + extension;
    // In a time, so that a program that replaces the FIFO doesn't leave its reader waiting.
    succeed("mkfifo " + name + " && { timeout 60 cat " + name + " > read." + extension +
            " & } && luciole render scene.json --quiet -o " + name + "; status=$?; test -p " + name +
            " || { echo replaced; kill $!; }; wait; test $status = 0 && test -p " + name);
    expectSamePicture("file." + extension, "read." + extension);
  }
  succeed(
      "mkfifo s && { timeout 60 cat s > stats.json & } && luciole render scene.json --quiet -o a.png --stats "
      "s; "
      "test -p s && wait");
  EXPECT_EQ(nlohmann::json::parse(readText(folder / "stats.json")).at("image").at("width"), 96);
  succeed(
      "mkfifo j && { timeout 60 cat j > compared.json & } && luciole compare file.png file.exr --json j && "
      "wait");
  EXPECT_GT(nlohmann::json::parse(readText(folder / "compared.json")).at("pixels"), 0);
}

TEST_F(Outputs, LinksStayWhereTheyAre) {
  std::filesystem::create_directory(folder / "disk");
  succeed("ln -s disk/real.png link.png && ln -s disk/real.json link.json");
  succeed("luciole render scene.json --quiet -o link.png --stats link.json");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.png"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.json"));
  EXPECT_EQ(readImage(folder / "disk/real.png").width, 96);
  EXPECT_FALSE(nlohmann::json::parse(readText(folder / "disk/real.json")).empty());
  refuse("ln -s gone/real.png lost.png && luciole render scene.json -o lost.png", 2, "lost.png");
}

TEST_F(Outputs, FormatSaysWhatANameDoesNot) {
  succeed("luciole render scene.json --quiet -o file.exr && luciole gbuffer scene.json --quiet -o g.exr");
  succeed("luciole render scene.json --quiet --format exr -o - > piped");
  expectSamePicture("file.exr", "piped");
  succeed(
      "luciole gbuffer scene.json --quiet --format exr -o - > pipedg && "
      "luciole shade pipedg --scene scene.json --format exr -o shaded --quiet");
  expectSamePicture("file.exr", "shaded");
  succeed(
      "luciole reference scene.json --quiet --size 16x9 --format exr -o reference && "
      "luciole compare reference reference --max-abs 0");
  succeed(
      "ln -s /dev/null nothing && luciole render scene.json --quiet --format png -o nothing && test -L "
      "nothing");
  refuse("luciole render scene.json --quiet -o nothing", 2, "--format");
  refuse("luciole render scene.json --quiet --format pgn -o nothing", 2, "pgn");
  refuse("luciole render scene.json --quiet --format png --aov normal,depth -o out.exr", 2, "--aov");
  refuse("luciole gbuffer scene.json --quiet --format png -o out.exr", 2, "expected .exr");
  refuse("ln -s /dev/full full && luciole render scene.json --quiet --format png -o full", 3,
         "No space left");
  EXPECT_EQ(readText(folder / "piped").substr(0, 4), "\x76\x2f\x31\x01");
}

TEST_F(Outputs, WhatStandardOutputDoesNotTakeIsTold) {
  for (const char* refusing : {" >/dev/full", " >&-"})
    for (const char* command : {"info scene.json", "--version", "help render",
                                "render scene.json --hash --quiet -o out.png", "compare out.png out.png"})
      refuse(std::string("luciole ") + command + refusing, 3, "write");
}

TEST_F(Outputs, AFullOrClosedStandardErrorChangesNothing) {
  for (const char* refusing : {" 2>/dev/full", " 2>&-"}) {
    succeed(std::string("luciole render scene.json -o out.png") + refusing);
    EXPECT_EQ(runLine(folder, std::string("luciole render nothing.json -o no.png") + refusing).status, 2);
    EXPECT_EQ(runLine(folder, std::string("luciole unknown") + refusing).status, 2);
  }
}

TEST_F(Outputs, WithoutStandardStreamsFilesAreTheSame) {
  // Files that are opened first would have their numbers otherwise, and get what is printed.
  const std::string line = "luciole render scene.json --hash -o out.png";
  succeed(line);
  const std::string whole = readText(folder / "out.png");
  EXPECT_EQ(runLine(folder, line + " <&- >&- 2>&-").status, 3) << "the hash is lost";
  EXPECT_EQ(readText(folder / "out.png"), whole);
}

/// sRGB codes of a picture, from 0 to 255, not only whole ones.
std::vector<double> codesOf(const Image& image) {
  std::vector<double> codes;
  for (const float value : image.pixels) codes.push_back(encodeSrgb(value) * 255.0);
  return codes;
}

TEST_F(Outputs, PicturesOfEightBitsAreDitheredUnlessTold) {
  succeed(
      "luciole render scene.json --quiet -o a.exr && luciole render scene.json --quiet --dither off -o "
      "b.exr");
  expectSamePicture("a.exr", "b.exr");
  succeed(
      "luciole render scene.json --quiet -o on.png && luciole render scene.json --quiet --dither off -o "
      "off.png");
  const std::vector<double> exact = codesOf(readImage(folder / "a.exr")),
                            on = codesOf(readImage(folder / "on.png")),
                            off = codesOf(readImage(folder / "off.png"));
  // What a 16-bit code and its decoding in float leave of a code: less than 1e-3 of a step.
  int moved = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    ASSERT_LE(std::abs(off[i] - exact[i]), 0.501) << i;
    ASSERT_LT(std::abs(on[i] - exact[i]), 1.001) << i;
    moved += std::abs(on[i] - off[i]) > 0.5;
  }
  // Of values that lie anywhere between two steps, a quarter goes the other way.
  EXPECT_NEAR(double(moved) / double(exact.size()), 0.25, 0.1);

  // The grain belongs to the place in the whole picture, not to that in the file.
  succeed("luciole render scene.json --quiet --crop 13,9,40,30 -o crop.png");
  const Image whole = readImage(folder / "on.png"), crop = readImage(folder / "crop.png");
  for (int y = 0; y < crop.height; ++y)
    for (int i = 0; i < 3 * crop.width; ++i)
      ASSERT_EQ(crop.pixels[y * 3 * crop.width + i], whole.pixels[((y + 9) * whole.width + 13) * 3 + i]);

  // Nor does it change what is compared, or what a difference looks like.
  succeed(
      "luciole render scene.json --quiet --culling none -o none.png && luciole compare on.png none.png "
      "--max-abs 0");
  succeed("luciole compare a.exr on.png --diff diff.png && luciole compare a.exr on.png --diff diff.exr");
  const std::vector<double> shown = codesOf(readImage(folder / "diff.png")),
                            difference = codesOf(readImage(folder / "diff.exr"));
  for (std::size_t i = 0; i < shown.size(); ++i) ASSERT_LE(std::abs(shown[i] - difference[i]), 0.501) << i;
}

TEST_F(Outputs, BlackAndWhiteStayBlackAndWhite) {
  writeText(folder / "empty.json",
            R"({"camera": {"eye": [0,0,5], "target": [0,0,0]}, "lights": [], "objects": [],
    "background": [0, 1, 0]})");
  succeed("luciole render empty.json --size 64x64 --quiet -o a.png");
  const Image image = readImage(folder / "a.png");
  for (std::size_t i = 0; i < image.pixels.size(); ++i) ASSERT_EQ(image.pixels[i], i % 3 == 1 ? 1.0f : 0.0f);
}

TEST_F(Outputs, ExrsOfEveryCommandCarryCameraAndCommand) {
  succeed("luciole gbuffer scene.json --crop 8,4,40,30 --quiet -o g.exr");
  const GBuffer gbuffer = readGBuffer(folder / "g.exr");
  for (const std::string line :
       {"render scene.json --crop 8,4,40,30", "shade g.exr --scene scene.json",
        "reference scene.json --crop 8,4,40,30", "reference --gbuffer g.exr --scene scene.json",
        "render scene.json --frames 1-1 --crop 8,4,40,30"}) {
    const std::string name = line.find("frames") == std::string::npos ? "a.exr" : "a.#.exr";
    succeed("rm -f a.exr && luciole " + line + " --quiet -o " + name + " && mv a*.exr a.exr || true");
    for (const char* attribute : {"luciole:cameraToWorld", "luciole:projection"}) {
      EXPECT_NE(readAttribute(folder / "a.exr", attribute), "") << line;
      EXPECT_EQ(readAttribute(folder / "a.exr", attribute), readAttribute(folder / "g.exr", attribute))
          << line;
    }
    EXPECT_THAT(readAttribute(folder / "a.exr", "Software"), HasSubstr("Luciole")) << line;
    EXPECT_THAT(readAttribute(folder / "a.exr", "ImageDescription"), HasSubstr(line)) << line;
    for (const char* matrix : {"worldToCamera", "worldToNDC"})
      EXPECT_THAT(readText(folder / "a.exr"), HasSubstr(std::string(matrix) + '\0' + "m44f")) << line;
  }
  // With positions and normals a picture is a G-buffer, and where it lies is known from its header alone.
  succeed("luciole render scene.json --crop 8,4,40,30 --aov position,normal --quiet -o layers.exr");
  const GBuffer layers = readGBuffer(folder / "layers.exr");
  EXPECT_EQ(layers.picture_size, gbuffer.picture_size);
  EXPECT_EQ(layers.crop_origin, gbuffer.crop_origin);
  EXPECT_EQ(layers.camera.camera_to_world, gbuffer.camera.camera_to_world);
}

TEST_F(Outputs, ForeignGBuffersGiveTheirPictureNoCamera) {
  Image points{4, 3, {"P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z"}, {}};
  for (int i = 0; i < 12; ++i) points.pixels.insert(points.pixels.end(), {0.1f * i, 0, -2, 0, 0, 1});
  writeImage(points, folder / "g.exr", {});
  succeed("luciole shade g.exr --scene scene.json --quiet -o a.exr");
  EXPECT_EQ(readAttribute(folder / "a.exr", "luciole:cameraToWorld"), "");
  EXPECT_THAT(readText(folder / "a.exr"), testing::Not(HasSubstr("worldToCamera")));
}

TEST_F(Outputs, SizesHaveOneLimit) {
  for (const std::string size : {"32769x1", "1x32769", "40000x40000", "65536x100"})
    refuse("luciole render scene.json -o out.png --size " + size, 2,
           "--size: " + size + " pixels, expected 1 to 32768 a side");
  EXPECT_FALSE(std::filesystem::exists(folder / "out.png"));
}

}  // namespace
}  // namespace luciole::test
