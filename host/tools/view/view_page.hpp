#pragma once

#include "tools/view/server.hpp"

namespace luciole {

/// The page, whole in one file, that asks a SceneView or a FileView.
Answer viewPage();

}  // namespace luciole
