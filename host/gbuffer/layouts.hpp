#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/layers.hpp"

// Finds the channels of a picture file that are planes of a G-buffer, by the names that programs give them.
namespace luciole {

/// The content of a layer of a file. It has three channels, except for depth, shininess, lift and model.
enum class Role : std::uint8_t {
  kPosition,
  kNormal,
  kDepth,
  kDiffuse,
  kSpecular,
  kShininess,
  kAmbient,
  kEmission,
  kGeometricNormal,  ///< the triangle's own
  kUnbentNormal,     ///< see GBuffer::unbent_normal
  kLift,             ///< see raster/lift.hpp
  kModel,            ///< modelNumber() of what surfaces choose
  kViewPosition,     ///< in this program's view space
  kViewNormal,
  kColor,  ///< the picture itself
};
inline constexpr std::size_t kRoleCount = 15;
/// In the order of Role, as messages and --channels have them.
inline constexpr std::array<const char*, kRoleCount> kRoleNames{
    "position",  "normal",  "depth",         "diffuse",          "specular",
    "shininess", "ambient", "emission",      "geometric_normal", "unbent_normal",
    "lift",      "model",   "view_position", "view_normal",      "color"};

constexpr bool isScalar(Role role) {
  return role == Role::kDepth || role == Role::kShininess || role == Role::kLift || role == Role::kModel;
}

/// The space of a file's positions and normals.
enum class FileSpace : std::uint8_t {
  kWorld,
  kCamera,  ///< the eye at the origin, with axes of the program's own choice
};

/// The names of a program's layers. A role may have several names, separated by |. A name matches layers of
/// this name and those that end in "." and the name, after view layers, parts and nested integrators. Case is
/// ignored.
struct Layout {
  const char* program;
  const char* position = "";
  const char* normal = "";
  const char* depth = "";
  const char* diffuse = "";
  const char* specular = "";
  const char* shininess = "";
  const char* ambient = "";
  const char* emission = "";
  const char* geometric_normal = "";
  const char* unbent_normal = "";
  const char* lift = "";
  const char* model = "";
  const char* view_position = "";
  const char* view_normal = "";
  const char* color = "|";              ///< the nameless layer
  FileSpace space = FileSpace::kWorld;  ///< unless the positions tell another
  bool is_albedo = true;                ///< `diffuse` is a reflectance, not light
  bool depth_is_distance = false;       ///< from the eye, rather than along the view axis
};

/// The names in a Layout's "A|B|…", which must outlive the result.
std::vector<std::string_view> splitNames(std::string_view names);

/// All known layouts, this program's own first.
std::span<const Layout> layouts();

/// A layer that was found.
struct FoundLayer {
  std::string name{};                       ///< as the file has it, without components; empty: there is none
  int part = -1;                            ///< in the file; -1: none
  std::array<int, 3> channels{-1, -1, -1};  ///< places in the part; a scalar's is the first
  std::optional<float> constant{};          ///< the number that was typed in place of a layer

  bool isThere() const { return part >= 0; }
};

struct FoundLayers {
  const Layout* layout = nullptr;
  std::array<FoundLayer, kRoleCount> layers;

  const FoundLayer& operator[](Role role) const { return layers[std::size_t(role)]; }
};

/// Layers that the user named, or for shininess a number.
using ChosenLayers = std::map<Role, std::string>;

/// Finds the layers of a file: those that the user chose, and the others by the layout that matches most
/// layers. Throws InputError, in one line that lists the file's channels, if there is neither a position nor
/// a depth, if a name matches several layers, or if a layer lacks components.
FoundLayers findLayers(const std::vector<PicturePart>& parts, const ChosenLayers& chosen,
                       const std::string& path);

}  // namespace luciole
