#pragma once

#include <vector>

#include "cl/device.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/picture_options.hpp"

namespace luciole {

/// Opens the device that --device names in a thread of its own (see startDevice). Warns if its arithmetic is
/// wrong, when the picture's kernels are compiled; with --require-exact awaitDevice() throws MachineError
/// then. makes_one_picture: see OpenedDevice.
void startCheckedDevice(const PictureOptions& options, CommandContext& context, bool makes_one_picture);

/// The same for all devices that render the picture: one, or with --device all every device that can be
/// opened and whose arithmetic is right; these are open on return. Warns of others. Throws MachineError, for
/// all devices if none is left.
std::vector<OpenedDevice*> startDevices(const PictureOptions& options, CommandContext& context,
                                        bool makes_one_picture);

/// Writes the used device to the event log.
void logDevice(const DeviceDescription& device);

}  // namespace luciole
