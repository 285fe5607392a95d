#pragma once

#include <functional>
#include <optional>

#include "render/plan.hpp"

// Pictures are rendered in bands of whole rows, so that they fit into memory.
namespace luciole {

/// Rows of a picture, counted from the whole picture's top.
struct Band {
  int first, height;
};

/// Where the bands of a picture may end.
struct BandLimits {
  int tallest;  ///< the most rows that fit into memory
  int origin;  ///< bands of kBinSize rows or more end at this row plus a multiple of kBinSize, or at `bottom`
  int bottom;  ///< the end of the picture, or of its crop
};

/// The end of the tallest band that begins at row `first`.
int bandEnd(int first, const BandLimits& limits);

/// Returns the band to render next; none: the picture is complete.
using NextBand = std::function<std::optional<Band>(const BandLimits& limits)>;

/// Takes the pixels of a band, or of its next rows if the device's memory doesn't hold all of it. They last
/// until it returns.
using BandSink = std::function<void(const Band& band, const Image& rows)>;

/// Renders the bands of a planned picture that `next` returns. The scene and the settings must be valid.
/// Otherwise as renderBands().
void makeBands(OpenedDevice& device, const Scene& scene, const RenderSettings& settings,
               const PicturePlan& plan, const NextBand& next, const BandSink& take, Stats& stats,
               KeptPicture* kept);

}  // namespace luciole
