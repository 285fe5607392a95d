#include "scene/obj/obj.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "image/image.hpp"
#include "scene/triangulate.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

using testing::HasSubstr;

class ObjLoader : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
  }
  /// A picture of one texel.
  void writePicture(const std::string& name, const std::vector<float>& texel) {
    const std::vector<std::string> channels{"R", "G", "B", "A"};
    writeImage({1, 1, {channels.begin(), channels.begin() + texel.size()}, texel}, folder / name, {});
  }
  Scene load(const std::string& text) {
    write("a.obj", text);
    Scene scene;
    loadObj(folder / "a.obj", scene);
    return scene;
  }
  std::string error(const std::string& text) {
    try {
      load(text);
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  }
  Material material(const std::string& statements) {
    write("m.mtl", "newmtl x\n" + statements);
    const Scene scene = load(std::string("mtllib m.mtl\nusemtl x\n") + kTriangle);
    return scene.materials.at(scene.meshes[0].triangle_materials[0]);
  }
  static constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const test::TemporaryFolder folder;
};

glm::dvec3 faceNormal(const Mesh& mesh, const glm::uvec3& t) {
  const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
  return glm::normalize(glm::cross(b - a, c - a));
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    sum += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return sum;
}

/// Unit normals are computed in double and rounded once to float: a component below 1 is off by 2^-25 at
/// most, three of them by sqrt(3) x 2^-25 < 2^-24, which leaves room for the rounding in double.
constexpr double kNormalTolerance = 1.0 / (1 << 24);

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
  EXPECT_LE(glm::length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}

TEST_F(ObjLoader, ATriangleComesThroughAsItIs) {
  const Scene scene = load(kTriangle);
  ASSERT_EQ(scene.meshes.size(), 1u);
  const Mesh& mesh = scene.meshes[0];
  EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.normals, std::vector<glm::vec3>(3, glm::vec3(0, 0, 1)));
  EXPECT_EQ(mesh.triangles, std::vector<glm::uvec3>{glm::uvec3(0, 1, 2)});
  EXPECT_TRUE(mesh.uvs.empty());
  EXPECT_TRUE(mesh.colors.empty());
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].object_to_world, glm::dmat4(1.0));
  EXPECT_EQ(scene.materials.at(0).diffuse, Material().diffuse);
}

TEST_F(ObjLoader, AppendsBehindWhatTheSceneHolds) {
  write("a.obj", kTriangle);
  Scene scene;
  EXPECT_EQ(loadObj(folder / "a.obj", scene), 0u);
  EXPECT_EQ(loadObj(folder / "a.obj", scene), 1u);
  EXPECT_EQ(scene.meshes[1].triangle_materials[0], 1u);
  EXPECT_EQ(scene.objects[1].mesh, 1u);
}

TEST_F(ObjLoader, NegativeIndicesCountFromTheEnd) {
  const Scene scene = load("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 7 7 7\n");
  EXPECT_EQ(scene.meshes[0].positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST_F(ObjLoader, AConcavePolygonKeepsItsArea) {
  // A square of side 2 (area 4) less a notch, the triangle of base 2 and height 1.5.
  const Scene scene = load("v 0 0 5\nv 2 0 5\nv 2 2 5\nv 1 0.5 5\nv 0 2 5\nf 1 2 3 4 5\n");
  EXPECT_EQ(scene.meshes[0].triangles.size(), 3u);
  // Three areas of exact small binary fractions.
  EXPECT_EQ(area(scene.meshes[0]), 2.5);
  for (const glm::uvec3& t : scene.meshes[0].triangles)
    EXPECT_EQ(faceNormal(scene.meshes[0], t), glm::dvec3(0, 0, 1));
}

TEST_F(ObjLoader, AConcaveQuadIsCutThroughItsNotch) {
  const Scene scene = load("v 0 0 0\nv 2 1 0\nv 0 2 0\nv 1 1 0\nf 1 2 3 4\n");
  EXPECT_EQ(area(scene.meshes[0]), 1.0);
  for (const glm::uvec3& t : scene.meshes[0].triangles)
    EXPECT_EQ(faceNormal(scene.meshes[0], t), glm::dvec3(0, 0, 1));
}

TEST(Triangulate, AStarOf255CornersIsCoveredOnceWherever) {
  std::vector<glm::dvec3> star;
  double expected = 0;
  constexpr int kCorners = 254;
  const double step = 2 * std::acos(-1.0) / kCorners;
  for (int i = 0; i < kCorners; ++i) {
    const double radius = i % 2 ? 1 : 3;
    star.emplace_back(1000 + radius * std::cos(i * step), 2000 + radius * std::sin(i * step), -500);
    expected += 0.5 * 1 * 3 * std::sin(step);
  }
  double sum = 0;
  const auto triangles = triangulate(star);
  EXPECT_EQ(triangles.size(), std::size_t{kCorners - 2});
  for (const auto& [a, b, c] : triangles) {
    const double twice = glm::cross(star[b] - star[a], star[c] - star[a]).z;
    EXPECT_GT(twice, 0) << "turned over";
    sum += twice / 2;
  }
  // Corners are rounded to 2^-42 (ulp/2 of 2000 is below it) and edges are at most 6 long: 254 areas, each
  // off by less than 4 x 6 x 2^-42.
  EXPECT_NEAR(sum, expected, kCorners * 4 * 6 * std::ldexp(1.0, -42));
}

TEST(Triangulate, AConvexPolygonBecomesAFan) {
  using Fan = std::vector<std::array<int, 3>>;
  EXPECT_EQ(triangulate({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}), (Fan{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Triangulate, PolygonsWithoutAreaStillEnd) {
  EXPECT_EQ(triangulate(std::vector<glm::dvec3>(9, glm::dvec3(1, 2, 3))).size(), 7u);
  EXPECT_EQ(triangulate({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2u) << "a bow tie";
}

TEST_F(ObjLoader, MissingNormalsAreSmoothWithoutAnySmoothingStatement) {
  // A corner of a cube: at the corner three faces of 90 degrees each meet, whatever way they are cut.
  const std::string cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\n";
  const Scene scene = load(cube + "f 1 4 3 2\nf 1 2 6 5\nf 1 5 7 4\n");
  const Mesh& mesh = scene.meshes[0];
  EXPECT_EQ(mesh.positions.size(), 7u);
  expectNear(mesh.normals[0], -glm::normalize(glm::dvec3(1)), kNormalTolerance);
}

TEST_F(ObjLoader, FacesAreWeightedByTheirAngle) {
  // At vertex 1: the xy plane with 90 degrees, and the yz plane (normal -x) with 45 degrees.
  const Scene scene = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 1\nf 1 2 3\nf 1 4 3\n");
  expectNear(scene.meshes[0].normals[0], glm::normalize(glm::dvec3(-1, 0, 2)), kNormalTolerance);
}

TEST_F(ObjLoader, SmoothingGroupsKeepTheEdgesBetweenThem) {
  const std::string roof = "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 0 0 1\n";
  const Mesh one = load(roof + "s 1\nf 1 3 2\nf 1 2 4\n").meshes[0];
  EXPECT_EQ(one.positions.size(), 4u);
  const Mesh two = load(roof + "s 1\nf 1 3 2\ns 2\nf 1 2 4\n").meshes[0];
  EXPECT_EQ(two.positions.size(), 6u);
  const Mesh on = load(roof + "s on\nf 1 3 2\nf 1 2 4\n").meshes[0];
  EXPECT_EQ(on.normals, one.normals);
  const Mesh off = load(roof + "s off\nf 1 3 2\nf 1 2 4\n").meshes[0];
  EXPECT_EQ(off.positions.size(), 6u);
  for (const glm::uvec3& t : off.triangles)
    expectNear(off.normals[t.x], faceNormal(off, t), kNormalTolerance);
}

TEST_F(ObjLoader, NormalsOfTheFileAreMadeUnitAndZeroOnesReplaced) {
  const Mesh mesh = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 3 4\nvn 0 0 0\nf 1//1 2//1 3//2\n").meshes[0];
  expectNear(mesh.normals[0], {0, 0.6, 0.8}, kNormalTolerance);
  EXPECT_EQ(mesh.normals[2], glm::vec3(0, 0, 1));
}

TEST_F(ObjLoader, TrianglesAreWoundToAgreeWithTheNormals) {
  const Mesh mesh = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nf 1//1 2//1 3//1\n").meshes[0];
  EXPECT_EQ(faceNormal(mesh, mesh.triangles[0]), glm::dvec3(0, 0, -1));
}

TEST_F(ObjLoader, TextureCoordinatesGrowDownwards) {
  const Mesh mesh = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.75\nvt 1 1\nf 1/1 2/2 3\n").meshes[0];
  EXPECT_EQ(mesh.uvs, (std::vector<glm::vec2>{{0.25f, 0.25f}, {1, 0}, {0, 1}}));
}

TEST_F(ObjLoader, VerticesAreSharedUnlessTheirDataDiffers) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\n";
  EXPECT_EQ(load(square + "f 1/1 2/1 3/1\nf 1/1 3/1 4/1\n").meshes[0].positions.size(), 4u);
  EXPECT_EQ(load(square + "f 1/1 2/1 3/1\nf 1/2 3/1 4/1\n").meshes[0].positions.size(), 5u);
}

TEST_F(ObjLoader, VertexColoursCountOnlyIfEveryVertexHasOne) {
  const Mesh all = load("v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0 0 0 1\nf 1 2 3\n").meshes[0];
  EXPECT_EQ(all.colors, (std::vector<glm::vec4>{{1, 0, 0, 1}, {0, 0.5f, 0, 1}, {0, 0, 1, 1}}));
  EXPECT_TRUE(load("v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").meshes[0].colors.empty());
  EXPECT_TRUE(load("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n").meshes[0].colors.empty()) << "a weight";
}

TEST_F(ObjLoader, MaterialsAreRead) {
  const Material m = material("Ka 0.1 0.2 0.3\nKd 0.4 0.5 0.6\nKs 0.7 0.8 0.9\nNs 12.5\nKe 2 3 4\n");
  EXPECT_EQ(m.name, "x");
  EXPECT_EQ(m.ambient, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(m.diffuse, glm::vec3(0.4f, 0.5f, 0.6f));
  EXPECT_EQ(m.specular, glm::vec3(0.7f, 0.8f, 0.9f));
  EXPECT_EQ(m.emission, glm::vec3(2, 3, 4));
  EXPECT_EQ(m.shininess, 12.5f);
  EXPECT_TRUE(m.double_sided);
}

TEST_F(ObjLoader, StatementsLeftOutHaveTheDefaultsOfEveryMaterial) {
  const Material m = material("newmtl y\nKd 1 1 1\n");
  EXPECT_EQ(m.ambient, Material().ambient);
  EXPECT_EQ(m.diffuse, Material().diffuse);
  EXPECT_EQ(m.specular, Material().specular);
}

TEST_F(ObjLoader, IlluminationModels0And1HaveNoHighlight) {
  for (const char* illum : {"0", "1"}) {
    EXPECT_EQ(material(std::string("Ks 1 1 1\nillum ") + illum).specular, glm::vec3(0));
  }
  EXPECT_EQ(material("Ks 1 1 1\nillum 2").specular, glm::vec3(1));
  EXPECT_EQ(material("Ks 1 1 1\n").specular, glm::vec3(1));
}

TEST_F(ObjLoader, DissolveMakesNoHoles) {
  writePicture("plain.png", {1, 1, 1});
  for (const char* dissolve : {"d 0\n", "d 0.3\n", "Tr 1\n"}) {
    const Material m = material(std::string(dissolve) + "map_Kd plain.png\n");
    EXPECT_EQ(m.alpha, 1.0f);
    EXPECT_EQ(m.alpha_cutoff, 0.0f);
  }
}

TEST_F(ObjLoader, OnlyMapsWithAlphaMakeHoles) {
  writePicture("plain.png", {1, 1, 1});
  writePicture("opaque.png", {1, 1, 1, 1});
  writePicture("holes.png", {1, 1, 1, 0});
  EXPECT_EQ(material("map_Kd plain.png\n").alpha_cutoff, 0.0f);
  EXPECT_EQ(material("map_Kd opaque.png\n").alpha_cutoff, 0.0f);
  EXPECT_EQ(material("map_Kd holes.png\n").alpha_cutoff, 0.5f);
  const Material mask = material("map_d plain.png\n");
  EXPECT_EQ(mask.alpha_cutoff, 0.5f);
  EXPECT_EQ(mask.alpha_map.texture, 0);
}

TEST_F(ObjLoader, MapsAreFoundThroughBackslashesAndBlanks) {
  std::filesystem::create_directory(folder / "tex tures");
  writePicture("tex tures/a b.png", {1, 0, 0});
  const Material m = material("map_Kd tex tures\\a b.png\nmap_Ke tex tures/a b.png  \n");
  EXPECT_EQ(m.diffuse_map.texture, 0);
  EXPECT_EQ(m.emission_map.texture, 0) << "one file is one texture";
  EXPECT_EQ(m.emission, glm::vec3(1)) << "a map_Ke without Ke is seen";
}

TEST_F(ObjLoader, ClampedMapsAreClamped) {
  writePicture("a.png", {1, 0, 0});
  EXPECT_EQ(material("map_Kd -clamp on a.png\n").diffuse_map.wrap_u, Wrap::kClampToEdge);
  EXPECT_EQ(material("map_Kd a.png\n").diffuse_map.wrap_v, Wrap::kRepeat);
}

TEST_F(ObjLoader, BumpMapsAndNormalMapsBendNormals) {
  writePicture("a.png", {1, 0, 0});
  for (const char* statement :
       {"bump -bm 0.5 a.png\n", "map_bump -bm 0.5 a.png\n", "map_Bump -bm 0.5 a.png\n"}) {
    const Material m = material(statement);
    EXPECT_EQ(m.normal_map.texture, 0) << statement;
    EXPECT_EQ(m.normal_scale, 0.5f) << statement;
  }
  EXPECT_EQ(material("bump a.png\n").normal_scale, 1.0f);
  EXPECT_EQ(material("map_Kd a.png\n").normal_map.texture, -1);
  write("m.mtl", "newmtl x\nmap_Kd a.png\nbump a.png\nnorm a.png\n");
  const Scene scene = load(std::string("mtllib m.mtl\nusemtl x\n") + kTriangle);
  const Material& both = scene.materials.at(0);
  EXPECT_EQ(scene.textures.at(std::size_t(both.normal_map.texture)).kind, TextureKind::kNormals)
      << "norm counts";
  EXPECT_EQ(scene.textures.at(std::size_t(both.diffuse_map.texture)).kind, TextureKind::kColor);
  EXPECT_THROW(material("bump -bm 1e9 a.png\n"), InputError);
}

TEST_F(ObjLoader, AMissingPictureIsToldByFileAndMaterialWhichDoesWithout) {
  write("m.mtl", "newmtl x\nKd 0.5 0 0\nKe 1 1 1\nmap_Kd nowhere.png\nmap_Ke gone.png\n");
  const Scene scene = load(std::string("mtllib m.mtl\nusemtl x\n") + kTriangle);
  ASSERT_EQ(scene.missing_textures.size(), 2u);
  EXPECT_THAT(scene.missing_textures[0], HasSubstr(folder / "m.mtl: material 'x': map_Kd"));
  EXPECT_THAT(scene.missing_textures[0], HasSubstr("nowhere.png"));
  EXPECT_THAT(scene.missing_textures[1], HasSubstr("map_Ke"));
  EXPECT_EQ(scene.materials.at(0).diffuse, glm::vec3(0.5f, 0, 0));
  EXPECT_EQ(scene.materials.at(0).diffuse_map.texture, -1);
  EXPECT_EQ(scene.materials.at(0).emission, glm::vec3(0)) << "it glows by the picture only";
}

TEST_F(ObjLoader, TexturesOfUnusedMaterialsAreNotLoaded) {
  const Material m = material("Kd 1 0 0\nnewmtl unused\nmap_Kd nowhere.png\n");
  EXPECT_EQ(m.diffuse, glm::vec3(1, 0, 0));
}

TEST_F(ObjLoader, AMissingMaterialFileGivesTheDefaultMaterial) {
  const Scene scene = load(std::string("mtllib nowhere.mtl\nusemtl x\n") + kTriangle);
  EXPECT_EQ(scene.materials.at(0).diffuse, Material().diffuse);
}

TEST_F(ObjLoader, NamesOfMaterialsAndTheirFilesMayHoldBlanks) {
  write("my file.mtl", "newmtl  dark red \nKd 0.5 0 0\nnewmtl dark\nKd 0 0 0\n");
  const Scene scene = load(std::string("mtllib my file.mtl\nusemtl dark red\n") + kTriangle);
  EXPECT_EQ(scene.materials.at(0).diffuse, glm::vec3(0.5f, 0, 0));
}

TEST_F(ObjLoader, EveryMaterialFileOfAStatementIsRead) {
  write("a.mtl", "newmtl a\nKd 1 0 0\n");
  write("b.mtl", "newmtl b\nKd 0 1 0\n");
  const Scene scene = load(std::string("mtllib missing.mtl a.mtl b.mtl\nusemtl b\n") + kTriangle);
  EXPECT_EQ(scene.materials.at(0).diffuse, glm::vec3(0, 1, 0));
}

TEST_F(ObjLoader, EachTriangleHasItsMaterial) {
  write("m.mtl", "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n");
  const Scene scene = load(std::string("mtllib m.mtl\nusemtl b\n") + kTriangle +
                           "usemtl a\ng x\nf 1 2 3\nusemtl b\nf 3 2 1\n");
  const Mesh& mesh = scene.meshes[0];
  EXPECT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[mesh.triangle_materials[0]].name, "b");
  EXPECT_EQ(scene.materials[mesh.triangle_materials[1]].name, "a");
  EXPECT_EQ(mesh.triangle_materials[2], mesh.triangle_materials[0]);
}

TEST_F(ObjLoader, LinesMayBeContinuedCommentedAndEndAnyWay) {
  const Mesh expected = load(kTriangle).meshes[0];
  for (const char* text : {"v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r",
                           "\xef\xbb\xbfv 0 0 0 # origin\n  v\t1 0 0\nv 0 1 0\nf 1 2 \\\n 3\n",
                           "v 0 0 0\nv 1 0 0\nv +0 1e0 .0\nf 1// 2// 3//  \n"}) {
    EXPECT_EQ(load(text).meshes[0].positions, expected.positions) << text;
  }
}

TEST_F(ObjLoader, LinesPointsAndUnknownStatementsAreIgnored) {
  EXPECT_EQ(load(std::string("p 0\nl 7 8\nvp 1\ncurv2 x\n") + kTriangle).meshes[0].triangles.size(), 1u);
}

TEST_F(ObjLoader, MistakesNameTheLineInOneLine) {
  EXPECT_THAT(error("v 0 0 0\nv nan 0 0\n"), HasSubstr("a.obj: line 2: 'nan' is not a finite number"));
  EXPECT_THAT(error("v 1e39 0 0\n"), HasSubstr("line 1: '1e39' is not a finite number"));
  EXPECT_THAT(error("v +-1 0 0\n"), HasSubstr("line 1: '+-1' is not a finite number"));
  EXPECT_THAT(error("v 1 2\n"), HasSubstr("line 1: a vertex needs 3 numbers, found 2"));
  EXPECT_THAT(error("v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 4\n"),
              HasSubstr("line 5: a face refers to vertex 4"));
  EXPECT_THAT(error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n"),
              HasSubstr("line 4: a face refers to vertex -4"));
  EXPECT_THAT(error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"), HasSubstr("line 4: index 0"));
  EXPECT_THAT(error("v 0 0 0\nf 1/2 1 1\n"), HasSubstr("line 2: a face refers to texture coordinate 2"));
  EXPECT_THAT(error("v 0 0 0\nf 1//99999999999999999999 1 1\n"), HasSubstr("is not an index"));
  EXPECT_THAT(error("v 0 0 0\nf one two three\n"), HasSubstr("line 2: 'one' is not an index"));
  EXPECT_THAT(error("v 0 0 0\n"), HasSubstr("has no faces"));
  EXPECT_THAT(error(""), HasSubstr("has no faces"));
  EXPECT_THAT(error(std::string("\xff\xfev\0 \0", 6)), HasSubstr("UTF-16"));
}

TEST_F(ObjLoader, AFaceOf255CornersIsReadAndMoreAreRefused) {
  std::string vertices, face = "f";
  for (int i = 1; i <= 256; ++i) {
    vertices += fmt::format("v {} {} 0\n", std::cos(i * 0.02), std::sin(i * 0.02));
    if (i <= 255) face += fmt::format(" {}", i);
  }
  EXPECT_EQ(load(vertices + face).meshes[0].triangles.size(), 253u);
  EXPECT_THAT(error(vertices + face + " 256"), HasSubstr("more than 255 corners"));
}

TEST_F(ObjLoader, RealScenesHaveTheirTriangles) {
  LUCIOLE_NEEDS_SHARED();
  const auto triangles = [](const char* file) {
    Scene scene;
    loadObj((test::sharedScenes() / file).string(), scene);
    return scene.meshes.at(0).triangles.size();
  };
  EXPECT_EQ(triangles("utah_teapot/teapot.obj"), 6320u);
  EXPECT_EQ(triangles("quake_e1m1/e1m1.obj"), 15085u);
  EXPECT_EQ(triangles("stanford/stanford-bunny.obj"), 69451u);
  EXPECT_EQ(triangles("stanford/dragon.obj"), 100000u);
  EXPECT_EQ(triangles("cornell_box/CornellBox-Original.obj"), 36u);
}

TEST_F(ObjLoader, SponzaHasItsTrianglesMaterialsAndMasks) {
  LUCIOLE_NEEDS_SHARED();
  Scene scene;
  loadObj((test::sharedScenes() / "sponza_crytek_obj/sponza.obj").string(), scene);
  EXPECT_EQ(scene.meshes[0].triangles.size(), 262267u);
  EXPECT_EQ(scene.materials.size(), 25u);
  int masks = 0;
  for (const Material& m : scene.materials) masks += m.alpha_cutoff == 0.5f;
  EXPECT_EQ(masks, 3) << "leaf, plant and chain";
}

TEST_F(ObjLoader, EverySharedObjLoads) {
  LUCIOLE_NEEDS_SHARED();
  for (const char* scenes : {"cornell_box", "stanford", "utah_teapot"}) {
    for (const auto& entry : std::filesystem::directory_iterator(test::sharedScenes() / scenes)) {
      if (entry.path().extension() != ".obj") continue;
      Scene scene;
      EXPECT_NO_THROW(loadObj(entry.path().string(), scene)) << entry.path();
    }
  }
}

}  // namespace
}  // namespace luciole
