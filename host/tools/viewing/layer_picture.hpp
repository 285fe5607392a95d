#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "luciole/image.hpp"

namespace luciole {

/// The meaning of a layer's values, which decides their colours. Codes are sRGB's, from 0 to 1.
enum class LayerKind : std::uint8_t {
  kColor,   ///< three: linear light, as it is; one: grey
  kVector,  ///< three. Unit vectors have the codes v·½ + ½, as normal maps do; positions run from 0 to 1
            ///< between the least and the largest of each coordinate. The zero vector, nothing, is black
  kValue,   ///< one: false colours and a scale bar below, see valueSheet()
  kBound,   ///< three, of an error: the largest, see boundMap()
  kId,      ///< one: each number has a colour by its hash. Below 0 is nothing: black
  kMatte,   ///< Cryptomatte: pairs of an id and a share; colours by hash, mixed. 0 is nothing
};

struct LayerPicture {
  Image image;                     ///< linear R G B; of the layer's size but with a scale bar
  std::vector<std::string> notes;  ///< lines that explain the colours, unless the picture has a scale
};

/// A layer as a picture to look at. layer: its channels alone, in their order. name: for the scale bar and
/// the notes. What isn't finite is red in colours, vectors and ids. Throws MachineError where it doesn't fit
/// into memory.
LayerPicture layerPicture(const std::string& name, LayerKind kind, const Image& layer);

}  // namespace luciole
