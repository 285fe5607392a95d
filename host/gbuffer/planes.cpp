#include "luciole/planes.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <limits>

#include "kernels/shared.h"

namespace luciole {
namespace {

static_assert(GBuffer::kTileSide == kTileSize && GBuffer::kTileSide * GBuffer::kTileSide == kTilePixels);

/// Makes a group of `count` values, in the memory that it has where that is enough.
template <class Group>
void clear(std::size_t count, Group& group, typename Group::value_type value = 0) {
  if (group.capacity() < count) group = Group();  // freed first, so that memory need not hold both
  group.clear();
  group.resize(count, value);
}

}  // namespace

void allocatePlanes(PlaneSet planes, GBuffer& gbuffer) {
  const std::size_t pixels = gbuffer.pixels();
  // In parallel, since most of the time goes into the system's clearing of fresh memory.
  tbb::parallel_invoke(
      [&] {
        clear(3 * pixels, gbuffer.position);
        std::fill(gbuffer.position.begin() + std::ptrdiff_t(2 * pixels), gbuffer.position.end(),
                  -std::numeric_limits<float>::infinity());
      },
      [&] { clear(3 * pixels, gbuffer.normal); }, [&] { clear(3 * pixels, gbuffer.diffuse); },
      [&] { clear(planes.specular ? 4 * pixels : 0, gbuffer.specular); },
      [&] { clear(planes.ambient ? 3 * pixels : 0, gbuffer.ambient); },
      [&] { clear(planes.emission ? 3 * pixels : 0, gbuffer.emission); },
      [&] { clear(planes.geometric_normal ? pixels : 0, gbuffer.geometric_normal); },
      [&] { clear(planes.unbent_normal ? pixels : 0, gbuffer.unbent_normal); },
      [&] { clear(planes.lift ? pixels : 0, gbuffer.lift); },
      [&] { clear(planes.model ? pixels : 0, gbuffer.model); },
      [&] { clear(planes.tangent ? pixels : 0, gbuffer.tangent); },
      [&] { clear(planes.uv ? 2 * pixels : 0, gbuffer.uv); },
      [&] { clear(planes.object ? pixels : 0, gbuffer.object, kNoIndex); },
      [&] { clear(planes.material ? pixels : 0, gbuffer.material, kNoIndex); });
}

void freePlanes(GBuffer& gbuffer) {
  for (Plane* group : {&gbuffer.position, &gbuffer.normal, &gbuffer.diffuse, &gbuffer.specular,
                       &gbuffer.ambient, &gbuffer.emission, &gbuffer.lift, &gbuffer.uv})
    *group = Plane();  // unlike an empty list, which leaves the memory
  for (PackedNormals* group : {&gbuffer.geometric_normal, &gbuffer.unbent_normal, &gbuffer.tangent})
    *group = PackedNormals();
  gbuffer.model = ModelPlane();
  for (IndexPlane* group : {&gbuffer.object, &gbuffer.material}) *group = IndexPlane();
}

}  // namespace luciole
