#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "lighting/lighting.hpp"
#include "render/plan.hpp"

namespace luciole {

/// Memory of a band that is done with, for the next one: the system takes as long to clear fresh memory as
/// its pixels take to be shaded.
struct RecycledMemory {
  GBuffer gbuffer;
  Plane color;
  Image picture;
};

/// A picture that is ready to be made.
struct ReadyPicture {
  OpenedDevice& device;
  const Scene& scene;
  const RenderSettings& settings;
  const PicturePlan& plan;
  Stats& stats;
  std::vector<std::uint32_t> objects = {};  ///< that are drawn
  Lighting lighting = {};
  std::vector<LitLayer> layers = {};
  std::vector<glm::vec3> vertex_colors = {};  ///< with Shading::kGouraud only
  RecycledMemory recycled = {};
};

/// Adds to a picture's statistics what buffers cost while it exists.
struct TrafficMeter {
  OpenedDevice& device;
  Stats& stats;
  Traffic before = trafficOf(device);

  ~TrafficMeter();
};

/// Fills in the lights of the picture and of its layers. See prepareLighting.
void prepareLights(ReadyPicture& picture, const Camera& camera, KeptShadows* kept);

/// Sets what the statistics say of a picture of this size beside what it cost.
void describePicture(ReadyPicture& picture, glm::ivec2 size);

/// Adds to the statistics what is known of the picture's lights when all is lit.
void countLighting(ReadyPicture& picture);

}  // namespace luciole
