// Small OBJ and MTL files after public bug reports of other programs (shared/scenes/reports, with notes of
// what is right), rendered as a user would.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/utf8.hpp"
#include "luciole/image.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

class ObjReports : public ProgramTest {
 protected:
  static std::string report(const std::string& file) { return (sharedScenes() / "reports" / file).string(); }
  /// The picture of a scene, and in `err` what was said.
  Image picture(const std::string& scene, const std::string& options = "") {
    const Outcome outcome = run("luciole render '" + scene + "' " + options + " -o picture.exr");
    err = outcome.err;
    return readImage(folder / "picture.exr");
  }
  /// The colour of a pixel.
  static glm::vec3 at(const Image& image, int x, int y) {
    const std::size_t pixel = std::size_t(y) * std::size_t(image.width) + std::size_t(x);
    const float* const values = &image.pixels[pixel * image.channels.size()];
    return {values[0], values[1], values[2]};
  }
  /// Which components of a pixel are above one half: texels next to it have a share in it.
  static glm::vec3 strong(const Image& image, int x, int y) {
    return glm::vec3(glm::greaterThan(at(image, x, y), glm::vec3(0.5f)));
  }
  /// Expects all pixels to be of a colour, but for the rounding of floats that shading adds up.
  static void expectAll(const Image& image, const glm::vec3& color, float tolerance = 1e-5f) {
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(at(image, x, y)[c], color[c], tolerance) << x << " " << y;
  }
  /// The mean of a channel.
  static double mean(const Image& image, const std::string& channel) {
    std::size_t which = 0;
    while (image.channels.at(which) != channel) ++which;
    double sum = 0;
    for (std::size_t i = which; i < image.pixels.size(); i += image.channels.size()) sum += image.pixels[i];
    return sum / (double(image.width) * image.height);
  }
  std::string err;
};

TEST_F(ObjReports, OptionsOfMapsScaleAndMoveThem) {
  LUCIOLE_NEEDS_SHARED();
  const Image plain = picture(report("01_mtl_map_options/plain.json"));
  EXPECT_EQ(strong(plain, 3, 3), glm::vec3(1, 0, 0));
  EXPECT_EQ(strong(plain, 12, 3), glm::vec3(0, 1, 0));
  EXPECT_EQ(strong(plain, 12, 12), glm::vec3(1, 1, 1));
  for (const char* same : {"s2", "o2"})
    EXPECT_EQ(picture(report(std::string("01_mtl_map_options/") + same + ".json")).pixels, plain.pixels);
  const Image twice = picture(report("01_mtl_map_options/s3.json"));
  EXPECT_EQ(strong(twice, 1, 1), glm::vec3(1, 0, 0));
  EXPECT_EQ(strong(twice, 6, 1), glm::vec3(0, 1, 0));
  EXPECT_EQ(strong(twice, 9, 9), glm::vec3(1, 0, 0));
  const Image moved = picture(report("01_mtl_map_options/o3.json"));
  EXPECT_EQ(strong(moved, 3, 3), glm::vec3(0, 1, 0));
  EXPECT_EQ(strong(moved, 12, 3), glm::vec3(1, 0, 0));
}

TEST_F(ObjReports, WhatIsNoNumberIsDrawnWithout) {
  LUCIOLE_NEEDS_SHARED();
  for (const char* file : {"vn", "vt"}) {
    expectAll(picture(report(std::string("02_obj_nan/") + file + ".json")), glm::vec3(0.8f));
    EXPECT_THAT(err, HasSubstr("is not a finite number"));
    refuse("luciole render '" + report(std::string("02_obj_nan/") + file + ".json") + "' --strict -o x.exr",
           2, "is not a finite number");
  }
}

TEST_F(ObjReports, AByteOrderMarkIsNoPartOfTheText) {
  LUCIOLE_NEEDS_SHARED();
  expectAll(picture(report("03_mtl_bom/q.json")), glm::vec3(1, 0, 0));
  std::string scene = readText(report("03_mtl_bom/q.json"));
  scene.replace(scene.find("q.obj"), 5, report("03_mtl_bom/q.obj"));
  writeText(folder / "marked.json", "\xef\xbb\xbf" + scene);
  expectAll(picture("marked.json"), glm::vec3(1, 0, 0));
}

TEST_F(ObjReports, VertexColoursAreSrgbAndWhiteWhereThereIsNone) {
  LUCIOLE_NEEDS_SHARED();
  expectAll(picture(report("04_obj_vertex_colours/q.json")), glm::vec3(0.21404f));
  const Image mixed = picture(report("04_obj_vertex_colours/mixed.json"));
  EXPECT_EQ(at(mixed, 3, 8), glm::vec3(1, 0, 0));
  EXPECT_EQ(at(mixed, 12, 8), glm::vec3(1));
  expectAll(picture(report("36_siblings/v7.json")), glm::vec3(1, 0, 0));
}

TEST_F(ObjReports, AConstantColourIsUnlitAndSmallLettersAreRead) {
  LUCIOLE_NEEDS_SHARED();
  for (const char* file : {"q", "behind", "lower"})
    expectAll(picture(report(std::string("05_mtl_illum0/") + file + ".json")), {0.25f, 0.5f, 0.75f});
}

TEST_F(ObjReports, FacesHaveAnyNumberOfCorners) {
  LUCIOLE_NEEDS_SHARED();
  // Of 128 x 128 pixels some 450 lie on the disc's rim, each of them right or wrong by half as a rule.
  const Image disc = picture(report("06_obj_polygons/disc300.json"), "--size 128x128 --alpha");
  EXPECT_NEAR(mean(disc, "A"), std::acos(-1.0) * 0.81 / 4, 0.003);
  EXPECT_EQ(mean(picture(report("06_obj_polygons/frame.json"), "--size 128x128 --alpha"), "A"), 0.75);
}

TEST_F(ObjReports, NamedPartsAreObjectsOfTheirOwn) {
  LUCIOLE_NEEDS_SHARED();
  succeed("luciole render '" + report("07_obj_groups/two.json") +
          "' --aov cryptomatte_object,object_id --compression none --half --quiet -o two.exr");
  const Image two = readImage(folder / "two.exr");
  std::size_t id = 0;
  while (two.channels.at(id) != "object_id") ++id;
  const auto idAt = [&](int x) { return two.pixels[(8 * 16 + std::size_t(x)) * two.channels.size() + id]; };
  EXPECT_NE(idAt(3), idAt(12));
  EXPECT_THAT(readText(folder / "two.exr"), HasSubstr("{\"left\":"));
  const Json scene = Json::parse(succeed("luciole info '" + report("07_obj_groups/two.json") + "' --json -"));
  EXPECT_EQ(scene["objects"], 2);
  EXPECT_EQ(scene["object_names"], (Json{"left", "right"}));
}

TEST_F(ObjReports, OneNumberOfAColourIsGrey) {
  LUCIOLE_NEEDS_SHARED();
  expectAll(picture(report("08_mtl_one_number/q.json")), glm::vec3(0.5f));
}

TEST_F(ObjReports, NamesInLatin1AreWrittenAsUtf8) {
  LUCIOLE_NEEDS_SHARED();
  for (const char* file : {"q.obj", "q.mtl"})
    std::filesystem::copy_file(report(std::string("30_latin1_names/") + file), folder / file);
  std::filesystem::copy_file(report("34_mtl_absolute_path/wood.png"), folder / "textur_gr\xfcn.png");
  std::filesystem::copy_file(report("30_latin1_names/q.obj"), folder /
                                                                  "k\xfc"
                                                                  "che.obj");
  const std::vector<std::string> names{"q.obj",
                                       "k\xfc"
                                       "che.obj"};
  for (const std::string& name : names) {
    const Outcome outcome =
        run("luciole render " + name +
            " --size 16x16 --log json --stats - --aov cryptomatte --trace t.json -o " + name + ".exr");
    for (const std::string& text : {outcome.out, outcome.err, readText(folder / "t.json")})
      EXPECT_TRUE(isUtf8(text));
    EXPECT_EQ(Json::parse(outcome.out)["command"].get<std::string>().find("luciole render " + utf8Of(name)),
              0u);
    const Json info = Json::parse(succeed("luciole info " + name + " --json -"));
    EXPECT_EQ(info["materials"][0]["name"], "Gr\xc3\xbcn");
    const std::string header = succeed("luciole info " + name + ".exr --json -");
    EXPECT_THAT(header, HasSubstr("luciole render " + utf8Of(name)));
    EXPECT_THAT(readText(folder / (name + ".exr")), HasSubstr("{\"Gr\xc3\xbcn\":"));
    run("luciole render " + name + " --size 16x16 --quiet -o " + name + ".png");
    EXPECT_THAT(readText(folder / (name + ".png")), HasSubstr("luciole render " + utf8Of(name)));
  }
  std::filesystem::remove(folder / "textur_gr\xfcn.png");
  refuse("luciole render q.obj -o x.exr", 2, "there is no picture 'textur_gr\xc3\xbcn.png'");
}

TEST_F(ObjReports, PathsOfOtherMachinesAreLookedForBesideTheFile) {
  LUCIOLE_NEEDS_SHARED();
  expectAll(picture(report("34_mtl_absolute_path/q.json")), glm::vec3(1, 0, 0));
  EXPECT_THAT(err, testing::Not(HasSubstr("warning")));
  const Json info =
      Json::parse(succeed("luciole info '" + report("34_mtl_absolute_path/lib.obj") + "' --json -"));
  EXPECT_EQ(info["materials"][0]["name"], "m");
  EXPECT_EQ(info["warnings"], Json::array());
}

TEST_F(ObjReports, MaterialsThatAreNotFoundAreTold) {
  LUCIOLE_NEEDS_SHARED();
  expectAll(picture(report("36_siblings/unknown_usemtl.json")), glm::vec3(0.8f));
  EXPECT_THAT(err, HasSubstr("there is no material 'm'"));
  EXPECT_THAT(succeed("luciole info '" + report("36_siblings/unknown_usemtl.json") + "'"),
              HasSubstr("there is no material 'm'"));
  picture(report("36_siblings/map_Ks.json"));
  EXPECT_THAT(err, HasSubstr("map_Ks is not drawn"));
}

}  // namespace
}  // namespace luciole::test
