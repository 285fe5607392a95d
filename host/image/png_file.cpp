#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "base/error.hpp"
#include "base/output_file.hpp"
#include "image/row_file.hpp"

namespace luciole {
namespace {

bool isUtf8(const std::string& text) {
  try {
    nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

bool isAscii(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
}

class PngFile : public RowFile {
 public:
  explicit PngFile(const std::string& path)
      : path_(path),
        file_(path),
        png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, this, onError, onWarning)),
        info_(png_ ? png_create_info_struct(png_) : nullptr) {
    if (!info_) throw MachineError("out of memory");
  }
  ~PngFile() override { png_destroy_write_struct(&png_, &info_); }

  void begin(int width, int height, int channels, const Metadata& metadata, int bits) {
    row_bytes_ = std::size_t(width) * channels * bits / 8;
    call([&] {
      png_set_write_fn(png_, this, writeBytes, nullptr);
      png_set_IHDR(png_, info_, png_uint_32(width), png_uint_32(height), bits,
                   channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                   PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
      png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_ABSOLUTE);
    });
    for (const auto& [name, value] : metadata) addText(name, value);
    call([&] {
      png_write_info(png_, info_);
      if (bits == 16) png_set_swap(png_);  // the file's codes are big-endian
    });
  }

  void write(const void* values, int rows) override {
    call([&] {
      for (int y = 0; y < rows; ++y)
        png_write_row(png_, static_cast<const png_byte*>(values) + std::size_t(y) * row_bytes_);
    });
  }

  void close() override {
    call([&] { png_write_end(png_, info_); });
    file_.putInPlace();
  }

 private:
  /// ASCII goes into a tEXt chunk, which every reader knows; its text is Latin-1, which agrees with UTF-8 on
  /// ASCII. Other UTF-8 goes into iTXt. Bytes that are no UTF-8 go into tEXt unchanged.
  void addText(const std::string& name, const std::string& value) {
    std::string key = name == "ImageDescription" ? "Description" : name;  // PNG's own word for it
    std::string content = value;
    png_text text{};
    text.compression =
        !isAscii(value) && isUtf8(value) ? PNG_ITXT_COMPRESSION_NONE : PNG_TEXT_COMPRESSION_NONE;
    text.key = key.data();
    text.text = content.data();
    call([&] { png_set_text(png_, info_, &text, 1); });
  }

  /// Runs `use`, which calls the library, and throws the error that it met. No exception passes through the
  /// library, which is C. The library's own errors jump back to here, over no object that has a destructor.
  template <class Use>
  void call(const Use& use) {
    if (setjmp(png_jmpbuf(png_)) == 0) use();
    if (error_) std::rethrow_exception(error_);
  }

  /// libpng can't go on after its own errors. With rows that fit the header the only one is lack of memory.
  [[noreturn]] static void onError(png_structp png, png_const_charp message) {
    keepError(png, message);
    png_longjmp(png, 1);
  }

  static void keepError(png_structp png, png_const_charp message) {
    PngFile* self = static_cast<PngFile*>(png_get_error_ptr(png));
    if (self->error_) return;
    self->error_ =
        std::make_exception_ptr(MachineError(fmt::format("{}: can't encode: {}", self->path_, message)));
  }

  /// libpng's own handler would print the warning.
  static void onWarning(png_structp, png_const_charp) {}

  /// Keeps the first write error until libpng, which must not be left by an exception, has returned.
  static void writeBytes(png_structp png, png_bytep bytes, std::size_t count) {
    PngFile* self = static_cast<PngFile*>(png_get_io_ptr(png));
    if (self->error_) return;
    try {
      self->file_.writeAt(self->size_, std::as_bytes(std::span(bytes, count)));
      self->size_ += count;
    } catch (...) {
      self->error_ = std::current_exception();
    }
  }

  std::string path_;
  OutputFile file_;
  std::uint64_t size_ = 0;
  std::exception_ptr error_;
  png_structp png_;
  png_infop info_;
  std::size_t row_bytes_ = 0;
};

}  // namespace

std::unique_ptr<RowFile> openPngFile(const std::string& path, int width, int height, int channels,
                                     const Metadata& metadata, int bits) {
  checkWritable(path, {.format = "png"});
  checkSizeLimit(std::uint64_t(width) * height * channels * bits / 8, path);
  auto file = std::make_unique<PngFile>(path);
  file->begin(width, height, channels, metadata, bits);
  return file;
}

}  // namespace luciole
