#pragma once

#include <array>
#include <bitset>
#include <string>
#include <vector>

#include "kernels/feature_table.h"
#include "lights/light_use.hpp"
#include "luciole/scene.hpp"
#include "luciole/settings.hpp"
#include "raster/rasterize.hpp"
#include "scene/models.hpp"
#include "shadow/maps/shadow_maps.hpp"

namespace luciole {

/// Features of scenes. A program is compiled for a set of features and contains no code of others.
#define FEATURE_ENUMERATOR(name, ...) k##name,
enum class Feature : unsigned { EACH_FEATURE(FEATURE_ENUMERATOR, FEATURE_ENUMERATOR) kCount };
#undef FEATURE_ENUMERATOR
inline constexpr std::size_t kFeatureCount = static_cast<std::size_t>(Feature::kCount);

/// The kernels that depend on a feature, besides those that shade pixels and vertices.
enum FeatureUse : unsigned {
  kForLookups = 1,    ///< kernels/maps/find_needed.cl
  kForBeams = 2,      ///< kernels/exact/beam_shadows.cl
  kForClusters = 4,   ///< kernels/clusters/clustered_light.cl
  kForFog = 8,        ///< shading that applies fog to colours lit at vertices
  kForSampling = 16,  ///< kernels/sampled/sampled_light.cl
};

/// A row of kernels/feature_table.h.
struct FeatureRow {
  const char* define;   ///< its name in the kernels; for a model, that of its number
  const char* name;     ///< in --stats
  const char* meaning;  ///< of the compiled code, for people
  unsigned uses;        ///< bits of FeatureUse
};
extern const std::array<FeatureRow, kFeatureCount> kFeatureTable;

class FeatureSet {
 public:
  bool has(Feature feature) const { return bits_[static_cast<std::size_t>(feature)]; }
  void set(Feature feature, bool on = true) { bits_[static_cast<std::size_t>(feature)] = on; }
  FeatureSet without(const FeatureSet& others) const {
    FeatureSet rest = *this;
    rest.bits_ &= ~others.bits_;
    return rest;
  }
  bool operator==(const FeatureSet&) const = default;
  bool shadowMaps() const {
    return has(Feature::kParallelShadows) || has(Feature::kPerspectiveShadows) || has(Feature::kCubeShadows);
  }
  bool shadows() const { return shadowMaps() || has(Feature::kExact); }
  /// Whether shadows are tested by the scene's triangles.
  bool triangleTree() const { return has(Feature::kExact) || sampledLight(); }
  bool sampledLight() const { return has(Feature::kSampledLights) || has(Feature::kSampledDirections); }
  /// Whether light comes with bounds of its error.
  bool lightError() const { return has(Feature::kClusteredLights) || sampledLight(); }
  /// Bit i is that of row i of the table.
  std::uint64_t bits() const { return bits_.to_ullong(); }

 private:
  std::bitset<kFeatureCount> bits_;
};

/// The names in --stats of the features that are set, in the table's order.
std::vector<std::string> featureNames(const FeatureSet& features);

/// The features that surfaces need, of a scene's materials or of a G-buffer file.
struct SurfaceTraits {
  bool specular = false;
  bool emission = false;
  bool smooth = false;  ///< shadow tests start above facets (raster/lift.hpp)
  bool normal_maps = false;
  ModelChoices models{1};  ///< of the surfaces
};
/// The traits of a scene's materials and meshes. `smooth` is set only if a light casts shadows.
SurfaceTraits materialTraits(const Scene& scene);

/// The feature of a program that compiles this model.
constexpr Feature featureOf(Model model) {
  return isUserModel(model) ? Feature::kUserModels : Feature(unsigned(Feature::kPhong) + unsigned(model));
}

constexpr bool isModel(Feature feature) {
  return feature >= Feature::kPhong && unsigned(feature) < unsigned(Feature::kPhong) + kModelNames.size();
}

/// Sets settings.model if all surfaces of a picture have one model, else settings.material_models.
void chooseModel(const ModelChoices& choices, ShadeSettings& settings);

/// How a light's shadows are computed in a picture with these settings. light: its index in the scene.
ShadowWay shadowWay(const Scene& scene, std::size_t light, const ShadeSettings& settings);

/// Whether a picture lets clusters stand for lights, and samples those with a place (LightUse::kSampled) and
/// directional ones.
struct StandIns {
  bool clustered = false, sampled = false, directions = false;
};

/// Each only if the settings allow an error, and there are enough lights of such a use (clustersAreFaster,
/// samplesAreFaster). view: of the picture. O(lights).
StandIns standIns(const Scene& scene, const View& view, SurfaceTraits surfaces,
                  const ShadeSettings& settings);

/// The properties of a picture that decide about its lights' uses.
UseConditions useConditions(const ShadeSettings& settings);

/// The features that this scene's lights, fog and surfaces need, seen by this camera. stand_ins:
/// as standIns() says.
FeatureSet neededFeatures(const Scene& scene, const Camera& camera, SurfaceTraits surfaces,
                          const ShadeSettings& settings, StandIns stand_ins = {});

/// Whether a light of this use is summed by itself in a picture with these features.
bool isSummed(LightUse use, const FeatureSet& features);

/// The subset of a program's features on which kernels of this use depend. Programs that differ in other
/// features share these kernels.
FeatureSet featuresFor(FeatureUse use, const FeatureSet& features);

/// The features of the general program. It gives a picture of some of them the bits that their own program
/// gives it, in more time.
FeatureSet generalFeatures();

/// Whether the general program may take the place of the program of these features.
bool isGeneral(const FeatureSet& features);

/// The G-buffer groups that a program with these features reads.
PlaneSet neededPlanes(const FeatureSet& features);

/// The compiler's -D option for these features.
std::string featureDefines(const FeatureSet& features);

/// A picture's ShadeSettings::user_text for a program of these features: empty without Feature::kUserModels.
std::string userTextFor(const FeatureSet& features, const std::string& user_text);

/// The compiler's -D options for other settings: the degrees of polynomials and the width of PCF.
std::string mathDefines(const ShadeSettings& settings);

}  // namespace luciole
