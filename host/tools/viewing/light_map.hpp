#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "luciole/image.hpp"
#include "luciole/scene.hpp"
#include "raster/view.hpp"
#include "shadow/maps/shadow_sizes.hpp"

namespace luciole {

/// A face of a light's shadow map as distances.
struct LightFace {
  std::string name;  ///< "" of a cone; "positive_x" ... of a cube; "cascade0" ... of a directional light
  std::string up;    ///< the axis of the world that is up in it, such as "y"; "" where none is
  std::vector<float> metres;  ///< row-major; how far the surface is, along the face's axis; infinite: nothing
};

/// All of the shadow map of one light.
struct LightMap {
  int size = 0;  ///< texels a side of each face
  std::vector<LightFace> faces;
};

/// Draws all faces of the map that shadows of ShadowMethod::kHard look up for a light with a shadow, in the
/// picture of this view. Of a light with a position, metres are from it; of a directional light from the
/// plane across its direction that touches the scene's bounds first. No faces where the scene has no surface.
/// Throws as planShadowMaps does.
LightMap drawLightMap(const Scene& scene, const View& camera_view, std::uint32_t light,
                      const ShadowLimits& limits);

/// All faces, of which there must be one, in false colours. Of large maps some texels are shown.
Image lightMapPicture(const LightMap& map, const std::string& title);

}  // namespace luciole
