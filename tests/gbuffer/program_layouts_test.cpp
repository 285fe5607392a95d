// Files with the exact names, types and headers of each program, made from our own G-buffer of the Cornell
// box: lit again, they give the picture that our own G-buffer gives.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "gbuffer/camera_header.hpp"
#include "gbuffer/foreign_file.hpp"
#include "gbuffer/gbuffer_input.hpp"
#include "luciole/gbuffer_file.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr int kBoxWidth = 64, kBoxHeight = 48;

/// The Cornell box from a corner, so that no axis of the world is one of the camera's. Some background shows.
struct Box {
  Scene scene = loadScene(LUCIOLE_SOURCE_DIR "/scenes/cornell.json");
  RenderSettings settings = settingsFor(scene, {kBoxWidth, kBoxHeight});
  GBuffer gbuffer;

  Box() {
    settings.camera.camera_to_world =
        glm::inverse(glm::lookAt(glm::dvec3(3.5, 4.5, 9), glm::dvec3(0.2, 2.4, 0), glm::dvec3(0, 1, 0)));
    // Shadows end at the same places to within rounding, and so not at the same pixels.
    settings.shade.shadows = ShadowMethod::kOff;
    Stats stats;
    gbuffer = rasterizeScene(nullptr, scene, settings, stats);
    // What few programs write.
    gbuffer.lift = {};
    gbuffer.geometric_normal = {};
    std::fill(gbuffer.specular.begin(), gbuffer.specular.end(), 0.0f);
    gbuffer.ambient = gbuffer.diffuse;
  }
  Image shade(const GBuffer& surfaces) const {
    Stats stats;
    return shadeGBuffer(testDevice(), scene, surfaces, settings, stats);
  }
};

const Box& box() {
  static const Box made;
  return made;
}

/// The largest difference of two pictures' pixels, and the largest value of the first.
std::pair<float, float> difference(const Image& a, const Image& b) {
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  float most = 0, largest = 0;
  for (std::size_t i = 0; i < std::min(a.pixels.size(), b.pixels.size()); ++i) {
    most = std::max(most, std::abs(a.pixels[i] - b.pixels[i]));
    largest = std::max(largest, a.pixels[i]);
  }
  return {most, largest};
}

struct Program {
  const char* name;
  std::function<std::vector<ForeignPart>(const Surfaces&)> write;
  FileSpace space = FileSpace::kWorld;
  bool is_half = false;  ///< positions and normals
  bool has_half_colors = false;
  bool has_camera = true;  ///< in the header; else the scene's is given
  bool has_emission = true;
  const char* holes = "zero";  ///< what the file has where nothing is
};

using Value = std::function<glm::vec3(int, int)>;

Value positions(const Surfaces& s) {
  return [&s](int x, int y) { return s.position(x, y); };
}
Value normals(const Surfaces& s) {
  return [&s](int x, int y) { return s.normal(x, y); };
}
/// The share of light that surfaces reflect: π Kd for lights in watts a steradian.
Value albedo(const Surfaces& s) {
  return [&s](int x, int y) { return float(std::numbers::pi) * s.three(s.gbuffer.diffuse, x, y); };
}
Value emission(const Surfaces& s) {
  return [&s](int x, int y) { return s.three(s.gbuffer.emission, x, y); };
}
Value black() {
  return [](int, int) { return glm::vec3(0.0f); };
}
std::function<float(int, int)> depth(const Surfaces& s, float hole) {
  return [&s, hole](int x, int y) { return s.depth(x, y, hole); };
}

/// worldToCamera and worldToNDC as OpenEXR defines them.
void addStandardCamera(const Surfaces& s, OIIO::ImageSpec& spec) {
  for (const auto& [name, matrix] : cameraAttributes(s.gbuffer.camera, {kBoxWidth, kBoxHeight}).matrices)
    spec.attribute(name, kMatrixType, glm::value_ptr(matrix));
}

/// Blender 4.5: one part of view layers, floats; nothing of the camera.
std::vector<ForeignPart> blender(const Surfaces& s) {
  ForeignPart part;
  addLayer(part.channels, "ViewLayer.Combined", "RGB", kFloat, black());
  part.channels.push_back({"ViewLayer.Combined.A", kFloat, [](int, int) { return 1.0f; }});
  part.channels.push_back({"ViewLayer.Depth.Z", kFloat, depth(s, 1e10f)});
  addLayer(part.channels, "ViewLayer.DiffCol", "RGB", kFloat, albedo(s));
  addLayer(part.channels, "ViewLayer.Emit", "RGB", kFloat, emission(s));
  addLayer(part.channels, "ViewLayer.GlossCol", "RGB", kFloat, albedo(s));
  addLayer(part.channels, "ViewLayer.Normal", "XYZ", kFloat, normals(s));
  addLayer(part.channels, "ViewLayer.Position", "XYZ", kFloat, positions(s));
  part.header = [](OIIO::ImageSpec& spec) {
    spec.attribute("BlenderMultiChannel", "Blender V2.55.1 and newer");
    spec.attribute("compression", "zip");
  };
  return {part};
}

/// Blender 5: a part a pass, by its full name.
std::vector<ForeignPart> blender5(const Surfaces& s) {
  std::vector<ForeignPart> parts;
  const auto add = [&](const std::string& pass, const char* components, const Value& value) {
    ForeignPart part;
    addLayer(part.channels, "ViewLayer." + pass, components, kFloat, value);
    part.header = [pass](OIIO::ImageSpec& spec) {
      spec.attribute("oiio:subimagename", "ViewLayer." + pass);
      spec.attribute("compression", "zip");
    };
    parts.push_back(part);
  };
  add("Combined", "RGB", black());
  add("Depth", "RGB", black());
  parts.back().channels = {{"ViewLayer.Depth.Z", kFloat, depth(s, 1e10f)}};
  add("Position", "XYZ", positions(s));
  add("Normal", "XYZ", normals(s));
  add("Diffuse Color", "RGB", albedo(s));
  add("Glossy Color", "RGB", albedo(s));
  add("Emission", "RGB", emission(s));
  return parts;
}

/// pbrt-v4's GBufferFilm: halves, camera space with z ahead, matrices for column vectors. Its "NDC" has y up,
/// and the shorter side of the picture measures 1.
std::vector<ForeignPart> pbrt(const Surfaces& s) {
  const glm::vec3 ahead(1, 1, -1);
  ForeignPart part;
  const auto add = [&](const char* name, const char* components, const Value& value) {
    addLayer(part.channels, name, components, kHalf, value);
  };
  add("", "RGB", black());
  add("Albedo", "RGB", albedo(s));
  add("P", "XYZ", [&s, ahead](int x, int y) { return ahead * s.viewPosition(x, y); });
  for (const char* name : {"dzdx", "dzdy", "u", "v"})
    part.channels.push_back({name, kHalf, [](int, int) { return 0.0f; }});
  for (const char* name : {"N", "Ns"})
    add(name, "XYZ", [&s, ahead](int x, int y) { return ahead * s.viewNormal(x, y); });
  add("Variance", "RGB", black());
  add("RelativeVariance", "RGB", black());
  part.header = [&s](OIIO::ImageSpec& spec) {
    const Camera& camera = s.gbuffer.camera;
    const glm::dmat4 mirror = glm::scale(glm::dmat4(1.0), glm::dvec3(1, 1, -1));
    const glm::dmat4 world_to_camera = mirror * glm::inverse(camera.camera_to_world);
    const double inverse_tan = 1 / std::tan(camera.fov_y / 2), n = 1e-2, f = 1000;
    glm::dmat4 projection{0.0};
    projection[0][0] = projection[1][1] = inverse_tan;
    projection[2] = {0, 0, f / (f - n), 1};
    projection[3] = {0, 0, -f * n / (f - n), 0};
    const glm::dmat4 to_ndc = glm::translate(glm::dmat4(1.0), glm::dvec3(0.5)) *
                              glm::scale(glm::dmat4(1.0), glm::dvec3(0.5)) * projection;
    addMatrix(spec, "worldToCamera", glm::transpose(world_to_camera));
    addMatrix(spec, "worldToNDC", glm::transpose(to_ndc * world_to_camera));
    spec.attribute("compression", "zip");
  };
  return {part};
}

/// Mitsuba 3's AOV integrator, "pos:position,nn:sh_normal,gn:geo_normal,albedo:albedo,dd:depth": floats,
/// nothing of the camera, and a depth along the ray.
std::vector<ForeignPart> mitsuba(const Surfaces& s) {
  ForeignPart part;
  addLayer(part.channels, "", "RGB", kFloat, black());
  addLayer(part.channels, "pos", "XYZ", kFloat, positions(s));
  addLayer(part.channels, "nn", "XYZ", kFloat, normals(s));
  addLayer(part.channels, "gn", "XYZ", kFloat, normals(s));
  addLayer(part.channels, "albedo", "RGB", kFloat, albedo(s));
  part.channels.push_back({"dd.T", kFloat, [&s](int x, int y) { return glm::length(s.viewPosition(x, y)); }});
  addLayer(part.channels, "img", "RGB", kFloat, black());
  part.channels.push_back({"img.A", kFloat, [](int, int) { return 1.0f; }});
  part.header = [](OIIO::ImageSpec& spec) { spec.attribute("compression", "piz"); };
  return {part};
}

/// RenderMan's display of colours: r g b for vectors too; OpenEXR's matrices.
std::vector<ForeignPart> renderMan(const Surfaces& s) {
  ForeignPart part;
  addLayer(part.channels, "Ci", "rgb", kHalf, black());
  part.channels.push_back({"a", kHalf, [](int, int) { return 1.0f; }});
  addLayer(part.channels, "__Pworld", "rgb", kFloat, positions(s));
  addLayer(part.channels, "__Nworld", "rgb", kFloat, normals(s));
  addLayer(part.channels, "albedo", "rgb", kFloat, albedo(s));
  part.channels.push_back({"z", kFloat, depth(s, INFINITY)});
  part.header = [&s](OIIO::ImageSpec& spec) {
    addStandardCamera(s, spec);
    spec.attribute("compression", "zips");
  };
  return {part};
}

/// Arnold's driver_exr: tiles, colours in halves, vectors in floats, Z of 1e30 where nothing is.
std::vector<ForeignPart> arnold(const Surfaces& s) {
  ForeignPart part;
  addLayer(part.channels, "", "RGB", kHalf, black());
  part.channels.push_back({"A", kHalf, [](int, int) { return 1.0f; }});
  addLayer(part.channels, "P", "XYZ", kFloat, positions(s));
  addLayer(part.channels, "N", "XYZ", kFloat, normals(s));
  part.channels.push_back({"Z", kFloat, depth(s, 1e30f)});
  addLayer(part.channels, "albedo", "RGB", kHalf, albedo(s));
  addLayer(part.channels, "diffuse", "RGB", kHalf, black());
  addLayer(part.channels, "emission", "RGB", kHalf, emission(s));
  part.header = [&s](OIIO::ImageSpec& spec) {
    addStandardCamera(s, spec);
    spec.tile_width = spec.tile_height = 32;
    spec.attribute("compression", "zip");
  };
  return {part};
}

/// 3Delight's built-in variables as layers of their names.
std::vector<ForeignPart> threeDelight(const Surfaces& s) {
  ForeignPart part;
  addLayer(part.channels, "Ci", "rgb", kHalf, black());
  addLayer(part.channels, "P.world", "xyz", kFloat, positions(s));
  addLayer(part.channels, "N.world", "xyz", kFloat, normals(s));
  addLayer(part.channels, "albedo", "rgb", kHalf, albedo(s));
  part.channels.push_back({"z", kFloat, depth(s, 1e30f)});
  part.header = [&s](OIIO::ImageSpec& spec) { addStandardCamera(s, spec); };
  return {part};
}

/// numpy arrays that OpenEXR's own Python module writes: NaN where nothing is.
std::vector<ForeignPart> python(const Surfaces& s) {
  const auto orNan = [&s](const Value& value) -> Value {
    return [&s, value](int x, int y) { return s.shows(x, y) ? value(x, y) : glm::vec3(NAN); };
  };
  ForeignPart part;
  addLayer(part.channels, "P", "RGB", kFloat, orNan(positions(s)));
  addLayer(part.channels, "N", "RGB", kFloat, orNan(normals(s)));
  addLayer(part.channels, "albedo", "rgb", kFloat, albedo(s));
  return {part};
}

const Program kPrograms[] = {
    {.name = "Blender 4.5", .write = blender, .has_camera = false, .holes = "zero"},
    {.name = "Blender 5", .write = blender5, .has_camera = false, .holes = "zero"},
    {.name = "pbrt-v4",
     .write = pbrt,
     .space = FileSpace::kCamera,
     .is_half = true,
     .has_half_colors = true,
     .has_emission = false,
     .holes = "zero"},
    {.name = "Mitsuba 3", .write = mitsuba, .has_camera = false, .has_emission = false, .holes = "zero"},
    {.name = "RenderMan", .write = renderMan, .has_emission = false, .holes = "zero"},
    {.name = "Arnold", .write = arnold, .has_half_colors = true, .holes = "zero"},
    {.name = "3Delight",
     .write = threeDelight,
     .has_half_colors = true,
     .has_emission = false,
     .holes = "zero"},
    {.name = "Python", .write = python, .has_camera = false, .has_emission = false, .holes = "NaN"},
};

class ProgramLayouts : public testing::TestWithParam<Program> {};

TEST_P(ProgramLayouts, GiveThePictureOfOurOwnGBuffer) {
  const Program& program = GetParam();
  const TemporaryFolder folder;
  const std::string path = folder / "in.exr";
  const Surfaces surfaces{box().gbuffer};
  writeForeignParts(path, kBoxWidth, kBoxHeight, program.write(surfaces));
  GBufferRequest request{.albedo = true};
  if (!program.has_camera) request.camera = box().gbuffer.camera;
  const GBufferInput input = readGBuffer(path, request);

  GBuffer expected = box().gbuffer;
  // The ambient coefficient stays the albedo.
  for (float& one : expected.ambient) one *= float(std::numbers::pi);
  if (!program.has_emission) expected.emission = {};
  const auto [most, largest] = difference(box().shade(expected), box().shade(input.gbuffer));
  fmt::print("| {} | {} | {} | Kd = albedo/pi | {:.1e} of {:.2f} |\n", program.name,
             input.notes.front().substr(input.notes.front().find("named as")),
             program.space == FileSpace::kCamera ? "camera" : "world", most, largest);
  // Positions, normals and colours are rounded, to 2^-24 or 2^-11 of themselves. The nearest light, a lamp's
  // below the ceiling, is half a metre off and points at most 14 m from the eye or the origin: a shift of 14
  // u changes 1/d² by 4 · 14 u / 0.5, cosines by the same half at most, and colours by u: together less than
  // 200 u of the colour.
  const float u = program.is_half ? 0x1p-11f : 0x1p-24f;
  EXPECT_LE(most, (200 * u + (program.has_half_colors ? 0x1p-11f : 0)) * largest);
  EXPECT_TRUE(input.gbuffer.knows_camera);
  EXPECT_NEAR(input.gbuffer.camera.fov_y, box().gbuffer.camera.fov_y, program.is_half ? 1e-2 : 1e-5);
  EXPECT_THAT(input.notes, Contains(HasSubstr(program.space == FileSpace::kCamera ? "in camera space"
                                                                                  : "in world space")));
  EXPECT_THAT(input.notes, Contains(HasSubstr(program.holes)));
}

INSTANTIATE_TEST_SUITE_P(Programs, ProgramLayouts, testing::ValuesIn(kPrograms), [](const auto& tested) {
  std::string name = tested.param.name;
  std::erase_if(name, [](unsigned char c) { return !std::isalnum(c); });
  return name;
});

TEST(Relight, OurOwnFileIsReadBitForBit) {
  const TemporaryFolder folder;
  writeGBuffer(box().gbuffer, folder / "g.exr", {});
  GBufferRequest request;
  request.camera = Camera{};  // which doesn't count: the file has its own
  const GBufferInput input = readGBuffer(folder / "g.exr", request);
  EXPECT_EQ(difference(box().shade(box().gbuffer), box().shade(input.gbuffer)).first, 0.0f);
  EXPECT_THAT(input.notes.front(),
              HasSubstr("named as Luciole's: position = P, normal = N, depth = Z, diffuse = diffuse"));
}

}  // namespace
}  // namespace luciole::test
