#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "render_json.hpp"
#include "shadow/maps/shadow_maps.hpp"

// Scenes whose shadow maps several tests plan and draw.
namespace luciole::test {

/// A floor of 20 m, and lights as scene files have them, separated by commas.
inline std::string planeScene(const std::string& light) {
  return fmt::format(R"({{"camera": {{"eye": [0, 3, 6], "target": [0, 0, 0]}},
    "objects": [{{"primitive": "plane", "scale": 20}}], "lights": [{}]}})",
                     light);
}

/// A terrain of many meshlets under a light of each kind.
inline Scene terrainScene() {
  Scene scene =
      sceneFromJson(planeScene(R"({"type": "directional", "direction": [1, -2, 0.3], "shadow": true},
    {"type": "point", "position": [1, 2, -1], "shadow": true},
    {"type": "point", "position": [-3, 1, 2], "range": 5, "shadow": true},
    {"type": "spot", "position": [2, 4, 1], "target": [0, 0, 0], "cutoff": 40, "shadow": true})"));
  constexpr std::uint32_t kCells = 60;
  Mesh mesh;
  for (std::uint32_t z = 0; z <= kCells; ++z)
    for (std::uint32_t x = 0; x <= kCells; ++x)
      mesh.positions.push_back(
          {0.2f * x - 6, 0.6f * std::sin(0.9f * x) * std::cos(0.7f * z) + 0.2f, 0.2f * z - 6});
  for (std::uint32_t z = 0; z < kCells; ++z)
    for (std::uint32_t x = 0; x < kCells; ++x) {
      const std::uint32_t a = z * (kCells + 1) + x, b = a + kCells + 1;
      mesh.triangles.push_back({a, b, a + 1});
      mesh.triangles.push_back({b, b + 1, a + 1});
    }
  mesh.normals.assign(mesh.positions.size(), {0, 1, 0});
  mesh.triangle_materials.assign(mesh.triangles.size(), 0);
  Object object;
  object.mesh = std::uint32_t(scene.meshes.size());
  object.material = 0;
  scene.meshes.push_back(mesh);
  scene.objects.push_back(object);
  return scene;
}

/// A thousand lamps over a floor, all of them in the picture.
inline Scene thousandLamps() {
  Scene scene = sceneFromJson(planeScene(R"({"type": "point", "position": [0, 1, 0], "shadow": true})"));
  scene.lights.resize(1000, scene.lights.front());
  for (int i = 0; i < 1000; ++i) scene.lights[i].position.x = 0.001 * i;
  return scene;
}

inline ShadowMaps planFor(const Scene& scene, glm::ivec2 size = {200, 100},
                          const ShadowLimits& limits = {.size = 256}) {
  return planShadowMaps(scene, cameraView(scene.cameras.front(), size), ShadowMethod::kHard, limits);
}

template <class T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

}  // namespace luciole::test
