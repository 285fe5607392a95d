#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared.h"
#include "raster/view.hpp"
#include "scene/bounds.hpp"
#include "scene/scene.hpp"
#include "shadow/shadow_method.hpp"

namespace luciole {

/// What maps are planned for.
struct PlanInput {
  const View& camera;
  ShadowMethod method;
  glm::dmat4 view_to_world;  ///< the camera's
  Bounds bounds;             ///< of the scene, world space
};

/// What a light's map shows: a cascade a face of a directional light, a cone, or the six sides of a cube.
struct PlannedMap {
  ShadowMap lookup{};             ///< but for its faces' indices
  std::vector<ShadowFace> faces;  ///< for lookups: nothing is drawn yet
  std::vector<View> views;        ///< one a face, for drawing
};

/// Whether a shadowed light needs six faces: point lights, and spots too wide for one perspective map.
bool usesCubeMap(const Light& light);

/// How many faces a light's map has, at most.
int facesOf(const Light& light);

/// Texels around a lookup that it may read. So many are drawn around a cone or a cube's face, of `size`
/// texels a side with them, for their sake. Soft shadows may spread over an eighth of what a face shows.
int borderOf(int size, ShadowMethod method);

/// Distance that a light with a place can cast shadows over, in metres: its range, or to the farthest corner
/// of the scene's bounds where that is less. > 0.
double lightReach(const Light& light, const Bounds& scene);

/// The map of a light with a shadow, whose faces have `size` texels a side. A directional light's texels stay
/// where they are in the world while the camera moves, and keep their size while it turns.
PlannedMap planMap(const Light& light, const PlanInput& input, int size);

}  // namespace luciole
