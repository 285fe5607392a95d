#include "image/drawing.hpp"

#include <algorithm>
#include <cmath>

namespace luciole {
namespace {

constexpr int kMinWidth = 480;  ///< pixels that a scale bar and its labels need
constexpr int kMinTextSize = 14;
constexpr double kCaptionHeight = 8.6;  ///< in text sizes

}  // namespace

CaptionedSize captionedSize(int picture_width, int picture_height) {
  CaptionedSize size{};
  size.factor = picture_width >= picture_height ? std::max(1, (kMinWidth + picture_width - 1) / picture_width)
                                                : std::max(1, kMinWidth / picture_height);
  size.width = std::max(kMinWidth, picture_width * size.factor);
  size.left = (size.width - picture_width * size.factor) / 2;
  size.caption_top = picture_height * size.factor;
  size.text_size = std::max(kMinTextSize, size.width / 64);
  size.height = size.caption_top + int(std::lround(kCaptionHeight * size.text_size));
  return size;
}

Image blankPaper(int width, int height) {
  return {width, height, {"R", "G", "B"}, std::vector<float>(std::size_t(width) * height * 3, 1.0f)};
}

void lay(OIIO::ImageBuf& canvas, int x, int y, const OIIO::ImageBuf& picture, int factor) {
  const OIIO::ROI enlarged(0, picture.spec().width * factor, 0, picture.spec().height * factor, 0, 1, 0, 3);
  OIIO::ImageBufAlgo::paste(canvas, x, y, 0, 0, OIIO::ImageBufAlgo::resample(picture, false, enlarged));
}

int Panel::pixels(double length) const { return int(std::lround(length * text_size)); }

double Panel::width() const { return double(canvas.spec().width) / text_size; }

double Panel::textWidth(const std::string& text) const {
  const OIIO::ROI box = font.empty() ? OIIO::ROI() : OIIO::ImageBufAlgo::text_size(text, text_size, font);
  return box.defined() ? double(box.width()) / text_size : 0;
}

void Panel::fill(double x, double y, double across, double down, const LinearColor& color) const {
  const int left = pixels(x), right = left + pixels(across);
  OIIO::ImageBufAlgo::fill(canvas, color, OIIO::ROI(left, right, top + pixels(y), top + pixels(y + down)));
}

void Panel::write(double x, double baseline, const std::string& text,
                  OIIO::ImageBufAlgo::TextAlignX align) const {
  if (font.empty()) return;
  OIIO::ImageBufAlgo::render_text(canvas, pixels(x), top + pixels(baseline), text, text_size, font, kInk,
                                  align);
}

}  // namespace luciole
