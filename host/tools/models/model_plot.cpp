#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <iterator>
#include <numbers>
#include <span>
#include <utility>

#include "tools/figures/svg_plot.hpp"
#include "tools/models/check_model.hpp"

namespace luciole {
namespace {

// Pixels.
constexpr double kRadius = 150, kMarginAround = 28, kPanelWidth = 2 * kRadius + 2 * kMarginAround,
                 kPanelHeight = kRadius + 82, kTitleHeight = 56;
constexpr const char* kLobeColors[] = {kPlotColors[6], kPlotColors[1], kPlotColors[2]};
constexpr const char* kLine = "#999999";

std::string label(glm::dvec2 at, const std::string& text, const char* more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>\n", at.x, at.y, more, svgText(text));
}

std::string stroke(const std::vector<glm::dvec2>& points, const char* color, double width,
                   const char* more = "") {
  std::string d;
  for (const glm::dvec2& point : points)
    d += fmt::format("{}{:.2f} {:.2f}", d.empty() ? "M" : "L", point.x, point.y);
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}/>\n", d, color, width,
                     more);
}

/// The point so far from `center` at an angle from upwards, degrees; positive ones to the left, where the
/// light stands.
glm::dvec2 polar(glm::dvec2 center, double degrees, double radius) {
  const double angle = degrees * std::numbers::pi / 180;
  return center + radius * glm::dvec2(-std::sin(angle), -std::cos(angle));
}

/// A half circle with rings, the light's arrow and lobes, each as large as its share of the largest.
std::string lobePanel(std::span<const Lobe> lobes, glm::dvec2 corner) {
  double most = 0;
  for (const Lobe& lobe : lobes)
    most = std::max(most, *std::max_element(lobe.value.begin(), lobe.value.end()));
  if (!(most > 0)) most = 1;
  const glm::dvec2 center = corner + glm::dvec2(kPanelWidth / 2, kRadius + 40);
  std::string svg;
  for (const double share : {0.5, 1.0}) {
    std::vector<glm::dvec2> ring;
    for (int degrees = -90; degrees <= 90; degrees += 3)
      ring.push_back(polar(center, degrees, share * kRadius));
    svg += stroke(ring, kLine, 0.7, " stroke-dasharray=\"2 3\"");
    svg += label(polar(center, -90, share * kRadius) + glm::dvec2(0, 15), fmt::format("{:.3g}", share * most),
                 " text-anchor=\"middle\" fill=\"#555555\"");
  }
  svg += stroke({polar(center, 90, kRadius), polar(center, -90, kRadius)}, "#222222", 1.2);
  svg += stroke({center, polar(center, 0, kRadius)}, kLine, 0.7);
  for (std::size_t i = 0; i < lobes.size(); ++i) {
    std::vector<glm::dvec2> curve;
    for (std::size_t k = 0; k < lobes[i].degrees.size(); ++k)
      curve.push_back(polar(center, lobes[i].degrees[k], lobes[i].value[k] / most * kRadius));
    svg += stroke(curve, kLobeColors[i % std::size(kLobeColors)], 1.8, " stroke-linejoin=\"round\"");
  }
  const double light = lobes.front().light_degrees;
  svg += stroke({polar(center, light, kRadius + 16), polar(center, light, 22)}, kPlotColors[5], 2.5,
                " marker-end=\"url(#arrow)\"");
  svg += stroke({polar(center, -light, kRadius), polar(center, -light, kRadius + 10)}, kPlotColors[5], 2);
  svg += label(corner + glm::dvec2(kPanelWidth / 2, kPanelHeight - 8), fmt::format("light at {:g}°", light),
               " text-anchor=\"middle\" font-weight=\"bold\"");
  return svg;
}

const char* curveColor(std::size_t curve) { return kPlotColors[1 + curve % 5]; }

/// The albedo over the eye's angle, from 0 to what is needed, with a line at 1.
std::string albedoPanel(const ModelCheck& check, glm::dvec2 corner) {
  const glm::dvec2 area(kPanelWidth - 122, kPanelHeight - 70), low = corner + glm::dvec2(52, 24 + area.y);
  double most = 1.2;
  for (const AlbedoCurve& curve : check.albedo)
    for (std::size_t i = 0; i < curve.degrees.size(); ++i)
      most = std::max({most, curve.diffuse[i], curve.specular[i]});
  const auto at = [&](double degrees, double albedo) {
    return low + glm::dvec2(degrees / 90 * area.x, -albedo / most * area.y);
  };
  std::string svg = stroke({at(0, most), at(0, 0), at(90, 0)}, "#222222", 1.2);
  svg += stroke({at(0, 1), at(90, 1)}, kLine, 1, " stroke-dasharray=\"4 3\"");
  for (const int degrees : {0, 30, 60, 90})
    svg += label(at(degrees, 0) + glm::dvec2(0, 16), fmt::format("{}°", degrees), " text-anchor=\"middle\"");
  for (const double albedo : {0.0, 0.5, 1.0})
    svg += label(at(0, albedo) + glm::dvec2(-7, 4), fmt::format("{:.1f}", albedo), " text-anchor=\"end\"");
  if (most > 1.4)
    svg += label(at(0, most) + glm::dvec2(-7, 4), fmt::format("{:.1f}", most), " text-anchor=\"end\"");
  std::vector<glm::dvec2> diffuse;
  for (std::size_t i = 0; i < check.albedo.front().degrees.size(); ++i)
    diffuse.push_back(at(check.albedo.front().degrees[i], check.albedo.front().diffuse[i]));
  svg += stroke(diffuse, "#000000", 1.8, " stroke-dasharray=\"7 3\"");
  // Names stand at the curves' ends, the lowest curve's lowest, apart from each other.
  std::vector<std::pair<double, std::size_t>> ends;
  for (std::size_t k = 0; k < check.albedo.size(); ++k) {
    std::vector<glm::dvec2> points;
    const AlbedoCurve& curve = check.albedo[k];
    for (std::size_t i = 0; i < curve.degrees.size(); ++i)
      points.push_back(at(curve.degrees[i], curve.specular[i]));
    svg += stroke(points, curveColor(k), 1.8);
    ends.emplace_back(points.back().y, k);
  }
  std::sort(ends.rbegin(), ends.rend());
  double above = low.y + 12;
  for (const auto& [y, k] : ends) {
    above = std::min(y + 4, above - 12);
    svg += label({at(90, 0).x + 4, above}, fmt::format("n = {:g}", check.albedo[k].shininess),
                 fmt::format(" font-size=\"11\" fill=\"{}\"", curveColor(k)).c_str());
  }
  svg += label(corner + glm::dvec2(kPanelWidth / 2, kPanelHeight - 8),
               "light from everywhere, by the eye's angle", " text-anchor=\"middle\" font-weight=\"bold\"");
  return svg;
}

}  // namespace

std::string modelPlot(const ModelCheck& check) {
  const double width = 3 * kPanelWidth, height = kTitleHeight + 2 * kPanelHeight + 16;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"12\" fill=\"#222222\">\n"
      "<defs><marker id=\"arrow\" viewBox=\"0 0 10 10\" refX=\"8\" refY=\"5\" markerWidth=\"4\" "
      "markerHeight=\"4\" "
      "orient=\"auto\"><path d=\"M0 0L10 5L0 10z\" fill=\"{2}\"/></marker></defs>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
      width, height, kPlotColors[5]);
  svg += label({16, 26}, check.name, " font-size=\"17\" font-weight=\"bold\"");
  svg += label({16, 46}, "What reaches the eye, in the plane of the light (colours of 1). Shininess:");
  for (std::size_t i = 0; i < 3; ++i)
    svg += label({470 + 60.0 * double(i), 46}, fmt::format("— {:g}", check.lobes[i].shininess),
                 fmt::format(" fill=\"{}\" font-weight=\"bold\"", kLobeColors[i]).c_str());
  svg += label({670, 46}, "Last: albedo of the diffuse part - - and of the specular part —");
  for (std::size_t panel = 0; panel < 5; ++panel)
    svg += lobePanel(std::span(check.lobes).subspan(3 * panel, 3),
                     {kPanelWidth * double(panel % 3), kTitleHeight + kPanelHeight * double(panel / 3)});
  svg += albedoPanel(check, {2 * kPanelWidth, kTitleHeight + kPanelHeight});
  return svg + "</svg>\n";
}

}  // namespace luciole
