#include "scene/gltf/gltf.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "image/image.hpp"
#include "load/load_scene.hpp"
#include "scene/gltf/gltf_file.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

using namespace test;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// Five vertices on a square's rim and centre, for strips, fans and indices.
GltfFile vertexFile() {
  GltfFile file = triangleFile();
  const int position =
      file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
  file.primitive()["attributes"]["POSITION"] = position;
  return file;
}

class GltfLoader : public test::GltfTest {
 protected:
  void writePicture(const std::string& name, const std::vector<float>& texel) {
    const std::vector<std::string> channels{"R", "G", "B", "A"};
    writeImage({1, 1, {channels.begin(), channels.begin() + texel.size()}, texel}, folder / name, {});
  }
  Material material(const json& source) {
    GltfFile file = triangleFile();
    file.root["materials"] = {source};
    file.primitive()["material"] = 0;
    return load(file).materials.at(0);
  }
  Light light(const json& source) {
    GltfFile file = triangleFile();
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {source};
    file.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    file.root["nodes"][0]["translation"] = {1, 2, 3};
    return load(file).lights.at(0);
  }
  Camera camera(const json& source, const json& node = json::object()) {
    GltfFile file = triangleFile();
    file.root["cameras"] = {source};
    file.root["nodes"][0] = node;
    file.root["nodes"][0]["camera"] = 0;
    return load(file).cameras.at(0);
  }
};

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
  EXPECT_EQ(load(file).meshes.at(0).triangles.size(), 1u);
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

TEST_F(GltfLoader, TheTexturePicksItsCoordinatesAndWrapping) {
  writePicture("a.png", {1, 0, 0});
  GltfFile file = triangleFile();
  json& attributes = file.primitive()["attributes"];
  attributes["TEXCOORD_0"] = file.addAccessor<float>("VEC2", kFloat, 2, {9, 9, 9, 9, 9, 9});
  attributes["TEXCOORD_1"] = file.addAccessor<float>("VEC2", kFloat, 2, {0, 0.25, 1, 0.5, 0, 1});
  file.primitive()["material"] = 0;
  file.root["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}}}};
  file.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
  file.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
  file.root["images"] = {{{"uri", "a.png"}}};
  const Scene scene = load(file);
  EXPECT_EQ(scene.meshes.at(0).uvs, (std::vector<glm::vec2>{{0, 0.25f}, {1, 0.5f}, {0, 1}}));
  const TextureUse& use = scene.materials.at(0).diffuse_map;
  EXPECT_EQ(use.texture, 0);
  EXPECT_EQ(use.wrap_u, Wrap::kClampToEdge);
  EXPECT_EQ(use.wrap_v, Wrap::kMirroredRepeat);
  EXPECT_TRUE(scene.meshes[0].emission_uvs.empty());
}

/// A triangle whose base colour and emission are looked up in a picture.
class GltfTextures : public GltfLoader {
 protected:
  GltfTextures() {
    writePicture("a.png", {1, 0, 0});
    json& attributes = file.primitive()["attributes"];
    attributes["TEXCOORD_0"] = file.addAccessor<float>("VEC2", kFloat, 2, {0, 0, 1, 0, 1, 1});
    attributes["TEXCOORD_1"] = file.addAccessor<float>("VEC2", kFloat, 2, {0, 0.25, 1, 0.5, 0, 1});
    file.primitive()["material"] = 0;
    file.root["extensionsUsed"] = {"KHR_texture_transform"};
    file.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                               {"emissiveTexture", {{"index", 0}}},
                               {"emissiveFactor", {1, 1, 1}}}};
    file.root["textures"] = {{{"source", 0}}};
    file.root["images"] = {{{"uri", "a.png"}}};
  }
  json& base() { return file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]; }
  json& glow() { return file.root["materials"][0]["emissiveTexture"]; }
  static json transform(const json& members) { return {{"KHR_texture_transform", members}}; }

  GltfFile file = triangleFile();
};

/// An affine map of coordinates to 4 at most is exact to 2^-50 in double, so it loses its one rounding to
/// float, 2^-23, and what is expected three of that.
void expectUvs(const std::vector<glm::vec2>& uvs, const std::vector<glm::vec2>& expected) {
  ASSERT_EQ(uvs.size(), expected.size());
  for (std::size_t i = 0; i < uvs.size(); ++i)
    for (int c = 0; c < 2; ++c) EXPECT_NEAR(uvs[i][c], expected[i][c], 4 * 0x1p-23) << i;
}

TEST_F(GltfTextures, ATransformOfBothMovesTheCoordinatesOnce) {
  // The specification's own example: the picture's lower left quadrant.
  base()["extensions"] = glow()["extensions"] =
      transform({{"offset", {0, 1}}, {"rotation", kPi / 2}, {"scale", {0.5, 0.5}}});
  const Scene scene = load(file);
  EXPECT_TRUE(scene.warnings.empty());
  expectUvs(scene.meshes.at(0).uvs, {{0, 1}, {0, 0.5f}, {0.5f, 0.5f}});
  EXPECT_TRUE(scene.meshes[0].emission_uvs.empty());
}

TEST_F(GltfTextures, ScaleComesBeforeRotationAndRotationBeforeOffset) {
  base()["extensions"] = transform({{"offset", {0.25, 0.5}}, {"rotation", kPi / 6}, {"scale", {2, -1}}});
  glow() = json{{"index", 0}};
  // (1, 1) becomes (2, -1), turned by 30 degrees towards smaller v.
  const float c = float(std::sqrt(0.75)), s = 0.5f;
  expectUvs(load(file).meshes.at(0).uvs,
            {{0.25f, 0.5f}, {2 * c + 0.25f, -2 * s + 0.5f}, {2 * c - s + 0.25f, -2 * s - c + 0.5f}});
}

TEST_F(GltfTextures, EachTextureHasCoordinatesOfItsOwn) {
  glow()["texCoord"] = 1;
  Mesh mesh = load(file).meshes.at(0);
  expectUvs(mesh.uvs, {{0, 0}, {1, 0}, {1, 1}});
  expectUvs(mesh.emission_uvs, {{0, 0.25f}, {1, 0.5f}, {0, 1}});
  // The transform's own texCoord wins.
  glow()["extensions"] = transform({{"texCoord", 0}, {"scale", {3, 1}}});
  base()["extensions"] = transform({{"texCoord", 1}});
  mesh = load(file).meshes.at(0);
  expectUvs(mesh.uvs, {{0, 0.25f}, {1, 0.5f}, {0, 1}});
  expectUvs(mesh.emission_uvs, {{0, 0}, {3, 0}, {3, 1}});
}

TEST_F(GltfTextures, PrimitivesWithAndWithoutGlowOfItsOwnBecomeOneMesh) {
  glow()["texCoord"] = 1;
  json plain = file.primitive();
  plain["material"] = 1;
  file.root["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  file.root["meshes"][0]["primitives"].push_back(plain);
  for (const int first : {0, 1}) {
    if (first == 1)
      std::swap(file.root["meshes"][0]["primitives"][0], file.root["meshes"][0]["primitives"][1]);
    const Mesh mesh = load(file).meshes.at(0);
    ASSERT_EQ(mesh.emission_uvs.size(), 6u);
    for (const int triangle : {0, 1}) {
      const glm::uvec3 corners = mesh.triangles[std::size_t(triangle)];
      EXPECT_EQ(mesh.uvs[corners.z], glm::vec2(1, 1));
      EXPECT_EQ(mesh.emission_uvs[corners.z], triangle == first ? glm::vec2(0, 1) : glm::vec2(1, 1));
    }
  }
}

TEST_F(GltfTextures, LightMapsAreLaidOutByTheSecondCoordinatesOrTheFirst) {
  expectUvs(load(file).meshes.at(0).lightmap_uvs, {{0, 0.25f}, {1, 0.5f}, {0, 1}});
  file.root.erase("materials");
  file.primitive().erase("material");
  file.primitive()["attributes"].erase("TEXCOORD_1");
  const Scene scene = load(file);
  EXPECT_TRUE(scene.meshes.at(0).uvs.empty()) << "no texture needs them";
  expectUvs(scene.meshes[0].lightmap_uvs, {{0, 0}, {1, 0}, {1, 1}});
}

TEST_F(GltfTextures, NormalMapsHaveTangentsAndCoordinatesOfTheirOwn) {
  json& attributes = file.primitive()["attributes"];
  attributes["NORMAL"] = file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
  attributes["TANGENT"] = file.addAccessor<float>("VEC4", kFloat, 4, {1, 0, 0, -1, 0, 1, 0, 1, 1, 0, 0, 1});
  EXPECT_TRUE(load(file).meshes.at(0).tangents.empty()) << "nothing bends by them";
  file.root["materials"][0]["normalTexture"] = {{"index", 0}, {"texCoord", 1}, {"scale", 0.25}};
  Scene scene = load(file);
  EXPECT_EQ(scene.meshes.at(0).tangents, (std::vector<glm::vec4>{{1, 0, 0, -1}, {0, 1, 0, 1}, {1, 0, 0, 1}}));
  expectUvs(scene.meshes[0].uvs, {{0, 0}, {1, 0}, {1, 1}});
  expectUvs(scene.meshes[0].normal_uvs, {{0, 0.25f}, {1, 0.5f}, {0, 1}});
  const Material& material = scene.materials.at(0);
  EXPECT_EQ(material.normal_scale, 0.25f);
  EXPECT_EQ(scene.textures.at(std::size_t(material.normal_map.texture)).kind, TextureKind::kNormals);
  EXPECT_NE(material.normal_map.texture, material.diffuse_map.texture) << "its numbers are no colours";
  file.root["materials"][0].erase("pbrMetallicRoughness");
  file.root["materials"][0].erase("emissiveTexture");
  scene = load(file);
  expectUvs(scene.meshes.at(0).uvs, {{0, 0.25f}, {1, 0.5f}, {0, 1}});
  EXPECT_TRUE(scene.meshes[0].normal_uvs.empty());
  file.root["materials"][0]["normalTexture"]["scale"] = 1e9;
  EXPECT_THAT(error(file), HasSubstr("materials[0]: normalTexture.scale"));
}

TEST_F(GltfTextures, WebPPicturesComeBeforeTheirFallback) {
  writePicture("b.webp", {0, 0, 1});
  file.root["images"].push_back({{"uri", "b.webp"}, {"mimeType", "image/webp"}});
  file.root["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
  Scene scene = load(file);
  // WebP is lossy: the blue of the top left texel is all there is, and bright.
  const Texels& texels =
      scene.textures.at(std::size_t(scene.materials.at(0).diffuse_map.texture)).levels[0].texels;
  EXPECT_GT(texels[2], 60000);
  EXPECT_LT(texels[0], 6000);
  file.root["textures"][0].erase("source");
  scene = load(file);
  EXPECT_EQ(scene.textures.size(), 1u);
}

TEST_F(GltfTextures, BasisPicturesFallBackOrAreRefused) {
  file.root["textures"][0]["extensions"]["KHR_texture_basisu"]["source"] = 1;
  file.root["images"].push_back({{"uri", "a.ktx2"}});
  EXPECT_EQ(load(file).materials.at(0).diffuse_map.texture, 0);
  file.root["textures"][0].erase("source");
  EXPECT_THAT(error(file), HasSubstr("textures[0]: has a KHR_texture_basisu picture only"));
}

TEST_F(GltfLoader, SpecularAndIorChangeWhatDielectricsReflect) {
  GltfFile file = triangleFile();
  file.primitive()["material"] = 0;
  file.root["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}}};
  const auto specular = [&] { return load(file).materials.at(0).specular; };
  const glm::vec3 plain = specular();  // 0.04, times a peak of 1/4 at a roughness of 1
  EXPECT_FLOAT_EQ(plain.x, 0.01f);
  json& extensions = file.root["materials"][0]["extensions"];
  extensions["KHR_materials_specular"] = {{"specularFactor", 0.5}, {"specularColorFactor", {1, 0.5, 40}}};
  EXPECT_FLOAT_EQ(specular().x, 0.005f);
  EXPECT_FLOAT_EQ(specular().y, 0.0025f);
  EXPECT_FLOAT_EQ(specular().z, 0.125f) << "no more than all is reflected, times the factor";
  extensions = {{"KHR_materials_ior", {{"ior", 2}}}};
  EXPECT_FLOAT_EQ(specular().x, 1.0f / 9 / 4);
  extensions["KHR_materials_ior"]["ior"] = 0;
  EXPECT_FLOAT_EQ(specular().x, 0.25f) << "a mirror, for the older model";
  for (const auto& [extension, members] : std::vector<std::pair<const char*, json>>{
           {"KHR_materials_ior", {{"ior", 0.5}}},
           {"KHR_materials_specular", {{"specularFactor", 2}}},
           {"KHR_materials_specular", {{"specularColorFactor", {-1, 0, 0}}}}}) {
    extensions = {{extension, members}};
    EXPECT_THAT(error(file), HasSubstr("materials[0]: ")) << members;
  }
  extensions = {{"KHR_materials_specular", 3}};
  EXPECT_EQ(specular(), plain);
}

TEST_F(GltfTextures, TexturesOfSpecularCountByTheirMeans) {
  writePicture("half.png", {1, 0, 1, 0.5f});
  file.root["images"].push_back({{"uri", "half.png"}});
  file.root["textures"].push_back({{"source", 1}});
  json& material = file.root["materials"][0];
  material["pbrMetallicRoughness"]["metallicFactor"] = 0;
  material["extensions"]["KHR_materials_specular"] = {{"specularTexture", {{"index", 1}}},
                                                      {"specularColorTexture", {{"index", 1}}}};
  const glm::vec3 specular = load(file).materials.at(0).specular;
  EXPECT_NEAR(specular.x, 0.005f, 0.01f / 255) << "the alpha's code is one of 8 bits";
  EXPECT_EQ(specular.y, 0.0f);
  material["extensions"]["KHR_materials_specular"]["specularTexture"]["index"] = 7;
  EXPECT_THAT(error(file), HasSubstr("materials[0]: refers to texture 7"));
}

TEST_F(GltfLoader, VariantsChooseMaterials) {
  GltfFile file = triangleFile();
  file.primitive()["material"] = 0;
  file.primitive()["extensions"]["KHR_materials_variants"]["mappings"] = {
      {{"material", 1}, {"variants", {1, 2}}}};
  file.root["materials"] = {{{"name", "plain"}}, {{"name", "fancy"}}};
  file.root["extensions"]["KHR_materials_variants"]["variants"] = {
      {{"name", "day"}}, {{"name", "dusk"}}, {{"name", "night"}}};
  const auto materialOf = [&](const char* variant) {
    load(file);
    Scene scene;
    loadGltf(folder / "a.gltf", scene, variant);
    EXPECT_EQ(scene.variants, (std::vector<std::string>{"day", "dusk", "night"}));
    return scene.materials.at(scene.meshes.at(0).triangle_materials.at(0)).name;
  };
  EXPECT_EQ(materialOf(""), "plain");
  EXPECT_EQ(materialOf("day"), "plain");
  EXPECT_EQ(materialOf("dusk"), "fancy");
  EXPECT_EQ(materialOf("night"), "fancy");
  const auto refusal = [&](const char* variant) -> std::string {
    try {
      materialOf(variant);
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_THAT(refusal("dawn"), HasSubstr("has no variant 'dawn'; it has day, dusk, night"));
  file.primitive()["extensions"]["KHR_materials_variants"]["mappings"][0]["material"] = -3;
  EXPECT_THAT(refusal("dusk"), HasSubstr("material"));
  for (const json& odd : {json(3), json::array({3}), json::array({{{"name", 3}}})}) {
    file.root["extensions"]["KHR_materials_variants"]["variants"] = odd;
    EXPECT_THAT(error(file), HasSubstr("KHR_materials_variants.variants"));
  }
}

TEST_F(GltfLoader, InstancesArePlacedInTheirNodesSpace) {
  GltfFile file = triangleFile();
  const int translations = file.addAccessor<float>("VEC3", kFloat, 3, {1, 0, 0, 0, 2, 0});
  const int rotations = file.addAccessor<std::int16_t>("VEC4", 5122, 4, {0, 0, 0, 32767, 0, 32767, 0, 0});
  file.accessor(rotations)["normalized"] = true;
  const int scales = file.addAccessor<float>("VEC3", kFloat, 3, {1, 1, 1, 3, 3, 3});
  json& node = file.root["nodes"][0];
  node["translation"] = {0, 0, 10};
  json& attributes = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  attributes = {{"TRANSLATION", translations}, {"ROTATION", rotations}, {"SCALE", scales}, {"_ID", scales}};
  const Scene scene = load(file);
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.meshes.size(), 1u) << "they share their mesh";
  const auto at = [&](std::size_t object, const glm::dvec4& p) {
    return glm::dvec3(scene.objects[object].object_to_world * p);
  };
  EXPECT_LE(glm::distance(at(0, {1, 0, 0, 1}), glm::dvec3(2, 0, 10)), 1e-12);
  EXPECT_LE(glm::distance(at(1, {1, 0, 0, 1}), glm::dvec3(-3, 2, 10)), 1e-12);
  attributes["SCALE"] = file.addAccessor<float>("VEC3", kFloat, 3, {1, 1, 1});
  EXPECT_THAT(error(file), HasSubstr("its attributes have 2 and 1 elements"));
  attributes = json::object();
  EXPECT_THAT(error(file), HasSubstr("has none of TRANSLATION, ROTATION, SCALE"));
  attributes = {{"ROTATION", file.addAccessor<float>("VEC4", kFloat, 4, {0, 0, 0, 0})}};
  EXPECT_THAT(error(file), HasSubstr("instance 0 has no finite transform"));
  attributes = {{"TRANSLATION", "x"}};
  EXPECT_THAT(error(file), HasSubstr("TRANSLATION"));
}

TEST_F(GltfLoader, HiddenNodesHideWhatIsBelowThem) {
  GltfFile file = triangleFile();
  file.root["nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"mesh", 0}}};
  file.root["scenes"][0]["nodes"] = {0, 1};
  EXPECT_EQ(load(file).objects.size(), 2u);
  file.root["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = false;
  EXPECT_EQ(load(file).objects.size(), 1u);
  file.root["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = true;
  EXPECT_EQ(load(file).objects.size(), 2u);
}

TEST_F(GltfTextures, ImpossibleTransformsAreRefused) {
  for (const auto& [members, what] : std::vector<std::pair<json, std::string>>{
           {{{"offset", {1}}}, "baseColorTexture.KHR_texture_transform: offset must be 2 numbers"},
           {{{"scale", "x"}}, "baseColorTexture.KHR_texture_transform: scale must be 2 numbers"},
           {{{"texCoord", -1}}, "baseColorTexture: texCoord"},
           {{{"scale", {1e300, 1}}}, "TEXCOORD: element 1 is not finite"}}) {
    base()["extensions"] = transform(members);
    EXPECT_THAT(error(file), HasSubstr(what));
  }
}

TEST_F(GltfTextures, UnlitGlowsWhereItsColourIsLookedUp) {
  file.root["materials"][0]["extensions"]["KHR_materials_unlit"] = json::object();
  base()["extensions"] = transform({{"scale", {2, 2}}});
  glow()["texCoord"] = 1;
  const Scene scene = load(file);
  expectUvs(scene.meshes.at(0).uvs, {{0, 0}, {2, 0}, {2, 2}});
  EXPECT_TRUE(scene.meshes[0].emission_uvs.empty());
  EXPECT_TRUE(scene.materials.at(0).colored_emission);
  EXPECT_EQ(scene.materials[0].emission_map.texture, scene.materials[0].diffuse_map.texture);
}

TEST_F(GltfTextures, AMissingPictureIsToldOnceAndItsMaterialsDoWithout) {
  file.root["images"] = {{{"uri", "nowhere.png"}}};
  const Scene scene = load(file);
  ASSERT_EQ(scene.missing_textures.size(), 1u);
  EXPECT_EQ(scene.missing_textures[0], folder / "a.gltf" + ": images[0]: there is no picture 'nowhere.png'");
  EXPECT_EQ(scene.materials.at(0).diffuse_map.texture, -1);
  EXPECT_EQ(scene.materials[0].ambient, glm::vec3(1));
  EXPECT_EQ(scene.materials[0].emission, glm::vec3(0)) << "it glows by the picture only";
}

TEST_F(GltfTextures, MalformedAddressesAreRefusedAtTheirPlace) {
  for (const char* uri : {"%!QAAAQAAA5", "a%2", "a%", "100% wool.png", "a%00.png"}) {
    file.root["images"] = {{{"uri", "a.png"}}, {{"uri", uri}}};
    EXPECT_THAT(error(file), HasSubstr("images[1].uri: '%")) << uri;
  }
  file.root["images"] = {{{"uri", "."}}};
  EXPECT_THAT(error(file), HasSubstr("images[0].uri: '.' is not a file"));
}

TEST_F(GltfLoader, OnePictureIsOneTexture) {
  writePicture("a b.png", {1, 0, 0});
  GltfFile file = triangleFile();
  file.primitive()["material"] = 0;
  file.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                             {"emissiveTexture", {{"index", 1}}}}};
  file.root["textures"] = {{{"source", 0}}, {{"source", 0}}};
  file.root["images"] = {{{"uri", "a%20b.png"}}};
  EXPECT_EQ(load(file).textures.size(), 1u);
  file.root["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
  EXPECT_THAT(error(file), HasSubstr("images[0]")) << "coordinates are not a picture";
}

TEST_F(GltfLoader, ZeroNormalsComeFromTheFaces) {
  GltfFile file = triangleFile();
  file.primitive()["attributes"]["NORMAL"] =
      file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0, NAN, 0, 0, 0, 0, -8});
  EXPECT_EQ(load(file).meshes.at(0).normals, (std::vector<glm::vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0, -1}}));
}

TEST_F(GltfLoader, TransformsMultiplyDownTheTree) {
  GltfFile file = triangleFile();
  const double half = std::sqrt(0.5);
  file.root["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, 0, half, half}}},
                        {{"mesh", 0}, {"scale", {2, -3, 4}}},
                        {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}}};
  file.root["scenes"][0]["nodes"] = {0, 2};
  const Scene scene = load(file);
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.meshes.size(), 1u) << "a mesh of two nodes is one mesh";
  const glm::dvec4 moved = scene.objects[0].object_to_world * glm::dvec4(1, 1, 1, 1);
  // Scaled to (2, -3, 4), a quarter turn about z to (3, 2, 4), moved by 10. Ten operations on numbers up
  // to 16.
  EXPECT_LE(glm::length(moved - glm::dvec4(13, 2, 4, 1)), 10 * 16 * std::ldexp(1.0, -53));
  EXPECT_EQ(scene.objects[1].object_to_world[3], glm::dvec4(5, 6, 7, 1));
}

TEST_F(GltfLoader, NodesThatAreNoTreeAreRefused) {
  GltfFile file = triangleFile();
  file.root["nodes"] = {{{"children", {1}}}, {{"children", {0}}, {"mesh", 0}}};
  EXPECT_THAT(error(file), HasSubstr("expected a tree"));
  file.root["nodes"] = {{{"children", {1, 2}}}, {{"children", {2}}}, {{"mesh", 0}}};
  EXPECT_THAT(error(file), HasSubstr("nodes[2]: has two parents"));
  file.root["nodes"] = {{{"children", {7}}}};
  EXPECT_THAT(error(file), HasSubstr("nodes[0]: refers to node 7, but the file has 1 of them"));
}

TEST_F(GltfLoader, AChainOfManyNodesNeedsNoStack) {
  GltfFile file = triangleFile();
  constexpr int kLength = 20000;
  json nodes = json::array();
  for (int i = 1; i < kLength; ++i) nodes.push_back({{"children", {i}}});
  nodes.push_back({{"mesh", 0}});
  file.root["nodes"] = nodes;
  EXPECT_EQ(load(file).objects.size(), 1u);
}

TEST_F(GltfLoader, TheDefaultSceneIsShown) {
  GltfFile file = triangleFile();
  file.root["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {1, 2, 3}}}};
  file.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  file.root["scene"] = 1;
  const Scene scene = load(file);
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].object_to_world[3], glm::dvec4(1, 2, 3, 1));
  file.root.erase("scene");
  file.root.erase("scenes");
  EXPECT_EQ(load(file).objects.size(), 2u) << "without scenes, every root";
}

TEST_F(GltfLoader, CamerasStandWhereTheirNodeStands) {
  const json lens = {{"type", "perspective"},
                     {"perspective", {{"yfov", 0.5}, {"znear", 0.25}, {"zfar", 40}}}};
  const Camera c =
      camera(lens, {{"translation", {1, 2, 3}}, {"rotation", {0, 1, 0, 0}}, {"scale", {2, -3, 4}}});
  EXPECT_EQ(c.fov_y, 0.5);
  EXPECT_EQ(c.near, 0.25);
  EXPECT_EQ(c.far, 40);
  // Half a turn about y, and upside down; what is left is a rotation: its mirroring scale goes into x.
  const glm::dmat4 expected(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, -1, 0, 0), glm::dvec4(0, 0, -1, 0),
                            glm::dvec4(1, 2, 3, 1));
  EXPECT_EQ(c.camera_to_world, expected);
}

TEST_F(GltfLoader, ACameraWithoutZfarSeesAMillionTimesItsZnear) {
  EXPECT_EQ(camera({{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.5}}}}).far, 0.5e6);
}

TEST_F(GltfLoader, OrthographicCamerasAreRead) {
  const json lens = {{"type", "orthographic"},
                     {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0}, {"zfar", 100}}}};
  const Camera c = camera(lens);
  EXPECT_TRUE(c.orthographic);
  EXPECT_EQ(c.half_height, 3);
  EXPECT_GT(c.near, 0);
  EXPECT_EQ(c.far, 100);
}

TEST_F(GltfLoader, ImpossibleCamerasAreRefused) {
  GltfFile file = triangleFile();
  file.root["nodes"][0]["camera"] = 0;
  for (const json& lens : std::vector<json>{{{"yfov", 0}, {"znear", 1}},
                                            {{"yfov", 4}, {"znear", 1}},
                                            {{"yfov", 1}, {"znear", 0}},
                                            {{"yfov", 1}, {"znear", 2}, {"zfar", 1}}}) {
    file.root["cameras"] = {{{"type", "perspective"}, {"perspective", lens}}};
    EXPECT_THAT(error(file), HasSubstr("cameras[0]: ")) << lens;
  }
}

/// Colours go through one product and one division in double or float and one rounding to float.
constexpr float kColorTolerance = 3.0f / (1 << 23);

TEST_F(GltfLoader, ALambertianSurfaceIsAsBrightAsGltfSays) {
  // Base colour over pi times the illuminance: with our Kd N.L the light carries the 1/pi.
  const Light l = light({{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 10}, {"range", 4}});
  EXPECT_EQ(l.kind, LightKind::kPoint);
  EXPECT_NEAR(l.diffuse.x, 10 / kPi, 10 / kPi * kColorTolerance);
  EXPECT_NEAR(l.diffuse.y, 5 / kPi, 5 / kPi * kColorTolerance);
  EXPECT_EQ(l.specular, l.diffuse);
  EXPECT_EQ(l.ambient, glm::vec3(0));
  EXPECT_EQ(l.attenuation, glm::vec3(0, 0, 1));
  EXPECT_EQ(l.range, 4.0f);
  EXPECT_EQ(l.window, RangeWindow::kKhr);
  EXPECT_EQ(l.position, glm::dvec3(1, 2, 3));
}

TEST_F(GltfLoader, DirectionalLightsDoNotFallOff) {
  const Light l = light({{"type", "directional"}});
  EXPECT_EQ(l.kind, LightKind::kDirectional);
  EXPECT_EQ(l.direction, glm::dvec3(0, 0, -1));
  EXPECT_EQ(l.attenuation, glm::vec3(1, 0, 0));
  EXPECT_EQ(l.range, std::numeric_limits<float>::infinity());
}

TEST_F(GltfLoader, SpotLightsHaveTheirCones) {
  const Light l = light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}});
  EXPECT_EQ(l.kind, LightKind::kSpot);
  EXPECT_EQ(l.falloff, SpotFalloff::kCone);
  EXPECT_EQ(l.cutoff, 0.5);
  EXPECT_EQ(l.inner_cone, 0.25);
  const Light sharp = light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}}}});
  EXPECT_LT(sharp.inner_cone, sharp.cutoff);
  EXPECT_THROW(light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.6}, {"outerConeAngle", 0.5}}}}),
               InputError);
  EXPECT_THROW(light({{"type", "spot"}, {"spot", {{"outerConeAngle", 2}}}}), InputError);
}

TEST_F(GltfLoader, ExtrasOfANodeOrItsLightNameTheLightsGroup) {
  GltfFile file = triangleFile();
  json& lights = file.root["extensions"]["KHR_lights_punctual"]["lights"];
  json& node = file.root["nodes"][0];
  lights = {{{"type", "point"}, {"extras", {{"group", "of the light"}}}}};
  node["extensions"]["KHR_lights_punctual"]["light"] = 0;
  const auto groupName = [&] {
    const Scene scene = load(file);
    return scene.light_groups.at(scene.lights.at(0).group);
  };
  EXPECT_EQ(groupName(), "of the light");
  node["extras"]["group"] = "of the node";
  EXPECT_EQ(groupName(), "of the node");
  node["extras"]["group"] = {1, 2};  // somebody else's
  EXPECT_EQ(groupName(), "of the light");
  node["extras"]["group"] = "a.b";
  EXPECT_EQ(groupName(), "of the light");
  EXPECT_THAT(load(file).warnings, ElementsAre(HasSubstr("nodes[0]: extras.group: expected a group's name")));
  node.erase("extras");
  lights[0].erase("extras");
  EXPECT_EQ(groupName(), "default");
}

TEST_F(GltfLoader, ImpossibleLightsAreRefused) {
  EXPECT_THROW(light({{"type", "point"}, {"intensity", -1}}), InputError);
  EXPECT_THROW(light({{"type", "point"}, {"range", -1}}), InputError);
  EXPECT_THROW(light({{"type", "point"}, {"intensity", 1e300}}), InputError);
  EXPECT_THROW(light({{"type", "neon"}}), InputError);
}

void expectNear(const glm::vec3& a, const glm::dvec3& b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], kColorTolerance) << i;
}

TEST_F(GltfLoader, DielectricsAndMetalsBecomePhong) {
  const json plastic = {
      {"baseColorFactor", {0.8, 0.4, 0.2, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}};
  const Material p = material({{"name", "p"}, {"pbrMetallicRoughness", plastic}});
  EXPECT_EQ(p.name, "p");
  expectNear(p.ambient, {0.8, 0.4, 0.2});
  expectNear(p.diffuse, {0.8, 0.4, 0.2});
  expectNear(p.specular, glm::dvec3(0.01));  // 0.04 / 4
  EXPECT_EQ(p.shininess, 0.0f);

  const json gold = {
      {"baseColorFactor", {0.8, 0.4, 0.2, 1}}, {"metallicFactor", 1}, {"roughnessFactor", 0.5}};
  const Material g = material({{"pbrMetallicRoughness", gold}});
  expectNear(g.diffuse, glm::dvec3(0));
  expectNear(g.specular, {3.2, 1.6, 0.8});  // alpha 1/4: times 4
  EXPECT_EQ(g.shininess, 7.5f);             // (2 x 16 - 2) / 4

  const Material mirror = material({{"pbrMetallicRoughness", {{"roughnessFactor", 0}}}});
  EXPECT_LT(mirror.shininess, 1000.0f);
  EXPECT_NEAR(mirror.specular.x, 1 / (4 * std::pow(0.15, 4)), 1e-3) << "as of a roughness of 0.15";
}

TEST_F(GltfLoader, MetalnessAndRoughnessMapsCountWithTheirMean) {
  writePicture("mr.png", {0, 1, 0});
  GltfFile file = triangleFile();
  file.primitive()["material"] = 0;
  file.root["materials"] = {{{"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", 0}}}}}}};
  file.root["textures"] = {{{"source", 0}}};
  file.root["images"] = {{{"uri", "mr.png"}}};
  const Scene scene = load(file);
  expectNear(scene.materials.at(0).diffuse, glm::dvec3(1));  // metalness 1 x 0
  EXPECT_EQ(scene.materials[0].shininess, 0.0f);             // roughness 1 x 1
  EXPECT_TRUE(scene.textures.empty()) << "it is not drawn";
}

TEST_F(GltfLoader, EmissionUnlitAndSidesAreRead) {
  const Material m =
      material({{"emissiveFactor", {1, 0.5, 0}},
                {"doubleSided", true},
                {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}});
  EXPECT_EQ(m.emission, glm::vec3(4, 2, 0));
  EXPECT_TRUE(m.double_sided);
  const Material unlit = material({{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 1, 1}}}},
                                   {"extensions", {{"KHR_materials_unlit", json::object()}}}});
  EXPECT_EQ(unlit.emission, glm::vec3(0.5f, 0.25f, 1));
  EXPECT_EQ(unlit.diffuse + unlit.ambient + unlit.specular, glm::vec3(0));
}

TEST_F(GltfLoader, AlphaModesBecomeCutoffs) {
  EXPECT_EQ(material({{"alphaMode", "OPAQUE"}}).alpha_cutoff, 0.0f);
  EXPECT_EQ(material({{"alphaMode", "MASK"}}).alpha_cutoff, 0.5f);
  EXPECT_EQ(material({{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}}).alpha_cutoff, 0.25f);
  const Material glass =
      material({{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.75}}}}});
  EXPECT_EQ(glass.alpha_cutoff, 0.5f);
  EXPECT_EQ(glass.alpha, 0.75f);
}

TEST_F(GltfLoader, EachUnknownExtensionInUseIsWarnedOfOnce) {
  GltfFile file = triangleFile();
  file.root["extensionsUsed"] = {"KHR_materials_transmission", "KHR_lights_punctual",
                                 "KHR_materials_transmission", "EXT_made_up"};
  const Scene scene = load(file);
  const auto about = [&](const char* extension) {
    return AllOf(StartsWith(folder / "a.gltf: "), HasSubstr(extension), HasSubstr("not supported"));
  };
  EXPECT_THAT(scene.warnings, ElementsAre(about("KHR_materials_transmission"), about("EXT_made_up")));
}

TEST_F(GltfLoader, UnsupportedRequirementsAreNamedWithWhatIsKnown) {
  GltfFile file = triangleFile();
  file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  EXPECT_THAT(error(file),
              AllOf(HasSubstr("extensionsRequired: 'KHR_draco_mesh_compression' is not supported"),
                    HasSubstr("KHR_lights_punctual"), HasSubstr("KHR_texture_transform")));
  file.root.erase("extensionsRequired");
  file.root["asset"]["version"] = "1.0";
  EXPECT_THAT(error(file), HasSubstr("version is '1.0'"));
}

TEST_F(GltfLoader, EveryRangeIsCheckedBeforeItIsRead) {
  const GltfFile good = triangleFile();
  const auto broken = [&](const std::function<void(json&)>& change) {
    GltfFile file = good;
    change(file.root);
    return error(file);
  };
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["count"] = 4; }),
              HasSubstr("reach past bufferViews[0]"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["count"] = 1ull << 62; }), HasSubstr("reach past"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["count"] = 0; }), HasSubstr("count is 0"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["byteOffset"] = 4; }), HasSubstr("reach past"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["byteOffset"] = ~0ull - 8; }), HasSubstr("reach past"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["bufferView"] = 9; }), HasSubstr("bufferView 9"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["type"] = "VEC2"; }), HasSubstr("components"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["componentType"] = 5130; }), HasSubstr("componentType"));
  EXPECT_THAT(broken([](json& r) { r["bufferViews"][0]["byteLength"] = 40; }),
              HasSubstr("reach past its buffer"));
  EXPECT_THAT(broken([](json& r) { r["bufferViews"][0]["byteOffset"] = ~0ull; }), HasSubstr("reach past"));
  EXPECT_THAT(broken([](json& r) { r["bufferViews"][0]["buffer"] = 3; }), HasSubstr("buffer 3"));
  EXPECT_THAT(broken([](json& r) { r["bufferViews"][0]["byteStride"] = 4; }), HasSubstr("4 bytes apart"));
  EXPECT_THAT(broken([](json& r) { r["nodes"][0]["mesh"] = 5; }), HasSubstr("mesh 5"));
  EXPECT_THAT(broken([](json& r) { r["scene"] = 5; }), HasSubstr("scene 5"));
  EXPECT_THAT(broken([](json& r) { r["meshes"][0]["primitives"][0]["material"] = 5; }),
              HasSubstr("material 5"));
  EXPECT_THAT(broken([](json& r) {
                r["accessors"][0].erase("bufferView");
                r["accessors"][0]["count"] = 1ull << 40;
              }),
              HasSubstr("has no bufferView"));
  EXPECT_THAT(broken([](json& r) {
                r["accessors"][0]["sparse"] = {
                    {"count", 1},
                    {"indices", {{"bufferView", 0}, {"componentType", kUnsignedInt}, {"byteOffset", 12}}},
                    {"values", {{"bufferView", 0}}}};
              }),
              HasSubstr("replaces element"));
}

TEST_F(GltfLoader, IndicesAndPositionsOutOfRangeAreRefused) {
  GltfFile file = vertexFile();
  file.primitive()["indices"] = file.addAccessor<std::uint8_t>("SCALAR", kUnsignedByte, 1, {0, 1, 5});
  EXPECT_THAT(error(file), HasSubstr("index 5, but it has only 5 vertices"));
  file = triangleFile();
  file.primitive()["attributes"]["POSITION"] =
      file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0, 1, 0, INFINITY, 0, 1, 0});
  EXPECT_THAT(error(file), HasSubstr("POSITION: element 1 is not finite"));
  file = vertexFile();
  file.primitive()["attributes"]["NORMAL"] = 0;
  EXPECT_THAT(error(file), HasSubstr("5 and 3 elements"));
}

std::size_t triangles(const Scene& scene) {
  std::size_t sum = 0;
  for (const Object& object : scene.objects) sum += scene.meshes[object.mesh].triangles.size();
  return sum;
}

TEST_F(GltfLoader, QuakeHasItsTrianglesAndLights) {
  LUCIOLE_NEEDS_SHARED();
  Scene scene;
  loadGltf((test::sharedScenes() / "quake_e1m1/e1m1.gltf").string(), scene);
  EXPECT_EQ(triangles(scene), 15085u);
  EXPECT_EQ(scene.lights.size(), 198u);
  EXPECT_EQ(scene.textures.size(), 66u);
}

TEST_F(GltfLoader, TheSameModelIsReadFromEveryPackaging) {
  LUCIOLE_NEEDS_SHARED();
  for (const char* model : {"Box", "BoxTextured", "Duck", "Cameras", "DamagedHelmet", "LightsPunctualLamp",
                            "NegativeScaleTest", "OrientationTest", "SimpleSparseAccessor", "Suzanne",
                            "TextureSettingsTest", "TriangleWithoutIndices", "VertexColorTest"}) {
    std::size_t expected = 0;
    const std::string khronos = std::string("khronos_") + model;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(test::sharedScenes() / khronos)) {
      const std::string path = entry.path().string();
      if (!path.ends_with(".gltf") && !path.ends_with(".glb")) continue;
      Scene scene;
      if (path.find("Draco") != std::string::npos) {
        EXPECT_THROW(loadGltf(path, scene), InputError) << path;
        continue;
      }
      loadGltf(path, scene);
      if (expected == 0) expected = triangles(scene);
      EXPECT_GT(triangles(scene), 0u) << path;
      EXPECT_EQ(triangles(scene), expected) << path;
    }
    EXPECT_GT(expected, 0u) << model;
  }
}

TEST_F(GltfLoader, TheLampHasItsLightsAndTheCamerasAreTwo) {
  LUCIOLE_NEEDS_SHARED();
  Scene lamp, cameras;
  loadGltf((test::sharedScenes() / "khronos_LightsPunctualLamp/glTF/LightsPunctualLamp.gltf").string(), lamp);
  EXPECT_EQ(lamp.lights.size(), 5u);
  loadGltf((test::sharedScenes() / "khronos_Cameras/glTF/Cameras.gltf").string(), cameras);
  ASSERT_EQ(cameras.cameras.size(), 2u);
  EXPECT_FALSE(cameras.cameras[0].orthographic);
  EXPECT_TRUE(cameras.cameras[1].orthographic);
}

}  // namespace
}  // namespace luciole
