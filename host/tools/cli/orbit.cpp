#include "tools/cli/orbit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "luciole/pose.hpp"
#include "scene/bounds.hpp"

namespace luciole {
namespace {

/// What a turn may take at most.
constexpr int kMostFrames = 100'000;

/// The point ahead of a camera, no nearer than what it sees, that is nearest to a place.
glm::dvec3 pointAhead(const Camera& camera, const glm::dvec3& place) {
  const glm::dvec3 eye(camera.camera_to_world[3]), ahead(-camera.camera_to_world[2]);
  return eye + ahead * std::max(glm::dot(place - eye, ahead), camera.near);
}

}  // namespace

void addOrbitOption(CLI::App& command, Orbit& orbit) {
  command
      .add_option(
          "--orbit", orbit.frames,
          "frames of a turn: the camera goes once round its target (a framed mesh's middle; in a room, "
          "itself), by 360/N degrees a frame from where it is; --frames 1-N unless it says others, and "
          "what moves moves as well")
      ->check(CLI::Range(2, kMostFrames))
      ->type_name("N");
}

std::string framesOf(const std::string& typed, const Orbit& orbit) {
  return typed.empty() && orbit.frames > 0 ? fmt::format("1-{}", orbit.frames) : typed;
}

void setMiddle(Scene& scene, int frame, Orbit& orbit) {
  if (orbit.frames == 0) return;
  poseScene(scene, 1);
  const Bounds bounds = sceneBounds(scene);
  if (bounds.low.x <= bounds.high.x) orbit.middle = bounds.low + (bounds.high - bounds.low) / 2.0;
  poseScene(scene, frame);
}

Camera orbiting(const Camera& camera, const Orbit& orbit, int frame) {
  if (orbit.frames == 0) return camera;
  const glm::dvec3 center = camera.target ? *camera.target : pointAhead(camera, orbit.middle);
  // Whole turns leave a camera where it is, to the last bit.
  const int steps = ((frame - 1) % orbit.frames + orbit.frames) % orbit.frames;
  if (steps == 0) return camera;
  const double angle = glm::radians(360.0 * steps / orbit.frames);
  const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), angle, glm::normalize(camera.up)));
  const glm::dmat3 axes = turn * glm::dmat3(camera.camera_to_world);
  const glm::dvec3 eye = center + turn * (glm::dvec3(camera.camera_to_world[3]) - center);
  // Rounded axes are made those of a rigid motion again.
  const glm::dvec3 back = glm::normalize(axes[2]), right = glm::normalize(glm::cross(axes[1], back));
  Camera turned = camera;
  turned.camera_to_world = {glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0),
                            glm::dvec4(eye, 1)};
  return turned;
}

}  // namespace luciole
