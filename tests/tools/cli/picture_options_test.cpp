// What --half, --compression, --alpha, --bits and --crop make of a picture's file, as a person would type
// them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "image/layers.hpp"
#include "image/srgb.hpp"
#include "luciole/gbuffer_file.hpp"
#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<double> kBackground{0.2, 0.3, 0.4};  // kSmallScene's

class PictureFiles : public ProgramTest {
 protected:
  PictureFiles() { writeText(folder / "scene.json", kSmallScene); }
  Image read(const std::string& name) { return readImage(folder / name); }
  nlohmann::json stats() { return nlohmann::json::parse(readText(folder / "stats.json")); }

  /// Expects that a picture with A, laid over the background, is the picture without. Both are means of
  /// `samples` samples.
  void expectOverBackground(const std::string& with, const std::string& without, int samples,
                            double exposed) {
    const Image layer = read(with), whole = read(without);
    ASSERT_EQ(layer.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    ASSERT_EQ(whole.pixels.size() / 3, layer.pixels.size() / 4);
    for (std::size_t pixel = 0; pixel < whole.pixels.size() / 3; ++pixel) {
      const double alpha = layer.pixels[4 * pixel + 3];
      ASSERT_GE(alpha, 0);
      ASSERT_LE(alpha, 1);
      EXPECT_NEAR(alpha * samples, std::round(alpha * samples), samples * 0x1p-24) << "no share of samples";
      for (int c = 0; c < 3; ++c) {
        const double expected = whole.pixels[3 * pixel + c], background = kBackground[c] * exposed;
        const double over = layer.pixels[4 * pixel + c] + (1 - alpha) * background;
        // Each mean is a sum of n terms ≥ 0 (n − 1 roundings), times a factor (its own rounding and the
        // product's): (n + 1) 2⁻²⁴ of it at the most. A and the background are rounded once each, and exp2
        // errs by up to a last bit, which is two roundings.
        const double bound = 0x1p-24 * (2 * (samples + 1) * expected + 4 * background) * (1 + 0x1p-10);
        ASSERT_LE(std::abs(over - expected), bound) << with << " pixel " << pixel << " channel " << c;
      }
    }
  }
};

TEST_F(PictureFiles, HalfIsTheSamePictureRoundedAndSaysSo) {
  const std::string layers = " --aov position,normal,depth,diffuse,material,light_count,shadow";
  succeed("luciole render scene.json --quiet -o float.exr" + layers);
  const std::string said = told("luciole render scene.json --half -o half.exr --stats stats.json" + layers);
  EXPECT_THAT(said, HasSubstr("colours rounded by up to 2^-11 of themselves"));
  EXPECT_TRUE(isOneLine(said)) << said;
  EXPECT_EQ(stats()["errors"]["half_relative"], 0x1p-11);
  EXPECT_EQ(stats()["errors"]["half_absolute"], 0x1p-25);
  const Image whole = read("float.exr"), half = read("half.exr");
  ASSERT_EQ(whole.channels, half.channels);
  bool any_rounded = false;
  for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
    const std::string& name = whole.channels[i % whole.channels.size()];
    const bool is_color = name == "R" || name == "G" || name == "B" || name.find(".R") != std::string::npos ||
                          name.find(".G") != std::string::npos || name.find(".B") != std::string::npos;
    const double value = whole.pixels[i];
    if (half.pixels[i] == whole.pixels[i]) continue;  // an infinite depth, for one
    const double bound = is_color ? std::max(0x1p-11 * std::abs(value), 0x1p-25) : 0;
    ASSERT_LE(std::abs(half.pixels[i] - value), bound) << name;
    any_rounded = true;
  }
  EXPECT_TRUE(any_rounded);
  EXPECT_THAT(told("luciole render scene.json -o float.exr"), Not(HasSubstr("rounded")));
}

TEST_F(PictureFiles, PixelsTooBrightForAHalfAreCountedInOneWarning) {
  succeed("luciole render scene.json --exposure 18 --quiet -o float.exr");
  const Image whole = read("float.exr");
  int beyond = 0;
  for (std::size_t i = 0; i < whole.pixels.size(); i += 3)
    beyond += std::max({whole.pixels[i], whole.pixels[i + 1], whole.pixels[i + 2]}) > 65504;
  ASSERT_GT(beyond, 1);
  const std::string line = "luciole render scene.json --exposure 18 --half -o half.exr --stats stats.json";
  const std::string warning = fmt::format("half.exr: {} pixels were brighter than 65504", beyond);
  EXPECT_THAT(told(line), HasSubstr("luciole: warning: " + warning));
  ASSERT_EQ(stats()["warnings"].size(), 1u);
  EXPECT_THAT(std::string(stats()["warnings"][0]), HasSubstr(warning));
  EXPECT_EQ(told(line + " --quiet"), "");
  const Image half = read("half.exr");
  for (std::size_t i = 0; i < half.pixels.size(); ++i)
    ASSERT_NEAR(half.pixels[i], std::min(whole.pixels[i], 65504.0f), 0x1p-11 * half.pixels[i] + 0x1p-25);
}

TEST_F(PictureFiles, LosslessCompressionKeepsPicturesAndGBuffers) {
  succeed("luciole render scene.json --quiet -o usual.exr");
  EXPECT_EQ(readAttribute(folder / "usual.exr", "compression"), "zip");
  for (const std::string name : {"none", "rle", "zips", "zip", "piz"}) {
    const std::string choice = " --quiet --compression " + name;
    succeed("luciole render scene.json -o a.exr" + choice);
    expectSamePicture("usual.exr", "a.exr");
    EXPECT_EQ(readAttribute(folder / "a.exr", "compression"), name);
    succeed("luciole gbuffer scene.json -o g.exr" + choice +
            " && luciole shade g.exr --scene scene.json -o b.exr" + choice);
    expectSamePicture("usual.exr", "b.exr");
    EXPECT_EQ(readAttribute(folder / "g.exr", "compression"), name);
    EXPECT_EQ(readAttribute(folder / "b.exr", "compression"), name);
  }
}

TEST_F(PictureFiles, PngsAndExrsAreWrittenWithoutLoadingOpenImageIO) {
  // ld.so(8) then tells each file that it loads.
  for (const std::string name : {"a.png", "a.exr"}) {
    const std::string loaded = told("LD_DEBUG=files luciole render scene.json --quiet -o " + name);
    EXPECT_THAT(loaded, HasSubstr("libOpenEXR"));
    EXPECT_THAT(loaded, testing::Not(HasSubstr("OpenImageIO"))) << name;
  }
}

TEST_F(PictureFiles, CompressionOfAPngKeepsEveryCode) {
  succeed("luciole render scene.json --quiet -o usual.png");
  for (const std::string name : {"fast", "small"}) {
    succeed("luciole render scene.json --quiet --compression " + name + " -o a.png");
    expectSamePicture("usual.png", "a.png");
  }
  refuse("luciole gbuffer scene.json -o no.exr --compression small", 2,
         "no.exr: .exr has no such compression (--compression small), expected .png");
}

TEST_F(PictureFiles, LossyCompressionIsForPicturesAlone) {
  succeed("luciole render scene.json --quiet -o usual.exr && luciole gbuffer scene.json --quiet -o g.exr");
  const Image usual = read("usual.exr");
  for (const std::string name : {"pxr24", "b44", "b44a", "dwaa", "dwab"}) {
    succeed("luciole render scene.json --quiet -o a.exr --half --compression " + name);
    // A picture all the same: no value is off by a tenth of the brightest, which is below 4 in this scene.
    EXPECT_THAT(read("a.exr").pixels, testing::Pointwise(testing::FloatNear(0.4f), usual.pixels));
    refuse("luciole gbuffer scene.json -o no.exr --compression " + name, 2,
           "--compression " + name + ": changes values, and a G-buffer must keep them");
    refuse("luciole reference scene.json -o no.exr --compression " + name, 2, "a reference must keep them");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "no.exr"));
}

TEST_F(PictureFiles, WhatDoesNotGoTogetherIsRefusedBeforeAnyWork) {
  refuse("luciole render scene.json -o no.exr --compression dwa", 2, "did you mean dwaa?");
  refuse("luciole render scene.json -o no.exr --compression zibs", 2, "did you mean zips?");
  refuse("luciole render scene.json -o no.png --compression zip", 2, "(--compression zip), expected .exr");
  refuse("luciole gbuffer scene.json -o g.exr --half", 2, "--half");
  refuse("luciole render scene.json -o no.png --half", 2, "no.png: .png has no 16-bit floats (--half)");
  refuse("luciole render scene.json -o no.jpg --alpha", 2, ".jpg has no coverage (--alpha)");
  refuse("luciole render scene.json -o no.exr --bits 16", 2, ".exr has no 16-bit codes (--bits)");
  refuse("luciole render scene.json -o no.jpg --bits 16", 2, ".jpg has no 16-bit codes (--bits)");
  refuse("luciole render scene.json -o no.png --bits 10", 2, "--bits");
  refuse("luciole render scene.json -o no.##.png --frames 1-2 --half", 2, "(--half)");
  refuse("luciole shade missing.exr --scene scene.json -o no.png --half", 2, "(--half)");
  refuse("luciole reference scene.json -o no.jpg --alpha", 2, "(--alpha)");
  EXPECT_EQ(filesIn(folder), std::vector<std::string>{"scene.json"});
}

TEST_F(PictureFiles, AlphaOverTheBackgroundIsThePicture) {
  for (const std::string options :
       {"", "--samples 5", "--samples 4 --shading gouraud --exposure 1.5", "--samples 3 --crop 20,0,50,40",
        "--samples 8 --shading flat --shadows off"}) {
    const int samples = options.find("--samples") == 0 ? options[10] - '0' : 1;
    const double exposed = options.find("--exposure") == std::string::npos ? 1 : std::exp2(1.5);
    succeed("luciole render scene.json --quiet -o a.exr " + options);
    succeed("luciole render scene.json --quiet --alpha -o b.exr " + options);
    expectOverBackground("b.exr", "a.exr", samples, exposed);
  }
  const Image layer = read("b.exr");
  int none = 0, some = 0, all = 0;
  for (std::size_t i = 0; i < layer.pixels.size(); i += 4) {
    const float alpha = layer.pixels[i + 3];
    ++(alpha == 0 ? none : alpha == 1 ? all : some);
    if (alpha > 0) continue;
    for (int c = 0; c < 3; ++c) ASSERT_EQ(layer.pixels[i + c], 0);
  }
  EXPECT_GT(none, 0);
  EXPECT_GT(some, 0);
  EXPECT_GT(all, 0);
}

TEST_F(PictureFiles, AlphaIsTheSameByEveryCommand) {
  succeed("luciole render scene.json --quiet --alpha --shadows off -o a.exr");
  succeed("luciole gbuffer scene.json --quiet -o g.exr");
  succeed("luciole shade g.exr --scene scene.json --quiet --alpha --shadows off -o shaded.exr");
  succeed("luciole reference scene.json --quiet --alpha --shadows off -o reference.exr");
  succeed(
      "luciole reference --gbuffer g.exr --scene scene.json --quiet --alpha --shadows off -o of_file.exr");
  succeed("luciole render scene.json --quiet --alpha --shadows off --frames 1-2 -o f.#.exr");
  const Image picture = read("a.exr");
  EXPECT_EQ(read("shaded.exr").pixels, picture.pixels);
  EXPECT_EQ(read("f.1.exr").pixels, picture.pixels);
  EXPECT_EQ(read("f.2.exr").pixels, picture.pixels);
  EXPECT_EQ(read("of_file.exr").pixels, read("reference.exr").pixels);
  // The promise is 1e-5 of the maximum, which is below 4 in this scene.
  succeed("luciole compare reference.exr a.exr --max-abs 4e-5");
  succeed(
      "luciole render scene.json --quiet --alpha --samples 4 --samples-shading all --shadows off -o a4.exr");
  succeed("luciole reference scene.json --quiet --alpha --samples 4 --shadows off -o reference4.exr");
  succeed("luciole compare reference4.exr a4.exr --max-abs 4e-5");
  for (const auto& [ours, truth] : {std::pair("a.exr", "reference.exr"), {"a4.exr", "reference4.exr"}}) {
    const Image a = read(ours), b = read(truth);
    for (std::size_t i = 3; i < a.pixels.size(); i += 4) ASSERT_EQ(a.pixels[i], b.pixels[i]) << truth;
  }
}

TEST_F(PictureFiles, WhatTheFogHidesCoversAllTheSame) {
  writeText(folder / "fog.json", R"({"camera": {"eye": [0, 0, 0], "target": [0, 0, -1]}, "size": [32, 18],
    "background": [0.2, 0.3, 0.4], "fog": {"mode": "linear", "start": 0, "end": 10, "color": [0.2, 0.3, 0.4]},
    "objects": [{"primitive": "box", "scale": 20, "translate": [0, 0, -60]}],
    "lights": [{"type": "directional", "direction": [0, 0, -1]}]})");
  succeed("luciole render fog.json --quiet -o a.exr --stats stats.json");
  ASSERT_EQ(stats()["counts"]["objects_hidden_by_fog"], 1);
  succeed("luciole render fog.json --quiet --alpha -o b.exr");
  succeed("luciole reference fog.json --quiet --alpha -o reference.exr");
  for (const char* name : {"b.exr", "reference.exr"}) {
    const Image layer = read(name);
    const float* middle = &layer.pixels[(9 * 32 + 16) * 4];
    EXPECT_EQ(middle[3], 1) << name;
    for (int c = 0; c < 3; ++c) EXPECT_EQ(middle[c], float(kBackground[c])) << name;
    EXPECT_EQ(layer.pixels[3], 0) << name;
  }
}

TEST_F(PictureFiles, AlphaInAPngIsLaidOverTheBackgroundByTheBook) {
  succeed("luciole render scene.json --quiet --samples 6 --exposure -1 -o a.exr");
  for (const int bits : {8, 16}) {
    succeed(
        fmt::format("luciole render scene.json --quiet --samples 6 --exposure -1 --alpha --dither off "
                    "--bits {} -o b.png",
                    bits));
    const Image whole = read("a.exr"), layer = read("b.png");
    ASSERT_EQ(layer.channels.size(), 4u);
    const double half_step = 0.5 / (bits == 8 ? 255 : 65535);
    std::size_t compared = 0;
    for (std::size_t pixel = 0; pixel < whole.pixels.size() / 3; ++pixel) {
      const float* in = &layer.pixels[4 * pixel];
      if (std::max({in[0], in[1], in[2]}) >= 1) continue;  // a PNG ends there
      ++compared;
      for (int c = 0; c < 3; ++c) {
        const double background = kBackground[c] / 2;
        const double over = in[3] * in[c] + (1 - in[3]) * background;
        // Half a step of A moves the colour against the background, half a step of a code the colour: sRGB
        // is steepest at 1, 2.4 / 1.055. Encoding rounds three times, 3 · 2⁻²⁴ · 65535 < 0.05 of half a
        // step. The two pictures are means of six samples in float, 2 · 7 · 2⁻²⁴ of values below 1 apart.
        const double slope = 2.4 / 1.055;
        const double bound =
            1.05 * half_step * (std::abs(in[c] - background) + slope * (in[3] + half_step)) + 14 * 0x1p-24;
        ASSERT_LE(std::abs(over - whole.pixels[3 * pixel + c]), bound) << bits << " bits, pixel " << pixel;
      }
    }
    EXPECT_GT(compared, whole.pixels.size() / 3 / 2);
  }
}

TEST_F(PictureFiles, SixteenBitsAreFinerThanEightAndHaveNoGrain) {
  succeed("luciole render scene.json --quiet -o a.exr");
  const Image whole = read("a.exr");
  for (const char* name : {"b.png", "b.tif"}) {
    succeed(std::string("luciole render scene.json --quiet --bits 16 -o ") + name);
    const Image codes = read(name);
    for (std::size_t i = 0; i < whole.pixels.size(); ++i)
      // Half a step; each encoding here and there rounds three times, 3 · 2⁻²⁴ · 65535 < 0.015 of a step.
      ASSERT_LE(std::abs(encodeSrgb(codes.pixels[i]) - encodeSrgb(whole.pixels[i])), 0.53 / 65535) << name;
  }
  succeed(
      "luciole render scene.json --quiet --bits 8 -o c.png && luciole render scene.json --quiet -o d.png");
  EXPECT_EQ(read("c.png").pixels, read("d.png").pixels);
}

TEST_F(PictureFiles, CropsLandInTheirPlaceAndAreComparedThereOnly) {
  for (const std::string line :
       {"render scene.json", "render scene.json --half --alpha", "reference scene.json", "gbuffer scene.json",
        "render scene.json --frames 1-1"}) {
    succeed("rm -f *.exr && luciole " + line + " --quiet --crop 8,4,40,30 -o crop." +
            (line.find("frames") == std::string::npos ? "" : "#.") + "exr");
    const PicturePart file =
        readParts(folder / (line.find("frames") == std::string::npos ? "crop.exr" : "crop.1.exr")).front();
    EXPECT_EQ(file.picture_size, glm::ivec2(96, 54)) << line;
    EXPECT_EQ(file.crop_origin, glm::ivec2(8, 4)) << line;
    EXPECT_EQ(file.size, glm::ivec2(40, 30)) << line;
  }
  succeed("luciole render scene.json --quiet --crop 8,4,40,30 -o a.exr");
  succeed("luciole reference scene.json --quiet --crop 8,4,40,30 -o same.exr");
  succeed("luciole render scene.json --quiet --crop 9,4,40,30 -o beside.exr");
  succeed("luciole render scene.json --quiet --crop 8,4,40,30 -o same.png");
  succeed("luciole compare a.exr same.exr --diff diff.exr && luciole compare a.exr same.png");
  EXPECT_EQ(read("diff.exr").crop_origin, glm::ivec2(8, 4));
  EXPECT_EQ(read("diff.exr").picture_size, glm::ivec2(96, 54));
  refuse("luciole compare a.exr beside.exr", 2,
         "a.exr, beside.exr: parts of a picture that start at 8,4 and 9,4");
}

TEST_F(PictureFiles, AReferenceGrowsCropByCropWithAlphaAndHalves) {
  succeed("luciole reference scene.json --alpha --half --quiet -o whole.exr");
  for (const char* crop : {"0,0,96,20", "0,15,96,20", "0,35,96,19"})
    succeed(std::string("luciole reference scene.json --alpha --half --quiet -o parts.exr --crop ") + crop);
  EXPECT_EQ(read("parts.exr").pixels, read("whole.exr").pixels);
  // Other values are another picture, and codes divided by A don't give the values back.
  succeed("luciole reference scene.json --alpha --quiet --crop 0,0,96,9 -o parts.exr");
  EXPECT_EQ(read("parts.exr").height, 9);
  for (const char* crop : {"0,0,96,8", "0,8,96,8"})
    succeed(std::string("luciole reference scene.json --alpha --quiet -o parts.png --crop ") + crop);
  EXPECT_EQ(read("parts.png").height, 8);
}

TEST_F(PictureFiles, SparseReferencesKeepTheirAlpha) {
  succeed("luciole reference scene.json --alpha --quiet -o whole.exr");
  succeed("luciole reference scene.json --alpha --quiet --pixels 50 -o some.exr");
  const Image whole = read("whole.exr"), some = read("some.exr");
  ASSERT_EQ(some.channels, (std::vector<std::string>{"R", "G", "B", "A", "sampled"}));
  int sampled = 0;
  for (std::size_t pixel = 0; pixel < some.pixels.size() / 5; ++pixel) {
    if (some.pixels[5 * pixel + 4] == 0) continue;
    ++sampled;
    for (int c = 0; c < 4; ++c) ASSERT_EQ(some.pixels[5 * pixel + c], whole.pixels[4 * pixel + c]);
  }
  EXPECT_EQ(sampled, 50);
}

}  // namespace
}  // namespace luciole::test
