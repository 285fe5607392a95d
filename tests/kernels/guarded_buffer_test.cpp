#include "kernels/guarded_buffer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "kernels/probe.hpp"

namespace luciole::test {
namespace {

/// Writes a float to `values[place]` of a guarded buffer of 16 and says whether its guard words were left
/// alone.
bool intactAfterWriteAt(int place) {
  OpenedDevice& device = deviceWithLanes(1);
  const GuardedBuffer values(device, 16 * sizeof(float));
  Kernel kernel = makeKernelFromSource(device, probeSource("mistake_probe.cl"), "write_at", "");
  launch(device, kernel, {{"values", values.as<float>()}, {"place", place}}, {.items = 1});
  return values.intact(device);
}

TEST(GuardedBuffer, SeesAWriteJustPastEitherEndAndAsFarAsItIsLong) {
  for (const int place : {0, 15}) EXPECT_TRUE(intactAfterWriteAt(place)) << place;
  for (const int place : {-16, -1, 16, 31}) EXPECT_FALSE(intactAfterWriteAt(place)) << place;
}

TEST(GuardedBuffer, ReadsPastTheEndAreNaN) {
  OpenedDevice& device = deviceWithLanes(1);
  const std::vector<float> ones(16, 1.0f);
  const GuardedBuffer values(device, std::as_bytes(std::span(ones)));
  std::vector<float> found(1);
  const Buffer<float> output = makeBuffer<float>(device, 1);
  Kernel kernel = makeKernelFromSource(device, probeSource("mistake_probe.cl"), "read_at", "");
  for (const int place : {-1, 0, 15, 16}) {
    launch(device, kernel, {{"values", values.as<const float>()}, {"found", output}, {"place", place}},
           {.items = 1});
    download(device, output, found);
    EXPECT_EQ(std::isnan(found[0]), place < 0 || place > 15) << place;
  }
}

TEST(Probe, FailsWhereAKernelWritesMoreColumnsThanItWasAskedFor) {
  const std::vector<Column> in(3, Column{1});
  EXPECT_THROW(probe(deviceWithLanes(1), "math_probe.cl", "probe_normalize", in, 2), std::runtime_error);
}

}  // namespace
}  // namespace luciole::test
