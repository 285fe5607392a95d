#pragma once

#include <list>

#include "cl/device.hpp"
#include "render/share_picture.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/picture_options.hpp"

namespace luciole {

/// Opens the device that --device names in a thread of its own (see startDevice), which also looks whether it
/// computes as every device should. If not, it warns, or with --require-exact throws MachineError.
void startCheckedDevice(const PictureOptions& options, CommandContext& context);

/// The same, and the devices that make the picture: the one, or with --device all every one that can be
/// opened and computes as it should, open already. Those that are left out are told. Throws MachineError, for
/// all devices if none is left.
std::list<Sharer> startSharers(const PictureOptions& options, CommandContext& context);

/// In an event log, tells which device is used.
void logDevice(const DeviceDescription& device);

}  // namespace luciole
