#pragma once

#include <glm/glm.hpp>

#include "luciole/scene.hpp"

namespace luciole {

/// The rigid camera-to-world transform of a camera at `eye` that looks at `target`. `up` points upwards: any
/// length but 0, not parallel to the view.
glm::dmat4 cameraToWorld(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up);

/// Poses a scene at a frame, which may be fractional: sets the members of cameras, lights, objects and meshes
/// that are animated, and nothing else. The result doesn't depend on earlier poses. An object that a scale of
/// 0 along two axes or more hides gets an empty mesh. Throws InputError naming the frame where a pose doesn't
/// exist: a camera whose up is parallel to its view, a spot at its target, a transform that isn't finite, or
/// a coordinate beyond ±10¹⁸ metres.
void poseScene(Scene& scene, double frame);

/// Attaches an object to a node, from the next poseScene() on.
void attach(Scene& scene, const Attachment& object);

}  // namespace luciole
