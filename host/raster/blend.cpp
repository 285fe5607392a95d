#include "raster/blend.hpp"

#include <algorithm>

#include "base/random.hpp"

namespace luciole {
namespace {

/// Element i of a random permutation of 0 … count − 1. A. Kensler, "Correlated multi-jittered sampling",
/// 2013: an invertible hash on the next power of two, repeated until the result is below count.
std::uint32_t permuted(std::uint32_t i, std::uint32_t count, std::uint32_t seed) {
  std::uint32_t mask = count - 1;
  for (int shift = 1; shift < 32; shift *= 2) mask |= mask >> shift;
  do {
    i ^= seed;
    i *= 0xe170893du;
    i ^= seed >> 16;
    i ^= (i & mask) >> 4;
    i ^= seed >> 8;
    i *= 0x0929eb3fu;
    i ^= seed >> 23;
    i ^= (i & mask) >> 1;
    i *= 1 | seed >> 27;
    i *= 0x6935fa69u;
    i ^= (i & mask) >> 11;
    i *= 0x74dcb303u;
    i ^= (i & mask) >> 2;
    i *= 0x9e501cc3u;
    i ^= (i & mask) >> 2;
    i *= 0xc860a3dfu;
    i &= mask;
    i ^= i >> 5;
  } while (i >= count);
  return (i + seed) % count;
}

/// Whether a material's opacity may be below 1 on a mesh whose vertices leave it as it is.
bool mayBeTransparent(const Scene& scene, const Material& material, const Mesh& mesh) {
  if (material.alpha < 1) return true;
  if (mesh.uvs.empty()) return false;
  const int diffuse = material.diffuse_map.texture;
  const auto hasAlpha = [](const Texture& texture) {
    return texture.alpha_varies || texture.levels[0].texels[3] < 65535;
  };
  return material.alpha_map.texture >= 0 || (diffuse >= 0 && hasAlpha(scene.textures[std::size_t(diffuse)]));
}

}  // namespace

std::uint64_t blendSurface(std::uint32_t object, std::uint32_t triangle_or_quad, bool front) {
  return std::uint64_t(object) << 33 ^ std::uint64_t(triangle_or_quad) << 1 ^ std::uint64_t(front);
}

double blendThreshold(std::uint64_t surface, const glm::ivec2& pixel, const SampleNumber& sample) {
  std::uint64_t state = std::uint64_t(std::uint32_t(pixel.y)) << 32 | std::uint32_t(pixel.x);
  state = nextBits(state) ^ surface;
  const std::uint64_t bits = nextBits(state);
  const std::uint32_t count = std::uint32_t(sample.count);
  // The sum is exact, and the quotient at most 1 − 2⁻³² / count, which is a double for the counts that there
  // are.
  return (permuted(std::uint32_t(sample.index), count, std::uint32_t(bits)) +
          double(std::uint32_t(bits >> 32)) * 0x1p-32) /
         double(count);
}

std::vector<std::uint32_t> blendedMaterials(const Scene& scene) {
  const auto isBlended = [](const Material& material) { return material.blended; };
  if (std::none_of(scene.materials.begin(), scene.materials.end(), isBlended)) return {};
  std::vector<bool> found(scene.materials.size(), false);
  for (const Object& object : scene.objects) {
    const Mesh& mesh = scene.meshes[object.mesh];
    const bool clear_vertices = std::any_of(mesh.colors.begin(), mesh.colors.end(),
                                            [](const glm::vec4& color) { return color.a < 1; });
    const auto check = [&](std::uint32_t index) {
      const Material& material = scene.materials[index];
      if (material.blended && !found[index])
        found[index] = clear_vertices || mayBeTransparent(scene, material, mesh);
    };
    if (object.material >= 0)
      check(std::uint32_t(object.material));
    else
      std::for_each(mesh.triangle_materials.begin(), mesh.triangle_materials.end(), check);
  }
  std::vector<std::uint32_t> materials;
  for (std::uint32_t i = 0; i < found.size(); ++i)
    if (found[i]) materials.push_back(i);
  return materials;
}

}  // namespace luciole
