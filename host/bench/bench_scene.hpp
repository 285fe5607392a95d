#pragma once

#include "scene/scene.hpp"

namespace luciole {

/// The scene that `luciole bench` measures when none is named. It asks for every approximation at once:
/// highlights of exponents from 1 to 10⁴, spot exponents, exp2 fog, a shadow map of each kind, and some
/// hundreds of lights that reach only a little way.
Scene makeBenchScene();

}  // namespace luciole
