#include "scene/corners.hpp"

namespace luciole {
namespace {

template <class T>
void copyElement(std::size_t from, std::vector<T>& values) {
  if (!values.empty()) values.push_back(T(values[from]));
}

}  // namespace

std::uint32_t copyVertex(std::uint32_t vertex, Mesh& mesh) {
  copyElement(vertex, mesh.positions);
  copyElement(vertex, mesh.normals);
  copyElement(vertex, mesh.uvs);
  copyElement(vertex, mesh.emission_uvs);
  copyElement(vertex, mesh.normal_uvs);
  copyElement(vertex, mesh.lightmap_uvs);
  copyElement(vertex, mesh.tangents);
  copyElement(vertex, mesh.colors);
  copyElement(vertex, mesh.sources);
  return std::uint32_t(mesh.positions.size() - 1);
}

}  // namespace luciole
