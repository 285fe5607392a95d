// PNGs as they are written, held against libpng, zlib and the specification (ISO 15948).
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <png.h>
#include <tbb/global_control.h>
#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <numeric>

#include "image/row_file.hpp"
#include "png_chunk.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

/// A picture of codes, 8-bit ones or 16-bit ones of this machine.
struct Codes {
  int width, height, channels, bits;
  std::string bytes;
  std::size_t pixelBytes() const { return std::size_t(channels) * bits / 8; }
  std::size_t rowBytes() const { return width * pixelBytes(); }
};

/// Stripes of what each of PNG's filters is made for: noise, ramps along rows and down columns, both, and
/// flat colour with grain.
Codes someCodes(int width, int height, int channels, int bits) {
  Codes codes{width, height, channels, bits, {}};
  std::uint32_t state = 1;
  for (int y = 0; y < height; ++y)
    for (std::size_t i = 0; i < codes.rowBytes(); ++i) {
      state = state * 1664525u + 1013904223u;
      const auto noise = int(state >> 24), ramp = int(i / 7), rise = y * 3;
      const std::array<int, 5> kinds{noise, ramp, rise, ramp + rise, 100 + noise % 3};
      codes.bytes += char(kinds[y / 8 % 5]);
    }
  return codes;
}

/// Writes it, some rows at a time, and returns the file's bytes.
std::string written(const Codes& codes, const std::string& compression, int rows_at_a_time) {
  const TemporaryFolder folder;
  const auto file =
      openPngFile(folder / "a.png", codes.width, codes.height, codes.channels,
                  {{"Software", "Luciole"}, {"luciole:place", "Nîmes"}}, codes.bits, compression);
  for (int y = 0; y < codes.height; y += rows_at_a_time)
    file->write(codes.bytes.data() + std::size_t(y) * codes.rowBytes(),
                std::min(rows_at_a_time, codes.height - y));
  file->close();
  return readText(folder / "a.png");
}

/// The codes that libpng reads. Whatever it warns of is a failure, as is a check that doesn't fit.
std::string readStrictly(const std::string& file, int bits) {
  struct Source {
    const std::string& bytes;
    std::size_t at = 0;
  } source{file};
  const auto fail = [](png_structp png, png_const_charp message) {
    ADD_FAILURE() << message;
    png_longjmp(png, 1);
  };
  const auto warn = [](png_structp, png_const_charp message) { ADD_FAILURE() << message; };
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, warn);
  png_infop info = png_create_info_struct(png);
  std::string codes;
  if (setjmp(png_jmpbuf(png)) == 0) {
    png_set_read_fn(png, &source, [](png_structp of, png_bytep to, std::size_t count) {
      Source& from = *static_cast<Source*>(png_get_io_ptr(of));
      if (count > from.bytes.size() - from.at) png_error(of, "the file ends early");
      from.bytes.copy(reinterpret_cast<char*>(to), count, from.at);
      from.at += count;
    });
    png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_read_info(png, info);
    if (bits == 16) png_set_swap(png);
    png_read_update_info(png, info);
    const std::size_t row = png_get_rowbytes(png, info);
    codes.resize(row * png_get_image_height(png, info));
    for (std::size_t at = 0; at < codes.size(); at += row)
      png_read_row(png, reinterpret_cast<png_bytep>(codes.data() + at), nullptr);
    png_read_end(png, nullptr);
    EXPECT_EQ(source.at, file.size());
  }
  png_destroy_read_struct(&png, &info, nullptr);
  return codes;
}

/// The filtered rows: what the IDAT chunks, which are neighbours, hold as one zlib stream that ends with
/// them.
std::string filteredRows(const std::string& file, std::size_t size) {
  std::string stream, order;
  for (std::size_t at = 8; at < file.size();) {
    std::uint32_t length = 0;
    for (int i = 0; i < 4; ++i) length = length << 8 | std::uint8_t(file[at + i]);
    const std::string type = file.substr(at + 4, 4), data = file.substr(at + 8, length);
    EXPECT_EQ(file.substr(at, 12 + length), pngChunk(type, data)) << type;
    if (type == "IDAT") stream += data;
    if (!order.ends_with(type)) order += type;
    at += 12 + length;
  }
  EXPECT_TRUE(order.starts_with("IHDR")) << order;
  EXPECT_TRUE(order.ends_with("IDATIEND")) << order;
  EXPECT_EQ(order.find("IDAT"), order.size() - 8) << order;

  std::string rows(size + 1, '\0');
  z_stream inflater{};
  inflateInit(&inflater);
  inflater.next_in = reinterpret_cast<Bytef*>(stream.data());
  inflater.avail_in = uInt(stream.size());
  inflater.next_out = reinterpret_cast<Bytef*>(rows.data());
  inflater.avail_out = uInt(rows.size());
  EXPECT_EQ(inflate(&inflater, Z_FINISH), Z_STREAM_END) << (inflater.msg ? inflater.msg : "");
  EXPECT_EQ(inflater.total_out, size);
  EXPECT_EQ(inflater.avail_in, 0u);
  inflateEnd(&inflater);
  rows.resize(size);
  return rows;
}

/// A row of the file's bytes by a filter, from the specification's words (9.2), and its magnitude.
std::pair<std::string, int> filtered(const std::string& row, const std::string& above, std::size_t pixel,
                                     int filter) {
  std::string out(1, char(filter));
  int sum = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const int a = i < pixel ? 0 : std::uint8_t(row[i - pixel]), b = std::uint8_t(above[i]);
    const int c = i < pixel ? 0 : std::uint8_t(above[i - pixel]), p = a + b - c;
    const int pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
    const int paeth = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
    const std::array<int, 5> expected{0, a, b, (a + b) / 2, paeth};
    out += char(row[i] - expected[filter]);
    sum += std::abs(int(std::int8_t(out.back())));
  }
  return {out, sum};
}

/// Small ones, ones that no strip fits, and ones of several strips.
const std::vector<std::pair<int, int>> kSizes{{1, 1}, {7, 93}, {144, 17}, {1, 3000}, {32768, 3}, {640, 300}};

TEST(PngFile, ReadersFindItsCodesAndNothingToWarnOf) {
  const TemporaryFolder folder;
  for (const char* compression : {"", "small"})
    for (const int bits : {8, 16})
      for (const int channels : {3, 4})
        for (const auto& [width, height] : kSizes) {
          SCOPED_TRACE(testing::Message() << width << " x " << height << " x " << channels << ", " << bits
                                          << " bits, " << compression);
          const Codes codes = someCodes(width, height, channels, bits);
          const std::string file = written(codes, compression, height);
          EXPECT_TRUE(readStrictly(file, bits) == codes.bytes);
          std::ofstream(folder / "a.png", std::ios::binary) << file;
          OIIO::ImageSpec as_stored;
          as_stored.attribute("oiio:UnassociatedAlpha", 1);
          const auto input = OIIO::ImageInput::open(folder / "a.png", &as_stored);
          ASSERT_TRUE(input) << OIIO::geterror();
          std::string read(codes.bytes.size(), '\0');
          EXPECT_TRUE(input->read_image(
              0, 0, 0, channels, bits == 16 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8, read.data()))
              << input->geterror();
          EXPECT_TRUE(read == codes.bytes);
        }
}

TEST(PngFile, IsOneStreamOfRowsByTheFilterOfLeastMagnitude) {
  std::array<int, 5> uses{};
  for (const int bits : {8, 16})
    for (const int channels : {3, 4})
      for (const auto& [width, height] : kSizes) {
        SCOPED_TRACE(testing::Message() << width << " x " << height << " x " << channels << ", " << bits);
        const Codes codes = someCodes(width, height, channels, bits);
        const std::size_t bytes = codes.rowBytes();
        const std::string rows = filteredRows(written(codes, "", height), height * (1 + bytes));
        std::string above(bytes, '\0');
        for (int y = 0; y < height; ++y) {
          std::string row = codes.bytes.substr(y * bytes, bytes);
          for (std::size_t i = 0; bits == 16 && i < bytes; i += 2) std::swap(row[i], row[i + 1]);
          const std::string found = rows.substr(y * (1 + bytes), 1 + bytes);
          ASSERT_LT(std::uint8_t(found[0]), 5);
          ++uses[found[0]];
          const auto [expected, sum] = filtered(row, above, codes.pixelBytes(), found[0]);
          ASSERT_TRUE(found == expected) << "row " << y;
          for (int filter = 0; filter < 5; ++filter)
            ASSERT_LE(sum, filtered(row, above, codes.pixelBytes(), filter).second) << "row " << y;
          above = row;
        }
      }
  for (const int use : uses) EXPECT_GT(use, 0);
}

TEST(PngFile, ItsBytesDependNeitherOnThreadsNorOnPieces) {
  const Codes codes = someCodes(300, 600, 3, 8);  // strips of 145 rows
  for (const char* compression : {"fast", "small"}) {
    const std::string whole = written(codes, compression, codes.height);
    for (const int rows : {1, 17, 145, 146, 599})
      EXPECT_TRUE(written(codes, compression, rows) == whole) << rows << " rows at a time";
    for (const std::size_t threads : {1, 2, 5}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      EXPECT_TRUE(written(codes, compression, 100) == whole) << threads << " threads";
    }
  }
}

TEST(PngFile, SmallIsSmaller) {
  const Codes codes = someCodes(640, 300, 3, 8);
  EXPECT_LT(written(codes, "small", 300).size(), written(codes, "fast", 300).size());
  EXPECT_EQ(written(codes, "", 300), written(codes, "fast", 300));
}

}  // namespace
}  // namespace luciole::test
