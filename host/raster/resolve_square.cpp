#include "raster/resolve_square.hpp"

#include <cstring>
#include <span>

namespace luciole {
namespace {

/// The first of a square's pixels, from one on, that still sees a triangle; kSquarePixels where none does.
int nextSeen(const Lanes<std::uint32_t>& triangles, int from) {
  while (from < kSquarePixels && triangles[from] == kNoTriangle) ++from;
  return from;
}

/// Which pixels see the triangle that pixel `lane` sees; they are taken out of `triangles`.
LaneMask takeTriangle(Lanes<std::uint32_t>& triangles, int lane) {
  const std::uint32_t triangle = triangles[lane];
  LaneMask mask;
  for (int i = 0; i < kSquarePixels; ++i) {
    mask[i] = triangles[i] == triangle;
    triangles[i] = mask[i] ? kNoTriangle : triangles[i];
  }
  return mask;
}

/// The values of a square of which at least one pixel sees something. Those of pixels that see nothing are
/// arbitrary.
SquareValues valuesSeen(const ResolveInput& input, const SquarePlace& place, Lanes<std::uint32_t> triangles,
                        SurfaceCache& surfaces) {
  const auto show = [&](int lane, LaneMask& mask) {
    const SeenSurface& seen = surfaces[triangles[lane]];
    mask = takeTriangle(triangles, lane);
    return valuesOf(input, seen, place, mask);
  };
  LaneMask mask;
  int lane = nextSeen(triangles, 0);
  SquareValues values = show(lane, mask);
  while ((lane = nextSeen(triangles, lane + 1)) < kSquarePixels) {
    const SquareValues others = show(lane, mask);
    copyValues(others, mask, values);
  }
  applyMaps(input.scene, place, values);
  return values;
}

/// Stores the values of the pixels that see something into a plane, from `out` on. `whole`: all of them do.
template <class T>
void store(const Lanes<T>& values, const LaneMask& mask, bool whole, T* out) {
  if (whole) {
    std::memcpy(out, values.data(), sizeof values);
  } else {
    for (int i = 0; i < kSquarePixels; ++i)
      if (mask[i]) out[i] = values[i];
  }
}

/// The same into a group of planes, if the G-buffer has it.
void store(std::span<const Lanes<float>> values, std::size_t place, const LaneMask& mask, bool whole,
           Plane& group) {
  if (group.empty()) return;
  const std::size_t stride = group.size() / values.size();
  for (std::size_t c = 0; c < values.size(); ++c)
    store(values[c], mask, whole, group.data() + c * stride + place);
}

void store(const SquareValues& values, const Lanes<std::uint32_t>& triangles, std::size_t place,
           GBuffer& gbuffer) {
  LaneMask drawn;
  bool whole = true;
  for (int i = 0; i < kSquarePixels; ++i) {
    drawn[i] = triangles[i] != kNoTriangle;
    whole &= drawn[i] != 0;
  }
  store(values.position, place, drawn, whole, gbuffer.position);
  store(values.normal, place, drawn, whole, gbuffer.normal);
  store(values.diffuse, place, drawn, whole, gbuffer.diffuse);
  store(values.specular, place, drawn, whole, gbuffer.specular);
  store(values.ambient, place, drawn, whole, gbuffer.ambient);
  store(values.emission, place, drawn, whole, gbuffer.emission);
  if (!gbuffer.geometric_normal.empty())
    store(values.surface_normal, drawn, whole, gbuffer.geometric_normal.data() + place);
  if (!gbuffer.unbent_normal.empty())
    store(values.surface_normal, drawn, whole, gbuffer.unbent_normal.data() + place);
  if (!gbuffer.lift.empty()) store(values.lift, drawn, whole, gbuffer.lift.data() + place);
  if (!gbuffer.model.empty()) store(values.model, drawn, whole, gbuffer.model.data() + place);
}

/// Asks for the cache lines of a group of planes that store() will write. (GCC takes a function that only
/// prefetches for one without effect, and its call away, unless it is inlined first.)
[[gnu::always_inline]] inline void prefetch(const Plane& group, std::size_t components, std::size_t place) {
  if (group.empty()) return;
  const std::size_t stride = group.size() / components;
  for (std::size_t c = 0; c < components; ++c) __builtin_prefetch(group.data() + c * stride + place, 1);
}

}  // namespace

void resolveSquare(const ResolveInput& input, const SquarePlace& place, const Lanes<std::uint32_t>& triangles,
                   SurfaceCache& surfaces, std::size_t at, GBuffer& gbuffer) {
  if (nextSeen(triangles, 0) == kSquarePixels) return;
  // They arrive while the values are computed.
  prefetch(gbuffer.position, 3, at);
  prefetch(gbuffer.normal, 3, at);
  prefetch(gbuffer.diffuse, 3, at);
  prefetch(gbuffer.specular, 4, at);
  prefetch(gbuffer.ambient, 3, at);
  prefetch(gbuffer.emission, 3, at);
  if (!gbuffer.geometric_normal.empty()) __builtin_prefetch(gbuffer.geometric_normal.data() + at, 1);
  if (!gbuffer.unbent_normal.empty()) __builtin_prefetch(gbuffer.unbent_normal.data() + at, 1);
  prefetch(gbuffer.lift, 1, at);
  store(valuesSeen(input, place, triangles, surfaces), triangles, at, gbuffer);
}

}  // namespace luciole
