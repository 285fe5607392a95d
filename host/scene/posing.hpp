#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "luciole/pose.hpp"

// The parts of poseScene(), for the readers of scene files. Functions that return a text return what is
// wrong, or "".
namespace luciole {

/// Poses one camera, light or source at a frame.
std::string poseCamera(const CameraMotion& motion, double frame, Camera& camera);
std::string poseLight(const LightMotion& motion, double frame, Light& light);
std::string poseSource(const LightMotion& motion, double frame, LightSource& source);

/// Places a camera at `eye`, looking at `target`. `up` is unit. Wrong: `eye` is `target`, or `up` is parallel
/// to the view.
std::string aimCamera(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up, Camera& camera);
/// Aims a spot from its position at a target.
std::string aimSpot(const glm::dvec3& target, Light& light);

/// The position at [azimuth, elevation, distance] (degrees, metres) around a target. Azimuth 0 lies towards
/// +z, 90 towards +x; elevation is the angle above the horizon. Azimuths that differ by 360 give the same
/// bits.
glm::dvec3 orbitEye(const glm::dvec3& orbit, const glm::dvec3& target);

/// The transform translate · rotate (degrees about x, then y, then z) · scale.
glm::dmat4 placement(const glm::dvec3& translate, const glm::dvec3& degrees, const glm::dvec3& scale);
/// The same with a quaternion x, y, z, w of any length but 0.
glm::dmat4 placementByQuaternion(const glm::dvec3& translate, const glm::dvec4& rotation,
                                 const glm::dvec3& scale);

/// Places a camera or light that is attached to a node: it looks along the node's −z. Wrong: a scale of 0
/// that leaves it no direction or hides a light.
std::string attachCamera(const glm::dmat4& node_to_world, Camera& camera);
/// luminaires: of the scene. The light's own, which no other light may have, is turned to the node's +x.
std::string attachLight(const glm::dmat4& node_to_world, std::vector<Luminaire>& luminaires, Light& light);

/// Whether all 16 elements are finite.
bool isFinite(const glm::dmat4& matrix);
/// Whether a transform makes every object a line or a point, so that nothing of it shows. One that flattens
/// objects along one axis alone doesn't.
bool hidesObjects(const glm::dmat4& matrix);

}  // namespace luciole
