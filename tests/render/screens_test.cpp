// Screens: functions of the user's that change lit colours by what is around each pixel.
#include "render/screens.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/probe.hpp"
#include "lighting/count_picture.hpp"
#include "luciole/error.hpp"
#include "render/share_picture.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kScreensScene =
    R"({"camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0], "fov_y": 60}, "background": [0, 0, 0.25], "ambient": 0.1,
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}, "e": {"emission": [0.2, 0.1, 0]}},
  "objects": [{"primitive": "plane", "scale": 9, "segments": 9, "material": "m"}, {"primitive": "sphere", "translate": [0, 1, 0], "material": "m"},
              {"primitive": "torus", "translate": [1, 0.5, 2], "rotate": [60, 0, 20], "material": "e"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "intensity": 0.5, "shadow": true},
             {"type": "point", "position": [1, 2, 2], "range": 4, "shadow": true, "color": [1, 0.5, 0.2]}],
  "light_fields": [{"count": 60, "seed": 3, "min": [-4, 0, -4], "max": [4, 2, 4], "range": 0.8, "intensity": 0.5}]})";

Shader screenOf(const std::string& text) { return {"mine.clh", text}; }

const Shader kIdentity = screenOf(
    "#define RADIUS 0\n"
    "INLINE vec3L screen(const Screen *at) { return color_at(at, 0, 0); }\n");

const Shader kBlur = screenOf(R"(#define RADIUS 8
INLINE vec3L screen(const Screen *at) {
  vec3L sum = scale3(color_at(at, 0, 0), (floatL)(0.0f));
  EACH_NEIGHBOR(dx, dy) {
    vec3L color = color_at(at, dx, dy);
    sum.x += color.x;
    sum.y += color.y;
    sum.z += color.z;
  }
  return scale3(sum, (floatL)(1.0f / 289));
}
)");

/// Has of all that a screen sees.
const Shader kEverything = screenOf(R"(#define RADIUS 2
INLINE vec3L screen(const Screen *at) {
  vec3L color = color_at(at, -2, 1), normal = normal_at(at, 2, 0), place = position_at(at, 0, -2);
  vec3L from_eye = from_eye_at(at, 1, 1), to_eye = to_eye_at(at, 0, 0);
  floatL depth = min_lanes(depth_at(at, 1, 2), (floatL)(100.0f)), pixel = pixel_size_at(at, 0, 0);
  intL ids = object_at(at, 2, -2) + 2 * material_at(at, -1, 0);
  floatL seen = object_at(at, 0, 0) >= 0 ? abs_lanes(to_eye.x) + pixel : (floatL)(0.0f);
  floatL grain = convert_floatL((at->x + 3 * at->y) & 7) + at->width + at->height;
  color.x = 0.5f * color.x + 0.01f * abs_lanes(normal.x + normal.y) + 0.001f * grain;
  color.y = 0.5f * color.y + 0.01f * abs_lanes(place.x - from_eye.z) + 0.01f * convert_floatL(ids + 3);
  color.z = 0.5f * color.z + 0.001f * depth + 0.1f * seen;
  return color;
}
)");

RenderSettings screened(const Scene& scene, glm::ivec2 size, const std::vector<Shader>& screens) {
  RenderSettings settings = settingsFor(scene, size);
  settings.screens = screens;
  return settings;
}

TEST(Screens, OneThatReturnsTheColorLeavesEveryBit) {
  const Scene scene = sceneFromJson(kScreensScene);
  for (const int lanes : widths()) {
    for (const float exposure : {0.0f, 0.3f}) {
      RenderSettings settings = screened(scene, {77, 43}, {});
      settings.exposure = exposure;
      const Image without = picture(scene, settings, deviceWithLanes(lanes));
      settings.screens = {kIdentity, kIdentity};
      EXPECT_EQ(picture(scene, settings, deviceWithLanes(lanes)).pixels, without.pixels) << lanes;
    }
  }
}

TEST(Screens, SeeEachSampleByItself) {
  const Scene scene = sceneFromJson(kScreensScene);
  RenderSettings settings = screened(scene, {50, 40}, {});
  settings.samples = 4;
  settings.sample_shading = SampleShading::kAll;
  settings.exposure = 1;  // a factor that rounds nothing
  const Image all = picture(scene, settings);
  settings.screens = {kIdentity};
  EXPECT_EQ(picture(scene, settings).pixels, all.pixels);
  settings.sample_shading = SampleShading::kShared;
  EXPECT_EQ(picture(scene, settings).pixels, all.pixels);
}

TEST(Screens, ABlurOfTheLargestRadiusIsTheHosts) {
  const Scene scene = sceneFromJson(kScreensScene);
  const glm::ivec2 size(37, 29);
  const Image sharp = picture(scene, screened(scene, size, {}));
  const Image blurred = picture(scene, screened(scene, size, {kBlur}));
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      for (int c = 0; c < 3; ++c) {
        float sum = sharp.pixels[3 * std::size_t(y * size.x + x) + std::size_t(c)] * 0.0f;
        for (int dy = -8; dy <= 8; ++dy)
          for (int dx = -8; dx <= 8; ++dx) {
            const glm::ivec2 at = glm::clamp(glm::ivec2(x + dx, y + dy), glm::ivec2(0), size - 1);
            sum += sharp.pixels[3 * std::size_t(at.y * size.x + at.x) + std::size_t(c)];
          }
        // The same sums in the same order.
        ASSERT_EQ(blurred.pixels[std::size_t(3 * (y * size.x + x) + c)], sum * (1.0f / 289)) << x << " " << y;
      }
}

TEST(Screens, BandsAndCropsAndWidthsChangeNoBit) {
  const Scene scene = sceneFromJson(kScreensScene);
  const glm::ivec2 size(93, 86);
  for (const int samples : {1, 3}) {
    RenderSettings settings = screened(scene, size, {kEverything, kBlur, kEverything});
    settings.samples = samples;
    const Image whole = picture(scene, settings);
    for (const int height : {13, 16, 32}) {
      settings.band_height = height;
      EXPECT_EQ(picture(scene, settings).pixels, whole.pixels) << height;
    }
    settings.band_height = 0;
    EXPECT_EQ(picture(scene, settings, deviceWithLanes(1)).pixels, whole.pixels);
    EXPECT_EQ(picture(scene, settings, deviceWithLanes(4)).pixels, whole.pixels);
    for (const Crop crop :
         {Crop{0, 0, 1, 1}, Crop{17, 31, 41, 23}, Crop{92, 3, 1, 83}, Crop{5, 70, 88, 16}}) {
      settings.crop = crop;
      const Image part = picture(scene, settings);
      ASSERT_EQ(part.width, crop.width);
      ASSERT_EQ(part.height, crop.height);
      for (int y = 0; y < crop.height; ++y)
        for (int i = 0; i < 3 * crop.width; ++i)
          ASSERT_EQ(part.pixels[std::size_t(3 * y * crop.width + i)],
                    whole.pixels[std::size_t(3 * ((crop.y + y) * size.x + crop.x) + i)])
              << crop.x << " " << crop.y << ": " << i / 3 << " " << y;
    }
  }
}

TEST(Screens, BandsOfClusteredLightChangeNoBit) {
  const Scene scene = sceneFromJson(kScreensScene);
  RenderSettings settings = screened(scene, {80, 150}, {kBlur});
  settings.crop = Crop{7, 11, 60, 134};
  settings.shade.shadows = ShadowMethod::kOff;
  settings.shade.light_error = 1.0f / 64;
  settings.shade.always_clusters = true;
  const Image whole = picture(scene, settings);
  settings.band_height = 64;
  EXPECT_EQ(picture(scene, settings).pixels, whole.pixels);
}

TEST(Screens, TwoDevicesGiveTheBitsOfOne) {
  const Scene scene = sceneFromJson(kScreensScene);
  RenderSettings settings = screened(scene, {100, 150}, {kBlur, kEverything});
  settings.band_height = 16;
  std::list<OpenedDevice> devices;
  std::list<Sharer> sharers;
  for (const char* selector : {",lanes=16", ",lanes=4"}) {
    openDevice(selector, devices.emplace_back());
    sharers.push_back({&devices.back()});
  }
  Image shared;
  Stats stats;
  renderShared(
      sharers, scene, settings,
      [&](const Image& rows) {
        shared.pixels.insert(shared.pixels.end(), rows.pixels.begin(), rows.pixels.end());
      },
      stats);
  EXPECT_EQ(shared.pixels, picture(scene, settings).pixels);
}

TEST(Screens, AGivenGBufferIsThePictureOfItsScene) {
  const Scene scene = sceneFromJson(kScreensScene);
  RenderSettings settings = screened(scene, {61, 47}, {kEverything, kBlur});
  settings.shade.shadows = ShadowMethod::kExact;
  settings.exposure = -0.7f;
  Stats stats;
  GBuffer gbuffer = rasterizeScene(nullptr, scene, settings, stats);
  // Files have no numbers of objects and materials.
  const Shader no_ids = screenOf([&] {
    std::string text = kEverything.text;
    const std::string ids = "object_at(at, 2, -2) + 2 * material_at(at, -1, 0)";
    return text.replace(text.find(ids), ids.size(), "at->x & 3");
  }());
  settings.screens = {no_ids, kBlur};
  EXPECT_EQ(shadeGBuffer(testDevice(), scene, gbuffer, settings, stats).pixels,
            picture(scene, settings).pixels);
}

TEST(Screens, SeeObjectsMaterialsAndTheBackground) {
  const Scene scene = sceneFromJson(kScreensScene);
  RenderSettings settings = screened(scene, {60, 50}, {screenOf(R"(#define RADIUS 1
INLINE vec3L screen(const Screen *at) {
  vec3L color = color_at(at, 0, 0);
  color.x = convert_floatL(object_at(at, 0, 0) + 1);
  color.y = convert_floatL(material_at(at, 0, 0) + 1);
  color.z = object_at(at, 0, 0) >= 0 ? depth_at(at, 0, 0) : (floatL)(7.0f);
  return color;
}
)")});
  settings.aovs = {Aov::kDepth, Aov::kObjectId, Aov::kMaterialId};
  const Image image = picture(scene, settings);
  const std::size_t step = image.channels.size(), object = channelIndex(image, "object_id"),
                    material = channelIndex(image, "material_id"), depth = channelIndex(image, "Z");
  bool has_background = false;
  for (std::size_t i = 0; i < image.pixels.size(); i += step) {
    const float* pixel = image.pixels.data() + i;
    ASSERT_EQ(pixel[0], pixel[object] + 1);
    ASSERT_EQ(pixel[1], pixel[material] + 1);
    ASSERT_EQ(pixel[2], std::isfinite(pixel[depth]) ? pixel[depth] : 7.0f);
    has_background |= pixel[object] < 0;
  }
  EXPECT_TRUE(has_background);
}

TEST(Screens, LeaveLayersAndAlpha) {
  const Scene scene = sceneFromJson(kScreensScene);
  RenderSettings settings = screened(scene, {50, 30}, {});
  settings.samples = 2;
  settings.sample_shading = SampleShading::kAll;
  settings.alpha = settings.light_groups = true;
  settings.aovs = {Aov::kNormal, Aov::kDepth, Aov::kDiffuseLight, Aov::kShadingCount};
  const Image without = picture(scene, settings);
  settings.screens = {kBlur};
  const Image with = picture(scene, settings);
  ASSERT_EQ(with.channels, without.channels);
  const std::size_t step = with.channels.size();
  bool differs = false;
  for (std::size_t i = 0; i < with.pixels.size(); ++i) {
    if (i % step >= 3)
      ASSERT_EQ(with.pixels[i], without.pixels[i]) << with.channels[i % step];
    else
      differs |= with.pixels[i] != without.pixels[i];
  }
  EXPECT_TRUE(differs);
}

TEST(Screens, ColorsThatAreNoneStayAsTheyWereAndAreCounted) {
  const Scene scene = sceneFromJson(kScreensScene);
  const glm::ivec2 size(64, 40);
  const Image without = picture(scene, screened(scene, size, {}));
  RenderSettings settings = screened(scene, size, {kIdentity, screenOf(R"(#define RADIUS 0
INLINE vec3L screen(const Screen *at) {
  vec3L color = color_at(at, 0, 0);
  color.x = at->x < 5 ? color.x * 0.0f - 1.0f : color.x;
  color.y = at->x == 7 ? color.y * INFINITY - INFINITY : color.y;
  color.z = at->x == 9 ? (floatL)(INFINITY) : color.z;
  return color;
}
)")});
  for (const int height : {0, 13}) {
    settings.band_height = height;
    Stats stats;
    EXPECT_EQ(renderScene(testDevice(), scene, settings, stats).pixels, without.pixels);
    EXPECT_EQ(countOf(stats, faultyScreenPixels(0)), 0u);
    EXPECT_EQ(countOf(stats, faultyScreenPixels(1)), 7u * 40);
  }
}

void expectRefused(const std::string& text, const testing::Matcher<std::string>& message) {
  const Scene scene = sceneFromJson(kScreensScene);
  try {
    picture(scene, screened(scene, {40, 30}, {screenOf(text)}));
    ADD_FAILURE() << "took " << text;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), message);
  }
}

TEST(Screens, ThatReadBeyondTheirRadiusAreRefusedAtThePlace) {
  const std::string head = "#define RADIUS 2\nINLINE vec3L screen(const Screen *at) {\n";
  expectRefused(head + "  return color_at(at, 1, -3);\n}\n", HasSubstr("beyond the screen's RADIUS"));
  expectRefused(head + "  return color_at(at, 1, -3);\n}\n", StartsWith("mine.clh:3:"));
  expectRefused(
      head +
          "  vec3L color = color_at(at, 0, 0);\n  UNROLLED(i, 6) {\n    int dx = (int)i - 2;\n"
          "    color.x += depth_at(at, dx, 0);\n  }\n  return color;\n}\n",
      StartsWith("mine.clh:6:16: this looks at the pixel (3, 0) from its own, beyond the screen's RADIUS"));
  expectRefused("INLINE vec3L screen(const Screen *at) { return color_at(at, 0, 0); }\n",
                HasSubstr("#define RADIUS, 0 to 8"));
  for (const char* radius : {"9", "-1", "1.5", ""})
    expectRefused("#define RADIUS " + std::string(radius) +
                      "\nINLINE vec3L screen(const Screen *at) { return color_at(at, 0, 0); }\n",
                  StartsWith("mine.clh:1:9: "));
}

TEST(Screens, ThatDontCompileNameTheUsersPlace) {
  expectRefused(
      "#define RADIUS 1\nINLINE vec3L screen(const Screen *at) {\n  return color_at(at, 0, 0) + other;\n}\n",
      StartsWith("mine.clh:3:"));
}

TEST(Screens, CountAsLoopsWhatNeighborsRepeat) {
  std::string nested =
      "#define RADIUS 8\nINLINE vec3L screen(const Screen *at) {\n  vec3L c = color_at(at, 0, 0);\n";
  expectRefused(nested +
                    "  EACH_NEIGHBOR(dx, dy) { EACH_NEIGHBOR(ex, ey) { c.x += depth_at(at, dx, ey); } }\n  "
                    "return c;\n}\n",
                HasSubstr("loops and calls repeat"));
  expectRefused(nested + "  EACH_NEIGHBOR(dx, dy) { dx -= 1; }\n  return c;\n}\n",
                HasSubstr("only the loop changes it"));
}

}  // namespace
}  // namespace luciole::test
