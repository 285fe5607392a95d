#include "raster/resolve.hpp"

#include <cstring>
#include <span>

#include "raster/seen_surface.hpp"
#include "raster/square_values.hpp"

namespace luciole {
namespace {

/// The part of the picture to fill in: the bin's pixels inside the crop.
struct Part {
  glm::ivec2 first;
  glm::ivec2 end;

  bool contains(const glm::ivec2& at) const {
    return at.x >= first.x && at.y >= first.y && at.x < end.x && at.y < end.y;
  }
};

/// The triangles that a square's pixels see; kNoTriangle outside the part.
Lanes<std::uint32_t> trianglesSeen(const BinPixels& pixels, const glm::ivec2& bin_origin, const Part& part,
                                   const glm::ivec2& square) {
  const glm::ivec2 in_bin = square - bin_origin;
  const bool whole = part.contains(square) && part.contains(square + (kSquareSize - 1));
  Lanes<std::uint32_t> triangles;
  for (int i = 0; i < kSquarePixels; ++i) {
    const glm::ivec2 step(kSquareLayout.x[i], kSquareLayout.y[i]);
    triangles[i] = whole || part.contains(square + step)
                       ? pixels.label[(in_bin.y + step.y) * kBinSize + in_bin.x + step.x]
                       : kNoTriangle;
  }
  return triangles;
}

/// The first of a square's pixels, from one on, that still sees a triangle; kSquarePixels where none does.
int nextSeen(const Lanes<std::uint32_t>& triangles, int from) {
  while (from < kSquarePixels && triangles[from] == kNoTriangle) ++from;
  return from;
}

/// Which pixels see the triangle that pixel `lane` sees; they are taken out of `triangles`.
LaneMask takeTriangle(Lanes<std::uint32_t>& triangles, int lane) {
  const std::uint32_t triangle = triangles[lane];
  LaneMask sees_it;
  for (int i = 0; i < kSquarePixels; ++i) {
    sees_it[i] = triangles[i] == triangle;
    triangles[i] = sees_it[i] ? kNoTriangle : triangles[i];
  }
  return sees_it;
}

/// Resolves a square of which at least one pixel sees something. The values of pixels that see nothing are
/// arbitrary.
SquareValues resolveSquare(const ResolveInput& input, const glm::ivec2& first_pixel,
                           Lanes<std::uint32_t> triangles, SurfaceCache& surfaces) {
  const SquarePlace place = squarePlace(input.plane, first_pixel);
  const auto show = [&](int lane, LaneMask& sees_it) {
    const SeenSurface& seen = surfaces[triangles[lane]];
    sees_it = takeTriangle(triangles, lane);
    return valuesOf(input, seen, place, sees_it);
  };
  LaneMask sees_it;
  int lane = nextSeen(triangles, 0);
  SquareValues values = show(lane, sees_it);
  while ((lane = nextSeen(triangles, lane + 1)) < kSquarePixels) {
    const SquareValues others = show(lane, sees_it);
    put(others, sees_it, values);
  }
  applyMaps(input.scene, values);
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
    store(values.geometric_normal, drawn, whole, gbuffer.geometric_normal.data() + place);
  if (!gbuffer.lift.empty()) store(values.lift, drawn, whole, gbuffer.lift.data() + place);
}

}  // namespace

void resolveBin(const ResolveInput& input, const BinPixels& pixels, glm::ivec2 bin_origin, GBuffer& gbuffer) {
  const glm::ivec2 crop = gbuffer.crop_origin;
  const Part part{glm::max(bin_origin, crop),
                  glm::min(bin_origin + kBinSize, crop + glm::ivec2(gbuffer.width, gbuffer.height))};
  // Squares, like tiles, are aligned to the crop, and bins to the picture. So a square may lie in several
  // bins.
  const glm::ivec2 first_square = crop + (part.first - crop) / kSquareSize * kSquareSize;
  SurfaceCache surfaces(input);
  for (int y = first_square.y; y < part.end.y; y += kSquareSize) {
    for (int x = first_square.x; x < part.end.x; x += kSquareSize) {
      const Lanes<std::uint32_t> triangles = trianglesSeen(pixels, bin_origin, part, {x, y});
      if (nextSeen(triangles, 0) == kSquarePixels) continue;
      store(resolveSquare(input, {x, y}, triangles, surfaces), triangles,
            gbuffer.index(x - crop.x, y - crop.y), gbuffer);
    }
  }
}

}  // namespace luciole
