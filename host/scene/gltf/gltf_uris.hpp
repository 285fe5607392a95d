#pragma once

#include <string>
#include <string_view>

namespace luciole {

/// Refuses, before tinygltf opens any, the files that a glTF's JSON names by an address with a malformed
/// percent escape, or that are no regular files: of a folder tinygltf would read 2⁶³ bytes. `path` is the
/// glTF file's. JSON that is none is left to tinygltf. Throws InputError.
void checkUris(const std::string& path, std::string_view json);

}  // namespace luciole
