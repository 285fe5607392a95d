#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "lighting/light_gbuffer.hpp"
#include "pictures/shot.hpp"
#include "shadow/maps/draw_shadow_maps.hpp"
#include "shadow/maps/texel_place.hpp"

// The whole scene, camera and lights with it, far from the origin. Its numbers round to doubles, and what a
// picture may change by follows from that.
namespace luciole::test {
namespace {

constexpr glm::ivec2 kSize(96, 70);
constexpr double kNearestLight = 1.0;  ///< metres from a light to what it lights, at least
const glm::dvec3 kEye(3.1, 2.3, 6.2), kTarget(0.1, 0.7, -0.3);

std::string at(const glm::dvec3& p) { return fmt::format("[{}, {}, {}]", p.x, p.y, p.z); }

/// Flat things only, hovering over a floor. Lights of 1 at most.
Scene movedScene(const glm::dvec3& offset) {
  return sceneFromJson(fmt::format(
      R"({{"camera": {{"eye": {}, "target": {}, "fov_y": 50, "near": 0.5, "far": 30}}, "background": [0.2, 0.3, 0.4], "ambient": 0.05,
      "materials": {{"m": {{"diffuse": [0.6, 0.8, 0.4], "specular": 0.3, "shininess": 20}}}},
      "objects": [{{"primitive": "plane", "scale": 10.3, "material": "m", "translate": {}}},
                  {{"primitive": "box", "scale": 1.1, "rotate": [20, 30, 40], "material": "m", "translate": {}}},
                  {{"primitive": "box", "scale": [0.7, 1.3, 0.9], "rotate": [0, 15.5, 3], "material": "m", "translate": {}}}],
      "lights": [{{"type": "directional", "direction": [-1.1, -2, -1.5], "color": 0.5, "shadow": true}},
                 {{"type": "point", "position": {}, "range": 9, "color": [1, 0.5, 0.25], "shadow": true}},
                 {{"type": "spot", "position": {}, "direction": [1, -1.9, -0.9], "inner_cone": 10, "outer_cone": 40, "color": [0.2, 0.6, 1], "shadow": true}}]}})",
      at(offset + kEye), at(offset + kTarget), at(offset + glm::dvec3(0.3, -0.1, 0.2)),
      at(offset + glm::dvec3(0.7, 1.3, -0.3)), at(offset + glm::dvec3(-1.1, 1.2, 0.9)),
      at(offset + glm::dvec3(1.3, 3.6, 1.7)), at(offset + glm::dvec3(-2.3, 4.1, 2.2))));
}

/// How far a scene whose coordinates are `largest` at most moves against its camera, in metres. In units u =
/// 2⁻⁵³ · largest: an object's and the eye's coordinates round (√3 each); so do the sums of three products
/// that the eye's and the object's place go through (per component 3 products of √3 in all and 2 sums up to
/// √3: 3√3, by √3 for the vector 9; the object's with one sum more 12). Eye and target 7.3 m apart turn the
/// camera by 2√3 / 7.3, which moves points 12 m away, the farthest here, by 6: 31 in all. Lights come by the
/// inverse of a matrix, whose entries have twice the operations: 60.
double groupLog2(double largest) { return 60 * 0x1p-53 * largest; }

/// By how much the colours of a pixel may change, before rounding, where its position moves by `moved`, its
/// normal by `turned` and the lights by `shift`: how steep each factor of the lighting equation is. Fading by
/// range changes by 2.5 / range a metre at most (the slope of (1 − x⁴)²).
double colorChange(const Scene& scene, const glm::dvec3& position, double moved, double turned,
                   double shift) {
  const glm::dmat4 to_view = glm::inverse(scene.cameras.front().camera_to_world);
  double change = 0;
  for (const Light& light : scene.lights) {
    const bool placed = light.kind != LightKind::kDirectional;
    const double distance = glm::distance(glm::dvec3(to_view * glm::dvec4(light.position, 1)), position);
    // A unit vector changes by twice the shift over the distance.
    const double way = placed ? 2 * (moved + shift) / distance : turned;
    const double view = 2 * moved / glm::length(position);
    double fading = std::isfinite(light.range) ? 2.5 / light.range * (moved + shift) : 0;
    if (light.kind == LightKind::kSpot)
      fading += 2 * (way + turned) / (std::cos(light.inner_cone) - std::cos(light.cutoff));
    // R = 2(N·L)N − L turns by 4 of the normal's and 3 of the light's; the exponent multiplies the cosine's
    // change.
    const double lobe = 20 * (4 * turned + 3 * way + view);
    change += 0.8 * (turned + way + fading) + 0.3 * (lobe + fading);
  }
  return change;
}

/// The scene with a colour of its own for every triangle, and nothing shared between objects.
Scene numberedTriangles(Scene scene) {
  const std::vector<Mesh> meshes = scene.meshes;
  scene.meshes.clear();
  scene.materials.clear();
  for (Object& object : scene.objects) {
    Mesh mesh = meshes[object.mesh];
    for (std::uint32_t& material : mesh.triangle_materials) {
      material = std::uint32_t(scene.materials.size());
      scene.materials.push_back({});
      scene.materials.back().diffuse = glm::vec3(float(scene.materials.size()));
    }
    object.mesh = std::uint32_t(scene.meshes.size());
    object.material = -1;
    scene.meshes.push_back(std::move(mesh));
  }
  return scene;
}

/// Which triangle each pixel shows, 0: none; −1 where a triangle's edge passes within kEdgeShift of the
/// sample, so that a corner that snaps to the next 1/256 pixel may give it to a neighbour.
std::vector<int> trianglesShown(const Scene& scene) {
  const Scene numbered = numberedTriangles(scene);
  std::vector<int> shown;
  for (const glm::dvec2& move : {glm::dvec2(0, 0), {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}) {
    View view = cameraView(scene.cameras.front(), kSize);
    view.sample += kEdgeShift * move;
    const GBuffer gbuffer = draw(numbered, view);
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x) {
        const int triangle = int(valueAt(gbuffer.diffuse, gbuffer, x, y).x);
        const std::size_t i = std::size_t(y) * kSize.x + x;
        if (move == glm::dvec2(0)) shown.push_back(triangle);
        if (triangle != shown[i]) shown[i] = -1;
      }
  }
  return shown;
}

/// What the two scenes' pictures without shadows may differ by at a pixel; the positions are compared on the
/// way.
double allowedChange(const Shot& home, const Shot& moved, int x, int y, double shift) {
  const glm::dvec3 p(positionAt(home.gbuffer, x, y)), q(positionAt(moved.gbuffer, x, y));
  const glm::dvec3 n(valueAt(home.gbuffer.normal, home.gbuffer, x, y)),
      m(valueAt(moved.gbuffer.normal, moved.gbuffer, x, y));
  // The pixel's ray meets a plane that has moved by `shift` farther away by that over the slope; then both
  // round to floats.
  const double slope = std::abs(glm::dot(n, glm::normalize(p)));
  const double apart = shift / slope + 2.01 * kUnit * glm::length(p);
  EXPECT_LE(glm::length(p - q), apart) << "pixel " << x << "," << y;
  const double turned = 0.1 * shift + std::sqrt(3.0) * kUnit;  // 2√3 / 7.3 of 60, and 2⁻²⁵ a component, twice
  EXPECT_LE(glm::length(n - m), turned) << "pixel " << x << "," << y;
  double rounding = 0;
  for (int c = 0; c < 3; ++c) {
    const Interval a = shadeInterval(home.scene, home.gbuffer, home.gbuffer.index(x, y), c, Model::kPhong),
                   b = shadeInterval(moved.scene, moved.gbuffer, moved.gbuffer.index(x, y), c, Model::kPhong);
    rounding = std::max(rounding, a.high - a.low + b.high - b.low);
  }
  return rounding + colorChange(home.scene, p, apart, turned, shift);
}

double difference(const Shot& a, const Shot& b, int x, int y) {
  const glm::vec3 d = glm::abs(colorAt(a.image, x, y) - colorAt(b.image, x, y));
  return std::max({d.x, d.y, d.z});
}

class Moved : public testing::TestWithParam<double> {
 protected:
  const double distance = GetParam();
  /// Along the sun's rays: across them, cascades have their texels elsewhere after a way that is not of whole
  /// texels.
  const glm::dvec3 offset{0.55 * distance, distance, 0.75 * distance};
  const double shift = groupLog2(distance + 10);
};

TEST_P(Moved, KeepsItsPicture) {
  const Shot home = shoot(movedScene(glm::dvec3(0)), kSize), moved = shoot(movedScene(offset), kSize);
  const std::vector<int> shown = trianglesShown(home.scene);
  int compared = 0, background = 0;
  double worst = 0, worst_allowed = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const int triangle = shown[std::size_t(y) * kSize.x + x];
      if (triangle == 0) {
        ASSERT_EQ(colorAt(moved.image, x, y), moved.scene.background) << "pixel " << x << "," << y;
        ++background;
      }
      if (triangle <= 0) continue;
      ASSERT_TRUE(isCovered(moved.gbuffer, x, y)) << "pixel " << x << "," << y;
      const double allowed = allowedChange(home, moved, x, y, shift);
      const double got = difference(home, moved, x, y);
      ASSERT_LE(got, allowed) << "pixel " << x << "," << y;
      worst = std::max(worst, got);
      worst_allowed = std::max(worst_allowed, allowed);
      ++compared;
    }
  RecordProperty("largest_change", fmt::format("{}", worst));
  RecordProperty("largest_allowed", fmt::format("{}", worst_allowed));
  // Edges take few of the pixels.
  EXPECT_GT(compared + background, 0.95 * kSize.x * kSize.y);
  EXPECT_GT(compared, 0.4 * kSize.x * kSize.y);
  EXPECT_GT(background, 0.05 * kSize.x * kSize.y);
  expectAsTheReference(moved);
  expectCullingChangesNothing(moved);
}

constexpr int kMapSize = 256;

/// How far the grid of a face may lie beside its place, in texels.
double texelShift(const ShadowMap& map, const ShadowFace& face, double shift) {
  return shift * face.scale / (map.kind == kParallelMap ? 1.0 : kNearestLight);
}

ShadowMaps wholeMaps(const Shot& shot) {
  ShadowMaps maps = planShadowMaps(shot.scene, cameraView(shot.settings.camera, kSize), ShadowMethod::kHard,
                                   shot.settings.shade.shadow_limits);
  drawNeeded(shot.scene, everything(maps), maps);
  return maps;
}

/// How many texels of the two scenes' maps show something else; the others have the same depth.
int differentTexels(const ShadowMaps& home, const ShadowMaps& moved, double shift) {
  int different = 0;
  for (const ShadowMap& map : home.maps)
    for (std::size_t face = map.first_face; face < map.first_face + map.face_count; ++face) {
      const int size = home.planned[face].view.size.x;
      const double grid = texelShift(map, home.faces[face], shift);
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
          const auto depth = [&](int i, int j) {
            return double(texelOf(home, face, std::clamp(i, 0, size - 1), std::clamp(j, 0, size - 1)).depth);
          };
          // A grid that moves by a share of a texel shows that share of the step to the next one; the float
          // depth rounds three times (at a row's start, the step, the sum) in each map.
          double low = depth(x, y), high = low;
          for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i) {
              low = std::min(low, depth(x + i, y + j));
              high = std::max(high, depth(x + i, y + j));
            }
          const double allowed = 2 * grid * (high - low) + 6 * kUnit * high;
          different += std::abs(texelOf(moved, face, x, y).depth - depth(x, y)) > allowed;
        }
    }
  return different;
}

TEST_P(Moved, KeepsItsShadows) {
  const auto with_shadows = [](RenderSettings& settings) {
    settings.shade.shadows = ShadowMethod::kPcf;
    settings.shade.shadow_limits.size = kMapSize;
  };
  const Shot home = shoot(movedScene(glm::dvec3(0)), kSize, with_shadows),
             moved = shoot(movedScene(offset), kSize, with_shadows),
             open = shoot(movedScene(glm::dvec3(0)), kSize);
  const ShadowMaps home_maps = wholeMaps(home), moved_maps = wholeMaps(moved);
  ASSERT_EQ(moved_maps.faces.size(), home_maps.faces.size());
  double texels = 0;  // that a grid may be shifted by
  for (const ShadowMap& map : home_maps.maps)
    for (std::size_t face = map.first_face; face < map.first_face + map.face_count; ++face) {
      ASSERT_EQ(moved_maps.planned[face].view.size, home_maps.planned[face].view.size);
      // What a face covers, 1 m at least, changes by the shift on either side; then a float.
      EXPECT_NEAR(moved_maps.faces[face].scale, home_maps.faces[face].scale,
                  (2 * shift + 2 * kUnit) * home_maps.faces[face].scale);
      texels = std::max(texels, texelShift(map, home_maps.faces[face], shift));
    }
  const int different = differentTexels(home_maps, moved_maps, shift);
  RecordProperty("different_texels", different);
  // A texel's centre shows something else where an outline, of 10³ texels a face and 11 faces, passes
  // between: by the grid's shift, or by 1/256 where a corner snaps otherwise, as likely as 256 shifts: in all
  // 10⁴ · 2 shifts.
  EXPECT_LE(different, std::ceil(2e4 * texels));

  const std::vector<int> shown = trianglesShown(home.scene);
  int shadowed = 0, others = 0;
  double worst = 0, worst_allowed = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      if (shown[std::size_t(y) * kSize.x + x] <= 0) continue;
      // A lookup's weights are linear in its place, with slopes of 1 along x and y. It lies beside by the
      // grid's shift and by the rounding of its floats, 10 of them up to 4 maps' width each, in both
      // pictures. Where the lit side's pixels lie, all three lights together are below 2.
      const double lookup = 2 * (texels + 2 * 10 * kUnit * 4 * kMapSize);
      const double allowed = allowedChange(home, moved, x, y, shift) + 2 * lookup;
      const double got = difference(home, moved, x, y);
      others += got > allowed;
      worst = std::max(worst, got);
      worst_allowed = std::max(worst_allowed, allowed);
      shadowed += difference(home, open, x, y) > 0.01;
    }
  // A texel is no larger than a pixel, and the lookups of 2 by 2 texels read it.
  EXPECT_LE(others, 4 * different);
  RecordProperty("largest_change", fmt::format("{}", worst));
  RecordProperty("largest_allowed", fmt::format("{}", worst_allowed));
  EXPECT_GT(shadowed, 300);
}

/// A square hovering 1 m over a floor under a sun in the zenith. Its shadow has the same outline.
TEST_P(Moved, ShadowsKeepTheirPlaceForAnyNearAndFar) {
  const std::array<glm::dvec3, 3> eyes{{{0.5, 4, 3}, {-3, 2.2, 2.5}, {2.6, 0.7, 0.3}}};
  for (int i = 0; i < 12; ++i) {
    const double near = i & 1 ? 1e-6 : 0.5, far = i & 2 ? 1e8 : 20;
    const Scene scene = sceneFromJson(fmt::format(
        R"({{"camera": {{"eye": {}, "target": {}, "near": {}, "far": {}}},
        "materials": {{"m": {{"diffuse": 0.5, "double_sided": true}}}},
        "objects": [{{"primitive": "plane", "scale": 6, "material": "m", "translate": {}}},
                    {{"primitive": "plane", "scale": 2, "material": "m", "translate": {}}}],
        "lights": [{{"type": "directional", "direction": [0, -1, 0], "shadow": true}}]}})",
        at(offset + eyes[i / 4]), at(offset), near, far, at(offset), at(offset + glm::dvec3(0, 1, 0))));
    const Shot shot = shoot(scene, kSize, [](RenderSettings& settings) {
      settings.shade.shadows = ShadowMethod::kPcf;
      settings.shade.shadow_limits.size = kMapSize;
    });
    const ShadowMaps maps = planShadowMaps(scene, cameraView(shot.settings.camera, kSize),
                                           ShadowMethod::kHard, {.size = kMapSize});
    // The coarsest cascade covers a sphere around the whole scene at the most, and the rim's 4 texels more on
    // each side.
    const double texel = 1 / maps.faces.back().scale;
    EXPECT_LE(texel, std::sqrt(2 * 6.0 * 6.0 + 1) / (kMapSize - 9) * 1.001)
        << "near " << near << ", far " << far;
    int dark = 0, lit = 0;
    for (int y = 0; y < kSize.y; ++y)
      for (int x = 0; x < kSize.x; ++x) {
        if (!isCovered(shot.gbuffer, x, y)) continue;
        const glm::dvec3 p =
            glm::dvec3(shot.settings.camera.camera_to_world * glm::dvec4(positionAt(shot.gbuffer, x, y), 1)) -
            offset;
        // Positions round by 10⁻⁶ m. Lookups read texels whose centres lie up to √2 away.
        const double inside = 1 - std::max(std::abs(p.x), std::abs(p.z));
        if (p.y > 0.5 || std::abs(inside) < 1.5 * texel) continue;
        ASSERT_NEAR(colorAt(shot.image, x, y).x, inside > 0 ? 0 : 0.5, 8 * kUnit)
            << "near " << near << ", far " << far << ": " << p.x << "," << p.z;
        ++(inside > 0 ? dark : lit);
      }
    EXPECT_GT(dark, 50);
    EXPECT_GT(lit, 200);
  }
}

INSTANTIATE_TEST_SUITE_P(Hard, Moved, testing::Values(0.0, 1e5, 1e7), [](const auto& distance) {
  return fmt::format("{}Kilometres", int(distance.param / 1000));
});

}  // namespace
}  // namespace luciole::test
