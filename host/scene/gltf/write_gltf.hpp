#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace luciole {

/// Triangles of a mesh to be written: a position and a unit normal for each vertex.
struct GltfTriangles {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;       ///< optional; v grows downwards
  std::vector<glm::uvec3> corners;  ///< counter-clockwise from the front
};

/// A glTF 2.0 asset under construction: its JSON, without what writeGltf() adds from the other members, and
/// the bytes of its one buffer.
struct GltfDocument {
  nlohmann::ordered_json root;
  /// JSON of the nodes, with commas between. As text: there may be a million, and as values they'd take ten
  /// times the memory.
  std::string nodes;
  int node_count = 0;
  std::string bytes;
};

/// A length in metres, rounded to whole millimetres, so that the file needs few digits.
double millimetres(double metres);

/// Appends a node. Returns its index.
int addNode(const std::string& json, GltfDocument& document);

/// Appends the triangles to the buffer, as accessors. Returns a primitive of these, without a material.
/// `triangles` must have a vertex.
nlohmann::ordered_json addTriangles(const GltfTriangles& triangles, GltfDocument& document);

/// Appends a PNG's bytes to the buffer, and a texture of it that is clamped at its edges. Returns the
/// texture.
int addPngTexture(const std::string& png, GltfDocument& document);

/// Throws InputError unless the path's name ends in .glb or .gltf, or is "-".
void checkGltfPath(const std::string& path);

/// Writes the document: a .glb or "-" as one binary file, a .gltf with its buffer beside it as a .bin. Throws
/// InputError for a name that ends otherwise or a binary file beyond glTF's 4 GiB, and where writeTextFile()
/// does.
void writeGltf(GltfDocument document, const std::string& path);

}  // namespace luciole
