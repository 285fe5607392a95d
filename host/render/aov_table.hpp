#pragma once

#include <array>
#include <string>
#include <vector>

#include "lighting/light_gbuffer.hpp"
#include "luciole/gbuffer.hpp"
#include "render/render.hpp"

namespace luciole {

/// What is known of a picture's first sample, from which most layers are filled.
struct FirstSample {
  const GBuffer& gbuffer;
  const LitPlanes& lit;
  Plane world_position, world_normal, depth;  ///< of the G-buffer's points, with a row of `in_world` only
  Plane all_visible;                          ///< ones, with Aov::kShadow only
};

/// Where the channels of a layer lie: planes in the G-buffer's layout.
using ChannelPlaces = std::vector<const float*>;

struct AovRow {
  Aov aov;
  const char* name;                     ///< as people type it
  std::vector<std::string> channels{};  ///< in the file; none for parts of the light: LightLayer names theirs
  /// The channels' places. A null one isn't in the picture. Without this function they are filled in later.
  ChannelPlaces (*places)(const FirstSample&) = nullptr;
  bool in_world = false;   ///< asks for FirstSample's places and directions in world space
  float otherwise = 0.0f;  ///< until they are filled in
};
inline constexpr std::size_t kAovCount = std::size_t(Aov::kCount);

/// Row i describes Aov(i).
const std::array<AovRow, kAovCount>& aovTable();

inline const AovRow& aovRow(Aov aov) { return aovTable()[std::size_t(aov)]; }

}  // namespace luciole
