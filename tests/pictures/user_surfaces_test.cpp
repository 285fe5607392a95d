// Functions of the user's that change surfaces before they are lit.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "gbuffer/packed_normal.hpp"
#include "kernels/probe.hpp"
#include "lighting/count_picture.hpp"
#include "luciole/shader.hpp"
#include "messages.hpp"
#include "render/plan.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

constexpr glm::ivec2 kSurfaceSize{75, 50};

Shader surfaceOf(const std::string& body) {
  return {"user.clh", "INLINE void surface(Surface *s) {\n" + body + "\n}\n"};
}

/// A ball, a box and a floor under lights of all kinds, in fog. floor: the diffuse colour of all.
std::string surfacesScene(const char* diffuse = "[0.5, 0.25, 0.75]", const char* specular = "0",
                          const char* emission = "0") {
  return fmt::format(
      R"({{"camera": {{"eye": [1, 2, 6], "target": [0, 0.5, 0], "fov_y": 35}}, "ambient": [0.1, 0.2, 0.1],
      "fog": {{"mode": "exp", "density": 0.03, "color": [0.5, 0.6, 0.7]}}, "background": [0.1, 0.1, 0.3],
      "materials": {{"m": {{"diffuse": {0}, "ambient": {0}, "specular": {1}, "shininess": 16, "emission": {2}}}}},
      "objects": [{{"primitive": "sphere", "segments": 24, "translate": [-1, 0.9, 0], "material": "m"}},
                  {{"primitive": "box", "translate": [1, 0.5, 0.5], "rotate": [0, 30, 0], "material": "m"}},
                  {{"primitive": "plane", "scale": 8, "segments": 4, "material": "m"}}],
      "lights": [{{"type": "directional", "direction": [-1, -2, -1.5], "intensity": 0.5, "shadow": true}},
                 {{"type": "point", "position": [1, 3, 3], "attenuation": [0, 0, 0.1]}}],
      "light_fields": [{{"count": 40, "seed": 3, "min": [-3, 0, -3], "max": [3, 3, 3], "range": 2}}]}})",
      diffuse, specular, emission);
}

struct SurfaceCase {
  const char* name;
  Shading shading;
  int samples;
  SampleShading sample_shading;
  ShadowMethod shadows;
};

class UserSurfaces : public testing::TestWithParam<SurfaceCase> {
 protected:
  static RenderSettings settingsOf(const Scene& scene, const std::vector<Shader>& surfaces = {}) {
    RenderSettings settings = settingsFor(scene, kSurfaceSize);
    settings.shading = GetParam().shading;
    settings.samples = GetParam().samples;
    settings.sample_shading = GetParam().sample_shading;
    settings.shade.shadows = GetParam().shadows;
    settings.surfaces = surfaces;
    return settings;
  }
};

// All that a function can name, so that all planes are there.
TEST_P(UserSurfaces, WhatAFunctionLeavesKeepsItsBits) {
  const Scene scene = sceneFromJson(surfacesScene("[0.5, 0.25, 0.75]", "0.25", "[0.01, 0, 0]"));
  const Shader leaves = surfaceOf(
      "s->diffuse.x = s->diffuse.x + 0.0f * s->position.x; s->specular.y *= 1.0f; s->exponent *= 1.0f;\n"
      "s->ambient.z = s->ambient.z; s->emission = s->emission; s->position.x = s->to_eye.x;");
  EXPECT_EQ(picture(scene, settingsOf(scene, {leaves})).pixels, picture(scene, settingsOf(scene)).pixels);
}

TEST_P(UserSurfaces, AColourOfAFunctionIsThatOfAMaterial) {
  const Scene plain = sceneFromJson(surfacesScene("1")),
              wanted = sceneFromJson(surfacesScene("[0.25, 0.5, 0.125]", "0.5", "[0, 0.0625, 0]"));
  const Shader sets = surfaceOf(
      "s->diffuse.x = s->ambient.x = (floatL)(0.25f); s->diffuse.y = s->ambient.y = (floatL)(0.5f);\n"
      "s->diffuse.z = s->ambient.z = (floatL)(0.125f); s->emission.y = (floatL)(0.0625f);\n"
      "s->specular.x = s->specular.y = s->specular.z = (floatL)(0.5f); s->exponent = (floatL)(16.0f);");
  EXPECT_EQ(picture(plain, settingsOf(plain, {sets})).pixels, picture(wanted, settingsOf(wanted)).pixels);
}

TEST_P(UserSurfaces, BandsCropsAndWidthsChangeNoBit) {
  const Scene scene = sceneFromJson(surfacesScene());
  const Shader marble = readShader(LUCIOLE_SOURCE_DIR "/kernels/examples/marble.clh", ShaderKind::kSurface);
  RenderSettings settings = settingsOf(scene, {marble});
  const Image whole = picture(scene, settings);
  EXPECT_NE(whole.pixels, picture(scene, settingsOf(scene)).pixels);
  settings.band_height = 16;
  EXPECT_EQ(picture(scene, settings).pixels, whole.pixels) << "bands";
  settings.band_height = 0;
  for (const int lanes : widths())
    EXPECT_EQ(picture(scene, settings, deviceWithLanes(lanes)).pixels, whole.pixels) << lanes << " lanes";
  settings.crop = Crop{13, 9, 41, 30};
  const Image part = picture(scene, settings);
  for (int y = 0; y < 30; ++y)
    for (std::size_t i = 0; i < 3 * 41; ++i)
      ASSERT_EQ(part.pixels[std::size_t(y) * 3 * 41 + i],
                whole.pixels[(std::size_t(y + 9) * kSurfaceSize.x + 13) * 3 + i]);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, UserSurfaces,
    testing::Values(SurfaceCase{"Phong", Shading::kPhong, 1, SampleShading::kShared, ShadowMethod::kExact},
                    SurfaceCase{"Flat", Shading::kFlat, 1, SampleShading::kShared, ShadowMethod::kHard},
                    SurfaceCase{"Gouraud", Shading::kGouraud, 1, SampleShading::kShared, ShadowMethod::kOff},
                    SurfaceCase{"Shared", Shading::kPhong, 5, SampleShading::kShared, ShadowMethod::kExact},
                    SurfaceCase{"All", Shading::kPhong, 3, SampleShading::kAll, ShadowMethod::kPcf}),
    [](const auto& of_case) { return of_case.param.name; });

TEST(UserSurface, FunctionsComeOneAfterAnother) {
  const Scene scene = sceneFromJson(surfacesScene("1")),
              wanted = sceneFromJson(surfacesScene("[0.25, 1, 1]"));
  RenderSettings settings = settingsFor(scene, kSurfaceSize);
  settings.surfaces = {surfaceOf("s->diffuse.x = s->ambient.x = (floatL)(0.5f);"),
                       surfaceOf("s->diffuse.x *= s->diffuse.x; s->ambient.x *= s->ambient.x;")};
  EXPECT_EQ(picture(scene, settings).pixels, picture(wanted, settingsFor(wanted, kSurfaceSize)).pixels);
}

/// The G-buffer of the scene, changed by a function; the number of faults to `faults`.
GBuffer changedBy(const Shader& shader, const Scene& scene, std::uint64_t* faults = nullptr) {
  RenderSettings settings = settingsFor(scene, kSurfaceSize);
  settings.surfaces = {shader};
  Stats stats;
  GBuffer gbuffer = rasterizeScene(&testDevice(), scene, settings, stats);
  if (faults) *faults = countOf(stats, kFaultySurfaces);
  return gbuffer;
}

TEST(UserSurface, SeesTheWorldAndTheScenesNumbers) {
  const Scene scene = sceneFromJson(surfacesScene());
  // Positive, so that nothing counts as 0.
  const GBuffer told = changedBy(
      surfaceOf("s->diffuse.x = s->position.x + 8.0f; s->diffuse.y = s->position.y + 8.0f;\n"
                "s->diffuse.z = s->position.z + 8.0f; s->specular.x = s->normal.x + 2.0f;\n"
                "s->specular.y = s->normal.y + 2.0f; s->specular.z = s->normal.z + 2.0f;\n"
                "s->ambient.x = s->uv.x; s->ambient.y = s->uv.y; s->ambient.z = convert_floatL(s->object);\n"
                "s->emission.x = convert_floatL(s->material); s->emission.y = s->tangent.x + 2.0f;\n"
                "s->emission.z = dot3(s->tangent, s->normal) + 2.0f;"),
      scene);
  const glm::dmat4 to_world = told.camera.camera_to_world;
  const std::size_t n = told.pixels();
  int shown = 0;
  for (int y = 0; y < kSurfaceSize.y; ++y)
    for (int x = 0; x < kSurfaceSize.x; ++x) {
      const std::size_t i = told.index(x, y);
      if (std::isinf(told.position[i + 2 * n])) continue;
      ++shown;
      const auto at = [&](const Plane& plane) {
        return glm::dvec3(plane[i], plane[i + n], plane[i + 2 * n]);
      };
      const glm::dvec3 position(to_world * glm::dvec4(at(told.position), 1));
      // Four roundings of up to 16 m, and two of directions.
      EXPECT_LE(glm::distance(at(told.diffuse) - 8.0, position), 1.8 * 4 * 16 * 0x1p-24);
      EXPECT_LE(glm::distance(at(told.specular) - 2.0, glm::dmat3(to_world) * at(told.normal)),
                1.8 * 8 * 0x1p-24);
      EXPECT_EQ(told.ambient[i], told.uv[i]);
      EXPECT_EQ(told.ambient[i + n], told.uv[i + n]);
      EXPECT_EQ(told.ambient[i + 2 * n], float(told.object[i]));
      EXPECT_EQ(told.emission[i], float(told.material[i]));
      const glm::dvec3 tangent = glm::dmat3(to_world) * unpackNormal(told.tangent[i]);
      EXPECT_NEAR(told.emission[i + n] - 2, tangent.x, 6.5e-5 + 16 * 0x1p-24);
      EXPECT_NEAR(told.emission[i + 2 * n] - 2, 0, 16 * 0x1p-24);
    }
  EXPECT_GT(shown, 2000);
}

TEST(UserSurface, ANewNormalIsUnitAndLightsBehindTheTrueSurfaceStayDark) {
  const Scene scene = sceneFromJson(surfacesScene());
  const GBuffer before = changedBy(surfaceOf(""), scene);
  // Turned by more than 90 degrees where it looks to the left.
  const GBuffer turned = changedBy(surfaceOf("s->normal.x += 3.0f;"), scene);
  const std::size_t n = turned.pixels();
  ASSERT_EQ(turned.unbent_normal.size(), n);
  EXPECT_TRUE(turned.geometric_normal.empty());
  for (std::size_t i = 0; i < n; ++i) {
    if (std::isinf(turned.position[i + 2 * n])) continue;
    const auto normal = [&](const GBuffer& g) {
      return glm::dvec3(g.normal[i], g.normal[i + n], g.normal[i + 2 * n]);
    };
    const glm::dmat3 to_world(turned.camera.camera_to_world);
    ASSERT_NEAR(glm::length(normal(turned)), 1, 5 * 0x1p-24);
    ASSERT_LE(glm::distance(to_world * normal(turned),
                            glm::normalize(to_world * normal(before) + glm::dvec3(3, 0, 0))),
              20 * 0x1p-24);
    ASSERT_LE(glm::distance(unpackNormal(turned.unbent_normal[i]), normal(before)), 6.6e-5);
  }
  EXPECT_EQ(turned.diffuse, before.diffuse);
}

TEST(UserSurface, NumbersThatAreNoSurfacesAreCountedAndKeptOut) {
  const Scene scene = sceneFromJson(surfacesScene("0.5", "0.25"));
  const GBuffer before = changedBy(surfaceOf(""), scene);
  const std::size_t n = before.pixels();
  std::uint64_t covered = 0;
  for (std::size_t i = 0; i < n; ++i) covered += !std::isinf(before.position[i + 2 * n]);
  for (const char* bad : {"0.0f / (s->position.x - s->position.x)", "1.0f / (s->position.x - s->position.x)",
                          "1e38f * 10.0f + 0.0f * s->position.x"}) {
    std::uint64_t faults = 0;
    const std::string number = bad;
    const GBuffer kept = changedBy(surfaceOf("s->diffuse.x = " + number + "; s->exponent = " + number +
                                             "; s->normal.y = " + number + ";"),
                                   scene, &faults);
    EXPECT_EQ(faults, covered) << bad;
    EXPECT_EQ(kept.diffuse, before.diffuse) << bad;
    EXPECT_EQ(kept.specular, before.specular) << bad;
    EXPECT_EQ(kept.normal, before.normal) << bad;
  }
  std::uint64_t faults = 0;
  const GBuffer zero = changedBy(
      surfaceOf("s->diffuse.y = (floatL)(-1.0f); s->exponent -= 100.0f; s->normal = scale3(s->normal, "
                "(floatL)(0.0f));"),
      scene, &faults);
  EXPECT_EQ(faults, covered);
  EXPECT_EQ(zero.normal, before.normal);
  for (std::size_t i = 0; i < n; ++i) {
    ASSERT_EQ(zero.diffuse[i + n], 0.0f);
    ASSERT_EQ(zero.specular[i + 3 * n], 0.0f);
    ASSERT_EQ(zero.diffuse[i], before.diffuse[i]);
  }
}

TEST(UserSurface, AGivenGBufferIsChangedBeforeItIsLit) {
  const Scene plain = sceneFromJson(surfacesScene("1")),
              wanted = sceneFromJson(surfacesScene("[0.25, 1, 1]", "0.5"));
  Stats stats;
  RenderSettings settings = settingsFor(plain, kSurfaceSize);
  const GBuffer given = rasterizeScene(nullptr, plain, settings, stats),
                want = rasterizeScene(nullptr, wanted, settings, stats);
  settings.surfaces = {surfaceOf(
      "s->diffuse.x = s->ambient.x = (floatL)(0.25f); s->specular.x = s->specular.y = s->specular.z "
      "= (floatL)(0.5f); s->exponent = (floatL)(16.0f);")};
  const Image changed = shadeGBuffer(testDevice(), plain, given, settings, stats);
  settings.surfaces.clear();
  EXPECT_EQ(changed.pixels, shadeGBuffer(testDevice(), wanted, want, settings, stats).pixels);
}

TEST(UserSurface, AMistakeIsToldWithItsPlace) {
  const Scene scene = sceneFromJson(surfacesScene());
  RenderSettings settings = settingsFor(scene, kSurfaceSize);
  settings.surfaces = {surfaceOf("s->diffuse.x = tint;")};
  EXPECT_THAT(messageOf<InputError>([&] { picture(scene, settings); }),
              testing::StartsWith("user.clh:2:16: "));
  settings.surfaces = {surfaceOf("while (true) {}")};
  EXPECT_THAT(messageOf<InputError>([&] { picture(scene, settings); }),
              testing::StartsWith("user.clh:2:1: "));
}

TEST(UserSurface, WithoutFunctionsNothingIsAskedForOrLaunched) {
  const Scene scene = sceneFromJson(surfacesScene());
  const RenderSettings settings = settingsFor(scene, kSurfaceSize);
  const PlaneSet planes = planPicture(scene, settings).planes;
  EXPECT_FALSE(planes.tangent || planes.uv || planes.object || planes.material || planes.specular);
  Stats stats;
  renderScene(testDevice(), scene, settings, stats);
  for (const auto& [stage, milliseconds] : stats.stages) EXPECT_NE(stage, Stage::kChangeSurfaces);
}

}  // namespace
}  // namespace luciole::test
