#pragma once

#include <png.h>

#include <csetjmp>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>

namespace luciole {

/// A PNG read by libpng, whose messages are stored instead of printed. Functions return false on failure;
/// then only error() may be called.
class PngRows {
 public:
  /// read: copies so many bytes of the file, and returns whether there were as many.
  explicit PngRows(std::function<bool(png_bytep, std::size_t)> read)
      : read_(std::move(read)),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, onError,
                                    [](png_structp, png_const_charp) {})),
        info_(png_ ? png_create_info_struct(png_) : nullptr) {}
  ~PngRows() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngRows(const PngRows&) = delete;
  PngRows& operator=(const PngRows&) = delete;

  static bool isOne(std::span<const std::byte> file) {
    constexpr std::size_t kSignatureBytes = 8;
    return file.size() >= kSignatureBytes &&
           png_sig_cmp(reinterpret_cast<png_const_bytep>(file.data()), 0, kSignatureBytes) == 0;
  }

  /// Reads up to the pixels. What png() and info() say then is the file's.
  bool readHeader() {
    return info_ && call([&] {
             png_set_read_fn(png_, this, readBytes);
             png_read_info(png_, info_);
           });
  }

  /// To be called before the first row. What png() and info() say then is the rows': palettes, bits and
  /// transparent colours become bytes and alpha, 16 bits are in the machine's order.
  bool begin() {
    return call([&] {
      png_set_expand(png_);
      png_set_swap(png_);  // the file's 16 bits are big-endian
      passes_ = png_set_interlace_handling(png_);
      png_read_update_info(png_, info_);
    });
  }

  std::size_t width() const { return png_get_image_width(png_, info_); }
  std::size_t height() const { return png_get_image_height(png_, info_); }
  int channels() const { return png_get_channels(png_, info_); }
  /// How often all rows are to be read: each pass adds pixels to them.
  int passes() const { return passes_; }

  bool next(png_bytep row) {
    return call([&] { png_read_row(png_, row, nullptr); });
  }

  /// Reads what comes after the pixels.
  bool end() {
    return call([&] { png_read_end(png_, nullptr); });
  }

  png_structp png() const { return png_; }
  png_infop info() const { return info_; }
  const std::string& error() const { return error_; }

 private:
  /// Runs `use`, which calls the library. An error jumps back to here, over no object that has a destructor.
  template <class Use>
  bool call(const Use& use) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    use();
    return true;
  }

  [[noreturn]] static void onError(png_structp png, png_const_charp message) {
    keepError(png, message);
    png_longjmp(png, 1);
  }
  static void keepError(png_structp png, png_const_charp message) {
    static_cast<PngRows*>(png_get_error_ptr(png))->error_ = message;
  }

  static void readBytes(png_structp png, png_bytep bytes, std::size_t count) {
    if (!static_cast<PngRows*>(png_get_io_ptr(png))->read_(bytes, count))
      png_error(png, "the file ends early");
  }

  std::function<bool(png_bytep, std::size_t)> read_;
  std::string error_ = "can't open it";
  png_structp png_;
  png_infop info_;
  int passes_ = 1;
};

}  // namespace luciole
