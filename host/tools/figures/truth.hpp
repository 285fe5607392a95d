#pragma once

#include "luciole/image.hpp"
#include "raster/view.hpp"
#include "reference/reference.hpp"

namespace luciole {

/// A reference picture, channels R G B.
struct Truth {
  Image image;
  /// Estimate of its own mean absolute error; 0: only float's rounding, 2⁻²⁴ of each value.
  double own_error = 0;
};

/// The mean of 80 samples a pixel, each shaded in double precision (see referencePicture). They are two sets:
/// as their errors are independent and about equal, their mean is wrong by about half of their difference,
/// which is the estimate of the own error.
Truth sampledTruth(const Scene& scene, const View& view, const ReferenceSettings& settings);

}  // namespace luciole
