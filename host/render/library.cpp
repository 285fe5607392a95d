#include <mutex>

#include "luciole/render.hpp"
#include "render/bake.hpp"
#include "render/render.hpp"

// What luciole/render.hpp offers: the renderer's functions, each with the device to itself.
namespace luciole {

Picture render(Device& device, const Scene& scene, const RenderSettings& settings) {
  OpenedDevice& on = opened(device);
  const std::lock_guard lock(on.use);
  Picture picture;
  picture.image = renderScene(on, scene, settings, picture.stats);
  return picture;
}

Stats render(Device& device, const Scene& scene, const RenderSettings& settings, const RowSink& take) {
  OpenedDevice& on = opened(device);
  const std::lock_guard lock(on.use);
  Stats stats;
  renderBands(on, scene, settings, take, stats);
  return stats;
}

GBuffer drawGBuffer(Device& device, const Scene& scene, const RenderSettings& settings) {
  OpenedDevice& on = opened(device);
  const std::lock_guard lock(on.use);
  Stats stats;
  return rasterizeScene(&on, scene, settings, stats);
}

Picture shade(Device& device, const Scene& scene, const GBuffer& gbuffer, const RenderSettings& settings) {
  OpenedDevice& on = opened(device);
  const std::lock_guard lock(on.use);
  Picture picture;
  picture.image = shadeGBuffer(on, scene, gbuffer, settings, picture.stats);
  return picture;
}

Picture bakeLight(Device& device, Scene scene, std::uint32_t object, const BakeSettings& bake,
                  const RenderSettings& settings) {
  OpenedDevice& on = opened(device);
  const std::lock_guard lock(on.use);
  scene.fog = {};
  scene.background = glm::vec3(0.0f);
  scene.sources.clear();  // their lights stay
  Picture picture;
  picture.image = bakeMap(on, scene, object, bake, settings, picture.stats);
  return picture;
}

}  // namespace luciole
