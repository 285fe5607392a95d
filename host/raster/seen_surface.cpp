#include "raster/seen_surface.hpp"

#include "gbuffer/packed_normal.hpp"

namespace luciole {
namespace {

template <class T, class Value>
Interpolant<T> between(const Value* values, const glm::uvec3& corners) {
  const T first(values[corners[0]]);
  return {first, T(values[corners[1]]) - first, T(values[corners[2]]) - first};
}

Interpolant<glm::dvec3> normals(const Surface& surface, const glm::dvec3& facing_normal, Shading shading) {
  if (shading == Shading::kFlat) return {facing_normal, {}, {}};
  const glm::dmat3 to_view =
      surface.front_facing ? surface.object->normal_to_view : -surface.object->normal_to_view;
  const auto in_object = between<glm::dvec3>(surface.object->mesh->normals.data(), surface.corners);
  return {to_view * in_object.first, to_view * in_object.to_second, to_view * in_object.to_third};
}

Interpolant<glm::dvec3> tangents(const Surface& surface) {
  const glm::dmat3 to_view(surface.object->object_to_view);
  const auto in_object = between<glm::dvec3>(surface.object->mesh->tangents.data(), surface.corners);
  return {to_view * in_object.first, to_view * in_object.to_second, to_view * in_object.to_third};
}

/// The lift on the side that is seen.
Lift liftOf(const Surface& surface, const Interpolant<glm::dvec3>& normal) {
  const glm::bvec3 bent = bentCorners(*surface.object->mesh, surface.corners);
  return makeLift(bent, {normal.first, normal.first + normal.to_second, normal.first + normal.to_third},
                  surface.edge1, surface.edge2);
}

}  // namespace

SeenSurface makeSeenSurface(const ResolveInput& input, std::uint32_t triangle) {
  SeenSurface seen;
  seen.surface = makeSurface(input.scene, input.objects, triangle, input.plane);
  if (input.flattened_objects) {
    const Surface flat = makeSurface(input.scene, *input.flattened_objects, triangle, input.plane);
    seen.surface.weight1 = flat.weight1;
    seen.surface.weight2 = flat.weight2;
    seen.surface.determinant = flat.determinant;
    seen.surface.front_facing = true;
  }
  const Surface& surface = seen.surface;
  const Mesh& mesh = *surface.object->mesh;
  seen.facing_normal = surface.front_facing ? surface.normal : -surface.normal;
  seen.geometric_normal = packNormal(seen.facing_normal);
  seen.normal = normals(surface, seen.facing_normal, input.shading);
  if (input.planes.lift && input.shading != Shading::kFlat) seen.lift = liftOf(surface, seen.normal);
  const bool any_map =
      surface.material->diffuse_map.texture >= 0 || surface.material->emission_map.texture >= 0;
  seen.mapped = any_map && !mesh.uvs.empty();
  if (seen.mapped || (input.planes.uv && !mesh.uvs.empty()))
    seen.uv = between<glm::dvec2>(mesh.uvs.data(), surface.corners);
  seen.has_tangent = input.planes.tangent && !mesh.tangents.empty();
  if (seen.has_tangent) seen.tangent = tangents(surface);
  seen.has_normal_map =
      surface.material->normal_map.texture >= 0 && input.shading == Shading::kPhong && !mesh.tangents.empty();
  // Lit vertex colours are multiplied by the diffuse map, so they need no other coordinates.
  seen.has_emission_uv = seen.mapped && !mesh.emission_uvs.empty() && !input.litVertices();
  if (seen.has_emission_uv) seen.emission_uv = between<glm::dvec2>(mesh.emission_uvs.data(), surface.corners);
  if (input.litVertices()) {
    seen.colored = true;
    seen.color =
        between<glm::dvec3>(input.vertex_colors.data() + surface.object->first_vertex, surface.corners);
  } else if (!mesh.colors.empty()) {
    seen.colored = true;
    seen.color = between<glm::dvec3>(mesh.colors.data(), surface.corners);
  }
  return seen;
}

}  // namespace luciole
