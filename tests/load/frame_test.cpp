#include "load/frame.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "luciole/load_scene.hpp"
#include "luciole/primitives.hpp"
#include "scene/bounds.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

void place(Scene& scene, Mesh mesh, const glm::dvec3& center, const glm::dvec3& scale) {
  glm::dmat4 placement{1.0};
  for (int i = 0; i < 3; ++i) placement[i][i] = scale[i];
  placement[3] = glm::dvec4(center, 1);
  scene.objects.push_back({static_cast<std::uint32_t>(scene.meshes.size()), placement, -1});
  scene.meshes.push_back(std::move(mesh));
}

Mesh box() { return makePrimitive({PrimitiveKind::kBox, 1, 0.25f, 1.0f}, 0); }

Mesh insideOut(Mesh mesh) {
  for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  return mesh;
}

/// A closed hall 40 m long in x, 10 m wide and high, with two rows of columns.
Scene hall(const glm::dvec3& center) {
  Scene scene;
  scene.materials.emplace_back();
  place(scene, insideOut(box()), center, {40, 10, 10});
  for (double x = -15; x <= 15; x += 5) {
    for (double z : {-3.0, 3.0}) place(scene, box(), center + glm::dvec3(x, 0, z), {0.5, 10, 0.5});
  }
  return scene;
}

void expectWholeInPicture(const Scene& scene, const Camera& camera, const std::string& what) {
  const Bounds bounds = sceneBounds(scene);
  const glm::dmat4 to_camera = glm::inverse(camera.camera_to_world);
  const double tangent = std::tan(camera.fov_y / 2);
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 corner{i & 1 ? bounds.high.x : bounds.low.x, i & 2 ? bounds.high.y : bounds.low.y,
                            i & 4 ? bounds.high.z : bounds.low.z};
    const glm::dvec3 p = to_camera * glm::dvec4(corner, 1);
    EXPECT_GT(-p.z, camera.near) << what;
    EXPECT_LT(-p.z, camera.far) << what;
    EXPECT_LT(std::abs(p.y), -p.z * tangent) << what;
    EXPECT_LT(std::abs(p.x), -p.z * tangent * 16 / 9) << what;
  }
}

bool isInsideBounds(const Scene& scene, const Camera& camera) {
  const Bounds bounds = sceneBounds(scene);
  const glm::dvec3 eye = camera.camera_to_world[3];
  return glm::all(glm::greaterThan(eye, bounds.low)) && glm::all(glm::lessThan(eye, bounds.high));
}

TEST(Frame, ObjectsAreWholeInThePictureWhateverTheirSizeAndPlace) {
  for (const glm::dvec3& scale : {glm::dvec3(1), glm::dvec3(1e-6), glm::dvec3(1e6), glm::dvec3(100, 1, 1),
                                  glm::dvec3(1, 100, 1), glm::dvec3(1, 1, 100)}) {
    for (const glm::dvec3& center : {glm::dvec3(0), glm::dvec3(1e5, -2e5, 3e4)}) {
      if (glm::length(center) * 1e-9 > scale.x)
        continue;  // smaller than what places that far out can tell apart
      Scene scene;
      scene.materials.emplace_back();
      place(scene, makePrimitive({PrimitiveKind::kSphere, 16, 0.25f, 1.0f}, 0), center, scale);
      const Framing framing = frameScene(scene);
      EXPECT_FALSE(framing.inside);
      expectWholeInPicture(scene, framing.camera, "scale " + std::to_string(scale.x));
    }
  }
}

TEST(Frame, ClosedHallIsSeenFromInsideAlongItsLength) {
  for (const glm::dvec3& center : {glm::dvec3(0), glm::dvec3(1e5, 0, -1e5)}) {
    const Scene scene = hall(center);
    const Framing framing = frameScene(scene);
    ASSERT_TRUE(framing.inside);
    EXPECT_TRUE(isInsideBounds(scene, framing.camera));
    EXPECT_GT(std::abs(framing.camera.camera_to_world[2].x), 0.9) << "looks along x";
    EXPECT_GT(framing.view_length, 20) << "over more than half of the hall";
    const double height = framing.camera.camera_to_world[3].y - (center.y - 5);
    EXPECT_NEAR(height, 2.5, 1e-3) << "a quarter of 10 m; the tree's floats at 20 m are exact to 2·10⁻⁶ m";
  }
}

TEST(Frame, BoxWithAnOpenSideIsLookedIntoFromThere) {
  for (int axis : {0, 2}) {
    for (double sign : {-1.0, 1.0}) {
      Mesh room = insideOut(box());
      std::erase_if(room.triangles, [&](const glm::uvec3& t) { return room.normals[t.x][axis] == sign; });
      Scene scene;
      scene.materials.emplace_back();
      place(scene, room, {3, 2, 1}, {4, 3, 5});
      const Framing framing = frameScene(scene);
      EXPECT_FALSE(framing.inside);
      EXPECT_GT(sign * framing.camera.camera_to_world[2][axis], 0.999);
      expectWholeInPicture(scene, framing.camera, "open box");
    }
  }
}

TEST(Frame, FlatPictureIsSeenStraightOnFromItsFront) {
  for (double sign : {1.0, -1.0}) {
    Mesh card = box();
    std::erase_if(card.triangles, [&](const glm::uvec3& t) { return card.normals[t.x].z != sign; });
    Scene scene;
    scene.materials.emplace_back();
    place(scene, card, {0, 0, 0}, {2, 1, 0});
    scene.objects[0].object_to_world[2][2] = 1e-9;  // flat, but not singular
    const Framing framing = frameScene(scene);
    EXPECT_EQ(framing.camera.camera_to_world[2], glm::dvec4(0, 0, sign, 0));
    expectWholeInPicture(scene, framing.camera, "card");
  }
}

TEST(Frame, SceneWithoutGeometryStillGetsACamera) {
  Scene scene;
  completeScene(scene, false);
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_TRUE(scene.lights.empty());
}

TEST(Frame, MeshFilesGetLightsAmbientAndSkyAndNothingTheyHaveIsChanged) {
  Scene scene = hall(glm::dvec3(0));
  completeScene(scene, true);
  EXPECT_GT(scene.lights.size(), 1u);
  EXPECT_GT(scene.ambient.r, 0);
  EXPECT_GT(scene.background.b, scene.background.r);

  Scene lit = hall(glm::dvec3(0));
  lit.lights.emplace_back();
  lit.cameras.emplace_back().name = "own";
  completeScene(lit, true);
  EXPECT_EQ(lit.lights.size(), 1u);
  EXPECT_EQ(lit.ambient, glm::vec3(0));
  ASSERT_EQ(lit.cameras.size(), 1u);
  EXPECT_EQ(lit.cameras[0].name, "own");
}

TEST(Frame, SharedObjectsAreWholeInThePicture) {
  LUCIOLE_NEEDS_SHARED();
  for (const char* file :
       {"utah_teapot/teapot.obj", "stanford/stanford-bunny.obj", "stanford/dragon.obj",
        "khronos_DamagedHelmet/glTF/DamagedHelmet.gltf", "khronos_Suzanne/glTF/Suzanne.gltf",
        "khronos_Duck/glTF/Duck.gltf", "cornell_box/CornellBox-Original.obj",
        "khronos_SimpleSparseAccessor/glTF/SimpleSparseAccessor.gltf"}) {
    const Scene scene = loadScene((test::sharedScenes() / file).string());
    const Framing framing = frameScene(scene);
    EXPECT_FALSE(framing.inside) << file;
    expectWholeInPicture(scene, framing.camera, file);
    EXPECT_FALSE(scene.lights.empty()) << file;
  }
}

TEST(Frame, CornellBoxesAreSeenThroughTheirOpenSide) {
  LUCIOLE_NEEDS_SHARED();
  const Scene original = loadScene((test::sharedScenes() / "cornell_box/CornellBox-Original.obj").string());
  EXPECT_EQ(original.cameras[0].camera_to_world[2], glm::dvec4(0, 0, 1, 0));
  const Scene embree = loadScene((test::sharedScenes() / "cornell_box/embree_cornell_box.obj").string());
  EXPECT_EQ(embree.cameras[0].camera_to_world[2], glm::dvec4(0, 0, -1, 0));
}

TEST(Frame, SponzaIsSeenDownItsNaveAndAQuakeLevelFromARoom) {
  LUCIOLE_NEEDS_SHARED();
  const Scene sponza = loadScene((test::sharedScenes() / "sponza_crytek_obj/sponza.obj").string());
  EXPECT_TRUE(isInsideBounds(sponza, sponza.cameras[0]));
  EXPECT_GT(std::abs(sponza.cameras[0].camera_to_world[2].x), 0.95) << "along the nave";
  // The nave's columns stand at z = −220 and 140 (the file's centimetres).
  EXPECT_GT(sponza.cameras[0].camera_to_world[3].z, -220);
  EXPECT_LT(sponza.cameras[0].camera_to_world[3].z, 140);

  for (const char* file : {"quake_e1m1/e1m1.gltf", "quake_e1m1/e1m1.obj"}) {
    const Framing framing = frameScene(loadScene((test::sharedScenes() / file).string()));
    EXPECT_TRUE(framing.inside) << file;
    EXPECT_GT(framing.view_length, 20) << file;
  }
}

}  // namespace
}  // namespace luciole
