// Meshes of glTF files: indices, attributes and what is missing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "scene/gltf/gltf_loader.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

TEST_F(GltfLoader, ATriangleWithoutIndicesOrNormalsIsFlat) {
  const Scene scene = load(triangleFile());
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.normals, std::vector<glm::vec3>(3, glm::vec3(0, 0, 1)));
  EXPECT_EQ(scene.materials.size(), 1u);
  EXPECT_FALSE(scene.materials[0].double_sided);
}

TEST_F(GltfLoader, MissingNormalsAreFlatEvenWhereVerticesAreShared) {
  GltfFile file = triangleFile();
  file.primitive()["attributes"]["POSITION"] =
      file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  file.primitive()["indices"] =
      file.addAccessor<std::uint8_t>("SCALAR", kUnsignedByte, 1, {0, 1, 2, 0, 2, 3});
  const Mesh mesh = load(file).meshes.at(0);
  EXPECT_EQ(mesh.normals[mesh.triangles[0].x], glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.normals[mesh.triangles[1].x], glm::vec3(1, 0, 0));
}

TEST_F(GltfLoader, IndicesOfEverySizeAreRead) {
  for (const int type : {kUnsignedByte, kUnsignedShort, kUnsignedInt}) {
    GltfFile file = vertexFile();
    int indices = 0;
    if (type == kUnsignedByte) indices = file.addAccessor<std::uint8_t>("SCALAR", type, 1, {4, 1, 2});
    if (type == kUnsignedShort) indices = file.addAccessor<std::uint16_t>("SCALAR", type, 1, {4, 1, 2});
    if (type == kUnsignedInt) indices = file.addAccessor<std::uint32_t>("SCALAR", type, 1, {4, 1, 2});
    file.primitive()["indices"] = indices;
    const Mesh mesh = load(file).meshes.at(0);
    ASSERT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.positions[mesh.triangles[0].x], glm::vec3(0, 2, 0));
  }
}

/// The corners of each triangle, by what the positions of vertexFile() are.
std::vector<std::array<glm::vec3, 3>> corners(const Mesh& mesh) {
  std::vector<std::array<glm::vec3, 3>> result;
  for (const glm::uvec3& t : mesh.triangles) {
    result.push_back({mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]});
  }
  return result;
}

TEST_F(GltfLoader, StripsAlternateTheirWindingAndFansTurnAroundTheFirst) {
  const glm::vec3 v[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}};
  GltfFile file = vertexFile();
  file.primitive()["mode"] = 5;
  using Corners = std::vector<std::array<glm::vec3, 3>>;
  EXPECT_EQ(corners(load(file).meshes.at(0)),
            (Corners{{v[0], v[1], v[2]}, {v[1], v[3], v[2]}, {v[2], v[3], v[4]}}));
  file.primitive()["mode"] = 6;
  EXPECT_EQ(corners(load(file).meshes.at(0)),
            (Corners{{v[1], v[2], v[0]}, {v[2], v[3], v[0]}, {v[3], v[4], v[0]}}));
}

TEST_F(GltfLoader, PointsAndLinesAreLeftOut) {
  GltfFile file = triangleFile();
  json line = file.primitive();
  line["mode"] = 1;
  file.root["meshes"][0]["primitives"].push_back(line);
  const Scene scene = load(file);
  EXPECT_EQ(scene.meshes.at(0).triangles.size(), 1u);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_THAT(scene.warnings[0].text, HasSubstr("meshes[0].primitives[1]: mode 1 is of lines"));
  EXPECT_TRUE(scene.warnings[0].repaired) << "--strict refuses it";
  file.primitive()["mode"] = 0;
  EXPECT_THAT(error(file), HasSubstr("shows nothing"));
}

TEST_F(GltfLoader, SparseAccessorsReplaceElements) {
  for (const bool has_base : {true, false}) {
    GltfFile file = triangleFile();
    const int indices = file.addView<std::uint16_t>({2, 0});
    const int values = file.addView<float>({7, 8, 9, 4, 5, 6});
    json& accessor = file.accessor(0);
    if (!has_base) accessor.erase("bufferView");
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", indices}, {"componentType", kUnsignedShort}}},
                          {"values", {{"bufferView", values}}}};
    const glm::vec3 kept = has_base ? glm::vec3(1, 0, 0) : glm::vec3(0);
    EXPECT_EQ(load(file).meshes.at(0).positions, (std::vector<glm::vec3>{{4, 5, 6}, kept, {7, 8, 9}}));
  }
}

TEST_F(GltfLoader, QuantizedAttributesAreRead) {
  GltfFile file = triangleFile();
  file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int position =
      file.addAccessor<std::int8_t>("VEC3", kByte, 4, {0, 0, 0, 99, 127, 0, 0, 99, 0, -128, 64, 99});
  file.root["bufferViews"].back()["byteStride"] = 4;
  file.primitive()["attributes"]["POSITION"] = position;
  EXPECT_EQ(load(file).meshes.at(0).positions,
            (std::vector<glm::vec3>{{0, 0, 0}, {127, 0, 0}, {0, -128, 64}}));
  file.accessor(position)["normalized"] = true;
  EXPECT_EQ(load(file).meshes.at(0).positions,
            (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, -1, 64.0f / 127}}));
}

TEST_F(GltfLoader, VertexColoursOfEveryFormatAreRead) {
  GltfFile file = triangleFile();
  json& attributes = file.primitive()["attributes"];
  const int floats = file.addAccessor<float>("VEC3", kFloat, 3, {1, 0, 0, 0, 0.5, 0, 0, 0, 2});
  const int bytes =
      file.addAccessor<std::uint8_t>("VEC4", kUnsignedByte, 4, {255, 0, 0, 51, 0, 0, 0, 0, 0, 0, 0, 255});
  const int shorts = file.addAccessor<std::uint16_t>("VEC4", kUnsignedShort, 4,
                                                     {65535, 0, 0, 13107, 0, 0, 0, 0, 0, 0, 0, 0});
  file.accessor(bytes)["normalized"] = file.accessor(shorts)["normalized"] = true;
  attributes["COLOR_0"] = floats;
  EXPECT_EQ(load(file).meshes.at(0).colors,
            (std::vector<glm::vec4>{{1, 0, 0, 1}, {0, 0.5f, 0, 1}, {0, 0, 2, 1}}));
  attributes["COLOR_0"] = bytes;
  EXPECT_EQ(load(file).meshes.at(0).colors[0], glm::vec4(1, 0, 0, 0.2f));
  attributes["COLOR_0"] = shorts;
  EXPECT_EQ(load(file).meshes.at(0).colors[0], glm::vec4(1, 0, 0, 0.2f));
}

TEST_F(GltfLoader, PrimitivesWithAndWithoutColoursBecomeOneMesh) {
  GltfFile file = triangleFile();
  json colored = file.primitive();
  colored["attributes"]["COLOR_0"] = file.addAccessor<float>("VEC3", kFloat, 3, {1, 0, 0, 1, 0, 0, 1, 0, 0});
  colored["material"] = 0;
  file.root["materials"] = {{{"name", "m"}}};
  file.root["meshes"][0]["primitives"].push_back(colored);
  const Scene scene = load(file);
  const Mesh& mesh = scene.meshes.at(0);
  ASSERT_EQ(mesh.colors.size(), 6u);
  EXPECT_EQ(mesh.colors[mesh.triangles[0].x], glm::vec4(1));
  EXPECT_EQ(mesh.colors[mesh.triangles[1].x], glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(scene.materials[mesh.triangle_materials[1]].name, "m");
}

TEST_F(GltfLoader, ZeroNormalsComeFromTheFaces) {
  GltfFile file = triangleFile();
  file.primitive()["attributes"]["NORMAL"] =
      file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0, NAN, 0, 0, 0, 0, -8});
  EXPECT_EQ(load(file).meshes.at(0).normals, (std::vector<glm::vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0, -1}}));
}

TEST_F(GltfLoader, IndicesAndPositionsOutOfRangeAreRefused) {
  GltfFile file = vertexFile();
  file.primitive()["indices"] = file.addAccessor<std::uint8_t>("SCALAR", kUnsignedByte, 1, {0, 1, 5});
  EXPECT_THAT(error(file), HasSubstr("index 5, but it has only 5 vertices"));
  file = triangleFile();
  file.primitive()["attributes"]["POSITION"] =
      file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0, 1, 0, INFINITY, 0, 1, 0});
  EXPECT_THAT(error(file), HasSubstr("POSITION: element 1 is not finite"));
}

}  // namespace
}  // namespace luciole::test
