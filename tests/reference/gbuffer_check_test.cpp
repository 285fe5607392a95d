// G-buffers against primary rays, in this project's own scenes and the shared ones.
#include "reference/gbuffer_check.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "raster/rasterize.hpp"
#include "reference/reference.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

struct Seen {
  Scene scene;
  View view;
  GBuffer gbuffer;
};

Seen see(const Scene& scene, glm::ivec2 size) {
  Seen seen{scene, cameraView(scene.cameras.front(), size), {}};
  seen.gbuffer = rasterize(seen.scene, allObjects(seen.scene), seen.view, Shading::kPhong, {.lift = true});
  return seen;
}

GBufferCheck check(const Seen& seen) {
  return checkGBuffer(seen.scene, seen.view, seen.gbuffer,
                      allPixels({seen.gbuffer.width, seen.gbuffer.height}));
}

/// Positions are stored as floats, each coordinate within 2^-24 of itself: 6e-8 of the distance. A normal's
/// three roundings turn it by 1e-7.
void expectRight(const std::string& path) {
  const Seen seen = see(loadScene(path), {480, 270});
  const GBufferCheck result = check(seen);
  fmt::print("position {:.1e}, normal {:.1e} rad; of {} pixels {} beside edges, {} at ties, {} unexplained\n",
             result.position_error, result.normal_error, result.pixels, result.beside_edges, result.at_ties,
             result.unexplained);
  EXPECT_EQ(result.pixels, 480u * 270u);
  EXPECT_LE(result.position_error, 1e-7);
  EXPECT_LE(result.normal_error, 2e-7);
  // A lift is shorter than the way from the eye, and rounded once, too.
  EXPECT_LE(result.lift_error, 1e-7);
  EXPECT_EQ(result.unexplained, 0u) << "such as at " << result.worst_pixel.x << ", " << result.worst_pixel.y;
}

class GBufferOf : public testing::TestWithParam<const char*> {};
TEST_P(GBufferOf, ShowsWhatPrimaryRaysMeet) {
  expectRight(fmt::format("{}/scenes/{}.json", LUCIOLE_SOURCE_DIR, GetParam()));
}
INSTANTIATE_TEST_SUITE_P(Scenes, GBufferOf,
                         testing::Values("fireflies", "underwater", "colonnade", "city", "spheres",
                                         "cornell"));

class GBufferOfShared : public testing::TestWithParam<const char*> {};
TEST_P(GBufferOfShared, ShowsWhatPrimaryRaysMeet) {
  LUCIOLE_NEEDS_SHARED();
  expectRight((sharedScenes() / GetParam()).string());
}
INSTANTIATE_TEST_SUITE_P(Scenes, GBufferOfShared,
                         testing::Values("sponza_crytek_obj/sponza.obj", "quake_e1m1/e1m1.gltf"));

TEST(GBufferCheck, KnowsWhatAPictureLeavesOut) {
  // An invisible ball before a mirrored torus and a box around the camera whose near faces are turned away.
  const char* objects = R"("materials": {"air": {"alpha": 0.3, "alpha_cutoff": 0.5}},
    "objects": [{"primitive": "sphere", "translate": [0, 0, 2], "material": "air"},
                {"primitive": "torus", "scale": [-1.5, 1, 1], "rotate": [70, 10, 0]},
                {"primitive": "box", "scale": [-9, 9, 9]}]})";
  for (const char* kind : {"\"fov_y\": 60", "\"orthographic\": 3",
                           "\"fov_y\": 60, \"shift\": [0.3, -0.2], \"pixel_aspect\": 1.1",
                           "\"orthographic\": 3, \"shift\": [-0.2, 0.1], \"pixel_aspect\": 0.9"}) {
    const Seen seen =
        see(sceneFromJson(std::string(R"({"camera": {"eye": [1, 2, 4], "target": [0, 0, 0], )") + kind +
                          "}, " + objects),
            {160, 90});
    const GBufferCheck result = check(seen);
    EXPECT_EQ(result.unexplained, 0u) << kind;
    EXPECT_LT(result.beside_edges, 160u) << kind;
    EXPECT_LE(result.position_error, 1e-7) << kind;
    EXPECT_GT(result.position_error, 0) << kind;
    EXPECT_LE(result.lift_error, 1e-7) << kind;
    EXPECT_GT(result.lift_error, 0) << kind;
  }
}

TEST(GBufferCheck, FindsWhatIsWrong) {
  Seen seen = see(sceneFromJson(R"({"camera": {"eye": [0, 2, 4], "target": [0, 0, 0]},
                                    "objects": [{"primitive": "plane", "scale": 100}]})"),
                  {64, 36});
  const std::size_t n = seen.gbuffer.pixels();
  EXPECT_EQ(check(seen).unexplained, 0u);

  const std::size_t moved = seen.gbuffer.index(20, 30), turned = seen.gbuffer.index(40, 30),
                    lost = seen.gbuffer.index(50, 30), near = seen.gbuffer.index(10, 30);
  seen.gbuffer.position[moved] += 1e-4f;
  EXPECT_EQ(check(seen).unexplained, 1u);
  EXPECT_EQ(check(seen).worst_pixel, glm::ivec2(20, 30));
  seen.gbuffer.normal[turned] += 1e-3f;
  EXPECT_EQ(check(seen).unexplained, 2u);
  seen.gbuffer.position[lost + 2 * n] = -std::numeric_limits<float>::infinity();
  EXPECT_EQ(check(seen).unexplained, 3u);
  // Small errors are measured: 8e-7 of the distance.
  const glm::vec3 place(seen.gbuffer.position[near], seen.gbuffer.position[near + n],
                        seen.gbuffer.position[near + 2 * n]);
  seen.gbuffer.position[near] += 8e-7f * glm::length(place);
  EXPECT_EQ(check(seen).unexplained, 3u);
  EXPECT_NEAR(check(seen).position_error, 8e-7, 2e-7) << "two roundings of 6e-8 and one of the sum";
}

/// A bent normal may be off by what kSameBentNormal in gbuffer_check.cpp allows for, at worst; a map of these
/// has far less contrast.
TEST(GBufferCheck, KnowsNormalsThatAMapBends) {
  LUCIOLE_NEEDS_SHARED();
  const Seen seen =
      see(loadScene((sharedScenes() / "khronos_DamagedHelmet/glTF-Binary/DamagedHelmet.glb").string()),
          {480, 270});
  const GBufferCheck result = check(seen);
  EXPECT_EQ(result.unexplained, 0u) << "such as at " << result.worst_pixel.x << ", " << result.worst_pixel.y;
  EXPECT_GT(result.bent_normal_error, 0);
  EXPECT_LE(result.bent_normal_error, 8e-3);
}

}  // namespace
}  // namespace luciole::test
