#include "lights/luminaires.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <unordered_map>
#include <vector>

#include "luciole/error.hpp"

namespace luciole {
namespace {

/// Of shares of light: products with what is smaller could be denormals.
constexpr double kLeastShare = 0x1p-60;
/// An angle, or a share of light, that makes no light a limit.
constexpr float kEverywhere = 10.0f;

/// Lines of an axis, and where each lies among those of the profile.
struct AxisLines {
  std::vector<double> lines = {};
  std::vector<std::size_t> cell = {};
  std::vector<double> share = {};
  bool is_even = false;
};

/// The lines of a profile's axis, with as many more as make them even, which a bilinear table doesn't depend
/// on. As they are where that would be too many: where angles have no common step of 0.001 degrees or more.
AxisLines axisLines(const std::vector<double>& own) {
  constexpr double kStep = glm::radians(1e-3), kExact = 1e-3;
  constexpr std::uint64_t kMostTimes = 8, kFewCells = 512;
  const std::size_t cells = own.size() - 1;
  std::uint64_t step = 0;
  bool is_even = true;
  for (std::size_t i = 1; i <= cells; ++i) {
    const double steps = (own[i] - own[0]) / kStep;
    is_even &= std::abs(steps - std::round(steps)) < kExact && steps >= 0.5;
    step = std::gcd(step, std::uint64_t(std::max(std::round(steps), 0.0)));
  }
  const std::uint64_t whole = std::uint64_t(std::round((own[cells] - own[0]) / kStep));
  is_even = is_even && step > 0 && whole / step <= std::max(kMostTimes * cells, kFewCells);
  AxisLines axis{.is_even = is_even};
  const std::uint64_t count = is_even ? whole / step : cells;
  std::size_t cell = 0;
  for (std::uint64_t i = 0; i <= count; ++i) {
    const double line = is_even ? own[0] + (own[cells] - own[0]) * double(i) / double(count) : own[i];
    while (cell + 1 < cells && line >= own[cell + 1] - kStep / 4) ++cell;
    axis.lines.push_back(line);
    axis.cell.push_back(cell);
    axis.share.push_back(std::clamp((line - own[cell]) / (own[cell + 1] - own[cell]), 0.0, 1.0));
  }
  return axis;
}

/// low, high: beyond these there is no light.
void appendAxis(const AxisLines& axis, float low, float high, std::vector<float>& floats) {
  const std::size_t cells = axis.lines.size() - 1;
  floats.push_back(std::bit_cast<float>(std::uint32_t(cells)));
  floats.push_back(low);
  floats.push_back(high);
  floats.push_back(axis.is_even ? float(double(cells) / (axis.lines.back() - axis.lines.front())) : 0.0f);
  for (const double line : axis.lines) floats.push_back(float(line));
}

void appendProfile(const LightProfile& profile, std::vector<float>& floats) {
  constexpr double kPi = std::numbers::pi, kAngleSlack = 1e-6;
  const std::vector<double>&polar = profile.polar, &azimuth = profile.azimuth;
  const AxisLines rows = axisLines(polar), columns = axisLines(azimuth);
  appendAxis(rows, polar.front() <= kAngleSlack ? -kEverywhere : float(polar.front()),
             polar.back() >= kPi - kAngleSlack ? kEverywhere : float(polar.back()), floats);
  const bool all_around = azimuth.back() - azimuth.front() >= 2 * kPi - kAngleSlack;
  appendAxis(columns, all_around ? -kEverywhere : float(azimuth.front()),
             all_around ? kEverywhere : float(azimuth.back()), floats);
  const double scale = profile.peak > 0 ? 1 / profile.peak : 0;
  for (std::size_t i = 0; i < rows.lines.size(); ++i)
    for (std::size_t j = 0; j < columns.lines.size(); ++j) {
      const float* near = &profile.candela[rows.cell[i] * azimuth.size() + columns.cell[j]];
      const float* far = near + azimuth.size();
      const double share =
          std::lerp(std::lerp(double(near[0]), double(near[1]), columns.share[j]),
                    std::lerp(double(far[0]), double(far[1]), columns.share[j]), rows.share[i]) *
          scale;
      floats.push_back(share >= kLeastShare ? float(share) : 0.0f);
    }
}

}  // namespace

glm::dmat3 luminaireAxes(const Luminaire& luminaire, const glm::dvec3& direction) {
  constexpr double kParallel = 1e-6;
  const auto across = [&](const glm::dvec3& way) { return way - glm::dot(way, direction) * direction; };
  glm::dvec3 up = across(glm::normalize(luminaire.up));
  if (!(glm::length(up) >= kParallel))
    up = across(std::abs(direction.x) < 0.8 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
  up = glm::normalize(up);
  const glm::dvec3 left = glm::cross(up, direction);
  switch (luminaire.profile->type) {
    case PhotometricType::kC:
      break;
    case PhotometricType::kA:
      return {direction, -left, up};
    case PhotometricType::kB:
      return {direction, up, -left};
  }
  return {up, left, direction};
}

RawArray<float> setLuminaires(const Scene& scene, const Camera& camera, std::span<const std::uint32_t> order,
                              std::span<ShadeLight> lights) {
  std::vector<std::uint32_t> lamps;  // places in `lights`
  for (std::uint32_t i = 0; i < order.size(); ++i)
    if (scene.lights[order[i]].luminaire >= 0) lamps.push_back(i);
  constexpr std::size_t kMost = (std::size_t(1) << 24) - 1;
  if (lamps.size() > kMost)
    throw InputError(
        fmt::format("{}: {} lights with profiles, expected {} at most", scene.name, lamps.size(), kMost));
  const glm::dmat3 to_view = glm::transpose(glm::dmat3(camera.camera_to_world));
  std::unordered_map<const LightProfile*, std::uint32_t> places;
  std::vector<float> profiles;
  RawArray<float> floats(lamps.size() * kLuminaireFloats);
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    const Light& light = scene.lights[order[lamps[i]]];
    const Luminaire& luminaire = scene.luminaires[std::size_t(light.luminaire)];
    const auto [place, is_new] =
        places.emplace(luminaire.profile.get(), std::uint32_t(floats.size() + profiles.size()));
    if (is_new) appendProfile(*luminaire.profile, profiles);
    const glm::dmat3 axes = to_view * luminaireAxes(luminaire, light.direction);
    for (int axis = 0; axis < 3; ++axis) {
      float* out = &floats[i * kLuminaireFloats + std::size_t(axis) * 4];
      for (int c = 0; c < 3; ++c) out[c] = float(axes[axis][c]);
      out[3] = axis == 0 ? std::bit_cast<float>(place->second) : 0.0f;
    }
    lights[lamps[i]].ambient.w = float(i + 1);
  }
  floats.insert(floats.end(), profiles.begin(), profiles.end());
  return floats;
}

}  // namespace luciole
