// Normals of meshes whose triangles share vertices across sharp edges, as boxes do.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numeric>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"

namespace luciole::python {
namespace {

/// A tree of a forest's nodes: the root that stands for all that are joined.
std::uint32_t rootOf(std::uint32_t node, std::vector<std::uint32_t>& parents) {
  while (parents[node] != node) node = parents[node] = parents[parents[node]];
  return node;
}

struct Edge {
  std::uint64_t vertices;  ///< the smaller index in the upper half
  std::uint32_t corner;    ///< where it begins: three times the triangle and 0, 1 or 2
};

std::vector<Edge> sortedEdges(const std::vector<glm::uvec3>& triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[t][int(k)], triangles[t][int((k + 1) % 3)]);
      edges.push_back({std::uint64_t(low) << 32 | high, 3 * t + k});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::pair(a.vertices, a.corner) < std::pair(b.vertices, b.corner);
  });
  return edges;
}

/// The unit normal of a triangle, or 0 where it has no area.
glm::dvec3 facing(const std::vector<glm::vec3>& positions, const glm::uvec3& triangle) {
  const glm::dvec3 a = positions[triangle.x], b = positions[triangle.y], c = positions[triangle.z];
  const glm::dvec3 across = glm::cross(b - a, c - a);
  const double length = glm::length(across);
  return length > 0 ? across / length : glm::dvec3(0);
}

double angleAt(const glm::dvec3& at, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 u = b - at, v = c - at;
  return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

/// The corners that share a vertex and are joined by edges that aren't sharp get one vertex: (for each new
/// vertex the old one, the triangles, its normal: the mean of its triangles', weighted by their angles
/// there).
nb::tuple splitAtCreases(const In<float, nb::shape<-1, 3>>& vertices,
                         const In<std::uint32_t, nb::shape<-1, 3>>& indices, double crease_cosine) {
  std::vector<std::uint32_t> sources, made(3 * indices.shape(0));
  std::vector<float> normals;
  {
    const nb::gil_scoped_release unlocked;
    const auto positions = vectorsOf<glm::vec3>(vertices.data(), vertices.shape(0));
    const auto* const first = reinterpret_cast<const glm::uvec3*>(indices.data());
    const std::vector<glm::uvec3> triangles(first, first + indices.shape(0));
    std::vector<glm::dvec3> facings;
    for (const glm::uvec3& triangle : triangles) facings.push_back(facing(positions, triangle));
    const auto vertexAt = [&](std::uint32_t corner) { return triangles[corner / 3][int(corner % 3)]; };
    const auto next = [](std::uint32_t corner) { return corner / 3 * 3 + (corner + 1) % 3; };

    std::vector<std::uint32_t> parents(made.size());
    std::iota(parents.begin(), parents.end(), 0u);
    const std::vector<Edge> edges = sortedEdges(triangles);
    for (std::size_t i = 1; i < edges.size(); ++i) {
      if (edges[i].vertices != edges[i - 1].vertices) continue;
      const std::uint32_t a = edges[i - 1].corner, b = edges[i].corner;
      if (glm::dot(facings[a / 3], facings[b / 3]) < crease_cosine) continue;
      for (const std::uint32_t here : {a, next(a)})
        for (const std::uint32_t there : {b, next(b)})
          if (vertexAt(here) == vertexAt(there)) parents[rootOf(here, parents)] = rootOf(there, parents);
    }

    std::vector<std::uint32_t> number(made.size(), ~0u);
    std::vector<glm::dvec3> sums;
    for (std::uint32_t corner = 0; corner < made.size(); ++corner) {
      std::uint32_t& vertex = number[rootOf(corner, parents)];
      if (vertex == ~0u) {
        vertex = std::uint32_t(sources.size());
        sources.push_back(vertexAt(corner));
        sums.emplace_back(0.0);
      }
      made[corner] = vertex;
      const glm::dvec3 at = positions[vertexAt(corner)], b = positions[vertexAt(next(corner))],
                       c = positions[vertexAt(next(next(corner)))];
      sums[vertex] += angleAt(at, b, c) * facings[corner / 3];
    }
    for (const glm::dvec3& sum : sums) {
      const double length = glm::length(sum);
      const glm::vec3 normal(length > 0 ? sum / length : glm::dvec3(0, 0, 1));
      normals.insert(normals.end(), {normal.x, normal.y, normal.z});
    }
  }
  const std::size_t count = sources.size(), triangle_count = made.size() / 3;
  return nb::make_tuple(arrayOf(std::move(sources), {count}), arrayOf(std::move(made), {triangle_count, 3}),
                        arrayOf(std::move(normals), {count, 3}));
}

}  // namespace

void bindCreases(nb::module_& module) { module.def("split_at_creases", splitAtCreases); }

}  // namespace luciole::python
