#include "image/heat_map.hpp"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "image/drawing.hpp"
#include "image/label_font.hpp"

namespace luciole {
namespace {

using OIIO::ImageBuf;
using OIIO::ImageBufAlgo::TextAlignX;

// Linear, as the colours of OpenImageIO's color_map are: its viridis runs from 68 1 84 to 253 231 37 in 8-bit
// sRGB.
constexpr LinearColor kZeroColor{0.0f, 0.0f, 0.0f};
constexpr LinearColor kNotComparedColor{0.05f, 0.05f, 0.05f};
constexpr LinearColor kNotFiniteColor{1.0f, 0.0f, 0.0f};
constexpr LinearColor kInfiniteColor = kNotComparedColor;

constexpr int kMinDecades = 3;
constexpr int kMaxDecades = 6;

/// From 10^low to 10^high, or from low to high.
struct Scale {
  double low = -kMaxDecades;
  double high = 0;
  bool is_linear = false;

  bool has(double value) const { return std::isfinite(value) && (is_linear || value > 0); }
};

/// A colour off the scale and what it means.
struct Swatch {
  LinearColor color;
  std::string meaning;
};

/// What a map shows.
struct Content {
  int width, height;
  std::span<const double> values;  ///< row-major; values off the scale have a swatch's colour
  Scale scale;
  std::string title, figures;
  double mark;  ///< a value to label on the scale; 0: none
  std::string mark_name;
  std::vector<Swatch> swatches;
  bool infinity_is_far = false;  ///< it has a colour of its own
};

Scale errorScale(const std::vector<double>& differences) {
  double smallest = HUGE_VAL, largest = 0;
  for (const double d : differences) {
    if (!Scale{}.has(d)) continue;
    smallest = std::min(smallest, d);
    largest = std::max(largest, d);
  }
  if (largest == 0) return {};
  const double high = std::ceil(std::log10(largest));
  return {std::clamp(std::floor(std::log10(smallest)), high - kMaxDecades, high - kMinDecades), high};
}

/// Position of a value on the scale: 0 at its low end, 1 at its high end; < 0 or > 1 off the scale.
double placeOn(const Scale& scale, double value) {
  return ((scale.is_linear ? value : std::log10(value)) - scale.low) / (scale.high - scale.low);
}

/// False colours of values in [0,1].
ImageBuf falseColors(int width, int height, std::vector<float>& values) {
  const ImageBuf source(OIIO::ImageSpec(width, height, 1, OIIO::TypeDesc::FLOAT), values.data());
  return OIIO::ImageBufAlgo::color_map(source, 0, "viridis");
}

ImageBuf colorPixels(const Content& content) {
  std::vector<float> places;
  places.reserve(content.values.size());
  const Scale& scale = content.scale;
  for (const double value : content.values)
    places.push_back(scale.has(value) ? float(std::clamp(placeOn(scale, value), 0.0, 1.0)) : 0.0f);
  ImageBuf colors = falseColors(content.width, content.height, places);
  for (std::size_t p = 0; p < content.values.size(); ++p) {
    const double value = content.values[p];
    if (scale.has(value)) continue;
    const LinearColor& color = value == 0                                      ? kZeroColor
                               : value == kNotCompared                         ? kNotComparedColor
                               : content.infinity_is_far && !std::isnan(value) ? kInfiniteColor
                                                                               : kNotFiniteColor;
    colors.setpixel(int(p % content.width), int(p / content.width), color.data());
  }
  return colors;
}

constexpr double kTickWidth = 0.1;

/// 1, 2 or 5 times a power of ten, of which `span` has four to ten.
double tickStep(double span) {
  const double power = std::pow(10.0, std::floor(std::log10(span / 4)));
  return power * (span >= 20 * power ? 5 : span >= 8 * power ? 2 : 1);
}

void drawBar(const Panel& panel, const Content& content) {
  constexpr double kTop = 3.6, kHeight = 1.2, kTick = 0.35;
  const Scale& scale = content.scale;
  const double length = panel.width() - 2 * kMargin;
  const int columns = panel.pixels(length), rows = panel.pixels(kHeight);
  std::vector<float> ramp;
  for (int i = 0; i < columns * rows; ++i) ramp.push_back(float(i % columns) / float(columns - 1));
  pasteEnlarged(panel.canvas, panel.pixels(kMargin), panel.top + panel.pixels(kTop),
                falseColors(columns, rows, ramp), 1);
  const auto tick = [&](double x, double y) { panel.fill(x - kTickWidth / 2, y, kTickWidth, kTick, kInk); };
  double written = -kMargin;  // up to where
  const auto label = [&](double value, const std::string& text) {
    const double x = kMargin + length * placeOn(scale, value), half = panel.textWidth(text) / 2;
    tick(x, kTop + kHeight);
    if (x - half < written + 0.5) return;
    panel.write(x, kTop + kHeight + 1.5, text, TextAlignX::Center);
    written = x + half;
  };
  const double span = scale.high - scale.low;
  if (scale.is_linear) {
    const double step = tickStep(span);
    const double largest = std::max(std::abs(scale.low), std::abs(scale.high));
    const int digits = std::max(6, 1 + int(std::ceil(std::log10(largest / step))));
    for (double i = std::ceil(scale.low / step); i * step <= scale.high; ++i)
      label(i * step, fmt::format("{:.{}g}", i == 0 ? 0.0 : i * step, digits));
  } else {
    for (double power = std::floor(scale.low); power <= scale.high; ++power)
      for (const double digit : {1.0, 2.0, 3.0, 5.0, 7.0}) {
        const bool is_wanted = digit == 1 || (span < 1) || (span < kMinDecades && (digit == 2 || digit == 5));
        const double place = power + std::log10(digit);
        if (!is_wanted || place < scale.low || place > scale.high) continue;
        const double value = digit * std::pow(10.0, power);
        const bool is_short = power == 0 || span < kMinDecades;
        label(value, is_short ? fmt::format("{:g}", value) : fmt::format("1e{}", power));
      }
  }
  if (content.mark == 0) return;
  const double place = placeOn(scale, content.mark);
  if (place < 0) {
    panel.write(kMargin, kTop - 0.5, "< " + content.mark_name, TextAlignX::Left);
  } else if (place > 1) {
    panel.write(kMargin + length, kTop - 0.5, content.mark_name + " >", TextAlignX::Right);
  } else {
    tick(kMargin + length * place, kTop - kTick);
    panel.write(kMargin + length * place, kTop - 0.5, content.mark_name, TextAlignX::Center);
  }
}

void drawPanel(const Panel& panel, const Content& content) {
  panel.write(kMargin, 1.5, content.title, TextAlignX::Left);
  panel.write(panel.width() - kMargin, 1.5, content.figures, TextAlignX::Right);
  drawBar(panel, content);
  double x = kMargin;
  for (const Swatch& swatch : content.swatches) {
    constexpr double kBaseline = 7.9;
    panel.fill(x, kBaseline - 0.75, 0.8, 0.8, swatch.color);
    panel.write(x + 1.2, kBaseline, swatch.meaning, TextAlignX::Left);
    x += 2.4 + panel.textWidth(swatch.meaning);
  }
}

/// The scale of what is finite, which gets sorted: linear, or logarithmic, see valueSheet().
Scale valueScale(std::vector<double>& finite) {
  std::sort(finite.begin(), finite.end());
  if (finite.empty()) return {0, 1, true};
  const double least = finite.front(), most = finite.back();
  const auto positive = std::upper_bound(finite.begin(), finite.end(), 0.0);
  const double median = positive == finite.end() ? most : positive[(finite.end() - positive) / 2];
  if (least > 0 && most > 4 * median) return {std::log10(least), std::log10(most)};
  if (least == 0 && most > 20 * median) {
    const double high = std::ceil(std::log10(most));
    return {std::max(std::floor(std::log10(*positive)), high - kMaxDecades), high};
  }
  // Values that are all the same, but for rounding, have a scale, too.
  const double size = std::max(std::abs(least), std::abs(most));
  if (most - least > 1e-6 * size) return {least, most, true};
  return {least, least + (size > 0 ? size : 1), true};
}

Image drawMap(const Content& content) {
  const CaptionedSize size = captionedSize(content.width, content.height);
  Image map = blankPaper(size.width, size.height);
  ImageBuf canvas(OIIO::ImageSpec(map.width, map.height, 3, OIIO::TypeDesc::FLOAT), map.pixels.data());
  pasteEnlarged(canvas, size.left, 0, colorPixels(content), size.factor);
  drawPanel({canvas, size.caption_top, size.text_size, findLabelFont()}, content);
  return map;
}

}  // namespace

Image errorMap(const ImageDifference& difference) {
  double largest = 0;
  bool all_compared = true;
  for (const double d : difference.of_pixel) {
    if (Scale{}.has(d)) largest = std::max(largest, d);
    all_compared = all_compared && d != kNotCompared;
  }
  std::vector<Swatch> swatches{{kZeroColor, "equal"}};
  if (!all_compared) swatches.push_back({kNotComparedColor, "not compared"});
  if (difference.nonfinite > 0)
    swatches.push_back({kNotFiniteColor, fmt::format("not finite ({} values)", difference.nonfinite)});
  return drawMap({.width = difference.width,
                  .height = difference.height,
                  .values = difference.of_pixel,
                  .scale = errorScale(difference.of_pixel),
                  .title = "|B - A|, linear",
                  .figures = fmt::format("max {:.2g}, mean {:.2g}", largest, difference.mean_abs),
                  .mark = 1.0 / 255,
                  .mark_name = "1/255",
                  .swatches = swatches});
}

Image listMap(int width, int height, const std::vector<float>& list_lengths) {
  const std::vector<double> values(list_lengths.begin(), list_lengths.end());
  double largest = 0, sum = 0;
  for (const double value : values) {
    largest = std::max(largest, value);
    sum += value;
  }
  const double decades = std::max(1.0, std::ceil(std::log10(std::max(largest, 1.0))));
  return drawMap({.width = width,
                  .height = height,
                  .values = values,
                  .scale = {0, decades},
                  .title = "lights per tile",
                  .figures = fmt::format("most {:.0f}, mean {:.3g}", largest, sum / double(values.size())),
                  .mark = 0,
                  .mark_name = {},
                  .swatches = {{kZeroColor, "none"}}});
}

Image boundMap(int width, int height, const std::vector<float>& bounds) {
  const std::vector<double> values(bounds.begin(), bounds.end());
  double largest = 0, sum = 0;
  std::size_t bounded = 0;
  for (const double value : values) {
    largest = std::max(largest, value);
    sum += value;
    bounded += value > 0;
  }
  return drawMap({.width = width,
                  .height = height,
                  .values = values,
                  .scale = {-5, -1},
                  .title = "bound of the error, linear",
                  .figures = fmt::format("largest {:.2g}, mean {:.2g}", largest,
                                         sum / double(std::max<std::size_t>(bounded, 1))),
                  .mark = 1.0 / 255,
                  .mark_name = "1/255",
                  .swatches = {{kZeroColor, "none"}}});
}

Image valueSheet(int width, int height, const std::vector<ValuePanel>& panels, int columns,
                 const std::string& title) {
  std::vector<double> values;
  values.reserve(panels.size() * std::size_t(width) * std::size_t(height));
  for (const ValuePanel& panel : panels)
    values.insert(values.end(), panel.values.begin(), panel.values.end());
  std::vector<double> finite;
  bool any_infinite = false, any_nan = false;
  for (const double value : values) {
    if (std::isfinite(value)) finite.push_back(value);
    any_infinite = any_infinite || std::isinf(value);
    any_nan = any_nan || std::isnan(value);
  }
  Content content{.width = width,
                  .height = height,
                  .values = values,
                  .scale = valueScale(finite),
                  .title = title,
                  .figures = finite.empty()
                                 ? "no finite value"
                                 : fmt::format("least {:.4g}, most {:.4g}", finite.front(), finite.back()),
                  .mark = 0,
                  .mark_name = {},
                  .swatches = {},
                  .infinity_is_far = true};
  if (!content.scale.is_linear && finite.front() == 0) content.swatches.push_back({kZeroColor, "0"});
  if (any_infinite) content.swatches.push_back({kInfiniteColor, "infinite"});
  if (any_nan) content.swatches.push_back({kNotFiniteColor, "not a number"});
  if (panels.size() == 1) return drawMap(content);
  const Sheet sheet = sheetOf(int(panels.size()), columns, width, height);
  Image paper = blankPaper(sheet.width, sheet.height + captionHeight(sheet.text_size));
  ImageBuf canvas(OIIO::ImageSpec(paper.width, paper.height, 3, OIIO::TypeDesc::FLOAT), paper.pixels.data());
  const std::string font = findLabelFont();
  for (int i = 0; i < int(panels.size()); ++i) {
    Content one = content;
    one.values = content.values.subspan(std::size_t(i) * width * height, std::size_t(width) * height);
    pasteEnlarged(canvas, sheet.left(i), sheet.top(i), colorPixels(one), sheet.factor);
    writeLabel(canvas, sheet, i, panels[std::size_t(i)].label, font);
  }
  drawPanel({canvas, sheet.height, sheet.text_size, font}, content);
  return paper;
}

}  // namespace luciole
