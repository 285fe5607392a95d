#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "luciole/image.hpp"
#include "scene/gltf/gltf_file.hpp"

namespace luciole::test {

/// Five vertices on a square's rim and centre, for strips, fans and indices.
inline GltfFile vertexFile() {
  GltfFile file = triangleFile();
  const int position =
      file.addAccessor<float>("VEC3", kFloat, 3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
  file.primitive()["attributes"]["POSITION"] = position;
  return file;
}

/// Loads small files, or a part of one in a file that is otherwise a triangle.
class GltfLoader : public GltfTest {
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

/// Colours go through one product and one division in double or float and one rounding to float.
inline constexpr float kColorTolerance = 3.0f / (1 << 23);

inline void expectNear(const glm::vec3& a, const glm::dvec3& b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], kColorTolerance) << i;
}

}  // namespace luciole::test
