#pragma once

#include <array>
#include <bitset>
#include <string>
#include <vector>

#include "culling/exact_reason.hpp"
#include "kernels/features.h"
#include "raster/rasterize.hpp"
#include "scene/model.hpp"
#include "scene/scene.hpp"
#include "shadow/shadow_maps.hpp"

namespace luciole {

/// What scenes may use. A program is compiled for a set of features and contains the code of no others.
#define FEATURE_ENUMERATOR(name, ...) k##name,
enum class Feature : unsigned { EACH_FEATURE(FEATURE_ENUMERATOR, FEATURE_ENUMERATOR) kCount };
#undef FEATURE_ENUMERATOR
inline constexpr std::size_t kFeatureCount = static_cast<std::size_t>(Feature::kCount);

/// Which kernels depend on a feature, besides those that shade pixels and vertices.
enum FeatureUse : unsigned {
  kForLookups = 1,   ///< kernels/find_needed.cl: where shadow maps are looked up
  kForBeams = 2,     ///< kernels/beam_shadows.cl
  kForClusters = 4,  ///< kernels/clustered_light.cl
  kForFog = 8,       ///< shading that gives lit pixels their fog
};

/// A row of kernels/features.h.
struct FeatureRow {
  const char* define;   ///< its name in the kernels; for a model, that of its number
  const char* name;     ///< in --stats
  const char* meaning;  ///< what the compiled code does
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
  /// Bit i is that of row i of the table.
  std::uint64_t bits() const { return bits_.to_ullong(); }

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

/// Those of a program's features that kernels of this use depend on. Programs that differ only in others
/// share these kernels.
FeatureSet featuresFor(FeatureUse use, const FeatureSet& features);

/// The G-buffer groups that a program with these features reads.
PlaneSet neededPlanes(const FeatureSet& features);

/// The compiler's -D option for these features.
std::string featureDefines(const FeatureSet& features);

/// The compiler's -D options for other settings: the degrees of polynomials and the width of PCF.
std::string mathDefines(const ShadeSettings& settings);

}  // namespace luciole
