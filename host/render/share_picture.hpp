#pragma once

#include <list>
#include <string>

#include "cl/device.hpp"
#include "lighting/kept_shadows.hpp"
#include "lighting/stats.hpp"
#include "luciole/scene.hpp"
#include "render/render.hpp"

namespace luciole {

/// A device that makes pictures beside others.
struct Sharer {
  OpenedDevice* device;
  KeptShadows kept = {};    ///< from picture to picture
  double rows = 0;          ///< that it made so far
  double milliseconds = 0;  ///< that it took for them
  std::string error = {};   ///< why it takes no part any more; empty: it does
};

/// renderBands() by several devices side by side, or by one. Each takes the next band when it is done with
/// one, and the more of the rows that are left the more it made in its time, so that all end together. The
/// colours have the same bits as those that one of them makes, if all compute alike (ArithmeticCheck). A
/// device that fails is left out from then on, its band is made by another, and its Sharer::error and
/// Stats::shares tell why. Each device prepares the scene's lights and shadows for itself, in memory of its
/// own. keeps: more pictures of the scene follow, at other poses. Throws as renderBands does: MachineError
/// if none of the devices is left.
void renderShared(std::list<Sharer>& sharers, const Scene& scene, const RenderSettings& settings,
                  const RowSink& take, Stats& stats, bool keeps);

}  // namespace luciole
