#pragma once

#include <cstddef>

namespace luciole {

/// A rectangle of array elements: `rows` runs of `count` elements, `pitch` elements apart, the first at
/// element `first`. With one run `pitch` isn't used.
struct IndexRange {
  std::size_t first = 0, count = 0;
  std::size_t rows = 1, pitch = 0;
};

}  // namespace luciole
