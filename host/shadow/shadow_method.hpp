#pragma once

#include <cstdint>

namespace luciole {

/// How a lookup tells from its maps whether a point is in shadow.
enum class ShadowMethod : std::uint8_t {
  kOff,
  kHard,   ///< the texel that the point falls into
  kPcf,    ///< the nearest texels, weighted (percentage-closer filtering)
  kSoft,   ///< a disc as wide as the penumbra that the light's size gives
  kExact,  ///< as rays to the light's centre: by bounds of depth, and by rays where these don't decide
};

}  // namespace luciole
