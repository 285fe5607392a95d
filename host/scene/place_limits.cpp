#include "scene/place_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/text_file.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

/// The largest magnitude of a point's coordinates; infinite where one is NaN, as products of finite numbers
/// can give.
double reachOf(const glm::dvec3& point) {
  double reach = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::isnan(point[i])) return std::numeric_limits<double>::infinity();
    reach = std::max(reach, std::abs(point[i]));
  }
  return reach;
}

[[noreturn]] void fail(const Scene& scene, const std::string& thing, const char* what, double value) {
  throw InputError(fmt::format("{}: {}: {} of {:.3g}, expected {} at most", scene.name, thing, what, value,
                               kLargestNumber));
}

/// A mesh's bounding box: its centre and half its sides, object space.
struct Box {
  glm::dvec3 middle{0.0}, half{0.0};
};

std::vector<Box> meshBoxes(const Scene& scene) {
  std::vector<Box> boxes;
  for (const Mesh& mesh : scene.meshes) {
    Box& box = boxes.emplace_back();
    if (mesh.positions.empty()) continue;
    glm::vec3 low = mesh.positions[0], high = low;
    for (const glm::vec3& position : mesh.positions) {
      low = glm::min(low, position);
      high = glm::max(high, position);
    }
    box.middle = (glm::dvec3(low) + glm::dvec3(high)) * 0.5;
    box.half = (glm::dvec3(high) - glm::dvec3(low)) * 0.5;
  }
  return boxes;
}

/// A bound for reachOf() of any point of the box in world space.
double reachOfBox(const glm::dmat4& to_world, const Box& box) {
  glm::dvec3 half(0.0);
  for (int i = 0; i < 3; ++i) half += glm::abs(glm::dvec3(to_world[i])) * box.half[i];
  return reachOf(glm::abs(glm::dvec3(to_world * glm::dvec4(box.middle, 1.0))) + half);
}

void checkObject(const Scene& scene, std::size_t index) {
  const Object& object = scene.objects[index];
  const Mesh& mesh = scene.meshes[object.mesh];
  for (const glm::vec3& position : mesh.positions) {
    const double reach = reachOf(glm::dvec3(object.object_to_world * glm::dvec4(position, 1.0)));
    if (reach > kLargestNumber)
      fail(scene, fmt::format("object {} '{}'", index, forMessage(mesh.name)), "a vertex's coordinate",
           reach);
  }
}

}  // namespace

void checkPlaces(const Scene& scene) {
  const std::vector<Box> boxes = meshBoxes(scene);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (reachOfBox(object.object_to_world, boxes[object.mesh]) > kLargestNumber) checkObject(scene, i);
  }
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const double reach = light.kind == LightKind::kDirectional ? 0 : reachOf(light.position);
    if (reach > kLargestNumber) fail(scene, fmt::format("light {}", i), "a coordinate", reach);
  }
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const Camera& camera = scene.cameras[i];
    const std::string thing = fmt::format("camera {} '{}'", i, forMessage(camera.name));
    const double reach = reachOf(glm::dvec3(camera.camera_to_world[3]));
    if (reach > kLargestNumber) fail(scene, thing, "a coordinate", reach);
    if (camera.orthographic && camera.half_height > kLargestNumber)
      fail(scene, thing, "half a picture's height", camera.half_height);
  }
}

}  // namespace luciole
