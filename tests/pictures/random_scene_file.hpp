#pragma once

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kernels/random_scene.hpp"
#include "scene/models.hpp"

// Random scenes as the text of a scene file, so that one that fails a test can be kept and rendered by hand.
namespace luciole::test {

/// Keeps the order of keys, for people who read the files.
using SceneJson = nlohmann::ordered_json;

/// What decides a kernel program, apart from the lights.
struct SceneKind {
  bool orthographic;
  Model model;
  const char* fog;  ///< "" for none
  bool fog_per_channel, fog_radial;
  bool long_sums;  ///< of more lights than the kernels sum in one go
};

/// Each kind is a kernel program of its own to compile, which takes a second; so the seeds that every run of
/// the tests uses keep to a few, and each of their scenes has a light of every type, all kinds of shadow
/// maps, and something smooth.
inline constexpr SceneKind kSceneKinds[] = {{false, Model::kPhong, "", false, false, false},
                                            {true, Model::kBlinnPhong, "linear", false, true, true},
                                            {false, Model::kToon, "exp2", true, false, false},
                                            {false, Model::kCookTorrance, "", false, false, true},
                                            {false, Model::kOrenNayar, "", false, false, false}};
inline constexpr unsigned kFirstFreeSeed = 1'000'000;  ///< from here on anything goes

namespace random_scene_file {

/// Three decimals are enough to be random, and can be read.
inline double rounded(double value) { return std::round(value * 1000) / 1000; }

inline SceneJson number(double low, double high, Random& random) {
  return rounded(random.between(low, high));
}

inline SceneJson array(const glm::dvec3& v) { return {rounded(v.x), rounded(v.y), rounded(v.z)}; }

/// In a box around the origin.
inline SceneJson place(double reach, Random& random) {
  return array({random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)});
}

inline SceneJson camera(bool orthographic, Random& random) {
  const glm::dvec3 eye = random.between(3, 8) * random.direction();
  SceneJson camera{
      {"eye", array(eye)}, {"target", place(1, random)}, {"up", array(random.direction())}, {"far", 50}};
  if (orthographic) {
    camera["orthographic"] = number(1.5, 4, random);
  } else {
    camera["fov_y"] = number(25, 90, random);
  }
  return camera;
}

inline SceneJson fog(const SceneKind& kind, Random& random) {
  SceneJson fog{{"mode", kind.fog}};
  if (fog["mode"] == "linear") {
    fog["start"] = number(0, 4, random);
    fog["end"] = number(6, 20, random);
  } else {
    fog["density"] = kind.fog_per_channel ? array(random.color(0.2)) : number(0, 0.2, random);
  }
  fog["color"] = array(random.color());
  fog["distance"] = kind.fog_radial ? "radial" : "depth";
  return fog;
}

inline SceneJson material(Random& random) {
  constexpr double kShininess[] = {0, 1, 5.5, 32, 64, 1e4};
  SceneJson material{{"diffuse", array(random.color())}};
  if (random.chance(0.7)) {
    material["specular"] = array(random.color());
    material["shininess"] = kShininess[random.below(6)];
  }
  if (random.chance(0.3)) material["ambient"] = array(random.color());
  if (random.chance(0.2)) material["emission"] = array(random.color());
  if (random.chance(0.3)) material["double_sided"] = true;
  return material;
}

inline SceneJson object(int materials, Random& random) {
  const std::string primitive =
      std::array{"plane", "box", "sphere", "cylinder", "cone", "torus"}[random.below(6)];
  SceneJson object{{"primitive", primitive}, {"translate", place(2, random)}};
  if (primitive != "box" && random.chance(0.8)) object["segments"] = 3 + random.below(20);
  if (primitive == "torus") object["minor_radius"] = number(0.05, 0.9, random);
  if (random.chance(0.8)) object["rotate"] = array(180.0 * (2.0 * random.color() - 1.0));
  if (random.chance(0.5)) {
    object["scale"] = number(0.2, 2, random);
  } else {
    object["scale"] = array(random.color(2) + 0.1);
    if (random.chance(0.2)) object["scale"][random.below(3)] = -0.7;
  }
  if (random.chance(0.9)) object["material"] = fmt::format("m{}", random.below(materials));
  return object;
}

inline SceneJson light(int kind, Random& random) {
  SceneJson light{{"type", std::array{"point", "directional", "spot", "spot"}[kind]}};
  if (kind == 1) {
    light["direction"] = array(random.direction());
  } else {
    light["position"] = place(4, random);
    if (random.chance(0.7)) light["range"] = number(0.3, 8, random);
    if (random.chance(0.4)) light["attenuation"] = array(random.color() + 0.01);
  }
  if (kind >= 2) light["direction"] = array(random.direction());
  if (kind == 2) {
    light["cutoff"] = random.chance(0.1) ? SceneJson(90) : number(0, 90, random);
    if (random.chance(0.7)) light["exponent"] = number(0, 128, random);
  } else if (kind == 3) {
    light["inner_cone"] = number(0, 44, random);
    light["outer_cone"] = number(45, 90, random);
  }
  if (random.chance(0.7)) {
    light["color"] = array(random.color());
  } else {
    light["diffuse"] = array(random.color());
    light["specular"] = array(random.color());
  }
  if (random.chance(0.2)) light["ambient"] = array(random.color(0.2));
  light["intensity"] = number(0, 4, random);
  if (random.chance(0.3)) light["shadow"] = true;
  return light;
}

/// Lights that have among them everything a light can have, so that all such scenes share one program.
inline void addLightOfEveryType(SceneJson& lights, Random& random) {
  for (int kind = 0; kind < 4; ++kind) lights.push_back(light(kind, random));
  lights[0]["range"] = 3.5;
  lights[0]["attenuation"] = {0.5, 0.1, 0.2};
  lights[0]["ambient"] = {0.05, 0.1, 0.05};
  lights[0]["shadow"] = true;
  lights[1]["shadow"] = true;
  lights[2]["exponent"] = 3.5;
  lights[2]["cutoff"] = 40;  // one map shows it
  lights[2]["shadow"] = true;
}

}  // namespace random_scene_file

/// Which model is for a scene's pictures: no key says so, and the tests need all.
inline Model modelFor(glm::ivec2 size) { return kAllModels[size.x % int(std::size(kAllModels))]; }

/// A scene file's content, for pictures of some thousand pixels.
inline SceneJson randomSceneFile(unsigned seed) {
  using namespace random_scene_file;
  Random random(seed);
  SceneKind kind = kSceneKinds[seed % std::size(kSceneKinds)];
  const bool free = seed >= kFirstFreeSeed;
  if (free)
    kind = {random.chance(0.3),
            kAllModels[random.below(int(std::size(kAllModels)))],
            std::array{"", "linear", "exp", "exp2"}[random.below(4)],
            random.chance(0.5),
            random.chance(0.5),
            random.chance(0.2)};
  SceneJson scene;
  scene["camera"] = camera(kind.orthographic, random);
  constexpr int kModels = std::size(kAllModels);
  scene["size"] = {kModels * (3 + random.below(16)) + int(kind.model), 17 + random.below(38)};
  scene["background"] = array(random.color());
  if (!free || random.chance(0.7)) scene["ambient"] = array(random.color(0.1) + 0.001);
  if (*kind.fog) {
    scene["fog"] = fog(kind, random);
    if (random.chance(0.3)) scene["background"] = scene["fog"]["color"];
  }
  constexpr int kMaterials = 4;
  for (int i = 0; i < kMaterials; ++i) scene["materials"][fmt::format("m{}", i)] = material(random);
  // Now and then materials choose their models. Of the others, those of one kind do, so that they share a
  // program.
  const bool of_their_own = free ? random.chance(0.3) : kind.model == Model::kOrenNayar;
  for (int i = 0; i < kMaterials && of_their_own; ++i)
    if (!free || random.chance(0.7))
      scene["materials"][fmt::format("m{}", i)]["model"] =
          modelName(kAllModels[free ? random.below(kModels) : 5 * i % kModels]);
  if (!free) {
    scene["materials"]["m0"]["specular"] = {0.3, 0.4, 0.5};
    scene["materials"]["m0"]["emission"] = {0.1, 0.0, 0.2};
  }
  scene["objects"] = SceneJson::array();
  for (int i = 2 + random.below(6); i > 0; --i) scene["objects"].push_back(object(kMaterials, random));
  if (!free)
    scene["objects"].push_back(
        {{"primitive", "sphere"}, {"translate", {0.2, -0.3, 0.1}}, {"scale", 0.5}, {"material", "m0"}});
  scene["lights"] = SceneJson::array();
  if (!free) addLightOfEveryType(scene["lights"], random);
  for (int i = kind.long_sums ? 140 : random.below(12); i > 0; --i)
    scene["lights"].push_back(light(random.below(4), random));
  return scene;
}

}  // namespace luciole::test
