#include <fmt/format.h>
#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>
#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/output_file.hpp"
#include "base/threads.hpp"
#include "base/utf8.hpp"
#include "image/deflate.hpp"
#include "image/png_filters.hpp"
#include "image/row_file.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

bool isAscii(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
}

/// A number as PNG and zlib have it.
void putBigEndian(std::uint32_t value, std::uint8_t* out) {
  for (int i = 0; i < 4; ++i) out[i] = std::uint8_t(value >> (24 - 8 * i));
}

constexpr std::size_t kNumberBytes = 4;
constexpr std::size_t kChunkStart = 2 * kNumberBytes;  ///< its data's length and its name

/// Makes `chunk` one that is to be filled: room for its length, and its name.
void beginChunk(std::string_view name, std::vector<std::uint8_t>& chunk) {
  chunk.assign(kChunkStart, 0);
  std::copy(name.begin(), name.end(), chunk.begin() + kNumberBytes);
}

/// Fills in the length of a chunk's data, and appends the check of name and data.
void endChunk(std::vector<std::uint8_t>& chunk) {
  putBigEndian(std::uint32_t(chunk.size() - kChunkStart), chunk.data());
  const std::uint32_t check = crc32_gzip_refl(0, chunk.data() + kNumberBytes, chunk.size() - kNumberBytes);
  chunk.resize(chunk.size() + kNumberBytes);
  putBigEndian(check, chunk.data() + chunk.size() - kNumberBytes);
}

void appendNumber(std::uint32_t value, std::vector<std::uint8_t>& bytes) {
  bytes.resize(bytes.size() + kNumberBytes);
  putBigEndian(value, bytes.data() + bytes.size() - kNumberBytes);
}

/// Appends a chunk of these bytes.
void appendChunk(std::string_view name, std::span<const std::uint8_t> data, std::vector<std::uint8_t>& file) {
  std::vector<std::uint8_t> chunk;
  beginChunk(name, chunk);
  chunk.insert(chunk.end(), data.begin(), data.end());
  endChunk(chunk);
  file.insert(file.end(), chunk.begin(), chunk.end());
}

/// ASCII goes into a tEXt chunk, which every reader knows; its text is Latin-1, which agrees with UTF-8 on
/// ASCII. All else goes into iTXt, as UTF-8.
void appendText(const std::string& name, const std::string& value, std::vector<std::uint8_t>& file) {
  std::string data = name == "ImageDescription" ? "Description" : name;  // PNG's own word for it
  data += '\0';
  const bool is_ascii = isAscii(value);
  if (!is_ascii) data += std::string(4, '\0');  // not compressed, in no language, the name not translated
  data += utf8Of(value);
  appendChunk(is_ascii ? "tEXt" : "iTXt", {reinterpret_cast<const std::uint8_t*>(data.data()), data.size()},
              file);
}

/// What stands in a PNG before its pixels (PNG specification, third edition, sections 5.2 and 11).
std::vector<std::uint8_t> pngHeader(int width, int height, int channels, const Metadata& metadata, int bits) {
  constexpr std::uint8_t kRgb = 2, kRgba = 6, kAbsoluteColorimetric = 3;
  // sRGB's white, red, green and blue in xy, and its gamma, in hundred thousandths, for readers without sRGB.
  constexpr std::uint32_t kPrimaries[] = {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
  constexpr std::uint32_t kGamma = 45455;
  std::vector<std::uint8_t> file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}, data;
  appendNumber(std::uint32_t(width), data);
  appendNumber(std::uint32_t(height), data);
  // No choice of compression or filter, and not interlaced.
  data.insert(data.end(), {std::uint8_t(bits), channels == 4 ? kRgba : kRgb, 0, 0, 0});
  appendChunk("IHDR", data, file);
  data.clear();
  appendNumber(kGamma, data);
  appendChunk("gAMA", data, file);
  appendChunk("sRGB", {&kAbsoluteColorimetric, 1}, file);
  data.clear();
  for (const std::uint32_t value : kPrimaries) appendNumber(value, data);
  appendChunk("cHRM", data, file);
  for (const auto& [name, value] : metadata) appendText(name, value, file);
  return file;
}

/// Rows that are filtered and compressed together, as many as have this many bytes. Where they begin depends
/// on the picture's size alone, so that its bytes don't depend on threads nor on the pieces it comes in.
/// Strips of 1 MiB save another 0.3 % of the file.
constexpr std::size_t kStripBytes = 128 << 10;

/// The zlib stream's first bytes (RFC 1950): its window, of 32 KiB, and how thorough its writer was.
constexpr std::uint8_t kZlibWindow = 0x78, kZlibFast = 0x01, kZlibSmall = 0xda;

struct Strip {
  int first, end;  ///< rows
};

/// A strip as a chunk.
struct EncodedStrip {
  std::vector<std::uint8_t> chunk;
  std::uint32_t adler = 1;  ///< Adler-32 of what it holds, before it was compressed
  std::size_t bytes = 0;    ///< that many
};

class PngFile : public RowFile {
 public:
  /// place: a path, or a text.
  template <class Place>
  PngFile(Place& place, std::span<const std::uint8_t> header, int width, int height, int channels, int bits,
          bool small)
      : file_(place),
        height_(height),
        wide_codes_(bits == 16),
        small_(small),
        pixel_bytes_(std::size_t(channels) * bits / 8),
        row_bytes_(width * pixel_bytes_),
        strip_rows_(int(std::max<std::size_t>(kStripBytes / (row_bytes_ + 1), 1))),
        kept_(row_bytes_),
        workspaces_([this] { return Workspace(row_bytes_, small_); }) {
    append(header);
  }

  void write(const void* values, int rows) override {
    const std::uint8_t* given = static_cast<const std::uint8_t*>(values);
    const int first = kept_first_ + 1, end = kept_end_ + rows;
    const int whole = end == height_ ? end : end - end % strip_rows_;  // strips end there
    const auto rowAt = [&](int y) {
      return y < kept_end_ ? kept_.data() + std::size_t(y - kept_first_) * row_bytes_
                           : given + std::size_t(y - kept_end_) * row_bytes_;
    };
    if (whole <= first) {
      kept_.insert(kept_.end(), given, given + std::size_t(rows) * row_bytes_);
      kept_end_ = end;
      return;
    }
    writeStrips(first, whole, rowAt);
    const std::uint8_t* last = rowAt(whole - 1);
    std::vector<std::uint8_t> kept(last, last + row_bytes_);
    kept.insert(kept.end(), given + std::size_t(whole - kept_end_) * row_bytes_,
                given + std::size_t(rows) * row_bytes_);
    kept_ = std::move(kept);
    kept_first_ = whole - 1;
    kept_end_ = end;
  }

  void close() override {
    std::vector<std::uint8_t> chunk;
    beginChunk("IDAT", chunk);
    chunk.resize(chunk.size() + kNumberBytes);
    putBigEndian(adler_, chunk.data() + kChunkStart);
    endChunk(chunk);
    append(chunk);
    beginChunk("IEND", chunk);
    endChunk(chunk);
    append(chunk);
    file_.putInPlace();
  }

 private:
  static constexpr std::size_t kMargin = 8;  ///< zeros before a row: the pixel before its first one

  /// What a thread works with.
  struct Workspace {
    Workspace(std::size_t row_bytes, bool small)
        : row(kMargin + row_bytes), above(kMargin + row_bytes), spare(1 + row_bytes), deflate(small) {}
    std::vector<std::uint8_t> row, above;
    std::vector<std::uint8_t> filtered, spare;
    std::vector<std::uint8_t> chunk;
    Deflate deflate;
  };

  /// Writes strips of the rows from `first` to `end`. They are encoded side by side and written in order;
  /// only some of them are in memory.
  template <class RowAt>
  void writeStrips(int first, int end, const RowAt& rowAt) {
    int next = first;
    const auto begin = [&](tbb::flow_control& control) -> Strip {
      if (next == end) control.stop();
      const int from = std::exchange(next, std::min(next + strip_rows_, end));
      return {from, next};
    };
    const auto encode = [&](const Strip& strip) { return encodeStrip(strip, rowAt); };
    const auto finish = [&](const EncodedStrip& strip) {
      append(strip.chunk);
      adler_ = std::uint32_t(adler32_combine(adler_, strip.adler, z_off_t(strip.bytes)));
    };
    tbb::parallel_pipeline(
        2 * threadCount(),
        tbb::make_filter<void, Strip>(tbb::filter_mode::serial_in_order, begin) &
            tbb::make_filter<Strip, EncodedStrip>(tbb::filter_mode::parallel, encode) &
            tbb::make_filter<EncodedStrip, void>(tbb::filter_mode::serial_in_order, finish));
  }

  template <class RowAt>
  EncodedStrip encodeStrip(const Strip& strip, const RowAt& rowAt) {
    Workspace& work = workspaces_.local();
    const std::size_t filtered_row = 1 + row_bytes_;
    work.filtered.resize(filtered_row * std::size_t(strip.end - strip.first));
    copyRow(rowAt(strip.first - 1), work.above);
    for (int y = strip.first; y < strip.end; ++y) {
      copyRow(rowAt(y), work.row);
      filterPngRow(work.row.data() + kMargin, work.above.data() + kMargin, row_bytes_, pixel_bytes_,
                   work.filtered.data() + filtered_row * std::size_t(y - strip.first), work.spare.data());
      work.row.swap(work.above);
    }
    beginChunk("IDAT", work.chunk);
    if (strip.first == 0) work.chunk.insert(work.chunk.end(), {kZlibWindow, small_ ? kZlibSmall : kZlibFast});
    work.deflate.append(work.filtered, strip.end == height_, work.chunk);
    endChunk(work.chunk);
    return {{work.chunk.begin(), work.chunk.end()},
            isal_adler32(1, work.filtered.data(), work.filtered.size()),
            work.filtered.size()};
  }

  /// A row after its margin, with 16-bit codes as the file has them, big-endian.
  void copyRow(const std::uint8_t* from, std::vector<std::uint8_t>& row) const {
    std::uint8_t* to = row.data() + kMargin;
    if (!wide_codes_) {
      std::memcpy(to, from, row_bytes_);
      return;
    }
    for (std::size_t i = 0; i < row_bytes_; i += 2) {
      to[i] = from[i + 1];
      to[i + 1] = from[i];
    }
  }

  void append(std::span<const std::uint8_t> bytes) {
    file_.writeAt(size_, std::as_bytes(bytes));
    size_ += bytes.size();
  }

  OutputFile file_;
  std::uint64_t size_ = 0;   ///< of the file
  std::uint32_t adler_ = 1;  ///< Adler-32 of all filtered rows
  const int height_;
  const bool wide_codes_, small_;
  const std::size_t pixel_bytes_, row_bytes_;
  const int strip_rows_;
  /// Rows that aren't written yet, since they make no whole strip, after the one above them: before the
  /// picture, zeros.
  std::vector<std::uint8_t> kept_;
  int kept_first_ = -1, kept_end_ = 0;
  tbb::enumerable_thread_specific<Workspace> workspaces_;
};

}  // namespace

std::unique_ptr<RowFile> openPngFile(const std::string& path, int width, int height, int channels,
                                     const Metadata& metadata, int bits, const std::string& compression,
                                     std::string* memory) {
  if (!memory) checkWritable(path, {.format = "png"});
  if (width < 1 || height < 1)
    throw MachineError(
        fmt::format("{}: can't encode: {}x{} pixels, a PNG has 1x1 at least", path, width, height));
  const std::vector<std::uint8_t> header = pngHeader(width, height, channels, metadata, bits);
  const bool small = compression == "small";
  if (memory) return std::make_unique<PngFile>(*memory, header, width, height, channels, bits, small);
  checkSizeLimit(std::uint64_t(width) * height * channels * bits / 8, path);
  return std::make_unique<PngFile>(path, header, width, height, channels, bits, small);
}

}  // namespace luciole
