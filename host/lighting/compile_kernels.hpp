#pragma once

#include <future>
#include <vector>

#include "cl/device.hpp"
#include "luciole/settings.hpp"
#include "luciole/stats.hpp"
#include "shade/features.hpp"

namespace luciole {

/// Compiles the kernels for these features down to machine code, by lighting one tile of background: OpenCL
/// compiles a kernel at its first launch. Throws MachineError.
void compileKernels(OpenedDevice& device, const FeatureSet& features, const ShadeSettings& settings);

/// Compiles the programs of these feature sets in a thread of its own, once the device is open. The future's
/// value is the milliseconds that it took. Its destructor waits for the thread, which refers to the
/// arguments.
std::future<double> startCompiling(OpenedDevice& device, const std::vector<FeatureSet>& programs,
                                   const ShadeSettings& settings);

/// Waits for the kernels of startCompiling(), and adds the times of waiting, compiling and opening the device
/// to the statistics. Calls RenderSettings::on_long_compile. Throws what the thread threw.
void awaitKernels(std::future<double>& compiling, OpenedDevice& device, const RenderSettings& settings,
                  Stats& stats);

}  // namespace luciole
