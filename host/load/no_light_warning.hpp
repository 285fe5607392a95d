#pragma once

#include "luciole/scene.hpp"

namespace luciole {

/// The warning of completeScene() about a scene without any light. Commands that replace the lights remove
/// it.
Warning noLightWarning(const Scene& scene);

}  // namespace luciole
