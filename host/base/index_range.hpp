#pragma once

#include <cstddef>

namespace luciole {

/// `count` elements of an array, from element `first` on.
struct IndexRange {
  std::size_t first = 0, count = 0;
};

}  // namespace luciole
