#include "scene/gltf/write_baked.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "base/write_file.hpp"

namespace luciole {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "glTF's buffers are little endian");

// The specification's numbers.
constexpr int kFloat = 5126, kUnsignedInt = 5125, kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr int kLinear = 9729, kTrilinear = 9987, kClamp = 33071;
constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

/// Appends bytes, each run from a multiple of 4 on, and lists the views of them.
struct Buffer {
  std::string bytes;
  json views = json::array(), accessors = json::array();

  int addView(std::string_view run, int target) {
    views.push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", run.size()}});
    if (target != 0) views.back()["target"] = target;
    bytes += run;
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    return int(views.size()) - 1;
  }
  template <class T>
  int add(const std::vector<T>& values, const char* type, int component, int target, std::size_t count) {
    const std::string_view run(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    const int view = addView(run, target);
    accessors.push_back(
        {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
    return int(accessors.size()) - 1;
  }
};

json numbers(const glm::vec3& v) { return json::array({v.x, v.y, v.z}); }

void appendChunk(std::uint32_t type, std::string data, char padding, std::string& file) {
  data.resize((data.size() + 3) / 4 * 4, padding);
  const std::uint32_t head[] = {std::uint32_t(data.size()), type};
  file.append(reinterpret_cast<const char*>(head), sizeof head);
  file += data;
}

}  // namespace

void writeBakedGltf(const Scene& scene, const Object& object, const std::vector<glm::vec2>& uvs,
                    const std::string& png, float strength, const std::string& path) {
  const Mesh& mesh = scene.meshes[object.mesh];
  Buffer buffer;
  const int positions = buffer.add(mesh.positions, "VEC3", kFloat, kArrayBuffer, mesh.positions.size());
  glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
  for (const glm::vec3& position : mesh.positions) {
    low = glm::min(low, position);
    high = glm::max(high, position);
  }
  buffer.accessors.back()["min"] = numbers(low);
  buffer.accessors.back()["max"] = numbers(high);
  const int normals = buffer.add(mesh.normals, "VEC3", kFloat, kArrayBuffer, mesh.normals.size());
  const int places = buffer.add(uvs, "VEC2", kFloat, kArrayBuffer, uvs.size());
  const int indices =
      buffer.add(mesh.triangles, "SCALAR", kUnsignedInt, kElementArrayBuffer, 3 * mesh.triangles.size());
  const int picture = buffer.addView(png, 0);

  json node;
  node["mesh"] = 0;
  if (!object.name.empty()) node["name"] = object.name;
  if (object.object_to_world != glm::dmat4(1)) {
    json& matrix = node["matrix"] = json::array();
    for (int i = 0; i < 16; ++i) matrix.push_back(object.object_to_world[i / 4][i % 4]);
  }
  json material;
  material["name"] = "baked light";
  material["pbrMetallicRoughness"] = {{"baseColorFactor", json::array({0, 0, 0, 1})}, {"metallicFactor", 0}};
  material["emissiveFactor"] = json::array({1, 1, 1});
  material["emissiveTexture"]["index"] = 0;
  material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
  const json primitive{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", places}}},
                       {"indices", indices},
                       {"material", 0}};
  json file;
  file["asset"] = {{"version", "2.0"}, {"generator", "Luciole " LUCIOLE_VERSION}};
  file["extensionsUsed"] = json::array({"KHR_materials_emissive_strength"});
  file["scene"] = 0;
  file["scenes"][0]["nodes"] = json::array({0});
  file["nodes"][0] = std::move(node);
  file["meshes"][0]["primitives"][0] = primitive;
  file["materials"][0] = std::move(material);
  file["textures"][0] = {{"source", 0}, {"sampler", 0}};
  file["samplers"][0] = {
      {"magFilter", kLinear}, {"minFilter", kTrilinear}, {"wrapS", kClamp}, {"wrapT", kClamp}};
  file["images"][0] = {{"bufferView", picture}, {"mimeType", "image/png"}};
  file["accessors"] = std::move(buffer.accessors);
  file["bufferViews"] = std::move(buffer.views);
  file["buffers"][0]["byteLength"] = buffer.bytes.size();

  std::string chunks;
  appendChunk(kJsonChunk, file.dump(), ' ', chunks);
  appendChunk(kBinaryChunk, std::move(buffer.bytes), '\0', chunks);
  if (chunks.size() + 12 > std::numeric_limits<std::uint32_t>::max())
    throw InputError(path + ": a .glb holds 4 GiB at most");
  const std::uint32_t head[] = {kMagic, 2, std::uint32_t(chunks.size() + 12)};
  writeTextFile(path, std::string(reinterpret_cast<const char*>(head), sizeof head) + chunks);
}

}  // namespace luciole
