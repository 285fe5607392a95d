#pragma once

#include <glm/glm.hpp>
#include <string>

#include "scene/scene.hpp"

namespace luciole {

/// A camera's placement: at `eye`, looking at `target`, with `up` (any length, not along the view) upwards.
glm::dmat4 cameraToWorld(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up);

/// Puts what moves in a scene where it is at a frame, which may lie between two: sets members of cameras,
/// lights and objects, and nothing of the rest. The result doesn't depend on earlier poses. Objects that a
/// scale of 0 flattens show an empty mesh. Throws InputError naming the frame where there is no such pose: a
/// camera whose up is parallel to its view, a spot at its target, a transform that isn't finite; and what
/// checkPlaces() does.
void poseScene(Scene& scene, double frame);

/// Makes an object hang on a node, from the next pose on.
void attach(Scene& scene, const Attachment& object);

/// The same as poseScene for one camera or light; what is wrong, or "".
std::string poseCamera(const CameraMotion& motion, double frame, Camera& camera);
std::string poseLight(const LightMotion& motion, double frame, Light& light);

/// Aims a camera; what is wrong, or "". `up` is unit.
std::string aimCamera(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up, Camera& camera);
/// Aims a spot from its position; what is wrong, or "".
std::string aimSpot(const glm::dvec3& target, Light& light);

/// Where [azimuth, elevation, distance] (degrees, metres) around a target is: azimuth 0 lies towards +z, 90
/// towards +x; elevation is the angle above the horizon. Full turns end where they began, to the bit.
glm::dvec3 orbitEye(const glm::dvec3& orbit, const glm::dvec3& target);

/// translate · rotate (degrees about x, then y, then z) · scale.
glm::dmat4 placement(const glm::dvec3& translate, const glm::dvec3& degrees, const glm::dvec3& scale);
/// The same with a quaternion x, y, z, w of any length but 0.
glm::dmat4 placementByQuaternion(const glm::dvec3& translate, const glm::dvec4& rotation,
                                 const glm::dvec3& scale);

/// A camera or light that hangs on a node looks along its −z; what is wrong with that, or "".
std::string hangCamera(const glm::dmat4& node_to_world, Camera& camera);
std::string hangLight(const glm::dmat4& node_to_world, Light& light);

bool isFinite(const glm::dmat4& matrix);
/// Whether a transform leaves nothing to be seen.
bool isFlat(const glm::dmat4& matrix);

}  // namespace luciole
