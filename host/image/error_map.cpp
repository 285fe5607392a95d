#include "image/error_map.hpp"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "error.hpp"
#include "image/oiio.hpp"

namespace luciole {
namespace {

using OIIO::ImageBuf;
using OIIO::ROI;
using OIIO::ImageBufAlgo::TextAlignX;
using Color = std::array<float, 3>;

// All linear, as OpenImageIO's maps are: its viridis begins at what sRGB calls 68 1 84 and ends at 253
// 231 37.
constexpr Color kEqualColor{0.0f, 0.0f, 0.0f};
constexpr Color kNotComparedColor{0.05f, 0.05f, 0.05f};
constexpr Color kNotFiniteColor{1.0f, 0.0f, 0.0f};
constexpr Color kPaper{1.0f, 1.0f, 1.0f};
constexpr Color kInk{0.0f, 0.0f, 0.0f};

constexpr const char* kFont = "DejaVuSans";
constexpr int kMinDecades = 3;
constexpr int kMaxDecades = 6;
constexpr int kMinWidth = 480;  ///< pixels that the bar and its labels need
constexpr int kMinTextSize = 14;
constexpr double kPanelHeight = 8.6;  ///< in text sizes, as all lengths in the panel are

/// From 10^low to 10^high.
struct Scale {
  int low = -kMaxDecades;
  int high = 0;
};

bool isOnScale(double difference) { return difference > 0 && std::isfinite(difference); }

Scale scaleOf(const std::vector<double>& differences) {
  double smallest = HUGE_VAL, largest = 0;
  for (const double d : differences) {
    if (!isOnScale(d)) continue;
    smallest = std::min(smallest, d);
    largest = std::max(largest, d);
  }
  if (largest == 0) return {};
  Scale scale;
  scale.high = int(std::ceil(std::log10(largest)));
  scale.low =
      std::clamp(int(std::floor(std::log10(smallest))), scale.high - kMaxDecades, scale.high - kMinDecades);
  return scale;
}

/// 0 at the low end, 1 at the high end, and beyond.
double placeOn(const Scale& scale, double difference) {
  return (std::log10(difference) - scale.low) / (scale.high - scale.low);
}

/// The map's colours of values in [0,1].
ImageBuf falseColors(int width, int height, std::vector<float>& values) {
  const ImageBuf source(OIIO::ImageSpec(width, height, 1, OIIO::TypeDesc::FLOAT), values.data());
  return OIIO::ImageBufAlgo::color_map(source, 0, "viridis");
}

ImageBuf colorPixels(const ImageDifference& difference, const Scale& scale) {
  std::vector<float> places;
  places.reserve(difference.of_pixel.size());
  for (const double d : difference.of_pixel) {
    places.push_back(isOnScale(d) ? float(std::clamp(placeOn(scale, d), 0.0, 1.0)) : 0.0f);
  }
  ImageBuf colors = falseColors(difference.width, difference.height, places);
  for (std::size_t p = 0; p < difference.of_pixel.size(); ++p) {
    const double d = difference.of_pixel[p];
    if (isOnScale(d)) continue;
    const Color& color = d == 0 ? kEqualColor : d == kNotCompared ? kNotComparedColor : kNotFiniteColor;
    colors.setpixel(int(p % difference.width), int(p / difference.width), color.data());
  }
  return colors;
}

/// Lays a picture on the canvas, every pixel as a square of `factor` a side.
void lay(ImageBuf& canvas, int x, int y, const ImageBuf& picture, int factor) {
  const ROI enlarged(0, picture.spec().width * factor, 0, picture.spec().height * factor, 0, 1, 0, 3);
  OIIO::ImageBufAlgo::paste(canvas, x, y, 0, 0, OIIO::ImageBufAlgo::resample(picture, false, enlarged));
}

/// The paper under the picture, and lengths on it: x from the left and y from the picture's bottom, both in
/// text sizes.
struct Panel {
  ImageBuf& canvas;
  int top;
  int text_size;

  int pixels(double length) const { return int(std::lround(length * text_size)); }
  double width() const { return double(canvas.spec().width) / text_size; }
  double textWidth(const std::string& text) const {
    return double(OIIO::ImageBufAlgo::text_size(text, text_size, kFont).width()) / text_size;
  }

  /// Upper and lower edges are rounded alike wherever things meet, widths are the same everywhere.
  void fill(double x, double y, double across, double down, const Color& color) const {
    const int left = pixels(x), right = left + pixels(across);
    OIIO::ImageBufAlgo::fill(canvas, color, ROI(left, right, top + pixels(y), top + pixels(y + down)));
  }
  void write(double x, double baseline, const std::string& text, TextAlignX align) const {
    if (!OIIO::ImageBufAlgo::render_text(canvas, pixels(x), top + pixels(baseline), text, text_size, kFont,
                                         kInk, align)) {
      throw MachineError(
          fmt::format("error map: no labels without DejaVu Sans (Debian: fonts-dejavu-core): {}",
                      oneLine(canvas.geterror())));
    }
  }
};

constexpr double kMargin = 2.0;
constexpr double kTickWidth = 0.1;

void drawBar(const Panel& panel, const Scale& scale) {
  constexpr double kTop = 3.6, kHeight = 1.2, kTick = 0.35;
  const double length = panel.width() - 2 * kMargin;
  const int columns = panel.pixels(length), rows = panel.pixels(kHeight);
  std::vector<float> ramp;
  for (int i = 0; i < columns * rows; ++i) ramp.push_back(float(i % columns) / float(columns - 1));
  lay(panel.canvas, panel.pixels(kMargin), panel.top + panel.pixels(kTop), falseColors(columns, rows, ramp),
      1);
  const auto tick = [&](double x, double y) { panel.fill(x - kTickWidth / 2, y, kTickWidth, kTick, kInk); };
  for (int power = scale.low; power <= scale.high; ++power) {
    const double x = kMargin + length * (power - scale.low) / (scale.high - scale.low);
    tick(x, kTop + kHeight);
    panel.write(x, kTop + kHeight + 1.5, power == 0 ? "1" : fmt::format("1e{}", power), TextAlignX::Center);
  }
  const double step = placeOn(scale, 1.0 / 255);
  if (step < 0) {
    panel.write(kMargin, kTop - 0.5, "< 1/255", TextAlignX::Left);
  } else if (step > 1) {
    panel.write(kMargin + length, kTop - 0.5, "1/255 >", TextAlignX::Right);
  } else {
    tick(kMargin + length * step, kTop - kTick);
    panel.write(kMargin + length * step, kTop - 0.5, "1/255", TextAlignX::Center);
  }
}

void drawPanel(const Panel& panel, const ImageDifference& difference, const Scale& scale) {
  panel.fill(0, 0, panel.width(), kPanelHeight, kPaper);
  double largest = 0;
  bool all_compared = true;
  for (const double d : difference.of_pixel) {
    if (isOnScale(d)) largest = std::max(largest, d);
    all_compared = all_compared && d != kNotCompared;
  }
  panel.write(kMargin, 1.5, "|B - A|, linear", TextAlignX::Left);
  panel.write(panel.width() - kMargin, 1.5,
              fmt::format("max {:.2g}, mean {:.2g}", largest, difference.mean_abs), TextAlignX::Right);
  drawBar(panel, scale);
  double x = kMargin;
  const auto swatch = [&](const Color& color, const std::string& meaning) {
    constexpr double kBaseline = 7.9;
    panel.fill(x, kBaseline - 0.75, 0.8, 0.8, color);
    panel.write(x + 1.2, kBaseline, meaning, TextAlignX::Left);
    x += 2.4 + panel.textWidth(meaning);
  };
  swatch(kEqualColor, "equal");
  if (!all_compared) swatch(kNotComparedColor, "not compared");
  if (difference.nonfinite > 0)
    swatch(kNotFiniteColor, fmt::format("not finite ({} values)", difference.nonfinite));
}

}  // namespace

Image errorMap(const ImageDifference& difference) {
  const int factor = std::max(1, kMinWidth / std::max(difference.width, difference.height));
  const int picture_width = difference.width * factor, picture_height = difference.height * factor;
  Image map{std::max(kMinWidth, picture_width), 0, {"R", "G", "B"}, {}};
  const int text_size = std::max(kMinTextSize, map.width / 64);
  map.height = picture_height + int(std::lround(kPanelHeight * text_size));
  map.pixels.assign(std::size_t(map.width) * map.height * 3, 1.0f);

  ImageBuf canvas(OIIO::ImageSpec(map.width, map.height, 3, OIIO::TypeDesc::FLOAT), map.pixels.data());
  const Scale scale = scaleOf(difference.of_pixel);
  lay(canvas, (map.width - picture_width) / 2, 0, colorPixels(difference, scale), factor);
  drawPanel({canvas, picture_height, text_size}, difference, scale);
  return map;
}

}  // namespace luciole
