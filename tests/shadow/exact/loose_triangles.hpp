#pragma once

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "kernels/shared.h"
#include "luciole/scene.hpp"

// Scenes of triangles that share no corners, for tests of the tree over them, and lights for rays among them.
namespace luciole::test {

using Triangle = std::array<glm::vec3, 3>;

/// One object of these triangles, with materials 0, without holes, and 1, with holes.
inline Scene looseScene(const std::vector<Triangle>& triangles, std::uint32_t material = 0) {
  Scene scene;
  scene.name = "loose";
  scene.materials.resize(2);
  scene.materials[1].alpha_cutoff = 0.5f;
  Mesh mesh;
  for (const Triangle& triangle : triangles) {
    const std::uint32_t first = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), triangle.begin(), triangle.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  mesh.normals.assign(mesh.positions.size(), {0, 1, 0});
  mesh.triangle_materials.assign(mesh.triangles.size(), material);
  scene.meshes = {mesh};
  scene.objects = {Object{}};
  return scene;
}

/// Triangles of up to `size` in a cube of side 2 around the origin.
inline std::vector<Triangle> randomTriangles(int count, float size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> anywhere(-1, 1);
  const auto vector = [&] { return glm::vec3(anywhere(random), anywhere(random), anywhere(random)); };
  std::vector<Triangle> triangles;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 middle = vector();
    triangles.push_back({middle + size * vector(), middle + size * vector(), middle + size * vector()});
  }
  return triangles;
}

/// Vectors in that cube.
struct RandomVectors {
  std::mt19937 random;
  std::uniform_real_distribution<float> anywhere{-1, 1};
  explicit RandomVectors(unsigned seed) : random(seed) {}
  glm::vec3 operator()() { return {anywhere(random), anywhere(random), anywhere(random)}; }
};

inline BeamLight lightAt(const glm::vec3& xyz, float w) {
  BeamLight light{};
  light.place = {xyz.x, xyz.y, xyz.z, w};
  return light;
}
inline BeamLight pointAt(const glm::vec3& place) { return lightAt(place, 1); }
inline BeamLight towards(const glm::vec3& direction) { return lightAt(direction, 0); }

/// A HoleTest of scenes without holes.
inline bool neverAsked(std::uint32_t triangle, const glm::dvec3&) {
  ADD_FAILURE() << "triangle " << triangle << " is solid";
  return true;
}

}  // namespace luciole::test
