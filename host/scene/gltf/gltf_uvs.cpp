#include "scene/gltf/gltf_uvs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "scene/gltf/gltf_material.hpp"

namespace luciole {
namespace {

constexpr const char* kTransform = "KHR_texture_transform";

glm::dvec2 readPair(const GltfModel& model, const GltfJson& transform, const char* member,
                    const glm::dvec2& otherwise, const std::string& place) {
  const GltfJson& value = memberOf(transform, member);
  if (value.is_null()) return otherwise;
  glm::dvec2 pair;
  for (int i = 0; i < 2; ++i) {
    if (!value.is_array() || value.size() != 2 || !value[std::size_t(i)].is_number())
      failGltf(model, place, fmt::format("{} must be 2 numbers", member));
    pair[i] = value[std::size_t(i)].get<double>();
  }
  return pair;
}

/// The specification's matrix is offset · rotation · scale. Its "counter-clockwise" holds for v growing
/// downwards, as its example of a picture's lower left quadrant and its test model show. The shader in the
/// specification turns the other way (github.com/KhronosGroup/glTF/issues/1563).
GltfUvs readUvs(const GltfModel& model, const GltfTextureInfo& texture, const std::string& place) {
  GltfUvs uvs;
  if (texture.texture < 0) return uvs;
  uvs.set = texture.uv_set;
  const GltfJson& transform = memberOf(texture.extensions, kTransform);
  if (transform.is_object()) {
    const std::string here = fmt::format("{}.{}", place, kTransform);
    const double angle = extensionNumber(texture.extensions, kTransform, "rotation", 0.0);
    const glm::dvec2 scale = readPair(model, transform, "scale", glm::dvec2(1), here);
    const double cosine = std::cos(angle), sine = std::sin(angle);
    uvs.matrix = {scale.x * glm::dvec2(cosine, -sine), scale.y * glm::dvec2(sine, cosine)};
    uvs.offset = readPair(model, transform, "offset", glm::dvec2(0), here);
    const double set = extensionNumber(texture.extensions, kTransform, "texCoord", uvs.set);
    uvs.set = set >= 0 && set < 1e9 ? static_cast<int>(set) : -1;
  }
  if (uvs.set < 0) failGltf(model, place, "texCoord is negative or too large");
  return uvs;
}

}  // namespace

GltfUvs baseColorUvs(const GltfModel& model, int material) {
  return readUvs(model, baseTexture(model, material), gltfMaterialPlace(material) + ".baseColorTexture");
}

GltfUvs emissionUvs(const GltfModel& model, int material) {
  if (isUnlit(gltfMaterial(model, material))) return baseColorUvs(model, material);
  return readUvs(model, gltfMaterial(model, material).emissive,
                 gltfMaterialPlace(material) + ".emissiveTexture");
}

GltfUvs normalUvs(const GltfModel& model, int material) {
  return readUvs(model, gltfMaterial(model, material).normal, gltfMaterialPlace(material) + ".normalTexture");
}

}  // namespace luciole
