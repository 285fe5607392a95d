#include "scene/gltf/gltf_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "base/text_file.hpp"
#include "base/utf8.hpp"
#include "luciole/error.hpp"
#include "scene/gltf/gltf_model.hpp"

namespace luciole {
namespace {

constexpr std::size_t kNoIndex = ~std::size_t{0};

/// An object of the file and the way to it, which becomes text for messages alone. Absent members, and those
/// of an object that is absent, have their defaults. Functions that read throw InputError where a member is
/// of another kind.
class ObjectReader {
 public:
  ObjectReader(const GltfModel& model, GltfJson& root) : model_(model), json_(&root) { expectObject(); }

  /// Whether there is such a member.
  bool has(const char* name) const { return find(name) != nullptr; }

  ObjectReader object(const char* name) const {
    GltfJson* found = find(name);
    static GltfJson empty = GltfJson::object();
    return {*this, name, kNoIndex, found ? *found : empty};
  }

  /// Calls read(object) for each object of a list.
  template <typename Read>
  void each(const char* name, const Read& read) const {
    GltfJson* list = findList(name);
    for (std::size_t i = 0; list && i < list->size(); ++i) read(ObjectReader(*this, name, i, (*list)[i]));
  }

  std::string text(const char* name, const char* otherwise = "") const {
    GltfJson* found = find(name);
    if (!found) return otherwise;
    if (!found->is_string()) fail(name, "expected a text");
    return std::move(found->get_ref<std::string&>());
  }

  /// What the thing is called. A name that is no text changes no picture.
  std::string name() const {
    const GltfJson* found = find("name");
    if (!found || found->is_string()) return text("name");
    warnRepaired(model_, placeOf("name"), "is no text; left out", "name");
    return "";
  }

  bool truth(const char* name, bool otherwise = false) const {
    const GltfJson* found = find(name);
    if (found && !found->is_boolean()) fail(name, "expected true or false");
    return found ? found->get<bool>() : otherwise;
  }

  double number(const char* name, double otherwise) const {
    const GltfJson* found = find(name);
    return found ? numberOf(*found, name) : otherwise;
  }

  std::optional<double> optionalNumber(const char* name) const {
    return has(name) ? std::optional(number(name, 0)) : std::nullopt;
  }

  std::vector<double> numbers(const char* name) const {
    std::vector<double> values;
    if (const GltfJson* list = findList(name))
      for (const GltfJson& value : *list) values.push_back(numberOf(value, name));
    return values;
  }

  std::size_t size(const char* name) const {
    const GltfJson* found = find(name);
    if (!found) return 0;
    if (found->is_number_unsigned()) return found->get<std::size_t>();
    constexpr double kMostExact = 9007199254740992.0;  // 2^53
    const double value = numberOf(*found, name);
    if (!(value >= 0 && value < kMostExact && value == std::floor(value)))
      fail(name, fmt::format("{}, expected a whole number from 0 on", value));
    return static_cast<std::size_t>(value);
  }

  int index(const char* name) const {
    const GltfJson* found = find(name);
    return found ? indexOf(*found, name) : -1;
  }

  /// A whole number that names something, such as 5126 for floats. It may be one that names nothing.
  int code(const char* name, int otherwise) const {
    const double value = number(name, otherwise);
    if (value != std::floor(value)) fail(name, fmt::format("{}, expected a whole number", value));
    return static_cast<int>(std::clamp(value, -1e9, 1e9));
  }

  std::vector<int> indices(const char* name) const {
    std::vector<int> values;
    if (const GltfJson* list = findList(name))
      for (const GltfJson& value : *list) values.push_back(indexOf(value, name));
    return values;
  }

  std::vector<std::string> texts(const char* name) const {
    std::vector<std::string> values;
    if (GltfJson* list = findList(name))
      for (GltfJson& value : *list) {
        if (!value.is_string()) fail(name, "expected a list of texts");
        values.push_back(std::move(value.get_ref<std::string&>()));
      }
    return values;
  }

  GltfAttributes attributes() const {
    GltfAttributes values;
    for (const auto& [name, value] : json_->items()) {
      const int accessor = indexOf(value, name.c_str());
      if (accessor >= 0) values.emplace(name, accessor);
    }
    return values;
  }

  /// The extensions, which their readers check.
  GltfJson extensions() const {
    GltfJson* found = find("extensions");
    return found ? std::move(*found) : GltfJson();
  }

  /// The text "group" of its extras, which are anybody's.
  std::optional<std::string> group() const {
    const GltfJson* extras = find("extras");
    if (!extras || !extras->is_object()) return {};
    const auto group = extras->find("group");
    if (group == extras->end() || !group->is_string()) return {};
    return group->get<std::string>();
  }

 private:
  ObjectReader(const ObjectReader& owner, const char* name, std::size_t index, GltfJson& json)
      : model_(owner.model_), owner_(&owner), name_(name), index_(index), json_(&json) {
    expectObject();
  }

  void expectObject() const {
    if (!json_->is_object()) failGltf(model_, owner_ ? place() : "its JSON", "expected an object");
  }

  /// A member; null where there is none, or null is written for none.
  GltfJson* find(const char* name) const {
    const auto found = json_->find(name);
    return found == json_->end() || found->is_null() ? nullptr : &*found;
  }

  GltfJson* findList(const char* name) const {
    GltfJson* found = find(name);
    if (found && !found->is_array()) fail(name, "expected a list");
    return found;
  }

  double numberOf(const GltfJson& value, const char* name) const {
    if (!value.is_number()) fail(name, "expected a number");
    return value.get<double>();
  }

  int indexOf(const GltfJson& value, const char* name) const {
    const double index = numberOf(value, name);
    if (index != std::floor(index)) fail(name, fmt::format("{}, expected a whole number", index));
    if (index < 0)
      warnRepaired(model_, placeOf(name), fmt::format("{} is nothing's number; left out", index),
                   "negative index");
    // One that no file can have is refused where it is looked up.
    return index < 0 ? -1 : index < 1e9 ? static_cast<int>(index) : 1'000'000'000;
  }

  std::string place() const {
    if (!owner_) return "";
    const std::string before = owner_->placeOf(name_);
    return index_ == kNoIndex ? before : fmt::format("{}[{}]", before, index_);
  }
  std::string placeOf(const char* name) const {
    const std::string here = place();
    return here.empty() ? forMessage(name) : fmt::format("{}.{}", here, forMessage(name));
  }
  [[noreturn]] void fail(const char* name, const std::string& what) const {
    failGltf(model_, placeOf(name), what);
  }

  const GltfModel& model_;
  const ObjectReader* owner_ = nullptr;
  const char* name_ = "";
  std::size_t index_ = kNoIndex;
  GltfJson* json_;
};

int componentsOf(const std::string& type) {
  static const std::map<std::string, int> kComponents{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                      {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
  const auto found = kComponents.find(type);
  return found == kComponents.end() ? 0 : found->second;
}

GltfAccessor parseAccessor(const ObjectReader& from) {
  GltfAccessor accessor{.view = from.index("bufferView"),
                        .offset = from.size("byteOffset"),
                        .count = from.size("count"),
                        .type = from.code("componentType", 0),
                        .components = componentsOf(from.text("type")),
                        .normalized = from.truth("normalized"),
                        .sparse = {}};
  if (!from.has("sparse")) return accessor;
  const ObjectReader sparse = from.object("sparse"), indices = sparse.object("indices"),
                     values = sparse.object("values");
  accessor.sparse = GltfSparse{.count = sparse.size("count"),
                               .index_offset = indices.size("byteOffset"),
                               .value_offset = values.size("byteOffset"),
                               .index_view = indices.index("bufferView"),
                               .index_type = indices.code("componentType", 0),
                               .value_view = values.index("bufferView")};
  return accessor;
}

GltfTextureInfo parseTextureInfo(const ObjectReader& owner, const char* name) {
  const ObjectReader from = owner.object(name), extensions = from.object("extensions"),
                     transform = extensions.object("KHR_texture_transform");
  const int uv_set = from.index("texCoord"), transformed_set = transform.index("texCoord");
  return {.texture = from.index("index"),
          .uv_set = std::max(transformed_set >= 0 ? transformed_set : uv_set, 0),
          .scale = from.number("scale", 1),
          .uv_offset = transform.numbers("offset"),
          .uv_scale = transform.numbers("scale"),
          .uv_rotation = transform.number("rotation", 0)};
}

std::optional<GltfGlossy> parseGlossy(const ObjectReader& extensions) {
  constexpr const char* kName = "KHR_materials_pbrSpecularGlossiness";
  if (!extensions.has(kName)) return {};
  const ObjectReader from = extensions.object(kName);
  return GltfGlossy{.diffuse_factor = from.numbers("diffuseFactor"),
                    .specular_factor = from.numbers("specularFactor"),
                    .glossiness = from.number("glossinessFactor", 1),
                    .diffuse = parseTextureInfo(from, "diffuseTexture"),
                    .specular_glossiness = parseTextureInfo(from, "specularGlossinessTexture")};
}

GltfMaterial parseMaterial(const ObjectReader& from) {
  const ObjectReader pbr = from.object("pbrMetallicRoughness"), extensions = from.object("extensions"),
                     specular = extensions.object("KHR_materials_specular");
  return {
      .name = from.name(),
      .base_factor = pbr.numbers("baseColorFactor"),
      .emissive_factor = from.numbers("emissiveFactor"),
      .metallic = pbr.number("metallicFactor", 1),
      .roughness = pbr.number("roughnessFactor", 1),
      .alpha_cutoff = from.number("alphaCutoff", 0.5),
      .base = parseTextureInfo(pbr, "baseColorTexture"),
      .metallic_roughness = parseTextureInfo(pbr, "metallicRoughnessTexture"),
      .normal = parseTextureInfo(from, "normalTexture"),
      .emissive = parseTextureInfo(from, "emissiveTexture"),
      .alpha_mode = from.text("alphaMode", "OPAQUE"),
      .double_sided = from.truth("doubleSided"),
      .unlit = extensions.has("KHR_materials_unlit"),
      .emissive_strength = extensions.object("KHR_materials_emissive_strength").number("emissiveStrength", 1),
      .ior = extensions.object("KHR_materials_ior").number("ior", 1.5),
      .specular = {.factor = specular.number("specularFactor", 1),
                   .color_factor = specular.numbers("specularColorFactor"),
                   .texture = parseTextureInfo(specular, "specularTexture"),
                   .color_texture = parseTextureInfo(specular, "specularColorTexture")},
      .glossy = parseGlossy(extensions)};
}

GltfPrimitive parsePrimitive(const ObjectReader& from) {
  GltfPrimitive primitive{.attributes = from.object("attributes").attributes(),
                          .indices = from.index("indices"),
                          .material = from.index("material"),
                          .mode = from.code("mode", 4),
                          .targets = {},
                          .extensions = {}};
  from.each("targets", [&](const ObjectReader& target) { primitive.targets.push_back(target.attributes()); });
  primitive.extensions = from.extensions();
  return primitive;
}

GltfMesh parseMesh(const ObjectReader& from) {
  GltfMesh mesh{.name = from.name(), .primitives = {}, .weights = from.numbers("weights")};
  from.each("primitives",
            [&](const ObjectReader& primitive) { mesh.primitives.push_back(parsePrimitive(primitive)); });
  return mesh;
}

GltfImage parseImage(const ObjectReader& from) {
  return {from.name(), from.text("uri"), from.index("bufferView"), {}, {}};
}

GltfNode parseNode(const ObjectReader& from) {
  const ObjectReader extensions = from.object("extensions"), luminaire = extensions.object("EXT_lights_ies");
  GltfNode node{
      .name = from.name(),
      .children = from.indices("children"),
      .mesh = from.index("mesh"),
      .camera = from.index("camera"),
      .skin = from.index("skin"),
      .light = extensions.object("KHR_lights_punctual").index("light"),
      .luminaire = {luminaire.index("light"), luminaire.number("multiplier", 1), luminaire.numbers("color")},
      .matrix = from.numbers("matrix"),
      .translation = from.numbers("translation"),
      .rotation = from.numbers("rotation"),
      .scale = from.numbers("scale"),
      .weights = from.numbers("weights"),
      .hidden = !extensions.object("KHR_node_visibility").truth("visible", true),
      .group = from.group(),
      .extensions = {}};
  node.extensions = from.extensions();
  return node;
}

GltfAnimationEntry parseAnimationEntry(const ObjectReader& from) {
  GltfAnimationEntry animation{.name = from.name(), .channels = {}, .samplers = {}};
  from.each("channels", [&](const ObjectReader& channel) {
    const ObjectReader target = channel.object("target");
    animation.channels.push_back({channel.index("sampler"), target.index("node"), target.text("path")});
  });
  from.each("samplers", [&](const ObjectReader& sampler) {
    animation.samplers.push_back(
        {sampler.index("input"), sampler.index("output"), sampler.text("interpolation", "LINEAR")});
  });
  return animation;
}

GltfCamera parseCamera(const ObjectReader& from) {
  const std::string type = from.text("type");
  const bool is_known = equalIgnoringCase(type, "orthographic") || equalIgnoringCase(type, "perspective");
  const bool is_orthographic = is_known ? equalIgnoringCase(type, "orthographic")
                                        : from.has("orthographic") && !from.has("perspective");
  const ObjectReader lens = from.object(is_orthographic ? "orthographic" : "perspective");
  return {.name = from.name(),
          .type = type,
          .orthographic = is_orthographic,
          .ymag = lens.optionalNumber("ymag"),
          .yfov = lens.optionalNumber("yfov"),
          .near = lens.optionalNumber("znear"),
          .far = lens.optionalNumber("zfar")};
}

GltfLight parseLight(const ObjectReader& from) {
  const ObjectReader spot = from.object("spot");
  const GltfLight plain;
  return {.name = from.name(),
          .type = from.text("type"),
          .color = from.numbers("color"),
          .intensity = from.number("intensity", plain.intensity),
          .inner_cone = spot.number("innerConeAngle", plain.inner_cone),
          .outer_cone = spot.number("outerConeAngle", plain.outer_cone),
          .range = from.optionalNumber("range"),
          .group = from.group()};
}

void parseFile(const ObjectReader& root, GltfFile& file) {
  const auto list = [&](const ObjectReader& owner, const char* name, auto& all, const auto& read) {
    owner.each(name, [&](const ObjectReader& from) { all.push_back(read(from)); });
  };
  file.version = root.object("asset").text("version");
  file.extensions_used = root.texts("extensionsUsed");
  file.extensions_required = root.texts("extensionsRequired");
  list(root, "buffers", file.buffers, [](const ObjectReader& from) {
    GltfBuffer buffer{.uri = {}, .length = from.size("byteLength"), .bytes = {}};
    if (from.has("uri")) buffer.uri = from.text("uri");
    return buffer;
  });
  list(root, "bufferViews", file.views, [](const ObjectReader& from) {
    return GltfView{from.index("buffer"), from.size("byteOffset"), from.size("byteLength"),
                    from.size("byteStride"), from.extensions()};
  });
  list(root, "accessors", file.accessors, parseAccessor);
  list(root, "images", file.images, parseImage);
  list(root.object("extensions").object("EXT_lights_ies"), "lights", file.profiles, parseImage);
  list(root, "samplers", file.samplers, [](const ObjectReader& from) {
    return GltfSampler{from.optionalNumber("wrapS"), from.optionalNumber("wrapT"),
                       from.optionalNumber("magFilter"), from.optionalNumber("minFilter")};
  });
  list(root, "textures", file.textures, [](const ObjectReader& from) {
    return GltfTexture{from.index("sampler"), from.index("source"),
                       from.object("extensions").object("EXT_texture_webp").index("source"),
                       from.extensions()};
  });
  list(root, "materials", file.materials, parseMaterial);
  list(root, "meshes", file.meshes, parseMesh);
  list(root, "nodes", file.nodes, parseNode);
  list(root, "skins", file.skins, [](const ObjectReader& from) {
    return GltfSkinEntry{from.indices("joints"), from.index("inverseBindMatrices")};
  });
  list(root, "animations", file.animations, parseAnimationEntry);
  list(root, "cameras", file.cameras, parseCamera);
  list(root.object("extensions").object("KHR_lights_punctual"), "lights", file.lights, parseLight);
  list(root, "scenes", file.scenes, [](const ObjectReader& from) { return from.indices("nodes"); });
  file.scene = root.index("scene");
  file.extensions = root.extensions();
}

/// Throws InputError for JSON nested so deep that copying or comparing it, which recurses, would overflow the
/// stack.
void checkNesting(const GltfModel& model, std::string_view json) {
  constexpr int kDeepest = 500;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '"') in_string = !in_string;
    if (in_string) {
      if (c == '\\') ++i;
    } else if (c == '{' || c == '[') {
      if (++depth > kDeepest)
        throw InputError(fmt::format("{}: JSON nested deeper than {}", model.path, kDeepest));
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

/// What the parser says is wrong without its own name and number.
std::string parserWords(const std::exception& error) {
  const std::string words = error.what();
  const std::size_t end = words.find("] ");
  return forMessage(end == std::string::npos ? words : words.substr(end + 2));
}

/// The UTF-16 unit of an escape \uXXXX that `text` has at a place; 0: there is none.
std::uint32_t unitAt(std::string_view text, std::size_t place) {
  std::uint32_t unit = 0;
  if (text.substr(place, 2) != "\\u" || text.size() < place + 6) return 0;
  const char* const first = text.data() + place + 2;
  return std::from_chars(first, first + 4, unit, 16).ptr == first + 4 ? unit : 0;
}

/// The text with each escape of half a pair of UTF-16 units, which is no letter, as one: the Latin-1 letter
/// of a byte that Python wrote so, else U+FFFD.
std::string withoutHalfPairs(std::string text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\') continue;
    const std::uint32_t unit = unitAt(text, i), next = unit == 0 ? 0 : unitAt(text, i + 6);
    const bool is_first = unit >= 0xd800 && unit < 0xdc00, is_second = unit >= 0xdc00 && unit < 0xe000;
    if (is_first && next >= 0xdc00 && next < 0xe000)
      i += 6;
    else if (unit >= 0xdc80 && unit < 0xdd00)
      text.replace(i + 2, 2, "00");
    else if (is_first || is_second)
      text.replace(i + 2, 4, "fffd");
    ++i;  // what is escaped may be a backslash
  }
  return text;
}

GltfJson parseJson(std::string_view text, const GltfModel& model) {
  try {
    return GltfJson::parse(text);
  } catch (const GltfJson::exception& error) {
    const std::string valid = withoutHalfPairs(utf8Of(text));
    if (valid == text)
      throw InputError(fmt::format("{}: is not valid JSON: {}", model.path, parserWords(error)));
    try {
      GltfJson json = GltfJson::parse(valid);
      warnRepaired(model, "its JSON",
                   isUtf8(text) ? "has escapes of half a letter; taken for Latin-1 or U+FFFD"
                                : "is not UTF-8; other bytes are taken for Latin-1",
                   "text");
      return json;
    } catch (const GltfJson::exception& second) {
      throw InputError(fmt::format("{}: is not valid JSON: {}", model.path, parserWords(second)));
    }
  }
}

}  // namespace

void parseGltf(std::string_view text, GltfModel& model) {
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos) {
    if (text.find_first_not_of(std::string_view("\0 \t\r\n", 5), zero) != std::string_view::npos)
      throw InputError(
          fmt::format("{}: is not valid JSON: byte {} is 0, expected UTF-8", model.path, zero + 1));
    warnRepaired(model, "its JSON", fmt::format("ends in {} zeros, expected blanks", text.size() - zero),
                 "zeros");
    text = text.substr(0, zero);
  }
  checkNesting(model, text);
  GltfJson json = parseJson(text, model);
  parseFile(ObjectReader(model, json), model.file);
}

std::size_t gltfComponentSize(int type) {
  switch (type) {
    case kGltfByte:
    case kGltfUnsignedByte:
      return 1;
    case kGltfShort:
    case kGltfUnsignedShort:
      return 2;
    case kGltfUnsignedInt:
    case kGltfFloat:
      return 4;
    default:
      return 0;
  }
}

}  // namespace luciole
