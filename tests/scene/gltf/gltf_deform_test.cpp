// Skins and morph targets: where the vertices of a mesh are in the world, pose by pose.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <tuple>

#include "luciole/load_scene.hpp"
#include "luciole/pose.hpp"
#include "scene/gltf/gltf_file.hpp"
#include "scene/warning_texts.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

/// A strip of two squares above each other, from (0,0) to (1,2), whose lower vertices follow joint 0, whose
/// upper ones joint 1, and whose middle both alike. Joint 0 is node 1 at the origin; joint 1 is its child,
/// node 2, at (0,1,0). Node 0 has mesh and skin.
GltfFile barFile() {
  GltfFile file;
  const int position =
      file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0});
  const int normal =
      file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int joints = file.addAccessor<std::uint8_t>(
      "VEC4", kUnsignedByte, 4, {0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  const int weights = file.addAccessor<float>(
      "VEC4", kFloat, 4,
      {1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  const int indices =
      file.addAccessor<std::uint16_t>("SCALAR", kUnsignedShort, 1, {0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4});
  const int binds = file.addAccessor<float>(
      "MAT4", kFloat, 16,
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1});
  file.root["meshes"] = {
      {{"primitives",
        {{{"attributes",
           {{"POSITION", position}, {"NORMAL", normal}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
          {"indices", indices}}}}}};
  file.root["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"children", {2}}}, {{"translation", {0, 1, 0}}}};
  file.root["scenes"] = {{{"nodes", {0, 1}}}};
  file.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", binds}}};
  return file;
}

void animate(GltfFile& file, int node, const std::string& path, const std::vector<float>& times,
             const std::vector<float>& values, const std::string& interpolation = "LINEAR") {
  const int components = path == "rotation" ? 4 : path == "weights" ? 1 : 3;
  const char* type = path == "rotation" ? "VEC4" : path == "weights" ? "SCALAR" : "VEC3";
  const int input = file.addAccessor("SCALAR", kFloat, 1, times);
  const int output = file.addAccessor(type, kFloat, components, values);
  json& animation = file.root["animations"][0];
  const int sampler = animation.contains("samplers") ? static_cast<int>(animation["samplers"].size()) : 0;
  animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
  animation["channels"].push_back({{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}});
}

/// The bar, which joint 1 bends by 90 degrees about x in one second, towards the viewer.
GltfFile bendingFile() {
  GltfFile file = barFile();
  const float half = std::sqrt(0.5f);
  animate(file, 2, "rotation", {0, 1}, {0, 0, 0, 1, half, 0, 0, half});
  return file;
}

std::vector<glm::dvec3> placesOf(const Scene& scene, std::size_t object = 0) {
  std::vector<glm::dvec3> places;
  const Object& shown = scene.objects.at(object);
  for (const glm::vec3& position : scene.meshes.at(shown.mesh).positions)
    places.emplace_back(shown.object_to_world * glm::dvec4(position, 1));
  return places;
}

std::vector<glm::dvec3> normalsOf(const Scene& scene) {
  std::vector<glm::dvec3> normals;
  const Object& shown = scene.objects.at(0);
  const glm::dmat3 turn = glm::transpose(glm::inverse(glm::dmat3(shown.object_to_world)));
  for (const glm::vec3& normal : scene.meshes.at(shown.mesh).normals)
    normals.push_back(glm::normalize(turn * glm::dvec3(normal)));
  return normals;
}

/// Numbers of up to 4 in float, of inputs in float: rounded twice.
constexpr double kRounding = 2 * 4.0 / (1 << 24);

void expectPlace(const glm::dvec3& a, const glm::dvec3& b, const std::string& what) {
  EXPECT_LE(glm::length(a - b), kRounding)
      << what << ": " << a.x << " " << a.y << " " << a.z << ", expected " << b.x << " " << b.y << " " << b.z;
}

/// Where the bar is while joint 1 is turned by an angle about x: the linear blend of both joints.
std::vector<glm::dvec3> bentBar(double angle) {
  const glm::dmat4 upper = glm::rotate(glm::translate(glm::dmat4(1), {0.0, 1.0, 0.0}), angle, {1, 0, 0}) *
                           glm::translate(glm::dmat4(1), {0.0, -1.0, 0.0});
  std::vector<glm::dvec3> places;
  for (int i = 0; i < 6; ++i) {
    const int row = i / 2;
    const double share = row * 0.5;
    const glm::dvec4 rest(i % 2, row, 0, 1);
    places.emplace_back(share * (upper * rest) + (1 - share) * rest);
  }
  return places;
}

class GltfDeform : public GltfTest {
 protected:
  Scene loaded(const GltfFile& file, double frame = 1) {
    load(file);
    return loadScene(folder / "a.gltf", frame);
  }
};

TEST_F(GltfDeform, ASkinBendsAsItsJointsDo) {
  Scene scene = load(bendingFile());
  for (const double t : {0.0, 0.3, 0.5, 1.0, 2.0}) {
    poseScene(scene, 1 + 24 * t);
    const double angle = std::min(t, 1.0) * kPi / 2;
    const std::vector<glm::dvec3> places = placesOf(scene), expected = bentBar(angle);
    for (std::size_t i = 0; i < 6; ++i) expectPlace(places[i], expected[i], fmt::format("{} {}", t, i));
    const std::vector<glm::dvec3> normals = normalsOf(scene);
    const glm::dvec3 turned(0, -std::sin(angle), std::cos(angle));
    expectPlace(normals[0], {0, 0, 1}, "below");
    expectPlace(normals[5], turned, "above");
    // A mean of two turns about one axis turns by half the angle, and shrinks across the axis alike.
    expectPlace(normals[2], {0, -std::sin(angle / 2), std::cos(angle / 2)}, "between");
  }
}

TEST_F(GltfDeform, APoseDoesNotDependOnThoseBefore) {
  Scene scene = load(bendingFile()), fresh = scene;
  for (const double frame : {25.0, 1.0, 13.0}) poseScene(scene, frame);
  poseScene(fresh, 13);
  EXPECT_EQ(scene.meshes[0].positions, fresh.meshes[0].positions);
  EXPECT_EQ(scene.meshes[0].normals, fresh.meshes[0].normals);
}

TEST_F(GltfDeform, JointsAndWeightsMayBeBytesOrShorts) {
  for (const int kind : {kUnsignedByte, kUnsignedShort}) {
    GltfFile file = bendingFile();
    json& attributes = file.primitive()["attributes"];
    const std::vector<std::uint16_t> joints{0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0,
                                            0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    attributes["JOINTS_0"] = file.addAccessor("VEC4", kUnsignedShort, 4, joints);
    // Their sums are not 1, as glTF says: a mean is what counts.
    if (kind == kUnsignedByte)
      attributes["WEIGHTS_0"] = file.addAccessor<std::uint8_t>(
          "VEC4", kind, 4, {9, 0, 0, 0, 8, 0, 0, 0, 40, 40, 0, 0, 7, 7, 0, 0, 255, 0, 0, 0, 200, 0, 0, 0});
    else
      attributes["WEIGHTS_0"] = file.addAccessor<std::uint16_t>(
          "VEC4", kind, 4, {9, 0, 0, 0, 8, 0, 0, 0, 40, 40, 0, 0, 7, 7, 0, 0, 65535, 0, 0, 0, 200, 0, 0, 0});
    file.accessor(attributes["WEIGHTS_0"])["normalized"] = true;
    Scene scene = load(file);
    poseScene(scene, 13);
    const std::vector<glm::dvec3> places = placesOf(scene), expected = bentBar(kPi / 4);
    for (std::size_t i = 0; i < 6; ++i) expectPlace(places[i], expected[i], fmt::format("{} {}", kind, i));
  }
}

TEST_F(GltfDeform, MoreThanFourJointsMayMoveAVertex) {
  // Joints 2 to 5 stand still 1, 2, 4 and 8 metres to the right of where they were at rest.
  GltfFile file = barFile();
  for (const double x : {1, 2, 4, 8}) {
    file.root["skins"][0]["joints"].push_back(file.root["nodes"].size());
    file.root["scenes"][0]["nodes"].push_back(file.root["nodes"].size());
    file.root["nodes"].push_back({{"translation", {x, 0, 0}}});
  }
  file.root["skins"][0].erase("inverseBindMatrices");
  std::vector<std::uint8_t> first, second;
  std::vector<float> weights, more;
  for (int i = 0; i < 6; ++i) {
    first.insert(first.end(), {2, 3, 4, 5});
    second.insert(second.end(), {0, 0, 0, 0});
    weights.insert(weights.end(), {0.25f, 0.125f, 0.125f, 0.25f});
    more.insert(more.end(), {0.25f, 0, 0, 0});
  }
  json& attributes = file.primitive()["attributes"];
  attributes["JOINTS_0"] = file.addAccessor("VEC4", kUnsignedByte, 4, first);
  attributes["JOINTS_1"] = file.addAccessor("VEC4", kUnsignedByte, 4, second);
  attributes["WEIGHTS_0"] = file.addAccessor("VEC4", kFloat, 4, weights);
  attributes["WEIGHTS_1"] = file.addAccessor("VEC4", kFloat, 4, more);
  expectPlace(placesOf(load(file))[1], {1 + 0.25 + 0.25 + 0.5 + 2, 0, 0}, "five joints");
}

TEST_F(GltfDeform, WithoutWeightsAVertexFollowsItsFirstJoint) {
  GltfFile file = barFile();
  file.primitive()["attributes"]["WEIGHTS_0"] =
      file.addAccessor("VEC4", kFloat, 4, std::vector<float>(24, 0.0f));
  file.root["nodes"][2]["translation"] = {0, 3, 0};
  const std::vector<glm::dvec3> places = placesOf(load(file));
  expectPlace(places[2], {0, 1, 0}, "joint 0");
  expectPlace(places[4], {0, 4, 0}, "joint 1");
}

TEST_F(GltfDeform, WhereTheNodeOfASkinIsMeansNothing) {
  GltfFile file = bendingFile();
  file.root["nodes"][0]["translation"] = {100, 200, 300};
  file.root["nodes"][0]["scale"] = {0, 0, 0};
  Scene scene = load(file);
  poseScene(scene, 25);
  const std::vector<glm::dvec3> places = placesOf(scene), expected = bentBar(kPi / 2);
  for (std::size_t i = 0; i < 6; ++i) expectPlace(places[i], expected[i], "vertex");
}

TEST_F(GltfDeform, FarFromTheOriginASkinIsAsExact) {
  GltfFile file = bendingFile();
  file.root["nodes"].push_back({{"translation", {1e7, -2e7, 3e7}}, {"children", {1}}});
  file.root["scenes"][0]["nodes"] = {0, 3};
  Scene scene = load(file);
  poseScene(scene, 13);
  const std::vector<glm::dvec3> places = placesOf(scene), expected = bentBar(kPi / 4);
  // Doubles of 3e7 are 4e-9 apart.
  for (std::size_t i = 0; i < 6; ++i) expectPlace(places[i] - glm::dvec3(1e7, -2e7, 3e7), expected[i], "far");
}

TEST_F(GltfDeform, WhatStandsStillIsDeformedOnce) {
  GltfFile file = barFile();
  file.root["nodes"][2]["rotation"] = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  const Scene scene = load(file);
  EXPECT_TRUE(scene.animation.deformations.empty());
  EXPECT_TRUE(scene.animation.nodes.empty());
  EXPECT_TRUE(scene.meshes[0].sources.empty());
  const std::vector<glm::dvec3> places = placesOf(scene), expected = bentBar(kPi / 2);
  for (std::size_t i = 0; i < 6; ++i) expectPlace(places[i], expected[i], "vertex");
}

TEST_F(GltfDeform, JointsMayBeHiddenOrOutsideTheScene) {
  GltfFile hidden = bendingFile();
  hidden.root["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = false;
  hidden.root["nodes"][2]["mesh"] = 0;
  GltfFile outside = bendingFile();
  outside.root["scenes"][0]["nodes"] = {0};
  for (const GltfFile& file : {hidden, outside}) {
    Scene scene = load(file);
    EXPECT_EQ(scene.objects.size(), 1u) << "a joint's own mesh is hidden as it is";
    poseScene(scene, 25);
    const std::vector<glm::dvec3> places = placesOf(scene), expected = bentBar(kPi / 2);
    for (std::size_t i = 0; i < 6; ++i) expectPlace(places[i], expected[i], "vertex");
  }
}

/// Whether the first triangle's front is seen from where its first vertex's normal points.
bool facesItsNormal(const Scene& scene) {
  const std::vector<glm::dvec3> places = placesOf(scene);
  const glm::uvec3 triangle = scene.meshes.at(scene.objects[0].mesh).triangles.at(0);
  const glm::dvec3 side =
      glm::cross(places[triangle.y] - places[triangle.x], places[triangle.z] - places[triangle.x]);
  const double mirrors = glm::determinant(glm::dmat3(scene.objects[0].object_to_world));
  return glm::dot(side, normalsOf(scene)[triangle.x]) * mirrors > 0;
}

TEST_F(GltfDeform, AMirroredSkinShowsItsFronts) {
  GltfFile file = bendingFile();
  EXPECT_TRUE(facesItsNormal(load(file)));
  file.root["nodes"].push_back({{"scale", {-1, 1, 1}}, {"children", {1}}});
  file.root["scenes"][0]["nodes"] = {0, 3};
  Scene scene = load(file);
  for (const double frame : {1, 25}) {
    poseScene(scene, frame);
    EXPECT_TRUE(facesItsNormal(scene)) << frame;
  }
  std::vector<glm::dvec3> expected = bentBar(kPi / 2);
  for (std::size_t i = 0; i < 6; ++i) {
    expected[i].x *= -1;
    expectPlace(placesOf(scene)[i], expected[i], "mirrored");
  }
  expectPlace(normalsOf(scene)[0], {0, 0, 1}, "normal");
}

TEST_F(GltfDeform, FlatTrianglesStayFlat) {
  GltfFile file = bendingFile();
  file.primitive()["attributes"].erase("NORMAL");
  Scene scene = load(file);
  poseScene(scene, 25);
  const std::vector<glm::dvec3> places = placesOf(scene), normals = normalsOf(scene);
  ASSERT_EQ(places.size(), 12u);
  for (std::size_t i = 0; i < 12; i += 3) {
    const glm::dvec3 flat = glm::normalize(glm::cross(places[i + 1] - places[i], places[i + 2] - places[i]));
    for (std::size_t c = 0; c < 3; ++c) expectPlace(normals[i + c], flat, "flat");
  }
}

/// A triangle with morph targets that shift it by these vectors each.
GltfFile morphFile(const std::vector<glm::vec3>& shifts) {
  GltfFile file = triangleFile();
  for (const glm::vec3& s : shifts) {
    const int target =
        file.addAccessor<float>("VEC3", kFloat, 3, {s.x, s.y, s.z, s.x, s.y, s.z, s.x, s.y, s.z});
    file.primitive()["targets"].push_back({{"POSITION", target}});
  }
  return file;
}

TEST_F(GltfDeform, MorphTargetsMoveVerticesByTheirWeights) {
  GltfFile file = morphFile({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  expectPlace(placesOf(load(file))[0], {0, 0, 0}, "without weights");
  EXPECT_TRUE(load(file).meshes[0].sources.empty());
  file.root["meshes"][0]["weights"] = {0.5, 0, -2};
  expectPlace(placesOf(load(file))[1], {1.5, 0, -2}, "the mesh's weights");
  file.root["nodes"][0]["weights"] = {0, 1, 0};
  file.root["nodes"][0]["translation"] = {0, 0, 3};
  file.root["nodes"].push_back({{"mesh", 0}});
  file.root["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = load(file);
  expectPlace(placesOf(scene)[1], {1, 1, 3}, "the node's weights, in the node's place");
  expectPlace(placesOf(scene, 1)[1], {1.5, 0, -2}, "the mesh's weights");
  EXPECT_TRUE(scene.animation.deformations.empty());
}

TEST_F(GltfDeform, MorphTargetsMayBeSparseAndMoveNormals) {
  GltfFile file = morphFile({{0, 0, 0}});
  json& attributes = file.primitive()["attributes"];
  attributes["NORMAL"] = file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
  json& target = file.primitive()["targets"][0];
  target["NORMAL"] = file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0, 0, 1, 0, 0, 0, 0});
  const int which = file.addView<std::uint16_t>({2}), how = file.addView<float>({0, 4, 0});
  json& positions = file.accessor(target["POSITION"]);
  positions["sparse"] = {{"count", 1},
                         {"indices", {{"bufferView", which}, {"componentType", kUnsignedShort}}},
                         {"values", {{"bufferView", how}}}};
  file.root["meshes"][0]["weights"] = {0.5};
  const Scene scene = load(file);
  expectPlace(placesOf(scene)[1], {1, 0, 0}, "at rest");
  expectPlace(placesOf(scene)[2], {0, 3, 0}, "moved");
  expectPlace(normalsOf(scene)[0], {0, 0, 1}, "at rest");
  expectPlace(normalsOf(scene)[1], glm::normalize(glm::dvec3(0, 0.5, 1)), "turned");
}

TEST_F(GltfDeform, WeightsMoveByTheirChannel) {
  // Five targets take two curves.
  const std::vector<glm::vec3> shifts{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}, {2, 0, 0}};
  GltfFile linear = morphFile(shifts);
  animate(linear, 0, "weights", {0, 1}, {0, 0, 0, 0, 0, 1, 2, 0, 0, 4});
  Scene scene = load(linear);
  EXPECT_TRUE(scene.animation.nodes.empty()) << "the node itself stands still";
  poseScene(scene, 7);
  expectPlace(placesOf(scene)[0], {0.25 + 2, 0.5, 0}, "linear");

  // A weight of t³ − t from 1 s to 2 s: slopes of 2 and 11.
  GltfFile cubic = morphFile({{1, 0, 0}});
  animate(cubic, 0, "weights", {1, 2}, {99, 0, 2, 11, 6, 99}, "CUBICSPLINE");
  scene = load(cubic);
  for (const double t : {1.0, 1.25, 1.5, 2.0}) {
    poseScene(scene, 1 + 24 * t);
    EXPECT_NEAR(placesOf(scene)[0].x, t * t * t - t, 2 * kRounding) << t;
  }
}

TEST_F(GltfDeform, TargetsMoveAVertexBeforeJointsDo) {
  GltfFile file = bendingFile();
  std::vector<float> shift(18, 0.0f);
  shift[15] = 1;  // vertex 5: to (2,2,0)
  file.primitive()["targets"] = {{{"POSITION", file.addAccessor("VEC3", kFloat, 3, shift)}}};
  file.root["nodes"][0]["weights"] = {1};
  Scene scene = load(file);
  poseScene(scene, 25);
  expectPlace(placesOf(scene)[5], {2, 1, 1}, "moved, then turned");
  expectPlace(placesOf(scene)[4], {0, 1, 1}, "turned");
}

TEST_F(GltfDeform, ChannelsOfWhatAnExtensionMovesAreLeftOut) {
  GltfFile file = bendingFile();
  json& animation = file.root["animations"][0];
  json pointer = animation["channels"][0];
  pointer["target"] = {{"path", "pointer"},
                       {"extensions", {{"KHR_animation_pointer", {{"pointer", "/nodes/0/rotation"}}}}}};
  animation["channels"].insert(animation["channels"].begin(), pointer);
  file.root["extensionsUsed"] = {"KHR_animation_pointer"};
  Scene scene = load(file);
  EXPECT_THAT(textsOf(scene.warnings),
              testing::ElementsAre(HasSubstr("'KHR_animation_pointer' is not supported")));
  poseScene(scene, 25);
  expectPlace(placesOf(scene)[5], bentBar(kPi / 2)[5], "the others move");
}

TEST_F(GltfDeform, ASceneFilePlacesWhatDeforms) {
  load(bendingFile());
  std::ofstream(folder / "scene.json") << R"({"objects": [
      {"mesh": "a.gltf", "translate": [5, 0, 0]},
      {"mesh": "a.gltf", "scale": 2, "keys": [{"frame": 1, "translate": [0,0,0]}, {"frame": 13, "translate": [0,0,6]}]}]})";
  const Scene scene = loadScene(folder / "scene.json", 13);
  const std::vector<glm::dvec3> bent = bentBar(kPi / 4), first = placesOf(scene), second = placesOf(scene, 1);
  for (std::size_t i = 0; i < 6; ++i) {
    expectPlace(first[i], bent[i] + glm::dvec3(5, 0, 0), "first");
    expectPlace(second[i] / 2.0, bent[i] + glm::dvec3(0, 0, 3), "second");
  }
}

TEST_F(GltfDeform, ASkinThatNoVertexFollowsIsLeftOut) {
  GltfFile file = bendingFile();
  for (const char* name : {"JOINTS_0", "WEIGHTS_0"}) file.primitive()["attributes"].erase(name);
  file.root.erase("animations");
  file.root["nodes"][0]["translation"] = {5, 0, 0};
  EXPECT_THAT(repair(file), HasSubstr("nodes[0]: has a skin, but its mesh no JOINTS_0 and WEIGHTS_0"));
  EXPECT_EQ(load(file).objects.at(0).object_to_world[3], glm::dvec4(5, 0, 0, 1)) << "where its node is";
}

TEST_F(GltfDeform, WeightsOfAnotherSumAreScaledToOne) {
  GltfFile file = bendingFile();
  std::vector<float> weights(24, 0);
  for (std::size_t i = 0; i < 6; ++i) weights[4 * i] = i == 1 ? 0.0f : i == 2 ? 3.0f : 1.004f;
  file.primitive()["attributes"]["WEIGHTS_0"] = file.addAccessor("VEC4", kFloat, 4, weights);
  EXPECT_THAT(repair(file), HasSubstr("meshes[0].primitives[0].WEIGHTS_0: 2 elements have another sum than "
                                      "1, 0 of element 1 the first"));
}

TEST_F(GltfDeform, WrongSkinsAndTargetsAreRefused) {
  const auto refuses = [&](GltfFile file, const char* what, const std::function<void(GltfFile&)>& change) {
    change(file);
    EXPECT_THAT(error(file), HasSubstr(what));
  };
  const GltfFile bar = bendingFile(), morph = morphFile({{1, 0, 0}, {0, 1, 0}});
  const auto attributes = [](GltfFile& f) -> json& { return f.primitive()["attributes"]; };
  refuses(bar, "refers to skin 4", [](GltfFile& f) { f.root["nodes"][0]["skin"] = 4; });
  refuses(bar, "skins[0]: has no joints", [](GltfFile& f) { f.root["skins"][0]["joints"] = json::array(); });
  refuses(bar, "refers to node 9", [](GltfFile& f) { f.root["skins"][0]["joints"] = {1, 9}; });
  refuses(bar, "has 3 joints, but 2 inverseBindMatrices", [](GltfFile& f) {
    f.root["skins"][0]["joints"] = {1, 2, 0};
  });
  refuses(bar, "a vertex follows joint 1, but its skin has 1",
          [](GltfFile& f) { f.root["skins"][0]["joints"] = {1}; });
  refuses(bar, "without JOINTS_0", [&](GltfFile& f) {
    json bare = f.primitive();
    bare["attributes"].erase("JOINTS_0");
    bare["attributes"].erase("WEIGHTS_0");
    f.root["meshes"][0]["primitives"].push_back(bare);
  });
  refuses(bar, "has one of JOINTS_0 and WEIGHTS_0", [&](GltfFile& f) { attributes(f).erase("WEIGHTS_0"); });
  refuses(bar, "WEIGHTS_0: element 0 is not finite", [&](GltfFile& f) {
    attributes(f)["WEIGHTS_0"] = f.addAccessor("VEC4", kFloat, 4, std::vector<float>(24, INFINITY));
  });
  refuses(bar, "element 0 is no joint's number", [&](GltfFile& f) {
    attributes(f)["JOINTS_0"] = f.addAccessor("VEC4", kFloat, 4, std::vector<float>(24, 0.5f));
  });
  refuses(bar, "its attributes have 6 and 5 elements", [&](GltfFile& f) {
    attributes(f)["JOINTS_0"] = f.addAccessor("VEC4", kUnsignedByte, 4, std::vector<std::uint8_t>(20, 0));
  });
  refuses(bar, "inverseBindMatrices is not finite", [](GltfFile& f) {
    f.root["skins"][0]["inverseBindMatrices"] =
        f.addAccessor("MAT4", kFloat, 16, std::vector<float>(32, std::nanf("")));
  });
  refuses(bar, "contains itself", [](GltfFile& f) {
    f.root["scenes"][0]["nodes"] = {0};
    f.root["nodes"][2]["children"] = {1};
  });
  refuses(bar, "has a skin, which has no instances", [](GltfFile& f) {
    f.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        f.primitive()["attributes"]["POSITION"];
  });
  refuses(morph, "targets[1].POSITION: has 2 elements for 3 vertices", [](GltfFile& f) {
    f.root["meshes"][0]["weights"] = {1, 0};
    f.primitive()["targets"][1]["POSITION"] = f.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0, 0, 0, 0});
  });
  refuses(morph, "targets[0].POSITION: element 0 is not finite", [](GltfFile& f) {
    f.root["meshes"][0]["weights"] = {1, 0};
    f.primitive()["targets"][0]["POSITION"] =
        f.addAccessor("VEC3", kFloat, 3, std::vector<float>(9, std::nanf("")));
  });
  refuses(morph, "expected 4", [](GltfFile& f) { animate(f, 0, "weights", {0, 1}, {0, 0, 1}); });
  refuses(morph, "a vertex's position is not finite", [](GltfFile& f) {
    f.root["meshes"][0]["weights"] = {1e300, 0};
  });
}

TEST_F(GltfDeform, WrongNumbersOfWeightsAndTargetsAreMended) {
  const auto mended = [&](const char* what, const std::function<void(GltfFile&)>& change) {
    GltfFile file = morphFile({{1, 0, 0}, {0, 1, 0}});
    change(file);
    EXPECT_THAT(repair(file), HasSubstr(what));
    return load(file).meshes.at(0).positions;
  };
  const std::vector<glm::vec3> rest = load(morphFile({{1, 0, 0}, {0, 1, 0}})).meshes.at(0).positions;
  EXPECT_NE(mended("meshes[0]: has 1 weights for 2 morph targets",
                   [](GltfFile& f) { f.root["meshes"][0]["weights"] = {1}; }),
            rest);
  EXPECT_NE(mended("nodes[0]: has 3 weights for 2",
                   [](GltfFile& f) {
                     f.root["nodes"][0]["weights"] = {1, 2, 3};
                   }),
            rest);
  EXPECT_EQ(mended("meshes[0]: has 1 weights for 0 morph targets",
                   [](GltfFile& f) {
                     f.primitive().erase("targets");
                     f.root["meshes"][0]["weights"] = {1};
                   }),
            rest);
  EXPECT_EQ(mended("meshes[0]: its primitives have 2 and 0 morph targets",
                   [](GltfFile& f) {
                     json other = f.primitive();
                     other.erase("targets");
                     f.root["meshes"][0]["primitives"].push_back(other);
                     f.root["meshes"][0]["weights"] = {1, 0};
                   })
                .size(),
            2 * rest.size());
}

TEST_F(GltfDeform, NegativeWeightsOfJointsAreTakenForZero) {
  GltfFile file = bendingFile();
  std::vector<float> weights(24, 0.0f);
  for (std::size_t i = 0; i < 6; ++i) {
    weights[4 * i] = 1;
    weights[4 * i + 1] = i == 2 ? -0.25f : 0.0f;
  }
  file.primitive()["attributes"]["WEIGHTS_0"] = file.addAccessor("VEC4", kFloat, 4, weights);
  EXPECT_THAT(repair(file), HasSubstr("WEIGHTS_0: 1 are negative, the first of element 2"));
}

TEST_F(GltfDeform, APoseThatIsNotFiniteIsRefusedByItsFrame) {
  GltfFile file = morphFile({{3e38f, 0, 0}});
  animate(file, 0, "weights", {0, 1}, {0, 3e38f});
  Scene scene = load(file);
  try {
    poseScene(scene, 25);
    FAIL();
  } catch (const InputError& fault) {
    EXPECT_THAT(fault.what(), HasSubstr("at frame 25: a vertex's position is not finite"));
  }
  poseScene(scene, 1);
  expectPlace(placesOf(scene)[1], {1, 0, 0}, "the frame before is as it was");
}

}  // namespace
}  // namespace luciole::test
