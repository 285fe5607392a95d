#include "image/tone.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "image/srgb.hpp"
#include "luciole/image.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

/// Narkowicz's curve as he published it, in double.
double published(double x) {
  const double a = 2.51, b = 0.03, c = 2.43, d = 0.59, e = 0.14;
  return std::clamp((x * (a * x + b)) / (x * (c * x + d) + e), 0.0, 1.0);
}

TEST(FilmicTone, IsThePublishedCurve) {
  // Each side of the fraction takes four rounded steps, its constant's among them, and the fraction one. All
  // terms are positive, so no error grows: 9 half units, and squares of them.
  constexpr double kRelative = 10 * 0x1p-24;
  for (double stops = -20; stops <= 10; stops += 1.0 / 64) {
    const float x = float(std::exp2(stops));
    EXPECT_NEAR(filmicTone(x), published(x), kRelative * published(x)) << x;
  }
  EXPECT_NEAR(filmicTone(0.18f), 0.086724 / 0.324932, 1e-6) << "by hand";
}

TEST(FilmicTone, RisesFromBlackToWhite) {
  EXPECT_EQ(filmicTone(0), 0.0f);
  float last = 0;
  for (double stops = -20; stops <= 2.75; stops += 1.0 / 64) {
    const float tone = filmicTone(float(std::exp2(stops)));
    EXPECT_GT(tone, last) << stops;
    last = tone;
  }
  EXPECT_LT(filmicTone(7.2f), 1.0f);
  for (const float bright :
       {7.3f, 8.0f, 100.0f, std::numeric_limits<float>::max(), std::numeric_limits<float>::infinity()})
    EXPECT_EQ(filmicTone(bright), 1.0f) << bright;
  for (const float none :
       {-1.0f, -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()})
    EXPECT_EQ(filmicTone(none), 0.0f) << none;
}

TEST(FilmicTone, ComesBeforeTheSrgbTransferInFilesOfIntegersAlone) {
  const test::TemporaryFolder folder;
  const std::vector<float> values{0, 0.001f, 0.02f, 0.18f, 0.5f, 1, 3, 9};
  Image image{int(values.size()), 1, {"R", "G", "B", "A"}, {}};
  for (const float value : values)
    image.pixels.insert(image.pixels.end(), {value, value / 2, value / 4, 0.5f});
  for (const char* name : {"a.png", "a.tga", "a.exr"})
    writeImage(image, folder / name, {}, {.tone = ToneCurve::kFilmic});
  EXPECT_EQ(readImage(folder / "a.exr").pixels, image.pixels);
  for (const char* name : {"a.png", "a.tga"}) {
    const Image read = readImage(folder / name);
    ASSERT_EQ(read.pixels.size(), image.pixels.size());
    for (std::size_t i = 0; i < read.pixels.size(); ++i) {
      const bool is_alpha = i % 4 == 3;
      const float code = 255 * (is_alpha ? read.pixels[i] : encodeSrgb(read.pixels[i]));
      const double exact = is_alpha ? 127.5 : 255 * double(encodeSrgb(float(published(image.pixels[i]))));
      // Half a step of rounding, and what a 16-bit code and its decoding leave of a code: below 1e-3.
      EXPECT_NEAR(code, exact, 0.501) << name << " " << i;
    }
  }
}

}  // namespace
}  // namespace luciole
