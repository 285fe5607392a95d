#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace luciole {

/// A corner of a face: indices into the file's lists, counted from 0; -1: the file gives none.
struct ObjCorner {
  int position = -1;
  int uv = -1;
  int normal = -1;
};

struct ObjFace {
  std::size_t first_corner;  ///< index in ObjFile::corners
  int corner_count;          ///< 0 to 255
  int material;              ///< index in ObjFile::material_names, -1: none
  unsigned smoothing;        ///< group; 0: flat
};

/// The surfaces of an OBJ file. Every number is finite, every index is in range.
struct ObjFile {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> colors;  ///< one a position, or none
  std::vector<glm::vec2> uvs;     ///< v grows upwards
  std::vector<glm::vec3> normals;
  std::vector<ObjCorner> corners;
  std::vector<ObjFace> faces;
  std::vector<std::string> material_names;  ///< one a usemtl statement
  std::vector<std::string> material_files;  ///< arguments of the mtllib statements, as written
};

/// Reads the statements v, vt, vn, f, s, usemtl and mtllib, and leaves out all others. In a file without any
/// "s", all faces are of smoothing group 1. Throws InputError naming the line. O(bytes of the file), on all
/// cores: parts of about `part_bytes` are read at the same time, and the result doesn't depend on it.
ObjFile readObjFile(const std::string& path, std::size_t part_bytes = std::size_t(1) << 20);

}  // namespace luciole
