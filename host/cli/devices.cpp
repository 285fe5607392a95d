#include <fmt/format.h>

#include "cl/device.hpp"
#include "cli/commands.hpp"

namespace luciole {

void addDevicesCommand(CLI::App& app, CommandContext&) {
  CLI::App* command = app.add_subcommand("devices", "OpenCL devices, and which one would be used");
  auto selector = std::make_shared<std::string>();
  command->add_option("--device", *selector, "which one this selector means");
  command->callback([selector] {
    const std::vector<DeviceDescription> devices = listDevices();
    const std::size_t chosen = selectDevice(devices, *selector);
    for (std::size_t i = 0; i < devices.size(); ++i)
      fmt::print("{} {}  {} ({}), driver {}, {} lanes\n", i == chosen ? '*' : ' ', i, devices[i].name,
                 devices[i].platform, devices[i].version, devices[i].lanes);
  });
}

}  // namespace luciole
