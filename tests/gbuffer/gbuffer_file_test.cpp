#include "luciole/gbuffer_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <utility>

#include "gbuffer/camera_header.hpp"
#include "gbuffer/packed_normal.hpp"
#include "image/oiio.hpp"
#include "image/read_texture.hpp"
#include "kernels/shared.h"
#include "luciole/error.hpp"
#include "luciole/pose.hpp"
#include "shared_files.hpp"
#include "tools/cli/run_program.hpp"

namespace luciole {
namespace {

void writeCamera(const Camera& camera, glm::ivec2 picture_size, OIIO::ImageSpec& spec) {
  const ExrAttributes attributes = cameraAttributes(camera, picture_size);
  for (const auto& [name, text] : attributes.texts) spec.attribute(name, text);
  for (const auto& [name, matrix] : attributes.matrices)
    spec.attribute(name, OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::MATRIX44),
                   glm::value_ptr(matrix));
}

using test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr float kInf = std::numeric_limits<float>::infinity();

Camera someCamera() {
  Camera camera;
  camera.name = "main";
  camera.camera_to_world =
      glm::inverse(glm::lookAt(glm::dvec3(3.1, 2.2, 5.3), glm::dvec3(0.1, 1.0, 0.2), glm::dvec3(0, 1, 0)));
  camera.fov_y = 0.9;
  camera.near = 0.15;
  camera.far = 250;
  return camera;
}

void setThree(Plane& plane, std::size_t at, std::size_t stride, glm::vec3 v) {
  for (int c = 0; c < 3; ++c) plane[at + c * stride] = v[c];
}

/// Every third pixel shows nothing; the others lie where rays through their centres meet some depth.
GBuffer somePicture(int width, int height, const Camera& camera) {
  GBuffer g;
  g.width = width;
  g.height = height;
  g.tiles_x = (width + kTileSize - 1) / kTileSize;
  g.tiles_y = (height + kTileSize - 1) / kTileSize;
  g.camera = camera;
  g.picture_size = {width, height};
  const std::size_t stride = g.pixels();
  for (Plane* plane : {&g.position, &g.normal, &g.diffuse, &g.ambient, &g.emission})
    plane->assign(3 * stride, 0.0f);
  g.specular.assign(4 * stride, 0.0f);
  g.geometric_normal.assign(stride, 0);
  g.lift.assign(stride, 0.0f);
  std::fill(g.position.begin() + std::ptrdiff_t(2 * stride), g.position.end(), -kInf);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int i = y * width + x;
      if (i % 3 == 2) continue;
      const std::size_t at = g.index(x, y);
      const double depth = 1.0 + 0.37 * (i % 11);
      const double half = camera.orthographic ? camera.half_height : std::tan(camera.fov_y / 2) * depth;
      const glm::dvec2 off = glm::dvec2((x + 0.5) / width * 2 - 1, 1 - (y + 0.5) / height * 2) - camera.shift;
      const glm::dvec2 screen{off.x * camera.pixel_aspect * width / height, off.y};
      setThree(g.position, at, stride, glm::vec3(screen.x * half, screen.y * half, -depth));
      setThree(g.normal, at, stride, glm::vec3(glm::normalize(glm::dvec3(0.1 * (i % 7), 0.3, 1.0))));
      g.geometric_normal[at] = packNormal(glm::dvec3(i % 5 - 2, i % 3 - 0.3, 0.1 * (i % 101)));
      g.lift[at] = i % 4 == 0 ? 0.0f : 1e-3f * float(i % 97);
      setThree(g.diffuse, at, stride, glm::vec3(0.1f, 0.01f * float(i % 90), 0.7f));
      setThree(g.specular, at, stride, glm::vec3(0.3f, 0.2f, 0.1f * float(i % 5)));
      g.specular[at + 3 * stride] = float(i % 64);
      setThree(g.ambient, at, stride, glm::vec3(0.2f, 0.1f, 0.3f));
      setThree(g.emission, at, stride, glm::vec3(float(i), 0.0f, 1e-6f));
    }
  }
  return g;
}

bool sameBits(const Plane& a, const Plane& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// Writes an EXR as another program might, channel by channel.
void writeForeign(const std::string& path, int width, int height, const std::vector<std::string>& channels,
                  const std::function<float(int, int, int)>& value,
                  const std::function<void(OIIO::ImageSpec&)>& header = {},
                  OIIO::TypeDesc type = OIIO::TypeDesc::FLOAT) {
  OIIO::ImageSpec spec(width, height, int(channels.size()), type);
  spec.channelnames = channels;
  if (header) header(spec);
  std::vector<float> values;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < int(channels.size()); ++c) values.push_back(value(x, y, c));
    }
  }
  const auto output = OIIO::ImageOutput::create("exr");
  ASSERT_TRUE(output->open(path, spec));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()));
  ASSERT_TRUE(output->close());
}

std::string errorOf(const std::string& path) {
  try {
    readGBuffer(path);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "threw nothing";
  return "";
}

glm::vec3 positionAt(const GBuffer& g, int x, int y) {
  const std::size_t at = g.index(x, y), stride = g.pixels();
  return {g.position[at], g.position[at + stride], g.position[at + 2 * stride]};
}

/// Float matrices of a camera some 6 m from the origin, inverted and multiplied: a few dozen roundings of
/// 6e-8 × 6 m, and an opening from matrix elements that carry the same; far below the distance between
/// neighbouring pixels.
constexpr float kPositionTolerance = 2e-5f;

TEST(GBufferFile, EveryPlaneSurvivesBitForBit) {
  const TemporaryFolder folder;
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 93}, {144, 17}}) {
    const GBuffer written = somePicture(width, height, someCamera());
    writeGBuffer(written, folder / "g.exr", {});
    const GBuffer read = readGBuffer(folder / "g.exr");
    EXPECT_EQ(read.width, width);
    EXPECT_EQ(read.height, height);
    EXPECT_TRUE(sameBits(read.position, written.position));
    EXPECT_TRUE(sameBits(read.normal, written.normal));
    EXPECT_TRUE(sameBits(read.diffuse, written.diffuse));
    EXPECT_TRUE(sameBits(read.specular, written.specular));
    EXPECT_TRUE(sameBits(read.ambient, written.ambient));
    EXPECT_TRUE(sameBits(read.emission, written.emission));
    EXPECT_EQ(read.geometric_normal, written.geometric_normal);
    EXPECT_TRUE(sameBits(read.lift, written.lift));
  }
}

TEST(GBufferFile, NormalsThatAreNotUnitAreNormalized) {
  const TemporaryFolder folder;
  GBuffer written = somePicture(16, 16, someCamera());
  const Plane unit = written.normal;
  for (float& component : written.normal) component = float(component * (1 + 9e-7));
  writeGBuffer(written, folder / "g.exr", {});
  const GBuffer read = readGBuffer(folder / "g.exr");
  const std::size_t stride = read.pixels();
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const std::size_t at = read.index(x, y);
      if (unit[at + 2 * stride] == 0) continue;
      const glm::dvec3 normal(read.normal[at], read.normal[at + stride], read.normal[at + 2 * stride]);
      EXPECT_NEAR(glm::length(normal), 1, 1.001 * 0x1p-24) << "each component rounds once";
      // Both round once, and the written one once more.
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(normal[c], unit[at + c * stride], 3 * 0x1p-24);
    }
  }
}

TEST(GBufferFile, FacetsAreOptional) {
  const TemporaryFolder folder;
  GBuffer without = somePicture(3, 2, someCamera());
  without.geometric_normal.clear();
  writeGBuffer(without, folder / "g.exr", {});
  EXPECT_TRUE(readGBuffer(folder / "g.exr").geometric_normal.empty());

  // Of any length, and the shading normal where they are none.
  const std::vector<std::string> channels{"P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "Ng.X", "Ng.Y", "Ng.Z"};
  writeForeign(folder / "g.exr", 3, 1, channels, [](int x, int, int c) {
    const float values[] = {0, 0, -4, 0, 0, 2, 0, 3, 0};
    return c < 6 || x == 0 ? values[c] : x == 1 ? 0.0f : kInf;
  });
  const GBuffer g = readGBuffer(folder / "g.exr");
  ASSERT_EQ(g.geometric_normal.size(), g.pixels());
  EXPECT_EQ(unpackNormal(g.geometric_normal[g.index(0, 0)]), glm::dvec3(0, 1, 0));
  EXPECT_EQ(unpackNormal(g.geometric_normal[g.index(1, 0)]), glm::dvec3(0, 0, 1));
  EXPECT_EQ(unpackNormal(g.geometric_normal[g.index(2, 0)]), glm::dvec3(0, 0, 1));
}

TEST(GBufferFile, UnbentNormalsAreReadInsteadOfFacets) {
  const TemporaryFolder folder;
  const std::vector<std::string> channels{"P.X",  "P.Y",  "P.Z",  "N.X",       "N.Y",       "N.Z",
                                          "Ng.X", "Ng.Y", "Ng.Z", "Nunbent.X", "Nunbent.Y", "Nunbent.Z"};
  writeForeign(folder / "g.exr", 1, 1, channels, [](int, int, int c) {
    const float values[] = {0, 0, -4, 0, 0, 2, 0, 3, 0, 5, 0, 0};
    return values[c];
  });
  const GBuffer g = readGBuffer(folder / "g.exr");
  EXPECT_TRUE(g.geometric_normal.empty());
  ASSERT_EQ(g.unbent_normal.size(), g.pixels());
  EXPECT_EQ(unpackNormal(g.unbent_normal[0]), glm::dvec3(1, 0, 0));
}

TEST(GBufferFile, LiftsAreOptionalAndNeverNegative) {
  const TemporaryFolder folder;
  GBuffer without = somePicture(3, 2, someCamera());
  without.lift.clear();
  writeGBuffer(without, folder / "g.exr", {});
  EXPECT_TRUE(readGBuffer(folder / "g.exr").lift.empty());

  const std::vector<std::string> channels{"P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "lift"};
  writeForeign(folder / "g.exr", 2, 1, channels, [](int x, int, int c) {
    const float values[] = {0, 0, -4, 0, 0, 2, x == 0 ? 0.5f : -0.5f};
    return values[c];
  });
  const GBuffer g = readGBuffer(folder / "g.exr");
  ASSERT_EQ(g.lift.size(), g.pixels());
  EXPECT_EQ(g.lift[g.index(0, 0)], 0.5f);
  EXPECT_EQ(g.lift[g.index(1, 0)], 0.0f);
  writeForeign(folder / "g.exr", 2, 1, channels,
               [](int, int, int c) { return c == 6 ? kInf : float(c) - 2.0f; });
  EXPECT_THAT(errorOf(folder / "g.exr"), HasSubstr("channel lift: pixel 0,0 is inf"));
}

TEST(GBufferFile, CameraAndCropSurviveExactly) {
  const TemporaryFolder folder;
  for (const bool orthographic : {false, true}) {
    GBuffer written = somePicture(7, 5, someCamera());
    written.camera.orthographic = orthographic;
    written.camera.half_height = 1.7;
    written.camera.shift = {0.1, -0.7};
    written.camera.pixel_aspect = 1.01;
    written.picture_size = {64, 48};
    written.crop_origin = {11, 13};
    writeGBuffer(written, folder / "g.exr", {{"Software", "Luciole"}});
    const GBuffer read = readGBuffer(folder / "g.exr");
    EXPECT_EQ(read.camera.camera_to_world, written.camera.camera_to_world);
    EXPECT_EQ(read.camera.name, "main");
    EXPECT_EQ(read.camera.orthographic, orthographic);
    if (orthographic) {
      EXPECT_EQ(read.camera.half_height, 1.7);
    } else {
      EXPECT_EQ(read.camera.fov_y, 0.9);
    }
    EXPECT_EQ(read.camera.shift, written.camera.shift);
    EXPECT_EQ(read.camera.pixel_aspect, 1.01);
    EXPECT_EQ(read.camera.near, 0.15);
    EXPECT_EQ(read.camera.far, 250);
    EXPECT_EQ(read.picture_size, glm::ivec2(64, 48));
    EXPECT_EQ(read.crop_origin, glm::ivec2(11, 13));
  }
}

TEST(GBufferFile, HeaderHasTheCameraAsOpenExrDefinesIt) {
  OIIO::ImageSpec spec(64, 48, 3, OIIO::TypeDesc::FLOAT);
  Camera camera = someCamera();
  camera.shift = {0.25, -0.5};
  camera.pixel_aspect = 1.5;
  writeCamera(camera, {64, 48}, spec);
  const OIIO::TypeDesc type(OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::MATRIX44);
  // A point 2 m ahead, on the ray through the picture's right edge at the height of the axis, ¾ of half the
  // picture's width from it, as a row vector times a matrix.
  const double right = 0.75 * std::tan(camera.fov_y / 2) * 2 * 1.5 * 64 / 48;
  const glm::dvec4 world = camera.camera_to_world * glm::dvec4(right, 0, -2, 1);
  const auto times = [&](const char* name) {
    const auto* m = static_cast<const float*>(spec.find_attribute(name, type)->data());
    glm::dvec4 result{0.0};
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 4; ++row) result[column] += world[row] * m[row * 4 + column];
    }
    return result;
  };
  const glm::dvec4 in_camera = times("worldToCamera");
  EXPECT_NEAR(in_camera.x, right, kPositionTolerance);
  EXPECT_NEAR(in_camera.y, 0, kPositionTolerance);
  EXPECT_NEAR(in_camera.z, 2, kPositionTolerance);
  const glm::dvec4 ndc = times("worldToNDC");
  EXPECT_NEAR(ndc.x / ndc.w, 1.0, kPositionTolerance);
  EXPECT_NEAR(ndc.y / ndc.w, 0.75, kPositionTolerance);
}

TEST(GBufferFile, ACameraThatSeesToInfinityComesBack) {
  Camera camera;
  camera.near = 0.001;
  camera.far = std::numeric_limits<double>::infinity();
  const ExrAttributes attributes = cameraAttributes(camera, {40, 30});
  for (const auto& [name, matrix] : attributes.matrices)
    for (int i = 0; i < 16; ++i) EXPECT_TRUE(std::isfinite(matrix[i / 4][i % 4])) << name;
  const std::optional<CameraHeader> header = readCamera(attributes, {40, 30}, "a.exr", {});
  ASSERT_TRUE(header);
  EXPECT_EQ(header->camera.far, camera.far);
  EXPECT_EQ(header->camera.near, camera.near);
}

TEST(GBufferFile, PositionsAndNormalsAloneAreEnough) {
  const TemporaryFolder folder;
  // Channels in an order of their own, one that nobody knows, half floats, normals of length 2.
  writeForeign(
      folder / "g.exr", 3, 1, {"N.X", "P.Z", "cryptomatte", "P.X", "N.Z", "P.Y", "N.Y"},
      [](int x, int, int c) {
        if (x == 1) return 0.0f;
        const float lit[] = {0, -4, 9, 0.5f, 2, 0.25f, 0};
        return x == 2 && c == 1 ? kInf : lit[c];
      },
      {}, OIIO::TypeDesc::HALF);
  const GBuffer g = readGBuffer(folder / "g.exr");
  const std::size_t at = g.index(0, 0), stride = g.pixels();
  EXPECT_EQ(positionAt(g, 0, 0), glm::vec3(0.5f, 0.25f, -4.0f));
  EXPECT_EQ(g.normal[at + 2 * stride], 1.0f);
  EXPECT_EQ(g.diffuse[at], 0.8f);
  EXPECT_EQ(g.ambient[at], 0.8f);
  EXPECT_EQ(g.specular[at], 0.0f);
  EXPECT_EQ(g.specular[at + 3 * stride], 0.0f);
  EXPECT_TRUE(g.emission.empty());
  for (const int background : {1, 2}) {
    EXPECT_EQ(positionAt(g, background, 0), glm::vec3(0, 0, -kInf));
    EXPECT_EQ(g.diffuse[g.index(background, 0)], 0.0f);
  }
}

/// The header of a program that knows only the standard attributes, with cameras that look along +z or −z.
void standardHeader(OIIO::ImageSpec& spec, const Camera& camera, bool plus_z) {
  writeCamera(camera, {spec.width, spec.height}, spec);
  for (const char* own : {"luciole:cameraToWorld", "luciole:projection", "luciole:cameraName"}) {
    spec.erase_attribute(own);
  }
  if (plus_z) return;
  const OIIO::TypeDesc type(OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::MATRIX44);
  float m[16];
  std::memcpy(m, spec.find_attribute("worldToCamera", type)->data(), sizeof m);
  for (int row = 0; row < 4; ++row) m[row * 4 + 2] = -m[row * 4 + 2];
  spec.attribute("worldtocamera", type, m);
}

TEST(GBufferFile, PositionsAreFoundFromDepthAndCamera) {
  const TemporaryFolder folder;
  for (const bool orthographic : {false, true}) {
    for (const float sign : {1.0f, -1.0f}) {
      Camera camera = someCamera();
      camera.orthographic = orthographic;
      camera.half_height = 1.7;
      if (sign < 0) {
        camera.shift = {0.5, -0.3};
        camera.pixel_aspect = 1.2;
      }
      const GBuffer truth = somePicture(7, 5, camera);
      writeForeign(
          folder / "g.exr", 7, 5, {"N.X", "N.Y", "N.Z", "Z"},
          [&](int x, int y, int c) {
            return c == 3 ? -positionAt(truth, x, y).z * sign : c == 1 ? 1.0f : 0.0f;
          },
          [&](OIIO::ImageSpec& spec) { standardHeader(spec, camera, true); });
      const GBuffer g = readGBuffer(folder / "g.exr");
      for (int i = 0; i < 35; ++i) {
        const glm::vec3 expected = positionAt(truth, i % 7, i / 7), found = positionAt(g, i % 7, i / 7);
        if (std::isinf(expected.z)) {
          EXPECT_EQ(found, expected);
        } else {
          EXPECT_LT(glm::distance(found, expected), kPositionTolerance) << i;
        }
      }
    }
  }
}

TEST(GBufferFile, CamerasMayLookAlongEitherSideOfZ) {
  const TemporaryFolder folder;
  for (const bool with_ndc : {true, false}) {
    for (const bool plus_z : {true, false}) {
      const Camera camera = someCamera();
      const glm::dvec4 ahead = camera.camera_to_world * glm::dvec4(0.2, 0.1, -3, 1);
      writeForeign(
          folder / "g.exr", 1, 1, {"P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z"},
          [&](int, int, int c) { return c < 3 ? float(ahead[c]) : 0.5f; },
          [&](OIIO::ImageSpec& spec) {
            standardHeader(spec, camera, plus_z);
            if (!with_ndc) spec.erase_attribute("worldToNDC");
          });
      EXPECT_LT(glm::distance(positionAt(readGBuffer(folder / "g.exr"), 0, 0), glm::vec3(0.2f, 0.1f, -3.0f)),
                kPositionTolerance);
    }
  }
}

TEST(GBufferFile, ErrorsNameFileAndChannel) {
  const TemporaryFolder folder;
  const std::string path = folder / "g.exr";
  const auto one = [](int, int, int) { return 1.0f; };
  const auto expectError = [&](const std::vector<std::string>& channels, const char* part) {
    writeForeign(path, 1, 1, channels, one);
    EXPECT_THAT(errorOf(path), HasSubstr("g.exr: " + std::string(part)));
  };
  expectError({"P.X", "P.Z", "N.X", "N.Y", "N.Z"}, "channel P.Y: missing");
  expectError({"N.X", "N.Y", "N.Z"},
              "no layer that is known to hold positions or depths among the channels N.X, N.Y, N.Z");
  expectError({"N.X", "N.Y", "N.Z", "Z"}, "attribute worldToNDC");
  expectError({"P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "diffuse.R"}, "channel diffuse.G: missing");
  expectError({"P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "Ng.X", "Ng.Z"}, "channel Ng.Y: missing");
  writeForeign(path, 2, 1, {"P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "shininess"},
               [](int x, int, int c) { return c == 6 && x == 1 ? kInf : 1.0f; });
  EXPECT_THAT(errorOf(path), HasSubstr("channel shininess: pixel 1,0 is inf"));
}

TEST(GBufferFile, DamagedCamerasAreErrors) {
  const TemporaryFolder folder;
  const std::string path = folder / "g.exr";
  const auto expectError = [&](const char* attribute, const std::string& text) {
    writeForeign(
        path, 1, 1, {"P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z"}, [](int, int, int) { return 1.0f; },
        [&](OIIO::ImageSpec& spec) {
          writeCamera(someCamera(), {1, 1}, spec);
          spec.attribute(attribute, text);
        });
    EXPECT_THAT(errorOf(path), HasSubstr(attribute)) << text;
  };
  for (const char* text :
       {"1 2 3", "x", "2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 5"}) {
    expectError("luciole:cameraToWorld", text);
  }
  for (const char* text :
       {"perspective 1 2", "fisheye 1 2 3", "perspective 4 1 2", "parallel 1 2 1", "parallel nan 1 2"}) {
    expectError("luciole:projection", text);
  }
}

TEST(GBufferFile, OnlyExrIsWritten) {
  const TemporaryFolder folder;
  EXPECT_THROW(writeGBuffer(somePicture(1, 1, someCamera()), folder / "g.png", {}), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

/// The most memory this process has had, bytes.
std::size_t peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::size_t(usage.ru_maxrss) * 1024;
}

TEST(GBufferFile, APromiseThatTheFileDoesNotKeepTakesNoMemory) {
  const TemporaryFolder folder;
  const std::string path = folder / "promise.exr";
  writeGBuffer(somePicture(16, 16, someCamera()), path, {});
  std::string bytes = test::readText(path);
  const std::int32_t last[2] = {32767, 511};
  for (const std::string name : {"dataWindow", "displayWindow"}) {
    // Name and type, each with its end, then the length and the box's first x and y.
    const std::size_t at = bytes.find(name + '\0') + name.size() + 1 + sizeof "box2i" + 4 + 8;
    bytes.replace(at, sizeof last, reinterpret_cast<const char*>(last), sizeof last);
  }
  bytes.resize(100'000);  // with less, the size alone gives the header away
  test::writeText(path, bytes);
  const std::size_t before = peakMemory();
  EXPECT_THAT([&] { readGBuffer(path); }, ThrowsMessage<InputError>(HasSubstr("damaged")));
  // 20 channels at least are promised, of 32768 × 512 floats each; a decoder's block is 16 rows of them.
  constexpr std::size_t kPlane = std::size_t(32768) * 512 * sizeof(float);
  EXPECT_LT(peakMemory() - before, 10 * kPlane);
}

TEST(GBufferFile, WindowsOfAnImpossiblePictureAreRefused) {
  const TemporaryFolder folder;
  const std::string path = folder / "g.exr";
  // The largest that OpenEXR takes, and one pixel more than a picture may have.
  for (const auto& [first, side] : {std::pair(-(1 << 30) + 2, 2147483645), {-1, 32769}}) {
    writeForeign(
        path, 1, 1, {"P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z"}, [](int, int, int) { return 1.0f; },
        [&, first = first, side = side](OIIO::ImageSpec& spec) {
          spec.full_x = spec.full_y = first;
          spec.full_width = spec.full_height = side;
        });
    const auto message = ThrowsMessage<InputError>(HasSubstr("g.exr: part of a picture of "));
    EXPECT_THAT([&] { readGBuffer(path); }, message);
    EXPECT_THAT([&] { readImage(path); }, message);
    EXPECT_THAT([&] { readTexture(path); }, message);
  }
}

TEST(GBufferFile, PicturesCarryTheCameraAsGBuffersDo) {
  const TemporaryFolder folder;
  GBuffer gbuffer = somePicture(4, 3, someCamera());
  gbuffer.picture_size = {20, 10};
  gbuffer.crop_origin = {5, 2};
  writeGBuffer(gbuffer, folder / "g.exr", {});
  writeImage(
      {4, 3, {"R", "G", "B"}, std::vector<float>(36, 0.5f)}, folder / "p.exr", {},
      {.picture_size = {20, 10}, .crop_origin = {5, 2}, .exr = cameraAttributes(someCamera(), {20, 10})});
  const auto g = OIIO::ImageInput::open(folder / "g.exr"), p = OIIO::ImageInput::open(folder / "p.exr");
  ASSERT_TRUE(g && p);
  const OIIO::TypeDesc matrix(OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::MATRIX44);
  for (const char* name : {"worldToCamera", "worldToNDC"}) {
    const auto *of_g = g->spec().find_attribute(name, matrix), *of_p = p->spec().find_attribute(name, matrix);
    ASSERT_TRUE(of_g && of_p) << name;
    EXPECT_EQ(std::memcmp(of_g->data(), of_p->data(), 16 * sizeof(float)), 0) << name;
  }
  for (const char* name : {"luciole:cameraToWorld", "luciole:projection", "luciole:cameraName"}) {
    EXPECT_NE(readAttribute(folder / "p.exr", name), "");
    EXPECT_EQ(readAttribute(folder / "p.exr", name), readAttribute(folder / "g.exr", name));
  }
  EXPECT_EQ(p->spec().x, 5);
  EXPECT_EQ(p->spec().y, 2);
  EXPECT_EQ(p->spec().full_width, 20);
  EXPECT_EQ(p->spec().full_height, 10);
}

TEST(GBufferFile, WhetherTheCameraIsKnownIsTold) {
  const TemporaryFolder folder;
  const std::string path = folder / "g.exr";
  const auto knows = [&](const std::function<void(OIIO::ImageSpec&)>& header) {
    writeForeign(
        path, 1, 1, {"P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z"}, [](int, int, int) { return 1.0f; }, header);
    return readGBuffer(path).knows_camera;
  };
  EXPECT_FALSE(knows({}));
  EXPECT_TRUE(knows([](OIIO::ImageSpec& spec) { writeCamera(someCamera(), {1, 1}, spec); }));
  EXPECT_TRUE(knows([](OIIO::ImageSpec& spec) { standardHeader(spec, someCamera(), true); }));
  EXPECT_FALSE(knows([](OIIO::ImageSpec& spec) {
    standardHeader(spec, someCamera(), true);
    spec.erase_attribute("worldToNDC");  // how wide it sees
  }));
}

/// A header of these attributes (name, type, value), and nothing after it.
std::string exrHeader(const std::vector<std::array<std::string, 3>>& attributes) {
  std::string bytes("\x76\x2f\x31\x01\x02\0\0\0", 8);
  for (const auto& [name, type, value] : attributes) {
    const auto length = std::int32_t(value.size());
    bytes += name + '\0' + type + '\0' + std::string(reinterpret_cast<const char*>(&length), 4) + value;
  }
  return bytes + '\0';
}

TEST(GBufferFile, AttributesThatPromiseTooMuchAreRefusedBeforeThereIsRoomForThem) {
  const TemporaryFolder folder;
  const std::string path = folder / "header.exr";
  const auto numbers = [](std::vector<std::int32_t> values) {
    return std::string(reinterpret_cast<const char*>(values.data()), 4 * values.size());
  };
  const auto expectRefused = [&](const std::string& bytes, const char* why) {
    test::writeText(path, bytes);
    const std::size_t before = peakMemory();
    EXPECT_THAT([&] { readGBuffer(path); }, ThrowsMessage<InputError>(HasSubstr(why)));
    // What OpenImageIO takes for its own start, and far below the 2 GB that each of these asks for.
    EXPECT_LT(peakMemory() - before, std::size_t(200) << 20) << why;
  };
  std::string text = exrHeader({{"comments", "string", "abcd"}});
  text.replace(text.find("abcd") - 4, 4, numbers({0x7869701f}));
  expectRefused(text, "an attribute of");
  expectRefused(exrHeader({{"dataWindow", "box2i", numbers({0, -1000000000, 15, 1000000000})}}), "a side");
  expectRefused(exrHeader({{"dataWindow", "box2i", numbers({0, 5, 15, 4})}}), "a side");
  expectRefused(exrHeader({{"lines", "lineOrder", "abcd"}}), "doesn't fill");
  expectRefused(
      exrHeader({{"channels", "chlist", "R" + std::string(17, '\0') + "G" + std::string(17, '\0')}}),
      "doesn't fill");
  expectRefused(exrHeader({{"names", "stringvector", numbers({3}) + "ab"}}), "doesn't fill");
  expectRefused(exrHeader({{"tiles", "tiledesc", numbers({100000000, 16}) + '\0'}}), "tiles of");
  expectRefused(exrHeader({{"preview", "preview", numbers({30000, 30000})}}), "a preview");
  expectRefused(exrHeader({{"chunkCount", "int", numbers({0x7fffffff})}}), "chunks");
  expectRefused(exrHeader({{"comments", "string", "abcd"}}).substr(0, 20), "ends inside its header");
}

}  // namespace
}  // namespace luciole
