#include "render/validate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/picture_size.hpp"
#include "image/exposure.hpp"
#include "lighting/light_layers.hpp"
#include "luciole/error.hpp"
#include "luciole/validate_scene.hpp"
#include "render/aov_table.hpp"
#include "scene/models.hpp"
#include "shadow/exact/light_samples.hpp"
#include "shadow/maps/shadow_sizes.hpp"

namespace luciole {
namespace {

constexpr int kMostSamples = 1024;

/// Throws unless a value is in a range that has both ends.
template <class T>
void checkRange(const char* field, T value, T least, T most) {
  if (!(value >= least && value <= most))
    throw InputError(fmt::format("{}: {}, expected {} to {}", field, value, least, most));
}

template <class Enum>
void checkEnum(const char* field, Enum value, Enum last) {
  checkRange(field, unsigned(value), 0u, unsigned(last));
}

void checkSize(const char* field, const glm::ivec2& size) {
  if (size.x < 1 || size.y < 1 || size.x > kLargestSide || size.y > kLargestSide)
    throw InputError(
        fmt::format("{}: {}x{} pixels, expected 1 to {} a side", field, size.x, size.y, kLargestSide));
}

void validateShading(const ShadeSettings& shade, const Scene& scene) {
  const std::size_t lights = scene.lights.size();
  checkEnum("settings.shade.model", shade.model, Model(kNumberOfModels + scene.user_models.size() - 1));
  checkEnum("settings.shade.culling", shade.culling, Culling::kTiles);
  if (shade.tile_size != 4 && shade.tile_size != 8 && shade.tile_size != 16)
    throw InputError(fmt::format("settings.shade.tile_size: {}, expected 4, 8 or 16", shade.tile_size));
  checkEnum("settings.shade.shadows", shade.shadows, ShadowMethod::kAuto);
  if (!shade.shadow_ways.empty() && shade.shadow_ways.size() != lights)
    throw InputError(fmt::format("settings.shade.shadow_ways: has {} elements, but there are {} lights",
                                 shade.shadow_ways.size(), lights));
  checkRange("settings.shade.soft_samples", shade.soft_samples, 1, kMostSoftSamples);
  checkRange("settings.shade.pcf_width", shade.pcf_width, 2, 6);
  checkRange("settings.shade.shadow_limits.size", shade.shadow_limits.size, kSmallestFace, kLargestFace);
  // The polynomials of kernels/math.clh.
  checkRange("settings.shade.log2_degree", shade.log2_degree, 3, 9);
  checkRange("settings.shade.exp2_degree", shade.exp2_degree, 2, 7);
  checkRange("settings.shade.light_error", shade.light_error, 0.0f, 1.0f);
  checkRange("settings.shade.light_error_floor", shade.light_error_floor, 1e-6f, 1.0f);
  checkRange("settings.shade.confidence", shade.confidence, 0.5, 0.9999);
}

}  // namespace

void validate(const Scene& scene, const RenderSettings& settings, KeptPicture* kept) {
  if (!kept || !kept->scene_is_valid) validateScene(scene);
  if (kept) kept->scene_is_valid = true;
  checkSize("settings.size", settings.size);
  if (const std::string fault = cameraFault(settings.camera); !fault.empty())
    throw InputError("settings.camera." + fault);
  checkRange("settings.samples", settings.samples, 1, kMostSamples);
  checkEnum("settings.sample_shading", settings.sample_shading, SampleShading::kAll);
  checkEnum("settings.shading", settings.shading, Shading::kPhong);
  validateShading(settings.shade, scene);
  for (const Aov aov : settings.aovs) checkEnum("settings.aovs", aov, Aov(kAovCount - 1));
  if (settings.shading == Shading::kGouraud && wantsLightLayers(settings))
    throw InputError("settings.shading: layers of light are lit at each pixel, not kGouraud");
  checkRange("settings.exposure", double(settings.exposure), -kMostStops, kMostStops);
  if (settings.band_height < 0)
    throw InputError(fmt::format("settings.band_height: {}, expected at least 0", settings.band_height));
}

}  // namespace luciole
