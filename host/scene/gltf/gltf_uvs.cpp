#include "scene/gltf/gltf_uvs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "scene/gltf/gltf_material.hpp"

namespace luciole {
namespace {

constexpr const char* kTransform = "KHR_texture_transform";

glm::dvec2 readPair(const GltfModel& model, const tinygltf::Value& transform, const char* member,
                    const glm::dvec2& otherwise, const std::string& place) {
  if (!transform.Has(member)) return otherwise;
  const tinygltf::Value& value = transform.Get(member);
  glm::dvec2 pair;
  for (int i = 0; i < 2; ++i) {
    if (!value.IsArray() || value.ArrayLen() != 2 || !value.Get(i).IsNumber())
      failGltf(model, place, fmt::format("{} must be 2 numbers", member));
    pair[i] = value.Get(i).GetNumberAsDouble();
  }
  return pair;
}

/// The specification's matrix is offset · rotation · scale. Its "counter-clockwise" holds for v growing
/// downwards, as its example of a picture's lower left quadrant and its test model show. The shader in the
/// specification turns the other way (github.com/KhronosGroup/glTF/issues/1563).
template <class Info>
GltfUvs readUvs(const GltfModel& model, const Info& texture, const std::string& place) {
  GltfUvs uvs;
  if (texture.index < 0) return uvs;
  uvs.set = texture.texCoord;
  const auto found = texture.extensions.find(kTransform);
  if (found != texture.extensions.end() && found->second.IsObject()) {
    const std::string here = fmt::format("{}.{}", place, kTransform);
    const double angle = extensionNumber(texture.extensions, kTransform, "rotation", 0.0);
    const glm::dvec2 scale = readPair(model, found->second, "scale", glm::dvec2(1), here);
    const double cosine = std::cos(angle), sine = std::sin(angle);
    uvs.matrix = {scale.x * glm::dvec2(cosine, -sine), scale.y * glm::dvec2(sine, cosine)};
    uvs.offset = readPair(model, found->second, "offset", glm::dvec2(0), here);
    const double set = extensionNumber(texture.extensions, kTransform, "texCoord", uvs.set);
    uvs.set = set >= 0 && set < 1e9 ? static_cast<int>(set) : -1;
  }
  if (uvs.set < 0) failGltf(model, place, "texCoord is negative or too large");
  return uvs;
}

}  // namespace

GltfUvs baseColorUvs(const GltfModel& model, int material) {
  return readUvs(model, gltfMaterial(model, material).pbrMetallicRoughness.baseColorTexture,
                 gltfMaterialPlace(material) + ".baseColorTexture");
}

GltfUvs emissionUvs(const GltfModel& model, int material) {
  if (isUnlit(gltfMaterial(model, material))) return baseColorUvs(model, material);
  return readUvs(model, gltfMaterial(model, material).emissiveTexture,
                 gltfMaterialPlace(material) + ".emissiveTexture");
}

GltfUvs normalUvs(const GltfModel& model, int material) {
  return readUvs(model, gltfMaterial(model, material).normalTexture,
                 gltfMaterialPlace(material) + ".normalTexture");
}

}  // namespace luciole
