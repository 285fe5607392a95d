#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "luciole/scene.hpp"

namespace luciole {

/// The files that a scene is read from, and when they were written.
using WatchedFiles = std::map<std::string, std::filesystem::file_time_type>;

/// A scene's file, and those that its JSON or OBJ names, there or not.
WatchedFiles filesOf(const std::string& path);

/// Adds the pictures of the scene's textures, and its shaders.
void watchTextures(const Scene& scene, WatchedFiles& watched);

/// Whether one of them was written since, or has gone or come.
bool haveChanged(const WatchedFiles& watched);

}  // namespace luciole
