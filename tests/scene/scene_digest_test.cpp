#include "scene/scene_digest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "luciole/load_scene.hpp"
#include "scene/scene_fields.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

/// Goes through a scene number by number, and changes the one that it is told to.
struct Walk {
  std::size_t change = 0;  ///< which, counted from 1; 0: none
  std::size_t count = 0;   ///< numbers, texts, and lengths of lists so far

  bool isNext() { return ++count == change; }

  template <class T>
  void visit(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      if (isNext()) value = !value;
    } else if constexpr (std::is_enum_v<T>) {
      if (isNext()) value = T(int(value) + 1);
    } else if constexpr (std::is_arithmetic_v<T>) {
      // The lowest bit of a double or float, so that all of it must count.
      if (isNext()) reinterpret_cast<unsigned char*>(&value)[0] ^= 1;
    } else {
      withFields(value, [this](auto&... fields) { (visit(fields), ...); });
    }
  }
  void visit(std::string& text) {
    if (isNext()) text += "x";
  }
  template <glm::length_t Count, class T>
  void visit(glm::vec<Count, T>& vector) {
    for (int i = 0; i < Count; ++i) visit(vector[i]);
  }
  template <glm::length_t Columns, glm::length_t Rows, class T>
  void visit(glm::mat<Columns, Rows, T>& matrix) {
    for (int i = 0; i < Columns; ++i) visit(matrix[i]);
  }
  template <class T, class Allocator>
  void visit(std::vector<T, Allocator>& values) {
    for (T& value : values) visit(value);
    if (isNext()) values.emplace_back();
  }
  template <class T>
  void visit(std::optional<T>& value) {
    if (value) visit(*value);
    if (isNext()) value = value ? std::nullopt : std::optional<T>(std::in_place);
  }
  template <class T>
  void visit(std::shared_ptr<const T>& value) {
    if (value) {
      T copy = *value;
      visit(copy);
      value = std::make_shared<const T>(copy);
    }
    if (isNext()) value = value ? nullptr : std::make_shared<const T>();
  }
};

/// Has one of everything.
Scene fullScene() {
  Scene scene;
  scene.textures.resize(1);
  scene.textures[0].levels.resize(1);
  scene.textures[0].levels[0].texels.assign(5, 0);
  scene.materials.resize(2);
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions.resize(3);
  mesh.normals.resize(3);
  mesh.uvs.resize(3);
  mesh.emission_uvs.resize(3);
  mesh.colors.resize(1);
  mesh.triangles.resize(1);
  mesh.triangle_materials.resize(3);
  mesh.divided = std::make_shared<const Mesh>(mesh);
  scene.objects.resize(1);
  scene.lights.resize(2);
  scene.cameras.resize(1);
  scene.size = glm::ivec2(3, 4);
  scene.warnings = {{"a warning", "a kind", false}};
  scene.missing_textures = {"a texture"};
  Animation& animation = scene.animation;
  const Curve curve = constantCurve({1, 2, 3, 4});
  animation.curves = {curve};
  animation.nodes.resize(1);
  animation.objects.resize(1);
  animation.attached_cameras.resize(1);
  animation.attached_lights.resize(1);
  animation.cameras = {{0, false, curve, curve, glm::dvec3(0), curve}};
  LightMotion& motion = animation.lights.emplace_back();
  for (Curve* moved :
       {&motion.position, &motion.direction, &motion.target, &motion.color, &motion.intensity, &motion.range})
    *moved = curve;
  return scene;
}

TEST(SceneDigest, ChangesWithEveryField) {
  const Scene scene = fullScene();
  Walk all;
  Scene copy = scene;
  all.visit(copy);
  EXPECT_EQ(sceneDigest(copy), sceneDigest(scene));
  ASSERT_GT(all.count, 300u);
  std::vector<std::uint64_t> digests{sceneDigest(scene)};
  for (std::size_t change = 1; change <= all.count; ++change) {
    Walk walk{change};
    Scene changed = scene;
    walk.visit(changed);
    digests.push_back(sceneDigest(changed));
    ASSERT_NE(digests.back(), digests.front()) << "number " << change << " of the scene doesn't count";
  }
  // Nor do two changes come to the same.
  std::sort(digests.begin(), digests.end());
  EXPECT_EQ(std::adjacent_find(digests.begin(), digests.end()), digests.end());
}

TEST(SceneDigest, TellsWhereOneListEndsAndTheNextBegins) {
  Scene one = fullScene(), other = one;
  one.meshes[0].name = "ab";
  one.textures[0].name = "c";
  other.meshes[0].name = "a";
  other.textures[0].name = "bc";
  EXPECT_NE(sceneDigest(one), sceneDigest(other));
  one = other = fullScene();
  std::swap(one.lights[0], one.lights[1]);
  EXPECT_EQ(sceneDigest(one), sceneDigest(other)) << "of equal lights";
  one.lights[0].range = other.lights[1].range = 3;
  EXPECT_NE(sceneDigest(one), sceneDigest(other)) << "the order of lights counts";
}

TEST(SceneDigest, IsTheSameWhenAFileIsLoadedAgain) {
  const std::string path = LUCIOLE_SOURCE_DIR "/scenes/spheres.json";
  EXPECT_EQ(sceneDigest(loadScene(path)), sceneDigest(loadScene(path)));
}

}  // namespace
}  // namespace luciole
