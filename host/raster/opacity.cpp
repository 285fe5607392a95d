#include "raster/opacity.hpp"

#include "image/srgb.hpp"

namespace luciole {

float opacityAt(const Scene& scene, const Surface& surface, const Weights& weights,
                const TexturePlace& place) {
  const Material& material = *surface.material;
  float opacity = material.alpha * vertexColor(surface, weights).a;
  if (surface.object->mesh->uvs.empty()) return opacity;
  if (material.diffuse_map.texture >= 0) {
    const Texture& diffuse = scene.textures[material.diffuse_map.texture];
    opacity *= diffuse.alpha_varies ? lookUp(scene, material.diffuse_map, place, 3)
                                    : diffuse.levels[0].texels[3] / 65535.0f;
  }
  // Where the opacity is 0 already, the second map is not looked up.
  const int alpha = material.alpha_map.texture;
  if (alpha >= 0 && opacity > 0.0f) {
    // A grey opacity map holds plain numbers, not sRGB colours: the code counts, not the linear value.
    opacity *= scene.textures[alpha].alpha_varies ? lookUp(scene, material.alpha_map, place, 3)
                                                  : encodeSrgb(lookUp(scene, material.alpha_map, place, 0));
  }
  return opacity;
}

bool isHole(const Scene& scene, const Surface& surface, const ViewPlane& plane, double x, double y) {
  const Material& material = *surface.material;
  const Weights weights = weightsInside(surface, plane.at(x, y));
  const bool textured = material.diffuse_map.texture >= 0 || material.alpha_map.texture >= 0;
  const TexturePlace place = textured && !surface.object->mesh->uvs.empty()
                                 ? texturePlace(surface, plane, x, y, weights)
                                 : TexturePlace{};
  return opacityAt(scene, surface, weights, place) < material.alpha_cutoff;
}

}  // namespace luciole
