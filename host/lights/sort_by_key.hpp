#pragma once

#include <cstdint>
#include <vector>

#include "luciole/array_memory.hpp"

namespace luciole {

/// A number to sort by and what it belongs to.
struct Keyed {
  std::uint64_t key;
  std::uint32_t index;
};

using KeyedArray = std::vector<Keyed, RawArrayAllocator<Keyed>>;

/// Sorts by key, ascending; elements of one key keep their order. A radix sort from the lowest digit up, on
/// all cores, of O(n) for any keys. Takes as much memory again as the array has. At most 2³² − 1 elements.
void sortByKey(KeyedArray& elements);

}  // namespace luciole
