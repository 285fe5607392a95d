#include "scene/json/json_scene.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "load/frame.hpp"
#include "luciole/error.hpp"
#include "luciole/load_scene.hpp"
#include "luciole/pose.hpp"
#include "scene/json/write_scene.hpp"
#include "scene/lights/light_field.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

class JsonScene : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; }
  Scene load(const std::string& text) {
    write("scene.json", text);
    return loadJsonScene(folder / "scene.json").scene;
  }
  /// With what is made of it.
  Scene loadWhole(const std::string& text) {
    write("scene.json", text);
    return loadScene(folder / "scene.json");
  }
  /// The message for a scene that must be refused, without the path before the file's name.
  std::string refusal(const std::string& text) {
    try {
      loadWhole(text);
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      return message.substr(folder.path().string().size() + 1);
    }
    ADD_FAILURE() << "accepted: " << text.substr(0, 300);
    return "";
  }
  test::TemporaryFolder folder;
};

TEST_F(JsonScene, EmptySceneHasTheDocumentedDefaults) {
  const Scene scene = load("{}");
  EXPECT_TRUE(scene.cameras.empty());
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_FALSE(scene.size);
  EXPECT_EQ(scene.background, glm::vec3(0));
  EXPECT_EQ(scene.ambient, glm::vec3(0));
  EXPECT_EQ(scene.fog.mode, FogMode::kNone);
  EXPECT_TRUE(scene.lighting);
}

TEST_F(JsonScene, ReadsTheWholeOfAScene) {
  const Scene scene = load(R"({ // a comment
    "camera": {"eye": [0,0,5], "target": [0,0,0], "fov_y": 90, "near": 0.5, "far": 50, "shift": [0.25, -1.5], "pixel_aspect": 1.1},
    "size": [640, 480], "background": [0.1,0.2,0.3], "ambient": 0.25, "lighting": false,
    "fog": {"mode": "exp2", "density": [0.1,0.2,0.3], "color": [1,1,1], "distance": "radial"},
    "materials": {"red": {"diffuse": [1,0,0], "specular": 0.5, "shininess": 32, "double_sided": true}},
    "objects": [{"primitive": "box", "material": "red", "translate": [1,2,3], "scale": 2}, {"primitive": "box"}],
    "lights": [{"type": "point", "position": [1,2,3], "color": [1,0.5,0.25], "intensity": 4, "range": 6, "shadow": true},
               {"type": "point", "position": [0,0,0], "enabled": false},
               {"type": "directional", "direction": [0,-2,0], "ambient": [1,0,0], "diffuse": [0,1,0], "specular": 0},
               {"type": "spot", "position": [0,5,0], "target": [0,0,0], "cutoff": 30, "exponent": 8},
               {"type": "spot", "position": [0,5,0], "direction": [0,0,1], "inner_cone": 10, "outer_cone": 20}]})");
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].camera_to_world[3], glm::dvec4(0, 0, 5, 1));
  EXPECT_EQ(scene.cameras[0].camera_to_world[2], glm::dvec4(0, 0, 1, 0));
  EXPECT_EQ(scene.cameras[0].fov_y, glm::radians(90.0));
  EXPECT_EQ(scene.cameras[0].shift, glm::dvec2(0.25, -1.5));
  EXPECT_EQ(scene.cameras[0].pixel_aspect, 1.1);
  EXPECT_EQ(scene.size, glm::ivec2(640, 480));
  EXPECT_EQ(scene.ambient, glm::vec3(0.25f));
  EXPECT_FALSE(scene.lighting);
  EXPECT_EQ(scene.fog.mode, FogMode::kExp2);
  EXPECT_TRUE(scene.fog.radial);
  EXPECT_EQ(scene.fog.density, glm::vec3(0.1f, 0.2f, 0.3f));
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.meshes.size(), 1u) << "equal primitives are one mesh";
  const Material& red = scene.materials[static_cast<std::size_t>(scene.objects[0].material)];
  EXPECT_EQ(red.diffuse, glm::vec3(1, 0, 0));
  EXPECT_EQ(red.ambient, red.diffuse);
  EXPECT_EQ(red.shininess, 32);
  EXPECT_TRUE(red.double_sided);
  EXPECT_EQ(scene.objects[0].object_to_world * glm::dvec4(0.5, 0, 0, 1), glm::dvec4(2, 2, 3, 1));
  const Material& plain = scene.materials[scene.meshes[0].triangle_materials[0]];
  EXPECT_EQ(plain.ambient, plain.diffuse);

  ASSERT_EQ(scene.lights.size(), 4u) << "the disabled light is dropped";
  EXPECT_EQ(scene.lights[0].diffuse, glm::vec3(4, 2, 1));
  EXPECT_EQ(scene.lights[0].specular, glm::vec3(4, 2, 1));
  EXPECT_EQ(scene.lights[0].ambient, glm::vec3(0));
  EXPECT_EQ(scene.lights[0].range, 6);
  EXPECT_TRUE(scene.lights[0].shadow);
  EXPECT_EQ(scene.lights[1].kind, LightKind::kDirectional);
  EXPECT_EQ(scene.lights[1].direction, glm::dvec3(0, -1, 0));
  EXPECT_EQ(scene.lights[1].ambient, glm::vec3(1, 0, 0));
  EXPECT_EQ(scene.lights[1].specular, glm::vec3(0));
  EXPECT_EQ(scene.lights[2].kind, LightKind::kSpot);
  EXPECT_EQ(scene.lights[2].direction, glm::dvec3(0, -1, 0));
  EXPECT_EQ(scene.lights[2].cutoff, glm::radians(30.0));
  EXPECT_EQ(scene.lights[3].falloff, SpotFalloff::kCone);
  EXPECT_EQ(scene.lights[3].inner_cone, glm::radians(10.0));
}

TEST_F(JsonScene, RotationIsAboutXThenYThenZ) {
  const Scene scene =
      load(R"({"objects": [{"primitive": "box", "rotate": [90, 90, 0], "translate": [0,0,10]}]})");
  // y turns to z about x, z to x about y. Each rotation is exact to an ulp of 1: some 10⁻¹⁶ a step, two
  // steps.
  const glm::dvec3 turned = scene.objects[0].object_to_world * glm::dvec4(0, 1, 0, 1);
  EXPECT_LT(glm::distance(turned, glm::dvec3(1, 0, 10)), 4 * 2.3e-16 + 10 * 2.3e-16);
}

TEST_F(JsonScene, SpotWithCutoff180IsAPointLight) {
  const Scene scene = load(
      R"({"lights": [{"type": "spot", "position": [0,0,0], "direction": [0,-1,0], "cutoff": 180, "exponent": 9}]})");
  EXPECT_EQ(scene.lights[0].kind, LightKind::kPoint);
}

TEST_F(JsonScene, LightsMayHaveASize) {
  const Scene scene = load(R"({"lights": [
      {"type": "point", "position": [0,0,0], "radius": 0.25}, {"type": "point", "position": [0,0,0]},
      {"type": "directional", "direction": [0,-1,0], "angle": 0.5}]})");
  EXPECT_EQ(scene.lights[0].radius, 0.25);
  EXPECT_EQ(scene.lights[1].radius, 0);
  EXPECT_EQ(scene.lights[2].half_angle, glm::radians(0.25));
  for (const char* wrong : {R"({"type": "point", "position": [0,0,0], "radius": -1})",
                            R"({"type": "point", "position": [0,0,0], "angle": 1})",
                            R"({"type": "directional", "direction": [0,-1,0], "radius": 1})",
                            R"({"type": "directional", "direction": [0,-1,0], "angle": 91})"})
    EXPECT_THAT(refusal(std::string(R"({"lights": [)") + wrong + "]}"), HasSubstr("scene.json: lights[0]"))
        << wrong;
}

TEST_F(JsonScene, ObjectsHaveTheirNamesAndThoseOfAFilesParts) {
  write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("two.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
      "nodes": [{"name": "door", "mesh": 0}, {"mesh": 0, "translation": [1, 0, 0]}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3", "bufferView": 0, "min": [0, 0, 0], "max": [1, 1, 0]}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  const Scene scene = load(R"({"objects": [{"mesh": "one.obj", "name": "sheet"}, {"mesh": "one.obj"},
      {"mesh": "two.gltf", "name": "house"}, {"mesh": "two.gltf"}]})");
  std::vector<std::string> names;
  for (const Object& object : scene.objects) names.push_back(object.name);
  EXPECT_EQ(names, (std::vector<std::string>{"sheet", "", "house/door", "house", "door", ""}));
}

TEST_F(JsonScene, LightsAndFieldsHaveGroupsByName) {
  const Scene scene = loadWhole(R"({"lights": [
      {"type": "point", "position": [0,0,0], "group": "key"}, {"type": "point", "position": [0,0,0]},
      {"type": "directional", "direction": [0,-1,0], "group": "rim"}, {"type": "point", "position": [0,0,0], "group": "key"}],
      "light_fields": [{"count": 2, "min": [0,0,0], "max": [1,1,1], "group": "rim"}]})");
  EXPECT_EQ(scene.light_groups, (std::vector<std::string>{"default", "key", "rim"}));
  std::vector<std::uint32_t> groups;
  for (const Light& light : scene.lights) groups.push_back(light.group);
  EXPECT_EQ(groups, (std::vector<std::uint32_t>{1, 0, 2, 1, 2, 2}));
}

TEST_F(JsonScene, CamerasKeepTheOrderOfTheFile) {
  const Scene scene =
      load(R"({"cameras": {"z": {"eye":[0,0,1],"target":[0,0,0]}, "a": {"eye":[0,0,2],"target":[0,0,0],
                              "orthographic": 3}}})");
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[0].name, "z");
  EXPECT_EQ(scene.cameras[1].name, "a");
  EXPECT_TRUE(scene.cameras[1].orthographic);
  EXPECT_EQ(scene.cameras[1].half_height, 3);
}

TEST_F(JsonScene, MeshFileUsedTwiceIsLoadedOnce) {
  write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Scene scene = load(R"({"objects": [{"mesh": "t.obj"}, {"mesh": "./t.obj", "translate": [5,0,0]}]})");
  EXPECT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].mesh, scene.objects[1].mesh);
  EXPECT_EQ(scene.objects[1].object_to_world[3].x, 5);
}

TEST_F(JsonScene, MessagesNameFilePlaceFaultAndExpectation) {
  const auto light = [](const std::string& rest) {
    return R"({"lights": [{"type": "point", )" + rest + "}]}";
  };
  EXPECT_EQ(refusal(light(R"("position": [0, "NaN", 0])")),
            "scene.json: lights[0].position[1]: expected a finite number, got \"NaN\"");
  EXPECT_EQ(refusal(light(R"("position": [0,0,0], "colour": [1,1,1])")),
            "scene.json: lights[0]: unknown key \"colour\" (did you mean \"color\"?)");
  EXPECT_EQ(refusal(R"({"materials": {"m": {"speculr": 1}}})"),
            "scene.json: materials.m: unknown key \"speculr\" (did you mean \"specular\"?)");
  EXPECT_EQ(refusal(light(R"("position": [0,0,0], "cutoff": 30)")),
            "scene.json: lights[0].cutoff: means nothing for a light that isn't a spot");
  EXPECT_EQ(refusal(R"({"objects": [{"mesh": "gone.obj"}]})"),
            "scene.json: objects[0].mesh: there is no file " + folder / "gone.obj");
  EXPECT_EQ(refusal(R"({"objects": [{"primitive": "box", "material": "gold"}]})"),
            "scene.json: objects[0].material: no material is called \"gold\"");
  EXPECT_EQ(refusal(R"({"size": [0, 5]})"), "scene.json: size: 0x5 pixels, expected 1 to 32768 a side");
  EXPECT_THAT(refusal("{\n  \"size\": [1,\n  2\n"), HasSubstr("scene.json: line 4, column 1: syntax error"));
  EXPECT_THAT(refusal(std::string("{}\0{}", 5)),
              HasSubstr("scene.json: byte 3 is 0, expected text in UTF-8"));
  EXPECT_THAT(refusal(R"({"ambient": [0, 1e999, 0]})"),
              HasSubstr("scene.json: ambient[1]: expected a finite number"));
  EXPECT_THAT(refusal(R"({"ambient": 1, "ambient": 2})"),
              EndsWith("scene.json: ambient: this key is given twice"));
  EXPECT_THAT(refusal(R"({"lights": [{"type":"point","position":[0,0,0]}, {"type":"point","type":"spot"}]})"),
              EndsWith("scene.json: lights[1].type: this key is given twice"));
}

TEST_F(JsonScene, AMissingPictureIsToldByItsPlaceAndItsMaterialDoesWithout) {
  const Scene scene = load(
      R"({"materials": {"m": {"diffuse_map": "gone.png", "emission_map": "gone.png", "alpha_map": "gone.png"}}})");
  ASSERT_EQ(scene.missing_textures.size(), 3u);
  EXPECT_EQ(scene.missing_textures[0], fmt::format("{}: materials.m.diffuse_map: there is no file {}",
                                                   folder / "scene.json", folder / "gone.png"));
  const Material& material = scene.materials.back();
  EXPECT_EQ(material.diffuse_map.texture, -1);
  EXPECT_EQ(material.emission, glm::vec3(0));
  EXPECT_EQ(material.alpha_cutoff, 0);
}

TEST_F(JsonScene, FogKeysOfAnotherModeAreToldWithTheModesTheyFit) {
  EXPECT_EQ(refusal(R"({"fog": {"mode": "linear", "density": 0.1}})"),
            "scene.json: fog.density: means nothing for linear fog, only for the modes exp and exp2");
  EXPECT_EQ(refusal(R"({"fog": {"mode": "exp", "start": 1}})"),
            "scene.json: fog.start: means nothing for exp fog, only for the mode linear");
  EXPECT_EQ(refusal(R"({"fog": {"mode": "exp2", "end": 1}})"),
            "scene.json: fog.end: means nothing for exp2 fog, only for the mode linear");
}

TEST_F(JsonScene, SpotsAndDirectionalLightsMustSayWhereTheyShine) {
  EXPECT_EQ(refusal(R"({"lights": [{"type": "directional"}]})"),
            "scene.json: lights[0]: \"direction\" is missing");
  for (const char* spread : {"", R"(, "cutoff": 180)", R"(, "cutoff": 30)", R"(, "outer_cone": 30)"})
    EXPECT_EQ(refusal(fmt::format(R"({{"lights": [{{"type": "spot", "position": [0,3,0]{}}}]}})", spread)),
              "scene.json: lights[0]: \"direction\" or \"target\" is missing");
}

TEST_F(JsonScene, RefusesWhatCannotBeDrawn) {
  const auto camera = [](const std::string& rest) { return R"({"camera": {"eye": [0,0,5], )" + rest + "}}"; };
  const auto light = [](const std::string& rest) {
    return R"({"lights": [{"position": [0,0,0], )" + rest + "}]}";
  };
  const auto object = [](const std::string& rest) { return R"({"objects": [{)" + rest + "}]}"; };
  const std::vector<std::string> texts{
      "[]",
      "3",
      "",
      "{\"a\": NaN}",
      "{\"lights\": {\"a\": 1}}",
      "{\"lights\": 3}",
      "{\"lights\": [3]}",
      "{\"cameras\": [1]}",
      "{\"cameras\": {}}",
      "{\"lighting\": 1}",
      "{\"background\": [1,2]}",
      "{\"background\": [-1,0,0]}",
      "{\"ambient\": 1e300}",
      camera(R"("target": [0,0,5])"),
      camera(R"("target": [0,9,5])"),
      camera(R"("target": [0,0,0], "up": [0,0,1])"),
      camera(R"("target": [0,0,0], "up": [0,0,0])"),
      camera(R"("target": [0,0,0], "fov_y": 0)"),
      camera(R"("target": [0,0,0], "fov_y": 180)"),
      camera(R"("target": [0,0,0], "fov_y": 45, "orthographic": 1)"),
      camera(R"("target": [0,0,0], "shift": 0.5)"),
      camera(R"("target": [0,0,0], "shift": [0,0,0])"),
      camera(R"("target": [0,0,0], "shift": [0,1.1e6])"),
      camera(R"("target": [0,0,0], "pixel_aspect": 0)"),
      camera(R"("target": [0,0,0], "near": 0)"),
      camera(R"("target": [0,0,0], "near": 5, "far": 5)"),
      camera(R"("up": [0,1,0])"),
      camera(R"("target": null)"),
      R"({"size": [32769, 1]})",
      R"({"size": [0, 1]})",
      R"({"size": [-1, 1]})",
      R"({"size": [1, 65536]})",
      R"({"size": [1.5, 1]})",
      R"({"size": [1]})",
      light(R"("color": 1)"),
      light(R"("type": "lamp")"),
      light(R"("type": "point", "attenuation": [0,0,0])"),
      light(R"("type": "point", "attenuation": [1,-1,0])"),
      light(R"("type": "point", "range": 0)"),
      light(R"("type": "point", "range": -1)"),
      light(R"("type": "point", "intensity": -1)"),
      light(R"("type": "point", "direction": [0,0,1])"),
      light(R"("type": "directional", "direction": [0,0,1])"),
      light(R"("type": "spot", "cutoff": 30)"),
      light(R"("type": "spot", "cutoff": 30, "direction": [0,0,0])"),
      light(R"("type": "spot", "cutoff": 30, "target": [0,0,0])"),
      light(R"("type": "spot", "cutoff": 91, "direction": [0,0,1])"),
      light(R"("type": "spot", "cutoff": -1, "direction": [0,0,1])"),
      light(R"("type": "spot", "exponent": 129, "cutoff": 30, "direction": [0,0,1])"),
      light(R"("type": "spot", "inner_cone": 30, "outer_cone": 30, "direction": [0,0,1])"),
      light(R"("type": "spot", "inner_cone": 10, "cutoff": 30, "direction": [0,0,1])"),
      light(R"("type": "point", "enabled": false, "range": 0)"),
      object(""),
      object(R"("primitive": "blob")"),
      object(R"("primitive": "box", "mesh": "x.obj")"),
      object(R"("primitive": "box", "scale": 0)"),
      object(R"("primitive": "box", "scale": [1,0,1])"),
      object(R"("primitive": "box", "segments": 4)"),
      object(R"("primitive": "sphere", "segments": 2)"),
      object(R"("primitive": "sphere", "segments": 1000000000)"),
      object(R"("primitive": "sphere", "minor_radius": 0.5)"),
      object(R"("primitive": "torus", "minor_radius": 1)"),
      object(R"("primitive": "plane", "segments": 0)"),
      object(R"("mesh": "scene.json")"),
      object(R"("mesh": ".")"),
      R"({"fog": {}})",
      R"({"fog": {"mode": "thick"}})",
      R"({"fog": {"mode": "linear", "density": 1}})",
      R"({"fog": {"mode": "exp", "end": 1}})",
      R"({"fog": {"mode": "linear", "start": 1, "end": 1}})",
      R"({"materials": []})",
      R"({"materials": {"m": {"alpha": 2}}})",
      R"({"light_fields": [{"min": [0,0,0], "max": [1,1,1]}]})",
      R"({"light_fields": [{"count": 1}]})",
      R"({"light_fields": [{"count": -1, "min": [0,0,0], "max": [1,1,1]}]})",
      R"({"light_fields": [{"count": 1, "min": [2,0,0], "max": [1,1,1]}]})",
      R"({"light_fields": [{"count": 1, "shape": "ball", "min": [2,0,0], "max": [1,1,1]}]})",
      R"({"light_fields": [{"count": 1, "min": [0,0,0], "max": [1,1,1], "range": [3,2]}]})",
      R"({"light_fields": [{"count": 1, "min": [0,0,0], "max": [1,1,1], "colors": []}]})",
      R"({"light_fields": [{"count": 1, "shape": "cone"}]})",
      R"({"light_fields": [{"count": 1, "min": [0,0,0], "max": [1,1,1], "offset": 1}]})",
      R"({"light_fields": [{"count": 1, "min": [0,0,0], "max": [1,1,1], "cutoff": 0}]})",
      R"({"light_fields": [{"count": 1, "min": [0,0,0], "max": [1,1,1], "cutoff": 1, "range": 1}]})",
      R"({"light_fields": [{"count": 1, "min": [0,0,0], "max": [1,1,1], "cutoff": 1, "attenuation": [1,0,0]}]})",
      R"({"light_fields": [{"count": 1, "min": [0,0,0], "max": [1,1,1], "no_range": true, "range": 1}]})",
      R"({"light_fields": [{"count": 1, "min": [0,0,0], "max": [1,1,1], "no_range": true, "cutoff": 1}]})",
      R"({"light_fields": [{"count": 1, "min": [0,0,0], "max": [1,1,1], "no_range": true, "attenuation": [1,0,0]}]})",
      R"({"light_fields": [{"count": 1, "min": [0,0,0], "max": [1,1,1], "no_range": 1}]})",
      R"({"light_fields": [{"count": 1, "shape": "surface"}]})",
      R"({"light_fields": [{"count": 1, "shape": "surface", "radius": 1}], "objects": [{"primitive": "box"}]})",
      R"({"light_fields": [{"count": 1, "shape": "clusters", "min": [0,0,0], "max": [1,1,1], "radius": 1}]})",
      R"({"light_fields": [{"count": 1, "shape": "clusters", "min": [0,0,0], "max": [1,1,1], "clusters": 3}]})",
      R"({"light_fields": [{"count": 1, "shape": "clusters", "min": [0,0,0], "max": [1,1,1], "clusters": 0, "radius": 1}]})",
      R"({"light_fields": [{"count": 1, "shape": "curve"}]})",
      R"({"light_fields": [{"count": 1, "shape": "curve", "points": 3}]})",
      R"({"light_fields": [{"count": 1, "shape": "curve", "points": [[0,0,0]]}]})",
      R"({"light_fields": [{"count": 1, "shape": "curve", "points": [[0,0,0],[1,1]]}]})",
      R"({"light_fields": [{"count": 1, "shape": "curve", "points": [[0,0,0],[1,1,1]], "min": [0,0,0]}]})",
      R"({"light_fields": [{"csv": "none.csv"}]})",
      R"({"light_fields": [{"csv": 3}]})",
      R"({"light_fields": [{"csv": "scene.json", "color": 1}]})",
      R"({"light_fields": [{"csv": "scene.json", "shape": "box"}]})",
  };
  for (const std::string& text : texts) {
    EXPECT_THAT(refusal(text), HasSubstr("scene.json: ")) << text;
  }
}

TEST_F(JsonScene, ReadsEveryShapeOfLightField) {
  write("lamps.csv", "x,y,z,r,g,b,range\n1,2,3,1,1,1,4\n5,6,7,1,1,1,\n8,9,10,1,1,1,\n");
  const Scene scene =
      loadWhole(R"({"objects": [{"primitive": "plane", "scale": 2, "translate": [0, 5, 0]}], "light_fields": [
    {"count": 2, "shape": "surface", "offset": 0.5, "cutoff": 0.25, "color": 4, "shadow": true},
    {"count": 3, "shape": "clusters", "clusters": 2, "min": [9,9,9], "max": [9,9,9], "radius": 0.5},
    {"count": 4, "shape": "curve", "points": [[0,0,7],[1,0,7],[2,0,7]]},
    {"csv": "lamps.csv", "count": 2, "intensity": 3},
    {"csv": "lamps.csv", "range": 2},
    {"count": 3, "min": [0,0,0], "max": [1,1,1], "no_range": true}]})");
  ASSERT_EQ(scene.lights.size(), 17u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(scene.lights[i].position.y, 5.5);
    EXPECT_EQ(scene.lights[i].range, 4);
    EXPECT_EQ(scene.lights[i].attenuation, glm::vec3(0, 0, 1));
    EXPECT_TRUE(scene.lights[i].shadow);
  }
  for (int i = 2; i < 5; ++i) EXPECT_LE(glm::distance(scene.lights[i].position, glm::dvec3(9)), 0.5 + 1e-14);
  for (int i = 5; i < 9; ++i) EXPECT_EQ(scene.lights[i].position.z, 7);
  EXPECT_EQ(scene.lights[10].position, glm::dvec3(5, 6, 7));
  EXPECT_EQ(scene.lights[9].diffuse, glm::vec3(3));
  EXPECT_EQ(scene.lights[9].range, 4);
  EXPECT_EQ(scene.lights[13].range, 2);
  for (int i = 14; i < 17; ++i) {
    EXPECT_TRUE(std::isinf(scene.lights[i].range));
    EXPECT_EQ(scene.lights[i].attenuation, glm::vec3(0, 0, 1));
  }
}

TEST_F(JsonScene, MistakesInListsOfLightsNameTheirFileAndLine) {
  write("lamps.csv", "1,2,3,1,1,1,4\n1,2\n");
  EXPECT_THAT(refusal(R"({"light_fields": [{"csv": "lamps.csv"}]})"),
              HasSubstr("lamps.csv: line 2: expected"));
  EXPECT_THAT(refusal(R"({"light_fields": [{"csv": "lamps.csv", "count": 1}, {"csv": "no.csv"}]})"),
              HasSubstr("light_fields[1].csv: there is no file"));
}

TEST_F(JsonScene, ALightsRangeFadesOutAsItsWindowSays) {
  const Scene scene = load(R"({"lights": [
    {"type": "point", "position": [0,0,0], "range": 2},
    {"type": "point", "position": [0,0,0], "range": 2, "window": "smooth"},
    {"type": "point", "position": [0,0,0], "range": 2, "window": "khr"}]})");
  EXPECT_EQ(scene.lights[0].window, RangeWindow::kSmooth);
  EXPECT_EQ(scene.lights[1].window, RangeWindow::kSmooth);
  EXPECT_EQ(scene.lights[2].window, RangeWindow::kKhr);
}

TEST_F(JsonScene, WrittenLightsAreReadToTheBit) {
  std::uint64_t random = 5;
  const auto number = [&] { return nextUniform(random); };
  const auto color = [&] { return glm::vec3(number(), number(), number()); };
  std::vector<Light> lights;
  for (int i = 0; i < 300; ++i) {
    Light light;
    light.kind = LightKind(i % 3);
    light.name = "light \"" + std::to_string(i) + "\"";
    light.diffuse = color();
    light.specular = i % 2 ? light.diffuse : color();
    light.ambient = i % 5 ? glm::vec3(0) : color();
    light.shadow = i % 7 == 0;
    if (light.kind != LightKind::kPoint) {
      const glm::dvec3 towards(number() - 0.5, number() - 0.5, number() - 0.5);
      light.direction = towards / glm::length(towards);
    }
    if (light.kind == LightKind::kDirectional) {
      light.half_angle = glm::radians(7.0 * number()) / 2;
    } else {
      light.position = {number() / 3, 1e5 * number(), -number()};
      light.radius = i % 4 ? 0 : number();
      light.attenuation = {number(), number(), number()};
      if (i % 4) light.range = float(1 + number());
      light.window = i % 8 == 1 ? RangeWindow::kKhr : RangeWindow::kSmooth;
    }
    if (light.kind == LightKind::kSpot) {
      light.falloff = i % 2 ? SpotFalloff::kCone : SpotFalloff::kExponent;
      light.cutoff = glm::radians(20 + 60 * number());
      if (i % 2)
        light.inner_cone = glm::radians(19 * number());
      else
        light.exponent = float(100 * number());
    }
    lights.push_back(light);
  }
  const std::vector<Light> read = load(lightsScene(lights)).lights;
  ASSERT_EQ(read.size(), lights.size());
  // An angle in degrees may be none's that is read as these radians, but of the two nearest one is.
  for (std::size_t i = 0; i < lights.size(); ++i) {
    EXPECT_NEAR(read[i].half_angle, lights[i].half_angle, 0x1p-54);
    EXPECT_NEAR(read[i].cutoff, lights[i].cutoff, 0x1p-52);
    EXPECT_NEAR(read[i].inner_cone, lights[i].inner_cone, 0x1p-54);
    Light one = read[i];
    one.half_angle = lights[i].half_angle;
    one.cutoff = lights[i].cutoff;
    one.inner_cone = lights[i].inner_cone;
    EXPECT_EQ(one, lights[i]) << i << " " << glm::distance(one.direction, lights[i].direction);
  }
}

TEST_F(JsonScene, PictureForAnotherProgramHasTheLightsCameraAndSurroundingsOfTheScene) {
  std::filesystem::create_directory(folder / "elsewhere");
  write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("scene.json", R"({"camera": {"eye": [0,0,5], "target": [0,0,0]}, "ambient": 0.25,
    "fog": {"mode": "exp2", "density": 0.125, "color": [0.5, 0.25, 0]}, "background": [0, 0.5, 1],
    "lights": [{"type": "directional", "direction": [0,-1,0]}], "light_fields": [{"count": 3, "shape": "surface"}],
    "objects": [{"mesh": "t.obj"}]})");
  Scene scene = loadScene(folder / "scene.json");
  scene.lights.assign(2, {});
  scene.lights[1].position = {0.1, 1.0 / 3, 1e-7};
  scene.lights[1].range = 0.7f;
  Camera camera = scene.cameras[0];
  camera.camera_to_world[3] = {1, 2, 3, 1};
  const std::string mesh = folder / "t.obj";
  for (const std::string& path : {folder / "scene.json", mesh, std::string()}) {
    write("elsewhere/picture.json", pictureScene(path, folder / "elsewhere", scene, camera, {7, 5}));
    const Scene read = loadScene(folder / "elsewhere/picture.json");
    EXPECT_EQ(read.lights, scene.lights) << path;
    ASSERT_EQ(read.cameras.size(), 1u);
    EXPECT_EQ(read.cameras[0].camera_to_world, camera.camera_to_world) << path;
    EXPECT_EQ(read.size, glm::ivec2(7, 5)) << path;
    EXPECT_EQ(read.ambient, scene.ambient) << path;
    EXPECT_EQ(read.background, scene.background) << path;
    EXPECT_EQ(read.fog.color, scene.fog.color) << path;
    EXPECT_EQ(read.fog.density, scene.fog.density) << path;
    EXPECT_EQ(read.objects.size(), path.empty() ? 0u : 1u) << path;
  }
}

TEST_F(JsonScene, CopyWithOtherLightsIsTheSameSceneFromAnotherFolder) {
  std::filesystem::create_directory(folder / "parts");
  std::filesystem::create_directory(folder / "copies");
  write("parts/t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("parts/p.ppm", std::string("P6 1 1 255\n") + "abc");
  write("scene.json", R"({ // a comment
    "$schema": "parts/scene.schema.json",
    "cameras": {"zoom": {"eye": [0,0,5], "target": [0,0,0]}, "all": {"eye": [0,0,9], "target": [0,0,0]}},
    "materials": {"z": {"diffuse_map": "parts/p.ppm"}, "a": {"diffuse": 0.1, "emission_map": ")" +
                          (folder / "parts/p.ppm") + R"("}},
    "lights": [{"type": "directional", "direction": [0,-1,0]}],
    "objects": [{"mesh": "parts/t.obj", "material": "z", "translate": [0.1, 1e-7, 3]}, {"primitive": "box"}],
    "light_fields": [{"count": 3, "shape": "surface"}], "size": [7, 5]})");
  std::vector<Light> lights(2);
  lights[1].position = {1, 2, 3};
  write("copies/lit.json", sceneWithLights(folder / "scene.json", folder / "copies", {}, lights));
  const Scene scene = loadScene(folder / "scene.json");
  const Scene copy = loadScene(folder / "copies/lit.json");
  ASSERT_EQ(copy.lights.size(), 2u);
  EXPECT_EQ(copy.lights[1].position, glm::dvec3(1, 2, 3));
  ASSERT_EQ(copy.cameras.size(), 2u);
  EXPECT_EQ(copy.cameras[0].name, "zoom");
  EXPECT_EQ(copy.cameras[0].camera_to_world, scene.cameras[0].camera_to_world);
  ASSERT_EQ(copy.objects.size(), 2u);
  EXPECT_EQ(copy.objects[0].object_to_world, scene.objects[0].object_to_world);
  EXPECT_EQ(copy.meshes[0].positions, scene.meshes[0].positions);
  EXPECT_EQ(copy.textures.size(), scene.textures.size());
  EXPECT_EQ(copy.size, scene.size);
  EXPECT_THAT(test::readText(folder / "copies/lit.json"), HasSubstr("\"../parts/scene.schema.json\""));
  write("bare.json", R"({"$schema": "https://example.org/scene.schema.json"})");
  write("copies/bare.json", sceneWithLights(folder / "bare.json", folder / "copies", {}, {}));
  EXPECT_TRUE(loadScene(folder / "copies/bare.json").lights.empty());
  EXPECT_THAT(test::readText(folder / "copies/bare.json"),
              HasSubstr("\"https://example.org/scene.schema.json\""));
}

TEST_F(JsonScene, HugeCountsAreRefusedBeforeTheyAreAllocated) {
  const std::string field = R"({"count": 60000000, "min": [0,0,0], "max": [1,1,1]})";
  EXPECT_THAT(refusal(R"({"light_fields": [)" + field + ", " + field + "]}"),
              HasSubstr("light_fields[1]: 120000000 lights"));
  EXPECT_THAT(refusal(R"({"light_fields": [{"count": 1e18, "min": [0,0,0], "max": [1,1,1]}]})"),
              HasSubstr("light_fields[0].count: expected a whole number"));
}

TEST_F(JsonScene, DeepNestingIsRefusedNotFollowed) {
  constexpr std::size_t kDeep = 1'000'000;
  EXPECT_THAT(refusal(R"({"objects": )" + std::string(kDeep, '[')),
              HasSubstr("nested deeper than 64 levels"));
  std::string objects = "{\"objects\": ";
  for (std::size_t i = 0; i < 100'000; ++i) objects += "{\"a\":";
  EXPECT_THAT(refusal(objects), HasSubstr("nested deeper than 64 levels"));
}

TEST_F(JsonScene, EveryTruncatedSceneIsRefusedInOneLine) {
  const std::string whole =
      R"({"camera":{"eye":[0,0,5],"target":[0,0,0]},"lights":[{"type":"point","position":[1,2,3],
    "color":[1,1,1]},{"type":"directional","direction":[0,-1,0]}],"objects":[{"primitive":"sphere","segments":8}]})";
  load(whole);
  for (std::size_t length = 0; length < whole.size(); ++length) refusal(whole.substr(0, length));
}

TEST_F(JsonScene, MissingFileAndFolderAreRefused) {
  EXPECT_THROW(loadJsonScene(folder / "none.json"), InputError);
  EXPECT_THROW(loadJsonScene(folder.path().string()), InputError);
  EXPECT_THROW(loadScene(folder / "scene.txt"), InputError);
}

TEST_F(JsonScene, LightsAreNotAddedToWhatAFileSays) {
  write("scene.json", R"({"objects": [{"primitive": "box"}], "lights": []})");
  const Scene scene = loadScene(folder / "scene.json");
  EXPECT_EQ(scene.cameras.size(), 1u);
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_EQ(scene.ambient, glm::vec3(0));
}

TEST_F(JsonScene, WrittenCamerasReadBackWithinTheirRounding) {
  write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  for (const double away : {0.0, 1e-3, 7.0, 1e7}) {
    for (const bool orthographic : {false, true}) {
      Camera camera;
      camera.camera_to_world = cameraToWorld(glm::dvec3(away, -2 * away, 3), {1, 2, 0.1}, {0.1, 1, 0.2});
      camera.orthographic = orthographic;
      camera.fov_y = 0.7;
      camera.half_height = 3.3;
      camera.shift = {1e-3 * away, -0.1};
      camera.pixel_aspect = 1.1;
      camera.near = 0.123;
      camera.far = 4.56e7;
      const Camera read = load(meshWithLights("t.obj", camera, {})).cameras.front();
      EXPECT_EQ(read.camera_to_world[3], camera.camera_to_world[3]);
      // Each axis is made again from rounded numbers, of the size of the others: some 10 operations of 2^-53.
      for (int i = 0; i < 3; ++i)
        EXPECT_LT(glm::distance(read.camera_to_world[i], camera.camera_to_world[i]), 20 * 0x1p-53) << away;
      EXPECT_EQ(read.orthographic, orthographic);
      EXPECT_NEAR(read.fov_y, orthographic ? Camera{}.fov_y : 0.7, 4 * 0x1p-53);
      EXPECT_EQ(read.half_height, orthographic ? 3.3 : Camera{}.half_height);
      EXPECT_EQ(read.shift, camera.shift);
      EXPECT_EQ(read.pixel_aspect, 1.1);
      EXPECT_EQ(read.near, 0.123);
      EXPECT_EQ(read.far, 4.56e7);
    }
  }
}

TEST_F(JsonScene, WrittenLightsReadBackToTheBit) {
  LightField field;
  field.count = 1000;
  field.low = glm::dvec3(-1e5, 0, 1e-3);
  field.high = glm::dvec3(1e5, 1e-7, 2e-3);
  field.intensity = {0.1f, 1e6f};
  field.range = {0.1f, 7.3f};
  field.attenuation = {0.1f, 0.2f, 0.3f};
  field.shadow = true;
  Scene written;
  expandLightField(field, written);
  field.range = LightField{}.range;
  field.attenuation = LightField{}.attenuation;
  field.shadow = false;
  expandLightField(field, written);
  const std::vector<Light>& lights = written.lights;
  write("t \"é\".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Scene scene = load(meshWithLights("t \"é\".obj", {}, lights));
  EXPECT_EQ(scene.objects.size(), 1u);
  ASSERT_EQ(scene.lights.size(), lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    ASSERT_EQ(scene.lights[i].position, lights[i].position);
    ASSERT_EQ(scene.lights[i].diffuse, lights[i].diffuse);
    ASSERT_EQ(scene.lights[i].specular, lights[i].specular);
    ASSERT_EQ(scene.lights[i].attenuation, lights[i].attenuation);
    ASSERT_EQ(scene.lights[i].range, lights[i].range);
    ASSERT_EQ(scene.lights[i].shadow, lights[i].shadow);
  }
  EXPECT_TRUE(load(lightsScene({})).lights.empty());
}

}  // namespace
}  // namespace luciole
