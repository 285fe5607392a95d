#pragma once

#include <glm/glm.hpp>

#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// Which texture coordinates a texture uses, and its KHR_texture_transform: matrix · uv + offset.
struct GltfUvs {
  int set = -1;  ///< of the TEXCOORD attributes; -1: the material has no such texture
  glm::dmat2 matrix{1.0};
  glm::dvec2 offset{0.0};

  bool operator==(const GltfUvs&) const = default;
};

/// The coordinates of the base colour texture, and of the emissive texture; for KHR_materials_unlit both are
/// the base colour's. `material` −1 is glTF's default material. Throws InputError.
GltfUvs baseColorUvs(const GltfModel& model, int material);
GltfUvs emissionUvs(const GltfModel& model, int material);
/// Those of the normal texture.
GltfUvs normalUvs(const GltfModel& model, int material);

}  // namespace luciole
