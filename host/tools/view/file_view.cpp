#include "tools/view/file_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "image/exposure.hpp"
#include "image/exr_input.hpp"
#include "image/heat_map.hpp"
#include "luciole/compare.hpp"
#include "luciole/error.hpp"
#include "tools/view/view_json.hpp"
#include "tools/viewing/layer_picture.hpp"
#include "tools/viewing/light_mixer.hpp"

namespace luciole {
namespace {

using Json = nlohmann::json;

/// Layers that are kept, unless they are two.
constexpr std::size_t kKeptBytes = std::size_t(512) << 20;
constexpr double kLargestMix = 1e9;

const char* kindName(LayerKind kind) {
  switch (kind) {
    case LayerKind::kColor:
      return "color";
    case LayerKind::kVector:
      return "vector";
    case LayerKind::kValue:
      return "value";
    case LayerKind::kBound:
      return "bound";
    case LayerKind::kId:
      return "id";
    case LayerKind::kMatte:
      return "matte";
  }
  return "";
}

bool isLight(const ShownLayer& layer) {
  return layer.kind == LayerKind::kColor && layer.channels.size() == 3;
}

/// JSON has no number that isn't finite.
Json valueOf(float value) {
  return std::isfinite(value) ? Json(value) : Json(std::isnan(value) ? "NaN" : value > 0 ? "inf" : "-inf");
}

/// B − A in false colours, whatever their channels are called, and a line of numbers.
LayerPicture differenceOf(Image a, Image b) {
  if (a.width != b.width || a.height != b.height)
    throw InputError(
        fmt::format("A has {} x {} pixels, and B {} x {}: only pictures of one size have a difference",
                    a.width, a.height, b.width, b.height));
  if (a.channels.size() != b.channels.size())
    throw InputError(fmt::format("A has {} numbers a pixel, and B {}: choose layers of one kind",
                                 a.channels.size(), b.channels.size()));
  for (std::size_t c = 0; c < a.channels.size(); ++c) a.channels[c] = b.channels[c] = fmt::format("c{}", c);
  const ImageDifference difference = compareImages(a, b);
  return {
      errorMap(difference),
      {fmt::format("B - A: at most {:.4g}, at pixel {}, {}; on average {:.4g}; RMSE {:.4g}; PSNR {:.2f} dB",
                   difference.max_abs, difference.worst_pixel[0], difference.worst_pixel[1],
                   difference.mean_abs, difference.rmse, difference.psnr)}};
}

}  // namespace

FileView::File FileView::open(const std::string& path) {
  File file{path, filesOf(path), ExrInput(path).parts(), {}, ""};
  if (shownLayers(file.parts).empty()) throw InputError(path + ": no layer that can be shown");
  try {
    for (const GroupFactor& group : lightGroupsOf(path)) file.groups.push_back(group.group);
  } catch (const InputError&) {  // it has none
  }
  return file;
}

FileView::FileView(const std::vector<std::string>& paths, bool watches) : watches_(watches) {
  for (const std::string& path : paths) files_.push_back(open(path));
}

/// Reads the headers of changed files. What can't be read keeps its old ones.
void FileView::reload() {
  for (std::size_t i = 0; i < files_.size(); ++i) {
    File& file = files_[i];
    if (!watches_ || !haveChanged(file.watched)) continue;
    file.watched = filesOf(file.path);
    try {
      file = open(file.path);
    } catch (const InputError& error) {
      file.fault = error.what();
    }
    kept_.remove_if([&](const KeptLayer& kept) { return kept.file == i; });
    ++generation_;
  }
}

Answer FileView::state() {
  const std::lock_guard lock(mutex_);
  reload();
  Json state{{"kind", "files"}, {"generation", generation_}, {"fault", nullptr}, {"files", Json::array()}};
  for (const File& file : files_) {
    Json layers = Json::array();
    for (const ShownLayer& layer : shownLayers(file.parts))
      layers.push_back({{"name", layer.name}, {"kind", kindName(layer.kind)}});
    const glm::ivec2 size = file.parts[std::size_t(shownLayers(file.parts)[0].part)].size;
    state["files"].push_back(
        {{"name", file.path}, {"size", {size.x, size.y}}, {"layers", layers}, {"groups", file.groups}});
    if (!file.fault.empty()) state["fault"] = file.fault;
  }
  return jsonAnswer(std::move(state));
}

/// What is kept of a file by this key, or else is read now.
std::shared_ptr<const FileView::Layer> FileView::keptLayer(std::size_t file, const std::string& key,
                                                           const std::function<Layer()>& read) {
  const auto known = std::find_if(kept_.begin(), kept_.end(), [&](const KeptLayer& kept) {
    return kept.file == file && kept.key == key;
  });
  if (known != kept_.end())
    kept_.splice(kept_.begin(), kept_, known);
  else
    kept_.push_front({file, key, std::make_shared<const Layer>(read())});
  std::size_t bytes = 0, count = 0;
  kept_.remove_if([&](const KeptLayer& kept) {
    bytes += kept.layer->image.pixels.size() * sizeof(float);
    return ++count > 2 && bytes > kKeptBytes;
  });
  return kept_.front().layer;
}

std::size_t FileView::fileOf(const Json& request) const {
  return std::size_t(numberIn(memberIn(request, "file"), 0, double(files_.size()) - 1, "file"));
}

/// The layer that an object names: {"file", "layer"}.
std::shared_ptr<const FileView::Layer> FileView::layerOf(const Json& request) {
  const std::size_t file = fileOf(request);
  const std::string name = textIn(memberIn(request, "layer"), "layer"), &path = files_[file].path;
  return keptLayer(file, "layer " + name, [&] {
    ExrInput input(path);
    const ShownLayer shown = findShownLayer(input.parts(), name, path);
    return Layer{shown, readShownLayer(input, shown)};
  });
}

/// The sum of a file's groups of lights by factors {"GROUP": [factor, "#rrggbb"]}, where 1 needn't stand.
Image FileView::mixOf(std::size_t file, const Json& mix) {
  std::vector<GroupFactor> factors;
  for (const std::string& group : files_[file].groups) {
    factors.push_back({group});
    const Json& term = memberIn(mix, group.c_str());
    if (term.is_null()) continue;
    if (!term.is_array() || term.size() != 2) refuseMember("mix");
    const auto color = linearColor(textIn(term[1], "mix"));
    if (!color) refuseMember("mix");
    factors.back().factor = float(numberIn(term[0], 0, kLargestMix, "mix")) * *color;
  }
  const auto groups = keptLayer(file, "groups", [&] {
    return Layer{{}, readLightGroups(files_[file].path)};
  });
  return mixLights(groups->image, factors);
}

Answer FileView::picture(const std::string& body) {
  const Json request = requestIn(body);
  const Json &mix = memberIn(request, "mix"), &exposure = memberIn(request, "exposure");
  const std::lock_guard lock(mutex_);
  const std::shared_ptr<const Layer> layer = layerOf(request);
  const std::size_t file = fileOf(request);
  const bool is_mixed = mix.is_object() && !files_[file].groups.empty() && layer->shown.name == "color";
  Image image = is_mixed ? mixOf(file, mix) : layer->image;
  LayerPicture picture;
  WriteOptions how;
  if (textIn(memberIn(request, "mode"), "mode") == "difference") {
    picture = differenceOf(std::move(image), layerOf(memberIn(request, "other"))->image);
  } else {
    if (isLight(layer->shown)) {
      image.channels = {"R", "G", "B"};
      expose(image, exposure.is_null() ? 0 : numberIn(exposure, -kMostStops, kMostStops, "exposure"));
    }
    how.dither = isLight(layer->shown);
    picture = layerPicture(layer->shown.name, layer->shown.kind, image);
  }
  std::string png;
  how.memory = &png;
  writeImage(picture.image, "picture.png", {}, how);
  return pictureAnswer({{"type", "image/png"},
                        {"size", {layer->image.width, layer->image.height}},
                        // Small pictures with a scale below are enlarged.
                        {"scale", std::max(picture.image.width / layer->image.width, 1)},
                        {"notes", picture.notes},
                        {"warnings", Json::array()},
                        {"generation", generation_}},
                       png);
}

Answer FileView::pick(const std::string& body) {
  const Json request = requestIn(body), at = memberIn(request, "at");
  const std::lock_guard lock(mutex_);
  const std::shared_ptr<const Layer> layer = layerOf(request);
  const Image& image = layer->image;
  if (!at.is_array() || at.size() != 2) refuseMember("at");
  const auto placeIn = [&](int i, int size) {
    return std::min(int(numberIn(at[i], 0, 1, "at") * size), size - 1);
  };
  const int x = placeIn(0, image.width), y = placeIn(1, image.height);
  const std::size_t channels = image.channels.size();
  Json values = Json::array();
  for (std::size_t c = 0; c < channels; ++c) {
    const std::string& name = image.channels[c];
    const float value =
        image.pixels[(std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * channels + c];
    values.push_back({name.substr(name.rfind('.') + 1), valueOf(value)});
  }
  return jsonAnswer({{"pixel", {x, y}}, {"values", values}});
}

}  // namespace luciole
