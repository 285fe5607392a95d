#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "kernels/shared.h"
#include "luciole/scene.hpp"
#include "luciole/settings.hpp"
#include "raster/view.hpp"
#include "scene/bounds.hpp"

namespace luciole {

/// The input of planning maps. It refers to the camera's view.
struct PlanInput {
  const View& camera;
  ShadowMethod method;
  glm::dmat4 view_to_world;              ///< the camera's
  Bounds bounds;                         ///< of the scene, world space
  std::span<const ShadowWay> ways = {};  ///< of each light; empty: all lights with a shadow have maps
};

/// A light's map: a face for each cascade of a directional light, for a cone, or for the six sides of a cube.
struct PlannedMap {
  ShadowMap lookup{};             ///< but for its faces' indices
  std::vector<ShadowFace> faces;  ///< for lookups: nothing is drawn yet
  std::vector<View> views;        ///< one a face, for drawing
};

/// Whether a shadowed light needs six faces: point lights, and spots too wide for one perspective map.
bool usesCubeMap(const Light& light);

/// How many faces a light's map has, at most.
int facesOf(const Light& light);

/// The width in texels of the border of a face of `size` texels a side, border included: how far around its
/// point a lookup may read. For soft shadows it is an eighth of the face without border, at most 64 texels;
/// otherwise 4.
int borderOf(int size, ShadowMethod method);

/// How far a light with a position can cast shadows, in metres, > 0: its range, or a little more than the
/// distance to the farthest corner of the scene's bounds if that is less.
double lightReach(const Light& light, const Bounds& scene);

/// The map of a light with a shadow, whose faces have `size` texels a side. A directional light's texels stay
/// where they are in the world while the camera moves, and keep their size while it turns.
PlannedMap planMap(const Light& light, const PlanInput& input, int size);

}  // namespace luciole
