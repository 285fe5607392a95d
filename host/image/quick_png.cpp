#include "image/quick_png.hpp"

#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <vector>

#include "base/machine_memory.hpp"
#include "base/picture_size.hpp"
#include "image/spread_texels.hpp"

namespace luciole {
namespace {

using Bytes = std::span<const std::uint8_t>;

enum ColorType { kGrey = 0, kRgb = 2, kPalette = 3, kGreyAlpha = 4, kRgba = 6 };

struct Png {
  std::size_t width = 0, height = 0;
  int bits = 0;      ///< of a channel
  int channels = 0;  ///< of the file's rows: 1 where they hold indices
  bool indexed = false;
  Bytes palette;  ///< R G B each
  Bytes alphas;   ///< of the first colours of the palette
  std::vector<std::uint8_t> stream;

  std::size_t pixelBytes() const { return std::max(bits * channels / 8, 1); }
  std::size_t rowBytes() const { return (width * bits * channels + 7) / 8; }
};

std::uint32_t bigEndian(Bytes bytes) {
  return std::uint32_t(bytes[0]) << 24 | bytes[1] << 16 | bytes[2] << 8 | bytes[3];
}

/// A chunk (ISO 15948). Its type is empty where the file ends or the chunk is damaged.
struct Chunk {
  std::string_view type;
  Bytes data;
};

Chunk takeChunk(Bytes& rest) {
  constexpr std::size_t kAround = 12;  // length, type and check
  if (rest.size() < kAround) return {};
  const std::size_t length = bigEndian(rest);
  if (length > rest.size() - kAround) return {};
  const Bytes checked = rest.subspan(4, 4 + length);
  const std::uint32_t check = crc32_gzip_refl(0, checked.data(), checked.size());
  if (check != bigEndian(rest.subspan(8 + length))) return {};
  rest = rest.subspan(kAround + length);
  return {{reinterpret_cast<const char*>(checked.data()), 4}, checked.subspan(4)};
}

bool readHeader(Bytes header, Png& png) {
  if (header.size() != 13) return false;
  png.width = bigEndian(header);
  png.height = bigEndian(header.subspan(4));
  png.bits = header[8];
  const int color_type = header[9];
  constexpr std::array<int, 7> kChannels{1, 0, 3, 1, 2, 0, 4};  // by colour type
  if (color_type > kRgba) return false;
  png.channels = kChannels[color_type];
  png.indexed = color_type == kPalette;
  const bool few_bits = png.bits == 1 || png.bits == 2 || png.bits == 4;
  const bool has_bits = png.bits == 8 || (few_bits && png.channels == 1);
  const bool is_plain = header[10] == 0 && header[11] == 0 && header[12] == 0;  // not interlaced
  return png.channels > 0 && has_bits && is_plain && png.width >= 1 && png.width <= kLargestSide &&
         png.height >= 1 && png.height <= kLargestSide;
}

/// Whether a gAMA chunk may be taken for a gamma of 1 or is damaged.
bool mayBeLinear(Bytes gamma) {
  if (gamma.size() != 4) return true;
  const std::uint32_t value = bigEndian(gamma);  // 100,000 for 1
  return value > 98000 && value < 102000;
}

/// All up to the pixels' end, or false where this isn't a file for here.
bool readChunks(Bytes file, Png& png) {
  constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  if (file.size() < kSignature.size() || !std::equal(kSignature.begin(), kSignature.end(), file.begin()))
    return false;
  Bytes rest = file.subspan(kSignature.size());
  const Chunk header = takeChunk(rest);
  if (header.type != "IHDR" || !readHeader(header.data, png)) return false;
  // A header that claims more than deflate, which reaches 1 : 1032, can have packed into the file is damaged.
  constexpr std::size_t kMostCompression = 1040;
  if (png.rowBytes() * png.height / kMostCompression > file.size()) return false;
  for (;;) {
    const Chunk chunk = takeChunk(rest);
    if (chunk.type.empty()) return false;
    const bool may_be_skipped = chunk.type[0] >= 'a';
    if (chunk.type == "IDAT") {
      if (png.indexed && png.palette.empty()) return false;
      png.stream.insert(png.stream.end(), chunk.data.begin(), chunk.data.end());
    } else if (!png.stream.empty()) {
      return chunk.type == "IEND" || may_be_skipped;
    } else if (chunk.type == "PLTE" && png.indexed && png.palette.empty()) {
      png.palette = chunk.data;
      if (chunk.data.size() % 3 != 0 || chunk.data.size() / 3 > std::size_t(1) << png.bits) return false;
    } else if (chunk.type == "tRNS") {
      if (!png.alphas.empty() || 3 * chunk.data.size() > png.palette.size()) return false;
      png.alphas = chunk.data;
    } else if (!may_be_skipped || (chunk.type == "gAMA" && mayBeLinear(chunk.data))) {
      return false;
    }
  }
}

/// The filtered rows, each after its filter's number; empty where the stream is damaged or of another length.
std::unique_ptr<std::uint8_t[]> inflatedRows(const Png& png) {
  const std::size_t bytes = (png.rowBytes() + 1) * png.height;
  if (bytes > UINT32_MAX || png.stream.size() > UINT32_MAX) return nullptr;
  std::unique_ptr<std::uint8_t[]> rows(new std::uint8_t[bytes]);
  const auto state = std::make_unique<inflate_state>();
  isal_inflate_init(state.get());
  state->crc_flag = ISAL_ZLIB;
  state->next_in = const_cast<std::uint8_t*>(png.stream.data());
  state->avail_in = std::uint32_t(png.stream.size());
  state->next_out = rows.get();
  state->avail_out = std::uint32_t(bytes);
  const bool done = isal_inflate(state.get()) == ISAL_DECOMP_OK && state->block_state == ISAL_BLOCK_FINISH &&
                    state->avail_out == 0 && state->avail_in == 0;
  return done ? std::move(rows) : nullptr;
}

/// Paeth's predictor: of left, above and corner the one nearest to left + above - corner.
inline int paeth(int left, int above, int corner) {
  const int from_left = std::abs(above - corner), from_above = std::abs(left - corner);
  const int from_corner = std::abs(left + above - 2 * corner);
  const int other = from_above <= from_corner ? above : corner;
  return from_left <= from_above && from_left <= from_corner ? left : other;
}

/// Undoes the filters that refer to the pixel before. `above` is the row before, which is unfiltered.
template <int kPixelBytes, class Predict>
void unfilterBy(const Predict& predict, const std::uint8_t* above, std::size_t bytes, std::uint8_t* row) {
  std::array<int, kPixelBytes> left{}, corner{};
  for (std::size_t i = 0; i + kPixelBytes <= bytes; i += kPixelBytes) {
    for (int c = 0; c < kPixelBytes; ++c) {
      left[c] = (row[i + c] + predict(left[c], above[i + c], corner[c])) & 0xff;
      corner[c] = above[i + c];
      row[i + c] = std::uint8_t(left[c]);
    }
  }
}

/// Undoes a row's filter; false for one that doesn't exist.
template <int kPixelBytes>
bool unfilter(int filter, const std::uint8_t* above, std::size_t bytes, std::uint8_t* row) {
  switch (filter) {
    case 0:
      return true;
    case 1:
      unfilterBy<kPixelBytes>([](int left, int, int) { return left; }, above, bytes, row);
      return true;
    case 2:
      for (std::size_t i = 0; i < bytes; ++i) row[i] = std::uint8_t(row[i] + above[i]);
      return true;
    case 3:
      unfilterBy<kPixelBytes>([](int left, int up, int) { return (left + up) >> 1; }, above, bytes, row);
      return true;
    case 4:
      unfilterBy<kPixelBytes>(paeth, above, bytes, row);
      return true;
    default:
      return false;
  }
}

bool unfilterRow(const Png& png, int filter, const std::uint8_t* above, std::uint8_t* row) {
  switch (png.pixelBytes()) {
    case 1:
      return unfilter<1>(filter, above, png.rowBytes(), row);
    case 2:
      return unfilter<2>(filter, above, png.rowBytes(), row);
    case 3:
      return unfilter<3>(filter, above, png.rowBytes(), row);
    default:
      return unfilter<4>(filter, above, png.rowBytes(), row);
  }
}

/// The texel of each value of a row of indices, or of greys of fewer than 8 bits; false where one has none.
bool lookUpRow(const Png& png, const std::uint8_t* row, std::uint16_t* texels) {
  const unsigned most = (1u << png.bits) - 1;
  for (std::size_t x = 0; x < png.width; ++x, texels += 4) {
    const std::size_t bit = x * png.bits;
    const unsigned value = row[bit / 8] >> (8 - png.bits - bit % 8) & most;
    if (!png.indexed) {
      texels[0] = texels[1] = texels[2] = wideCode(std::uint8_t(value * 255 / most));
      texels[3] = 65535;
      continue;
    }
    if (3 * value >= png.palette.size()) return false;
    for (int c = 0; c < 3; ++c) texels[c] = wideCode(png.palette[3 * value + c]);
    texels[3] = value < png.alphas.size() ? wideCode(png.alphas[value]) : std::uint16_t(65535);
  }
  return true;
}

}  // namespace

std::optional<MipLevel> readPngQuickly(std::span<const std::byte> file, const std::string& name) {
  Png png;
  if (!readChunks({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()}, png))
    return std::nullopt;
  const std::size_t texel_bytes = 4 * sizeof(std::uint16_t);
  // The rows, the texels, and a third more for the mip chain.
  requireMemory(double(png.rowBytes() * png.height) + double(png.width * png.height * texel_bytes) * 4 / 3,
                name);
  const std::unique_ptr<std::uint8_t[]> rows = inflatedRows(png);
  if (!rows) return std::nullopt;
  MipLevel level{int(png.width), int(png.height), Texels(png.width * png.height * 4)};
  const std::vector<std::uint8_t> nothing(png.rowBytes());
  const std::uint8_t* above = nothing.data();
  for (std::size_t y = 0; y < png.height; ++y) {
    std::uint8_t* row = &rows[y * (png.rowBytes() + 1)] + 1;
    if (!unfilterRow(png, row[-1], above, row)) return std::nullopt;
    std::uint16_t* texels = &level.texels[y * png.width * 4];
    if (png.bits < 8 || png.indexed) {
      if (!lookUpRow(png, row, texels)) return std::nullopt;
    } else {
      spreadTexels(row, png.width, png.channels, texels);
    }
    above = row;
  }
  return level;
}

}  // namespace luciole
