#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/bench/measure.hpp"
#include "tools/bench/speed_input.hpp"
#include "tools/bench/speed_table.hpp"
#include "tools/figures/machine.hpp"

namespace luciole {

/// Steps of an 8-bit picture in a range of 1: what reports count errors in.
inline constexpr double k8BitSteps = 255;

/// What "cull and shade" measured.
struct BenchedGBuffer {
  std::string file, scene;  ///< the surfaces, and the scene whose lights light them
  std::uint64_t lights = 0;
  int width = 0, height = 0;
  std::string model;
};

struct BenchResult {
  Machine machine;
  /// What was drawn; where nothing was, because a G-buffer alone was lit, the scene that lit it, and its
  /// size.
  std::string scene;
  std::uint64_t triangles = 0, lights = 0;
  int width = 0, height = 0, repeats = 0;
  std::optional<BenchedGBuffer> gbuffer{};
  std::vector<BenchGroup> groups{};  ///< speed against error
  std::vector<SpeedTable> speed{};   ///< speed alone, a table for each measurement
};

/// What to measure.
struct BenchChoice {
  std::vector<std::string> only{};             ///< of benchNames(); empty: everything
  bool named_scene = false;                    ///< the scene is the user's rather than makeBenchScene()
  std::optional<glm::ivec2> size{};            ///< of every picture, instead of each measurement's own
  std::optional<int> shadow_size{};            ///< of all shadow maps, instead of those that are tried
  std::optional<GivenGBuffer> given{};         ///< for "cull and shade", which is measured only with it
  std::string program{};                       ///< the path of luciole itself
  std::string scene_path{};                    ///< of a named scene
  std::vector<std::string> picture_options{};  ///< see SpeedInput
};

/// The names of all that can be measured, groups of variants first, in the order in which they are measured.
std::vector<std::string> benchNames();

/// Measures what was chosen; takes minutes. Throws InputError, also if the scene lacks the shadows that all
/// that was chosen needs, and MachineError.
BenchResult runBench(const Scene& scene, const BenchSettings& settings, const BenchChoice& choice);

}  // namespace luciole
