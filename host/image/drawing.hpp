#pragma once

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <array>
#include <string>

#include "luciole/image.hpp"

// Pictures with captions below them, on white paper: what the module's maps share. Nothing outside the folder
// includes this.
namespace luciole {

using LinearColor = std::array<float, 3>;
inline constexpr LinearColor kInk{0.0f, 0.0f, 0.0f};
inline constexpr double kMargin = 2.0;  ///< left and right of texts, in text sizes

/// The layout of a picture and the caption below it, in pixels.
struct CaptionedSize {
  int width, height;  ///< of both together
  int factor;         ///< every pixel of the picture is a square of so many a side
  int left;           ///< of the picture; its top is 0
  int caption_top;    ///< the picture's bottom
  int text_size;
};

/// Small pictures are enlarged by a whole factor. A wide one fills the width exactly, so that maps and
/// pictures can be overlaid. A tall one is in the middle of 480 pixels, and becomes at most as high, or keeps
/// its height if that is more.
CaptionedSize captionedSize(int picture_width, int picture_height);

/// The height in pixels of a scale bar with what is written around it.
int captionHeight(int text_size);

/// Pictures of one size in rows, with a line of text below each.
struct Sheet {
  int columns, rows;
  int factor;          ///< every pixel of a picture is a square of so many a side
  int text_size;       ///< the gap between pictures, too
  int step_x, step_y;  ///< from a picture to the next, in pixels
  int width, height;   ///< of all together
  int left(int i) const { return i % columns * step_x; }
  int top(int i) const { return i / columns * step_y; }
};

/// The sheet of `count` pictures, enlarged by a whole factor where it would be less than 480 pixels wide.
Sheet sheetOf(int count, int columns, int picture_width, int picture_height);

/// A white picture with channels R G B.
Image blankPaper(int width, int height);

/// Puts a picture on the canvas, every pixel as a square of `factor` a side. Both have three channels.
void pasteEnlarged(OIIO::ImageBuf& canvas, int x, int y, const OIIO::ImageBuf& picture, int factor);

/// The paper under a picture, and lengths on it: x from the left and y from the picture's bottom, both in
/// text sizes.
struct Panel {
  OIIO::ImageBuf& canvas;
  int top;
  int text_size;
  std::string font;  ///< a file; "": nothing is written

  int pixels(double length) const;
  double width() const;
  double textWidth(const std::string& text) const;
  /// UTF-8 text on one line and no wider than `width` text sizes: what is left out of the middle becomes
  /// "...".
  std::string fitted(const std::string& text, double width) const;
  /// In y both edges are rounded, so that neighbours meet without a gap. In x the width is rounded, so that
  /// equal widths stay equal.
  void fill(double x, double y, double across, double down, const LinearColor& color) const;
  /// Without a font labels are left out; the colours are of use without them. Characters beyond ASCII
  /// become '?'.
  void write(double x, double baseline, const std::string& text,
             OIIO::ImageBufAlgo::TextAlignX align = OIIO::ImageBufAlgo::TextAlignX::Left) const;
};

/// Whether the line below a sheet's picture holds the text.
bool hasRoom(OIIO::ImageBuf& canvas, const Sheet& sheet, const std::string& text, const std::string& font);

/// Writes the line below a sheet's picture, in its middle.
void writeLabel(OIIO::ImageBuf& canvas, const Sheet& sheet, int picture, const std::string& text,
                const std::string& font);

}  // namespace luciole
