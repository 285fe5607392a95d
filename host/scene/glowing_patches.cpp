#include "scene/glowing_patches.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "image/srgb.hpp"
#include "scene/luminance.hpp"
#include "scene/z_curve.hpp"

namespace luciole {
namespace {

/// Pieces that a light's part has at least, so that it lies near the middle of its own.
constexpr double kPiecesOfPart = 16;
constexpr double kMostPieces = 1 << 22;
constexpr double kMostSteps = 512;

/// A texture's coordinate from 0 to 1.
double wrapped(double u, Wrap wrap) {
  if (wrap == Wrap::kClampToEdge) return std::clamp(u, 0.0, 1.0);
  if (wrap == Wrap::kRepeat) return u - std::floor(u);
  const double turn = u - 2 * std::floor(u / 2);
  return turn <= 1 ? turn : 2 - turn;
}

/// The texel of a texture at (u, v), linear, of the level whose texels are about as large as `extent`, in
/// texels of the finest.
glm::vec3 texelAt(const Texture& texture, const TextureUse& use, const glm::dvec2& uv, double extent) {
  const int finest = int(texture.levels.size()) - 1;
  const int number = std::clamp(int(std::lround(std::log2(std::max(extent, 1.0)))), 0, finest);
  const MipLevel& level = texture.levels[std::size_t(number)];
  const auto place = [](double u, int size) { return std::min(int(u * size), size - 1); };
  const std::size_t at = std::size_t(place(wrapped(uv.y, use.wrap_v), level.height)) * level.width +
                         place(wrapped(uv.x, use.wrap_u), level.width);
  glm::vec3 color;
  for (int c = 0; c < 3; ++c) {
    const std::uint16_t code = level.texels[4 * at + std::size_t(c)];
    color[c] = number == 0 ? linearOfSrgb16()[code] : linearOfRoot16(code);
  }
  return color;
}

/// A triangle that glows.
struct GlowingTriangle {
  std::array<glm::dvec3, 3> corner;  // world
  std::array<glm::dvec2, 3> uv{};
  glm::dvec3 normal;  // unit
  glm::vec3 radiance;
  double area, extent = 0;  // extent: its longest edge in texels; 0: it has no texture
  const Material* material;
};

std::vector<GlowingTriangle> glowingTriangles(const Scene& scene, const Object& object,
                                              std::optional<std::uint32_t> of_material) {
  const Mesh& mesh = scene.meshes[object.mesh];
  const double side = glm::determinant(glm::dmat3(object.object_to_world)) < 0 ? -1 : 1;
  std::vector<GlowingTriangle> triangles;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t number =
        object.material >= 0 ? std::uint32_t(object.material) : mesh.triangle_materials[i];
    const Material& material = scene.materials[number];
    if ((of_material && number != *of_material) || material.emission == glm::vec3(0.0f)) continue;
    GlowingTriangle triangle{};
    triangle.material = &material;
    triangle.radiance = material.emission;
    glm::vec3 tint(0.0f);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[i][k];
      triangle.corner[std::size_t(k)] =
          glm::dvec3(object.object_to_world * glm::dvec4(mesh.positions[vertex], 1));
      if (!mesh.colors.empty()) tint += glm::vec3(mesh.colors[vertex]) / 3.0f;
    }
    if (material.colored_emission && !mesh.colors.empty()) triangle.radiance *= tint;
    const auto& [a, b, c] = triangle.corner;
    const glm::dvec3 across = glm::cross(b - a, c - a);
    const double length = glm::length(across);
    if (!(length > 0)) continue;
    triangle.area = 0.5 * length;
    triangle.normal = across * (side / length);
    const std::vector<glm::vec2>& uvs = mesh.emission_uvs.empty() ? mesh.uvs : mesh.emission_uvs;
    if (material.emission_map.texture >= 0 && !uvs.empty()) {
      const MipLevel& texels = scene.textures[std::size_t(material.emission_map.texture)].levels[0];
      for (int k = 0; k < 3; ++k) triangle.uv[std::size_t(k)] = uvs[mesh.triangles[i][k]];
      for (std::size_t k = 0; k < 3; ++k)
        triangle.extent = std::max(triangle.extent, glm::length((triangle.uv[(k + 1) % 3] - triangle.uv[k]) *
                                                                glm::dvec2(texels.width, texels.height)));
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

/// A piece of a triangle.
struct Piece {
  glm::dvec3 place;
  glm::vec3 radiance;
  double area;
  std::uint32_t triangle;
  std::uint64_t order = 0;  // on the Z curve

  double light() const { return area * glm::dot(kLuminance, glm::dvec3(radiance)); }
};

/// Cuts a triangle into steps² pieces of one size.
void cut(const Scene& scene, const GlowingTriangle& triangle, std::uint32_t number, int steps,
         Piece* pieces) {
  const auto& [a, b, c] = triangle.corner;
  const TextureUse& map = triangle.material->emission_map;
  for (int row = 0; row < steps; ++row)
    for (int i = 0; i < 2 * (steps - row) - 1; ++i) {
      // Every other one stands on its head.
      const int column = i / 2;
      const double third = i % 2 == 0 ? 1.0 / 3 : 2.0 / 3;
      const double v = (column + third) / steps, w = (row + third) / steps, u = 1 - v - w;
      Piece piece{u * a + v * b + w * c, triangle.radiance, triangle.area / (double(steps) * steps), number};
      if (triangle.extent > 0)
        piece.radiance *=
            texelAt(scene.textures[std::size_t(map.texture)], map,
                    u * triangle.uv[0] + v * triangle.uv[1] + w * triangle.uv[2], triangle.extent / steps);
      *pieces++ = piece;
    }
}

/// Sorts pieces along a Z curve through the box around them.
void sortAlongCurve(std::vector<Piece>& pieces) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const Piece& piece : pieces) {
    low = glm::min(low, piece.place);
    high = glm::max(high, piece.place);
  }
  const glm::dvec3 sides = high - low;
  const double scale = 0x1p20 / std::max({sides.x, sides.y, sides.z, std::numeric_limits<double>::min()});
  for (Piece& piece : pieces) {
    const glm::dvec3 at = (piece.place - low) * scale;
    piece.order = everyThirdBit(std::uint64_t(at.x)) | everyThirdBit(std::uint64_t(at.y)) << 1 |
                  everyThirdBit(std::uint64_t(at.z)) << 2;
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.order < b.order; });
}

/// What a light stands for: pieces that follow each other. It lies in the piece that is nearest to their
/// middle.
GlowingPatch join(std::span<const Piece> pieces, const std::vector<GlowingTriangle>& triangles) {
  GlowingPatch patch;
  glm::dvec3 middle(0.0), radiance(0.0);
  double light = 0;
  for (const Piece& piece : pieces) {
    middle += piece.light() * piece.place;
    radiance += piece.area * glm::dvec3(piece.radiance);
    light += piece.light();
    patch.area += piece.area;
  }
  middle /= light;
  const Piece& nearest = *std::min_element(pieces.begin(), pieces.end(), [&](const Piece& a, const Piece& b) {
    return glm::distance(a.place, middle) < glm::distance(b.place, middle);
  });
  patch.radiance = glm::vec3(radiance / patch.area);
  patch.place = nearest.place;
  patch.normal = triangles[nearest.triangle].normal;
  patch.double_sided = triangles[nearest.triangle].material->double_sided;
  return patch;
}

}  // namespace

bool glows(const Scene& scene, const Object& object) {
  const auto shines = [&](std::uint32_t material) {
    return scene.materials[material].emission != glm::vec3(0.0f);
  };
  const std::vector<std::uint32_t>& materials = scene.meshes[object.mesh].triangle_materials;
  return object.material >= 0 ? shines(std::uint32_t(object.material))
                              : std::any_of(materials.begin(), materials.end(), shines);
}

std::vector<GlowingPatch> glowingPatches(const Scene& scene, const Object& object,
                                         std::optional<std::uint32_t> material, std::uint32_t count) {
  const std::vector<GlowingTriangle> triangles = glowingTriangles(scene, object, material);
  double area = 0;
  for (const GlowingTriangle& triangle : triangles) area += triangle.area;
  // As many pieces as lights need and textures have texels, or fewer of each where those would be too many.
  const auto stepsOf = [&](const GlowingTriangle& triangle, double share) {
    const double needed = std::sqrt(kPiecesOfPart * count * triangle.area / area);
    return std::clamp(std::ceil(share * std::max(needed, triangle.extent)), 1.0, kMostSteps);
  };
  double share = 1, wanted = std::numeric_limits<double>::infinity();
  for (; share > 0x1p-10 && wanted > kMostPieces; share /= 2) {
    wanted = 0;
    for (const GlowingTriangle& triangle : triangles)
      wanted += stepsOf(triangle, share) * stepsOf(triangle, share);
    if (wanted <= kMostPieces) break;
  }
  std::vector<std::size_t> first{0};
  for (const GlowingTriangle& triangle : triangles) {
    const auto steps = std::size_t(stepsOf(triangle, share));
    first.push_back(first.back() + steps * steps);
  }
  std::vector<Piece> pieces(first.back());
  tbb::parallel_for(std::size_t(0), triangles.size(), [&](std::size_t i) {
    cut(scene, triangles[i], std::uint32_t(i), int(stepsOf(triangles[i], share)), &pieces[first[i]]);
  });
  std::erase_if(pieces, [](const Piece& piece) { return !(piece.light() > 0); });
  sortAlongCurve(pieces);
  double whole = 0;
  for (const Piece& piece : pieces) whole += piece.light();
  std::vector<GlowingPatch> patches;
  double reached = 0;
  for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
    const double until = whole * double(patches.size() + 1) / count;
    // A piece belongs to the part in which its middle is.
    do {
      reached += pieces[end].light();
      ++end;
    } while (end < pieces.size() && reached + 0.5 * pieces[end].light() < until);
    patches.push_back(join(std::span(pieces).subspan(begin, end - begin), triangles));
  }
  return patches;
}

}  // namespace luciole
