#include "image/srgb_codes.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "image/srgb.hpp"

namespace luciole {
namespace {

template <class Code>
void expectTheCodesOf(const std::vector<float>& values) {
  std::vector<float> thresholds;
  for (std::size_t i = 0; i < values.size(); ++i) thresholds.push_back((float(i * 97 % 256) + 0.5f) / 256);
  std::vector<Code> codes(values.size());
  srgbCodes(values.data(), thresholds.data(), values.size(), codes.data());
  for (std::size_t i = 0; i < values.size(); ++i)
    ASSERT_EQ(codes[i], Code(encodeSrgb(values[i]) * float(std::numeric_limits<Code>::max()) + thresholds[i]))
        << values[i];
}

TEST(SrgbCodes, AreThoseOfTheTransferFunctionToTheLastBit) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<float> values{0.0f,      -0.0f,      -1.0f,
                            kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()};
  const std::uint32_t one = std::bit_cast<std::uint32_t>(1.0f);
  const std::uint32_t curve = std::bit_cast<std::uint32_t>(0.003f);
  for (std::uint32_t bits = 0; bits < curve; bits += 4093) values.push_back(std::bit_cast<float>(bits));
  for (std::uint32_t bits = curve; bits <= one + 100; bits += 13)
    values.push_back(std::bit_cast<float>(bits));
  expectTheCodesOf<std::uint8_t>(values);
  expectTheCodesOf<std::uint16_t>(values);
}

TEST(SrgbCodes, OfAnyNumberOfValues) {
  for (const int count : {0, 1, 63, 64, 65, 144}) {
    std::vector<float> values;
    for (int i = 0; i < count; ++i) values.push_back(float(i) / 144);
    expectTheCodesOf<std::uint8_t>(values);
    expectTheCodesOf<std::uint16_t>(values);
  }
}

}  // namespace
}  // namespace luciole
