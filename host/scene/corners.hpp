#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <vector>

#include "luciole/scene.hpp"

// Corners of a mesh's triangles, numbered 3 · triangle + 0, 1 or 2: which of them may share a vertex.
namespace luciole {

/// Joins corners into groups (union by the lower number, with path halving).
struct CornerGroups {
  std::vector<std::uint32_t> parent;

  explicit CornerGroups(std::size_t corners) : parent(corners) {
    std::iota(parent.begin(), parent.end(), 0u);
  }
  std::uint32_t find(std::uint32_t corner) {
    while (parent[corner] != corner) corner = parent[corner] = parent[parent[corner]];
    return corner;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent[std::max(a, b)] = std::min(a, b);
  }
};

/// An edge of a triangle between two vertices, the lower first.
struct CornerEdge {
  std::uint32_t low, high;
  std::uint32_t low_corner, high_corner;

  bool operator<(const CornerEdge& other) const {
    return std::tie(low, high, low_corner) < std::tie(other.low, other.high, other.low_corner);
  }
  bool joins(const CornerEdge& other) const { return low == other.low && high == other.high; }
};

/// The edges of the triangles for which isWanted(triangle), so that those between the same vertices follow
/// each other. vertexAt(corner): its vertex. Edges from a vertex to itself are left out. O(n log n).
template <class IsWanted, class VertexAt>
std::vector<CornerEdge> sortedEdges(std::size_t triangles, const IsWanted& isWanted,
                                    const VertexAt& vertexAt) {
  std::vector<CornerEdge> edges;
  edges.reserve(3 * triangles);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    if (!isWanted(t)) continue;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t here = 3 * t + i, there = 3 * t + (i + 1) % 3;
      const std::uint32_t a = vertexAt(here), b = vertexAt(there);
      if (a < b) edges.push_back({a, b, here, there});
      if (b < a) edges.push_back({b, a, there, here});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Appends a copy of a vertex with all that the mesh has of it. Returns its number. Arrays must have their
/// sizes.
std::uint32_t copyVertex(std::uint32_t vertex, Mesh& mesh);

}  // namespace luciole
