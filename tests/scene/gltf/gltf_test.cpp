// glTF files as a whole: nodes, cameras, extensions, ranges, and real ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include "luciole/error.hpp"
#include "scene/gltf/gltf_loader.hpp"
#include "scene/warning_texts.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST_F(GltfLoader, InstancesArePlacedInTheirNodesSpace) {
  GltfFile file = triangleFile();
  const int translations = file.addAccessor<float>("VEC3", kFloat, 3, {1, 0, 0, 0, 2, 0});
  const int rotations = file.addAccessor<std::int16_t>("VEC4", 5122, 4, {0, 0, 0, 32767, 0, 32767, 0, 0});
  file.accessor(rotations)["normalized"] = true;
  const int scales = file.addAccessor<float>("VEC3", kFloat, 3, {1, 1, 1, 3, 3, 3});
  json& node = file.root["nodes"][0];
  node["translation"] = {0, 0, 10};
  json& attributes = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  attributes = {{"TRANSLATION", translations}, {"ROTATION", rotations}, {"SCALE", scales}, {"_ID", scales}};
  const Scene scene = load(file);
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.meshes.size(), 1u) << "they share their mesh";
  const auto at = [&](std::size_t object, const glm::dvec4& p) {
    return glm::dvec3(scene.objects[object].object_to_world * p);
  };
  EXPECT_LE(glm::distance(at(0, {1, 0, 0, 1}), glm::dvec3(2, 0, 10)), 1e-12);
  EXPECT_LE(glm::distance(at(1, {1, 0, 0, 1}), glm::dvec3(-3, 2, 10)), 1e-12);
  attributes["SCALE"] = file.addAccessor<float>("VEC3", kFloat, 3, {1, 1, 1});
  EXPECT_THAT(error(file), HasSubstr("its attributes have 2 and 1 elements"));
  attributes = json::object();
  EXPECT_THAT(repair(file), HasSubstr("has none of TRANSLATION, ROTATION, SCALE; drawn once"));
  EXPECT_EQ(load(file).objects.size(), 1u);
  attributes = {{"SCALE", file.addAccessor<float>("VEC3", kFloat, 3, {1, INFINITY, 1})}};
  EXPECT_THAT(error(file), HasSubstr("instance 0 has no finite transform"));
  attributes = {{"ROTATION", file.addAccessor<float>("VEC4", kFloat, 4, {0, 0, 0, 0})}};
  EXPECT_THAT(repair(file), HasSubstr("instance 0: rotation is of length 0"));
  attributes = {{"TRANSLATION", "x"}};
  EXPECT_THAT(error(file), HasSubstr("TRANSLATION"));
}

TEST_F(GltfLoader, HiddenNodesHideWhatIsBelowThem) {
  GltfFile file = triangleFile();
  file.root["nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"mesh", 0}}};
  file.root["scenes"][0]["nodes"] = {0, 1};
  EXPECT_EQ(load(file).objects.size(), 2u);
  file.root["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = false;
  EXPECT_EQ(load(file).objects.size(), 1u);
  file.root["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = true;
  EXPECT_EQ(load(file).objects.size(), 2u);
}

TEST_F(GltfLoader, TransformsMultiplyDownTheTree) {
  GltfFile file = triangleFile();
  const double half = std::sqrt(0.5);
  file.root["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, 0, half, half}}},
                        {{"mesh", 0}, {"scale", {2, -3, 4}}},
                        {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}}};
  file.root["scenes"][0]["nodes"] = {0, 2};
  const Scene scene = load(file);
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.meshes.size(), 1u) << "a mesh of two nodes is one mesh";
  const glm::dvec4 moved = scene.objects[0].object_to_world * glm::dvec4(1, 1, 1, 1);
  // Scaled to (2, -3, 4), a quarter turn about z to (3, 2, 4), moved by 10. Ten operations on numbers up
  // to 16.
  EXPECT_LE(glm::length(moved - glm::dvec4(13, 2, 4, 1)), 10 * 16 * std::ldexp(1.0, -53));
  EXPECT_EQ(scene.objects[1].object_to_world[3], glm::dvec4(5, 6, 7, 1));
}

TEST_F(GltfLoader, NodesThatAreNoTreeAreRefused) {
  GltfFile file = triangleFile();
  file.root["nodes"] = {{{"children", {1}}}, {{"children", {0}}, {"mesh", 0}}};
  EXPECT_THAT(error(file), HasSubstr("expected a tree"));
  file.root["nodes"] = {{{"children", {1, 2}}}, {{"children", {2}}}, {{"mesh", 0}}};
  EXPECT_THAT(error(file), HasSubstr("nodes[2]: has two parents"));
  file.root["scenes"][0]["nodes"] = {0, 2};
  file.root["nodes"] = {{{"children", {1}}}, {{"children", {2}}}, {{"mesh", 0}}};
  EXPECT_THAT(error(file), HasSubstr("nodes[2]: has two parents")) << "both in the scene";
  file.root["scenes"][0]["nodes"] = {0};
  file.root["nodes"] = {{{"children", {7}}}};
  EXPECT_THAT(error(file), HasSubstr("nodes[0]: refers to node 7, but the file has 1 of them"));
}

TEST_F(GltfLoader, AChainOfManyNodesNeedsNoStack) {
  GltfFile file = triangleFile();
  constexpr int kLength = 20000;
  json nodes = json::array();
  for (int i = 1; i < kLength; ++i) nodes.push_back({{"children", {i}}});
  nodes.push_back({{"mesh", 0}});
  file.root["nodes"] = nodes;
  EXPECT_EQ(load(file).objects.size(), 1u);
}

TEST_F(GltfLoader, TheDefaultSceneIsShown) {
  GltfFile file = triangleFile();
  file.root["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {1, 2, 3}}}};
  file.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  file.root["scene"] = 1;
  const Scene scene = load(file);
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].object_to_world[3], glm::dvec4(1, 2, 3, 1));
  file.root.erase("scene");
  file.root.erase("scenes");
  EXPECT_EQ(load(file).objects.size(), 2u) << "without scenes, every root";
}

TEST_F(GltfLoader, CamerasStandWhereTheirNodeStands) {
  const json lens = {{"type", "perspective"},
                     {"perspective", {{"yfov", 0.5}, {"znear", 0.25}, {"zfar", 40}}}};
  const Camera c =
      camera(lens, {{"translation", {1, 2, 3}}, {"rotation", {0, 1, 0, 0}}, {"scale", {2, -3, 4}}});
  EXPECT_EQ(c.fov_y, 0.5);
  EXPECT_EQ(c.near, 0.25);
  EXPECT_EQ(c.far, 40);
  // Half a turn about y, and upside down; what is left is a rotation: its mirroring scale goes into x.
  const glm::dmat4 expected(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, -1, 0, 0), glm::dvec4(0, 0, -1, 0),
                            glm::dvec4(1, 2, 3, 1));
  EXPECT_EQ(c.camera_to_world, expected);
}

TEST_F(GltfLoader, ACameraWithoutZfarSeesToInfinity) {
  EXPECT_EQ(camera({{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.5}}}}).far, INFINITY);
}

TEST_F(GltfLoader, OrthographicCamerasAreRead) {
  const json lens = {{"type", "orthographic"},
                     {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0}, {"zfar", 100}}}};
  const Camera c = camera(lens);
  EXPECT_TRUE(c.orthographic);
  EXPECT_EQ(c.half_height, 3);
  EXPECT_GT(c.near, 0);
  EXPECT_EQ(c.far, 100);
}

TEST_F(GltfLoader, ImpossibleCamerasAreMendedOrLeftOut) {
  GltfFile file = triangleFile();
  file.root["nodes"][0]["camera"] = 0;
  for (const auto& [lens, left, what] : std::vector<std::tuple<json, bool, std::string>>{
           {{{"yfov", 0}, {"znear", 1}}, false, "yfov is 0, expected one between 0 and pi; left out"},
           {{{"yfov", 4}, {"znear", 1}}, false, "yfov is 4, "},
           {{{"yfov", 1}, {"znear", 0}}, true, "znear is 0, taken for 0.001"},
           {{{"yfov", 1}, {"znear", -1}, {"zfar", 1}}, true, "znear is -1, taken for 1e-06"},
           {{{"yfov", 1}, {"znear", 2}, {"zfar", 1}}, true, "zfar is 1, expected more than znear 2"}}) {
    file.root["cameras"] = {{{"type", "perspective"}, {"perspective", lens}}};
    EXPECT_THAT(repair(file), HasSubstr("cameras[0]: " + what)) << lens;
    EXPECT_EQ(load(file).cameras.size(), left ? 1u : 0u) << lens;
  }
  for (const json& lens : std::vector<json>{{{"ymag", 0}, {"zfar", 1}}, {{"ymag", 1}, {"znear", 0.1}}}) {
    file.root["cameras"] = {{{"type", "orthographic"}, {"orthographic", lens}}};
    EXPECT_THAT(repair(file), HasSubstr("cameras[0]: ")) << lens;
    EXPECT_TRUE(load(file).cameras.empty());
  }
}

TEST_F(GltfLoader, EachUnknownExtensionInUseIsWarnedOfOnce) {
  GltfFile file = triangleFile();
  file.root["extensionsUsed"] = {"KHR_materials_transmission", "KHR_lights_punctual",
                                 "KHR_materials_transmission", "EXT_made_up"};
  const Scene scene = load(file);
  const auto about = [&](const char* extension) {
    return AllOf(StartsWith(folder / "a.gltf: "), HasSubstr(extension), HasSubstr("not supported"));
  };
  EXPECT_THAT(textsOf(scene.warnings),
              ElementsAre(about("KHR_materials_transmission"), about("EXT_made_up")));
}

TEST_F(GltfLoader, UnsupportedRequirementsAreNamedWithWhatIsKnown) {
  GltfFile file = triangleFile();
  file.root["extensionsRequired"] = {"KHR_materials_volume"};
  EXPECT_THAT(error(file), AllOf(HasSubstr("extensionsRequired: 'KHR_materials_volume' is not supported"),
                                 HasSubstr("KHR_lights_punctual"), HasSubstr("KHR_texture_transform")));
  file.root.erase("extensionsRequired");
  file.root["asset"]["version"] = "1.0";
  EXPECT_THAT(error(file), HasSubstr("version is '1.0'"));
}

TEST_F(GltfLoader, EveryRangeIsCheckedBeforeItIsRead) {
  const GltfFile good = triangleFile();
  const auto broken = [&](const std::function<void(json&)>& change) {
    GltfFile file = good;
    change(file.root);
    return error(file);
  };
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["count"] = 4; }),
              HasSubstr("reach past bufferViews[0]"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["count"] = 1ull << 62; }), HasSubstr("reach past"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["byteOffset"] = 4; }), HasSubstr("reach past"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["byteOffset"] = ~0ull - 8; }), HasSubstr("reach past"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["bufferView"] = 9; }), HasSubstr("bufferView 9"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["type"] = "VEC2"; }), HasSubstr("components"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["componentType"] = 5130; }), HasSubstr("componentType"));
  EXPECT_THAT(broken([](json& r) { r["bufferViews"][0]["byteLength"] = 40; }),
              HasSubstr("reach past its buffer"));
  EXPECT_THAT(broken([](json& r) { r["bufferViews"][0]["byteOffset"] = ~0ull; }), HasSubstr("reach past"));
  EXPECT_THAT(broken([](json& r) { r["bufferViews"][0]["buffer"] = 3; }), HasSubstr("buffer 3"));
  EXPECT_THAT(broken([](json& r) { r["bufferViews"][0]["byteStride"] = 4; }), HasSubstr("4 bytes apart"));
  EXPECT_THAT(broken([](json& r) { r["nodes"][0]["mesh"] = 5; }), HasSubstr("mesh 5"));
  EXPECT_THAT(broken([](json& r) { r["scene"] = 5; }), HasSubstr("scene 5"));
  EXPECT_THAT(broken([](json& r) { r["meshes"][0]["primitives"][0]["material"] = 5; }),
              HasSubstr("material 5"));
  EXPECT_THAT(broken([](json& r) {
                r["accessors"][0].erase("bufferView");
                r["accessors"][0]["count"] = 1ull << 40;
              }),
              HasSubstr("has no bufferView"));
  EXPECT_THAT(broken([](json& r) {
                r["accessors"][0]["sparse"] = {
                    {"count", 1},
                    {"indices", {{"bufferView", 0}, {"componentType", kUnsignedInt}, {"byteOffset", 12}}},
                    {"values", {{"bufferView", 0}}}};
              }),
              HasSubstr("replaces element"));
}

std::size_t triangles(const Scene& scene) {
  std::size_t sum = 0;
  for (const Object& object : scene.objects) sum += scene.meshes[object.mesh].triangles.size();
  return sum;
}

TEST_F(GltfLoader, QuakeHasItsTrianglesAndLights) {
  LUCIOLE_NEEDS_SHARED();
  Scene scene;
  loadGltf((test::sharedScenes() / "quake_e1m1/e1m1.gltf").string(), scene);
  EXPECT_EQ(triangles(scene), 15085u);
  EXPECT_EQ(scene.lights.size(), 198u);
  EXPECT_EQ(scene.textures.size(), 66u);
}

TEST_F(GltfLoader, TheSameModelIsReadFromEveryPackaging) {
  LUCIOLE_NEEDS_SHARED();
  for (const char* model : {"Box", "BoxTextured", "Duck", "Cameras", "DamagedHelmet", "LightsPunctualLamp",
                            "NegativeScaleTest", "OrientationTest", "SimpleSparseAccessor", "Suzanne",
                            "TextureSettingsTest", "TriangleWithoutIndices", "VertexColorTest"}) {
    std::size_t expected = 0;
    const std::string khronos = std::string("khronos_") + model;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(test::sharedScenes() / khronos)) {
      const std::string path = entry.path().string();
      if (!path.ends_with(".gltf") && !path.ends_with(".glb")) continue;
      Scene scene;
      loadGltf(path, scene);
      if (expected == 0) expected = triangles(scene);
      EXPECT_GT(triangles(scene), 0u) << path;
      EXPECT_EQ(triangles(scene), expected) << path;
    }
    EXPECT_GT(expected, 0u) << model;
  }
}

TEST_F(GltfLoader, TheLampHasItsLightsAndTheCamerasAreTwo) {
  LUCIOLE_NEEDS_SHARED();
  Scene lamp, cameras;
  loadGltf((test::sharedScenes() / "khronos_LightsPunctualLamp/glTF/LightsPunctualLamp.gltf").string(), lamp);
  EXPECT_EQ(lamp.lights.size(), 5u);
  loadGltf((test::sharedScenes() / "khronos_Cameras/glTF/Cameras.gltf").string(), cameras);
  ASSERT_EQ(cameras.cameras.size(), 2u);
  EXPECT_FALSE(cameras.cameras[0].orthographic);
  EXPECT_TRUE(cameras.cameras[1].orthographic);
}

}  // namespace
}  // namespace luciole::test
