#pragma once

#include <CLI/CLI.hpp>
#include <glm/glm.hpp>
#include <string>

#include "luciole/scene.hpp"

// render --orbit: the camera makes a full turn around its target.
namespace luciole {

struct Orbit {
  int frames = 0;          ///< of a full turn; 0: the camera stays where the scene has it
  glm::dvec3 middle{0.0};  ///< of the scene, at frame 1: see setMiddle()
};

void addOrbitOption(CLI::App& command, Orbit& orbit);

/// The frames that --frames says; without it those of the turn.
std::string framesOf(const std::string& typed, const Orbit& orbit);

/// With an orbit sets its middle, for cameras without a target. Poses the scene at the frame.
void setMiddle(Scene& scene, int frame, Orbit& orbit);

/// A camera of the scene at a frame, rotated about its `up` through its target by (frame − 1) · 360° /
/// frames. Without a target it uses the point ahead that is nearest to the scene's middle.
Camera orbiting(const Camera& camera, const Orbit& orbit, int frame);

}  // namespace luciole
