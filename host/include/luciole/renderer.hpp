#pragma once

#include <memory>
#include <span>

#include "luciole/device.hpp"
#include "luciole/image.hpp"
#include "luciole/render.hpp"
#include "luciole/scene.hpp"
#include "luciole/settings.hpp"
#include "luciole/stats.hpp"

namespace luciole {

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

 private:
  struct State;
  friend Renderer makeRenderer(std::span<OpenedDevice* const> devices, Scene scene);
  explicit Renderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace luciole
