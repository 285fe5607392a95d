#pragma once

#include "luciole/scene.hpp"

namespace luciole {

/// The scene that `luciole bench` measures when none is named. It needs all approximations at once:
/// highlights of exponents from 1 to 10⁴, spot exponents, exp2 fog, a shadow map of each kind, and some
/// hundreds of lights of short range.
Scene makeBenchScene();

}  // namespace luciole
