#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

/// The place in the names of output files that a camera's name replaces.
inline constexpr const char* kCameraPlace = "{camera}";

/// The index of the camera of that name, or counted from 0; the first for "". Throws InputError.
std::size_t findCamera(const Scene& scene, const std::string& wanted);

/// The indices of the cameras that --camera means: one, or for "all" all of the scene. Throws InputError.
std::vector<std::size_t> chosenCameras(const Scene& scene, const std::string& option);

/// The file's name for a camera: `{camera}` becomes its name, or its index if it has none. Characters other
/// than ASCII letters, digits, - _ . and those beyond ASCII become _, as does a dot in front. The folder's
/// name never changes.
std::string cameraFile(const std::string& pattern, const Scene& scene, std::size_t camera);

/// The files' names for several cameras. Throws InputError if two would be the same, or there are several and
/// the pattern has no `{camera}`. option: the pattern's, for messages.
std::vector<std::string> cameraFiles(const std::string& pattern, const Scene& scene,
                                     const std::vector<std::size_t>& cameras, const std::string& option);

}  // namespace luciole
