#include "shadow/shadow_maps.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "base/error.hpp"
#include "raster/rasterize.hpp"
#include "render_json.hpp"
#include "shadow/texel_place.hpp"

namespace luciole::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

void askForShadows(RenderSettings& settings) { settings.aovs = {Aov::kShadow, Aov::kPosition, Aov::kDepth}; }

/// Pixels of the shadow layer darker than fully lit, where something was hit.
int darkPixels(const Image& image) {
  const std::size_t shadow = channelIndex(image, "shadow"), channels = image.channels.size();
  int dark = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += channels) dark += image.pixels[i + shadow] < 1.0f;
  return dark;
}

std::string planeScene(const std::string& light) {
  return fmt::format(R"({{"camera": {{"eye": [0, 3, 6], "target": [0, 0, 0]}},
    "objects": [{{"primitive": "plane", "scale": 20}}], "lights": [{}]}})",
                     light);
}

TEST(ShadowMaps, PlaneUnderTheSunHasNoAcneAtAnyAngle) {
  for (const auto method : {ShadowMethod::kHard, ShadowMethod::kPcf})
    for (const double degrees : {0.0, 10.0, 30.0, 45.0, 60.0, 75.0, 80.0, 84.0}) {
      const double angle = degrees * kPi / 180;
      const std::string light =
          fmt::format(R"({{"type": "directional", "direction": [{}, {}, {}], "shadow": true}})",
                      std::sin(angle) * 0.8, -std::cos(angle), std::sin(angle) * 0.6);
      const Image image = renderJson(planeScene(light), {160, 90}, [&](RenderSettings& settings) {
        askForShadows(settings);
        settings.shade.shadows = method;
      });
      EXPECT_EQ(darkPixels(image), 0) << degrees << " degrees";
    }
}

TEST(ShadowMaps, PlaneUnderSpotsAndPointLightsHasNoAcne) {
  for (const auto method : {ShadowMethod::kHard, ShadowMethod::kPcf})
    for (const char* light :
         {R"({"type": "point", "position": [0, 2, 0], "shadow": true})",
          R"({"type": "point", "position": [3, 0.4, 1], "range": 30, "shadow": true})",
          R"({"type": "spot", "position": [2, 3, 1], "target": [0, 0, 0], "cutoff": 40, "shadow": true})",
          R"({"type": "spot", "position": [2, 1, 1], "target": [0, 0, 0], "cutoff": 85, "shadow": true})"}) {
      const Image image = renderJson(planeScene(light), {160, 90}, [&](RenderSettings& settings) {
        askForShadows(settings);
        settings.shade.shadows = method;
      });
      EXPECT_EQ(darkPixels(image), 0) << light;
    }
}

TEST(ShadowMaps, RoomAroundAPointLightIsLitWithoutSeams) {
  const Image image =
      renderJson(R"({"camera": {"eye": [0.5, 0.3, 0.9], "target": [-1, -0.4, -1], "fov_y": 100},
    "materials": {"wall": {"double_sided": true}},
    "objects": [{"primitive": "box", "scale": 4, "material": "wall"}],
    "lights": [{"type": "point", "position": [0.1, 0.2, 0], "shadow": true}]})",
                 {256, 144}, askForShadows);
  // Where walls meet too: a bend towards the light never shadows itself.
  const std::size_t channels = image.channels.size(), shadow = channelIndex(image, "shadow");
  for (std::size_t i = 0; i < image.pixels.size(); i += channels)
    EXPECT_EQ(image.pixels[i + shadow], 1.0f) << "pixel " << i / channels;
}

/// A square of side 1 hovers at height 1 over a plane; what it hides from the light is known by similar
/// triangles.
struct HoverCase {
  const char* name;
  const char* light;
  double low, high;  ///< the shadow on the plane: [low, high]² in x and z
};

class HoveringSquare : public testing::TestWithParam<HoverCase> {};

TEST_P(HoveringSquare, ShadowFallsWhereGeometrySaysWithinTexels) {
  const HoverCase& hover = GetParam();
  const std::string json =
      fmt::format(R"({{"camera": {{"eye": [0, 6, 0.01], "target": [0, 0, 0], "up": [0, 0, -1], "fov_y": 40}},
    "materials": {{"m": {{"double_sided": true}}}},
    "objects": [{{"primitive": "plane", "scale": 8}}, {{"primitive": "plane", "translate": [0, 1, 0], "material": "m"}}],
    "lights": [{}]}})",
                  hover.light);
  const Scene scene = sceneFromJson(json);
  const ShadowMaps maps =
      planShadowMaps(scene, cameraView(scene.cameras.front(), {128, 128}), ShadowMethod::kPcf, {});
  // The lookup's filter reaches the centres of texels one away along either axis, which are those of x and z
  // here. The floor sees the coarsest cascade at the most, and other lights from 4 m.
  double side = 0;
  for (const ShadowFace& face : maps.faces)
    side = std::max(side, (maps.maps.front().kind == kParallelMap ? 1 : 4) / double(face.scale));
  const double blur = side * 1.01;
  EXPECT_LT(blur, 6 * 2 * std::tan(20 * kPi / 180) / 128);  // a pixel on the floor
  const Image image = renderJson(json, {128, 128}, askForShadows);
  const std::size_t channels = image.channels.size(), shadow = channelIndex(image, "shadow"),
                    place = channelIndex(image, "P.X");
  int checked = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += channels) {
    const float x = image.pixels[i + place], y = image.pixels[i + place + 1], z = image.pixels[i + place + 2];
    if (y > 0.5f || !std::isfinite(image.pixels[i + channelIndex(image, "Z")]))
      continue;  // the square itself
    const double inside =
        std::min(std::min(x - hover.low, hover.high - x), std::min(z - hover.low, hover.high - z));
    if (std::abs(inside) < blur) continue;
    EXPECT_EQ(image.pixels[i + shadow], inside > 0 ? 0.0f : 1.0f) << x << " " << z;
    ++checked;
  }
  EXPECT_GT(checked, 128 * 128 / 2);
}

INSTANTIATE_TEST_SUITE_P(
    Lights, HoveringSquare,
    testing::Values(
        HoverCase{"Sun", R"({"type": "directional", "direction": [0, -1, 0], "shadow": true})", -0.5, 0.5},
        HoverCase{
            "Spot",
            R"({"type": "spot", "position": [0, 4, 0], "direction": [0, -1, 0], "cutoff": 35, "shadow": true})",
            -0.5 * 4 / 3, 0.5 * 4 / 3},
        HoverCase{"Point", R"({"type": "point", "position": [0, 4, 0], "shadow": true})", -0.5 * 4 / 3,
                  0.5 * 4 / 3}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(ShadowMaps, AlphaMaskedHolesLetLightThrough) {
  // A hovering square whose opacity is below the cutoff casts nothing.
  const Image image = renderJson(R"({"camera": {"eye": [0, 6, 0.01], "target": [0, 0, 0], "up": [0, 0, -1]},
    "materials": {"gone": {"alpha": 0.2, "alpha_cutoff": 0.5}},
    "objects": [{"primitive": "plane", "scale": 8}, {"primitive": "plane", "translate": [0, 1, 0], "material": "gone"}],
    "lights": [{"type": "directional", "direction": [0, -1, 0], "shadow": true}]})",
                                 {64, 64}, askForShadows);
  EXPECT_EQ(darkPixels(image), 0);
}

/// A terrain of many runs of triangles under a light of each kind.
Scene terrainScene() {
  Scene scene =
      sceneFromJson(planeScene(R"({"type": "directional", "direction": [1, -2, 0.3], "shadow": true},
    {"type": "point", "position": [1, 2, -1], "shadow": true},
    {"type": "point", "position": [-3, 1, 2], "range": 5, "shadow": true},
    {"type": "spot", "position": [2, 4, 1], "target": [0, 0, 0], "cutoff": 40, "shadow": true})"));
  constexpr std::uint32_t kCells = 60;
  Mesh mesh;
  for (std::uint32_t z = 0; z <= kCells; ++z)
    for (std::uint32_t x = 0; x <= kCells; ++x)
      mesh.positions.push_back(
          {0.2f * x - 6, 0.6f * std::sin(0.9f * x) * std::cos(0.7f * z) + 0.2f, 0.2f * z - 6});
  for (std::uint32_t z = 0; z < kCells; ++z)
    for (std::uint32_t x = 0; x < kCells; ++x) {
      const std::uint32_t a = z * (kCells + 1) + x, b = a + kCells + 1;
      mesh.triangles.push_back({a, b, a + 1});
      mesh.triangles.push_back({b, b + 1, a + 1});
    }
  mesh.normals.assign(mesh.positions.size(), {0, 1, 0});
  mesh.triangle_materials.assign(mesh.triangles.size(), 0);
  Object object;
  object.mesh = std::uint32_t(scene.meshes.size());
  object.material = 0;
  scene.meshes.push_back(mesh);
  scene.objects.push_back(object);
  return scene;
}

ShadowMaps planFor(const Scene& scene, glm::ivec2 size = {200, 100},
                   const ShadowLimits& limits = {.size = 256}) {
  return planShadowMaps(scene, cameraView(scene.cameras.front(), size), ShadowMethod::kHard, limits);
}

template <class T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(ShadowMaps, PlanDoesNotDependOnTheCrop) {
  const Scene scene = terrainScene();
  View view = cameraView(scene.cameras.front(), {200, 100});
  const ShadowMaps whole = planShadowMaps(scene, view, ShadowMethod::kHard, {});
  view.crop_origin = {50, 20};
  view.crop_size = {10, 10};
  const ShadowMaps part = planShadowMaps(scene, view, ShadowMethod::kHard, {});
  EXPECT_TRUE(sameBits(whole.maps, part.maps));
  EXPECT_TRUE(sameBits(whole.faces, part.faces));
  ASSERT_EQ(whole.planned.size(), part.planned.size());
  for (std::size_t i = 0; i < whole.planned.size(); ++i) {
    EXPECT_EQ(whole.planned[i].view.world_to_view, part.planned[i].view.world_to_view);
    EXPECT_EQ(whole.planned[i].view.projection, part.planned[i].view.projection);
    EXPECT_EQ(whole.planned[i].view.size, part.planned[i].view.size);
  }
}

TEST(ShadowMaps, LightsWithoutShadowHaveNoMap) {
  const ShadowMaps maps = planFor(sceneFromJson(planeScene(R"({"type": "point", "position": [0, 1, 0]})")));
  EXPECT_TRUE(maps.maps.empty() && maps.faces.empty() && maps.planned.empty());
  EXPECT_EQ(maps.map_of_light.front(), kNoShadow);
}

TEST(ShadowMaps, EmptySceneHasNone) {
  Scene scene = terrainScene();
  scene.objects.clear();
  const ShadowMaps maps = planFor(scene);
  EXPECT_TRUE(maps.maps.empty());
  EXPECT_EQ(maps.map_of_light, std::vector<std::uint32_t>(scene.lights.size(), kNoShadow));
}

/// A thousand lamps over a floor, all of them in the picture.
Scene thousandLamps() {
  Scene scene = sceneFromJson(planeScene(R"({"type": "point", "position": [0, 1, 0], "shadow": true})"));
  scene.lights.resize(1000, scene.lights.front());
  for (int i = 0; i < 1000; ++i) scene.lights[i].position.x = 0.001 * i;
  return scene;
}

TEST(ShadowMaps, ThousandPointLightsFitIntoSixteenMebibytesCoarser) {
  const Scene scene = thousandLamps();
  const ShadowLimits roomy{.bytes = std::size_t(64) << 30}, tight{.bytes = std::size_t(16) << 20};
  const ShadowMaps wanted = planFor(scene, {1920, 1080}, roomy), maps = planFor(scene, {1920, 1080}, tight);
  EXPECT_EQ(wanted.reduced_lights, 0u);
  EXPECT_GT(wanted.planned_texels * sizeof(ShadowTexel), tight.bytes);
  EXPECT_EQ(maps.reduced_lights, 1000u);
  EXPECT_LE(maps.planned_texels * sizeof(ShadowTexel), tight.bytes);
  ASSERT_EQ(maps.maps.size(), 1000u);
  ASSERT_EQ(maps.faces.size(), 6000u);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    EXPECT_EQ(maps.map_of_light[i], i);
    EXPECT_EQ(maps.maps[i].first_face, 6 * i);
    EXPECT_EQ(maps.maps[i].face_count, 6u);
    EXPECT_GE(maps.planned[6 * i].view.size.x, kSmallestFace);
    EXPECT_LT(maps.faces[6 * i].scale, wanted.faces[6 * i].scale);
  }
}

TEST(ShadowMaps, AllThatWasPlannedFitsWhenDrawn) {
  const Scene scene = thousandLamps();
  ShadowMaps maps = planFor(scene, {1920, 1080}, {.bytes = std::size_t(16) << 20});
  drawNeeded(scene, everything(maps), maps);
  EXPECT_EQ(maps.texels.size(), maps.planned_texels);
}

TEST(ShadowMaps, LimitThatTheSmallestFacesExceedIsRefused) {
  const Scene scene = thousandLamps();
  const std::size_t least = 6000 * kSmallestFace * kSmallestFace * sizeof(ShadowTexel);
  EXPECT_EQ(planFor(scene, {1920, 1080}, {.bytes = least}).planned_texels * sizeof(ShadowTexel), least);
  EXPECT_THROW(planFor(scene, {1920, 1080}, {.bytes = least - 1}), MachineError);
}

TEST(ShadowMaps, LookupsAndViewsAgreeOnEveryTexel) {
  const Scene scene = terrainScene();
  const ShadowMaps maps = planFor(scene);
  const View camera = cameraView(scene.cameras.front(), {200, 100});
  std::mt19937 random(6);
  std::uniform_real_distribution<double> place(-6, 6);
  int compared = 0;
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 world(place(random), 0.2 * place(random), place(random));
    const glm::dvec4 seen = camera.world_to_view * glm::dvec4(world, 1);
    for (const ShadowMap& map : maps.maps) {
      if (map.kind == kCubeMap) continue;  // tests/kernels/shadow_test.cpp knows the order of the faces
      const auto row = [&](const float4& r) { return glm::dot(glm::dvec4(r.x, r.y, r.z, r.w), seen); };
      const double u = row(map.to_map_x), v = row(map.to_map_y), w = row(map.to_map_z);
      const bool parallel = map.kind == kParallelMap;
      for (std::size_t f = map.first_face; f < map.first_face + map.face_count; ++f) {
        const auto texel = texelOn(maps.planned[f], world);
        if (!texel || (!parallel && w < 0.5)) continue;
        const ShadowFace& face = maps.faces[f];
        const double divide = parallel ? 1 : w;
        const glm::dvec2 looked_up(face.middle_x + face.scale * u / divide,
                                   face.middle_y - face.scale * v / divide);
        // The rows' four floats and those of the face round once, in coordinates up to 15 m, and 30 texels a
        // tangent or a metre times the scale; w from 0.5 m on doubles it.
        const double allowed = 0x1p-24 * (8 * 15 * face.scale / (parallel ? 1 : 0.25) +
                                          4 * std::abs(face.middle_x) + 4 * std::abs(face.middle_y));
        ASSERT_LE(glm::length(looked_up - *texel), allowed) << "face " << f;
        const glm::dvec4 clip =
            maps.planned[f].view.projection * (maps.planned[f].view.world_to_view * glm::dvec4(world, 1));
        const double depth = parallel ? w : map.depth_scale / w + map.depth_offset;
        ASSERT_NEAR(depth, clip.z / clip.w,
                    0x1p-24 * (parallel ? 64 : 64 * map.depth_scale / (w * w)) + 0x1p-24);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 5000);
}

/// What a camera over the terrain sees, in world space.
std::vector<glm::dvec3> seenPoints(const Scene& scene, const View& view) {
  const GBuffer gbuffer = rasterize(scene, allObjects(scene), view, Shading::kFlat, {});
  std::vector<glm::dvec3> points;
  for (std::size_t i = 0; i < gbuffer.pixels(); ++i) {
    const glm::dvec3 p(gbuffer.position[i], gbuffer.position[gbuffer.pixels() + i],
                       gbuffer.position[2 * gbuffer.pixels() + i]);
    if (std::isfinite(p.z)) points.emplace_back(scene.cameras.front().camera_to_world * glm::dvec4(p, 1));
  }
  return points;
}

TEST(ShadowMaps, CascadesCoverAllThatIsSeenTheFinestFirst) {
  for (const bool orthographic : {false, true}) {
    Scene scene = terrainScene();
    scene.lights.resize(1);
    scene.cameras.front().orthographic = orthographic;
    scene.cameras.front().half_height = 2;
    const View view = cameraView(scene.cameras.front(), {200, 100});
    const ShadowMaps maps = planShadowMaps(scene, view, ShadowMethod::kHard, {.size = 512});
    EXPECT_EQ(maps.faces.size() > 1, !orthographic);
    for (std::size_t i = 1; i < maps.faces.size(); ++i)
      EXPECT_LT(maps.faces[i].scale, maps.faces[i - 1].scale);
    std::vector<int> used(maps.faces.size());
    const std::vector<glm::dvec3> points = seenPoints(scene, view);
    for (const glm::dvec3& point : points) {
      const auto place = placeOf(maps, maps.maps.front(), point);
      ASSERT_TRUE(place) << point.x << ' ' << point.y << ' ' << point.z;
      ++used[place->face];
    }
    EXPECT_GT(points.size(), 15000u);
    if (!orthographic) {
      EXPECT_GT(std::count_if(used.begin(), used.end(), [](int count) { return count > 100; }), 1);
    }
  }
}

TEST(ShadowMaps, MovingCameraLeavesTexelsWhereTheyAreInTheWorld) {
  Scene scene = terrainScene();
  scene.lights.resize(1);
  // It sees 14.65 m far; texels change their size where that passes 16 m, or 11.3 m.
  scene.cameras.front().camera_to_world =
      scene.cameras.front().camera_to_world * glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -1));
  const ShadowMaps home = planFor(scene);
  const double texel = 1 / home.faces.front().scale;
  const glm::dmat4 place = scene.cameras.front().camera_to_world;
  std::mt19937 random(12);
  std::uniform_real_distribution<double> unit(-1, 1);
  int jumps = 0;
  for (int i = 0; i < 50; ++i) {
    const double reach = i % 2 ? texel : 30 * texel;
    const glm::dvec3 way = reach * glm::dvec3(unit(random), unit(random), unit(random));
    // Turned too: the cascades are around spheres.
    scene.cameras.front().camera_to_world =
        glm::rotate(glm::translate(glm::dmat4(1), way) * place, 0.02 * unit(random), glm::dvec3(0, 1, 0));
    const ShadowMaps moved = planFor(scene);
    ASSERT_EQ(moved.faces.size(), home.faces.size());
    for (std::size_t f = 0; f < home.faces.size(); ++f) {
      EXPECT_EQ(moved.planned[f].view.size, home.planned[f].view.size);
      EXPECT_EQ(moved.faces[f].scale, home.faces[f].scale);
      for (const glm::dvec3& point : {glm::dvec3(0), {3.1, 0.7, -2.3}}) {
        const glm::dvec2 shift =
            texelOn(moved.planned[f], point).value() - texelOn(home.planned[f], point).value();
        // Some twenty roundings of doubles of up to 10⁴ texels.
        ASSERT_LE(glm::length(shift - glm::round(shift)), 20 * 0x1p-53 * 1e4) << "cascade " << f;
        jumps += glm::round(shift) != glm::dvec2(0);
      }
    }
  }
  EXPECT_GT(jumps, 0);  // it follows the camera
}

/// What was drawn of some faces is what all of them drawn show, as far away as it was asked for; beyond it
/// there may be anything or nothing beyond it. Returns how many texels were compared.
std::size_t expectSameTexels(const ShadowMaps& some, const ShadowMaps& all) {
  std::size_t compared = 0;
  for (std::size_t f = 0; f < some.planned.size(); ++f) {
    const int size = some.planned[f].view.size.x;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const float down_to = drawnDownTo(some, f, {x, y});
        if (!std::isfinite(down_to)) continue;
        const ShadowTexel a = texelOf(some, f, x, y), b = texelOf(all, f, x, y);
        if (b.depth < down_to) {
          EXPECT_LT(a.depth, down_to) << "face " << f << " at " << x << ',' << y;
        } else {
          EXPECT_EQ(a.depth, b.depth) << "face " << f << " at " << x << ',' << y;
          EXPECT_EQ(a.slopes, b.slopes) << "face " << f << " at " << x << ',' << y;
          ++compared;
        }
        if (testing::Test::HasFailure()) return 0;
      }
  }
  return compared;
}

TEST(ShadowMaps, TexelsAreTheSameHoweverMuchIsDrawn) {
  const Scene scene = terrainScene();
  ShadowMaps all = planFor(scene, {200, 100}, {.size = 500}), some = all;  // not of whole bins
  drawNeeded(scene, everything(all), all);
  EXPECT_EQ(all.texels.size(), all.planned_texels);
  // Depths that are there, to ask for.
  std::vector<float> depths;
  for (std::size_t i = 0; i < all.texels.size(); i += 97)
    if (all.texels[i].depth > 0) depths.push_back(all.texels[i].depth);
  std::mt19937 random(31);
  std::size_t compared = 0;
  for (int round = 0; round < 12; ++round) {
    std::vector<std::uint32_t> needed = nothing(some);
    for (std::uint32_t& bin : needed) {
      if (random() % 8 != 0) continue;
      bin = random() % 2 ? 0u : std::bit_cast<std::uint32_t>(depths[random() % depths.size()]);
    }
    drawNeeded(scene, needed, some);
    ASSERT_LE(some.texels.size(), some.planned_texels);
    for (std::size_t f = 0; f < some.faces.size(); ++f)
      for (std::size_t bin = 0; bin < some.planned[f].farthest.size(); ++bin) {
        const std::uint32_t asked = needed[some.faces[f].first_bin + bin];
        if (asked != kNotNeeded) {
          EXPECT_LE(some.planned[f].farthest[bin], std::bit_cast<float>(asked)) << "face " << f;
        }
      }
    compared = expectSameTexels(some, all);
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
  EXPECT_GT(compared, all.texels.size() / 4);
}

TEST(ShadowMaps, ACopyOfWhatWasDrawnStaysUpToDate) {
  const Scene scene = terrainScene();
  ShadowMaps maps = planFor(scene, {200, 100}, {.size = 500});
  std::vector<ShadowTexel> copy;
  std::mt19937 random(31);
  for (int round = 0; round < 12; ++round) {
    std::vector<std::uint32_t> needed = nothing(maps);
    for (std::uint32_t& bin : needed)
      if (random() % 8 == 0) bin = 0;
    const std::vector<IndexRange> drawn = drawNeeded(scene, needed, maps);
    copy.resize(maps.texels.size());
    for (const IndexRange& range : drawn) {
      for (std::size_t row = 0; row < range.rows; ++row) {
        const std::size_t first = range.first + row * range.pitch;
        ASSERT_LE(first + range.count, copy.size());
        std::copy_n(maps.texels.data() + first, range.count, copy.data() + first);
      }
    }
    ASSERT_EQ(std::memcmp(copy.data(), maps.texels.data(), copy.size() * sizeof(ShadowTexel)), 0)
        << "round " << round;
  }
}

TEST(ShadowMaps, ABinInsideItsFacesRectangleIsToldByItself) {
  const Scene scene = terrainScene();
  ShadowMaps maps = planFor(scene, {200, 100}, {.size = 512});
  std::vector<std::uint32_t> needed = nothing(maps);
  const auto bin = [&](uint x, uint y) -> std::uint32_t& {
    return needed.at(maps.faces[2].first_bin + y * maps.faces[2].bins + x);
  };
  bin(1, 1) = bin(3, 2) = 0;
  drawNeeded(scene, needed, maps);
  EXPECT_TRUE(drawNeeded(scene, needed, maps).empty()) << "what is there already";
  bin(2, 2) = 0;
  const std::vector<IndexRange> drawn = drawNeeded(scene, needed, maps);
  ASSERT_EQ(drawn.size(), 1u);
  const std::size_t width = 3 * kShadowBin;
  EXPECT_EQ(drawn[0].first, kShadowBin * width + kShadowBin);
  EXPECT_EQ(drawn[0].count, std::size_t(kShadowBin));
  EXPECT_EQ(drawn[0].rows, std::size_t(kShadowBin));
  EXPECT_EQ(drawn[0].pitch, width);
}

TEST(ShadowMaps, OnlyNeededBinsAreDrawnAndOnlyOnce) {
  const Scene scene = terrainScene();
  ShadowMaps maps = planFor(scene, {200, 100}, {.size = 512});
  std::vector<std::uint32_t> needed = nothing(maps);
  drawNeeded(scene, needed, maps);
  EXPECT_TRUE(maps.texels.empty());
  // One bin of one face, and two that aren't neighbours of another: the rectangle around them.
  const auto bin = [&](std::size_t face, uint x, uint y) -> std::uint32_t& {
    return needed.at(maps.faces[face].first_bin + y * maps.faces[face].bins + x);
  };
  bin(1, 2, 3) = 0;
  bin(2, 1, 1) = 0;
  bin(2, 3, 2) = 0;
  drawNeeded(scene, needed, maps);
  constexpr std::size_t kBin = kShadowBin * kShadowBin;
  EXPECT_EQ(maps.texels.size(), (1 + 3 * 2) * kBin);
  for (std::size_t f = 0; f < maps.planned.size(); ++f) {
    EXPECT_EQ(maps.faces[f].width, f == 1 ? 64u : f == 2 ? 192u : 0u) << "face " << f;
    EXPECT_EQ(maps.planned[f].count.x > 0, f == 1 || f == 2) << "face " << f;
    for (const float farthest : maps.planned[f].farthest)
      EXPECT_TRUE(farthest == 0 || std::isinf(farthest)) << "face " << f;
  }
  EXPECT_EQ(std::count(maps.planned[2].farthest.begin(), maps.planned[2].farthest.end(), 0.0f), 2);
  // What is there already, and a part of it: what memory holds isn't touched.
  const std::vector<ShadowFace> before = maps.faces;
  for (ShadowTexel& texel : maps.texels) texel = {0.25f, 7};
  drawNeeded(scene, needed, maps);
  bin(1, 2, 3) = std::bit_cast<std::uint32_t>(0.5f);
  bin(2, 1, 1) = kNotNeeded;
  drawNeeded(scene, needed, maps);
  EXPECT_EQ(maps.texels.size(), (1 + 3 * 2) * kBin);
  EXPECT_TRUE(sameBits(maps.faces, before));
  for (const ShadowTexel& texel : maps.texels) ASSERT_TRUE(texel.depth == 0.25f && texel.slopes == 7);
}

TEST(ShadowMaps, FloorThatIsWideBeyondMeasureIsDrawn) {
  // Where a face's rim sees it, 10¹¹ m away, is a place of 10¹⁴ texels.
  Scene scene = terrainScene();
  scene.lights = {scene.lights[2]};
  scene.lights.front().position = {0, 1e-3, 0};
  scene.lights.front().range = 1.0f;
  scene.objects.resize(1);
  scene.objects.front().object_to_world = glm::scale(glm::dmat4(1), glm::dvec3(1e11));
  ShadowMaps maps = planFor(scene);
  drawNeeded(scene, everything(maps), maps);
  std::size_t drawn = 0;
  const std::size_t area = maps.texels.size() / 6;
  for (std::size_t i = 0; i < area; ++i) drawn += maps.texels[3 * area + i].depth > 0;  // −y
  EXPECT_EQ(drawn, area);
}

TEST(ShadowMaps, OccludersNearALightOfAHugeRangeCastShadows) {
  // A sheet 10 cm under a lamp hides 2 m of the floor, 1 m below, to each side.
  const Image image = renderJson(R"({"camera": {"eye": [0, 0.5, 4], "target": [0, 0, 0], "fov_y": 40},
    "materials": {"m": {"double_sided": true}},
    "objects": [{"primitive": "plane", "scale": 10},
                {"primitive": "plane", "scale": 0.4, "translate": [0, 0.9, 0], "material": "m"}],
    "lights": [{"type": "point", "position": [0, 1, 0], "range": 1e6, "shadow": true}]})",
                                 {160, 90}, askForShadows);
  const std::size_t channels = image.channels.size(), shadow = channelIndex(image, "shadow"),
                    place = channelIndex(image, "P.X");
  int dark = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += channels) {
    const float* p = image.pixels.data() + i + place;
    if (!std::isfinite(image.pixels[i + channelIndex(image, "Z")]) || std::abs(p[0]) > 1.9f ||
        std::abs(p[1]) > 0.01f || std::abs(p[2]) > 1.9f)
      continue;
    EXPECT_EQ(image.pixels[i + shadow], 0.0f) << p[0] << " " << p[2];
    ++dark;
  }
  EXPECT_GT(dark, 1000);
}

TEST(ShadowMaps, WhatIsBeyondALightsRangeCastsNothing) {
  // Lamps whose range ends below, and above, a slab that hangs between them and the floor.
  Scene scene = terrainScene();
  scene.lights = {scene.lights[2]};
  scene.lights.front().position = {0, 4, 0};
  for (const float range : {2.0f, 40.0f}) {
    scene.lights.front().range = range;
    ShadowMaps maps = planFor(scene);
    drawNeeded(scene, everything(maps), maps);
    std::size_t drawn = 0;
    for (const ShadowTexel& texel : maps.texels) drawn += texel.depth > 0;
    EXPECT_EQ(drawn > 0, range > 10) << range;
  }
}

}  // namespace
}  // namespace luciole::test
