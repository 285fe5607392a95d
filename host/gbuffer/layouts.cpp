#include "gbuffer/layouts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/text_file.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

// Files of Blender 4.5 and 5.0, of Mitsuba 3.9 (whose names are the user's: here those of its documentation
// and the usual ones) and of OpenEXR for Python, which names the planes of an array P.R, P.G, P.B, were
// looked at. The others' names are those of their sources and documentation: pbrt-v4's GBufferFilm::GetImage,
// and the output variables of RenderMan, Arnold and 3Delight.
constexpr Layout kLayouts[]{
    {.program = "Luciole",
     .position = "P",
     .normal = "N",
     .depth = "Z",
     .diffuse = "diffuse",
     .specular = "specular",
     .shininess = "shininess",
     .ambient = "ambient",
     .emission = "emission",
     .geometric_normal = "Ng",
     .unbent_normal = "Nunbent",
     .lift = "lift",
     .model = "model",
     .view_position = "Pcam",
     .view_normal = "Ncam",
     .color = "|rgba|color|beauty",
     .is_albedo = false},
    {.program = "Blender",
     .position = "Position",
     .normal = "Normal",
     .depth = "Depth.Z|Depth.V",
     .diffuse = "DiffCol",
     .specular = "GlossCol",
     .emission = "Emit",
     .color = "Combined"},
    {.program = "Blender 5",
     .position = "Position",
     .normal = "Normal",
     .depth = "Depth.V|Depth.Z",
     .diffuse = "Diffuse Color",
     .specular = "Glossy Color",
     .emission = "Emission",
     .color = "Combined"},
    {.program = "Arnold",
     .position = "P",
     .normal = "N",
     .depth = "Z",
     .diffuse = "diffuse_albedo|albedo",
     .specular = "specular_albedo",
     .emission = "emission",
     .color = "|RGBA|beauty"},
    {.program = "pbrt",
     .position = "P",
     .normal = "Ns",
     .diffuse = "Albedo",
     .geometric_normal = "N",
     .space = FileSpace::kCamera},
    {.program = "RenderMan",
     .position = "__Pworld|Pworld",
     .normal = "__Nworld|Nworld",
     .depth = "z",
     .diffuse = "albedo",
     .emission = "emissive",
     .color = "Ci|"},
    {.program = "3Delight",
     .position = "P.world",
     .normal = "N.world",
     .depth = "z|depth.z",
     .diffuse = "albedo",
     .emission = "incandescence",
     .color = "Ci|"},
    {.program = "3Delight in camera space",
     .position = "P.camera",
     .normal = "N.camera",
     .depth = "z|depth.z",
     .diffuse = "albedo",
     .emission = "incandescence",
     .color = "Ci|",
     .space = FileSpace::kCamera},
    {.program = "Mitsuba",
     .position = "position|pos|pp|P",
     .normal = "sh_normal|normal|normals|nn|N",
     .depth = "depth.T|dd.y.T|dd.T",
     .diffuse = "albedo|diffuse_reflectance",
     .specular = "specular_reflectance",
     .geometric_normal = "geo_normal|gn|ng",
     .color = "|img|image",
     .depth_is_distance = true},
};

/// In the order of Role.
constexpr std::array<const char * Layout::*, kRoleCount> kNamesOf{
    &Layout::position,         &Layout::normal,        &Layout::depth,   &Layout::diffuse,
    &Layout::specular,         &Layout::shininess,     &Layout::ambient, &Layout::emission,
    &Layout::geometric_normal, &Layout::unbent_normal, &Layout::lift,    &Layout::model,
    &Layout::view_position,    &Layout::view_normal,   &Layout::color};

char lower(char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; }

/// Whether a layer's whole name is `wanted`, or ends in a dot and it. An empty one is only the nameless
/// layer's.
bool endsIn(std::string_view name, std::string_view wanted) {
  if (equalIgnoringCase(name, wanted)) return true;
  return !wanted.empty() && name.size() > wanted.size() && name[name.size() - wanted.size() - 1] == '.' &&
         equalIgnoringCase(name.substr(name.size() - wanted.size()), wanted);
}

/// Channels of one part that share the name before their last dot, and one name of components.
struct Group {
  std::string name;  ///< with the part's, unless the channels have that already
  FoundLayer layer;
  const char* components;  ///< "xyz" or "rgb"

  int count() const { return int(3 - std::count(layer.channels.begin(), layer.channels.end(), -1)); }
};

std::string withPart(const PicturePart& part, std::string_view name) {
  const bool has_it =
      part.name.empty() ||
      (name.size() >= part.name.size() && equalIgnoringCase(name.substr(0, part.name.size()), part.name) &&
       (name.size() == part.name.size() || name[part.name.size()] == '.'));
  if (has_it) return std::string(name);
  return name.empty() ? part.name : fmt::format("{}.{}", part.name, name);
}

/// The layers of a file.
struct Catalogue {
  std::vector<Group> groups;
  std::vector<Group> scalars;  ///< every channel by its whole name, but those of complete groups

  explicit Catalogue(const std::vector<PicturePart>& parts) {
    for (std::size_t part = 0; part < parts.size(); ++part) addPart(parts[part], int(part));
  }

 private:
  void addPart(const PicturePart& part, int index) {
    const std::size_t first = groups.size();
    std::map<std::pair<std::string, const char*>, std::size_t> places;
    std::vector<std::size_t> group_of(part.channels.size(), std::size_t(-1));
    for (std::size_t c = 0; c < part.channels.size(); ++c) {
      const std::string& channel = part.channels[c];
      const std::size_t dot = channel.rfind('.');
      const std::string component = dot == std::string::npos ? channel : channel.substr(dot + 1);
      if (component.size() != 1) continue;
      for (const char* components : {"xyz", "rgb"}) {
        const std::size_t place = std::string_view(components).find(lower(component[0]));
        if (place == std::string_view::npos) continue;
        const std::string name = withPart(part, dot == std::string::npos ? "" : channel.substr(0, dot));
        const auto [at, is_new] = places.try_emplace({name, components}, groups.size());
        if (is_new) groups.push_back({name, {.name = name, .part = index}, components});
        groups[at->second].layer.channels[place] = int(c);
        group_of[c] = at->second;
      }
    }
    for (std::size_t c = 0; c < part.channels.size(); ++c) {
      if (group_of[c] >= first && group_of[c] < groups.size() && groups[group_of[c]].count() == 3) continue;
      const std::string name = withPart(part, part.channels[c]);
      scalars.push_back({name, {.name = name, .part = index, .channels = {int(c), -1, -1}}, ""});
    }
  }
};

/// All layers that a name matches. A layer of exactly this name excludes others.
std::vector<const Group*> fitting(const Catalogue& file, Role role, std::string_view name) {
  std::vector<const Group*> found;
  for (const Group& group : isScalar(role) ? file.scalars : file.groups) {
    if (!endsIn(group.name, name)) continue;
    if (group.name.size() == name.size()) return {&group};
    found.push_back(&group);
  }
  // Complete layers are preferred to single channels, such as the r of an id.
  if (!isScalar(role) && std::any_of(found.begin(), found.end(), [](auto* one) { return one->count() == 3; }))
    std::erase_if(found, [](auto* one) { return one->count() < 3; });
  return found;
}

/// The layers that match the first name with a match.
std::vector<const Group*> candidates(const Catalogue& file, Role role, std::string_view names) {
  for (const std::string_view name : splitNames(names))
    if (std::vector<const Group*> found = fitting(file, role, name); !found.empty()) return found;
  return {};
}

/// The file's channels in a few words.
std::string channelList(const std::vector<PicturePart>& parts) {
  constexpr std::size_t kMost = 100;
  std::vector<std::string> names;
  std::size_t count = 0;
  for (const PicturePart& part : parts)
    for (const std::string& channel : part.channels)
      if (++count <= kMost) names.push_back(forMessage(withPart(part, channel)));
  if (names.empty()) return "channels, of which there are none";
  return fmt::format("channels {}{}", fmt::join(names, ", "),
                     count > kMost ? fmt::format(" and {} more", count - kMost) : "");
}

/// Words that end a message: how to say which layer is which.
constexpr const char* kHint = "request.layers ROLE=NAME,... says which layer is which";

/// The part of a layer's name before the name that the layout knows.
std::string prefixOf(const FoundLayer& layer, std::string_view names) {
  for (const std::string_view name : splitNames(names))
    if (endsIn(layer.name, name)) return layer.name.substr(0, layer.name.size() - name.size());
  return layer.name.substr(0, layer.name.rfind('.') + 1);
}

struct Search {
  const std::vector<PicturePart>& parts;
  const Catalogue& file;
  const std::string& path;

  /// The layers of a match that have the prefix, such as the same view layer; all if none has it.
  static std::vector<const Group*> withPrefix(const std::vector<const Group*>& found,
                                              const std::string& prefix) {
    std::vector<const Group*> same;
    for (const Group* group : found)
      if (group->name.size() >= prefix.size() &&
          equalIgnoringCase(group->name.substr(0, prefix.size()), prefix))
        same.push_back(group);
    return same.empty() ? found : same;
  }

  /// The one layer that a name fits.
  FoundLayer choose(Role role, const std::vector<const Group*>& left) const {
    if (left.size() > 1) {
      throw InputError(fmt::format("{}: {}: is it {} or {}? {}", path, kRoleNames[std::size_t(role)],
                                   forMessage(left[0]->name), forMessage(left[1]->name), kHint));
    }
    if (!isScalar(role)) checkComplete(*left[0]);
    return left[0]->layer;
  }

  void checkComplete(const Group& group) const {
    if (group.count() == 3) return;
    const bool is_large = std::any_of(group.layer.channels.begin(), group.layer.channels.end(), [&](int c) {
      const std::string& name = parts[std::size_t(group.layer.part)].channels[std::size_t(std::max(c, 0))];
      return c >= 0 && name.back() < 'a';
    });
    std::array<std::string, 3> names;
    for (int i = 0; i < 3; ++i) {
      const char component = group.components[i];
      names[i] = fmt::format("{}{}{}", forMessage(group.name), group.name.empty() ? "" : ".",
                             is_large ? char(component - 'a' + 'A') : component);
    }
    const auto missing = std::find(group.layer.channels.begin(), group.layer.channels.end(), -1);
    throw InputError(fmt::format("{}: channel {}: missing, expected {}", path,
                                 names[std::size_t(missing - group.layer.channels.begin())],
                                 fmt::join(names, " ")));
  }
};

/// A number that was typed for a layer.
std::optional<float> typedNumber(const std::string& text) {
  float number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number) || number < 0)
    return {};
  return number;
}

/// The rank of a layout: the number of its layers in the file; of equal ones the layout with an albedo layer,
/// whose "diffuse" is light.
std::pair<int, bool> fit(const Layout& layout, const Catalogue& file) {
  int count = 0;
  for (std::size_t role = 0; role < kRoleCount; ++role)
    count += Role(role) != Role::kColor && !candidates(file, Role(role), layout.*kNamesOf[role]).empty();
  return {count, layout.is_albedo && !candidates(file, Role::kDiffuse, layout.diffuse).empty()};
}

}  // namespace

std::vector<std::string_view> splitNames(std::string_view names) {
  std::vector<std::string_view> list;
  for (std::size_t begin = 0, end; begin < names.size() + 1 && !names.empty(); begin = end + 1) {
    end = std::min(names.find('|', begin), names.size());
    list.push_back(names.substr(begin, end - begin));
  }
  return list;
}

std::span<const Layout> layouts() { return kLayouts; }

FoundLayers findLayers(const std::vector<PicturePart>& parts, const ChosenLayers& chosen,
                       const std::string& path) {
  const Catalogue file(parts);
  const Search search{parts, file, path};
  FoundLayers found;
  const auto layout =
      std::max_element(std::begin(kLayouts), std::end(kLayouts),
                       [&](const auto& a, const auto& b) { return fit(a, file) < fit(b, file); });
  found.layout = &*layout;
  std::string prefix;
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    const Role role = Role(i);
    FoundLayer& layer = found.layers[i];
    const char* names = found.layout->*kNamesOf[i];
    if (const auto typed = chosen.find(role); typed != chosen.end()) {
      if (role == Role::kShininess) layer.constant = typedNumber(typed->second);
      if (layer.constant) continue;
      const auto fits = fitting(file, role, typed->second);
      if (fits.empty())
        throw InputError(fmt::format("{}: {} {}: no such layer among the {}", path, kRoleNames[i],
                                     forMessage(typed->second), channelList(parts)));
      layer = search.choose(role, Search::withPrefix(fits, prefix));
    } else if (auto fits = Search::withPrefix(candidates(file, role, names), prefix); !fits.empty()) {
      // The picture is seldom asked for, and its channels' names are everyone's.
      const bool is_clear = fits.size() == 1 && fits.front()->count() == 3;
      if (role != Role::kColor || is_clear) layer = search.choose(role, fits);
    }
    if (prefix.empty() && layer.isThere()) prefix = prefixOf(layer, names);
  }
  if (!found[Role::kPosition].isThere() && !found[Role::kDepth].isThere()) {
    const bool is_deep =
        std::any_of(parts.begin(), parts.end(), [](const auto& part) { return part.is_deep; });
    throw InputError(fmt::format("{}: {}no layer that is known to hold positions or depths among the {}; {}",
                                 path, is_deep ? "deep pixels are not read, and " : "", channelList(parts),
                                 kHint));
  }
  return found;
}

}  // namespace luciole
