#pragma once

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <array>
#include <string>

#include "image/image.hpp"

// Pictures with captions below them, on white paper: what the module's maps share. Nothing outside the folder
// includes this.
namespace luciole {

using LinearColor = std::array<float, 3>;
inline constexpr LinearColor kInk{0.0f, 0.0f, 0.0f};
inline constexpr double kMargin = 2.0;  ///< left and right of what is written, in text sizes

/// Where a picture and the caption below it lie, in pixels.
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

/// A white picture with channels R G B.
Image blankPaper(int width, int height);

/// Lays a picture on the canvas, every pixel as a square of `factor` a side. Both have three channels.
void lay(OIIO::ImageBuf& canvas, int x, int y, const OIIO::ImageBuf& picture, int factor);

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
  /// In y both edges are rounded, so that neighbours meet without a gap. In x the width is rounded, so that
  /// equal widths stay equal.
  void fill(double x, double y, double across, double down, const LinearColor& color) const;
  /// Without a font labels are left out; the colours are of use without them.
  void write(double x, double baseline, const std::string& text,
             OIIO::ImageBufAlgo::TextAlignX align = OIIO::ImageBufAlgo::TextAlignX::Left) const;
};

}  // namespace luciole
