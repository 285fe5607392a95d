#include "image/drawing.hpp"

#include <algorithm>
#include <cmath>

namespace luciole {
namespace {

constexpr int kMinWidth = 480;       ///< pixels that a scale bar and its labels need
constexpr int kMinLabelWidth = 192;  ///< of a picture of a sheet, in pixels
constexpr int kMinTextSize = 14;
constexpr double kCaptionHeight = 8.6;  ///< in text sizes
constexpr double kLabelHeight = 1.7;    ///< of a sheet's lines below its pictures, in text sizes

bool continuesCharacter(char byte) { return (byte & 0xC0) == 0x80; }

/// A text as it is drawn: OpenImageIO draws characters beyond ASCII as others.
std::string drawnText(const std::string& text) {
  std::string drawn;
  for (const char c : text)
    if (!continuesCharacter(c)) drawn += c >= ' ' && c < 127 ? c : '?';
  return drawn;
}

/// Of the line below a picture of a sheet, in text sizes.
double labelWidth(const Sheet& sheet) { return double(sheet.step_x) / sheet.text_size - 1; }

}  // namespace

CaptionedSize captionedSize(int picture_width, int picture_height) {
  CaptionedSize size{};
  size.factor = picture_width >= picture_height ? std::max(1, (kMinWidth + picture_width - 1) / picture_width)
                                                : std::max(1, kMinWidth / picture_height);
  size.width = std::max(kMinWidth, picture_width * size.factor);
  size.left = (size.width - picture_width * size.factor) / 2;
  size.caption_top = picture_height * size.factor;
  size.text_size = std::max(kMinTextSize, size.width / 64);
  size.height = size.caption_top + captionHeight(size.text_size);
  return size;
}

int captionHeight(int text_size) { return int(std::lround(kCaptionHeight * text_size)); }

Sheet sheetOf(int count, int columns, int picture_width, int picture_height) {
  Sheet sheet{};
  sheet.columns = std::min(columns, count);
  sheet.rows = (count + sheet.columns - 1) / sheet.columns;
  const int across = sheet.columns * picture_width;
  sheet.factor =
      std::max({1, (kMinWidth + across - 1) / across, (kMinLabelWidth + picture_width - 1) / picture_width});
  const int width = picture_width * sheet.factor, height = picture_height * sheet.factor;
  // Of many pictures labels are small beside the sheet, not beside their picture.
  sheet.text_size = std::max(kMinTextSize, std::min(across * sheet.factor / 64, width / 20));
  sheet.step_x = width + sheet.text_size;
  sheet.step_y = height + int(std::lround(kLabelHeight * sheet.text_size));
  sheet.width = (sheet.columns - 1) * sheet.step_x + width;
  sheet.height = sheet.rows * sheet.step_y;
  return sheet;
}

Image blankPaper(int width, int height) {
  return {width, height, {"R", "G", "B"}, std::vector<float>(std::size_t(width) * height * 3, 1.0f)};
}

void pasteEnlarged(OIIO::ImageBuf& canvas, int x, int y, const OIIO::ImageBuf& picture, int factor) {
  const OIIO::ROI enlarged(0, picture.spec().width * factor, 0, picture.spec().height * factor, 0, 1, 0, 3);
  OIIO::ImageBufAlgo::paste(canvas, x, y, 0, 0, OIIO::ImageBufAlgo::resample(picture, false, enlarged));
}

int Panel::pixels(double length) const { return int(std::lround(length * text_size)); }

double Panel::width() const { return double(canvas.spec().width) / text_size; }

double Panel::textWidth(const std::string& text) const {
  const OIIO::ROI box =
      font.empty() ? OIIO::ROI() : OIIO::ImageBufAlgo::text_size(drawnText(text), text_size, font);
  return box.defined() ? double(box.width()) / text_size : 0;
}

std::string Panel::fitted(const std::string& text, double width) const {
  std::string shown = text;
  for (std::size_t kept = text.size(); kept > 1 && textWidth(shown) > width;) {
    std::size_t head = --kept / 2, tail = text.size() - (kept - head);
    while (head > 0 && continuesCharacter(text[head])) --head;
    while (tail < text.size() && continuesCharacter(text[tail])) ++tail;
    shown = text.substr(0, head) + "..." + text.substr(tail);
  }
  return shown;
}

void Panel::fill(double x, double y, double across, double down, const LinearColor& color) const {
  const int left = pixels(x), right = left + pixels(across);
  OIIO::ImageBufAlgo::fill(canvas, color, OIIO::ROI(left, right, top + pixels(y), top + pixels(y + down)));
}

void Panel::write(double x, double baseline, const std::string& text,
                  OIIO::ImageBufAlgo::TextAlignX align) const {
  if (font.empty()) return;
  OIIO::ImageBufAlgo::render_text(canvas, pixels(x), top + pixels(baseline), drawnText(text), text_size, font,
                                  kInk, align);
}

bool hasRoom(OIIO::ImageBuf& canvas, const Sheet& sheet, const std::string& text, const std::string& font) {
  return Panel{canvas, 0, sheet.text_size, font}.textWidth(text) <= labelWidth(sheet);
}

void writeLabel(OIIO::ImageBuf& canvas, const Sheet& sheet, int picture, const std::string& text,
                const std::string& font) {
  const Panel panel{canvas, sheet.top(picture) + sheet.step_y, sheet.text_size, font};
  const double width = labelWidth(sheet);
  // What is too long loses its beginning: the value is at the end.
  std::string shown = text;
  for (std::size_t cut = 1; cut < text.size() && panel.textWidth(shown) > width; ++cut)
    if (!continuesCharacter(text[cut])) shown = "..." + text.substr(cut);
  panel.write(double(sheet.left(picture)) / sheet.text_size + width / 2, -0.5, shown,
              OIIO::ImageBufAlgo::TextAlignX::Center);
}

}  // namespace luciole
