#include "scene/tangents.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "scene/corners.hpp"

namespace luciole {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

/// A triangle's tangent in its plane, unit; zero where it has no area in the picture.
struct Facet {
  glm::dvec3 tangent{0.0};
  bool mirrored = false;  ///< clockwise in the picture, v upwards
};

const std::vector<glm::vec2>& uvsOf(const Mesh& mesh) {
  return mesh.normal_uvs.empty() ? mesh.uvs : mesh.normal_uvs;
}

Facet facetOf(const Mesh& mesh, const glm::uvec3& corners) {
  const std::vector<glm::vec2>& uvs = uvsOf(mesh);
  const auto position = [&](int i) { return glm::dvec3(mesh.positions[corners[i]]); };
  const auto uv = [&](int i) { return glm::dvec2(uvs[corners[i]].x, -double(uvs[corners[i]].y)); };
  const glm::dvec3 edge1 = position(1) - position(0), edge2 = position(2) - position(0);
  const glm::dvec2 step1 = uv(1) - uv(0), step2 = uv(2) - uv(0);
  const double area = step1.x * step2.y - step1.y * step2.x;
  const glm::dvec3 along = (step2.y * edge1 - step1.y * edge2) * (area < 0 ? -1.0 : 1.0);
  const double length = glm::length(along);
  if (area == 0 || !(length > 0) || !std::isfinite(length)) return {};
  return {along / length, area < 0};
}

/// A vector projected into the plane of a unit normal, at unit length; zero if nothing remains.
glm::dvec3 flattened(const glm::dvec3& vector, const glm::dvec3& normal) {
  const glm::dvec3 flat = vector - normal * glm::dot(normal, vector);
  const double length = glm::length(flat);
  return length > 1e-12 * glm::length(vector) && std::isfinite(length) ? flat / length : glm::dvec3(0.0);
}

/// For each vertex the first one with the same position, normal and, unless across_seams, texture
/// coordinates.
std::vector<std::uint32_t> weld(const Mesh& mesh, bool across_seams) {
  using Key = std::array<float, 8>;
  const std::vector<glm::vec2>& uvs = uvsOf(mesh);
  const auto key = [&](std::uint32_t i) {
    const glm::vec3 p = mesh.positions[i], n = mesh.normals[i];
    const glm::vec2 uv = across_seams ? glm::vec2(0.0f) : uvs[i];
    return Key{p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y};
  };
  std::vector<std::uint32_t> order(mesh.positions.size()), first(order.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Key of_a = key(a), of_b = key(b);
    return of_a != of_b ? of_a < of_b : a < b;
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
  return first;
}

/// Whether texture coordinates change alike along two triangles' edge, as where a texture goes on beyond a
/// seam.
bool goesOn(const Mesh& mesh, const CornerEdge& a, const CornerEdge& b) {
  const std::vector<glm::vec2>& uvs = uvsOf(mesh);
  const auto uv = [&](std::uint32_t corner) {
    return glm::dvec2(uvs[mesh.triangles[corner / 3][int(corner % 3)]]);
  };
  const glm::dvec2 step_a = uv(a.high_corner) - uv(a.low_corner),
                   step_b = uv(b.high_corner) - uv(b.low_corner);
  return glm::distance(step_a, step_b) <= 0x1p-10 * (glm::length(step_a) + glm::length(step_b));
}

/// Corners that share a tangent are of one group.
CornerGroups groupCorners(const Mesh& mesh, const std::vector<Facet>& facets,
                          const std::vector<std::uint32_t>& welded) {
  CornerGroups groups(3 * mesh.triangles.size());
  const std::vector<CornerEdge> edges = sortedEdges(
      mesh.triangles.size(), [&](std::uint32_t t) { return facets[t].tangent != glm::dvec3(0.0); },
      [&](std::uint32_t corner) { return welded[mesh.triangles[corner / 3][int(corner % 3)]]; });
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin;
    std::array<const CornerEdge*, 2> of_side{};
    for (; end < edges.size() && edges[end].joins(edges[begin]); ++end) {
      const CornerEdge*& other = of_side[facets[edges[end].low_corner / 3].mirrored];
      if (other && goesOn(mesh, *other, edges[end])) {
        groups.join(other->low_corner, edges[end].low_corner);
        groups.join(other->high_corner, edges[end].high_corner);
      }
      other = &edges[end];
    }
    begin = end;
  }
  return groups;
}

/// The angle of a triangle at a corner, between its sides flattened into the plane of the corner's normal.
double angleAt(const Mesh& mesh, const glm::uvec3& corners, int corner, const glm::dvec3& normal) {
  const glm::dvec3 at(mesh.positions[corners[corner]]);
  const glm::dvec3 a = flattened(glm::dvec3(mesh.positions[corners[(corner + 1) % 3]]) - at, normal);
  const glm::dvec3 b = flattened(glm::dvec3(mesh.positions[corners[(corner + 2) % 3]]) - at, normal);
  return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

/// A tangent for each corner, zero where there is none.
std::vector<glm::vec4> cornerTangents(const Mesh& mesh, const std::vector<bool>& wanted, bool across_seams) {
  std::vector<Facet> facets(mesh.triangles.size());
  for (std::size_t t = 0; t < facets.size(); ++t)
    if (wanted[t]) facets[t] = facetOf(mesh, mesh.triangles[t]);
  const std::vector<std::uint32_t> welded = weld(mesh, across_seams);
  CornerGroups groups = groupCorners(mesh, facets, welded);
  std::vector<glm::dvec3> sums(3 * facets.size());
  std::vector<std::uint32_t> group_of_vertex(mesh.positions.size(), kNone);  // any one, of a welded vertex
  for (std::uint32_t corner = 0; corner < sums.size(); ++corner) {
    const Facet& facet = facets[corner / 3];
    if (facet.tangent == glm::dvec3(0.0)) continue;
    const glm::uvec3& corners = mesh.triangles[corner / 3];
    const glm::dvec3 normal(mesh.normals[corners[int(corner % 3)]]);
    const std::uint32_t group = groups.find(corner);
    sums[group] += flattened(facet.tangent, normal) * angleAt(mesh, corners, int(corner % 3), normal);
    std::uint32_t& known = group_of_vertex[welded[corners[int(corner % 3)]]];
    if (known == kNone) known = group;
  }
  std::vector<glm::vec4> tangents(sums.size(), glm::vec4(0));
  for (std::uint32_t corner = 0; corner < sums.size(); ++corner) {
    if (!wanted[corner / 3]) continue;
    const std::uint32_t vertex = mesh.triangles[corner / 3][int(corner % 3)];
    const bool own = facets[corner / 3].tangent != glm::dvec3(0.0);
    const std::uint32_t group = own ? groups.find(corner) : group_of_vertex[welded[vertex]];
    if (group == kNone) continue;
    const glm::dvec3 tangent = flattened(sums[group], glm::dvec3(mesh.normals[vertex]));
    if (tangent == glm::dvec3(0.0)) continue;
    tangents[corner] = glm::vec4(tangent, facets[group / 3].mirrored ? -1.0f : 1.0f);
  }
  return tangents;
}

/// Adds the tangents that corners lack: those of materials with a normal map, or all, across seams.
void addMissing(Scene& scene, bool all) {
  std::vector<std::vector<bool>> wanted(scene.meshes.size());
  for (const Object& object : scene.objects) {
    const Mesh& mesh = scene.meshes[object.mesh];
    if (uvsOf(mesh).empty()) continue;
    std::vector<bool>& triangles = wanted[object.mesh];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const std::uint32_t material =
          object.material >= 0 ? std::uint32_t(object.material) : mesh.triangle_materials[t];
      if (scene.materials[material].normal_map.texture < 0 && !all) continue;
      const glm::uvec3& corners = mesh.triangles[t];
      const auto has = [&](int i) {
        return !mesh.tangents.empty() && mesh.tangents[corners[i]] != glm::vec4(0);
      };
      if (has(0) && has(1) && has(2)) continue;
      triangles.resize(mesh.triangles.size(), false);
      triangles[t] = true;
    }
  }
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (!wanted[i].empty()) addTangents(wanted[i], scene.meshes[i], all);
  for (Deformation& deformation : scene.animation.deformations)
    deformation.tangents = scene.meshes[deformation.mesh].tangents;
}

}  // namespace

bool hasNormalMaps(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& material) { return material.normal_map.texture >= 0; });
}

void addTangents(const std::vector<bool>& wanted, Mesh& mesh, bool across_seams) {
  const std::vector<glm::vec4> tangents = cornerTangents(mesh, wanted, across_seams);
  const std::size_t before = mesh.positions.size();
  mesh.tangents.resize(before, glm::vec4(0));
  std::vector<bool> used(before, false);  // by a triangle that keeps what the vertex has
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3 && !wanted[t]; ++i) used[mesh.triangles[t][i]] = true;
  std::map<std::pair<std::uint32_t, std::array<float, 4>>, std::uint32_t> copies;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!wanted[t]) continue;
    for (int i = 0; i < 3; ++i) {
      std::uint32_t& vertex = mesh.triangles[t][i];
      const glm::vec4& tangent = tangents[3 * t + std::size_t(i)];
      if (used[vertex] && mesh.tangents[vertex] != tangent) {
        const auto [copy, is_new] =
            copies.try_emplace({vertex, {tangent.x, tangent.y, tangent.z, tangent.w}}, kNone);
        if (is_new) {
          copy->second = copyVertex(vertex, mesh);
          used.push_back(true);
        }
        vertex = copy->second;
      }
      used[vertex] = true;
      mesh.tangents[vertex] = tangent;
    }
  }
}

void addTangents(Scene& scene) {
  if (hasNormalMaps(scene)) addMissing(scene, false);
}

void addAllTangents(Scene& scene) {
  addMissing(scene, true);
  for (Mesh& mesh : scene.meshes) {
    if (!mesh.divided || uvsOf(*mesh.divided).empty()) continue;
    Mesh divided = *mesh.divided;
    addTangents(std::vector<bool>(divided.triangles.size(), true), divided, true);
    mesh.divided = std::make_shared<const Mesh>(std::move(divided));
  }
}

}  // namespace luciole
