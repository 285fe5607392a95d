#include "tools/viewing/shown_layer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <utility>

#include "base/did_you_mean.hpp"
#include "base/machine_memory.hpp"
#include "base/text_file.hpp"
#include "gbuffer/layouts.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

constexpr const char* kColors = "color";

/// Of a file's layers, in the message about one that isn't there.
constexpr std::size_t kLayersShown = 40;

std::string lowered(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// The part of a name behind its last dot.
std::string lastPart(const std::string& name) { return name.substr(name.rfind('.') + 1); }

bool isCryptomatte(const std::string& name) {
  const std::string last = lowered(lastPart(name));
  const std::size_t size = last.size();
  return last.starts_with("crypto") && std::isdigit(static_cast<unsigned char>(last[size - 1])) &&
         std::isdigit(static_cast<unsigned char>(last[size - 2]));
}

/// Whether a channel of one number counts things: ours, Blender's, Mitsuba's, Arnold's.
bool isId(const std::string& name) {
  static const std::vector<std::string> kIds{"object_id",   "material_id", "model",    "indexob", "indexma",
                                             "shape_index", "prim_index",  "objectid", "id"};
  return std::find(kIds.begin(), kIds.end(), lowered(lastPart(name))) != kIds.end();
}

std::string withPart(const PicturePart& part, const std::string& name) {
  if (part.name.empty() || lowered(name).starts_with(lowered(part.name))) return name;
  return name == kColors ? part.name : part.name + "." + name;
}

/// Channels that are alike up to the last dot, by their component, lower case.
struct Group {
  std::string name;
  std::vector<std::pair<std::string, int>> channels;

  /// The places of these components; nothing where one of them is missing.
  std::vector<int> find(const std::vector<std::string>& components) const {
    std::vector<int> places;
    for (const std::string& component : components)
      for (const auto& [known, place] : channels)
        if (known == component) places.push_back(place);
    return places.size() == components.size() ? places : std::vector<int>{};
  }
};

void addGroup(const PicturePart& part, int index, const Group& group, std::vector<ShownLayer>& layers) {
  const std::string name = withPart(part, group.name.empty() ? kColors : group.name);
  std::vector<int> used;
  const auto add = [&](std::vector<int> channels, LayerKind kind) {
    if (channels.empty() || !used.empty()) return;
    used = channels;
    layers.push_back({name, index, std::move(channels), kind});
  };
  if (isCryptomatte(name)) add(group.find({"r", "g", "b", "a"}), LayerKind::kMatte);
  add(group.find({"x", "y", "z"}), LayerKind::kVector);
  add(group.find({"r", "g", "b"}), lastPart(name) == "light_error" ? LayerKind::kBound : LayerKind::kColor);
  for (const auto& [component, place] : group.channels) {
    if (std::find(used.begin(), used.end(), place) != used.end()) continue;
    const std::string channel = withPart(part, part.channels[std::size_t(place)]);
    const bool is_grey = component == "y" && group.find({"x"}).empty();
    layers.push_back({channel,
                      index,
                      {place},
                      isId(channel) || isId(name) ? LayerKind::kId
                      : is_grey                   ? LayerKind::kColor
                                                  : LayerKind::kValue});
  }
}

void addLayers(const PicturePart& part, int index, std::vector<ShownLayer>& layers) {
  std::vector<Group> groups;
  std::map<std::string, std::size_t> places;
  for (std::size_t c = 0; c < part.channels.size(); ++c) {
    const std::string& channel = part.channels[c];
    const std::size_t dot = channel.rfind('.');
    const std::string name = dot == std::string::npos ? "" : channel.substr(0, dot);
    const auto [at, is_new] = places.try_emplace(name, groups.size());
    if (is_new) groups.push_back({name, {}});
    groups[at->second].channels.emplace_back(lowered(channel.substr(dot == std::string::npos ? 0 : dot + 1)),
                                             int(c));
  }
  for (const Group& group : groups) addGroup(part, index, group, layers);
}

/// The names that programs give to what a role holds; none for another word.
std::vector<std::string> namesOfRole(const std::string& role) {
  static const std::map<std::string, const char * Layout::*> kRoles{
      {"position", &Layout::position}, {"normal", &Layout::normal},
      {"depth", &Layout::depth},       {"diffuse", &Layout::diffuse},
      {"specular", &Layout::specular}, {"geometric_normal", &Layout::geometric_normal},
      {kColors, &Layout::color}};
  std::vector<std::string> names;
  const auto known = kRoles.find(role);
  if (known == kRoles.end()) return names;
  for (const Layout& layout : layouts())
    for (const std::string_view name : splitNames(layout.*known->second)) names.emplace_back(name);
  return names;
}

/// The first layer whose name, in whole, behind a dot or before its component, is this one.
const ShownLayer* layerNamed(const std::vector<ShownLayer>& layers, const std::string& name) {
  const std::string wanted = lowered(name);
  for (const ShownLayer& layer : layers)
    if (layer.name == name) return &layer;
  for (const ShownLayer& layer : layers)
    if (lowered(layer.name) == wanted || lowered(layer.name).ends_with("." + wanted)) return &layer;
  for (const ShownLayer& layer : layers)
    if (lowered(layer.name).starts_with(wanted + ".")) return &layer;
  return nullptr;
}

}  // namespace

std::vector<ShownLayer> shownLayers(const std::vector<PicturePart>& parts) {
  std::vector<ShownLayer> layers;
  for (std::size_t i = 0; i < parts.size(); ++i) addLayers(parts[i], int(i), layers);
  return layers;
}

ShownLayer findShownLayer(const std::vector<PicturePart>& parts, const std::string& name,
                          const std::string& where) {
  const std::vector<ShownLayer> layers = shownLayers(parts);
  if (layers.empty()) throw InputError(where + ": no layer that can be shown");
  const std::string wanted = name.empty() ? kColors : name;
  const ShownLayer* found = name.empty() && layers.size() == 1 ? &layers.front() : layerNamed(layers, wanted);
  for (const std::string& one : namesOfRole(lowered(wanted)))
    if (!found && !one.empty()) found = layerNamed(layers, one);
  if (!found && name.empty()) found = layerNamed(layers, "Y");
  if (found) return *found;
  std::vector<std::string> names;
  for (const ShownLayer& layer : layers) names.push_back(forMessage(layer.name));
  const std::size_t shown = std::min(names.size(), kLayersShown);
  const std::string list =
      fmt::format("{}{}", fmt::join(names.begin(), names.begin() + std::ptrdiff_t(shown), ", "),
                  shown < names.size() ? fmt::format(" and {} more", names.size() - shown) : "");
  if (name.empty()) throw InputError(fmt::format("{}: which layer? Expected one of {}", where, list));
  throw InputError(fmt::format("{}: no layer {}{}; expected one of {}", where, forMessage(name),
                               didYouMean(name, names), list));
}

ShownLayer aovLayer(const std::vector<std::string>& channels) {
  PicturePart part;
  part.channels = channels;
  std::vector<ShownLayer> layers = shownLayers({part});
  ShownLayer layer = layers.at(1);                 // behind the colours
  for (std::size_t i = 2; i < layers.size(); ++i)  // the further ranks of a Cryptomatte
    layer.channels.insert(layer.channels.end(), layers[i].channels.begin(), layers[i].channels.end());
  return layer;
}

void appendRows(const Image& rows, const std::vector<int>& channels, Image& picture) {
  picture.width = rows.width;
  picture.height += rows.height;
  picture.channels.clear();
  for (const int channel : channels) picture.channels.push_back(rows.channels[std::size_t(channel)]);
  for (std::size_t at = 0; at < rows.pixels.size(); at += rows.channels.size())
    for (const int channel : channels) picture.pixels.push_back(rows.pixels[at + std::size_t(channel)]);
}

Image readShownLayer(ExrInput& input, const ShownLayer& layer) {
  const PicturePart& part = input.parts()[std::size_t(layer.part)];
  const ChannelPlanes planes = input.read(layer.part, layer.channels);
  const std::size_t channels = layer.channels.size(), pixels = planes.size() / channels;
  requireMemory(double(planes.size()) * sizeof(float),
                fmt::format("a picture of {} x {} pixels", part.size.x, part.size.y));
  Image image{part.size.x, part.size.y, {}, {}, part.picture_size, part.crop_origin};
  for (const int channel : layer.channels) image.channels.push_back(part.channels[std::size_t(channel)]);
  image.pixels.resize(planes.size());
  for (std::size_t c = 0; c < channels; ++c)
    for (std::size_t p = 0; p < pixels; ++p) image.pixels[p * channels + c] = planes[c * pixels + p];
  return image;
}

}  // namespace luciole
