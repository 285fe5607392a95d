#pragma once

#include <string>
#include <vector>

#include "luciole/scene.hpp"
#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// A material of the file by its index; −1 is glTF's default material. Throws InputError where there is none.
const GltfMaterial& gltfMaterial(const GltfModel& model, int material);
/// The name of a material in messages.
std::string gltfMaterialPlace(int material);
/// The texture of its base colour: KHR_materials_pbrSpecularGlossiness' diffuse one where it has that.
const GltfTextureInfo& baseTexture(const GltfModel& model, int material);

/// Appends the materials in the order given, −1 being glTF's default one, and their textures. Throws
/// InputError.
///
/// Metallic-roughness becomes Phong as follows. Base colour, metallic m and roughness r are the factors times
/// the means of their textures, since Phong has no maps for them:
///
///     ambient   = base
///     diffuse   = base · (1 − m)
///     specular  = mix(F0, base, m) · min(1, 1 / (4 α²)),  α = r²
///     shininess = (2 / α² − 2) / 4
///
/// F0 is 0.04, or what KHR_materials_ior and KHR_materials_specular make it, whose textures count by their
/// means. For ambient and diffuse the base colour texture becomes the diffuse map instead of its mean. The
/// exponent is that of Walter et al., "Microfacet Models for Refraction" (2007), for the half vector; a
/// quarter of it is for the reflected vector. 1 / (4 α²) is the peak of the GGX lobe relative to a Lambertian
/// 1/π, limited to 1 to keep the highlight in range. r is at least 0.15 (shininess 987), since a sharper
/// highlight falls between pixels. alphaMode BLEND is Material::blended, and of its shadows a cutoff of 0.5.
/// An unlit material reflects nothing and has its base colour as emission, to the bit.
///
/// KHR_materials_pbrSpecularGlossiness comes before metallic-roughness: base is its diffuse colour, F0 its
/// specular colour, r is 1 − glossiness, of textures' means, and diffuse = base · (1 − the largest of F0).
///
/// Factors outside the specification's range are clamped to it, with a warning each; pictures that are
/// missing or of a kind that is not supported are left out, with a warning.
void addGltfMaterials(const GltfModel& model, const std::vector<int>& materials, Scene& scene);

}  // namespace luciole
