#include "tools/view/scene_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <span>
#include <utility>

#include "base/clock.hpp"
#include "base/dump_utf8.hpp"
#include "base/write_file.hpp"
#include "cl/launch.hpp"
#include "image/heat_map.hpp"
#include "lighting/compile_helper.hpp"
#include "lighting/count_picture.hpp"
#include "luciole/compare.hpp"
#include "luciole/error.hpp"
#include "luciole/reference.hpp"
#include "raster/view.hpp"
#include "render/aov_table.hpp"
#include "render/renderer.hpp"
#include "scene/bounds.hpp"
#include "scene/json/write_scene.hpp"
#include "scene/tangents.hpp"
#include "shaders/shader_text.hpp"
#include "tools/models/check_model.hpp"
#include "tools/view/scene_state.hpp"
#include "tools/view/view_camera.hpp"
#include "tools/view/view_json.hpp"
#include "tools/viewing/light_map.hpp"
#include "tools/viewing/shown_layer.hpp"

namespace luciole {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kPagesKnown = 16;
/// Programs in memory, of which an editor makes one at a time, after which those of its texts are dropped.
constexpr std::size_t kMostPrograms = 64;

/// The files that "save" may write.
constexpr std::array kSavedEndings{".json", ".png", ".exr", "-model.clh", "-surface.clh", "-screen.clh"};

/// Thrown between a picture's bands where a newer request has taken its place.
struct Superseded {};

/// What a layer's name asks the renderer for; nothing for the picture's colours.
std::optional<Aov> aovNamed(const std::string& name) {
  for (const AovRow& row : aovTable())
    if (row.name == name) return row.aov;
  return std::nullopt;
}

/// The place "FILE:LINE:COLUMN: …" of a shader's fault, if the message begins with one of ours.
Json shaderFault(const std::string& message) {
  for (const char* kind : {"model", "surface", "screen"}) {
    const std::string file = std::string(kind) + kShaderExtension + ":";
    if (!message.starts_with(file)) continue;
    int line = 1, column = 1;
    const char* const end = message.data() + message.size();
    const auto [after, error] = std::from_chars(message.data() + file.size(), end, line);
    if (error == std::errc() && after != end) std::from_chars(after + 1, end, column);
    return {{"kind", kind}, {"line", line}, {"column", column}};
  }
  return nullptr;
}

/// Calls what answers a request, and answers with what goes wrong.
template <class Answering>
Answer guarded(const Answering& answering) {
  try {
    return answering();
  } catch (const Superseded&) {
    return {.status = 409, .body = R"({"superseded":true})"};
  } catch (const InputError& error) {
    Json json{{"error", error.what()}};
    if (Json shader = shaderFault(error.what()); !shader.is_null()) json["shader"] = shader;
    return {.status = 422, .body = dumpUtf8(json)};
  }
}

/// Where the lights of the list are in the picture, in shares of it.
Json markersOf(const Scene& scene, const Camera& camera, glm::ivec2 size) {
  const View view = cameraView(camera, size);
  Json markers = Json::array();
  for (std::size_t i = 0; i < std::min(ownLights(scene).size(), kMostListed); ++i) {
    const Light& light = scene.lights[i];
    if (light.kind == LightKind::kDirectional) continue;
    const glm::dvec4 clip = view.projection * view.world_to_view * glm::dvec4(light.position, 1);
    if (!(clip.w > 0) || std::abs(clip.x) > clip.w || std::abs(clip.y) > clip.w) continue;
    markers.push_back({i, 0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w});
  }
  return markers;
}

/// Sets a change, in place of the one of the same place.
void setPlace(const std::string& change, std::vector<std::string>& changes) {
  const std::string place = change.substr(0, change.find('=') + 1);
  const auto found = std::find_if(changes.begin(), changes.end(),
                                  [&](const std::string& one) { return one.starts_with(place); });
  if (found == changes.end())
    changes.push_back(change);
  else
    *found = change;
}

/// What shaders gave that is no light, no surface or no colour.
Json faultLines(const Stats& stats) {
  Json lines = Json::array();
  const auto add = [&](const std::string& count, const char* what) {
    if (const std::uint64_t faults = countOf(stats, count); faults > 0)
      lines.push_back(fmt::format("{} at {} points", what, faults));
  };
  add(kFaultyPixels, "the model gave NaN, infinite or negative light, which counts as 0,");
  add(kFaultySurfaces, "surface() gave numbers or directions that are none, which stay as they were,");
  add(faultyScreenPixels(0), "screen() gave NaN, infinite or negative colours, which stay as they were,");
  return lines;
}

/// A word as a shell takes it.
std::string shellWord(const std::string& word) {
  if (!word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                              "_./=,:+-") == word.npos)
    return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

Json boundState(const Stats& stats) {
  const LightErrorStats& error = stats.light_error;
  if (error.values == 0) return nullptr;
  return {{"largest", error.largest}, {"mean", error.sum / double(error.values)}, {"least", error.least}};
}

}  // namespace

SceneView::SceneView(OpenedDevice& device, SceneSource source) : device_(device), source_(std::move(source)) {
  load();
  awaitDevice(device_);
  state_ = dumpUtf8(allState());
}

SceneView::~SceneView() {
  if (optimizing_.joinable()) optimizing_.join();
}

/// Reads the scene. Throws before anything is changed.
void SceneView::load() {
  files_ = filesOf(source_.path);
  Scene scene = source_.load();
  watchTextures(scene, files_);
  const Bounds bounds = sceneBounds(scene);
  if (bounds.low.x <= bounds.high.x) {
    middle_ = bounds.low + (bounds.high - bounds.low) / 2.0;
    length_ = std::max(glm::length(bounds.high - bounds.low), 1e-6);
  }
  loaded_ = valuesOf(scene);
  applied_.reset();
  exposure_.reset();
  costs_ = {};
  has_tangents_ = false;
  fault_.clear();
  renderer_ = makeRenderer(std::array{&device_}, std::move(scene));
}

/// Reads the scene again where its files have changed. What is wrong with them is told, and the scene stays.
void SceneView::reload() {
  if (!source_.watches || !haveChanged(files_)) return;
  ++generation_;
  try {
    load();
  } catch (const InputError& error) {
    fault_ = error.what();
  }
}

/// Gives all surfaces tangents, once, for shaders that ask for them.
void SceneView::readyTangents() {
  if (std::exchange(has_tangents_, true)) return;
  Scene scene = std::move(renderer_->scene());
  addAllTangents(scene);
  renderer_ = makeRenderer(std::array{&device_}, std::move(scene));
}

/// Makes the renderer's scene what the view says, and returns the settings of its pictures. Throws
/// InputError.
RenderSettings SceneView::apply(const SceneChanges& view) {
  if (applied_ == view) return settings_;
  applied_.reset();
  Scene& scene = renderer_->scene();
  setValues(loaded_, scene);
  std::vector<std::string> numbered = numberedChanges(view.changes);
  const auto shader = [](const char* kind, const std::string& text) {
    return Shader{std::string(kind) + kShaderExtension, text};
  };
  const Shader model = shader("model", view.shaders.model), surface = shader("surface", view.shaders.surface),
               screen = shader("screen", view.shaders.screen);
  bool uses_tangents = false;
  if (!model.text.empty()) uses_tangents = shaderFacts(model, ShaderKind::kModel).uses_tangents;
  if (!surface.text.empty()) uses_tangents |= shaderFacts(surface, ShaderKind::kSurface).uses_tangents;
  if (!screen.text.empty()) shaderFacts(screen, ShaderKind::kScreen);
  if (uses_tangents) readyTangents();
  Scene& ready = renderer_->scene();
  makeChanges(numbered, ready);
  RenderSettings settings = source_.settings(view.options, ready);
  if (!model.text.empty()) {
    if (ready.user_models.size() == kMostUserModels)
      throw InputError("model.clh: the scene has too many models");
    ready.user_models.push_back(model);
    settings.shade.model = userModel(ready.user_models.size() - 1);
  }
  if (!surface.text.empty()) settings.surfaces = {surface};
  if (!screen.text.empty()) settings.screens = {screen};
  settings_ = settings;
  numbered_ = std::move(numbered);
  applied_ = view;
  if (device_.programs.size() > kMostPrograms) dropPassingPrograms(device_);
  return settings_;
}

/// Whether a newer request of the same page came in.
bool SceneView::isSuperseded(const ViewRequest& request) {
  const std::lock_guard lock(newest_mutex_);
  for (auto page = newest_.begin(); page != newest_.end(); ++page) {
    if (page->first != request.page) continue;
    page->second = std::max(page->second, request.number);
    const bool is_superseded = page->second > request.number;
    newest_.splice(newest_.begin(), newest_, page);
    return is_superseded;
  }
  newest_.emplace_front(request.page, request.number);
  if (newest_.size() > kPagesKnown) newest_.pop_back();
  return false;
}

/// After a picture that was made by programs compiled quickly, or by the general one: has its own compiled by
/// a process beside, and then takes these.
void SceneView::optimizeKernels() {
  if (is_optimized_.exchange(false)) {
    optimizing_.join();
    dropPassingPrograms(device_);
  }
  if (device_.left_over.empty() || is_optimizing_.exchange(true)) return;
  if (optimizing_.joinable()) optimizing_.join();
  optimizing_ = std::thread([this, task = std::exchange(device_.left_over, {})] {
    compileLeftOver(device_, task);
    is_optimizing_ = false;
    is_optimized_ = true;
  });
}

Answer SceneView::picture(const std::string& body) {
  return guarded([&] {
    ViewRequest request = readRequest(body);
    isSuperseded(request);
    const std::lock_guard lock(mutex_);
    if (isSuperseded(request)) throw Superseded();
    optimizeKernels();
    const double begin = millisecondsSinceStart();
    RenderSettings settings = apply(request.changes);
    Camera camera = cameraOf(request);
    if (const std::string change = moveLight(request.gesture, renderer_->scene(), camera); !change.empty()) {
      setPlace(change, request.changes.changes);
      settings = apply(request.changes);
      camera = cameraOf(request);
    }
    settings.camera = camera;
    settings.size = request.is_moving ? movingSize(request) : request.size;
    settings.samples = request.samples;
    Stats stats;
    stats.began = begin;
    expose(request.changes, request.is_moving, settings, stats);
    Json about{{"camera", request.camera},
               {"changes", request.changes.changes},
               {"samples", settings.samples},
               {"generation", generation_},
               {"shows", {settings.size.x, settings.size.y}}};
    std::vector<std::string> notes;
    const Image image = layerImage(request, settings, stats, notes);
    std::string bytes;
    const bool is_picture = request.layer == "color";
    writeImage(image, request.is_moving ? "a.jpg" : "a.png", {},
               {.dither = is_picture && !request.is_moving, .memory = &bytes});
    if (!request.is_moving) {
      full_milliseconds_ = millisecondsSinceStart() - begin;
      if (request.samples == 1 && is_picture) addFrame(settings.size, full_milliseconds_, costs_);
    }
    about["type"] = request.is_moving ? "image/jpeg" : "image/png";
    about["size"] = {image.width, image.height};
    about["milliseconds"] = millisecondsSinceStart() - begin;
    about["stages"] = Json::array();
    for (const auto& stage : stats.stages)
      if (const double share = ownShare(stats, stage); share >= 0.05)
        about["stages"].push_back({stageName(stage.first), share});
    about["bound"] = boundState(stats);
    about["markers"] = markersOf(renderer_->scene(), settings.camera, settings.size);
    about["notes"] = notes;
    about["warnings"] = faultLines(stats);
    return pictureAnswer(about, bytes);
  });
}

/// The size of a motion's next frame.
glm::ivec2 SceneView::movingSize(const ViewRequest& request) {
  if (request.seen) addFrame(request.seen->size, request.seen->milliseconds, costs_);
  return frameSize(costs_, request.size);
}

/// The camera of the request after its gesture, which goes into request.camera.
Camera SceneView::cameraOf(ViewRequest& request) const {
  const Scene& scene = renderer_->scene();
  Camera camera = settings_.camera;
  if (request.camera.is_string()) {
    const auto found = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                    [&](const Camera& one) { return Json(one.name) == request.camera; });
    if (found == scene.cameras.end())
      throw InputError(fmt::format("camera: {} has none of that name", scene.name));
    camera = *found;
  } else if (!request.camera.is_null()) {
    camera = readViewCamera(request.camera);
  }
  if (request.gesture.is_null()) return camera;
  Json json =
      request.camera.is_object() ? request.camera : viewCameraJson(camera, pointAhead(camera, middle_));
  if (!moveCamera(request.gesture, length_, json)) return camera;
  camera = readViewCamera(json);
  request.camera = json;
  return camera;
}

/// The settings with the exposure that the options ask to be measured: at rest, and for a motion's first
/// frame.
void SceneView::expose(const SceneChanges& view, bool is_moving, RenderSettings& settings, Stats& stats) {
  const auto option = view.options.find("exposure");
  if (option == view.options.end() || option->second != "auto") return;
  if (!is_moving || !exposure_) exposure_ = renderer_->measureExposure(settings, stats);
  settings.exposure = float(*exposure_);
}

/// The picture of the request's layer, to be looked at.
Image SceneView::layerImage(const ViewRequest& request, RenderSettings settings, Stats& stats,
                            std::vector<std::string>& notes) {
  if (request.layer == "shadow_map") return shadowMapImage(request, settings);
  if (request.layer == "error") return errorImage(request, settings, stats, notes);
  const std::optional<Aov> aov = aovNamed(request.layer);
  if (!aov && request.layer != "color")
    throw InputError("layer: " + request.layer + ": there is none of that name");
  if (aov) settings.aovs = {*aov};
  // So that a newer request need not wait for all of it. A multiple of 64 changes no bit.
  constexpr int kBandHeight = 128;
  constexpr double kLong = 200;  // milliseconds
  if (!request.is_moving && (settings.samples > 1 || full_milliseconds_ > kLong))
    settings.band_height = kBandHeight;
  Image image;
  const auto take = [&](const Image& rows) {
    if (!request.is_moving && isSuperseded(request)) throw Superseded();
    appendRows(rows, image);
  };
  renderer_->render(settings, take, stats);
  if (!aov) return image;
  const ShownLayer shown = aovLayer(image.channels);
  Image layer;
  appendRows(image, shown.channels, layer);
  LayerPicture picture = layerPicture(shown.name, shown.kind, layer);
  notes = picture.notes;
  return picture.image;
}

Image SceneView::shadowMapImage(const ViewRequest& request, const RenderSettings& settings) {
  const Scene& scene = renderer_->scene();
  if (request.light >= scene.lights.size()) throw InputError("light: the scene has none of that number");
  const Light& light = scene.lights[request.light];
  const std::string name = nameOr(light.name, "light", request.light);
  if (!light.shadow) throw InputError(name + " casts no shadow, so it has no map");
  const LightMap map = drawLightMap(scene, cameraView(settings.camera, settings.size), request.light,
                                    settings.shade.shadow_limits);
  if (map.faces.empty()) throw InputError(scene.name + ": has no surface, so shadow maps show nothing");
  return lightMapPicture(map, name + ", metres");
}

/// The picture's differences from double precision, in a size whose reference takes some seconds.
Image SceneView::errorImage(const ViewRequest& request, RenderSettings settings, Stats& stats,
                            std::vector<std::string>& notes) {
  constexpr double kMilliseconds = 2000, kPixel = 0.02, kPair = 0.002;
  constexpr std::size_t kPiece = 2048;  // pixels between two looks for a newer request
  const Scene& scene = renderer_->scene();
  const double most = kMilliseconds / (kPixel + kPair * double(scene.lights.size()));
  const double share = std::min(1.0, std::sqrt(most / (double(settings.size.x) * settings.size.y)));
  settings.size = glm::max(glm::ivec2(16), glm::ivec2(share * glm::dvec2(settings.size)));
  settings.samples = 1;
  settings.exposure = 0;
  settings.screens.clear();
  Image image;
  renderer_->render(
      settings, [&](const Image& rows) { appendRows(rows, image); }, stats);
  std::vector<glm::ivec2> pixels;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) pixels.emplace_back(x, y);
  Image truth{image.width, image.height, {"R", "G", "B"}, {}};
  for (std::size_t first = 0; first < pixels.size(); first += kPiece) {
    if (isSuperseded(request)) throw Superseded();
    const std::size_t count = std::min(kPiece, pixels.size() - first);
    for (const glm::dvec3& color : referencePicture(scene, settings, std::span(pixels).subspan(first, count)))
      for (int c = 0; c < 3; ++c) truth.pixels.push_back(float(color[c]));
  }
  const ImageDifference difference = compareImages(truth, image);
  notes.push_back(fmt::format("against double precision, {} x {} pixels: {:.2g} at most, {:.2g} in the mean",
                              image.width, image.height, difference.max_abs, difference.mean_abs));
  return errorMap(difference);
}

Answer SceneView::pick(const std::string& body) {
  return guarded([&] {
    ViewRequest request = readRequest(body);
    const std::lock_guard lock(mutex_);
    RenderSettings settings = apply(request.changes);
    settings.camera = cameraOf(request);
    settings.size = request.size;
    Stats stats;
    expose(request.changes, true, settings, stats);
    const glm::ivec2 at = glm::min(glm::ivec2(request.at * glm::dvec2(request.size)), request.size - 1);
    settings.crop = Crop{at.x, at.y, 1, 1};
    settings.aovs = {Aov::kObjectId, Aov::kMaterialId, Aov::kPosition, Aov::kNormal, Aov::kDepth};
    const Image pixel = renderer_->render(settings).image;
    const auto valuesAt = [&](Aov aov) {
      Json values = Json::array();
      for (const std::string& name : aovRow(aov).channels) {
        const auto place = std::find(pixel.channels.begin(), pixel.channels.end(), name);
        values.push_back(pixel.pixels.at(std::size_t(place - pixel.channels.begin())));
      }
      return values;
    };
    const Scene& scene = renderer_->scene();
    const int object = valuesAt(Aov::kObjectId)[0], material = valuesAt(Aov::kMaterialId)[0];
    Json found{{"pixel", {at.x, at.y}},
               {"color", {pixel.pixels[0], pixel.pixels[1], pixel.pixels[2]}},
               {"material", nullptr}};
    if (object < 0 || material < 0) return jsonAnswer(found);
    found["object"] = nameOr(scene.objects[std::size_t(object)].name, "object", std::size_t(object));
    found["material"] = material;
    found["position"] = valuesAt(Aov::kPosition);
    found["normal"] = valuesAt(Aov::kNormal);
    found["distance"] = valuesAt(Aov::kDepth)[0];
    return jsonAnswer(found);
  });
}

Answer SceneView::check(const std::string& body) {
  return guarded([&] {
    const ViewRequest request = readRequest(body);
    const std::unique_lock lock(check_mutex_, std::try_to_lock);
    if (!lock) return Answer{.status = 503, .body = R"({"error":"a model is being checked"})"};
    const Shader shader{"model.clh", request.changes.shaders.model};
    shaderFacts(shader, ShaderKind::kModel);
    Json lines = Json::array();
    std::string text = modelCheckText(checkModel({shader.path, {}, shader}, device_.selector));
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      lines.push_back(text.substr(at, end - at));
      at = end + 1;
    }
    return jsonAnswer({{"lines", lines}});
  });
}

Answer SceneView::save(const std::string& body) {
  return guarded([&] {
    namespace fs = std::filesystem;
    ViewRequest request = readRequest(body);
    const std::lock_guard lock(mutex_);
    RenderSettings settings = apply(request.changes);
    const ViewShaders& shaders = request.changes.shaders;
    const std::string stem = fs::path(source_.path).stem().string() + "-view-";
    const auto isTaken = [&](int number) {
      return std::any_of(kSavedEndings.begin(), kSavedEndings.end(), [&](const char* ending) {
        return fs::exists(fs::path(source_.folder) / (stem + std::to_string(number) + ending));
      });
    };
    int number = 1;
    while (number < 10000 && isTaken(number)) ++number;
    const std::string name = (fs::path(source_.folder) / (stem + std::to_string(number))).string();

    // The picture is that of the camera as the file has it.
    const Camera camera = cameraOf(request);
    const Json camera_json =
        request.camera.is_object() ? request.camera : viewCameraJson(camera, pointAhead(camera, middle_));
    settings.camera = readViewCamera(camera_json);
    settings.size = request.size;
    const Scene& scene = renderer_->scene();
    const SavedScene saved =
        savedScene(source_.path, source_.folder, scene, camera_json, request.size, numbered_);
    std::vector<std::string> words{"luciole", "render", name + ".json"};
    const auto isWanted = [&](const char* output) {
      return std::find(request.outputs.begin(), request.outputs.end(), output) != request.outputs.end();
    };
    Json files = Json::array();
    const auto written = [&](const std::string& path) { files.push_back(path); };
    const auto saveShader = [&](const char* kind, const std::string& text) {
      if (text.empty()) return;
      const std::string path = name + "-" + kind + kShaderExtension;
      words.insert(words.end(), {std::string("--") + kind, path});
      if (!isWanted("scene")) return;
      writeTextFile(path, text);
      written(path);
    };
    for (const auto& [option, value] : request.changes.options)
      if (option != "model" || shaders.model.empty()) words.insert(words.end(), {"--" + option, value});
    saveShader("model", shaders.model);
    saveShader("surface", shaders.surface);
    saveShader("screen", shaders.screen);
    for (const std::string& change : saved.left) words.insert(words.end(), {"--set", change});
    if (isWanted("scene")) {
      writeTextFile(name + ".json", saved.text);
      written(name + ".json");
    }
    std::string command;
    words.insert(words.end(), {"-o", name + ".png"});
    for (const std::string& word : words) command += (command.empty() ? "" : " ") + shellWord(word);
    if (isWanted("png") || isWanted("exr")) {
      Stats stats;
      expose(request.changes, false, settings, stats);
      const Image image = renderer_->render(settings).image;
      for (const char* extension : {"png", "exr"}) {
        if (!isWanted(extension)) continue;
        const std::string path = name + "." + extension;
        writeImage(image, path, {{"Software", "Luciole " LUCIOLE_VERSION}, {"ImageDescription", command}},
                   {.dither = true});
        written(path);
      }
    }
    return jsonAnswer({{"files", files}, {"command", command}});
  });
}

Json SceneView::allState() {
  Json json = sceneState(renderer_->scene(), loaded_);
  json.update({{"kind", "scene"},
               {"generation", generation_},
               {"fault", fault_.empty() ? Json(nullptr) : Json(fault_)},
               {"options", source_.options},
               {"shaders",
                {{"model", source_.shaders.model},
                 {"surface", source_.shaders.surface},
                 {"screen", source_.shaders.screen}}},
               {"examples", exampleShaders()},
               {"output", source_.folder}});
  return json;
}

Answer SceneView::state() {
  return guarded([&] {
    // Who asks each second need not wait for a picture that takes long.
    const std::unique_lock lock(mutex_, std::try_to_lock);
    const std::lock_guard state_lock(state_mutex_);
    if (lock) {
      reload();
      state_ = dumpUtf8(allState());
    }
    return Answer{.body = state_};
  });
}

}  // namespace luciole
