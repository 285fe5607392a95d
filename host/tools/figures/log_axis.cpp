#include "tools/figures/log_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace luciole {
namespace {

using Unit = std::pair<double, const char*>;  ///< its size and name

/// The value in the first unit, largest first, of which it is at least one; in the last if there is none.
template <std::size_t kCount>
std::string inUnits(double value, const std::array<Unit, kCount>& units) {
  // The factor allows for a power of ten that was rounded down.
  const auto fits = [&](const Unit& unit) { return value >= unit.first * (1 - 1e-12); };
  const auto found = std::find_if(units.begin(), units.end() - 1, fits);
  return fmt::format("{:g}{}", value / found->first, found->second);
}

std::string raised(int exponent) {
  static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text;
  for (const char c : std::to_string(exponent)) text += c == '-' ? "⁻" : kDigits[c - '0'];
  return text;
}

}  // namespace

double LogAxis::place(double value) const {
  const double drawn = value == 0 && floor ? *floor : std::clamp(value, low, high);
  return std::log(drawn / low) / std::log(high / low);
}

LogAxis axisAround(const std::vector<double>& values, double room) {
  std::vector<double> positive;
  std::copy_if(values.begin(), values.end(), std::back_inserter(positive), [](double v) { return v > 0; });
  if (positive.empty()) return {0.5, 2, values.empty() ? std::optional<double>() : 1.0};
  const auto [least, most] = std::minmax_element(positive.begin(), positive.end());
  const double ratio = *most / *least, factor = std::max(std::pow(ratio, room), 1.15);
  if (positive.size() == values.size()) return {*least / factor, *most * factor, {}};
  const double floor = *least / std::max(std::pow(ratio, 0.2), 2.0);
  return {floor / factor, *most * factor, floor};
}

std::vector<double> logTicks(double low, double high, int most) {
  static const std::vector<double> kMultiples[] = {{1},
                                                   {1, 3},
                                                   {1, 2, 5},
                                                   {1, 1.5, 2, 3, 5, 7},
                                                   {1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 3.5, 4, 5, 6, 7, 8, 9}};
  std::vector<double> ticks;
  for (const auto& multiples : kMultiples) {
    ticks.clear();
    for (int power = int(std::floor(std::log10(low))); std::pow(10.0, power) <= high; ++power)
      for (const double multiple : multiples)
        if (const double tick = multiple * std::pow(10.0, power); tick >= low && tick <= high)
          ticks.push_back(tick);
    if (ticks.size() >= 3) break;
  }
  const std::size_t stride = (ticks.size() + std::size_t(most) - 1) / std::size_t(most);
  std::vector<double> kept;
  for (std::size_t i = 0; i < ticks.size(); i += stride) kept.push_back(ticks[i]);
  return kept;
}

std::string timeTick(double milliseconds) {
  return inUnits(milliseconds, std::array<Unit, 4>{{{1e3, " s"}, {1, " ms"}, {1e-3, " µs"}, {1e-6, " ns"}}});
}

std::string countTick(double count) {
  return inUnits(count, std::array<Unit, 4>{{{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}}});
}

std::string errorTick(double error) {
  if (error >= 0.0099 && error < 1000) return fmt::format("{:g}", error);
  const int power = int(std::floor(std::log10(error * (1 + 1e-12))));
  const std::string mantissa = fmt::format("{:g}", error / std::pow(10.0, power));
  return (mantissa == "1" ? "" : mantissa + "·") + "10" + raised(power);
}

}  // namespace luciole
