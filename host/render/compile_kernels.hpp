#pragma once

#include <future>

#include "render/plan.hpp"

namespace luciole {

/// Compiles the kernels for these features down to machine code, by lighting one tile of background: OpenCL
/// compiles a kernel at its first launch. Throws MachineError.
void compileKernels(OpenedDevice& device, const FeatureSet& features, const ShadeSettings& settings);

/// Compiles the plan's programs in a thread of its own, once the device is open. The future's value is the
/// milliseconds that it took; its destructor waits for the thread, which refers to the plan.
std::future<double> startCompiling(OpenedDevice& device, const PicturePlan& plan);

/// Waits for these kernels, and adds what it took to the statistics. Throws what the thread threw.
void awaitKernels(std::future<double>& compiling, OpenedDevice& device, const RenderSettings& settings,
                  Stats& stats);

}  // namespace luciole
