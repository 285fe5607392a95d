#include "image/png_pixels.hpp"

#include <isa-l/crc.h>

#include <algorithm>
#include <cstring>

#include "image/png_filters.hpp"

namespace luciole {
namespace {

/// Rows are inflated together, so many bytes: few calls, and they stay in a core's cache.
constexpr std::size_t kInflatedBytes = 1 << 17;

std::uint32_t bigEndian(const std::byte* bytes) {
  const auto at = [&](int i) { return std::uint32_t(bytes[i]); };
  return at(0) << 24 | at(1) << 16 | at(2) << 8 | at(3);
}

}  // namespace

PngPixels::PngPixels(const PngRows& header, std::span<const std::byte> chunks)
    : chunks_(chunks),
      width_(header.width()),
      height_(header.height()),
      row_bytes_(png_get_rowbytes(header.png(), header.info())),
      bits_(png_get_bit_depth(header.png(), header.info())),
      file_channels_(header.channels()),
      has_transparency_(png_get_valid(header.png(), header.info(), PNG_INFO_tRNS) != 0),
      stream_(std::make_unique<inflate_state>()),
      rows_left_(height_),
      rows_((std::min(height_, std::max<std::size_t>(1, kInflatedBytes / (row_bytes_ + 1))) + 1) *
            (row_bytes_ + 1)),
      codes_(width_ * 4) {
  png_structp png = header.png();
  png_infop info = header.info();
  if (png_get_color_type(png, info) == PNG_COLOR_TYPE_PALETTE) {
    png_colorp colors = nullptr;
    int count = 0;
    png_get_PLTE(png, info, &colors, &count);
    palette_ = colors;
  }
  alphas_.fill(255);
  png_bytep alphas = nullptr;
  int alpha_count = 0;
  png_color_16p hidden = nullptr;
  if (has_transparency_) png_get_tRNS(png, info, &alphas, &alpha_count, &hidden);
  if (palette_ && alphas) std::copy_n(alphas, alpha_count, alphas_.begin());
  if (!palette_ && hidden)
    hidden_ = file_channels_ == 1
                  ? std::array<std::uint8_t, 3>{std::uint8_t(hidden->gray & ((1 << bits_) - 1)), 0, 0}
                  : std::array<std::uint8_t, 3>{std::uint8_t(hidden->red), std::uint8_t(hidden->green),
                                                std::uint8_t(hidden->blue)};
  isal_inflate_init(stream_.get());
  stream_->crc_flag = ISAL_ZLIB;
}

/// Makes the next IDAT chunk the input. Returns false where there is none, or it is damaged.
bool PngPixels::feed() {
  constexpr std::size_t kAround = 12;  // length, type, and the sum of type and data
  if (chunks_.size() < kAround || std::memcmp(&chunks_[4], "IDAT", 4) != 0) return false;
  const std::uint32_t length = bigEndian(chunks_.data());
  if (length > chunks_.size() - kAround) return false;
  const auto* type = reinterpret_cast<const unsigned char*>(&chunks_[4]);
  if (crc32_gzip_refl(0, type, std::uint64_t(length) + 4) != bigEndian(&chunks_[8 + length])) return false;
  stream_->next_in = const_cast<std::uint8_t*>(type + 4);
  stream_->avail_in = length;
  chunks_ = chunks_.subspan(kAround + length);
  return true;
}

/// Inflates the next bytes. Returns false where there aren't as many.
bool PngPixels::inflate(std::uint8_t* out, std::size_t count) {
  stream_->next_out = out;
  stream_->avail_out = std::uint32_t(count);
  while (stream_->avail_out > 0) {
    const std::uint32_t before = stream_->avail_out;
    const bool is_fed = stream_->avail_in > 0 || feed();
    if (isal_inflate(stream_.get()) != ISAL_DECOMP_OK) return false;
    if (!is_fed && stream_->avail_out == before) return false;
  }
  return true;
}

/// Fills rows_ with the next ones. The last one given becomes the first.
bool PngPixels::inflateRows() {
  const std::size_t stride = row_bytes_ + 1;
  std::memmove(rows_.data(), rows_.data() + given_ * stride, stride);
  inflated_ = std::min(rows_left_, rows_.size() / stride - 1);
  rows_left_ -= inflated_;
  given_ = 0;
  return inflated_ > 0 && inflate(rows_.data() + stride, inflated_ * stride);
}

/// The codes of a row with a palette, a transparent colour, or fewer than 8 bits.
const std::uint8_t* PngPixels::expanded(const std::uint8_t* row) {
  const int mask = (1 << bits_) - 1;
  std::uint8_t* code = codes_.data();
  for (std::size_t i = 0; i < width_; ++i) {
    if (file_channels_ == 3) {
      std::copy_n(row + 3 * i, 3, code);
      code[3] = std::equal(hidden_.begin(), hidden_.end(), code) ? 0 : 255;
      code += 4;
      continue;
    }
    const std::size_t bit = i * std::size_t(bits_);
    const int value = row[bit / 8] >> (8 - bits_ - int(bit % 8)) & mask;
    if (palette_) {
      const png_color& color = palette_[value];
      *code++ = color.red;
      *code++ = color.green;
      *code++ = color.blue;
      if (has_transparency_) *code++ = alphas_[std::size_t(value)];
    } else {
      *code++ = std::uint8_t(value * (255 / mask));
      if (has_transparency_) *code++ = value == hidden_[0] ? 0 : 255;
    }
  }
  return codes_.data();
}

const std::uint8_t* PngPixels::next() {
  if (given_ == inflated_ && !inflateRows()) return nullptr;
  const std::uint8_t* above = rows_.data() + given_ * (row_bytes_ + 1) + 1;
  std::uint8_t* row = rows_.data() + ++given_ * (row_bytes_ + 1) + 1;
  const std::size_t pixel_bytes = std::size_t(std::max(1, file_channels_ * bits_ / 8));
  if (!unfilterPngRow(row[-1], row, above, row_bytes_, pixel_bytes)) return nullptr;
  return bits_ < 8 || palette_ || has_transparency_ ? expanded(row) : row;
}

bool PngPixels::end() {
  std::uint8_t more;
  return !inflate(&more, 1) && stream_->block_state == ISAL_BLOCK_FINISH && stream_->avail_in == 0;
}

}  // namespace luciole
