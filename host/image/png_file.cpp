#include <fmt/format.h>
#include <png.h>

#include <cstddef>
#include <exception>
#include <span>

#include "error.hpp"
#include "image/output_file.hpp"
#include "image/row_file.hpp"

namespace luciole {
namespace {

class PngFile : public RowFile {
 public:
  explicit PngFile(const std::string& path)
      : path_(path),
        file_(path),
        png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, this, onError, nullptr)),
        info_(png_create_info_struct(png_)) {
    if (!info_) throw MachineError("out of memory");
  }
  ~PngFile() override { png_destroy_write_struct(&png_, &info_); }

  void begin(int width, int height, int channels, const Metadata& metadata) {
    row_bytes_ = std::size_t(width) * channels;
    png_set_write_fn(png_, this, writeBytes, nullptr);
    png_set_IHDR(png_, info_, png_uint_32(width), png_uint_32(height), 8,
                 channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_ABSOLUTE);
    for (const auto& [name, value] : metadata) addText(name, value);
    png_write_info(png_, info_);
    throwError();
  }

  void write(const void* values, int rows) override {
    for (int y = 0; y < rows; ++y)
      png_write_row(png_, static_cast<const png_byte*>(values) + std::size_t(y) * row_bytes_);
    throwError();
  }

  void close() override {
    png_write_end(png_, info_);
    throwError();
    file_.putInPlace();
  }

 private:
  void addText(const std::string& name, const std::string& value) {
    std::string key = name == "ImageDescription" ? "Description" : name;  // PNG's own word for it
    std::string content = value;
    png_text text{};
    text.compression = PNG_TEXT_COMPRESSION_NONE;
    text.key = key.data();
    text.text = content.data();
    png_set_text(png_, info_, &text, 1);
  }

  /// The library can't go on after an error of its own: of a picture that fits its rows, lack of memory.
  [[noreturn]] static void onError(png_structp png, png_const_charp message) {
    const PngFile* self = static_cast<PngFile*>(png_get_error_ptr(png));
    throw MachineError(fmt::format("{}: can't encode: {}", self->path_, message));
  }

  /// Keeps the first error of the disk until the library, which is not to be left in the middle, returns.
  static void writeBytes(png_structp png, png_bytep bytes, std::size_t count) {
    PngFile* self = static_cast<PngFile*>(png_get_io_ptr(png));
    if (self->error_) return;
    try {
      self->file_.writeAt(self->size_, std::as_bytes(std::span(bytes, count)));
      self->size_ += count;
    } catch (const MachineError&) {
      self->error_ = std::current_exception();
    }
  }

  void throwError() const {
    if (error_) std::rethrow_exception(error_);
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
                                     const Metadata& metadata) {
  checkWritable(path);
  checkSizeLimit(std::uint64_t(width) * height * channels, path);
  auto file = std::make_unique<PngFile>(path);
  file->begin(width, height, channels, metadata);
  return file;
}

}  // namespace luciole
