#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/gltf/gltf_model.hpp"

namespace luciole {

/// The two parts of a file: of a GLB its first chunk and its BIN chunk, else all of it and nothing.
struct GltfParts {
  std::string_view json, binary;
};

/// Cuts a file's bytes into its parts. Lengths, paddings and the order of a GLB's chunks are repaired, each
/// with a warning, and unknown chunks left out. Throws InputError.
GltfParts splitGltf(std::string_view bytes, const GltfModel& model);

/// Loads the content of the file's buffers: the BIN chunk, data in their URI, or files beside the glTF file
/// or in the folders `search` (see findFile). Throws InputError if a file isn't found, or a buffer view lacks
/// data; missing data that no view needs gets a warning. Finds the files of images, or the data in their URI;
/// of missing images GltfImage::file and GltfImage::bytes stay empty.
void findResources(std::string_view binary, const std::vector<std::string>& search, GltfModel& model);

}  // namespace luciole
