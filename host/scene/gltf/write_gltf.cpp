#include "scene/gltf/write_gltf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <span>

#include "base/write_file.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126, kVertices = 34962, kIndices = 34963;
constexpr int kLinear = 9729, kTrilinear = 9987, kClampToEdge = 33071;

void addWord(std::uint32_t word, std::string& bytes) {
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(word >> 8 * i & 0xff);
}

void align(char filler, std::string& bytes) { bytes.append((4 - bytes.size() % 4) % 4, filler); }

/// Appends elements of `size` bytes, all aligned to 4, and an accessor of them. Returns the accessor.
int addAccessor(const std::string& elements, std::size_t count, const char* type, int component_type,
                int target, GltfDocument& document) {
  // A new member moves the others, so one reference to them at a time.
  Json& views = document.root["bufferViews"];
  const std::size_t view = views.size();
  views.push_back({{"buffer", 0},
                   {"byteOffset", document.bytes.size()},
                   {"byteLength", elements.size()},
                   {"target", target}});
  document.bytes += elements;
  align('\0', document.bytes);
  Json& accessors = document.root["accessors"];
  accessors.push_back(
      {{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}});
  return static_cast<int>(accessors.size()) - 1;
}

template <class Vector>
std::string floatsOf(const std::vector<Vector>& vectors) {
  std::string bytes;
  for (const Vector& vector : vectors) {
    for (int i = 0; i < Vector::length(); ++i) {
      std::uint32_t word = 0;
      std::memcpy(&word, &vector[i], 4);
      addWord(word, bytes);
    }
  }
  return bytes;
}

Json numbersOf(const glm::vec3& v) { return {v.x, v.y, v.z}; }

/// A file's name as a URI has it: what might mean something else there is escaped.
std::string uriOf(const std::string& name) {
  std::string uri;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || std::strchr("-._~", c))
      uri += c;
    else
      uri += fmt::format("%{:02X}", byte);
  }
  return uri;
}

std::string jsonText(const GltfDocument& document) {
  std::string text = document.root.dump();
  text.pop_back();
  text += ",\"nodes\":[" + document.nodes + "]}";
  return text;
}

std::string extensionOf(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

double millimetres(double metres) { return std::round(1000 * metres) / 1000; }

int addNode(const std::string& json, GltfDocument& document) {
  if (document.node_count > 0) document.nodes += ',';
  document.nodes += json;
  return document.node_count++;
}

Json addTriangles(const GltfTriangles& triangles, GltfDocument& document) {
  glm::vec3 low = triangles.positions.front(), high = low;
  for (const glm::vec3& position : triangles.positions) {
    low = glm::min(low, position);
    high = glm::max(high, position);
  }
  const std::size_t count = triangles.positions.size();
  const bool is_short = count <= 65535;
  std::string indices;
  for (const glm::uvec3& corners : triangles.corners) {
    for (int i = 0; i < 3; ++i)
      for (int byte = 0; byte < (is_short ? 2 : 4); ++byte)
        indices += static_cast<char>(corners[i] >> 8 * byte & 0xff);
  }
  const int position = addAccessor(floatsOf(triangles.positions), count, "VEC3", kFloat, kVertices, document);
  document.root["accessors"][static_cast<std::size_t>(position)].update(
      {{"min", numbersOf(low)}, {"max", numbersOf(high)}});
  const int normal = addAccessor(floatsOf(triangles.normals), count, "VEC3", kFloat, kVertices, document);
  const int index = addAccessor(indices, 3 * triangles.corners.size(), "SCALAR",
                                is_short ? kUnsignedShort : kUnsignedInt, kIndices, document);
  Json primitive{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}, {"indices", index}};
  if (!triangles.uvs.empty())
    primitive["attributes"]["TEXCOORD_0"] =
        addAccessor(floatsOf(triangles.uvs), count, "VEC2", kFloat, kVertices, document);
  return primitive;
}

int addPngTexture(const std::string& png, GltfDocument& document) {
  Json& root = document.root;
  root["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", document.bytes.size()}, {"byteLength", png.size()}});
  document.bytes += png;
  align('\0', document.bytes);
  root["images"].push_back({{"bufferView", root["bufferViews"].size() - 1}, {"mimeType", "image/png"}});
  root["samplers"].push_back(
      {{"magFilter", kLinear}, {"minFilter", kTrilinear}, {"wrapS", kClampToEdge}, {"wrapT", kClampToEdge}});
  root["textures"].push_back(
      {{"sampler", root["samplers"].size() - 1}, {"source", root["images"].size() - 1}});
  return static_cast<int>(root["textures"].size()) - 1;
}

void checkGltfPath(const std::string& path) {
  if (path == "-" || extensionOf(path) == ".glb" || extensionOf(path) == ".gltf") return;
  throw InputError(fmt::format("{}: expected a name that ends in .glb or .gltf", path));
}

void writeGltf(GltfDocument document, const std::string& path) {
  checkGltfPath(path);
  Json buffer{{"byteLength", document.bytes.size()}};
  const bool is_binary = extensionOf(path) != ".gltf";
  if (!is_binary) {
    const std::filesystem::path beside = std::filesystem::path(path).replace_extension(".bin");
    buffer["uri"] = uriOf(beside.filename().string());
    document.root["buffers"].push_back(std::move(buffer));
    writeTextFile(beside.string(), document.bytes);
    writeTextFile(path, jsonText(document) + "\n");
    return;
  }
  document.root["buffers"].push_back(std::move(buffer));
  std::string json = jsonText(document);
  align(' ', json);
  const std::size_t size = 12 + 8 + json.size() + 8 + document.bytes.size();
  if (size > std::numeric_limits<std::uint32_t>::max())
    throw InputError(path + ": a .glb holds 4 GiB at most");
  std::string glb = "glTF";
  glb.reserve(size);
  addWord(2, glb);
  addWord(static_cast<std::uint32_t>(size), glb);
  addWord(static_cast<std::uint32_t>(json.size()), glb);
  glb += "JSON" + json;
  addWord(static_cast<std::uint32_t>(document.bytes.size()), glb);
  glb += std::string("BIN\0", 4) + document.bytes;
  writeTextFile(path, glb);
}

}  // namespace luciole
