#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "luciole/image.hpp"

namespace luciole {

/// How picture B differs from picture A, over the compared pixels and channels, in linear units unless said
/// otherwise. Equal values differ by 0; so do infinities of the same sign, and two NaNs. Any other pair with
/// a value that is not finite counts in `nonfinite`, and as an infinite difference in max_abs, the
/// percentiles and `over`. The means leave such pairs out. They are infinite if no other pair is left.
struct ImageDifference {
  std::vector<std::string> channels = {};  ///< compared
  std::uint64_t pixels = 0;                ///< compared
  double max_abs = 0;
  double mean_abs = 0;
  double max_relative = 0;  ///< max_abs / the largest magnitude of A's finite compared values
  double mean_relative = 0;
  double mean_signed = 0;  ///< mean of B − A: the bias
  double mse = 0;          ///< mean of (B − A)²
  double rmse = 0;         ///< √mse
  double psnr = 0;         ///< dB, peak 1; infinite for equal pictures
  double relmse = 0;       ///< mean of (B − A)² / (A² + 10⁻²)
  double mape = 0;         ///< mean of |B − A| / (|A| + 10⁻²)
  /// Mean of 2 |B − A| / (|A| + |B| + 10⁻²), in [0, 2): twice the figure of T. Vogels et al., "Denoising with
  /// Kernel Prediction and Asymmetric Loss Functions", 2018.
  double smape = 0;
  double p99_abs = 0;   ///< over pixels, of the largest difference of a pixel's channels: the smallest d such
                        ///< that 99 % of the pixels differ by at most d
  double p999_abs = 0;  ///< the same for 99.9 %
  std::uint64_t nonfinite =
      0;  ///< pairs of values, one of them NaN or infinite at least, that are not the same value
  std::array<std::uint64_t, 3> over{};  ///< pixels with any channel differing by more than kOverLimits[i]
  std::array<int, 2> worst_pixel{};     ///< x, y of max_abs
  int width = 0;
  int height = 0;
  std::vector<double> of_pixel =
      {};  ///< row-major: the largest difference of a pixel's channels, or kNotCompared
};
/// Half, one and four 8-bit steps of a linear [0,1] range.
inline constexpr std::array<double, 3> kOverLimits{0.5 / 255, 1.0 / 255, 4.0 / 255};
inline constexpr double kNotCompared = -1.0;

/// The figures that pictures are judged by, and the names that files give them. The smaller the better, but
/// for psnr; mean_signed is the better the nearer to 0.
inline constexpr std::pair<const char*, double ImageDifference::*> kImageMetrics[] = {
    {"max_abs", &ImageDifference::max_abs},
    {"mean_abs", &ImageDifference::mean_abs},
    {"max_relative", &ImageDifference::max_relative},
    {"mean_relative", &ImageDifference::mean_relative},
    {"mean_signed", &ImageDifference::mean_signed},
    {"mse", &ImageDifference::mse},
    {"rmse", &ImageDifference::rmse},
    {"psnr", &ImageDifference::psnr},
    {"relmse", &ImageDifference::relmse},
    {"mape", &ImageDifference::mape},
    {"smape", &ImageDifference::smape},
    {"p99_abs", &ImageDifference::p99_abs},
    {"p999_abs", &ImageDifference::p999_abs}};

/// Compares the channels that both pictures have under the same names, except A, the coverage. Sizes must be
/// equal, and R, G, B and Y be in both pictures or in neither. Parts of pictures of one size must start at
/// the same pixel. Where a picture has a channel `sampled`, only pixels where it is not 0 are compared.
/// Throws InputError when sizes, parts or channels don't match or no pixel is left.
ImageDifference compareImages(const Image& a, const Image& b);

/// |B − A| × gain of the same channels as a picture to look at; +inf where only one is not finite, 0 where
/// nothing is compared. Throws as compareImages does.
Image differencePicture(const Image& a, const Image& b, float gain);

}  // namespace luciole
