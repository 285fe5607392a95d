#include "shadow/maps/find_needed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"
#include "lighting/light_gbuffer.hpp"
#include "shadow/maps/draw_shadow_maps.hpp"
#include "shadow/maps/texel_place.hpp"

namespace luciole::test {
namespace {

constexpr glm::ivec2 kOddSize{147, 93};

/// Many triangles of all sizes under shadowed lights of every kind, some of them behind the camera.
Scene crowdedScene(bool orthographic, Random& random) {
  Camera camera = randomCamera(random);
  camera.orthographic = orthographic;
  camera.half_height = 10;
  Scene scene = randomScene(camera, 14, random);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    Light& light = scene.lights[i];
    light.shadow = i % 7 != 6;
    light.cutoff = glm::radians(i % 2 ? 40.0 : 75.0);
    light.inner_cone = 0.5 * light.cutoff;
    if (i % 3 == 0) light.range = float(random.between(5, 20));
  }
  Mesh mesh;
  for (std::uint32_t i = 0; i < 400; ++i) {
    const glm::vec3 corner(random.between(-10, 10), random.between(-10, 10), random.between(-30, -2));
    for (int c = 0; c < 3; ++c)
      mesh.positions.push_back(corner + float(i % 20 == 0 ? 8 : 1) * glm::vec3(random.direction()));
    mesh.normals.resize(mesh.positions.size(), glm::vec3(0, 0, 1));
    mesh.triangles.push_back(glm::uvec3(3 * i, 3 * i + 1, 3 * i + 2));
    mesh.triangle_materials.push_back(0);
  }
  scene.materials.resize(1);
  scene.materials[0].double_sided = true;
  scene.meshes.push_back(mesh);
  scene.objects.push_back({std::uint32_t(scene.meshes.size() - 1), camera.camera_to_world, -1});
  scene.cameras = {camera};
  return scene;
}

ShadeSettings shadeSettings(Culling culling, ShadowMethod method) {
  ShadeSettings settings;
  settings.culling = culling;
  settings.shadows = method;
  settings.shadow_layer = true;
  settings.shadow_limits.size = 256;
  return settings;
}

/// A scene, its G-buffer, and its lights on a device.
struct Prepared {
  Prepared(OpenedDevice& device, const Scene& scene_, const ShadeSettings& settings) : scene(scene_) {
    const Camera& camera = scene.cameras.front();
    const View view = cameraView(camera, kOddSize);
    features = neededFeatures(scene, camera, materialTraits(scene), settings);
    gbuffer = rasterize(scene, allObjects(scene), view, Shading::kFlat, neededPlanes(features));
    prepareLighting(device, scene, camera, view, features, settings, lighting, stats);
  }
  Plane light(OpenedDevice& device) {
    return lightGBuffer(device, scene, lighting, {lighting.lights, features, gbuffer}, stats).color;
  }

  void drawEverything(OpenedDevice& device) {
    ShadowMaps& maps = lighting.maps.host;
    giveBack(lighting.maps.faces);
    const std::vector<IndexRange> drawn = drawNeeded(scene, everything(maps), maps);
    const std::vector<IndexRange> faces{{0, maps.faces.size()}};
    refresh(device, maps.faces, faces, lighting.maps.faces);
    refresh(device, maps.texels, drawn, lighting.maps.texels);
  }

  const Scene& scene;
  FeatureSet features;
  GBuffer gbuffer;
  Lighting lighting;
  Stats stats;
};

bool reaches(const Light& light, const glm::dvec3& point, const glm::dvec3& normal) {
  const bool placed = light.kind != LightKind::kDirectional;
  const glm::dvec3 way = placed ? light.position - point : -light.direction;
  if (placed && glm::length(way) >= light.range) return false;
  if (light.kind == LightKind::kSpot &&
      glm::dot(glm::normalize(-way), light.direction) <= std::cos(light.cutoff))
    return false;
  return glm::dot(way, normal) > 0;
}

/// Metres by which a point may be elsewhere for the kernel: positions round to floats of up to 60 m, and so
/// do the sums that take them to a face, 16 times in all.
constexpr double kMoved = 16 * 0x1p-24 * 60;

TEST(FindNeeded, EveryTexelThatALookupReadsIsDrawn) {
  Random random(3);
  for (const bool orthographic : {false, true})
    for (const Culling culling : {Culling::kTiles, Culling::kNone})
      for (const int lanes : {1, 16}) {
        OpenedDevice& device = deviceWithLanes(lanes);
        const Scene scene = crowdedScene(orthographic, random);
        Prepared prepared(device, scene, shadeSettings(culling, ShadowMethod::kPcf));
        prepared.light(device);
        const ShadowMaps& maps = prepared.lighting.maps.host;
        const GBuffer& gbuffer = prepared.gbuffer;
        const glm::dmat4& to_world = scene.cameras.front().camera_to_world;
        std::size_t checked = 0;
        for (std::size_t i = 0; i < gbuffer.pixels(); ++i) {
          const auto at = [&](const Plane& plane) {
            return glm::dvec3(plane[i], plane[gbuffer.pixels() + i], plane[2 * gbuffer.pixels() + i]);
          };
          if (!std::isfinite(at(gbuffer.position).z)) continue;
          const glm::dvec3 point(to_world * glm::dvec4(at(gbuffer.position), 1)),
              normal(to_world * glm::dvec4(at(gbuffer.normal), 0));
          for (std::size_t l = 0; l < scene.lights.size(); ++l) {
            if (maps.map_of_light[l] == kNoShadow || !reaches(scene.lights[l], point, normal)) continue;
            const auto place = placeOf(maps, maps.maps[maps.map_of_light[l]], point);
            // Where two faces meet, rounding chooses.
            if (!place || place->from_limit < 0.01) continue;
            // The widest filter reads two texels to each side of the one that holds the lookup.
            const glm::ivec2 texel(glm::floor(place->texel));
            for (const int dx : {-2, 2})
              for (const int dy : {-2, 2})
                ASSERT_LE(drawnDownTo(maps, place->face, texel + glm::ivec2(dx, dy)),
                          place->depth + kMoved * place->depth_step)
                    << "pixel " << i << ", light " << l << ", face " << place->face << ", " << lanes
                    << " lanes";
            ++checked;
          }
        }
        EXPECT_GT(checked, 1000u);
        // Or all might have been drawn for nothing.
        EXPECT_LT(maps.texels.size(), maps.planned_texels);
      }
}

TEST(FindNeeded, PictureIsTheSameAsWithEveryTexelDrawn) {
  Random random(5);
  for (const bool orthographic : {false, true})
    for (const Culling culling : {Culling::kTiles, Culling::kNone})
      for (const ShadowMethod method : {ShadowMethod::kHard, ShadowMethod::kPcf})
        for (const int lanes : {1, 16}) {
          OpenedDevice& device = deviceWithLanes(lanes);
          const Scene scene = crowdedScene(orthographic, random);
          Prepared some(device, scene, shadeSettings(culling, method)),
              all(device, scene, shadeSettings(culling, method));
          all.drawEverything(device);
          const Plane a = some.light(device), b = all.light(device);
          EXPECT_EQ(a, b) << lanes << " lanes";
          EXPECT_LT(some.lighting.maps.host.texels.size(), all.lighting.maps.host.texels.size());
        }
}

TEST(FindNeeded, NothingThatIsSeenNeedsNothing) {
  Random random(7);
  OpenedDevice& device = deviceWithLanes(16);
  Scene scene = crowdedScene(false, random);
  // From outside, looking away.
  scene.cameras.front().camera_to_world =
      scene.cameras.front().camera_to_world * glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -100));
  Prepared prepared(device, scene, shadeSettings(Culling::kTiles, ShadowMethod::kPcf));
  prepared.light(device);
  EXPECT_FALSE(prepared.lighting.maps.host.maps.empty());
  EXPECT_TRUE(prepared.lighting.maps.host.texels.empty());
}

// So that a picture with other fog or another model, or filtered otherwise, waits for no compiler a second
// time.
TEST(FindNeeded, ScenesThatCastAlikeShareItsProgram) {
  Random random(7);
  Scene scene = crowdedScene(false, random);
  OpenedDevice& device = deviceWithLanes(4);
  const auto programs = [&] {
    return std::count_if(device.programs.begin(), device.programs.end(),
                         [](const auto& program) { return program.first.ends_with("maps/find_needed.cl"); });
  };
  Prepared(device, scene, shadeSettings(Culling::kTiles, ShadowMethod::kHard)).light(device);
  const auto before = programs();
  EXPECT_GT(before, 0);
  scene.fog = {.mode = FogMode::kExp, .density = glm::vec3(0.01f)};
  ShadeSettings others = shadeSettings(Culling::kTiles, ShadowMethod::kPcf);
  others.model = Model::kToon;
  others.pcf_width = 4;
  Prepared(device, scene, others).light(device);
  EXPECT_EQ(programs(), before);
}

}  // namespace
}  // namespace luciole::test
