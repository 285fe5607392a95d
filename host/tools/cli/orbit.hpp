#pragma once

#include <CLI/CLI.hpp>
#include <glm/glm.hpp>
#include <string>

#include "luciole/scene.hpp"

// render --orbit: the camera goes once round what it looks at.
namespace luciole {

struct Orbit {
  int frames = 0;          ///< of a full turn; 0: the camera stays where the scene has it
  glm::dvec3 middle{0.0};  ///< of the scene, at frame 1: see setMiddle()
};

void addOrbitOption(CLI::App& command, Orbit& orbit);

/// The frames that --frames says; without it those of the turn.
std::string framesOf(const std::string& typed, const Orbit& orbit);

/// For an orbit finds the scene's middle, for cameras without a target, and leaves the scene posed for the
/// frame.
void setMiddle(Scene& scene, int frame, Orbit& orbit);

/// A camera, as the scene has it at a frame, turned for that frame: at frame 1 it is itself, and from one to
/// the next its azimuth grows by 360° / frames, about its `up` through its target. Without a target that is
/// the point ahead of it that is nearest to the scene's middle.
Camera orbiting(const Camera& camera, const Orbit& orbit, int frame);

}  // namespace luciole
