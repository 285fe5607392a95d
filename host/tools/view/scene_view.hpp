#pragma once

#include <atomic>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cl/device.hpp"
#include "luciole/render.hpp"
#include "tools/view/frame_size.hpp"
#include "tools/view/server.hpp"
#include "tools/view/view_changes.hpp"
#include "tools/view/view_request.hpp"
#include "tools/view/watched_files.hpp"

// A scene that a page looks at: its requests become pictures.
namespace luciole {

/// The scene, and what only the command line knows of it.
struct SceneSource {
  std::string path;
  std::string folder;        ///< where "save" writes
  bool watches = true;       ///< reads the scene again when a file of it has changed
  ViewOptions options = {};  ///< as the command was typed
  ViewShaders shaders = {};
  /// Reads the scene. Throws InputError and MachineError.
  std::function<Scene()> load = {};
  /// What options mean for the scene, of which they may set models and who casts shadows. Throws InputError
  /// for an option that the page has no business with.
  std::function<RenderSettings(const ViewOptions& options, Scene& scene)> settings = {};
};

/// Answers the requests of pages (see the protocol in README.md) about one scene. It keeps no view: each
/// request says all of it. Any thread may call it; pictures take turns.
class SceneView {
 public:
  /// Reads the scene. `device` must outlive it; where it is still being opened that is awaited. Throws as
  /// SceneSource::load and awaitDevice do.
  SceneView(OpenedDevice& device, SceneSource source);
  ~SceneView();

  /// GET state. Reads the scene again where its files have changed.
  Answer state();
  /// POST picture: a 32-bit length, so much JSON, and the picture.
  Answer picture(const std::string& body);
  Answer pick(const std::string& body);
  Answer save(const std::string& body);
  Answer check(const std::string& body);

 private:
  void load();
  void reload();
  void readyTangents();
  RenderSettings apply(const SceneChanges& view);
  bool isSuperseded(const ViewRequest& request);
  void optimizeKernels();
  glm::ivec2 movingSize(const ViewRequest& request);
  Camera cameraOf(ViewRequest& request) const;
  void expose(const SceneChanges& view, bool is_moving, RenderSettings& settings, Stats& stats);
  Image layerImage(const ViewRequest& request, RenderSettings settings, Stats& stats,
                   std::vector<std::string>& notes);
  Image shadowMapImage(const ViewRequest& request, const RenderSettings& settings);
  Image errorImage(const ViewRequest& request, RenderSettings settings, Stats& stats,
                   std::vector<std::string>& notes);
  nlohmann::json allState();

  OpenedDevice& device_;
  SceneSource source_;
  std::mutex mutex_;  ///< held while the scene is used
  std::optional<Renderer> renderer_;
  WatchedFiles files_;
  SceneValues loaded_;                   ///< as the files have them
  std::optional<SceneChanges> applied_;  ///< to the renderer's scene
  RenderSettings settings_;              ///< by these
  std::vector<std::string> numbered_;    ///< and the changes as --set has them
  glm::dvec3 middle_{0.0};               ///< of the scene
  double length_ = 1;                    ///< metres: of the scene's diagonal
  std::optional<double> exposure_;       ///< stops, measured; empty: not yet, or not needed
  std::uint64_t generation_ = 1;
  std::string fault_;  ///< why the files as they are can't be shown
  bool has_tangents_ = false;

  FrameCosts costs_;
  double full_milliseconds_ = 0;  ///< that the last full picture took

  std::mutex state_mutex_;
  std::string state_;  ///< as it was told last

  std::mutex newest_mutex_;
  std::list<std::pair<std::string, std::uint64_t>> newest_;  ///< requests of the last pages
  std::mutex check_mutex_;
  std::thread optimizing_;
  std::atomic<bool> is_optimizing_ = false, is_optimized_ = false;
};

}  // namespace luciole
