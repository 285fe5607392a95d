#include "gbuffer/planes.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <limits>

namespace luciole {

void allocatePlanes(PlaneSet planes, GBuffer& gbuffer) {
  const std::size_t pixels = gbuffer.pixels();
  // In parallel, since most of the time goes into the system's clearing of fresh memory.
  tbb::parallel_invoke(
      [&] {
        gbuffer.position.resize(3 * pixels);
        std::fill(gbuffer.position.begin() + std::ptrdiff_t(2 * pixels), gbuffer.position.end(),
                  -std::numeric_limits<float>::infinity());
      },
      [&] { gbuffer.normal.resize(3 * pixels); }, [&] { gbuffer.diffuse.resize(3 * pixels); },
      [&] { gbuffer.specular.resize(planes.specular ? 4 * pixels : 0); },
      [&] { gbuffer.ambient.resize(planes.ambient ? 3 * pixels : 0); },
      [&] { gbuffer.emission.resize(planes.emission ? 3 * pixels : 0); },
      [&] { gbuffer.geometric_normal.resize(planes.geometric_normal ? pixels : 0); },
      [&] { gbuffer.lift.resize(planes.lift ? pixels : 0); });
}

void freePlanes(GBuffer& gbuffer) {
  for (Plane* group : {&gbuffer.position, &gbuffer.normal, &gbuffer.diffuse, &gbuffer.specular,
                       &gbuffer.ambient, &gbuffer.emission, &gbuffer.lift})
    *group = {};
  gbuffer.geometric_normal = {};
}

}  // namespace luciole
