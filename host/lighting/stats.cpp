#include "lighting/stats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/csv.hpp"
#include "base/dump_utf8.hpp"
#include "base/peak_memory.hpp"
#include "base/threads.hpp"
#include "base/trace.hpp"
#include "cl/kernel_cache.hpp"

namespace luciole {

const char* stageName(Stage stage) {
  static constexpr const char* kNames[]{
      "load scene",
      "read G-buffer",
      "open device",
      "compile kernels",
      "wait for device",
      "wait for kernels",
      "measure exposure",
      "triangle tree",
      "prepare lights",
      "gather vertices",
      "rasterize",
      "change surfaces",
      "cull",
      "find shadow texels",
      "shadow maps",
      "beam shadows",
      "shadow rays",
      "clustered light",
      "sampled light",
      "shade",
      "read back",
      "screens",
      "resolve",
      "count lights",
      "check G-buffer",
      "write",
  };
  static_assert(std::size(kNames) == std::size_t(Stage::kWrite) + 1);
  return kNames[std::size_t(stage)];
}

bool isStart(Stage stage) {
  return stage == Stage::kOpenDevice || stage == Stage::kCompileKernels || stage == Stage::kWaitForDevice ||
         stage == Stage::kWaitForKernels;
}

void addStage(Stats& stats, Stage stage, double milliseconds) {
  for (auto& [known, sum] : stats.stages) {
    if (known == stage) {
      sum += milliseconds;
      return;
    }
  }
  stats.stages.emplace_back(stage, milliseconds);
}

double ownShare(const Stats& stats, const std::pair<Stage, double>& stage) {
  const bool is_beside =
      std::find(stats.beside.begin(), stats.beside.end(), stage.first) != stats.beside.end();
  return is_beside ? 0 : stage.second;
}

double stageTime(const Stats& stats, Stage stage) {
  for (const auto& [known, milliseconds] : stats.stages)
    if (known == stage) return milliseconds;
  return 0;
}

std::uint64_t countOf(const Stats& stats, std::string_view name) {
  for (const auto& [known, count] : stats.counts)
    if (known == name) return count;
  return 0;
}

void addPart(const Stats& part, Stats& whole) {
  if (whole.width == 0 && part.width > 0) {
    whole.device = part.device;
    whole.triangles = part.triangles;
    whole.lights = part.lights;
    whole.features = part.features;
    whole.warnings = part.warnings;
    whole.width = part.width;
    whole.height = part.height;
    whole.samples = part.samples;
    whole.beside = part.beside;
  }
  for (const auto& [stage, milliseconds] : part.stages) addStage(whole, stage, milliseconds);
  for (const auto& counted : part.counts) {
    const std::string& name = counted.first;
    const std::uint64_t count = counted.second;
    // Every device has the counts of the scene; those of pixels add up.
    const bool is_of_scene =
        name.starts_with("lights_") || name.starts_with("shadow_lights") || name.starts_with("objects_");
    const auto known = std::find_if(whole.counts.begin(), whole.counts.end(),
                                    [&](const auto& one) { return one.first == name; });
    if (known == whole.counts.end())
      whole.counts.emplace_back(name, count);
    else
      known->second = is_of_scene ? std::max(known->second, count) : known->second + count;
  }
  whole.light_error.largest = std::max(whole.light_error.largest, part.light_error.largest);
  whole.light_error.sum += part.light_error.sum;
  whole.light_error.proven += part.light_error.proven;
  whole.light_error.least = std::max(whole.light_error.least, part.light_error.least);
  whole.light_error.values += part.light_error.values;
  whole.device_bytes += part.device_bytes;
  whole.traffic.bytes_up += part.traffic.bytes_up;
  whole.traffic.bytes_down += part.traffic.bytes_down;
  whole.traffic.bytes_made += part.traffic.bytes_made;
}

double endStage(Stage stage, std::int64_t begin) {
  const std::int64_t end = nanosecondsSinceStart();
  traceEvent(stageName(stage), kTraceStage, begin, end);
  return 1e-6 * double(end - begin);
}

std::string statsJson(const Stats& stats, double ended) {
  nlohmann::ordered_json json;
  json["version"] = LUCIOLE_VERSION;
  json["command"] = stats.command;
  json["device"] = {{"platform", stats.device.platform},
                    {"name", stats.device.name},
                    {"driver", stats.device.version},
                    {"lanes", stats.device.lanes},
                    {"compute_units", stats.device.compute_units}};
  if (!stats.device.arithmetic.empty()) json["device"]["arithmetic"] = stats.device.arithmetic;
  for (const DeviceShare& share : stats.shares) {
    json["devices"].push_back({{"platform", share.device.platform},
                               {"name", share.device.name},
                               {"driver", share.device.version},
                               {"lanes", share.device.lanes},
                               {"rows", share.rows},
                               {"milliseconds", share.milliseconds}});
    if (!share.error.empty()) json["devices"].back()["error"] = share.error;
  }
  json["scene"] = {{"triangles", stats.triangles}, {"lights", stats.lights}, {"features", stats.features}};
  json["warnings"] = stats.warnings;
  json["image"] = {{"width", stats.width}, {"height", stats.height}, {"samples", stats.samples}};
  if (!stats.hash.empty()) json["image"]["hash"] = stats.hash;
  if (stats.measured_exposure) json["image"]["measured_exposure"] = *stats.measured_exposure;
  double cold_start = 0;
  json["stages"] = nlohmann::ordered_json::array();
  for (const auto& timed : stats.stages) {
    const auto& [stage, milliseconds] = timed;
    json["stages"].push_back({{"name", stageName(stage)},
                              {"milliseconds", milliseconds},
                              {"wall_milliseconds", ownShare(stats, timed)}});
    if (stage == Stage::kOpenDevice || stage == Stage::kCompileKernels) cold_start += milliseconds;
  }
  json["counts"] = nlohmann::ordered_json::object();
  for (const auto& [name, count] : stats.counts) json["counts"][name] = count;
  for (const auto& [name, error] : stats.errors) json["errors"][name] = error;
  if (const LightErrorStats& bounds = stats.light_error; bounds.values > 0)
    json["light_error"] = {{"largest", bounds.largest},
                           {"mean", bounds.sum / double(bounds.values)},
                           {"proven_mean", bounds.proven / double(bounds.values)},
                           {"least_allowing", bounds.least}};
  json["memory"] = {{"peak_bytes", peakBytes()},
                    {"device_bytes", stats.device_bytes},
                    {"uploaded_bytes", stats.traffic.bytes_up},
                    {"downloaded_bytes", stats.traffic.bytes_down},
                    {"made_bytes", stats.traffic.bytes_made}};
  json["threads"] = countThreads();
  json["cold_start_milliseconds"] = cold_start;
  const std::optional<int> compiled = kernelsCompiled(stats.device.platform);
  json["kernels_compiled"] = compiled ? nlohmann::ordered_json(*compiled) : nullptr;
  if (!compiled) json["reasons"]["kernels_compiled"] = "only PoCL tells";
  json["picture_milliseconds"] = ended - stats.began;
  json["wall_milliseconds"] = ended;
  return dumpUtf8(std::move(json), 2) + "\n";
}

std::string statsCsv(const Stats& stats, double ended) {
  std::vector<std::string> names, values;
  const auto add = [&](std::string name, std::string value) {
    std::replace(name.begin(), name.end(), ' ', '_');
    names.push_back(std::move(name));
    values.push_back(std::move(value));
  };
  const auto text = [](const auto& number) { return fmt::format("{}", number); };
  const auto ifAny = [&](const auto& number) { return number ? text(*number) : std::string(); };
  add("version", LUCIOLE_VERSION);
  add("command", stats.command);
  add("platform", stats.device.platform);
  add("device", stats.device.name);
  add("driver", stats.device.version);
  add("lanes", text(stats.device.lanes));
  add("threads", text(countThreads()));
  add("triangles", text(stats.triangles));
  add("lights", text(stats.lights));
  add("width", text(stats.width));
  add("height", text(stats.height));
  add("samples", text(stats.samples));
  add("measured_exposure", ifAny(stats.measured_exposure));
  add("hash", stats.hash);
  add("wall_ms", text(ended));
  add("picture_ms", text(ended - stats.began));
  add("cold_start_ms", text(stageTime(stats, Stage::kOpenDevice) + stageTime(stats, Stage::kCompileKernels)));
  add("kernels_compiled", ifAny(kernelsCompiled(stats.device.platform)));
  for (int stage = 0; stage <= int(Stage::kWrite); ++stage)
    add(std::string(stageName(Stage(stage))) + " ms", text(stageTime(stats, Stage(stage))));
  for (const char* count : {"pixels_lit",
                            "refined_pixels",
                            "pixel_lights_evaluated",
                            "pixel_lights_in_range",
                            "list_entries",
                            "lights_stood_for",
                            "pixel_clusters_evaluated",
                            "pixel_clustered_lights_evaluated",
                            "pixels_redone",
                            "lights_sampled",
                            "sampled_rays",
                            "sampled_groups",
                            "sampled_strata",
                            "sampled_rounds",
                            "pixels_beyond_light_error",
                            "shadow_lights_exact",
                            "shadow_lights_by_maps",
                            "shadow_pairs_exact",
                            "shadow_pairs_by_maps",
                            "shadow_rays"})
    add(count, text(countOf(stats, count)));
  const LightErrorStats& bounds = stats.light_error;
  const bool is_bounded = bounds.values > 0;
  add("light_error_largest", is_bounded ? text(bounds.largest) : "");
  add("light_error_mean", is_bounded ? text(bounds.sum / double(bounds.values)) : "");
  add("peak_bytes", text(peakBytes()));
  add("device_bytes", text(stats.device_bytes));
  add("uploaded_bytes", text(stats.traffic.bytes_up));
  add("downloaded_bytes", text(stats.traffic.bytes_down));
  return csvLine(names) + csvLine(values);
}

}  // namespace luciole
