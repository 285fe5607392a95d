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

/// Sorts by key, ascending, and elements of one key by index. On all cores: by radix in O(n), but elements
/// whose keys differ in their lowest bits only in O(n log n). Takes as much memory again as the array has. At
/// most 2³² − 1 elements.
void sortByKey(RawArray<Keyed>& elements);

}  // namespace luciole
