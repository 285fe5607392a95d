#include "raster/placed_runs.hpp"

namespace luciole {

PlacedRuns placeRuns(const Scene& scene, const TriangleRuns& runs, std::span<const std::uint32_t> chosen,
                     const glm::dmat4& world_to_view) {
  std::vector<std::uint32_t> used, object_of;
  object_of.reserve(chosen.size());
  for (const std::uint32_t run : chosen) {
    if (used.empty() || used.back() != runs.runs[run].object) used.push_back(runs.runs[run].object);
    object_of.push_back(std::uint32_t(used.size() - 1));
  }
  return {runs, chosen, placeObjects(scene, used, world_to_view), std::move(object_of)};
}

}  // namespace luciole
