#include "image/exr_zip.hpp"

#include <ImfChannelList.h>
#include <ImfPartType.h>
#include <half.h>
#include <isa-l/igzip_lib.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <stdexcept>
#include <utility>

namespace luciole {
namespace {

using Bytes = std::vector<std::uint8_t>;

int rowsInBlock(Imf::Compression compression) { return compression == Imf::ZIPS_COMPRESSION ? 1 : 16; }

/// Where a wanted channel lies in a block: each of its rows holds all channels one after another.
struct Slot {
  std::size_t offset;  ///< bytes from a row's begin
  Imf::PixelType type;
  float* plane;
};

struct Rows {
  std::size_t width, bytes;  ///< bytes: of a row
  std::vector<Slot> slots;
};

Rows rowsOf(const Imf::Header& header, const std::vector<WantedChannel>& wanted) {
  const Imath::Box2i& window = header.dataWindow();
  Rows rows{std::size_t(window.max.x) - std::size_t(window.min.x) + 1, 0, {}};
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
    const Imf::PixelType type = i.channel().type;
    for (const WantedChannel& one : wanted)
      if (one.name == i.name()) rows.slots.push_back({rows.bytes, type, one.plane});
    rows.bytes += rows.width * (type == Imf::HALF ? 2 : 4);
  }
  return rows;
}

/// Decompresses a whole stream (RFC 1950), whose length is known.
void inflate(std::span<const std::uint8_t> packed, std::span<std::uint8_t> bytes, inflate_state& state) {
  isal_inflate_init(&state);
  state.crc_flag = ISAL_ZLIB;
  state.next_in = const_cast<std::uint8_t*>(packed.data());
  state.avail_in = std::uint32_t(packed.size());
  state.next_out = bytes.data();
  state.avail_out = std::uint32_t(bytes.size());
  const bool done = isal_inflate(&state) == ISAL_DECOMP_OK && state.block_state == ISAL_BLOCK_FINISH;
  if (!done || state.total_out != bytes.size())
    throw std::runtime_error("a block of rows can't be decompressed");
}

/// Bytes of a block. Zip holds each byte as its difference from the one before, + 128, and the odd bytes
/// after the even ones.
struct Block {
  Bytes bytes;
  bool is_plain = false;  ///< in their own order, as where compression would not have made them fewer

  void undoDifferences() {
    std::uint8_t last = bytes.empty() ? 0 : bytes[0];
    for (std::size_t i = 1; i < bytes.size(); ++i)
      bytes[i] = last = std::uint8_t(last + std::uint8_t(bytes[i] - 128));
  }
  const std::uint8_t* even(std::size_t at) const { return bytes.data() + at / 2; }
  const std::uint8_t* odd(std::size_t at) const { return bytes.data() + (bytes.size() + 1) / 2 + at / 2; }
};

/// A thread's memory, kept from block to block.
struct Workplace {
  Bytes packed;
  Block block;
  std::unique_ptr<inflate_state> state;
};

std::uint32_t word(std::uint8_t a, std::uint8_t b, std::uint8_t c = 0, std::uint8_t d = 0) {
  return std::uint32_t(a) | std::uint32_t(b) << 8 | std::uint32_t(c) << 16 | std::uint32_t(d) << 24;
}

float valueOf(std::uint32_t bits, Imf::PixelType type) {
  if (type == Imf::FLOAT) return std::bit_cast<float>(bits);
  if (type == Imf::UINT) return float(bits);
  half small;
  small.setBits(static_cast<unsigned short>(bits));
  return small;
}

/// Writes a row of a channel, which begins at that byte of the block.
void unpackRow(const Block& block, std::size_t at, std::size_t width, Imf::PixelType type, float* out) {
  if (block.is_plain) {
    const std::uint8_t* in = block.bytes.data() + at;
    for (std::size_t x = 0; x < width; ++x, in += type == Imf::HALF ? 2 : 4)
      out[x] = valueOf(type == Imf::HALF ? word(in[0], in[1]) : word(in[0], in[1], in[2], in[3]), type);
    return;
  }
  const std::uint8_t *even = block.even(at), *odd = block.odd(at);
  if (type == Imf::HALF) {
    for (std::size_t x = 0; x < width; ++x) out[x] = valueOf(word(even[x], odd[x]), type);
  } else {
    for (std::size_t x = 0; x < width; ++x)
      out[x] = valueOf(word(even[2 * x], odd[2 * x], even[2 * x + 1], odd[2 * x + 1]), type);
  }
}

}  // namespace

bool isZip(const Imf::Header& header) {
  const Imf::Compression compression = header.compression();
  if (compression != Imf::ZIP_COMPRESSION && compression != Imf::ZIPS_COMPRESSION) return false;
  if (header.hasTileDescription() || (header.hasType() && header.type() != Imf::SCANLINEIMAGE)) return false;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i)
    if (i.channel().xSampling != 1 || i.channel().ySampling != 1) return false;
  return true;
}

void readZip(Imf::InputPart& part, const std::vector<WantedChannel>& wanted) {
  const Imf::Header& header = part.header();
  const Rows rows = rowsOf(header, wanted);
  const int first = header.dataWindow().min.y, height = header.dataWindow().max.y - first + 1,
            in_block = rowsInBlock(header.compression());
  std::mutex library;
  tbb::enumerable_thread_specific<Workplace> workplaces;
  tbb::parallel_for(0, (height + in_block - 1) / in_block, [&](int index) {
    const int y = index * in_block, count = std::min(in_block, height - y);
    auto& [packed, block, state] = workplaces.local();
    {
      const std::lock_guard lock(library);
      const char* data = nullptr;
      int size = 0;
      part.rawPixelData(first + y, data, size);
      packed.assign(data, data + size);
    }
    const std::size_t length = rows.bytes * std::size_t(count);
    block.is_plain = packed.size() >= length;
    if (block.is_plain) {
      std::swap(block.bytes, packed);
    } else {
      block.bytes.resize(length);
      if (!state) state = std::make_unique<inflate_state>();
      inflate(packed, block.bytes, *state);
      block.undoDifferences();
    }
    for (int row = 0; row < count; ++row)
      for (const Slot& slot : rows.slots)
        unpackRow(block, std::size_t(row) * rows.bytes + slot.offset, rows.width, slot.type,
                  slot.plane + std::size_t(y + row) * rows.width);
  });
}

}  // namespace luciole
