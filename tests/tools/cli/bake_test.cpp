// Light maps, as a person makes them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "luciole/image.hpp"
#include "luciole/load_scene.hpp"
#include "luciole/render.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

/// An OBJ in the making, of rectangles with charts of their own in an atlas.
struct Rectangles {
  int columns, rows;
  std::string text;
  int count = 0;

  /// The corner, the sides and the chart's place. Its normal is cross(u, v).
  void add(const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v) {
    const glm::dvec3 normal = glm::normalize(glm::cross(u, v));
    const double margin = 0.05;
    const int column = count % columns, row = count / columns;
    for (const auto& [a, b] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
      const glm::dvec3 p = corner + double(a) * u + double(b) * v;
      text += fmt::format("v {} {} {}\nvn {} {} {}\nvt {} {}\n", p.x, p.y, p.z, normal.x, normal.y, normal.z,
                          (column + margin + (1 - 2 * margin) * a) / columns,
                          (row + margin + (1 - 2 * margin) * b) / rows);
    }
    const auto corners = [&](int i, int j, int k) {
      std::string face = "f";
      for (const int corner_of : {i, j, k}) face += fmt::format(" {0}/{0}/{0}", 4 * count + corner_of);
      return face + "\n";
    };
    text += corners(1, 2, 3) + corners(1, 3, 4);
    ++count;
  }
};

class BakeCommand : public ProgramTest {
 protected:
  /// A room of 4 × 3 × 4 m and a block in it.
  void writeRoom() const {
    Rectangles room{4, 3, "mtllib room.mtl\nusemtl wall\n"};
    const glm::dvec3 x(4, 0, 0), y(0, 3, 0), z(0, 0, 4), low(-2, 0, -2);
    for (const auto& [corner, u, v] :
         {std::tuple(low, x, y), {low, z, x}, {low, y, z}, {low + z, y, x}, {low + x, z, y}, {low + y, x, z}})
      room.add(corner, u, v);
    const glm::dvec3 bx(1, 0, 0), by(0, 1, 0), bz(0, 0, 1), block(-0.7, 0.01, -0.7);
    for (const auto& [corner, u, v] : {std::tuple(block + bz, bx, by),
                                       {block + by, bz, bx},
                                       {block + bx, by, bz},
                                       {block, by, bx},
                                       {block, bz, by}})
      room.add(corner, u, v);
    writeText(folder / "room.obj", room.text);
    writeText(folder / "room.mtl", "newmtl wall\nKd 0.7 0.65 0.5\nKa 0.2 0.2 0.2\nKs 0 0 0\n");
    for (const bool lit : {true, false})
      writeText(folder / (lit ? "lit.json" : "unlit.json"),
                fmt::format(R"(
          {{"camera": {{"eye": [1.7, 2.2, 1.8], "target": [-0.5, 0.8, -0.5], "fov_y": 60}}, "size": [192, 108],
            "ambient": {}, "objects": [{{"mesh": "{}", "name": "room"}}], "lights": [{}]}})",
                            lit ? 0.1 : 0.0, lit ? "room.obj" : "room.glb",
                            lit ? R"(
          {"type": "point", "position": [1.2, 2.5, -0.5], "color": [3, 2.6, 2], "attenuation": [1, 0, 0.7], "shadow": true},
          {"type": "spot", "position": [-1.5, 2.7, 1.5], "target": [0, 0, 0], "cutoff": 35, "color": [1, 1.5, 3],
           "attenuation": [1, 0, 0.2], "shadow": true})"
                                : ""));
  }

  /// A square of 2 m that faces up, below a lamp 1 m above its middle.
  void writeFloor(const std::string& uvs = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n",
                  const char* faces = "1/1 2/2 3/3 4/4") const {
    writeText(folder / "floor.obj",
              fmt::format("mtllib floor.mtl\nusemtl floor\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\n{}f {}\n",
                          uvs, faces));
    writeText(folder / "floor.mtl", "newmtl floor\nKd 0.5 0.25 0.125\nKa 0 0 0\nKs 0.4 0.4 0.4\nNs 8\n");
    writeText(
        folder / "floor.json",
        R"({"camera": {"eye": [0, 2, 3], "target": [0, 0, 0]}, "ambient": 0, "fog": {"mode": "exp", "density": 1, "color": 1},
                  "objects": [{"mesh": "floor.obj", "name": "floor"}],
                  "lights": [{"type": "point", "position": [0, 1, 0], "color": 2, "attenuation": [0, 0, 1]}]})");
  }
};

/// The middle of a texel of a map of the floor of n × n.
glm::dvec3 placeOf(int x, int y, int n) { return {(x + 0.5) * 2 / n - 1, 0, (y + 0.5) * 2 / n - 1}; }

/// Of the lamp: cos θ / d², and Phong's cosine to the power of 8 over d² towards an eye.
double diffuseAt(const glm::dvec3& place) {
  const glm::dvec3 way = glm::dvec3(0, 1, 0) - place;
  return way.y / glm::length(way) / glm::dot(way, way);
}
double highlightAt(const glm::dvec3& place, const glm::dvec3& eye) {
  const glm::dvec3 way = glm::dvec3(0, 1, 0) - place, to_light = glm::normalize(way);
  const glm::dvec3 mirrored(-to_light.x, to_light.y, -to_light.z);
  return std::pow(std::max(0.0, glm::dot(mirrored, glm::normalize(eye - place))), 8) / glm::dot(way, way);
}

// Pictures are within 1e-5 of double precision.
constexpr double kError = 1e-5;

TEST_F(BakeCommand, EachTexelIsTheLightAtItsPlaceAndFogIsNone) {
  writeFloor();
  succeed("luciole bake floor.json --object floor --size 20x20 --quiet -o map.exr");
  succeed("luciole bake floor.json --object floor --size 20x20 --irradiance --quiet -o light.exr");
  succeed("luciole bake floor.json --object floor --size 20x20 --eye 0.5 1.5 1 --quiet -o seen.exr");
  const Image map = readImage(folder / "map.exr"), light = readImage(folder / "light.exr"),
              seen = readImage(folder / "seen.exr");
  ASSERT_EQ(map.width, 20);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) {
      const glm::dvec3 place = placeOf(x, y, 20);
      for (int c = 0; c < 3; ++c) {
        const std::size_t i = 3 * (20 * std::size_t(y) + std::size_t(x)) + std::size_t(c);
        const double diffuse = 2 * diffuseAt(place), reflected = diffuse * 0.5 / (1 << c);
        EXPECT_NEAR(map.pixels[i], reflected, kError) << x << " " << y;
        EXPECT_NEAR(light.pixels[i], diffuse, kError) << x << " " << y;
        EXPECT_NEAR(seen.pixels[i], reflected + 2 * 0.4 * highlightAt(place, {0.5, 1.5, 1}), kError)
            << x << " " << y;
      }
    }
}

TEST_F(BakeCommand, TheLibraryMakesTheSameBits) {
  writeFloor();
  succeed("luciole bake floor.json --object floor --size 33x20 --eye 0.5 1.5 1 --quiet -o seen.exr");
  Device device = Device::open();
  const Scene scene = loadScene(folder / "floor.json");
  RenderSettings settings{.size{33, 20}};
  settings.shade.shadows = ShadowMethod::kAuto;
  const Picture map = bakeLight(device, scene, 0, {.eye = glm::dvec3(0.5, 1.5, 1)}, settings);
  EXPECT_EQ(map.image.pixels, readImage(folder / "seen.exr").pixels);
}

/// A pixel's three numbers from a channel on.
glm::dvec3 numbersAt(const Image& image, int x, int y, std::size_t first) {
  const float* pixel = image.pixels.data() + std::size_t(y * image.width + x) * image.channels.size() + first;
  return {pixel[0], pixel[1], pixel[2]};
}

/// The least and the most light in the 5 x 5 pixels around one; nothing where they leave the picture, or show
/// another plane as well. The picture's channels are light, position and normal.
std::optional<std::pair<glm::dvec3, glm::dvec3>> rangeAround(const Image& lit, int x, int y) {
  if (x < 2 || y < 2 || x + 2 >= lit.width || y + 2 >= lit.height) return std::nullopt;
  const glm::dvec3 position = numbersAt(lit, x, y, 3), normal = numbersAt(lit, x, y, 6);
  std::pair<glm::dvec3, glm::dvec3> range(glm::dvec3(1e30), glm::dvec3(-1e30));
  for (int near_y = y - 2; near_y <= y + 2; ++near_y)
    for (int near_x = x - 2; near_x <= x + 2; ++near_x) {
      if (std::abs(glm::dot(numbersAt(lit, near_x, near_y, 3) - position, normal)) > 1e-3)
        return std::nullopt;
      const glm::dvec3 light = numbersAt(lit, near_x, near_y, 0);
      range = {glm::min(range.first, light), glm::max(range.second, light)};
    }
  return range;
}

// A pixel looks texels up that are at most 18 mm wide, so it shows light from within a texel or two, which is
// less than two pixels here: each value lies between those of the lit picture around it, where no edge hides
// some of these places. Only the codes round, by half a step of 8-bit sRGB, which is 1.14 / 255 of the
// brightest at most. So does the mean.
TEST_F(BakeCommand, ARoomBakedAndShownUnlitIsTheRoomLit) {
  writeRoom();
  succeed("luciole bake lit.json --object room --size 1024x768 --quiet -o map.exr --to-gltf room.glb");
  succeed("luciole render lit.json --shadows exact --aov position,normal --quiet -o lit.exr");
  succeed("luciole render unlit.json --quiet -o unlit.exr");
  const Image map = readImage(folder / "map.exr"), lit = readImage(folder / "lit.exr"),
              unlit = readImage(folder / "unlit.exr");
  const double error = 1.14 / 255 * *std::max_element(map.pixels.begin(), map.pixels.end());
  double sum = 0;
  int compared = 0;
  for (int y = 0; y < lit.height; ++y)
    for (int x = 0; x < lit.width; ++x) {
      const glm::dvec3 light = numbersAt(unlit, x, y, 0), difference = light - numbersAt(lit, x, y, 0);
      sum += std::abs(difference.x) + std::abs(difference.y) + std::abs(difference.z);
      const auto range = rangeAround(lit, x, y);
      if (!range) continue;
      ++compared;
      for (int c = 0; c < 3; ++c) {
        EXPECT_GE(light[c], range->first[c] - error) << x << " " << y;
        EXPECT_LE(light[c], range->second[c] + error) << x << " " << y;
      }
    }
  EXPECT_GT(compared, lit.width * lit.height / 2);
  EXPECT_LE(sum / (3.0 * lit.width * lit.height), error);
}

TEST_F(BakeCommand, SeamsHaveTheLightOfTheirChartsAndAlphaTellsWhereChartsAre) {
  writeFloor("vt 0.25 0.25\nvt 0.75 0.25\nvt 0.75 0.75\nvt 0.25 0.75\n");
  succeed("luciole bake floor.json --object floor --size 32x32 --irradiance --quiet -o map.exr");
  succeed("luciole bake floor.json --object floor --size 32x32 --irradiance --alpha --quiet -o alpha.exr");
  const Image map = readImage(folder / "map.exr"), alpha = readImage(folder / "alpha.exr");
  for (const int x : {4, 7})
    EXPECT_NEAR(map.pixels[3 * (32 * 16 + std::size_t(x))], 2 * diffuseAt({-1, 0, 0}), 0.1);
  ASSERT_EQ(alpha.channels.back(), "A");
  for (int x = 0; x < 32; ++x) {
    const bool inside = x >= 8 && x < 24;
    EXPECT_EQ(alpha.pixels[4 * (32 * 16 + std::size_t(x)) + 3], inside ? 1 : 0) << x;
    EXPECT_EQ(alpha.pixels[4 * (32 * 16 + std::size_t(x))] > 0, inside) << x;
  }
}

TEST_F(BakeCommand, TheGltfHoldsTheObjectWhereItIs) {
  writeFloor();
  std::string scene = readText(folder / "floor.json");
  scene.replace(scene.find(R"("name": "floor")"), 0, R"("translate": [1, 2, 3], "rotate": [0, 30, 0], )");
  writeText(folder / "moved.json", scene);
  succeed("luciole bake moved.json --object floor --size 16x16 --quiet -o map.png --to-gltf floor.glb");
  EXPECT_THAT(succeed("luciole info floor.glb"),
              testing::HasSubstr("bounds       (-0.366025, 2, 1.63397) to (2.36603, 2, 4.36603)"));
}

TEST_F(BakeCommand, WrongInputIsRefusedInALineAndNothingIsWritten) {
  writeFloor();
  const std::string bake = "luciole bake floor.json --size 8x8 -o map.exr --to-gltf map.glb ";
  refuse(bake + "--object flor", 2,
         "floor.json has no object of that name; did you mean floor?; it has floor");
  refuse(bake + "--object floor --eye 0 1 0 --shadows hard", 2, "expected exact, soft-exact or off");
  refuse(bake + "--object floor --exposure auto", 2, "expected stops");
  refuse(bake + "--object floor --aov object_id", 2, "a map shows one object");
  refuse("luciole bake floor.json --object floor -o map.exr --to-gltf map.obj", 2, "ends in .glb or .gltf");
  refuse("luciole bake floor.json --object floor -o map.exr --to-gltf no/map.glb", 2, "no");
  refuse("luciole bake floor.json --object floor -o map.exr --to-gltf -", 2, "expected a file's name");
  refuse("luciole bake floor.json -o map.exr", 2, "--object");
  writeFloor("vt 0 0\nvt 2 0\nvt 1 1\nvt 0 1\n");
  refuse(bake + "--object floor", 2, "fit into a square of one unit");
  writeFloor("vt 0 0\nvt 1 0\nvt 0.5 0.5\nvt 1 0.1\n");
  refuse(bake + "--object floor", 2, "its charts overlap");
  writeFloor("", "1 2 3 4");
  refuse(bake + "--object floor", 2, "has no texture coordinates");
  EXPECT_FALSE(std::filesystem::exists(folder / "map.exr"));
  EXPECT_FALSE(std::filesystem::exists(folder / "map.glb"));
}

}  // namespace
}  // namespace luciole::test
