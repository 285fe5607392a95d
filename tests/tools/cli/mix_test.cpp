// Layers of light groups, and what luciole mix makes of them, as a person types it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"
#include "tools/scale/browser.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

class MixCommand : public ProgramTest {
 protected:
  /// Groups of four pixels with known light: key, rim and rest, and the picture that is their sum.
  void writeGroups() const {
    Image image{2, 2, {"R", "G", "B"}, {}};
    for (const char* layer : {"light_groups.key", "light_groups.rest", "light_groups.rim"})
      for (const char* component : {".R", ".G", ".B"})
        image.channels.push_back(std::string(layer) + component);
    for (int i = 0; i < 4; ++i)
      for (const float value :
           {0.375f, 0.4375f, 0.3125f, 0.125f, 0.25f, 0.0f, 0.0f, 0.0625f, 0.25f, 0.25f, 0.125f, 0.0625f})
        image.pixels.push_back(value);
    writeImage(image, folder / "groups.exr", {});
  }
  std::vector<float> pixelOf(const std::string& file) const {
    const Image image = readImage(folder / file);
    return {image.pixels.begin(), image.pixels.begin() + 3};
  }
};

TEST_F(MixCommand, WeighsAndTintsTheGroupsThatItNamesAndLeavesTheOthers) {
  writeGroups();
  succeed("luciole mix groups.exr --quiet -o same.exr");
  EXPECT_EQ(pixelOf("same.exr"), (std::vector<float>{0.375f, 0.4375f, 0.3125f}));
  succeed("luciole mix groups.exr --light-mixer key=2,rest=0 --quiet -o key.exr");
  EXPECT_EQ(pixelOf("key.exr"), (std::vector<float>{0.5f, 0.625f, 0.0625f}));
  succeed("luciole mix groups.exr --light-mixer 'rim=4:#ff0000,key=0' --exposure 1 --quiet -o rim.exr");
  EXPECT_EQ(pixelOf("rim.exr"), (std::vector<float>{2.0f, 0.125f, 0.5f}));
  // sRGB's 0xbc is 0.50289 of white.
  succeed("luciole mix groups.exr --light-mixer 'rim=0,rest=0,key=1:#bcffff' --quiet -o half.exr");
  EXPECT_NEAR(pixelOf("half.exr")[0], 0.125 * 0.502886, 1e-6);
}

TEST_F(MixCommand, OfAScenesOwnGroupsGivesItsPictureBack) {
  std::string scene = kSmallScene;
  const std::string last = R"("exponent": 4, "shadow": true)";
  scene.replace(scene.find(last), last.size(), last + R"(, "group": "stage spot")");
  writeText(folder / "scene.json", scene);
  succeed("luciole render scene.json --samples 2 --light-groups --alpha --quiet -o groups.exr");
  EXPECT_THAT(succeed("luciole info groups.exr"), HasSubstr("light_groups.stage spot R G B"));
  succeed(
      "luciole mix groups.exr --quiet -o mixed.exr && luciole compare groups.exr mixed.exr --max-abs 1e-6");
  succeed("luciole mix groups.exr --light-mixer 'stage spot=0,rest=2' --quiet -o mixed.png");
  succeed("luciole gbuffer scene.json --quiet -o g.exr");
  for (const char* light : {"shade g.exr --scene scene.json", "relight g.exr --lights scene.json"}) {
    succeed("luciole " + std::string(light) + " --light-groups --exposure auto --quiet -o lit.exr");
    succeed("luciole mix lit.exr --quiet -o mixed.exr && luciole compare lit.exr mixed.exr --max-abs 1e-5");
  }
  succeed("luciole render scene.json --light-groups --frames 1-2 --quiet -o frame.#.exr");
  EXPECT_THAT(succeed("luciole info frame.2.exr"), HasSubstr("light_groups.rest"));
}

TEST_F(MixCommand, RefusesWhatItCannotDoInOneLine) {
  writeGroups();
  const auto refuseMix = [&](const std::string& spec, const std::string& what) {
    refuse("luciole mix groups.exr --light-mixer '" + spec + "' -o out.exr", 2, what);
  };
  refuseMix("kye=2", "groups.exr has no such group, only key, rest, rim; did you mean key?");
  refuseMix("key", "expected GROUP=FACTOR");
  refuseMix("=2", "expected GROUP=FACTOR");
  refuseMix("key=2,", "expected GROUP=FACTOR");
  for (const char* factor : {"", "two", "-1", "nan", "inf", "2x", "1e10"})
    refuseMix("key=" + std::string(factor), "expected a factor from 0 to 1000000000");
  for (const char* color : {"", "red", "#12345", "#12345g"})
    refuseMix("key=2:" + std::string(color), "expected a colour #rrggbb");
  writeImage({1, 1, {"R", "G", "B"}, {0, 0, 0}}, folder / "plain.exr", {});
  refuse("luciole mix plain.exr -o out.exr", 2, "plain.exr: no layers light_groups.NAME");
  refuse("luciole mix plain.exr -o none/out.html", 2, "none");
  writeImage({1, 1, {"light_groups.a.R"}, {0}}, folder / "short.exr", {});
  refuse("luciole mix short.exr -o out.exr", 2, "short.exr: channel light_groups.a.G: missing");
  writeImage({1, 1, {"light_groups.a.G"}, {0}}, folder / "green.exr", {});
  refuse("luciole mix green.exr -o out.exr", 2, "green.exr: no layers light_groups.NAME");
  writeText(folder / "text.exr", "text");
  refuse("luciole mix text.exr -o out.exr", 2, "text.exr");
  EXPECT_FALSE(std::filesystem::exists(folder / "out.exr"));
}

TEST_F(MixCommand, BoundsOfLayersAreNoLight) {
  const std::vector<std::string> channels{"light_groups.a.R",
                                          "light_groups.a.G",
                                          "light_groups.a.B",
                                          "light_groups.a.light_error.R",
                                          "light_groups.a.light_error.G",
                                          "light_groups.a.light_error.B"};
  writeImage({1, 1, channels, {1, 2, 3, 4, 5, 6}}, folder / "bounded.exr", {});
  succeed("luciole mix bounded.exr --light-mixer a=2 --quiet -o out.exr");
  EXPECT_EQ(pixelOf("out.exr"), (std::vector<float>{2, 4, 6}));
  refuse("luciole mix bounded.exr --light-mixer a.light_error=2 -o out.exr", 2, "a.light_error");
}

TEST_F(MixCommand, NotANumberAndTooMuchLightBecomeTheLargestFloat) {
  writeImage({1, 1, {"light_groups.a.R", "light_groups.a.G", "light_groups.a.B"}, {NAN, INFINITY, 3e38f}},
             folder / "odd.exr", {});
  succeed("luciole mix odd.exr --light-mixer a=2 --quiet -o out.exr");
  EXPECT_EQ(pixelOf("out.exr"), std::vector<float>(3, 3.4028235e38f));
}

TEST_F(MixCommand, LayersOfLightAreRefusedWhereTheyWouldNotAddUp) {
  writeText(folder / "scene.json", kSmallScene);
  refuse("luciole render scene.json --light-groups -o a.png", 2, "--light-groups: a.png cannot hold layers");
  refuse("luciole render scene.json --aov fog --shading gouraud -o a.exr", 2, "--shading gouraud");
  refuse("luciole render scene.json --light-groups --frames 1-2 -o a.mp4", 2,
         "--light-groups: a.mp4 cannot hold");
}

TEST_F(MixCommand, GroupsNamesThatNoLayerCanHaveAreRefused) {
  const auto refuseName = [&](const std::string& name, const std::string& what) {
    writeText(
        folder / "bad.json",
        R"({"camera": {"eye": [0, 0, 5], "target": [0, 0, 0]}, "lights": [{"type": "point", "position": [0, 0, 0], "group": )" +
            name + "}]}");
    refuse("luciole render bad.json --light-groups -o a.exr", 2, "lights[0].group: " + what);
  };
  for (const char* name :
       {R"("")", R"("a.b")", R"("a=b")", R"("a,b")", R"("a:b")", R"("a\nb")", R"("\u0000")"})
    refuseName(name, "expected a group's name of 1 to 200 bytes");
  refuseName('"' + std::string(201, 'a') + '"', "expected a group's name of 1 to 200 bytes");
  refuseName("\"rest\"", "\"rest\" is the light that no light gives");
  refuseName("7", "expected");
}

TEST_F(MixCommand, AMillionGroupsAreRefusedInOneLine) {
  std::string lights;
  for (int i = 0; i < 1'000'000; ++i)
    lights += (i ? ",{" : "{") + std::string(R"("type":"point","position":[0,0,0],"group":"g)") +
              std::to_string(i) + "\"}";
  writeText(
      folder / "many.json",
      R"({"camera": {"eye": [0, 0, 5], "target": [0, 0, 0]}, "size": [16, 16], "lights": [)" + lights + "]}");
  refuse("luciole render many.json --light-groups -o a.exr", 2,
         "1000000 groups of lights, expected 4096 at most");
}

TEST_F(MixCommand, PageMixesInTheBrowserWhatTheCommandMixes) {
  LUCIOLE_NEEDS_PROGRAM("chromium", "chromium");
  writeGroups();
  succeed("luciole mix groups.exr --light-mixer 'rim=0.5:#ff8000' --quiet -o page.html");
  const std::string page = readText(folder / "page.html");
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  Browser& browser = browserWithEmptyPage();
  browser.open(page);
  const auto expectPicture = [&](const std::string& spec) {
    succeed("luciole mix groups.exr --light-mixer '" + spec + "' --dither off --bits 8 --quiet -o mixed.png");
    const Json shown = browser.evaluate(
        "[...document.getElementById('picture').getContext('2d').getImageData(1, 1, 1, 1).data]");
    const Image mixed = readImage(folder / "mixed.png");
    for (std::size_t c = 0; c < 3; ++c) {
      const double linear = mixed.pixels[c];
      const double code =
          255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
      // Half floats and the table of codes are finer than a code, and both sides round to one.
      EXPECT_NEAR(shown[c].get<double>(), code, 1.01) << spec << " " << shown;
    }
    EXPECT_EQ(shown[3], 255);
  };
  expectPicture("rim=0.5:#ff8000");
  EXPECT_THAT(browser.evaluate("document.getElementById('command').textContent").get<std::string>(),
              HasSubstr("luciole mix groups.exr --light-mixer rim=0.5:#ff8000 -o mixed.exr"));
  const auto set = [&](const std::string& group, const std::string& type, const std::string& change) {
    browser.evaluate(
        "(() => { const row = [...document.querySelectorAll('#groups tbody tr')].find(row => "
        "row.cells[0].textContent === '" +
        group + "'), input = row.querySelector('input[type=" + type + "]'); " + change +
        "; input.dispatchEvent(new Event('input', {bubbles: true})); })()");
    browser.settle();
  };
  set("key", "range", "input.value = 3");
  set("rest", "checkbox", "input.checked = false");
  set("rim", "color", "input.value = '#ffffff'");
  set("rim", "number", "input.value = 1.5");
  expectPicture("key=3,rest=0,rim=1.5");
  browser.evaluate("document.getElementById('reset').click()");
  browser.settle();
  expectPicture("key=1");
}

}  // namespace
}  // namespace luciole::test
