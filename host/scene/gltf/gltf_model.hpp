#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "luciole/warning.hpp"
#include "scene/gltf/gltf_json.hpp"

namespace luciole {

/// A parsed glTF file, not validated: any index in it may be out of range.
struct GltfModel {
  std::string path;
  std::vector<Warning>* warnings = nullptr;  ///< where warnings go; never null
  GltfFile file{};
  std::deque<std::string> kept{};  ///< the bytes that buffers and images refer to
  /// The content of compressed buffer views, by their index (decodeMeshopt(), decodeDraco()).
  std::map<int, std::vector<std::byte>> decoded{};
  int variant = -1;    ///< the chosen one of variantNames(); −1: the primitives' default materials
  int animation = -1;  ///< the only animation that runs; −1: all run
};

/// The names of the file's variants (KHR_materials_variants); those without one are called by their number,
/// with a warning. Throws InputError where they aren't a list.
std::vector<std::string> variantNames(const GltfModel& model);

/// What the file's animations are called: by name, or by index where they have none.
std::vector<std::string> animationNames(const GltfModel& model);

/// Parses a .gltf or .glb with its buffers, and finds its pictures (see findResources). Throws InputError:
/// among others for a glTF other than 2.x, a missing buffer, and a required extension that is not supported.
GltfModel readGltfModel(const std::string& path, const std::vector<std::string>& search,
                        std::vector<Warning>& warnings);

/// The extensions, each once, that the file uses, that it doesn't require, and that are not supported.
std::vector<std::string> ignoredExtensions(const GltfModel& model);

/// `list[index]`, or an InputError: "`place` refers to `what` `index`, but the file has only …".
template <typename T>
const T& element(const GltfModel& model, const std::vector<T>& list, int index, std::string_view place,
                 const char* what);

/// The bytes of a buffer view, which the model owns. Throws InputError where it reaches past its buffer.
std::span<const std::byte> viewBytes(const GltfModel& model, int buffer_view, const std::string& place);

/// Where a profile of EXT_lights_ies stands in the file.
std::string profilePlace(std::size_t index);

/// Whether an image's file doesn't exist or is empty.
bool isMissing(const GltfImage& image);

/// A member of a JSON object; null where there is none or `value` is no object.
const GltfJson& memberOf(const GltfJson& value, const char* name);

/// A JSON value as an index; −1 where it isn't one that a file could have.
int indexOf(const GltfJson& value);

/// Adds a warning that the file breaks the format's rules: "path: place: what". `kind`: as Warning has it.
void warnRepaired(const GltfModel& model, const std::string& place, const std::string& what,
                  const char* kind);

/// Adds a warning of content that isn't shown.
void warnLeftOut(const GltfModel& model, const std::string& place, const std::string& what, const char* kind);

/// Throws InputError "path: place: what".
[[noreturn]] void failGltf(const GltfModel& model, const std::string& place, const std::string& what);

template <typename T>
const T& element(const GltfModel& model, const std::vector<T>& list, int index, std::string_view place,
                 const char* what) {
  if (index < 0 || static_cast<std::size_t>(index) >= list.size()) {
    failGltf(model, std::string(place),
             index < 0 ? std::string("names no ") + what
                       : std::string("refers to ") + what + " " + std::to_string(index) +
                             ", but the file has " + std::to_string(list.size()) + " of them");
  }
  return list[static_cast<std::size_t>(index)];
}

}  // namespace luciole
