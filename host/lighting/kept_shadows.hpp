#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scene/bounds.hpp"
#include "shadow/exact/hole_masks.hpp"
#include "shadow/exact/triangle_tree.hpp"
#include "shadow/maps/shadow_maps.hpp"

namespace luciole {

/// Deformation::pose of each of the scene's deformations.
using ScenePoses = std::vector<std::vector<double>>;

/// Shadow maps and the triangle tree of a picture, for the next picture of the same scene at another pose.
/// They save time and change no bit.
struct KeptShadows {
  std::shared_ptr<TriangleTree> tree;
  std::shared_ptr<const HoleMasks> masks;  ///< of the tree; null where no triangle has holes
  std::vector<Object> tree_objects;        ///< at the pose of the tree
  ScenePoses tree_poses;
  double tree_area = 0;  ///< boxArea() of the tree as it was built

  ShadowMaps maps;
  std::vector<Object> maps_objects;  ///< at the pose of the maps
  ScenePoses maps_poses;
  std::vector<Bounds> maps_bounds;  ///< of each object whose mesh deforms; empty of others
  std::vector<float> maps_ranges;   ///< of the scene's lights
};

/// The result of updateTree().
enum class TreeWork : std::uint8_t { kNone, kRefitted, kBuilt };

/// Brings the tree of `kept` up to date for this scene and origin. Shadows are those of a new tree; only its
/// speed may differ. Does nothing if nothing moved. Refits the tree if objects or the origin moved, or a mesh
/// deformed: blocks hold corners relative to the origin. Builds a new one if there is none, if objects show
/// other meshes, or if the boxes' area has grown by more than a quarter since it was built. holes: masks are
/// needed. Only one picture at a time may use the tree. Throws as buildTriangleTree and makeHoleMasks do.
TreeWork updateTree(const Scene& scene, const glm::dvec3& origin, bool holes, KeptShadows& kept);

/// Moves texels from kept.maps into `maps`, which are planned for the scene at its pose and empty. A face
/// keeps its texels if its view is the same and it shows no object that moved or deformed, neither before nor
/// after. Other faces of the same size keep their place and are drawn anew. If no face keeps its texels, only
/// their memory is reused. Leaves kept.maps empty.
void takeMaps(const Scene& scene, KeptShadows& kept, ShadowMaps& maps);

/// Stores maps for the next picture. The scene is at the pose at which they were drawn.
void keepMaps(const Scene& scene, ShadowMaps maps, KeptShadows& kept);

}  // namespace luciole
