// `luciole reference`, as a person would type it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

class ReferenceCommand : public ProgramTest {
 protected:
  ReferenceCommand() { writeText(folder / "scene.json", kSmallScene); }
  std::vector<float> pixels(const std::string& name) { return readImage(folder / name).pixels; }
};

TEST_F(ReferenceCommand, IsThePictureWithoutShadows) {
  succeed("luciole reference scene.json --shadows off -o truth.exr");
  succeed("luciole render scene.json --shadows off -o ours.exr");
  // The promise is 1e-5 of the maximum, which is below 4 in this scene.
  succeed("luciole compare truth.exr ours.exr --max-abs 4e-5");
}

TEST_F(ReferenceCommand, SaysHowTheGBufferDid) {
  const Outcome outcome = runLine(folder, "luciole reference scene.json -o truth.exr --stats stats.json");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find("G-buffer against rays"), std::string::npos) << outcome.err;
  const auto stats = nlohmann::json::parse(readText(folder / "stats.json"));
  EXPECT_EQ(stats["counts"]["pixels_shaded"], 96 * 54);
  EXPECT_EQ(stats["counts"]["gbuffer_pixels_unexplained"], 0);
  EXPECT_LT(stats["errors"]["gbuffer_position"], 1e-6);
  EXPECT_EQ(runLine(folder, "luciole reference scene.json -o truth.exr --quiet").err, "");
}

TEST_F(ReferenceCommand, ShadesAGBufferFromAFile) {
  succeed("luciole reference scene.json -o scene.exr");
  succeed("luciole gbuffer scene.json -o gbuffer.exr");
  succeed("luciole reference --gbuffer gbuffer.exr --scene scene.json -o file.exr");
  EXPECT_EQ(pixels("scene.exr"), pixels("file.exr"));
}

TEST_F(ReferenceCommand, CropIsACutOut) {
  succeed("luciole reference scene.json -o whole.exr");
  succeed("luciole reference scene.json --crop 20,10,30,20 -o part.exr");
  const Image whole = readImage(folder / "whole.exr"), part = readImage(folder / "part.exr");
  ASSERT_EQ(part.width, 30);
  ASSERT_EQ(part.height, 20);
  for (int y = 0; y < 20; ++y)
    for (int i = 0; i < 30 * 3; ++i)
      ASSERT_EQ(part.pixels[y * 90 + i], whole.pixels[((y + 10) * 96 + 20) * 3 + i]);
}

TEST_F(ReferenceCommand, GrowsCropByCrop) {
  succeed("luciole reference scene.json -o whole.exr");
  succeed("luciole reference scene.json --crop 0,0,96,20 -o parts.exr");
  succeed("luciole reference scene.json --crop 0,15,96,20 -o parts.exr");
  refuse("luciole reference scene.json --crop 0,40,96,14 -o parts.exr", 2, "0,0,96,35");
  succeed("luciole reference scene.json --crop 0,35,96,19 -o parts.exr");
  EXPECT_EQ(pixels("parts.exr"), pixels("whole.exr"));
  // A part of another picture is not added to this one, but replaces it.
  succeed("luciole reference scene.json --model blinn-phong --crop 0,0,96,10 -o parts.exr");
  EXPECT_EQ(readImage(folder / "parts.exr").height, 10);
}

TEST_F(ReferenceCommand, APartOfAnotherStateOfATextureOrMeshIsNotGrownButReplaced) {
  const auto writeTexture = [&](float red) {
    writeImage({2, 2, {"R", "G", "B"}, {red, 0, 0, 0, red, 0, 0, 0, red, red, red, red}}, folder / "map.png",
               {});
  };
  const auto writeMesh = [&](double height) {
    writeText(folder / "roof.obj",
              fmt::format("v -1 0 0\nv 1 0 0\nv 0 {} 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n", height));
  };
  writeTexture(1);
  writeMesh(1);
  writeText(folder / "parts.json",
            R"({"camera": {"eye": [0, 0.5, 3], "target": [0, 0.5, 0]}, "size": [32, 20],
    "materials": {"m": {"diffuse_map": "map.png"}}, "objects": [{"mesh": "roof.obj", "material": "m"}],
    "lights": [{"type": "directional", "direction": [0, 0, -1]}]})");
  const auto heightAfter = [&](const std::string& crop) {
    succeed("luciole reference parts.json --crop " + crop + " -o parts.exr");
    return readImage(folder / "parts.exr").height;
  };
  EXPECT_EQ(heightAfter("0,0,32,5"), 5);
  EXPECT_EQ(heightAfter("0,5,32,5"), 10);
  writeTexture(0.5);
  EXPECT_EQ(heightAfter("0,10,32,5"), 5) << "the rest shows another texture";
  EXPECT_EQ(heightAfter("0,5,32,5"), 10);
  writeMesh(1.5);
  EXPECT_EQ(heightAfter("0,0,32,5"), 5) << "the rest shows another mesh";
  // What was written again and is the same is the same.
  writeMesh(1.5);
  writeTexture(0.5);
  EXPECT_EQ(heightAfter("0,5,32,5"), 10);
}

TEST_F(ReferenceCommand, SomePixelsAreThoseOfTheWhole) {
  succeed("luciole reference scene.json -o whole.exr");
  succeed("luciole reference scene.json --pixels 100 --seed 4 -o some.exr");
  const Image whole = readImage(folder / "whole.exr"), some = readImage(folder / "some.exr");
  ASSERT_EQ(some.channels.size(), 4u);
  EXPECT_EQ(some.channels[3], "sampled");
  int sampled = 0;
  for (std::size_t i = 0; i < some.pixels.size() / 4; ++i) {
    if (some.pixels[4 * i + 3] == 0) continue;
    ++sampled;
    for (int c = 0; c < 3; ++c) ASSERT_EQ(some.pixels[4 * i + c], whole.pixels[3 * i + c]);
  }
  EXPECT_EQ(sampled, 100);
  succeed("luciole reference scene.json --pixels 100 --seed 5 -o other.exr");
  EXPECT_NE(pixels("some.exr"), pixels("other.exr"));
  succeed("luciole render scene.json --shadows off -o ours.exr");
  succeed("luciole reference scene.json --shadows off --pixels 100 -o some.exr");
  succeed("luciole compare some.exr ours.exr --max-abs 4e-5");
}

TEST_F(ReferenceCommand, RefusesWhatDoesNotGoTogether) {
  refuse("luciole reference -o a.exr", 2, "expected a scene");
  refuse("luciole reference scene.json --gbuffer g.exr --scene scene.json -o a.exr", 2, "expected a scene");
  refuse("luciole reference --gbuffer g.exr -o a.exr", 2, "go together");
  refuse("luciole reference --gbuffer g.exr --scene scene.json --size 2x2 -o a.exr", 2, "already");
  refuse("luciole reference scene.json --pixels 5 -o a.png", 2, ".exr");
  refuse("luciole reference scene.json --shadows pcf -o a.exr", 2, "--shadows");
  refuse("luciole reference scene.json --crop 90,0,10,10 -o a.exr", 2, "--crop");
}

}  // namespace
}  // namespace luciole::test
