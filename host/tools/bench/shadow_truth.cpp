#include "tools/bench/shadow_truth.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "kernels/shared.h"
#include "luciole/load_scene.hpp"
#include "raster/view.hpp"
#include "rays/shadow_rays.hpp"
#include "scene/bounds.hpp"

namespace luciole {
namespace {

/// Rays that a thread makes and traces at once: 64 packets, 56 KB.
constexpr std::size_t kBlock = 1024;
constexpr std::size_t kDirections = 8;

glm::dvec3 triple(const Plane& group, std::size_t stride, std::size_t place) {
  return {group[place], group[place + stride], group[place + 2 * stride]};
}

glm::dvec3 viewPosition(const GBuffer& gbuffer, std::size_t place) {
  return triple(gbuffer.position, gbuffer.pixels(), place);
}

bool hasPlace(const Light& light) { return light.kind != LightKind::kDirectional; }

/// A light with a shadow, in view space.
struct ViewLight {
  std::uint32_t index;
  bool directional;
  glm::dvec3 position;
  glm::dvec3 direction;  ///< unit, the way it shines
  double range2;         ///< of its range, m²
  double cosine;         ///< of its cutoff; −2 for a light without one
};

std::vector<ViewLight> viewLights(const Scene& scene, const Camera& camera) {
  const glm::dmat4 world_to_view = worldToView(camera);
  std::vector<ViewLight> lights;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!light.shadow) continue;
    lights.push_back({static_cast<std::uint32_t>(i), !hasPlace(light),
                      glm::dvec3(world_to_view * glm::dvec4(light.position, 1)),
                      glm::normalize(glm::dmat3(world_to_view) * light.direction),
                      double(light.range) * light.range,
                      light.kind == LightKind::kSpot ? std::cos(light.cutoff) : -2.0});
  }
  return lights;
}

bool isFacing(const ViewLight& light, const glm::dvec3& position, const glm::dvec3& normal) {
  if (light.directional) return glm::dot(normal, light.direction) < 0;
  const glm::dvec3 way = light.position - position;
  const double distance2 = glm::dot(way, way);
  return glm::dot(normal, way) > 0 && distance2 < light.range2 &&
         -glm::dot(way, light.direction) > light.cosine * std::sqrt(distance2);
}

/// The pixels of a tile that show something, and the box around what they show.
struct TilePixels {
  std::array<std::uint32_t, kTilePixels> place;
  std::array<glm::dvec3, kTilePixels> position, normal;
  std::size_t count = 0;
  Bounds bounds;
};

TilePixels gatherTile(const GBuffer& gbuffer, std::size_t tile) {
  TilePixels pixels;
  for (std::size_t place = tile * kTilePixels; place < (tile + 1) * kTilePixels; ++place) {
    const glm::dvec3 position = viewPosition(gbuffer, place);
    if (!std::isfinite(position.z)) continue;
    pixels.place[pixels.count] = static_cast<std::uint32_t>(place);
    pixels.position[pixels.count] = position;
    pixels.normal[pixels.count] = triple(gbuffer.normal, gbuffer.pixels(), place);
    pixels.bounds.low = glm::min(pixels.bounds.low, position);
    pixels.bounds.high = glm::max(pixels.bounds.high, position);
    ++pixels.count;
  }
  return pixels;
}

bool mayReach(const ViewLight& light, const Bounds& bounds) {
  if (light.directional) return true;
  const glm::dvec3 way = light.position - glm::clamp(light.position, bounds.low, bounds.high);
  return glm::dot(way, way) < light.range2;
}

/// Calls `found` for the tile's pairs in their order.
template <class Found>
void findPairs(const std::vector<ViewLight>& lights, const TilePixels& pixels, Found found) {
  if (pixels.count == 0) return;
  for (const ViewLight& light : lights) {
    if (!mayReach(light, pixels.bounds)) continue;
    for (std::size_t i = 0; i < pixels.count; ++i)
      if (isFacing(light, pixels.position[i], pixels.normal[i]))
        found(LightPair{pixels.place[i], light.index});
  }
}

/// Splits pairs into blocks of at most `most` and calls run(first, end) for each block, on all threads.
template <class Run>
void forBlocks(std::size_t pairs, std::size_t most, Run run) {
  tbb::parallel_for(std::size_t(0), (pairs + most - 1) / most,
                    [&](std::size_t block) { run(block * most, std::min((block + 1) * most, pairs)); });
}

glm::dvec3 wayToLight(const Light& light, const glm::dvec3& point) {
  return hasPlace(light) ? light.position - point : -light.direction;
}

/// The eight points around a point (see nearEdges), as offsets from it; world space.
struct Around {
  glm::dvec3 to_light, right, up;  ///< unit, at right angles to each other
  double reach;                    ///< metres
  glm::dvec3 normal;               ///< the triangle's, unit

  glm::dvec3 shift(std::size_t i) const {
    const double angle = double(i) * (2 * std::numbers::pi / kDirections);
    const glm::dvec3 across = reach * (std::cos(angle) * right + std::sin(angle) * up);
    const double off = -glm::dot(normal, across), slope = glm::dot(normal, to_light),
                 most = kLongestWayBack * reach;
    const double back =
        std::abs(off) < most * std::abs(slope) ? off / slope : std::copysign(most, off * slope);
    return across + back * to_light;
  }
};

Around around(const Light& light, const glm::dvec3& point, const glm::dvec3& normal, double texel) {
  const glm::dvec3 to_light = glm::normalize(wayToLight(light, point));
  const glm::dvec3 any = std::abs(to_light.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(to_light, any));
  return {to_light, right, glm::cross(right, to_light), texel, normal};
}

}  // namespace

std::vector<LightPair> facingPairs(const Scene& scene, const GBuffer& gbuffer) {
  const std::vector<ViewLight> lights = viewLights(scene, gbuffer.camera);
  const std::size_t tiles = std::size_t(gbuffer.tiles_x) * gbuffer.tiles_y;
  std::vector<std::size_t> first(tiles + 1, 0);
  tbb::parallel_for(std::size_t(0), tiles, [&](std::size_t tile) {
    std::size_t count = 0;
    findPairs(lights, gatherTile(gbuffer, tile), [&](const LightPair&) { ++count; });
    first[tile + 1] = count;
  });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<LightPair> pairs(first.back());
  tbb::parallel_for(std::size_t(0), tiles, [&](std::size_t tile) {
    LightPair* next = pairs.data() + first[tile];
    findPairs(lights, gatherTile(gbuffer, tile), [&](const LightPair& pair) { *next++ = pair; });
  });
  return pairs;
}

TracedShadows traceTruth(const Scene& scene, const RayScene& rays, const GBuffer& gbuffer,
                         std::span<const LightPair> pairs) {
  TracedShadows result;
  result.lit.resize(pairs.size());
  const auto start = std::chrono::steady_clock::now();
  forBlocks(pairs.size(), kBlock, [&](std::size_t first, std::size_t end) {
    std::array<ShadowRay, kBlock> block;
    for (std::size_t i = first; i < end; ++i)
      block[i - first] = shadowRay(scene.lights[pairs[i].light], shadowStart(gbuffer, pairs[i].pixel));
    const auto lit = std::span(result.lit).subspan(first, end - first);
    areBlocked(rays, std::span(block).first(end - first), lit);
    for (std::uint8_t& value : lit) value = 1 - value;
  });
  result.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return result;
}

std::vector<std::uint8_t> nearEdges(const Scene& scene, const RayScene& rays, const GBuffer& gbuffer,
                                    const GBuffer& flat_normals, std::span<const LightPair> pairs,
                                    std::span<const std::uint8_t> lit, const TexelSide& texel_side) {
  const glm::dmat3 to_world(gbuffer.camera.camera_to_world);
  std::vector<std::uint8_t> edge(pairs.size());
  forBlocks(pairs.size(), kBlock / kDirections, [&](std::size_t first, std::size_t end) {
    const std::size_t count = end - first;
    // The first points of all pairs, then their second points, and so on: neighbouring rays are similar.
    std::array<ShadowRay, kBlock> block;
    std::array<std::uint8_t, kBlock> blocked;
    for (std::size_t i = 0; i < count; ++i) {
      const auto [pixel, index] = pairs[first + i];
      const Light& light = scene.lights[index];
      const glm::dvec3 point = shadowStart(gbuffer, pixel);
      const bool lifted = !gbuffer.lift.empty() && gbuffer.lift[pixel] > 0;
      const Plane& normals = lifted ? gbuffer.normal : flat_normals.normal;
      const glm::dvec3 normal = glm::normalize(to_world * triple(normals, gbuffer.pixels(), pixel));
      const Around points = around(light, point, normal, texel_side(index, point));
      for (std::size_t k = 0; k < kDirections; ++k)
        block[k * count + i] = shadowRay(light, point + points.shift(k));
    }
    const std::size_t asked = kDirections * count;
    areBlocked(rays, std::span(block).first(asked), std::span(blocked).first(asked));
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < kDirections; ++k)
        edge[first + i] |= blocked[k * count + i] == lit[first + i];
  });
  return edge;
}

ShadowErrors judge(std::span<const std::uint8_t> lit, std::span<const std::uint8_t> edge,
                   std::span<const float> visibility) {
  ShadowErrors errors;
  for (std::size_t i = 0; i < lit.size(); ++i) {
    errors.brighter += double(visibility[i]) - lit[i];
    const bool is_lit = lit[i] != 0, wrong = (visibility[i] >= 0.5f) != is_lit;
    if (edge[i]) {
      ++errors.edges;
      errors.wrong_edges += wrong;
    } else {
      ++(is_lit ? errors.lit : errors.dark);
      (is_lit ? errors.wrongly_dark : errors.wrongly_lit) += wrong;
    }
  }
  return errors;
}

}  // namespace luciole
