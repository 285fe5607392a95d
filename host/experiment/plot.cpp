#include "experiment/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "experiment/gnuplot.hpp"
#include "experiment/labels.hpp"

namespace luciole {
namespace {

constexpr double kSteps = 255;        ///< 8-bit steps of 1
constexpr double kLeastError = 1e-9;  ///< steps; an error of 0 is drawn here, as there is no room for it

/// The picture in pixels, y up: the first group across the top, the others side by side under it.
constexpr glm::dvec2 kPicture(960, 960);
constexpr double kHead = 112, kTitleDown = 24, kKeyDown = 58;
constexpr double kLeft = 90, kRight = 20, kUnder = 60, kOver = 40;

Rectangle panelArea(std::size_t index, std::size_t count) {
  const double middle = count > 1 ? kPicture.y * 0.42 : 0;
  if (index == 0) return {{kLeft, middle + kUnder}, {kPicture.x - kRight, kPicture.y - kHead}};
  const double width = kPicture.x / double(count - 1), left = width * double(index - 1);
  return {{left + kLeft, kUnder}, {left + width - kRight, middle - kOver}};
}

/// A logarithmic axis.
struct Axis {
  double low, high;
  /// Where a value lies between the ends, 0 to 1; beyond them at the end.
  double place(double value) const {
    return std::log(std::clamp(value, low, high) / low) / std::log(high / low);
  }
};

/// An axis with some room around the values.
Axis axisAround(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double room = std::max(std::pow(*high / *low, 0.12), 1.15);
  return {*low / room, *high * room};
}

std::string tickList(const Axis& axis) {
  std::string list;
  for (const double tick : logTicks(axis.low, axis.high))
    list += fmt::format("{}'{:g}' {:.17g}", list.empty() ? "" : ", ", tick, tick);
  return list;
}

/// A row as it is drawn.
struct Point {
  std::string name;
  double time, error, spread;  ///< milliseconds, 8-bit steps, milliseconds
  bool front, usual;
};

/// The rows from fast to slow.
std::vector<Point> groupPoints(const BenchGroup& group) {
  std::vector<Point> points;
  for (const BenchRow& row : group.rows)
    points.push_back({row.variant.name, row.time.median, std::max(row.error.mean_abs * kSteps, kLeastError),
                      row.time.spread, row.front, row.variant.is_default});
  std::stable_sort(points.begin(), points.end(),
                   [](const Point& a, const Point& b) { return a.time < b.time; });
  return points;
}

/// Of the points on the front, from fast to slow, those nearer than all before: equally fast ones within the
/// spread would make the line go back and forth.
std::vector<Point> frontLine(const std::vector<Point>& points) {
  std::vector<Point> line;
  for (const Point& point : points)
    if (point.front && (line.empty() || point.error < line.back().error)) line.push_back(point);
  return line;
}

std::string dataBlock(const char* name, const std::vector<Point>& points) {
  std::string block = fmt::format("${} << EOD\n", name);
  for (const Point& point : points) block += fmt::format("{} {} {}\n", point.time, point.error, point.spread);
  if (points.empty()) block += "NaN NaN NaN\n";  // gnuplot refuses a block without points
  return block + "EOD\n";
}

template <class Wanted>
std::vector<Point> only(const std::vector<Point>& points, Wanted&& wanted) {
  std::vector<Point> kept;
  std::copy_if(points.begin(), points.end(), std::back_inserter(kept), wanted);
  return kept;
}

/// Where a panel's values lie, in pixels from its lower left corner.
struct Panel {
  Axis x, y;
  glm::dvec2 size;
  glm::dvec2 place(double time, double error) const {
    return glm::dvec2(x.place(time), y.place(error)) * size;
  }
};

/// What names should not cover: bars of spread, the default's ring, and the front's steps.
std::vector<Rectangle> drawnLines(const Panel& panel, const std::vector<Point>& points) {
  constexpr glm::dvec2 kHalfWidth(3), kRing(12);
  std::vector<Rectangle> drawn;
  const auto add = [&](const glm::dvec2& a, const glm::dvec2& b) {
    drawn.push_back({glm::min(a, b) - kHalfWidth, glm::max(a, b) + kHalfWidth});
  };
  for (const Point& point : points) {
    add(panel.place(point.time - point.spread, point.error),
        panel.place(point.time + point.spread, point.error));
    const glm::dvec2 middle = panel.place(point.time, point.error);
    if (point.usual) drawn.push_back({middle - kRing, middle + kRing});
  }
  const std::vector<Point> line = frontLine(points);
  for (std::size_t i = 1; i < line.size(); ++i) {
    const glm::dvec2 corner = panel.place(line[i].time, line[i - 1].error);
    add(panel.place(line[i - 1].time, line[i - 1].error), corner);
    add(corner, panel.place(line[i].time, line[i].error));
  }
  return drawn;
}

/// Names beside their points, the default's first, and lines to those that had to go farther away.
std::string labelCommands(const Panel& panel, std::vector<Point> points) {
  const std::vector<Rectangle> drawn = drawnLines(panel, points);
  std::stable_partition(points.begin(), points.end(), [](const Point& point) { return point.usual; });
  std::vector<glm::dvec2> places;
  std::vector<std::string> names;
  for (const Point& point : points) {
    places.push_back(panel.place(point.time, point.error));
    names.push_back(point.name);
  }
  const std::vector<Rectangle> labels = placeLabels(places, names, drawn, {glm::dvec2(0), panel.size});
  std::string commands = "unset label\nunset arrow\n";
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const glm::dvec2 middle = (labels[i].low + labels[i].high) / (2.0 * panel.size);
    commands += fmt::format("set label {} at graph {},{} center font ',12' front\n", gnuplotString(names[i]),
                            middle.x, middle.y);
    const glm::dvec2 edge = glm::clamp(places[i], labels[i].low, labels[i].high);
    if (glm::distance(edge, places[i]) > 14)
      commands += fmt::format("set arrow from graph {},{} to graph {},{} nohead lc rgb '#999999' back\n",
                              places[i].x / panel.size.x, places[i].y / panel.size.y, edge.x / panel.size.x,
                              edge.y / panel.size.y);
  }
  return commands;
}

std::string panelCommands(const BenchGroup& group, const Rectangle& area) {
  const std::vector<Point> points = groupPoints(group);
  std::vector<double> times, errors;
  for (const Point& point : points) {
    // A bar may be as long as its median, and a logarithmic axis has no zero.
    times.insert(times.end(),
                 {std::max(point.time - point.spread, point.time / 2), point.time + point.spread});
    errors.push_back(point.error);
  }
  const Panel panel{axisAround(times), axisAround(errors), area.high - area.low};
  std::string commands = fmt::format(
      "set lmargin at screen {}\nset rmargin at screen {}\nset bmargin at screen {}\nset tmargin at screen "
      "{}\n",
      area.low.x / kPicture.x, area.high.x / kPicture.x, area.low.y / kPicture.y, area.high.y / kPicture.y);
  commands +=
      fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\nset xtics ({})\nset ytics ({})\n", panel.x.low,
                  panel.x.high, panel.y.low, panel.y.high, tickList(panel.x), tickList(panel.y));
  commands += fmt::format("set title {} font ',15'\n", gnuplotString(group.group.name));
  commands += labelCommands(panel, points);
  commands += dataBlock("line", frontLine(points));
  commands += dataBlock("front", only(points, [](const Point& p) { return p.front; }));
  commands += dataBlock("beaten", only(points, [](const Point& p) { return !p.front; }));
  commands += dataBlock("usual", only(points, [](const Point& p) { return p.usual; }));
  return commands;
}

}  // namespace

std::vector<double> logTicks(double low, double high) {
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
  return ticks;
}

std::string benchPlot(const BenchResult& result) {
  const std::string title =
      fmt::format("Speed against error: {}, {} x {}", result.scene, result.width, result.height);
  std::string script = fmt::format(
      "set terminal svg size {},{} background rgb 'white' font 'sans-serif,13' noenhanced\n"
      "set encoding utf8\nset multiplot\nset logscale xy\nset grid lc rgb '#dddddd'\nset border lc rgb "
      "'#444444'\n"
      "set xlabel 'milliseconds, median of {} and half the quartiles'' distance'\n"
      "set ylabel 'mean error, 8-bit steps' offset 1,0\n",
      kPicture.x, kPicture.y, result.repeats);
  std::vector<BenchGroup> groups;
  std::copy_if(result.groups.begin(), result.groups.end(), std::back_inserter(groups),
               [](const BenchGroup& group) { return haveOneTruth(group.group); });
  for (std::size_t i = 0; i < groups.size(); ++i) {
    script += panelCommands(groups[i], panelArea(i, groups.size()));
    script += i > 0 ? "unset key\n"
                    : fmt::format(
                          "set key at screen 0.5,{} center center horizontal\n"
                          "set label {} at screen 0.5,{} center font ',17'\n",
                          1 - kKeyDown / kPicture.y, gnuplotString(title), 1 - kTitleDown / kPicture.y);
    script +=
        "plot $line with steps lw 2 lc rgb '#e08214' title 'Pareto front', "
        "$front using 1:2:3 with xerrorbars pt 7 ps 0.8 lw 1.2 lc rgb '#b35806' title 'on it', "
        "$beaten using 1:2:3 with xerrorbars pt 6 ps 0.8 lw 1.2 lc rgb '#3b6ea5' title 'beaten', "
        "$usual with points pt 6 ps 2 lw 2 lc rgb '#000000' title 'default'\n";
  }
  return runGnuplot(script + "unset multiplot\n");
}

}  // namespace luciole
