#pragma once

#include <luciole/render.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

namespace luciole::python {

/// Whether this thread is in a callback of a picture that is being made.
extern thread_local bool in_callback;

/// A scene, and the renderer that keeps what its pictures share, if it has one. Threads take turns.
///
/// Whoever waits for a turn must not hold Python's interpreter lock: the thread whose turn it is may need it
/// for a callback. So functions release it first, and call nothing of Python meanwhile.
class SceneHandle {
 public:
  SceneHandle() = default;
  explicit SceneHandle(Scene scene) : own_(std::move(scene)) {}

  /// A turn. Throws InputError in a callback, whose picture may have the turn.
  std::unique_lock<std::mutex> turn();

  // Only in a turn.

  Scene& scene() { return renderer_ ? renderer_->scene() : own_; }
  /// For changes of meshes and objects, which a renderer doesn't take. Throws InputError if there is one.
  Scene& sceneToBuild(const char* what);
  /// For changes that a renderer takes: the next picture checks them.
  Scene& sceneToChange();
  /// Gives the scene to a renderer of its own. Throws InputError if it has one.
  void keep(std::shared_ptr<Device> device);

  /// make(renderer): the one that keeps, if it is of this device, else one that has the scene meanwhile.
  template <class Make>
  auto withRenderer(const std::shared_ptr<Device>& device, const Make& make) {
    if (renderer_ && device_ == device) {
      checkChanges();
      return make(*renderer_);
    }
    // Gives the scene back also where a picture fails.
    struct Borrowed {
      Scene& home;
      Renderer renderer;
      ~Borrowed() { home = std::move(renderer.scene()); }
    } borrowed{scene(), Renderer(*device, std::move(scene()))};
    return make(borrowed.renderer);
  }

 private:
  void checkChanges();

  std::mutex mutex_;
  Scene own_;
  std::shared_ptr<Device> device_;
  std::optional<Renderer> renderer_;
  bool is_changed_ = false;
};

}  // namespace luciole::python
