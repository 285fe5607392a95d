#pragma once

#include <string>
#include <vector>

namespace luciole {

/// Stands for a blank inside a material's name, because tinyobjloader ends a name at the first blank.
inline constexpr char kNameBlank = '\x1f';

/// An OBJ file's text, checked and cleaned for tinyobjloader, which would read "nan" as 0, accept indices
/// that point nowhere, and split names at blanks.
struct ObjText {
  /// Only v, vn, vt, f, s and usemtl statements; the rest is commented out. Every number is finite, every
  /// index points at something, every face has at most 255 corners. Blanks in material names are kNameBlank.
  std::string text;
  std::vector<std::string> material_files;  ///< the arguments of the mtllib statements, as written
  bool has_smoothing = false;               ///< the file has an "s" statement
};

/// Throws InputError naming the line.
ObjText readObjText(const std::string& path);

}  // namespace luciole
