#include "pictures/scene_hunt.hpp"

#include <gtest/gtest.h>

#include "render_json.hpp"

namespace luciole::test {
namespace {

TEST(RandomSceneFile, EverySeedIsASceneThatLoads) {
  for (unsigned i = 0; i < 60; ++i) {
    for (const unsigned seed : {i, kFirstFreeSeed + i}) {
      const Scene scene = sceneFromJson(randomSceneFile(seed).dump());
      EXPECT_FALSE(scene.objects.empty()) << seed;
      if (seed < kFirstFreeSeed) {
        EXPECT_EQ(modelFor(*scene.size), kSceneKinds[seed % std::size(kSceneKinds)].model) << seed;
      }
    }
  }
}

TEST(RandomSceneFile, EqualSeedsMakeEqualScenes) {
  EXPECT_EQ(randomSceneFile(7).dump(), randomSceneFile(7).dump());
  EXPECT_NE(randomSceneFile(7).dump(), randomSceneFile(8).dump());
}

bool hasLight(const SceneJson& scene, double intensity) {
  if (!scene.contains("lights")) return false;
  for (const SceneJson& light : scene["lights"])
    if (light.value("intensity", 1.0) == intensity) return true;
  return false;
}

/// A scene that fails because two of its many lights are there.
SceneJson sceneWithCulprits() {
  SceneJson scene = randomSceneFile(2);
  for (unsigned seed = 3; scene["lights"].size() < 25; ++seed) {
    const SceneJson other = randomSceneFile(seed);
    for (const SceneJson& light : other["lights"]) scene["lights"].push_back(light);
  }
  scene["lights"][5]["intensity"] = 123.25;
  scene["lights"][18]["intensity"] = 77.5;
  return scene;
}

bool bothCulprits(const SceneJson& scene) { return hasLight(scene, 123.25) && hasLight(scene, 77.5); }

TEST(Shrink, LeavesTheTwoLightsThatMatterAndNothingElse) {
  const SceneJson smallest = shrink(sceneWithCulprits(), bothCulprits, 2000);
  EXPECT_EQ(smallest, (SceneJson{{"lights", {{{"intensity", 123.25}}, {{"intensity", 77.5}}}}}));
}

TEST(Shrink, NeverGivesASceneThatDoesNotFail) {
  for (const int steps : {0, 1, 7, 50})
    EXPECT_TRUE(bothCulprits(shrink(sceneWithCulprits(), bothCulprits, steps)));
}

TEST(Shrink, NumbersThatDoNotMatterBecomeSimple) {
  const SceneJson scene{{"lights", {{{"range", 2.375}, {"position", {1.4375, 3.625, -0.1}}}}}};
  const auto fails = [](const SceneJson& candidate) {
    const SceneJson& light = candidate.at("lights").at(0);
    return light.at("range") >= 2 && light.at("position").size() == 3 && light["position"][1] >= 3.55;
  };
  const Fails with_errors = [&](const SceneJson& candidate) {
    try {
      return fails(candidate);
    } catch (const SceneJson::exception&) {
      return false;
    }
  };
  EXPECT_EQ(shrink(scene, with_errors, 100),
            (SceneJson{{"lights", {{{"range", 2.0}, {"position", {0.0, 4.0, 0.0}}}}}}));
}

TEST(SceneHunt, FailureLeavesASceneFileThatFailsTheSameWay) {
  const auto failure = [](const SceneJson& json) -> std::optional<std::string> {
    const Scene scene = sceneFromJson(json.dump());
    if (scene.lights.size() < 3) return std::nullopt;
    return fmt::format("{} lights are too many", scene.lights.size());
  };
  const auto message = hunt({"HuntTest", "luciole render $SCENE -o a.png", failure}, 0, 5);
  ASSERT_TRUE(message);
  EXPECT_NE(message->find("shrunk: 3 lights are too many"), std::string::npos) << *message;
  EXPECT_NE(message->find("luciole render $SCENE"), std::string::npos) << *message;
  const std::size_t start = message->find("SCENE=") + 6;
  const std::string path = message->substr(start, message->find('\n', start) - start);
  EXPECT_EQ(loadScene(path).lights.size(), 3u) << path;
  std::filesystem::remove(path);
}

TEST(SceneHunt, IsSilentWhereThePropertyHolds) {
  EXPECT_EQ(hunt({"HuntTest", "", [](const SceneJson&) { return std::nullopt; }}, 0, 5), std::nullopt);
}

}  // namespace
}  // namespace luciole::test
