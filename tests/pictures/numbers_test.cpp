// Numbers at the ends of what floats hold, on their way in and out.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "kernels/random_scene.hpp"
#include "luciole/error.hpp"
#include "luciole/gbuffer_file.hpp"
#include "luciole/image.hpp"
#include "pictures/surfaces_seen.hpp"
#include "render_json.hpp"
#include "scene/models.hpp"
#include "single_precision.hpp"

namespace luciole::test {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();

bool isFinite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

TEST(HardNumbers, DotProductsAFewUlpOverOneGiveNoMoreThanTheLight) {
  // Normals that face eye and light and whose float length is over 1, the worst of many.
  Random random(2);
  std::vector<SurfaceSeen> points;
  while (points.size() < 256) {
    SurfaceSeen seen{.specular = glm::vec3(1), .shininess = 1e6f};
    seen.position = glm::vec3(random.between(-5, 5), random.between(-5, 5), random.between(-9, -1));
    seen.normal = glm::vec3(-glm::normalize(glm::dvec3(seen.position)));
    if (glm::dot(seen.normal, seen.normal) > 1) points.push_back(seen);
  }
  Light light = pointLight({0, 0, 0});
  light.kind = LightKind::kSpot;
  light.exponent = 128;
  light.cutoff = 1.5;
  light.diffuse = {1, 0, 0};
  light.specular = {0, 1, 0};
  for (const Model model : {Model::kPhong, Model::kBlinnPhong, Model::kToon}) {
    for (const SurfaceSeen& point : points) {
      light.direction = glm::normalize(glm::dvec3(point.position));
      const glm::vec3 seen = shadedPoints(16, sceneWith({light}), {point}, {.model = model})[0];
      // 1 − cosine of the spot is at most 12 units, the 128th power of which is 128 · 12. N·L is within 8;
      // the chord |a − b| of vectors off by 19 units each way makes a lobe of 1 − 10⁶ · (19 units)²/2.
      const double spot = 128 * 12 * kUnit;
      EXPECT_NEAR(seen.r, 1, spot + 8 * kUnit);
      EXPECT_NEAR(seen.g, 1, spot + 1e6 * std::pow(19 * kUnit, 2) / 2 + 8 * kUnit);
      EXPECT_LE(seen.g, 1);
    }
  }
}

TEST(HardNumbers, DenormalLightIsBlackAndTheLargestIsCapped) {
  const SurfaceSeen wall{.diffuse = glm::vec3(0.5f), .specular = glm::vec3(0.5f)};
  Light light = pointLight({0, 0, 0});
  light.diffuse = light.specular = glm::vec3(1e-42f);
  for (const glm::vec3& seen :
       {shadedPoint(sceneWith({light}), wall), referencePoints(sceneWith({light}), {wall})[0]})
    // N·L = R·V = 1: 10^-42, or nothing where denormals count as 0.
    EXPECT_TRUE(seen.x >= 0 && seen.x < 0x1p-126f);
  // The smallest normal numbers, in sum, keep their digits: one rounding a product or sum, 8 of N·L.
  light.diffuse = light.specular = glm::vec3(0x1p-120f);
  EXPECT_NEAR(shadedPoint(sceneWith({light}), wall).x, 0x1p-120, 16 * kUnit * 0x1p-120);
  // Just in range, and past it.
  light.diffuse = light.specular = glm::vec3(3e38f);
  EXPECT_NEAR(shadedPoint(sceneWith({light}), wall).x, 3e38, 16 * kUnit * 3e38);
  EXPECT_EQ(shadedPoint(sceneWith({light, light, light}), wall), glm::vec3(kLargest));
  EXPECT_EQ(referencePoints(sceneWith({light, light, light}), {wall})[0], glm::vec3(kLargest));
  EXPECT_EQ(shadedPoint(sceneWith(std::vector<Light>(200, light)), wall), glm::vec3(kLargest));
}

/// A wall that fills the picture, lit so brightly.
std::string brightWall(const std::string& light) {
  return R"({"camera": {"eye": [0, 0, 4], "target": [0, 0, 0]},
    "objects": [{"primitive": "box", "scale": [50, 50, 1]}],
    "lights": [{"type": "point", "position": [0, 0, 2], )" +
         light + "}]}";
}

TEST(HardNumbers, BrightnessBeyondHalfFloatsSurvivesInFiles) {
  const TemporaryFolder folder;
  const Image image = renderJson(brightWall(R"("intensity": 1e7)"), {33, 17}, [](RenderSettings&) {});
  EXPECT_GT(*std::min_element(image.pixels.begin(), image.pixels.end()), 65504.0f);
  writeImage(image, folder / "bright.exr", {});
  EXPECT_EQ(readImage(folder / "bright.exr").pixels, image.pixels);
  // The same picture dimmed by 2^40: an exposure that is no more than a power of two.
  const Image dim = renderJson(brightWall(R"("intensity": 1e7)"), {33, 17},
                               [](RenderSettings& settings) { settings.exposure = -40; });
  for (std::size_t i = 0; i < dim.pixels.size(); ++i) ASSERT_EQ(dim.pixels[i], image.pixels[i] * 0x1p-40f);
  writeImage(image, folder / "bright.png", {});
  for (const float value : readImage(folder / "bright.png").pixels) ASSERT_EQ(value, 1.0f);
}

TEST(HardNumbers, SamplesAndExposuresAddUpToFinitePictures) {
  const TemporaryFolder folder;
  // 10¹⁸ · 10¹⁸ times 10¹⁸ at a metre is over the largest float.
  const std::string light = R"("color": [1e18, 1e18, 1], "intensity": 1e18, "attenuation": [0, 0, 1e-18])";
  for (const float exposure : {0.0f, 30.0f}) {
    const Image image = renderJson(brightWall(light), {9, 5}, [&](RenderSettings& settings) {
      settings.samples = 4;
      settings.exposure = exposure;
    });
    EXPECT_TRUE(isFinite(image.pixels));
    EXPECT_EQ(image.pixels[3 * 22], kLargest);
    writeImage(image, folder / "glare.exr", {});
    EXPECT_EQ(readImage(folder / "glare.exr").pixels, image.pixels);
  }
  // Vertices that are lit so brightly are averaged over their triangles.
  const Image gouraud = renderJson(brightWall(light), {9, 5}, [](RenderSettings& settings) {
    settings.shading = Shading::kGouraud;
    settings.samples = 4;
  });
  EXPECT_TRUE(isFinite(gouraud.pixels));
}

/// A G-buffer of half floats as another program writes it: one row of pixels that face the eye at 4 m, with
/// these values in a channel.
void writeHalfFloats(const std::string& path, const std::string& channel, const std::vector<float>& values) {
  std::vector<std::string> names{"P.X", "P.Y",        "P.Z",        "N.X",       "N.Y",
                                 "N.Z", "emission.R", "emission.G", "emission.B"};
  Imf::Header header(int(values.size()), 1);
  Imf::FrameBuffer channels;
  std::map<std::string, std::vector<half>> rows;
  for (const std::string& name : names) {
    std::vector<half>& row = rows[name];
    for (const float value : values)
      row.push_back(name == channel ? value : name == "P.Z" ? -4.0f : name == "N.Z" ? 1.0f : 0.0f);
    header.channels().insert(name, Imf::Channel(Imf::HALF));
    channels.insert(name, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(row.data()), sizeof(half), 0));
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(channels);
  file.writePixels(1);
}

TEST(HardNumbers, HalfFloatGBuffersThatOverflowedAreBackgroundOrAnError) {
  const TemporaryFolder folder;
  const std::string path = folder / "half.exr";
  Scene scene = sceneWith({});
  scene.background = {0.25f, 0.5f, 0.75f};
  const auto shaded = [&] {
    RenderSettings settings;
    Stats stats;
    return pointColors(shadeGBuffer(testDevice(), scene, readGBuffer(path), settings, stats), 3);
  };
  // The largest half float is a colour like any other.
  writeHalfFloats(path, "emission.G", {0.5f, 65504.0f, 0});
  EXPECT_EQ(shaded(), (std::vector<glm::vec3>{{0, 0.5f, 0}, {0, 65504.0f, 0}, {0, 0, 0}}));
  // 65520 and more become inf: a position or normal like that shows nothing.
  for (const char* channel : {"P.X", "P.Z", "N.Y"}) {
    writeHalfFloats(path, channel, {-1.0f, -1e6f, kNaN});
    EXPECT_EQ(shaded(), (std::vector<glm::vec3>{{0, 0, 0}, scene.background, scene.background})) << channel;
  }
  for (const float broken : {1e6f, kNaN}) {
    writeHalfFloats(path, "emission.G", {0.5f, 1.0f, broken});
    try {
      readGBuffer(path);
      FAIL() << "accepted " << broken;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("half.exr: channel emission.G: pixel 2,0 is "));
    }
  }
}

TEST(HardNumbers, NoNaNOrInfinityLeavesAKernelWhateverGoesIn) {
  Random random(17);
  constexpr float kOdd[] = {0, -0.0f, 1e-45f, 1e-38f, 1e-20f, 1, -1, 1e20f, 1e38f, kLargest, kInfinity, kNaN};
  const auto odd = [&] {
    return random.chance(0.5) ? kOdd[random.below(std::size(kOdd))] : float(random.between(-9, 9));
  };
  const auto oddPositive = [&] { return std::abs(odd()); };
  const auto oddColor = [&] { return glm::vec3(oddPositive(), oddPositive(), oddPositive()); };
  for (int round = 0; round < 4; ++round) {
    std::vector<SurfaceSeen> points;
    for (int i = 0; i < 1024; ++i)
      points.push_back({.position = {odd(), odd(), odd()},
                        .normal = {odd(), odd(), odd()},
                        .diffuse = oddColor(),
                        .specular = oddColor(),
                        .ambient = oddColor(),
                        .emission = random.chance(0.5) ? oddColor() : glm::vec3(0),
                        .shininess = oddPositive()});
    Scene scene = randomScene(Camera(), 40, random);
    for (Light& light : scene.lights) {
      if (random.chance(0.5)) light.position = {odd(), odd(), odd()};
      if (random.chance(0.2)) light.direction = {odd(), odd(), odd()};
      if (random.chance(0.5)) light.diffuse = light.specular = light.ambient = oddColor();
      if (random.chance(0.2)) light.attenuation = oddColor();
      if (random.chance(0.2)) light.range = odd();
      if (random.chance(0.2)) light.exponent = oddPositive();
      if (random.chance(0.2)) light.cutoff = odd();
    }
    scene.fog = randomFog(round % 2 == 0 ? FogMode::kLinear : FogMode::kExp2, random);
    if (round > 1) scene.fog.density = {oddPositive(), oddPositive(), oddPositive()};
    for (const int lanes : {1, 16})
      for (const Culling culling : {Culling::kNone, Culling::kTiles})
        for (const glm::vec3& color :
             shadedPoints(lanes, scene, points,
                          {.model = kAllModels[round % std::size(kAllModels)], .culling = culling}))
          for (int c = 0; c < 3; ++c)
            ASSERT_TRUE(std::isfinite(color[c])) << "round " << round << ": " << color[c];
  }
}

}  // namespace
}  // namespace luciole::test
