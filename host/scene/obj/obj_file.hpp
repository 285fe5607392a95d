#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "luciole/warning.hpp"

namespace luciole {

/// A corner of a face: indices into the file's lists, counted from 0; -1: the file gives none.
struct ObjCorner {
  int position = -1;
  int uv = -1;
  int normal = -1;
};

struct ObjFace {
  std::size_t first_corner;  ///< index in ObjFile::corners
  int corner_count;          ///< at least 3
  int material;              ///< index in ObjFile::material_names, -1: none
  int part;                  ///< index in ObjFile::parts, -1: none
  unsigned smoothing;        ///< group; 0: flat
};

/// An o or g statement. Its faces are those up to the next one.
struct ObjPart {
  std::string name;  ///< words joined by one blank; may be empty
  bool is_object;    ///< o, rather than g
};

/// The surfaces of an OBJ file. Every number is finite and every index in range.
struct ObjFile {
  std::vector<glm::vec3> positions;
  /// One a position, or none at all. As written, but at least 0; those of positions without one are −1.
  std::vector<glm::dvec3> colors;
  std::vector<glm::vec2> uvs;  ///< v grows upwards
  std::vector<glm::vec3> normals;
  std::vector<ObjCorner> corners;
  std::vector<ObjFace> faces;
  std::vector<std::string> material_names;  ///< one a usemtl statement
  std::vector<std::string> material_files;  ///< arguments of the mtllib statements, as written
  std::vector<ObjPart> parts;               ///< one an o or g statement
  bool has_lines = false;                   ///< or points, curves or surfaces, which are left out
  std::vector<Warning> warnings;            ///< what was repaired or left out: one of each kind
};

/// Reads the statements v, vt, vn, f (fo), o, g, s, usemtl and mtllib, in any case. Leaves out all others,
/// with a warning for elements that aren't faces and one for unknown statements. In a file without any "s",
/// all faces are of smoothing group
/// 1. Repairs, with one warning for each kind that has the first line and the count: texture coordinates that
/// aren't numbers become 0, such normals (0,0,0); a face whose texture coordinate or normal doesn't exist has
/// none; a face of fewer than 3 corners is left out. Throws InputError naming the line if a position isn't a
/// number or doesn't exist. O(bytes of the file), on all cores: parts of about `part_bytes` are read in
/// parallel; the result doesn't depend on it.
ObjFile readObjFile(const std::string& path, std::size_t part_bytes = std::size_t(1) << 20);

}  // namespace luciole
