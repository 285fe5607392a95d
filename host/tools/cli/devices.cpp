#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "cl/device.hpp"
#include "lighting/stats.hpp"
#include "luciole/error.hpp"
#include "tools/cli/commands.hpp"
#include "tools/devices/check_device.hpp"

namespace luciole {
namespace {

/// Checks a device and prints what its bits are. Returns whether they are those of every other.
bool printBits(const std::string& selector) {
  OpenedDevice device;
  ArithmeticCheck arithmetic;
  std::string picture;
  const double milliseconds = millisecondsOf([&] {
    openDevice(selector, device);
    arithmetic = checkArithmetic(device);
    picture = checkPicture(device);
  });
  const bool same_picture = picture == kCheckedPicture;
  const bool is_same = arithmetic.wrong.empty() && same_picture;
  fmt::print("     bits: {}, {:.0f} ms, arithmetic {:.16}\n", is_same ? "same" : "different", milliseconds,
             arithmetic.sha256);
  for (const std::string& line : arithmetic.wrong) fmt::print("       {}\n", line);
  if (!same_picture) fmt::print("       a small picture has the hash {}, not {}\n", picture, kCheckedPicture);
  return is_same;
}

}  // namespace

void addDevicesCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand("devices", "OpenCL devices, and which one would be used");
  auto selector = std::make_shared<std::string>();
  auto is_checked = std::make_shared<bool>(false);
  command->add_option("--device", *selector, "which one this selector means");
  command->add_flag(
      "--check", *is_checked,
      "compute hard cases and a small picture on each, or on the one of --device, and say whether "
      "the bits are those that every device should give; exit status 1 if some aren't");
  command->callback([&context, selector, is_checked] {
    const std::vector<DeviceDescription> devices = listDevices();
    const std::size_t chosen = selectDevice(devices, *selector);
    for (std::size_t i = 0; i < devices.size(); ++i) {
      fmt::print("{} {}  {} ({}), driver {}, {} lanes\n", i == chosen ? '*' : ' ', i, devices[i].name,
                 devices[i].platform, devices[i].version, devices[i].lanes);
      if (!*is_checked || (!selector->empty() && i != chosen)) continue;
      std::fflush(stdout);  // before a driver that may fail
      try {
        if (!printBits(selector->empty() ? std::to_string(i) : *selector)) context.status = kDifferent;
      } catch (const MachineError& error) {
        fmt::print("     bits: unknown, {}\n", error.what());
        if (context.status == kDone) context.status = kMachineFailed;
      }
    }
  });
}

}  // namespace luciole
