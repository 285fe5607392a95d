#pragma once

#include <cstdint>
#include <string>

namespace luciole::test {

/// Appends a number as PNG and zlib have it, big-endian.
inline void append(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += char(value >> shift);
}

/// A chunk of a PNG file, with its CRC (ISO 15948).
inline std::string pngChunk(const std::string& type, const std::string& data) {
  std::uint32_t crc = 0xffffffff;
  for (const char c : type + data) {
    crc ^= std::uint8_t(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
  }
  std::string chunk;
  append(chunk, std::uint32_t(data.size()));
  chunk += type + data;
  append(chunk, ~crc);
  return chunk;
}

/// Bytes, fewer than 65,536, as a zlib stream that leaves them as they are (RFC 1950 and 1951).
inline std::string stored(const std::string& bytes) {
  std::uint32_t low = 1, high = 0;
  for (const char c : bytes) {
    low = (low + std::uint8_t(c)) % 65521;
    high = (high + low) % 65521;
  }
  const auto size = std::uint16_t(bytes.size());
  std::string stream{'\x78', '\x01', '\x01', char(size), char(size >> 8), char(~size), char(~size >> 8)};
  stream += bytes;
  append(stream, high << 16 | low);
  return stream;
}

/// A whole file: `rows` as filtered bytes, each row after its filter's number; `between` are chunks that come
/// before the pixels.
inline std::string pngFile(std::uint32_t width, std::uint32_t height, int bits, int color_type,
                           bool interlaced, const std::string& between, const std::string& rows) {
  std::string header;
  append(header, width);
  append(header, height);
  header += {char(bits), char(color_type), 0, 0, char(interlaced)};
  return "\x89PNG\r\n\x1a\n" + pngChunk("IHDR", header) + between + pngChunk("IDAT", stored(rows)) +
         pngChunk("IEND", "");
}

}  // namespace luciole::test
