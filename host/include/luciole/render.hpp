#pragma once

#include <functional>

#include "luciole/device.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/image.hpp"
#include "luciole/scene.hpp"
#include "luciole/settings.hpp"
#include "luciole/stats.hpp"

namespace luciole {

/// A picture, and what it cost.
struct Picture {
  Image image = {};  ///< channels R G B, linear, A if asked for, then the layers
  Stats stats = {};
};

/// A scene's picture: rasterizes, draws shadow maps, culls and shades. Throws InputError for a scene or
/// settings that are out of their ranges, with a line that names the field ("settings.samples: 0, expected 1
/// to 1024"), before any work is done, and MachineError. The first picture of its kind on a device also pays
/// for compiling its kernels: 0.1 s to some seconds, unless an earlier process left them in the cache.
Picture render(Device& device, const Scene& scene, const RenderSettings& settings);

/// Takes the next rows of a picture, from the top down. `rows` lasts until it returns.
using RowSink = std::function<void(const Image& rows)>;

/// The same, handed to `take` band by band, so that the whole never lies in memory. Throws likewise, and what
/// `take` throws. A Renderer makes several pictures of one scene in less time.
Stats render(Device& device, const Scene& scene, const RenderSettings& settings, const RowSink& take);

/// The first half of render(): the G-buffer with every group. The device is needed for Shading::kGouraud
/// alone, which lights vertices. Throws as render() does.
GBuffer drawGBuffer(Device& device, const Scene& scene, const RenderSettings& settings);

/// The second half: lights a G-buffer by the scene's lights, ambient light and fog, with shadows that the
/// scene's objects cast. Uses of the settings `shade`, `aovs`, `exposure`, `alpha` and `count_lights` only;
/// the camera is the G-buffer's. Throws as render() does, and InputError for a G-buffer whose planes have
/// other sizes than it says or hold what they can't ("gbuffer.normal: ...").
Picture shade(Device& device, const Scene& scene, const GBuffer& gbuffer, const RenderSettings& settings);

}  // namespace luciole
