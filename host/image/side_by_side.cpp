#include "image/side_by_side.hpp"

#include <OpenImageIO/imagebuf.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "base/machine_memory.hpp"
#include "base/picture_size.hpp"
#include "image/drawing.hpp"
#include "image/heat_map.hpp"
#include "image/label_font.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

/// Where a picture's red, green and blue lie in a pixel.
std::array<std::size_t, 3> colorPlaces(const Image& image) {
  const auto place = [&](const char* name) {
    return std::size_t(std::find(image.channels.begin(), image.channels.end(), name) -
                       image.channels.begin());
  };
  std::array<std::size_t, 3> places{place("R"), place("G"), place("B")};
  const std::size_t none = image.channels.size();
  if (std::count(places.begin(), places.end(), none) > 0) places.fill(place("Y"));
  if (places[0] == none)
    throw InputError(
        fmt::format("channels '{}', expected R G B or Y to look at", fmt::join(image.channels, " ")));
  return places;
}

std::vector<float> colorsOf(const Image& image) {
  const std::array<std::size_t, 3> places = colorPlaces(image);
  std::vector<float> colors;
  colors.reserve(std::size_t(image.width) * image.height * 3);
  for (std::size_t p = 0; p < image.pixels.size(); p += image.channels.size())
    for (const std::size_t place : places) colors.push_back(image.pixels[p + place]);
  return colors;
}

/// A picture's colours as three channels that drawing takes. They lie in `colors`.
OIIO::ImageBuf drawable(const Image& image, std::vector<float>& colors) {
  colors = colorsOf(image);
  return {OIIO::ImageSpec(image.width, image.height, 3, OIIO::TypeDesc::FLOAT), colors.data()};
}

/// A picture with lines of text below it.
Image captioned(const Image& image, const CaptionedSize& size, const std::vector<std::string>& lines) {
  Image paper = blankPaper(size.width, size.height);
  OIIO::ImageBuf canvas(OIIO::ImageSpec(paper.width, paper.height, 3, OIIO::TypeDesc::FLOAT),
                        paper.pixels.data());
  std::vector<float> colors;
  const OIIO::ImageBuf picture = drawable(image, colors);
  pasteEnlarged(canvas, size.left, 0, picture, size.factor);
  const Panel panel{canvas, size.caption_top, size.text_size, findLabelFont()};
  double baseline = 1.5;
  for (const std::string& line : lines) {
    panel.write(kMargin, baseline, panel.fitted(line, panel.width() - 2 * kMargin));
    baseline += 1.5;
  }
  return paper;
}

/// Copies a picture to the column `left` of a row of the same height.
void putInRow(const Image& picture, Image& row, int left) {
  for (int y = 0; y < picture.height; ++y)
    std::copy_n(picture.pixels.begin() + std::ptrdiff_t(y) * picture.width * 3, picture.width * 3,
                row.pixels.begin() + (std::ptrdiff_t(y) * row.width + left) * 3);
}

}  // namespace

Image sideBySide(const Image& a, const Image& b, const ImageDifference& difference, const std::string& name_a,
                 const std::string& name_b) {
  const CaptionedSize size = captionedSize(a.width, a.height);
  const int step = size.width + size.text_size;
  const int width = 2 * step + size.width;
  if (width > kLargestSide)
    throw InputError(
        fmt::format("side by side they are {} pixels wide, expected at most {}", width, kLargestSide));
  // The row, one picture with its caption, and its enlarged pixels on the way there.
  requireMemory(3.0 * sizeof(float) * size.height * (double(width) + 2.0 * size.width),
                fmt::format("a picture of {} x {} pixels", width, size.height));
  Image row = blankPaper(width, size.height);
  const std::string factor = size.factor > 1 ? fmt::format(", enlarged {} times", size.factor) : "";
  putInRow(captioned(a, size, {"A  " + name_a, fmt::format("{} x {} pixels{}", a.width, a.height, factor)}),
           row, 0);
  const auto& [x, y] = difference.worst_pixel;
  putInRow(captioned(b, size,
                     {"B  " + name_b, fmt::format("max_abs {:.4g} at ({}, {})", difference.max_abs, x, y),
                      fmt::format("psnr {:.2f} dB", difference.psnr)}),
           row, step);
  putInRow(errorMap(difference), row, 2 * step);
  return row;
}

Image labelledSheet(const std::vector<Image>& pictures, const std::vector<std::string>& labels,
                    const std::vector<std::string>& brief, int columns) {
  const Image& first = pictures.front();
  const Sheet sheet = sheetOf(int(pictures.size()), columns, first.width, first.height);
  if (std::max(sheet.width, sheet.height) > kLargestSide)
    throw InputError(fmt::format("the sheet is {} x {} pixels, expected at most {} a side", sheet.width,
                                 sheet.height, kLargestSide));
  requireMemory(3.0 * sizeof(float) * sheet.width * (double(sheet.height) + sheet.step_y),
                fmt::format("a picture of {} x {} pixels", sheet.width, sheet.height));
  Image paper = blankPaper(sheet.width, sheet.height);
  OIIO::ImageBuf canvas(OIIO::ImageSpec(paper.width, paper.height, 3, OIIO::TypeDesc::FLOAT),
                        paper.pixels.data());
  const std::string font = findLabelFont();
  const bool all_fit = std::all_of(labels.begin(), labels.end(), [&](const std::string& label) {
    return hasRoom(canvas, sheet, label, font);
  });
  for (int i = 0; i < int(pictures.size()); ++i) {
    std::vector<float> colors;
    pasteEnlarged(canvas, sheet.left(i), sheet.top(i), drawable(pictures[std::size_t(i)], colors),
                  sheet.factor);
    writeLabel(canvas, sheet, i, (all_fit ? labels : brief)[std::size_t(i)], font);
  }
  return paper;
}

}  // namespace luciole
