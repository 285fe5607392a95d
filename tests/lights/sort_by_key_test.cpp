#include "lights/sort_by_key.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "base/random.hpp"

namespace luciole {
namespace {

void expectSortedAsStableSortDoes(KeyedArray elements, const std::string& what) {
  KeyedArray expected = elements;
  std::stable_sort(expected.begin(), expected.end(),
                   [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
  sortByKey(elements);
  ASSERT_EQ(elements.size(), expected.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    ASSERT_EQ(elements[i].key, expected[i].key) << what << ' ' << i;
    ASSERT_EQ(elements[i].index, expected[i].index) << what << ' ' << i;
  }
}

TEST(SortByKey, GivesTheOrderOfStableSortForKeysOfAnyBits) {
  std::uint64_t state = 5;
  for (const std::uint32_t count : {0u, 1u, 2u, 1000u, 65535u, 65536u, 65537u, 200001u}) {
    for (const std::uint64_t bits :
         {~std::uint64_t(0), std::uint64_t(0), std::uint64_t(3), std::uint64_t(3) << 62,
          std::uint64_t(0x3ff) << 54, (std::uint64_t(1) << 54) - 1, std::uint64_t(1) << 10 | 1 << 11}) {
      KeyedArray elements;
      for (std::uint32_t i = 0; i < count; ++i) elements.push_back({nextBits(state) & bits, i});
      expectSortedAsStableSortDoes(elements,
                                   testing::PrintToString(count) + " of " + testing::PrintToString(bits));
    }
  }
}

TEST(SortByKey, KeepsWhatIsSortedAndTurnsWhatIsReversed) {
  KeyedArray rising, falling;
  for (std::uint32_t i = 0; i < 100000; ++i) {
    rising.push_back({std::uint64_t(i) << 40, i});
    falling.push_back({std::numeric_limits<std::uint64_t>::max() - i / 3, i});
  }
  expectSortedAsStableSortDoes(rising, "rising");
  expectSortedAsStableSortDoes(falling, "falling");
}

}  // namespace
}  // namespace luciole
