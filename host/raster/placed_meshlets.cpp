#include "raster/placed_meshlets.hpp"

namespace luciole {

PlacedMeshlets placeMeshlets(const Scene& scene, const Meshlets& meshlets,
                             std::span<const std::uint32_t> chosen, const glm::dmat4& world_to_view) {
  std::vector<std::uint32_t> used, object_of;
  object_of.reserve(chosen.size());
  for (const std::uint32_t meshlet : chosen) {
    if (used.empty() || used.back() != meshlets.items[meshlet].object)
      used.push_back(meshlets.items[meshlet].object);
    object_of.push_back(std::uint32_t(used.size() - 1));
  }
  return {meshlets, chosen, placeObjects(scene, used, world_to_view), std::move(object_of)};
}

}  // namespace luciole
