#ifdef LUCIOLE_TINYGLTF_HEADER_ONLY  // set by CMake where the system has no compiled tinygltf
#include <nlohmann/json.hpp>
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_INCLUDE_JSON
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#endif
#include "scene/gltf/gltf_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <new>
#include <string_view>

#include "base/error.hpp"
#include "base/text_file.hpp"
#include "scene/gltf/gltf_draco.hpp"
#include "scene/gltf/gltf_fit.hpp"
#include "scene/gltf/gltf_meshopt.hpp"
#include "scene/gltf/gltf_uris.hpp"

namespace luciole {
namespace {

constexpr std::string_view kSupportedExtensions[] = {
    "EXT_mesh_gpu_instancing",    "EXT_meshopt_compression", "EXT_texture_webp",
    "KHR_draco_mesh_compression", "KHR_lights_punctual",     "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_specular",  "KHR_materials_variants",
    "KHR_materials_unlit",        "KHR_mesh_quantization",   "KHR_node_visibility",
    "KHR_texture_transform"};

bool isSupported(const std::string& extension) {
  const auto end = std::end(kSupportedExtensions);
  return std::find(std::begin(kSupportedExtensions), end, extension) != end;
}

/// Keeps a picture's bytes as they are. A picture in a buffer view is left alone: tinygltf has not checked
/// that the view lies inside its buffer.
bool keepBytes(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
               int size, void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

/// Throws InputError for JSON nested so deep that a recursive parser would overflow the stack.
void checkNesting(const std::string& path, std::string_view json) {
  constexpr int kDeepest = 500;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '"') in_string = !in_string;
    if (in_string) {
      if (c == '\\') ++i;
    } else if (c == '{' || c == '[') {
      if (++depth > kDeepest) throw InputError(fmt::format("{}: JSON nested deeper than {}", path, kDeepest));
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

/// The JSON text of a .gltf, or the first chunk of a .glb.
std::string_view jsonOf(std::string_view bytes, bool is_binary) {
  constexpr std::size_t kHeader = 20;
  if (!is_binary || bytes.size() < kHeader) return bytes;
  std::uint32_t length = 0;
  for (int i = 0; i < 4; ++i) length |= std::uint32_t{static_cast<unsigned char>(bytes[12 + i])} << 8 * i;
  return bytes.substr(kHeader, length);
}

void checkRequiredExtensions(const GltfModel& model) {
  for (const std::string& extension : model.file.extensionsRequired) {
    if (isSupported(extension)) continue;
    failGltf(model, "extensionsRequired",
             fmt::format("'{}' is not supported; known are {}", forMessage(extension),
                         fmt::join(kSupportedExtensions, ", ")));
  }
}

void parse(GltfModel& model) {
  std::string bytes = readFile(model.path);
  checkNesting(model.path, jsonOf(bytes, bytes.starts_with("glTF")));
  bytes = fitForTinygltf(std::move(bytes));
  const bool is_binary = bytes.starts_with("glTF");
  const std::size_t size = bytes.size();
  if (size > std::numeric_limits<int>::max()) throw InputError(model.path + ": is larger than 2 GiB");
  checkUris(model.path, jsonOf(bytes, is_binary));
  bytes.resize(size +
               16);  // tinygltf 2.7 reads up to 8 bytes beyond a GLB whose last chunk lies about its length

  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keepBytes, nullptr);
  const std::string folder = std::filesystem::path(model.path).parent_path().string();
  std::string errors, warnings;
  bool ok = false;
  try {
    const unsigned length = static_cast<unsigned>(size);
    if (is_binary) {
      const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
      ok = loader.LoadBinaryFromMemory(&model.file, &errors, &warnings, data, length, folder);
    } else {
      ok = loader.LoadASCIIFromString(&model.file, &errors, &warnings, bytes.data(), length, folder);
    }
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {  // what the JSON library throws at members of a wrong type
    throw InputError(fmt::format("{}: is not valid glTF: {}", model.path, forMessage(error.what())));
  }
  checkRequiredExtensions(model);  // first: they are a likely reason for what tinygltf finds wrong
  // tinygltf goes on after members of a wrong type, with default values. These would give another picture, so
  // such files are refused.
  if (!ok || !errors.empty()) {
    throw InputError(fmt::format("{}: is not valid glTF: {}", model.path, forMessage(errors)));
  }
}

}  // namespace

GltfModel readGltfModel(const std::string& path) {
  GltfModel model;
  model.path = path;
  parse(model);
  if (!model.file.asset.version.starts_with("2.")) {
    failGltf(model, "asset",
             fmt::format("version is '{}', expected 2.0", forMessage(model.file.asset.version)));
  }
  decodeMeshopt(model);
  decodeDraco(model);
  return model;
}

std::span<const std::byte> viewBytes(const GltfModel& model, int buffer_view, const std::string& place) {
  const tinygltf::BufferView& view = element(model, model.file.bufferViews, buffer_view, place, "bufferView");
  if (const auto known = model.decoded.find(buffer_view); known != model.decoded.end()) return known->second;
  const std::string here = fmt::format("bufferViews[{}]", buffer_view);
  const tinygltf::Buffer& buffer = element(model, model.file.buffers, view.buffer, here, "buffer");
  const std::size_t size = buffer.data.size();
  if (view.byteOffset > size || view.byteLength > size - view.byteOffset) {
    failGltf(model, here,
             fmt::format("{} bytes from {} on reach past its buffer of {} bytes", view.byteLength,
                         view.byteOffset, size));
  }
  return std::as_bytes(std::span(buffer.data)).subspan(view.byteOffset, view.byteLength);
}

bool isMissing(const tinygltf::Image& image) { return image.bufferView < 0 && image.image.empty(); }

std::span<const std::byte> imageBytes(const GltfModel& model, int image) {
  const tinygltf::Image& entry = model.file.images[image];
  const std::string place = fmt::format("images[{}]", image);
  if (entry.bufferView >= 0) return viewBytes(model, entry.bufferView, place);
  return std::as_bytes(std::span(entry.image));
}

std::vector<std::string> ignoredExtensions(const GltfModel& model) {
  std::vector<std::string> ignored;
  for (const std::string& extension : model.file.extensionsUsed)
    if (!isSupported(extension) && std::find(ignored.begin(), ignored.end(), extension) == ignored.end())
      ignored.push_back(extension);
  return ignored;
}

std::vector<std::string> variantNames(const GltfModel& model) {
  std::vector<std::string> names;
  const auto found = model.file.extensions.find("KHR_materials_variants");
  if (found == model.file.extensions.end()) return names;
  const std::string place = "extensions.KHR_materials_variants.variants";
  const tinygltf::Value& list = memberOf(found->second, "variants");
  if (!list.IsArray()) failGltf(model, place, "expected a list");
  for (std::size_t i = 0; i < list.ArrayLen(); ++i) {
    const tinygltf::Value& name = memberOf(list.Get(static_cast<int>(i)), "name");
    if (!name.IsString()) failGltf(model, fmt::format("{}[{}]", place, i), "has no name");
    names.push_back(name.Get<std::string>());
  }
  return names;
}

std::vector<std::string> animationNames(const GltfModel& model) {
  std::vector<std::string> names;
  for (const tinygltf::Animation& animation : model.file.animations)
    names.push_back(animation.name.empty() ? std::to_string(names.size()) : animation.name);
  return names;
}

double extensionNumber(const tinygltf::ExtensionMap& extensions, const char* extension, const char* member,
                       double otherwise) {
  const auto found = extensions.find(extension);
  if (found == extensions.end() || !found->second.IsObject() || !found->second.Has(member)) return otherwise;
  const tinygltf::Value& value = found->second.Get(member);
  return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

const tinygltf::Value& memberOf(const tinygltf::Value& value, const char* name) {
  static const tinygltf::Value kNull;
  return value.IsObject() && value.Has(name) ? value.Get(name) : kNull;
}

int extensionIndex(const tinygltf::ExtensionMap& extensions, const char* extension, const char* member) {
  const double number = extensionNumber(extensions, extension, member, -1);
  return number >= 0 && number < 1e9 ? static_cast<int>(number) : -1;
}

void failGltf(const GltfModel& model, const std::string& place, const std::string& what) {
  throw InputError(fmt::format("{}: {}: {}", model.path, place, what));
}

}  // namespace luciole
