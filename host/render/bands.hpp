#pragma once

#include <functional>
#include <optional>

#include "render/plan.hpp"

// Pictures are made in bands of whole rows, so that they fit into memory.
namespace luciole {

/// Rows of a picture, counted from the whole picture's top.
struct Band {
  int first, height;
};

/// What holds for the bands of a picture.
struct BandLimits {
  int tallest;  ///< the most rows that fit into memory
  int origin;   ///< bands end at this row plus a multiple of kBinSize, but for the last, and for lower ones
  int bottom;   ///< where the picture, or its crop, ends
};

/// Where a band ends that begins at row `first`: as far down as may be.
int bandEnd(int first, const BandLimits& limits);

/// Says which band to make next; none: the picture is done.
using NextBand = std::function<std::optional<Band>(const BandLimits& limits)>;

/// Takes the pixels of a band, or of the next of its rows where the device had no memory for all of them at
/// once. They last until it returns.
using BandSink = std::function<void(const Band& band, const Image& rows)>;

/// Makes the bands of a planned picture that `next` asks for. The scene and the settings are valid. All else:
/// see renderBands().
void makeBands(OpenedDevice& device, const Scene& scene, const RenderSettings& settings,
               const PicturePlan& plan, const NextBand& next, const BandSink& take, Stats& stats,
               KeptShadows* kept);

}  // namespace luciole
