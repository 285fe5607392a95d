#include "tools/figures/svg_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/utf8.hpp"
#include "tools/figures/labels.hpp"
#include "tools/figures/log_axis.hpp"

namespace luciole {

std::string svgText(const std::string& text) {
  const std::string valid = utf8Of(text);
  constexpr const char* kReplacement = "\uFFFD";
  std::string out;
  for (std::size_t i = 0; i < valid.size(); ++i) {
    const unsigned char c = static_cast<unsigned char>(valid[i]);
    const bool is_noncharacter = valid.compare(i, 3, "\uFFFE") == 0 || valid.compare(i, 3, "\uFFFF") == 0;
    if (is_noncharacter) i += 2;
    if (c < ' ' || is_noncharacter)
      out += kReplacement;
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else if (c == '"')
      out += "&quot;";
    else
      out += valid[i];
  }
  return out;
}

namespace {

// Pixels.
constexpr double kFont = 12, kTitleFont = 14, kHeadFont = 17;
constexpr double kMargin = 16, kHead = 32;                          ///< around the picture; its title
constexpr double kLeft = 78, kRight = 12, kOver = 28, kUnder = 46;  ///< of a panel, around its area
constexpr double kSwatch = 30, kSwatchGap = 8, kEntry = 20, kLegendGap = 16;
constexpr double kTickGap = 48;  ///< between labelled ticks, at least
constexpr const char *kInk = "#222222", *kMuted = "#555555", *kGrid = "#d9d9d9", *kFineGrid = "#f0f0f0";

std::string number(double value) {
  return fmt::format("{:g}", std::round(value * 100) / 100 + 0.0);  // + 0: no "-0"
}

enum class Anchor { kStart, kMiddle, kEnd };

/// A line of text, vertically centred at `at`. more: attributes.
std::string textAt(const glm::dvec2& at, Anchor anchor, const std::string& text,
                   const std::string& more = "") {
  static constexpr const char* kAnchors[] = {"", " text-anchor=\"middle\"", " text-anchor=\"end\""};
  return fmt::format("<text x=\"{}\" y=\"{}\" dy=\".35em\"{}{}>{}</text>\n", number(at.x), number(at.y),
                     kAnchors[int(anchor)], more, svgText(text));
}

std::string lineBetween(const glm::dvec2& a, const glm::dvec2& b) {
  return fmt::format("M{} {}L{} {}", number(a.x), number(a.y), number(b.x), number(b.y));
}

std::string path(const std::string& steps, const std::string& color, double width,
                 const std::string& more = "") {
  if (steps.empty()) return "";
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}/>\n", steps, color,
                     number(width), more);
}

std::string markerAt(const glm::dvec2& at, PlotMarker marker, const std::string& color) {
  const auto polygon = [&](const std::vector<glm::dvec2>& corners) {
    std::string d;
    for (const glm::dvec2& corner : corners)
      d += fmt::format("{}{} {}", d.empty() ? "M" : "L", number(at.x + corner.x), number(at.y + corner.y));
    return fmt::format("<path d=\"{}Z\" fill=\"{}\"/>\n", d, color);
  };
  const auto circle = [&](double radius, const std::string& look) {
    return fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n", number(at.x), number(at.y),
                       number(radius), look);
  };
  switch (marker) {
    case PlotMarker::kNone:
      return "";
    case PlotMarker::kDot:
      return circle(4, fmt::format("fill=\"{}\"", color));
    case PlotMarker::kSquare:
      return polygon({{-3.5, -3.5}, {3.5, -3.5}, {3.5, 3.5}, {-3.5, 3.5}});
    case PlotMarker::kTriangle:
      return polygon({{0, -4.5}, {4.5, 3.5}, {-4.5, 3.5}});
    case PlotMarker::kDiamond:
      return polygon({{0, -5}, {5, 0}, {0, 5}, {-5, 0}});
    case PlotMarker::kCircle:
      return circle(3.5, fmt::format("fill=\"#ffffff\" stroke=\"{}\" stroke-width=\"1.5\"", color));
    case PlotMarker::kRing:
      return circle(9, fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"2\"", color));
  }
  return "";
}

std::string lineLook(const PlotSeries& series) {
  const std::string dash = series.dash.empty() ? "" : fmt::format(" stroke-dasharray=\"{}\"", series.dash);
  return " stroke-linejoin=\"round\"" + dash;
}

/// A panel's area in the picture, and its axes.
struct Frame {
  Rectangle area;
  LogAxis x, y;

  glm::dvec2 place(const glm::dvec2& value) const {
    return {area.low.x + x.place(value.x) * (area.high.x - area.low.x),
            area.high.y - y.place(value.y) * (area.high.y - area.low.y)};
  }
};

/// An axis that holds all points and bars. An end of a bar at 0 or below doesn't count: the bar is drawn to
/// the axis. Labels need room.
LogAxis axisOf(const PlotPanel& panel, int axis) {
  std::vector<double> values;
  bool has_labels = false;
  for (const PlotSeries& series : panel.series) {
    for (const PlotPoint& point : series.points) {
      values.push_back(point.at[axis]);
      has_labels |= !point.label.empty();
      for (const double end : {point.low[axis], point.high[axis]})
        if (end > 0) values.push_back(end);
    }
  }
  return axisAround(values, has_labels ? 0.12 : 0.05);
}

std::vector<double> ticksOf(const LogAxis& axis, double length) {
  const double low = axis.floor ? *axis.floor * 1.3 : axis.low;
  return logTicks(low, axis.high, std::max(2, int(length / kTickGap)));
}

/// Ticks between the powers of ten; none if they would be too dense.
std::vector<double> fineTicks(const LogAxis& axis, double length) {
  const double low = axis.floor ? *axis.floor * 1.3 : axis.low;
  std::vector<double> ticks;
  if (length / std::log10(axis.high / axis.low) < 40) return ticks;
  for (int power = int(std::floor(std::log10(low))); std::pow(10.0, power) <= axis.high; ++power)
    for (int multiple = 2; multiple < 10; ++multiple)
      if (const double tick = multiple * std::pow(10.0, power); tick > low && tick < axis.high)
        ticks.push_back(tick);
  return ticks;
}

std::string axes(const PlotPanel& panel, const Frame& frame) {
  const Rectangle& area = frame.area;
  const glm::dvec2 size = area.high - area.low;
  const auto across = [&](double y) { return lineBetween({area.low.x, y}, {area.high.x, y}); };
  const auto upright = [&](double x) { return lineBetween({x, area.low.y}, {x, area.high.y}); };
  const auto placeX = [&](double value) { return frame.place({value, 1}).x; };
  const auto placeY = [&](double value) { return frame.place({1, value}).y; };
  std::string fine, coarse, zero, texts;
  for (const double tick : fineTicks(frame.x, size.x)) fine += upright(placeX(tick));
  for (const double tick : fineTicks(frame.y, size.y)) fine += across(placeY(tick));
  const auto addX = [&](double tick, const std::string& text, std::string& lines) {
    lines += upright(placeX(tick));
    texts += textAt({placeX(tick), area.high.y + 14}, Anchor::kMiddle, text);
  };
  const auto addY = [&](double tick, const std::string& text, std::string& lines) {
    lines += across(placeY(tick));
    texts += textAt({area.low.x - 8, placeY(tick)}, Anchor::kEnd, text);
  };
  for (const double tick : ticksOf(frame.x, size.x)) addX(tick, panel.x.tick(tick), coarse);
  for (const double tick : ticksOf(frame.y, size.y)) addY(tick, panel.y.tick(tick), coarse);
  if (frame.x.floor) addX(0, "0", zero);
  if (frame.y.floor) addY(0, "0", zero);
  const glm::dvec2 middle = (area.low + area.high) / 2.0;
  const double left = area.low.x - kLeft + kFont;
  return path(fine, kFineGrid, 1) + path(coarse, kGrid, 1) +
         path(zero, kMuted, 1, " stroke-dasharray=\"3 4\"") +
         path(across(area.high.y) + upright(area.low.x), kMuted, 1) +
         fmt::format("<g fill=\"{}\">\n{}{}{}</g>\n", kMuted, texts,
                     textAt({middle.x, area.high.y + 34}, Anchor::kMiddle, panel.x.title),
                     textAt({left, middle.y}, Anchor::kMiddle, panel.y.title,
                            fmt::format(" transform=\"rotate(-90 {} {})\"", number(left), number(middle.y))));
}

std::vector<Segment> lineOf(const PlotSeries& series, const Frame& frame) {
  std::vector<Segment> segments;
  for (std::size_t i = 1; i < series.points.size(); ++i) {
    const glm::dvec2 from = frame.place(series.points[i - 1].at), to = frame.place(series.points[i].at);
    if (series.line == PlotLine::kSteps) {
      const glm::dvec2 corner(to.x, from.y);
      segments.push_back({from, corner});
      segments.push_back({corner, to});
    } else if (series.line == PlotLine::kStraight) {
      segments.push_back({from, to});
    }
  }
  return segments;
}

std::vector<Segment> barsOf(const PlotSeries& series, const Frame& frame) {
  std::vector<Segment> bars;
  for (const PlotPoint& point : series.points)
    for (int axis = 0; axis < 2; ++axis) {
      if (point.low[axis] >= point.high[axis]) continue;
      glm::dvec2 low = point.at, high = point.at;
      low[axis] = std::max(point.low[axis], axis == 0 ? frame.x.low : frame.y.low);
      high[axis] = point.high[axis];
      bars.push_back({frame.place(low), frame.place(high)});
    }
  return bars;
}

std::string drawSeries(const PlotSeries& series, const Frame& frame) {
  std::string line, bars, markers;
  for (const Segment& segment : lineOf(series, frame))
    // A single path, so that its corners are joined.
    line += line.empty() ? lineBetween(segment.from, segment.to)
                         : fmt::format("L{} {}", number(segment.to.x), number(segment.to.y));
  for (const Segment& bar : barsOf(series, frame)) {
    const glm::dvec2 cap = glm::dvec2(bar.from.x == bar.to.x ? 4 : 0, bar.from.y == bar.to.y ? 4 : 0);
    bars += lineBetween(bar.from, bar.to) + lineBetween(bar.from - cap, bar.from + cap) +
            lineBetween(bar.to - cap, bar.to + cap);
  }
  for (const PlotPoint& point : series.points)
    markers += markerAt(frame.place(point.at), series.marker, series.color);
  return path(line, series.color, 2, lineLook(series)) + path(bars, series.color, 1.2) + markers;
}

/// The labels. A white outline keeps one readable that lies over something.
std::string drawLabels(const PlotPanel& panel, const Frame& frame) {
  constexpr glm::dvec2 kRing(11);
  std::vector<Label> labels;
  std::vector<Rectangle> taken;
  std::vector<Segment> lines;
  for (auto series = panel.series.rbegin(); series != panel.series.rend(); ++series) {
    for (const std::vector<Segment>& drawn : {lineOf(*series, frame), barsOf(*series, frame)})
      lines.insert(lines.end(), drawn.begin(), drawn.end());
    for (const PlotPoint& point : series->points) {
      const glm::dvec2 at = frame.place(point.at);
      if (!point.label.empty()) labels.push_back({at, point.label});
      if (series->marker == PlotMarker::kRing) taken.push_back({at - kRing, at + kRing});
    }
  }
  std::string leaders, texts;
  const std::vector<LabelPlace> places =
      placeLabels(labels, kFont, taken, lines, {frame.area.low + 3.0, frame.area.high - 3.0});
  for (std::size_t i = 0; i < places.size(); ++i) {
    const LabelPlace& place = places[i];
    if (place.has_leader) leaders += lineBetween(place.leader.from, place.leader.to);
    texts += textAt((place.text.low + place.text.high) / 2.0, Anchor::kMiddle, labels[i].text);
  }
  if (texts.empty()) return "";
  return path(leaders, "#999999", 1) +
         fmt::format(
             "<g class=\"labels\" fill=\"{}\" stroke=\"#ffffff\" stroke-width=\"3\" "
             "stroke-linejoin=\"round\" paint-order=\"stroke\">\n{}</g>\n",
             kInk, texts);
}

/// The series that have a name.
std::vector<const PlotSeries*> legendOf(const PlotPanel& panel) {
  std::vector<const PlotSeries*> entries;
  for (const PlotSeries& series : panel.series)
    if (panel.has_legend && !series.name.empty()) entries.push_back(&series);
  return entries;
}

std::string drawLegend(const PlotPanel& panel, const Frame& frame) {
  std::string drawn;
  glm::dvec2 at(frame.area.high.x + kLegendGap, frame.area.low.y + kEntry / 2);
  for (const PlotSeries* series : legendOf(panel)) {
    if (series->line != PlotLine::kNone)
      drawn += path(lineBetween(at, at + glm::dvec2(kSwatch, 0)), series->color, 2, lineLook(*series));
    drawn += markerAt(at + glm::dvec2(kSwatch / 2, 0), series->marker, series->color);
    drawn += textAt(at + glm::dvec2(kSwatch + kSwatchGap, 0), Anchor::kStart, series->name);
    at.y += kEntry;
  }
  return drawn;
}

/// The sizes of a panel: of the area between its axes, which is at least as high as its legend, and of the
/// whole with all that is around it.
struct PanelSize {
  glm::dvec2 area, whole;
};

PanelSize sizeOf(const PlotPanel& panel) {
  const std::vector<const PlotSeries*> legend = legendOf(panel);
  double widest = 0;
  for (const PlotSeries* series : legend) widest = std::max(widest, textSize(series->name, kFont).x);
  const double legend_width = legend.empty() ? 0 : kLegendGap + kSwatch + kSwatchGap + widest;
  const glm::dvec2 area = glm::max(panel.size, glm::dvec2(0, kEntry * double(legend.size())));
  return {area, area + glm::dvec2(kLeft + kRight + legend_width, kOver + kUnder)};
}

std::string drawPanel(const PlotPanel& panel, const glm::dvec2& corner) {
  const glm::dvec2 low = corner + glm::dvec2(kLeft, kOver);
  const Frame frame{{low, low + sizeOf(panel).area}, axisOf(panel, 0), axisOf(panel, 1)};
  std::string drawn = textAt({low.x, corner.y + kOver / 2}, Anchor::kStart, panel.title,
                             fmt::format(" font-size=\"{}\" font-weight=\"bold\"", kTitleFont));
  drawn += axes(panel, frame);
  for (const PlotSeries& series : panel.series) drawn += drawSeries(series, frame);
  return "<g>\n" + drawn + drawLabels(panel, frame) + drawLegend(panel, frame) + "</g>\n";
}

}  // namespace

std::string svgPlot(const Plot& plot) {
  glm::dvec2 size(textSize(plot.title, kHeadFont).x + 2 * kMargin, kMargin + kHead);
  std::string panels;
  for (const std::vector<PlotPanel>& row : plot.rows) {
    glm::dvec2 corner(kMargin, size.y);
    double height = 0;
    for (const PlotPanel& panel : row) {
      panels += drawPanel(panel, corner);
      const glm::dvec2 taken = sizeOf(panel).whole;
      corner.x += taken.x;
      height = std::max(height, taken.y);
    }
    size = {std::max(size.x, corner.x + kMargin), size.y + height};
  }
  size.y += kMargin;
  const std::string width = number(std::ceil(size.x)), height = number(std::ceil(size.y));
  return fmt::format(
             "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
             "width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" role=\"img\" font-family=\"sans-serif\" "
             "font-size=\"{2}\" fill=\"{3}\">\n<title>{4}</title>\n<rect width=\"{0}\" height=\"{1}\" "
             "fill=\"#ffffff\"/>\n",
             width, height, kFont, kInk, svgText(plot.title)) +
         textAt({kMargin, kMargin + kHead / 2}, Anchor::kStart, plot.title,
                fmt::format(" font-size=\"{}\" font-weight=\"bold\"", kHeadFont)) +
         panels + "</svg>\n";
}

}  // namespace luciole
