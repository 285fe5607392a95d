#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace luciole {

/// Options of the command line by their long names, as typed: {"shading", "flat"}.
using ViewOptions = std::map<std::string, std::string>;

/// The texts of shaders; "": none.
struct ViewShaders {
  std::string model = {}, surface = {}, screen = {};
  bool operator==(const ViewShaders&) const = default;
};

/// All that a picture of a scene depends on. The page keeps it.
struct SceneChanges {
  std::vector<std::string> changes = {};  ///< "PATH=VALUE" as of --set, with colours as of numberedChanges()
  ViewOptions options = {};
  ViewShaders shaders = {};
  bool operator==(const SceneChanges&) const = default;
};

/// A frame of a motion, as the page has seen it.
struct SeenFrame {
  double milliseconds = 0;  ///< from the request to the decoded picture
  glm::ivec2 size{0};
};

/// A request of the page about a scene.
struct ViewRequest {
  std::string page = {};  ///< its random name
  std::uint64_t number = 0;
  nlohmann::json camera = {};  ///< null, a camera's name, or a camera as scene files have it
  SceneChanges changes = {};
  nlohmann::json gesture = {};  ///< null, or one that moveCamera() or moveLight() knows
  glm::ivec2 size{640, 360};    ///< pixels of the whole picture
  bool is_moving = false;
  std::optional<SeenFrame> seen = {};  ///< the last frame of the motion
  int samples = 1;
  std::string layer = "color";
  std::uint32_t light = 0;                ///< whose shadow map is shown
  glm::dvec2 at{0.5};                     ///< picked, in shares of the picture
  std::vector<std::string> outputs = {};  ///< to be saved: "scene", "png", "exr"
};

/// Reads a request's body. Throws InputError for what isn't JSON, or has values of other kinds or sizes.
ViewRequest readRequest(const std::string& body);

}  // namespace luciole
