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
  for (const ClusterSet* of :
       std::initializer_list<const ClusterSet*>{&set.clusters, &set.samples, &set.directions})
    for (const LightClusters* clusters : {&of->diffuse, &of->specular})
      floats += clusters->rows.size() + clusters->light_rows.size();
  for (const SampledSet* samples : {&set.samples, &set.directions})
    floats += samples->lobes.size() + samples->places.size() * (sizeof(float4) / sizeof(float));
  return set.lights.size() * sizeof(ShadeLight) + floats * sizeof(float);
}

}  // namespace luciole
