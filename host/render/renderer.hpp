#pragma once

#include <span>

#include "cl/device.hpp"
#include "luciole/render.hpp"

namespace luciole {

/// A renderer whose pictures several devices make together (see renderShared). They must outlive it, and may
/// still be opening.
Renderer makeRenderer(std::span<OpenedDevice* const> devices, Scene scene);

}  // namespace luciole
