#include "scene/gltf/gltf_fit.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>

namespace luciole {
namespace {

constexpr std::size_t kGlbHeader = 20;  // of a GLB and its first chunk

std::uint32_t wordAt(const std::string& bytes, std::size_t place) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word |= std::uint32_t{static_cast<unsigned char>(bytes[place + i])} << 8 * i;
  return word;
}

void setWord(std::size_t place, std::uint32_t word, std::string& bytes) {
  for (std::size_t i = 0; i < 4; ++i) bytes[place + i] = static_cast<char>(word >> 8 * i & 0xff);
}

/// Calls visit(object) for each object of a list that is a member; for none where there is no such list.
template <typename Visit>
void eachObject(nlohmann::json& owner, const char* list, const Visit& visit) {
  if (!owner.is_object() || !owner.contains(list) || !owner[list].is_array()) return;
  for (nlohmann::json& object : owner[list])
    if (object.is_object()) visit(object);
}

/// Gives the accessors of a primitive that Draco compresses its data's buffer view, unless they have one.
/// Returns whether there are any such.
bool fitDraco(nlohmann::json& primitive, nlohmann::json& accessors) {
  static const nlohmann::json::json_pointer kView("/extensions/KHR_draco_mesh_compression/bufferView");
  if (!primitive.contains(kView) || !accessors.is_array()) return false;
  bool changed = false;
  const auto fit = [&](const nlohmann::json& number) {
    const std::size_t index = number.is_number_unsigned() ? number.get<std::size_t>() : accessors.size();
    if (index >= accessors.size() || !accessors[index].is_object()) return;
    changed = accessors[index].emplace("bufferView", primitive[kView]).second || changed;
  };
  if (primitive.contains("indices")) fit(primitive["indices"]);
  if (primitive.contains("attributes") && primitive["attributes"].is_object())
    for (const nlohmann::json& number : primitive["attributes"]) fit(number);
  return changed;
}

/// Changes the file, and returns whether it did.
bool fit(nlohmann::json& file) {
  static const nlohmann::json::json_pointer kFallback("/extensions/EXT_meshopt_compression/fallback"),
      kNode("/target/node");
  bool changed = false;
  eachObject(file, "buffers", [&](nlohmann::json& buffer) {
    if (buffer.contains("uri") || buffer.value(kFallback, nlohmann::json()) != nlohmann::json(true)) return;
    buffer["uri"] = "data:application/octet-stream;base64,AA==";
    buffer["byteLength"] = 1;
    changed = true;
  });
  eachObject(file, "meshes", [&](nlohmann::json& mesh) {
    eachObject(mesh, "primitives", [&](nlohmann::json& primitive) {
      if (file.contains("accessors")) changed = fitDraco(primitive, file["accessors"]) || changed;
    });
  });
  eachObject(file, "skins", [&](nlohmann::json& skin) {
    changed = changed || !skin.contains("inverseBindMatrices");
    skin.emplace("inverseBindMatrices", -1);
  });
  eachObject(file, "animations", [&](nlohmann::json& animation) {
    if (!animation.contains("channels") || !animation["channels"].is_array()) return;
    nlohmann::json kept = nlohmann::json::array();
    for (nlohmann::json& channel : animation["channels"])
      if (!channel.is_object() || !channel.contains("target") || channel.contains(kNode))
        kept.push_back(channel);
    changed = changed || kept.size() != animation["channels"].size();
    animation["channels"] = std::move(kept);
  });
  return changed;
}

bool mayNeedIt(std::string_view bytes) {
  for (const char* what :
       {"EXT_meshopt_compression", "KHR_draco_mesh_compression", "\"skins\"", "KHR_animation_pointer"})
    if (bytes.find(what) != std::string_view::npos) return true;
  return false;
}

}  // namespace

std::string fitForTinygltf(std::string bytes) {
  if (!mayNeedIt(bytes)) return bytes;
  const bool is_binary = bytes.starts_with("glTF");
  std::size_t begin = 0, end = bytes.size();
  if (is_binary) {
    if (bytes.size() < kGlbHeader || wordAt(bytes, 12) > bytes.size() - kGlbHeader) return bytes;
    begin = kGlbHeader;
    end = kGlbHeader + wordAt(bytes, 12);
  }
  const auto place = [&](std::size_t byte) { return bytes.begin() + static_cast<std::ptrdiff_t>(byte); };
  nlohmann::json file = nlohmann::json::parse(place(begin), place(end), nullptr, false);
  if (file.is_discarded() || !fit(file)) return bytes;
  std::string text = file.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (!is_binary) return text;
  text.append((4 - text.size() % 4) % 4, ' ');
  bytes.replace(begin, end - begin, text);
  setWord(8, static_cast<std::uint32_t>(wordAt(bytes, 8) + text.size() - (end - begin)), bytes);
  setWord(12, static_cast<std::uint32_t>(text.size()), bytes);
  return bytes;
}

}  // namespace luciole
