// Models from files of the user's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "kernels/probe.hpp"
#include "luciole/error.hpp"
#include "luciole/reference.hpp"
#include "reference/reference.hpp"
#include "render/plan.hpp"
#include "render_json.hpp"
#include "scene/models.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr glm::ivec2 kSeenSize{80, 45};
constexpr const char* kModelBegin =
    "INLINE Reflection reflect_light(const Surface *s, vec3L to_light, floatL n_dot_l) {\n";

/// The built-in models, moved into files.
const std::map<Model, std::string>& movedModels() {
  static const std::string lobe =
      "  floatL lobe = phong_lobe(s->light_way, s->inverse_light_way, s->mirrored_eye);\n"
      "  lobe = exp2_from(-63.0f, s->exponent, log2_one_plus(lobe));\n";
  static const std::map<Model, std::string> models{
      {Model::kPhong, kModelBegin + lobe + "  Reflection r = {n_dot_l, lobe};\n  return r;\n}\n"},
      {Model::kBlinnPhong,
       kModelBegin +
           std::string("  floatL lobe = blinn_lobe(s->light_way, s->inverse_light_way, s->to_eye, s->normal, "
                       "n_dot_l, "
                       "s->n_dot_v);\n  Reflection r = {n_dot_l, exp2_from(-63.0f, 0.5f * s->exponent, "
                       "log2_one_plus(lobe))};\n  return r;\n}\n")},
      {Model::kToon,
       kModelBegin + lobe + "  Reflection r = {toon(n_dot_l), toon_highlight(lobe)};\n  return r;\n}\n"},
      {Model::kCookTorrance,
       kModelBegin +
           std::string("  Glint glint = cook_torrance(cook_torrance_gloss(s->exponent, s->n_dot_v), "
                       "s->normal, to_light, s->to_eye, n_dot_l);\n"
                       "  Reflection r = {n_dot_l, glint.facing, glint.grazing};\n  return r;\n}\n")},
      {Model::kOrenNayar,
       kModelBegin + lobe +
           "  Reflection r = {oren_nayar(oren_nayar_roughness(s->exponent), to_light, s->to_eye, n_dot_l, "
           "s->n_dot_v), lobe};\n  return r;\n}\n"},
      {Model::kWard,
       kModelBegin +
           std::string("  Reflection r = {n_dot_l, ward_lobe(ward_sharpness(s->exponent), s->normal, "
                       "to_light, s->to_eye, n_dot_l, s->n_dot_v)};\n  return r;\n}\n")}};
  return models;
}

/// Two balls before a floor, under lights of all kinds with shadows.
Scene seenScene(int lights = 40) {
  return sceneFromJson(fmt::format(
      R"({{"camera": {{"eye": [0, 2, 6], "target": [0, 0.6, 0], "fov_y": 30}}, "ambient": 0.1,
      "materials": {{"a": {{"diffuse": [0.7, 0.5, 0.4], "specular": 0.4, "shininess": 20}},
                     "b": {{"diffuse": [0.2, 0.5, 0.6], "specular": 0.9, "shininess": 90}}}},
      "objects": [{{"primitive": "plane", "scale": 20, "segments": 9, "material": "a"}},
                  {{"primitive": "sphere", "segments": 24, "translate": [-1.1, 0.9, 0], "material": "a"}},
                  {{"primitive": "sphere", "segments": 24, "translate": [1.1, 0.9, 0.3], "material": "b"}}],
      "lights": [{{"type": "directional", "direction": [-1, -2, -1.5], "intensity": 0.5, "shadow": true}},
                 {{"type": "spot", "position": [2, 3, 3], "direction": [-2, -3, -3], "cutoff": 50}}],
      "light_fields": [{{"count": {}, "seed": 3, "min": [-4, 0, -3], "max": [4, 3, 4], "range": 3}}]}})",
      lights));
}

Model add(const std::string& text, Scene& scene, const std::string& path = "mine.clh") {
  scene.user_models.push_back({path, text});
  return userModel(scene.user_models.size() - 1);
}

RenderSettings settingsBy(Model model, const Scene& scene, ShadowMethod shadows = ShadowMethod::kExact) {
  RenderSettings settings = settingsFor(scene, kSeenSize);
  settings.shade.model = model;
  settings.shade.shadows = shadows;
  return settings;
}

TEST(UserModels, BuiltInModelsMovedIntoFilesGiveTheSameBits) {
  ASSERT_EQ(movedModels().size(), std::size(kAllModels));
  for (const int lights : {20, 300})  // by lists, by tiles
    for (const auto& [model, text] : movedModels()) {
      Scene scene = seenScene(lights);
      const ShadowMethod shadows = lights > 100 ? ShadowMethod::kOff : ShadowMethod::kExact;
      const Image built_in = picture(scene, settingsBy(model, scene, shadows));
      const Model moved = add(text, scene);
      EXPECT_EQ(picture(scene, settingsBy(moved, scene, shadows)).pixels, built_in.pixels)
          << modelName(model);
    }
}

TEST(UserModels, TheReferenceOfAMovedModelIsThatOfTheModel) {
  for (const auto& [model, text] : movedModels()) {
    Scene scene = seenScene(3);
    const std::vector<glm::ivec2> pixels{{20, 20}, {55, 20}, {60, 25}, {40, 40}, {0, 0}};
    const std::vector<glm::dvec3> built_in = referencePicture(scene, settingsBy(model, scene), pixels);
    const Model moved = add(text, scene);
    const std::vector<glm::dvec3> by_text = referencePicture(scene, settingsBy(moved, scene), pixels);
    // Some 64 roundings of 2^-53, and the lobe's power n makes an error of a direction √n times as large.
    for (std::size_t i = 0; i < pixels.size(); ++i)
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(by_text[i][c], built_in[i][c], 64 * 10 * 0x1p-53 * (1 + built_in[i][c]))
            << modelName(model);
  }
}

TEST(UserModels, OfMaterialsStandBesideBuiltInOnes) {
  Scene built_in = seenScene(), moved = seenScene();
  built_in.materials[0].model = Model::kCookTorrance;
  built_in.materials[1].model = Model::kOrenNayar;
  moved.materials[0].model = add(movedModels().at(Model::kCookTorrance), moved, "a.clh");
  moved.materials[1].model = add(movedModels().at(Model::kOrenNayar), moved, "b.clh");
  const Image truth = picture(built_in, settingsBy(Model::kPhong, built_in));
  for (const int lanes : widths())
    EXPECT_EQ(picture(moved, settingsBy(Model::kPhong, moved), deviceWithLanes(lanes)).pixels, truth.pixels)
        << lanes << " lanes";
  moved.materials[1].model = Model::kOrenNayar;
  EXPECT_EQ(picture(moved, settingsBy(Model::kPhong, moved)).pixels, truth.pixels);
}

TEST(UserModels, NamesOfOneFileAreNotThoseOfAnother) {
  const auto half = [](const char* share) {
    return fmt::format(
        "#define SHARE {}\n#define FOG 0\nINLINE floatL mirror(floatL x) {{ return x * SHARE; }}\n{}"
        "  Reflection r = {{mirror(n_dot_l)}};\n  return r;\n}}\n",
        share, kModelBegin);
  };
  Scene scene = seenScene(), whole = seenScene();
  scene.fog.mode = whole.fog.mode = FogMode::kExp;
  scene.fog.density = whole.fog.density = glm::vec3(0.1f);
  for (Scene* one : {&scene, &whole})
    for (Material& material : one->materials) material.specular = glm::vec3(0.0f);
  scene.materials[0].model = add(half("0.5f"), scene, "a.clh");
  scene.materials[1].model = add(half("0.25f"), scene, "b.clh");
  whole.materials[0].diffuse *= 0.5f;
  whole.materials[1].diffuse *= 0.25f;
  // Products with powers of two round alike.
  EXPECT_EQ(picture(scene, settingsBy(Model::kPhong, scene)).pixels,
            picture(whole, settingsBy(Model::kPhong, whole)).pixels);
}

TEST(UserModels, WhatIsNoLightCountsAsNoneAndItsPixelsAreCounted) {
  Scene dark = seenScene(5);
  const Model none = add(kModelBegin + std::string("  Reflection r = {0};\n  return r;\n}\n"), dark);
  const Image truth = picture(dark, settingsBy(none, dark));
  for (const char* wrong : {"-1.0f", "INFINITY", "NAN", "-INFINITY", "1e30f"}) {
    Scene scene = seenScene(5);
    const Model model =
        add(kModelBegin + fmt::format("  Reflection r = {{{0}, {0}}};\n  return r;\n}}\n", wrong), scene);
    Stats stats;
    const Image shown = renderScene(testDevice(), scene, settingsBy(model, scene), stats);
    EXPECT_EQ(shown.pixels, truth.pixels) << wrong;
    const std::uint64_t faulty = countOf(stats, "pixels_with_faulty_light");
    EXPECT_GT(faulty, 500u) << wrong;
    EXPECT_LE(faulty, countOf(stats, "pixels_lit")) << wrong;
  }
}

TEST(UserModels, AFaultBehindTheSurfaceIsNone) {
  Scene scene = seenScene(5);
  const Model model =
      add(kModelBegin +
              std::string(
                  "  floatL nan = n_dot_l > 0.0f ? n_dot_l : (floatL)(NAN);\n  Reflection r = {nan, nan};\n"
                  "  return r;\n}\n"),
          scene);
  Stats stats;
  renderScene(testDevice(), scene, settingsBy(model, scene), stats);
  EXPECT_EQ(countOf(stats, "pixels_with_faulty_light"), 0u);
}

TEST(UserModels, AFaultyPixelKeepsTheLightOfOtherModelsAndPixels) {
  Scene scene = seenScene(5), truth = seenScene(5);
  scene.materials[1].model =
      add(kModelBegin + std::string("  Reflection r = {NAN, NAN};\n  return r;\n}\n"), scene);
  truth.materials[1].model =
      add(kModelBegin + std::string("  Reflection r = {0, 0};\n  return r;\n}\n"), truth);
  EXPECT_EQ(picture(scene, settingsBy(Model::kPhong, scene)).pixels,
            picture(truth, settingsBy(Model::kPhong, truth)).pixels);
}

TEST(UserModels, BandsSamplesAndLayersAreThoseOfBuiltInModels) {
  Scene scene = seenScene(), built_in = seenScene();
  const Model moved = add(movedModels().at(Model::kBlinnPhong), scene);
  const auto shoot = [](const Scene& of, Model model) {
    RenderSettings settings = settingsBy(model, of);
    settings.samples = 4;
    settings.aovs = {Aov::kSpecularLight, Aov::kShadow};
    settings.light_groups = true;
    settings.band_height = 16;
    settings.crop = Crop{3, 5, 60, 37};
    return picture(of, settings).pixels;
  };
  EXPECT_EQ(shoot(scene, moved), shoot(built_in, Model::kBlinnPhong));
}

TEST(UserModels, LightsOfAnAllowedErrorAreSummedOneByOne) {
  Scene scene = seenScene(300);
  const Model model = add(movedModels().at(Model::kPhong), scene);
  RenderSettings settings = settingsBy(model, scene, ShadowMethod::kOff);
  settings.shade.light_error = 0.1f;
  settings.shade.always_clusters = true;
  EXPECT_FALSE(planPicture(scene, settings).features.has(Feature::kClusteredLights));
}

TEST(UserModels, ATextThatDoesNotCompileIsToldByItsPlace) {
  Scene scene = seenScene(5);
  const Model model = add(
      kModelBegin +
          std::string("  floatL a = n_dot_l / 2.0f + undeclared;\n  Reflection r = {a};\n  return r;\n}\n"),
      scene, "dir/mine.clh");
  try {
    picture(scene, settingsBy(model, scene));
    FAIL() << "it compiled";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), StartsWith("dir/mine.clh:2:31: "));
    EXPECT_THAT(error.what(), HasSubstr("undeclared"));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

TEST(UserModels, TheLargestTextThatIsAllowedCompiles) {
  std::string text;
  std::size_t lines = 0;
  for (int i = 0; i < 12; ++i, ++lines)
    text += fmt::format(
        "INLINE floatL f{}(floatL x) {{ UNROLLED(i, 16) {{ x = fma_lanes(x, x, 0.1f) * 0.5f; }} return x; "
        "}}\n",
        i);
  text += kModelBegin;
  for (int i = 0; i < 12; ++i) text += fmt::format("  n_dot_l = f{}(n_dot_l);\n", i);
  text += "  Reflection r = {n_dot_l};\n  return r;\n}\n";
  Scene scene = seenScene(5);
  EXPECT_NO_THROW(picture(scene, settingsBy(add(text, scene), scene)));
}

TEST(UserModels, AFileIsAddedOnceAndNotWithoutItsFunction) {
  const TemporaryFolder folder;
  writeText(folder / "phong.clh", movedModels().at(Model::kPhong));
  writeText(folder / "none.clh", "INLINE floatL lobe(floatL x) { return x; }\n");
  Scene scene;
  EXPECT_EQ(addUserModel(folder / "phong.clh", scene), userModel(0));
  EXPECT_EQ(addUserModel(folder / "phong.clh", scene), userModel(0));
  EXPECT_EQ(scene.user_models.size(), 1u);
  EXPECT_THROW(addUserModel(folder / "none.clh", scene), InputError);
  EXPECT_THROW(addUserModel(folder / "absent.clh", scene), InputError);
}

}  // namespace
}  // namespace luciole::test
