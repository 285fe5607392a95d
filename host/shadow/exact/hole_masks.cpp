#include "shadow/exact/hole_masks.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

#include "image/srgb.hpp"
#include "shadow/exact/placed_triangles.hpp"

namespace luciole {
namespace {

/// The most texels that masks can address.
constexpr std::size_t kMostTexels = std::size_t(1) << 31;
/// Limits, in texels, of what kernels/exact/hole_masks.clh may compute a place from.
constexpr double kMostPlace = 0x1p16, kMostCoordinate = 0x1p20;

/// Upper bound of the error of opacities. A lookup interpolates texels twice, with three roundings each, so
/// it exceeds them by 6·2⁻²⁴ < 2⁻²¹ at most. encodeSrgb has a slope of 12.92 at most and adds 4·2⁻²⁴; factors
/// round by 2⁻²⁴ each. The sum is below 2⁻¹⁷ + 2⁻²⁰.
constexpr float kMargin = 0x1p-16f;

/// Upper bound of the error of a mask's values: ½, plus the kernel's rounding.
constexpr float kValueMargin = 0.5f + 0x1p-10f;

unsigned char classify(float opacity, float factor, float cutoff) {
  const float margin = kMargin * std::max(1.0f, factor);
  return opacity >= cutoff + margin ? kSolid : opacity < cutoff - margin ? kHole : kMixed;
}

/// How the opacity of a material varies over surfaces.
struct MaterialHoles {
  unsigned char untextured = kMixed;  ///< on meshes without uvs
  unsigned char all = kMixed;         ///< on others, if it is constant
  const TextureUse* map = nullptr;    ///< the map of its mask; null: it has none
  int channel = 0;                    ///< of the map: 3, or 0 for the code of a grey one
  float factor = 0;                   ///< multiplies the map
  float solid_from = std::numeric_limits<float>::infinity(), hole_to = -solid_from;  ///< as HoleTriangle
  std::size_t first_texel = 0;
};

MaterialHoles holesOf(const Scene& scene, const Material& material) {
  MaterialHoles holes;
  const float cutoff = material.alpha_cutoff;
  holes.untextured = classify(material.alpha, material.alpha, cutoff);
  holes.factor = material.alpha;
  if (material.diffuse_map.texture >= 0) {
    const Texture& diffuse = scene.textures[std::size_t(material.diffuse_map.texture)];
    holes.channel = 3;
    if (diffuse.alpha_varies)
      holes.map = &material.diffuse_map;
    else
      holes.factor *= float(diffuse.levels[0].texels[3]) / 65535.0f;
  }
  if (material.alpha_map.texture >= 0) {
    if (holes.map) return holes.map = nullptr, holes;
    holes.map = &material.alpha_map;
    holes.channel = scene.textures[std::size_t(material.alpha_map.texture)].alpha_varies ? 3 : 0;
  }
  // Masks are made for texels that are mixed.
  if (holes.map && holes.map->nearest_magnified) return holes.map = nullptr, holes;
  if (!holes.map) holes.all = classify(holes.factor, holes.factor, cutoff);
  return holes;
}

/// A channel of a texel as sampleTexture() decodes it, from its code.
float valueOf(int code, int channel) {
  return channel == 3 ? float(code) / 65535.0f : linearOfSrgb16()[std::size_t(code)];
}

/// The first of the codes 0 to 65535 for which `holds` is false; 65536 if there is none. `holds` must be true
/// for all codes before it and false for all after it.
template <class Holds>
int firstFailing(const Holds& holds) {
  int first = 0, end = 65536;
  while (first < end) {
    const int middle = (first + end) / 2;
    if (holds(middle))
      first = middle + 1;
    else
      end = middle;
  }
  return first;
}

/// Sets solid_from and hole_to: the opacity grows with the code.
void setThresholds(float cutoff, MaterialHoles& holes) {
  const auto classOf = [&](int code) {
    const float value = valueOf(code, holes.channel);
    return classify(holes.factor * (holes.channel == 3 ? value : encodeSrgb(value)), holes.factor, cutoff);
  };
  const int solid = firstFailing([&](int code) { return classOf(code) != kSolid; });
  const int holed = firstFailing([&](int code) { return classOf(code) == kHole; });
  if (solid < 65536) holes.solid_from = 255.0f * valueOf(solid, holes.channel) + kValueMargin;
  if (holed > 0) holes.hole_to = 255.0f * valueOf(holed - 1, holes.channel) - kValueMargin;
}

/// The least and the greatest of some values.
struct Range {
  unsigned char least = 255, greatest = 0;
  void add(unsigned char value) {
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
};

/// Fills a mask, and returns the range of its texels.
Range fillMask(const MipLevel& mip, int channel, unsigned char* texels) {
  std::vector<unsigned char> bytes;  // of linear codes
  if (channel != 3) {
    bytes.resize(65536);
    for (int code = 0; code < 65536; ++code)
      bytes[std::size_t(code)] = static_cast<unsigned char>(255.0f * valueOf(code, channel) + 0.5f);
  }
  const std::size_t count = std::size_t(mip.width) * std::size_t(mip.height);
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count, 1 << 14), Range{},
      [&](const tbb::blocked_range<std::size_t>& part, Range range) {
        const std::uint16_t* const from = mip.texels.data() + channel;
        for (std::size_t i = part.begin(); i < part.end(); ++i) {
          const unsigned code = from[4 * i];
          texels[i] = channel == 3 ? static_cast<unsigned char>((code + 128) / 257) : bytes[code];
          range.add(texels[i]);
        }
        return range;
      },
      [](Range a, const Range& b) {
        a.add(b.least);
        a.add(b.greatest);
        return a;
      });
}

/// Materials with holes that triangles have.
std::vector<std::atomic<bool>> usedMaterials(const Scene& scene) {
  std::vector<std::atomic<bool>> used(scene.materials.size());
  tbb::parallel_for(std::size_t(0), scene.objects.size(), [&](std::size_t i) {
    const Object& object = scene.objects[i];
    if (object.material >= 0)
      used[std::size_t(object.material)].store(true, std::memory_order_relaxed);
    else
      for (const std::uint32_t material : scene.meshes[object.mesh].triangle_materials)
        if (scene.materials[material].alpha_cutoff > 0) used[material].store(true, std::memory_order_relaxed);
  });
  return used;
}

/// Fills the masks of all materials in use that have one.
std::vector<MaterialHoles> classifyMaterials(const Scene& scene, RawArray<unsigned char>& texels) {
  const std::vector<std::atomic<bool>> used = usedMaterials(scene);
  std::vector<MaterialHoles> all(scene.materials.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Material& material = scene.materials[i];
    if (material.alpha_cutoff <= 0 || !used[i]) continue;
    all[i] = holesOf(scene, material);
    if (!all[i].map) continue;
    const MipLevel& mip = scene.textures[std::size_t(all[i].map->texture)].levels.front();
    const std::size_t size = std::size_t(mip.width) * std::size_t(mip.height);
    if (size > kMostTexels - count) {
      all[i].map = nullptr;
      continue;
    }
    all[i].first_texel = count;
    count += size;
    setThresholds(material.alpha_cutoff, all[i]);
  }
  texels.resize(count);
  tbb::parallel_for(std::size_t(0), all.size(), [&](std::size_t i) {
    MaterialHoles& holes = all[i];
    if (!holes.map) return;
    const MipLevel& mip = scene.textures[std::size_t(holes.map->texture)].levels.front();
    const Range range = fillMask(mip, holes.channel, &texels[holes.first_texel]);
    if (float(range.least) >= holes.solid_from) holes.all = kSolid;
    if (float(range.greatest) <= holes.hole_to) holes.all = kHole;
  });
  return all;
}

/// Whether a mesh's colours leave the opacity as it is.
std::vector<char> opaqueColors(const Scene& scene) {
  std::vector<char> opaque(scene.meshes.size());
  tbb::parallel_for(std::size_t(0), opaque.size(), [&](std::size_t i) {
    const std::vector<glm::vec4>& colors = scene.meshes[i].colors;
    opaque[i] =
        std::all_of(colors.begin(), colors.end(), [](const glm::vec4& color) { return color.a == 1; });
  });
  return opaque;
}

/// A texture coordinate of a triangle, in texels of a mask: at corner a, and the differences to b and to c.
struct MaskCoordinates {
  double a, ab, ac;
  double largest;  ///< |coordinate|, or infinity if one isn't finite
};

MaskCoordinates maskCoordinates(const std::array<double, 3>& uv, int size, Wrap wrap) {
  const std::array<double, 3> at{uv[0] * size, uv[1] * size, uv[2] * size};
  const double period = wrap == Wrap::kRepeat ? size : 2.0 * size;
  MaskCoordinates places{at[0], at[1] - at[0], at[2] - at[0], 0};
  if (wrap != Wrap::kClampToEdge) places.a -= period * std::floor(at[0] / period);
  for (const double place : at)
    places.largest = std::max(places.largest, std::isfinite(place) ? std::abs(place) : INFINITY);
  return places;
}

HoleTriangle holeTriangle(const Scene& scene, const Mesh& mesh, const glm::uvec3& corners,
                          const MaterialHoles& holes) {
  HoleTriangle result{};
  if (!holes.map) return result;
  const MipLevel& mip = scene.textures[std::size_t(holes.map->texture)].levels.front();
  const auto along = [&](int axis, int size, Wrap wrap) {
    return maskCoordinates(
        {mesh.uvs[corners[0]][axis], mesh.uvs[corners[1]][axis], mesh.uvs[corners[2]][axis]}, size, wrap);
  };
  const MaskCoordinates x = along(0, mip.width, holes.map->wrap_u),
                        y = along(1, mip.height, holes.map->wrap_v);
  const double largest = std::max(x.largest, y.largest);
  if (largest > kMostCoordinate) return result;
  const double extent = std::max({1.0, std::abs(x.ab), std::abs(x.ac), std::abs(y.ab), std::abs(y.ac)});
  const double first = std::max(std::abs(x.a), std::abs(y.a));
  if (std::max(first, extent) > kMostPlace) return result;
  result.a_x = float(x.a);
  result.a_y = float(y.a);
  result.ab_x = float(x.ab);
  result.ab_y = float(y.ab);
  result.ac_x = float(x.ac);
  result.ac_y = float(y.ac);
  result.extent = float(extent);
  result.slack = float(0x1p-24 * (14 * extent + 9 * (first + 3 * extent) + largest));
  result.solid_from = holes.solid_from;
  result.hole_to = holes.hole_to;
  result.first_texel = uint(holes.first_texel);
  result.width = uint(mip.width);
  result.height = uint(mip.height);
  result.wrap_u = uint(holes.map->wrap_u);
  result.wrap_v = uint(holes.map->wrap_v);
  return result;
}
static_assert(int(Wrap::kRepeat) == kWrapRepeat && int(Wrap::kMirroredRepeat) == kWrapMirrored &&
              int(Wrap::kClampToEdge) == kWrapClamped);

}  // namespace

HoleMasks makeHoleMasks(const Scene& scene, const TriangleTree& tree) {
  HoleMasks masks;
  const std::vector<MaterialHoles> materials = classifyMaterials(scene, masks.texels);
  const std::vector<char> opaque = opaqueColors(scene);
  const PlacedTriangles placed = placeTriangles(scene, tree.origin, tree.scale);
  struct Place {
    const Mesh& mesh;
    glm::uvec3 corners;
    const MaterialHoles& holes;
    bool opaque;
  };
  const auto find = [&](std::size_t block, int slot) {
    const std::uint32_t triangle = tree.triangles[block * kTreeWidth + std::size_t(slot)];
    const std::uint32_t object = objectOf(placed, triangle), in_mesh = triangle - placed.first[object];
    const std::uint32_t mesh = scene.objects[object].mesh;
    return Place{scene.meshes[mesh], scene.meshes[mesh].triangles[in_mesh],
                 materials[materialOfTriangle(placed, object, triangle)], opaque[mesh] != 0};
  };
  const std::size_t blocks = tree.block_bits.size();
  masks.block_bits.resize(blocks);
  tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
    uint bits = tree.block_bits[block];
    for (uint left = bits >> 16; left != 0; left &= left - 1) {
      const int slot = std::countr_zero(left);
      const Place place = find(block, slot);
      if (!place.opaque) continue;
      const unsigned char all = place.mesh.uvs.empty() ? place.holes.untextured : place.holes.all;
      if (all != kMixed) bits &= ~(1u << (16 + slot));
      if (all == kHole) bits &= ~(1u << slot);
    }
    masks.block_bits[block] = bits;
  });
  masks.first_triangle.resize(blocks);
  uint count = 0;
  for (std::size_t block = 0; block < blocks; ++block) {
    masks.first_triangle[block] = count;
    count += uint(std::popcount(masks.block_bits[block] >> 16));
  }
  masks.triangles.resize(count);
  tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
    uint next = masks.first_triangle[block];
    for (uint left = masks.block_bits[block] >> 16; left != 0; left &= left - 1) {
      const Place place = find(block, std::countr_zero(left));
      masks.triangles[next++] = place.opaque && !place.mesh.uvs.empty()
                                    ? holeTriangle(scene, place.mesh, place.corners, place.holes)
                                    : HoleTriangle{};
    }
  });
  return masks;
}

}  // namespace luciole
