#include "render/ready_picture.hpp"

#include "lighting/count_picture.hpp"
#include "render/screens.hpp"

namespace luciole {

TrafficMeter::~TrafficMeter() {
  const Traffic after = trafficOf(device);
  stats.traffic.bytes_up += after.bytes_up - before.bytes_up;
  stats.traffic.bytes_down += after.bytes_down - before.bytes_down;
  stats.traffic.bytes_made += after.bytes_made - before.bytes_made;
}

void prepareLights(ReadyPicture& picture, const Camera& camera, KeptShadows* kept) {
  const PicturePlan& plan = picture.plan;
  prepareLighting(picture.device, picture.scene, camera, withMargin(plan.view, plan), plan.features,
                  plan.shade, picture.lighting, picture.stats, kept);
  if (picture.settings.alpha) {
    picture.lighting.lights.frame.background = {};
    picture.lighting.lights.sky = nullptr;
  }
  picture.layers = timed(picture.stats, Stage::kPrepareLights, [&] {
    return prepareLayers(picture.device, picture.scene, camera, picture.lighting, plan.pixels, plan.shade,
                         plan.layers);
  });
}

void describePicture(ReadyPicture& picture, glm::ivec2 size) {
  describeScene(picture.scene, picture.plan.features, picture.stats);
  picture.stats.width = size.x;
  picture.stats.height = size.y;
  picture.stats.samples = picture.settings.samples;
}

void countLighting(ReadyPicture& picture) {
  countLightUses(picture.scene, picture.plan.shade, picture.lighting, picture.stats);
  countShadows(picture.lighting, picture.stats);
}

}  // namespace luciole
