// What breaks glTF's rules and is drawn by every viewer: it is mended, with one warning that --strict
// refuses.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "luciole/load_scene.hpp"
#include "scene/gltf/gltf_loader.hpp"
#include "scene/warning_texts.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

class GltfRepair : public GltfLoader {
 protected:
  /// A triangle with a material of these members.
  static GltfFile withMaterial(const json& material) {
    GltfFile file = triangleFile();
    file.root["materials"] = {material};
    file.primitive()["material"] = 0;
    return file;
  }
  Material mended(const json& material, const char* what) {
    EXPECT_THAT(repair(withMaterial(material)), HasSubstr(std::string("materials[0]: ") + what));
    return load(withMaterial(material)).materials.at(0);
  }
};

TEST_F(GltfRepair, StrictRefusesWhatIsMended) {
  load(withMaterial({{"pbrMetallicRoughness", {{"metallicFactor", 1.00016}}}}));
  const std::string path = folder / "a.gltf";
  EXPECT_EQ(loadScene(path, 1).objects.size(), 1u);
  try {
    loadScene(path, 1, {.strict = true});
    FAIL() << "no error";
  } catch (const InputError& fault) {
    EXPECT_EQ(fault.what(), path + ": materials[0]: metallicFactor is 1.00016, taken for 1");
  }
}

TEST_F(GltfRepair, FactorsAreClamped) {
  const auto pbr = [](const char* name, const json& value) {
    json members{{"metallicFactor", 0}, {"roughnessFactor", 1}};
    members[name] = value;
    return json{{"pbrMetallicRoughness", members}};
  };
  EXPECT_EQ(mended(pbr("baseColorFactor", {0.5, 1.5, 0.25, 1}), "baseColorFactor is 1.5").ambient,
            glm::vec3(0.5f, 1, 0.25f));
  EXPECT_EQ(mended(pbr("baseColorFactor", {-1, 1, 1, 1}), "baseColorFactor is -1").ambient,
            glm::vec3(0, 1, 1));
  EXPECT_EQ(mended(pbr("baseColorFactor", {0.5, 0.5, 0.5}), "baseColorFactor has 3 numbers").ambient,
            glm::vec3(0.5f));
  EXPECT_EQ(mended(pbr("metallicFactor", 2), "metallicFactor is 2").diffuse, glm::vec3(0));
  EXPECT_EQ(mended(pbr("roughnessFactor", 7), "roughnessFactor is 7").shininess, 0.0f);
  EXPECT_EQ(mended({{"emissiveFactor", {1.5, 0, 0}}}, "emissiveFactor is 1.5").emission, glm::vec3(1, 0, 0));
  EXPECT_EQ(mended({{"alphaMode", "MASK"}, {"alphaCutoff", -1}}, "alphaCutoff is -1").alpha_cutoff, 0.0f);
  EXPECT_EQ(mended({{"emissiveFactor", {1, 1, 1}},
                    {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", -2}}}}}},
                   "emissiveStrength is -2")
                .emission,
            glm::vec3(0));
}

TEST_F(GltfRepair, UnknownWordsAndNumbersAreTakenForTheNearest) {
  EXPECT_EQ(mended({{"alphaMode", "mask"}}, "alphaMode is 'mask', taken for MASK").alpha_cutoff, 0.5f);
  EXPECT_EQ(mended({{"alphaMode", "glass"}}, "alphaMode is 'glass', taken for OPAQUE").alpha_cutoff, 0.0f);
  GltfFile file = triangleFile();
  json odd = file.primitive();
  odd["mode"] = 7;
  file.root["meshes"][0]["primitives"].push_back(odd);
  EXPECT_THAT(repair(file), HasSubstr("meshes[0].primitives[1]: mode 7 is not one of glTF's; left out"));
  file = triangleFile();
  file.root["nodes"][0]["camera"] = -1;
  EXPECT_THAT(repair(file), HasSubstr("nodes[0].camera: -1 is nothing's number; left out"));
  file = triangleFile();
  file.root["nodes"][0]["name"] = 7;
  EXPECT_THAT(repair(file), HasSubstr("nodes[0].name: is no text"));
  file.root["nodes"][0]["name"] = nullptr;
  EXPECT_TRUE(load(file).warnings.empty());
}

TEST_F(GltfRepair, NumbersThatNameNothingAreTakenForTheDefault) {
  GltfFile file = triangleFile();
  json odd = file.primitive();
  odd["mode"] = -1;
  file.root["meshes"][0]["primitives"].push_back(odd);
  EXPECT_THAT(repair(file), HasSubstr("meshes[0].primitives[1]: mode -1 is not one of glTF's; left out"));
  writePicture("a.png", {1, 0, 0});
  file = withMaterial({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                       {"emissiveTexture", {{"index", 0}}}});
  file.primitive()["attributes"]["TEXCOORD_0"] =
      file.addAccessor<float>("VEC2", kFloat, 2, {0, 0, 1, 0, 0, 1});
  file.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
  file.root["images"] = {{{"uri", "a.png"}}};
  for (const json& number : {json(0), json(-5), json(5.5), json(1e15)})
    for (const char* name : {"wrapS", "wrapT", "magFilter", "minFilter"}) {
      file.root["samplers"] = {{{name, number}}};
      EXPECT_THAT(repair(file), HasSubstr(fmt::format("samplers[0]: {} is {}, none of glTF's", name,
                                                      number.get<double>())));
    }
  file.root["samplers"] = json::array();
  EXPECT_THAT(repair(file), HasSubstr("textures[0]: refers to sampler 0, but the file has 0 of them"));
}

TEST_F(GltfRepair, CamerasOfOddTypesAndLensesAreMended) {
  const json lens{{"ymag", -2}, {"znear", 1}, {"zfar", 5}}, view{{"yfov", 1}, {"znear", 0.5}};
  const auto mendedCamera = [&](const json& camera, const char* what) {
    GltfFile file = triangleFile();
    file.root["cameras"] = {camera};
    file.root["nodes"][0]["camera"] = 0;
    EXPECT_THAT(repair(file), HasSubstr(std::string("cameras[0]: ") + what));
    return load(file).cameras;
  };
  EXPECT_EQ(mendedCamera({{"type", "orthographic"}, {"orthographic", lens}}, "ymag is -2, taken for 2")
                .at(0)
                .half_height,
            2);
  json plain = lens;
  plain["ymag"] = 2;
  for (const char* type : {"Orthographic", "fisheye"})
    EXPECT_TRUE(mendedCamera({{"type", type}, {"orthographic", plain}},
                             (std::string("type is '") + type + "', taken for orthographic").c_str())
                    .at(0)
                    .orthographic);
  EXPECT_FALSE(mendedCamera({{"perspective", view}}, "type is '', taken for perspective").at(0).orthographic);
  EXPECT_TRUE(mendedCamera({{"type", "perspective"}}, "has no yfov; left out").empty());
  plain.erase("zfar");
  EXPECT_TRUE(
      mendedCamera({{"type", "orthographic"}, {"orthographic", plain}}, "has no zfar; left out").empty());
}

TEST_F(GltfRepair, AttributesOfOtherLengthsAreCutOrLeftOut) {
  GltfFile file = triangleFile();
  json& attributes = file.primitive()["attributes"];
  attributes["COLOR_0"] = file.addAccessor<float>("VEC3", kFloat, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1});
  EXPECT_THAT(repair(file),
              HasSubstr("meshes[0].primitives[0]: COLOR_0 has 4 elements for 3 vertices; the last"));
  EXPECT_EQ(load(file).meshes.at(0).colors.size(), 3u);
  attributes.erase("COLOR_0");
  attributes["NORMAL"] = file.addAccessor<float>("VEC3", kFloat, 3, {1, 0, 0, 1, 0, 0});
  EXPECT_THAT(repair(file), HasSubstr("NORMAL has 2 elements for 3 vertices; drawn as if without"));
  EXPECT_EQ(load(file).meshes.at(0).normals.at(0), glm::vec3(0, 0, 1)) << "the faces'";
  attributes.erase("NORMAL");
  attributes["TEXCOORD_1"] = file.addAccessor<float>("VEC3", kFloat, 3, {1, 0, 0, 1, 0, 0});
  EXPECT_TRUE(load(file).warnings.empty()) << "no texture needs them";
  attributes.erase("POSITION");
  file.root["nodes"].push_back({{"camera", 0}});
  file.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  file.root["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = load(file);
  EXPECT_THAT(textsOf(scene.warnings), testing::ElementsAre(HasSubstr("has no POSITION; left out")));
  EXPECT_TRUE(scene.objects.empty());
}

TEST_F(GltfRepair, GreatestIndicesEndRuns) {
  const auto triangles = [&](int mode, const std::vector<std::uint16_t>& indices) {
    GltfFile file = vertexFile();
    file.primitive()["mode"] = mode;
    file.primitive()["indices"] = file.addAccessor<std::uint16_t>("SCALAR", kUnsignedShort, 1, indices);
    EXPECT_THAT(repair(file), HasSubstr("meshes[0].primitives[0]: 1 of its indices are 65535"));
    return load(file).meshes.at(0).triangles.size();
  };
  EXPECT_EQ(triangles(4, {0, 1, 2, 65535, 0, 2, 3}), 2u);
  EXPECT_EQ(triangles(4, {0, 1, 2, 65535}), 1u);
  EXPECT_EQ(triangles(5, {0, 1, 2, 3, 65535, 1, 2, 3}), 3u);
  EXPECT_EQ(triangles(6, {65535, 0, 1, 2, 3}), 2u);
  GltfFile file = triangleFile();
  file.primitive()["indices"] = file.addAccessor<std::uint16_t>("SCALAR", kUnsignedShort, 1, {0, 1, 255});
  EXPECT_THAT(error(file), HasSubstr("index 255, but it has only 3 vertices"));
}

TEST_F(GltfRepair, VariantsWithoutANameAreCalledByTheirNumber) {
  GltfFile file = triangleFile();
  json& extension = file.root["extensions"]["KHR_materials_variants"];
  extension["variants"] = {{{"name", "a"}}, json::object()};
  EXPECT_THAT(repair(file), HasSubstr("KHR_materials_variants.variants[1]: has no name, called '1'"));
  EXPECT_EQ(load(file).variants, (std::vector<std::string>{"a", "1"}));
  extension = json::object();
  EXPECT_TRUE(load(file).warnings.empty());
}

TEST_F(GltfRepair, AParentOutsideTheSceneCountsForNothing) {
  GltfFile file = triangleFile();
  file.root["nodes"].push_back({{"translation", {5, 0, 0}}, {"children", {0}}});
  EXPECT_THAT(repair(file), HasSubstr("nodes[0]: is the scene's and nodes[1]'s, which is not in the scene"));
  EXPECT_EQ(load(file).objects.at(0).object_to_world, glm::dmat4(1.0));
}

TEST_F(GltfRepair, OtherKindsOfValuesAreRefusedByTheirPlace) {
  const auto broken = [&](const std::function<void(json&)>& change) {
    GltfFile file = triangleFile();
    change(file.root);
    return error(file);
  };
  EXPECT_THAT(broken([](json& r) { r["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = "0"; }),
              HasSubstr("meshes[0].primitives[0].attributes.POSITION: expected a number"));
  EXPECT_THAT(broken([](json& r) { r["nodes"] = 3; }), HasSubstr("nodes: expected a list"));
  EXPECT_THAT(broken([](json& r) { r["nodes"][0] = 3; }), HasSubstr("nodes[0]: expected an object"));
  EXPECT_THAT(broken([](json& r) { r["nodes"][0]["mesh"] = 0.5; }),
              HasSubstr("nodes[0].mesh: 0.5, expected"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["count"] = -3; }), HasSubstr("accessors[0].count: -3"));
  EXPECT_THAT(broken([](json& r) {
                r["nodes"][0]["scale"] = {1, "x", 1};
              }),
              HasSubstr("nodes[0].scale: expected a number"));
  EXPECT_THAT(broken([](json& r) {
                r["materials"] = {{{"doubleSided", 1}}};
              }),
              HasSubstr("materials[0].doubleSided: expected true or false"));
  EXPECT_THAT(broken([](json& r) {
                r["nodes"][0]["translation"] = {1, 2};
              }),
              HasSubstr("nodes[0]: translation has 2 numbers, expected 3"));
  const auto inMaterial = [&](const char* extension, const json& members) {
    return broken([&](json& r) { r["materials"] = {{{"extensions", {{extension, members}}}}}; });
  };
  const std::string place = "materials[0].extensions.";
  EXPECT_THAT(inMaterial("KHR_materials_emissive_strength", {{"emissiveStrength", "5"}}),
              HasSubstr(place + "KHR_materials_emissive_strength.emissiveStrength: expected a number"));
  EXPECT_THAT(inMaterial("KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", "red"}}),
              HasSubstr(place + "KHR_materials_pbrSpecularGlossiness.diffuseFactor: expected a list"));
  EXPECT_THAT(inMaterial("KHR_materials_pbrSpecularGlossiness", json::array()),
              HasSubstr(place + "KHR_materials_pbrSpecularGlossiness: expected an object"));
  EXPECT_THAT(inMaterial("KHR_materials_specular", {{"specularColorFactor", {1, "a", 1}}}),
              HasSubstr(place + "KHR_materials_specular.specularColorFactor: expected a number"));
  EXPECT_THAT(broken([](json& r) { r["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = 0; }),
              HasSubstr("nodes[0].extensions.KHR_node_visibility.visible: expected true or false"));
  EXPECT_THAT(broken([](json& r) { r["meshes"][0]["primitives"][0]["material"] = 3; }),
              HasSubstr("meshes[0].primitives[0]: refers to material 3"));
  EXPECT_THAT(broken([](json& r) { r["accessors"][0]["type"] = "vec3"; }),
              HasSubstr("accessors[0]: its type is none of glTF's"));
  EXPECT_THAT(broken([](json& r) {
                r = json::array({1});
                r = {{"x", r}};
              }),
              HasSubstr("asset"));
}

TEST_F(GltfRepair, LastRowsAndRotationsOfNodesAreMended) {
  GltfFile file = triangleFile();
  json& node = file.root["nodes"][0];
  node["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1e-6, 5, 6, 7, 1.0000001};
  EXPECT_THAT(repair(file), HasSubstr("nodes[0]: matrix has 0 0 1e-06 1.0000001 as last row"));
  EXPECT_EQ(load(file).objects.at(0).object_to_world,
            glm::dmat4({1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {5, 6, 7, 1}));
  node["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};
  node["translation"] = {1, 1, 1};
  EXPECT_THAT(repair(file), HasSubstr("nodes[0]: has a matrix, and parts beside it"));
  EXPECT_EQ(load(file).objects.at(0).object_to_world[3], glm::dvec4(5, 6, 7, 1));
  node = {{"mesh", 0}, {"rotation", {0, 2, 0, 0}}};
  EXPECT_THAT(repair(file), HasSubstr("nodes[0]: rotation is of length 2"));
  EXPECT_EQ(glm::dvec3(load(file).objects.at(0).object_to_world[0]), glm::dvec3(-1, 0, 0));
  node["rotation"] = {0, 0, 0, 0};
  EXPECT_THAT(repair(file), HasSubstr("rotation is of length 0"));
  EXPECT_EQ(load(file).objects.at(0).object_to_world, glm::dmat4(1.0));
}

TEST_F(GltfRepair, AScaleOfZeroAlongOneAxisShowsTheFlatThing) {
  GltfFile file = triangleFile();
  json& node = file.root["nodes"][0];
  node["scale"] = {2, 2, 0};
  const Scene scene = load(file);
  EXPECT_EQ(scene.objects.size(), 1u);
  EXPECT_TRUE(scene.warnings.empty());
  for (const json& scale : {json{2, 0, 0}, json{0, 0, 0}}) {
    node["scale"] = scale;
    EXPECT_THAT(error(file), HasSubstr("shows nothing")) << scale;
  }
}

TEST_F(GltfRepair, NumbersOfVerticesThatAreNoneAreMended) {
  GltfFile file = withMaterial({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  writePicture("a.png", {1, 0, 0});
  file.root["textures"] = {{{"source", 0}}};
  file.root["images"] = {{{"uri", "a.png"}}};
  EXPECT_THAT(repair(file), HasSubstr("meshes[0].primitives[0]: has no TEXCOORD_0"));
  EXPECT_EQ(load(file).meshes.at(0).uvs, std::vector<glm::vec2>(3, {0, 0})) << "not without its texture";
  json& attributes = file.primitive()["attributes"];
  attributes["TEXCOORD_0"] = file.addAccessor<float>("VEC2", kFloat, 2, {0.5f, 0.5f, NAN, 0, 0, INFINITY});
  EXPECT_THAT(repair(file),
              HasSubstr("TEXCOORD_0: 2 elements, 1 the first, with a number that is not finite"));
  EXPECT_EQ(load(file).meshes.at(0).uvs, (std::vector<glm::vec2>{{0.5f, 0.5f}, {0, 0}, {0, 0}}));
  file = triangleFile();
  file.primitive()["attributes"]["COLOR_0"] =
      file.addAccessor<float>("VEC3", kFloat, 3, {1, 0, 0, 0, NAN, 0, 0, 0, 1});
  EXPECT_THAT(repair(file), HasSubstr("COLOR_0: 1 elements, 1 the first"));
  EXPECT_EQ(load(file).meshes.at(0).colors.at(1), glm::vec4(1));
}

TEST_F(GltfRepair, NormalsThatAreNotUnitAreTold) {
  GltfFile file = triangleFile();
  json& attributes = file.primitive()["attributes"];
  attributes["NORMAL"] = file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 1, 0, 0, -8, 0, 0, 1.005f});
  EXPECT_THAT(repair(file), HasSubstr("NORMAL: 1 elements, 1 the first, not of length 1"));
  attributes["NORMAL"] = file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 1, 0, 0, 0, 0, NAN, 1});
  EXPECT_THAT(repair(file), HasSubstr("NORMAL: 2 elements, 1 the first, without a direction"));
}

TEST_F(GltfRepair, CountsThatGiveNothingToDrawAreMended) {
  GltfFile file = triangleFile();
  json empty = file.primitive();
  empty["attributes"]["POSITION"] = file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0});
  file.accessor(1)["count"] = 0;
  file.root["meshes"][0]["primitives"].push_back(empty);
  EXPECT_THAT(repair(file), HasSubstr("accessors[1]: count is 0"));
  file = triangleFile();
  file.primitive()["indices"] = file.addAccessor<std::uint8_t>("SCALAR", kUnsignedByte, 1, {0, 1, 2, 0});
  EXPECT_THAT(repair(file), HasSubstr("meshes[0].primitives[0]: 4 corners, expected a multiple of 3"));
  file = triangleFile();
  file.root["meshes"].push_back({{"primitives", json::array()}});
  file.root["nodes"].push_back({{"mesh", 1}});
  file.root["scenes"][0]["nodes"] = {0, 1};
  EXPECT_THAT(repair(file), HasSubstr("meshes[1]: has no primitives"));
  file = triangleFile();
  file.accessor(0)["min"] = {5, 5, 5};
  file.accessor(0)["max"] = {-5, -5, -5};
  EXPECT_TRUE(load(file).warnings.empty()) << "limits are not needed";
}

TEST_F(GltfRepair, SpecularGlossinessBecomesPhong) {
  const json glossy = {
      {"diffuseFactor", {0, 0.5, 0, 1}}, {"specularFactor", {0.25, 0, 0.5}}, {"glossinessFactor", 0.5}};
  const Material m = material({{"extensions", {{"KHR_materials_pbrSpecularGlossiness", glossy}}},
                               {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}}});
  expectNear(m.ambient, {0, 0.5, 0});
  expectNear(m.diffuse, {0, 0.25, 0});  // what the specular part leaves: 1 - 0.5
  expectNear(m.specular, {1, 0, 2});    // alpha = 1/4: times 4
  EXPECT_EQ(m.shininess, 7.5f);
  const Material rough = material({{"extensions",
                                    {{"KHR_materials_pbrSpecularGlossiness",
                                      {{"specularFactor", {0, 0, 0}}, {"glossinessFactor", 0}}}}}});
  expectNear(rough.diffuse, glm::dvec3(1));
  EXPECT_EQ(rough.specular, glm::vec3(0));
  EXPECT_THAT(
      repair(withMaterial(
          {{"extensions", {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {2, 0, 0, 1}}}}}}})),
      HasSubstr("materials[0]: diffuseFactor is 2"));
}

TEST_F(GltfRepair, SpecularGlossinesTexturesAreMapsOrCountByTheirMeans) {
  writePicture("diffuse.png", {1, 0, 0});
  writePicture("glossy.png", {1, 1, 1, 0});
  GltfFile file = withMaterial({{"extensions",
                                 {{"KHR_materials_pbrSpecularGlossiness",
                                   {{"diffuseTexture", {{"index", 0}, {"texCoord", 1}}},
                                    {"specularFactor", {0.5, 0.5, 0.5}},
                                    {"specularGlossinessTexture", {{"index", 1}}}}}}}});
  file.primitive()["attributes"]["TEXCOORD_1"] =
      file.addAccessor<float>("VEC2", kFloat, 2, {0, 0.25, 1, 0.5, 0, 1});
  file.root["textures"] = {{{"source", 0}}, {{"source", 1}}};
  file.root["images"] = {{{"uri", "diffuse.png"}}, {{"uri", "glossy.png"}}};
  const Scene scene = load(file);
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.meshes.at(0).uvs.at(1), glm::vec2(1, 0.5f));
  EXPECT_GE(scene.materials.at(0).diffuse_map.texture, 0);
  EXPECT_EQ(scene.materials[0].shininess, 0.0f) << "its glossiness is 0";
}

TEST_F(GltfRepair, SamplersSayHowTexelsAreFiltered) {
  writePicture("a.png", {1, 0, 0});
  GltfFile file = withMaterial({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  file.primitive()["attributes"]["TEXCOORD_0"] =
      file.addAccessor<float>("VEC2", kFloat, 2, {0, 0, 1, 0, 0, 1});
  file.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
  file.root["images"] = {{{"uri", "a.png"}}};
  const auto use = [&](const json& sampler) {
    file.root["samplers"] = {sampler};
    const Scene scene = load(file);
    EXPECT_TRUE(scene.warnings.empty()) << sampler;
    return scene.materials.at(0).diffuse_map;
  };
  EXPECT_FALSE(use(json::object()).nearest_magnified);
  EXPECT_TRUE(use({{"magFilter", 9728}}).nearest_magnified);
  EXPECT_FALSE(use({{"magFilter", 9729}}).nearest_magnified);
  const struct {
    int filter;
    bool nearest;
    Mips mips;
  } kFilters[] = {{9728, true, Mips::kNone},     {9729, false, Mips::kNone},   {9984, true, Mips::kNearest},
                  {9985, false, Mips::kNearest}, {9986, true, Mips::kBlended}, {9987, false, Mips::kBlended}};
  for (const auto& row : kFilters) {
    EXPECT_EQ(use({{"minFilter", row.filter}}).nearest_minified, row.nearest) << row.filter;
    EXPECT_EQ(use({{"minFilter", row.filter}}).mips, row.mips) << row.filter;
  }
  file.root["samplers"] = {{{"magFilter", 5}}};
  EXPECT_THAT(repair(file), HasSubstr("samplers[0]: magFilter is 5"));
}

}  // namespace
}  // namespace luciole::test
