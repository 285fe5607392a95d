#include "raster/opacity.hpp"

#include "image/srgb.hpp"

namespace luciole {
namespace {

bool alphaVaries(const Texture& texture) {
  const std::vector<std::uint16_t>& texels = texture.levels[0].texels;
  for (std::size_t i = 3; i < texels.size(); i += 4)
    if (texels[i] != texels[3]) return true;
  return false;
}

}  // namespace

std::vector<bool> findVaryingAlpha(const Scene& scene) {
  std::vector<bool> varying(scene.textures.size());
  for (const Material& material : scene.materials) {
    if (material.alpha_cutoff == 0.0f) continue;
    for (const int map : {material.diffuse_map.texture, material.alpha_map.texture})
      if (map >= 0 && !varying[map]) varying[map] = alphaVaries(scene.textures[map]);
  }
  return varying;
}

float opacityAt(const Scene& scene, const std::vector<bool>& varying_alpha, const Surface& surface,
                const Weights& weights, const TexturePlace& place) {
  const Material& material = *surface.material;
  float opacity = material.alpha * vertexColor(surface, weights).a;
  if (surface.object->mesh->uvs.empty()) return opacity;
  const int diffuse = material.diffuse_map.texture;
  if (diffuse >= 0)
    opacity *= varying_alpha[diffuse] ? lookUp(scene, material.diffuse_map, place, 3)
                                      : scene.textures[diffuse].levels[0].texels[3] / 65535.0f;
  // Where one map says that nothing is there, the other needn't be looked at.
  const int alpha = material.alpha_map.texture;
  if (alpha >= 0 && opacity > 0.0f) {
    // An opacity map in grey is a picture of numbers: its codes count, not the light they would stand for.
    opacity *= varying_alpha[alpha] ? lookUp(scene, material.alpha_map, place, 3)
                                    : encodeSrgb(lookUp(scene, material.alpha_map, place, 0));
  }
  return opacity;
}

bool isHole(const Scene& scene, const std::vector<bool>& varying_alpha, const Surface& surface,
            const ViewPlane& plane, int x, int y) {
  const Material& material = *surface.material;
  const Weights weights = weightsInside(surface, plane.at(x, y));
  const bool textured = material.diffuse_map.texture >= 0 || material.alpha_map.texture >= 0;
  const TexturePlace place = textured && !surface.object->mesh->uvs.empty()
                                 ? texturePlace(surface, plane, x, y, weights)
                                 : TexturePlace{};
  return opacityAt(scene, varying_alpha, surface, weights, place) < material.alpha_cutoff;
}

}  // namespace luciole
