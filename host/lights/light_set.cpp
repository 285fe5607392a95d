#include "lights/light_set.hpp"

namespace luciole {

void finishLightSet(OpenedDevice& device, LightSet& set) {
  set.frame.light_count = static_cast<uint>(set.lights.size());
  set.tree = buildLightTree(set.lights);
  set.light_buffer = borrowed(device, set.lights);
  set.luminaire_buffer = borrowed(device, set.luminaires);
  set.tree_buffer = borrowed(device, set.tree.planes);
  set.beam_buffer = borrowed(device, set.beam_lights);
}

std::size_t bytesOf(const LightSet& set) {
  std::size_t floats = set.tree.planes.size() + set.luminaires.size();
  for (const LightClusters* clusters :
       {&set.clusters.diffuse, &set.clusters.specular, &set.samples.diffuse, &set.samples.specular})
    floats += clusters->rows.size() + clusters->light_rows.size();
  return set.lights.size() * sizeof(ShadeLight) + floats * sizeof(float) +
         set.samples.places.size() * sizeof(float4);
}

}  // namespace luciole
