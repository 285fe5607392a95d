#pragma once

#include <list>
#include <string>

#include "cl/device.hpp"
#include "lighting/stats.hpp"
#include "luciole/scene.hpp"
#include "render/kept_picture.hpp"
#include "render/render.hpp"

namespace luciole {

/// One of the devices that render pictures together.
struct Sharer {
  OpenedDevice* device;
  KeptPicture kept = {};    ///< from picture to picture
  double rows = 0;          ///< that it has rendered so far
  double milliseconds = 0;  ///< of work on these rows
  std::string error = {};   ///< why it dropped out; empty: it didn't
};

/// renderBands() on several devices in parallel, or on one. A device that has finished a band takes the next
/// one, of a height by its speed so far, so that all end together. The colours have the same bits as one
/// device's, if all compute alike (DeviceDescription::arithmetic). A device that fails drops out: another one
/// renders its band, and Sharer::error and Stats::shares have the reason. Each device prepares the scene's
/// lights and shadows for itself. Throws as
/// renderBands does, and MachineError if all devices have failed.
void renderShared(std::list<Sharer>& sharers, const Scene& scene, const RenderSettings& settings,
                  const RowSink& take, Stats& stats);

}  // namespace luciole
