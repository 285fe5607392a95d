#pragma once

#include <string>
#include <vector>

#include "image/exr_input.hpp"
#include "image/layers.hpp"
#include "tools/viewing/layer_picture.hpp"

namespace luciole {

/// A layer that can be shown: channels of one part of a file, or of one picture.
struct ShownLayer {
  std::string name;
  int part = 0;
  std::vector<int> channels;  ///< places in PicturePart::channels, in the order that layerPicture() wants
  LayerKind kind = LayerKind::kValue;
};

/// All layers, in the order of their channels. The picture's own colours are called "color". The layers of a
/// part with a name have it before theirs.
std::vector<ShownLayer> shownLayers(const std::vector<PicturePart>& parts);

/// The layer of that name: its whole name, its part after a dot (case ignored), or its role: position,
/// normal, depth ... Without a name the colours, or the only layer. Throws InputError "where:
/// ..." that lists the layers.
ShownLayer findShownLayer(const std::vector<PicturePart>& parts, const std::string& name,
                          const std::string& where);

/// The layer among the channels of a picture that was made with one of RenderSettings::aovs.
ShownLayer aovLayer(const std::vector<std::string>& channels);

/// Appends channels of some rows to a picture, whose sizes they were before.
void appendRows(const Image& rows, const std::vector<int>& channels, Image& picture);

/// A layer's channels, side by side in each pixel, with the file's names. Throws as ExrInput::read().
Image readShownLayer(ExrInput& input, const ShownLayer& layer);

}  // namespace luciole
