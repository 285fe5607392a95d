#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include "base/error.hpp"
#include "gbuffer/gbuffer_file.hpp"
#include "load/load_scene.hpp"
#include "scene/pose.hpp"
#include "scene/scene_fault.hpp"

namespace luciole::test {

/// Reads a stranger's file as its extension says: .exr is a G-buffer, all else a scene. A file that is
/// refused in one line, or doesn't fit the machine, has been dealt with; anything else that goes wrong gets
/// out of here.
inline void readStrangersFile(const std::string& path) {
  try {
    if (path.ends_with(".exr")) {
      readGBuffer(path);
    } else {
      Scene scene = loadScene(path);
      for (const double frame : {1.0, 2.5, 30.0}) {
        poseScene(scene, frame);
        if (const std::string fault = sceneFault(scene); !fault.empty()) throw std::logic_error(fault);
      }
    }
  } catch (const InputError& error) {
    if (std::string(error.what()).find('\n') != std::string::npos)
      throw std::logic_error("a message of several lines");
  } catch (const MachineError&) {
  }
}

}  // namespace luciole::test
