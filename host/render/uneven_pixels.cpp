#include "render/uneven_pixels.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace luciole {
namespace {

/// Three points in a row, as places in the planes; the outer two may be the same.
struct PointsInRow {
  std::size_t before, here, after;
};

/// How uneven one component is: at most this, in units of the colour.
float unevenness(const PointsInRow& row, const float* color, const float* reflectance) {
  const float before = reflectance[row.before], here = reflectance[row.here], after = reflectance[row.after];
  const float lit = color[row.here];
  // Where a reflectance is 0 its light is not known.
  if (!(before > 0.0f && here > 0.0f && after > 0.0f))
    return std::abs(0.5f * (color[row.before] + color[row.after]) - lit);
  return std::abs(0.5f * (color[row.before] * (here / before) + color[row.after] * (here / after)) - lit);
}

/// Whether two neighbouring points, by their places in the planes, show a surface that goes on from one to
/// the other: it turns by less than 26 degrees, and the way between them leaves neither of their planes
/// by 30.
bool goesOn(const GBuffer& gbuffer, std::size_t a, std::size_t b) {
  const std::size_t stride = gbuffer.pixels();
  const auto vectorAt = [&](const Plane& group, std::size_t i) {
    return glm::vec3(group[i], group[i + stride], group[i + 2 * stride]);
  };
  const glm::vec3 of_a = vectorAt(gbuffer.normal, a), of_b = vectorAt(gbuffer.normal, b);
  const glm::vec3 way = vectorAt(gbuffer.position, b) - vectorAt(gbuffer.position, a);
  const float most = 0.5f * glm::length(way);
  return glm::dot(of_a, of_b) > 0.9f && std::abs(glm::dot(of_a, way)) <= most &&
         std::abs(glm::dot(of_b, way)) <= most;
}

}  // namespace

std::vector<std::uint8_t> unevenPixels(const SampledView& sampled, const SharedSamples& shared,
                                       const Plane& color) {
  const GBuffer& gbuffer = shared.gbuffer;
  const std::size_t stride = gbuffer.pixels();
  const int width = gbuffer.width;
  const auto objectAt = [&](const glm::ivec2& pixel) {
    const bool inside = pixel.x >= 0 && pixel.y >= 0 && pixel.x < width && pixel.y < gbuffer.height;
    return inside ? shared.objects[std::size_t(pixel.y) * width + pixel.x] : kNoObject;
  };
  const auto is_uneven = [&](const glm::ivec2& pixel, const glm::ivec2& step) {
    const std::size_t here = gbuffer.index(pixel.x, pixel.y);
    const auto same_surface = [&](const glm::ivec2& other) {
      return objectAt(other) == objectAt(pixel) && goesOn(gbuffer, here, gbuffer.index(other.x, other.y));
    };
    const bool before = same_surface(pixel - step), after = same_surface(pixel + step);
    if (!before && !after) return false;
    const glm::ivec2 first = before ? pixel - step : pixel + step, last = after ? pixel + step : first;
    const PointsInRow row{gbuffer.index(first.x, first.y), here, gbuffer.index(last.x, last.y)};
    const float share = before && after ? 1.0f : 0.5f;
    float most = 0, brightest = 0;
    for (int c = 0; c < 3; ++c) {
      const float* of_color = color.data() + c * stride;
      most = std::max(most, share * unevenness(row, of_color, gbuffer.diffuse.data() + c * stride));
      brightest = std::max({brightest, of_color[row.before], of_color[row.here], of_color[row.after]});
    }
    return most > kMostUneven * brightest;
  };
  std::vector<std::uint8_t> uneven(shared.objects.size());
  const glm::ivec2 crop = sampled.view.crop_origin;
  const glm::ivec2 first = sampled.inner.first - crop, end = sampled.inner.end - crop;
  tbb::parallel_for(first.y, end.y, [&](int y) {
    for (int x = first.x; x < end.x; ++x) {
      const glm::ivec2 pixel(x, y);
      uneven[std::size_t(y) * width + x] =
          objectAt(pixel) != kNoObject && (is_uneven(pixel, {1, 0}) || is_uneven(pixel, {0, 1}));
    }
  });
  return uneven;
}

}  // namespace luciole
