// Skies as directional lights: what they give together is what the picture gives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "luciole/error.hpp"
#include "luciole/image.hpp"
#include "luciole/scene.hpp"
#include "scene/sky_cells.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

glm::dvec3 directionAt(double u, double v) {
  const double phi = 2 * glm::pi<double>() * (u - 0.5), theta = glm::pi<double>() * v;
  return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

using ColorOf = std::function<glm::vec3(const glm::dvec3& direction)>;

std::shared_ptr<const Sky> skyOf(int height, const ColorOf& color) {
  std::vector<float> texels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * height; ++x) {
      const glm::vec3 of = color(directionAt((x + 0.5) / (2 * height), (y + 0.5) / height));
      texels.insert(texels.end(), {of.r, of.g, of.b});
    }
  std::vector<Warning> warnings;
  return makeSky(2 * height, height, texels, "sky", warnings);
}

/// Coloured, with a sun of a texel or two.
glm::vec3 bright(const glm::dvec3& d) {
  const double sun = glm::dot(d, glm::normalize(glm::dvec3(0.5, 0.6, -0.4))) > 0.9985 ? 400 : 0;
  return glm::vec3(0.3 + 0.7 * std::max(d.y, 0.0) + sun, 0.4 + 0.2 * d.x + sun, 0.6 + 0.3 * d.z + 0.8 * sun);
}

std::vector<glm::dvec3> normals(int count) {
  std::mt19937 random(43);
  std::normal_distribution<double> normal;
  std::vector<glm::dvec3> all;
  for (int i = 0; i < count; ++i)
    all.push_back(glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))));
  return all;
}

/// What a white surface of this normal reflects of the cells' lights, without shadows.
glm::dvec3 litBy(const std::vector<SkyCell>& cells, const glm::dvec3& normal) {
  glm::dvec3 sum(0.0);
  for (const SkyCell& cell : cells)
    sum += glm::dvec3(cell.light) * std::max(glm::dot(normal, cell.direction), 0.0);
  return sum;
}

/// The same of the picture: its texels are of one brightness each, and are cut into 6 × 6.
glm::dvec3 litBy(const Sky& sky, const glm::dvec3& normal) {
  const SkyLevel& level = sky.levels[0];
  constexpr int kParts = 6;
  glm::dvec3 sum(0.0);
  for (int y = 0; y < level.height * kParts; ++y) {
    const double v = (y + 0.5) / (level.height * kParts);
    const double area = 2 * glm::pi<double>() / (level.width * kParts) *
                        (std::cos(glm::pi<double>() * y / (level.height * kParts)) -
                         std::cos(glm::pi<double>() * (y + 1) / (level.height * kParts)));
    for (int x = 0; x < level.width * kParts; ++x) {
      const double cosine = glm::dot(normal, directionAt((x + 0.5) / (level.width * kParts), v));
      const float* texel = &level.texels[3 * (std::size_t(y / kParts) * level.width + x / kParts)];
      if (cosine > 0) sum += glm::dvec3(texel[0], texel[1], texel[2]) * (cosine * area / glm::pi<double>());
    }
  }
  return sum;
}

TEST(SkyCells, WhiteSkyOfOneLightsAWhiteSurfaceToOne) {
  const auto sky = skyOf(32, [](const glm::dvec3&) { return glm::vec3(1); });
  for (const std::uint32_t count : {1000u, 4096u, 30000u}) {
    const std::vector<SkyCell> cells = skyCells(*sky, count);
    EXPECT_EQ(cells.size(), count);
    double worst = 0;
    for (const glm::dvec3& normal : normals(200))
      worst = std::max(worst, std::abs(litBy(cells, normal).g - 1));
    // Cells that the horizon doesn't cut are exact. The others lie within their diameter δ of it, where they
    // give at most δ each: together 2π · 2δ · δ / 2 / π = 2 δ². Of 4π/N sr and up to 2.5 times as long as
    // wide δ² is 2.9 · 4π/N; the poles' corners are longer, but few. And floats round once.
    EXPECT_LT(worst, 2 * 2.9 * 4 * glm::pi<double>() / count + 0x1p-23) << count;
    RecordProperty(std::to_string(count), std::to_string(worst));
  }
}

TEST(SkyCells, GiveAThousandNormalsThePicturesIrradiance) {
  const auto sky = skyOf(64, bright);
  const std::vector<SkyCell> cells = skyCells(*sky, 16384);
  const double mean = litBy(*sky, {0, 1, 0}).g;
  double worst = 0, sum = 0;
  for (const glm::dvec3& normal : normals(1000)) {
    const glm::dvec3 ours = litBy(cells, normal), truth = litBy(*sky, normal);
    for (int c = 0; c < 3; ++c) {
      worst = std::max(worst, std::abs(ours[c] - truth[c]) / mean);
      sum += (ours[c] - truth[c]) / mean / 3000;
    }
  }
  // As above: cells that the horizon cuts have at most δ² of the light of the sky near it, which is below its
  // mean but for the sun; where the horizon cuts that, its cells of 2.6° / 10 give ½ · 0.005 of its half.
  EXPECT_LT(worst, 4e-3);
  EXPECT_LT(std::abs(sum), 1e-4);
}

TEST(SkyCells, ThatTheHorizonDoesNotCutAreExact) {
  const glm::dvec3 up = glm::normalize(glm::dvec3(0.2, 1, 0.3));
  const auto sky =
      skyOf(48, [&](const glm::dvec3& d) { return glm::dot(d, up) > 0.4 ? glm::vec3(3) : glm::vec3(0); });
  const double whole = litBy(skyCells(*sky, 1), up).g;
  for (const std::uint32_t count : {2u, 3u, 100u, 4001u})
    // Each light's colour rounds once.
    EXPECT_NEAR(litBy(skyCells(*sky, count), up).g, whole, 0x1p-24 * whole) << count;
}

TEST(SkyCells, OfADarkSkyAreNone) {
  EXPECT_TRUE(skyCells(*skyOf(8, [](const glm::dvec3&) { return glm::vec3(0); }), 100).empty());
  // Only a half shines: no light stands for the other.
  const auto half = skyOf(8, [](const glm::dvec3& d) { return glm::vec3(d.y > 0 ? 1 : 0); });
  for (const SkyCell& cell : skyCells(*half, 500)) EXPECT_GT(cell.direction.y, 0);
}

TEST(SkyCells, CoverTheWholeSphereOnce) {
  double sum = 0;
  for (const SkyCell& cell : skyCells(*skyOf(20, bright), 777)) sum += cell.solid_angle;
  EXPECT_NEAR(sum, 4 * glm::pi<double>(), 777 * 0x1p-24 * 4 * glm::pi<double>() / 777 * 2);
}

TEST(SkyCells, SunThatIsOneTexelIsSharedByLights) {
  const auto sky = skyOf(32, bright);
  const glm::dvec3 sun = glm::normalize(glm::dvec3(0.5, 0.6, -0.4));
  int of_sun = 0;
  for (const SkyCell& cell : skyCells(*sky, 4096)) of_sun += glm::dot(cell.direction, sun) > 0.995;
  EXPECT_GT(of_sun, 40);
  EXPECT_LT(of_sun, 2000);
}

TEST(Environment, TurnsCounterClockwise) {
  // A quarter of a turn takes what is ahead, −z, to the left, −x.
  const auto ahead = skyOf(16, [](const glm::dvec3& d) { return glm::vec3(d.z < -0.9 ? 1 : 0); });
  Scene scene;
  LightSource source;
  source.sky = ahead;
  source.count = 10;
  source.rotate = glm::pi<double>() / 2;
  scene.sources = {source};
  addSourceLights(scene);
  ASSERT_EQ(scene.lights.size(), 10u);
  for (const Light& light : scene.lights) EXPECT_GT(light.direction.x, 0.85);
}

TEST(Sky, NumbersThatAreNoLightAreTold) {
  std::vector<float> texels(6 * 3 * 3, 0.5f);
  texels[0] = std::numeric_limits<float>::quiet_NaN();
  texels[4] = std::numeric_limits<float>::infinity();
  texels[7] = -1;
  texels[9] = 1e30f;
  std::vector<Warning> warnings;
  const auto sky = makeSky(6, 3, texels, "odd.hdr", warnings);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0].text, "odd.hdr: 3 numbers that are negative or not finite count as 0");
  EXPECT_TRUE(warnings[0].repaired);
  EXPECT_EQ(warnings[1].text, "odd.hdr: 1 numbers above 1e15 count as that");
  for (const SkyCell& cell : skyCells(*sky, 100)) {
    EXPECT_TRUE(std::isfinite(cell.light.r + cell.light.g + cell.light.b));
    EXPECT_NEAR(glm::length(cell.direction), 1, 1e-12);
  }
}

TEST(Sky, ShapesAreChecked) {
  std::vector<Warning> warnings;
  const std::vector<float> texels(3 * 5 * 3, 1.0f);
  EXPECT_THROW(makeSky(5, 3, texels, "sky", warnings), InputError);
  EXPECT_THROW(makeSky(6, 3, texels, "sky", warnings), InputError) << "fewer numbers than texels";
  const test::TemporaryFolder folder;
  const std::string path = folder / "square.ppm";
  std::ofstream(path) << "P3 2 2 255 1 1 1 1 1 1 1 1 1 1 1 1\n";
  try {
    readSky(path, warnings);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("a picture of 2x2 as a sky; expected latitude and longitude"));
  }
}

/// A picture of a cross of faces of `side` texels, by where a face's place is seen.
Image crossOf(int side, bool is_tall, const ColorOf& color) {
  struct Face {
    int column, row;
    glm::dvec3 middle, right, up;
  };
  const Face behind =
      is_tall ? Face{1, 3, {0, 0, 1}, {1, 0, 0}, {0, -1, 0}} : Face{3, 1, {0, 0, 1}, {-1, 0, 0}, {0, 1, 0}};
  Image image{
      .width = (is_tall ? 3 : 4) * side, .height = (is_tall ? 4 : 3) * side, .channels = {"R", "G", "B"}};
  image.pixels.resize(std::size_t(image.width) * image.height * 3);
  for (const Face& face : {Face{1, 0, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                           {0, 1, {-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                           {1, 1, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}},
                           {2, 1, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                           {1, 2, {0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                           behind})
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const glm::dvec3 d =
            face.middle + face.right * (2 * (x + 0.5) / side - 1) + face.up * (1 - 2 * (y + 0.5) / side);
        const glm::vec3 of = color(glm::normalize(d));
        for (int c = 0; c < 3; ++c)
          image.pixels[3 * (std::size_t(face.row * side + y) * image.width + face.column * side + x) + c] =
              of[c];
      }
  return image;
}

TEST(Sky, CrossesOfACubesFacesShowWhatMapsShow) {
  const ColorOf smooth = [](const glm::dvec3& d) {
    return glm::vec3(1 + 0.5 * d.x, 1 + 0.5 * d.y, 1 + 0.5 * d.z);
  };
  const test::TemporaryFolder folder;
  for (const bool is_tall : {false, true}) {
    const std::string path = folder / "cross.exr";
    writeImage(crossOf(32, is_tall, smooth), path, {});
    std::vector<Warning> warnings;
    const auto sky = readSky(path, warnings);
    ASSERT_EQ(sky->levels[0].width, 128);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 128; ++x) {
        const glm::vec3 expected = smooth(directionAt((x + 0.5) / 128, (y + 0.5) / 64));
        // Bilinear between texels that are up to 1/16 apart of a function whose second derivative is below 1:
        // (1/16)² / 8 each way; and half a texel, 1/32 of a slope of ½ · 1.5, where faces end.
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(sky->levels[0].texels[3 * (std::size_t(y) * 128 + x) + c], expected[c], 0.026)
              << x << " " << y << " " << is_tall;
      }
  }
}

}  // namespace
}  // namespace luciole
