#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "kernels/shared.h"
#include "luciole/array_memory.hpp"

namespace luciole {

/// A point light without range whose attenuation is quadratic·d² alone. View space, metres. Of directional
/// lights, which are sampled, `position` is the unit vector towards them and `quadratic` 1.
struct UnboundedLight {
  glm::dvec3 position;
  glm::dvec3 color;  ///< its diffuse or its specular one; ≥ 0
  double quadratic;  ///< at least kLeastQuadratic
};

/// The falloff 1 / (quadratic·d²) is clamped to 2¹⁰⁰. With quadratic at least this, no cluster is clamped:
/// clusters are farther than 2⁻²⁵ m from the points that they light.
inline constexpr double kLeastQuadratic = 0x1p-40;

/// A balanced tree over lights; its layout is that of kernels/shared.h.
struct LightClusters {
  std::size_t lights = 0;  ///< their number
  /// kLightFields · kClusterSlots floats for each pair of leaves. Slots without a light are 0.
  RawArray<float> light_rows;
  /// kClusterFields · kClusterSlots floats a row. Slots without a cluster are 0.
  RawArray<float> rows;
  unsigned levels =
      0;  ///< of the tree below its root; its 2^levels leaves hold up to kLeafLights lights each
  std::vector<std::uint32_t> order;  ///< the lights' indices, leaf by leaf
};

/// Where the lights of node `index` of a level begin among `lights` lights. The nodes of a level share them
/// evenly, so the tree is a function of their number alone.
constexpr std::size_t clusterBegin(std::size_t lights, unsigned level, std::size_t index) {
  return (lights * index) >> level;
}

/// Calls visit(slot, number in LightClusters::order) for each light. Slots are counted through all rows of
/// lights.
template <class Visit>
void forEachSlot(const LightClusters& clusters, const Visit& visit) {
  for (std::size_t leaf = 0; leaf < std::size_t(1) << clusters.levels; ++leaf) {
    const std::size_t begin = clusterBegin(clusters.lights, clusters.levels, leaf);
    for (std::size_t i = begin; i < clusterBegin(clusters.lights, clusters.levels, leaf + 1); ++i)
      visit(leaf * kLeafLights + (i - begin), i);
  }
}

/// Builds the tree in O(n log n), in parallel: each node's lights are halved along the longest side of their
/// box. Deterministic.
LightClusters buildLightClusters(std::span<const UnboundedLight> lights);

}  // namespace luciole
