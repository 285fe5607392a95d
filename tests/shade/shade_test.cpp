#include "shade/shade.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <functional>

#include "kernels/shared.h"
#include "render_json.hpp"

namespace luciole::test {
namespace {

/// Whether two buffers are one, or lie in memory of their own.
bool areApart(const DeviceMemory& one, const DeviceMemory& other) {
  const cl::Buffer &a = one.handle, &b = other.handle;
  if (a() == b()) return true;
  const auto first = [](const cl::Buffer& buffer) {
    return static_cast<const char*>(buffer.getInfo<CL_MEM_HOST_PTR>());
  };
  const auto end = [&](const cl::Buffer& buffer) { return first(buffer) + buffer.getInfo<CL_MEM_SIZE>(); };
  if (!first(a) || !first(b)) return true;
  const std::less_equal<const char*> before;
  return before(end(a), first(b)) || before(end(b), first(a));
}

TEST(BorrowedGBuffer, NoTwoBuffersShareHostMemory) {
  GBuffer gbuffer;
  gbuffer.width = gbuffer.height = kTileSize;
  gbuffer.tiles_x = gbuffer.tiles_y = 1;
  for (Plane* group :
       {&gbuffer.position, &gbuffer.normal, &gbuffer.diffuse, &gbuffer.ambient, &gbuffer.emission})
    group->assign(3 * kTilePixels, 1.0f);
  gbuffer.specular.assign(4 * kTilePixels, 1.0f);
  const PackedNormals surface_normal(kTilePixels);
  const Plane lift(kTilePixels);
  for (const bool unlit : {false, true}) {
    const GBufferBuffers buffers =
        borrowedGBuffer(testDevice(), gbuffer, surface_normal, lift, {}, {}, unlit);
    const std::array<DeviceMemory, 8> all{buffers.position.memory,       buffers.normal.memory,
                                          buffers.diffuse.memory,        buffers.specular.memory,
                                          buffers.ambient.memory,        buffers.emission.memory,
                                          buffers.surface_normal.memory, buffers.lift.memory};
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) EXPECT_TRUE(areApart(all[i], all[k])) << k << " and " << i;
    EXPECT_EQ(buffers.ambient.memory.handle() == buffers.diffuse.memory.handle(), unlit);
  }
}

}  // namespace
}  // namespace luciole::test
