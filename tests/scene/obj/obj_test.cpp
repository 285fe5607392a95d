#include "scene/obj/obj.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "luciole/error.hpp"
#include "luciole/image.hpp"
#include "scene/warning_texts.hpp"
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
  for (const char* group : {"ON", "4294967296", "99999999999999999999"})
    EXPECT_EQ(load(roof + "s " + group + "\nf 1 3 2\nf 1 2 4\n").meshes[0].normals, one.normals) << group;
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

TEST_F(ObjLoader, VertexColoursAreSrgbAndWhiteWhereThereIsNone) {
  const Mesh some = load("v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0\nf 1 2 3\n").meshes[0];
  ASSERT_EQ(some.colors.size(), 3u);
  EXPECT_EQ(some.colors[0], glm::vec4(1, 0, 0, 1));
  EXPECT_NEAR(some.colors[1].g, 0.21404, 5e-6) << "IEC 61966-2-1 of 0.5, in five digits";
  EXPECT_EQ(some.colors[2], glm::vec4(1));
  EXPECT_TRUE(load("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n").meshes[0].colors.empty()) << "a weight";
  const Mesh weighed = load("v 0 0 0 9 1 0 0\nv 1 0 0 9 0 1 0\nv 0 1 0 9 0 0 1\nf 1 2 3\n").meshes[0];
  EXPECT_EQ(weighed.colors, (std::vector<glm::vec4>{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}}));
}

TEST_F(ObjLoader, VertexColoursInBytesAreTakenAsSuch) {
  const Scene scene = load("v 0 0 0 255 0 0\nv 1 0 0 0 255 0\nv 0 1 0 255 255 255\nf 1 2 3\n");
  EXPECT_EQ(scene.meshes[0].colors, (std::vector<glm::vec4>{{1, 0, 0, 1}, {0, 1, 0, 1}, {1, 1, 1, 1}}));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_TRUE(scene.warnings[0].repaired);
}

TEST_F(ObjLoader, VertexColoursFarBrighterThanWhiteAreTold) {
  EXPECT_EQ(load("v 0 0 0 1.5 0.5 0\nv 1 0 0 0 1 0\nv 0 1 0 1 1 1\nf 1 2 3\n").warnings.size(), 0u);
  const Scene scene = load("v 0 0 0 65535 0.5 0\nv 1 0 0 0 1 0\nv 0 1 0 1 1 1\nf 1 2 3\n");
  EXPECT_THAT(test::textsOf(scene.warnings),
              testing::ElementsAre(HasSubstr("has vertex colours up to 65535")));
  EXPECT_FALSE(scene.warnings[0].repaired);
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

TEST_F(ObjLoader, IlluminationModel1HasNoHighlight) {
  EXPECT_EQ(material("Ks 1 1 1\nillum 1").specular, glm::vec3(0));
  EXPECT_EQ(material("Ks 1 1 1\nillum 2").specular, glm::vec3(1));
  EXPECT_EQ(material("Ks 1 1 1\n").specular, glm::vec3(1));
}

TEST_F(ObjLoader, IlluminationModel0IsAConstantColour) {
  writePicture("a.png", {1, 0, 0});
  const Material m = material("Ka 1 1 1\nKd 0.25 0.5 0.75\nKs 1 1 1\nKe 3 3 3\nmap_Kd a.png\nillum 0\n");
  EXPECT_EQ(m.emission, glm::vec3(0.25f, 0.5f, 0.75f));
  EXPECT_EQ(m.ambient + m.diffuse + m.specular, glm::vec3(0));
  EXPECT_EQ(m.emission_map.texture, m.diffuse_map.texture);
  EXPECT_TRUE(m.colored_emission);
}

TEST_F(ObjLoader, StatementsAreReadInAnyCase) {
  const Material m = material("KA 0.1 0.1 0.1\nkd 0.25 0.5 0.75\nks 1 1 1\nNS 4\nke 2 2 2\nILLUM 2\n");
  EXPECT_EQ(m.ambient, glm::vec3(0.1f));
  EXPECT_EQ(m.diffuse, glm::vec3(0.25f, 0.5f, 0.75f));
  EXPECT_EQ(m.specular, glm::vec3(1));
  EXPECT_EQ(m.emission, glm::vec3(2));
  EXPECT_EQ(m.shininess, 4);
  write("c.mtl", "NEWMTL x\nKD 1 0 0\n");
  const Scene scene = load("MTLLIB c.mtl\nUSEMTL x\nV 0 0 0\nV 1 0 0\nV 0 1 0\nF 1 2 3\n");
  EXPECT_EQ(scene.materials[0].diffuse, glm::vec3(1, 0, 0));
}

TEST_F(ObjLoader, OneNumberOfAColourStandsForAllThree) {
  EXPECT_EQ(material("Kd 0.5\n").diffuse, glm::vec3(0.5f));
  EXPECT_EQ(material("Ks 0.5 # grey\n").specular, glm::vec3(0.5f));
  EXPECT_EQ(material("Kd 1e-400\n").diffuse, glm::vec3(0));
  EXPECT_EQ(material("Kd 0.5 0.25 0.75 1\n").diffuse, glm::vec3(0.5f, 0.25f, 0.75f));
}

TEST_F(ObjLoader, ColoursInXyzAreConverted) {
  const Material m = material("Kd xyz 0.4124 0.2126 0.0193\n");
  EXPECT_NEAR(m.diffuse.r, 1, 1e-3) << "the primaries are given in four digits";
  EXPECT_NEAR(m.diffuse.g, 0, 1e-3);
  EXPECT_NEAR(m.diffuse.b, 0, 1e-3);
}

TEST_F(ObjLoader, WhatIsNoNumberInAMaterialLeavesTheDefaultAndIsTold) {
  for (const char* statement : {"d nan", "Tr x", "d"}) {
    write("m.mtl", std::string("newmtl x\n") + statement + "\n");
    EXPECT_EQ(load(std::string("mtllib m.mtl\nusemtl x\n") + kTriangle).warnings.size(), 1u) << statement;
  }
  for (const char* statement : {"Kd nan 0 0", "Kd inf", "Kd red", "Kd 0.5 0,5 0.5", "Kd", "Ns nan", "Ns x",
                                "Ke 1e999", "illum two", "illum 99", "Kd xyz 1 x 1"}) {
    write("m.mtl", std::string("newmtl x\n") + statement + "\n");
    const Scene scene = load(std::string("mtllib m.mtl\nusemtl x\n") + kTriangle);
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.diffuse, Material().diffuse) << statement;
    EXPECT_EQ(m.emission, Material().emission) << statement;
    EXPECT_EQ(m.shininess, 1) << statement;
    ASSERT_EQ(scene.warnings.size(), 1u) << statement;
    EXPECT_TRUE(scene.warnings[0].repaired) << statement;
    EXPECT_THAT(scene.warnings[0].text,
                HasSubstr(folder / "m.mtl: material 'x': " + std::string(statement, 2)));
  }
}

TEST_F(ObjLoader, WhatIsIgnoredIsToldOnceAFile) {
  writePicture("a.png", {1, 0, 0});
  write("m.mtl",
        "newmtl x\nmap_Kd -mm 0.1 2 -texres 512 a.png\nmap_Ks a.png\nKd spectral a.rfl\nd 0.5\nrubbish 1\n"
        "newmtl y\nmap_Kd -mm 0.2 2 a.png\nmap_Ks a.png\nKd spectral a.rfl\nTr 0.5\nd 0.4\nmore 1\n");
  const Scene scene = load(std::string("mtllib m.mtl\nusemtl x\n") + kTriangle + "usemtl y\nf 1 2 3\n");
  std::vector<std::string> kinds;
  for (const Warning& warning : scene.warnings) {
    kinds.push_back(warning.kind);
    EXPECT_FALSE(warning.repaired);
  }
  EXPECT_THAT(kinds, testing::UnorderedElementsAre("ignored -mm", "ignored -texres", "ignored map_ks",
                                                   "ignored kd spectral", "ignored d", "ignored tr",
                                                   "ignored unknown statement"));
}

TEST_F(ObjLoader, StatementsBeforeTheFirstMaterialAreTold) {
  write("m.mtl", "# a comment\nKd 1 0 0\nNs 3\nnewmtl x\nKd 0 1 0\n");
  const Scene scene = load(std::string("mtllib m.mtl\nusemtl x\n") + kTriangle);
  EXPECT_EQ(scene.materials.at(0).diffuse, glm::vec3(0, 1, 0));
  EXPECT_THAT(test::textsOf(scene.warnings),
              testing::ElementsAre(folder / "m.mtl: line 2: 'Kd' stands before the first newmtl; left out"));
}

TEST_F(ObjLoader, OptionsOfMapsAreReadByTheirArguments) {
  writePicture("a b.png", {1, 0, 0});
  const std::vector<std::string> options = {
      "-s 1 1",          "-s 2 2 1",       "-o 0.5",     "-o 0.5 0.25 0",   "-t 0 0 0",
      "-mm 0 1",         "-cc off",        "-clamp off", "-clamp on",       "-blendu on -blendv on",
      "-bm 2",           "-boost 1",       "-texres 64", "-imfchan m",      "-type sphere",
      "-s 1 1 1 -o 0 0", "-clamp on -s 2", "-S 2\t2",    "-colorspace sRGB"};
  for (const std::string& those : options) {
    const std::vector<std::string> statements{"map_Kd " + those + " a b.png",
                                              "map_Kd\t" + those + "\ta b.png \t", "map_kd a b.png " + those,
                                              "MAP_KD " + those + " a b.png # a comment"};
    for (const std::string& statement : statements) {
      write("m.mtl", "newmtl x\n" + statement + "\n");
      const Scene scene = load(std::string("mtllib m.mtl\nusemtl x\n") + kTriangle);
      EXPECT_EQ(scene.missing_textures, std::vector<std::string>()) << statement;
      EXPECT_EQ(scene.materials[0].diffuse_map.texture, 0) << statement;
      EXPECT_EQ(scene.materials[0].diffuse_map.wrap_u,
                those.find("-clamp on") == those.npos ? Wrap::kRepeat : Wrap::kClampToEdge)
          << statement;
    }
  }
}

TEST_F(ObjLoader, ScaleAndOffsetOfEachMapMoveItsTextureCoordinates) {
  writePicture("a.png", {1, 0, 0});
  write("m.mtl",
        "newmtl x\nmap_Kd -s 2 4 1 -o 0.5 a.png\nmap_Ke -o 0 0.25 a.png\nbump -s 3 a.png\nnewmtl y\nmap_Kd "
        "a.png\n");
  const Mesh mesh = load(
                        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl x\nf 1/1 "
                        "2/2 3/3\nusemtl y\n"
                        "f 1/1 2/2 3/3\n")
                        .meshes[0];
  ASSERT_EQ(mesh.positions.size(), 6u) << "vertices of two materials whose maps lie otherwise";
  const std::vector<glm::vec2> plain{{0, 1}, {1, 1}, {0, 0}};
  const auto with = [&](std::vector<glm::vec2> uvs) {
    uvs.insert(uvs.end(), plain.begin(), plain.end());
    return uvs;
  };
  EXPECT_EQ(mesh.uvs, with({{0.5f, 1}, {2.5f, 1}, {0.5f, -3}}));
  EXPECT_EQ(mesh.emission_uvs, with({{0, 0.75f}, {1, 0.75f}, {0, -0.25f}}));
  EXPECT_EQ(mesh.normal_uvs, with({{0, 1}, {3, 1}, {0, 0}}));
  EXPECT_EQ(mesh.lightmap_uvs, with(plain));
}

TEST_F(ObjLoader, OptionsBehindAnUnknownOneAreRead) {
  writePicture("a.png", {1, 0, 0});
  for (const char* options :
       {"-new 1 -s 2 2 1", "-new -s 2 2", "-s 2 2 -new on -cc off", "-new 1 2 3 -s 2 2 1 -bm 1"}) {
    write("m.mtl", std::string("newmtl x\nmap_Kd ") + options + " a.png\n");
    const Scene scene =
        load("mtllib m.mtl\nusemtl x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/2 3/1\n");
    EXPECT_EQ(scene.meshes[0].uvs[1], glm::vec2(2, -1)) << options;
    EXPECT_THAT(test::textsOf(scene.warnings),
                testing::ElementsAre(HasSubstr("map_Kd: the option -new is not known")));
  }
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
  EXPECT_EQ(material("bump -bm 1e9 a.png\n").normal_scale, 1.0f);
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
  EXPECT_THAT(test::textsOf(scene.warnings),
              testing::ElementsAre(folder / "a.obj: there is no material file 'nowhere.mtl'",
                                   folder / "a.obj: there is no material 'x'; its faces are grey"));
}

TEST_F(ObjLoader, MaterialsThatAreNotFoundAreAllTold) {
  write("m.mtl", "newmtl a\nKd 1 0 0\n");
  const Scene scene = load(std::string("mtllib m.mtl\nusemtl b\n") + kTriangle +
                           "usemtl\nf 1 2 3\nusemtl unused\nusemtl c\nf 1 2 3\nusemtl b\nf 1 2 3\n");
  const std::string begin = folder / "a.obj: there is no material '", end = "'; its faces are grey";
  EXPECT_THAT(test::textsOf(scene.warnings),
              testing::ElementsAre(begin + "b" + end, begin + end, begin + "c" + end));
  for (const Warning& warning : scene.warnings) EXPECT_EQ(warning.kind, scene.warnings[0].kind);
}

TEST_F(ObjLoader, NamesAreFoundThroughCommentsQuotesAndPathsOfOtherMachines) {
  write("m.mtl",
        "newmtl red\nKd 1 0 0\nnewmtl green # not red\nKd 0 1 0\nnewmtl blue #1\nKd 0 0 1\nnewmtl "
        "\"grey\"\nKd 0.5\n");
  write("my file.mtl", "newmtl white\nKd 1 1 1\n");
  std::filesystem::create_directory(folder / "other");
  write("other/far.mtl", "newmtl black\nKd 0 0 0\n");
  const auto diffuse = [&](const std::string& library, const std::string& name) {
    write("a.obj", "mtllib " + library + "\nusemtl " + name + "\n" + kTriangle);
    Scene scene;
    loadObj(folder / "a.obj", scene, {folder / "other"});
    EXPECT_EQ(test::textsOf(scene.warnings), std::vector<std::string>()) << library << " " << name;
    return scene.materials.at(0).diffuse;
  };
  EXPECT_EQ(diffuse("m.mtl", "red # a comment"), glm::vec3(1, 0, 0));
  EXPECT_EQ(diffuse("m.mtl", "\"red\""), glm::vec3(1, 0, 0));
  EXPECT_EQ(diffuse("m.mtl", "green"), glm::vec3(0, 1, 0));
  EXPECT_EQ(diffuse("m.mtl", "green # not red"), glm::vec3(0, 1, 0));
  EXPECT_EQ(diffuse("m.mtl", "blue #1"), glm::vec3(0, 0, 1));
  EXPECT_EQ(diffuse("\"m.mtl\"", "red"), glm::vec3(1, 0, 0));
  EXPECT_EQ(diffuse("m.mtl", "red #a comment"), glm::vec3(1, 0, 0));
  EXPECT_EQ(diffuse("m.mtl", "blue"), glm::vec3(0, 0, 1));
  EXPECT_EQ(diffuse("m.mtl", "grey"), glm::vec3(0.5f));
  EXPECT_EQ(diffuse("m.mtl #all materials", "red"), glm::vec3(1, 0, 0));
  EXPECT_EQ(diffuse("m.mtl # materials", "red"), glm::vec3(1, 0, 0));
  EXPECT_EQ(diffuse("\"my file.mtl\" \"m.mtl\"", "white"), glm::vec3(1));
  EXPECT_EQ(diffuse("my file.mtl m.mtl", "red"), glm::vec3(1, 0, 0));
  EXPECT_EQ(diffuse("my\\ file.mtl", "white"), glm::vec3(1));
  EXPECT_EQ(diffuse("C:\\Users\\some one\\m.mtl", "red"), glm::vec3(1, 0, 0));
  EXPECT_EQ(diffuse("/home/some one/my file.mtl", "white"), glm::vec3(1));
  EXPECT_EQ(diffuse("far.mtl", "black"), glm::vec3(0));
}

TEST_F(ObjLoader, OfMaterialsOfOneNameTheFirstCountsAndThatIsTold) {
  write("m.mtl", "newmtl x\nKd 1 0 0\nnewmtl x\nKd 0 1 0\n");
  const Scene scene = load(std::string("mtllib m.mtl\nusemtl x\n") + kTriangle);
  EXPECT_EQ(scene.materials.at(0).diffuse, glm::vec3(1, 0, 0));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_THAT(scene.warnings[0].text, HasSubstr("material 'x': is given again"));
  write("m.mtl", "newmtl x\nKd 1 0 0\n# the next one\n\nnewmtl x\nKd 1 0 0\n");
  EXPECT_EQ(load(std::string("mtllib m.mtl\nusemtl x\n") + kTriangle).warnings.size(), 0u)
      << "the same again";
}

TEST_F(ObjLoader, FilesMayBeginWithAMarkAndEndLinesAnyWay) {
  for (const std::string ends : {"\n", "\r\n", "\r"}) {
    write("m.mtl", "\xef\xbb\xbfnewmtl x" + ends + "Kd 1 0 0" + ends);
    const Scene scene = load("\xef\xbb\xbfmtllib m.mtl" + ends + "usemtl x" + ends + kTriangle);
    EXPECT_EQ(scene.materials.at(0).diffuse, glm::vec3(1, 0, 0));
  }
}

TEST_F(ObjLoader, NamesInLatin1BecomeUtf8) {
  writePicture("gr\xc3\xbcn.png", {1, 0, 0});
  write("m.mtl", "newmtl Gr\xfcn\nKd 0 1 0\nmap_Kd gr\xfcn.png\nmap_Ke fehlt_gr\xfcn.png\n");
  const Scene scene = load(std::string("mtllib m.mtl\no W\xe4nde\nusemtl Gr\xfcn\n") + kTriangle);
  EXPECT_EQ(scene.materials.at(0).name, "Gr\xc3\xbcn");
  EXPECT_EQ(scene.materials.at(0).diffuse_map.texture, 0);
  EXPECT_EQ(scene.objects.at(0).name, "W\xc3\xa4nde");
  EXPECT_THAT(scene.missing_textures.at(0), HasSubstr("fehlt_gr\xc3\xbcn.png"));
  const Scene mixed = load(std::string("mtllib m.mtl\nusemtl Gr\xc3\xbcn\n") + kTriangle);
  EXPECT_EQ(mixed.materials.at(0).name, "Gr\xc3\xbcn") << "UTF-8 here, Latin-1 there";
}

/// The names of a scene's objects, each with its triangles.
std::vector<std::pair<std::string, std::size_t>> partsOf(const Scene& scene) {
  std::vector<std::pair<std::string, std::size_t>> parts;
  for (const Object& object : scene.objects)
    parts.emplace_back(object.name, scene.meshes[object.mesh].triangles.size());
  return parts;
}

TEST_F(ObjLoader, NamedObjectsAreObjectsOfTheirOwn) {
  using Parts = std::vector<std::pair<std::string, std::size_t>>;
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", f = "f 1 2 3\n";
  EXPECT_EQ(partsOf(load(v + f)), (Parts{{"", 1}}));
  EXPECT_EQ(partsOf(load(v + "o a\n" + f)), (Parts{{"a", 1}}));
  EXPECT_EQ(partsOf(load(v + "g a\n" + f)), (Parts{{"a", 1}}));
  EXPECT_EQ(partsOf(load(v + "o\n" + f)), (Parts{{"", 1}}));
  EXPECT_EQ(partsOf(load(v + "o a\n" + f + "o empty\no b\n" + f + "o a\n" + f)), (Parts{{"a", 2}, {"b", 1}}));
  EXPECT_EQ(partsOf(load(v + "g a\n" + f + "g b  c\n" + f + "f -1 -2 -3\n")), (Parts{{"a", 1}, {"b c", 2}}));
  EXPECT_EQ(partsOf(load(v + f + "g b # the second\n" + f)), (Parts{{"", 1}, {"b", 1}}));
  EXPECT_EQ(partsOf(load(v + "o a\ng x\n" + f + "g y\n" + f + "o b\n" + f)), (Parts{{"a", 2}, {"b", 1}}));
  EXPECT_EQ(partsOf(load(v + "o a\ng x\n" + f + "g y\n" + f)), (Parts{{"x", 1}, {"y", 1}}))
      << "one object only";
  EXPECT_EQ(partsOf(load(v + "o a\ng x\n" + f)), (Parts{{"a", 1}}));
  EXPECT_EQ(partsOf(load(v + "o a\n" + f + "g y\n" + f)), (Parts{{"a", 1}, {"y", 1}}));
}

TEST_F(ObjLoader, NormalsAreSmoothFromObjectToObject) {
  const std::string roof = "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 0 0 1\n";
  const Scene scene = load(roof + "o a\nf 1 3 2\no b\nf 1 2 4\n");
  ASSERT_EQ(scene.meshes.size(), 2u);
  const Mesh one = load(roof + "f 1 3 2\nf 1 2 4\n").meshes[0];
  EXPECT_EQ(scene.meshes[0].normals[0], one.normals[0]);
  EXPECT_EQ(scene.meshes[1].normals[0], one.normals[0]);
  EXPECT_EQ(scene.meshes[1].triangles[0], glm::uvec3(0, 1, 2)) << "vertices are counted anew";
}

TEST_F(ObjLoader, NormalsAndTextureCoordinatesWithoutNumbersAreDrawnWithout) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const char* text : {"vn nan nan nan\nf 1//1 2//1 3//1\n", "vn 0 0\nf 1//1 2//1 3//1\n",
                           "vn 1.#QNAN 0 1\nf 1//1 2//1 3//1\n", "vt 0 0\nf 1/1/7 2/1/7 3/1/7\n",
                           "f 1//-1 2//-1 3//-1\n", "f 1/9 2/9 3/9\n", "vn 0 0 1\nf 1/0/1 2/0/1 3/0/1\n",
                           "vt -nan(ind) inf\nf 1/1 2/1 3/1\n", "f 1 2\nf 1 2 3\n"}) {
    const Scene scene = load(v + text);
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(mesh.normals, std::vector<glm::vec3>(3, glm::vec3(0, 0, 1))) << text;
    for (const glm::vec2& uv : mesh.uvs) EXPECT_EQ(uv, glm::vec2(0, 1)) << text;
    ASSERT_EQ(scene.warnings.size(), 1u) << text;
    EXPECT_THAT(scene.warnings[0].text, HasSubstr(folder / "a.obj: line ")) << text;
    EXPECT_TRUE(scene.warnings[0].repaired) << text;
  }
  EXPECT_THAT(
      load(v + "vt 0 0\nf 1/1/7 2/1/7 3/1/7\n").warnings[0].text,
      HasSubstr("line 5: a face refers to normal 7, but the file has only 0; drawn without, as 2 more are"));
}

TEST_F(ObjLoader, NumbersTooSmallForAFloatAre0) {
  for (const char* number : {"1e-400", "-1e-400", "1e-99999999999999999999", "0.1e-46", "1E-310"}) {
    const Mesh mesh = load(std::string("v ") + number + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").meshes[0];
    EXPECT_LT(std::abs(mesh.positions[0].x), 1e-44f) << number;
  }
  const std::string long_one = "v 0." + std::string(400, '0') + "1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(load(long_one).meshes[0].positions[0], glm::vec3(0));
  for (const char* number : {"1e400", "1e99999999999999999999", "-1e39"})
    EXPECT_THAT(error(std::string("v ") + number + " 0 0\n"), HasSubstr("is not a finite number"));
  EXPECT_THAT(error("v 1" + std::string(400, '0') + " 0 0\n"), HasSubstr("is not a finite number"));
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
  ASSERT_EQ(scene.meshes.size(), 2u) << "before the first group, and x";
  const Mesh &first = scene.meshes[0], &second = scene.meshes[1];
  EXPECT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[first.triangle_materials[0]].name, "b");
  EXPECT_EQ(scene.materials[second.triangle_materials[0]].name, "a");
  EXPECT_EQ(second.triangle_materials[1], first.triangle_materials[0]);
}

TEST_F(ObjLoader, LinesMayBeContinuedCommentedAndEndAnyWay) {
  const Mesh expected = load(kTriangle).meshes[0];
  for (const char* text : {"v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r",
                           "\xef\xbb\xbfv 0 0 0 # origin\n  v\t1 0 0\nv 0 1 0\nf 1 2 \\\n 3\n",
                           "v 0 0 0\nv 1 0 0\nv +0 1e0 .0\nf 1// 2// 3//  \n",
                           "v 0 0 0 # of C:\\\nv 1 0 0\nv 0 1 0\n# to C:\\\nf 1 2 3#\\\n",
                           "v\v0\f0 0\nv\t1 0 0\n\fv 0 1 0\nfo 1 2 3\x1a"}) {
    EXPECT_EQ(load(text).meshes[0].positions, expected.positions) << text;
  }
}

TEST_F(ObjLoader, WhatMakesNoFaceIsLeftOutAndTold) {
  const Scene scene =
      load(std::string("p 0\nl 7 8\nvp 1\ncstype bezier\ncurv2 x\nusemap wood\n") + kTriangle);
  EXPECT_EQ(scene.meshes[0].triangles.size(), 1u);
  EXPECT_THAT(
      test::textsOf(scene.warnings),
      testing::ElementsAre(folder / "a.obj: line 1: 'p' makes no face; left out, as 2 more are",
                           folder / "a.obj: line 6: 'usemap' is no statement that is known here; left out"));
  for (const Warning& warning : scene.warnings) EXPECT_FALSE(warning.repaired);
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
  EXPECT_THAT(error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"), HasSubstr("line 4: index 0 of a vertex"));
  EXPECT_THAT(error("v 0 0 0\nf 1//99999999999999999999 1 1\n"), HasSubstr("is not an index"));
  EXPECT_THAT(error("v 0 0 0\nf one two three\n"), HasSubstr("line 2: 'one' is not an index"));
  EXPECT_THAT(error("v 0 0 0\n"), HasSubstr("has no faces"));
  EXPECT_THAT(error(""), HasSubstr("has no faces"));
  EXPECT_THAT(error(std::string("\xff\xfev\0 \0", 6)), HasSubstr("UTF-16"));
}

TEST_F(ObjLoader, AFileOfPointsAndLinesIsRefusedAsSuch) {
  EXPECT_THAT(error("v 0 0 0\nv 1 0 0\np 1\nl 1 2\n"),
              HasSubstr("has points, lines or curves, but no faces"));
}

TEST_F(ObjLoader, RealScenesHaveTheirTriangles) {
  LUCIOLE_NEEDS_SHARED();
  const auto triangles = [](const char* file) {
    Scene scene;
    loadObj((test::sharedScenes() / file).string(), scene);
    std::size_t count = 0;
    for (const Mesh& mesh : scene.meshes) count += mesh.triangles.size();
    return count;
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
  std::size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) triangles += mesh.triangles.size();
  EXPECT_EQ(triangles, 262267u);
  EXPECT_EQ(scene.objects.size(), 381u);
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
