#include "tools/scale/scale_method.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "luciole/error.hpp"
#include "tools/scale/scale_truth.hpp"

namespace luciole {
namespace {

/// Who made the point's picture: the value of kMethodAxis.
std::string makerOf(const ScaleDescription& description, const ScalePoint& point) {
  for (std::size_t i = 0; i < point.values.size(); ++i)
    if (description.axes[i].name == kMethodAxis) return point.values[i];
  return kOwnMethod;
}

}  // namespace

const ScaleMethod* methodOf(const ScaleDescription& description, const ScalePoint& point) {
  const std::string maker = makerOf(description, point);
  const auto found = std::find_if(description.methods.begin(), description.methods.end(),
                                  [&](const ScaleMethod& method) { return method.name == maker; });
  return found == description.methods.end() ? nullptr : &*found;
}

int runsOf(const ScaleDescription& description, const ScalePoint& point) {
  const ScaleMethod* method = methodOf(description, point);
  return method ? method->runs : description.repeats;
}

void addMethods(ScaleExperiment& experiment, const std::vector<ScaleMethod>& methods,
                const std::vector<std::vector<std::optional<OtherPicture>>>& of_lights) {
  ScaleDescription& description = experiment.description;
  const std::string truth = truthName(description, description.points.front());
  for (const ScalePoint& point : description.points)
    if (truthName(description, point) != truth)
      throw InputError(fmt::format(
          "scale: --against {}: the variants are meant to make different pictures, '{}' and '{}'; expected "
          "variants of one",
          methods.front().name, truth, truthName(description, point)));
  const ScaleTask first = experiment.tasks.front();
  std::vector<ScalePoint> points;
  std::vector<ScaleTask> tasks;
  std::size_t next = 0;
  for (std::size_t k = 0; k < description.lights.size(); ++k) {
    for (; next < description.points.size() && description.points[next].lights == description.lights[k];
         ++next) {
      points.push_back(description.points[next]);
      points.back().values.emplace_back(kOwnMethod);
      tasks.push_back(experiment.tasks[next]);
    }
    for (std::size_t i = 0; i < methods.size(); ++i) {
      if (!of_lights[i][k]) continue;
      std::vector<std::string> values(description.axes.size(), kNotThis);
      values.push_back(methods[i].name);
      points.push_back({description.lights[k], std::move(values)});
      tasks.push_back(first);
      tasks.back().other = of_lights[i][k];
    }
  }
  for (ScaleAxis& axis : description.axes)
    if (std::find(axis.values.begin(), axis.values.end(), kNotThis) == axis.values.end())
      axis.values.emplace_back(kNotThis);
  description.axes.push_back({kMethodAxis, {kOwnMethod}});
  for (const ScaleMethod& method : methods) description.axes.back().values.push_back(method.name);
  description.methods = methods;
  description.points = std::move(points);
  experiment.tasks = std::move(tasks);
}

Image readMethodPicture(const std::string& file, const glm::ivec2& size) {
  const Image picture = readImage(file);
  if (picture.width != size.x || picture.height != size.y)
    throw InputError(fmt::format("{}: {} x {} pixels, expected {} x {}", file, picture.width, picture.height,
                                 size.x, size.y));
  std::size_t places[3];
  for (int c = 0; c < 3; ++c) {
    const auto place = std::find(picture.channels.begin(), picture.channels.end(), std::string(1, "RGB"[c]));
    if (place == picture.channels.end())
      throw InputError(
          fmt::format("{}: channels '{}', expected R G B", file, fmt::join(picture.channels, " ")));
    places[c] = std::size_t(place - picture.channels.begin());
  }
  Image colors{size.x, size.y, {"R", "G", "B"}, {}};
  for (std::size_t i = 0; i < picture.pixels.size(); i += picture.channels.size())
    for (const std::size_t place : places) colors.pixels.push_back(picture.pixels[i + place]);
  const auto wrong = std::count_if(colors.pixels.begin(), colors.pixels.end(),
                                   [](float value) { return !std::isfinite(value); });
  if (wrong > 0)
    throw InputError(fmt::format("{}: {} value{} not finite, expected numbers", file, wrong,
                                 wrong == 1 ? " is" : "s are"));
  return colors;
}

}  // namespace luciole
