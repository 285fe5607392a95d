#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "luciole/scene.hpp"
#include "luciole/shader.hpp"

namespace luciole {

/// Where a surface's normals and colours are evaluated.
enum class Shading : std::uint8_t {
  kFlat,     ///< the triangle's own normal
  kGouraud,  ///< colours lit at the vertices, interpolated
  kPhong,    ///< normals interpolated
};

/// How shadows are computed.
enum class ShadowMethod : std::uint8_t {
  kOff,
  kHard,       ///< by a map: the texel that the point falls into
  kPcf,        ///< by a map: the nearest texels, weighted (percentage-closer filtering)
  kSoft,       ///< by a map: a disc as wide as the penumbra that the light's size gives
  kExact,      ///< by the triangles themselves: whether one is between the point and the light's centre
  kSoftExact,  ///< likewise, for samples of the light's size: the share of them that the point sees
  kAuto,       ///< for each light kExact, or kHard if that is estimated to be at least twice as fast
};

/// How the shadows of a light are computed.
enum class ShadowWay : std::uint8_t {
  kNone,   ///< it casts none
  kMap,    ///< by a shadow map
  kBeams,  ///< exactly, by beams through a tree of triangles
};

/// How much shadow maps may take.
struct ShadowLimits {
  int size = 2048;  ///< texels a side of a cascade and of a spot's map; a cube's face: half
  std::size_t bytes = std::size_t(512) << 20;  ///< of all maps together
};

/// Texels a side: the fewest of a face, and the most that ShadowLimits::size may ask for.
inline constexpr int kSmallestFace = 16, kLargestFace = 16384;

/// The lights that a pixel is shaded by.
enum class Culling : std::uint8_t {
  kNone,   ///< all
  kTiles,  ///< those that may reach its square of pixels
};

/// How to light a G-buffer, apart from what the scene says.
struct ShadeSettings {
  Model model = Model::kPhong;  ///< of surfaces that choose none
  /// Surfaces have different models: those of GBuffer::model. Set by render() and shade().
  bool material_models = false;
  /// The text of the models from files that surfaces have. Set by render() and shade().
  std::string user_text = {};
  Culling culling = Culling::kTiles;
  int tile_size = 4;  ///< pixels a side of the squares that share a light list: 4, 8 or 16
  ShadowMethod shadows = ShadowMethod::kHard;
  bool shadow_layer = false;  ///< also write the mean visibility of lights that cast shadows
  /// With ShadowMethod::kAuto the way of each light. Empty: render() and shade() choose.
  std::vector<ShadowWay> shadow_ways{};
  int soft_samples = 16;  ///< for each light with a size, with ShadowMethod::kSoftExact, 1 to 1024
  int pcf_width = 2;      ///< texels a side that ShadowMethod::kPcf weighs, 2 to 6; 2 is bilinear
  ShadowLimits shadow_limits{};
  int log2_degree = 7;  ///< of the polynomial that approximates log2, 3 to 9
  int exp2_degree = 6;  ///< of the polynomial that approximates exp2, 2 to 7
  /// E, 0 to 1: many lights need not be summed one by one, as long as each pixel's error stays below
  /// E·max(light_error_floor, colour) in each channel. For points without shadows the error is proven. Points
  /// that cast them, directions and faces are sampled, if no map's shadow was asked for: then the pixel's
  /// interval holds with the probability `confidence`. 0: each light is summed by itself.
  float light_error = 0;
  float light_error_floor = 1;  ///< above 0; a small one makes light_error a share of the colour
  double confidence = 0.99;     ///< 0.5 to 0.9999
  std::uint32_t seed = 0;       ///< of the samples: each gives another error
  /// Use clusters and samples even where summing each light is estimated to be faster: for tests and
  /// measurements.
  bool always_clusters = false;
};

/// Part of a picture, in pixels from its top left corner.
struct Crop {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Extra layers of an EXR.
enum class Aov : std::uint8_t {
  kPosition,
  kNormal,
  kDepth,
  kDiffuse,
  kMaterial,
  // Parts of the picture's light. The picture is their sum.
  kAmbient,  ///< ambient light: the scene's, and the lights' own
  kDiffuseLight,
  kSpecularLight,
  kEmission,  ///< and the background
  kFog,       ///< the fog's own colour
  /// The light that arrives at a surface, whatever it reflects: Σ colour · falloff · N·L of the lights that
  /// it sees, before any fog, for which exposure doesn't count. Where a light's colour is its intensity in
  /// candela, with an attenuation of (0, 0, 1), of a directional light its lux, and of a source its radiance
  /// in candela a square metre, these are lux. R G B; of coloured light the lux are the luminance, 0.2126 R +
  /// 0.7152 G + 0.0722 B. Ambient light isn't in it.
  kIlluminance,
  // Of pictures of a scene, not of a G-buffer.
  kObjectId,        ///< index in Scene::objects; -1 for background
  kMaterialId,      ///< index in Scene::materials; -1 for background
  kCryptoObject,    ///< Cryptomatte: the objects of the pixel's samples and their coverage
  kCryptoMaterial,  ///< the same of materials
  kLightCount,      ///< lights in range of the pixel
  kListLength,  ///< lights in the list of the pixel's square, all lights if there are no lists. Squares are
                ///< counted from the band's first pixel, so it depends on the band and the crop
  kShadow,
  /// Half widths of the intervals that hold the colour (ShadeSettings::light_error), r g b in the units of R
  /// G B: the mean over the samples. With Shading::kGouraud the largest of any vertex.
  kLightError,
  kLightProof,    ///< r g b: the share of kLightError that is proven; the rest has ShadeSettings::confidence
  kShadingCount,  ///< points that were shaded for all samples of the pixel
  kCount
};

/// The samples of a pixel that are shaded.
enum class SampleShading : std::uint8_t {
  kShared,  ///< one point for those that see the same surface, and each sample where light is uneven
  kAll,     ///< each of them, at its own place
};

struct RenderSettings {
  glm::ivec2 size{1280, 720};
  Camera camera = {};
  std::optional<Crop> crop = {};
  int samples = 1;  ///< per pixel, at the points of a Hammersley set
  SampleShading sample_shading = SampleShading::kShared;
  Shading shading = Shading::kPhong;
  ShadeSettings shade = {};
  /// Functions of the user's (ShaderKind::kSurface) that change surfaces before they are lit, one after
  /// another.
  std::vector<Shader> surfaces = {};
  /// Layers. kLightError, kShadingCount, Cryptomattes and parts of the light are of all samples; the others
  /// show the first sample, or the point that is shaded for it.
  std::vector<Aov> aovs = {};
  /// Adds three channels for each group of lights that has any, and three for the rest: ambient light,
  /// emission, fog and background. Their sum is the picture. With these or with parts of the light
  /// Shading::kGouraud is refused, and Aov::kLightError adds a layer of bounds to each of them.
  bool light_groups = false;
  /// Functions that change the lit colours, after exposure, by what is around a pixel, one after another.
  /// Every sample of a pixel is lit and goes through them before the mean is taken. Layers and alpha stay.
  std::vector<Shader> screens = {};
  float exposure = 0;  ///< stops: colours are multiplied by 2^exposure
  /// Adds a channel A: the share of a pixel's samples that show a surface. The colours are then those of the
  /// surfaces alone, times A: what they lack is (1 − A) × 2^exposure × the scene's background. Objects that
  /// the fog hides are drawn too: they look like the scene's background, but hide any other.
  bool alpha = false;
  /// Also count, for the statistics, the lights in every pixel's list and those in its range.
  bool count_lights = false;
  /// Rows that are rendered at a time, at most; 0: chosen by the memory that is left. The picture's colours
  /// don't depend on it; with a light error only if it is a multiple of 64.
  int band_height = 0;
  /// Called after each pass over a band, if set: how many rows are done, of how many, in all passes together.
  std::function<void(int done, int rows)> on_pass = {};
  /// Called once if set and a picture has waited 0.3 s for its kernels to be compiled.
  std::function<void()> on_long_compile = {};

  /// Whether `aovs` has this layer.
  bool wants(Aov aov) const { return std::find(aovs.begin(), aovs.end(), aov) != aovs.end(); }
};

struct WriteOptions;

/// A setting of a picture or of its file, as people say it: a name, and a value as text. Command lines and
/// other languages make their options from these rows, so that all have the same names, values and defaults.
struct NamedSetting {
  const char* name;          ///< lower case, words apart by "_"
  std::string help;          ///< what it does, in one line
  std::string initial = {};  ///< the value of a picture that doesn't say it; "": as `help` says
  /// The values that there are. Empty: a text of another kind.
  std::vector<std::string> choices = {};
  bool is_flag = false;  ///< its choices are "on" and "off"
  bool is_list = false;  ///< several choices, with commas between them
  /// Numbers: the least and the greatest. Both 0: not a number.
  double least = 0, greatest = 0;
  bool is_whole = false;  ///< a whole number
  /// Takes the value. Null: of a file, or what depends on the scene: models and shadow casters.
  void (*set)(const std::string& value, RenderSettings& settings) = nullptr;
  void (*set_file)(const std::string& value, WriteOptions& options) = nullptr;  ///< the same of a file
};

/// All of them.
const std::vector<NamedSetting>& namedSettings();

/// The row of this name. Throws InputError for another name, with a suggestion.
const NamedSetting& namedSetting(std::string_view name);

/// What is wrong with a value, as "expected 1 to 1024, got 0"; "" if it is right.
std::string settingFault(const NamedSetting& setting, const std::string& value);

/// Values by their names.
using SettingValues = std::map<std::string, std::string, std::less<>>;

/// All names with their initial values.
SettingValues initialSettings();

/// Sets what the values say; "" says nothing. A size of a width alone keeps the shape of settings.size.
/// Throws InputError that names the setting: "samples: expected 1 to 1024, got 0".
void applySettings(const SettingValues& values, RenderSettings& settings);

/// The same for those of files.
void applySettings(const SettingValues& values, WriteOptions& options);

/// Decides which lights cast shadows by the value of "cast_shadows". "": those that are marked, or all where
/// none is and shadows are asked for.
void castShadows(const std::string& who, bool asked_for, Scene& scene);

/// Sets how many lights take the place of each source by the value of "light_count". "": as the scene says;
/// "auto" is left to Renderer::chooseLightCounts().
void setLightCounts(const std::string& how_many, Scene& scene);

}  // namespace luciole
