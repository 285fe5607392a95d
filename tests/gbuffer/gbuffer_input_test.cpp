#include "gbuffer/gbuffer_input.hpp"

#include <OpenImageIO/deepdata.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "gbuffer/camera_header.hpp"
#include "gbuffer/foreign_file.hpp"
#include "luciole/error.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

constexpr int kWidth = 40, kHeight = 30;
const float kNaN = std::numeric_limits<float>::quiet_NaN();

Camera tiltedCamera() {
  Camera camera;
  camera.camera_to_world =
      glm::inverse(glm::lookAt(glm::dvec3(3, 4, 8), glm::dvec3(0.3, 1, 0.2), glm::dvec3(0, 1, 0)));
  camera.fov_y = 0.8;
  return camera;
}

/// The direction of the ray through a pixel, view space, with z = −1.
glm::dvec3 rayThrough(const Camera& camera, int x, int y) {
  const double half = std::tan(camera.fov_y / 2);
  return {((x + 0.5) / kWidth * 2 - 1) * half * kWidth / kHeight, (1 - (y + 0.5) / kHeight * 2) * half, -1};
}

/// Two planes in view space, one behind the other: the left half of the picture is a floor that tilts away,
/// the right one a wall that is nearer. The rows at the top show nothing.
struct TwoPlanes {
  Camera camera = tiltedCamera();
  glm::dvec3 floor = glm::normalize(glm::dvec3(0.1, 1, 0.4)), wall = glm::normalize(glm::dvec3(-0.5, 0.1, 1));

  bool shows(int, int y) const { return y >= 4; }
  bool isWall(int x) const { return x >= kWidth / 2; }
  glm::vec3 viewNormal(int x, int y) const {
    return shows(x, y) ? glm::vec3(isWall(x) ? wall : floor) : glm::vec3(0.0f);
  }
  glm::vec3 viewPosition(int x, int y) const {
    if (!shows(x, y)) return glm::vec3(0.0f);
    const glm::dvec3 ray = rayThrough(camera, x, y), normal = isWall(x) ? wall : floor,
                     through = isWall(x) ? glm::dvec3(0, 0, -3) : glm::dvec3(0, 0, -9);
    return glm::vec3(ray * (glm::dot(through, normal) / glm::dot(ray, normal)));
  }
  glm::vec3 position(int x, int y) const {
    if (!shows(x, y)) return glm::vec3(0.0f);
    return glm::vec3(camera.camera_to_world * glm::dvec4(viewPosition(x, y), 1.0));
  }
  glm::vec3 normal(int x, int y) const {
    return glm::vec3(glm::dmat3(camera.camera_to_world) * glm::dvec3(viewNormal(x, y)));
  }
};

class GBufferInputTest : public testing::Test {
 protected:
  void write(const std::vector<ForeignPart>& parts, int width = kWidth, int height = kHeight) {
    writeForeignParts(path, width, height, parts);
  }
  GBufferInput read(const GBufferRequest& request = {}) const { return readGBuffer(path, request); }
  void expectError(const std::string& what, const GBufferRequest& request = {}) const {
    EXPECT_THAT([&] { read(request); }, ThrowsMessage<InputError>(HasSubstr(what)));
    try {
      read(request);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
    }
  }
  /// Positions and normals of the planes, by these functions of a pixel.
  ForeignPart surfaces(const std::function<glm::vec3(int, int)>& position,
                       const std::function<glm::vec3(int, int)>& normal) const {
    ForeignPart part;
    addLayer(part.channels, "P", "XYZ", kFloat, position);
    if (normal) addLayer(part.channels, "N", "XYZ", kFloat, normal);
    return part;
  }
  ForeignPart world() const {
    return surfaces([this](int x, int y) { return planes.position(x, y); },
                    [this](int x, int y) { return planes.normal(x, y); });
  }
  void addCamera(ForeignPart& part) const {
    part.header = [this](OIIO::ImageSpec& spec) {
      for (const auto& [name, matrix] : cameraAttributes(planes.camera, {kWidth, kHeight}).matrices)
        spec.attribute(name, kMatrixType, glm::value_ptr(matrix));
    };
  }
  /// Positions of some 10 m, rounded to floats in the world and once more in view space.
  void expectPlanes(const GBuffer& g, double tolerance = 1e-5) const {
    const Surfaces read_back{g};
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        ASSERT_EQ(read_back.shows(x, y), planes.shows(x, y)) << x << ',' << y;
        EXPECT_LT(glm::distance(read_back.viewPosition(x, y), planes.viewPosition(x, y)), tolerance);
        EXPECT_LT(glm::distance(read_back.viewNormal(x, y), planes.viewNormal(x, y)), tolerance);
      }
  }

  const TemporaryFolder folder;
  const std::string path = folder / "in.exr";
  const TwoPlanes planes{};
};

TEST(CameraHeader, OfPixelsThatAreWiderThanHighSeesAsFarAsTheyDo) {
  Camera camera;
  camera.fov_y = 1;
  const ExrAttributes attributes = cameraAttributes(camera, {30, 20}, 2);
  const double height = std::tan(0.5);
  const auto own = readCamera(attributes, {30, 20}, "a.exr", {}, 2);
  ASSERT_TRUE(own && own->half_extent);
  EXPECT_EQ(*own->half_extent, glm::dvec2(height * 2 * 30 / 20, height));
  const auto others = readCamera({.texts = {}, .matrices = attributes.matrices}, {30, 20}, "a.exr", {}, 2);
  ASSERT_TRUE(others && others->half_extent);
  EXPECT_NEAR(others->half_extent->x, height * 2 * 30 / 20, 1e-6);  // the matrices are floats
  EXPECT_NEAR(others->half_extent->y, height, 1e-6);
}

// The matrices are floats: of numbers up to 12, and of an inverse.
TEST(CameraHeader, OfAnotherProgramTellsWhereTheAxisMeetsThePicture) {
  for (const bool orthographic : {false, true})
    for (const glm::dvec2& shift : {glm::dvec2(0), {0.02, 0}, {-0.75, 1.5}}) {
      Camera camera = tiltedCamera();
      camera.orthographic = orthographic;
      camera.shift = shift;
      camera.pixel_aspect = shift.x == 0 ? 1 : 1.25;
      const ExrAttributes attributes = cameraAttributes(camera, {30, 20}, 2);
      const auto read = readCamera({.texts = {}, .matrices = attributes.matrices}, {30, 20}, "a.exr", {}, 2);
      ASSERT_TRUE(read && read->half_extent);
      const double noise = shift.x == 0 ? 0 : 2e-5;  // one that isn't shifted is read as such
      EXPECT_NEAR(read->camera.shift.x, shift.x, noise);
      EXPECT_NEAR(read->camera.shift.y, shift.y, noise);
      EXPECT_NEAR(read->camera.pixel_aspect, camera.pixel_aspect, noise);
    }
}

TEST_F(GBufferInputTest, PartsMustBeOfOneSizeAndPlace) {
  ForeignPart positions = surfaces([](int, int) { return glm::vec3(0, 0, -3); }, {});
  positions.header = [](OIIO::ImageSpec& spec) { spec.attribute("oiio:subimagename", "positions"); };
  ForeignPart normals;
  addLayer(normals.channels, "N", "XYZ", kFloat, [](int, int) { return glm::vec3(0, 0, 1); });
  normals.header = [](OIIO::ImageSpec& spec) {
    spec.attribute("oiio:subimagename", "normals");
    spec.width = 20;
    spec.full_width = kWidth;
  };
  write({positions, normals});
  expectError(
      "in.exr: parts positions and normals differ: 40 x 30 pixels at 0,0 of 40 x 30, and 20 x 30 pixels");
}

TEST_F(GBufferInputTest, ADataWindowInsideTheDisplayWindowIsACrop) {
  ForeignPart part = surfaces([this](int x, int y) { return planes.position(x + 6, y + 9); },
                              [this](int x, int y) { return planes.normal(x + 6, y + 9); });
  part.header = [this](OIIO::ImageSpec& spec) {
    for (const auto& [name, matrix] : cameraAttributes(planes.camera, {kWidth, kHeight}).matrices)
      spec.attribute(name, kMatrixType, glm::value_ptr(matrix));
    spec.x = 106;
    spec.y = 59;
    spec.full_x = 100;
    spec.full_y = 50;
    spec.full_width = kWidth;
    spec.full_height = kHeight;
    spec.tile_width = spec.tile_height = 16;
  };
  write({part}, 30, 20);
  const GBufferInput input = read();
  EXPECT_EQ(input.gbuffer.crop_origin, glm::ivec2(6, 9));
  EXPECT_EQ(input.gbuffer.picture_size, glm::ivec2(kWidth, kHeight));
  EXPECT_LT(glm::distance(Surfaces{input.gbuffer}.viewPosition(3, 2), planes.viewPosition(9, 11)), 1e-5f);
  EXPECT_THAT(input.notes, Each(Not(HasSubstr("elsewhere"))));
}

TEST_F(GBufferInputTest, ADataWindowFarFromTheDisplayWindowIsRefused) {
  ForeignPart part =
      surfaces([](int, int) { return glm::vec3(0, 0, -3); }, [](int, int) { return glm::vec3(0, 0, 1); });
  part.header = [](OIIO::ImageSpec& spec) {
    spec.full_x = 1'000'000;
    spec.full_width = spec.full_height = kWidth;
  };
  write({part}, 30, 20);
  expectError(
      "in.exr: the data window begins (-1000000, 0) pixels from the display window, expected 32768 at most");
}

TEST_F(GBufferInputTest, HolesMayBeZeroNaNInfiniteOrFarAndAreTold) {
  for (const auto& [hole, word] : {std::pair(0.0f, "(zero)"), {kNaN, "(NaN)"}, {INFINITY, "(infinite)"}}) {
    write(
        {surfaces([&, hole = hole](
                      int x, int y) { return planes.shows(x, y) ? planes.position(x, y) : glm::vec3(hole); },
                  [&, hole = hole](int x, int y) {
                    return planes.shows(x, y) ? planes.normal(x, y) : glm::vec3(hole);
                  })});
    const GBufferInput input = read({.camera = planes.camera});
    expectPlanes(input.gbuffer);
    EXPECT_THAT(input.notes.back(), HasSubstr("160 of 1200 pixels show nothing " + std::string(word)));
  }
  ForeignPart part =
      surfaces([](int, int) { return glm::vec3(1, 1, -3); }, [](int, int) { return glm::vec3(0, 0, 1); });
  part.channels.push_back({"Z", kFloat, [](int x, int) { return x == 0 ? 1e10f : 3.0f; }});
  write({part});
  EXPECT_THAT(read().notes.back(), HasSubstr("30 of 1200 pixels show nothing (far)"));
}

TEST_F(GBufferInputTest, NaNInAMaterialIsAnErrorButNotInAHole) {
  ForeignPart part = world();
  addLayer(part.channels, "albedo", "RGB", kHalf,
           [this](int x, int y) { return glm::vec3(planes.shows(x, y) ? 0.5f : kNaN); });
  write({part});
  EXPECT_NO_THROW(read());
  part.channels.back().value = [](int x, int y) { return x == 7 && y == 9 ? kNaN : 0.5f; };
  write({part});
  expectError("in.exr: channel albedo.B: pixel 7,9 is nan, expected a finite number");
}

TEST_F(GBufferInputTest, CutShortFilesAreRefusedWhereverTheyEnd) {
  ForeignPart part = world();
  part.header = [](OIIO::ImageSpec& spec) { spec.tile_width = spec.tile_height = 16; };
  for (const bool tiled : {true, false}) {
    if (!tiled) part.header = {};
    write({part});
    const std::string bytes = readText(path);
    for (const double share : {0.02, 0.3, 0.6, 0.95}) {
      writeText(path, bytes.substr(0, std::size_t(share * double(bytes.size()))));
      expectError("in.exr: ");
    }
  }
}

TEST_F(GBufferInputTest, DeepPixelsAreNotRead) {
  OIIO::ImageSpec spec(2, 2, 3, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"P.X", "P.Y", "P.Z"};
  spec.deep = true;
  OIIO::DeepData data;
  data.init(spec);
  for (int i = 0; i < 4; ++i) data.set_samples(i, 1);
  const auto output = OIIO::ImageOutput::create("exr");
  ASSERT_TRUE(output->open(path, spec) && output->write_deep_image(data) && output->close())
      << output->geterror();
  expectError("in.exr: deep pixels are not read, and no layer that is known to hold positions");
}

TEST_F(GBufferInputTest, CameraSpaceIsKnownByTheRaysWhateverItsAxes) {
  for (const glm::vec3& axes : {glm::vec3(1, 1, 1), {1, 1, -1}, {-1, 1, -1}, {1, -1, -1}}) {
    write({surfaces([&](int x, int y) { return axes * planes.viewPosition(x, y); },
                    [&](int x, int y) { return axes * planes.viewNormal(x, y); })});
    const GBufferInput input = read({.camera_to_world = planes.camera.camera_to_world});
    expectPlanes(input.gbuffer);
    EXPECT_EQ(input.gbuffer.camera.camera_to_world, planes.camera.camera_to_world);
    EXPECT_TRUE(input.gbuffer.knows_camera);
    EXPECT_NEAR(input.gbuffer.camera.fov_y, planes.camera.fov_y, 1e-5);
    EXPECT_THAT(input.notes[1], HasSubstr("in camera space, camera as told"));
  }
}

TEST_F(GBufferInputTest, CameraSpaceWithoutACameraIsRefused) {
  write({surfaces([this](int x, int y) { return planes.viewPosition(x, y); },
                  [this](int x, int y) { return planes.viewNormal(x, y); })});
  // Without any camera, camera space and the world are one.
  EXPECT_NO_THROW(expectPlanes(read().gbuffer));
  expectError("in.exr: positions are in camera space, and no camera tells where that is",
              {.space = FileSpace::kCamera});
}

TEST_F(GBufferInputTest, WorldSpaceIsKnownByTheRaysOfTheHeadersCamera) {
  ForeignPart part = world();
  addCamera(part);
  write({part});
  GBufferInput input = read();
  expectPlanes(input.gbuffer);
  EXPECT_THAT(input.notes[1], HasSubstr("in world space, camera the file's"));
  // A camera that doesn't fit is told.
  input = read({.camera_to_world = glm::dmat4(1.0)});
  EXPECT_THAT(input.notes[1], HasSubstr("lie elsewhere than their pixels"));
}

TEST_F(GBufferInputTest, TransposedMatricesAreKnown) {
  for (const bool turns_only : {false, true}) {
    TwoPlanes moved = planes;
    if (turns_only) moved.camera.camera_to_world[3] = {0, 0, 0, 1};
    ForeignPart part = surfaces([&](int x, int y) { return moved.position(x, y); },
                                [&](int x, int y) { return moved.normal(x, y); });
    part.header = [&](OIIO::ImageSpec& spec) {
      for (const auto& [name, matrix] : cameraAttributes(moved.camera, {kWidth, kHeight}).matrices) {
        const glm::mat4 transposed = glm::transpose(matrix);
        spec.attribute(name, kMatrixType, glm::value_ptr(transposed));
      }
    };
    write({part});
    expectPlanes(read().gbuffer);
  }
}

TEST_F(GBufferInputTest, PositionsAndNormalsAreRebuiltFromDepthAndCamera) {
  for (const bool along_ray : {false, true}) {
    ForeignPart part;
    part.channels.push_back({along_ray ? "depth.T" : "Z", kFloat, [&](int x, int y) {
                               const glm::vec3 p = planes.viewPosition(x, y);
                               return !planes.shows(x, y) ? 1e30f : along_ray ? glm::length(p) : -p.z;
                             }});
    if (!along_ray) addCamera(part);
    write({part});
    const GBufferInput input = along_ray ? read({.camera = planes.camera}) : read();
    // At the edge between floor and wall each pixel still has its own side's neighbours.
    expectPlanes(input.gbuffer, 2e-4);
    EXPECT_THAT(input.notes, Contains(HasSubstr("normals from neighbouring positions; 0 pixels at edges")));
  }
  ForeignPart part;
  part.channels.push_back({"Z", kFloat, [](int, int) { return 3.0f; }});
  write({part});
  expectError("in.exr: attribute worldToNDC: depth without positions needs");
}

TEST_F(GBufferInputTest, AcrossDepthEdgesNoNormalIsMadeUp) {
  // Posts one pixel wide, each eighth: nothing beside a pixel of theirs is of the same surface.
  ForeignPart part;
  part.channels.push_back({"Z", kFloat, [](int x, int) { return x % 8 == 7 ? 2.0f : 5.0f; }});
  addCamera(part);
  write({part});
  const GBufferInput input = read();
  const Surfaces surfaces{input.gbuffer};
  EXPECT_FALSE(surfaces.shows(7, 10));
  EXPECT_TRUE(surfaces.shows(6, 10));
  // The wall behind them faces the camera.
  EXPECT_LT(glm::distance(surfaces.viewNormal(6, 10), glm::vec3(0, 0, 1)), 1e-5f);
  EXPECT_THAT(input.notes, Contains(HasSubstr("150 pixels at edges have none and show nothing")));
}

TEST_F(GBufferInputTest, AnAlbedoBecomesCoefficientsOfWattsASteradian) {
  ForeignPart part = world();
  addLayer(part.channels, "albedo", "RGB", kFloat, [](int, int) { return glm::vec3(0.6f, 0.3f, 0.9f); });
  addLayer(part.channels, "specular_albedo", "RGB", kFloat, [](int, int) { return glm::vec3(0.25f); });
  write({part});
  const auto at = [](const GBuffer& g, const Plane& plane) { return Surfaces{g}.three(plane, 20, 20); };
  // Without exponent there are no highlights.
  GBufferInput input = read();
  EXPECT_EQ(at(input.gbuffer, input.gbuffer.diffuse), glm::vec3(0.6f, 0.3f, 0.9f));
  EXPECT_EQ(at(input.gbuffer, input.gbuffer.specular), glm::vec3(0.0f));
  EXPECT_THAT(input.notes.front(), HasSubstr("specular = specular_albedo (left out: no shininess)"));
  input = read({.layers = {{Role::kShininess, "30"}}, .albedo = true});
  const float pi = float(std::numbers::pi);
  EXPECT_LT(glm::distance(at(input.gbuffer, input.gbuffer.diffuse), glm::vec3(0.6f, 0.3f, 0.9f) / pi), 1e-7f);
  EXPECT_LT(glm::distance(at(input.gbuffer, input.gbuffer.specular), glm::vec3(0.25f * 32 / (2 * pi))),
            1e-6f);
  EXPECT_EQ(at(input.gbuffer, input.gbuffer.ambient), glm::vec3(0.6f, 0.3f, 0.9f));
  EXPECT_EQ(input.gbuffer.specular[input.gbuffer.index(20, 20) + 3 * input.gbuffer.pixels()], 30.0f);
}

TEST_F(GBufferInputTest, ThePictureIsReadWhereItIsAskedFor) {
  ForeignPart part = world();
  addLayer(part.channels, "", "RGB", kHalf, [](int x, int y) { return glm::vec3(float(x), float(y), 0.5f); });
  write({part});
  EXPECT_TRUE(read().color.pixels.empty());
  Image color = read({.color = true}).color;
  EXPECT_EQ(color.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(color.pixels[(5 * kWidth + 7) * 3], 7.0f);
  EXPECT_EQ(color.pixels[(5 * kWidth + 7) * 3 + 1], 5.0f);
  part.channels.push_back({"A", kHalf, [](int, int) { return 0.25f; }});
  write({part});
  color = read({.color = true}).color;
  EXPECT_EQ(color.channels.back(), "A");
  EXPECT_EQ(color.pixels[3], 0.25f);
  write({world()});
  expectError("in.exr: no layer that is known to hold the picture", {.color = true});
}

TEST_F(GBufferInputTest, OtherFilesAreRefused) {
  expectError("in.exr: no such file");
  writeText(path, "P3 1 1 255 10 20 30");
  expectError("in.exr: not an EXR file");
}

}  // namespace
}  // namespace luciole::test
