#pragma once

#include <array>
#include <bitset>
#include <string>
#include <vector>

#include "lights/exact_reason.hpp"
#include "raster/rasterize.hpp"
#include "scene/model.hpp"
#include "scene/scene.hpp"
#include "shadow/maps/shadow_maps.hpp"

namespace luciole {

/// What scenes may use. A program is compiled for a set of features and contains the code of no others.
enum class Feature : unsigned {
  kPointLights,
  kDirectionalLights,
  kSpotLights,
  kSpotExponent,
  kSpotCone,
  kAttenuation,
  kSmoothWindow,
  kKhrWindow,
  kSpecular,
#define MODEL_FEATURE(name, typed, shown, meaning, diffuse, specular) k##name,
  EACH_MODEL(MODEL_FEATURE)  // in the order of Model
#undef MODEL_FEATURE
  kAmbient,
  kLightAmbient,
  kEmission,
  kParallelShadows,
  kPerspectiveShadows,
  kCubeShadows,
  kPcf,
  kSoft,
  kExact,
  kSoftExact,
  kHoles,
  kLift,
  kNormalMaps,
  kFogLinear,
  kFogExp,
  kFogExp2,
  kFogPerChannel,
  kFogRadial,
  kParallelView,
  kLightLists,
  kLongSums,
  kOutputShadow,
  kClusteredLights,
  kClusteredHighlights,
  kMaterialModels,
  kCount
};
inline constexpr std::size_t kFeatureCount = static_cast<std::size_t>(Feature::kCount);

/// The feature table: row i describes Feature i. kernels/features.clh has a fallback for each define.
struct FeatureRow {
  const char* define;   ///< the kernels' macro, 0 or 1; for a model, the name of its number in the kernels
  const char* name;     ///< in --stats
  const char* meaning;  ///< what the compiled code does
};
extern const std::array<FeatureRow, kFeatureCount> kFeatureTable;

class FeatureSet {
 public:
  bool has(Feature feature) const { return bits_[static_cast<std::size_t>(feature)]; }
  void set(Feature feature, bool on = true) { bits_[static_cast<std::size_t>(feature)] = on; }
  bool operator==(const FeatureSet&) const = default;
  bool shadowMaps() const {
    return has(Feature::kParallelShadows) || has(Feature::kPerspectiveShadows) || has(Feature::kCubeShadows);
  }
  bool shadows() const { return shadowMaps() || has(Feature::kExact); }

 private:
  std::bitset<kFeatureCount> bits_;
};

/// The names in --stats of the features that are set, in the table's order.
std::vector<std::string> featureNames(const FeatureSet& features);

/// What surfaces need of shading, whether they come from a scene's materials or from a G-buffer file.
struct SurfaceTraits {
  bool specular = false;
  bool emission = false;
  bool smooth = false;  ///< shadow tests start above facets (raster/lift.hpp)
  bool normal_maps = false;
  ModelChoices models{1};  ///< that they choose
};
/// The traits of a scene's materials and meshes. `smooth` is set only if a light casts shadows.
SurfaceTraits materialTraits(const Scene& scene);

enum class Culling : std::uint8_t { kNone, kTiles };

/// The feature of a program that compiles this model.
constexpr Feature featureOf(Model model) { return Feature(unsigned(Feature::kPhong) + unsigned(model)); }

constexpr bool isModel(Feature feature) {
  return feature >= Feature::kPhong && unsigned(feature) < unsigned(Feature::kPhong) + kModelNames.size();
}

/// How to light a G-buffer, apart from what the scene says.
struct ShadeSettings {
  Model model = Model::kPhong;  ///< of surfaces that choose none
  /// Surfaces have different models: G-buffers say which (GBuffer::model). See chooseModel().
  bool material_models = false;
  Culling culling = Culling::kTiles;
  int tile_size = 4;  ///< pixels a side of the squares that share a light list: 4, 8 or 16
  ShadowMethod shadows = ShadowMethod::kHard;
  bool shadow_layer = false;  ///< also write how visible, on average, lights with shadows are
  /// With ShadowMethod::kAuto the way of each light. Empty: a picture's are chosen by shadowWays, and where
  /// no picture is known, all are exact.
  std::vector<ShadowWay> shadow_ways{};
  int soft_samples =
      16;             ///< of a light that has a size, with ShadowMethod::kSoftExact, 1 to kMostSoftSamples
  int pcf_width = 2;  ///< texels a side that ShadowMethod::kPcf weighs, 2 to 6; 2 is bilinear
  ShadowLimits shadow_limits{};
  int log2_degree = 7;  ///< degrees of the polynomials in kernels/math.clh, which lists those to choose from
  int exp2_degree = 6;
  /// E, 0 to 1: lights may be stood for by clusters of them as long as each pixel's error stays below
  /// E·max(1, colour) in each channel. 0: each light is summed by itself.
  float light_error = 0;
  /// Clusters stand for lights even where summing each is less work (clustersPay): to test and measure them.
  bool always_clusters = false;
};

/// Sets the model of a picture whose surfaces choose these: the one that all have, or `material_models`.
void chooseModel(const ModelChoices& choices, ShadeSettings& settings);

/// Who tells of a light's shadows in a picture with these settings. light: its index in the scene.
ShadowWay shadowWay(const Scene& scene, std::size_t light, const ShadeSettings& settings);

/// Whether clusters stand for some of the scene's lights in a picture with these settings: where the settings
/// allow it, for those without an ExactReason, if there are enough of them (clustersPay). view: of the
/// picture. O(lights).
bool standsForLights(const Scene& scene, const View& view, SurfaceTraits surfaces,
                     const ShadeSettings& settings);

/// Which of a picture's lights others may stand for.
LightUse lightUse(const ShadeSettings& settings);

/// The features that this scene's lights, fog and surfaces need, seen by this camera. clustered: as
/// standsForLights() says.
FeatureSet neededFeatures(const Scene& scene, const Camera& camera, SurfaceTraits surfaces,
                          const ShadeSettings& settings, bool clustered = false);

/// The features that decide where shadow maps are looked up. kernels/find_needed.cl depends on no others, so
/// scenes that differ only in others share these programs.
FeatureSet lookupFeatures(const FeatureSet& features);

/// The features that kernels/beam_shadows.cl depends on.
FeatureSet beamFeatures(const FeatureSet& features);

/// What of a program's features kernels need that light pixels by clusters.
FeatureSet clusterFeatures(const FeatureSet& features);

/// The G-buffer groups that a program with these features reads.
PlaneSet neededPlanes(const FeatureSet& features);

/// The compiler's -D options for these features: one for each row of the table, and MODELS for all models.
std::string featureDefines(const FeatureSet& features);

/// The compiler's -D options for other settings: the degrees of polynomials and the width of PCF.
std::string mathDefines(const ShadeSettings& settings);

}  // namespace luciole
