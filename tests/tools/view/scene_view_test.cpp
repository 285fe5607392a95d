// What a page asks of a scene, without a server between.
#include "tools/view/scene_view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/random.hpp"
#include "luciole/error.hpp"
#include "luciole/load_scene.hpp"
#include "render_json.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using Json = nlohmann::json;

constexpr const char* kViewedScene =
    R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0], "fov_y": 60}, "size": [90, 70], "background": [0, 0, 0.25],
  "ambient": 0.1, "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}},
  "objects": [{"primitive": "plane", "scale": 20, "segments": 9, "material": "m"},
              {"primitive": "sphere", "translate": [0, 1, 0], "material": "m"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "intensity": 0.5, "shadow": true},
             {"type": "point", "position": [1, 2, 2], "range": 4, "shadow": true, "color": [1, 0.5, 0.2]},
             {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 40, "exponent": 4}]})";

/// What an answer says, and its picture.
struct Shown {
  int status = 0;
  Json about = {};
  std::string bytes = {};
};

class SceneViews : public testing::Test {
 protected:
  SceneViews() {
    writeScene(kViewedScene);
    view.emplace(testDevice(), SceneSource{.path = folder / "scene.json",
                                           .folder = folder.path().string(),
                                           .load = [this] { return loadScene(folder / "scene.json"); },
                                           .settings =
                                               [](const ViewOptions& options, Scene& scene) {
                                                 if (options.contains("wrong"))
                                                   throw InputError("options: wrong");
                                                 RenderSettings settings = settingsFor(scene, {90, 70});
                                                 if (options.contains("shading"))
                                                   settings.shading = Shading::kFlat;
                                                 return settings;
                                               }});
  }

  void writeScene(const std::string& text) const {
    std::ofstream(folder / "scene.json", std::ios::binary | std::ios::trunc) << text;
  }

  Json request() {
    return {{"page", "p"},
            {"number", ++number},
            {"size", {90, 70}},
            {"samples", 1},
            {"view", {{"camera", nullptr}, {"changes", Json::array()}, {"options", Json::object()}}}};
  }

  static Shown shownBy(const Answer& answer) {
    Shown shown{answer.status};
    if (answer.type == "application/json") {
      shown.about = Json::parse(answer.body);
      return shown;
    }
    std::uint32_t length = 0;
    for (int i = 3; i >= 0; --i)
      length = length << 8 | static_cast<unsigned char>(answer.body.at(std::size_t(i)));
    shown.about = Json::parse(answer.body.substr(4, length));
    shown.bytes = answer.body.substr(4 + length);
    return shown;
  }
  Shown picture(const Json& json) { return shownBy(view->picture(json.dump())); }

  /// The PNG that render makes of a scene's text.
  std::string rendered(const std::string& json, const std::function<void(RenderSettings&)>& set = {}) {
    const Scene scene = sceneFromJson(json);
    RenderSettings settings = settingsFor(scene, {90, 70});
    if (set) set(settings);
    std::string bytes;
    writeImage(test::picture(scene, settings), "a.png", {}, {.dither = true, .memory = &bytes});
    return bytes;
  }

  /// The scene's text with these members in place of its own.
  static std::string with(const Json& members) {
    Json json = Json::parse(kViewedScene);
    json.update(members);
    return json.dump();
  }

  const TemporaryFolder folder;
  std::optional<SceneView> view;
  std::uint64_t number = 0;
};

TEST_F(SceneViews, PicturesHaveTheBitsOfRender) {
  const Shown shown = picture(request());
  ASSERT_EQ(shown.status, 200) << shown.about;
  EXPECT_EQ(shown.about["type"], "image/png");
  EXPECT_EQ(shown.about["size"], (Json{90, 70}));
  EXPECT_TRUE(shown.bytes == rendered(kViewedScene));
  EXPECT_THAT(shown.about["stages"].dump(), HasSubstr("rasterize"));
  Json flat = request();
  flat["view"]["options"]["shading"] = "flat";
  EXPECT_TRUE(picture(flat).bytes ==
              rendered(kViewedScene, [](RenderSettings& one) { one.shading = Shading::kFlat; }));
  EXPECT_TRUE(picture(request()).bytes == shown.bytes) << "a change that was taken back leaves nothing";
}

TEST_F(SceneViews, GesturesGiveTheCameraThatThePictureShows) {
  for (const Json& gesture : {Json{{"orbit", {0.2, 0.1}}}, Json{{"pan", {0.1, -0.2}}}, Json{{"dolly", 2}},
                              Json{{"walk", {0.1, 0.2, 0.3}}}, Json{{"turn", {0.1, -0.1}}}}) {
    Json moved = request();
    moved["gesture"] = gesture;
    const Shown shown = picture(moved);
    ASSERT_EQ(shown.status, 200) << shown.about;
    ASSERT_TRUE(shown.about["camera"].is_object()) << gesture;
    EXPECT_TRUE(shown.bytes == rendered(with({{"camera", shown.about["camera"]}}))) << gesture;
    EXPECT_FALSE(shown.bytes == rendered(kViewedScene)) << gesture;
    Json again = request();
    again["view"]["camera"] = shown.about["camera"];
    EXPECT_TRUE(picture(again).bytes == shown.bytes) << gesture;
  }
}

TEST_F(SceneViews, AnOrbitKeepsItsDistanceAndDoesNotPassThePole) {
  Json moved = request();
  for (int i = 0; i < 20; ++i) {
    moved["gesture"] = {{"orbit", {0.05, 0.3}}};
    moved["number"] = ++number;
    const Shown shown = picture(moved);
    ASSERT_EQ(shown.status, 200) << shown.about;
    moved["view"]["camera"] = shown.about["camera"];
    const Json& eye = shown.about["camera"]["eye"];
    const glm::dvec3 away(eye[0].get<double>(), eye[1].get<double>() - 0.5, eye[2].get<double>());
    // Each turn rounds a vector of 6 m; so do 20 of them.
    EXPECT_NEAR(glm::length(away), std::sqrt(9 + 2.25 + 25), 20 * 16 * 6 * 0x1p-53);
  }
  EXPECT_GT(moved["view"]["camera"]["eye"][1].get<double>(), 6) << "near the pole above";
}

TEST_F(SceneViews, ChangesAreThoseOfTheScenesText) {
  Json lights = Json::parse(kViewedScene)["lights"];
  Json asked = request();
  asked["view"]["changes"] = {"lights[1].position=[0, 3, 1]", "ambient=[0.3, 0.2, 0.1]",
                              "fog={\"mode\": \"exp\"}", "fog.color=#ffffff*0.5",
                              "materials.m.diffuse=#ff0000*0.25"};
  lights[1]["position"] = {0, 3, 1};
  const Shown shown = picture(asked);
  ASSERT_EQ(shown.status, 200) << shown.about;
  EXPECT_TRUE(shown.bytes ==
              rendered(with({{"lights", lights},
                             {"ambient", {0.3, 0.2, 0.1}},
                             {"fog", {{"mode", "exp"}, {"color", {0.5, 0.5, 0.5}}}},
                             {"materials",
                              {{"m", {{"diffuse", {0.25, 0, 0}}, {"specular", 0.5}, {"shininess", 32}}}}}})));
}

TEST_F(SceneViews, ADraggedLightMovesWithThePointer) {
  const Shown before = picture(request());
  Json asked = request();
  asked["gesture"] = {{"drag_light", {1, 0.1, 0}}};
  const Shown shown = picture(asked);
  ASSERT_EQ(shown.status, 200) << shown.about;
  ASSERT_EQ(shown.about["changes"].size(), 1u);
  const auto markerOf = [](const Shown& one) {
    for (const Json& marker : one.about["markers"])
      if (marker[0] == 1) return marker;
    return Json();
  };
  // A tenth of the height is 7 of 90 pixels of width.
  EXPECT_NEAR(markerOf(shown)[1].get<double>() - markerOf(before)[1].get<double>(), 7.0 / 90, 1e-9);
  EXPECT_NEAR(markerOf(shown)[2].get<double>(), markerOf(before)[2].get<double>(), 1e-9);
  Json again = request();
  again["view"]["changes"] = shown.about["changes"];
  EXPECT_TRUE(picture(again).bytes == shown.bytes);
}

TEST_F(SceneViews, FramesOfAMotionAreJpegsAndSmallerWhereTheyTakeLong) {
  Json asked = request();
  asked["size"] = {640, 360};
  asked["moving"] = true;
  const Shown first = picture(asked);
  EXPECT_EQ(first.about["type"], "image/jpeg");
  EXPECT_EQ(first.bytes.substr(0, 2), "\xff\xd8");
  EXPECT_LE(first.about["size"][0].get<int>(), 640);
  for (int i = 0; i < 5; ++i) {
    asked["number"] = ++number;
    asked["moving"] = {{"milliseconds", 300}, {"size", {320, 180}}};
    asked["size"] = {640, 360};
    EXPECT_LT(picture(asked).about["size"][0].get<int>(), 320);
  }
}

TEST_F(SceneViews, ANewerRequestOfThePageTakesTheOlderOnesPlace) {
  Json newer = request(), older = request();
  newer["number"] = 100;
  older["number"] = 99;
  EXPECT_EQ(picture(newer).status, 200);
  EXPECT_EQ(picture(older).status, 409);
  older["page"] = "another";
  EXPECT_EQ(picture(older).status, 200) << "pages count for themselves";
}

TEST_F(SceneViews, EachLayerIsAPicture) {
  for (const char* layer : {"normal", "depth", "light_count", "shadow", "light_error", "diffuse", "position",
                            "error", "shadow_map"}) {
    Json asked = request();
    asked["layer"] = layer;
    const Shown shown = picture(asked);
    EXPECT_EQ(shown.status, 200) << layer << shown.about;
    EXPECT_EQ(shown.bytes.substr(1, 3), "PNG") << layer;
  }
  Json asked = request();
  asked["layer"] = "nothing";
  EXPECT_EQ(picture(asked).status, 422);
  asked = request();
  asked["layer"] = "shadow_map";
  asked["light"] = 2;
  EXPECT_THAT(picture(asked).about["error"].get<std::string>(), HasSubstr("casts no shadow"));
}

TEST_F(SceneViews, AnEditedShaderChangesThePictureAndABrokenOneSaysWhere) {
  const std::string before = picture(request()).bytes;
  Json asked = request();
  asked["view"]["shaders"] = {{"screen",
                               "#define RADIUS 0\nINLINE vec3L screen(const Screen *at) {\n"
                               "  vec3L c = color_at(at, 0, 0);\n  c.x = 0.0f;\n  return c;\n}\n"}};
  const Shown edited = picture(asked);
  ASSERT_EQ(edited.status, 200) << edited.about;
  EXPECT_NE(edited.bytes, before);
  asked["number"] = ++number;
  asked["view"]["shaders"]["screen"] =
      "#define RADIUS 0\nINLINE vec3L screen(const Screen *at) {\n  retur 1;\n}\n";
  const Shown broken = picture(asked);
  EXPECT_EQ(broken.status, 422);
  EXPECT_EQ(broken.about["shader"]["kind"], "screen") << broken.about;
  EXPECT_EQ(broken.about["shader"]["line"], 3) << broken.about;
  EXPECT_TRUE(picture(request()).bytes == before);
}

TEST_F(SceneViews, TextsOfShadersThatCameAndWentDoNotStayInMemory) {
  for (int i = 0; i < 80; ++i) {
    Json asked = request();
    asked["size"] = {16, 16};
    asked["view"]["shaders"] = {
        {"screen",
         "#define RADIUS 0\nINLINE vec3L screen(const Screen *at) {\n  return color_at(at, 0, 0); // " +
             std::to_string(i) + "\n}\n"}};
    ASSERT_EQ(picture(asked).status, 200);
  }
  EXPECT_LE(testDevice().programs.size(), 96u);
}

TEST_F(SceneViews, PickTellsWhatIsThere) {
  Json asked = request();
  asked["at"] = {0.5, 0.5};
  Json found = Json::parse(view->pick(asked.dump()).body);
  EXPECT_EQ(found["object"], "object 1");
  EXPECT_EQ(found["pixel"], (Json{45, 35}));
  EXPECT_EQ(found["position"].size(), 3u);
  asked["at"] = {0.5, 0};
  found = Json::parse(view->pick(asked.dump()).body);
  EXPECT_TRUE(found["material"].is_null()) << found;
}

TEST_F(SceneViews, AFileThatChangedIsReadAgainAndAWrongOneIsToldWhileTheSceneStays) {
  const Json before = Json::parse(view->state().body);
  EXPECT_EQ(before["fault"], nullptr);
  EXPECT_EQ(before["light_count"], 3);
  const std::string shown = picture(request()).bytes;
  const auto later = [&] {
    const auto time = std::filesystem::last_write_time(folder / "scene.json") + std::chrono::seconds(5);
    std::filesystem::last_write_time(folder / "scene.json", time);
  };
  writeScene("{\"lights\": 3}");
  later();
  const Json wrong = Json::parse(view->state().body);
  EXPECT_NE(wrong["generation"], before["generation"]);
  EXPECT_THAT(wrong["fault"].get<std::string>(), HasSubstr("lights"));
  EXPECT_TRUE(picture(request()).bytes == shown);
  EXPECT_EQ(Json::parse(view->state().body)["generation"], wrong["generation"]) << "told once";
  const std::string other = with({{"background", {1, 0, 0}}, {"lights", Json::array()}});
  writeScene(other);
  later();
  later();
  const Json mended = Json::parse(view->state().body);
  EXPECT_EQ(mended["fault"], nullptr);
  EXPECT_EQ(mended["light_count"], 0);
  EXPECT_TRUE(picture(request()).bytes == rendered(other));
}

TEST_F(SceneViews, WhatIsSavedGivesTheSavedBits) {
  Json asked = request();
  asked["view"]["changes"] = {"lights[0].direction=[-0.3, -1, 0.2]", "lights[1].color=#ff8000",
                              "lights[2].enabled=false", "materials.m.shininess=4", "background=#102030"};
  asked["gesture"] = {{"orbit", {0.3, 0.1}}};
  const Shown shown = picture(asked);
  ASSERT_EQ(shown.status, 200) << shown.about;
  Json save = request();
  save["view"] = asked["view"];
  save["view"]["camera"] = shown.about["camera"];
  save["what"] = {"scene", "png", "exr"};
  const Answer answer = view->save(save.dump());
  ASSERT_EQ(answer.status, 200) << answer.body;
  const Json saved = Json::parse(answer.body);
  EXPECT_EQ(saved["files"],
            (Json{folder / "scene-view-1.json", folder / "scene-view-1.png", folder / "scene-view-1.exr"}));
  EXPECT_THAT(saved["command"].get<std::string>(), HasSubstr("luciole render"));
  const Scene scene = loadScene(folder / "scene-view-1.json");
  EXPECT_EQ(scene.lights.size(), 3u);
  const Image again = test::picture(scene, settingsFor(scene, {90, 70}));
  EXPECT_TRUE(readImage(folder / "scene-view-1.exr").pixels == again.pixels);
  std::string bytes;
  writeImage(again, "a.png", {}, {.dither = true, .memory = &bytes});
  EXPECT_TRUE(bytes == shown.bytes) << "the page's own";
  EXPECT_THAT(Json::parse(view->save(save.dump()).body)["files"].dump(), HasSubstr("scene-view-2.png"))
      << "nothing is overwritten";
}

/// The changes that a saved view's command makes by --set, quoted where they need it.
std::vector<std::string> changesOf(const std::string& command) {
  std::vector<std::string> changes;
  const std::string option = "--set ";
  for (std::size_t at = command.find(option); at != std::string::npos; at = command.find(option, at + 1)) {
    const std::size_t begin = at + option.size();
    const bool is_quoted = command[begin] == '\'';
    const std::size_t end = command.find(is_quoted ? '\'' : ' ', begin + 1);
    changes.push_back(command.substr(begin + is_quoted, end - begin - is_quoted));
  }
  return changes;
}

TEST_F(SceneViews, WhatIsSavedOfAMeshFileGivesTheSavedBits) {
  std::ofstream(folder / "box.mtl") << "newmtl red\nKd 0.8 0.1 0.1\nKs 0.5 0.5 0.5\nNs 20\n";
  std::ofstream(folder / "box.obj")
      << "mtllib box.mtl\nusemtl red\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 1 1\n"
         "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
  SceneView of_mesh(testDevice(), {.path = folder / "box.obj",
                                   .folder = folder.path().string(),
                                   .load = [this] { return loadScene(folder / "box.obj"); },
                                   .settings =
                                       [](const ViewOptions&, Scene& scene) {
                                         return settingsFor(scene, {90, 70});
                                       }});
  Json asked = request();
  asked["view"]["changes"] = {"materials[0].diffuse=#3060ff", "lights[0].intensity=2"};
  asked["gesture"] = {{"orbit", {0.3, 0.1}}};
  const Shown shown = shownBy(of_mesh.picture(asked.dump()));
  ASSERT_EQ(shown.status, 200) << shown.about;
  asked["view"]["camera"] = shown.about["camera"];
  asked["what"] = {"scene", "exr"};
  asked.erase("gesture");
  const Answer answer = of_mesh.save(asked.dump());
  ASSERT_EQ(answer.status, 200) << answer.body;
  LoadSettings load;
  load.changes = changesOf(Json::parse(answer.body)["command"]);
  ASSERT_EQ(load.changes.size(), 1u) << answer.body;
  const Scene scene = loadScene(folder / "box-view-1.json", 1, load);
  EXPECT_TRUE(readImage(folder / "box-view-1.exr").pixels ==
              test::picture(scene, settingsFor(scene, {90, 70})).pixels);
}

TEST_F(SceneViews, NoRequestNamesAFile) {
  for (const char* change :
       {"materials.m.diffuse_map=/etc/passwd", "objects[0].mesh=/etc/passwd", "lights[0].profile=/etc/passwd",
        "light_fields[0].csv=/etc/passwd", "materials.m.model=/tmp/a.clh", "camera.eye=[0,0,0]", "size=[1,1]",
        "lights=[]", "materials.m.diffuse=#12345", "materials.m.diffuse=#123456*nan", "fog.color=#123456"}) {
    Json asked = request();
    asked["view"]["changes"] = {change};
    EXPECT_EQ(picture(asked).status, 422) << change;
  }
}

/// Text with some bytes changed, taken out or doubled.
std::string mutated(std::string text, std::uint64_t& random) {
  for (int i = 0; i < 3 && !text.empty(); ++i) {
    const std::size_t at = std::size_t(nextUniform(random) * double(text.size()));
    const double what = nextUniform(random);
    if (what < 0.4)
      text[at] = char(nextUniform(random) * 256);
    else if (what < 0.7)
      text.erase(at, 1 + std::size_t(nextUniform(random) * 8));
    else
      text.insert(at, text.substr(at, 16));
  }
  return text;
}

TEST_F(SceneViews, RandomRequestsAreAnsweredOrRefused) {
  std::uint64_t random = 41;
  Json asked = request();
  asked["size"] = {16, 12};
  asked["view"]["camera"] = {{"eye", {3, 2, 5}}, {"target", {0, 0.5, 0}}, {"up", {0, 1, 0}},
                             {"fov_y", 60},      {"near", 0.1},           {"far", 100}};
  asked["view"]["changes"] = {"lights[1].position=[0, 3, 1]", "materials.m.diffuse=#ff0000*0.25"};
  asked["gesture"] = {{"orbit", {0.2, 0.1}}};
  asked["at"] = {0.5, 0.5};
  const std::string body = asked.dump();
  int good = 0;
  for (int i = 0; i < 1500; ++i) {
    const std::string one = mutated(body, random);
    for (const Answer& answer : {view->picture(one), view->pick(one)}) {
      EXPECT_THAT((std::vector{200, 409, 422}), Contains(answer.status)) << one << "\n" << answer.body;
      good += answer.status == 200;
    }
  }
  EXPECT_GT(good, 10);
  Json last = request();
  last["page"] = "another";
  EXPECT_EQ(picture(last).status, 200);
}

}  // namespace
}  // namespace luciole::test
