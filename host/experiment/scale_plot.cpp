#include "experiment/scale_plot.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiment/gnuplot.hpp"

namespace luciole {
namespace {

/// M. Okabe and K. Ito, "Color Universal Design", 2008: told apart by every kind of colour vision.
constexpr const char* kColors[] = {"#000000", "#0072b2", "#d55e00", "#009e73",
                                   "#cc79a7", "#e69f00", "#56b4e9"};

struct Place {
  double lights = 0;
  Quartiles milliseconds;
};

struct Line {
  std::string name;
  std::vector<Place> places;

  double highest() const {
    double most = 0;
    for (const Place& place : places) most = std::max(most, place.milliseconds.median);
    return most;
  }
};

Line& lineNamed(std::vector<Line>& lines, const std::string& name) {
  const auto known =
      std::find_if(lines.begin(), lines.end(), [&](const Line& line) { return line.name == name; });
  if (known != lines.end()) return *known;
  return lines.emplace_back(Line{name, {}});
}

/// The variant that is fastest with the most lights that any was done with.
const std::vector<std::string>& bestVariant(const ScaleSummary& summary) {
  const PointSummary* best = &summary.points.front();
  for (const PointSummary& point : summary.points) {
    const bool has_more = point.point.lights > best->point.lights;
    const bool is_faster =
        point.point.lights == best->point.lights && point.milliseconds.median < best->milliseconds.median;
    if (has_more || is_faster) best = &point;
  }
  return best->point.values;
}

std::vector<Line> stageLines(const ScaleSummary& summary, const std::vector<std::string>& variant) {
  std::vector<Line> lines;
  for (const PointSummary& point : summary.points) {
    if (point.point.values != variant) continue;
    lineNamed(lines, "total").places.push_back({double(point.point.lights), point.milliseconds});
    for (const StageSummary& stage : point.stages)
      lineNamed(lines, stage.name).places.push_back({double(point.point.lights), stage.milliseconds});
  }
  const double least = 0.01 * lines.front().highest();
  std::erase_if(lines, [&](const Line& line) { return line.highest() < least; });
  return lines;
}

std::string variantName(const ScaleSummary& summary, const std::vector<std::string>& values) {
  std::string name;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] == kNotThis) continue;
    name += fmt::format("{}{} {}", name.empty() ? "" : ", ", summary.description.axes[i].name, values[i]);
  }
  return name;
}

std::vector<Line> variantLines(const ScaleSummary& summary) {
  std::vector<Line> lines;
  for (const PointSummary& point : summary.points)
    lineNamed(lines, variantName(summary, point.point.values))
        .places.push_back({double(point.point.lights), point.milliseconds});
  return lines;
}

/// A panel's commands; `first`: the number of its first data block.
std::string panel(const std::string& title, const std::vector<Line>& lines, std::size_t first) {
  std::string blocks, plots;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    blocks += fmt::format("$line{} << EOD\n", first + i);
    for (const Place& place : lines[i].places) {
      const Quartiles& time = place.milliseconds;
      // A logarithmic axis has no zero.
      if (time.low > 0)
        blocks += fmt::format("{} {} {} {}\n", place.lights, time.median, time.low, time.high);
    }
    blocks += "NaN NaN NaN NaN\nEOD\n";  // gnuplot refuses a block without points
    plots +=
        fmt::format("{}$line{} with yerrorlines lw 1.6 pt {} ps 0.6 lc rgb '{}' title {}", i ? ", " : "plot ",
                    first + i, 4 + i % 10, kColors[i % std::size(kColors)], gnuplotString(lines[i].name));
  }
  return blocks + fmt::format("set title {} font ',14'\n", gnuplotString(title)) + plots + "\n";
}

}  // namespace

std::string scalePlot(const ScaleSummary& summary) {
  const std::vector<Line> variants = variantLines(summary);
  const bool two = variants.size() > 1;
  std::string script = fmt::format(
      "set terminal svg size {},480 background rgb 'white' font 'sans-serif,13' noenhanced\n"
      "set encoding utf8\nset multiplot layout 1,{}\nset logscale xy\nset grid lc rgb '#dddddd'\n"
      "set border lc rgb '#444444'\nset format x '%.0s%c'\nset key bmargin center horizontal samplen 2\n"
      "set xlabel 'lights'\nset ylabel 'milliseconds, median and quartiles' offset 1,0\n"
      "set offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05\n",
      two ? 1080 : 640, two ? 2 : 1);
  const std::vector<std::string>& best = bestVariant(summary);
  const std::string name = two ? variantName(summary, best) : summary.description.scene;
  const std::vector<Line> stages = stageLines(summary, best);
  script += panel(name + ", by stage", stages, 0);
  if (two) script += panel("the whole picture, by variant", variants, stages.size());
  return runGnuplot(script + "unset multiplot\n");
}

}  // namespace luciole
