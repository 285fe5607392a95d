#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "base/dump_utf8.hpp"
#include "base/text_file.hpp"
#include "base/utf8.hpp"
#include "base/write_file.hpp"
#include "gbuffer/camera_header.hpp"
#include "image/layers.hpp"
#include "lights/light_use.hpp"
#include "luciole/error.hpp"
#include "luciole/pose.hpp"
#include "render/plan.hpp"
#include "scene/json/mesh_file.hpp"
#include "shade/sampled_light.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/frames.hpp"
#include "tools/cli/picture_options.hpp"
#include "tools/info/estimate.hpp"
#include "tools/info/scene_info.hpp"

namespace luciole {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions : PictureOptions {
  std::string file, json;
};

/// Both forms of what there is to say of a file.
struct Report {
  Json json;
  std::string text;
};

/// Text from a file, fit for a line of its own.
std::string printable(std::string_view words) {
  std::string text = utf8Of(words);
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

/// A line of the text: what it is about, and what there is. Further lines have no label.
void addLine(Report& report, const std::string& label, const std::string& words) {
  report.text += fmt::format("{:<12} {}\n", label, words);
}

Json vectorJson(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
std::string vectorText(const glm::dvec3& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }
std::string sizeText(glm::ivec2 size) { return fmt::format("{}x{}", size.x, size.y); }

std::string counted(std::size_t count, const std::string& thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

void addWarnings(Report& report, const std::vector<Warning>& warnings) {
  report.json["warnings"] = Json::array();
  for (const Warning& warning : warnings) report.json["warnings"].push_back(warning.text);
  for (const std::string& line : shownWarnings(warnings, "--json"))
    addLine(report, "warning", printable(line));
}

Json cameraJson(const Camera& camera) {
  const glm::dmat4& place = camera.camera_to_world;
  Json json{{"name", camera.name},
            {"projection", camera.orthographic ? "parallel" : "perspective"},
            {"eye", vectorJson(place[3])},
            {"direction", vectorJson(glm::dvec3(0) - glm::dvec3(place[2]))},
            {"up", vectorJson(place[1])}};
  if (camera.orthographic)
    json["half_height"] = camera.half_height;
  else
    json["fov_y_degrees"] = glm::degrees(camera.fov_y);
  if (camera.shift != glm::dvec2(0)) json["shift"] = {camera.shift.x, camera.shift.y};
  if (camera.pixel_aspect != 1) json["pixel_aspect"] = camera.pixel_aspect;
  return json;
}

std::string cameraText(const Camera& camera) {
  const glm::dmat4& place = camera.camera_to_world;
  return fmt::format("{}{}at {} looks along {}", printable(camera.name), camera.name.empty() ? "" : ": ",
                     vectorText(place[3]), vectorText(glm::dvec3(0) - glm::dvec3(place[2])));
}

/// JSON has no infinity: null.
void addPlanes(const Camera& camera, Json& json) {
  json["near"] = camera.near;
  json["far"] = std::isfinite(camera.far) ? Json(camera.far) : Json();
}

std::string planesText(const Camera& camera) {
  return std::isfinite(camera.far) ? fmt::format("sees from {:.6g} to {:.6g} m", camera.near, camera.far)
                                   : fmt::format("sees from {:.6g} m on", camera.near);
}

std::string openingText(const Camera& camera) {
  std::string text = camera.orthographic ? fmt::format("parallel, {:.6g} m high", 2 * camera.half_height)
                                         : fmt::format("{:.4g} degrees high", glm::degrees(camera.fov_y));
  if (camera.shift != glm::dvec2(0))
    text += fmt::format(", shifted by {:.4g}, {:.4g}", camera.shift.x, camera.shift.y);
  if (camera.pixel_aspect != 1)
    text += fmt::format(", pixels {:.6g} times as wide as high", camera.pixel_aspect);
  return text;
}

void addShape(const Scene& scene, const SceneInfo& info, Report& report) {
  report.json["triangles"] = info.triangles;
  report.json["mesh_triangles"] = info.mesh_triangles;
  report.json["objects"] = scene.objects.size();
  report.json["meshes"] = info.meshes;
  addLine(
      report, "triangles",
      fmt::format("{} in {}; {} in {}", info.triangles, counted(scene.objects.size(), "object"),
                  info.mesh_triangles, info.meshes == 1 ? "1 mesh" : fmt::format("{} meshes", info.meshes)));
  report.json["bounds"] = nullptr;
  if (const auto& [low, high] = info.bounds; low.x <= high.x) {
    report.json["bounds"] = {{"low", vectorJson(low)}, {"high", vectorJson(high)}};
    addLine(report, "bounds", fmt::format("{} to {}, metres", vectorText(low), vectorText(high)));
  }
  report.json["frames"] = nullptr;
  if (info.moves) {
    report.json["frames"] = {{"first", info.moves->first}, {"last", info.moves->last}};
    addLine(report, "frames",
            fmt::format("moves from {:.6g} to {:.6g}", info.moves->first, info.moves->last));
  }
}

/// The names that objects have, each once.
void addNames(const Scene& scene, Report& report) {
  constexpr std::size_t kMost = 10;
  std::set<std::string> known;
  std::vector<std::string> names;
  for (const Object& object : scene.objects)
    if (!object.name.empty() && known.insert(object.name).second) names.push_back(object.name);
  report.json["object_names"] = names;
  const std::size_t shown = std::min(names.size(), kMost);
  std::string line = fmt::format("{}", fmt::join(names.begin(), names.begin() + std::ptrdiff_t(shown), ", "));
  if (names.size() > shown) line += fmt::format(" and {} more", names.size() - shown);
  if (!names.empty()) addLine(report, "names", printable(line));
}

void addMaterials(const Scene& scene, const SceneInfo& info, Report& report) {
  Json& materials = report.json["materials"] = Json::array();
  for (const Material& material : scene.materials) {
    Json& one = materials.emplace_back();
    one["name"] = material.name;
    if (material.model) one["model"] = modelName(*material.model);
    for (const auto& [use, map] : {std::pair("diffuse_map", material.diffuse_map),
                                   {"emission_map", material.emission_map},
                                   {"normal_map", material.normal_map},
                                   {"alpha_map", material.alpha_map}})
      if (map.texture >= 0) one[use] = scene.textures[std::size_t(map.texture)].name;
  }
  addLine(report, "materials", fmt::format("{}", scene.materials.size()));
  Json& textures = report.json["textures"] = Json::array();
  addLine(report, "textures",
          info.texels == 0 ? "0"
                           : fmt::format("{}, {:.3g} megatexels", scene.textures.size(), info.texels / 1e6));
  std::string folder = std::filesystem::path(scene.name).parent_path().string();
  if (!folder.empty()) folder += "/";
  for (const Texture& texture : scene.textures) {
    const bool is_beside = texture.name.starts_with(folder);
    const glm::ivec2 size = texture.levels.empty()
                                ? glm::ivec2(0)
                                : glm::ivec2(texture.levels[0].width, texture.levels[0].height);
    textures.push_back({{"name", texture.name}, {"width", size.x}, {"height", size.y}});
    addLine(report, "",
            fmt::format("{:<11}{}", sizeText(size),
                        printable(texture.name.substr(is_beside ? folder.size() : 0))));
  }
}

void addCameras(const Scene& scene, Report& report) {
  Json& cameras = report.json["cameras"] = Json::array();
  report.json["adds_camera"] = scene.adds_camera;
  addLine(
      report, "cameras",
      scene.adds_camera ? "0 in the file; this one would be taken" : fmt::format("{}", scene.cameras.size()));
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const Camera& camera = scene.cameras[i];
    Json& json = cameras.emplace_back(cameraJson(camera));
    addPlanes(camera, json);
    addLine(report, "", fmt::format("{} {}, {}", i, cameraText(camera), openingText(camera)));
    addLine(report, "", "  " + planesText(camera));
  }
}

void addLights(const Scene& scene, const LightCounts& lights, Report& report) {
  report.json["lights"] = {{"count", scene.lights.size()},      {"point", lights.point},
                           {"directional", lights.directional}, {"spot", lights.spot},
                           {"casting", lights.casting},         {"everywhere", lights.everywhere},
                           {"of_sources", scene.source_lights}};
  report.json["adds_lights"] = scene.adds_lights;
  std::string kinds =
      scene.adds_lights ? "0 in the file; these would be added: " : fmt::format("{}", scene.lights.size());
  const char* separator = scene.adds_lights ? "" : ": ";
  for (const auto& [count, kind] :
       {std::pair(lights.point, "point"), {lights.directional, "directional"}, {lights.spot, "spot"}})
    if (count > 0) kinds += fmt::format("{}{} {}", std::exchange(separator, ", "), count, kind);
  addLine(report, "lights", kinds);
  if (!scene.lights.empty())
    addLine(report, "",
            fmt::format("{} cast shadows, {} reach everywhere", lights.casting, lights.everywhere));
  if (const LightSource* sky = environmentOf(scene))
    addLine(report, "environment",
            fmt::format("{}, {}x{}, {} lights", sky->sky->name, sky->sky->levels[0].width,
                        sky->sky->levels[0].height, sky->cells.size()));
  if (scene.source_lights > 0)
    addLine(report, "of sources",
            fmt::format("{} lights take the place of {} and of what glows", scene.source_lights,
                        counted(scene.sources.size(), "source")));
}

/// For how many of the lights clusters may stand and how many may be sampled (--light-error), and why not the
/// others; and what this picture would do with them.
void addLightUses(const Scene& scene, const PicturePlan& plan, Report& report) {
  const ShadeSettings& settings = plan.shade;
  const LightUseCounts counts = countUses(scene.lights, useConditions(settings));
  const std::size_t clusterable = counts[std::size_t(LightUse::kClustered)],
                    placed = counts[std::size_t(LightUse::kSampled)],
                    directions = counts[std::size_t(LightUse::kSampledDirection)],
                    sampleable = placed + directions;
  Json& json = report.json["lights"];
  json["clusterable"] = clusterable;
  json["sampleable"] = sampleable;
  json["exact"] = Json::object();
  std::vector<std::string> reasons;
  for (std::size_t i = std::size_t(LightUse::kByModel); i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    json["exact"][reasonName(LightUse(i))] = counts[i];
    reasons.push_back(fmt::format("{} by {}", counts[i], reasonName(LightUse(i))));
  }
  if (scene.lights.empty()) return;
  addLine(report, "",
          fmt::format("clusters may stand for {} (--light-error), {} may be sampled{}{}", clusterable,
                      sampleable, reasons.empty() ? "" : "; not: ", fmt::join(reasons, ", ")));
  if (!(settings.light_error > 0)) return;
  const std::size_t clustered = plan.features.has(Feature::kClusteredLights) ? clusterable : 0,
                    sampled_places = plan.features.has(Feature::kSampledLights) ? placed : 0,
                    sampled_directions = plan.features.has(Feature::kSampledDirections) ? directions : 0,
                    sampled = sampled_places + sampled_directions;
  double rays = 0;
  for (const std::size_t set : {sampled_places, sampled_directions})
    if (set > 0) rays += sampledRays(set, settings);
  json["clustered"] = clustered;
  json["sampled"] = sampled;
  json["rays_per_point"] = rays;
  json["confidence"] = settings.confidence;
  std::vector<std::string> uses;
  if (clustered > 0) uses.push_back(fmt::format("clusters stand for {}", clustered));
  if (sampled > 0)
    uses.push_back(fmt::format("{} are sampled by about {:.0f} rays a point at a confidence of {}", sampled,
                               rays, settings.confidence));
  if (const std::size_t few = clusterable + sampleable - clustered - sampled; few > 0)
    uses.push_back(fmt::format("{} are too few for it", few));
  if (!uses.empty()) addLine(report, "", fmt::format("{}", fmt::join(uses, ", ")));
}

/// Two digits of a duration: "450 ms", "1.5 s", "12 min".
std::string durationText(double milliseconds) {
  const auto [value, unit] = milliseconds < 995      ? std::pair(milliseconds, "ms")
                             : milliseconds < 120000 ? std::pair(milliseconds / 1000, "s")
                                                     : std::pair(milliseconds / 60000, "min");
  return value < 9.95 ? fmt::format("{:.1f} {}", value, unit)
                      : fmt::format("{:.0f} {}", value < 99.5 ? value : std::round(value / 10) * 10, unit);
}

/// A duration of hours, too: "2 h 05 min".
std::string jobText(double milliseconds) {
  const auto minutes = std::int64_t(std::round(milliseconds / 60000));
  return minutes < 120 ? durationText(milliseconds)
                       : fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

/// Of a scene that moves so many frames are looked at, at most, each for those up to the next: to look at one
/// may take half as long as to make it.
constexpr std::size_t kFramesPosed = 25;

/// What the pictures of all these frames together would cost, made by one process.
void addJob(Scene& scene, const std::vector<int>& frames, const InfoOptions& options, Report& report) {
  double milliseconds = 0, bytes = 0, longest = 0;
  int slowest = frames.front();
  std::pair<double, double> of_each;  // the last one's that was looked at, and its start
  const bool moves = sceneInfo(scene).moves.has_value();
  const std::size_t step = moves ? (frames.size() + kFramesPosed - 1) / kFramesPosed : frames.size();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const int frame = frames[i];
    if (i % step == 0) {
      poseScene(scene, frame);
      const RenderSettings settings = renderSettings(options, scene);
      const PictureWork work = pictureWork(scene, settings, planPicture(scene, settings));
      of_each = {estimatedMilliseconds(work), estimatedStart(work)};
      bytes = std::max(bytes, estimatedBytes(work));
    }
    const auto [of_frame, start] = of_each;
    milliseconds += milliseconds == 0 ? of_frame : of_frame - start;
    if (of_frame > longest) {
      longest = of_frame;
      slowest = frame;
    }
  }
  report.json["job"] = {{"frames", frames.size()},
                        {"milliseconds", milliseconds},
                        {"memory_bytes", bytes},
                        {"slowest_frame", slowest},
                        {"slowest_milliseconds", longest}};
  addLine(
      report, "all frames",
      fmt::format("{}: about {}, at most {:.0f} MiB; the longest{}, frame {}, about {}",
                  counted(frames.size(), "frame"), jobText(milliseconds), bytes / (1 << 20),
                  moves && step > 1 ? fmt::format(" of 1 in {}", step) : "", slowest, durationText(longest)));
}

/// What a render with these options would use and cost. Returns what keeps it from being made, or "".
std::string addRender(const Scene& scene, const RenderSettings& settings, const PicturePlan& plan,
                      Report& report) {
  const std::vector<std::string> features = featureNames(plan.features);
  report.json["features"] = features;
  addLine(report, "features", features.empty() ? "none" : fmt::format("{}", fmt::join(features, ", ")));
  const int rows = std::min(plan.band_height, settings.size.y), bands = (settings.size.y + rows - 1) / rows;
  report.json["plan"] = {{"programs", plan.programs.size()},
                         {"bytes_per_pixel", plan.pixel_bytes},
                         {"bands", bands},
                         {"band_rows", rows},
                         {"shares_samples", plan.shares_samples}};
  addLine(report, "plan",
          fmt::format("{} of {} rows at most, {} bytes a pixel, {} of kernels",
                      counted(std::size_t(bands), "band"), rows, plan.pixel_bytes,
                      counted(plan.programs.size(), "set")));
  Json& json = report.json["render"];
  json = {{"width", settings.size.x}, {"height", settings.size.y}, {"samples", settings.samples},
          {"milliseconds", nullptr},  {"memory_bytes", nullptr},   {"machine", kEstimateMachine}};
  try {
    const PictureWork work = pictureWork(scene, settings, plan);
    const double milliseconds = estimatedMilliseconds(work), bytes = estimatedBytes(work);
    json["milliseconds"] = milliseconds;
    json["memory_bytes"] = bytes;
    addLine(report, "a picture",
            fmt::format("{} with {}: about {:.0f} MiB, and about {} on {}", sizeText(settings.size),
                        counted(std::size_t(settings.samples), "sample"), bytes / (1 << 20),
                        durationText(milliseconds), kEstimateMachine));
    return "";
  } catch (const MachineError& error) {
    return error.what();
  }
}

Report sceneReport(InfoOptions options) {
  options.quiet = true;  // the report has the warnings
  const FrameChoice choice = chosenFrames(options.frames);
  Scene scene = openLitScene(options.file, choice.frames.front(), options);
  const RenderSettings settings = renderSettings(options, scene);
  const PicturePlan plan = planPicture(scene, settings);
  const SceneInfo info = sceneInfo(scene);
  Report report;
  report.json["file"] = options.file;
  report.json["kind"] = "scene";
  report.text = printable(options.file) + "\n";
  addShape(scene, info, report);
  addNames(scene, report);
  addMaterials(scene, info, report);
  addCameras(scene, report);
  addLights(scene, info.lights, report);
  addLightUses(scene, plan, report);
  report.json["variants"] = scene.variants;
  if (!scene.variants.empty())
    addLine(report, "variants", printable(fmt::format("{}", fmt::join(scene.variants, ", "))));
  report.json["animations"] = scene.animations;
  if (!scene.animations.empty())
    addLine(report, "animations", printable(fmt::format("{}", fmt::join(scene.animations, ", "))));
  report.json["ignored_extensions"] = scene.ignored_extensions;
  if (!scene.ignored_extensions.empty())
    addLine(report, "ignored", printable(fmt::format("{}", fmt::join(scene.ignored_extensions, ", "))));
  const std::string obstacle = addRender(scene, settings, plan, report);
  report.json["job"] = nullptr;
  if (choice.is_list && obstacle.empty()) addJob(scene, choice.frames, options, report);
  std::vector<Warning> warnings = scene.warnings;
  if (!obstacle.empty()) warnings.push_back({"the picture can't be made: " + obstacle, "obstacle"});
  addWarnings(report, warnings);
  return report;
}

std::string findText(const PicturePart& part, const std::string& name) {
  for (const auto& [known, text] : part.attributes.texts)
    if (equalIgnoringCase(known, name)) return text;
  return "";
}

/// A layer: the channels whose names are alike up to the last dot. Those without a dot are of the layer "".
struct Layer {
  std::string name;
  std::vector<std::string> channels, types;
};

std::vector<Layer> layersOf(const PicturePart& part) {
  std::vector<Layer> layers;
  for (std::size_t i = 0; i < part.channels.size(); ++i) {
    const std::string& channel = part.channels[i];
    const std::size_t dot = channel.rfind('.');
    const std::string name = dot == std::string::npos ? "" : channel.substr(0, dot);
    auto layer = std::find_if(layers.begin(), layers.end(), [&](const Layer& l) { return l.name == name; });
    if (layer == layers.end()) layer = layers.insert(layer, {name, {}, {}});
    layer->channels.push_back(channel.substr(dot == std::string::npos ? 0 : dot + 1));
    layer->types.push_back(part.types[i]);
  }
  return layers;
}

void addPart(const PicturePart& part, Report& report) {
  Json layers = Json::array();
  const bool is_crop = part.size != part.picture_size || part.crop_origin != glm::ivec2(0);
  std::string words = sizeText(part.size);
  if (is_crop)
    words += fmt::format(" from ({}, {}) on of {}", part.crop_origin.x, part.crop_origin.y,
                         sizeText(part.picture_size));
  if (part.display.pixel_aspect != 1)
    words += fmt::format(", pixels {:g} times as wide as high", part.display.pixel_aspect);
  if (const glm::ivec2 origin = part.display.origin; origin != glm::ivec2(0))
    words += fmt::format(", display window from ({}, {}) on", origin.x, origin.y);
  if (!part.compression.empty()) words += ", " + printable(part.compression);
  addLine(report, "picture", words + (part.name.empty() ? "" : ", " + printable(part.name)));
  for (const Layer& layer : layersOf(part)) {
    layers.push_back({{"name", layer.name}, {"channels", layer.channels}, {"types", layer.types}});
    const bool is_uniform = std::count(layer.types.begin(), layer.types.end(), layer.types[0]) ==
                            std::ptrdiff_t(layer.types.size());
    addLine(report, layers.size() == 1 ? "layers" : "",
            fmt::format("{:<12} {}  {}", layer.name.empty() ? "(no name)" : printable(layer.name),
                        printable(fmt::format("{}", fmt::join(layer.channels, " "))),
                        is_uniform ? layer.types[0] : fmt::format("{}", fmt::join(layer.types, " "))));
  }
  report.json["parts"].push_back(
      {{"name", part.name},
       {"width", part.size.x},
       {"height", part.size.y},
       {"picture", {{"width", part.picture_size.x}, {"height", part.picture_size.y}}},
       {"origin", {part.crop_origin.x, part.crop_origin.y}},
       {"display_origin", {part.display.origin.x, part.display.origin.y}},
       {"pixel_aspect", part.display.pixel_aspect},
       {"compression", part.compression},
       {"layers", layers}});
}

/// Returns what is wrong with the camera of a picture's header, or "".
std::string addCamera(const std::string& file, const PicturePart& part, Report& report) {
  report.json["camera"] = nullptr;
  try {
    const std::optional<CameraHeader> header =
        readCamera(part.attributes, part.picture_size, file, {}, part.display.pixel_aspect);
    if (!header) {
      addLine(report, "camera", "none");
      return "";
    }
    Json& json = report.json["camera"] = cameraJson(header->camera);
    const bool knows_opening = header->half_extent.has_value();
    if (!knows_opening) json.erase("fov_y_degrees");
    if (header->is_exact) {
      addPlanes(header->camera, json);
    }
    addLine(report, "camera",
            cameraText(header->camera) + (knows_opening ? ", " + openingText(header->camera) : ""));
    if (header->is_exact) addLine(report, "", planesText(header->camera));
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

Report pictureReport(const std::string& file) {
  const std::vector<PicturePart> parts = readParts(file);
  Report report;
  report.json["file"] = file;
  report.json["kind"] = "picture";
  report.text = printable(file) + "\n";
  report.json["parts"] = Json::array();
  for (const PicturePart& part : parts) addPart(part, report);
  const std::string fault = addCamera(file, parts.front(), report);
  const bool is_ours = findText(parts.front(), "Software").starts_with("Luciole");
  for (const auto& [key, attribute] : {std::pair("software", "Software"),
                                       {is_ours ? "command" : "description", "ImageDescription"},
                                       {"device", "luciole:device"}}) {
    const std::string text = findText(parts.front(), attribute);
    if (text.empty()) continue;
    report.json[key] = text;
    addLine(report, key, printable(text));
  }
  addWarnings(report, fault.empty() ? std::vector<Warning>{} : std::vector<Warning>{{fault, "fault"}});
  return report;
}

void showInfo(const InfoOptions& options) {
  if (!options.json.empty()) checkPlace(options.json);
  const bool is_scene =
      options.file == "-" || extensionOf(options.file) == ".json" || isMeshFile(options.file);
  const Report report = is_scene ? sceneReport(options) : pictureReport(options.file);
  if (!options.json.empty()) writeTextFile(options.json, dumpUtf8(report.json, 2) + "\n");
  if (options.json != "-" && !options.quiet) fmt::print("{}", report.text);
}

}  // namespace

void addInfoCommand(CLI::App& app, CommandContext&) {
  CLI::App* command = app.add_subcommand(
      "info",
      "what a scene holds, what a render with these options would use and cost; or what a picture holds");
  auto options = std::make_shared<InfoOptions>();
  command
      ->add_option("FILE", options->file,
                   "a .json, .obj, .gltf or .glb file (- : JSON on standard input), or a picture: an .exr's "
                   "layers, camera and command")
      ->required();
  addPictureOptions(
      *command, *options,
      kViewOptions | kSampleOption | kModelOptions | kShadeOptions | kCastOption | kManyPictures);
  command->add_option("--frames", options->frames,
                      "of a scene that moves: at frame A; or for A-B, A-BxN or a list, also what all these "
                      "frames together would cost (default: 1)");
  command->add_option("--json", options->json, "write it all as JSON (- : standard output)");
  command->callback([options] { showInfo(*options); });
}

}  // namespace luciole
