#pragma once

#include <array>
#include <bitset>
#include <string>
#include <vector>

#include "lights/exact_reason.hpp"
#include "luciole/scene.hpp"
#include "luciole/settings.hpp"
#include "raster/rasterize.hpp"
#include "scene/models.hpp"
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

/// The feature of a program that compiles this model.
constexpr Feature featureOf(Model model) { return Feature(unsigned(Feature::kPhong) + unsigned(model)); }

constexpr bool isModel(Feature feature) {
  return feature >= Feature::kPhong && unsigned(feature) < unsigned(Feature::kPhong) + kModelNames.size();
}

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

/// The features that decide where shadow maps are looked up. kernels/maps/find_needed.cl depends on no others, so
/// scenes that differ only in others share these programs.
FeatureSet lookupFeatures(const FeatureSet& features);

/// The features that kernels/exact/beam_shadows.cl depends on.
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
