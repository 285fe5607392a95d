#include "raster/square_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gbuffer/packed_normal.hpp"
#include "gbuffer/tangent_plane.hpp"

namespace luciole {
namespace {

/// Barycentric weights of a surface's second and third corner at a square's pixels. The first corner's are 1
/// minus both.
struct SquareWeights {
  Lanes<double> second;
  Lanes<double> third;
};

/// Where the rays of a square's pixels intersect a surface's plane, inside the triangle or not.
struct PlaneCrossing {
  SquareWeights weights;
  Lanes<double> scale;  ///< 1 / dot(determinant row, p)
};

PlaneCrossing crossPlane(const Surface& surface, const SquarePlace& place) {
  const glm::dvec3 weight1 = surface.weight1, weight2 = surface.weight2, determinant = surface.determinant;
  PlaneCrossing crossing;
  for (int i = 0; i < kSquarePixels; ++i) {
    const double x = place.x[i], y = place.y[i];
    const double scale = 1.0 / (determinant.x * x + determinant.y * y + determinant.z);
    crossing.scale[i] = scale;
    crossing.weights.second[i] = (weight1.x * x + weight1.y * y + weight1.z) * scale;
    crossing.weights.third[i] = (weight2.x * x + weight2.y * y + weight2.z) * scale;
  }
  return crossing;
}

/// The weights with those of the pixels that see the surface moved into the triangle (see weightsInside).
SquareWeights clampInside(const Surface& surface, const SquarePlace& place, const LaneMask& mask,
                          const SquareWeights& in_plane) {
  SquareWeights weights = in_plane;
  LaneMask outside;
  std::int32_t any = 0;
  for (int i = 0; i < kSquarePixels; ++i) {
    const double second = in_plane.second[i], third = in_plane.third[i];
    const bool inside = (1.0 - second - third >= 0.0) & (second >= 0.0) & (third >= 0.0);
    outside[i] = mask[i] & !inside;
    any |= outside[i];
  }
  if (!any) return weights;
  for (int i = 0; i < kSquarePixels; ++i) {
    if (!outside[i]) continue;
    const Weights held = weightsInside(surface, {place.x[i], place.y[i], 1.0});
    weights.second[i] = held[1];
    weights.third[i] = held[2];
  }
  return weights;
}

/// Interpolates one component.
Lanes<double> interpolate(double first, double to_second, double to_third, const SquareWeights& weights) {
  Lanes<double> result;
  for (int i = 0; i < kSquarePixels; ++i)
    result[i] = first + weights.second[i] * to_second + weights.third[i] * to_third;
  return result;
}
template <class T>
Lanes<double> interpolate(const Interpolant<T>& values, int component, const SquareWeights& weights) {
  return interpolate(values.first[component], values.to_second[component], values.to_third[component],
                     weights);
}

Lanes<float> rounded(const Lanes<double>& values) {
  Lanes<float> result;
  for (int i = 0; i < kSquarePixels; ++i) result[i] = float(values[i]);
  return result;
}

void normalize(const Lanes3<double>& v, const glm::dvec3& otherwise, Lanes3<float>& out) {
  Lanes<double> inverse;
  std::int32_t usable = 1;
  for (int i = 0; i < kSquarePixels; ++i) {
    inverse[i] = 1.0 / std::sqrt(v[0][i] * v[0][i] + v[1][i] * v[1][i] + v[2][i] * v[2][i]);
    usable &= (inverse[i] > 0.0) & (inverse[i] <= std::numeric_limits<double>::max());
  }
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < kSquarePixels; ++i) out[c][i] = float(v[c][i] * inverse[i]);
  if (usable) return;
  for (int i = 0; i < kSquarePixels; ++i) {
    if (inverse[i] > 0.0 && inverse[i] <= std::numeric_limits<double>::max()) continue;
    for (int c = 0; c < 3; ++c) out[c][i] = float(otherwise[c]);
  }
}

// As std::min and std::max, but of values: GCC vectorizes no loop over choices of references.
double lesser(double a, double b) { return b < a ? b : a; }
double greater(double a, double b) { return a < b ? b : a; }
double positive(double a) { return greater(a, 0.0); }

/// The lifts of a square's pixels in metres, see lift.hpp. `normal`: interpolated, of any length.
void setLift(const SeenSurface& seen, const SquareWeights& weights, const Lanes3<double>& normal,
             Lanes<float>& out) {
  const Lift& lift = seen.lift;
  if (!lift.any) {
    out.fill(0.0f);
    return;
  }
  const glm::dvec3 edge1 = seen.surface.edge1, edge2 = seen.surface.edge2;
  for (int i = 0; i < kSquarePixels; ++i) {
    const double second = weights.second[i], third = weights.third[i], first = 1.0 - second - third;
    const double planes = first * positive(second * lift.rise[0][0] + third * lift.rise[0][1]) +
                          second * positive(third * lift.rise[1][0] + first * lift.rise[1][1]) +
                          third * positive(first * lift.rise[2][0] + second * lift.rise[2][1]);
    const double x = normal[0][i], y = normal[1][i], z = normal[2][i];
    const double to_second = edge1.x * x + edge1.y * y + edge1.z * z,
                 to_third = edge2.x * x + edge2.y * y + edge2.z * z;
    const double own = positive(greater(to_second, to_third)) - (second * to_second + third * to_third);
    const double length2 = x * x + y * y + z * z;
    const double height = lesser(greater(own, 0.5 * planes), planes) / std::sqrt(length2);
    const float lifted = float(lesser(height, lift.most));
    // Where the corners' normals cancel there is no direction to lift along.
    out[i] = (length2 > 0.0) & (height > 0.0) ? lifted : 0.0f;
  }
}

/// The change of texture coordinates from a pixel to the next along an axis of the picture. Relative to the
/// first corner u = n / d, where n and d are dot products of rows with p (see Surface). They grow by n' and
/// d' a pixel, so
///     (n + n') / (d + d') − n / d = (n' − u · d') / (d + d').
/// Both are 0 unless both are finite.
void stepAlong(int axis, const Surface& surface, const Interpolant<glm::dvec2>& uv, double pixel,
               const PlaneCrossing& crossing, const Lanes<double>& u, const Lanes<double>& v,
               Lanes<float>& du, Lanes<float>& dv) {
  const double weight1 = pixel * surface.weight1[axis], weight2 = pixel * surface.weight2[axis];
  const double determinant = pixel * surface.determinant[axis];
  const glm::dvec2 row = weight1 * uv.to_second + weight2 * uv.to_third;
  const glm::dvec2 first = uv.first;
  constexpr float kLargest = std::numeric_limits<float>::max();
  for (int i = 0; i < kSquarePixels; ++i) {
    const double scale = crossing.scale[i];
    const float next = 1.0f / float(1.0 + determinant * scale);
    const float along_u = float((row.x - (u[i] - first.x) * determinant) * scale) * next;
    const float along_v = float((row.y - (v[i] - first.y) * determinant) * scale) * next;
    const bool finite = (std::abs(along_u) <= kLargest) & (std::abs(along_v) <= kLargest);
    du[i] = finite ? along_u : 0.0f;
    dv[i] = finite ? along_v : 0.0f;
  }
}

void setFootprints(const Surface& surface, const Interpolant<glm::dvec2>& uv, const ViewPlane& plane,
                   const PlaneCrossing& crossing, const SquareWeights& weights, SquareFootprints& result) {
  result.u = rounded(interpolate(uv, 0, weights));
  result.v = rounded(interpolate(uv, 1, weights));
  const Lanes<double> u = interpolate(uv, 0, crossing.weights);
  const Lanes<double> v = interpolate(uv, 1, crossing.weights);
  stepAlong(0, surface, uv, plane.scale.x, crossing, u, v, result.du_dx, result.dv_dx);
  stepAlong(1, surface, uv, plane.scale.y, crossing, u, v, result.du_dy, result.dv_dy);
}

void fill(const glm::vec3& value, Lanes3<float>& out) {
  for (int c = 0; c < 3; ++c) out[c].fill(value[c]);
}

void multiply(const Lanes3<float>& factors, Lanes3<float>& out) {
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < kSquarePixels; ++i) out[c][i] *= factors[c][i];
}

void setMaterial(const ResolveInput& input, const SeenSurface& seen, const SquareWeights& weights,
                 SquareValues& out) {
  const Material& material = *seen.surface.material;
  Lanes3<float> color;
  if (seen.colored)
    for (int c = 0; c < 3; ++c) color[c] = rounded(interpolate(seen.color, c, weights));
  if (input.litVertices()) {
    for (Lanes3<float>* nothing : {&out.diffuse, &out.ambient}) fill(glm::vec3(0.0f), *nothing);
    for (Lanes<float>& nothing : out.specular) nothing.fill(0.0f);
    out.emission = color;
    return;
  }
  fill(material.diffuse, out.diffuse);
  fill(material.ambient, out.ambient);
  fill(material.emission, out.emission);
  for (int c = 0; c < 3; ++c) out.specular[c].fill(material.specular[c]);
  out.specular[3].fill(material.shininess);
  if (!seen.colored) return;
  multiply(color, out.diffuse);
  multiply(color, out.ambient);
  if (material.colored_emission) multiply(color, out.emission);
}

/// Sets the maps of the pixels that see the surface, and their footprints. Its material must be mapped.
void setMaps(const ResolveInput& input, const SeenSurface& seen, const PlaneCrossing& crossing,
             const SquareWeights& weights, const LaneMask& mask, SquareValues& out) {
  const Material& material = *seen.surface.material;
  const auto setMap = [&](const TextureUse& map, Lanes<const TextureUse*>& uses) {
    const TextureUse* use = map.texture >= 0 ? &map : nullptr;
    for (int i = 0; i < kSquarePixels; ++i) uses[i] = mask[i] ? use : nullptr;
  };
  // The diffuse map colours what vertices reflect.
  if (input.litVertices()) {
    setMap(material.diffuse_map, out.emission_map);
  } else {
    setMap(material.diffuse_map, out.reflection_map);
    setMap(material.emission_map, out.emission_map);
  }
  const Surface& surface = seen.surface;
  setFootprints(surface, seen.uv, input.plane, crossing, weights, out.footprints);
  out.emission_footprints = out.footprints;
  if (seen.has_emission_uv)
    setFootprints(surface, seen.emission_uv, input.plane, crossing, weights, out.emission_footprints);
  out.mapped = true;
}

template <std::size_t kCount>
void copyComponents(const std::array<Lanes<float>, kCount>& values, const LaneMask& mask,
                    std::array<Lanes<float>, kCount>& out) {
  for (std::size_t c = 0; c < kCount; ++c) copyLanes(values[c], mask, out[c]);
}

void copyFootprints(const SquareFootprints& values, const LaneMask& mask, SquareFootprints& out) {
  copyLanes(values.u, mask, out.u);
  copyLanes(values.v, mask, out.v);
  copyLanes(values.du_dx, mask, out.du_dx);
  copyLanes(values.dv_dx, mask, out.dv_dx);
  copyLanes(values.du_dy, mask, out.du_dy);
  copyLanes(values.dv_dy, mask, out.dv_dy);
}

bool anyMap(const Lanes<const TextureUse*>& maps) {
  bool any = false;
  for (int i = 0; i < kSquarePixels; ++i) any |= maps[i] != nullptr;
  return any;
}

bool isSpread(const SquarePlace& place) {
  bool spread = false;
  for (int i = 0; i < kSquarePixels; ++i) spread |= (place.spread_x[i] != 0.0f) | (place.spread_y[i] != 0.0f);
  return spread;
}

/// A footprint's place, moved by a number of pixels right and down.
void moveAlong(const Lanes<float>& right, const Lanes<float>& down, const SquareFootprints& from,
               SquareFootprints& to) {
  for (int i = 0; i < kSquarePixels; ++i) {
    to.u[i] = from.u[i] + right[i] * from.du_dx[i] + down[i] * from.du_dy[i];
    to.v[i] = from.v[i] + right[i] * from.dv_dx[i] + down[i] * from.dv_dy[i];
  }
}

Lanes3<float> mapColors(const Scene& scene, const Lanes<const TextureUse*>& maps, const SquarePlace& place,
                        const SquareFootprints& footprints) {
  if (!isSpread(place)) return sampleTextures(scene.textures, maps, footprints);
  Lanes3<float> mean{};
  SquareFootprints moved = footprints;
  for (const float side_x : {-1.0f, 1.0f})
    for (const float side_y : {-1.0f, 1.0f}) {
      Lanes<float> right, down;
      for (int i = 0; i < kSquarePixels; ++i) {
        right[i] = side_x * place.spread_x[i];
        down[i] = side_y * place.spread_y[i];
      }
      moveAlong(right, down, footprints, moved);
      const Lanes3<float> colors = sampleTextures(scene.textures, maps, moved);
      for (int c = 0; c < 3; ++c)
        for (int i = 0; i < kSquarePixels; ++i) mean[c][i] += 0.25f * colors[c][i];
    }
  return mean;
}

/// Bends the normals of pixels by the surface's normal map. Red is along the tangent, green across it on its
/// side, blue along the normal; blue below 0 counts as 0. Where the surface has no tangent, or the map's
/// vector is shorter than a step of 8 bits, the normal stays. The lift keeps its height above the surface:
/// along the bent normal it is longer, up to twice, which is enough for normals bent by 60°.
void bendNormals(const ResolveInput& input, const SeenSurface& seen, const SquarePlace& place,
                 const PlaneCrossing& crossing, const SquareWeights& weights, const LaneMask& mask,
                 SquareValues& values) {
  const Surface& surface = seen.surface;
  const Mesh& mesh = *surface.object->mesh;
  const std::vector<glm::vec2>& uvs = mesh.normal_uvs.empty() ? mesh.uvs : mesh.normal_uvs;
  const glm::dvec2 first(uvs[surface.corners[0]]);
  SquareFootprints footprints;
  setFootprints(
      surface,
      {first, glm::dvec2(uvs[surface.corners[1]]) - first, glm::dvec2(uvs[surface.corners[2]]) - first},
      input.plane, crossing, weights, footprints);
  Lanes<const TextureUse*> maps;
  for (int i = 0; i < kSquarePixels; ++i) maps[i] = mask[i] ? &surface.material->normal_map : nullptr;
  const Lanes3<float> numbers = mapColors(input.scene, maps, place, footprints);
  const double scale = surface.material->normal_scale, face = surface.front_facing ? 1.0 : -1.0;
  for (int i = 0; i < kSquarePixels; ++i) {
    if (!mask[i]) continue;
    const glm::dvec3 normal =
        face * glm::dvec3(values.normal[0][i], values.normal[1][i], values.normal[2][i]);
    const glm::dvec4 given =
        tangentAt(surface, {1.0 - weights.second[i] - weights.third[i], weights.second[i], weights.third[i]});
    const glm::dvec3 across = given.w * glm::cross(normal, glm::dvec3(given));
    const glm::dvec3 slopes(scale * (2.0 * numbers[0][i] - 1.0), scale * (2.0 * numbers[1][i] - 1.0),
                            std::max(2.0 * numbers[2][i] - 1.0, 0.0));
    const double width = glm::length(across), length = glm::length(slopes);
    if (!(width > 1e-6) || !(length > 0x1p-8)) continue;
    const glm::dvec3 right = given.w * glm::cross(across, normal) / width;
    const glm::dvec3 bent =
        (slopes.x * right + slopes.y * across / width + slopes.z * normal) * (face / length);
    for (int c = 0; c < 3; ++c) values.normal[c][i] = float(bent[c]);
    values.lift[i] /= float(std::max(slopes.z / length, 0.5));
  }
}

/// The tangents of the pixels that see a surface.
void setTangents(const ResolveInput& input, const SeenSurface& seen, const SquareWeights& weights,
                 const LaneMask& mask, SquareValues& values) {
  Lanes3<double> along{};
  if (seen.has_tangent)
    for (int c = 0; c < 3; ++c) along[c] = interpolate(seen.tangent, c, weights);
  for (int i = 0; i < kSquarePixels; ++i)
    if (mask[i])
      values.tangent[i] = packNormal(
          tangentOf({along[0][i], along[1][i], along[2][i]},
                    {values.normal[0][i], values.normal[1][i], values.normal[2][i]}, input.world_to_view));
}

}  // namespace

SquarePlace squarePlace(const ViewPlane& plane, const glm::ivec2& first_pixel) {
  SquarePlace place;
  for (int i = 0; i < kSquarePixels; ++i) {
    place.x[i] = plane.offset.x + plane.scale.x * double(first_pixel.x + kSquareLayout.x[i]);
    place.y[i] = plane.offset.y + plane.scale.y * double(first_pixel.y + kSquareLayout.y[i]);
  }
  return place;
}

SquareValues valuesOf(const ResolveInput& input, const SeenSurface& seen, const SquarePlace& place,
                      const LaneMask& mask) {
  const Surface& surface = seen.surface;
  SquareValues values;
  const PlaneCrossing crossing = crossPlane(surface, place);
  const SquareWeights weights = clampInside(surface, place, mask, crossing.weights);
  // Relative to the first corner, so that small triangles far from the eye keep their precision.
  for (int c = 0; c < 3; ++c)
    values.position[c] = rounded(interpolate(surface.corner[c], surface.edge1[c], surface.edge2[c], weights));
  const Lanes3<double> normal{interpolate(seen.normal, 0, weights), interpolate(seen.normal, 1, weights),
                              interpolate(seen.normal, 2, weights)};
  normalize(normal, seen.facing_normal, values.normal);
  setLift(seen, weights, normal, values.lift);
  if (input.planes.unbent_normal) {
    for (int i = 0; i < kSquarePixels; ++i)
      values.surface_normal[i] = packNormal({values.normal[0][i], values.normal[1][i], values.normal[2][i]});
  } else {
    values.surface_normal.fill(seen.geometric_normal);
  }
  if (seen.has_normal_map) bendNormals(input, seen, place, crossing, weights, mask, values);
  if (input.planes.model) values.model.fill(modelNumber(surface.material->model));
  if (input.planes.tangent) setTangents(input, seen, weights, mask, values);
  if (input.planes.uv)
    for (int c = 0; c < 2; ++c) values.uv[c] = rounded(interpolate(seen.uv, c, weights));
  if (input.planes.object) values.object.fill(surface.object->number);
  if (input.planes.material)
    values.material.fill(std::uint32_t(surface.material - input.scene.materials.data()));
  setMaterial(input, seen, weights, values);
  if (seen.mapped) setMaps(input, seen, crossing, weights, mask, values);
  return values;
}

void copyValues(const SquareValues& values, const LaneMask& mask, const PlaneSet& planes, SquareValues& out) {
  copyComponents(values.position, mask, out.position);
  copyComponents(values.normal, mask, out.normal);
  copyComponents(values.diffuse, mask, out.diffuse);
  copyComponents(values.specular, mask, out.specular);
  copyComponents(values.ambient, mask, out.ambient);
  copyComponents(values.emission, mask, out.emission);
  copyLanes(values.surface_normal, mask, out.surface_normal);
  copyLanes(values.lift, mask, out.lift);
  if (planes.model) copyLanes(values.model, mask, out.model);
  if (planes.tangent) copyLanes(values.tangent, mask, out.tangent);
  if (planes.uv) copyComponents(values.uv, mask, out.uv);
  if (planes.object) copyLanes(values.object, mask, out.object);
  if (planes.material) copyLanes(values.material, mask, out.material);
  if (!values.mapped && !out.mapped) return;
  out.mapped = true;
  copyLanes(values.reflection_map, mask, out.reflection_map);
  copyLanes(values.emission_map, mask, out.emission_map);
  copyFootprints(values.footprints, mask, out.footprints);
  copyFootprints(values.emission_footprints, mask, out.emission_footprints);
}

void applyMaps(const Scene& scene, const SquarePlace& place, SquareValues& values) {
  if (!values.mapped) return;
  if (anyMap(values.reflection_map)) {
    const Lanes3<float> colors = mapColors(scene, values.reflection_map, place, values.footprints);
    multiply(colors, values.diffuse);
    multiply(colors, values.ambient);
  }
  if (anyMap(values.emission_map))
    multiply(mapColors(scene, values.emission_map, place, values.emission_footprints), values.emission);
}

}  // namespace luciole
