#include "scene/gltf/gltf_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "scene/gltf/gltf_draco.hpp"
#include "scene/gltf/gltf_meshopt.hpp"
#include "scene/gltf/gltf_resources.hpp"

namespace luciole {
namespace {

constexpr std::string_view kSupportedExtensions[] = {"EXT_lights_ies",
                                                     "EXT_mesh_gpu_instancing",
                                                     "EXT_meshopt_compression",
                                                     "EXT_texture_webp",
                                                     "KHR_draco_mesh_compression",
                                                     "KHR_lights_punctual",
                                                     "KHR_materials_emissive_strength",
                                                     "KHR_materials_ior",
                                                     "KHR_materials_pbrSpecularGlossiness",
                                                     "KHR_materials_specular",
                                                     "KHR_materials_variants",
                                                     "KHR_materials_unlit",
                                                     "KHR_mesh_quantization",
                                                     "KHR_node_visibility",
                                                     "KHR_texture_transform"};

bool isSupported(const std::string& extension) {
  const auto end = std::end(kSupportedExtensions);
  return std::find(std::begin(kSupportedExtensions), end, extension) != end;
}

void checkRequiredExtensions(const GltfModel& model) {
  for (const std::string& extension : model.file.extensions_required) {
    if (isSupported(extension)) continue;
    failGltf(model, "extensionsRequired",
             fmt::format("'{}' is not supported; known are {}", forMessage(extension),
                         fmt::join(kSupportedExtensions, ", ")));
  }
}

}  // namespace

GltfModel readGltfModel(const std::string& path, const std::vector<std::string>& search,
                        std::vector<Warning>& warnings) {
  GltfModel model;
  model.path = path;
  model.warnings = &warnings;
  const std::string& bytes = model.kept.emplace_back(readFile(path));
  const GltfParts parts = splitGltf(bytes, model);
  parseGltf(parts.json, model);
  if (model.file.version != "2" && !model.file.version.starts_with("2."))
    failGltf(model, "asset", fmt::format("version is '{}', expected 2.0", forMessage(model.file.version)));
  checkRequiredExtensions(model);
  findResources(parts.binary, search, model);
  decodeMeshopt(model);
  decodeDraco(model);
  return model;
}

std::string profilePlace(std::size_t index) {
  return fmt::format("extensions.EXT_lights_ies.lights[{}]", index);
}

std::span<const std::byte> viewBytes(const GltfModel& model, int buffer_view, const std::string& place) {
  const GltfView& view = element(model, model.file.views, buffer_view, place, "bufferView");
  if (const auto known = model.decoded.find(buffer_view); known != model.decoded.end()) return known->second;
  const std::string here = fmt::format("bufferViews[{}]", buffer_view);
  const GltfBuffer& buffer = element(model, model.file.buffers, view.buffer, here, "buffer");
  const std::size_t size = buffer.bytes.size();
  if (view.offset > size || view.length > size - view.offset) {
    failGltf(model, here,
             !buffer.uri && size == 0
                 ? fmt::format("buffers[{}] has no uri, and {}", view.buffer,
                               view.buffer == 0 ? "the file no BIN chunk" : "is not a GLB's first")
                 : fmt::format("{} bytes from {} on reach past its buffer of {} bytes", view.length,
                               view.offset, size));
  }
  return buffer.bytes.subspan(view.offset, view.length);
}

bool isMissing(const GltfImage& image) { return image.view < 0 && image.file.empty() && image.bytes.empty(); }

std::vector<std::string> ignoredExtensions(const GltfModel& model) {
  std::vector<std::string> ignored;
  for (const std::string& extension : model.file.extensions_used)
    if (!isSupported(extension) && std::find(ignored.begin(), ignored.end(), extension) == ignored.end())
      ignored.push_back(extension);
  return ignored;
}

std::vector<std::string> variantNames(const GltfModel& model) {
  std::vector<std::string> names;
  const GltfJson& extension = memberOf(model.file.extensions, "KHR_materials_variants");
  if (extension.is_null()) return names;
  const std::string place = "extensions.KHR_materials_variants.variants";
  const GltfJson& list = memberOf(extension, "variants");
  if (extension.is_object() && list.is_null()) return names;
  if (!list.is_array()) failGltf(model, place, "expected a list");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const GltfJson& name = memberOf(list[i], "name");
    if (!name.is_string())
      warnRepaired(model, fmt::format("{}[{}]", place, i), fmt::format("has no name, called '{}'", i),
                   "variant");
    names.push_back(name.is_string() ? name.get<std::string>() : std::to_string(i));
  }
  return names;
}

std::vector<std::string> animationNames(const GltfModel& model) {
  std::vector<std::string> names;
  for (const GltfAnimationEntry& animation : model.file.animations)
    names.push_back(animation.name.empty() ? std::to_string(names.size()) : animation.name);
  return names;
}

const GltfJson& memberOf(const GltfJson& value, const char* name) {
  static const GltfJson kNull;
  if (!value.is_object()) return kNull;
  const auto found = value.find(name);
  return found == value.end() ? kNull : *found;
}

int indexOf(const GltfJson& value) {
  const double number = value.is_number() ? value.get<double>() : -1;
  return number >= 0 && number < 1e9 ? static_cast<int>(number) : -1;
}

void warnRepaired(const GltfModel& model, const std::string& place, const std::string& what,
                  const char* kind) {
  model.warnings->push_back({fmt::format("{}: {}: {}", model.path, place, what), kind, true});
}

void warnLeftOut(const GltfModel& model, const std::string& place, const std::string& what,
                 const char* kind) {
  model.warnings->push_back({fmt::format("{}: {}: {}", model.path, place, what), kind});
}

void failGltf(const GltfModel& model, const std::string& place, const std::string& what) {
  throw InputError(fmt::format("{}: {}: {}", model.path, place, what));
}

}  // namespace luciole
