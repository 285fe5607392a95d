#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace luciole {

/// Colours that every kind of colour vision tells apart, and that show on white (M. Okabe and K. Ito, "Color
/// Universal Design", 2008, without yellow): black, blue, vermilion, green, purple, orange, sky blue.
inline constexpr const char* kPlotColors[] = {"#000000", "#0072b2", "#d55e00", "#009e73",
                                              "#cc79a7", "#e69f00", "#56b4e9"};

enum class PlotMarker { kNone, kDot, kSquare, kTriangle, kDiamond, kCircle, kRing };
enum class PlotLine { kNone, kStraight, kSteps };  ///< steps go right first, then up or down

struct PlotPoint {
  glm::dvec2 at{0.0};              ///< ≥ 0
  glm::dvec2 low{0.0}, high{0.0};  ///< ends of its error bars in x and y; no bar if they are equal
  std::string label{};             ///< text beside it
};

struct PlotSeries {
  std::string name{};  ///< in the legend
  std::string color = kPlotColors[0];
  PlotMarker marker = PlotMarker::kDot;
  PlotLine line = PlotLine::kNone;
  std::string dash{};  ///< of the line, as stroke-dasharray; empty: none
  std::vector<PlotPoint> points{};
};

struct PlotAxis {
  std::string title{};
  std::string (*tick)(double) = nullptr;  ///< the text for a number on the axis
};

/// Series on logarithmic axes. The later ones are drawn over the earlier, and their labels get better places.
struct PlotPanel {
  std::string title{};
  glm::dvec2 size{0.0};  ///< of the area between the axes, pixels
  PlotAxis x{}, y{};
  std::vector<PlotSeries> series{};
  bool has_legend = true;
};

/// Rows of panels side by side.
struct Plot {
  std::string title{};
  std::vector<std::vector<PlotPanel>> rows{};
};

/// A text for SVG, between tags or in an attribute. What isn't valid UTF-8, or isn't allowed in XML, becomes
/// U+FFFD.
std::string svgText(const std::string& text);

/// The plot as an SVG picture in UTF-8, as large as its panels need.
std::string svgPlot(const Plot& plot);

}  // namespace luciole
