#include "lighting/kept_shadows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "luciole/pose.hpp"
#include "shadow/maps/draw_shadow_maps.hpp"
#include "shadow/maps/shadow_scenes.hpp"
#include "shadow/maps/texel_place.hpp"

namespace luciole::test {
namespace {

/// What a tree says of each triangle, whatever its shape.
std::map<std::uint32_t, std::vector<float>> rowsOfTriangles(const TriangleTree& tree) {
  std::map<std::uint32_t, std::vector<float>> rows;
  for (std::size_t block = 0; block < tree.block_bits.size(); ++block)
    for (int slot = 0; slot < kTreeWidth; ++slot) {
      if ((tree.block_bits[block] >> slot & 1) == 0) continue;
      std::vector<float>& of_one = rows[tree.triangles[block * kTreeWidth + slot]];
      for (int row = 0; row < kBlockRows; ++row)
        of_one.push_back(tree.blocks[(block * kBlockRows + row) * kTreeWidth + slot]);
    }
  return rows;
}

void expectTreeOf(const Scene& scene, const glm::dvec3& origin, const KeptShadows& kept) {
  const TriangleTree fresh = buildTriangleTree(scene, origin);
  EXPECT_EQ(kept.tree->origin, fresh.origin);
  EXPECT_EQ(kept.tree->scale, fresh.scale);
  EXPECT_EQ(rowsOfTriangles(*kept.tree), rowsOfTriangles(fresh));
}

TEST(KeptShadows, TheTreeIsKeptWhereNothingMovesAndRefittedWhereSomethingDoes) {
  Scene scene = terrainScene();
  KeptShadows kept;
  EXPECT_EQ(updateTree(scene, glm::dvec3(0), false, kept), TreeWork::kBuilt);
  EXPECT_EQ(updateTree(scene, glm::dvec3(0), false, kept), TreeWork::kNone);
  expectTreeOf(scene, glm::dvec3(0), kept);
  EXPECT_EQ(updateTree(scene, {1, 2, 3}, false, kept), TreeWork::kRefitted) << "the eye moved";
  expectTreeOf(scene, {1, 2, 3}, kept);
  scene.objects.back().object_to_world[3] = {0.1, 0.1, 0, 1};
  EXPECT_EQ(updateTree(scene, {1, 2, 3}, false, kept), TreeWork::kRefitted);
  expectTreeOf(scene, {1, 2, 3}, kept);
}

/// Lets a morph target lift the mesh of the last object by the frame's number less 1.
void liftLastMesh(Scene& scene) {
  Mesh& mesh = scene.meshes[scene.objects.back().mesh];
  RestShape rest;
  rest.positions = mesh.positions;
  rest.normals = mesh.normals;
  rest.first_influence.resize(mesh.positions.size() + 1, 0);
  MorphTarget& target = rest.targets.emplace_back();
  mesh.sources.resize(mesh.positions.size());
  for (std::uint32_t i = 0; i < mesh.sources.size(); ++i) {
    mesh.sources[i] = i;
    target.vertices.push_back(i);
  }
  target.positions.assign(mesh.positions.size(), {0, 1, 0});
  target.normals.assign(mesh.positions.size(), glm::vec3(0));
  target.tangents = target.normals;
  Deformation deformation;
  deformation.mesh = scene.objects.back().mesh;
  deformation.rest = std::make_shared<const RestShape>(std::move(rest));
  deformation.weights = {0};
  deformation.weight_curves = {int(scene.animation.curves.size())};
  scene.animation.curves.push_back({Interpolation::kLinear, {{1, glm::dvec4(0)}, {101, glm::dvec4(100)}}});
  scene.animation.deformations.push_back(std::move(deformation));
}

TEST(KeptShadows, TheTreeIsRefittedWhereAMeshDeforms) {
  Scene scene = terrainScene();
  liftLastMesh(scene);
  poseScene(scene, 1);
  KeptShadows kept;
  EXPECT_EQ(updateTree(scene, glm::dvec3(0), false, kept), TreeWork::kBuilt);
  poseScene(scene, 1.1);
  EXPECT_EQ(updateTree(scene, glm::dvec3(0), false, kept), TreeWork::kRefitted);
  expectTreeOf(scene, glm::dvec3(0), kept);
  poseScene(scene, 1.1);
  EXPECT_EQ(updateTree(scene, glm::dvec3(0), false, kept), TreeWork::kNone) << "the same pose";
}

TEST(KeptShadows, ALightThatChangesTheTreesScaleRefitsIt) {
  Scene scene = terrainScene();
  KeptShadows kept;
  updateTree(scene, glm::dvec3(0), false, kept);
  scene.lights[1].position.x = 1e15;
  EXPECT_EQ(updateTree(scene, glm::dvec3(0), false, kept), TreeWork::kRefitted);
  expectTreeOf(scene, glm::dvec3(0), kept);
}

TEST(KeptShadows, ATreeWhoseBoxesHaveGrownIsBuiltAnew) {
  // Two copies side by side share no block. Where they pass through each other, boxes are as large as both.
  Scene scene = terrainScene();
  scene.objects.push_back(scene.objects.back());
  KeptShadows kept;
  updateTree(scene, glm::dvec3(0), false, kept);
  scene.objects.back().object_to_world[3] = {40, 0, 0, 1};
  EXPECT_EQ(updateTree(scene, glm::dvec3(0), false, kept), TreeWork::kBuilt);
  expectTreeOf(scene, glm::dvec3(0), kept);
  EXPECT_EQ(updateTree(scene, glm::dvec3(0), false, kept), TreeWork::kNone) << "it isn't built for ever";
}

TEST(KeptShadows, ATreeOfOtherMeshesOrMaterialsIsBuiltAnew) {
  Scene scene = terrainScene();
  KeptShadows kept;
  updateTree(scene, glm::dvec3(0), false, kept);
  std::swap(scene.objects[0].mesh, scene.objects[1].mesh);
  EXPECT_EQ(updateTree(scene, glm::dvec3(0), false, kept), TreeWork::kBuilt);
  scene.materials.push_back(scene.materials.front());
  scene.objects[0].material = int(scene.materials.size()) - 1;
  EXPECT_EQ(updateTree(scene, glm::dvec3(0), false, kept), TreeWork::kBuilt);
  scene.objects.pop_back();
  EXPECT_EQ(updateTree(scene, glm::dvec3(0), false, kept), TreeWork::kBuilt);
  expectTreeOf(scene, glm::dvec3(0), kept);
}

/// Faces of which something was drawn.
std::size_t facesDrawn(const ShadowMaps& maps) {
  return std::size_t(std::ranges::count_if(maps.planned, [](const PlannedFace& face) {
    return std::ranges::any_of(face.farthest, [](float depth) { return std::isfinite(depth); });
  }));
}

/// Every texel that was drawn is the one of maps that are drawn afresh.
void expectMapsOf(const Scene& scene, const ShadowMaps& maps) {
  ShadowMaps fresh = planFor(scene);
  drawNeeded(scene, everything(fresh), fresh);
  for (std::size_t f = 0; f < maps.planned.size(); ++f)
    for (int y = 0; y < maps.planned[f].view.size.y; ++y)
      for (int x = 0; x < maps.planned[f].view.size.x; ++x) {
        if (!std::isfinite(drawnDownTo(maps, f, {x, y}))) continue;
        const ShadowTexel a = texelOf(maps, f, x, y), b = texelOf(fresh, f, x, y);
        ASSERT_TRUE(a.depth == b.depth && a.slopes == b.slopes) << "face " << f << " at " << x << ',' << y;
      }
}

/// Draws all of a scene's maps, keeps them, lets `change` change the scene, and returns the maps planned for
/// it that have taken what they can.
template <class Change>
ShadowMaps takenAfter(Scene& scene, Change change) {
  ShadowMaps maps = planFor(scene);
  drawNeeded(scene, everything(maps), maps);
  KeptShadows kept;
  keepMaps(scene, std::move(maps), kept);
  change();
  ShadowMaps next = planFor(scene);
  takeMaps(scene, kept, next);
  expectMapsOf(scene, next);
  EXPECT_TRUE(kept.maps.texels.empty());
  return next;
}

TEST(KeptShadows, MapsOfASceneThatStandsStillAreTaken) {
  Scene scene = terrainScene();
  ShadowMaps maps = takenAfter(scene, [] {});
  EXPECT_EQ(facesDrawn(maps), maps.planned.size());
  EXPECT_TRUE(drawNeeded(scene, everything(maps), maps).empty());
}

TEST(KeptShadows, FacesThatShowAnObjectThatMovedAreDrawnAgain) {
  Scene scene = terrainScene();
  Object small = scene.objects.back();
  small.object_to_world = glm::scale(glm::dmat4(1), glm::dvec3(0.01));
  small.object_to_world[3] = {-3, 0.5, 2, 1};  // below the lamp whose range is 5
  scene.objects.push_back(small);
  ShadowMaps maps = takenAfter(scene, [&] { scene.objects.back().object_to_world[3].x += 0.2; });
  const std::size_t taken = facesDrawn(maps);
  EXPECT_GT(taken, 0u);
  EXPECT_LT(taken, maps.planned.size());
  EXPECT_FALSE(drawNeeded(scene, everything(maps), maps).empty());
  EXPECT_EQ(facesDrawn(maps), maps.planned.size());
  EXPECT_EQ(maps.texels.size(), maps.planned_texels) << "they lie where they lay";
  expectMapsOf(scene, maps);
}

TEST(KeptShadows, FacesThatShowAMeshThatDeformedAreDrawnAgain) {
  Scene scene = terrainScene();
  Object small = scene.objects.back();
  small.mesh = std::uint32_t(scene.meshes.size());
  scene.meshes.push_back(scene.meshes.back());
  small.object_to_world = glm::scale(glm::dmat4(1), glm::dvec3(0.01));
  small.object_to_world[3] = {-3, 0.5, 2, 1};  // below the lamp whose range is 5
  scene.objects.push_back(small);
  liftLastMesh(scene);
  poseScene(scene, 1);
  // 20 of its metres up: beyond the box where it was.
  ShadowMaps maps = takenAfter(scene, [&] { poseScene(scene, 21); });
  const std::size_t taken = facesDrawn(maps);
  EXPECT_GT(taken, 0u);
  EXPECT_LT(taken, maps.planned.size());
  drawNeeded(scene, everything(maps), maps);
  expectMapsOf(scene, maps);
  EXPECT_EQ(facesDrawn(takenAfter(scene, [&] { poseScene(scene, 21); })), maps.planned.size()) << "same pose";
}

TEST(KeptShadows, OnlyTheFacesOfALightThatMovedAreDrawnAgain) {
  Scene scene = terrainScene();
  const ShadowMaps maps = takenAfter(scene, [&] { scene.lights[2].position.x += 0.01; });
  EXPECT_EQ(facesDrawn(maps), maps.planned.size() - 6);
}

TEST(KeptShadows, MapsOfAnotherMethodOrOtherLightsAreNotTaken) {
  Scene scene = terrainScene();
  EXPECT_EQ(facesDrawn(takenAfter(scene, [&] { scene.lights.pop_back(); })), 0u);
  scene = terrainScene();
  EXPECT_EQ(facesDrawn(takenAfter(scene, [&] { scene.objects.pop_back(); })), 0u);
}

}  // namespace
}  // namespace luciole::test
