#include "scene/gltf/gltf_material.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>

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
  std::set<int> warned_samplers;  ///< whose faults are known
};

/// The index of a texture's picture; -1 where there is no texture, or none that can be read.
int imageOf(const GltfModel& model, int texture, const std::string& place) {
  if (texture < 0) return -1;
  const GltfTexture& entry = element(model, model.file.textures, texture, place, "texture");
  const int image = entry.webp < 0 ? entry.source : entry.webp;
  if (image >= 0) element(model, model.file.images, image, fmt::format("textures[{}]", texture), "image");
  return image;
}

/// Warns of a texture whose picture only an extension names that is not supported.
void warnOfNoSource(const GltfModel& model, int texture) {
  const GltfTexture& entry = model.file.textures[std::size_t(texture)];
  std::string extension = "no";
  if (entry.extensions.is_object() && !entry.extensions.empty())
    extension = fmt::format("only a {}", forMessage(entry.extensions.begin().key()));
  warnLeftOut(model, fmt::format("textures[{}]", texture),
              fmt::format("has {} picture{}; drawn without", extension,
                          extension == "no" ? "" : ", which is not supported"),
              "texture source");
}

Pictures decodePictures(const GltfModel& model, const std::vector<int>& materials, Scene& scene) {
  Pictures pictures;
  std::set<int> without_source;
  for (const int index : materials) {
    const GltfMaterial& material = gltfMaterial(model, index);
    const GltfGlossy glossy = material.glossy.value_or(GltfGlossy());
    for (const int texture :
         {material.base.texture, material.metallic_roughness.texture, material.emissive.texture,
          material.normal.texture, material.specular.texture.texture, material.specular.color_texture.texture,
          glossy.diffuse.texture, glossy.specular_glossiness.texture}) {
      const int image = imageOf(model, texture, gltfMaterialPlace(index));
      if (image >= 0) pictures.decoded.try_emplace(image);
      if (image < 0 && texture >= 0 && without_source.insert(texture).second) warnOfNoSource(model, texture);
    }
  }
  std::vector<int> images;
  for (const auto& [image, texture] : pictures.decoded) {
    const GltfImage& entry = model.file.images[std::size_t(image)];
    if (isMissing(entry))
      scene.missing_textures.push_back(
          entry.uri.empty() ? fmt::format("{}: images[{}]: holds no picture", model.path, image)
                            : fmt::format("{}: images[{}]: there is no picture '{}'", model.path, image,
                                          forMessage(entry.uri)));
    else
      images.push_back(image);
  }
  std::erase_if(pictures.decoded,
                [&](const auto& entry) { return isMissing(model.file.images[std::size_t(entry.first)]); });
  tbb::parallel_for(std::size_t{0}, images.size(), [&](std::size_t i) {
    const GltfImage& entry = model.file.images[std::size_t(images[i])];
    const std::string place = fmt::format("images[{}]", images[i]);
    const std::string name =
        fmt::format("{}: {} '{}'", model.path, place, forMessage(entry.uri.empty() ? entry.name : entry.uri));
    const std::string file = entry.file.empty() ? "" : readFile(entry.file);
    const std::span<const std::byte> bytes = entry.view >= 0      ? viewBytes(model, entry.view, place)
                                             : entry.file.empty() ? entry.bytes
                                                                  : std::as_bytes(std::span(file));
    pictures.decoded.at(images[i]) = readTexture(bytes, name);
  });
  return pictures;
}

// The numbers of a sampler, which are OpenGL's.
constexpr int kGlRepeat = 10497, kGlClampToEdge = 33071, kGlMirroredRepeat = 33648;
constexpr int kGlNearest = 9728, kGlLinear = 9729, kGlNearestMipmapNearest = 9984,
              kGlLinearMipmapNearest = 9985, kGlNearestMipmapLinear = 9986, kGlLinearMipmapLinear = 9987;

/// Sets what a sampler says. Of numbers that mean nothing the default counts. tell: such are told.
void setSampler(const GltfModel& model, int index, bool tell, TextureUse& use) {
  const GltfSampler& sampler = model.file.samplers[std::size_t(index)];
  const auto known = [&](const std::optional<double>& number, const char* member,
                         std::initializer_list<int> numbers) {
    if (!number) return 0;
    for (const int one : numbers)
      if (*number == one) return one;
    if (tell)
      warnRepaired(model, fmt::format("samplers[{}]", index),
                   fmt::format("{} is {}, none of glTF's; taken for the default", member, *number),
                   "sampler");
    return 0;
  };
  const auto wrapOf = [&](const std::optional<double>& number, const char* member) {
    switch (known(number, member, {kGlRepeat, kGlClampToEdge, kGlMirroredRepeat})) {
      case kGlClampToEdge:
        return Wrap::kClampToEdge;
      case kGlMirroredRepeat:
        return Wrap::kMirroredRepeat;
      default:
        return Wrap::kRepeat;
    }
  };
  use.wrap_u = wrapOf(sampler.wrap_u, "wrapS");
  use.wrap_v = wrapOf(sampler.wrap_v, "wrapT");
  use.nearest_magnified = known(sampler.magnified, "magFilter", {kGlNearest, kGlLinear}) == kGlNearest;
  const int minified = known(sampler.minified, "minFilter",
                             {kGlNearest, kGlLinear, kGlNearestMipmapNearest, kGlLinearMipmapNearest,
                              kGlNearestMipmapLinear, kGlLinearMipmapLinear});
  use.nearest_minified =
      minified == kGlNearest || minified == kGlNearestMipmapNearest || minified == kGlNearestMipmapLinear;
  if (minified == kGlNearest || minified == kGlLinear) use.mips = Mips::kNone;
  if (minified == kGlNearestMipmapNearest || minified == kGlLinearMipmapNearest) use.mips = Mips::kNearest;
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
  const int sampler = model.file.textures[std::size_t(texture)].sampler;
  if (sampler < 0) return use;
  const bool tell = pictures.warned_samplers.insert(sampler).second;
  if (std::size_t(sampler) < model.file.samplers.size())
    setSampler(model, sampler, tell, use);
  else if (tell)
    warnRepaired(model, fmt::format("textures[{}]", texture),
                 fmt::format("refers to sampler {}, but the file has {} of them; taken for the default",
                             sampler, model.file.samplers.size()),
                 "no sampler");
  return use;
}

/// The picture of a texture; null where there is none.
const Texture* pictureOf(const GltfModel& model, int texture, const std::string& place,
                         const Pictures& pictures) {
  const auto found = pictures.decoded.find(imageOf(model, texture, place));
  return found == pictures.decoded.end() ? nullptr : &found->second;
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

/// A number within its limits, to which it is clamped with a warning.
double within(const GltfModel& model, double value, double least, double most, const std::string& place,
              const char* name) {
  const double clamped = std::clamp(value, least, most);
  if (clamped != value)
    warnRepaired(model, place, fmt::format("{} is {}, taken for {}", name, value, clamped), name);
  return clamped;
}

/// A colour of `count` factors, each within 0 and `most`; those that the file leaves out are `otherwise`.
glm::dvec4 factor(const GltfModel& model, const std::vector<double>& values, int count, double otherwise,
                  const std::string& place, const char* name, double most = 1) {
  glm::dvec4 result(otherwise);
  if (!values.empty() && values.size() != std::size_t(count))
    warnRepaired(model, place, fmt::format("{} has {} numbers, expected {}", name, values.size(), count),
                 name);
  for (int i = 0; i < count && std::size_t(i) < values.size(); ++i)
    result[i] = within(model, values[std::size_t(i)], 0, most, place, name);
  return result;
}

/// What a material reflects.
struct Reflection {
  glm::dvec4 base{1.0};     ///< colour and alpha, without its texture
  glm::dvec3 diffuse{1.0};  ///< of them, the share that is scattered
  glm::dvec3 f0{0.0};       ///< reflected head-on, with the means of textures
  double roughness = 1;
};

/// Phong's model for a surface of GGX's facets (Walter et al. 2007). Its lobe's exponent is a quarter of the
/// facets' 2/α² − 2, because a mirrored direction turns by twice the angle of its facet, and cosines of small
/// angles fall by their squares. Its peak is the facets', whose term π·D·G·F / (4 N·V) is F0 / 4α² head-on.
/// So a metal's highlight has all its light; a dielectric's lacks what Fresnel's term adds at grazing angles.
/// Roughness below 0.15 would need lobes narrower than a pixel mostly is.
void setReflection(const Reflection& reflection, Material& material) {
  const double alpha = std::pow(std::max(reflection.roughness, 0.15), 2);
  material.ambient = glm::vec3(reflection.base);
  material.diffuse = glm::vec3(reflection.diffuse);
  material.specular = glm::vec3(reflection.f0 / (4 * alpha * alpha));
  material.shininess = static_cast<float>((2 / (alpha * alpha) - 2) / 4);
  material.facets = {glm::vec3(reflection.f0), static_cast<float>(alpha)};
}

/// What a dielectric reflects head-on, by KHR_materials_ior and KHR_materials_specular, whose textures count
/// by their means.
glm::dvec3 dielectricReflection(const GltfModel& model, const GltfMaterial& source, const std::string& place,
                                const Pictures& pictures) {
  constexpr double kMost = std::numeric_limits<double>::max();
  const double ior = source.ior == 0 ? 0 : within(model, source.ior, 1, kMost, place, "ior");
  const double plain = ior == 0 ? 1.0 : std::pow((ior - 1) / (ior + 1), 2);
  const GltfSpecular& specular = source.specular;
  double share = within(model, specular.factor, 0, 1, place, "specularFactor");
  glm::dvec3 color = factor(model, specular.color_factor, 3, 1, place, "specularColorFactor", kMost);
  if (const Texture* texture = pictureOf(model, specular.texture.texture, place, pictures))
    share *= double(texture->levels.back().texels[3]) / 65535;
  if (const Texture* texture = pictureOf(model, specular.color_texture.texture, place, pictures))
    color *= meanColor(*texture);
  return glm::min(plain * color, glm::dvec3(1)) * share;
}

Reflection metallicRoughness(const GltfModel& model, const GltfMaterial& source, const std::string& place,
                             const Pictures& pictures) {
  Reflection reflection;
  reflection.base = factor(model, source.base_factor, 4, 1, place, "baseColorFactor");
  glm::dvec3 mean_base = reflection.base;
  if (const Texture* texture = pictureOf(model, source.base.texture, place, pictures))
    mean_base *= meanColor(*texture);
  double metallic = within(model, source.metallic, 0, 1, place, "metallicFactor");
  reflection.roughness = within(model, source.roughness, 0, 1, place, "roughnessFactor");
  if (const Texture* texture = pictureOf(model, source.metallic_roughness.texture, place, pictures)) {
    const glm::dvec3 mean = meanCode(*texture);
    reflection.roughness *= mean.g;
    metallic *= mean.b;
  }
  reflection.diffuse = glm::dvec3(reflection.base) * (1 - metallic);
  reflection.f0 = glm::mix(dielectricReflection(model, source, place, pictures), mean_base, metallic);
  return reflection;
}

/// KHR_materials_pbrSpecularGlossiness.
Reflection specularGlossiness(const GltfModel& model, const GltfGlossy& source, const std::string& place,
                              const Pictures& pictures) {
  Reflection reflection;
  reflection.base = factor(model, source.diffuse_factor, 4, 1, place, "diffuseFactor");
  reflection.f0 = factor(model, source.specular_factor, 3, 1, place, "specularFactor");
  double glossiness = within(model, source.glossiness, 0, 1, place, "glossinessFactor");
  if (const Texture* texture = pictureOf(model, source.specular_glossiness.texture, place, pictures)) {
    reflection.f0 *= meanColor(*texture);
    glossiness *= double(texture->levels.back().texels[3]) / 65535;
  }
  reflection.roughness = 1 - glossiness;
  const glm::dvec3& f0 = reflection.f0;
  reflection.diffuse = glm::dvec3(reflection.base) * (1 - std::max({f0.x, f0.y, f0.z}));
  return reflection;
}

/// How opacity decides: 0 for everything is opaque.
double cutoffOf(const GltfModel& model, const GltfMaterial& source, const std::string& place) {
  const char* mode = "OPAQUE";
  for (const char* name : {"MASK", "BLEND"})
    if (equalIgnoringCase(source.alpha_mode, name)) mode = name;
  if (source.alpha_mode != mode)
    warnRepaired(model, place,
                 fmt::format("alphaMode is '{}', taken for {}", forMessage(source.alpha_mode), mode),
                 "alphaMode");
  if (mode == std::string_view("BLEND")) return 0.5;
  if (mode == std::string_view("OPAQUE")) return 0;
  return within(model, source.alpha_cutoff, 0, std::numeric_limits<double>::max(), place, "alphaCutoff");
}

Material convert(const GltfModel& model, int index, Pictures& pictures, Scene& scene) {
  const GltfMaterial& source = gltfMaterial(model, index);
  const std::string place = gltfMaterialPlace(index);
  const Reflection reflection = source.glossy ? specularGlossiness(model, *source.glossy, place, pictures)
                                              : metallicRoughness(model, source, place, pictures);
  const glm::dvec3 emission = factor(model, source.emissive_factor, 3, 0, place, "emissiveFactor");

  Material material;
  material.name = index < 0 ? "default" : source.name;
  setReflection(reflection, material);
  material.diffuse_map = textureUse(model, baseTexture(model, index).texture, place, pictures, scene);
  const double strength = within(model, source.emissive_strength, 0, std::numeric_limits<double>::max(),
                                 place, "emissiveStrength");
  material.emission = glm::vec3(emission * strength);
  if (!std::isfinite(material.emission.x + material.emission.y + material.emission.z))
    failGltf(model, place, "emissiveStrength is too large");
  material.emission_map = textureUse(model, source.emissive.texture, place, pictures, scene);
  // Where the picture of the emission is missing, there is no emission.
  if (source.emissive.texture >= 0 && material.emission_map.texture < 0) material.emission = glm::vec3(0);
  if (source.unlit) {
    material.emission = glm::vec3(reflection.base);
    material.emission_map = material.diffuse_map;
    material.colored_emission = true;
    material.ambient = material.diffuse = material.specular = glm::vec3(0);
    material.facets.reset();
  }
  if (!source.unlit) {
    material.normal_map =
        textureUse(model, source.normal.texture, place, pictures, scene, TextureKind::kNormals);
    material.normal_scale = static_cast<float>(within(model, source.normal.scale, -kMostNormalScale,
                                                      kMostNormalScale, place, "normalTexture.scale"));
  }
  material.alpha = static_cast<float>(reflection.base.a);
  material.alpha_cutoff = static_cast<float>(cutoffOf(model, source, place));
  material.double_sided = source.double_sided;
  material.blended = equalIgnoringCase(source.alpha_mode, "BLEND");  // its cutoff is of its shadows
  return material;
}

}  // namespace

const GltfMaterial& gltfMaterial(const GltfModel& model, int material) {
  static const GltfMaterial kDefault;
  return material < 0 ? kDefault : element(model, model.file.materials, material, "a primitive", "material");
}

std::string gltfMaterialPlace(int material) { return fmt::format("materials[{}]", material); }

const GltfTextureInfo& baseTexture(const GltfModel& model, int material) {
  const GltfMaterial& source = gltfMaterial(model, material);
  return source.glossy ? source.glossy->diffuse : source.base;
}

void addGltfMaterials(const GltfModel& model, const std::vector<int>& materials, Scene& scene) {
  Pictures pictures = decodePictures(model, materials, scene);
  for (const int index : materials) scene.materials.push_back(convert(model, index, pictures, scene));
}

}  // namespace luciole
