// luciole info: what it says of scenes and pictures is what is in them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>

#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string kOwnScenes = LUCIOLE_SOURCE_DIR "/scenes/";

class Info : public ProgramTest {
 protected:
  json infoOf(const std::string& arguments) {
    return json::parse(succeed("luciole info --json - " + arguments));
  }
};

/// Triangles that the f lines of an OBJ file make: a polygon of n corners makes n − 2.
std::uint64_t trianglesOfObj(const std::string& path) {
  std::istringstream lines(readText(path));
  std::uint64_t triangles = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("f ", 0) != 0) continue;
    std::istringstream words(line.substr(2));
    std::uint64_t corners = 0;
    for (std::string word; words >> word;) ++corners;
    triangles += corners - 2;
  }
  return triangles;
}

TEST_F(Info, FramesTogetherCostWhatEachDoesButForTheStart) {
  const std::string scene = "'" + kOwnScenes + "fireflies.json' --size 320x180";
  const json one = infoOf(scene + " --frames 40"), other = infoOf(scene + " --frames 80");
  EXPECT_TRUE(one["job"].is_null());
  EXPECT_NE(one["render"]["milliseconds"], other["render"]["milliseconds"]) << "it is at another place";
  const json job = infoOf(scene + " --frames 40,80")["job"];
  EXPECT_EQ(job["frames"], 2);
  const double first = one["render"]["milliseconds"], second = other["render"]["milliseconds"];
  EXPECT_LT(job["milliseconds"], first + second);
  EXPECT_GT(job["milliseconds"], std::max(first, second));
  EXPECT_EQ(job["slowest_frame"], first < second ? 80 : 40);
  EXPECT_EQ(job["slowest_milliseconds"], std::max(first, second));
  EXPECT_EQ(job["memory_bytes"], std::max(one["render"]["memory_bytes"].get<double>(),
                                          other["render"]["memory_bytes"].get<double>()));
  EXPECT_THAT(succeed("luciole info " + scene + " --frames 1-9"), HasSubstr("all frames   9 frames: about "));
  refuse("luciole info " + scene + " --frames x", 2, "--frames x");
}

// To look at a frame takes about half as long as to make it.
TEST_F(Info, OfManyFramesLooksAtSome) {
  writeText(folder / "moves.json",
            R"({"objects": [{"primitive": "box"}], "lights": [{"type": "point", "position": [0, 3, 0]}],
      "camera": {"orbit": [0, 10, 3], "target": [0, 0, 0],
                 "keys": [{"frame": 1, "orbit": [0, 10, 3]}, {"frame": 2000, "orbit": [360, 10, 9]}]}})");
  const json job = infoOf("moves.json --size 64x36 --frames 1-2000")["job"];
  EXPECT_EQ(job["frames"], 2000);
  EXPECT_EQ((job["slowest_frame"].get<int>() - 1) % 80, 0);
}

TEST_F(Info, CountsWhatAnObjFileHas) {
  LUCIOLE_NEEDS_SHARED();
  const std::string path = (sharedScenes() / "stanford/stanford-bunny.obj").string();
  const json info = infoOf("'" + path + "'");
  EXPECT_EQ(info["triangles"], trianglesOfObj(path));
  EXPECT_EQ(info["mesh_triangles"], info["triangles"]);
  EXPECT_EQ(info["adds_camera"], true);
  EXPECT_EQ(info["adds_lights"], true);
  EXPECT_EQ(info["cameras"].size(), 1u);
  EXPECT_GT(info["lights"]["count"], 0);
  // The box around the v lines, which are single-precision numbers in text.
  double low[3] = {1e30, 1e30, 1e30}, high[3] = {-1e30, -1e30, -1e30};
  std::istringstream lines(readText(path));
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("v ", 0) != 0) continue;
    std::istringstream words(line.substr(2));
    for (int i = 0; i < 3; ++i) {
      float v = 0;
      words >> v;
      low[i] = std::min(low[i], double(v));
      high[i] = std::max(high[i], double(v));
    }
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_FLOAT_EQ(info["bounds"]["low"][i], float(low[i]));
    EXPECT_FLOAT_EQ(info["bounds"]["high"][i], float(high[i]));
  }
}

TEST_F(Info, CountsInstancesLightsAndCastersOfOwnScenes) {
  // Comments, which JSON doesn't know, are allowed in scenes.
  for (const char* name : {"city", "colonnade", "spheres"}) {
    const json scene = json::parse(readText(kOwnScenes + name + ".json"), nullptr, true, true);
    const json info = infoOf(kOwnScenes + name + ".json");
    EXPECT_EQ(info["objects"], scene["objects"].size()) << name;
    std::map<std::string, int> kinds{{"point", 0}, {"directional", 0}, {"spot", 0}};
    int casting = 0;
    for (const json& light : scene["lights"]) {
      ++kinds[light["type"]];
      casting += light.value("shadow", false);
    }
    for (const auto& [kind, count] : kinds) EXPECT_EQ(info["lights"][kind], count) << name << " " << kind;
    EXPECT_EQ(info["lights"]["casting"], casting) << name;
    EXPECT_EQ(info["adds_camera"], false) << name;
    EXPECT_EQ(info["render"]["width"], 1280) << name;
    EXPECT_EQ(info["warnings"], json::array()) << name;
    EXPECT_EQ(info["cameras"][0]["eye"], scene["camera"]["eye"]) << name;
    EXPECT_EQ(infoOf(kOwnScenes + name + ".json --cast-shadows none")["lights"]["casting"], 0) << name;
  }
}

TEST_F(Info, TexturesOutsideTheScenesFolderHaveTheirWholePath) {
  const TemporaryFolder elsewhere;
  writeText(elsewhere / "t.ppm", "P3 1 1 255 10 20 30\n");
  writeText(folder / "a.mtl", "newmtl m\nmap_Kd " + (elsewhere / "t.ppm") + "\n");
  writeText(folder / "a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
  EXPECT_THAT(succeed("luciole info a.obj"), HasSubstr(" " + (elsewhere / "t.ppm") + "\n"));
}

TEST_F(Info, NamesExtensionsThatAreIgnoredAndTexturesWithTheirSizes) {
  LUCIOLE_NEEDS_SHARED();
  const std::string path =
      (sharedScenes() / "khronos_LightsPunctualLamp/glTF/LightsPunctualLamp.gltf").string();
  const json info = infoOf("'" + path + "'"), file = json::parse(readText(path));
  EXPECT_EQ(info["ignored_extensions"], json::array({"KHR_materials_transmission"}));
  EXPECT_EQ(info["warnings"].size(), 1u);
  EXPECT_EQ(info["lights"]["point"], 5);
  EXPECT_EQ(info["lights"]["casting"], 0);
  EXPECT_EQ(info["adds_lights"], false);
  EXPECT_EQ(info["materials"].size(), file["materials"].size());
  ASSERT_GT(info["textures"].size(), 0u);
  for (const json& texture : info["textures"]) {
    EXPECT_GT(texture["width"], 0);
    EXPECT_GT(texture["height"], 0);
  }
  EXPECT_THAT(succeed("luciole info '" + path + "'"), HasSubstr("ignored      KHR_materials_transmission\n"));
}

TEST_F(Info, CountsWhatAGameLevelHas) {
  LUCIOLE_NEEDS_SHARED();
  const std::string path = (sharedScenes() / "quake_e1m1/e1m1.gltf").string();
  const json info = infoOf("'" + path + "'"), file = json::parse(readText(path));
  std::uint64_t triangles = 0;
  for (const json& primitive : file["meshes"][0]["primitives"])
    triangles += file["accessors"][primitive["indices"].get<int>()]["count"].get<std::uint64_t>() / 3;
  EXPECT_EQ(info["mesh_triangles"], triangles);
  int lights = 0;
  for (const json& node : file["nodes"]) lights += node.contains("extensions");
  EXPECT_EQ(info["lights"]["count"], lights);
  EXPECT_EQ(info["materials"].size(), file["materials"].size());
}

TEST_F(Info, FeaturesAreThoseOfARender) {
  writeText(folder / "scene.json", kSmallScene);
  for (const char* options : {"", "--shadows soft", "--shading flat", "--culling none --model toon"}) {
    succeed(fmt::format("luciole render scene.json --quiet {} -o a.png --stats s.json", options));
    const json stats = json::parse(readText(folder / "s.json"));
    EXPECT_EQ(infoOf(fmt::format("scene.json {}", options))["features"], stats["scene"]["features"])
        << options;
  }
}

TEST_F(Info, PlanTellsBandsSharedSamplesAndSetsOfKernels) {
  writeText(folder / "scene.json", kSmallScene);
  const json large = infoOf("scene.json --size 8000x6000")["plan"];
  const int rows = large["band_rows"];
  EXPECT_GT(large["bands"], 1);
  EXPECT_EQ(large["bands"], (6000 + rows - 1) / rows);
  EXPECT_LE(large["bytes_per_pixel"].get<double>() * 8000 * rows, double(512 << 20));
  const json small = infoOf("scene.json --shading gouraud --samples 4")["plan"];
  EXPECT_EQ(small["bands"], 1);
  EXPECT_EQ(small["programs"], 2) << "vertices, and pixels' fog";
  EXPECT_EQ(small["shares_samples"], true);
  EXPECT_EQ(large["shares_samples"], false);
  EXPECT_EQ(large["programs"], 1);
}

TEST_F(Info, MemoryIsAboutWhatARenderTakes) {
  // Within 1.5 times. Counting for --stats takes more memory where lists of lights are long: none are here.
  for (const char* scene : {"cornell", "colonnade", "underwater", "spheres"})
    for (const char* options : {"--size 320x180", "--size 1280x720", "--size 640x360 --samples 8"}) {
      const std::string arguments = fmt::format("{}{}.json {}", kOwnScenes, scene, options);
      // The second time, with all kernels compiled.
      for (int time = 0; time < 2; ++time)
        succeed("luciole render --quiet -o a.png --stats s.json " + arguments);
      const double took = json::parse(readText(folder / "s.json"))["memory"]["peak_bytes"];
      const double told = infoOf(arguments)["render"]["memory_bytes"];
      EXPECT_LT(told, 1.5 * took) << arguments;
      EXPECT_GT(told, took / 1.5) << arguments;
    }
}

TEST_F(Info, MoreToDoIsToldToCostMore) {
  writeText(folder / "scene.json", kSmallScene);
  const auto cost = [&](const std::string& options) {
    const json render = infoOf("scene.json " + options)["render"];
    return std::pair(render["milliseconds"].get<double>(), render["memory_bytes"].get<double>());
  };
  const auto usual = cost("--size 640x360"), large = cost("--size 1280x720");
  EXPECT_GT(large.first, usual.first);
  EXPECT_GT(large.second, usual.second);
  EXPECT_GT(cost("--size 640x360 --samples 4").first, usual.first);
  EXPECT_GT(cost("--size 640x360 --shadows soft").first, usual.first);
  EXPECT_LT(cost("--size 640x360 --shadows off").first, usual.first);
  EXPECT_LT(cost("--size 640x360 --shadows off").second, usual.second);
  EXPECT_GE(cost("--size 640x360 --culling none").first, usual.first);
  EXPECT_EQ(cost("--size 640x360"), usual) << "it is no measurement";
}

TEST_F(Info, MovingScenesTellTheirFrames) {
  EXPECT_EQ(infoOf(kOwnScenes + "fireflies.json")["frames"], (json{{"first", 1.0}, {"last", 121.0}}));
  EXPECT_EQ(infoOf(kOwnScenes + "cornell.json")["frames"], nullptr);
}

TEST_F(Info, SceneThatNeedsTooMuchIsStillToldOf) {
  writeText(folder / "scene.json", kSmallScene);
  std::string lights;
  for (int i = 0; i < 1000; ++i)
    lights += fmt::format(R"({}{{"type": "point", "position": [{}, 1, 0], "shadow": true}})", i ? "," : "",
                          i * 0.01);
  writeText(folder / "many.json", R"({"camera": {"eye": [3, 2, 5], "target": [0, 0, 0]},
      "objects": [{"primitive": "box"}], "lights": [)" +
                                      lights + "]}");
  const json info = infoOf("many.json --shadows hard --shadow-memory 1");
  EXPECT_EQ(info["lights"]["casting"], 1000);
  EXPECT_EQ(info["render"]["milliseconds"], nullptr);
  ASSERT_EQ(info["warnings"].size(), 1u);
  EXPECT_THAT(info["warnings"][0].get<std::string>(), HasSubstr("don't fit into 1 MiB"));
}

TEST_F(Info, OutputGoesWhereItIsAskedFor) {
  writeText(folder / "scene.json", kSmallScene);
  const std::string text = succeed("luciole info scene.json");
  EXPECT_THAT(text, HasSubstr("lights       203: 201 point, 1 directional, 1 spot\n"));
  EXPECT_EQ(succeed("luciole info scene.json --json a.json"), text);
  EXPECT_EQ(succeed("luciole info scene.json --json b.json --quiet"), "");
  EXPECT_EQ(readText(folder / "a.json"), readText(folder / "b.json"));
  EXPECT_EQ(succeed("luciole info --json - scene.json"), readText(folder / "a.json"));
  EXPECT_THAT(succeed("luciole info - < scene.json"), HasSubstr("lights       203"));
}

TEST_F(Info, PictureOfOursTellsLayersCameraAndCommand) {
  writeText(folder / "scene.json", kSmallScene);
  const std::string command =
      "luciole render scene.json --quiet --aov normal,depth --crop 8,4,32,16 -o a.exr";
  succeed(command);
  const json info = infoOf("a.exr");
  EXPECT_EQ(info["command"], command);
  EXPECT_THAT(info["software"].get<std::string>(), HasSubstr("Luciole"));
  ASSERT_EQ(info["parts"].size(), 1u);
  const json& part = info["parts"][0];
  EXPECT_EQ(part["width"], 32);
  EXPECT_EQ(part["height"], 16);
  EXPECT_EQ(part["picture"], (json{{"width", 96}, {"height", 54}}));
  EXPECT_EQ(part["origin"], json::array({8, 4}));
  std::map<std::string, json> layers;
  for (const json& layer : part["layers"]) layers[layer["name"]] = layer["channels"];
  EXPECT_THAT(layers[""].dump(), HasSubstr("\"R\",\"G\",\"B\""));
  EXPECT_EQ(layers["N"], json::array({"X", "Y", "Z"}));
  EXPECT_EQ(info["camera"]["eye"], json::array({3.0, 2.0, 5.0}));
  EXPECT_THAT(succeed("luciole info a.exr"), HasSubstr("32x16 from (8, 4) on of 96x54"));
  succeed("luciole gbuffer scene.json --quiet -o g.exr");
  EXPECT_THAT(succeed("luciole info g.exr"), HasSubstr("N            X Y Z  float\n"));
}

/// Bytes of an EXR of 2 × 1 half pixels without compression, as another program writes it.
std::string foreignExr(bool is_rigid) {
  std::string file;
  const auto number = [&](auto value) { file.append(reinterpret_cast<const char*>(&value), sizeof value); };
  const auto text = [&](const std::string& words) { file.append(words.c_str(), words.size() + 1); };
  const auto attribute = [&](const std::string& name, const std::string& type, std::int32_t length) {
    text(name);
    text(type);
    number(length);
  };
  number(std::int32_t(20000630));
  number(std::int32_t(2));
  attribute("channels", "chlist", 2 * 22 + 1);
  for (const char* channel : {"sky.B", "sky.R"}) {
    text(channel);
    for (const std::int32_t value : {1, 0, 1, 1}) number(value);  // half, not linear, every pixel
  }
  file += '\0';
  attribute("comments", "string", 5);
  file += "\xE9t\xE9 5";  // Latin-1
  attribute("compression", "compression", 1);
  file += '\0';
  for (const char* window : {"dataWindow", "displayWindow"}) {
    attribute(window, "box2i", 16);
    for (const std::int32_t value : {0, 0, 1, 0}) number(value);
  }
  attribute("lineOrder", "lineOrder", 1);
  file += '\0';
  attribute("pixelAspectRatio", "float", 4);
  number(1.0f);
  attribute("screenWindowCenter", "v2f", 8);
  number(0.0f);
  number(0.0f);
  attribute("screenWindowWidth", "float", 4);
  number(1.0f);
  attribute("software", "string", 7);
  file += "Painter";
  attribute("worldToCamera", "m44f", 64);
  for (int i = 0; i < 16; ++i)
    number(i == 0 && !is_rigid ? 3.0f : i == 10 ? -1.0f : i % 5 == 0 ? 1.0f : i == 14 ? 4.0f : 0.0f);
  file += '\0';
  number(std::uint64_t(file.size() + 8));
  number(std::int32_t(0));
  number(std::int32_t(8));
  for (int i = 0; i < 4; ++i) number(std::uint16_t(0x3c00));
  return file;
}

TEST_F(Info, PictureOfAnotherProgramTellsWhatItHas) {
  writeText(folder / "a.exr", foreignExr(true));
  const json info = infoOf("a.exr");
  EXPECT_EQ(info["software"], "Painter");
  EXPECT_EQ(info["description"], "\u00e9t\u00e9 5");
  EXPECT_FALSE(info.contains("command"));
  const json& layer = info["parts"][0]["layers"][0];
  EXPECT_EQ(layer["name"], "sky");
  EXPECT_EQ(layer["types"], json::array({"half", "half"}));
  EXPECT_EQ(info["camera"]["eye"], json::array({0.0, 0.0, 4.0}));
  EXPECT_FALSE(info["camera"].contains("fov_y_degrees"));
  EXPECT_EQ(info["warnings"], json::array());
  // A camera that can't be is told, and all else as well.
  writeText(folder / "b.exr", foreignExr(false));
  const json other = infoOf("b.exr");
  EXPECT_EQ(other["camera"], nullptr);
  EXPECT_THAT(other["warnings"].dump(), HasSubstr("worldToCamera"));
}

TEST_F(Info, PngTellsItsCommand) {
  writeText(folder / "scene.json", kSmallScene);
  succeed("luciole render scene.json --quiet -o a.png");
  const json info = infoOf("a.png");
  EXPECT_EQ(info["command"], "luciole render scene.json --quiet -o a.png");
  EXPECT_EQ(info["parts"][0]["layers"][0]["types"], json::array({"uint8", "uint8", "uint8"}));
}

TEST_F(Info, WhatCannotBeReadIsRefusedInOneLine) {
  writeText(folder / "scene.json", kSmallScene);
  refuse("luciole info gone.json", 2, "gone.json");
  refuse("luciole info gone.exr", 2, "gone.exr: no such file");
  refuse("luciole info scene.json --json nowhere/a.json", 2, "nowhere");
  refuse("luciole info scene.json --camera gone", 2, "--camera gone");
  writeText(folder / "text.exr", "no picture");
  refuse("luciole info text.exr", 2, "text.exr");
  succeed("luciole gbuffer scene.json --quiet -o g.exr");
  const std::string whole = readText(folder / "g.exr");
  // Without its end, its second half, and all but the start of its header.
  for (const std::size_t bytes : {whole.size() - 10, whole.size() / 2, std::size_t(100)}) {
    writeText(folder / "broken.exr", whole.substr(0, bytes));
    refuse("luciole info broken.exr", 2, "broken.exr");
  }
}

}  // namespace
}  // namespace luciole::test
