#include "render/renderer.hpp"

#include <array>
#include <list>
#include <mutex>
#include <utility>
#include <vector>

#include "render/light_counts.hpp"
#include "render/measure_exposure.hpp"
#include "render/share_picture.hpp"

namespace luciole {

struct Renderer::State {
  std::list<Sharer> sharers;
  Scene scene;

  /// The devices for one picture alone.
  std::vector<std::unique_lock<std::mutex>> lock() {
    std::vector<std::unique_lock<std::mutex>> locks;
    for (Sharer& sharer : sharers) locks.emplace_back(sharer.device->use);
    return locks;
  }
};

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Renderer makeRenderer(std::span<OpenedDevice* const> devices, Scene scene) {
  auto state = std::make_unique<Renderer::State>();
  for (OpenedDevice* const device : devices) state->sharers.push_back({device});
  state->scene = std::move(scene);
  return Renderer(std::move(state));
}

Renderer::Renderer(Device& device, Scene scene)
    : Renderer(makeRenderer(std::array{&opened(device)}, std::move(scene))) {}

Scene& Renderer::scene() { return state_->scene; }
const Scene& Renderer::scene() const { return state_->scene; }

void Renderer::render(const RenderSettings& settings, const RowSink& take, Stats& stats) {
  const auto locks = state_->lock();
  renderShared(state_->sharers, state_->scene, settings, take, stats);
}

Picture Renderer::render(const RenderSettings& settings) {
  Picture picture;
  render(
      settings, [&](const Image& rows) { appendRows(rows, picture.image); }, picture.stats);
  return picture;
}

double Renderer::measureExposure(const RenderSettings& settings, Stats& stats) {
  const auto locks = state_->lock();
  Sharer& first = state_->sharers.front();
  return luciole::measureExposure(*first.device, state_->scene, settings, stats, &first.kept);
}

double Renderer::chooseLightCounts(const RenderSettings& settings, Stats& stats) {
  const auto locks = state_->lock();
  Sharer& first = state_->sharers.front();
  return luciole::chooseLightCounts(*first.device, state_->scene, settings, stats, &first.kept);
}

}  // namespace luciole
