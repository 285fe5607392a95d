#pragma once

#include <future>
#include <vector>

#include "cl/device.hpp"
#include "luciole/settings.hpp"
#include "luciole/stats.hpp"
#include "shade/features.hpp"
#include "shade/screen_rows.hpp"
#include "shade/surface.hpp"

namespace luciole {

/// Kernels that can be compiled side by side.
struct KernelChoice {
  bool beams = true;    ///< kernels/exact/beam_shadows.cl, which takes longest
  bool others = true;   ///< all others that light, rays for undecided shadows among them
  bool counts = false;  ///< those that count lights for statistics
};

/// Compiles the kernels for these features down to machine code, by lighting one tile of background: OpenCL
/// compiles a kernel at its first launch. Throws MachineError.
void compileKernels(OpenedDevice& device, const FeatureSet& features, const ShadeSettings& settings,
                    KernelChoice choice = {});

/// Compiles the programs of these feature sets, surfaces and screens in a thread of its own, once the device
/// is open, then calls OpenedDevice::self_check. Where the device has a helper (compile_helper.hpp) it
/// compiles beams meanwhile; and if the device makes one picture, of not too many pairs of a point and a
/// light, it is lit by the general program in the place of programs that PoCL hasn't kept, or these are
/// compiled quickly. OpenedDevice::left_over is set to what PoCL lacks, with the general program. Where
/// OpenedDevice::always_lights_generally is set, the general program replaces all that it can. The future's
/// value is the milliseconds that it took. Its destructor waits for the thread, which refers to the
/// arguments.
std::future<double> startCompiling(OpenedDevice& device, const std::vector<FeatureSet>& programs,
                                   const ShadeSettings& settings, double pairs,
                                   const SurfaceProgram& surfaces, const std::vector<ScreenProgram>& screens);

/// Waits for the kernels of startCompiling(), and adds the times of waiting, compiling and opening the device
/// to the statistics. Calls RenderSettings::on_long_compile. Throws what the thread threw.
void awaitKernels(std::future<double>& compiling, OpenedDevice& device, const RenderSettings& settings,
                  Stats& stats);

}  // namespace luciole
