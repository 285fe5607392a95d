#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "luciole/scene.hpp"
#include "scene/bounds.hpp"

namespace luciole {

enum class FieldShape : std::uint8_t {
  kBox,       ///< uniform in the box from `low` to `high`
  kBall,      ///< uniform in the ball around `center`
  kSphere,    ///< uniform on the surface of that ball
  kSurface,   ///< uniform on the scene's triangles, `offset` in front of them
  kClusters,  ///< around `clusters` centres, which are uniform in the box
  kCurve,     ///< along the curve through `points`, uniform in its length
  kList,      ///< the first `count` of `list`
};

/// Point lights at random positions, or a list of any lights. The same seed gives the same lights on every
/// machine, to the bit, and a smaller count gives the first lights of a larger one. Positions don't depend on
/// colours, intensities and ranges.
struct LightField {
  std::uint64_t count = 0;
  std::uint64_t seed = 0;
  FieldShape shape = FieldShape::kBox;
  glm::dvec3 low{0.0};  ///< world, metres; box and clusters
  glm::dvec3 high{1.0};
  glm::dvec3 center{0.0};  ///< ball and sphere
  /// Metres. Ball and sphere: the radius. Clusters: the largest distance of lights from their cluster's
  /// centre; most are near it. Curve: lights are uniform in a ball of this radius around their place on the
  /// curve.
  double radius = 1.0;
  double offset = 0.0;  ///< surface: metres along the triangle's normal, towards its front
  std::uint64_t clusters = 1;
  std::vector<glm::dvec3>
      points;               ///< curve: two or more. Catmull-Rom, uniform; ends as if it went on straight
  std::vector<Light> list;  ///< at least `count` lights
  bool as_listed = false;   ///< list: of the members below only `group` changes its lights
  // Appearance. A list's lights have their own colours, and their own ranges and attenuations unless given
  // here.
  std::vector<glm::vec3> colors{glm::vec3(1.0f)};  ///< each light picks one; never empty
  glm::vec2 intensity{1.0f};                       ///< multiplies the colour; uniform from x to y
  glm::vec2 range{
      std::numeric_limits<float>::infinity()};  ///< metres, uniform from x to y; or infinite, both
  std::optional<glm::vec3> attenuation{};       ///< as in Light
  /// If > 0, ranges are those of rangeForCutoff instead. With an attenuation of (0,0,1) a light has faded to
  /// this value there.
  double cutoff = 0.0;
  /// Lights have an infinite range and fade with the square of the distance. Their intensity is chosen so
  /// that other places of the field (see fieldPlaces()) get as much light on average as from lights with the
  /// range of kUsualDensity, for any count. Then `range`, `attenuation` and `cutoff` must have their
  /// defaults. Not for kList.
  bool no_range = false;
  bool shadow = false;
  std::uint32_t group = 0;  ///< as in Light
};

/// The most lights a scene may have.
inline constexpr std::uint64_t kMostLights = 100'000'000;

/// The shapes that scene files and options may name: all but the list.
inline constexpr std::string_view kFieldShapeNames = "box, ball, sphere, surface, clusters or curve";
/// The shape of one of these names; empty for any other name.
std::optional<FieldShape> fieldShapeNamed(std::string_view name);

/// A field with `count` 0, of a shape that fills or runs through a box: a ball or sphere whose diameter is
/// the mean of the box's sides, 32 clusters, a winding curve. Lights on surfaces lie in front of them by a
/// hundredth of the box's longest side. Colours are those of lamps and neon.
LightField fieldInBox(FieldShape shape, const Bounds& box);

/// Appends the field's lights to the scene's. FieldShape::kSurface uses the scene's triangles at its pose.
/// Throws InputError where there would be more than kMostLights or there is no surface to put them on,
/// MachineError where they don't fit into memory. O(count), and O(triangles) for kSurface.
void expandLightField(const LightField& field, Scene& scene);

/// Points at which a field's density and brightness are measured: the positions of kMeasuredPlaces lights of
/// the next seed, world space, metres. Not for FieldShape::kList. Throws as expandLightField.
std::vector<glm::dvec3> fieldPlaces(const LightField& field, const Scene& scene);

/// Enough places for a mean that is right to a few percent.
inline constexpr std::size_t kMeasuredPlaces = 1000;

/// The same for one field after the other, without copying the lights of those before.
void expandLightFields(std::span<const LightField> fields, Scene& scene);

}  // namespace luciole
