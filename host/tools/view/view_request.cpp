#include "tools/view/view_request.hpp"

#include "tools/view/view_json.hpp"

namespace luciole {
namespace {

using Json = nlohmann::json;

constexpr int kLargestViewSide = 8192;
constexpr std::size_t kMostChanges = 4096;

std::vector<std::string> textsIn(const Json& json, const std::string& name) {
  std::vector<std::string> texts;
  if (json.is_null()) return texts;
  if (!json.is_array() || json.size() > kMostChanges) refuseMember(name);
  for (const Json& one : json) texts.push_back(textIn(one, name));
  return texts;
}

glm::ivec2 sizeIn(const Json& json, const std::string& name) {
  if (!json.is_array() || json.size() != 2) refuseMember(name);
  glm::ivec2 size;
  for (int i = 0; i < 2; ++i) size[i] = int(numberIn(json[std::size_t(i)], 1, kLargestViewSide, name));
  return size;
}

SceneChanges changesIn(const Json& view) {
  SceneChanges read;
  read.changes = textsIn(memberIn(view, "changes"), "changes");
  if (const Json& options = memberIn(view, "options"); !options.is_null()) {
    if (!options.is_object()) refuseMember("options");
    for (const auto& [name, value] : options.items()) read.options[name] = textIn(value, "options." + name);
  }
  if (const Json& shaders = memberIn(view, "shaders"); !shaders.is_null()) {
    if (!shaders.is_object()) refuseMember("shaders");
    read.shaders = {textIn(memberIn(shaders, "model"), "shaders.model"),
                    textIn(memberIn(shaders, "surface"), "shaders.surface"),
                    textIn(memberIn(shaders, "screen"), "shaders.screen")};
  }
  return read;
}

}  // namespace

ViewRequest readRequest(const std::string& body) {
  const Json json = requestIn(body);
  ViewRequest request;
  request.page = textIn(memberIn(json, "page"), "page").substr(0, 64);
  if (const Json& number = memberIn(json, "number"); !number.is_null())
    request.number = std::uint64_t(numberIn(number, 0, 1e15, "number"));
  if (const Json& view = memberIn(json, "view"); !view.is_null()) {
    if (!view.is_object()) refuseMember("view");
    request.camera = memberIn(view, "camera");
    request.changes = changesIn(view);
  }
  request.gesture = memberIn(json, "gesture");
  if (const Json& size = memberIn(json, "size"); !size.is_null()) request.size = sizeIn(size, "size");
  // `moving` is null at rest; a motion's first frame has seen none.
  if (const auto moving = json.find("moving"); moving != json.end() && !moving->is_null()) {
    request.is_moving = true;
    if (moving->is_object())
      request.seen = {numberIn(memberIn(*moving, "milliseconds"), 0, 1e9, "moving.milliseconds"),
                      sizeIn(memberIn(*moving, "size"), "moving.size")};
    else if (!moving->is_boolean())
      refuseMember("moving");
  }
  if (const Json& samples = memberIn(json, "samples"); !samples.is_null())
    request.samples = int(numberIn(samples, 1, 1024, "samples"));
  if (const Json& layer = memberIn(json, "layer"); !layer.is_null()) request.layer = textIn(layer, "layer");
  if (const Json& light = memberIn(json, "light"); !light.is_null())
    request.light = std::uint32_t(numberIn(light, 0, 4e9, "light"));
  if (const Json& at = memberIn(json, "at"); !at.is_null()) {
    if (!at.is_array() || at.size() != 2) refuseMember("at");
    request.at = {numberIn(at[0], 0, 1, "at"), numberIn(at[1], 0, 1, "at")};
  }
  request.outputs = textsIn(memberIn(json, "what"), "what");
  return request;
}

}  // namespace luciole
