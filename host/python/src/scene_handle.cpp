#include "scene_handle.hpp"

#include <luciole/error.hpp>
#include <luciole/validate_scene.hpp>
#include <string>

namespace luciole::python {

thread_local bool in_callback = false;

std::unique_lock<std::mutex> SceneHandle::turn() {
  if (in_callback)
    throw InputError("progress: the callback may not use scenes while its picture is being made");
  return std::unique_lock(mutex_);
}

Scene& SceneHandle::sceneToBuild(const char* what) {
  if (renderer_)
    throw InputError(std::string(what) +
                     ": the scene belongs to a Renderer, which keeps meshes and objects as they "
                     "were; expected changes of transforms, lights, cameras and materials");
  return own_;
}

Scene& SceneHandle::sceneToChange() {
  is_changed_ = true;
  return scene();
}

void SceneHandle::keep(std::shared_ptr<Device> device) {
  if (renderer_)
    throw InputError("scene: it belongs to a Renderer already; expected another, or scene.copy()");
  renderer_.emplace(*device, std::move(own_));
  device_ = std::move(device);
}

void SceneHandle::checkChanges() {
  if (!is_changed_) return;
  validateScene(renderer_->scene());
  is_changed_ = false;
}

}  // namespace luciole::python
