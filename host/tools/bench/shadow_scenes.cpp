#include "tools/bench/shadow_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

#include "base/random.hpp"
#include "load/frame.hpp"
#include "luciole/pose.hpp"
#include "luciole/primitives.hpp"

namespace luciole {
namespace {

/// A scene with one material, seen on 45 degrees.
Scene startScene(const std::string& name, const glm::dvec3& eye, const glm::dvec3& target) {
  Scene scene;
  scene.name = name;
  Material material;
  material.name = "chalk";
  material.diffuse = glm::vec3(0.8f);
  material.double_sided = true;
  scene.materials.push_back(material);
  Camera camera;
  camera.camera_to_world = cameraToWorld(eye, target, {0, 1, 0});
  scene.cameras.push_back(camera);
  return scene;
}

void add(Scene& scene, const Primitive& primitive, const glm::dvec3& where, const glm::dvec3& scale,
         const glm::dmat4& turned = glm::dmat4(1)) {
  scene.meshes.push_back(makePrimitive(primitive, 0));
  scene.objects.push_back({std::uint32_t(scene.meshes.size() - 1),
                           glm::translate(glm::dmat4(1), where) * turned * glm::scale(glm::dmat4(1), scale),
                           -1});
}

void addGround(Scene& scene, double side) { add(scene, {PrimitiveKind::kPlane}, {0, 0, 0}, {side, 1, side}); }

void addSun(Scene& scene, const glm::dvec3& direction) {
  Light light;
  light.kind = LightKind::kDirectional;
  light.direction = glm::normalize(direction);
  light.shadow = true;
  scene.lights.push_back(light);
}

void addLamp(Scene& scene, const glm::dvec3& position, float range) {
  Light light;
  light.position = position;
  light.range = range;
  light.shadow = true;
  scene.lights.push_back(light);
}

Scene grazingPlane() {
  Scene scene = startScene("grazing plane", {0, 2.5, 9}, {0, 0, 0});
  addGround(scene, 60);
  const double height = 3.0 * 3.14159265358979323846 / 180;
  addSun(scene, {-std::cos(height), -std::sin(height), -0.2});
  for (int i = -3; i <= 3; ++i)
    add(scene, {PrimitiveKind::kBox}, {i * 1.7, 0.1, i % 2 * 1.5}, {0.1, 0.2, 0.1});
  return scene;
}

Scene thinWall() {
  Scene scene = startScene("thin wall", {2.5, 1.8, 4}, {0, 0.6, 0});
  addGround(scene, 20);
  add(scene, {PrimitiveKind::kPlane}, {0, 1, 0}, {4, 1, 2},
      glm::rotate(glm::dmat4(1), glm::radians(90.0), glm::dvec3(1, 0, 0)));
  addLamp(scene, {0.3, 0.7, -0.02}, 8);
  return scene;
}

Scene picketFence() {
  Scene scene = startScene("picket fence", {1.6, 1.4, 2}, {-0.5, 0.5, -6});
  addGround(scene, 60);
  addSun(scene, {0.6, -0.5, -0.35});
  for (int i = 0; i < 100; ++i) add(scene, {PrimitiveKind::kBox}, {0, 0.5, 1 - 0.2 * i}, {0.012, 1, 0.03});
  for (const double y : {0.3, 0.8}) add(scene, {PrimitiveKind::kBox}, {-0.02, y, -9}, {0.02, 0.05, 20});
  return scene;
}

Scene cubeSeam() {
  Scene scene = startScene("cube seam", {2.2, 1.6, 2.6}, {-0.4, -0.3, -0.6});
  add(scene, {PrimitiveKind::kBox}, {0, 0, 0}, {8, 5, 8});
  addLamp(scene, {0.1, 0.2, 0.15}, 9);
  for (const double x : {-1.0, 1.0})
    for (const double z : {-1.0, 1.0}) {
      add(scene, {PrimitiveKind::kSphere, 24}, {x + 0.1, 0.2, z + 0.15}, glm::dvec3(0.25));
      add(scene, {PrimitiveKind::kBox}, {1.5 * x, -1.5, 1.5 * z}, glm::dvec3(0.4),
          glm::rotate(glm::dmat4(1), 0.5, glm::dvec3(1, 1, 0)));
    }
  add(scene, {PrimitiveKind::kTorus, 48}, {0.1, -0.9, 0.15}, glm::dvec3(0.7));
  return scene;
}

Scene contact() {
  Scene scene = startScene("contact", {1.5, 1.6, 3.5}, {0, 0.5, 0});
  addGround(scene, 20);
  add(scene, {PrimitiveKind::kSphere, 96}, {0, 1, 0}, {1, 1, 1});
  addLamp(scene, {2.5, 2.5, 1.5}, 15);
  return scene;
}

/// A leaf: a quadrilateral, bent along its middle.
void addLeaf(Mesh& mesh, const glm::dvec3& where, const glm::dvec3& along, const glm::dvec3& across) {
  const auto first = std::uint32_t(mesh.positions.size());
  const glm::dvec3 up = glm::cross(along, across) / glm::length(along);
  for (const glm::dvec3& corner : {where, where + 0.5 * (along + across) + 0.3 * up, where + along,
                                   where + 0.5 * (along - across) + 0.3 * up}) {
    mesh.positions.push_back(glm::vec3(corner));
    mesh.normals.push_back(glm::vec3(glm::normalize(up)));
  }
  for (const glm::uvec3& corners : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) {
    mesh.triangles.push_back(corners + first);
    mesh.triangle_materials.push_back(0);
  }
}

Scene foliage() {
  constexpr int kShrubs = 20, kLeaves = 2000;
  Scene scene = startScene("foliage", {0.5, 1.7, 6.5}, {0, 0.6, 0});
  addGround(scene, 30);
  std::uint64_t state = 1;
  const auto uniform = [&](double low, double high) { return between(low, high, nextUniform(state)); };
  const auto direction = [&] {
    const double z = uniform(-1, 1), angle = uniform(0, 2 * 3.14159265358979323846), r = std::sqrt(1 - z * z);
    return glm::dvec3(r * std::cos(angle), r * std::sin(angle), z);
  };
  Mesh leaves;
  for (int i = 0; i < kShrubs; ++i) {
    const glm::dvec3 middle(uniform(-5, 5), 0.6, uniform(-6, 4));
    for (int j = 0; j < kLeaves; ++j) {
      const glm::dvec3 where = middle + glm::dvec3(0.8, 0.6, 0.8) * std::cbrt(uniform(0, 1)) * direction();
      const glm::dvec3 along = uniform(0.05, 0.1) * direction();
      const glm::dvec3 across = 0.03 * glm::normalize(glm::cross(along, direction()));
      addLeaf(leaves, where, along, across);
    }
  }
  scene.meshes.push_back(std::move(leaves));
  scene.objects.push_back({std::uint32_t(scene.meshes.size() - 1), glm::dmat4(1), -1});
  for (int i = 0; i < 16; ++i) addLamp(scene, {uniform(-5, 5), uniform(0.3, 2.5), uniform(-6, 4)}, 5);
  return scene;
}

}  // namespace

std::vector<Scene> makeShadowScenes() {
  return {grazingPlane(), thinWall(), picketFence(), cubeSeam(), contact(), foliage()};
}

Scene makeLampHall(int lamps) {
  constexpr double kWidth = 16, kLength = 40;
  Scene scene = startScene(fmt::format("hall, {}", lamps == 1 ? "1 lamp" : fmt::format("{} lamps", lamps)),
                           {0.4, 2.2, 21}, {0, 1.4, 0});
  add(scene, {PrimitiveKind::kBox}, {0, 2.5, 0}, {kWidth, 5, kLength + 4});
  for (int i = 0; i < 30; ++i) {
    const int row = i / 3;
    const double x = (i % 3 - 1) * 4.5, z = (row - 4.5) * 4;
    add(scene, {PrimitiveKind::kCylinder, 96}, {x, 0, z}, {0.25, 2, 0.25});
    add(scene, {PrimitiveKind::kSphere, 48}, {x, 2.3, z}, glm::dvec3(0.35));
  }
  const int columns = std::max(int(std::lround(std::sqrt(lamps * kWidth / kLength))), 1);
  const int rows = (lamps + columns - 1) / columns;
  const auto range = float(1.5 * std::sqrt(kWidth * kLength / lamps));
  for (int i = 0; i < lamps; ++i) {
    const double x = (i % columns + 0.5) / columns - 0.5, z = (double(i) / columns + 0.5) / rows - 0.5;
    addLamp(scene, {x * (kWidth - 1), 3.2 + i % 7 * 0.1, z * kLength}, std::max(range, 3.0f));
  }
  return scene;
}

}  // namespace luciole
