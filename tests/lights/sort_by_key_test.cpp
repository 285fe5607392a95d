#include "lights/sort_by_key.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace luciole {
namespace {

struct KeyBits {
  std::uint64_t same;     ///< set in all keys
  std::uint64_t varying;  ///< random in each
};

class SortByKey : public testing::TestWithParam<KeyBits> {};

TEST_P(SortByKey, OrdersByKeyAndThenByIndex) {
  std::mt19937_64 random(7);
  for (const std::uint32_t count : {0u, 1u, 2u, 1000u, 200'001u}) {
    RawArray<Keyed> elements(count);
    for (std::uint32_t i = 0; i < count; ++i)
      elements[i] = {GetParam().same | (random() & GetParam().varying), i};
    RawArray<Keyed> expected = elements;
    std::stable_sort(expected.begin(), expected.end(),
                     [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
    sortByKey(elements);
    for (std::uint32_t i = 0; i < count; ++i) {
      ASSERT_EQ(elements[i].key, expected[i].key) << i << " of " << count;
      ASSERT_EQ(elements[i].index, expected[i].index) << i << " of " << count;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bits, SortByKey,
                         testing::Values(KeyBits{0, ~std::uint64_t(0)},                 // any
                                         KeyBits{~std::uint64_t(0), 0},                 // all alike
                                         KeyBits{std::uint64_t(1) << 60, 0x3ff},        // one digit
                                         KeyBits{0, 0x00f0'0000'0000'00ff},             // many of a run
                                         KeyBits{0, 0x8000'0000'0000'0001},             // four keys in all
                                         KeyBits{std::uint64_t(3) << 60, 0xffff'ffff})  // no run
);

}  // namespace
}  // namespace luciole
