#include <mutex>
#include <utility>

#include "lighting/kept_shadows.hpp"
#include "luciole/render.hpp"
#include "render/render.hpp"

// What luciole/render.hpp offers: the renderer's functions, each with the device to itself.
namespace luciole {

std::shared_ptr<KeptShadows> keepShadows() { return std::make_shared<KeptShadows>(); }

Picture render(Device& device, const Scene& scene, const RenderSettings& settings) {
  OpenedDevice& on = opened(device);
  const std::lock_guard lock(on.use);
  Picture picture;
  picture.image = renderScene(on, scene, settings, picture.stats);
  return picture;
}

Stats render(Device& device, const Scene& scene, const RenderSettings& settings, const RowSink& take,
             const std::shared_ptr<KeptShadows>& kept) {
  OpenedDevice& on = opened(device);
  const std::lock_guard lock(on.use);
  Stats stats;
  renderBands(on, scene, settings, take, stats, kept.get());
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

}  // namespace luciole
