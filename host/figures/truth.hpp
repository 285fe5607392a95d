#pragma once

#include "image/image.hpp"
#include "raster/view.hpp"
#include "reference/reference.hpp"

namespace luciole {

/// The picture that others are held against, channels R G B.
struct Truth {
  Image image;
  /// Estimate of its own mean absolute error; 0: only what float rounds off, 2⁻²⁴ of each value.
  double own_error = 0;
};

/// The mean of many samples a pixel, each shaded in double precision. It is put together from two sets of
/// samples: as their errors are about alike and have nothing to do with each other, their mean is wrong by
/// about half of what they differ.
Truth sampledTruth(const Scene& scene, const View& view, const ReferenceSettings& settings);

}  // namespace luciole
