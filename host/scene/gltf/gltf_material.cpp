#include "scene/gltf/gltf_material.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "base/text_file.hpp"
#include "image/make_normals.hpp"
#include "image/read_texture.hpp"
#include "image/srgb.hpp"

namespace luciole {
namespace {

/// The pictures that materials use, by their index in the file. `decoded` has all that aren't missing;
/// `in_scene` has the index in Scene::textures of those that are drawn.
struct Pictures {
  std::map<int, Texture> decoded;
  std::map<int, int> in_scene;
  std::map<int, int> normals_in_scene;
};

const tinygltf::Texture& textureOf(const GltfModel& model, int texture, const std::string& place) {
  return element(model, model.file.textures, texture, place, "texture");
}

/// The index of a texture's picture, or -1 where there is no texture.
int imageOf(const GltfModel& model, int texture, const std::string& place) {
  if (texture < 0) return -1;
  const tinygltf::Texture& entry = textureOf(model, texture, place);
  int image = extensionIndex(entry.extensions, "EXT_texture_webp", "source");
  if (image < 0) image = entry.source;
  if (image < 0 && entry.extensions.count("KHR_texture_basisu"))
    failGltf(model, fmt::format("textures[{}]", texture),
             "has a KHR_texture_basisu picture only, which is not supported; expected a source beside it");
  element(model, model.file.images, image, fmt::format("textures[{}]", texture), "image");
  return image;
}

constexpr const char* kSpecular = "KHR_materials_specular";

/// The index of one of KHR_materials_specular's textures, or −1.
int specularTexture(const tinygltf::Material& material, const char* member) {
  const auto found = material.extensions.find(kSpecular);
  if (found == material.extensions.end()) return -1;
  const tinygltf::Value& texture = memberOf(found->second, member);
  const tinygltf::Value& index = memberOf(texture, "index");
  const double number = index.IsNumber() ? index.GetNumberAsDouble() : -1;
  return number >= 0 && number < 1e9 ? static_cast<int>(number) : -1;
}

Pictures decodePictures(const GltfModel& model, const std::vector<int>& materials, Scene& scene) {
  Pictures pictures;
  for (const int index : materials) {
    const tinygltf::Material& material = gltfMaterial(model, index);
    const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    for (const int texture :
         {pbr.baseColorTexture.index, pbr.metallicRoughnessTexture.index, material.emissiveTexture.index,
          material.normalTexture.index, specularTexture(material, "specularTexture"),
          specularTexture(material, "specularColorTexture")}) {
      const int image = imageOf(model, texture, gltfMaterialPlace(index));
      if (image >= 0) pictures.decoded.try_emplace(image);
    }
  }
  std::vector<int> images;
  for (const auto& [image, texture] : pictures.decoded) {
    const tinygltf::Image& entry = model.file.images[image];
    if (isMissing(entry))
      scene.missing_textures.push_back(
          fmt::format("{}: images[{}]: there is no picture '{}'", model.path, image, forMessage(entry.uri)));
    else
      images.push_back(image);
  }
  std::erase_if(pictures.decoded,
                [&](const auto& entry) { return isMissing(model.file.images[entry.first]); });
  tbb::parallel_for(std::size_t{0}, images.size(), [&](std::size_t i) {
    const tinygltf::Image& entry = model.file.images[images[i]];
    const std::string name = forMessage(entry.uri.empty() ? entry.name : entry.uri);
    pictures.decoded.at(images[i]) = readTexture(
        imageBytes(model, images[i]), fmt::format("{}: images[{}] '{}'", model.path, images[i], name));
  });
  return pictures;
}

Wrap wrapOf(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::kClampToEdge;
  if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::kMirroredRepeat;
  return Wrap::kRepeat;
}

TextureUse textureUse(const GltfModel& model, int texture, const std::string& place, Pictures& pictures,
                      Scene& scene, TextureKind kind = TextureKind::kColor) {
  TextureUse use;
  const int image = imageOf(model, texture, place);
  if (!pictures.decoded.count(image)) return use;
  std::map<int, int>& known = kind == TextureKind::kNormals ? pictures.normals_in_scene : pictures.in_scene;
  const auto [entry, is_new] = known.try_emplace(image, static_cast<int>(scene.textures.size()));
  if (is_new) {
    scene.textures.push_back(pictures.decoded.at(image));
    if (kind != TextureKind::kColor) makeNormals(kind, scene.textures.back());
  }
  use.texture = entry->second;
  const int sampler = textureOf(model, texture, place).sampler;
  if (sampler >= 0) {
    const tinygltf::Sampler& modes =
        element(model, model.file.samplers, sampler, fmt::format("textures[{}]", texture), "sampler");
    use.wrap_u = wrapOf(modes.wrapS);
    use.wrap_v = wrapOf(modes.wrapT);
  }
  return use;
}

/// Linear mean of a colour picture: its 1×1 level.
glm::dvec3 meanColor(const Texture& texture) {
  const Texels& texel = texture.levels.back().texels;
  const glm::dvec3 codes = glm::dvec3(texel[0], texel[1], texel[2]) / 65535.0;
  if (texture.levels.size() > 1) return codes * codes;
  return {decodeSrgb(codes.r), decodeSrgb(codes.g), decodeSrgb(codes.b)};
}

/// Mean of a picture whose codes are plain numbers in [0,1], not sRGB.
glm::dvec3 meanCode(const Texture& texture) {
  const Texels& texels = texture.levels[0].texels;
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i + 3 < texels.size(); i += 4)
    sum += glm::dvec3(texels[i], texels[i + 1], texels[i + 2]);
  const std::size_t count = texels.size() / 4;
  return sum / (65535.0 * static_cast<double>(count));
}

/// A colour factor; components that the file leaves out are those of `otherwise`. Throws InputError for one
/// outside 0 to 1.
glm::dvec4 factor(const GltfModel& model, const std::vector<double>& values, const glm::dvec4& otherwise,
                  const std::string& place) {
  glm::dvec4 result = otherwise;
  for (std::size_t i = 0; i < std::min<std::size_t>(values.size(), 4); ++i) {
    if (!(values[i] >= 0 && values[i] <= 1)) failGltf(model, place, "a factor is outside 0 to 1");
    result[static_cast<int>(i)] = values[i];
  }
  return result;
}

/// Phong's model for a surface of GGX's facets (Walter et al. 2007). Its lobe's exponent is a quarter of the
/// facets' 2/α² − 2, because a mirrored direction turns by twice the angle of its facet, and cosines of small
/// angles fall by their squares. Its peak is the facets', whose term π·D·G·F / (4 N·V) is F0 / 4α² head-on.
/// So a metal's highlight has all its light; a dielectric's lacks what Fresnel's term adds at grazing angles.
/// Roughness below 0.15 would need lobes narrower than a pixel mostly is.
void setReflection(Material& material, const glm::dvec3& base, const glm::dvec3& mean_base,
                   const glm::dvec3& dielectric, double metallic, double roughness) {
  const double alpha = std::pow(std::max(roughness, 0.15), 2);
  material.ambient = glm::vec3(base);
  material.diffuse = glm::vec3(base * (1 - metallic));
  const glm::dvec3 f0 = glm::mix(dielectric, mean_base, metallic);
  material.specular = glm::vec3(f0 / (4 * alpha * alpha));
  material.shininess = static_cast<float>((2 / (alpha * alpha) - 2) / 4);
  material.facets = {glm::vec3(f0), static_cast<float>(alpha)};
}

/// What a dielectric reflects head-on, by KHR_materials_ior and KHR_materials_specular, whose textures count
/// by their means.
glm::dvec3 dielectricReflection(const GltfModel& model, const tinygltf::Material& source,
                                const std::string& place, const Pictures& pictures) {
  const double ior = extensionNumber(source.extensions, "KHR_materials_ior", "ior", 1.5);
  if (ior != 0 && !(ior >= 1)) failGltf(model, place, "ior must be 0 or at least 1");
  const double plain = ior == 0 ? 1.0 : std::pow((ior - 1) / (ior + 1), 2);
  double factor = extensionNumber(source.extensions, kSpecular, "specularFactor", 1.0);
  if (!(factor >= 0 && factor <= 1)) failGltf(model, place, "specularFactor must be from 0 to 1");
  glm::dvec3 color(1);
  const auto found = source.extensions.find(kSpecular);
  if (found == source.extensions.end()) return glm::dvec3(plain);
  const tinygltf::Value& list = memberOf(found->second, "specularColorFactor");
  for (int i = 0; i < 3 && list.IsArray() && list.ArrayLen() == 3; ++i)
    color[i] = list.Get(i).IsNumber() ? list.Get(i).GetNumberAsDouble() : 1.0;
  if (!(color.x >= 0 && color.y >= 0 && color.z >= 0 && std::isfinite(color.x + color.y + color.z)))
    failGltf(model, place, "specularColorFactor must be at least 0 and finite");
  const auto picture = [&](const char* member) -> const Texture* {
    const auto known = pictures.decoded.find(imageOf(model, specularTexture(source, member), place));
    return known == pictures.decoded.end() ? nullptr : &known->second;
  };
  if (const Texture* texture = picture("specularTexture"))
    factor *= double(texture->levels.back().texels[3]) / 65535;
  if (const Texture* texture = picture("specularColorTexture")) color *= meanColor(*texture);
  return glm::min(plain * color, glm::dvec3(1)) * factor;
}

Material convert(const GltfModel& model, int index, Pictures& pictures, Scene& scene) {
  const tinygltf::Material& source = gltfMaterial(model, index);
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  const std::string place = gltfMaterialPlace(index);
  const auto picture = [&](const tinygltf::TextureInfo& info) -> const Texture* {
    const auto found = pictures.decoded.find(imageOf(model, info.index, place));
    return found == pictures.decoded.end() ? nullptr : &found->second;
  };
  const glm::dvec4 base = factor(model, pbr.baseColorFactor, glm::dvec4(1), place);
  const glm::dvec3 emission = factor(model, source.emissiveFactor, glm::dvec4(0), place);
  glm::dvec3 mean_base = base;
  if (const Texture* texture = picture(pbr.baseColorTexture)) mean_base *= meanColor(*texture);
  double metallic = factor(model, {pbr.metallicFactor}, glm::dvec4(1), place).x;
  double roughness = factor(model, {pbr.roughnessFactor}, glm::dvec4(1), place).x;
  if (const Texture* texture = picture(pbr.metallicRoughnessTexture)) {
    const glm::dvec3 mean = meanCode(*texture);
    roughness *= mean.g;
    metallic *= mean.b;
  }

  Material material;
  material.name = index < 0 ? "default" : source.name;
  setReflection(material, base, mean_base, dielectricReflection(model, source, place, pictures), metallic,
                roughness);
  material.diffuse_map = textureUse(model, pbr.baseColorTexture.index, place, pictures, scene);
  const double strength =
      extensionNumber(source.extensions, "KHR_materials_emissive_strength", "emissiveStrength", 1.0);
  material.emission = glm::vec3(emission * strength);
  if (!(strength >= 0) || !std::isfinite(material.emission.x + material.emission.y + material.emission.z)) {
    failGltf(model, place, "emissiveStrength is negative or too large");
  }
  material.emission_map = textureUse(model, source.emissiveTexture.index, place, pictures, scene);
  // Where the picture of the emission is missing, there is no emission.
  if (source.emissiveTexture.index >= 0 && material.emission_map.texture < 0)
    material.emission = glm::vec3(0);
  if (isUnlit(source)) {
    material.emission = glm::vec3(base);
    material.emission_map = material.diffuse_map;
    material.colored_emission = true;
    material.ambient = material.diffuse = material.specular = glm::vec3(0);
    material.facets.reset();
  }
  if (!isUnlit(source)) {
    material.normal_map =
        textureUse(model, source.normalTexture.index, place, pictures, scene, TextureKind::kNormals);
    material.normal_scale = static_cast<float>(source.normalTexture.scale);
    if (!(std::abs(material.normal_scale) <= kMostNormalScale))
      failGltf(model, place,
               fmt::format("normalTexture.scale is {0}, expected -{1} to {1}", material.normal_scale,
                           kMostNormalScale));
  }
  material.alpha = static_cast<float>(base.a);
  if (source.alphaMode == "MASK") material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
  if (source.alphaMode == "BLEND") {
    material.blended = true;
    material.alpha_cutoff = 0.5f;  // of its shadows
  }
  if (!(material.alpha_cutoff >= 0)) failGltf(model, place, "alphaCutoff is negative");
  material.double_sided = source.doubleSided;
  return material;
}

}  // namespace

const tinygltf::Material& gltfMaterial(const GltfModel& model, int material) {
  static const tinygltf::Material kDefault;
  return material < 0 ? kDefault : element(model, model.file.materials, material, "a primitive", "material");
}

std::string gltfMaterialPlace(int material) { return fmt::format("materials[{}]", material); }

bool isUnlit(const tinygltf::Material& material) {
  return material.extensions.count("KHR_materials_unlit") > 0;
}

void addGltfMaterials(const GltfModel& model, const std::vector<int>& materials, Scene& scene) {
  Pictures pictures = decodePictures(model, materials, scene);
  for (const int index : materials) scene.materials.push_back(convert(model, index, pictures, scene));
}

}  // namespace luciole
