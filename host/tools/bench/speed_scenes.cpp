#include "tools/bench/speed_scenes.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "image/build_mips.hpp"
#include "load/frame.hpp"
#include "luciole/pose.hpp"
#include "luciole/primitives.hpp"
#include "raster/rasterize.hpp"
#include "scene/lights/light_field.hpp"
#include "shade/features.hpp"

namespace luciole {
namespace {

const std::vector<glm::vec3> kSceneColors{
    {1, 0.55f, 0.2f}, {0.4f, 0.6f, 1}, {0.5f, 1, 0.6f}, {1, 0.35f, 0.5f}};

/// Points that fill a box evenly, the same on every machine: M. Roberts, "The Unreasonable Effectiveness of
/// Quasirandom Sequences", 2018, with the root of x⁴ = x + 1.
glm::dvec3 spreadPoint(int index, const glm::dvec3& low, const glm::dvec3& high) {
  const glm::dvec3 place = glm::fract((index + 1.0) * glm::dvec3(0.8191725134, 0.6710436067, 0.5497004779));
  return low + place * (high - low);
}

/// Stones of two tones, 16 x 16 to a texture.
Texture stones(glm::dvec3 light, glm::dvec3 dark) {
  constexpr int kSide = 512, kStone = 32, kJoint = 2;
  Texture texture;
  texture.name = "stones";
  MipLevel level{kSide, kSide, {}};
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const int row = y / kStone, shifted = x + row % 2 * kStone / 2, column = shifted / kStone;
      const bool joint = y % kStone < kJoint || shifted % kStone < kJoint;
      const double shade = joint ? 0.3 : 0.7 + 0.3 * spreadPoint(row * 17 + column % 16, {}, {1, 1, 1}).x;
      const glm::dvec3 color = shade * ((row + column) % 2 ? light : dark);
      for (int c = 0; c < 3; ++c) level.texels.push_back(std::uint16_t(65535 * color[c]));
      level.texels.push_back(65535);
    }
  texture.levels.push_back(std::move(level));
  buildMips(texture);
  return texture;
}

/// A material with a texture of its own.
int addStones(Scene& scene, glm::dvec3 light, glm::dvec3 dark, float shininess) {
  Material material;
  material.name = "stones";
  material.diffuse = glm::vec3(1);
  material.specular = glm::vec3(0.3f);
  material.shininess = shininess;
  material.diffuse_map.texture = int(scene.textures.size());
  scene.textures.push_back(stones(light, dark));
  scene.materials.push_back(material);
  return int(scene.materials.size()) - 1;
}

std::uint32_t addMesh(Scene& scene, const Primitive& primitive) {
  scene.meshes.push_back(makePrimitive(primitive, 0));
  return std::uint32_t(scene.meshes.size() - 1);
}

void place(Scene& scene, std::uint32_t mesh, int material, const glm::dmat4& turned, const glm::dvec3& where,
           const glm::dvec3& scale) {
  const glm::dmat4 moved = glm::translate(glm::dmat4(1), where) * turned;
  scene.objects.push_back({mesh, glm::scale(moved, scale), material});
}

glm::dmat4 turn(double degrees, const glm::dvec3& axis) {
  return glm::rotate(glm::dmat4(1), glm::radians(degrees), axis);
}

void setCamera(Scene& scene, const glm::dvec3& eye, const glm::dvec3& target) {
  Camera camera;
  camera.camera_to_world = cameraToWorld(eye, target, {0, 1, 0});
  scene.cameras.push_back(camera);
}

void addHallWalls(Scene& scene, int floor, int wall) {
  const std::uint32_t plane = addMesh(scene, {PrimitiveKind::kPlane, 64, 0.25f, 6.0f});
  const glm::dmat4 upright(1);
  place(scene, plane, floor, upright, {0, 0, -20}, {20, 1, 44});
  place(scene, plane, wall, turn(180, {1, 0, 0}), {0, 9, -20}, {20, 1, 44});
  place(scene, plane, wall, turn(-90, {0, 0, 1}), {-10, 4.5, -20}, {9, 1, 44});
  place(scene, plane, wall, turn(90, {0, 0, 1}), {10, 4.5, -20}, {9, 1, 44});
  place(scene, plane, wall, turn(90, {1, 0, 0}), {0, 4.5, -42}, {20, 1, 9});
  place(scene, plane, wall, turn(-90, {1, 0, 0}), {0, 4.5, 2}, {20, 1, 9});
}

}  // namespace

Scene makeHall() {
  Scene scene;
  scene.name = "hall";
  const int floor = addStones(scene, {0.6, 0.55, 0.5}, {0.45, 0.42, 0.4}, 40);
  const int wall = addStones(scene, {0.65, 0.5, 0.4}, {0.5, 0.4, 0.35}, 10);
  const int column = addStones(scene, {0.7, 0.7, 0.65}, {0.6, 0.6, 0.55}, 80);
  addHallWalls(scene, floor, wall);
  const std::uint32_t shaft = addMesh(scene, {PrimitiveKind::kCylinder, 128, 0.25f, 2.0f});
  const std::uint32_t arch = addMesh(scene, {PrimitiveKind::kTorus, 64, 0.12f, 2.0f});
  const std::uint32_t ball = addMesh(scene, {PrimitiveKind::kSphere, 44, 0.25f, 2.0f});
  for (int row = 0; row < 10; ++row) {
    for (const double side : {-4.0, 4.0}) {
      const glm::dvec3 foot(side, 0, -4.0 * row - 2);
      place(scene, shaft, column, glm::dmat4(1), foot, {0.45, 6, 0.45});
      place(scene, arch, column, turn(90, {0, 0, 1}), foot + glm::dvec3(0, 6, -2), {2, 2, 2});
    }
    place(scene, arch, column, turn(90, {1, 0, 0}), {0, 6, -4.0 * row - 2}, {4, 1, 2.5});
  }
  for (int i = 0; i < 44; ++i) {
    const double radius = 0.15 + 0.5 * spreadPoint(i, {}, {1, 1, 1}).z;
    place(scene, ball, i % 3, glm::dmat4(1), spreadPoint(i, {-9, radius, -40}, {9, radius, -3}),
          glm::dvec3(radius));
  }
  LightField field;
  field.count = 1024;
  field.seed = 1;
  field.low = {-10, 0, -42};
  field.high = {10, 9, 2};
  field.colors = kSceneColors;
  field.intensity = {0.1f, 0.5f};
  field.range = {1.736f, 2.604f};
  expandLightField(field, scene);
  setCamera(scene, {-1, 2.2, -18.8}, {0, 2.6, -20});
  return scene;
}

Scene makeLightSphere(std::uint64_t lights) {
  Scene scene;
  scene.name = "sphere";
  Material material;
  material.name = "sphere";
  material.specular = glm::vec3(0.3f);
  material.shininess = 30;
  material.double_sided = true;
  scene.materials.push_back(material);
  // With 512 segments its facets lie within 2 mm of the sphere.
  place(scene, addMesh(scene, {PrimitiveKind::kSphere, 512}), 0, glm::dmat4(1), {}, glm::dvec3(50.1));
  LightField field;
  field.count = lights;
  field.seed = 1;
  field.shape = FieldShape::kSphere;
  field.radius = 50;
  field.colors = kSceneColors;
  field.range = glm::vec2(0.3f);
  expandLightField(field, scene);
  setCamera(scene, {0, 0, 0}, {0, 0.3, -1});
  return scene;
}

Scene makeCity(std::uint64_t lights) {
  constexpr int kBlocks = 40;             // a side
  constexpr double kBlock = 25;           // metres
  constexpr double kMillionRange = 4.05;  // metres
  Scene scene;
  scene.name = "city";
  const int street = addStones(scene, {0.45, 0.45, 0.5}, {0.35, 0.35, 0.4}, 30);
  const int house = addStones(scene, {0.7, 0.6, 0.5}, {0.55, 0.5, 0.45}, 10);
  const double half = kBlocks * kBlock / 2;
  place(scene, addMesh(scene, {PrimitiveKind::kPlane, 64, 0.25f, 200.0f}), street, glm::dmat4(1), {},
        {2 * half, 1, 2 * half});
  const std::uint32_t box = addMesh(scene, {PrimitiveKind::kBox, 1, 0.25f, 2.0f});
  for (int i = 0; i < kBlocks * kBlocks; ++i) {
    const glm::dvec3 shape = spreadPoint(i, {8, 5, 8}, {18, 30, 18});
    const glm::dvec3 middle(kBlock * (i % kBlocks + 0.5) - half, shape.y / 2,
                            kBlock * (i / kBlocks + 0.5) - half);
    place(scene, box, house, glm::dmat4(1), middle, shape);
  }
  LightField field;
  field.count = lights;
  field.seed = 1;
  field.low = {-half, 0, -half};
  field.high = {half, 30, half};
  field.colors = kSceneColors;
  field.intensity = {0.1f, 0.5f};
  field.range = glm::vec2(float(kMillionRange * std::cbrt(1e6 / double(lights))));
  expandLightField(field, scene);
  setCamera(scene, {-12.5, 120, 420}, {0, 0, 250});
  return scene;
}

GBuffer gbufferOf(const Scene& scene, glm::ivec2 size) {
  const Camera& camera = scene.cameras.front();
  const FeatureSet features = neededFeatures(scene, camera, materialTraits(scene), {});
  GBuffer gbuffer =
      rasterize(scene, allObjects(scene), cameraView(camera, size), Shading::kPhong, neededPlanes(features));
  gbuffer.camera = camera;
  return gbuffer;
}

}  // namespace luciole
