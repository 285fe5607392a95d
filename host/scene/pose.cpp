#include "scene/posing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <utility>

#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "scene/deform.hpp"
#include "scene/place_limits.hpp"

namespace luciole {
namespace {

/// Metres; points that are closer give no direction.
constexpr double kLeastDistance = 1e-18;
/// The least sine of the angle between two directions that aren't taken for parallel. 10⁻⁸ leaves half of a
/// double's digits.
constexpr double kLeastSine = 1e-8;

[[noreturn]] void fail(const Scene& scene, double frame, const std::string& thing, const std::string& what) {
  throw InputError(fmt::format("{}: {} at frame {}: {}", scene.name, thing, frame, what));
}

std::string cameraName(const Scene& scene, std::size_t index) {
  const std::string& name = scene.cameras[index].name;
  return name.empty() ? fmt::format("camera {}", index) : fmt::format("camera '{}'", forMessage(name));
}

/// Whether a vector's length is above 0 and finite, and so is its square.
bool hasDirection(const glm::dvec3& vector) {
  const double length = glm::length(vector);
  return length > 0 && std::isfinite(length);
}

glm::dvec4 valueOf(const Animation& animation, int curve, double frame, const glm::dvec4& otherwise) {
  return curve < 0 ? otherwise : valueAt(animation.curves[static_cast<std::size_t>(curve)], frame);
}

glm::dmat4 localTransform(const Animation& animation, const MovingNode& node, double frame) {
  const glm::dvec3 translate = valueOf(animation, node.translate, frame, glm::dvec4(0));
  const glm::dvec3 scale = valueOf(animation, node.scale, frame, glm::dvec4(1));
  if (node.quaternion) {
    const glm::dvec4 rotation = valueOf(animation, node.rotate, frame, {0, 0, 0, 1});
    return placementByQuaternion(translate, rotation, scale);
  }
  return placement(translate, glm::dvec3(valueOf(animation, node.rotate, frame, glm::dvec4(0))), scale);
}

std::vector<glm::dmat4> nodeTransforms(const Scene& scene, double frame) {
  const std::vector<MovingNode>& nodes = scene.animation.nodes;
  std::vector<glm::dmat4> worlds;
  worlds.reserve(nodes.size());
  for (const MovingNode& node : nodes) {
    const glm::dmat4 local = node.before * localTransform(scene.animation, node, frame);
    worlds.push_back(node.parent < 0 ? local : worlds[static_cast<std::size_t>(node.parent)] * local);
    if (!isFinite(worlds.back())) fail(scene, frame, "a moving node", "its transform is not finite");
  }
  return worlds;
}

/// The weights of a deformation's targets at a frame.
std::vector<double> weightsAt(const Animation& animation, const Deformation& deformation, double frame) {
  std::vector<double> weights = deformation.weights;
  for (std::size_t i = 0; i < weights.size() && !deformation.weight_curves.empty(); i += 4) {
    const glm::dvec4 four = valueOf(animation, deformation.weight_curves[i / 4], frame, glm::dvec4(0));
    for (std::size_t j = i; j < std::min(i + 4, weights.size()); ++j) weights[j] = four[int(j - i)];
  }
  return weights;
}

/// Deforms a mesh, unless it shows this pose already.
void poseMesh(Scene& scene, const std::vector<glm::dmat4>& worlds, double frame, Deformation& deformation) {
  std::vector<double> pose = poseNumbers(deformation, worlds, weightsAt(scene.animation, deformation, frame));
  if (pose == deformation.pose) return;
  deformation.pose.clear();  // should there be no such shape
  Mesh& mesh = scene.meshes[deformation.mesh];
  const std::string fault = deform(deformation, pose, mesh);
  if (!fault.empty()) fail(scene, frame, fmt::format("mesh '{}'", forMessage(mesh.name)), fault);
  deformation.pose = std::move(pose);
}

/// Sets a direction to a curve's, if that has keys. Returns what is wrong, or "".
std::string turn(const Curve& curve, double frame, glm::dvec3& direction) {
  if (curve.keys.empty()) return "";
  const glm::dvec3 way = valueAt(curve, frame);
  const double length = glm::length(way);
  if (!(length >= kLeastSine)) return "it turns from one direction to the opposite one, which is no way";
  direction = way / length;
  return "";
}

/// Sets a light's colours to 0 while a scale of 0 hides it, and restores them afterwards.
void setLightShown(bool shown, Light& light, Attachment& attachment) {
  std::optional<glm::mat3>& kept = attachment.hidden_colors;
  if (shown == !kept.has_value()) return;
  const glm::mat3 colors = kept.value_or(glm::mat3(0.0f));
  if (shown)
    kept.reset();
  else
    kept = glm::mat3(light.ambient, light.diffuse, light.specular);
  light.ambient = colors[0];
  light.diffuse = colors[1];
  light.specular = colors[2];
}

}  // namespace

glm::dmat4 cameraToWorld(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up) {
  const glm::dvec3 back = glm::normalize(eye - target);
  const glm::dvec3 right = glm::normalize(glm::cross(up, back));
  return {glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0),
          glm::dvec4(eye, 1)};
}

void poseScene(Scene& scene, double frame) {
  Animation& animation = scene.animation;
  const std::vector<glm::dmat4> worlds = nodeTransforms(scene, frame);
  for (Deformation& deformation : animation.deformations) poseMesh(scene, worlds, frame, deformation);
  const auto placeOf = [&](const Attachment& attachment) {
    const glm::dmat4 place = worlds[attachment.node] * attachment.after;
    if (!isFinite(place))
      fail(scene, frame, "what is attached to a moving node", "its transform is not finite");
    return place;
  };
  for (const Attachment& attachment : animation.objects) {
    Object& object = scene.objects[attachment.index];
    object.object_to_world = placeOf(attachment);
    object.mesh = hidesObjects(object.object_to_world) ? static_cast<std::uint32_t>(animation.no_mesh)
                                                       : attachment.mesh;
  }
  for (const Attachment& attachment : animation.attached_cameras) {
    const std::string fault = attachCamera(placeOf(attachment), scene.cameras[attachment.index]);
    if (!fault.empty()) fail(scene, frame, cameraName(scene, attachment.index), fault);
  }
  for (Attachment& attachment : animation.attached_lights) {
    Light& light = scene.lights[attachment.index];
    setLightShown(attachLight(placeOf(attachment), scene.luminaires, light).empty(), light, attachment);
  }
  for (const CameraMotion& motion : animation.cameras) {
    const std::string fault = poseCamera(motion, frame, scene.cameras[motion.camera]);
    if (!fault.empty()) fail(scene, frame, cameraName(scene, motion.camera), fault);
  }
  for (const LightMotion& motion : animation.lights) {
    const std::string fault = poseLight(motion, frame, scene.lights[motion.light]);
    if (!fault.empty()) fail(scene, frame, fmt::format("light {}", motion.light), fault);
  }
  for (const LightMotion& motion : animation.sources) {
    const std::string fault = poseSource(motion, frame, scene.sources[motion.light]);
    if (!fault.empty()) fail(scene, frame, fmt::format("source {}", motion.light), fault);
  }
  const bool sources_move =
      !animation.sources.empty() || !animation.objects.empty() || !animation.deformations.empty();
  if (scene.source_lights > 0 && sources_move) addSourceLights(scene);
  checkPlaces(scene);
}

void attach(Scene& scene, const Attachment& object) {
  int& no_mesh = scene.animation.no_mesh;
  if (no_mesh < 0) {
    no_mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.emplace_back();
  }
  scene.animation.objects.push_back(object);
}

std::string poseCamera(const CameraMotion& motion, double frame, Camera& camera) {
  const glm::dvec3 target = valueAt(motion.target, frame);
  const glm::dvec3 place = valueAt(motion.eye, frame);
  if (!motion.fov_y.keys.empty()) camera.fov_y = glm::radians(valueAt(motion.fov_y, frame).x);
  return aimCamera(motion.orbits ? orbitEye(place, target) : place, target, motion.up, camera);
}

std::string poseLight(const LightMotion& motion, double frame, Light& light) {
  if (!motion.position.keys.empty()) light.position = valueAt(motion.position, frame);
  if (!motion.range.keys.empty()) light.range = static_cast<float>(valueAt(motion.range, frame).x);
  if (!motion.color.keys.empty() || !motion.intensity.keys.empty()) {
    light.ambient = motion.ambient;
    light.diffuse = motion.diffuse;
    light.specular = motion.specular;
    if (!motion.color.keys.empty())
      light.diffuse = light.specular = glm::vec3(glm::dvec3(valueAt(motion.color, frame)));
    const float intensity = motion.intensity.keys.empty()
                                ? motion.own_intensity
                                : static_cast<float>(valueAt(motion.intensity, frame).x);
    light.ambient *= intensity;
    light.diffuse *= intensity;
    light.specular *= intensity;
  }
  if (!motion.target.keys.empty()) return aimSpot(glm::dvec3(valueAt(motion.target, frame)), light);
  return turn(motion.direction, frame, light.direction);
}

std::string poseSource(const LightMotion& motion, double frame, LightSource& source) {
  if (!motion.rotate.keys.empty()) source.rotate = glm::radians(valueAt(motion.rotate, frame).x);
  if (!motion.position.keys.empty()) source.position = valueAt(motion.position, frame);
  if (!motion.color.keys.empty() || !motion.intensity.keys.empty()) {
    source.radiance =
        motion.color.keys.empty() ? motion.diffuse : glm::vec3(glm::dvec3(valueAt(motion.color, frame)));
    source.radiance *= motion.intensity.keys.empty() ? motion.own_intensity
                                                     : static_cast<float>(valueAt(motion.intensity, frame).x);
  }
  if (source.kind == SourceKind::kEnvironment) return "";
  const std::string fault = turn(motion.direction, frame, source.direction);
  if (!fault.empty()) return fault;
  return glm::length(glm::cross(source.up, source.direction)) < kLeastSine
             ? "its up is parallel to its direction"
             : "";
}

std::string aimCamera(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up, Camera& camera) {
  const double distance = glm::length(target - eye);
  if (!(distance >= kLeastDistance)) return "eye and target are the same point";
  if (glm::length(glm::cross((target - eye) / distance, up)) < kLeastSine)
    return "up is parallel to the view from eye to target";
  camera.camera_to_world = cameraToWorld(eye, target, up);
  camera.target = target;
  camera.up = up;
  return "";
}

std::string aimSpot(const glm::dvec3& target, Light& light) {
  const glm::dvec3 ray = target - light.position;
  if (!(glm::length(ray) >= kLeastDistance)) return "is the light's position, so it has no direction";
  light.direction = glm::normalize(ray);
  return "";
}

glm::dvec3 orbitEye(const glm::dvec3& orbit, const glm::dvec3& target) {
  const double azimuth = glm::radians(std::remainder(orbit.x, 360.0)), elevation = glm::radians(orbit.y);
  const double out = orbit.z * std::cos(elevation);
  return target + glm::dvec3(out * std::sin(azimuth), orbit.z * std::sin(elevation), out * std::cos(azimuth));
}

glm::dmat4 placement(const glm::dvec3& translate, const glm::dvec3& degrees, const glm::dvec3& scale) {
  const glm::dvec3 angles = glm::radians(degrees);
  glm::dmat4 matrix = glm::translate(glm::dmat4(1.0), translate);
  matrix = glm::rotate(matrix, angles.z, {0, 0, 1});
  matrix = glm::rotate(matrix, angles.y, {0, 1, 0});
  matrix = glm::rotate(matrix, angles.x, {1, 0, 0});
  return glm::scale(matrix, scale);
}

glm::dmat4 placementByQuaternion(const glm::dvec3& translate, const glm::dvec4& rotation,
                                 const glm::dvec3& scale) {
  const glm::dquat turn(rotation.w, rotation.x, rotation.y, rotation.z);
  return glm::scale(glm::translate(glm::dmat4(1.0), translate) * glm::mat4_cast(glm::normalize(turn)), scale);
}

std::string attachCamera(const glm::dmat4& node_to_world, Camera& camera) {
  const glm::dvec3 back(node_to_world[2]), up(node_to_world[1]);
  const glm::dvec3 right = glm::cross(up, back);
  if (!hasDirection(right) || !hasDirection(back)) return "its scale leaves a camera no direction";
  const glm::dvec3 x = glm::normalize(right), z = glm::normalize(back);
  camera.camera_to_world = {glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0),
                            node_to_world[3]};
  return "";
}

std::string attachLight(const glm::dmat4& node_to_world, std::vector<Luminaire>& luminaires, Light& light) {
  if (glm::dmat3(node_to_world) == glm::dmat3(0.0)) return "its scale is 0";
  light.position = glm::dvec3(node_to_world[3]);
  if (light.kind == LightKind::kPoint && light.luminaire < 0) return "";
  const glm::dvec3 back(node_to_world[2]), right(node_to_world[0]);
  if (!hasDirection(back)) return "its scale leaves a light no direction";
  if (light.luminaire >= 0) {
    if (!hasDirection(right)) return "its scale leaves a luminaire no direction";
    luminaires[std::size_t(light.luminaire)].up = glm::normalize(right);
  }
  light.direction = -glm::normalize(back);
  return "";
}

bool isFinite(const glm::dmat4& matrix) {
  for (int i = 0; i < 16; ++i) {
    if (!std::isfinite(matrix[i / 4][i % 4])) return false;
  }
  return true;
}

bool hidesObjects(const glm::dmat4& matrix) {
  const glm::dvec3 x(matrix[0]), y(matrix[1]), z(matrix[2]);
  return glm::cross(x, y) == glm::dvec3(0) && glm::cross(y, z) == glm::dvec3(0) &&
         glm::cross(z, x) == glm::dvec3(0);
}

}  // namespace luciole
