#include "scene/gltf/gltf_uvs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "scene/gltf/gltf_material.hpp"

namespace luciole {
namespace {

glm::dvec2 pairOf(const GltfModel& model, const std::vector<double>& numbers, const char* member,
                  const glm::dvec2& otherwise, const std::string& place) {
  if (numbers.empty()) return otherwise;
  if (numbers.size() != 2)
    failGltf(model, place + ".KHR_texture_transform", fmt::format("{} must be 2 numbers", member));
  return {numbers[0], numbers[1]};
}

/// The specification's matrix is offset · rotation · scale. Its "counter-clockwise" holds for v growing
/// downwards, as its example of a picture's lower left quadrant and its test model show. The shader in the
/// specification turns the other way (github.com/KhronosGroup/glTF/issues/1563).
GltfUvs readUvs(const GltfModel& model, const GltfTextureInfo& texture, const std::string& place) {
  GltfUvs uvs;
  if (texture.texture < 0) return uvs;
  uvs.set = texture.uv_set;
  const glm::dvec2 scale = pairOf(model, texture.uv_scale, "scale", glm::dvec2(1), place);
  const double cosine = std::cos(texture.uv_rotation), sine = std::sin(texture.uv_rotation);
  uvs.matrix = {scale.x * glm::dvec2(cosine, -sine), scale.y * glm::dvec2(sine, cosine)};
  uvs.offset = pairOf(model, texture.uv_offset, "offset", glm::dvec2(0), place);
  return uvs;
}

}  // namespace

GltfUvs baseColorUvs(const GltfModel& model, int material) {
  return readUvs(model, baseTexture(model, material), gltfMaterialPlace(material) + ".baseColorTexture");
}

GltfUvs emissionUvs(const GltfModel& model, int material) {
  if (gltfMaterial(model, material).unlit) return baseColorUvs(model, material);
  return readUvs(model, gltfMaterial(model, material).emissive,
                 gltfMaterialPlace(material) + ".emissiveTexture");
}

GltfUvs normalUvs(const GltfModel& model, int material) {
  return readUvs(model, gltfMaterial(model, material).normal, gltfMaterialPlace(material) + ".normalTexture");
}

}  // namespace luciole
