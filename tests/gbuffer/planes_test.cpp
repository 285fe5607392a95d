#include "luciole/planes.hpp"

#include <gtest/gtest.h>

namespace luciole {
namespace {

std::size_t capacities(const GBuffer& gbuffer) {
  std::size_t sum = gbuffer.geometric_normal.capacity() + gbuffer.unbent_normal.capacity() +
                    gbuffer.model.capacity() + gbuffer.tangent.capacity() + gbuffer.object.capacity() +
                    gbuffer.material.capacity();
  for (const Plane* group : {&gbuffer.position, &gbuffer.normal, &gbuffer.diffuse, &gbuffer.specular,
                             &gbuffer.ambient, &gbuffer.emission, &gbuffer.lift, &gbuffer.uv})
    sum += group->capacity();
  return sum;
}

TEST(Planes, FreedOnesKeepNoMemory) {
  GBuffer gbuffer{.width = 33, .height = 17, .tiles_x = 3, .tiles_y = 2};
  allocatePlanes({.specular = true,
                  .ambient = true,
                  .emission = true,
                  .geometric_normal = true,
                  .unbent_normal = true,
                  .lift = true,
                  .model = true,
                  .tangent = true,
                  .uv = true,
                  .object = true,
                  .material = true},
                 gbuffer);
  EXPECT_GE(capacities(gbuffer), 27 * gbuffer.pixels());
  freePlanes(gbuffer);
  EXPECT_EQ(capacities(gbuffer), 0u);
}

}  // namespace
}  // namespace luciole
