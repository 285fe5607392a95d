#pragma once

#include <string>
#include <vector>

#include "scene/gltf/gltf_model.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// A material of the file; −1 is glTF's default material. Throws InputError where there is no such one.
const tinygltf::Material& gltfMaterial(const GltfModel& model, int material);
/// What messages call it.
std::string gltfMaterialPlace(int material);
/// Whether it shows its base colour as it is (KHR_materials_unlit).
bool isUnlit(const tinygltf::Material& material);

/// Appends the materials in the order given, −1 being glTF's default one, and their textures. Throws
/// InputError.
///
/// Metallic-roughness becomes Phong so, with base, metallic m and roughness r the factors times their
/// textures' means, as Phong has no maps for them:
///     ambient = base,   diffuse = base · (1 − m)           (here the base colour texture is not averaged,
///     but mapped) specular = mix(0.04, base, m) · min(1, 1 / (4 α²)),  α = r² shininess = (2 / α² − 2) / 4
/// The exponent is that of Walter et al., "Microfacet Models for Refraction" (2007), for the half vector, a
/// quarter of it for the reflected one. 1/(4 α²) is the peak of the GGX lobe relative to a Lambertian 1/π; it
/// is limited to 1, for the highlight to stay in range, and r is kept above 0.15 (shininess 987): a sharper
/// highlight falls between pixels. Nothing is blended here: alphaMode BLEND is drawn as MASK with cutoff 0.5.
/// An unlit material reflects nothing and glows in its base colour, which is that colour to the bit.
void addGltfMaterials(const GltfModel& model, const std::vector<int>& materials, Scene& scene);

}  // namespace luciole
