#include "image/png_input.hpp"

#include <fmt/format.h>
#include <png.h>

#include <array>
#include <cmath>
#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <vector>

#include "image/oiio.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

constexpr std::size_t kSignatureBytes = 8;

class PngInput : public OIIO::ImageInput {
 public:
  PngInput() = default;
  ~PngInput() override { PngInput::close(); }
  PngInput(const PngInput&) = delete;
  PngInput& operator=(const PngInput&) = delete;

  const char* format_name() const override { return "png"; }

  bool open(const std::string& path, OIIO::ImageSpec& spec) override {
    close();
    file_ = std::fopen(path.c_str(), "rb");
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, onError, onWarning);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    if (!file_ || !info_) {
      errorfmt("can't open it");
      return false;
    }
    const bool read = call([&] {
      png_set_read_fn(png_, this, readBytes);
      png_read_info(png_, info_);
      png_set_expand(png_);  // palettes, bits and transparent colours to R G B, bytes and alpha
      png_set_swap(png_);    // the file's 16 bits are big-endian
      passes_ = png_set_interlace_handling(png_);
      png_read_update_info(png_, info_);
    });
    if (read) spec = m_spec = readSpec();
    return read;
  }

  bool close() override {
    png_destroy_read_struct(&png_, &info_, nullptr);
    if (file_) std::fclose(file_);
    file_ = nullptr;
    next_row_ = 0;
    rows_.clear();
    return true;
  }

  /// Rows must be asked for from the top down.
  bool read_native_scanline(int, int, int y, int, void* data) override {
    const lock_guard lock(*this);
    const std::size_t bytes = m_spec.scanline_bytes();
    if (passes_ > 1) {  // interlaced: each pass adds pixels to rows all over the picture
      if (rows_.empty() && !readPasses(bytes)) return false;
      std::memcpy(data, rows_.data() + std::size_t(y) * bytes, bytes);
      return true;
    }
    if (y != next_row_) {
      errorfmt("row {} asked for, expected {}", y, next_row_);
      return false;
    }
    ++next_row_;
    return call([&] { png_read_row(png_, static_cast<png_byte*>(data), nullptr); });
  }

 private:
  OIIO::ImageSpec readSpec() const {
    const int channels = png_get_channels(png_, info_);
    const bool wide = png_get_bit_depth(png_, info_) == 16;
    OIIO::ImageSpec spec(int(png_get_image_width(png_, info_)), int(png_get_image_height(png_, info_)),
                         channels, wide ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8);
    if (channels == 2) {
      spec.channelnames = {"Y", "A"};
      spec.alpha_channel = 1;
    }
    png_textp texts = nullptr;
    const int count = png_get_text(png_, info_, &texts, nullptr);
    for (int i = 0; i < count; ++i) {
      const std::string key = texts[i].key;
      spec.attribute(key == "Description" ? "ImageDescription" : key, std::string(texts[i].text));
    }
    // After the texts, which may have any name.
    spec.attribute("oiio:ColorSpace", isLinearFile() ? "Linear" : "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    return spec;
  }

  /// Whether the file says that its gamma is 1, to a hundredth.
  bool isLinearFile() const {
    int intent = 0;
    double gamma = 0;
    if (png_get_sRGB(png_, info_, &intent) || !png_get_gAMA(png_, info_, &gamma) || gamma <= 0) return false;
    return std::round(100 / gamma) == 100;
  }

  bool readPasses(std::size_t row_bytes) {
    rows_.resize(row_bytes * m_spec.height);
    return call([&] {
      for (int pass = 0; pass < passes_; ++pass)
        for (int y = 0; y < m_spec.height; ++y)
          png_read_row(png_, rows_.data() + std::size_t(y) * row_bytes, nullptr);
    });
  }

  /// Runs `use`, which calls the library. Returns false where it met an error, which jumps back to here over
  /// no object that has a destructor.
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
    static_cast<PngInput*>(png_get_error_ptr(png))->errorfmt("{}", message);
  }
  /// libpng goes on after warnings; its own handler would print them.
  static void onWarning(png_structp, png_const_charp) {}

  static void readBytes(png_structp png, png_bytep bytes, std::size_t count) {
    std::FILE* file = static_cast<PngInput*>(png_get_io_ptr(png))->file_;
    if (std::fread(bytes, 1, count, file) != count) png_error(png, "the file ends early");
  }

  std::FILE* file_ = nullptr;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int passes_ = 1;
  int next_row_ = 0;
  std::vector<png_byte> rows_;  ///< all rows of an interlaced picture
};

bool isPng(const std::string& path) {
  std::array<png_byte, kSignatureBytes> start{};
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (!file) return false;
  const std::size_t count = std::fread(start.data(), 1, start.size(), file);
  std::fclose(file);
  return count == start.size() && png_sig_cmp(start.data(), 0, start.size()) == 0;
}

}  // namespace

std::unique_ptr<OIIO::ImageInput> openPng(const std::string& path, const std::string& name) {
  if (!isPng(path)) return nullptr;
  auto input = std::make_unique<PngInput>();
  OIIO::ImageSpec spec;
  if (!input->open(path, spec))
    throw InputError(fmt::format("{}: can't read as a picture: {}", name, oneLine(input->geterror())));
  return input;
}

}  // namespace luciole
