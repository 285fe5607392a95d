#include "tools/view/view_camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "luciole/error.hpp"
#include "scene/json/json_scene.hpp"

namespace luciole {
namespace {

using Json = nlohmann::json;

constexpr double kTurnOfHeight = 3.0;  ///< radians that a drag over the picture's height turns

Json listOf(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
glm::dvec3 vectorOf(const Json& list) { return {list[0], list[1], list[2]}; }

/// The gesture's numbers, which there must be so many of. Throws InputError.
std::vector<double> amountsOf(const Json& gesture, std::size_t count) {
  std::vector<double> amounts;
  const Json list = gesture.is_array() ? gesture : Json::array({gesture});
  for (const Json& one : list)
    if (one.is_number() && std::abs(one.get<double>()) <= 1e9) amounts.push_back(one.get<double>());
  if (amounts.size() != count || list.size() != count)
    throw InputError("request: gesture: not as the page sends it");
  return amounts;
}

glm::dvec3 rotated(const glm::dvec3& v, double angle, const glm::dvec3& axis) {
  return glm::dvec3(glm::rotate(glm::dmat4(1.0), angle, axis) * glm::dvec4(v, 0));
}

/// A direction turned right about `up` and upwards by the drag, but never into `up`.
glm::dvec3 turned(const glm::dvec3& direction, const glm::dvec3& up, double right, double upwards) {
  constexpr double kLeast = 0.01;  // radians from the poles
  const double length = glm::length(direction);
  const glm::dvec3 unit = direction / length;
  const double polar = std::acos(std::clamp(glm::dot(unit, up), -1.0, 1.0));
  const double wanted = std::clamp(polar - upwards, kLeast, 3.141592653589793 - kLeast);
  const glm::dvec3 side = glm::cross(unit, up);
  if (!(glm::length(side) > 1e-9)) return direction;
  return length * rotated(rotated(unit, polar - wanted, glm::normalize(side)), -right, up);
}

/// Metres at a distance ahead that the picture's height shows.
double heightAt(const Json& camera, double distance) {
  if (camera.contains("orthographic")) return 2 * camera["orthographic"].get<double>();
  return 2 * distance * std::tan(glm::radians(camera["fov_y"].get<double>()) / 2);
}

}  // namespace

Camera readViewCamera(const Json& camera) {
  return parseJsonScene(Json{{"camera", camera}}.dump(), "request", {}).scene.cameras.at(0);
}

Json viewCameraJson(const Camera& camera, const glm::dvec3& target) {
  const glm::dvec3 eye(camera.camera_to_world[3]), own = camera.target.value_or(eye);
  // In a room a camera's target may be its own place.
  const glm::dvec3 at = glm::distance(own, eye) > camera.near ? own : target;
  glm::dvec3 up = glm::normalize(camera.up);
  // One that looks straight down has its own.
  if (glm::length(glm::cross(up, glm::normalize(at - eye))) < 1e-3)
    up = glm::dvec3(camera.camera_to_world[1]);
  constexpr double kBeyondAll = 1e20;  // farther than anything may lie from anything; JSON has no infinity
  Json json{{"eye", listOf(eye)},
            {"target", listOf(at)},
            {"up", listOf(up)},
            {"near", camera.near},
            {"far", std::min(camera.far, kBeyondAll)}};
  if (camera.orthographic)
    json["orthographic"] = camera.half_height;
  else
    json["fov_y"] = glm::degrees(camera.fov_y);
  if (camera.shift != glm::dvec2(0)) json["shift"] = {camera.shift.x, camera.shift.y};
  if (camera.pixel_aspect != 1) json["pixel_aspect"] = camera.pixel_aspect;
  return json;
}

glm::dvec3 pointAhead(const Camera& camera, const glm::dvec3& place) {
  const glm::dvec3 eye(camera.camera_to_world[3]), ahead(-camera.camera_to_world[2]);
  return eye + ahead * std::max(glm::dot(place - eye, ahead), 10 * camera.near);
}

bool moveCamera(const Json& gesture, double length, Json& camera) {
  if (!gesture.is_object() || gesture.size() != 1) return false;
  const std::string kind = gesture.begin().key();
  glm::dvec3 eye = vectorOf(camera["eye"]), target = vectorOf(camera["target"]);
  const glm::dvec3 up = vectorOf(camera["up"]);
  const glm::dvec3 ahead = glm::normalize(target - eye), right = glm::normalize(glm::cross(ahead, up));
  const auto amounts = [&](std::size_t count) { return amountsOf(gesture.begin().value(), count); };
  if (kind == "orbit") {
    const auto drag = amounts(2);
    eye = target + turned(eye - target, up, kTurnOfHeight * drag[0], kTurnOfHeight * drag[1]);
  } else if (kind == "turn") {
    const auto drag = amounts(2);
    target = eye + turned(target - eye, up, kTurnOfHeight * drag[0], -kTurnOfHeight * drag[1]);
  } else if (kind == "pan") {
    const auto drag = amounts(2);
    const double height = heightAt(camera, glm::length(target - eye));
    const double width = height * camera.value("pixel_aspect", 1.0);
    const glm::dvec3 step = height * drag[1] * glm::cross(right, ahead) - width * drag[0] * right;
    eye += step;
    target += step;
  } else if (kind == "dolly") {
    const double share = std::pow(0.9, std::clamp(amounts(1)[0], -50.0, 50.0));
    if (camera.contains("orthographic"))
      camera["orthographic"] = share * camera["orthographic"].get<double>();
    else
      eye = target + share * (eye - target);
  } else if (kind == "walk") {
    const auto steps = amounts(3);
    const glm::dvec3 step = 0.1 * length * (steps[0] * right + steps[1] * up + steps[2] * ahead);
    eye += step;
    target += step;
  } else {
    return false;
  }
  camera["eye"] = listOf(eye);
  camera["target"] = listOf(target);
  return true;
}

std::string moveLight(const Json& gesture, const Scene& scene, const Camera& camera) {
  if (!gesture.is_object() || !gesture.contains("drag_light")) return "";
  const std::vector<double> drag = amountsOf(gesture["drag_light"], 3);
  if (!(drag[0] >= 0 && drag[0] < double(scene.lights.size())))
    throw InputError(fmt::format("request: gesture: {} has no light {}", scene.name, drag[0]));
  const auto index = std::size_t(drag[0]);
  const Light& light = scene.lights[index];
  const glm::dmat3 axes(camera.camera_to_world);
  if (light.kind == LightKind::kDirectional) {
    const glm::dvec3 to_light = rotated(rotated(-light.direction, kTurnOfHeight * drag[1], axes[1]),
                                        kTurnOfHeight * drag[2], axes[0]);
    return fmt::format("lights[{}].direction={}", index, listOf(-to_light).dump());
  }
  const glm::dvec3 eye(camera.camera_to_world[3]);
  const double ahead = std::max(glm::dot(light.position - eye, -axes[2]), camera.near);
  const double height = camera.orthographic ? 2 * camera.half_height : 2 * ahead * std::tan(camera.fov_y / 2);
  const glm::dvec3 moved =
      light.position + height * (camera.pixel_aspect * drag[1] * axes[0] - drag[2] * axes[1]);
  return fmt::format("lights[{}].position={}", index, listOf(moved).dump());
}

}  // namespace luciole
