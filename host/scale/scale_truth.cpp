#include "scale/scale_truth.hpp"

#include <algorithm>

namespace luciole {
namespace {

/// Axes that say how the picture is made, not what it should be: by which lists, from how many samples of the
/// truth's, from which maps.
constexpr const char* kWaysToMakeIt[] = {"culling",   "tile",          "samples",
                                         "pcf-width", "shadow-memory", "shadow-size"};

bool isWayToMakeIt(const std::string& axis) {
  return std::find(std::begin(kWaysToMakeIt), std::end(kWaysToMakeIt), axis) != std::end(kWaysToMakeIt);
}

/// Lights of an experiment have no size, so that all methods, soft ones too, approximate rays to the lights.
/// Without shadows another picture is meant.
std::string shadowTruth(const std::string& method) {
  return method == "off" ? "no shadows" : "shadows by rays";
}

}  // namespace

std::string truthName(const ScaleDescription& description, const ScalePoint& point) {
  std::string name;
  for (std::size_t i = 0; i < point.values.size(); ++i) {
    const std::string &axis = description.axes[i].name, &value = point.values[i];
    if (isWayToMakeIt(axis) || value == kNotThis) continue;
    name += (name.empty() ? "" : ", ") + (axis == "shadows" ? shadowTruth(value) : axis + " " + value);
  }
  return name;
}

}  // namespace luciole
