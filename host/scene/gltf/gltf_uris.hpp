#pragma once

#include <string>
#include <string_view>

namespace luciole {

/// Throws InputError where a URI of a buffer or image in a glTF's JSON has a malformed percent escape, or
/// names something that exists and is no regular file. To be called before tinygltf opens the files: of a
/// folder it would try to read 2⁶³ bytes. `path` is the glTF file's. Invalid JSON is left to tinygltf.
void checkUris(const std::string& path, std::string_view json);

}  // namespace luciole
