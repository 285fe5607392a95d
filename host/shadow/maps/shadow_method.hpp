#pragma once

#include <cstdint>

namespace luciole {

/// How it is told whether a point is in a light's shadow.
enum class ShadowMethod : std::uint8_t {
  kOff,
  kHard,       ///< by a map: the texel that the point falls into
  kPcf,        ///< by a map: the nearest texels, weighted (percentage-closer filtering)
  kSoft,       ///< by a map: a disc as wide as the penumbra that the light's size gives
  kExact,      ///< by the triangles themselves: whether one is between the point and the light's centre
  kSoftExact,  ///< likewise, for samples of the light's size: the share of them that the point sees
  kAuto,       ///< for each light kExact or kHard: see shadowWays
};

/// Who tells whether points are in a light's shadow.
enum class ShadowWay : std::uint8_t {
  kNone,   ///< nobody: it casts none
  kMap,    ///< its shadow map
  kBeams,  ///< kernels/beam_shadows.cl: exact
};

}  // namespace luciole
