#include "shadow/maps/meshlets_seen.hpp"

#include <algorithm>
#include <array>

#include "shadow/maps/frustum.hpp"

namespace luciole {
namespace {

/// Whether a box may reach inside all planes and, for a light with a position, into its range.
bool mayShow(const std::array<glm::dvec4, 6>& planes, const glm::dvec3& low, const glm::dvec3& high,
             const Light& light) {
  for (const glm::dvec4& plane : planes) {
    const glm::dvec3 corner(plane.x > 0 ? high.x : low.x, plane.y > 0 ? high.y : low.y,
                            plane.z > 0 ? high.z : low.z);
    if (glm::dot(plane, glm::dvec4(corner, 1)) < 0) return false;
  }
  if (light.kind == LightKind::kDirectional) return true;
  return !(glm::distance(glm::clamp(light.position, low, high), light.position) > light.range);
}

/// Whether a box may show in any of the bins, at a depth that matters there.
bool mayMatter(const glm::dmat4& world_to_clip, const glm::ivec2& size, const WantedBins& bins,
               const glm::dvec3& low, const glm::dvec3& high) {
  glm::dvec2 first(1e300), last(-1e300);
  double nearest = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec4 clip =
        world_to_clip * glm::dvec4(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z, 1);
    if (!(clip.z <= clip.w)) return true;  // reaches behind the near plane, or isn't finite
    const glm::dvec2 place =
        glm::dvec2(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w) * glm::dvec2(size);
    first = glm::min(first, place);
    last = glm::max(last, place);
    nearest = std::max(nearest, clip.z / clip.w);
  }
  // Coordinates far outside the face may overflow an int.
  first = glm::clamp(first, glm::dvec2(-2.0 * kBinSize), glm::dvec2(size + 2 * kBinSize));
  last = glm::clamp(last, glm::dvec2(-2.0 * kBinSize), glm::dvec2(size + 2 * kBinSize));
  // A texel more on each side for snapping, and a float's rounding of depth.
  const glm::ivec2 from =
      glm::max(glm::ivec2(glm::floor((first - 1.0) / double(kBinSize))), bins.first) - bins.first;
  const glm::ivec2 to =
      glm::min(glm::ivec2(glm::floor((last + 1.0) / double(kBinSize))), bins.first + bins.count - 1) -
      bins.first;
  const float depth = float(nearest) * (1 + 0x1p-22f);
  for (int y = from.y; y <= to.y; ++y)
    for (int x = from.x; x <= to.x; ++x)
      if (bins.farthest[y * bins.count.x + x] <= depth) return true;
  return false;
}

}  // namespace

std::vector<std::uint32_t> meshletsSeen(const Meshlets& meshlets, const View& view, const WantedBins& bins,
                                        const Light& light) {
  const auto planes = cropPlanes(view);
  const glm::dmat4 world_to_clip = view.projection * view.world_to_view;
  const auto seen = [&](const glm::dvec3& low, const glm::dvec3& high) {
    return mayShow(planes, low, high, light) && mayMatter(world_to_clip, view.size, bins, low, high);
  };
  std::vector<std::uint32_t> result;
  for (std::uint32_t group = 0; group < meshlets.groups.size(); ++group) {
    if (!seen(meshlets.groups[group].low, meshlets.groups[group].high)) continue;
    const std::uint32_t end = std::min<std::uint32_t>((group + 1) * kMeshletsPerGroup, meshlets.items.size());
    for (std::uint32_t meshlet = group * kMeshletsPerGroup; meshlet < end; ++meshlet)
      if (seen(meshlets.items[meshlet].low, meshlets.items[meshlet].high)) result.push_back(meshlet);
  }
  return result;
}

}  // namespace luciole
