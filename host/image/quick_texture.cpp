#include "image/quick_texture.hpp"

// clang-format off
#include <cstdio>  // jpeglib.h needs its FILE
#include <jpeglib.h>
// clang-format on

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "base/machine_memory.hpp"
#include "base/picture_size.hpp"
#include "image/build_mips.hpp"
#include "image/png_pixels.hpp"
#include "image/spread_texels.hpp"

namespace luciole {
namespace {

/// Whether a file of `file_bytes` bytes, compressed to 1 / most_compression at best, can hold a picture of
/// this size. A header that claims more is damaged.
bool canHold(std::size_t file_bytes, std::uint64_t width, std::uint64_t height, std::uint64_t row_bytes,
             std::uint64_t most_compression) {
  return width <= kLargestSide && height <= kLargestSide &&
         row_bytes * height / most_compression <= file_bytes;
}

/// Whether a PNG is of at most 8 bits, not interlaced, and not said to be linear, where that counts.
bool isPlain(const PngRows& rows, std::size_t file_bytes, bool knows_space) {
  constexpr std::uint64_t kMostCompression = 1040;  // deflate reaches 1 : 1032
  png_structp png = rows.png();
  png_infop info = rows.info();
  double gamma = 0;
  const bool may_be_linear = knows_space && png_get_gAMA(png, info, &gamma) && gamma > 0.98 && gamma < 1.02;
  return png_get_bit_depth(png, info) <= 8 && png_get_interlace_type(png, info) == PNG_INTERLACE_NONE &&
         !may_be_linear &&
         canHold(file_bytes, rows.width(), rows.height(), png_get_rowbytes(png, info), kMostCompression);
}

/// Gives the rows of a JPEG file in memory, from the top down. An error of the library jumps back into
/// call(), over no object that has a destructor.
class JpegRows {
 public:
  explicit JpegRows(std::span<const std::byte> file) : file_(file) {
    jpeg_.err = jpeg_std_error(&errors_);
    errors_.error_exit = onError;
    errors_.output_message = [](j_common_ptr) {};
    jpeg_.client_data = this;
    is_made_ = call([&] { jpeg_create_decompress(&jpeg_); });
  }
  ~JpegRows() { jpeg_destroy_decompress(&jpeg_); }
  JpegRows(const JpegRows&) = delete;
  JpegRows& operator=(const JpegRows&) = delete;

  static bool isOne(std::span<const std::byte> file) {
    constexpr std::array<std::byte, 3> kSignature{std::byte{0xff}, std::byte{0xd8}, std::byte{0xff}};
    return file.size() >= kSignature.size() && std::equal(kSignature.begin(), kSignature.end(), file.begin());
  }

  /// Reads up to the first row; false where this isn't a file for here.
  bool begin() {
    bool is_plain = false;
    const bool read =
        is_made_ && call([&] {
          // Some versions of libjpeg take no pointer to const; none writes there.
          jpeg_mem_src(&jpeg_,
                       const_cast<unsigned char*>(reinterpret_cast<const unsigned char*>(file_.data())),
                       static_cast<unsigned long>(file_.size()));
          jpeg_read_header(&jpeg_, TRUE);
          is_plain = isPlain();
          if (is_plain) jpeg_start_decompress(&jpeg_);
        });
    return read && is_plain;
  }

  std::size_t width() const { return jpeg_.output_width; }
  std::size_t height() const { return jpeg_.output_height; }
  int channels() const { return jpeg_.output_components; }

  /// The next row's codes, valid until the next call; null where the file is damaged.
  const std::uint8_t* next() {
    row_.resize(width() * std::size_t(channels()));
    std::uint8_t* row = row_.data();
    unsigned read = 0;
    return call([&] { read = jpeg_read_scanlines(&jpeg_, &row, 1); }) && read == 1 ? row : nullptr;
  }

  /// Whether all was read without a warning, which is what libjpeg has to say of truncated files.
  bool end() {
    return call([&] { jpeg_finish_decompress(&jpeg_); }) && errors_.num_warnings == 0;
  }

 private:
  /// Grey or of three colours.
  bool isPlain() const {
    constexpr std::uint64_t kMostCompression = 65536;
    return ((jpeg_.num_components == 1 && jpeg_.out_color_space == JCS_GRAYSCALE) ||
            (jpeg_.num_components == 3 && jpeg_.out_color_space == JCS_RGB)) &&
           canHold(file_.size(), jpeg_.image_width, jpeg_.image_height,
                   std::uint64_t(jpeg_.image_width) * std::uint64_t(jpeg_.num_components), kMostCompression);
  }

  template <class Use>
  bool call(const Use& use) {
    if (setjmp(on_error_) != 0) return false;
    use();
    return true;
  }

  [[noreturn]] static void onError(j_common_ptr jpeg) {
    std::longjmp(static_cast<JpegRows*>(jpeg->client_data)->on_error_, 1);
  }

  jpeg_decompress_struct jpeg_{};
  jpeg_error_mgr errors_{};
  std::jmp_buf on_error_;
  std::span<const std::byte> file_;
  std::vector<std::uint8_t> row_;
  bool is_made_ = false;
};

template <class Rows>
std::optional<MipLevel> readLevel(Rows& rows, const std::string& name) {
  const std::size_t pixels = rows.width() * rows.height();
  // The texels, and a third more for the mip chain.
  requireMemory(double(pixels * 4 * sizeof(std::uint16_t)) * 4 / 3, name);
  MipLevel level{int(rows.width()), int(rows.height()), Texels(pixels * 4)};
  for (std::size_t y = 0; y < rows.height(); ++y) {
    const std::uint8_t* codes = rows.next();
    if (!codes) return std::nullopt;
    spreadTexels(codes, rows.width(), rows.channels(), &level.texels[y * rows.width() * 4]);
  }
  if (!rows.end()) return std::nullopt;
  return level;
}

std::optional<MipLevel> readPng(std::span<const std::byte> file, const std::string& name, bool knows_space) {
  std::span<const std::byte> rest = file;
  PngRows header([&rest](png_bytep bytes, std::size_t count) {
    if (count > rest.size()) return false;
    std::memcpy(bytes, rest.data(), count);
    rest = rest.subspan(count);
    return true;
  });
  if (!header.readHeader() || !isPlain(header, file.size(), knows_space)) return std::nullopt;
  constexpr std::size_t kChunkHeader = 8;  // of the first IDAT chunk, which libpng has read
  PngPixels pixels(header, file.last(rest.size() + kChunkHeader));
  return readLevel(pixels, name);
}

std::optional<MipLevel> readJpeg(std::span<const std::byte> file, const std::string& name) {
  JpegRows rows(file);
  if (!rows.begin()) return std::nullopt;
  return readLevel(rows, name);
}

}  // namespace

std::optional<Texture> readQuickly(std::span<const std::byte> file, const std::string& name,
                                   bool knows_space) {
  std::optional<MipLevel> level;
  if (PngRows::isOne(file)) level = readPng(file, name, knows_space);
  if (JpegRows::isOne(file)) level = readJpeg(file, name);
  if (!level) return std::nullopt;
  Texture texture{name, {}};
  texture.levels.push_back(std::move(*level));
  buildMips(texture);
  return texture;
}

std::optional<Texture> readQuickly(const std::string& path) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) return std::nullopt;
  const std::uintmax_t size = std::filesystem::file_size(path, failed);
  const auto close = [](std::FILE* file) { std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> file(failed ? nullptr : std::fopen(path.c_str(), "rb"),
                                                         close);
  if (!file) return std::nullopt;
  requireMemory(double(size), path);
  const std::unique_ptr<std::byte[]> bytes(new std::byte[size]);
  if (std::fread(bytes.get(), 1, size, file.get()) != size) return std::nullopt;
  return readQuickly(std::span<const std::byte>(bytes.get(), size), path, true);
}

}  // namespace luciole
