#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "luciole/scene.hpp"

// What the page's gestures do to cameras and lights. dx and dy are in heights of the picture, right and down.
namespace luciole {

/// The camera of a scene file's text {"eye": …, "target": …}. Throws InputError.
Camera readViewCamera(const nlohmann::json& camera);

/// A camera as scene files have it. Reading it gives the camera to within rounding, and from then on the same
/// text and bits. target: what the camera turns around where it knows nothing ahead of it.
nlohmann::json viewCameraJson(const Camera& camera, const glm::dvec3& target);

/// The point ahead of a camera that is nearest to a place, no nearer than what it sees.
glm::dvec3 pointAhead(const Camera& camera, const glm::dvec3& place);

/// Moves a camera, as viewCameraJson() has it: {"orbit": [dx, dy]} around its target, {"pan": [dx, dy]} so
/// that the target follows the pointer, {"dolly": d} to the target, by a tenth of the way for each notch,
/// {"walk": [right, up, ahead]} in tenths of `length`, {"turn": [dx, dy]} on the spot. Returns false for
/// another gesture. Throws InputError for one that isn't finite.
bool moveCamera(const nlohmann::json& gesture, double length, nlohmann::json& camera);

/// The position, or of a directional light the direction, after {"drag_light": [light, dx, dy]}, as the
/// change "lights[i].position=…". "": another gesture. Throws InputError for a light that isn't there.
std::string moveLight(const nlohmann::json& gesture, const Scene& scene, const Camera& camera);

}  // namespace luciole
