#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "luciole/deformation.hpp"

namespace luciole {

/// How a curve goes from one key to the next.
enum class Interpolation : std::uint8_t {
  kStep,    ///< it keeps a key's value until the next key
  kLinear,  ///< straight
  kSlerp,   ///< unit quaternions (x, y, z, w): the shorter arc between two, at a constant speed
  kCubic,   ///< Hermite's cubic through values and slopes
};

struct CurveKey {
  double frame = 0;
  glm::dvec4 value{0.0};      ///< unused components are 0
  glm::dvec4 slope_in{0.0};   ///< kCubic: change per frame, before the key
  glm::dvec4 slope_out{0.0};  ///< and after it
};

/// A value that changes with the frame. Before the first key it has the first key's value, after the last key
/// the last one's.
struct Curve {
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<CurveKey> keys = {};  ///< in ascending order of frames; empty: the value isn't animated
};

/// A curve that is the same at every frame.
inline Curve constantCurve(const glm::dvec4& value) { return {Interpolation::kLinear, {{0.0, value}}}; }

/// The value at a frame, which may be fractional. At a key's frame it is the key's value to the bit. The
/// curve must have at least one key. O(log keys).
glm::dvec4 valueAt(const Curve& curve, double frame);

/// Makes a curve cubic, with continuous slopes that don't overshoot: between two keys every component stays
/// between their values, so a range stays positive and a field of view below 180°. Slopes by Steffen 1990, "A
/// simple method for monotonic interpolation in one dimension". Two keys give a straight line. The curve must
/// have at least one key.
void makeSmooth(Curve& curve);

/// A moving coordinate frame: world = parent's world · before · translate · rotate · scale. `translate`,
/// `rotate` and `scale` are indices into Animation::curves; -1: none.
struct MovingNode {
  int parent = -1;  ///< an earlier node; -1: the world
  glm::dmat4 before{1.0};
  int translate = -1;       ///< metres
  int rotate = -1;          ///< degrees about x, then y, then z
  bool quaternion = false;  ///< `rotate` is a quaternion x, y, z, w of any length but 0 instead
  int scale = -1;           ///< factors
};

/// An object, camera or light that is attached to a node: its transform to world space is the node's · after.
struct Attachment {
  std::uint32_t index = 0;  ///< in Scene::objects, cameras or lights
  std::uint32_t node = 0;   ///< in Animation::nodes
  glm::dmat4 after{1.0};
  std::uint32_t mesh = 0;  ///< of an object: its mesh, unless a scale of 0 flattens it
  /// The ambient, diffuse and specular colours of a light that a scale of 0 hides at this pose. Its own are 0
  /// then. Set by poseScene().
  std::optional<glm::mat3> hidden_colors = {};
};

/// A camera that looks from a moving place at a moving target. `eye` and `target` have at least one key.
struct CameraMotion {
  std::uint32_t camera = 0;  ///< in Scene::cameras
  bool orbits = false;
  /// World, metres. With `orbits` azimuth and elevation in degrees and the distance from the target in
  /// metres: azimuth 0 lies towards +z, 90 towards +x; elevation is the angle above the horizon.
  Curve eye = {};
  Curve target = {};
  glm::dvec3 up{0.0, 1.0, 0.0};
  Curve fov_y = {};  ///< degrees; without keys the camera's own stays
};

/// A light whose members change. A curve without keys leaves the light's own.
struct LightMotion {
  std::uint32_t light = 0;  ///< in Scene::lights
  Curve position = {};
  Curve direction = {};  ///< any length but 0
  Curve target = {};     ///< world; instead of `direction`: what a spot shines at
  Curve color = {};
  Curve intensity = {};
  Curve range = {};
  Curve rotate = {};  ///< of an environment: degrees, as LightSource::rotate
  glm::vec3 ambient{0.0f}, diffuse{0.0f}, specular{0.0f};  ///< the light's colours without the intensity
  float own_intensity = 1.0f;
};

/// The animation of a scene. Empty: nothing moves.
struct Animation {
  double frame_rate = 24;  ///< frames a second, for files with times in seconds: frame 1 is time 0
  std::vector<Curve> curves = {};
  std::vector<MovingNode> nodes = {};  ///< parents first
  std::vector<Attachment> objects = {}, attached_cameras = {}, attached_lights = {};
  std::vector<CameraMotion> cameras = {};
  std::vector<LightMotion> lights = {};
  std::vector<LightMotion> sources = {};  ///< LightMotion::light is in Scene::sources
  std::vector<Deformation> deformations = {};
  /// In Scene::meshes: the empty mesh that hidden objects get. -1: no object is attached.
  int no_mesh = -1;
};

}  // namespace luciole
