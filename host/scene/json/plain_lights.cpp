#include "scene/json/plain_lights.hpp"

#include <simdjson.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <iterator>
#include <span>
#include <string_view>

#include "scene/json/json_fields.hpp"

namespace luciole {
namespace {

namespace ondemand = simdjson::ondemand;

constexpr std::size_t kLongText = 1 << 20;
/// Bytes of text that a thread reads at a time: they stay in its cache, and so does the parser's index.
constexpr std::size_t kPieceBytes = 256 << 10;

/// Where a piece of an array ends: the place of a comma, or of the bracket at the end; and how many elements
/// there are up to it.
struct Cut {
  std::size_t place, elements;
};

/// An array of a text, in pieces.
struct LightArray {
  std::size_t open;  ///< the place of its bracket
  std::vector<Cut> cuts = {};
};

/// The place of the next character of `text` that gives JSON its structure, from `place` on; the text's size
/// if there is none.
std::size_t findStructure(std::string_view text, std::size_t place) {
  static constexpr auto kStructure = [] {
    std::array<bool, 256> table{};
    for (const char c : std::string_view("{}[],\"")) table[static_cast<unsigned char>(c)] = true;
    return table;
  }();
  while (place < text.size() && !kStructure[static_cast<unsigned char>(text[place])]) ++place;
  return place;
}

/// Finds the array of the member "lights" of the text's object. Empty if there is none, or if brackets are
/// seen not to match.
std::optional<LightArray> findLights(std::string_view text) {
  constexpr std::string_view kKey = "lights";
  std::optional<LightArray> array;
  int depth = 0, depth_inside = 0;
  bool is_key = false;  // "lights" of the text's object was read, and after it nothing but a colon and blanks
  std::size_t piece = 0, elements = 1;
  for (std::size_t i = findStructure(text, 0); i < text.size(); i = findStructure(text, i + 1)) {
    const char c = text[i];
    if (c == '"') {
      const std::size_t begin = i + 1;
      for (i = text.find('"', begin); i < text.size() && text[i - 1] == '\\'; i = text.find('"', i + 1)) {
        std::size_t slashes = 1;
        while (slashes < i - begin && text[i - 1 - slashes] == '\\') ++slashes;
        if (slashes % 2 == 0) break;  // which stand for themselves
      }
      if (i == std::string_view::npos) return std::nullopt;
      is_key = depth == 1 && text.substr(begin, i - begin) == kKey;
    } else if (c == '{' || c == '[') {
      ++depth;
      if (is_key && c == '[' && !array) {
        array = {i};
        depth_inside = depth;
        piece = i;
      }
      is_key = false;
    } else if (c == ',') {
      is_key = false;
      if (!array || depth != depth_inside) continue;
      if (i - piece >= kPieceBytes) {
        array->cuts.push_back({i, elements});
        piece = i;
      }
      ++elements;
    } else {
      if (array && depth == depth_inside) {
        array->cuts.push_back({i, elements});
        return c == ']' ? array : std::nullopt;
      }
      --depth;
    }
  }
  return std::nullopt;
}

/// What these throw where a light is none that is plain.
struct NotPlain {};

double plainNumber(ondemand::value value, double low, double high = kLargestNumber) {
  const double number = value.get_double();
  if (!(number >= low && number <= high)) throw NotPlain();
  return number;
}

template <class Vector>
Vector plainVector(ondemand::value value, double low) {
  Vector vector(0);
  int i = 0;
  for (ondemand::value one : value.get_array()) {
    if (i == 3) throw NotPlain();
    vector[i++] = typename Vector::value_type(plainNumber(one, low));
  }
  if (i != 3) throw NotPlain();
  return vector;
}

glm::vec3 plainColor(ondemand::value value) {
  const ondemand::json_type type = value.type();
  if (type == ondemand::json_type::array) return plainVector<glm::vec3>(value, 0);
  return glm::vec3(float(plainNumber(value, 0)));
}

enum class PlainMember : unsigned {
  kType,
  kPosition,
  kColor,
  kDiffuse,
  kSpecular,
  kAmbient,
  kIntensity,
  kAttenuation,
  kRange,
  kRadius,
  kShadow
};
constexpr std::string_view kPlainMembers[]{"type",     "position", "color",     "diffuse",
                                           "specular", "ambient",  "intensity", "attenuation",
                                           "range",    "radius",   "shadow"};

Light readPlain(ondemand::object object) {
  Light light;
  glm::vec3 color(1.0f), diffuse(0.0f), specular(0.0f);
  float intensity = 1;
  unsigned seen = 0;
  for (auto field : object) {
    const std::string_view key = field.unescaped_key();
    const auto member =
        unsigned(std::find(std::begin(kPlainMembers), std::end(kPlainMembers), key) - kPlainMembers);
    if (member == std::size(kPlainMembers) || (seen >> member & 1)) throw NotPlain();
    seen |= 1u << member;
    ondemand::value value = field.value();
    switch (PlainMember(member)) {
      case PlainMember::kType:
        if (std::string_view(value.get_string()) != "point") throw NotPlain();
        break;
      case PlainMember::kPosition:
        light.position = plainVector<glm::dvec3>(value, -kLargestNumber);
        break;
      case PlainMember::kColor:
        color = plainColor(value);
        break;
      case PlainMember::kDiffuse:
        diffuse = plainColor(value);
        break;
      case PlainMember::kSpecular:
        specular = plainColor(value);
        break;
      case PlainMember::kAmbient:
        light.ambient = plainColor(value);
        break;
      case PlainMember::kIntensity:
        intensity = float(plainNumber(value, 0));
        break;
      case PlainMember::kAttenuation:
        light.attenuation = plainVector<glm::vec3>(value, 0);
        if (light.attenuation == glm::vec3(0)) throw NotPlain();
        break;
      case PlainMember::kRange:
        light.range = float(plainNumber(value, 1 / kLargestNumber));
        break;
      case PlainMember::kRadius:
        light.radius = plainNumber(value, 0);
        break;
      case PlainMember::kShadow:
        light.shadow = value.get_bool();
        break;
    }
  }
  const auto has = [&](PlainMember member) { return (seen >> unsigned(member) & 1) != 0; };
  if (!has(PlainMember::kType) || !has(PlainMember::kPosition)) throw NotPlain();
  light.ambient *= intensity;
  light.diffuse = (has(PlainMember::kDiffuse) ? diffuse : color) * intensity;
  light.specular = (has(PlainMember::kSpecular) ? specular : color) * intensity;
  return light;
}

/// Reads elements of an array, with the commas between them: as many as `lights` has. Throws NotPlain or
/// simdjson_error if anything is wrong.
void readPiece(std::string_view elements, std::span<Light> lights) {
  simdjson::padded_string text(elements.size() + 2);
  text.data()[0] = '[';
  std::copy(elements.begin(), elements.end(), text.data() + 1);
  text.data()[elements.size() + 1] = ']';
  ondemand::parser parser;
  ondemand::document document = parser.iterate(text);
  std::size_t count = 0;
  for (ondemand::value one : document.get_array()) {
    if (count == lights.size()) throw NotPlain();
    lights[count++] = readPlain(one.get_object());
  }
  // Nothing follows the array: a bracket that closed it would have been findLights()'s.
  if (count != lights.size()) throw NotPlain();
}

}  // namespace

std::optional<PlainLights> readPlainLights(const std::string& text) {
  if (text.size() < kLongText) return std::nullopt;
  const std::optional<LightArray> array = findLights(text);
  if (!array || array->cuts.back().place - array->open < kLongText) return std::nullopt;
  PlainLights read;
  read.lights.resize(array->cuts.back().elements);
  std::atomic<bool> are_plain = true;
  tbb::parallel_for(std::size_t(0), array->cuts.size(), [&](std::size_t i) {
    if (!are_plain) return;
    const Cut before = i == 0 ? Cut{array->open, 0} : array->cuts[i - 1], end = array->cuts[i];
    try {
      readPiece(std::string_view(text).substr(before.place + 1, end.place - before.place - 1),
                std::span(read.lights).subspan(before.elements, end.elements - before.elements));
    } catch (const NotPlain&) {
      are_plain = false;
    } catch (const simdjson::simdjson_error&) {
      are_plain = false;
    }
  });
  if (!are_plain) return std::nullopt;
  read.rest.assign(text, 0, array->open + 1);
  read.rest.append(text, array->cuts.back().place);
  return read;
}

}  // namespace luciole
