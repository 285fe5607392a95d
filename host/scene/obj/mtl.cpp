#include "scene/obj/mtl.hpp"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include "base/error.hpp"
#include "base/text_file.hpp"
#include "scene/load_textures.hpp"

namespace luciole {
namespace {

std::string messageAt(const MtlEntry& entry, const std::string& what) {
  return fmt::format("{}: material '{}': {}", entry.file, forMessage(entry.name), what);
}

[[noreturn]] void fail(const MtlEntry& entry, const std::string& what) {
  throw InputError(messageAt(entry, what));
}

glm::vec3 color(const MtlEntry& entry, const char* statement, const tinyobj::real_t (&values)[3]) {
  const glm::vec3 rgb(values[0], values[1], values[2]);
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(rgb[i])) fail(entry, fmt::format("{} is not finite", statement));
  }
  return glm::max(rgb, glm::vec3(0));
}

TextureUse textureUse(const MtlEntry& entry, const char* statement, std::string name,
                      const tinyobj::texture_option_t& options, Scene& scene,
                      TextureKind kind = TextureKind::kColor) {
  TextureUse use;
  if (name.empty()) return use;
  const auto& scale = options.scale;
  const auto& offset = options.origin_offset;
  if (scale[0] != 1 || scale[1] != 1 || offset[0] != 0 || offset[1] != 0) {
    fail(entry, fmt::format("{}: the options -s and -o are not supported", statement));
  }
  std::replace(name.begin(), name.end(), '\\', '/');
  const std::filesystem::path path = std::filesystem::path(entry.file).parent_path() / name;
  if (!isFile(path)) {
    scene.missing_textures.push_back(
        messageAt(entry, fmt::format("{}: there is no picture '{}'", statement, forMessage(path.string()))));
    return use;
  }
  use.texture = addTexture(scene, path.string(), kind);
  use.wrap_u = use.wrap_v = options.clamp ? Wrap::kClampToEdge : Wrap::kRepeat;
  return use;
}

/// Parses one material. Statements with the defaults of Material stand before the file's own, so that what
/// the file leaves out isn't tinyobjloader's black.
tinyobj::material_t parse(const MtlEntry& entry) {
  std::istringstream stream("Ka 0.2 0.2 0.2\nKd 0.8 0.8 0.8\nillum 2\n" + entry.statements);
  std::map<std::string, int> ids;
  std::vector<tinyobj::material_t> materials;
  std::string warnings, errors;
  tinyobj::LoadMtl(&ids, &materials, &stream, &warnings, &errors);
  if (!errors.empty() || materials.size() != 1) fail(entry, forMessage("can't be read " + errors));
  return materials[0];
}

bool hasAlpha(const Texture& texture) {
  return texture.alpha_varies || texture.levels[0].texels[3] != 0xffff;
}

}  // namespace

std::vector<MtlEntry> readMtl(const std::string& path) {
  std::string text = readFile(path);
  std::replace(text.begin(), text.end(), '\r', '\n');
  std::vector<MtlEntry> entries;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string keyword, name;
    words >> keyword;
    if (keyword == "newmtl") {
      std::getline(words >> std::ws, name);
      name.erase(name.find_last_not_of(" \t") + 1);
      entries.push_back({name, path, ""});
    } else if (!entries.empty()) {
      entries.back().statements += line + '\n';
    }
  }
  return entries;
}

Material readMaterial(const MtlEntry& entry, Scene& scene) {
  const tinyobj::material_t values = parse(entry);
  Material material;
  material.name = entry.name;
  material.ambient = color(entry, "Ka", values.ambient);
  material.diffuse = color(entry, "Kd", values.diffuse);
  material.emission = color(entry, "Ke", values.emission);
  const bool has_specular = values.illum > 1;  // illum 0 is a constant colour, 1 has no highlight
  if (has_specular) material.specular = color(entry, "Ks", values.specular);
  if (!std::isfinite(values.shininess)) fail(entry, "Ns is not finite");
  material.shininess = std::max(values.shininess, 0.0f);
  material.diffuse_map = textureUse(entry, "map_Kd", values.diffuse_texname, values.diffuse_texopt, scene);
  material.emission_map = textureUse(entry, "map_Ke", values.emissive_texname, values.emissive_texopt, scene);
  material.alpha_map = textureUse(entry, "map_d", values.alpha_texname, values.alpha_texopt, scene);
  // `norm` is for normals alone. `bump` and `map_bump` mean the same.
  const bool has_norm = !values.normal_texname.empty();
  const tinyobj::texture_option_t& bends = has_norm ? values.normal_texopt : values.bump_texopt;
  material.normal_map =
      has_norm ? textureUse(entry, "norm", values.normal_texname, bends, scene, TextureKind::kNormals)
               : textureUse(entry, "bump", values.bump_texname, bends, scene, TextureKind::kBump);
  if (!(std::abs(bends.bump_multiplier) <= kMostNormalScale))
    fail(entry, fmt::format("-bm is {0}, expected -{1} to {1}", bends.bump_multiplier, kMostNormalScale));
  material.normal_scale = bends.bump_multiplier;
  // With a map_Ke and no Ke the factor is 1, or the map would not be seen.
  const bool only_map = material.emission_map.texture >= 0 && material.emission == glm::vec3(0);
  if (only_map) material.emission = glm::vec3(1);
  // Where the picture of the emission is missing, there is no emission.
  if (!values.emissive_texname.empty() && material.emission_map.texture < 0) material.emission = glm::vec3(0);
  material.double_sided = true;
  return material;
}

void cutHoles(Material& material, const Scene& scene) {
  const bool holes =
      material.alpha_map.texture >= 0 ||
      (material.diffuse_map.texture >= 0 && hasAlpha(scene.textures[material.diffuse_map.texture]));
  material.alpha_cutoff = holes ? 0.5f : 0.0f;
}

}  // namespace luciole
