// luciole bench as a person types it, on a picture of few pixels.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "scene/models.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

/// A power, an exponential, a shadow and some lights to cull. The shadow is a spot's, whose maps are small.
constexpr const char* kScene = R"({
  "camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0]}, "background": [0.2, 0.3, 0.4],
  "fog": {"mode": "exp2", "density": 0.05, "color": [0.2, 0.3, 0.4]},
  "materials": {"stone": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}},
  "objects": [{"primitive": "plane", "scale": 10, "material": "stone"},
              {"primitive": "sphere", "translate": [0, 1, 0], "material": "stone"}],
  "lights": [{"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 40, "exponent": 4, "shadow": true}],
  "light_fields": [{"count": 50, "seed": 3, "min": [-4, 0, -4], "max": [4, 2, 4], "range": 0.8, "intensity": 0.5}]
})";

/// kScene with other words in the place of some.
std::string sceneWith(const std::string& words, const std::string& others) {
  const std::string scene = kScene;
  const std::size_t place = scene.find(words);
  return scene.substr(0, place) + others + scene.substr(place + words.size());
}

const nlohmann::json& defaultRow(const nlohmann::json& group) {
  for (const auto& row : group["rows"])
    if (row["default"]) return row;
  throw std::logic_error("no default in " + group["name"].get<std::string>());
}

class BenchCommand : public ProgramTest {
 protected:
  /// The same, and that no file was made.
  void refuse(const std::string& line, int status, const std::string& what) {
    ProgramTest::refuse(line, status, what);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << line;
  }
};

TEST_F(BenchCommand, MeasuresEveryVariantOfEveryGroup) {
  writeText(folder / "scene.json", kScene);
  const Outcome outcome = runLine(folder,
                                  "luciole bench scene.json --only shading --only shadows --only samples "
                                  "--size 64x36 --repeats 1 --json out.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");  // no progress line but on a terminal
  EXPECT_NE(outcome.out.find("samples 1 (default)"), std::string::npos) << outcome.out;
  const auto json = nlohmann::json::parse(readText(folder / "out.json"));
  ASSERT_EQ(json["groups"].size(), 3u);
  std::set<std::string> settings;
  for (const auto& group : json["groups"]) {
    int on_front = 0;
    for (const auto& row : group["rows"]) {
      settings.insert(group["name"].get<std::string>() + row["settings"].dump());
      EXPECT_GT(row["milliseconds"]["median"], 0) << row;
      EXPECT_GT(row["error"]["steps"]["max"], 0) << row;
      EXPECT_GE(row["error"]["steps"]["max"], row["error"]["steps"]["mean"]) << row;
      on_front += row["front"].get<bool>();
    }
    EXPECT_GE(on_front, 1) << group["name"];
  }
  // Each row is another variant: 16 of shading, 17 of shadows, 5 of samples.
  EXPECT_EQ(settings.size(), 16u + 17 + 5);

  const auto& shading = json["groups"][0];
  const auto& usual = defaultRow(shading)["error"]["steps"];
  for (const auto& row : shading["rows"]) {
    const auto& error = row["error"]["steps"];
    if (row["name"] == "no culling") {
      EXPECT_EQ(error, usual);  // culling changes no bit
    }
    // The default polynomials are nearer than float rounds, so that other degrees, and lanes, only deal
    // roundings anew: the mean of 6912 of them scatters by 1 / sqrt(6912), 1.2 % of one; four times that is
    // allowed.
    EXPECT_GE(error["mean"].get<double>(), 0.95 * usual["mean"].get<double>()) << row["name"];
  }

  const auto& samples = json["groups"][2]["rows"];
  EXPECT_LT(samples[4]["error"]["steps"]["mean"], samples[0]["error"]["steps"]["mean"]);
  // The truth must be nearer to itself than what it judges.
  EXPECT_LT(json["groups"][2]["truth_error_steps"], samples[4]["error"]["steps"]["mean"]);
}

TEST_F(BenchCommand, AntiAliasingHoldsSharedSamplesAgainstWholeOnes) {
  writeText(folder / "scene.json", kScene);
  const Outcome outcome = runLine(folder,
                                  "luciole bench scene.json --only anti-aliasing --size 64x36 --repeats 1 "
                                  "--quiet --json out.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto rows = nlohmann::json::parse(readText(folder / "out.json"))["speed"][0]["rows"];
  ASSERT_EQ(rows.size(), 7u);
  for (std::size_t i = 1; i < rows.size(); i += 2) {
    const auto &all = rows[i], &shared = rows[i + 1];
    EXPECT_LT(shared["shadings_per_pixel"], all["shadings_per_pixel"]) << shared;
    EXPECT_GT(shared["rmse_steps"], 0) << shared;
    EXPECT_EQ(all["rmse_times_all"], 1) << all;
  }
}

/// The mean error of a row, in 8-bit steps.
double meanOf(const nlohmann::json& group, const std::string& name) {
  for (const auto& row : group["rows"])
    if (row["name"] == name) return row["error"]["steps"]["mean"];
  throw std::logic_error("no row " + name);
}

TEST_F(BenchCommand, SharpAndSoftShadowsAreEachHeldAgainstTheirOwnTruth) {
  writeText(folder / "scene.json", sceneWith(R"("shadow": true)", R"("shadow": true, "radius": 0.4)"));
  const Outcome outcome = runLine(
      folder, "luciole bench scene.json --only shadows --size 160x90 --repeats 1 --quiet --json out.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto groups = nlohmann::json::parse(readText(folder / "out.json"))["groups"];
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0]["name"], "shadows");
  EXPECT_EQ(groups[1]["name"], "soft shadows");
  // Exact ones are what rays to the light's middle say, but for what shading rounds. Held against the
  // penumbra they would be as wrong as it is wide.
  EXPECT_LT(meanOf(groups[0], "exact 2048"), 1e-3);
  EXPECT_LT(meanOf(groups[0], "exact 2048"), meanOf(groups[0], "hard 2048"));
  EXPECT_GT(meanOf(groups[1], "exact 2048"), 10 * meanOf(groups[0], "exact 2048"));
  // Soft ones know the light's size.
  EXPECT_LT(meanOf(groups[1], "soft 2048"), meanOf(groups[1], "hard 2048"));
  EXPECT_LT(meanOf(groups[1], "soft 2048"), meanOf(groups[1], "no shadows"));
  EXPECT_LT(meanOf(groups[1], "soft-exact, 16 samples"), meanOf(groups[1], "soft 2048"));
  EXPECT_LT(meanOf(groups[1], "soft-exact, 256 samples"), meanOf(groups[1], "soft-exact, 16 samples") / 4);
  for (const auto& group : groups) {
    std::set<std::string> methods;
    for (const auto& row : group["rows"]) methods.insert(row["settings"]["shadows"]);
    EXPECT_EQ(methods.count("soft"), group["name"] == "soft shadows");
    EXPECT_EQ(methods.count("soft-exact"), group["name"] == "soft shadows");
    EXPECT_EQ(methods.count("exact"), 1u);
    EXPECT_NE(outcome.out.find("\n" + group["name"].get<std::string>() + ": "), std::string::npos);
  }
}

TEST_F(BenchCommand, ShadowSizeIsTheOnlyOneTried) {
  writeText(folder / "scene.json", kScene);
  const Outcome outcome =
      runLine(folder,
              "luciole bench scene.json --only shadows --only 'shadow errors' --shadow-size "
              "96 --size 64x36 --repeats 1 --quiet --json -");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  std::vector<std::string> names;
  for (const auto& row : json["groups"][0]["rows"]) names.push_back(row["name"]);
  EXPECT_EQ(names, (std::vector<std::string>{"hard 96", "pcf 96", "exact 96", "soft 96", "no shadows"}));
  for (const auto& row : json["speed"][0]["rows"]) {
    const std::string name = row["name"];
    EXPECT_TRUE(name.find(" 96") != std::string::npos || name.ends_with(", Embree")) << name;
  }
}

/// No table or JSON holds a number that is none, and every null has its reason.
void expectReasons(const nlohmann::json& row) {
  for (const auto& [key, value] : row.items())
    EXPECT_TRUE(!value.is_null() || row["reasons"].contains(key)) << key << " of " << row;
}

TEST_F(BenchCommand, WhatHasNoValueSaysWhy) {
  // No light casts a shadow, and nothing is seen.
  for (const std::string& scene : {sceneWith(R"("shadow": true)", R"("shadow": false)"),
                                   sceneWith(R"("target": [0, 0.5, 0]})", R"("target": [3, 9, 5.5]})")}) {
    writeText(folder / "scene.json", scene);
    const Outcome outcome =
        runLine(folder,
                "luciole bench scene.json --only 'shadow errors' --only shading --size 64x36 --repeats 2 "
                "--shadow-size 512 --quiet --json out.json");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out.find("nan"), std::string::npos) << outcome.out;
    EXPECT_NE(
        outcome.out.find("\n–: scene.json: no surface in the picture faces a light that casts shadows; "),
        std::string::npos)
        << outcome.out;
    const std::string text = readText(folder / "out.json");
    const auto json = nlohmann::json::parse(text);
    // Embree; and each of four methods in one picture, with 16 samples, and in 24 frames.
    ASSERT_EQ(json["speed"][0]["rows"].size(), 13u);
    for (const auto& row : json["speed"][0]["rows"]) {
      expectReasons(row);
      const std::string name = row["name"];
      if (name.ends_with("16 samples") || name.ends_with("24 frames")) continue;  // nobody judges these
      for (const char* key : {"times_rays", "wrongly_dark_percent", "wrongly_lit_percent", "edge_percent"})
        EXPECT_TRUE(row.contains(key) && row[key].is_null()) << key;
      EXPECT_EQ(row["pairs"], 0);
    }
  }
}

TEST_F(BenchCommand, TablesOfOnePixelHaveNoValueThatIsNone) {
  const Outcome outcome = runLine(
      folder, "luciole bench --only 'culling and shading' --size 1x1 --repeats 1 --quiet --json out.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find("nan"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("inf"), std::string::npos) << outcome.out;
  const auto json = nlohmann::json::parse(readText(folder / "out.json"));
  for (const auto& row : json["speed"][0]["rows"]) expectReasons(row);
}

TEST_F(BenchCommand, EveryModelIsHeldAgainstItself) {
  writeText(folder / "scene.json", kScene);
  const Outcome outcome = runLine(
      folder, "luciole bench scene.json --only models --size 64x36 --repeats 1 --quiet --json out.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(readText(folder / "out.json"));
  ASSERT_EQ(json["groups"].size(), 1u);
  const auto& rows = json["groups"][0]["rows"];
  ASSERT_EQ(rows.size(), std::size(kAllModels));
  std::set<double> brightest;
  for (const auto& row : rows) {
    EXPECT_EQ(row["settings"]["model"], row["name"]);
    EXPECT_EQ(row["default"], row["name"] == "phong");
    EXPECT_FALSE(row["front"]) << "no two rows have one truth";
    brightest.insert(row["brightest"].get<double>());
    // Against another model's truth a mean would be hundredths of the brightest. Toon multiplies what 50
    // lights' cosines and the lobe of exponent 32 have rounded, some 10⁻⁶, by 32 in places.
    EXPECT_LT(row["error"]["relative"]["mean"], 1e-6) << row;
  }
  EXPECT_GE(brightest.size(), 3u) << "each has a truth of its own";
}

TEST_F(BenchCommand, WritesThePlotAndASceneWithoutShadowsHasNoGroupOfThem) {
  writeText(folder / "bare.json", sceneWith(R"("shadow": true)", R"("shadow": false)"));
  const Outcome outcome = runLine(folder,
                                  "luciole bench bare.json --only shading --only shadows --only samples "
                                  "--size 64x36 --repeats 1 --json - --plot out.svg");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);  // nothing else on standard output
  ASSERT_EQ(json["groups"].size(), 2u);
  EXPECT_NE(readText(folder / "out.svg").find("</svg>"), std::string::npos);
}

TEST_F(BenchCommand, MeasuresOneThingAlone) {
  writeText(folder / "scene.json", kScene);
  const Outcome outcome = runLine(
      folder, "luciole bench scene.json --only rasterizer --size 64x36 --repeats 2 --quiet --json out.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("| G-buffer, 64 x 36 "), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("8-bit steps"), std::string::npos) << "no errors, so nothing to explain";
  const auto json = nlohmann::json::parse(readText(folder / "out.json"));
  EXPECT_TRUE(json["groups"].empty());
  ASSERT_EQ(json["speed"].size(), 1u);
  EXPECT_EQ(json["speed"][0]["name"], "rasterizer");
  EXPECT_NE(json["speed"][0]["measured"].get<std::string>().find("scene.json"), std::string::npos);
  for (const auto& row : json["speed"][0]["rows"]) {
    EXPECT_GT(row["milliseconds"]["median"], 0) << row;
    EXPECT_GE(row["milliseconds"]["spread"], 0) << row;
    EXPECT_GT(row["times_one_thread"]["median"], 0) << row;
  }
}

TEST_F(BenchCommand, PictureRunsTheProgramOnTheFileAndNotOnStandardInput) {
  writeText(folder / "scene.json", kScene);
  const std::string options = " --only picture --size 64x36 --repeats 1 --quiet --json out.json";
  for (const std::string& line :
       {"luciole bench scene.json" + options, "luciole bench - <scene.json" + options}) {
    const Outcome outcome = runLine(folder, line);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto speed = nlohmann::json::parse(readText(folder / "out.json"))["speed"];
    ASSERT_EQ(speed.size(), 2u);
    EXPECT_EQ(speed[0]["name"], "picture");
    EXPECT_EQ(speed[1]["name"], "cost of a feature");
    for (const auto& table : speed)
      for (const auto& row : table["rows"]) expectReasons(row);
    const bool is_file = line.find('<') == std::string::npos;
    EXPECT_EQ(speed[0]["rows"][0]["warm_milliseconds"].is_null(), !is_file);
    EXPECT_EQ(speed[1]["rows"].size(), is_file ? 7u : 1u);
  }
}

TEST_F(BenchCommand, CullAndShadeTimesAGBufferFromAFileBesideItsRoofs) {
  writeText(folder / "scene.json", kScene);
  ASSERT_EQ(runLine(folder, "luciole gbuffer scene.json --size 80x45 -o g.exr --quiet").status, 0);
  const Outcome outcome = runLine(folder,
                                  "luciole bench --gbuffer g.exr --scene scene.json --only 'cull and shade' "
                                  "--model blinn-phong --repeats 3 --quiet --json out.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(readText(folder / "out.json"));
  ASSERT_EQ(json["speed"].size(), 1u);
  EXPECT_NE(json["speed"][0]["measured"].get<std::string>().find("blinn-phong"), std::string::npos);
  // What was measured, and not the built-in scene.
  EXPECT_EQ(json["scene"]["name"], "scene.json");
  EXPECT_EQ(json["image"], nlohmann::json({{"width", 80}, {"height", 45}}));
  const nlohmann::json measured{
      {"file", "g.exr"}, {"scene", "scene.json"}, {"lights", json["scene"]["lights"]},
      {"width", 80},     {"height", 45},          {"model", "blinn-phong"}};
  EXPECT_EQ(json["gbuffer"], measured);
  EXPECT_NE(outcome.out.find("g.exr: 80 x 45 pixels, by the "), std::string::npos) << outcome.out;
  const auto& rows = json["speed"][0]["rows"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["name"], "cull and shade");
  for (const auto& row : rows) {
    EXPECT_GT(row["best_ms"], 0) << row;
    EXPECT_LE(row["best_ms"], row["median_ms"]) << row;
  }
  EXPECT_GT(rows[0]["pairs_evaluated"], 0);
  EXPECT_GT(rows[0]["pairs_in_range"], 0);
  // 5 x 3 tiles; at least position, normal and diffuse colour are read, and at most specular, ambient and
  // emission with them, and three floats written.
  EXPECT_GE(rows[0]["bytes"], 15 * 256 * 12 * 4);
  EXPECT_LE(rows[0]["bytes"], 15 * 256 * 22 * 4);
}

TEST_F(BenchCommand, RefusesWrongInputBeforeItMeasures) {
  refuse("luciole bench --gbuffer g.exr", 2, "--scene");
  refuse("luciole bench --gbuffer g.exr --scene scene.json --only shading", 2, "which --only leaves out");
  refuse("luciole bench --only 'cull and shade'", 2, "needs --gbuffer and --scene");
  refuse("luciole bench --model toon", 2, "--model requires --gbuffer");
  refuse("luciole bench none.json", 2, "none.json");
  refuse("luciole bench --json none/out.json", 2, "none/out.json: no such folder");
  refuse("luciole bench --plot none/out.svg", 2, "none/out.svg: no such folder");
  refuse("luciole bench --plot out.png", 2, "out.png: expected a .svg file");
  refuse("luciole bench --plot out.svg --only start", 2, "--plot out.svg: shows shading");
  refuse("luciole bench --only everything", 2, "--only");
  refuse("luciole bench --size 64y", 2, "--size");
  refuse("luciole bench --repeats 0", 2, "--repeats");
  refuse("luciole bench --shadow-size 15", 2, "--shadow-size");
  refuse("luciole bench --device no-such-device", 2, "no-such-device");
}

}  // namespace
}  // namespace luciole::test
