#include "tools/scale/scale_truth.hpp"

#include <algorithm>

#include "tools/scale/scale_method.hpp"

namespace luciole {
namespace {

/// Axes that change how the picture is made but not what it approximates: light lists, samples, shadow maps,
/// clusters and samples of lights, and who makes it.
constexpr const char* kWaysToMakeIt[] = {"culling",       "tile",          "samples",
                                         "pcf-width",     "shadow-memory", "shadow-size",
                                         kLightErrorAxis, kConfidenceAxis, kMethodAxis};

bool isWayToMakeIt(const std::string& axis) {
  return std::find(std::begin(kWaysToMakeIt), std::end(kWaysToMakeIt), axis) != std::end(kWaysToMakeIt);
}

/// The truth of a method of shadows. Lights of an experiment have no size, so all methods, also the soft one,
/// approximate rays to the lights' middles. A picture without shadows is another one.
std::string shadowTruth(const std::string& method) {
  return method == "off" ? "no shadows" : "shadows by rays";
}

}  // namespace

std::string truthName(const ScaleDescription& description, const ScalePoint& of_point) {
  const ScalePoint& point = methodOf(description, of_point) ? description.points.front() : of_point;
  std::string name;
  for (std::size_t i = 0; i < point.values.size(); ++i) {
    const std::string &axis = description.axes[i].name, &value = point.values[i];
    if (isWayToMakeIt(axis) || value == kNotThis) continue;
    name += (name.empty() ? "" : ", ") + (axis == "shadows" ? shadowTruth(value) : axis + " " + value);
  }
  return name;
}

}  // namespace luciole
