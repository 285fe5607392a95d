// A scene or settings that a caller of the library got wrong are told by their place, and nothing crashes.
#include "render/validate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "gbuffer/validate_gbuffer.hpp"
#include "luciole/error.hpp"
#include "luciole/planes.hpp"
#include "luciole/pose.hpp"
#include "luciole/validate_scene.hpp"
#include "raster/texture_space.hpp"
#include "reference/reference_picture.hpp"
#include "scene/scene_fields.hpp"

namespace luciole {
namespace {

using testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A triangle before the eye, with everything that a mesh may have.
Mesh fullMesh() {
  Mesh mesh;
  mesh.positions = {{-1, -1, -3}, {1, -1, -3}, {0, 1, -3}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.uvs = mesh.emission_uvs = mesh.normal_uvs = mesh.lightmap_uvs = {{0, 1}, {1, 1}, {0.5, 0}};
  mesh.tangents.assign(3, {1, 0, 0, 1});
  mesh.colors.assign(3, {1, 1, 1, 1});
  mesh.triangles = {{0, 1, 2}};
  mesh.triangle_materials = {1};
  mesh.sources = {0, 1, 2};
  return mesh;
}

/// A valid scene that has one of everything.
Scene fullScene() {
  Scene scene;
  for (const TextureKind kind : {TextureKind::kColor, TextureKind::kNormals}) {
    Texture& texture = scene.textures.emplace_back();
    texture.kind = kind;
    for (const int side : {2, 1})
      texture.levels.push_back({side, side, Texels(std::size_t(4 * side * side), std::uint16_t(0x8000))});
  }
  scene.materials.resize(2);
  Material& material = scene.materials[1];
  material.diffuse_map = material.emission_map = material.alpha_map = {0};
  material.normal_map = {1};
  material.alpha_cutoff = 0.1f;
  material.facets.emplace();
  material.model = Model::kPhong;
  scene.meshes = {fullMesh(), {}};
  scene.meshes[0].divided = std::make_shared<const Mesh>(fullMesh());
  scene.objects.resize(1);
  scene.lights.resize(3);
  scene.lights[1].kind = LightKind::kDirectional;
  scene.lights[2].kind = LightKind::kSpot;
  scene.lights[2].cutoff = 0.5;
  scene.lights[0].luminaire = 0;
  LightProfile profile;
  profile.polar = {0, 1, 3};
  profile.azimuth = {0, 3, 6};
  profile.candela.assign(9, 2.0f);
  profile.peak = 2;
  scene.luminaires = {{std::make_shared<const LightProfile>(profile)}};
  std::vector<Warning> warnings;
  scene.sources.resize(2);
  scene.sources[0].count = 3;
  scene.sources[0].sky = makeSky(4, 2, std::vector<float>(24, 1.0f), "sky", warnings);
  scene.sources[1].kind = SourceKind::kDisc;
  scene.sources[1].count = 2;
  addSourceLights(scene);
  scene.cameras.resize(1);
  scene.size = glm::ivec2(16, 16);
  scene.fog.mode = FogMode::kExp;
  Animation& animation = scene.animation;
  const Curve curve = constantCurve({1, 1, 1, 1});
  animation.curves = {curve};
  animation.nodes.resize(2);
  animation.nodes[1] = {.parent = 0, .translate = 0, .rotate = 0, .scale = 0};
  animation.objects = animation.attached_cameras = animation.attached_lights = {{.index = 0, .node = 1}};
  animation.no_mesh = 1;
  animation.cameras = {{0, false, curve, constantCurve({0, 0, 0, 0}), glm::dvec3(0, 1, 0), curve}};
  LightMotion& motion = animation.lights.emplace_back();
  motion.position = motion.color = motion.intensity = motion.range = curve;
  LightMotion& turn = animation.sources.emplace_back();
  turn.rotate = turn.color = turn.intensity = curve;
  Deformation& deformation = animation.deformations.emplace_back();
  RestShape rest;
  rest.positions = scene.meshes[0].positions;
  rest.normals = scene.meshes[0].normals;
  rest.targets.push_back({{1}, {{0, 1, 0}}, {{0, 0, 0}}, {{0, 0, 0}}});
  rest.first_influence = {0, 1, 2, 3};
  rest.influence_joints = {0, 0, 0};
  rest.influence_weights = {1, 1, 1};
  deformation.rest = std::make_shared<const RestShape>(rest);
  deformation.tangents = scene.meshes[0].tangents;
  deformation.weights = {0.5};
  deformation.weight_curves = {0};
  deformation.joints = {{.node = 1}};
  return scene;
}

RenderSettings smallSettings() {
  RenderSettings settings;
  settings.size = {16, 16};
  return settings;
}

/// Goes through a scene number by number, and breaks the one that it is told to.
struct Breaker {
  std::size_t change = 0;  ///< which, counted from 1; 0: none
  int way = 0;             ///< of several that each thing may be broken by
  std::size_t count = 0;   ///< numbers, and lengths of lists so far

  static constexpr int kWays = 3;

  bool isNext() { return ++count == change; }

  template <class T>
  void visit(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      if (isNext()) value = !value;
    } else if constexpr (std::is_enum_v<T>) {
      if (isNext()) value = T(100 + way);
    } else if constexpr (std::is_floating_point_v<T>) {
      if (isNext()) value = way == 0 ? T(kNan) : way == 1 ? std::numeric_limits<T>::infinity() : T(-1e30);
    } else if constexpr (std::is_arithmetic_v<T>) {
      if (isNext()) value = way == 0 ? T(1 << 20) : way == 1 ? std::numeric_limits<T>::max() : T(-2);
    } else {
      withFields(value, [this](auto&... fields) { (visit(fields), ...); });
    }
  }
  void visit(std::string&) {}
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
    if (!isNext()) return;
    if (way == 0)
      values.emplace_back();
    else if (way == 1 && !values.empty())
      values.pop_back();
    else
      values.clear();
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
    if (isNext()) value = value && way > 0 ? nullptr : std::make_shared<const T>();
  }
};

TEST(Validate, AValidSceneThatHasOneOfEverythingPasses) {
  EXPECT_NO_THROW(validate(fullScene(), smallSettings()));
}

// What passes can be posed, drawn, baked and lit.
TEST(Validate, ASceneBrokenInAnyFieldIsRefusedOrDrawn) {
  Breaker all;
  Scene whole = fullScene();
  all.visit(whole);
  ASSERT_GT(all.count, 400u);
  std::size_t refused = 0;
  for (std::size_t change = 1; change <= all.count; ++change)
    for (int way = 0; way < Breaker::kWays; ++way) {
      Scene scene = fullScene();
      Breaker{change, way}.visit(scene);
      try {
        Stats stats;
        rasterizeScene(nullptr, scene, smallSettings(), stats);
        poseScene(scene, 1);
        rasterizeScene(nullptr, scene, smallSettings(), stats);
        const glm::ivec2 middle(8, 8);
        referencePicture(scene, cameraView({}, {16, 16}), Shading::kGouraud, 1, {&middle, 1}, {});
        rasterizeTextureSpace(scene, 0, {8, 8}, {}, {});
      } catch (const InputError& error) {
        ++refused;
        EXPECT_GT(std::string(error.what()).size(), 10u);
      } catch (const MachineError&) {  // too much memory
      }
    }
  // The others are names, colours below 0, flags, and what any value may have.
  EXPECT_GT(refused, all.count * Breaker::kWays / 2);
}

struct Case {
  const char* message;
  std::function<void(Scene&, RenderSettings&)> spoil;
};

TEST(Validate, TellsThePlaceAndWhatIsWrong) {
  const auto scene = [](auto spoil) { return [=](Scene& s, RenderSettings&) { spoil(s); }; };
  const auto settings = [](auto spoil) { return [=](Scene&, RenderSettings& s) { spoil(s); }; };
  const Case cases[] = {
      {"meshes[0].triangles[0]: refers to vertex 99, but the mesh has 3",
       scene([](Scene& s) { s.meshes[0].triangles[0].z = 99; })},
      {"meshes[0].normals: has 0 elements, expected 3, as positions",
       scene([](Scene& s) { s.meshes[0].normals.clear(); })},
      {"meshes[0].positions[1]: (nan, -1, -3), expected numbers up to 1e+18",
       scene([](Scene& s) { s.meshes[0].positions[1].x = kNan; })},
      {"meshes[0].triangle_materials[0]: 2, but the number of materials is 2",
       scene([](Scene& s) { s.meshes[0].triangle_materials[0] = 2; })},
      {"materials[0].emission_map.mips: 7, expected a Mips",
       scene([](Scene& s) { s.materials[0].emission_map.mips = Mips(7); })},
      {"meshes[0].divided.uvs: has 1 elements, expected 3, as positions", scene([](Scene& s) {
         Mesh divided = *s.meshes[0].divided;
         divided.uvs.resize(1);
         s.meshes[0].divided = std::make_shared<const Mesh>(divided);
       })},
      {"objects[0].mesh: 7, but the number of meshes is 2", scene([](Scene& s) { s.objects[0].mesh = 7; })},
      {"objects[0].material: -3, but the number of materials is 2",
       scene([](Scene& s) { s.objects[0].material = -3; })},
      {"materials[1].diffuse_map.texture: 5, but the number of textures is 2",
       scene([](Scene& s) { s.materials[1].diffuse_map.texture = 5; })},
      {"materials[1].normal_map.texture: 0 is a texture of colours",
       scene([](Scene& s) { s.materials[1].normal_map.texture = 0; })},
      {"textures[1].levels[0].texels: has 3 elements, expected 16, 4 a texel",
       scene([](Scene& s) { s.textures[1].levels[0].texels.resize(3); })},
      {"lights[2].group: 4, but the number of light_groups is 1",
       scene([](Scene& s) { s.lights[2].group = 4; })},
      {"lights[1].half_angle: nan, expected radians from 0 to half a right angle",
       scene([](Scene& s) { s.lights[1].half_angle = kNan; })},
      {"lights[0].attenuation: (1, -1, 0), expected numbers of at least 0",
       scene([](Scene& s) { s.lights[0].attenuation.y = -1; })},
      {"a.json: fog.density: (-1, 1, 1), expected", scene([](Scene& s) {
         s.name = "a.json";
         s.fog.density.x = -1;
       })},
      {"settings.size: 0x16 pixels, expected 1 to 32768 a side",
       settings([](RenderSettings& s) { s.size.x = 0; })},
      {"settings.samples: 0, expected 1 to 1024", settings([](RenderSettings& s) { s.samples = 0; })},
      {"settings.camera.fov_y: 0, expected", settings([](RenderSettings& s) { s.camera.fov_y = 0; })},
      {"settings.camera.shift: (nan, 0), expected numbers up to 1e6",
       settings([](RenderSettings& s) { s.camera.shift.x = std::nan(""); })},
      {"settings.camera.pixel_aspect: 0, expected 1e-6 to 1e6",
       settings([](RenderSettings& s) { s.camera.pixel_aspect = 0; })},
      {"settings.camera.camera_to_world: scales or shears",
       settings([](RenderSettings& s) { s.camera.camera_to_world[0] *= 2.0; })},
      {"settings.shade.tile_size: 5, expected 4, 8 or 16",
       settings([](RenderSettings& s) { s.shade.tile_size = 5; })},
      {"settings.shade.light_error: nan, expected 0 to 1",
       settings([](RenderSettings& s) { s.shade.light_error = kNan; })},
      {"settings.shade.light_error_floor: 0, expected 1e-06 to 1",
       settings([](RenderSettings& s) { s.shade.light_error_floor = 0; })},
      {"settings.shade.confidence: 0.49, expected 0.5 to 0.9999",
       settings([](RenderSettings& s) { s.shade.confidence = 0.49; })},
      {"settings.shade.confidence: 1, expected 0.5 to 0.9999",
       settings([](RenderSettings& s) { s.shade.confidence = 1; })},
      {"settings.shade.confidence: nan, expected",
       settings([](RenderSettings& s) { s.shade.confidence = kNan; })},
      {"settings.aovs: 200, expected", settings([](RenderSettings& s) { s.aovs = {Aov(200)}; })},
      {"settings.exposure: inf, expected -100 to 100",
       settings([](RenderSettings& s) { s.exposure = std::numeric_limits<float>::infinity(); })},
  };
  for (const Case& one : cases) {
    Scene broken = fullScene();
    RenderSettings settings_broken = smallSettings();
    one.spoil(broken, settings_broken);
    try {
      // Nothing touches the device, which isn't open, before.
      OpenedDevice device;
      Stats stats;
      renderScene(device, broken, settings_broken, stats);
      ADD_FAILURE() << "passed: " << one.message;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith(one.message));
    }
  }
}

TEST(Validate, AGBufferWhosePlanesDontFitIsRefused) {
  const RenderSettings settings = smallSettings();
  GBuffer whole;
  whole.width = whole.height = 16;
  whole.tiles_x = whole.tiles_y = 1;
  whole.picture_size = settings.size;
  allocatePlanes({.specular = true, .geometric_normal = true, .lift = true, .model = true}, whole);
  EXPECT_NO_THROW(validateGBuffer(whole));
  const std::vector<std::pair<const char*, std::function<void(GBuffer&)>>> cases{
      {"gbuffer: 0x16 pixels", [](GBuffer& g) { g.width = 0; }},
      {"gbuffer: 9x1 tiles, expected 1x1", [](GBuffer& g) { g.tiles_x = 9; }},
      {"gbuffer.normal: has 0 numbers, expected 768", [](GBuffer& g) { g.normal.clear(); }},
      {"gbuffer.specular: has 1 numbers, expected 1024", [](GBuffer& g) { g.specular.resize(1); }},
      {"gbuffer.unbent_normal: has 1 numbers, expected 256", [](GBuffer& g) { g.unbent_normal.resize(1); }},
      {"gbuffer.unbent_normal: beside geometric_normal", [](GBuffer& g) { g.unbent_normal.resize(256); }},
      {"gbuffer.tangent: has 1 numbers, expected 256", [](GBuffer& g) { g.tangent.resize(1); }},
      {"gbuffer.uv: has 1 numbers, expected 512", [](GBuffer& g) { g.uv.resize(1); }},
      {"gbuffer.object: has 1 numbers, expected 256", [](GBuffer& g) { g.object.resize(1); }},
      {"gbuffer.material: has 1 numbers, expected 256", [](GBuffer& g) { g.material.resize(1); }},
      {"gbuffer.model: has a number above", [](GBuffer& g) { g.model[3] = 99; }},
      {"gbuffer.camera.near: -1", [](GBuffer& g) { g.camera.near = -1; }},
      {"gbuffer.picture_size: 0x0", [](GBuffer& g) {
         g.picture_size = {0, 0};
       }}};
  for (const auto& [message, spoil] : cases) {
    GBuffer broken = whole;
    spoil(broken);
    try {
      OpenedDevice device;
      Stats stats;
      shadeGBuffer(device, fullScene(), broken, settings, stats);
      ADD_FAILURE() << "passed: " << message;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message));
    }
  }
}

TEST(Validate, GouraudShadingWithoutADeviceIsRefused) {
  RenderSettings settings = smallSettings();
  settings.shading = Shading::kGouraud;
  Stats stats;
  EXPECT_THROW(rasterizeScene(nullptr, fullScene(), settings, stats), InputError);
}

}  // namespace
}  // namespace luciole
