#pragma once

#include <fstream>
#include <string>

#include "load/load_scene.hpp"
#include "render/render.hpp"
#include "shared_files.hpp"

namespace luciole::test {

/// A scene from its JSON text.
inline Scene sceneFromJson(const std::string& json) {
  const TemporaryFolder folder;
  std::ofstream(folder / "scene.json") << json;
  return loadScene(folder / "scene.json");
}

/// The default device, opened once a process.
inline Device& testDevice() {
  static Device device;
  static const bool opened = (openDevice("", device), true);
  (void)opened;
  return device;
}

/// A picture of the scene by its first camera, with the changes that `adjust` makes to the settings.
template <class Adjust>
Image renderJson(const std::string& json, glm::ivec2 size, Adjust adjust) {
  const Scene scene = sceneFromJson(json);
  RenderSettings settings;
  settings.size = size;
  settings.camera = scene.cameras.front();
  adjust(settings);
  Stats stats;
  return renderScene(testDevice(), scene, settings, stats);
}

inline std::size_t channelIndex(const Image& image, const std::string& name) {
  for (std::size_t c = 0; c < image.channels.size(); ++c)
    if (image.channels[c] == name) return c;
  throw std::logic_error("no channel " + name);
}

}  // namespace luciole::test
