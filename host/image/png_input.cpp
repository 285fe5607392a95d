#include "image/png_input.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "image/oiio.hpp"
#include "image/png_rows.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

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
    if (!file_) {
      errorfmt("can't open it");
      return false;
    }
    png_ = std::make_unique<PngRows>(
        [this](png_bytep bytes, std::size_t count) { return std::fread(bytes, 1, count, file_) == count; });
    const bool read = checked(png_->readHeader() && png_->begin());
    if (read) spec = m_spec = readSpec();
    return read;
  }

  bool close() override {
    png_.reset();
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
    if (png_->passes() > 1) {  // interlaced: each pass adds pixels to rows all over the picture
      if (rows_.empty() && !readPasses(bytes)) return false;
      std::memcpy(data, rows_.data() + std::size_t(y) * bytes, bytes);
      return true;
    }
    if (y != next_row_) {
      errorfmt("row {} asked for, expected {}", y, next_row_);
      return false;
    }
    ++next_row_;
    return checked(png_->next(static_cast<png_bytep>(data)));
  }

 private:
  /// Passes libpng's error on to OpenImageIO if `read` is false. Returns `read`.
  bool checked(bool read) {
    if (!read) errorfmt("{}", png_->error());
    return read;
  }

  OIIO::ImageSpec readSpec() const {
    png_structp png = png_->png();
    png_infop info = png_->info();
    const bool wide = png_get_bit_depth(png, info) == 16;
    OIIO::ImageSpec spec(int(png_->width()), int(png_->height()), png_->channels(),
                         wide ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8);
    if (spec.nchannels == 2) {
      spec.channelnames = {"Y", "A"};
      spec.alpha_channel = 1;
    }
    png_textp texts = nullptr;
    const int count = png_get_text(png, info, &texts, nullptr);
    for (int i = 0; i < count; ++i) {
      const std::string key = texts[i].key;
      spec.attribute(key == "Description" ? "ImageDescription" : key, std::string(texts[i].text));
    }
    // After the texts, which may have any name. A file is linear that says that its gamma is 1, to a
    // hundredth.
    double gamma = 0;
    const bool tells_gamma =
        !png_get_valid(png, info, PNG_INFO_sRGB) && png_get_gAMA(png, info, &gamma) && gamma > 0;
    spec.attribute("oiio:ColorSpace", tells_gamma && std::round(100 / gamma) == 100 ? "Linear" : "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    return spec;
  }

  bool readPasses(std::size_t row_bytes) {
    rows_.resize(row_bytes * m_spec.height);
    for (int pass = 0; pass < png_->passes(); ++pass)
      for (int y = 0; y < m_spec.height; ++y)
        if (!checked(png_->next(rows_.data() + std::size_t(y) * row_bytes))) return false;
    return true;
  }

  std::FILE* file_ = nullptr;
  std::unique_ptr<PngRows> png_;
  int next_row_ = 0;
  std::vector<png_byte> rows_;  ///< all rows of an interlaced picture
};

bool isPng(const std::string& path) {
  std::array<std::byte, 8> start{};
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (!file) return false;
  const std::size_t count = std::fread(start.data(), 1, start.size(), file);
  std::fclose(file);
  return PngRows::isOne({start.data(), count});
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
