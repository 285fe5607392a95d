#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "luciole/array_memory.hpp"
#include "luciole/warning.hpp"

namespace luciole {

enum class LightKind : std::uint8_t { kPoint, kDirectional, kSpot };

/// How a light with a finite range fades out: a factor of the distance d and the range r, exactly 0 for d ≥
/// r.
enum class RangeWindow : std::uint8_t {
  kSmooth,  ///< (1 − (d/r)⁴)²: value and slope reach zero at the range
  kKhr,     ///< 1 − (d/r)⁴, as KHR_lights_punctual recommends
};

enum class SpotFalloff : std::uint8_t {
  kExponent,  ///< OpenGL: cos(angle to the axis)^exponent inside the cutoff, 0 outside
  kCone,  ///< KHR_lights_punctual: from 1 inside inner_cone to 0 at the cutoff, square of a linear ramp in
          ///< cos
};

/// A light of the scene. Disabled lights are dropped by the loader.
struct Light {
  LightKind kind = LightKind::kPoint;
  /// The colours are over π: not candela and lux, but what makes a white surface show its luminance. So are
  /// those of glTF's lights and of sources.
  bool over_pi = false;
  /// In Scene::luminaires, of points and spots: their light is multiplied by the profile's candela over its
  /// peak, so that the colours are those of the brightest direction. −1: none.
  std::int32_t luminaire = -1;
  glm::dvec3 position{0.0};              ///< world, metres; not for directional lights
  glm::dvec3 direction{0.0, 0.0, -1.0};  ///< unit, world: the way that it shines; not for plain point lights
  /// Colours, linear, with the intensity multiplied in. ≥ 0 and finite. Defaults as the course text gives
  /// OpenGL's.
  glm::vec3 ambient{0.0f};
  glm::vec3 diffuse{1.0f};
  glm::vec3 specular{1.0f};
  glm::vec3 attenuation{1.0f, 0.0f, 0.0f};  ///< constant, linear (1/m), quadratic (1/m²); not all 0
  float range = std::numeric_limits<float>::infinity();  ///< metres, > 0
  RangeWindow window = RangeWindow::kSmooth;
  SpotFalloff falloff = SpotFalloff::kExponent;
  double cutoff = 0.0;  ///< spot: half angle in radians, 0 to π/2 (a cutoff of 180° makes a point light)
  double inner_cone = 0.0;  ///< kCone: radians, 0 ≤ inner_cone < cutoff
  float exponent = 0.0f;    ///< kExponent: ≥ 0
  bool shadow = false;
  /// The light's size, which gives its shadow a penumbra and changes nothing else. 0: a sharp shadow.
  double radius = 0.0;      ///< point and spot: of a sphere, metres
  double half_angle = 0.0;  ///< directional: half its angular diameter, radians, 0 to π/4
  std::uint32_t group = 0;  ///< in Scene::light_groups; see RenderSettings::light_groups
  /// The part of a larger source that it stands for: of a directional light the solid angle, sr; of others
  /// the area, m². Highlights that are narrower than what a surface sees of it are as wide. 0: it is a point.
  float cell = 0.0f;
  std::string name = {};  ///< may be empty; need not be unique

  bool operator==(const Light&) const = default;
};

/// How many lux a colour of 1 stands for, of a light that reaches a surface by so much: see Light::over_pi.
inline float luxOfColor(const Light& light) { return light.over_pi ? 3.14159265f : 1.0f; }

/// By which two angles a file says where light goes (IES LM-63). Of a luminaire that shines along a, whose up
/// u is perpendicular to that and whose left is l = u × a:
///
///     type  pole  azimuth 0  90 degrees
///     C     a     u          l           γ is the angle to the pole, C the azimuth
///     A     u     a          −l          V is a right angle less the angle to the pole, H the azimuth
///     B     −l    a          u           H is a right angle less the angle to the pole, V the azimuth
enum class PhotometricType : std::uint8_t { kC, kB, kA };

/// How much light a luminaire gives in each direction: a table over the angle to its pole and the azimuth,
/// bilinear between its entries, and 0 outside. See readLightProfile().
struct LightProfile {
  std::string name = {};  ///< the file's path, for messages
  PhotometricType type = PhotometricType::kC;
  /// Radians, ascending, two or more of each. polar: from 0 to π; azimuth: a range of up to 2π, which begins
  /// at −π or later and at π/2 at the latest.
  std::vector<double> polar = {}, azimuth = {};
  std::vector<float> candela = {};  ///< ≥ 0 and finite; [polar][azimuth]
  double peak = 0.0;                ///< candela, the largest entry
  double lumens = 0.0;              ///< of the table: its integral over all directions
  double lamp_lumens = 0.0;         ///< of the lamps, as the file says; 0: it doesn't
};

/// A luminaire: a profile and how it is turned. Its axis is Light::direction.
struct Luminaire {
  std::shared_ptr<const LightProfile> profile = {};
  glm::dvec3 up{0.0, 1.0, 0.0};  ///< world; any other direction takes its place where the axis is along it
};

/// The profile in a file of IES LM-63 (1986 to 2019), or of EULUMDAT if its name ends in .ldt. What is left
/// out or repaired is told in `warnings`. Throws InputError.
std::shared_ptr<const LightProfile> readLightProfile(const std::string& path, std::vector<Warning>& warnings);

/// A level of a Sky: row-major, texel (0,0) top left, r g b of each; linear, ≥ 0 and finite.
struct SkyLevel {
  int width = 0, height = 0;
  RawArray<float> texels = {};
};

/// What is seen in all directions, by latitude and longitude: the top row is overhead (+y), the middle
/// column ahead (−z), and +x lies to the right of it. levels[0] is the picture itself, each next level half
/// the size, down to a height of 1.
struct Sky {
  std::string name = {};  ///< the file's path, for messages
  std::vector<SkyLevel> levels = {};
};

/// A part of a sky, which a directional light stands for.
struct SkyCell {
  glm::dvec3 direction{0.0};  ///< unit: towards the middle of its light, in the sky's axes
  glm::vec3 light{0.0f};      ///< its irradiance, over π, of a surface that faces `direction`
  float solid_angle = 0.0f;   ///< sr
};

enum class SourceKind : std::uint8_t {
  kEnvironment,  ///< a Sky all around, which is the background, too
  kRectangle,    ///< a flat face that shines from its front alone, and isn't seen
  kDisc,         ///< the same, an ellipse
};

/// What shines and is no point: many lights take its place, see addSourceLights().
struct LightSource {
  SourceKind kind = SourceKind::kEnvironment;
  bool shadow = false;
  std::uint32_t count = 0;   ///< of lights that take its place; 0: it lights nothing
  std::uint32_t group = 0;   ///< as Light::group
  glm::vec3 radiance{1.0f};  ///< linear, ≥ 0; of an environment it multiplies the sky
  std::string name = {};     ///< may be empty; its lights have it
  // Of environments.
  std::shared_ptr<const Sky> sky = {};
  double rotate = 0.0;              ///< radians about +y, counter-clockwise as seen from above
  std::uint32_t divided = 0;        ///< the count that `cells` are of
  std::vector<SkyCell> cells = {};  ///< of the sky, `count` at most; made by addSourceLights()
  // Of faces. World, metres.
  glm::dvec3 position{0.0};              ///< of the middle
  glm::dvec3 direction{0.0, -1.0, 0.0};  ///< unit: the way it shines
  glm::dvec3 up{0.0, 0.0, -1.0};         ///< about the way its height goes; not parallel to `direction`
  double width = 1.0, height = 1.0;      ///< > 0
};

/// Lights that take the place of one source: the most, and those of a sky of which nothing else is said.
inline constexpr std::uint32_t kMostSourceLights = 1u << 20, kSkyLights = 4096;

/// A sky of a picture in memory: 3 × width × height numbers, r g b, row-major, the top left first, with width
/// = 2 × height. What isn't finite or is negative counts as 0, and what is above 10¹⁵ as that, with a
/// warning. Throws InputError for another shape. O(texels).
std::shared_ptr<const Sky> makeSky(int width, int height, std::span<const float> texels,
                                   const std::string& name, std::vector<Warning>& warnings);

/// The same of a file of any format that readImage() reads: by latitude and longitude, or a cross of a cube's
/// faces, 4:3 or 3:4, with the face ahead where the arms meet. Throws as readImage() does.
std::shared_ptr<const Sky> readSky(const std::string& path, std::vector<Warning>& warnings);

}  // namespace luciole
