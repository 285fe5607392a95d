#pragma once

#include <array>
#include <bitset>
#include <string>

#include "raster/rasterize.hpp"
#include "scene/model.hpp"
#include "scene/scene.hpp"
#include "shadow/shadow_maps.hpp"

namespace luciole {

/// What a scene may use and a program may compile. A program is built for one set of them.
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
#define MODEL_FEATURE(name, typed, shown, meaning) k##name,
  EACH_MODEL(MODEL_FEATURE)  // by Model
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
  kLift,
  kFogLinear,
  kFogExp,
  kFogExp2,
  kFogPerChannel,
  kFogRadial,
  kParallelView,
  kLightLists,
  kLongSums,
  kOutputShadow,
  kCount
};
inline constexpr std::size_t kFeatureCount = static_cast<std::size_t>(Feature::kCount);

/// The feature table: row i describes Feature i. kernels/features.clh has a fallback for each define.
struct FeatureRow {
  const char* define;  ///< the kernels' macro, 0 or 1; of a model its number, by which it has a bit of MODELS
  const char* name;    ///< in --stats
  const char* meaning;  ///< what the compiled code does
};
extern const std::array<FeatureRow, kFeatureCount> kFeatureTable;

class FeatureSet {
 public:
  bool has(Feature feature) const { return bits_[static_cast<std::size_t>(feature)]; }
  void set(Feature feature, bool on = true) { bits_[static_cast<std::size_t>(feature)] = on; }
  bool operator==(const FeatureSet&) const = default;
  bool shadows() const {
    return has(Feature::kParallelShadows) || has(Feature::kPerspectiveShadows) || has(Feature::kCubeShadows);
  }

 private:
  std::bitset<kFeatureCount> bits_;
};

/// What surfaces bring along, whether they come from materials or from a G-buffer file.
struct SurfaceTraits {
  bool specular = false;
  bool emission = false;
  bool smooth = false;  ///< shadow tests start above facets (raster/lift.hpp)
};
/// `smooth` only where lights cast shadows.
SurfaceTraits materialTraits(const Scene& scene);

enum class Culling : std::uint8_t { kNone, kTiles };

/// What a program of this model compiles.
constexpr Feature featureOf(Model model) { return Feature(unsigned(Feature::kPhong) + unsigned(model)); }

constexpr bool isModel(Feature feature) {
  return feature >= Feature::kPhong && unsigned(feature) < unsigned(Feature::kPhong) + kModelNames.size();
}

/// How to light a G-buffer, apart from the scene.
struct ShadeSettings {
  Model model = Model::kPhong;
  Culling culling = Culling::kTiles;
  int tile_size = 4;  ///< pixels a side of the squares that share a light list: 4, 8 or 16
  ShadowMethod shadows = ShadowMethod::kHard;
  bool shadow_layer = false;  ///< also write the share of shadowed lights that reaches each pixel
  int pcf_width = 2;          ///< texels a side that ShadowMethod::kPcf weighs, 2 to 6: a tent over a box
  ShadowLimits shadow_limits{};
  int log2_degree = 8;  ///< of the polynomials in kernels/math.clh, which lists the degrees there are
  int exp2_degree = 6;
};

/// The features that this scene's lights, fog and surfaces need, seen by this camera.
FeatureSet neededFeatures(const Scene& scene, const Camera& camera, SurfaceTraits surfaces,
                          const ShadeSettings& settings);

/// Those of the features that decide where shadow lookups go, not what they see: all that
/// kernels/find_needed.cl and kernels/classify.cl depend on, so that scenes that differ in others share these
/// programs.
FeatureSet lookupFeatures(const FeatureSet& features);

/// The G-buffer groups that a program with these features reads.
PlaneSet neededPlanes(const FeatureSet& features);

/// -D options for every row of the table; models share one.
std::string featureDefines(const FeatureSet& features);

/// -D options for what the settings choose beside features: degrees of polynomials, the width of PCF.
std::string mathDefines(const ShadeSettings& settings);

}  // namespace luciole
