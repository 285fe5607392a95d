#include "tools/bake/write_baked.hpp"

#include <utility>

#include "scene/gltf/write_gltf.hpp"

namespace luciole {

void writeBakedGltf(const Scene& scene, const Object& object, std::vector<glm::vec2> uvs,
                    const std::string& png, float strength, const std::string& path) {
  using Json = nlohmann::ordered_json;
  const Mesh& mesh = scene.meshes[object.mesh];
  GltfDocument document;
  Json& root = document.root;
  root["asset"] = {{"version", "2.0"}, {"generator", "Luciole " LUCIOLE_VERSION}};
  root["extensionsUsed"] = Json::array({"KHR_materials_emissive_strength"});
  root["scene"] = 0;
  root["scenes"].push_back({{"nodes", Json::array({0})}});
  Json primitive = addTriangles({mesh.positions, mesh.normals, std::move(uvs), mesh.triangles}, document);
  primitive["material"] = 0;
  root["meshes"].push_back({{"primitives", Json::array({primitive})}});
  Json material;
  material["name"] = "baked light";
  material["pbrMetallicRoughness"] = {{"baseColorFactor", Json::array({0, 0, 0, 1})}, {"metallicFactor", 0}};
  material["emissiveFactor"] = Json::array({1, 1, 1});
  material["emissiveTexture"] = {{"index", addPngTexture(png, document)}};
  material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
  root["materials"].push_back(std::move(material));

  Json node;
  if (!object.name.empty()) node["name"] = object.name;
  node["mesh"] = 0;
  for (int i = 0; i < 16 && object.object_to_world != glm::dmat4(1); ++i)
    node["matrix"].push_back(object.object_to_world[i / 4][i % 4]);
  addNode(node.dump(), document);
  writeGltf(std::move(document), path);
}

}  // namespace luciole
