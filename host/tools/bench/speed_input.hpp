#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cl/device.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/model.hpp"
#include "luciole/scene.hpp"
#include "tools/figures/rounds.hpp"

namespace luciole {

/// A G-buffer from a file, the scene whose lights light it, and how it reflects them.
struct GivenGBuffer {
  std::string file;
  GBuffer gbuffer;
  Scene scene;
  Model model = Model::kPhong;
};

/// The input of the measurements of speed.
struct SpeedInput {
  OpenedDevice& device;
  std::string device_selector;          ///< that opened it
  const Scene* scene = nullptr;         ///< null: the built-in scenes only
  const GivenGBuffer* given = nullptr;  ///< for measureGivenGBuffer, which needs it
  std::optional<glm::ivec2> size;       ///< of every picture, instead of each measurement's own
  std::optional<int> shadow_size;       ///< of shadow maps, instead of those that are tried
  int repeats = 9;
  std::string scene_path{};  ///< of `scene`, as typed; empty: the built-in or shipped scenes
  std::vector<std::string> picture_options{};  ///< of luciole render, for measurements of the whole process
  std::string program;  ///< the path of luciole itself, for measurements of the whole process
  OnProgress on_progress;
  std::uint64_t most_lights = 1'000'000;  ///< of any scene
};

}  // namespace luciole
