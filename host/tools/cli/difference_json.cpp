#include "tools/cli/difference_json.hpp"

#include <cmath>

namespace luciole {
namespace {

/// The reason why a figure is infinite, for people.
const char* whyInfinite(const std::string& name, const ImageDifference& d) {
  if (name == "psnr" && d.rmse == 0) return "no finite value differs";
  return d.nonfinite > 0 ? "a pixel of one picture alone is not finite"
                         : "A is black, of which nothing is a share";
}

}  // namespace

nlohmann::ordered_json differenceJson(const ImageDifference& d) {
  nlohmann::ordered_json json, reasons;
  json["channels"] = d.channels;
  json["pixels"] = d.pixels;
  for (const auto& [name, figure] : kImageMetrics) {
    const double value = d.*figure;
    if (std::isfinite(value)) {
      json[name] = value;
    } else {
      json[name] = nullptr;
      reasons[name] = whyInfinite(name, d);
    }
  }
  if (!reasons.empty()) json["reasons"] = reasons;
  json["nonfinite"] = d.nonfinite;
  json["pixels_over"] = {{"half_step", d.over[0]}, {"one_step", d.over[1]}, {"four_steps", d.over[2]}};
  json["worst_pixel"] = d.worst_pixel;
  return json;
}

}  // namespace luciole
