#include "image/deflate.hpp"

#include <zlib.h>

#include <cstddef>

#include "luciole/error.hpp"

namespace luciole {
namespace {

// The most thorough of ISA-L's four levels.
constexpr std::uint32_t kFastLevel = 3;
constexpr std::size_t kFastTables = ISAL_DEF_LVL3_DEFAULT;

/// Upper bound of a compressed piece: a literal takes at most 15 bits, a match fewer than its bytes as
/// literals. Each block of thousands of symbols has a header below 400 bytes.
std::size_t bound(std::size_t bytes) { return 2 * bytes + bytes / 4 + 1024; }

/// Returns the bytes of the piece in `out`, or 0 where they don't fit.
std::size_t deflateSmall(std::span<const std::uint8_t> piece, bool is_last, std::span<std::uint8_t> out) {
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 9, Z_FILTERED) != Z_OK)
    throw MachineError("out of memory");
  stream.next_in = const_cast<Bytef*>(piece.data());
  stream.avail_in = uInt(piece.size());
  stream.next_out = out.data();
  stream.avail_out = uInt(out.size());
  deflate(&stream, is_last ? Z_FINISH : Z_SYNC_FLUSH);
  const std::size_t size = stream.avail_out > 0 ? stream.total_out : 0;
  deflateEnd(&stream);
  return size;
}

std::size_t deflateFast(isal_zstream& stream, std::span<std::uint8_t> tables,
                        std::span<const std::uint8_t> piece, bool is_last, std::span<std::uint8_t> out) {
  isal_deflate_init(&stream);
  stream.level = kFastLevel;
  stream.level_buf = tables.data();
  stream.level_buf_size = std::uint32_t(tables.size());
  stream.flush = is_last ? NO_FLUSH : SYNC_FLUSH;
  stream.end_of_stream = is_last;
  stream.next_in = const_cast<std::uint8_t*>(piece.data());
  stream.avail_in = std::uint32_t(piece.size());
  stream.next_out = out.data();
  stream.avail_out = std::uint32_t(out.size());
  const bool done = isal_deflate(&stream) == COMP_OK && stream.avail_in == 0 && stream.avail_out > 0;
  return done ? stream.total_out : 0;
}

}  // namespace

Deflate::Deflate(bool small) : small_(small) {
  if (small_) return;
  stream_ = std::make_unique<isal_zstream>();
  tables_.resize(kFastTables);
}

void Deflate::append(std::span<const std::uint8_t> piece, bool is_last, std::vector<std::uint8_t>& out) {
  const std::size_t before = out.size();
  out.resize(before + bound(piece.size()));
  const std::span<std::uint8_t> room = std::span(out).subspan(before);
  const std::size_t size =
      small_ ? deflateSmall(piece, is_last, room) : deflateFast(*stream_, tables_, piece, is_last, room);
  if (size == 0) throw MachineError("a piece of a compressed stream is longer than any can be");
  out.resize(before + size);
}

}  // namespace luciole
