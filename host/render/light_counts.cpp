#include "render/light_counts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "lighting/count_picture.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

/// The first count that is tried, and the last.
constexpr std::uint32_t kFewestLights = 64, kMostChosen = 1 << 16;
/// Errors are held to this share of what is allowed, as they are estimated from few pixels.
constexpr double kShare = 1 / 1.5;
/// Pixels a side of the pictures that are compared, at most.
constexpr int kMeasuredSide = 96;

/// Whether all lights of sources cast shadows, or none does; empty: some do.
std::optional<bool> castAlike(const Scene& scene) {
  const auto lights = std::span(scene.lights).last(scene.source_lights);
  const auto cast =
      std::count_if(lights.begin(), lights.end(), [](const Light& light) { return light.shadow; });
  if (cast > 0 && std::size_t(cast) < lights.size()) return std::nullopt;
  return cast > 0;
}

/// Sets the number of lights, which cast shadows as those before did. cast: castAlike() of these.
void setCounts(std::uint32_t count, std::optional<bool> cast, Scene& scene) {
  setLightCounts(scene, count);
  if (cast)
    for (Light& light : std::span(scene.lights).last(scene.source_lights)) light.shadow = *cast;
}

/// A small picture by so many lights for each source.
Image pictureBy(std::uint32_t count, std::optional<bool> cast, OpenedDevice& device, Scene& scene,
                const RenderSettings& settings, Stats& stats, KeptPicture* kept) {
  setCounts(count, cast, scene);
  return renderScene(device, scene, settings, stats, kept);
}

/// The error of two pictures' mean, if their errors are independent, of the pixels that this share of all
/// don't exceed: half of their difference, in the units in which `shade` allows it.
double errorOfMean(const Image& one, const Image& other, const ShadeSettings& shade) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < one.pixels.size(); i += 3) {
    double worst = 0;
    for (std::size_t c = i; c < i + 3; ++c) {
      const double a = one.pixels[c], b = other.pixels[c];
      worst =
          std::max(worst, 0.5 * std::abs(a - b) / std::max(0.5 * (a + b), double(shade.light_error_floor)));
    }
    errors.push_back(worst);
  }
  const auto at = errors.begin() + std::ptrdiff_t(shade.confidence * double(errors.size() - 1));
  std::nth_element(errors.begin(), at, errors.end());
  return *at;
}

}  // namespace

double chooseLightCounts(OpenedDevice& device, Scene& scene, const RenderSettings& settings, Stats& stats,
                         KeptPicture* kept) {
  if (!(settings.shade.light_error > 0))
    throw InputError("settings.shade.light_error: 0, expected more where counts of lights are chosen by it");
  RenderSettings small;
  small.size = glm::max(settings.size * kMeasuredSide / std::max(settings.size.x, settings.size.y), 1);
  small.camera = settings.camera;
  small.shading = settings.shading;
  small.shade = settings.shade;
  small.shade.light_error = 0;
  small.surfaces = settings.surfaces;
  small.on_long_compile = settings.on_long_compile;
  const std::optional<bool> cast = castAlike(scene);
  double error = 0;
  std::uint32_t count = kFewestLights;
  for (;; count *= 2) {
    Stats of_small;
    // Halves that are divided alike would miss alike. Nine tenths of a half are divided otherwise everywhere.
    const Image one = pictureBy(count / 2, cast, device, scene, small, of_small, kept);
    const Image other = pictureBy(count * 9 / 20, cast, device, scene, small, of_small, kept);
    error = errorOfMean(one, other, settings.shade);
    if (error <= kShare * settings.shade.light_error || count == kMostChosen) break;
    // It falls about as the number to the power −¾.
    for (double left = error; left > 3.4 * kShare * settings.shade.light_error && count < kMostChosen / 2;
         left /= 1.7)
      count *= 2;
  }
  setCounts(count, cast, scene);
  if (error > settings.shade.light_error)
    stats.warnings.push_back(
        fmt::format("{} lights for each source miss {:.2g} of a pixel's light, more than {:.2g}", count,
                    error, settings.shade.light_error));
  addCount(stats, "lights_of_a_source", count);
  return error;
}

}  // namespace luciole
