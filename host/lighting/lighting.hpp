#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "lighting/draw_maps.hpp"
#include "lighting/kept_shadows.hpp"
#include "lighting/stats.hpp"
#include "lights/cull.hpp"
#include "lights/light_set.hpp"
#include "luciole/scene.hpp"
#include "raster/view.hpp"
#include "shade/features.hpp"
#include "shade/sampled_light.hpp"
#include "shadow/exact/beam_shadows.hpp"

namespace luciole {

/// The largest half width of any vertex's interval, r g b. It holds for each pixel too, because weights of
/// vertices add up to 1 and maps are at most 1.
struct VertexError {
  glm::vec3 bound{0.0f};
  glm::vec3 half_width{0.0f};  ///< of that part of an interval that is sampled
};

/// The lights and shadows of one picture, and the device memory that its passes reuse.
struct Lighting {
  FeatureSet features;
  std::string math_defines;  ///< as by mathDefines
  std::string user_text;     ///< ShadeSettings::user_text
  unsigned group_log2 = 0;   ///< see CullArguments
  bool unlit = false;        ///< Scene::lighting is off: the diffuse colour takes the place of ambient
  MapScene maps;
  BeamScene beams;  ///< with FeatureSet::triangleTree() only
  SampleSettings samples;
  LightSet lights;
  LightLists lists;                         ///< of the last G-buffer that was shaded by lists
  LightLists lists_in_range;                ///< lists by range alone, to count lights in range
  std::optional<VertexError> vertex_error;  ///< with Gouraud shading and an error allowed
};

/// Fills `lighting` for a scene seen by a view of `camera`, and plans the shadow maps that the features need.
/// Draws none. kept: of the picture before this one, or null. Waits, as late as possible, for a device that
/// is still being opened. Adds the times of its stages to `stats`. Throws MachineError, and what opening the
/// device throws.
void prepareLighting(OpenedDevice& device, const Scene& scene, const Camera& camera, const View& view,
                     const FeatureSet& features, const ShadeSettings& settings, Lighting& lighting,
                     Stats& stats, KeptShadows* kept = nullptr);

}  // namespace luciole
