#include "raster/visible_points.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "raster/rasterize.hpp"
#include "scene/bounds.hpp"

namespace luciole {
namespace {

/// Pixels that are drawn at once, so that their G-buffer takes at most some 200 MB.
constexpr int kBandPixels = 1 << 22;

/// A random sample of points that come one after another: Vitter 1985, "Random sampling with a reservoir",
/// algorithm R.
struct Reservoir {
  std::size_t count;    ///< of points, at most
  std::uint64_t state;  ///< of the random numbers
  std::uint64_t covered = 0;
  std::vector<glm::dvec3> points{};  ///< world space
};

/// Adds what the pixels of a G-buffer show.
void addPoints(const GBuffer& gbuffer, const glm::dmat4& camera_to_world, Reservoir& sample) {
  const std::size_t stride = gbuffer.pixels();
  for (int y = 0; y < gbuffer.height; ++y) {
    for (int x = 0; x < gbuffer.width; ++x) {
      const float* p = gbuffer.position.data() + gbuffer.index(x, y);
      if (std::isinf(p[2 * stride])) continue;
      ++sample.covered;
      const std::size_t place =
          sample.covered <= sample.count
              ? sample.points.size()
              : static_cast<std::size_t>(nextUniform(sample.state) * static_cast<double>(sample.covered));
      if (place >= sample.count) continue;
      const glm::dvec3 world(camera_to_world * glm::dvec4(p[0], p[stride], p[2 * stride], 1));
      if (place == sample.points.size()) {
        sample.points.push_back(world);
      } else {
        sample.points[place] = world;
      }
    }
  }
}

}  // namespace

std::vector<glm::dvec3> visiblePoints(const Scene& scene, const Camera& camera, glm::ivec2 size,
                                      std::size_t count, std::uint64_t seed) {
  const int band_height = std::max(kBandPixels / size.x, 1);
  const std::vector<std::uint32_t> objects = allObjects(scene);
  Reservoir sample{count, seed};
  for (int top = 0; top < size.y; top += band_height) {
    const Crop band{0, top, size.x, std::min(band_height, size.y - top)};
    addPoints(rasterize(scene, objects, cameraView(camera, size, band), Shading::kPhong, {}),
              camera.camera_to_world, sample);
  }
  return sample.points;
}

std::vector<glm::dvec3> visiblePoints(const GBuffer& gbuffer, std::size_t count, std::uint64_t seed) {
  Reservoir sample{count, seed};
  addPoints(gbuffer, gbuffer.camera.camera_to_world, sample);
  return sample.points;
}

Bounds seenBox(std::span<const glm::dvec3> points, const glm::dvec3& eye) {
  Bounds box;
  std::vector<double> places(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(points.begin(), points.end(), places.begin(),
                   [axis](const glm::dvec3& point) { return point[axis]; });
    std::sort(places.begin(), places.end());
    const std::size_t cut = (places.size() - 1) / 20;
    box.low[axis] = places[cut];
    box.high[axis] = places[places.size() - 1 - cut];
  }
  const glm::dvec3 sides = box.high - box.low;
  const double least = std::max({sides.x, sides.y, sides.z}) / 10;
  for (int axis = 0; axis < 3; ++axis) {
    if (sides[axis] >= least) continue;
    if (2 * eye[axis] >= box.low[axis] + box.high[axis]) {
      box.high[axis] = box.low[axis] + least;
    } else {
      box.low[axis] = box.high[axis] - least;
    }
  }
  return box;
}

}  // namespace luciole
