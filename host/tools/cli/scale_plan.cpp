#include "tools/cli/scale_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "base/sha256.hpp"
#include "base/split.hpp"
#include "base/text_file.hpp"
#include "base/utf8.hpp"
#include "luciole/error.hpp"
#include "raster/visible_points.hpp"
#include "scene/bounds.hpp"
#include "scene/json/light_list.hpp"
#include "scene/models.hpp"
#include "scene/scene_digest.hpp"
#include "tools/cli/scale_against.hpp"
#include "tools/cli/suggest.hpp"

namespace luciole {
namespace {

/// The axes of --vary: options of this command, with their default values. Those of `range` depend on the
/// scene (defaultRanges).
const std::vector<ScaleAxis> kAxes{{"culling", {"none", "tiles"}},
                                   {"tile", {"4", "8", "16"}},
                                   {"samples", {"1", "4", "16"}},
                                   {"shadows", {"off", "auto", "hard", "pcf", "exact"}},
                                   {"model", {kModelNames.begin(), kModelNames.end()}},
                                   {"shading", {"flat", "gouraud", "phong"}},
                                   {"field", {"box", "surface", "clusters"}},
                                   {"density", {"1", "8", "64"}},
                                   {"range", {}},
                                   {"cutoff", {"0.1", "0.01", "0.001"}},
                                   {"no-range", {"true"}},
                                   {"intensity", {"0.5", "1", "2"}},
                                   {"pcf-width", {"2", "4", "6"}},
                                   {"shadow-memory", {"64", "512"}},
                                   {"shadow-size", {"512", "1024", "2048", "4096"}},
                                   {kLightErrorAxis, {"0", "1/16", "1/64", "1/256", "1/1024"}},
                                   {kConfidenceAxis, {"0.9", "0.95", "0.99", "0.999"}}};

/// Axes that say how far lights reach. A variant takes a value of only one of them.
constexpr const char* kReaches[] = {"density", "range", "cutoff", "no-range"};

/// The most pairs of a pixel and a light, seconds of work, of a picture without light error beside others
/// with one: without shadows, and with them.
constexpr double kMostExactPairs = 1e10, kMostShadowedPairs = 1e9;

constexpr const char* kViewOfGBuffer =
    "scale: --gbuffer: a G-buffer has its size, camera, shading and samples already";

constexpr glm::ivec2 kDefaultSize(640, 360);
/// Number of visible points that make a box which holds most of what is seen.
constexpr std::size_t kPointsOfAField = 1000;
/// The truth has so many samples for each one of the picture with the most, if that has several.
constexpr int kTruthSamples = 4;

/// Parses --lights: "1,10,…,1000" or "1,10,...,1000". Dots after two numbers continue them by the same factor
/// up to the next number. Throws InputError.
std::vector<std::uint64_t> parseLights(const std::string& text) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("--lights {}: {}", text, why));
  };
  std::vector<std::uint64_t> lights;
  std::uint64_t factor = 0;  // of dots whose last number is still to come
  for (const std::string& part : split(text, ',')) {
    if (part == "..." || part == "…") {
      const std::size_t n = lights.size();
      if (n < 2 || factor > 0 || lights[n - 1] % lights[n - 2] != 0)
        refuse("dots go on from two numbers, of which the second is a multiple of the first");
      factor = lights[n - 1] / lights[n - 2];
      continue;
    }
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
    if (error != std::errc() || end != part.data() + part.size() || number < 1 || number > kMostLights)
      refuse(fmt::format("'{}' is no number of lights from 1 to {}", part, kMostLights));
    if (!lights.empty() && number <= lights.back()) refuse("expected each number above the one before");
    for (; factor > 0 && lights.back() < number / factor; lights.push_back(lights.back() * factor)) {
    }
    if (factor > 0 && lights.back() * factor != number)
      refuse("the dots don't lead to the number after them");
    factor = 0;
    lights.push_back(number);
  }
  if (factor > 0) refuse("expected a number after the dots");
  return lights;
}

/// Parses --vary: "culling,tile=4,8" are names of axes, each followed by its values after '=', if any.
std::vector<ScaleAxis> parseAxes(const std::vector<std::string>& vary) {
  const auto refuse = [](const std::string& part, const std::string& why) {
    throw InputError(fmt::format("--vary {}: {}", part, why));
  };
  std::vector<ScaleAxis> axes;
  for (const std::string& text : vary) {
    bool takes_values = false;
    for (const std::string& part : split(text, ',')) {
      const std::size_t equals = part.find('=');
      const std::string name = part.substr(0, equals);
      const auto known =
          std::find_if(kAxes.begin(), kAxes.end(), [&](const ScaleAxis& axis) { return axis.name == name; });
      if (known == kAxes.end()) {
        if (!takes_values) {
          std::vector<std::string> names;
          for (const ScaleAxis& axis : kAxes) names.push_back(axis.name);
          refuse(part, fmt::format("expected one of {}{}", fmt::join(names, ", "), didYouMean(part, names)));
        }
        axes.back().values.push_back(part);
        continue;
      }
      if (std::any_of(axes.begin(), axes.end(), [&](const ScaleAxis& axis) { return axis.name == name; }))
        refuse(part, "is there twice");
      takes_values = equals != std::string::npos;
      axes.push_back({name, takes_values ? std::vector{part.substr(equals + 1)} : known->values});
    }
  }
  for (const ScaleAxis& axis : axes)
    for (std::size_t i = 0; i < axis.values.size(); ++i)
      if (axis.values[i].empty() || axis.values[i] == kNotThis ||
          std::count(axis.values.begin(), axis.values.end(), axis.values[i]) > 1)
        refuse(axis.name, fmt::format("value '{}' is none or there twice", axis.values[i]));
  return axes;
}

bool isReach(const ScaleAxis& axis) {
  return std::find(std::begin(kReaches), std::end(kReaches), axis.name) != std::end(kReaches);
}

/// Default ranges of lights in metres, rounded to two digits: 1/64, 1/32 and 1/16 of the box's diagonal.
std::vector<std::string> defaultRanges(const Bounds& box) {
  std::vector<std::string> ranges;
  for (const double part : {64.0, 32.0, 16.0})
    ranges.push_back(
        fmt::format("{}", std::stod(fmt::format("{:.1e}", glm::length(box.high - box.low) / part))));
  return ranges;
}

/// Fills in values that depend on the scene. If several axes say how far lights reach, each also gets the
/// value kNotThis, so that they take turns.
void completeAxes(std::vector<ScaleAxis>& axes, const Bounds& box) {
  const bool take_turns = std::count_if(axes.begin(), axes.end(), isReach) > 1;
  for (ScaleAxis& axis : axes) {
    if (axis.values.empty()) axis.values = defaultRanges(box);
    if (take_turns && isReach(axis)) axis.values.push_back(kNotThis);
  }
}

/// All combinations of one value from each axis; the last axis changes fastest.
std::vector<std::vector<std::string>> allVariants(const std::vector<ScaleAxis>& axes) {
  std::vector<std::vector<std::string>> variants{{}};
  for (const ScaleAxis& axis : axes) {
    std::vector<std::vector<std::string>> longer;
    for (const auto& variant : variants)
      for (const std::string& value : axis.values) {
        longer.push_back(variant);
        longer.back().push_back(value);
      }
    variants = std::move(longer);
  }
  return variants;
}

/// Whether a combination is left out. Either it has not exactly one of the axes that say how far lights
/// reach, or it repeats another variant: an axis without effect beside another's value only keeps its first
/// value.
bool isLeftOut(const std::vector<ScaleAxis>& axes, const std::vector<std::string>& variant) {
  const auto has = [&](const std::string& name, const std::string& value) {
    for (std::size_t i = 0; i < axes.size(); ++i)
      if (axes[i].name == name) return variant[i] == value;
    return false;
  };
  const auto isFirst = [&](const std::string& name) {
    for (std::size_t i = 0; i < axes.size(); ++i)
      if (axes[i].name == name) return variant[i] == axes[i].values.front();
    return true;
  };
  int reaches = 0, reach_axes = 0;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    reach_axes += isReach(axes[i]);
    reaches += isReach(axes[i]) && variant[i] != kNotThis;
  }
  if (reach_axes > 0 && reaches != 1) return true;
  const bool varies_shadows =
      std::any_of(axes.begin(), axes.end(), [](const ScaleAxis& axis) { return axis.name == "shadows"; });
  return (has("culling", "none") && !isFirst("tile")) ||
         ((has("shadows", "off") || has(kLightErrorAxis, "0")) && !isFirst(kConfidenceAxis)) ||
         (varies_shadows && !has("shadows", "pcf") && !isFirst("pcf-width")) ||
         (has("shadows", "off") && (!isFirst("shadow-memory") || !isFirst("shadow-size")));
}

/// Whether a point without light error is left out, beside others with one, because each of its pictures
/// would take long.
bool isTooExact(const RenderSettings& settings, std::uint64_t lights, const std::vector<ScaleAxis>& axes) {
  const bool has_rivals = std::any_of(axes.begin(), axes.end(), [](const ScaleAxis& axis) {
    return axis.name == kLightErrorAxis && axis.values.size() > 1;
  });
  const double samples = double(settings.size.x) * settings.size.y * settings.samples;
  return has_rivals && settings.shade.light_error == 0 &&
         samples * double(lights) >
             (settings.shade.shadows == ShadowMethod::kOff ? kMostExactPairs : kMostShadowedPairs);
}

/// Sets an option as if it had been typed, and runs its checks.
void setOption(CLI::App& command, const std::string& name, const std::string& value) {
  CLI::Option* option = command.get_option("--" + name);
  option->clear();
  if (value == kNotThis) return;
  option->add_result(value);
  try {
    option->run_callback();
  } catch (const CLI::ParseError& error) {
    throw InputError(fmt::format("--vary {}={}: {}", name, value, error.what()));
  }
}

bool isGiven(const CLI::App& command, const std::string& name) {
  return command.get_option("--" + name)->count() > 0;
}

/// Takes the values of ways to say how far lights reach that the variant leaves to another one.
void forgetReaches(const CLI::App& command, ScaleOptions& options) {
  if (!isGiven(command, "range")) options.range.reset();
  if (!isGiven(command, "cutoff")) options.cutoff.reset();
  if (!isGiven(command, "no-range")) options.no_range = false;
}

bool variesLightError(const std::vector<ScaleAxis>& axes) {
  return std::any_of(axes.begin(), axes.end(),
                     [](const ScaleAxis& axis) { return axis.name == kLightErrorAxis; });
}

bool asksLightError(const ScaleOptions& options) {
  RenderSettings settings;
  applySettings({{"light_error", options.picture.value("light_error")}}, settings);
  return settings.shade.light_error > 0;
}

bool isList(const ScaleOptions& options) { return options.field.ends_with(".csv"); }

/// The first `count` of the scene's own lights. Those that it marks cast shadows, or all where it marks none;
/// none has a size, as the truth of all methods of shadows is rays to their middles.
std::vector<Light> ownLights(const ScaleOptions& options, const Scene& scene, std::uint64_t count) {
  const std::size_t there = scene.adds_lights ? 0 : scene.lights.size();
  if (there < count)
    throw InputError(
        fmt::format("{}: {} lights of its own, expected {} or more", options.scene, there, count));
  std::vector<Light> lights(scene.lights.begin(), scene.lights.begin() + std::ptrdiff_t(count));
  const bool marks =
      std::any_of(lights.begin(), lights.end(), [](const Light& light) { return light.shadow; });
  for (Light& light : lights) {
    light.shadow = light.shadow || !marks;
    light.radius = light.half_angle = 0;
  }
  return lights;
}

/// A field of lights that stay as they are.
LightField ownField(const ScaleOptions& options, const Scene& scene, std::uint64_t count) {
  LightField field;
  field.shape = FieldShape::kList;
  field.count = count;
  field.as_listed = true;
  field.list = isList(options) ? readLightList(options.field, count) : ownLights(options, scene, count);
  const bool casts = options.picture.value("shadows") != "off";
  for (Light& light : field.list) light.shadow = casts && (light.shadow || isList(options));
  return field;
}

LightField makeField(const ScaleOptions& options, const Scene& scene, const Bounds& box,
                     std::uint64_t most_lights) {
  if (options.own_lights) return ownField(options, scene, most_lights);
  LightField field;
  field.count = most_lights;
  if (options.sources) return field;
  if (isList(options)) {
    field.shape = FieldShape::kList;
    field.list = readLightList(options.field, most_lights);
  } else {
    const auto shape = fieldShapeNamed(options.field);
    if (!shape)
      throw InputError(
          fmt::format("--field {}: expected {}, or a .csv file", options.field, kFieldShapeNames));
    field = fieldInBox(*shape, box);
  }
  field.count = most_lights;
  field.seed = options.seed;
  field.intensity = glm::vec2(float(options.intensity));
  if (options.range) field.range = glm::vec2(float(*options.range));
  if (options.cutoff) {
    field.cutoff = *options.cutoff;
    field.attenuation = glm::vec3(0, 0, 1);
  }
  field.shadow = options.picture.value("shadows") != "off";
  return field;
}

/// Whether ranges are chosen for a density of lights: if --density is given, or if nothing else says the
/// range (--range, --cutoff, or a file of lights).
bool choosesRanges(const CLI::App& command, const ScaleOptions& options) {
  if (options.own_lights || options.sources) return false;
  return isGiven(command, "density") || (!options.range && !options.cutoff && !isList(options));
}

/// Whether lights lose their ranges: if that is asked for, or if a light error is, which concerns lights
/// without range alone, and nothing else says how far they reach.
bool removesRanges(const CLI::App& command, const ScaleOptions& options, const std::vector<ScaleAxis>& axes) {
  if (options.own_lights || options.sources) return false;
  if (options.no_range) return true;
  const bool is_reach_said = std::any_of(std::begin(kReaches), std::end(kReaches),
                                         [&](const char* name) { return isGiven(command, name); }) ||
                             isList(options);
  return (asksLightError(options) || variesLightError(axes)) && !is_reach_said;
}

/// So that an experiment goes on only with the same file.
std::string hashOfFile(const std::string& path) {
  const std::string bytes = readFile(path);
  Sha256 hash;
  hash.add(bytes.data(), bytes.size());
  return hash.hex();
}

/// The settings that all points share, as text for people.
std::vector<std::pair<std::string, std::string>> sharedSettings(CLI::App& command,
                                                                const ScaleOptions& options,
                                                                const std::vector<ScaleAxis>& axes,
                                                                const RenderSettings& settings) {
  std::vector<std::pair<std::string, std::string>> shared{
      {"size", fmt::format("{}x{}", settings.size.x, settings.size.y)}};
  if (!options.gbuffer.empty()) {
    if (!options.scene.empty()) shared.emplace_back("scene", options.scene);
    shared.emplace_back("G-buffer's SHA-256", hashOfFile(options.gbuffer));
  }
  if (options.frame != 1) shared.emplace_back("frame", std::to_string(options.frame));
  if (options.own_lights && !options.sources) shared.emplace_back("own-lights", "true");
  if (options.sources) shared.emplace_back("sources", "true");
  if (!settings.camera.name.empty()) shared.emplace_back("camera", settings.camera.name);
  std::vector<std::string> names{"seed", "check-pixels", "exposure"};
  for (const ScaleAxis& axis : kAxes) names.push_back(axis.name);
  const bool varies_reach = std::any_of(axes.begin(), axes.end(), isReach);
  for (const std::string& name : names) {
    const bool is_varied =
        std::any_of(axes.begin(), axes.end(), [&](const ScaleAxis& axis) { return axis.name == name; }) ||
        (varies_reach && isReach({name, {}}));
    const bool is_meant =
        name == "field"       ? (!options.own_lights && !options.sources) || isList(options)
        : name == "intensity" ? !options.own_lights && !options.sources
        : name == "samples" || name == "shading" ? options.gbuffer.empty()
        : name == "range"                        ? options.range.has_value()
        : name == "cutoff"                       ? options.cutoff.has_value()
        : name == "no-range"                     ? false  // told below
        : name == "density"       ? choosesRanges(command, options) && !removesRanges(command, options, axes)
        : name == kLightErrorAxis ? asksLightError(options)
        : name == kConfidenceAxis
            ? options.picture.value("shadows") != "off" && (asksLightError(options) || variesLightError(axes))
        : name == "pcf-width"                              ? options.picture.value("shadows") == "pcf"
        : name == "shadow-memory" || name == "shadow-size" ? options.picture.value("shadows") != "off"
                                                           : true;
    if (!is_varied && is_meant) shared.emplace_back(name, command.get_option("--" + name)->as<std::string>());
  }
  std::vector<std::string> lists{options.field};
  for (const ScaleAxis& axis : axes)
    if (axis.name == "field") lists.insert(lists.end(), axis.values.begin(), axis.values.end());
  for (const std::string& list : lists)
    if (list.ends_with(".csv")) shared.emplace_back(list + "'s SHA-256", hashOfFile(list));
  if (!varies_reach && removesRanges(command, options, axes)) shared.emplace_back("no-range", "true");
  if (!options.picture.device.empty()) shared.emplace_back("device", options.picture.device);
  return shared;
}

}  // namespace

void checkScaleOptions(const CLI::App& command, const ScaleOptions& options) {
  for (const auto& [name, value] :
       {std::pair("SCENE", options.gbuffer.empty() ? &options.scene : &options.gbuffer),
        std::pair("--lights", &options.lights), std::pair("--output", &options.output)})
    if (value->empty()) throw InputError(fmt::format("scale: {} is required", name));
  if (options.sources && options.own_lights) throw InputError("scale: --sources, --own-lights: expected one");
  if (options.scene == "-") throw InputError("scale: expected a file as SCENE, got standard input");
  const auto isTyped = [&](const char* name) { return command.get_option(name)->count() > 0; };
  if (options.own_lights && isTyped("--field") && !isList(options))
    throw InputError(fmt::format(
        "scale: --own-lights --field {}: expected a .csv file, or no --field for the scene's own lights",
        options.field));
  if (options.own_lights && options.scene.empty() && !isList(options))
    throw InputError("scale: --own-lights: expected a SCENE that has some, or --field with a .csv file");
  const auto isOfView = [](const std::string& axis) { return axis == "samples" || axis == "shading"; };
  const bool is_view_typed = isTyped("--size") || isTyped("--camera") || isTyped("--shading") ||
                             isTyped("--samples") || isTyped("--samples-shading");
  int reaches = options.range.has_value() + options.cutoff.has_value() + options.no_range;
  const std::vector<ScaleAxis> axes = parseAxes(options.vary);
  const auto varies = [&](const char* name) {
    return std::any_of(axes.begin(), axes.end(), [&](const ScaleAxis& axis) { return axis.name == name; });
  };
  for (const ScaleAxis& axis : axes) {
    if (command.get_option("--" + axis.name)->count() > 0)
      throw InputError(fmt::format("scale: --{} is given and varied; expected one", axis.name));
    if ((options.own_lights || options.sources) &&
        (isReach(axis) || axis.name == "intensity" || axis.name == "field"))
      throw InputError(fmt::format("scale: --vary {}: --{} leaves lights as they are", axis.name,
                                   options.sources ? "sources" : "own-lights"));
    if (!options.gbuffer.empty() && (is_view_typed || isOfView(axis.name))) throw InputError(kViewOfGBuffer);
    if (axis.name == kConfidenceAxis && options.picture.value("shadows") == "off" && !varies("shadows"))
      throw InputError(
          "scale: --vary confidence: is of lights that cast shadows; expected --shadows exact with it");
    reaches += isReach(axis) && command.get_option("--density")->count() > 0;
    if (isReach(axis) && reaches > 0)
      throw InputError(fmt::format(
          "scale: --vary {}, --density, --range, --cutoff and --no-range say how far lights reach; expected "
          "one",
          axis.name));
  }
  if (!options.gbuffer.empty() && is_view_typed) throw InputError(kViewOfGBuffer);
}

ScaleExperiment planExperiment(CLI::App& command, ScaleOptions& options, const Scene& scene,
                               std::optional<GBuffer> gbuffer) {
  if (options.sources && scene.source_lights == 0)
    throw InputError(fmt::format(
        "{}: nothing that many lights take the place of, expected some for --sources", scene.name));
  ScaleExperiment experiment;
  experiment.gbuffer = std::move(gbuffer);
  ScaleDescription& description = experiment.description;
  description.version = LUCIOLE_VERSION;
  description.scene = utf8Of(experiment.gbuffer ? options.gbuffer : options.scene);
  description.digest = sceneDigest(scene);
  description.lights = parseLights(options.lights);
  if (options.sources)
    experiment.truth_lights =
        std::uint32_t(std::min<std::uint64_t>(16 * description.lights.back(), kMostSourceLights));
  description.axes = parseAxes(options.vary);
  description.repeats = options.repeats;
  experiment.check_pixels = options.check_pixels;
  experiment.seed = options.seed;

  const auto settingsNow = [&] {
    RenderSettings settings = renderSettings(options.picture, scene);
    if (options.picture.value("size").empty()) settings.size = kDefaultSize;
    if (const auto& surfaces = experiment.gbuffer) {
      settings.size = {surfaces->width, surfaces->height};
      settings.camera = surfaces->camera;
    }
    return settings;
  };
  description.settings = sharedSettings(command, options, description.axes, settingsNow());
  const RenderSettings first = settingsNow();
  const std::vector<glm::dvec3> seen =
      experiment.gbuffer ? visiblePoints(*experiment.gbuffer, kPointsOfAField, options.seed)
                         : visiblePoints(scene, first.camera, first.size, kPointsOfAField, options.seed);
  if (seen.empty())
    throw InputError(fmt::format("{}: {} nothing that lights could be put around", description.scene,
                                 experiment.gbuffer ? "shows" : "its camera sees"));
  const Bounds box = seenBox(seen, glm::dvec3(first.camera.camera_to_world[3]));
  completeAxes(description.axes, box);

  std::vector<std::vector<std::string>> variants;
  std::vector<ScaleTask> of_variant;
  std::map<std::string, std::size_t> field_of;
  int most_samples = 1;
  for (const std::vector<std::string>& variant : allVariants(description.axes)) {
    if (isLeftOut(description.axes, variant)) continue;
    for (std::size_t i = 0; i < variant.size(); ++i) setOption(command, description.axes[i].name, variant[i]);
    forgetReaches(command, options);
    const bool has_range = !choosesRanges(command, options);
    const auto [place, is_new] = field_of.try_emplace(
        fmt::format("{} {} {} {} {}", options.field, options.range.value_or(0), options.cutoff.value_or(0),
                    options.intensity, options.picture.value("shadows") == "off"),
        experiment.fields.size());
    if (is_new) {
      experiment.fields.push_back(makeField(options, scene, box, description.lights.back()));
      const std::vector<Light>& list = experiment.fields.back().list;
      const bool chooses = !has_range || removesRanges(command, options, description.axes);
      if (chooses && std::any_of(list.begin(), list.end(),
                                 [](const Light& light) { return light.kind == LightKind::kDirectional; }))
        throw InputError(fmt::format(
            "{}: a directional light has no place to fade from; expected --own-lights in place of a density "
            "or --no-range",
            options.field));
    }
    variants.push_back(variant);
    of_variant.push_back({.settings = settingsNow(),
                          .field = place->second,
                          .density = has_range ? 0 : options.density,
                          .no_range = removesRanges(command, options, description.axes)});
    most_samples = std::max(most_samples, of_variant.back().settings.samples);
  }
  if (most_samples > 1) experiment.truth_samples = kTruthSamples * most_samples;
  for (const std::uint64_t lights : description.lights) {
    for (std::size_t i = 0; i < variants.size(); ++i) {
      if (isTooExact(of_variant[i].settings, lights, description.axes)) {
        ++experiment.too_exact;
        continue;
      }
      description.points.push_back({lights, variants[i]});
      experiment.tasks.push_back(of_variant[i]);
    }
  }
  addAgainst(options.against, experiment);
  return experiment;
}

}  // namespace luciole
