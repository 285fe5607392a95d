#include "scene/profiles/profile_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

#include "base/text_file.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

/// Angles of a table, degrees, and which of the file's each repeats.
using TableLines = std::vector<std::pair<double, std::size_t>>;

TableLines linesOf(const std::vector<double>& angles) {
  TableLines lines;
  for (std::size_t i = 0; i < angles.size(); ++i) lines.push_back({angles[i], i});
  return lines;
}

bool isAngle(double angle, double wanted) { return std::abs(angle - wanted) < 1e-3; }

void mirrorAtEnd(TableLines& lines) {
  const double end = lines.back().first;
  for (std::size_t i = lines.size() - 1; i-- > 0;)
    lines.push_back({2 * end - lines[i].first, lines[i].second});
}

/// The lines of types A and B, whose negative half may be left out.
TableLines bothHalves(const std::vector<double>& angles) {
  TableLines lines = linesOf(angles);
  if (!isAngle(lines.front().first, 0)) return lines;
  TableLines negative;
  for (std::size_t i = lines.size(); i-- > 1;) negative.push_back({-lines[i].first, lines[i].second});
  lines.insert(lines.begin(), negative.begin(), negative.end());
  return lines;
}

/// The lines of type C all around; none where the angles have no such meaning.
TableLines allAround(const std::vector<double>& angles) {
  TableLines lines = linesOf(angles);
  const double first = angles.front(), span = angles.back() - first;
  if (angles.size() == 1) {
    lines.push_back({first + 360, 0});
  } else if (isAngle(first, 0) && isAngle(span, 90)) {
    mirrorAtEnd(lines);
    mirrorAtEnd(lines);
  } else if (isAngle(span, 180) && (isAngle(first, 0) || isAngle(first, 90))) {
    mirrorAtEnd(lines);
  } else if (isAngle(first, 0) && span > 180 && !isAngle(span, 360)) {
    lines.push_back({360, 0});
  } else if (!isAngle(span, 360)) {
    return {};
  }
  return lines;
}

/// The same lines by angles to a pole, which is 90 degrees away from 0.
TableLines fromPole(const TableLines& lines) {
  TableLines turned;
  for (std::size_t i = lines.size(); i-- > 0;) turned.push_back({90 - lines[i].first, lines[i].second});
  return turned;
}

/// ∫∫ of a bilinear table over the sphere, exactly: of a cell from a to b in the angle θ to the pole, with
/// t = θ − a, ∫ sin θ dθ = cos a − cos b and ∫ t sin θ dθ = sin b − sin a − (b − a) cos b.
double integral(const LightProfile& profile) {
  const std::vector<double>&polar = profile.polar, &azimuth = profile.azimuth;
  const std::size_t columns = azimuth.size();
  std::vector<double> ring(polar.size(), 0.0);  // of each angle to the pole: ∫ over the azimuth
  for (std::size_t i = 0; i < polar.size(); ++i)
    for (std::size_t j = 0; j + 1 < columns; ++j)
      ring[i] += 0.5 * (azimuth[j + 1] - azimuth[j]) *
                 (double(profile.candela[i * columns + j]) + profile.candela[i * columns + j + 1]);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < polar.size(); ++i) {
    const double a = polar[i], b = polar[i + 1];
    const double whole = std::cos(a) - std::cos(b);
    const double later = (std::sin(b) - std::sin(a) - (b - a) * std::cos(b)) / (b - a);
    sum += ring[i] * (whole - later) + ring[i + 1] * later;
  }
  return sum;
}

}  // namespace

std::string makeProfile(const ProfileTable& table, LightProfile& profile) {
  const bool by_c = table.type == PhotometricType::kC;
  const double low = by_c ? 0 : -90, high = by_c ? 180 : 90;
  if (table.vertical.front() < low || table.vertical.back() > high)
    return fmt::format("vertical angles go from {} to {}, expected {} to {} at most", table.vertical.front(),
                       table.vertical.back(), low, high);
  const auto [first, last] = std::pair(table.horizontal.front(), table.horizontal.back());
  if (!by_c && (first < low || last > high))
    return fmt::format("horizontal angles go from {} to {}, expected {} to {} at most", first, last, low,
                       high);
  const TableLines vertical = by_c ? linesOf(table.vertical) : bothHalves(table.vertical),
                   horizontal = by_c ? allAround(table.horizontal) : bothHalves(table.horizontal);
  if (horizontal.empty())
    return fmt::format("horizontal angles go from {} to {}, expected 0 to 0, 90, 180 or 360, or 90 to 270",
                       first, last);
  if (vertical.size() < 2 || horizontal.size() < 2)
    return "has one angle, expected 2 or more vertical ones, and of types A and B horizontal ones";
  const bool by_vertical = table.type != PhotometricType::kB;  // the angles to the pole
  const TableLines polar = by_c          ? vertical
                           : by_vertical ? fromPole(vertical)
                                         : fromPole(horizontal),
                   &azimuth = by_vertical ? horizontal : vertical;
  profile.type = table.type;
  profile.lamp_lumens = table.lamp_lumens;
  for (const auto& [angle, from] : polar) profile.polar.push_back(glm::radians(angle));
  for (const auto& [angle, from] : azimuth) profile.azimuth.push_back(glm::radians(angle));
  profile.candela.reserve(polar.size() * azimuth.size());
  for (const auto& [polar_angle, i] : polar)
    for (const auto& [azimuth_angle, j] : azimuth)
      profile.candela.push_back(
          table.candela[by_vertical ? j * table.vertical.size() + i : i * table.vertical.size() + j]);
  profile.peak = double(*std::max_element(profile.candela.begin(), profile.candela.end()));
  profile.lumens = integral(profile);
  return "";
}

std::shared_ptr<const LightProfile> parseLightProfile(std::string_view text, const std::string& name,
                                                      std::vector<Warning>& warnings) {
  const bool is_eulumdat = equalIgnoringCase(std::filesystem::path(name).extension().string(), ".ldt");
  const ProfileTable table =
      is_eulumdat ? parseEulumdat(text, name, warnings) : parseIes(text, name, warnings);
  LightProfile profile{.name = name};
  if (const std::string fault = makeProfile(table, profile); !fault.empty())
    throw InputError(fmt::format("{}: {}", name, fault));
  const std::vector<double>& around = table.horizontal;
  if (table.type == PhotometricType::kC && around.size() > 1 && around.back() > 180 + 1e-3 &&
      !isAngle(around.back() - around.front(), 360) && isAngle(around.front(), 0) && !is_eulumdat)
    warnings.push_back(
        {fmt::format("{}: horizontal angles end at {}, taken for all around", name, around.back()),
         "horizontal angles", true});
  return std::make_shared<const LightProfile>(std::move(profile));
}

std::shared_ptr<const LightProfile> readLightProfile(const std::string& path,
                                                     std::vector<Warning>& warnings) {
  return parseLightProfile(readFile(path), path, warnings);
}

}  // namespace luciole
