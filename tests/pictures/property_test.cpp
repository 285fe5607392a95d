// What holds for every scene, tried on random ones. A scene that fails is shrunk and left as a file, and the
// message says how to see the failure from the command line. Every run takes the same seeds; LUCIOLE_SEED in
// the environment starts elsewhere. From 1000000 on scenes are of more kinds, most with a program of their
// own to compile:
//
//   for s in $(seq 100 100 20000); do LUCIOLE_SEED=$s build/tests/pictures_test --gtest_filter='Property.*'
//   || break; done
#include <gtest/gtest.h>

#include <cstring>

#include "kernels/probe.hpp"
#include "kernels/shade_bounds.hpp"
#include "lighting/light_gbuffer.hpp"
#include "long_run.hpp"
#include "pictures/scene_hunt.hpp"
#include "reference/reference.hpp"
#include "render/plan.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

using Failure = std::optional<std::string>;

struct Case {
  Scene scene;
  RenderSettings settings;
};

/// With smaller shadow maps than the command line's, to save time.
Case caseOf(const SceneJson& json, ShadowMethod shadows) {
  Case made{sceneFromJson(json.dump()), {}};
  if (!made.scene.size) throw InputError("size is missing");
  made.settings.size = *made.scene.size;
  made.settings.camera = made.scene.cameras.front();
  made.settings.shade = {
      .model = modelFor(*made.scene.size), .shadows = shadows, .shadow_limits = {.size = 256}};
  return made;
}

Image pictureOf(const Case& of, OpenedDevice& device = testDevice()) {
  Stats stats;
  return renderScene(device, of.scene, of.settings, stats);
}

Image pictureOf(const SceneJson& json, ShadowMethod shadows) { return pictureOf(caseOf(json, shadows)); }

GBuffer gbufferOf(const Case& of) {
  Stats stats;
  return rasterizeScene(nullptr, of.scene, of.settings, stats);
}

/// Where value i of a picture lies.
std::string where(const Image& image, std::size_t i) {
  const std::size_t channels = image.channels.size(), pixel = i / channels;
  return fmt::format("pixel {},{} channel {}", pixel % image.width, pixel / image.width,
                     image.channels[i % channels]);
}

/// Values for which `differ` says so, or nothing.
template <class Differ>
Failure differences(const Image& a, const Image& b, Differ differ) {
  std::size_t count = 0, first = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    if (differ(a.pixels[i], b.pixels[i]) && count++ == 0) first = i;
  if (count == 0) return std::nullopt;
  return fmt::format("{}: {:.9g} and {:.9g}; {} of {} values differ", where(a, first), a.pixels[first],
                     b.pixels[first], count, a.pixels.size());
}

Failure unequal(const Image& a, const Image& b) {
  return differences(a, b, [](float x, float y) { return !(x == y); });
}

Image cutOut(const Image& image, const Crop& crop) {
  Image part{crop.width, crop.height, image.channels, {}};
  const std::size_t channels = image.channels.size();
  for (int y = crop.y; y < crop.y + crop.height; ++y) {
    const auto row =
        image.pixels.begin() + std::ptrdiff_t((std::size_t(y) * image.width + crop.x) * channels);
    part.pixels.insert(part.pixels.end(), row, row + std::ptrdiff_t(crop.width * channels));
  }
  return part;
}

Failure cullingChangesSomething(const SceneJson& json, Shading shading) {
  Case made = caseOf(json, ShadowMethod::kPcf);
  made.settings.shading = shading;
  made.settings.shade.culling = Culling::kNone;
  const Image all = pictureOf(made);
  made.settings.shade.culling = Culling::kTiles;
  for (const int tile_size : {4, 8, 16}) {
    made.settings.shade.tile_size = tile_size;
    if (const auto different = unequal(all, pictureOf(made)))
      return fmt::format("tiles of {}: {}", tile_size, *different);
  }
  return std::nullopt;
}

constexpr const char* kCullingCommands =
    "luciole render $SCENE --model $MODEL --culling none -o none.exr && for n in 4 8 16; do "
    "luciole render $SCENE --model $MODEL --tile $n -o $n.exr && "
    "luciole compare $n.exr none.exr --max-abs 0; done";

TEST(Property, CullingChangesNothing) {
  const auto failure =
      hunt({"Culling", kCullingCommands,
            [](const SceneJson& json) { return cullingChangesSomething(json, Shading::kPhong); }},
           firstSeed(), 36);
  EXPECT_FALSE(failure) << *failure;
}

// Vertices are culled in tiles of their own. Only scenes without fog, to keep to few programs.
TEST(Property, CullingChangesNothingAtVertices) {
  for (const unsigned kind : {0, 3}) {
    const auto failure =
        hunt({"GouraudCulling", fmt::format("(the same with --shading gouraud) {}", kCullingCommands),
              [](const SceneJson& json) { return cullingChangesSomething(json, Shading::kGouraud); }},
             firstSeed() + kind, 8, std::size(kSceneKinds));
    EXPECT_FALSE(failure) << *failure;
  }
}

// A crop begins its tiles at its own corner: so the same pixels lie in
// tiles with other pixels, of smaller tiles at the edges, and have other lists.
TEST(Property, TilesAndCropsChangeNothing) {
  const auto failure = hunt(
      {"Crop",
       "luciole render $SCENE --model $MODEL -o whole.exr && "
       "luciole render $SCENE --model $MODEL --crop 5,3,9,11 -o crop.exr",
       [](const SceneJson& json) -> Failure {
         Case made = caseOf(json, ShadowMethod::kPcf);
         const Image whole = pictureOf(made);
         const glm::ivec2 size = made.settings.size;
         for (const Crop& crop :
              {Crop{1, 1, size.x - 1, size.y - 1}, {5, 3, 9, 11}, {3, 7, size.x / 2, size.y / 2}}) {
           made.settings.crop = crop;
           if (const auto different = unequal(cutOut(whole, crop), pictureOf(made)))
             return fmt::format("crop {},{},{},{}: {}", crop.x, crop.y, crop.width, crop.height, *different);
         }
         return std::nullopt;
       }},
      firstSeed(), 24);
  EXPECT_FALSE(failure) << *failure;
}

// A feature that isn't used adds 0, multiplies by 1 or isn't chosen, and what is left are the same
// operations.
TEST(Property, UnusedFeaturesChangeNothing) {
  const auto failure =
      hunt({"Features", "(only a test can compile more than a scene needs)",
            [](const SceneJson& json) -> Failure {
              const Case made = caseOf(json, ShadowMethod::kPcf);
              const RenderSettings& settings = made.settings;
              const GBuffer gbuffer = gbufferOf(made);
              SurfaceTraits surfaces = materialTraits(made.scene);
              surfaces.smooth = !gbuffer.lift.empty();
              const ShadeSettings shade = planPicture(made.scene, settings).shade;
              const FeatureSet needed = neededFeatures(made.scene, settings.camera, surfaces, shade);
              Lighting lighting;
              Stats stats;
              prepareLighting(testDevice(), made.scene, settings.camera,
                              cameraView(settings.camera, settings.size), needed, shade, lighting, stats);
              const Plane least =
                  lightGBuffer(testDevice(), made.scene, lighting, {lighting.lights, needed, gbuffer}, stats)
                      .color;
              const Plane most = lightGBuffer(testDevice(), made.scene, lighting,
                                              {lighting.lights, everyFeature(needed), gbuffer}, stats)
                                     .color;
              for (std::size_t i = 0; i < least.size(); ++i)
                if (least[i] != most[i])
                  return fmt::format("value {}: {:.9g} by the least program, {:.9g} by the full", i, least[i],
                                     most[i]);
              return std::nullopt;
            }},
           firstSeed(), 24);
  EXPECT_FALSE(failure) << *failure;
}

void scale(SceneJson& parent, const char* key, double factor) {
  if (!parent.contains(key)) return;
  if (!parent[key].is_array()) {
    parent[key] = factor * parent[key].get<double>();
    return;
  }
  for (SceneJson& component : parent[key]) component = factor * component.get<double>();
}

/// The scene with every light source `factor` times as strong.
SceneJson brighter(SceneJson scene, double factor) {
  scale(scene, "background", factor);
  scale(scene, "ambient", factor);
  if (scene.contains("fog")) scale(scene["fog"], "color", factor);
  if (scene.contains("materials"))
    for (auto& [name, material] : scene["materials"].items()) scale(material, "emission", factor);
  if (scene.contains("lights")) {
    for (SceneJson& light : scene["lights"]) {
      if (!light.contains("intensity")) light["intensity"] = 1.0;
      scale(light, "intensity", factor);
    }
  }
  return scene;
}

constexpr const char* kLookAtScene = "luciole render $SCENE --model $MODEL -o picture.exr";

// A power of two scales every product and sum exactly, unless one is below the normal numbers, where it
// counts as 0: one a light and channel, and a few of the material and the fog. By 3, colours round otherwise:
// a product with the intensity, one with the strength, a sum for each light, and ten for material and fog, in
// both pictures; all terms are positive.
TEST(Property, BrighterLightsScaleThePicture) {
  const auto failure = hunt(
      {"Scaling", kLookAtScene,
       [](const SceneJson& json) -> Failure {
         const Image once = pictureOf(json, ShadowMethod::kPcf);
         const double terms = (json.contains("lights") ? double(json["lights"].size()) : 0.0) + 12;
         for (const double factor : {0.25, 8.0, 3.0}) {
           const double error = factor == 3 ? 2 * terms * kUnit : 0;
           const auto wrong = differences(
               once, pictureOf(brighter(json, factor), ShadowMethod::kPcf), [&](float a, float b) {
                 return !(std::abs(b - factor * a) <= error * factor * a + terms * (factor + 1) * 0x1p-126);
               });
           if (wrong) return fmt::format("{} times as bright: {}", factor, *wrong);
         }
         return std::nullopt;
       }},
      firstSeed(), 24);
  EXPECT_FALSE(failure) << *failure;
}

// One program runs at every width, only what says so is contracted, and every lane does what a scalar does.
TEST(Property, LanesChangeNothing) {
  const auto failure =
      hunt({"Lanes",
            "for n in 1 4 8 16; do luciole render $SCENE --model $MODEL --device ,lanes=$n -o $n.exr; done; "
            "for n in 1 4 8; do luciole compare $n.exr 16.exr --max-abs 0; done",
            [](const SceneJson& json) -> Failure {
              const Case made = caseOf(json, ShadowMethod::kPcf);
              const Image scalar = pictureOf(made, deviceWithLanes(1));
              for (const int lanes : {4, 8, 16})
                if (const auto different = unequal(scalar, pictureOf(made, deviceWithLanes(lanes))))
                  return fmt::format("1 lane and {}: {}", lanes, *different);
              return std::nullopt;
            }},
           firstSeed(), 12);
  EXPECT_FALSE(failure) << *failure;
}

/// PoCL as devices compute that differ from it in what OpenCL leaves open: quotients that aren't rounded
/// right, denormals that aren't flushed, and what an integer becomes that a float doesn't fit into.
OpenedDevice& otherDevice(std::size_t which) {
  static const char* const kArithmetic[] = {
      "-cl-denorms-are-zero -DOWN_QUOTIENTS", "-cl-fp32-correctly-rounded-divide-sqrt",
      "-cl-denorms-are-zero -cl-fp32-correctly-rounded-divide-sqrt -DSATURATING"};
  static OpenedDevice devices[std::size(kArithmetic)];
  OpenedDevice& device = devices[which];
  if (!device.context()) {
    openDevice("", device);
    device.arithmetic = kArithmetic[which];
  }
  return device;
}

// Of exact shadows shading reads a bit, whatever the model and the fog are: scenes of the first kind will do.
TEST(Property, WhatOpenCLLeavesOpenChangesNothing) {
  for (const ShadowMethod shadows : {ShadowMethod::kPcf, ShadowMethod::kExact}) {
    const unsigned step = shadows == ShadowMethod::kExact ? std::size(kSceneKinds) : 1;
    const auto failure =
        hunt({"Arithmetic", "(as for Lanes, on a device whose arithmetic is another's)",
              [&](const SceneJson& json) -> Failure {
                const Case made = caseOf(json, shadows);
                const Image usual = pictureOf(made);
                for (const std::size_t which : {0, 1, 2})
                  if (const auto different = unequal(usual, pictureOf(made, otherDevice(which))))
                    return fmt::format("arithmetic {}: {}", which, *different);
                return std::nullopt;
              }},
             firstSeed(), longRun() ? 12 : 6, step);
    EXPECT_FALSE(failure) << *failure;
  }
}

// Light so faint that its products leave the range of floats: where they are flushed must not show beside
// what is visible, and colours down to 2^-40 are.
TEST(Property, FaintLightIsTheSameWhereDenormalsAreKept) {
  for (const int exponent : {0, -20, -40}) {
    const auto failure = hunt({"Faint", "(as for Lanes, on a device that keeps denormals)",
                               [&](const SceneJson& json) -> Failure {
                                 Case made = caseOf(json, ShadowMethod::kPcf);
                                 for (Light& light : made.scene.lights)
                                   for (glm::vec3* color : {&light.ambient, &light.diffuse, &light.specular})
                                     *color *= std::ldexp(1.0f, exponent);
                                 made.scene.ambient = made.scene.background = made.scene.fog.color =
                                     glm::vec3(0);
                                 return unequal(pictureOf(made), pictureOf(made, otherDevice(1)));
                               }},
                              firstSeed(), 12);
    EXPECT_FALSE(failure) << "lights of 2^" << exponent << "\n" << *failure;
  }
}

Failure shadowsAreWrong(const SceneJson& json) {
  const Image lit = pictureOf(json, ShadowMethod::kOff), shadowed = pictureOf(json, ShadowMethod::kPcf);
  if (const auto bad =
          differences(lit, shadowed, [](float a, float b) { return !std::isfinite(a) || !std::isfinite(b); }))
    return fmt::format("not finite: {}", *bad);
  return differences(lit, shadowed, [](float a, float b) { return b > a; });
}

// A visibility in [0, 1] multiplies a light's strength, and all that follows rounds monotonically.
TEST(Property, ShadowsOnlyDarkenAndEverythingIsFinite) {
  const auto failure = hunt({"Shadows",
                             "luciole render $SCENE --model $MODEL --shadows off -o lit.exr && "
                             "luciole render $SCENE --model $MODEL -o shadowed.exr",
                             shadowsAreWrong},
                            firstSeed(), 24);
  EXPECT_FALSE(failure) << *failure;
}

/// What is wrong with a picture by the intervals that float shading may reach, or with the reference.
Failure outsideBounds(const Case& of, const GBuffer& gbuffer, const Image& image) {
  const Image reference = referenceShade(of.scene, gbuffer, {.model = of.settings.shade.model});
  for (int y = 0; y < gbuffer.height; ++y) {
    for (int x = 0; x < gbuffer.width; ++x) {
      const std::size_t place = gbuffer.index(x, y);
      for (int c = 0; c < 3; ++c) {
        const std::size_t i = (std::size_t(y) * gbuffer.width + x) * 3 + c;
        const float got = image.pixels[i], exact = reference.pixels[i];
        Interval bounds{of.scene.background[c], of.scene.background[c]};
        if (std::isfinite(gbuffer.position[place + 2 * gbuffer.pixels()]))
          bounds = shadeInterval(of.scene, gbuffer, place, c, of.settings.shade.model).widened(2 * kUnit);
        if (!(got >= bounds.low && got <= bounds.high))
          return fmt::format("{}: {:.9g} outside {:.9g} to {:.9g}", where(image, i), got, bounds.low,
                             bounds.high);
        if (!(exact >= bounds.low && exact <= bounds.high))
          return fmt::format("{}: the reference's {:.9g} outside {:.9g} to {:.9g}", where(image, i), exact,
                             bounds.low, bounds.high);
      }
    }
  }
  return std::nullopt;
}

TEST(Property, PicturesAgreeWithTheReference) {
  const auto failure = hunt({"Reference", fmt::format("{} --shadows off", kLookAtScene),
                             [](const SceneJson& json) {
                               const Case made = caseOf(json, ShadowMethod::kOff);
                               return outsideBounds(made, gbufferOf(made), pictureOf(made));
                             }},
                            firstSeed(), 36);
  EXPECT_FALSE(failure) << *failure;
}

/// Turns a direction about the world's z axis.
glm::dvec3 turned(const SceneJson& json, double degrees) {
  const double c = std::cos(glm::radians(degrees)), s = std::sin(glm::radians(degrees));
  const glm::dvec3 v(json.at(0), json.at(1), json.at(2));
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

void turn(SceneJson& parent, const char* key, double degrees, const glm::dvec3& offset,
          const glm::dvec3& fallback) {
  const glm::dvec3 v =
      turned(parent.value(key, SceneJson{fallback.x, fallback.y, fallback.z}), degrees) + offset;
  parent[key] = {v.x, v.y, v.z};
}

/// The whole scene, camera included, turned about z and moved. Before a background of its own, so that fog
/// hides no object: how much it hides is decided by boxes along the world's axes, which don't turn.
SceneJson moved(SceneJson scene, double degrees, const glm::dvec3& offset) {
  scene["background"] = {2.0, 2.0, 2.0};
  if (!scene.contains("camera") || !scene["camera"].contains("eye") || !scene["camera"].contains("target"))
    throw InputError("the camera is missing");
  const glm::dvec3 nowhere(0);
  turn(scene["camera"], "eye", degrees, offset, nowhere);
  turn(scene["camera"], "target", degrees, offset, nowhere);
  turn(scene["camera"], "up", degrees, nowhere, {0, 1, 0});
  if (scene.contains("objects")) {
    for (SceneJson& object : scene["objects"]) {
      turn(object, "translate", degrees, offset, nowhere);
      if (!object.contains("rotate")) object["rotate"] = {0.0, 0.0, 0.0};
      object["rotate"][2] = object["rotate"][2].get<double>() + degrees;
    }
  }
  if (scene.contains("lights")) {
    for (SceneJson& light : scene["lights"]) {
      if (light.contains("position")) turn(light, "position", degrees, offset, nowhere);
      if (light.contains("direction")) turn(light, "direction", degrees, nowhere, nowhere);
    }
  }
  return scene;
}

/// Coordinates of a hundred metres are off by some 10⁻¹³ in double, which the view's rotation and a surface
/// seen edge on may multiply; rounded to float they then differ by an ulp at most.
bool nearlyEqual(float a, float b, double size) { return std::abs(double(a) - b) <= 2 * kUnit * size + 1e-9; }

/// Whether all that shading reads of a pixel is the same in both, to the bit; or else what differs by more
/// than an ulp.
struct PixelInput {
  bool equal = true;
  Failure failure;
};

PixelInput comparePixel(const GBuffer& a, const GBuffer& b, std::size_t place) {
  const std::size_t n = a.pixels();
  PixelInput input;
  const double distance =
      std::abs(a.position[place]) + std::abs(a.position[place + n]) + std::abs(a.position[place + 2 * n]);
  for (int c = 0; c < 3; ++c) {
    const std::size_t i = place + c * n;
    input.equal &= a.position[i] == b.position[i] && a.normal[i] == b.normal[i];
    if (a.position[i] != b.position[i] && !nearlyEqual(a.position[i], b.position[i], distance))
      input.failure = fmt::format("position {:.9g} and {:.9g}", a.position[i], b.position[i]);
    if (!nearlyEqual(a.normal[i], b.normal[i], 1))
      input.failure = fmt::format("normal {:.9g} and {:.9g}", a.normal[i], b.normal[i]);
    if (a.diffuse[i] != b.diffuse[i] || a.specular[i] != b.specular[i] || a.emission[i] != b.emission[i])
      input.failure = "another material";
  }
  return input;
}

Failure movingChangesSomething(const SceneJson& json, double degrees, const glm::dvec3& offset) {
  const Case here = caseOf(moved(json, 0, glm::dvec3(0)), ShadowMethod::kOff);
  const Case there = caseOf(moved(json, degrees, offset), ShadowMethod::kOff);
  const GBuffer a = gbufferOf(here), b = gbufferOf(there);
  const Image image_a = pictureOf(here), image_b = pictureOf(there);
  const auto lights_a = prepareLights(here.scene, here.settings.camera, {});
  const auto lights_b = prepareLights(there.scene, there.settings.camera, {});
  const bool equal_lights =
      std::memcmp(lights_a.data(), lights_b.data(), lights_a.size() * sizeof(ShadeLight)) == 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const PixelInput input = comparePixel(a, b, a.index(x, y));
      if (input.failure) return fmt::format("pixel {},{}: {}", x, y, *input.failure);
      if (!input.equal || !equal_lights) continue;
      for (int c = 0; c < 3; ++c) {
        const std::size_t i = (std::size_t(y) * a.width + x) * 3 + c;
        if (image_a.pixels[i] != image_b.pixels[i])
          return fmt::format("{}: {:.9g} and {:.9g} of equal surfaces and lights", where(image_a, i),
                             image_a.pixels[i], image_b.pixels[i]);
      }
    }
  }
  return outsideBounds(there, b, image_b);
}

// Moved, every surface and light has the same place before the camera, but for a rounding in double. So what
// shading reads is equal to the bit nearly everywhere and off by an ulp elsewhere; equal input gives equal
// pixels, and the others are held to the bounds of their own input. No pixel may change its surface: samples
// lie within 10⁻¹³ pixels of a random triangle's edge, snapped to 1/256 pixel, in none of millions.
TEST(Property, MovingCameraAndSceneTogetherChangesNothing) {
  const auto failure = hunt({"Moving", kLookAtScene,
                             [](const SceneJson& json) -> Failure {
                               if (const auto wrong = movingChangesSomething(json, 0, {60.125, -17.5, 31.25}))
                                 return fmt::format("moved: {}", *wrong);
                               if (const auto wrong = movingChangesSomething(json, 40.7, {0, 0, 0}))
                                 return fmt::format("turned: {}", *wrong);
                               return std::nullopt;
                             }},
                            firstSeed(), 24);
  EXPECT_FALSE(failure) << *failure;
}

}  // namespace
}  // namespace luciole::test
