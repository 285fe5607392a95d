#pragma once

#include <cstddef>

namespace luciole {

/// Asks for large pages in memory that nothing was written to yet, where it holds whole ones: filling it
/// takes a quarter of the time then. Only a hint.
void askForLargePages(void* memory, std::size_t bytes);

/// Reserves room for `count` elements in an empty vector or string, in large pages.
template <class Container>
void reserveLarge(Container& container, std::size_t count) {
  container.reserve(count);
  askForLargePages(container.data(), container.capacity() * sizeof(*container.data()));
}

}  // namespace luciole
