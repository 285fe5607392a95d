// Lights a sphere, and writes it as a PNG.
#include <cstdio>
#include <luciole/primitives.hpp>
#include <luciole/render.hpp>

int main() {
  luciole::Device device = luciole::Device::open();  // PoCL's, where there is one

  luciole::Scene scene;
  scene.materials = {{.diffuse{0.5f, 0.3f, 0.1f}, .specular{0.5f, 0.5f, 0.5f}, .shininess = 32}};
  scene.meshes = {luciole::makePrimitive({.kind = luciole::PrimitiveKind::kSphere, .segments = 64}, 0)};
  scene.objects = {{.mesh = 0}};
  scene.lights = {{.position{3, 4, 5}, .attenuation{0, 0, 0.02f}}};
  scene.ambient = glm::vec3(0.2f);

  luciole::RenderSettings settings{.size{640, 360}, .samples = 4};
  settings.camera.camera_to_world[3] = {0, 0, 4, 1};  // 4 m back, looking along -z

  const luciole::Picture picture = luciole::render(device, scene, settings);
  luciole::writeImage(picture.image, "sphere.png", {});
  std::printf("%s shaded it in %.1f ms\n", device.description().name.c_str(),
              luciole::stageTime(picture.stats, luciole::Stage::kShade));
}
