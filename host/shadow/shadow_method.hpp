#pragma once

#include <cstdint>

namespace luciole {

/// How a lookup tells from its maps whether a point is in shadow.
enum class ShadowMethod : std::uint8_t {
  kOff,
  kHard,   ///< the texel that the point falls into
  kPcf,    ///< the nearest texels, weighted (percentage-closer filtering)
  kSoft,   ///< a disc as wide as the light's size makes the shadow's edge
  kExact,  ///< as rays to the light's middle: by bounds of depth, and where these leave a doubt by rays
};

}  // namespace luciole
