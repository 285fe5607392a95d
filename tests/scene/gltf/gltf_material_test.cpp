// Materials of glTF files as Phong's, and their variants.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "luciole/error.hpp"
#include "scene/gltf/gltf_loader.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

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
    EXPECT_THAT(repair(file), HasSubstr("materials[0]: ")) << members;
  }
  extensions = {{"KHR_materials_specular", 3}};
  EXPECT_THAT(error(file), HasSubstr("materials[0].extensions.KHR_materials_specular: expected an object"));
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
    loadGltf(folder / "a.gltf", scene, {.variant = variant});
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
  json& variants = file.root["extensions"]["KHR_materials_variants"]["variants"];
  variants = 3;
  EXPECT_THAT(error(file), HasSubstr("KHR_materials_variants.variants: expected a list"));
  for (const json& odd : {json::array({3}), json::array({{{"name", 3}}})}) {
    variants = odd;
    EXPECT_THAT(repair(file), HasSubstr("KHR_materials_variants.variants[0]: has no name"));
  }
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
  EXPECT_TRUE(glass.blended);
  EXPECT_FALSE(material({{"alphaMode", "MASK"}}).blended);
  EXPECT_EQ(glass.alpha_cutoff, 0.5f) << "of its shadows";
  EXPECT_EQ(glass.alpha, 0.75f);
}

}  // namespace
}  // namespace luciole::test
