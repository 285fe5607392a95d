#include "raster/resolve.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "raster/sample_texture.hpp"
#include "raster/square.hpp"

namespace luciole {
namespace {

/// Surfaces of the triangles seen last, by their number's lowest bits: neighbours mostly have numbers near
/// each other.
class SurfaceCache {
 public:
  explicit SurfaceCache(const ResolveInput& input) : input_(input) { triangles_.fill(kNoTriangle); }
  const Surface& operator[](std::uint32_t triangle) {
    const std::size_t slot = triangle % kSlots;
    if (triangles_[slot] != triangle) {
      surfaces_[slot] = makeSurface(input_.scene, input_.geometry, triangle, input_.plane);
      triangles_[slot] = triangle;
    }
    return surfaces_[slot];
  }

 private:
  static constexpr std::size_t kSlots = 128;
  const ResolveInput& input_;
  std::array<std::uint32_t, kSlots> triangles_;
  std::array<Surface, kSlots> surfaces_;
};

/// What a square's pixels show, in the groups of a G-buffer.
struct SquareValues {
  Lanes3<float> position{};
  Lanes3<float> normal{};
  Lanes3<float> diffuse{};
  std::array<Lanes<float>, 4> specular{};
  Lanes3<float> ambient{};
  Lanes3<float> emission{};
};

SquareValues nothingSeen() {
  SquareValues values;
  values.position[2].fill(-std::numeric_limits<float>::infinity());
  return values;
}

/// The pixels of a square that see one surface.
struct SeenSquare {
  const Surface& surface;
  glm::ivec2 first;  ///< its top left pixel, counted in the whole picture
  LaneMask seen;
};

/// Takes over the values of the pixels that see the surface.
void put(const Lanes<float>& values, const LaneMask& seen, Lanes<float>& out) {
  for (int i = 0; i < kSquarePixels; ++i) out[i] = seen[i] ? values[i] : out[i];
}
void put(const Lanes3<float>& values, const LaneMask& seen, Lanes3<float>& out) {
  for (int c = 0; c < 3; ++c) put(values[c], seen, out[c]);
}
void put(float value, const LaneMask& seen, Lanes<float>& out) {
  for (int i = 0; i < kSquarePixels; ++i) out[i] = seen[i] ? value : out[i];
}

/// The weights of the surface's corners at the square's places, in its plane.
std::array<Places<double>, 3> weightsInPlane(const SeenSquare& square, const ViewPlane& plane) {
  std::array<Places<double>, 3> result;
  const Surface surface = square.surface;
  for (int i = 0; i < kSquarePlaces; ++i) {
    const glm::dvec3 p = plane.at(square.first.x + kSquareLayout.x[i], square.first.y + kSquareLayout.y[i]);
    const Weights weights = weightsInPlane(surface, p);
    for (int corner = 0; corner < 3; ++corner) result[corner][i] = weights[corner];
  }
  return result;
}

/// The same at its pixels, held inside the triangle.
Lanes3<double> weightsInside(const SeenSquare& square, const ViewPlane& plane,
                             const std::array<Places<double>, 3>& in_plane) {
  Lanes3<double> result;
  Lanes<std::int32_t> outside;
  for (int corner = 0; corner < 3; ++corner)
    for (int i = 0; i < kSquarePixels; ++i) result[corner][i] = in_plane[corner][i];
  std::int32_t any = 0;
  for (int i = 0; i < kSquarePixels; ++i) {
    const bool inside = (result[0][i] >= 0.0) & (result[1][i] >= 0.0) & (result[2][i] >= 0.0);
    outside[i] = square.seen[i] & !inside;
    any |= outside[i];
  }
  if (!any) return result;
  for (int i = 0; i < kSquarePixels; ++i) {
    if (!outside[i]) continue;
    const Weights weights = weightsInside(
        square.surface, plane.at(square.first.x + kSquareLayout.x[i], square.first.y + kSquareLayout.y[i]));
    for (int corner = 0; corner < 3; ++corner) result[corner][i] = weights[corner];
  }
  return result;
}

Lanes3<float> positions(const Surface& surface, const Lanes3<double>& weights) {
  Lanes3<float> result;
  for (int c = 0; c < 3; ++c) {
    // From the first corner, so that the edges' digits count, not the distance's.
    const double corner = surface.corner[c], edge1 = surface.edge1[c], edge2 = surface.edge2[c];
    for (int i = 0; i < kSquarePixels; ++i)
      result[c][i] = float(corner + weights[1][i] * edge1 + weights[2][i] * edge2);
  }
  return result;
}

Lanes3<float> normals(const Surface& surface, const Lanes3<double>& weights, Shading shading) {
  const glm::dvec3 own = surface.front_facing ? surface.normal : -surface.normal;
  Lanes3<float> result;
  if (shading == Shading::kFlat) {
    for (int c = 0; c < 3; ++c) result[c].fill(float(own[c]));
    return result;
  }
  const glm::vec3* of_vertex = surface.object->mesh->normals.data();
  const glm::dvec3 a(of_vertex[surface.corners[0]]);
  const glm::dvec3 b(of_vertex[surface.corners[1]]);
  const glm::dvec3 c(of_vertex[surface.corners[2]]);
  const glm::dmat3 to_view = surface.object->normal_to_view;
  const double side = surface.front_facing ? 1.0 : -1.0;
  for (int i = 0; i < kSquarePixels; ++i) {
    const glm::dvec3 sum = to_view * (weights[0][i] * a + weights[1][i] * b + weights[2][i] * c);
    const double length = std::sqrt(glm::dot(sum, sum));
    const bool usable = (length > 0.0) & (length <= std::numeric_limits<double>::max());
    for (int axis = 0; axis < 3; ++axis)
      result[axis][i] = float(usable ? side * (sum[axis] / length) : own[axis]);
  }
  return result;
}

/// What the maps and the vertex colours multiply into a surface's reflection and emission.
struct Tint {
  Lanes3<float> reflection;
  Lanes3<float> emission;
};

/// A pair of steps is used only where both are finite.
void clearUnlessFinite(Lanes<float>& x, Lanes<float>& y) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  for (int i = 0; i < kSquarePixels; ++i) {
    const bool finite = (std::abs(x[i]) <= kLargest) & (std::abs(y[i]) <= kLargest);
    x[i] = finite ? x[i] : 0.0f;
    y[i] = finite ? y[i] : 0.0f;
  }
}

SquareFootprints footprints(const Surface& surface, const std::array<Places<double>, 3>& in_plane,
                            const Lanes3<double>& weights) {
  const glm::vec2* uvs = surface.object->mesh->uvs.data();
  SquareFootprints result;
  for (int axis = 0; axis < 2; ++axis) {
    const double a = uvs[surface.corners[0]][axis];
    const double b = uvs[surface.corners[1]][axis];
    const double c = uvs[surface.corners[2]][axis];
    Lanes<float>& at = axis == 0 ? result.u : result.v;
    for (int i = 0; i < kSquarePixels; ++i)
      at[i] = float(weights[0][i] * a + weights[1][i] * b + weights[2][i] * c);
    Places<double> plane;
    for (int i = 0; i < kSquarePlaces; ++i)
      plane[i] = in_plane[0][i] * a + in_plane[1][i] * b + in_plane[2][i] * c;
    Lanes<float>& to_right = axis == 0 ? result.du_dx : result.dv_dx;
    Lanes<float>& down = axis == 0 ? result.du_dy : result.dv_dy;
    for (int i = 0; i < kSquarePixels; ++i) {
      to_right[i] = float(plane[kSquareLayout.right[i]] - plane[i]);
      down[i] = float(plane[kSquareLayout.below[i]] - plane[i]);
    }
  }
  clearUnlessFinite(result.du_dx, result.dv_dx);
  clearUnlessFinite(result.du_dy, result.dv_dy);
  return result;
}

Tint tints(const ResolveInput& input, const SeenSquare& square, const std::array<Places<double>, 3>& in_plane,
           const Lanes3<double>& weights) {
  Tint tint;
  for (int c = 0; c < 3; ++c) {
    tint.reflection[c].fill(1.0f);
    tint.emission[c].fill(1.0f);
  }
  const Material& material = *square.surface.material;
  const bool mapped = material.diffuse_map.texture >= 0 || material.emission_map.texture >= 0;
  if (!mapped || square.surface.object->mesh->uvs.empty()) return tint;
  const SquareFootprints places = footprints(square.surface, in_plane, weights);
  const auto look_up = [&](const TextureUse& map) {
    return sampleTexture(input.scene.textures[map.texture], map.wrap_u, map.wrap_v, places, square.seen);
  };
  if (material.diffuse_map.texture >= 0) tint.reflection = look_up(material.diffuse_map);
  if (material.emission_map.texture >= 0) tint.emission = look_up(material.emission_map);
  return tint;
}

Lanes3<float> times(const Lanes3<float>& values, const glm::vec3& factor) {
  Lanes3<float> result;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < kSquarePixels; ++i) result[c][i] = factor[c] * values[c][i];
  return result;
}

void resolveSurface(const ResolveInput& input, const SeenSquare& square, SquareValues& out) {
  const Surface& surface = square.surface;
  const Material& material = *surface.material;
  const std::array<Places<double>, 3> in_plane = weightsInPlane(square, input.plane);
  const Lanes3<double> weights = weightsInside(square, input.plane, in_plane);
  put(positions(surface, weights), square.seen, out.position);
  put(normals(surface, weights, input.shading), square.seen, out.normal);
  Tint tint = tints(input, square, in_plane, weights);
  const auto weights_of = [&](int i) { return Weights(weights[0][i], weights[1][i], weights[2][i]); };
  if (input.shading == Shading::kGouraud && !input.vertex_colors.empty()) {
    const glm::vec3* colors = input.vertex_colors.data() + surface.object->first_vertex;
    for (int i = 0; i < kSquarePixels; ++i) {
      const glm::vec3 color(interpolate(colors, surface.corners, weights_of(i)));
      for (int c = 0; c < 3; ++c) tint.reflection[c][i] *= color[c];
    }
    put(tint.reflection, square.seen, out.emission);
    return;
  }
  if (!surface.object->mesh->colors.empty()) {
    for (int i = 0; i < kSquarePixels; ++i) {
      const glm::vec4 color = vertexColor(surface, weights_of(i));
      for (int c = 0; c < 3; ++c) tint.reflection[c][i] *= color[c];
    }
  }
  put(times(tint.reflection, material.diffuse), square.seen, out.diffuse);
  put(times(tint.reflection, material.ambient), square.seen, out.ambient);
  put(times(tint.emission, material.emission), square.seen, out.emission);
  for (int c = 0; c < 3; ++c) put(material.specular[c], square.seen, out.specular[c]);
  put(material.shininess, square.seen, out.specular[3]);
}

/// Into a group of planes, unless the G-buffer does without it.
void store(std::span<const Lanes<float>> values, std::size_t place, const LaneMask& mask, bool whole,
           Plane& group) {
  if (group.empty()) return;
  const std::size_t stride = group.size() / values.size();
  for (std::size_t c = 0; c < values.size(); ++c) {
    float* out = group.data() + c * stride + place;
    if (whole) {
      std::copy(values[c].begin(), values[c].end(), out);
    } else {
      for (int i = 0; i < kSquarePixels; ++i)
        if (mask[i]) out[i] = values[c][i];
    }
  }
}

}  // namespace

void resolveBin(const ResolveInput& input, const BinPixels& pixels, glm::ivec2 bin_origin, GBuffer& gbuffer) {
  const glm::ivec2 crop = gbuffer.crop_origin;
  const glm::ivec2 first = glm::max(bin_origin, crop);
  const glm::ivec2 end = glm::min(bin_origin + kBinSize, crop + glm::ivec2(gbuffer.width, gbuffer.height));
  // Squares, like tiles, count from the crop, and bins from the picture, so a square may lie in several bins.
  const glm::ivec2 first_square = crop + (first - crop) / kSquareSize * kSquareSize;
  SurfaceCache surfaces(input);
  for (int y = first_square.y; y < end.y; y += kSquareSize) {
    for (int x = first_square.x; x < end.x; x += kSquareSize) {
      const bool whole = x >= first.x && y >= first.y && x + kSquareSize <= end.x && y + kSquareSize <= end.y;
      const int corner = (y - bin_origin.y) * kBinSize + (x - bin_origin.x);
      Lanes<std::uint32_t> triangles;
      LaneMask drawn;
      bool any = false;
      for (int i = 0; i < kSquarePixels; ++i) {
        const glm::ivec2 at(x + kSquareLayout.x[i], y + kSquareLayout.y[i]);
        const bool inside = whole || (at.x >= first.x && at.y >= first.y && at.x < end.x && at.y < end.y);
        triangles[i] = inside ? pixels.triangle[corner + kSquareLayout.y[i] * kBinSize + kSquareLayout.x[i]]
                              : kNoTriangle;
      }
      for (int i = 0; i < kSquarePixels; ++i) {
        drawn[i] = triangles[i] != kNoTriangle;
        any |= drawn[i] != 0;
      }
      if (!any) continue;
      SquareValues values = nothingSeen();
      for (int i = 0; i < kSquarePixels; ++i) {
        const std::uint32_t triangle = triangles[i];
        if (triangle == kNoTriangle) continue;
        SeenSquare square{surfaces[triangle], {x, y}, {}};
        for (int lane = 0; lane < kSquarePixels; ++lane) {
          square.seen[lane] = triangles[lane] == triangle;
          triangles[lane] = square.seen[lane] ? kNoTriangle : triangles[lane];
        }
        resolveSurface(input, square, values);
      }
      const std::size_t place = gbuffer.index(x - crop.x, y - crop.y);
      store(values.position, place, drawn, whole, gbuffer.position);
      store(values.normal, place, drawn, whole, gbuffer.normal);
      store(values.diffuse, place, drawn, whole, gbuffer.diffuse);
      store(values.specular, place, drawn, whole, gbuffer.specular);
      store(values.ambient, place, drawn, whole, gbuffer.ambient);
      store(values.emission, place, drawn, whole, gbuffer.emission);
    }
  }
}

}  // namespace luciole
