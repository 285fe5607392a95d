#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

#include "luciole/error.hpp"
#include "pictures/shrink.hpp"

namespace luciole::test {

/// Something that holds for every scene.
struct Property {
  std::string name;       ///< fit for a file's name
  std::string reproduce;  ///< a shell line that shows what is wrong with $SCENE, shaded by $MODEL
  /// What is wrong with a scene, or nothing. Throws InputError for what is no scene.
  std::function<std::optional<std::string>(const SceneJson& scene)> failure;
};

/// The first seed: 0, or $LUCIOLE_SEED for a hunt elsewhere. Seeds from kFirstFreeSeed on vary more.
inline unsigned firstSeed() {
  const char* text = std::getenv("LUCIOLE_SEED");
  return text ? unsigned(std::strtoul(text, nullptr, 10)) : 0;
}

/// Tries `count` scenes, seeds `step` apart. The first that fails is shrunk and left in the folder for
/// temporary files; what comes back says what is wrong and how to see it.
inline std::optional<std::string> hunt(const Property& property, unsigned first, unsigned count,
                                       unsigned step = 1) {
  for (unsigned i = 0; i < count; ++i) {
    const unsigned seed = first + i * step;
    const SceneJson scene = randomSceneFile(seed);
    if (!property.failure(scene)) continue;
    const Fails fails = [&](const SceneJson& candidate) {
      try {
        return property.failure(candidate).has_value();
      } catch (const InputError&) {
        return false;
      }
    };
    constexpr int kSteps = 300;  // each may compile a program of its own
    const SceneJson smallest = shrink(scene, fails, kSteps);
    const std::string path =
        (std::filesystem::temp_directory_path() / fmt::format("luciole-{}-{}.json", property.name, seed))
            .string();
    std::ofstream(path) << smallest.dump(1) << "\n";
    const SceneJson size = smallest.value("size", SceneJson{1, 1});
    const char* model = modelName(modelFor({size[0], size[1]}));
    return fmt::format("seed {}: {}\nshrunk: {}\nSCENE={}\nMODEL={}\n{}", seed, *property.failure(scene),
                       *property.failure(smallest), path, model, property.reproduce);
  }
  return std::nullopt;
}

}  // namespace luciole::test
