#pragma once

#include <string>
#include <vector>

#include "tools/bench/speed_input.hpp"
#include "tools/bench/speed_table.hpp"

namespace luciole {

/// The paths of the scenes that come with the program: in scenes/ or share/luciole/scenes/ of the nearest
/// folder above it that has them. Throws MachineError where none has.
std::vector<std::string> shippedScenes(const std::string& program);

/// Measures the whole process of luciole render on the shipped scenes, or on the one that is named: with an
/// empty kernel cache and with a full one, its stages and its peak memory. Throws MachineError.
SpeedTable measurePictures(const SpeedInput& input);

/// Measures what each feature that a scene has costs, and samples, layers and an EXR: whole processes with
/// and without it, one after the other. Of the named scene, or of the first of shippedScenes(). Throws
/// MachineError.
SpeedTable measureFeatureCosts(const SpeedInput& input);

}  // namespace luciole
