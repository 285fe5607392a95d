#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scene/bounds.hpp"
#include "shadow/exact/hole_masks.hpp"
#include "shadow/exact/triangle_tree.hpp"
#include "shadow/maps/shadow_maps.hpp"

namespace luciole {

/// Of each of the scene's deformations what its mesh shows: Deformation::pose.
using ScenePoses = std::vector<std::vector<double>>;

/// What of a picture's shadows the next picture of the same scene, at another pose, may use. Pictures are the
/// same with and without.
struct KeptShadows {
  std::shared_ptr<TriangleTree> tree;
  std::shared_ptr<const HoleMasks> masks;  ///< of the tree; null where no triangle has holes
  std::vector<Object> tree_objects;        ///< as the tree has them
  ScenePoses tree_poses;
  double tree_area = 0;  ///< boxArea() when the tree was built

  ShadowMaps maps;
  std::vector<Object> maps_objects;  ///< as the maps show them
  ScenePoses maps_poses;
  std::vector<Bounds> maps_bounds;  ///< of each object whose mesh deforms; empty of others
  std::vector<float> maps_ranges;   ///< of the scene's lights
};

/// What it took to bring the tree up to date.
enum class TreeWork : std::uint8_t { kNone, kRefitted, kBuilt };

/// Makes the tree of `kept` what buildTriangleTree would give for this scene and origin, but for its shape,
/// which says how fast it is: nothing where nothing moved, as blocks hold corners relative to the origin; a
/// refit where objects or the origin moved, or a mesh deformed; a new tree where there is none, where objects
/// show other meshes, or where boxes have grown by more than a quarter since it was built. holes: masks are
/// needed. Only one picture at a time may use the tree. Throws as buildTriangleTree and makeHoleMasks do.
TreeWork updateTree(const Scene& scene, const glm::dvec3& origin, bool holes, KeptShadows& kept);

/// Takes what `kept` has drawn into `maps`, which are planned for the scene at its pose and empty: those
/// faces whose views are the same, and that show no object that moved or deformed, as it was or as it is.
/// Other faces of the same size are drawn anew where they lay. Where there is no such face only the memory is
/// taken. kept.maps are of the picture before, and left empty.
void takeMaps(const Scene& scene, KeptShadows& kept, ShadowMaps& maps);

/// Keeps maps for the next picture. The scene is as it was drawn.
void keepMaps(const Scene& scene, ShadowMaps maps, KeptShadows& kept);

}  // namespace luciole
