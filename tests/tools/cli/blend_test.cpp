// Blended materials, of which each sample of a pixel shows the surface or what is behind it.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A pane of opacity 0.3 before a wall, both without light.
constexpr const char* kPane =
    R"({"camera": {"eye": [0, 0, 3], "target": [0, 0, 0]}, "size": [96, 54], "lighting": false,
  "materials": {"pane": {"diffuse": 0.9, "alpha": 0.3, "blend": true}, "wall": {"diffuse": 0.1}},
  "objects": [{"primitive": "plane", "rotate": [90, 0, 0], "scale": 20, "translate": [0, 0, 1], "material": "pane"},
              {"primitive": "plane", "rotate": [90, 0, 0], "scale": 40, "material": "wall"}]})";

/// Panes, a ball that has two sides, and what they throw shadows on.
constexpr const char* kRoom =
    R"({"camera": {"orbit": [20, 25, 6], "target": [0, 0.5, 0]}, "size": [96, 54], "ambient": 0.1,
  "background": [0.2, 0.3, 0.5],
  "materials": {"glass": {"diffuse": [0.9, 0.2, 0.1], "specular": 0.5, "shininess": 40, "alpha": 0.4, "blend": true, "double_sided": true},
                "dense": {"diffuse": [0.1, 0.6, 0.2], "alpha": 0.8, "blend": true}},
  "objects": [{"primitive": "plane", "scale": 8},
              {"primitive": "sphere", "translate": [0.7, 1, 0], "material": "glass"},
              {"primitive": "box", "translate": [-0.8, 0.5, 0.5], "material": "dense"},
              {"primitive": "box", "scale": 0.4, "translate": [-2, 0.2, 1], "keys": [
                  {"frame": 1, "translate": [-2, 0.2, 1]}, {"frame": 2, "translate": [-2, 0.2, 0.6]}]}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "shadow": true},
             {"type": "point", "position": [2, 3, 2], "color": [0.5, 0.4, 0.2], "range": 9}]})";

class BlendedMaterials : public ProgramTest {
 protected:
  BlendedMaterials() {
    writeText(folder / "pane.json", kPane);
    writeText(folder / "room.json", kRoom);
  }
};

// The samples of a pixel that show the pane are N times its opacity, rounded up or down: the pixel is off by
// less than 1/N of the difference, and the mean of all by 5 of its deviations, of ½ · 1/N · 1/√pixels.
TEST_F(BlendedMaterials, AreMixedWithWhatIsBehindAsTheOpacitySays) {
  constexpr double kDifference = 0.9 - 0.1, kMixture = 0.3 * 0.9 + 0.7 * 0.1;
  for (const int samples : {4, 16, 64}) {
    for (const char* shading : {"shared", "all"}) {
      succeed("luciole render pane.json --samples " + std::to_string(samples) + " --samples-shading " +
              shading + " -o out.exr");
      const Image image = readImage(folder / "out.exr");
      double sum = 0;
      for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
        ASSERT_NEAR(image.pixels[i], kMixture, kDifference / samples + 1e-6);
        sum += image.pixels[i];
      }
      const double pixels = double(image.pixels.size()) / 3;
      EXPECT_NEAR(sum / pixels, kMixture, 5 * 0.5 * kDifference / samples / std::sqrt(pixels)) << samples;
    }
  }
}

TEST_F(BlendedMaterials, AreTheSameInTheReference) {
  for (const char* samples : {"1", "4"}) {
    const std::string with = std::string(" room.json --samples ") + samples;
    succeed("luciole reference" + with + " -o truth.exr");
    succeed("luciole render" + with + " --samples-shading all --shadows exact -o ours.exr");
    // As the promise of README's: shading rounds by 1e-5 of the maximum.
    succeed("luciole compare truth.exr ours.exr --max-abs 2e-5");
  }
  EXPECT_THAT(told("luciole reference room.json -o truth.exr"), HasSubstr(" 0 any other"))
      << "rays see the same samples";
}

TEST_F(BlendedMaterials, HaveTheSameBitsHoweverThePictureIsMade) {
  for (const std::string samples : {"1", "5"}) {
    const std::string render = "luciole render room.json --quiet --samples " + samples + " -o out.exr ";
    const std::string hash = succeed(render + "--hash");
    for (const char* other : {"--threads 1", "--culling none", "--tile 4", "--device ,lanes=4"})
      EXPECT_EQ(succeed(render + "--hash " + other), hash) << other;
    succeed(render);
    const Image whole = readImage(folder / "out.exr");
    succeed(render + "--crop 23,11,50,30");
    const Image part = readImage(folder / "out.exr");
    for (int y = 0; y < 30; ++y)
      for (int i = 0; i < 150; ++i)
        ASSERT_EQ(part.pixels[std::size_t(y) * 150 + i],
                  whole.pixels[(std::size_t(y + 11) * 96 + 23) * 3 + i]);
  }
  succeed("luciole gbuffer room.json --quiet -o g.exr");
  succeed("luciole shade g.exr --scene room.json --quiet -o shaded.exr");
  succeed("luciole render room.json --quiet -o one.exr");
  succeed("luciole compare shaded.exr one.exr --max-abs 0");
}

// Where nothing moves, nor what throws a shadow there, two frames have the same grain.
TEST_F(BlendedMaterials, StandStillFromFrameToFrame) {
  succeed("luciole render room.json --quiet --frames 1-2 -o f#.exr");
  const Image first = readImage(folder / "f1.exr"), second = readImage(folder / "f2.exr");
  int differ = 0;
  for (int y = 0; y < 54; ++y)
    for (int x = 0; x < 96; ++x) {
      const std::size_t i = (std::size_t(y) * 96 + x) * 3;
      if (x >= 45)
        ASSERT_EQ(first.pixels[i], second.pixels[i]) << x << " " << y;
      else
        differ += first.pixels[i] != second.pixels[i];
    }
  EXPECT_GT(differ, 10);
}

TEST_F(BlendedMaterials, AreToldAtOneSampleOnce) {
  const char* warning =
      "pane.json: material 'pane': blended by dithering, one sample a pixel; more --samples smooth it";
  EXPECT_THAT(told("luciole render pane.json -o out.png"), HasSubstr(warning));
  const std::string frames = told("luciole render pane.json --frames 1-3 --stats s#.json -o f#.png");
  EXPECT_THAT(frames, HasSubstr(warning));
  EXPECT_EQ(frames.find("dithering"), frames.rfind("dithering"));
  EXPECT_THAT(nlohmann::json::parse(readText(folder / "s1.json"))["warnings"].dump(), HasSubstr("dithering"));
  EXPECT_THAT(told("luciole render room.json -o out.png"), HasSubstr("and 1 more: blended"));
  EXPECT_THAT(told("luciole render pane.json --samples 2 -o out.png"), Not(HasSubstr("dithering")));
  EXPECT_EQ(told("luciole render pane.json --quiet -o out.png"), "");
  std::string opaque = kPane;
  opaque.replace(opaque.find("0.3"), 3, "1.0");
  writeText(folder / "opaque.json", opaque);
  EXPECT_THAT(told("luciole render opaque.json -o out.png"), Not(HasSubstr("dithering")));
}

// A pane of 0.3 casts none, of 0.8 a whole one, by all methods and in the reference; alpha_cutoff says from
// where on.
TEST_F(BlendedMaterials, CastWholeShadowsFromTheirCutoffOn) {
  const auto scene = [&](const char* alpha) {
    return std::string(
               R"({"camera": {"eye": [0, 1, 3], "target": [0, 0, 0]}, "size": [32, 18], "materials": {"pane": {"blend": true, )") +
           alpha +
           R"(}}, "objects": [{"primitive": "plane", "scale": 10}, {"primitive": "plane", "scale": 100,
        "translate": [0, 5, 0], "material": "pane"}], "lights": [{"type": "directional", "direction": [0, -1, 0], "shadow": true}]})";
  };
  for (const auto& [alpha, lit] : {std::pair{R"("alpha": 0.3)", true},
                                   {R"("alpha": 0.8)", false},
                                   {R"("alpha": 0.3, "alpha_cutoff": 0.2)", false},
                                   {R"("alpha": 0.3, "alpha_cutoff": 0)", false},
                                   {R"("alpha": 0.8, "alpha_cutoff": 0.9)", true}}) {
    writeText(folder / "scene.json", scene(alpha));
    for (const std::string command : {"render scene.json --shadows hard", "render scene.json --shadows soft",
                                      "render scene.json --shadows exact",
                                      "render scene.json --shadows soft-exact", "reference scene.json"}) {
      succeed("luciole " + command + " --quiet -o out.exr");
      const Image image = readImage(folder / "out.exr");
      EXPECT_EQ(image.pixels[(std::size_t(14) * 32 + 16) * 3] > 0.5f, lit) << command << " " << alpha;
    }
  }
}

}  // namespace
}  // namespace luciole::test
