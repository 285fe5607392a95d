#include "lights/sort_by_key.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <functional>

namespace luciole {
namespace {

constexpr int kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t(1) << kDigitBits;
/// The highest digits are sorted by radix. Of 10⁶ points all over a box hardly two have the same three.
constexpr int kRadixDigits = 3;
constexpr std::size_t kBlock = std::size_t(1) << 16;  ///< elements of a task

/// The bits in which keys differ from each other.
std::uint64_t varyingBits(const RawArray<Keyed>& elements) {
  const auto add = [&](const tbb::blocked_range<std::size_t>& range, std::uint64_t bits) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) bits |= elements[i].key ^ elements[0].key;
    return bits;
  };
  return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, elements.size()), std::uint64_t(0), add,
                              std::bit_or<>());
}

/// Sorts by the bits of keys from `shift` on, below `bits`: a radix sort from the lowest digit up.
void sortByDigits(RawArray<Keyed>& elements, int shift, int bits) {
  const std::size_t blocks = (elements.size() + kBlock - 1) / kBlock;
  // For each digit of each block: how many there are, and then where the next one goes.
  std::vector<std::array<std::uint32_t, kDigits>> places(blocks);
  RawArray<Keyed> sorted(elements.size());
  for (; shift < bits; shift += kDigitBits) {
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
    for (std::size_t digit = 0; digit < kDigits; ++digit)
      for (std::array<std::uint32_t, kDigits>& own : places) {
        const std::uint32_t count = own[digit];
        own[digit] = next;
        next += count;
      }
    forEach([&](const Keyed& element, std::uint32_t& place) { sorted[place++] = element; });
    elements.swap(sorted);
  }
}

/// Sorts each run of elements whose keys are alike but for their lowest `bits` bits.
void sortRuns(RawArray<Keyed>& elements, int bits) {
  const auto endOfRun = [&](std::size_t i) {
    for (++i; i < elements.size() && elements[i].key >> bits == elements[i - 1].key >> bits;) ++i;
    return i;
  };
  // No run is in two tasks.
  std::vector<std::size_t> starts{0};
  while (starts.back() < elements.size())
    starts.push_back(endOfRun(std::min(starts.back() + kBlock, elements.size()) - 1));
  tbb::parallel_for(std::size_t(1), starts.size(), [&](std::size_t task) {
    for (std::size_t first = starts[task - 1]; first < starts[task];) {
      const std::size_t end = endOfRun(first);
      std::sort(&elements[first], &elements[first] + (end - first), [](const Keyed& a, const Keyed& b) {
        return a.key != b.key ? a.key < b.key : a.index < b.index;
      });
      first = end;
    }
  });
}

}  // namespace

void sortByKey(RawArray<Keyed>& elements) {
  if (elements.empty()) return;
  const int bits = std::bit_width(varyingBits(elements));
  const int run_bits = std::max(bits - kRadixDigits * kDigitBits, 0);
  sortByDigits(elements, run_bits, bits);
  if (run_bits > 0) sortRuns(elements, run_bits);
}

}  // namespace luciole
