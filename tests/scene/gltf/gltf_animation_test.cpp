#include "scene/gltf/gltf_animation.hpp"

#include <cmath>
#include <functional>

#include "luciole/load_scene.hpp"
#include "luciole/pose.hpp"
#include "scene/gltf/gltf_file.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

class GltfAnimation : public GltfTest {};

/// A node 0 with the triangle whose `path` an animation moves, through these numbers at these seconds.
GltfFile animatedFile(const std::string& path, const std::string& interpolation,
                      const std::vector<float>& times, const std::vector<float>& values) {
  GltfFile file = triangleFile();
  const bool turns = path == "rotation";
  const int input = file.addAccessor("SCALAR", kFloat, 1, times);
  const int output = file.addAccessor(turns ? "VEC4" : "VEC3", kFloat, turns ? 4 : 3, values);
  json sampler = {{"input", input}, {"output", output}};
  if (!interpolation.empty()) sampler["interpolation"] = interpolation;
  file.root["animations"] = {
      {{"samplers", {sampler}}, {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}}};
  return file;
}

glm::dvec3 placeAt(Scene scene, double frame) {
  poseScene(scene, frame);
  return glm::dvec3(scene.objects.at(0).object_to_world[3]);
}

TEST_F(GltfAnimation, LinearAndStepAnimationsFollowTheirKeys) {
  // 24 frames a second from frame 1 on: 0.5 s is frame 13, 1 s frame 25.
  Scene linear = load(animatedFile("translation", "", {0.5f, 1}, {0, 0, 0, 6, -12, 0}));
  EXPECT_EQ(placeAt(linear, 1), glm::dvec3(0));
  EXPECT_EQ(placeAt(linear, 16), glm::dvec3(1.5, -3, 0));
  EXPECT_EQ(placeAt(linear, 25), glm::dvec3(6, -12, 0));
  EXPECT_EQ(placeAt(linear, 99), glm::dvec3(6, -12, 0));
  Scene step = load(animatedFile("translation", "STEP", {0.5f, 1}, {1, 2, 3, 6, -12, 0}));
  EXPECT_EQ(placeAt(step, 24), glm::dvec3(1, 2, 3));
  EXPECT_EQ(placeAt(step, 25), glm::dvec3(6, -12, 0));
}

TEST_F(GltfAnimation, CubicSplinesAreHermitesWithSlopesASecond) {
  // x(t) = t³ − t from 1 s to 2 s: slopes 3t² − 1.
  Scene scene = load(animatedFile("translation", "CUBICSPLINE", {1, 2},
                                  {99, 0, 0, 0, 0, 0, 2, 0, 0, 11, 0, 0, 6, 0, 0, 99, 0, 0}));
  for (double t = 1; t <= 2; t += 0.125) {
    // Some twenty operations on numbers below 20 round, and slopes do when they are told by the frame.
    EXPECT_NEAR(placeAt(scene, 1 + 24 * t).x, t * t * t - t, 20 * 20 * 2.3e-16) << t;
  }
}

TEST_F(GltfAnimation, RotationsGoTheShorterWayAtAConstantSpeed) {
  const float half = std::sqrt(0.5f);
  // From 0 to 90 degrees about y, the second written as −q.
  Scene scene = load(animatedFile("rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, -half, 0, -half}));
  for (const double t : {0.0, 0.25, 0.5, 1.0}) {
    poseScene(scene, 1 + 24 * t);
    const glm::dvec3 x(scene.objects[0].object_to_world[0]);
    // √½ as a float is off by 2⁻²⁵ of itself, equally in both places: no error of the angle.
    EXPECT_NEAR(x.x, std::cos(t * kPi / 2), 1e-14);
    EXPECT_NEAR(x.z, -std::sin(t * kPi / 2), 1e-14);
  }
}

TEST_F(GltfAnimation, AnAnimatedScaleOfZeroHidesForSomeTime) {
  Scene scene = load(animatedFile("scale", "STEP", {0, 1, 2}, {0, 0, 0, 2, 3, 4, 1, 0, 0}));
  const auto shown = [&](double frame) {
    poseScene(scene, frame);
    return scene.meshes[scene.objects.at(0).mesh].triangles.size();
  };
  EXPECT_EQ(shown(1), 0u);
  EXPECT_EQ(shown(25), 1u);
  EXPECT_EQ(scene.objects[0].object_to_world[2][2], 4);
  EXPECT_EQ(shown(49), 0u);
  EXPECT_EQ(shown(30), 1u);
}

TEST_F(GltfAnimation, WhatHangsOnAMovingNodeMovesWithIt) {
  // Node 0 moves; its child lies 1 m above, and holds a camera and a light; node 2 stands still.
  GltfFile file = animatedFile("translation", "LINEAR", {0, 1}, {0, 0, 0, 24, 0, 0});
  file.root["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}, {"zfar", 9}}}}};
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", json::object()}}};
  file.root["nodes"][0]["children"] = {1};
  file.root["nodes"].push_back({{"translation", {0, 1, 0}}, {"mesh", 0}, {"camera", 0}});
  file.root["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  file.root["nodes"].push_back({{"mesh", 0}});
  file.root["scenes"][0]["nodes"] = {0, 2};
  Scene scene = load(file);
  poseScene(scene, 6);
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(glm::dvec3(scene.objects[0].object_to_world[3]), glm::dvec3(5, 0, 0));
  EXPECT_EQ(glm::dvec3(scene.objects[1].object_to_world[3]), glm::dvec3(5, 1, 0));
  EXPECT_EQ(glm::dvec3(scene.objects[2].object_to_world[3]), glm::dvec3(0));
  EXPECT_EQ(glm::dvec3(scene.cameras.at(0).camera_to_world[3]), glm::dvec3(5, 1, 0));
  EXPECT_EQ(scene.lights.at(0).position, glm::dvec3(5, 1, 0));
  EXPECT_EQ(scene.lights.at(0).direction, glm::dvec3(0, 0, -1));
}

TEST_F(GltfAnimation, AnAnimatedNodeKeepsWhatNoChannelMoves) {
  GltfFile file = animatedFile("translation", "LINEAR", {0, 1}, {0, 0, 0, 24, 0, 0});
  file.root["nodes"][0]["scale"] = {2, 3, 4};
  file.root["nodes"][0]["rotation"] = {0, 1, 0, 0};  // half a turn about y
  Scene scene = load(file);
  EXPECT_EQ(placeAt(scene, 2), glm::dvec3(1, 0, 0));
  EXPECT_EQ(glm::dvec3(scene.objects[0].object_to_world[0]), glm::dvec3(-2, 0, 0));
  EXPECT_EQ(glm::dvec3(scene.objects[0].object_to_world[1]), glm::dvec3(0, 3, 0));
}

TEST_F(GltfAnimation, AllAnimationsRunAndTheFirstWins) {
  GltfFile file = animatedFile("translation", "LINEAR", {0, 1}, {0, 0, 0, 24, 0, 0});
  json other = file.root["animations"][0], scale = other;
  const int output = file.addAccessor<float>("VEC3", kFloat, 3, {9, 9, 9, 9, 9, 9});
  other["samplers"][0]["output"] = output;
  scale["samplers"][0]["output"] = output;
  scale["channels"][0]["target"]["path"] = "scale";
  for (const json& more : {other, scale}) file.root["animations"].push_back(more);
  Scene scene = load(file);
  EXPECT_EQ(placeAt(scene, 2), glm::dvec3(1, 0, 0));
  poseScene(scene, 2);
  EXPECT_EQ(scene.objects[0].object_to_world[0][0], 9);
}

TEST_F(GltfAnimation, OneIsChosenByItsNameOrNumber) {
  GltfFile file = animatedFile("translation", "LINEAR", {0, 1}, {0, 0, 0, 24, 0, 0});
  json other = file.root["animations"][0];
  other["samplers"][0]["output"] = file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0, 0, 48, 0});
  for (const char* name : {"walk", "", "walk", "rest"}) {
    if (*name) other["name"] = name;
    file.root["animations"].push_back(other);
    other.erase("name");
  }
  load(file);
  const auto open = [&](const std::string& animation) {
    return loadScene(folder / "a.gltf", 2, {.choice = {.animation = animation}});
  };
  EXPECT_EQ(open("").animations, (std::vector<std::string>{"0", "walk", "2", "walk", "rest"}));
  EXPECT_EQ(placeAt(open("0"), 2), glm::dvec3(1, 0, 0));
  EXPECT_EQ(placeAt(open("rest"), 2), glm::dvec3(0, 2, 0));
  EXPECT_EQ(placeAt(open("3"), 2), glm::dvec3(0, 2, 0)) << "a number of one with a name";
  const auto refusal = [&](const std::string& animation) {
    try {
      open(animation);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(refusal("walk"), HasSubstr("has several animations 'walk'; expected a number"));
  EXPECT_THAT(refusal("rast"), HasSubstr("has no animation 'rast'; did you mean rest?; it has 0, walk, 2"));
  EXPECT_THAT(refusal("5"), HasSubstr("has no animation '5'"));
  EXPECT_THAT(refusal("-1"), HasSubstr("has no animation '-1'"));
}

TEST_F(GltfAnimation, ASceneFileNamesTheOneThatAnObjectHas) {
  GltfFile file = animatedFile("translation", "LINEAR", {0, 1}, {0, 0, 0, 24, 0, 0});
  json other = file.root["animations"][0];
  other["samplers"][0]["output"] = file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0, 0, 24, 0});
  other["name"] = "rise";
  file.root["animations"].push_back(other);
  load(file);
  std::ofstream(folder / "scene.json")
      << R"({"objects": [{"mesh": "a.gltf"}, {"mesh": "a.gltf", "animation": "rise"}]})";
  const Scene scene = loadScene(folder / "scene.json", 2);
  EXPECT_EQ(glm::dvec3(scene.objects.at(0).object_to_world[3]), glm::dvec3(1, 0, 0));
  EXPECT_EQ(glm::dvec3(scene.objects.at(1).object_to_world[3]), glm::dvec3(0, 1, 0));
}

TEST_F(GltfAnimation, AnimatedFilesMoveWhereASceneFilePlacesThem) {
  load(animatedFile("translation", "LINEAR", {0, 1}, {0, 0, 0, 24, 0, 0}));
  // 10 frames a second: frame 6 is 0.5 s.
  std::ofstream(folder / "scene.json")
      << R"({"frame_rate": 10, "objects": [{"mesh": "a.gltf", "translate": [0,7,0]},
      {"mesh": "a.gltf", "scale": 2, "keys": [{"frame": 1, "translate": [0,0,0]}, {"frame": 11, "translate": [0,0,10]}]}]})";
  Scene scene = loadScene(folder / "scene.json", 6);
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.meshes.size(), 2u) << "one, and the empty one";
  EXPECT_EQ(glm::dvec3(scene.objects[0].object_to_world[3]), glm::dvec3(12, 7, 0));
  EXPECT_EQ(glm::dvec3(scene.objects[1].object_to_world[3]), glm::dvec3(24, 0, 5));
}

TEST_F(GltfAnimation, AStillFileMovesAsAWhole) {
  GltfFile file = triangleFile();
  file.root["nodes"][0]["translation"] = {1, 0, 0};
  load(file);
  std::ofstream(folder / "scene.json")
      << R"({"objects": [{"mesh": "a.gltf", "keys": [{"frame": 1, "scale": 1}, {"frame": 3, "scale": 5}]}]})";
  EXPECT_EQ(glm::dvec3(loadScene(folder / "scene.json", 2).objects.at(0).object_to_world[3]),
            glm::dvec3(3, 0, 0));
}

TEST_F(GltfAnimation, AnimationsThatDoNotFitTogetherAreRefused) {
  const auto broken = [&](const std::function<void(json & animation)>& breakIt) {
    GltfFile file = animatedFile("translation", "LINEAR", {0, 1}, {0, 0, 0, 24, 0, 0});
    breakIt(file.root["animations"][0]);
    return error(file);
  };
  EXPECT_THAT(broken([](json& a) { a["samplers"][0]["interpolation"] = "CUBICSPLINE"; }),
              HasSubstr("2 times and 6 numbers of output, expected 18"));
  EXPECT_THAT(broken([](json& a) { a["samplers"][0]["input"] = 77; }), HasSubstr("accessor 77"));
  EXPECT_THAT(broken([](json& a) { a["samplers"][0]["output"] = a["samplers"][0]["input"]; }),
              HasSubstr("needs 3"));
  EXPECT_THAT(broken([](json& a) { a["channels"][0]["sampler"] = 5; }), HasSubstr("sampler 5"));
  EXPECT_THAT(broken([](json& a) { a["channels"][0]["target"]["node"] = 5; }), HasSubstr("node 5"));
  for (const std::vector<float>& times : {std::vector<float>{0, NAN}, {0, INFINITY}})
    EXPECT_THAT(error(animatedFile("scale", "LINEAR", times, {1, 1, 1, 1, 1, 1})),
                HasSubstr("a time is not"));
  EXPECT_THAT(error(animatedFile("scale", "LINEAR", {0, 1}, {1, 1, 1, 1, INFINITY, 1})),
              HasSubstr("not finite"));
}

TEST_F(GltfAnimation, FaultsOfKeysAreMended) {
  GltfFile file = animatedFile("translation", "BOUNCE", {0, 1}, {0, 0, 0, 24, 0, 0});
  EXPECT_THAT(repair(file), HasSubstr("animations[0].samplers[0]: interpolation 'BOUNCE' is none of"));
  EXPECT_EQ(placeAt(load(file), 13), glm::dvec3(12, 0, 0)) << "linear";
  file = animatedFile("translation", "step", {0, 1}, {0, 0, 0, 24, 0, 0});
  EXPECT_THAT(repair(file), HasSubstr("'step'"));
  EXPECT_EQ(placeAt(load(file), 13), glm::dvec3(0));
  // Keys before the first frame count for what comes after them.
  file = animatedFile("translation", "LINEAR", {-1, 1}, {0, 0, 0, 24, 0, 0});
  EXPECT_THAT(repair(file), HasSubstr("time -1: expected rising times from 0 on"));
  EXPECT_EQ(placeAt(load(file), 1), glm::dvec3(12, 0, 0));
  // Twice the same time is a jump.
  file = animatedFile("translation", "LINEAR", {0, 1, 1, 2}, {0, 0, 0, 24, 0, 0, 48, 0, 0, 48, 0, 0});
  EXPECT_THAT(repair(file), HasSubstr("time 1 after 1"));
  EXPECT_EQ(placeAt(load(file), 13), glm::dvec3(12, 0, 0));
  EXPECT_EQ(placeAt(load(file), 25), glm::dvec3(48, 0, 0));
  file = animatedFile("translation", "LINEAR", {1, 0}, {24, 0, 0, 0, 0, 0});
  EXPECT_THAT(repair(file), HasSubstr("time 0 after 1"));
  EXPECT_EQ(placeAt(load(file), 13), glm::dvec3(12, 0, 0)) << "sorted";
  file = animatedFile("rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, 0, 0});
  EXPECT_THAT(repair(file), HasSubstr("output 1: a rotation of length 0"));
  EXPECT_EQ(glm::dvec3(load(file).objects.at(0).object_to_world[0]), glm::dvec3(1, 0, 0));
  file = animatedFile("translation", "LINEAR", {0, 1}, {0, 0, 0, 24, 0, 0});
  file.root["animations"][0]["channels"][0]["target"]["path"] = "colour";
  EXPECT_THAT(repair(file), HasSubstr("animations[0].channels[0]: path 'colour'"));
  file.root["animations"][0]["channels"][0]["target"]["path"] = "weights";
  EXPECT_THAT(repair(file),
              HasSubstr("channels[0]: moves weights of a node without morph targets; left out"));
}

TEST_F(GltfAnimation, AnAnimatedMatrixIsTakenApart) {
  GltfFile file = animatedFile("translation", "LINEAR", {0, 1}, {0, 0, 0, 24, 0, 0});
  // A quarter turn about z of a scale of -2, 3, 0, moved to 7 8 9.
  const std::vector<double> matrix{0, -2, 0, 0, -3, 0, 0, 0, 0, 0, 0, 0, 7, 8, 9, 1};
  file.root["nodes"][0]["matrix"] = matrix;
  EXPECT_THAT(repair(file), HasSubstr("nodes[0]: has a matrix and is animated"));
  Scene scene = load(file);
  poseScene(scene, 13);
  const glm::dmat4& placed = scene.objects.at(0).object_to_world;
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(placed[i / 4][i % 4], matrix[std::size_t(i)], 1e-12) << i;
  EXPECT_EQ(glm::dvec3(placed[3]), glm::dvec3(12, 0, 0));
}

TEST_F(GltfAnimation, AnAnimatedScaleThatFlattensShowsTheFlatThing) {
  Scene scene = load(animatedFile("scale", "STEP", {0, 1}, {1, 1, 1, 2, 2, 0}));
  poseScene(scene, 25);
  EXPECT_EQ(scene.meshes[scene.objects.at(0).mesh].triangles.size(), 1u);
}

}  // namespace
}  // namespace luciole::test
