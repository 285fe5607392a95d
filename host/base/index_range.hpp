#pragma once

#include <cstddef>

namespace luciole {

/// A rectangle of array elements: `rows` runs of `count` elements. The first run begins at element `first`,
/// each other one `pitch` elements after the run before. With one run it is a plain range, and `pitch` is not
/// used.
struct IndexRange {
  std::size_t first = 0, count = 0;
  std::size_t rows = 1, pitch = 0;
};

}  // namespace luciole
