#include "lighting/kept_shadows.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "shadow/maps/frustum.hpp"

namespace luciole {
namespace {

constexpr double kMostGrowth = 1.25;

bool sameMeshes(const std::vector<Object>& a, const std::vector<Object>& b) {
  return std::ranges::equal(
      a, b, [](const Object& x, const Object& y) { return x.mesh == y.mesh && x.material == y.material; });
}

bool sameObject(const Object& a, const Object& b) {
  return a.mesh == b.mesh && a.material == b.material && a.object_to_world == b.object_to_world;
}

bool sameView(const View& a, const View& b) {
  return a.world_to_view == b.world_to_view && a.projection == b.projection && a.size == b.size;
}

ScenePoses posesOf(const Scene& scene) {
  ScenePoses poses;
  for (const Deformation& deformation : scene.animation.deformations) poses.push_back(deformation.pose);
  return poses;
}

/// Whether each mesh deforms.
std::vector<bool> deformingMeshes(const Scene& scene) {
  std::vector<bool> deforms(scene.meshes.size());
  for (const Deformation& deformation : scene.animation.deformations) deforms[deformation.mesh] = true;
  return deforms;
}

/// The bounds of all objects that moved or deformed, each before and after.
std::vector<Bounds> movedBounds(const Scene& scene, const KeptShadows& kept) {
  std::vector<bool> changed(scene.meshes.size());
  const std::vector<Deformation>& deformations = scene.animation.deformations;
  for (std::size_t i = 0; i < deformations.size(); ++i)
    changed[deformations[i].mesh] = deformations[i].pose != kept.maps_poses[i];
  const std::vector<bool> deforms = deformingMeshes(scene);
  std::vector<Bounds> result;
  for (std::size_t i = 0; i < kept.maps_objects.size(); ++i) {
    const Object &before = kept.maps_objects[i], &now = scene.objects[i];
    if (sameObject(before, now) && !changed[now.mesh]) continue;
    result.push_back(deforms[before.mesh] ? kept.maps_bounds[i] : objectBounds(scene, before));
    result.push_back(objectBounds(scene, now));
  }
  return result;
}

/// Whether a view may show something in any of the boxes.
bool showsAny(const View& view, const std::vector<Bounds>& boxes) {
  const auto planes = cropPlanes(view);
  return std::ranges::any_of(boxes, [&](const Bounds& box) {
    if (box.low.x > box.high.x) return false;
    return std::ranges::all_of(planes, [&](const glm::dvec4& plane) {
      const glm::dvec3 corner(plane.x > 0 ? box.high.x : box.low.x, plane.y > 0 ? box.high.y : box.low.y,
                              plane.z > 0 ? box.high.z : box.low.z);
      // Negated, so that boxes with NaN count as shown.
      return !(glm::dot(plane, glm::dvec4(corner, 1)) < 0);
    });
  });
}

/// The faces whose texels are unchanged; none if the maps have other faces.
std::vector<bool> unchangedFaces(const Scene& scene, const KeptShadows& kept, const ShadowMaps& before,
                                 const ShadowMaps& maps) {
  std::vector<bool> same(maps.planned.size());
  if (before.planned.size() != maps.planned.size() || before.method != maps.method ||
      kept.maps_objects.size() != scene.objects.size() || kept.maps_ranges.size() != scene.lights.size() ||
      kept.maps_poses.size() != scene.animation.deformations.size())
    return same;
  const std::vector<Bounds> moved = movedBounds(scene, kept);
  for (std::size_t i = 0; i < same.size(); ++i) {
    const PlannedFace &old = before.planned[i], &face = maps.planned[i];
    same[i] = old.light == face.light && kept.maps_ranges[face.light] == scene.lights[face.light].range &&
              sameView(old.view, face.view) && !showsAny(face.view, moved);
  }
  return same;
}

}  // namespace

TreeWork updateTree(const Scene& scene, const glm::dvec3& origin, bool holes, KeptShadows& kept) {
  if (kept.tree && sameMeshes(kept.tree_objects, scene.objects) && (kept.masks || !holes)) {
    const bool moved = !std::ranges::equal(kept.tree_objects, scene.objects, sameObject) ||
                       kept.tree_poses != posesOf(scene);
    if (!moved && isPlacedFor(scene, origin, *kept.tree)) return TreeWork::kNone;
    kept.tree_objects = scene.objects;
    kept.tree_poses = posesOf(scene);
    refitTriangleTree(scene, origin, *kept.tree);
    if (boxArea(*kept.tree) <= kMostGrowth * kept.tree_area) return TreeWork::kRefitted;
  }
  kept.tree = nullptr;  // freed first, so that memory need not hold both
  kept.masks = nullptr;
  kept.tree = std::make_shared<TriangleTree>(buildTriangleTree(scene, origin));
  if (holes) kept.masks = std::make_shared<const HoleMasks>(makeHoleMasks(scene, *kept.tree));
  kept.tree_objects = scene.objects;
  kept.tree_poses = posesOf(scene);
  kept.tree_area = boxArea(*kept.tree);
  return TreeWork::kBuilt;
}

void takeMaps(const Scene& scene, KeptShadows& kept, ShadowMaps& maps) {
  ShadowMaps before = std::exchange(kept.maps, {});
  maps.texels = std::move(before.texels);
  const std::vector<bool> same = unchangedFaces(scene, kept, before, maps);
  if (std::ranges::none_of(same, [](bool is_same) { return is_same; })) {
    maps.texels.clear();
    return;
  }
  for (std::size_t i = 0; i < maps.planned.size(); ++i) {
    const PlannedFace& old = before.planned[i];
    PlannedFace& face = maps.planned[i];
    if (old.view.size != face.view.size || old.farthest.empty()) continue;
    face.first = old.first;
    face.count = old.count;
    maps.faces[i].first = before.faces[i].first;
    maps.faces[i].width = before.faces[i].width;
    if (same[i])
      face.farthest = old.farthest;
    else
      face.farthest.assign(old.farthest.size(), std::numeric_limits<float>::infinity());
  }
}

void keepMaps(const Scene& scene, ShadowMaps maps, KeptShadows& kept) {
  kept.maps = std::move(maps);
  kept.maps_objects = scene.objects;
  kept.maps_poses = posesOf(scene);
  kept.maps_bounds.assign(scene.objects.size(), {});
  const std::vector<bool> deforms = deformingMeshes(scene);
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    if (deforms[scene.objects[i].mesh]) kept.maps_bounds[i] = objectBounds(scene, scene.objects[i]);
  kept.maps_ranges.clear();
  for (const Light& light : scene.lights) kept.maps_ranges.push_back(light.range);
}

}  // namespace luciole
