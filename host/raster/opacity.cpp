#include "raster/opacity.hpp"

#include <cmath>
#include <limits>

#include "image/srgb.hpp"
#include "raster/blend.hpp"
#include "raster/sample_texture.hpp"

namespace luciole {
namespace {

/// The barycentric weights of several places.
using LaneWeights = Lanes3<double>;

/// weightsInPlane() at places moved by a number of pixels.
LaneWeights inPlane(const Surface& surface, const ViewPlane& plane, const Lanes<double>& x,
                    const Lanes<double>& y, const glm::dvec2& move) {
  const glm::dvec3 weight1 = surface.weight1, weight2 = surface.weight2, determinant = surface.determinant;
  const glm::dvec2 origin = plane.offset, step = plane.scale;
  LaneWeights weights;
  for (int i = 0; i < kSquarePixels; ++i) {
    const double px = origin.x + step.x * (x[i] + move.x), py = origin.y + step.y * (y[i] + move.y);
    const double scale = 1.0 / (determinant.x * px + determinant.y * py + determinant.z);
    const double b1 = (weight1.x * px + weight1.y * py + weight1.z) * scale;
    const double b2 = (weight2.x * px + weight2.y * py + weight2.z) * scale;
    weights[0][i] = 1.0 - b1 - b2;
    weights[1][i] = b1;
    weights[2][i] = b2;
  }
  return weights;
}

/// Moves the weights of wanted places into the triangle, as weightsInside().
void clampInside(const Surface& surface, const ViewPlane& plane, const Lanes<double>& x,
                 const Lanes<double>& y, const LaneMask& wanted, LaneWeights& weights) {
  LaneMask outside;
  std::int32_t any = 0;
  for (int i = 0; i < kSquarePixels; ++i) {
    const bool inside = (weights[0][i] >= 0.0) & (weights[1][i] >= 0.0) & (weights[2][i] >= 0.0);
    outside[i] = wanted[i] & !inside;
    any |= outside[i];
  }
  if (!any) return;
  for (int i = 0; i < kSquarePixels; ++i) {
    if (!outside[i]) continue;
    const Weights held = weightsInside(surface, plane.at(x[i], y[i]));
    for (int c = 0; c < 3; ++c) weights[c][i] = held[c];
  }
}

/// A component of texture coordinates, as interpolateUv().
Lanes<double> interpolate(const Surface& surface, const LaneWeights& weights, int component) {
  const std::vector<glm::vec2>& uvs = surface.object->mesh->uvs;
  const double a = uvs[surface.corners[0]][component], b = uvs[surface.corners[1]][component],
               c = uvs[surface.corners[2]][component];
  Lanes<double> result;
  for (int i = 0; i < kSquarePixels; ++i)
    result[i] = weights[0][i] * a + weights[1][i] * b + weights[2][i] * c;
  return result;
}

/// The differences of two places' texture coordinates; zero where not finite.
void setSteps(const Surface& surface, const LaneWeights& from, const LaneWeights& to, Lanes<float>& du,
              Lanes<float>& dv) {
  const Lanes<double> u0 = interpolate(surface, from, 0), v0 = interpolate(surface, from, 1),
                      u1 = interpolate(surface, to, 0), v1 = interpolate(surface, to, 1);
  constexpr float kLargest = std::numeric_limits<float>::max();
  for (int i = 0; i < kSquarePixels; ++i) {
    const float u = float(u1[i] - u0[i]), v = float(v1[i] - v0[i]);
    const bool finite = (std::abs(u) <= kLargest) & (std::abs(v) <= kLargest);
    du[i] = finite ? u : 0.0f;
    dv[i] = finite ? v : 0.0f;
  }
}

/// texturePlace() of several places. `weights`: of the points seen there.
SquareFootprints texturePlaces(const Surface& surface, const ViewPlane& plane, const Lanes<double>& x,
                               const Lanes<double>& y, const LaneWeights& here, const LaneWeights& weights) {
  const Lanes<double> u = interpolate(surface, weights, 0), v = interpolate(surface, weights, 1);
  SquareFootprints places;
  for (int i = 0; i < kSquarePixels; ++i) {
    places.u[i] = float(u[i]);
    places.v[i] = float(v[i]);
  }
  setSteps(surface, here, inPlane(surface, plane, x, y, {1, 0}), places.du_dx, places.dv_dx);
  setSteps(surface, here, inPlane(surface, plane, x, y, {0, 1}), places.du_dy, places.dv_dy);
  return places;
}

void multiply(const Lanes<float>& factors, Lanes<float>& out) {
  for (int i = 0; i < kSquarePixels; ++i) out[i] *= factors[i];
}

/// opacityAt() the wanted places; elsewhere arbitrary.
Lanes<float> opacities(const Scene& scene, const Surface& surface, const LaneWeights& weights,
                       const SquareFootprints& places, const LaneMask& wanted) {
  const Material& material = *surface.material;
  const Mesh& mesh = *surface.object->mesh;
  Lanes<float> opacity;
  for (int i = 0; i < kSquarePixels; ++i)
    opacity[i] = material.alpha * vertexColor(surface, {weights[0][i], weights[1][i], weights[2][i]}).a;
  if (mesh.uvs.empty()) return opacity;
  if (material.diffuse_map.texture >= 0) {
    const Texture& diffuse = scene.textures[std::size_t(material.diffuse_map.texture)];
    Lanes<float> factors;
    factors.fill(float(diffuse.levels[0].texels[3]) / 65535.0f);
    if (diffuse.alpha_varies) factors = sampleChannel(diffuse, material.diffuse_map, places, wanted, 3);
    multiply(factors, opacity);
  }
  if (material.alpha_map.texture < 0) return opacity;
  // Where the opacity is 0 already, the second map is not looked up.
  LaneMask left;
  for (int i = 0; i < kSquarePixels; ++i) left[i] = wanted[i] & (opacity[i] > 0.0f);
  const Texture& alpha = scene.textures[std::size_t(material.alpha_map.texture)];
  Lanes<float> factors = sampleChannel(alpha, material.alpha_map, places, left, alpha.alpha_varies ? 3 : 0);
  if (!alpha.alpha_varies)
    for (int i = 0; i < kSquarePixels; ++i)
      if (left[i]) factors[i] = encodeSrgb(factors[i]);
  for (int i = 0; i < kSquarePixels; ++i) opacity[i] = left[i] ? opacity[i] * factors[i] : opacity[i];
  return opacity;
}

/// The side of a sample's share of its pixel's footprint. 1 without a sample.
float sideOfSample(const std::optional<SampleNumber>& sample) {
  return sample ? 1.0f / std::sqrt(float(sample->count)) : 1.0f;
}

/// The share of the way from alpha_cutoff to a sample's threshold: 1 − kTestedTexels / n, see isHole().
/// place: with the sample's footprint.
float shareOfThreshold(const Scene& scene, const Material& material, const TexturePlace& place) {
  float most = kTestedTexels;
  for (const TextureUse* map : {&material.diffuse_map, &material.alpha_map}) {
    if (map->texture < 0) continue;
    const Texture& texture = scene.textures[std::size_t(map->texture)];
    if (map == &material.alpha_map || texture.alpha_varies)
      most = std::max(most, texelsInside(texture, *map, place.duv_dx, place.duv_dy));
  }
  return 1.0f - kTestedTexels / most;
}

/// The opacity below which a sample sees a hole of a surface that isn't blended.
float cutoffOf(const Scene& scene, const Surface& surface, const TexturePlace& place, const glm::ivec2& pixel,
               const SampleNumber& sample) {
  const Material& material = *surface.material;
  const float cutoff = material.alpha_cutoff;
  if (sample.count == 1 || cutoff > material.alpha) return cutoff;
  const float share = shareOfThreshold(scene, material, place);
  if (share == 0.0f) return cutoff;
  const float threshold = material.alpha * float(blendThreshold(surface.blend_surface, pixel, sample));
  return cutoff + share * (threshold - cutoff);
}

}  // namespace

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

bool isHoleAt(const Scene& scene, const PlacedObject& object, std::uint32_t triangle,
              const Weights& weights) {
  Surface surface;
  surface.object = &object;
  surface.material = &materialOf(scene, object, triangle);
  surface.corners = object.mesh->triangles[triangle];
  if (surface.material->alpha_cutoff <= 0) return false;
  TexturePlace place{};
  if (!object.mesh->uvs.empty()) place.uv = interpolateUv(surface, weights);
  return opacityAt(scene, surface, weights, place) < surface.material->alpha_cutoff;
}

bool isHole(const Scene& scene, const Surface& surface, const ViewPlane& plane, const glm::dvec2& at,
            const glm::ivec2& pixel, const SampleNumber& sample) {
  const Material& material = *surface.material;
  const Weights weights = weightsInside(surface, plane.at(at.x, at.y));
  const bool textured = material.diffuse_map.texture >= 0 || material.alpha_map.texture >= 0;
  TexturePlace place{};
  if (textured && !surface.object->mesh->uvs.empty()) {
    place = texturePlace(surface, plane, at.x, at.y, weights);
    place.duv_dx *= sideOfSample(sample);
    place.duv_dy *= sideOfSample(sample);
  }
  const float opacity = opacityAt(scene, surface, weights, place);
  if (material.blended) return !(opacity > blendThreshold(surface.blend_surface, pixel, sample));
  return opacity < cutoffOf(scene, surface, place, pixel, sample);
}

LaneMask holesIn(const Scene& scene, const Surface& surface, const ViewPlane& plane, const Lanes<double>& x,
                 const Lanes<double>& y, const LaneMask& wanted, const std::optional<SampleNumber>& sample) {
  const Material& material = *surface.material;
  const LaneWeights here = inPlane(surface, plane, x, y, {0, 0});
  LaneWeights weights = here;
  clampInside(surface, plane, x, y, wanted, weights);
  const bool textured = material.diffuse_map.texture >= 0 || material.alpha_map.texture >= 0;
  SquareFootprints places{};
  if (textured && !surface.object->mesh->uvs.empty())
    places = texturePlaces(surface, plane, x, y, here, weights);
  Lanes<float> side;
  side.fill(sideOfSample(sample));
  for (Lanes<float>* step : {&places.du_dx, &places.dv_dx, &places.du_dy, &places.dv_dy})
    multiply(side, *step);
  const Lanes<float> opacity = opacities(scene, surface, weights, places, wanted);
  LaneMask holes;
  if (material.blended && sample) {
    for (int i = 0; i < kSquarePixels; ++i)
      holes[i] =
          wanted[i] && !(opacity[i] > blendThreshold(surface.blend_surface, {int(x[i]), int(y[i])}, *sample));
    return holes;
  }
  Lanes<float> cutoff;
  cutoff.fill(material.alpha_cutoff);
  if (sample && sample->count > 1)
    for (int i = 0; i < kSquarePixels; ++i) {
      if (!wanted[i]) continue;
      const TexturePlace place{
          {places.u[i], places.v[i]}, {places.du_dx[i], places.dv_dx[i]}, {places.du_dy[i], places.dv_dy[i]}};
      cutoff[i] = cutoffOf(scene, surface, place, {int(x[i]), int(y[i])}, *sample);
    }
  for (int i = 0; i < kSquarePixels; ++i) holes[i] = wanted[i] & (opacity[i] < cutoff[i]);
  return holes;
}

}  // namespace luciole
