// Textures of glTF files: pictures, coordinates and their transforms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "scene/gltf/gltf_loader.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

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
  EXPECT_THAT(repair(file), HasSubstr("materials[0]: normalTexture.scale"));
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

TEST_F(GltfTextures, BasisPicturesFallBackOrAreLeftOutWithAWarning) {
  file.root["textures"][0]["extensions"]["KHR_texture_basisu"]["source"] = 1;
  file.root["images"].push_back({{"uri", "a.ktx2"}});
  EXPECT_EQ(load(file).materials.at(0).diffuse_map.texture, 0);
  file.root["textures"][0].erase("source");
  const Scene scene = load(file);
  EXPECT_EQ(scene.materials.at(0).diffuse_map.texture, -1);
  ASSERT_EQ(scene.warnings.size(), 1u) << "though two maps use it";
  EXPECT_THAT(scene.warnings[0].text,
              HasSubstr("textures[0]: has only a KHR_texture_basisu picture, which is not supported"));
  EXPECT_FALSE(scene.warnings[0].repaired);
  file.root["textures"][0].erase("extensions");
  EXPECT_THAT(load(file).warnings.at(0).text, HasSubstr("textures[0]: has no picture; drawn without"));
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

TEST_F(GltfTextures, ImpossibleTransformsAreRefused) {
  for (const auto& [members, what] : std::vector<std::pair<json, std::string>>{
           {{{"offset", {1}}}, "baseColorTexture.KHR_texture_transform: offset must be 2 numbers"},
           {{{"scale", "x"}}, "baseColorTexture.extensions.KHR_texture_transform.scale: expected a list"},
           {{{"scale", {1e300, 1}}}, "TEXCOORD: element 1 is not finite"}}) {
    base()["extensions"] = transform(members);
    EXPECT_THAT(error(file), HasSubstr(what));
  }
}

TEST_F(GltfTextures, ANegativeSetOfATransformIsLeftOut) {
  base()["extensions"] = transform({{"texCoord", -1}});
  EXPECT_THAT(repair(file), HasSubstr("baseColorTexture.extensions.KHR_texture_transform.texCoord: -1"));
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

TEST_F(GltfTextures, AddressesThatMeanNoFileAreMissingPictures) {
  for (const char* uri : {"%!QAAAQAAA5", "a%2", "a%", "100% wool.png", "a%00.png", ".", "http://x/b.png"}) {
    file.root["images"] = {{{"uri", uri}}};
    EXPECT_THAT(load(file).missing_textures,
                testing::ElementsAre(HasSubstr("images[0]: there is no picture")))
        << uri;
  }
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

}  // namespace
}  // namespace luciole::test
