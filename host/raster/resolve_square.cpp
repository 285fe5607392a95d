#include "raster/resolve_square.hpp"

#include <span>

#ifdef __SSE2__
#include <emmintrin.h>
#else
#include <cstring>
#endif

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
    copyValues(others, mask, input.planes, values);
  }
  applyMaps(input.scene, place, values);
  return values;
}

/// Writes a square's part of a plane, a whole cache line. Where the machine can, past the caches: a line that
/// is written through them is read first, and planes are larger than they are.
template <class T>
void writeLine(const Lanes<T>& values, T* out) {
#ifdef __SSE2__
  const auto* from = reinterpret_cast<const __m128i*>(values.data());
  auto* to = reinterpret_cast<__m128i*>(out);
  for (std::size_t i = 0; i < sizeof values / sizeof *to; ++i)
    _mm_stream_si128(to + i, _mm_loadu_si128(from + i));
#else
  std::memcpy(out, values.data(), sizeof values);
#endif
}

/// Stores the values of the pixels that see something into a plane, from `out` on. `whole`: all of them do.
template <class T>
void store(const Lanes<T>& values, const LaneMask& mask, bool whole, T* out) {
  if (whole) {
    writeLine(values, out);
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
  if (!gbuffer.tangent.empty()) store(values.tangent, drawn, whole, gbuffer.tangent.data() + place);
  store(values.uv, place, drawn, whole, gbuffer.uv);
  if (!gbuffer.object.empty()) store(values.object, drawn, whole, gbuffer.object.data() + place);
  if (!gbuffer.material.empty()) store(values.material, drawn, whole, gbuffer.material.data() + place);
}

}  // namespace

void resolveSquare(const ResolveInput& input, const SquarePlace& place, const Lanes<std::uint32_t>& triangles,
                   SurfaceCache& surfaces, std::size_t at, GBuffer& gbuffer) {
  if (nextSeen(triangles, 0) == kSquarePixels) return;
  store(valuesSeen(input, place, triangles, surfaces), triangles, at, gbuffer);
}

void finishSquares() {
#ifdef __SSE2__
  _mm_sfence();
#endif
}

}  // namespace luciole
