#include "culling/light_clusters.hpp"

namespace luciole {

LightClusters buildLightClusters(std::span<const ShadeLight> lights) {
  return {LightArray(lights.begin(), lights.end())};
}

}  // namespace luciole
