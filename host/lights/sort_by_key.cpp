#include "lights/sort_by_key.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace luciole {

void sortByKey(KeyedArray& elements) {
  constexpr int kDigitBits = 11;
  constexpr std::size_t kDigits = std::size_t(1) << kDigitBits, kBlock = std::size_t(1) << 16;
  const std::size_t blocks = (elements.size() + kBlock - 1) / kBlock;
  // For each digit of each block: how many there are, and then where the next one goes.
  std::vector<std::array<std::uint32_t, kDigits>> places(blocks);
  KeyedArray sorted(elements.size());
  for (int shift = 0; shift < 64; shift += kDigitBits) {
    const auto forEach = [&](const auto& use) {
      tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
        std::array<std::uint32_t, kDigits>& own = places[block];
        const std::size_t end = std::min((block + 1) * kBlock, elements.size());
        for (std::size_t i = block * kBlock; i < end; ++i)
          use(elements[i], own[elements[i].key >> shift & (kDigits - 1)]);
      });
    };
    std::fill(places.begin(), places.end(), std::array<std::uint32_t, kDigits>{});
    forEach([](const Keyed&, std::uint32_t& count) { ++count; });
    std::uint32_t next = 0;
    bool is_sorted = false;  // all have the same digit
    for (std::size_t digit = 0; digit < kDigits; ++digit) {
      const std::uint32_t first = next;
      for (std::array<std::uint32_t, kDigits>& own : places) {
        const std::uint32_t count = own[digit];
        own[digit] = next;
        next += count;
      }
      is_sorted |= next - first == elements.size();
    }
    if (is_sorted) continue;
    forEach([&](const Keyed& element, std::uint32_t& place) { sorted[place++] = element; });
    elements.swap(sorted);
  }
}

}  // namespace luciole
