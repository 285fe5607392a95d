#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "luciole/image.hpp"
#include "tools/view/server.hpp"
#include "tools/view/watched_files.hpp"
#include "tools/viewing/shown_layer.hpp"

// EXR files that a page looks at: its requests become pictures of their layers.
namespace luciole {

/// Answers the requests of pages about EXR files of any program. Any thread may call it; calls take turns.
class FileView {
 public:
  /// Reads the files' headers. watches: reads a file again when it has changed. Throws InputError.
  FileView(const std::vector<std::string>& paths, bool watches);

  /// GET state: the files and their layers.
  Answer state();
  /// POST picture: a layer, at an exposure or with its groups of lights mixed, or how two layers differ.
  Answer picture(const std::string& body);
  /// POST pick: the numbers of a pixel, as the file has them.
  Answer pick(const std::string& body);

 private:
  struct File {
    std::string path;
    WatchedFiles watched;
    std::vector<PicturePart> parts;
    std::vector<std::string> groups;  ///< of lights
    std::string fault;                ///< why the file as it is now can't be read
  };
  /// What has been read of a file: a layer, or all of its groups of lights.
  struct Layer {
    ShownLayer shown;
    Image image;
  };
  struct KeptLayer {
    std::size_t file;
    std::string key;
    std::shared_ptr<const Layer> layer;
  };

  static File open(const std::string& path);
  void reload();
  std::shared_ptr<const Layer> keptLayer(std::size_t file, const std::string& key,
                                         const std::function<Layer()>& read);
  std::size_t fileOf(const nlohmann::json& request) const;
  std::shared_ptr<const Layer> layerOf(const nlohmann::json& request);
  Image mixOf(std::size_t file, const nlohmann::json& mix);

  bool watches_;
  std::mutex mutex_;  ///< for what follows
  std::vector<File> files_;
  std::list<KeptLayer> kept_;  ///< the last that were asked for, the newest first
  std::uint64_t generation_ = 1;
};

}  // namespace luciole
