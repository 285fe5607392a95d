#pragma once

#include <isa-l/igzip_lib.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "image/png_rows.hpp"

namespace luciole {

/// The pixels of a PNG in memory, row by row, as 8-bit codes: palettes and fewer bits become bytes,
/// transparent colours alpha. ISA-L inflates them, in half of the time that zlib takes for libpng. Only for
/// pictures of at most 8 bits a channel that aren't interlaced.
class PngPixels {
 public:
  /// `header` has read the file's header, up to its pixels. `chunks`: the rest, from the first IDAT chunk on.
  /// Both must outlive this.
  PngPixels(const PngRows& header, std::span<const std::byte> chunks);

  std::size_t width() const { return width_; }
  std::size_t height() const { return height_; }
  int channels() const { return (palette_ ? 3 : file_channels_) + (has_transparency_ ? 1 : 0); }

  /// The codes of the next row, valid until the next call; null where the file is damaged.
  const std::uint8_t* next();

  /// To be called after the last row: whether nothing is missing, left over or damaged.
  bool end();

 private:
  bool feed();
  bool inflate(std::uint8_t* out, std::size_t count);
  bool inflateRows();
  const std::uint8_t* expanded(const std::uint8_t* row);

  std::span<const std::byte> chunks_;  ///< not yet inflated
  std::size_t width_, height_, row_bytes_;
  int bits_, file_channels_;
  const png_color* palette_ = nullptr;
  bool has_transparency_;
  std::array<std::uint8_t, 256> alphas_{};  ///< of the palette's colours
  std::array<std::uint8_t, 3> hidden_{};    ///< the colour that is transparent, where there is no palette
  std::unique_ptr<inflate_state> stream_;
  std::size_t rows_left_;  ///< not yet inflated
  std::vector<std::uint8_t>
      rows_;  ///< each behind its filter's number; the first is the one before the others
  std::size_t inflated_ = 0, given_ = 0;  ///< rows behind that one
  std::vector<std::uint8_t> codes_;       ///< of a row, where they aren't the file's bytes
};

}  // namespace luciole
