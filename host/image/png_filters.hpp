#pragma once

#include <cstddef>
#include <cstdint>

namespace luciole {

/// Filters a row of a PNG by the one of the five filters whose bytes, signed, have the least sum of
/// magnitudes: the PNG specification's advice for pictures of true colour (ISO 15948, 9.2 and 12.8).
/// `row` and `above`, the row before it, zeros for the first one: `bytes` bytes each, after `pixel_bytes`, at
/// most 8, zeros. `out`: the filter's number and the bytes. `spare`: room for another such row.
void filterPngRow(const std::uint8_t* row, const std::uint8_t* above, std::size_t bytes,
                  std::size_t pixel_bytes, std::uint8_t* out, std::uint8_t* spare);

/// Undoes the filter of a row of a PNG, in place. `above`: the row before it, zeros for the first one. Both
/// have `bytes` bytes, whole pixels of `pixel_bytes`, 1 to 4. Returns false where there is no such filter.
bool unfilterPngRow(int filter, std::uint8_t* row, const std::uint8_t* above, std::size_t bytes,
                    std::size_t pixel_bytes);

}  // namespace luciole
