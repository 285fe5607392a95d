// luciole generate lights: the density that it promises, of every shape, and the camera that it is promised
// for.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "luciole/image.hpp"
#include "luciole/load_scene.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

/// A quadrangle seen from its front, corners counter-clockwise.
void addQuad(const std::string& a, const std::string& b, const std::string& c, const std::string& d,
             std::string& obj) {
  for (const std::string& corner : {a, b, c, d}) obj += "v " + corner + "\n";
  obj += "f -4 -3 -2 -1\n";
}

/// The box from low to high, its sides seen from inside or from outside.
void addBox(const glm::vec3& low, const glm::vec3& high, bool inside, std::string& obj) {
  const auto corner = [&](int i) {
    return fmt::format("{} {} {}", i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
  };
  constexpr int kSides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& s : kSides)
    inside ? addQuad(corner(s[3]), corner(s[2]), corner(s[1]), corner(s[0]), obj)
           : addQuad(corner(s[0]), corner(s[1]), corner(s[2]), corner(s[3]), obj);
}

/// A hall of 40 × 10 × 16 m whose columns stand at odd places, so that each place in it shows something else.
std::string hallObj() {
  std::string obj;
  addBox({0, 0, 0}, {40, 10, 16}, true, obj);
  for (int i = 0; i < 9; ++i) {
    const float x = 3.0f + 4.1f * float(i), z = 2.0f + float((7 * i) % 12);
    addBox({x, 0, z}, {x + 0.4f + 0.1f * float(i % 3), 10, z + 0.5f}, false, obj);
  }
  return obj;
}

/// A landscape of boxes, looked at from outside, without a camera of its own.
constexpr const char* kBoxes = R"({"objects": [{"primitive": "plane", "scale": [12, 1, 9]},
  {"primitive": "box", "translate": [2, 0.5, 1]}, {"primitive": "box", "scale": [1, 3, 1], "translate": [-3, 1.5, -2]},
  {"primitive": "sphere", "translate": [-1, 1, 2]}], "size": [320, 180],
  "lights": [{"type": "point", "position": [0, 5, 0]}]})";

class Generate : public ProgramTest {
 protected:
  Generate() {
    writeText(folder / "hall.obj", hallObj());
    writeText(folder / "small.json", kSmallScene);
    writeText(folder / "boxes.json", kBoxes);
    std::string csv;
    for (int i = 0; i < 500; ++i)
      csv +=
          fmt::format("{},{},{},1,1,1,2\n", (37 * i) % 400 * 0.1, (11 * i) % 90 * 0.1, (23 * i) % 160 * 0.1);
    writeText(folder / "lamps.csv", csv);
  }

  /// Of the lights in range of each pixel that shows something.
  struct Count {
    double mean, deviation;
  };
  Count lightsInRange(const std::string& scene) {
    succeed("luciole render " + scene + " --quiet --size 160x90 --aov depth,light_count -o counted.exr");
    const Image image = readImage(folder / "counted.exr");
    const auto channel = [&](const char* name) {
      return std::size_t(std::find(image.channels.begin(), image.channels.end(), name) -
                         image.channels.begin());
    };
    const std::size_t depth = channel("Z"), lights = channel("light_count"), step = image.channels.size();
    double pixels = 0, sum = 0, squares = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += step) {
      if (std::isinf(image.pixels[i + depth])) continue;
      const double count = image.pixels[i + lights];
      pixels += 1;
      sum += count;
      squares += count * count;
    }
    const double mean = sum / pixels;
    return {mean, std::sqrt(std::max(squares / pixels - mean * mean, 0.0))};
  }
};

TEST_F(Generate, EveryShapeHasItsDensityInThePictureOfAMeshAndOfAScene) {
  for (const char* scene : {"hall.obj", "small.json", "boxes.json"}) {
    for (const char* shape : {"--shape box", "--shape ball", "--shape sphere", "--shape surface",
                              "--shape clusters", "--shape curve", "--csv lamps.csv"}) {
      const bool is_list = std::string(shape).starts_with("--csv");
      succeed(fmt::format("luciole generate lights {} {} {} --density 8 --seed 2 -o lit.json", scene, shape,
                          is_list ? "" : "--count 2000"));
      const Count count = lightsInRange("lit.json");
      // It was set at 1000 of these pixels: five standard errors of their mean, and the last of 8000 pairs.
      EXPECT_NEAR(count.mean, 8, 5 * count.deviation / std::sqrt(1000) + 1e-3) << scene << " " << shape;
    }
  }
}

TEST_F(Generate, AListsSpotsSunsAndAttenuationsAreKept) {
  writeText(folder / "list.csv",
            "x,y,z,r,g,b,constant,quadratic,dx,dy,dz,cutoff,exponent,inner_cone,outer_cone\n"
            "1,2,3,4,5,6,1,0.5,,,,,,,\n"
            "1,2,3,4,5,6,,,1,-2,0.3,33.3,7,,\n"
            "1,2,3,4,5,6,,,1,0,0,,,12.1,47.7\n"
            ",,,4,5,6,,,0,-1,1,,,,\n");
  succeed("luciole generate lights --csv list.csv -o lights.json");
  const std::vector<Light> lights = loadScene(folder / "lights.json", 1, {}).lights;
  ASSERT_EQ(lights.size(), 4u);
  EXPECT_EQ(lights[0].attenuation, glm::vec3(1, 0, 0.5f));
  EXPECT_EQ(lights[1].kind, LightKind::kSpot);
  EXPECT_EQ(lights[1].cutoff, glm::radians(33.3));
  EXPECT_EQ(lights[1].exponent, 7);
  EXPECT_NEAR(glm::length(lights[1].direction - glm::normalize(glm::dvec3(1, -2, 0.3))), 0, 1e-15);
  EXPECT_EQ(lights[2].falloff, SpotFalloff::kCone);
  EXPECT_EQ(lights[2].inner_cone, glm::radians(12.1));
  EXPECT_EQ(lights[2].cutoff, glm::radians(47.7));
  EXPECT_EQ(lights[3].kind, LightKind::kDirectional);
  for (const Light& light : lights) EXPECT_EQ(light.diffuse, glm::vec3(4, 5, 6));
  refuse("luciole generate lights small.json --csv list.csv --density 4 -o x.json", 2,
         "--density: a directional light of list.csv has no place to fade from");
}

TEST_F(Generate, LightsWithoutRangeAreAsBrightAsLightsWithWhateverTheCount) {
  for (const char* shape : {"box", "clusters", "surface"}) {
    double first = 0;
    for (const int count : {300, 3000}) {
      const auto mean = [&](const char* option) {
        succeed(
            fmt::format("luciole generate lights hall.obj --shape {} --color 1,1,1 --count {} --seed 3 {} -o "
                        "lit.json && luciole render lit.json --quiet --size 96x54 --aov depth -o lit.exr",
                        shape, count, option));
        const Image image = readImage(folder / "lit.exr");
        double sum = 0;
        for (std::size_t i = 0; i < image.pixels.size(); i += image.channels.size()) sum += image.pixels[i];
        return sum;
      };
      const double ranged = mean(""), everywhere = mean("--no-range");
      // What arrives is the same on average. What surfaces make of it depends on the angle: a surface gets
      // from a quarter (light from all sides) to all of it (from the front), with ranges and without.
      EXPECT_LT(everywhere, 4 * ranged) << shape << count;
      EXPECT_GT(everywhere, ranged / 4) << shape << count;
      if (first == 0) first = everywhere;
      EXPECT_NEAR(everywhere / first, 1, 0.5) << shape;
    }
  }
}

TEST_F(Generate, TheFileHasTheCameraThatTheLightsWereMadeFor) {
  for (const char* file : {"hall.obj", "boxes.json"}) {
    const Camera seen = loadScene(folder / file).cameras.front();
    for (const char* shape : {"box", "clusters", "surface"}) {
      succeed(fmt::format(
          "mkdir -p sub && luciole generate lights {} --shape {} --count 3000 -o sub/lit.json", file, shape));
      ASSERT_TRUE(nlohmann::json::parse(readText(folder / "sub/lit.json")).contains("camera")) << file;
      const Camera written = loadScene(folder / "sub/lit.json").cameras.front();
      // The direction and two axes are made again from rounded numbers: each some 10 operations of 2^-53.
      for (int i = 0; i < 3; ++i)
        EXPECT_LT(glm::distance(written.camera_to_world[i], seen.camera_to_world[i]), 20 * 0x1p-53) << file;
      EXPECT_EQ(written.camera_to_world[3], seen.camera_to_world[3]) << file;
      EXPECT_NEAR(written.fov_y, seen.fov_y, 4 * 0x1p-53 * seen.fov_y) << file;
      EXPECT_EQ(written.near, seen.near) << file;
      EXPECT_EQ(written.far, seen.far) << file;
    }
  }
}

TEST_F(Generate, CamerasOfTheSceneStay) {
  succeed("luciole generate lights small.json --count 10 -o lit.json");
  EXPECT_EQ(loadScene(folder / "lit.json").cameras.front().camera_to_world,
            loadScene(folder / "small.json").cameras.front().camera_to_world);
}

TEST_F(Generate, LightFieldsOverAMeshDoNotMoveItsCamera) {
  writeText(folder / "bare.json", R"({"objects": [{"mesh": "hall.obj"}]})");
  writeText(folder / "field.json", R"({"objects": [{"mesh": "hall.obj"}],
      "light_fields": [{"count": 3000, "seed": 1, "min": [0, 0, 0], "max": [40, 10, 16], "range": 1}]})");
  const glm::dmat4 seen = loadScene(folder / "hall.obj").cameras.front().camera_to_world;
  EXPECT_EQ(loadScene(folder / "bare.json").cameras.front().camera_to_world, seen);
  EXPECT_EQ(loadScene(folder / "field.json").cameras.front().camera_to_world, seen);
}

TEST_F(Generate, ThePictureOfAGltfOfManyLightsIsThatInDoublePrecision) {
  succeed(
      "luciole generate gltf-lights --count 200 --seed 2 -o many.glb && "
      "luciole reference many.glb --exposure 0 --size 320x180 --quiet -o truth.exr && "
      "luciole render many.glb --exposure 0 --size 320x180 --quiet -o ours.exr");
  const auto figures = nlohmann::json::parse(succeed("luciole compare truth.exr ours.exr --json -"));
  EXPECT_EQ(figures["pixels"], 320 * 180);
  // What is seen lies up to 100 m from the eye, where a light's place rounds by 2^-18 m along each axis at
  // most, so by e = 6.6e-6 m. No ball has a light nearer than d = 0.3 m, so light turns by e / d, and
  // 1 / d^2 changes by 2 e / d. A highlight cos^n t changes by n cos^(n-1) t sin t e / d <= 0.61 sqrt(n) e /
  // d of its peak, and n is 127 at a roughness of 0.25. That is 2e-4 of the brightest.
  EXPECT_LT(figures["max_relative"], 2e-4);
  EXPECT_LT(figures["mean_relative"], 1e-7);  // the program's promise
  EXPECT_GT(figures["max_abs"], 0);
}

TEST_F(Generate, AGltfOfLightsComesWithItsReferenceAndFigures) {
  succeed("luciole generate gltf-lights --count 30 --seed 2 -o many.glb --reference truth.exr");
  succeed("luciole reference many.glb --exposure 0 --quiet -o same.exr");
  EXPECT_EQ(readImage(folder / "truth.exr").pixels, readImage(folder / "same.exr").pixels);
  EXPECT_EQ(readImage(folder / "truth.png").width, 1280);
  succeed("luciole render many.glb --exposure 0 --quiet -o ours.exr");
  const auto told = nlohmann::json::parse(readText(folder / "truth.json")),
             figures = nlohmann::json::parse(succeed("luciole compare truth.exr ours.exr --json -"));
  EXPECT_EQ(told["count"], 30);
  for (const auto& [name, figure] : figures.items()) EXPECT_EQ(told[name], figure) << name;
}

TEST_F(Generate, AGltfOfManyLightsIsRefusedInALine) {
  for (const char* count : {"0", "-1", "1000001", "1e3", "99999999999999999999999"})
    refuse(fmt::format("luciole generate gltf-lights --count {} -o many.glb", count), 2, "--count");
  refuse("luciole generate gltf-lights -o many.obj", 2, ".glb or .gltf");
  refuse("luciole generate gltf-lights -o gone/many.gltf", 2, "no such folder");
  refuse("luciole generate gltf-lights -o many.glb --reference truth.png", 2, ".exr");
  refuse("luciole generate gltf-lights -o - --reference truth.exr", 2, "--reference");
  refuse("test ! -e many.glb && luciole generate gltf-lights", 2, "--output");
}

}  // namespace
}  // namespace luciole::test
