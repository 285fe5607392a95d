#pragma once

#include <array>
#include <string>
#include <vector>

#include "lighting/light_gbuffer.hpp"
#include "luciole/gbuffer.hpp"
#include "render/render.hpp"

namespace luciole {

/// A picture's first sample, of which most layers show the planes.
struct FirstSample {
  const GBuffer& gbuffer;
  const LitPlanes& lit;
  std::vector<Plane> computed = {};  ///< planes for layers that neither of these has
};

/// The planes of a layer's channels, in the G-buffer's layout.
using PlanePointers = std::vector<const float*>;

/// An AOV of a picture, that is a layer of its EXR.
struct AovRow {
  Aov aov;
  const char* name;  ///< for --aov and scripts
  /// The names in the file. None for parts of the light, whose channels LightLayer names.
  std::vector<std::string> channels{};
  /// Finds the channels' planes, or computes them. The picture lacks a channel whose plane is null. No
  /// function: the channels are filled in after startPicture().
  PlanePointers (*planes)(FirstSample&) = nullptr;
  int computed_floats = 0;  ///< that planes() allocates for each pixel
  float initial = 0.0f;     ///< value of the channels before they are filled in
};
inline constexpr std::size_t kAovCount = std::size_t(Aov::kCount);

/// Row i describes Aov(i).
const std::array<AovRow, kAovCount>& aovTable();

inline const AovRow& aovRow(Aov aov) { return aovTable()[std::size_t(aov)]; }

}  // namespace luciole
