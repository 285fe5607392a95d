// The picture is the same to the last bit however lights are culled, on however many threads, in every run.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <cstring>

#include "kernels/probe.hpp"
#include "long_run.hpp"
#include "luciole/image.hpp"
#include "pictures/scene_hunt.hpp"
#include "render_json.hpp"
#include "scene/models.hpp"
#include "tools/cli/run_program.hpp"

namespace luciole::test {
namespace {

/// By bits, so that −0 is not 0.
bool sameBits(const Image& a, const Image& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)) == 0;
}

/// Every tile size, and the usual one once more, against no culling.
void expectCullingChangesNoBit(const Scene& scene, RenderSettings settings) {
  settings.shade.culling = Culling::kNone;
  const Image all = picture(scene, settings);
  settings.shade.culling = Culling::kTiles;
  for (const int tile_size : {4, 8, 16, 4}) {
    settings.shade.tile_size = tile_size;
    EXPECT_TRUE(sameBits(picture(scene, settings), all)) << "tiles of " << tile_size;
  }
}

/// The same, of the whole picture and of parts whose tiles lie otherwise on it.
void expectCullingChangesNoBitOfAnyPart(const Scene& scene, glm::ivec2 size) {
  RenderSettings settings = settingsFor(scene, size);
  expectCullingChangesNoBit(scene, settings);
  for (const Crop& crop : {Crop{7, 3, size.x / 2, size.y / 2}, {size.x - 37, size.y - 23, 37, 23}}) {
    settings.crop = crop;
    expectCullingChangesNoBit(scene, settings);
  }
}

/// All but colonnade_night: each of its 200,000 lights has a shadow in each pixel.
std::vector<std::string> ownScenes() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(LUCIOLE_SOURCE_DIR "/scenes"))
    if (entry.path().extension() == ".json" && !entry.path().stem().has_extension())  // not scene.schema.json
      names.push_back(entry.path().stem().string());
  std::erase(names, "colonnade_night");
  std::sort(names.begin(), names.end());
  return names;
}

class ExactScene : public testing::TestWithParam<std::string> {
 protected:
  static std::string file() { return fmt::format(LUCIOLE_SOURCE_DIR "/scenes/{}.json", GetParam()); }

  /// Smallest for lanterns, of which each of hundreds of thousands lights every pixel.
  static glm::ivec2 pictureSize(const Scene& scene) {
    return longRun()                       ? glm::ivec2(160, 90)
           : scene.lights.size() > 100'000 ? glm::ivec2(48, 27)
                                           : glm::ivec2(112, 63);
  }
};

TEST_P(ExactScene, CullingChangesNoBit) {
  const Scene scene = loadScene(file());
  expectCullingChangesNoBitOfAnyPart(scene, pictureSize(scene));
}

TEST_P(ExactScene, ThreadsAndRunsChangeNoBit) {
  // The rasterizer has as many threads as there are processors to run on.
  cpu_set_t allowed;
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  int processor = 0;
  while (!CPU_ISSET(processor, &allowed)) ++processor;
  const TemporaryFolder folder;
  const glm::ivec2 size = pictureSize(loadScene(file()));
  const std::string render =
      fmt::format("'" LUCIOLE_BINARY "' render '{}' --quiet --size {}x{} -o ", file(), size.x, size.y);
  const Outcome outcome = runLine(
      folder,
      fmt::format("POCL_MAX_PTHREAD_COUNT=1 taskset -c {} {}one.exr && POCL_MAX_PTHREAD_COUNT=2 {}two.exr",
                  processor, render, render));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(sameBits(readImage(folder / "one.exr"), readImage(folder / "two.exr")));
}

INSTANTIATE_TEST_SUITE_P(Own, ExactScene, testing::ValuesIn(ownScenes()),
                         [](const auto& scene) { return scene.param; });

/// Lights around what the camera sees, without ambient light, which would light what faces away, too.
void addLights(int count, Scene& scene, Random& random) {
  const Camera& camera = scene.cameras.front();
  Stats stats;
  RenderSettings settings = settingsFor(scene, {40, 24});
  const Image seen = [&] {
    settings.aovs = {Aov::kPosition};
    Scene unlit = scene;
    unlit.lights.clear();
    return picture(unlit, settings);
  }();
  while (count > 0) {
    const float* at = &seen.pixels[std::size_t(random.below(40 * 24)) * seen.channels.size() + 3];
    const glm::dvec3 point(at[0], at[1], at[2]);
    if (point == glm::dvec3(0)) continue;  // background
    const double size = 0.3 * glm::length(point - glm::dvec3(camera.camera_to_world[3]));
    Light light = randomLight(camera, random);
    light.position = point + size * random.direction();
    light.ambient = glm::vec3(0);
    if (std::isfinite(light.range)) light.range = float(size * random.between(0.2, 2));
    light.attenuation = {1, 0, 0};
    scene.lights.push_back(light);
    --count;
  }
}

class ExactSharedScene : public testing::TestWithParam<const char*> {};

TEST_P(ExactSharedScene, CullingChangesNoBit) {
  LUCIOLE_NEEDS_SHARED();
  Scene scene = loadScene((sharedScenes() / GetParam()).string());
  Random random(6);
  addLights(60, scene, random);
  expectCullingChangesNoBit(scene, settingsFor(scene, {160, 90}));
}

INSTANTIATE_TEST_SUITE_P(Shared, ExactSharedScene,
                         testing::Values("sponza_crytek_obj/sponza.obj", "quake_e1m1/e1m1.gltf",
                                         "utah_teapot/teapot.obj"),
                         [](const auto& file) {
                           return std::string(file.param, std::strchr(file.param, '_'));
                         });

/// A random scene (see random_scene_file.hpp) of one of the first two kinds, in which
/// no light gives ambient light, so that culling may go by the way that surfaces face; everything is `scale`
/// times as large.
Scene randomScene(unsigned seed, double scale) {
  constexpr unsigned kKinds = std::size(kSceneKinds);
  SceneJson json = randomSceneFile(seed / 2 * kKinds + seed % 2);
  for (SceneJson& light : json["lights"]) light.erase("ambient");
  const auto stretch = [&](SceneJson& vector) {
    for (SceneJson& component : vector) component = scale * component.get<double>();
  };
  const auto stretchNumber = [&](SceneJson& parent, const char* key) {
    if (parent.contains(key)) parent[key] = scale * parent[key].get<double>();
  };
  SceneJson& camera = json["camera"];
  stretch(camera["eye"]);
  stretch(camera["target"]);
  camera["near"] = 1e-3 * scale;
  for (const char* key : {"far", "orthographic"}) stretchNumber(camera, key);
  if (json.contains("fog"))
    for (const char* key : {"start", "end"}) stretchNumber(json["fog"], key);
  for (SceneJson& object : json["objects"]) {
    stretch(object["translate"]);
    if (object["scale"].is_array()) {
      stretch(object["scale"]);
    } else {
      stretchNumber(object, "scale");
    }
  }
  for (SceneJson& light : json["lights"]) {
    if (light.contains("position")) stretch(light["position"]);
    stretchNumber(light, "range");
    if (light.contains("attenuation")) light.erase("attenuation");
  }
  json["lights"][0]["attenuation"] = {1, 0, 0.1 / scale / scale};
  return sceneFromJson(json.dump());
}

TEST(Exact, CullingChangesNoBitOfRandomScenesOfAnySize) {
  unsigned seed = firstSeed();
  for (const double scale : {1.0, 1e-6, 1e7, 1.0, 1e-3, 1e3})
    for (int i = 0; i < (longRun() ? 5 : 3); ++i, ++seed) {
      SCOPED_TRACE(fmt::format("seed {}, scale {}", seed, scale));
      const Scene scene = randomScene(seed, scale);
      RenderSettings settings = settingsFor(scene, *scene.size);
      settings.shade.model = kAllModels[seed % std::size(kAllModels)];
      expectCullingChangesNoBit(scene, settings);
    }
}

/// A floor and a ball on it, with no lights.
constexpr const char* kExactFloor =
    R"({"camera": {"eye": [1.1, 1.3, 5.7], "target": [0.1, 0.2, 0.3], "up": [0.1, 1, 0.2]},
  "materials": {"m": {"diffuse": 0.8, "specular": 0.5, "shininess": 20}},
  "objects": [{"primitive": "plane", "scale": 30, "material": "m"}, {"primitive": "sphere", "translate": [0.3, 1, 0.2], "material": "m"}]})";

/// A lamp like nothing but a point: no range, no attenuation.
Light lampAt(const glm::dvec3& position, float brightness) {
  Light light;
  light.position = position;
  light.diffuse = light.specular = glm::vec3(brightness);
  return light;
}

// Bright lamps as high above a floor, or below it, as roundings lift or lower it: it looks up to some of them
// by no more than that, and shows it.
TEST(Exact, CullingChangesNoBitOfAFloorThatLampsGraze) {
  Scene scene = sceneFromJson(kExactFloor);
  Random random(12);
  for (int i = 0; i < 120; ++i) {
    const double height =
        (random.chance(0.7) ? 1 : -1) * std::exp(random.between(std::log(1e-9), std::log(1e-4)));
    const glm::dvec3 place(random.between(-6, 6), height, random.between(-6, 3));
    scene.lights.push_back(lampAt(place, 1e5f));
    if (i % 3 == 0) {
      Light& spot = scene.lights.back();
      spot.kind = LightKind::kSpot;
      spot.direction = random.direction();
      spot.cutoff = random.between(0.2, 1.57);
    } else if (i % 3 == 1) {
      Light& sun = scene.lights.back();
      sun.kind = LightKind::kDirectional;
      sun.direction = -glm::normalize(glm::dvec3(place.x, height, place.z));
    }
  }
  expectCullingChangesNoBitOfAnyPart(scene, {121, 83});
}

// Spots that shine along surfaces and through them, from narrower than a float's cosine tells to all around.
TEST(Exact, CullingChangesNoBitUnderSpotsOfAnyWidth) {
  Scene scene = sceneFromJson(kExactFloor);
  Random random(2);
  for (int i = 0; i < 120; ++i) {
    Light spot = lampAt({random.between(-4, 4), random.between(-0.5, 4), random.between(-4, 4)}, 100);
    spot.kind = LightKind::kSpot;
    spot.direction = random.direction();
    spot.cutoff = std::array{0.0, 1e-4, 0.01, 0.2, 0.8, 1.5707, glm::radians(90.0), 2.0, 3.14159}[i % 9];
    spot.exponent = i % 2 ? 3.0f : 0.0f;
    scene.lights.push_back(spot);
  }
  expectCullingChangesNoBitOfAnyPart(scene, {121, 83});
}

// Sums are added up in blocks of kSumBlock lights. Here pixels have just so many, and twice and thrice, among
// lights that add nothing, which are left out of lists: so that the last term stands at another place of the
// few lights that a kernel takes side by side.
TEST(Exact, LightsThatAddNothingCloseNoBlockOfASum) {
  Random random(3);
  const auto lampAtHeight = [&](double height) {
    return lampAt({random.between(-6, 6), height, random.between(-6, 6)}, float(random.between(0.01, 1)));
  };
  for (const int blocks : {3, 4}) {
    Scene scene = sceneFromJson(kExactFloor);
    scene.objects.pop_back();
    scene.lights.push_back(lampAtHeight(-1));
    for (int i = 0; i < blocks * kSumBlock; ++i) scene.lights.push_back(lampAtHeight(random.between(0.5, 4)));
    for (int i = 0; i < 40; ++i) scene.lights.push_back(lampAtHeight(-1));
    const RenderSettings settings = settingsFor(scene, {53, 37});
    SCOPED_TRACE(fmt::format("{} blocks", blocks));
    expectCullingChangesNoBit(scene, settings);
    for (const int lanes : widths())
      EXPECT_TRUE(sameBits(picture(scene, settings, deviceWithLanes(lanes)), picture(scene, settings)))
          << lanes << " lanes";
  }
}

}  // namespace
}  // namespace luciole::test
