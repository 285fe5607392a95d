#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "luciole/load_scene.hpp"
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
inline OpenedDevice& testDevice() {
  static OpenedDevice device;
  static const bool opened = (openDevice("", device), true);
  (void)opened;
  return device;
}

/// Settings for a picture of that size by the scene's first camera, with shadow maps of 256 x 256 texels:
/// small, to save time.
inline RenderSettings settingsFor(const Scene& scene, glm::ivec2 size) {
  RenderSettings settings;
  settings.size = size;
  settings.camera = scene.cameras.front();
  settings.shade.shadow_limits.size = 256;
  return settings;
}

inline Image picture(const Scene& scene, const RenderSettings& settings,
                     OpenedDevice& device = testDevice()) {
  Stats stats;
  return renderScene(device, scene, settings, stats);
}

/// A picture of the scene by its first camera, with the changes that `adjust` makes to the settings.
template <class Adjust>
Image renderJson(const std::string& json, glm::ivec2 size, Adjust adjust) {
  const Scene scene = sceneFromJson(json);
  RenderSettings settings;
  settings.size = size;
  settings.camera = scene.cameras.front();
  adjust(settings);
  return picture(scene, settings);
}

/// Names the tests of a suite with a method as its parameter.
inline std::string shadowMethodName(const testing::TestParamInfo<ShadowMethod>& test) {
  constexpr const char* kNames[] = {"Off", "Hard", "Pcf", "Soft", "Exact", "SoftExact", "Auto"};
  return kNames[int(test.param)];
}

inline std::size_t channelIndex(const Image& image, const std::string& name) {
  for (std::size_t c = 0; c < image.channels.size(); ++c)
    if (image.channels[c] == name) return c;
  throw std::logic_error("no channel " + name);
}

}  // namespace luciole::test
