#include "image/png_filters.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

namespace luciole {
namespace {

constexpr int kFilters = 5;

/// What the filter expects of a byte, by those to its left, above it, and above the one to its left. 16 bits
/// are enough, and leave twice as many values in a vector as 32.
template <int kFilter>
inline std::int16_t expected(std::int16_t left, std::int16_t above, std::int16_t corner) {
  if constexpr (kFilter == 1) return left;
  if constexpr (kFilter == 2) return above;
  if constexpr (kFilter == 3) return std::int16_t((left + above) >> 1);
  if constexpr (kFilter == 4) {  // Paeth's: the one nearest to left + above - corner
    const auto from_left = std::int16_t(std::abs(above - corner));
    const auto from_above = std::int16_t(std::abs(left - corner));
    const auto from_corner = std::int16_t(std::abs(left + above - 2 * corner));
    const std::int16_t one = from_above <= from_corner ? above : corner;
    return ((from_left <= from_above) & (from_left <= from_corner)) ? left : one;
  }
  return 0;
}

/// Filters the row and returns the sum of its bytes' magnitudes.
template <int kFilter>
std::uint64_t filterBy(const std::uint8_t* row, const std::uint8_t* above, std::size_t bytes,
                       std::size_t pixel_bytes, std::uint8_t* out) {
  constexpr std::size_t kBlock = 256;  // sums of so many magnitudes fit into 16 bits
  *out++ = std::uint8_t(kFilter);
  std::uint64_t sum = 0;
  for (std::size_t first = 0; first < bytes; first += kBlock) {
    const std::size_t end = std::min(first + kBlock, bytes);
    std::uint16_t of_block = 0;
    for (std::size_t i = first; i < end; ++i) {
      const auto rest =
          std::uint8_t(row[i] - expected<kFilter>(row[i - pixel_bytes], above[i], above[i - pixel_bytes]));
      out[i] = rest;
      of_block = std::uint16_t(of_block + std::min<std::uint8_t>(rest, std::uint8_t(-rest)));
    }
    sum += of_block;
  }
  return sum;
}

template <int kFilter, int kPixelBytes>
void unfilterBy(std::uint8_t* row, const std::uint8_t* above, std::size_t bytes) {
  std::int16_t left[kPixelBytes]{}, corner[kPixelBytes]{};
  for (std::size_t i = 0; i < bytes; i += kPixelBytes)
    for (int c = 0; c < kPixelBytes; ++c) {
      left[c] = std::uint8_t(row[i + c] + expected<kFilter>(left[c], above[i + c], corner[c]));
      corner[c] = above[i + c];
      row[i + c] = std::uint8_t(left[c]);
    }
}

/// A pixel's bytes. GCC and Clang make vector instructions of this type on any machine.
using Bytes = std::int16_t __attribute__((vector_size(8 * sizeof(std::int16_t))));

template <int kPixelBytes>
inline void load(const std::uint8_t* from, Bytes& bytes) {
  bytes = Bytes{};
  for (int c = 0; c < kPixelBytes; ++c) bytes[c] = from[c];
}

/// unfilterBy() of Paeth's filter, whose comparisons compilers don't make vectors of: half of the time.
template <int kPixelBytes>
void unfilterPaeth(std::uint8_t* row, const std::uint8_t* above, std::size_t bytes) {
  Bytes left{}, corner{}, up, rest;
  for (std::size_t i = 0; i < bytes; i += kPixelBytes) {
    load<kPixelBytes>(above + i, up);
    load<kPixelBytes>(row + i, rest);
    const Bytes along = up - corner, down = left - corner, both = along + down;
    const Bytes from_left = along > -along ? along : -along, from_above = down > -down ? down : -down,
                from_corner = both > -both ? both : -both;
    const Bytes one = from_above <= from_corner ? up : corner;
    left = (rest + (((from_left <= from_above) & (from_left <= from_corner)) ? left : one)) & 255;
    corner = up;
    for (int c = 0; c < kPixelBytes; ++c) row[i + c] = std::uint8_t(left[c]);
  }
}

template <int kPixelBytes>
bool unfilter(int filter, std::uint8_t* row, const std::uint8_t* above, std::size_t bytes) {
  switch (filter) {
    case 0:
      return true;
    case 1:
      unfilterBy<1, kPixelBytes>(row, above, bytes);
      return true;
    case 2:
      unfilterBy<2, kPixelBytes>(row, above, bytes);
      return true;
    case 3:
      unfilterBy<3, kPixelBytes>(row, above, bytes);
      return true;
    case 4:
      unfilterPaeth<kPixelBytes>(row, above, bytes);
      return true;
    default:
      return false;
  }
}

}  // namespace

void filterPngRow(const std::uint8_t* row, const std::uint8_t* above, std::size_t bytes,
                  std::size_t pixel_bytes, std::uint8_t* out, std::uint8_t* spare) {
  constexpr std::array<decltype(&filterBy<0>), kFilters> kBy{filterBy<0>, filterBy<1>, filterBy<2>,
                                                             filterBy<3>, filterBy<4>};
  std::uint8_t* rows[2] = {out, spare};  // the best one yet, and the other
  std::uint64_t least = kBy[0](row, above, bytes, pixel_bytes, rows[0]);
  for (int filter = 1; filter < kFilters; ++filter) {
    const std::uint64_t sum = kBy[filter](row, above, bytes, pixel_bytes, rows[1]);
    if (sum >= least) continue;
    least = sum;
    std::swap(rows[0], rows[1]);
  }
  if (rows[0] != out) std::memcpy(out, rows[0], bytes + 1);
}

bool unfilterPngRow(int filter, std::uint8_t* row, const std::uint8_t* above, std::size_t bytes,
                    std::size_t pixel_bytes) {
  constexpr std::array<decltype(&unfilter<1>), 4> kBy{unfilter<1>, unfilter<2>, unfilter<3>, unfilter<4>};
  return kBy[pixel_bytes - 1](filter, row, above, bytes);
}

}  // namespace luciole
