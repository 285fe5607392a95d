// Keys of a scene file, the curves through them, and the poses that they give a scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <string>

#include "luciole/animation.hpp"
#include "luciole/error.hpp"
#include "luciole/load_scene.hpp"
#include "scene/posing.hpp"
#include "scene/scene_fault.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

using testing::StartsWith;

/// A curve of one component.
Curve curveOf(Interpolation interpolation, const std::vector<std::pair<double, double>>& keys) {
  Curve curve;
  curve.interpolation = interpolation;
  for (const auto& [frame, value] : keys) curve.keys.push_back({frame, {value, 0, 0, 0}});
  return curve;
}

TEST(Curve, HoldsBeforeItsFirstKeyAndAfterItsLast) {
  for (const Interpolation kind : {Interpolation::kStep, Interpolation::kLinear, Interpolation::kCubic}) {
    const Curve curve = curveOf(kind, {{10, 3}, {20, 7}});
    for (const double frame : {-1e9, 0.0, 9.0, 10.0}) EXPECT_EQ(valueAt(curve, frame).x, 3);
    for (const double frame : {20.0, 21.0, 1e9}) EXPECT_EQ(valueAt(curve, frame).x, 7);
  }
  EXPECT_EQ(valueAt(constantCurve({1, 2, 3, 4}), 17), glm::dvec4(1, 2, 3, 4));
}

TEST(Curve, LinearIsStraightAndStepsStay) {
  // Quarters of whole numbers are exact.
  EXPECT_EQ(valueAt(curveOf(Interpolation::kLinear, {{10, 3}, {14, 7}}), 11).x, 4);
  EXPECT_EQ(valueAt(curveOf(Interpolation::kLinear, {{10, 3}, {14, 7}, {18, -1}}), 17).x, 1);
  EXPECT_EQ(valueAt(curveOf(Interpolation::kStep, {{10, 3}, {14, 7}}), 13.999).x, 3);
  EXPECT_EQ(valueAt(curveOf(Interpolation::kStep, {{10, 3}, {14, 7}}), 14).x, 7);
}

TEST(Curve, BetweenEqualKeysLinearChangesNoBit) {
  const Curve curve = curveOf(Interpolation::kLinear, {{1, 0.1}, {4, 0.1}});
  for (double frame = 1; frame <= 4; frame += 0.01) EXPECT_EQ(valueAt(curve, frame).x, 0.1);
}

TEST(Curve, CubicIsThePolynomialWithItsSlopes) {
  // x³ − 2x from 1 to 3, exactly; its slope is 3x² − 2.
  Curve curve = curveOf(Interpolation::kCubic, {{1, -1}, {3, 21}});
  curve.keys[0].slope_out.x = 1;
  curve.keys[1].slope_in.x = 25;
  for (double x = 1; x <= 3; x += 0.0625) {
    // Some twenty operations on numbers below 100 round.
    EXPECT_NEAR(valueAt(curve, x).x, x * x * x - 2 * x, 20 * 100 * std::numeric_limits<double>::epsilon());
  }
}

TEST(Curve, SmoothGoesThroughItsKeysAndNeverBeyondTwoOfThem) {
  Curve curve =
      curveOf(Interpolation::kLinear, {{1, 0}, {2, 1}, {4, 100}, {5, 100}, {9, 2}, {30, 0.5}, {31, 4}});
  makeSmooth(curve);
  for (std::size_t i = 0; i + 1 < curve.keys.size(); ++i) {
    const CurveKey &a = curve.keys[i], &b = curve.keys[i + 1];
    EXPECT_EQ(valueAt(curve, a.frame).x, a.value.x);
    // Both sums of Hermite's form and their four weights round: a dozen operations on numbers below 600.
    const double rounding = 12 * 600 * std::numeric_limits<double>::epsilon();
    double before = a.value.x;
    for (double frame = a.frame; frame <= b.frame; frame += 0.01) {
      const double value = valueAt(curve, frame).x;
      EXPECT_GE(value, std::min(a.value.x, b.value.x) - rounding) << frame;
      EXPECT_LE(value, std::max(a.value.x, b.value.x) + rounding) << frame;
      EXPECT_GE((value - before) * (b.value.x - a.value.x), -600 * rounding) << "turns back at " << frame;
      before = value;
    }
  }
}

TEST(Curve, SmoothHasNoCornersAndIsStraightWhereItsKeysAre) {
  Curve bent = curveOf(Interpolation::kLinear, {{0, 0}, {10, 1}, {20, 5}, {30, 6}});
  makeSmooth(bent);
  for (const double frame : {10.0, 20.0}) {
    const double h = 1e-4;
    const double before = (valueAt(bent, frame).x - valueAt(bent, frame - h).x) / h;
    const double after = (valueAt(bent, frame + h).x - valueAt(bent, frame).x) / h;
    // The second derivative of a cubic with values and slopes like these is below 1 (6·5/10² + 4·0.8/10).
    EXPECT_NEAR(before, after, h);
  }
  for (const std::size_t keys : {2u, 3u, 5u}) {
    Curve straight;
    for (std::size_t i = 0; i < keys; ++i)
      straight.keys.push_back({8.0 * double(i), {2.0 * double(i), 0, 0, 0}});
    makeSmooth(straight);
    for (double frame = 0; frame <= 8 * double(keys - 1); frame += 0.5)
      EXPECT_DOUBLE_EQ(valueAt(straight, frame).x, frame / 4);
  }
}

TEST(Curve, SlerpTurnsAtAConstantSpeedTheShorterWay) {
  const auto turned = [](double degrees) {
    return glm::dvec4(0, std::sin(glm::radians(degrees) / 2), 0, std::cos(glm::radians(degrees) / 2));
  };
  for (const double sign : {1.0, -1.0}) {  // q and −q are the same rotation
    Curve curve{Interpolation::kSlerp, {{1, turned(0)}, {5, sign * turned(120)}}};
    for (const double frame : {2.0, 3.5, 4.0}) {
      const glm::dvec4 value = valueAt(curve, frame);
      // Sines and cosines of a few roundings each.
      EXPECT_NEAR(std::abs(glm::dot(value, turned(30 * (frame - 1)))), 1, 1e-14);
      EXPECT_NEAR(glm::length(value), 1, 1e-14);
    }
  }
}

TEST(OrbitEye, GoesRoundTheTargetAndEndsWhereItBegan) {
  const glm::dvec3 target(10, 20, 30);
  EXPECT_EQ(orbitEye({0, 0, 5}, target), target + glm::dvec3(0, 0, 5));
  EXPECT_EQ(orbitEye({360, 0, 5}, target), orbitEye({0, 0, 5}, target));
  EXPECT_EQ(orbitEye({-690, 20, 5}, target), orbitEye({30, 20, 5}, target));
  // Right angles in radians, and their sines, round.
  const double rounding = 5 * 4 * std::numeric_limits<double>::epsilon() * 10;
  EXPECT_LT(glm::length(orbitEye({90, 0, 5}, target) - (target + glm::dvec3(5, 0, 0))), rounding);
  EXPECT_LT(glm::length(orbitEye({123, 90, 5}, target) - (target + glm::dvec3(0, 5, 0))), rounding);
  EXPECT_NEAR(glm::length(orbitEye({77, -33, 5}, target) - target), 5, rounding);
}

class SceneKeys : public testing::Test {
 protected:
  Scene load(const std::string& text) {
    std::ofstream(folder / "scene.json") << text;
    return loadScene(folder / "scene.json");
  }
  Scene at(const std::string& text, double frame) {
    Scene scene = load(text);
    poseScene(scene, frame);
    return scene;
  }
  std::string refusal(const std::function<void()>& act) {
    try {
      act();
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      return message.substr(std::min(message.size(), folder.path().string().size() + 1));
    }
    return "accepted";
  }
  std::string refusal(const std::string& text) {
    return refusal([&] { load(text); });
  }
  test::TemporaryFolder folder;
};

std::string cameraScene(const std::string& members) { return R"({"camera": {)" + members + "}}"; }
std::string lightScene(const std::string& members) {
  return R"({"camera": {"eye": [0,0,5], "target": [0,0,0]}, "lights": [{)" + members + "}]}";
}
std::string objectScene(const std::string& members) {
  return R"({"camera": {"eye": [0,0,5], "target": [0,0,0]}, "objects": [{"primitive": "box")" + members +
         "}]}";
}

TEST_F(SceneKeys, ACameraIsWhereOnePlacedByHandIs) {
  const std::string moving = cameraScene(
      R"("eye": [9,9,9], "target": [0,1,0], "keys": [{"frame": 1, "eye": [0,2,8], "fov_y": 30},
         {"frame": 5, "target": [4,1,0]}, {"frame": 9, "eye": [8,2,0], "fov_y": 60}])");
  // Halves and quarters: exact. One key alone names the target, so it is the same at every frame.
  const std::pair<double, const char*> poses[]{{-3, R"("eye": [0,2,8], "target": [4,1,0], "fov_y": 30)"},
                                               {1, R"("eye": [0,2,8], "target": [4,1,0], "fov_y": 30)"},
                                               {3, R"("eye": [2,2,6], "target": [4,1,0], "fov_y": 37.5)"},
                                               {5, R"("eye": [4,2,4], "target": [4,1,0], "fov_y": 45)"},
                                               {99, R"("eye": [8,2,0], "target": [4,1,0], "fov_y": 60)"}};
  for (const auto& [frame, still] : poses) {
    const Camera a = at(moving, frame).cameras.at(0), b = load(cameraScene(still)).cameras.at(0);
    EXPECT_EQ(a.camera_to_world, b.camera_to_world) << frame;
    EXPECT_EQ(a.fov_y, b.fov_y) << frame;
  }
}

TEST_F(SceneKeys, TwoKeysMakeATurntable) {
  const std::string turn = cameraScene(R"("orbit": [0,0,1], "target": [1,2,3],
      "keys": [{"frame": 1, "orbit": [0,10,5]}, {"frame": 5, "orbit": [360,10,5]}])");
  EXPECT_EQ(at(turn, 1).cameras[0].camera_to_world, at(turn, 5).cameras[0].camera_to_world);
  for (const double frame : {2.0, 3.0, 4.5}) {
    const glm::dmat4 place = at(turn, frame).cameras[0].camera_to_world;
    const glm::dvec3 eye = orbitEye({90 * (frame - 1), 10, 5}, {1, 2, 3});
    EXPECT_EQ(glm::dvec3(place[3]), eye);
    // Looks at the target: a dozen operations on numbers below 10.
    EXPECT_LT(glm::length(glm::cross(glm::dvec3(place[2]), eye - glm::dvec3(1, 2, 3))), 12 * 10 * 2.3e-16);
  }
}

TEST_F(SceneKeys, NamedCamerasMoveEachByItsOwnKeys) {
  const Scene scene = at(R"({"cameras": {"still": {"eye": [0,0,5], "target": [0,0,0]},
      "moves": {"eye": [0,0,5], "target": [0,0,0], "keys": [{"frame": 1, "eye": [1,0,5]}, {"frame": 3, "eye": [3,0,5]}]}}})",
                         2);
  EXPECT_EQ(glm::dvec3(scene.cameras[0].camera_to_world[3]), glm::dvec3(0, 0, 5));
  EXPECT_EQ(glm::dvec3(scene.cameras[1].camera_to_world[3]), glm::dvec3(2, 0, 5));
}

void expectEqualLights(const Light& a, const Light& b, const std::string& what) {
  EXPECT_EQ(a.position, b.position) << what;
  EXPECT_EQ(a.direction, b.direction) << what;
  EXPECT_EQ(a.ambient, b.ambient) << what;
  EXPECT_EQ(a.diffuse, b.diffuse) << what;
  EXPECT_EQ(a.specular, b.specular) << what;
  EXPECT_EQ(a.range, b.range) << what;
}

TEST_F(SceneKeys, ALightIsWhatOneOfTheSameNumbersIs) {
  struct Case {
    const char *moving, *still;
  };
  const Case cases[]{
      {R"("type": "point", "position": [0,0,0], "intensity": 3, "keys":
          [{"frame": 1, "position": [0,1,0], "color": [1,0,0.5]}, {"frame": 3, "position": [2,3,0], "color": 0}])",
       R"("type": "point", "position": [1,2,0], "intensity": 3, "color": [0.5,0,0.25])"},
      {R"("type": "point", "position": [0,0,0], "diffuse": [1,2,3], "ambient": 0.5, "intensity": 9, "keys":
          [{"frame": 1, "intensity": 1, "range": 4}, {"frame": 3, "intensity": 0.5, "range": 8}])",
       R"("type": "point", "position": [0,0,0], "diffuse": [1,2,3], "ambient": 0.5, "intensity": 0.75, "range": 6)"},
      {R"("type": "directional", "direction": [0,-1,0], "keys":
          [{"frame": 1, "direction": [2,0,0]}, {"frame": 3, "direction": [0,0,5]}])",
       R"("type": "directional", "direction": [0.5,0,0.5])"},
      {R"("type": "spot", "position": [0,4,0], "target": [1,0,0], "cutoff": 30, "keys":
          [{"frame": 1, "position": [0,4,0]}, {"frame": 3, "position": [8,4,0]}])",
       R"("type": "spot", "position": [4,4,0], "target": [1,0,0], "cutoff": 30)"},
      {R"("type": "spot", "position": [0,4,0], "target": [1,0,0], "cutoff": 30, "keys":
          [{"frame": 1, "target": [0,0,0]}, {"frame": 3, "target": [0,0,2]}])",
       R"("type": "spot", "position": [0,4,0], "target": [0,0,1], "cutoff": 30)"},
      {R"("type": "spot", "position": [0,4,0], "direction": [1,0,0], "cutoff": 180, "keys":
          [{"frame": 1, "direction": [0,-1,0]}, {"frame": 3, "direction": [0,1,0]}])",
       R"("type": "spot", "position": [0,4,0], "direction": [1,0,0], "cutoff": 180)"},
  };
  for (const Case& tested : cases) {
    const Scene moving = at(lightScene(tested.moving), 2);
    expectEqualLights(moving.lights.at(0), load(lightScene(tested.still)).lights.at(0), tested.moving);
  }
}

TEST_F(SceneKeys, ALightThatIsSwitchedOffTakesItsMotionAlong) {
  const std::string keys =
      R"("keys": [{"frame": 1, "position": [1,1,1]}, {"frame": 3, "position": [3,3,3]}])";
  const Scene scene =
      at(R"({"lights": [{"type": "point", "position": [0,0,0], "enabled": false, )" + keys +
             R"(}, {"type": "point", "position": [9,9,9]}, {"type": "point", "position": [0,0,0], )" + keys +
             R"(}], "light_fields": [{"count": 2, "min": [5,5,5], "max": [5,5,5]}]})",
         2);
  ASSERT_EQ(scene.lights.size(), 4u);
  EXPECT_EQ(scene.lights[0].position, glm::dvec3(9));
  EXPECT_EQ(scene.lights[1].position, glm::dvec3(2));
  EXPECT_EQ(scene.lights[2].position, glm::dvec3(5));
}

TEST_F(SceneKeys, AnObjectIsWhereOnePlacedByHandIs) {
  const std::string moving =
      objectScene(R"(, "scale": 2, "keys": [{"frame": 1, "translate": [0,0,0], "rotate": [0,0,0]},
      {"frame": 5, "translate": [4,0,-8], "rotate": [0,360,20]}])");
  for (const auto& [frame, still] : {std::pair{1.0, R"(, "scale": 2, "translate": [0,0,0])"},
                                     {2.0, R"(, "scale": 2, "translate": [1,0,-2], "rotate": [0,90,5])"},
                                     {3.0, R"(, "scale": 2, "translate": [2,0,-4], "rotate": [0,180,10])"},
                                     {7.0, R"(, "scale": 2, "translate": [4,0,-8], "rotate": [0,360,20])"}}) {
    EXPECT_EQ(at(moving, frame).objects.at(0).object_to_world,
              load(objectScene(still)).objects.at(0).object_to_world)
        << frame;
  }
}

TEST_F(SceneKeys, AnObjectThatPassesThroughNothingIsNotShownThere) {
  const std::string text = objectScene(R"(, "keys": [{"frame": 1, "scale": 1}, {"frame": 3, "scale": -1}])");
  Scene scene = load(text);
  EXPECT_EQ(test::sceneFault(scene), "");
  const std::uint32_t box = scene.objects[0].mesh;
  poseScene(scene, 2);
  EXPECT_TRUE(scene.meshes[scene.objects[0].mesh].triangles.empty());
  poseScene(scene, 3);
  EXPECT_EQ(scene.objects[0].mesh, box);
  EXPECT_EQ(scene.objects[0].object_to_world[0][0], -1);
}

TEST_F(SceneKeys, APoseDoesNotDependOnEarlierOnes) {
  const std::string text = R"({
    "camera": {"eye": [0,0,5], "target": [0,0,0], "interpolation": "smooth",
               "keys": [{"frame": 1, "eye": [0,0,5]}, {"frame": 4, "eye": [3,1,5]}, {"frame": 9, "eye": [0,4,2], "fov_y": 20}]},
    "objects": [{"primitive": "box", "keys": [{"frame": 1, "scale": 1}, {"frame": 9, "rotate": [10,20,30], "scale": 3}]}],
    "lights": [{"type": "point", "position": [0,0,0], "keys": [{"frame": 1, "color": 1}, {"frame": 9, "color": [0,1,0]}]}]})";
  Scene walked = load(text);
  for (const double frame : {9.0, 2.5, 1.0, 7.0, 6.5}) {
    poseScene(walked, frame);
    const Scene alone = at(text, frame);
    EXPECT_EQ(walked.cameras[0].camera_to_world, alone.cameras[0].camera_to_world);
    EXPECT_EQ(walked.cameras[0].fov_y, alone.cameras[0].fov_y);
    EXPECT_EQ(walked.objects[0].object_to_world, alone.objects[0].object_to_world);
    expectEqualLights(walked.lights[0], alone.lights[0], "");
  }
}

TEST_F(SceneKeys, ASceneIsLoadedAtFrame1AndAStillOneHasNoAnimation) {
  const Scene scene = load(
      lightScene(R"("type": "point", "position": [7,7,7], "keys": [{"frame": 1, "position": [1,0,0]}])"));
  EXPECT_EQ(scene.lights[0].position, glm::dvec3(1, 0, 0));
  const Scene still =
      load(R"({"camera": {"eye": [0,0,5], "target": [0,0,0]}, "objects": [{"primitive": "box"}],
      "lights": [{"type": "point", "position": [7,7,7]}]})");
  EXPECT_TRUE(still.animation.nodes.empty() && still.animation.curves.empty() &&
              still.animation.objects.empty() && still.animation.cameras.empty() &&
              still.animation.lights.empty());
  EXPECT_EQ(still.meshes.size(), 1u);
}

TEST_F(SceneKeys, FaultsNameTheirPlace) {
  const std::string eye = R"("eye": [0,0,5], "target": [0,0,0], )";
  const std::string point = R"("type": "point", "position": [0,0,0], )";
  const std::pair<std::string, const char*> cases[]{
      {cameraScene(eye + R"("keys": [])"), "scene.json: camera.keys: expected one key or more"},
      {cameraScene(eye + R"("keys": {})"), "scene.json: camera.keys: expected an array"},
      {cameraScene(eye + R"("keys": [7])"), "scene.json: camera.keys[0]: expected an object"},
      {cameraScene(eye + R"("keys": [{"eye": [1,1,1]}])"),
       "scene.json: camera.keys[0]: \"frame\" is missing"},
      {cameraScene(eye + R"("keys": [{"frame": 3}])"), "scene.json: camera.keys[0]: says nothing"},
      {cameraScene(eye + R"("keys": [{"frame": "a", "fov_y": 3}])"),
       "scene.json: camera.keys[0].frame: expected"},
      {cameraScene(eye + R"("keys": [{"frame": 1e300, "fov_y": 3}])"),
       "scene.json: camera.keys[0].frame: expected"},
      {cameraScene(eye + R"("keys": [{"frame": 2, "fov_y": 3}, {"frame": 2, "fov_y": 4}])"),
       "scene.json: camera.keys[1].frame: expected a frame after 2, got 2"},
      {cameraScene(eye + R"("keys": [{"frame": 2, "eyes": [1,1,1]}])"),
       "scene.json: camera.keys[0]: unknown key \"eyes\" (did you mean \"eye\"?)"},
      {cameraScene(eye + R"("keys": [{"frame": 2, "near": 1}])"),
       "scene.json: camera.keys[0]: unknown key \"near\""},
      {cameraScene(eye + R"("keys": [{"frame": 2, "fov_y": 180}])"),
       "scene.json: camera.keys[0].fov_y: expected degrees"},
      {cameraScene(eye + R"("keys": [{"frame": 2, "orbit": [0,0,5]}])"),
       "scene.json: camera.keys[0]: unknown key \"orbit\""},
      {cameraScene(eye + R"("orthographic": 2, "keys": [{"frame": 2, "fov_y": 3}])"),
       "scene.json: camera.keys[0].fov_y: means nothing"},
      {cameraScene(eye + R"("interpolation": "smooth")"),
       "scene.json: camera.interpolation: means nothing without keys"},
      {cameraScene(eye + R"("interpolation": "bouncy", "keys": [{"frame": 2, "fov_y": 3}])"),
       "scene.json: camera.interpolation: expected \"linear\" or \"smooth\""},
      {cameraScene(eye + R"("keys": [{"frame": 2, "eye": [0,5,0]}])"),
       "scene.json: camera.keys[0]: up is parallel"},
      {cameraScene(eye + R"("keys": [{"frame": 1, "fov_y": 9}, {"frame": 2, "eye": [0,0,0]}])"),
       "scene.json: camera.keys[0]: eye and target are the same point"},
      {cameraScene(R"("orbit": [0,91,5], "target": [0,0,0])"),
       "scene.json: camera.orbit[1]: expected an elevation"},
      {cameraScene(R"("orbit": [0,9,0], "target": [0,0,0])"),
       "scene.json: camera.orbit[2]: expected a number above 0"},
      {cameraScene(R"("orbit": [0,9,1], "eye": [0,0,1], "target": [0,0,0])"),
       "scene.json: camera.eye: means nothing beside orbit"},
      {cameraScene(R"("target": [0,0,0])"), "scene.json: camera: \"eye\" is missing"},
      {lightScene(point + R"("keys": [{"frame": 2, "direction": [1,0,0]}])"),
       "scene.json: lights[0].keys[0].direction: means nothing for a light without its own \"direction\""},
      {lightScene(point + R"("keys": [{"frame": 2, "range": 0}])"),
       "scene.json: lights[0].keys[0].range: expected a number above 0"},
      {lightScene(point + R"("keys": [{"frame": 2, "intensity": -1}])"),
       "scene.json: lights[0].keys[0].intensity: expected"},
      {lightScene(point + R"("diffuse": 1, "keys": [{"frame": 2, "color": 1}])"),
       "scene.json: lights[0].keys[0].color: means nothing"},
      {lightScene(point + R"("keys": [{"frame": 2, "position": [1,1]}])"),
       "scene.json: lights[0].keys[0].position: expected an array of 3"},
      {lightScene(point + R"("enabled": false, "keys": [{"frame": 2, "shadow": true}])"),
       "scene.json: lights[0].keys[0]: unknown key"},
      {lightScene(R"("type": "directional", "direction": [0,1,0], "keys": [{"frame": 2, "range": 3}])"),
       "scene.json: lights[0].keys[0].range: means nothing"},
      {lightScene(
           R"("type": "spot", "position": [0,4,0], "target": [0,0,0], "cutoff": 20, "keys": [{"frame": 2, "position": [0,0,0]}])"),
       "scene.json: lights[0].keys[0]: is the light's position"},
      {objectScene(R"(, "keys": [{"frame": 2, "scale": 0}])"),
       "scene.json: objects[0].keys[0].scale: a factor is 0"},
      {objectScene(R"(, "keys": [{"frame": 2, "material": "x"}])"),
       "scene.json: objects[0].keys[0]: unknown key"},
      {objectScene(R"(, "keys": [{"frame": 2, "rotate": [1e19,0,0]}])"),
       "scene.json: objects[0].keys[0].rotate[0]: expected"},
      {R"({"frame_rate": 0})", "scene.json: frame_rate: expected a number above 0"},
  };
  for (const auto& [text, what] : cases) EXPECT_THAT(refusal(text), StartsWith(what)) << text;
}

TEST_F(SceneKeys, APoseThatThereIsNotNamesItsFrame) {
  // Between its keys the camera flies over its target, the light turns round, the spot meets what it shines
  // at.
  const std::string turning = R"("frame": 1, "direction": [0,-1,0]}, {"frame": 5, "direction": [0,1,0])";
  const std::pair<std::string, const char*> cases[]{
      {R"({"cameras": {"crane": {"eye": [0,5,2], "target": [0,0,0],
          "keys": [{"frame": 1, "eye": [0,5,2]}, {"frame": 5, "eye": [0,5,-2]}]}}})",
       "scene.json: camera 'crane' at frame 3: up is parallel"},
      {lightScene(R"("type": "directional", "direction": [0,1,0], "keys": [{)" + turning + "}]"),
       "scene.json: light 0 at frame 3: it turns"},
      {lightScene(R"("type": "spot", "position": [0,4,0], "target": [0,0,0], "cutoff": 20,
          "keys": [{"frame": 1, "position": [1,0,0]}, {"frame": 5, "position": [-1,0,0]}])"),
       "scene.json: light 0 at frame 3: is the light's position"},
  };
  for (const auto& [text, what] : cases) {
    Scene scene = load(text);
    EXPECT_NO_THROW(poseScene(scene, 2.5)) << text;
    EXPECT_THAT(refusal([&] { poseScene(scene, 3); }), StartsWith(what));
    EXPECT_NO_THROW(poseScene(scene, 4)) << text;
  }
}

}  // namespace
}  // namespace luciole
