#include "tools/bench/bench_scene.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "load/frame.hpp"
#include "luciole/pose.hpp"
#include "luciole/primitives.hpp"
#include "scene/lights/light_field.hpp"

namespace luciole {
namespace {

constexpr int kExponents = 5;  ///< 10⁰ to 10⁴

/// One material for the ground, then one for each exponent.
void addMaterials(Scene& scene) {
  Material ground;
  ground.name = "ground";
  ground.diffuse = {0.5f, 0.48f, 0.45f};
  ground.ambient = ground.diffuse;
  ground.specular = glm::vec3(0.15f);
  ground.shininess = 20;
  scene.materials.push_back(ground);
  const glm::vec3 colors[kExponents]{{0.6f, 0.2f, 0.15f},
                                     {0.6f, 0.45f, 0.15f},
                                     {0.2f, 0.5f, 0.25f},
                                     {0.15f, 0.4f, 0.55f},
                                     {0.4f, 0.25f, 0.55f}};
  for (int i = 0; i < kExponents; ++i) {
    Material shiny;
    shiny.name = "shiny";
    shiny.diffuse = colors[i];
    shiny.ambient = shiny.diffuse;
    shiny.specular = glm::vec3(0.5f);
    shiny.shininess = std::pow(10.0f, float(i));
    scene.materials.push_back(shiny);
  }
}

void addObjects(Scene& scene) {
  enum Shape : std::uint32_t { kGround, kBall, kBlock, kRing };
  for (const Primitive& primitive :
       {Primitive{PrimitiveKind::kPlane}, Primitive{PrimitiveKind::kSphere, 64},
        Primitive{PrimitiveKind::kBox}, Primitive{PrimitiveKind::kTorus, 96, 0.3f}})
    scene.meshes.push_back(makePrimitive(primitive, 0));
  const auto place = [&](Shape shape, const glm::dvec3& where, double scale, int material) {
    const glm::dmat4 moved = glm::translate(glm::dmat4(1), where);
    scene.objects.push_back({shape, glm::scale(moved, glm::dvec3(scale)), material});
  };
  place(kGround, {0, 0, 0}, 60, 0);
  for (int row = 0; row < 4; ++row) {
    for (int i = 0; i < kExponents; ++i) {
      const double x = 2.4 * (i - 2), z = -4.0 * row;
      place(kBall, {x, 0.8, z}, 0.8, 1 + i);
      place(kBlock, {x + 1.2, 0.4, z - 2}, 0.8, 1 + (i + row) % kExponents);
    }
    place(kRing, {0, 2.6 + 0.3 * row, -4.0 * row - 1}, 0.9, 1 + row);
  }
}

void addLights(Scene& scene) {
  Light sun;
  sun.kind = LightKind::kDirectional;
  sun.direction = glm::normalize(glm::dvec3(-0.5, -1, -0.7));
  sun.diffuse = sun.specular = {0.35f, 0.33f, 0.3f};
  sun.shadow = true;
  sun.half_angle = glm::radians(0.25);
  scene.lights.push_back(sun);

  Light spot;
  spot.kind = LightKind::kSpot;
  spot.position = {-6, 7, 4};
  spot.direction = glm::normalize(glm::dvec3(0, 0.5, -4) - spot.position);
  spot.diffuse = spot.specular = {0.5f, 0.4f, 0.25f};
  spot.cutoff = glm::radians(35.0);
  spot.exponent = 12;
  spot.shadow = true;
  spot.radius = 0.15;
  scene.lights.push_back(spot);

  Light lamp;
  lamp.position = {2.4, 4.5, -6};
  lamp.diffuse = lamp.specular = {0.5f, 0.6f, 0.8f};
  lamp.attenuation = {1, 0.05f, 0.02f};
  lamp.shadow = true;
  lamp.radius = 0.15;
  scene.lights.push_back(lamp);

  LightField field;
  field.count = 250;
  field.seed = 1;
  field.low = {-9, 0.2, -17};
  field.high = {9, 2.5, 4};
  field.colors = {{1, 0.55f, 0.2f}, {0.4f, 0.6f, 1}, {0.5f, 1, 0.6f}, {1, 0.35f, 0.5f}};
  field.intensity = {0.1f, 0.4f};
  field.range = {1.2f, 2.4f};
  expandLightField(field, scene);
}

}  // namespace

Scene makeBenchScene() {
  Scene scene;
  scene.name = "built-in scene";
  scene.size = glm::ivec2(1280, 720);
  scene.background = {0.35f, 0.4f, 0.5f};
  scene.ambient = glm::vec3(0.04f);
  scene.fog.mode = FogMode::kExp2;
  scene.fog.density = glm::vec3(0.03f);
  scene.fog.color = scene.background;
  addMaterials(scene);
  addObjects(scene);
  addLights(scene);
  Camera camera;
  camera.camera_to_world = cameraToWorld({1.5, 4.5, 9}, {0, 0.8, -4}, {0, 1, 0});
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace luciole
