#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lighting/lighting.hpp"
#include "render/kept_picture.hpp"
#include "render/plan.hpp"

namespace luciole {

/// A planned picture, its lights, and the state that its bands share.
struct ReadyPicture {
  OpenedDevice& device;
  const Scene& scene;
  const RenderSettings& settings;
  const PicturePlan& plan;
  Stats& stats;
  std::vector<std::uint32_t> objects = {};  ///< indices of those to draw
  Lighting lighting = {};
  std::vector<LitLayer> layers = {};
  std::vector<glm::vec3> vertex_colors = {};  ///< with Shading::kGouraud only
  RecycledMemory recycled = {};
};

/// Adds the device's buffer traffic during its lifetime to a picture's statistics.
struct TrafficMeter {
  OpenedDevice& device;
  Stats& stats;
  Traffic before = trafficOf(device);

  ~TrafficMeter();
};

/// Fills in the lights of the picture and of its layers. See prepareLighting.
void prepareLights(ReadyPicture& picture, const Camera& camera, KeptShadows* kept);

/// Sets Stats::width, height and samples, and what describeScene() sets.
void describePicture(ReadyPicture& picture, glm::ivec2 size);

/// Adds the counts of the picture's lights and shadows to the statistics, after the last pass.
void countLighting(ReadyPicture& picture);

}  // namespace luciole
