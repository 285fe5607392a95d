#pragma once

#include <sys/types.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/cleanup.hpp"
#include "cl/device.hpp"
#include "lighting/compile_kernels.hpp"

// PoCL compiles one kernel after another, since its compiler holds a lock. Processes of their own compile
// side by side: PoCL's cache brings their work here.
namespace luciole {

/// Programs to be compiled.
struct CompileTask {
  std::vector<FeatureSet> programs;
  /// Of which count the degrees, pcf_width, tile_size, soft_samples and user_text.
  ShadeSettings settings;
  KernelChoice choice = {};
  bool quickly = false;  ///< see OpenedDevice::compiles_quickly
};

/// A task for a device as the arguments of OpenedDevice::helper's command `compile`.
std::vector<std::string> argumentsOf(const OpenedDevice& device, const CompileTask& task);

/// A task's device and the task itself.
struct DeviceTask {
  std::string selector;
  CompileTask task;
};
/// Reads what argumentsOf() returned. Throws InputError for anything else.
DeviceTask readTask(std::span<const std::string> arguments);

/// A helper at work. Its end is awaited before this goes.
class HelperProcess {
 public:
  HelperProcess() = default;
  HelperProcess(const HelperProcess&) = delete;
  HelperProcess& operator=(const HelperProcess&) = delete;
  ~HelperProcess() { await(); }

  /// Starts the device's helper on a task. Does nothing where there is none, where it would have no core of
  /// its own, or little memory.
  void start(const OpenedDevice& device, const CompileTask& task);
  /// Waits for its end. Returns false if there was one and it failed.
  bool await();

 private:
  std::optional<pid_t> child_;
  std::optional<Cleanup> killing_;
};

/// Has the device's helper do a task of OpenedDevice::left_over, and waits for its end.
void compileLeftOver(const OpenedDevice& device, const std::vector<std::string>& task);

/// Starts the device's helper on OpenedDevice::left_over, if there is any. Nobody waits for it: it outlives
/// this process by some seconds, at the lowest priority.
void startLeftOver(const OpenedDevice& device);

}  // namespace luciole
