// What luciole generate gltf-lights writes: valid by the rules of the glTF 2.0 specification, and the lights
// that were asked for.
#include "tools/assets/lights_asset.hpp"

#include <cmath>
#include <cstring>
#include <set>

#include "reference/reference.hpp"
#include "scene/gltf/gltf_file.hpp"

namespace luciole::test {
namespace {

/// A document as a reader meets it.
struct Read {
  json root;
  std::string bytes;

  template <typename T>
  T at(std::size_t offset) const {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
  }
};

std::uint32_t wordAt(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, 4);
  return word;
}

/// The two chunks of a .glb, whose lengths and padding must be right.
Read parseGlb(const std::string& glb) {
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(wordAt(glb, 4), 2u);
  EXPECT_EQ(wordAt(glb, 8), glb.size());
  const std::size_t length = wordAt(glb, 12);
  EXPECT_EQ(length % 4, 0u);
  EXPECT_EQ(glb.substr(16, 4), "JSON");
  const std::size_t second = 20 + length;
  EXPECT_EQ(wordAt(glb, second) % 4, 0u);
  EXPECT_EQ(glb.substr(second + 4, 4), std::string("BIN\0", 4));
  EXPECT_EQ(second + 8 + wordAt(glb, second), glb.size());
  return {json::parse(glb.substr(20, length)), glb.substr(second + 8)};
}

/// Checks one accessor and returns its numbers.
std::vector<double> numbersOf(const Read& file, std::size_t index, int component_type, const char* type,
                              int target) {
  const json& accessor = file.root["accessors"].at(index);
  EXPECT_EQ(accessor["componentType"], component_type);
  EXPECT_EQ(accessor["type"], type);
  const std::size_t size = component_type == kFloat ? 4 : 2;
  const std::size_t count = accessor["count"].get<std::size_t>() * (std::string(type) == "VEC3" ? 3 : 1);
  EXPECT_GE(count, 1u);
  const json& view = file.root["bufferViews"].at(accessor["bufferView"].get<std::size_t>());
  const std::size_t offset = view["byteOffset"];
  EXPECT_EQ(offset % 4, 0u);
  EXPECT_EQ(view["byteLength"], count * size);
  EXPECT_EQ(view["target"], target);
  EXPECT_LE(offset + count * size, file.root["buffers"][0]["byteLength"].get<std::size_t>());
  std::vector<double> numbers;
  for (std::size_t i = 0; i < count; ++i)
    numbers.push_back(size == 4 ? double(file.at<float>(offset + 4 * i))
                                : double(file.at<std::uint16_t>(offset + 2 * i)));
  return numbers;
}

void checkPrimitive(const Read& file, const json& primitive) {
  const std::size_t position = primitive["attributes"]["POSITION"];
  const std::vector<double> positions = numbersOf(file, position, kFloat, "VEC3", 34962),
                            normals =
                                numbersOf(file, primitive["attributes"]["NORMAL"], kFloat, "VEC3", 34962),
                            indices = numbersOf(file, primitive["indices"], kUnsignedShort, "SCALAR", 34963);
  ASSERT_EQ(positions.size(), normals.size());
  EXPECT_EQ(indices.size() % 3, 0u);
  const json& accessor = file.root["accessors"][position];
  for (std::size_t c = 0; c < 3; ++c) {
    double low = positions[c], high = low;
    for (std::size_t i = c; i < positions.size(); i += 3) {
      low = std::min(low, positions[i]);
      high = std::max(high, positions[i]);
    }
    EXPECT_EQ(accessor["min"][c].get<double>(), low);
    EXPECT_EQ(accessor["max"][c].get<double>(), high);
  }
  const auto vectorAt = [](const std::vector<double>& numbers, double i) {
    const auto at = 3 * std::size_t(i);
    return glm::dvec3(numbers[at], numbers[at + 1], numbers[at + 2]);
  };
  for (std::size_t i = 0; i < normals.size() / 3; ++i)
    EXPECT_NEAR(glm::length(vectorAt(normals, double(i))), 1, 2 * 0x1p-24);  // each component rounds
  const std::size_t vertices = positions.size() / 3;
  const double most = double(vertices);
  for (const double index : indices) ASSERT_LT(index, std::min(most, 65535.0));
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const glm::dvec3 a = vectorAt(positions, indices[i]), b = vectorAt(positions, indices[i + 1]),
                     c = vectorAt(positions, indices[i + 2]);
    const glm::dvec3 front = glm::cross(b - a, c - a);
    EXPECT_GT(glm::length(front), 0) << "a triangle without an area";
    for (int k = 0; k < 3; ++k)
      EXPECT_GT(glm::dot(front, vectorAt(normals, indices[i + std::size_t(k)])), 0) << "seen from behind";
  }
}

/// Rules of KHR_lights_punctual.
void checkLight(const json& light) {
  const std::string type = light["type"];
  EXPECT_TRUE(type == "point" || type == "spot" || type == "directional");
  EXPECT_GE(light["intensity"], 0);
  for (const json& channel : light["color"]) {
    EXPECT_GE(channel, 0);
    EXPECT_LE(channel, 1);
  }
  EXPECT_EQ(light.contains("range"), type != "directional");
  if (light.contains("range")) {
    EXPECT_GT(light["range"], 0);
  }
  EXPECT_EQ(light.contains("spot"), type == "spot");
  if (type != "spot") return;
  EXPECT_GE(light["spot"]["innerConeAngle"], 0);
  EXPECT_LT(light["spot"]["innerConeAngle"], light["spot"]["outerConeAngle"]);
  EXPECT_LE(light["spot"]["outerConeAngle"], kPi / 2);
}

/// Checks the nodes, and counts those that have a light.
std::uint64_t checkNodes(const Read& file, std::set<std::size_t>& meshes, std::set<std::size_t>& lights) {
  std::uint64_t lit = 0;
  for (const json& node : file.root["nodes"]) {
    if (node.contains("rotation")) {
      double square = 0;
      for (const json& x : node["rotation"]) square += x.get<double>() * x.get<double>();
      EXPECT_NEAR(square, 1, 1e-6);
    }
    EXPECT_FALSE(node.contains("children"));
    if (node.contains("mesh")) meshes.insert(node["mesh"].get<std::size_t>());
    if (!node.contains("extensions")) continue;
    lights.insert(node["extensions"]["KHR_lights_punctual"]["light"].get<std::size_t>());
    ++lit;
  }
  // A forest: without children each node is a root, once.
  std::vector<std::size_t> all(file.root["nodes"].size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  EXPECT_THAT(file.root["scenes"][0]["nodes"].get<std::vector<std::size_t>>(),
              testing::UnorderedElementsAreArray(all));
  return lit;
}

class LightsAsset : public testing::Test {
 protected:
  std::string written(std::uint64_t count, std::uint64_t seed, const std::string& name = "a.glb") {
    writeGltf(lightsAsset(count, seed), folder / name);
    return readText(folder / name);
  }
  const TemporaryFolder folder;
};

TEST_F(LightsAsset, KeepsTheRulesOfTheSpecification) {
  for (const std::uint64_t count : {1, 2, 3, 400}) {
    const Read file = parseGlb(written(count, 3));
    EXPECT_EQ(file.root["asset"]["version"], "2.0");
    EXPECT_EQ(file.root["asset"]["extras"]["count"], count);
    EXPECT_EQ(file.root["extensionsUsed"], json({"KHR_lights_punctual"}));
    EXPECT_FALSE(file.root.contains("extensionsRequired"));
    std::set<std::size_t> meshes, lights, materials, accessors;
    EXPECT_EQ(checkNodes(file, meshes, lights), count);
    const json& all_lights = file.root["extensions"]["KHR_lights_punctual"]["lights"];
    EXPECT_EQ(lights.size(), all_lights.size());
    EXPECT_EQ(*lights.rbegin(), all_lights.size() - 1);
    for (const json& light : all_lights) checkLight(light);
    EXPECT_EQ(meshes.size(), file.root["meshes"].size()) << "an unused mesh";
    EXPECT_EQ(*meshes.rbegin(), file.root["meshes"].size() - 1);
    for (const json& mesh : file.root["meshes"]) {
      for (const json& primitive : mesh["primitives"]) {
        materials.insert(primitive["material"].get<std::size_t>());
        for (const json& accessor :
             {primitive["attributes"]["POSITION"], primitive["attributes"]["NORMAL"], primitive["indices"]})
          accessors.insert(accessor.get<std::size_t>());
        checkPrimitive(file, primitive);
      }
    }
    EXPECT_EQ(materials.size(), file.root["materials"].size()) << "an unused material";
    EXPECT_EQ(accessors.size(), file.root["accessors"].size()) << "an unused accessor";
    EXPECT_EQ(accessors.size(), file.root["bufferViews"].size()) << "an unused view";
    for (const json& material : file.root["materials"]) {
      const json& pbr = material["pbrMetallicRoughness"];
      for (const json& factor : {pbr["metallicFactor"], pbr["roughnessFactor"]}) {
        EXPECT_GE(factor, 0);
        EXPECT_LE(factor, 1);
      }
    }
  }
}

TEST_F(LightsAsset, IsReadWithTheLightsThatWereAskedForAndACamera) {
  for (const char* name : {"a.glb", "night & day.gltf"}) {
    for (const std::uint64_t count : {1, 2, 300}) {
      written(count, 0, name);
      Scene scene;
      loadGltf(folder / name, scene);
      EXPECT_EQ(scene.lights.size(), count) << name;
      EXPECT_EQ(scene.cameras.size(), 1u);
      EXPECT_TRUE(scene.warnings.empty());
    }
  }
}

TEST_F(LightsAsset, IsTheSameForTheSameSeedOnly) {
  EXPECT_EQ(written(100, 5), written(100, 5));
  EXPECT_NE(written(100, 5), written(100, 6));
}

TEST_F(LightsAsset, TheRowsGetMuchTheSameLightWhateverTheCount) {
  for (const std::uint64_t count : {20, 200, 2000, 20000}) {
    written(count, 0);
    Scene scene;
    loadGltf(folder / "a.glb", scene);
    const Camera& camera = scene.cameras.front();
    double sum = 0;
    constexpr int kPlaces = 400;
    for (int i = 0; i < kPlaces; ++i) {
      // On the stage and the paving before it, where the ground is even.
      SurfacePoint point;
      const int column = i % 20, row = i / 20;
      point.position = {-12.0 + 1.2 * column, 0.13, 8.0 + 1.2 * row};
      point.normal = {0, 1, 0};
      point.diffuse = glm::dvec3(kPi);  // our lights are divided by it: the irradiance is left
      const glm::dvec3 light = referenceRadiance(scene, camera, point, Model::kPhong);
      sum += std::max({light.x, light.y, light.z});
    }
    // 1.5 lux are meant; two stops around it, as few big lamps lie by chance.
    EXPECT_GT(sum / kPlaces, 1.5 / 2) << count;
    EXPECT_LT(sum / kPlaces, 1.5 * 2) << count;
  }
}

}  // namespace
}  // namespace luciole::test
