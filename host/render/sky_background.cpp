#include "render/sky_background.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

namespace luciole {
namespace {

/// Bilinear, around the horizon and to the poles. u, v: from 0 to 1.
glm::dvec3 bilinear(const SkyLevel& level, double u, double v) {
  const double x = u * level.width - 0.5, y = std::clamp(v * level.height - 0.5, 0.0, level.height - 1.0);
  const double left = std::floor(x);
  const int top = int(y), below = std::min(top + 1, level.height - 1);
  const auto column = [&](int i) { return (i % level.width + level.width) % level.width; };
  const auto texel = [&](int row, int i) {
    const float* of = &level.texels[3 * (std::size_t(row) * level.width + column(i))];
    return glm::dvec3(of[0], of[1], of[2]);
  };
  const auto between = [&](int row) {
    return glm::mix(texel(row, int(left)), texel(row, int(left) + 1), x - left);
  };
  return glm::mix(between(top), between(below), y - top);
}

/// The sky in a direction, world, of any length. width: of the cone around it, radians.
glm::dvec3 skyColor(const LightSource& environment, const glm::dvec3& direction, double width) {
  const std::vector<SkyLevel>& levels = environment.sky->levels;
  const double cosine = std::cos(environment.rotate), sine = std::sin(environment.rotate);
  const double length = glm::length(direction);
  const glm::dvec3 d = glm::dvec3(cosine * direction.x - sine * direction.z, direction.y,
                                  sine * direction.x + cosine * direction.z) /
                       length;
  const double u = 0.5 + std::atan2(d.x, -d.z) / (2 * glm::pi<double>()),
               v = std::acos(std::clamp(d.y, -1.0, 1.0)) / glm::pi<double>();
  // Texels of the finest level that the cone covers: as many along the horizon as the pole is near.
  const double around =
      width / std::max(std::hypot(d.x, d.z), 1e-9) * levels[0].width / (2 * glm::pi<double>());
  const double covered = std::max(around, width * levels[0].height / glm::pi<double>());
  const double level = std::clamp(std::log2(std::max(covered, 1.0)), 0.0, double(levels.size() - 1));
  const std::size_t finer = std::min(std::size_t(level), levels.size() - 1),
                    coarser = std::min(finer + 1, levels.size() - 1);
  return glm::dvec3(environment.radiance) *
         glm::mix(bilinear(levels[finer], u, v), bilinear(levels[coarser], u, v), level - double(finer));
}

}  // namespace

Plane skyPlane(const LightSource& environment, const View& view, const GBuffer& gbuffer) {
  const float* depth = gbuffer.position.data() + 2 * gbuffer.pixels();
  return skyPlane(environment, view, gbuffer,
                  [&](std::size_t place) { return !std::isfinite(depth[place]); });
}

Plane skyPlane(const LightSource& environment, const View& view, const GBuffer& layout,
               const std::function<bool(std::size_t place)>& is_seen) {
  const std::size_t n = layout.pixels();
  Plane plane(3 * n);
  const glm::dvec2 size(view.size);
  // The ray through a place of the picture, in pixels from its top left corner, by the point there on the
  // near plane, which is at 1: the far one may be infinitely far.
  const glm::dmat4 view_to_world = glm::inverse(view.world_to_view), to_view = glm::inverse(view.projection);
  const auto rayThrough = [&](const glm::dvec2& at) {
    const glm::dvec4 clip(2 * at.x / size.x - 1, 1 - 2 * at.y / size.y, 1, 1);
    const glm::dvec4 near = to_view * clip;
    const bool parallel = view.projection[3][3] != 0;
    const glm::dvec3 ahead = parallel ? glm::dvec3(0, 0, -1) : glm::normalize(glm::dvec3(near) / near.w);
    return glm::dmat3(view_to_world) * ahead;
  };
  tbb::parallel_for(0, layout.height, [&](int y) {
    for (int x = 0; x < layout.width; ++x) {
      const std::size_t place = layout.index(x, y);
      if (!is_seen(place)) continue;
      const glm::dvec2 middle = glm::dvec2(view.crop_origin) + glm::dvec2(x + 0.5, y + 0.5);
      const glm::dvec3 ray = rayThrough(middle);
      const double width = std::max(glm::distance(rayThrough(middle + glm::dvec2(1, 0)), ray),
                                    glm::distance(rayThrough(middle + glm::dvec2(0, 1)), ray));
      const glm::dvec3 color = skyColor(environment, ray, width);
      for (int c = 0; c < 3; ++c) plane[place + std::size_t(c) * n] = float(color[c]);
    }
  });
  return plane;
}

void addSky(const Plane& sky, const GBuffer& gbuffer, Plane& color) {
  const std::size_t n = gbuffer.pixels();
  const float* depth = gbuffer.position.data() + 2 * n;
  tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
    for (std::size_t c = 0; c < 3 && !std::isfinite(depth[i]); ++c) color[i + c * n] += sky[i + c * n];
  });
}

}  // namespace luciole
