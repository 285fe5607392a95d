#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "luciole/error.hpp"
#include "scene/gltf/gltf.hpp"
#include "shared_files.hpp"

namespace luciole::test {

using nlohmann::json;

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr int kByte = 5120, kUnsignedByte = 5121, kUnsignedShort = 5123, kUnsignedInt = 5125,
                     kFloat = 5126;

/// A glTF file in the making: JSON, and a buffer "data.bin" beside it.
struct GltfFile {
  json root = {{"asset", {{"version", "2.0"}}}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
  std::string data;

  template <typename T>
  int addView(const std::vector<T>& values) {
    while (data.size() % 4) data += '\0';
    root["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", values.size() * sizeof(T)}});
    data.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return static_cast<int>(root["bufferViews"].size()) - 1;
  }
  template <typename T>
  int addAccessor(const char* type, int component_type, int components, const std::vector<T>& values) {
    const int view = addView(values);
    root["accessors"].push_back({{"bufferView", view},
                                 {"componentType", component_type},
                                 {"count", values.size() / components},
                                 {"type", type}});
    return static_cast<int>(root["accessors"].size()) - 1;
  }
  json& accessor(int index) { return root["accessors"][index]; }
  json& primitive() { return root["meshes"][0]["primitives"][0]; }
};

/// One triangle in the xy plane, counter-clockwise, without normals.
inline GltfFile triangleFile() {
  GltfFile file;
  const int position = file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  file.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", position}}}}}}}};
  return file;
}

/// Loads such files from a folder of its own.
class GltfTest : public testing::Test {
 protected:
  Scene load(GltfFile file) {
    file.root["buffers"] = {{{"byteLength", file.data.size()}, {"uri", "data.bin"}}};
    std::ofstream(folder / "data.bin", std::ios::binary) << file.data;
    std::ofstream(folder / "a.gltf") << file.root.dump();
    Scene scene;
    loadGltf(folder / "a.gltf", scene);
    return scene;
  }
  /// Loads it, and returns the only warning, which is of a fault that was mended.
  std::string repair(const GltfFile& file) {
    const std::vector<Warning> warnings = load(file).warnings;
    EXPECT_EQ(warnings.size(), 1u);
    if (warnings.empty()) return "no warning";
    EXPECT_TRUE(warnings[0].repaired) << warnings[0].text;
    EXPECT_THAT(warnings[0].text, testing::StartsWith(folder / "a.gltf: "));
    return warnings[0].text;
  }
  std::string error(const GltfFile& file) {
    try {
      load(file);
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), testing::StartsWith(folder / "a.gltf"));
      EXPECT_THAT(e.what(), testing::Not(testing::HasSubstr("\n")));
      return e.what();
    }
    return "no error";
  }
  const TemporaryFolder folder;
};

}  // namespace luciole::test
