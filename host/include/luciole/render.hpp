#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>

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

/// Makes pictures of one scene, one after another. It keeps between them what the next one needs as well: the
/// tree of triangles, shadow maps, geometry and memory. That saves time and changes no bit. Any thread may
/// use it; calls take turns.
class Renderer {
 public:
  /// `device` must outlive it. The scene isn't checked before the first picture.
  Renderer(Device& device, Scene scene);
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;
  ~Renderer();

  /// The scene. Between pictures its pose (poseScene()), cameras, lights, materials, user models, ambient
  /// light, background and fog may be changed; meshes, textures, holes, and which objects there are may not.
  /// What the first picture has found valid isn't checked again, so values must stay in their ranges. No
  /// picture may be made meanwhile.
  Scene& scene();
  const Scene& scene() const;

  /// The scene's picture. Throws as render() does.
  Picture render(const RenderSettings& settings);

  /// The same, handed to `take` band by band, so that the whole never lies in memory. Adds to the statistics.
  /// Throws likewise, and what `take` throws.
  void render(const RenderSettings& settings, const RowSink& take, Stats& stats);

  /// The exposure, in stops, that brings the picture's mean to middle grey, by a small picture without crop.
  /// Adds to the statistics what that cost. Throws as render() does.
  double measureExposure(const RenderSettings& settings, Stats& stats);

  /// Chooses how many lights take the place of each source, and of what glows: the fewest of 64, 128 … 65536
  /// whose own error is within settings.shade.light_error for the share `confidence` of the pixels. Returns
  /// that error, which is estimated from two pictures of about half as many lights, in other places each:
  /// half of what they differ by. A warning says where 65536 don't do. Throws as render() does, and
  /// InputError for a light_error of 0.
  double chooseLightCounts(const RenderSettings& settings, Stats& stats);

 private:
  struct State;
  friend Renderer makeRenderer(std::span<OpenedDevice* const> devices, Scene scene);
  explicit Renderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// The first half of render(): the G-buffer with every group. The device is needed for Shading::kGouraud
/// alone, which lights vertices. Throws as render() does.
GBuffer drawGBuffer(Device& device, const Scene& scene, const RenderSettings& settings);

/// The second half: lights a G-buffer by the scene's lights, ambient light and fog, with shadows that the
/// scene's objects cast. Uses of the settings `shade`, `aovs`, `exposure`, `alpha` and `count_lights` only;
/// the camera is the G-buffer's. Throws as render() does, and InputError for a G-buffer whose planes have
/// other sizes than it says or hold what they can't ("gbuffer.normal: ...").
Picture shade(Device& device, const Scene& scene, const GBuffer& gbuffer, const RenderSettings& settings);

/// What a map holds of the light on an object.
struct BakeSettings {
  /// A place in the world, metres: with the highlights that are seen from there. None: without highlights, as
  /// they look from nowhere.
  std::optional<glm::dvec3> eye = {};
  /// The light that arrives, to be multiplied by the surface's own colours: diffuse and ambient count as 1,
  /// emission as 0.
  bool irradiance = false;
};

/// The light on an object (an index into Scene::objects) as a map in texture space: settings.size texels,
/// laid out by its mesh's `lightmap_uvs`, or else `uvs`, the top left first. It has no fog and no background.
/// Texels around charts get their neighbours' light, so that filters and mip levels don't mix in black,
/// unless settings.alpha tells the covered texels. Uses of the settings `size`, `shade`, `surfaces`, `aovs`,
/// `light_groups`, `exposure`, `alpha`, `count_lights` and `on_long_compile` only. With an eye
/// ShadowMethod::kAuto is kExact. Throws as render() does, and InputError for an object that there isn't, one
/// whose texture coordinates are missing or share texels (for less than a hundredth of them there is a
/// warning in the statistics), layers that name objects or materials, and shadow maps with an eye.
Picture bakeLight(Device& device, Scene scene, std::uint32_t object, const BakeSettings& bake,
                  const RenderSettings& settings);

}  // namespace luciole
