// Quotients and roots, as the device rounds them and as kernels/quotient.clh does.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "base/random.hpp"
#include "kernels/probe.hpp"

namespace luciole::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Denormals are zeroes of their sign.
float flushed(float x) { return std::fabs(x) < 0x1p-126f ? std::copysign(0.0f, x) : x; }

/// Numerators and denominators: quotients that lie close to the middle between two floats and to powers of
/// two, the ends of the range, whatever isn't a number, and random bits.
std::pair<Column, Column> hardPairs() {
  std::pair<Column, Column> pairs;
  const auto add = [&](float a, float b) {
    pairs.first.push_back(a);
    pairs.second.push_back(b);
  };
  const float ends[] = {0.0f,
                        0x1p-149f,
                        0x1p-130f,
                        0x1p-126f,
                        0x1.000002p-126f,
                        0x1p-125f,
                        0x1.fffffep-1f,
                        1.0f,
                        1.000001f,
                        1.5f,
                        0x1.fffffep0f,
                        2.0f,
                        3.0f,
                        0x1p126f,
                        0x1p127f,
                        0x1.fffffep127f,
                        kInfinity,
                        NAN};
  for (const float a : ends)
    for (const float b : ends)
      for (const float sign : {1.0f, -1.0f}) {
        add(sign * a, b);
        add(a, sign * b);
      }
  std::uint64_t state = 1;
  const auto mantissa = [&] {
    return std::bit_cast<float>(0x3f800000u | std::uint32_t(nextBits(state) >> 41));
  };
  for (int i = 0; i < 200000; ++i) {
    const float b = mantissa(), q = mantissa();
    // q + ½ ulp, times b, is no float: its neighbours' quotients are the nearest to that middle.
    const double middle = (double(q) + 0x1p-24) * b;
    const float near = float(middle);
    for (const float a : {std::nextafter(near, 0.0f), near, std::nextafter(near, 4.0f)}) add(a, b);
    add(q * q, 1.0f);  // of which the root is near a float, and of what is below near a middle
    add(float((double(q) + 0x1p-24) * (double(q) + 0x1p-24)), 1.0f);
  }
  // Where an inverse is hardest to get right: denominators just below 2, by numerators of any sign, and
  // zeroes.
  for (int i = 1; i <= 4096; ++i)
    for (const float sign : {1.0f, -1.0f}) {
      const float b = 2 - float(i) * 0x1p-23f;
      add(sign * mantissa(), b);
      add(mantissa(), -sign * b);
      add(sign * 0.0f, b);
      add(sign * 0.0f, -b);
    }
  // Last, for the numbers before are usual ones to their vectors' last lanes.
  for (int i = 0; i < 200000; ++i)
    add(std::bit_cast<float>(std::uint32_t(nextBits(state) >> 32)),
        std::bit_cast<float>(std::uint32_t(nextBits(state) >> 32)));
  return pairs;
}

bool isSame(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

TEST(QuotientKernels, AreRoundedToNearestByTheDeviceAndByOurOwn) {
  const auto [a, b] = hardPairs();
  for (const int lanes : kAllLanes) {
    OpenedDevice& device = deviceWithLanes(lanes);
    const std::string own_of_device = device.arithmetic;
    for (const std::string& arithmetic :
         {own_of_device, std::string("-cl-denorms-are-zero -DOWN_QUOTIENTS")}) {
      device.arithmetic = arithmetic;
      const std::vector<Column> got = probe(device, "quotient_probe.cl", "probe_quotient", {a, b}, 3);
      int wrong = 0;
      for (std::size_t i = 0; i < a.size() && wrong < 10; ++i) {
        const float quotient = flushed(flushed(a[i]) / flushed(b[i])), root = std::sqrt(flushed(a[i]));
        for (const float one : {got[0][i], got[1][i]}) {
          // A quotient that rounds up to the smallest normal may have been flushed before.
          const bool is_edge = std::fabs(quotient) == 0x1p-126f && one == 0;
          if (isSame(one, quotient) || is_edge) continue;
          ++wrong;
          ADD_FAILURE() << std::hexfloat << a[i] << " / " << b[i] << " = " << one << ", not " << quotient
                        << ", " << lanes << " lanes, " << arithmetic;
        }
        if (isSame(got[2][i], root)) continue;
        ++wrong;
        ADD_FAILURE() << std::hexfloat << "root of " << a[i] << " = " << got[2][i] << ", not " << root << ", "
                      << lanes << " lanes, " << arithmetic;
      }
    }
    device.arithmetic = own_of_device;
  }
}

}  // namespace
}  // namespace luciole::test
