#pragma once

#include <cstddef>

namespace luciole {

/// Elements of an array: `rows` runs of `count` elements, of which the first begins at element `first` and
/// each other `pitch` elements after the one before. One run is a plain range.
struct IndexRange {
  std::size_t first = 0, count = 0;
  std::size_t rows = 1, pitch = 0;
};

}  // namespace luciole
