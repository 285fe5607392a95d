#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/figures/text_table.hpp"
#include "tools/models/check_model.hpp"

namespace luciole {
namespace {

using Json = nlohmann::json;

std::string angles(const Place& at) {
  return fmt::format("light {:.6g}, eye {:.6g}, {:.0f} between", at.light, at.eye, at.between);
}

Json placeJson(const Place& at) {
  return {{"light_degrees", at.light},
          {"eye_degrees", at.eye},
          {"between_degrees", at.between},
          {"shininess", at.shininess}};
}
Json placedJson(const PlacedValue& value) { return {{"value", value.value}, {"at", placeJson(value.at)}}; }
Json timeJson(const Repeated& time) { return {{"median", time.median}, {"spread", time.spread}}; }

/// The largest albedo of a part over all curves, with its angle and shininess.
PlacedValue largestAlbedo(const ModelCheck& check, std::vector<double> AlbedoCurve::*part) {
  PlacedValue largest;
  for (const AlbedoCurve& curve : check.albedo)
    for (std::size_t i = 0; i < curve.degrees.size(); ++i)
      if ((curve.*part)[i] > largest.value)
        largest = {(curve.*part)[i], {0, curve.degrees[i], 0, curve.shininess}};
  return largest;
}

std::string energyText(const char* part, const PlacedValue& largest) {
  // Sums over directions are good to a thousandth or so.
  const bool is_more = largest.value > 1.002;
  return fmt::format("{} {:.3f} at {:g} degrees, shininess {:g}{}", part, largest.value, largest.at.eye,
                     largest.at.shininess, is_more ? ": MORE than arrives" : "");
}

}  // namespace

std::string modelCheckText(const ModelCheck& check) {
  std::string lanes;
  for (const int width : check.lanes) lanes += (lanes.empty() ? "" : ", ") + std::to_string(width);
  std::string text = fmt::format("{}: {} pairs of a surface and a light\n\n", check.name, check.pairs);
  const auto line = [&](const char* what, const std::string& is) {
    text += fmt::format("  {:<22} {}\n", what, is);
  };
  line("lane widths",
       check.other_bits ? "OTHER BITS: " + angles(*check.other_bits) : lanes + ": the same bits");
  line("finite, not negative",
       check.first_faulty ? fmt::format("NO: {} NaN, {} infinite, {} negative, first at {}, shininess {:g}",
                                        check.nan, check.infinite, check.negative,
                                        angles(*check.first_faulty), check.first_faulty->shininess)
                          : "yes");
  const auto reciprocityText = [](const PlacedValue& largest) {
    if (largest.value < 1e-9) return std::string("yes");
    return fmt::format("NO: differs by {:.0f} % ({}, shininess {:g})", 100 * largest.value,
                       angles(largest.at), largest.at.shininess);
  };
  line("reciprocal, diffuse", reciprocityText(check.diffuse_reciprocity));
  line("reciprocal, specular", reciprocityText(check.reciprocity));
  line("most energy, colour 1", energyText("diffuse", largestAlbedo(check, &AlbedoCurve::diffuse)));
  line("", energyText("specular", largestAlbedo(check, &AlbedoCurve::specular)));
  line("under Oclgrind", !check.oclgrind           ? "not installed"
                         : check.oclgrind->empty() ? "no report"
                                                   : *check.oclgrind);
  line("time a pair",
       fmt::format("{:.2f} ns ± {:.2f}; Phong {:.2f}, {:.2f} times that; the roof {:.2f}",
                   check.nanoseconds.median, check.nanoseconds.spread, check.phong_nanoseconds.median,
                   check.nanoseconds.median / check.phong_nanoseconds.median, check.roof_nanoseconds.median));
  text +=
      "\nError against double precision, as a share of the larger of 1 and the value; ulps of values from "
      "1/1024 on:\n\n";
  std::vector<std::vector<std::string>> rows{
      {"shininess", "largest", "at (degrees)", "mean", "largest, ulps", "mean, ulps", "of allowed"}};
  for (const ModelError& error : check.errors)
    rows.push_back({fmt::format("{:g}", error.shininess), fmt::format("{:.2g}", error.largest.value),
                    angles(error.largest.at), fmt::format("{:.2g}", error.mean),
                    fmt::format("{:.3g}", error.largest_ulps), fmt::format("{:.2g}", error.mean_ulps),
                    fmt::format("{:.2f}", error.of_allowed.value)});
  text += textTable(rows);
  if (!check.loose.empty()) text += "\n";
  for (const std::string& loose : check.loose) text += loose + "\n";
  text += check.broken.empty() ? "\nAll promises hold.\n" : "\n";
  for (const std::string& broken : check.broken) text += "BROKEN: " + broken + "\n";
  return text;
}

std::string modelCheckJson(const ModelCheck& check) {
  Json json{
      {"model", check.name},
      {"pairs", check.pairs},
      {"lanes", check.lanes},
      {"same_bits", !check.other_bits},
      {"nan", check.nan},
      {"infinite", check.infinite},
      {"negative", check.negative},
      {"first_faulty", check.first_faulty ? placeJson(*check.first_faulty) : Json()},
      {"errors", Json::array()},
      {"reciprocity",
       {{"diffuse", placedJson(check.diffuse_reciprocity)}, {"specular", placedJson(check.reciprocity)}}},
      {"energy",
       {{"diffuse", placedJson(largestAlbedo(check, &AlbedoCurve::diffuse))},
        {"specular", placedJson(largestAlbedo(check, &AlbedoCurve::specular))}}},
      {"albedo", Json::array()},
      {"nanoseconds_a_pair",
       {{"model", timeJson(check.nanoseconds)},
        {"phong", timeJson(check.phong_nanoseconds)},
        {"roof", timeJson(check.roof_nanoseconds)}}},
      {"loose_arithmetic", check.loose},
      {"oclgrind", check.oclgrind ? Json(*check.oclgrind) : Json()},
      {"broken", check.broken}};
  for (const ModelError& error : check.errors)
    json["errors"].push_back({{"shininess", error.shininess},
                              {"largest", placedJson(error.largest)},
                              {"mean", error.mean},
                              {"largest_ulps", error.largest_ulps},
                              {"mean_ulps", error.mean_ulps},
                              {"of_allowed", placedJson(error.of_allowed)}});
  for (const AlbedoCurve& curve : check.albedo)
    json["albedo"].push_back({{"shininess", curve.shininess},
                              {"eye_degrees", curve.degrees},
                              {"diffuse", curve.diffuse},
                              {"specular", curve.specular}});
  return json.dump(1) + "\n";
}

}  // namespace luciole
