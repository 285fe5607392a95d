#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "gbuffer/gbuffer_input.hpp"
#include "luciole/error.hpp"
#include "luciole/image.hpp"
#include "luciole/load_scene.hpp"
#include "luciole/pose.hpp"
#include "scene/json/light_list.hpp"
#include "scene/load_textures.hpp"
#include "scene/obj/mtl.hpp"
#include "scene/scene_fault.hpp"
#include "shared_files.hpp"
#include "tools/scale/scale_files.hpp"
#include "tools/scale/scale_log.hpp"
#include "tools/scale/scale_plot.hpp"
#include "tools/scale/scale_summary.hpp"
#include "tools/scale/scale_table.hpp"
#include "tools/viewing/light_mixer.hpp"

namespace luciole::test {

inline void readStrangersScene(const std::string& path) {
  Scene scene = loadScene(path);
  for (const double frame : {1.0, 2.5, 30.0}) {
    poseScene(scene, frame);
    if (const std::string fault = sceneFault(scene); !fault.empty()) throw std::logic_error(fault);
  }
}

/// Every material of the file, as an OBJ that uses them all has it read.
inline void readStrangersMaterials(const std::string& path) {
  Scene scene;
  MtlReading reading{scene};
  for (const MtlEntry& entry : readMtl(path, scene.warnings))
    scene.materials.push_back(readMaterial(entry, reading).material);
  decodeTextures(scene);
  for (Material& material : scene.materials) cutHoles(material, scene);
  if (const std::string fault = sceneFault(scene); !fault.empty()) throw std::logic_error(fault);
}

/// The log of an experiment with the picture pictures/a.png: merged, summarized and taken up again.
inline void readStrangersLog(const std::string& path) {
  const TemporaryFolder folder;
  const std::string run = folder / "run", merged = folder / "merged";
  std::filesystem::create_directories(run + "/pictures");
  std::ofstream(run + "/pictures/a.png") << "picture";
  std::filesystem::copy_file(path, run + "/results.jsonl");
  const ScaleSummary summary = summarizeScale(mergeScaleLogs({run}, merged));
  scaleCsv(summary);
  growthJson(summary);
  pageData(summary, merged, "luciole scale merge");
  scaleTable(summary);
  if (!summary.points.empty()) scalePlot(summary);
  ScaleLog(run, summary.description);
}

/// A file of surfaces as shade reads it, and as relight does that is told all it can be told.
inline void readStrangersSurfaces(const std::string& path) {
  const GBufferRequest told{.layers = {{Role::kShininess, "20"}},
                            .camera_to_world = glm::dmat4(1.0),
                            .camera = Camera{},
                            .albedo = true,
                            .color = true};
  try {
    readGBuffer(path, told);
  } catch (const InputError&) {  // such as a file without a picture
  }
  readGBuffer(path, GBufferRequest{});
}

/// A picture of groups of lights, as mix reads it.
inline void readStrangersGroups(const std::string& path) {
  const std::vector<GroupFactor> groups = lightGroupsOf(path);
  WriteOptions options;
  const Image mixed = mixLights(path, groups, options);
  for (const float value : mixed.pixels)
    if (mixed.channels.size() == 3 && !std::isfinite(value))
      throw std::logic_error("light that isn't finite");
  smallGroups(path, groups, 1000);
}

/// Lights, a line each.
inline void readStrangersLights(const std::string& path) {
  Scene scene;
  scene.lights = readLightList(path);
  if (const std::string fault = sceneFault(scene); !fault.empty()) throw std::logic_error(fault);
}

/// Reads a stranger's file as its extension says: .exr is a G-buffer and a picture of groups of lights, .mtl
/// materials, .jsonl the log of an experiment, .csv a list of lights, .npy a picture, .ies and .ldt profiles,
/// .pfm a sky, all else a scene. A file that is refused in one line, or doesn't fit the machine, has been
/// dealt with; anything else that goes wrong gets out of here.
inline void readStrangersFile(const std::string& path) {
  try {
    if (path.ends_with(".exr")) {
      try {
        readStrangersGroups(path);
      } catch (const InputError&) {  // most have none
      }
      readStrangersSurfaces(path);
    } else if (path.ends_with(".mtl")) {
      readStrangersMaterials(path);
    } else if (path.ends_with(".jsonl")) {
      readStrangersLog(path);
    } else if (path.ends_with(".csv")) {
      readStrangersLights(path);
    } else if (path.ends_with(".npy")) {
      readImage(path);
    } else if (path.ends_with(".ies") || path.ends_with(".ldt")) {
      std::vector<Warning> warnings;
      readLightProfile(path, warnings);
    } else if (path.ends_with(".pfm")) {
      std::vector<Warning> warnings;
      readSky(path, warnings);
    } else {
      readStrangersScene(path);
    }
  } catch (const InputError& error) {
    if (std::string(error.what()).find('\n') != std::string::npos)
      throw std::logic_error("a message of several lines");
  } catch (const MachineError&) {
  }
}

}  // namespace luciole::test
