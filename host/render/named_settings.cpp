#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/did_you_mean.hpp"
#include "base/split.hpp"
#include "image/exposure.hpp"
#include "image/file_format.hpp"
#include "luciole/error.hpp"
#include "luciole/image.hpp"
#include "luciole/settings.hpp"
#include "render/aov_table.hpp"
#include "scene/models.hpp"
#include "shadow/exact/light_samples.hpp"
#include "shadow/maps/shadow_sizes.hpp"

namespace luciole {
namespace {

/// The values of which a relative light error is a share are at least this. Nabata and others (2016) judge
/// their errors so.
constexpr float kRelativeFloor = 0.05f;

template <class Number>
std::optional<Number> numberIn(const std::string& text) {
  const char* const text_end = text.c_str() + text.size();
  Number number{};
  const auto [end, error] = std::from_chars(text.c_str(), text_end, number);
  if (error != std::errc() || end != text_end) return std::nullopt;
  return number;
}

/// A number that settingFault() has found right.
template <class Number>
Number numberOf(const std::string& text) {
  return numberIn<Number>(text).value_or(Number{});
}

[[noreturn]] void refuse(const std::string& expected, const std::string& got) {
  throw InputError(fmt::format("expected {}, got {}", expected, got));
}

/// Whole numbers between separators, as many as `count`.
std::vector<int> wholeNumbers(const std::string& text, char separator, std::size_t count,
                              const std::string& expected) {
  std::vector<int> numbers;
  for (const std::string& part : split(text, separator))
    if (const std::optional<int> number = numberIn<int>(part)) numbers.push_back(*number);
  if (numbers.size() != count || split(text, separator).size() != count) refuse(expected, text);
  return numbers;
}

void setSize(const std::string& text, RenderSettings& settings) {
  const std::size_t count = text.find('x') != std::string::npos ? 2 : 1;
  const std::vector<int> sides = wholeNumbers(text, 'x', count, "WxH or W, such as 1280x720 or 1280");
  glm::ivec2 size(sides.front(), sides.back());
  if (count == 1) {
    const double height = std::round(double(size.x) * settings.size.y / settings.size.x);
    size.y = int(std::clamp(height, 1.0, double(std::numeric_limits<int>::max())));
  }
  if (size.x < 1 || size.y < 1 || size.x > kLargestSide || size.y > kLargestSide)
    throw InputError(fmt::format("{}x{} pixels, expected 1 to {} a side", size.x, size.y, kLargestSide));
  settings.size = size;
}

void setCrop(const std::string& text, RenderSettings& settings) {
  const std::vector<int> n = wholeNumbers(text, ',', 4, "X,Y,W,H, such as 0,0,64,64");
  settings.crop = Crop{n[0], n[1], n[2], n[3]};
}

/// "auto" is left to those who measure it.
void setExposure(const std::string& text, RenderSettings& settings) {
  if (text == "auto") return;
  const std::optional<double> stops = numberIn<double>(text.starts_with("+") ? text.substr(1) : text);
  if (!stops || !(std::abs(*stops) <= kMostStops))
    refuse(fmt::format("stops between {} and {}, or auto", -kMostStops, kMostStops), text);
  settings.exposure = float(*stops);
}

/// A number from 0 to 1, or a fraction such as 1/256.
float shareIn(const std::string& text) {
  const std::vector<std::string> parts = split(text, '/');
  const std::optional<double> over = numberIn<double>(parts.front());
  const std::optional<double> under = parts.size() == 1 ? 1.0 : numberIn<double>(parts[1]);
  if (parts.size() <= 2 && over && under && *under > 0 && std::isfinite(*under) && *over / *under >= 0 &&
      *over / *under <= 1)
    return float(*over / *under);
  refuse("a number or a fraction from 0 to 1, such as 1/256", text);
}

void setRelativeError(const std::string& text, RenderSettings& settings) {
  const float share = shareIn(text);
  if (share == 0) return;
  settings.shade.light_error = share;
  settings.shade.light_error_floor = kRelativeFloor;
}

/// What a layer's name stands for, in the order of Aov; a name may stand for several layers.
std::vector<std::pair<std::string, Aov>> layerNames() {
  std::vector<std::pair<std::string, Aov>> named;
  for (const AovRow& row : aovTable()) {
    if (row.aov == Aov::kCryptoObject)
      for (const Aov matte : {Aov::kCryptoObject, Aov::kCryptoMaterial})
        named.emplace_back("cryptomatte", matte);
    named.emplace_back(row.name, row.aov);
  }
  return named;
}

void setAovs(const std::string& text, RenderSettings& settings) {
  for (const std::string& name : split(text, ','))
    for (const auto& [known, aov] : layerNames())
      if (known == name && !settings.wants(aov)) settings.aovs.push_back(aov);
}

NamedSetting choice(const char* name, std::vector<std::string> choices, const char* initial,
                    const char* help) {
  return {.name = name, .help = help, .initial = initial, .choices = std::move(choices)};
}

NamedSetting flag(const char* name, const char* help) {
  return {.name = name, .help = help, .initial = "off", .choices = {"on", "off"}, .is_flag = true};
}

template <class Number>
NamedSetting number(const char* name, Number initial, double least, double greatest, const char* help) {
  return {.name = name,
          .help = help,
          .initial = fmt::format("{}", initial),
          .least = least,
          .greatest = greatest,
          .is_whole = std::is_integral_v<Number>};
}

NamedSetting text(const char* name, const char* initial, std::string help) {
  return {.name = name, .help = std::move(help), .initial = initial};
}

/// The row of a picture's setting.
NamedSetting of(NamedSetting row, void (*set)(const std::string&, RenderSettings&)) {
  row.set = set;
  return row;
}

/// The row of a file's.
NamedSetting ofFile(NamedSetting row, void (*set)(const std::string&, WriteOptions&)) {
  row.set_file = set;
  return row;
}

std::vector<NamedSetting> viewSettings() {
  return {
      of(text("size", "",
              "WxH pixels, or W, as high as the scene's shape makes it (default: the scene's, or 1280x720)"),
         setSize),
      of(text("crop", "", "X,Y,W,H: only this part of the picture"), setCrop),
      of(choice("shading", {"flat", "gouraud", "phong"}, "phong",
                "what is interpolated over a triangle: nothing, colours, normals"),
         [](const std::string& value, RenderSettings& settings) {
           settings.shading = value == "flat"      ? Shading::kFlat
                              : value == "gouraud" ? Shading::kGouraud
                                                   : Shading::kPhong;
         }),
      of(number("samples", 1, 1, 1024, "samples per pixel, against jagged edges"),
         [](const std::string& value, RenderSettings& settings) { settings.samples = numberOf<int>(value); }),
      of(choice("samples_shading", {"shared", "all"}, "shared",
                "what of a pixel's samples is shaded: a point for those that see the same surface, or all"),
         [](const std::string& value, RenderSettings& settings) {
           settings.sample_shading = value == "all" ? SampleShading::kAll : SampleShading::kShared;
         }),
      text("model", kModelNames[std::size_t(ShadeSettings{}.model)],
           "how surfaces reflect light whose materials don't say it: with highlights of (R.V)^n, of (N.H)^n, "
           "in "
           "flat steps, as rough ones do, as rough matte ones do, or as rough ones by Ward's lobe; or a file "
           "of "
           "one's own, *.clh"),
      of(text("exposure", "0",
              "stops: colours times 2^STOPS; or auto: what brings the picture's mean to middle grey"),
         setExposure),
      of(flag("alpha",
              "no background, and a channel A: the share of a pixel's samples that show a surface; colours "
              "are "
              "multiplied by it in exr and in a tif of floats, not in png, tga and others"),
         [](const std::string& value, RenderSettings& settings) { settings.alpha = value == "on"; })};
}

/// The number of "light_count"; 0: it is "auto", or not said. Throws InputError.
std::uint32_t lightCountIn(const std::string& value) {
  if (value.empty() || value == "auto") return 0;
  const std::optional<std::int64_t> count = numberIn<std::int64_t>(value);
  if (count && *count >= 1 && *count <= kMostSourceLights) return std::uint32_t(*count);
  throw InputError(
      fmt::format("expected auto or a whole number from 1 to {}, got {}", kMostSourceLights, value));
}

std::vector<NamedSetting> shadowSettings() {
  return {
      of(choice(
             "shadows", {"auto", "off", "hard", "pcf", "soft", "exact", "soft-exact"}, "auto",
             "exact (as rays to the light's middle), soft-exact (as rays to places on a light of a size), by "
             "shadow maps: hard (the texel that the point falls into), pcf (the nearest texels, weighted) or "
             "soft (edges as wide as the light's size makes them), or auto: for each light exact, but hard "
             "where that is at least twice as fast"),
         [](const std::string& value, RenderSettings& settings) {
           settings.shade.shadows = value == "off"          ? ShadowMethod::kOff
                                    : value == "hard"       ? ShadowMethod::kHard
                                    : value == "pcf"        ? ShadowMethod::kPcf
                                    : value == "soft"       ? ShadowMethod::kSoft
                                    : value == "exact"      ? ShadowMethod::kExact
                                    : value == "soft-exact" ? ShadowMethod::kSoftExact
                                                            : ShadowMethod::kAuto;
         }),
      choice("cast_shadows", {"all", "marked", "none"}, "",
             "which lights cast shadows: all, none, or those that the scene marks (default: marked, but all "
             "where none is marked and shadows are asked for)"),
      of(text("light_count", "",
              "lights that take the place of each environment, face and glowing mesh, 1 to 1048576, or auto: "
              "as few as miss no more than the light error in the share `confidence` of the pixels (default: "
              "as the scene says)"),
         [](const std::string& value, RenderSettings&) { lightCountIn(value); }),
      of(number("soft_samples", ShadeSettings{}.soft_samples, 1, kMostSoftSamples,
                "places on a light of a size that soft-exact looks at from each point"),
         [](const std::string& value, RenderSettings& settings) {
           settings.shade.soft_samples = numberOf<int>(value);
         }),
      of(number("pcf_width", ShadeSettings{}.pcf_width, 2, 6,
                "texels a side that pcf weighs: 2 is the sharpest"),
         [](const std::string& value, RenderSettings& settings) {
           settings.shade.pcf_width = numberOf<int>(value);
         }),
      of(number("shadow_memory", int(ShadowLimits{}.bytes >> 20), 1,
                16000,  // fewer texels than 31 bits count
                "MiB that all shadow maps may take: where they would take more, they get coarser"),
         [](const std::string& value, RenderSettings& settings) {
           settings.shade.shadow_limits.bytes = std::size_t(numberOf<int>(value)) << 20;
         }),
      of(number(
             "shadow_size", ShadowLimits{}.size, kSmallestFace, kLargestFace,
             "texels a side that the shadow map of a spot and each of a directional light may have; half as "
             "many for each face of a point light's"),
         [](const std::string& value, RenderSettings& settings) {
           settings.shade.shadow_limits.size = numberOf<int>(value);
         })};
}

std::vector<NamedSetting> lightSettings() {
  std::vector<std::string> layers;
  for (const auto& [name, aov] : layerNames())
    if (layers.empty() || layers.back() != name) layers.push_back(name);
  NamedSetting aov =
      of(text("aov", "", "extra layers of an EXR: " + fmt::format("{}", fmt::join(layers, ","))), setAovs);
  aov.choices = std::move(layers);
  aov.is_list = true;
  return {
      of(choice("culling", {"none", "tiles", "auto"}, "auto",
                "which lights a pixel goes through; never changes the picture"),
         [](const std::string& value, RenderSettings& settings) {
           settings.shade.culling = value == "none" ? Culling::kNone : Culling::kTiles;
         }),
      of(choice("tile", {"4", "8", "16"}, "4",
                "pixels a side of the squares that share a light list; never changes the picture"),
         [](const std::string& value, RenderSettings& settings) {
           settings.shade.tile_size = numberOf<int>(value);
         }),
      of(text("light_error", "0",
              "lights without range may be stood for by clusters of them, and where they cast shadows be "
              "sampled, as long as no pixel is wrong by more than so much of the larger of 1 and itself: "
              "from 0 "
              "(each light by itself) to 1, such as 1/256"),
         [](const std::string& value, RenderSettings& settings) {
           settings.shade.light_error = shareIn(value);
         }),
      of(text("light_error_relative", "0",
              fmt::format("as light_error, but so much of the larger of {} and the pixel itself",
                          kRelativeFloor)),
         setRelativeError),
      of(number(
             "confidence", ShadeSettings{}.confidence, 0.5, 0.9999,
             "with an error of lights that cast shadows: how often the interval that a pixel states holds, "
             "0.5 to 0.9999"),
         [](const std::string& value, RenderSettings& settings) {
           settings.shade.confidence = numberOf<double>(value);
         }),
      of(number("seed", ShadeSettings{}.seed, 0, std::numeric_limits<std::uint32_t>::max(),
                "of lights that are sampled: each gives other errors"),
         [](const std::string& value, RenderSettings& settings) {
           settings.shade.seed = numberOf<std::uint32_t>(value);
         }),
      of(flag("light_groups",
              "extra layers of an EXR, whose sum is the picture: light_groups.NAME of the lights of each "
              "group, "
              "light_groups.rest of all that no light gives; luciole mix weighs them anew"),
         [](const std::string& value, RenderSettings& settings) { settings.light_groups = value == "on"; }),
      std::move(aov)};
}

std::vector<NamedSetting> fileSettings() {
  NamedSetting compression = text(
      "compression", "",
      fmt::format("of a PNG: fast (default) or small; the others of an EXR (default: {}); from pxr24 on they "
                  "change the picture",
                  kExrCompression));
  compression.choices.assign(kPngCompressions.begin(), kPngCompressions.end());
  for (const ExrCompression& one : kExrCompressions) compression.choices.push_back(one.name);
  return {
      ofFile(
          text("format", "", "png, exr ...: what to write, whatever the name says (default: its extension)"),
          [](const std::string& value, WriteOptions& options) { options.format = value; }),
      ofFile(std::move(compression),
             [](const std::string& value, WriteOptions& options) { options.compression = value; }),
      ofFile(choice("dither", {"on", "off"}, "on",
                    "of 8-bit formats (png, jpg ...): a grain of half a step in place of bands"),
             [](const std::string& value, WriteOptions& options) { options.dither = value == "on"; }),
      ofFile(
          choice("tone", {"clip", "filmic"}, "clip",
                 "of integer formats: what is brighter than white is clipped, or goes through a film's curve "
                 "(Narkowicz's, of the ACES)"),
          [](const std::string& value, WriteOptions& options) {
            options.tone = value == "filmic" ? ToneCurve::kFilmic : ToneCurve::kClip;
          }),
      ofFile(choice("bits", {"8", "16"}, "",
                    "of the sRGB codes of a png (default: 8) or tif (default: 32-bit floats): 8 or 16"),
             [](const std::string& value, WriteOptions& options) { options.bits = numberOf<int>(value); }),
      ofFile(
          flag("half",
               "an EXR's colours as 16-bit floats: half the size, each within 2^-11 of itself or, if below "
               "2^-14, within 2^-25; at most 65504; positions, depths and counts keep 32 bits"),
          [](const std::string& value, WriteOptions& options) { options.half = value == "on"; })};
}

std::string choiceFault(const NamedSetting& setting, const std::string& value) {
  for (const std::string& part : setting.is_list ? split(value, ',') : std::vector{value})
    if (std::find(setting.choices.begin(), setting.choices.end(), part) == setting.choices.end())
      return fmt::format("'{}' is none of {}{}", part, fmt::join(setting.choices, ", "),
                         didYouMean(part, setting.choices));
  return "";
}

std::string numberFault(const NamedSetting& setting, const std::string& value) {
  const std::optional<double> number =
      setting.is_whole && !numberIn<std::int64_t>(value) ? std::optional<double>() : numberIn<double>(value);
  if (number && *number >= setting.least && *number <= setting.greatest) return "";
  return fmt::format("expected {}{} to {}, got {}", setting.is_whole ? "a whole number from " : "",
                     setting.least, setting.greatest, value);
}

template <class Target>
void applyRows(const SettingValues& values, void (*NamedSetting::*set)(const std::string&, Target&),
               Target& target) {
  for (const NamedSetting& setting : namedSettings()) {
    const auto found = values.find(setting.name);
    if (!(setting.*set) || found == values.end() || found->second.empty()) continue;
    std::string fault = settingFault(setting, found->second);
    try {
      if (fault.empty()) (setting.*set)(found->second, target);
    } catch (const InputError& error) {
      fault = error.what();
    }
    if (!fault.empty()) throw InputError(fmt::format("{}: {}", setting.name, fault));
  }
}

}  // namespace

const std::vector<NamedSetting>& namedSettings() {
  static const std::vector<NamedSetting> rows = [] {
    std::vector<NamedSetting> all;
    for (std::vector<NamedSetting>& some :
         std::vector{viewSettings(), shadowSettings(), lightSettings(), fileSettings()})
      all.insert(all.end(), some.begin(), some.end());
    return all;
  }();
  return rows;
}

const NamedSetting& namedSetting(std::string_view name) {
  std::vector<std::string> names;
  for (const NamedSetting& setting : namedSettings()) {
    if (setting.name == name) return setting;
    names.push_back(setting.name);
  }
  throw InputError(fmt::format("{}: no such setting{}", name, didYouMean(name, names)));
}

std::string settingFault(const NamedSetting& setting, const std::string& value) {
  if (!setting.choices.empty()) return choiceFault(setting, value);
  if (setting.least < setting.greatest) return numberFault(setting, value);
  try {
    RenderSettings settings;
    if (setting.set) setting.set(value, settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

SettingValues initialSettings() {
  SettingValues values;
  for (const NamedSetting& setting : namedSettings()) values[setting.name] = setting.initial;
  return values;
}

void applySettings(const SettingValues& values, RenderSettings& settings) {
  applyRows(values, &NamedSetting::set, settings);
}

void applySettings(const SettingValues& values, WriteOptions& options) {
  applyRows(values, &NamedSetting::set_file, options);
}

void setLightCounts(const std::string& how_many, Scene& scene) {
  if (const std::uint32_t count = lightCountIn(how_many); count > 0) setLightCounts(scene, count);
}

void castShadows(const std::string& who, bool asked_for, Scene& scene) {
  const bool any_marked =
      std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) { return light.shadow; });
  const bool all = who.empty() ? asked_for && !any_marked : who == "all";
  if (!all && who != "none") return;
  for (Light& light : scene.lights) light.shadow = all;
}

}  // namespace luciole
