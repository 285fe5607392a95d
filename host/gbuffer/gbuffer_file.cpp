#include "gbuffer/gbuffer_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/machine_memory.hpp"
#include "base/text_file.hpp"
#include "gbuffer/camera_header.hpp"
#include "gbuffer/packed_normal.hpp"
#include "image/file_format.hpp"
#include "image/layers.hpp"

namespace luciole {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Reads and writes the three components of a pixel in a group. `at` is GBuffer::index, `stride`
/// GBuffer::pixels.
glm::vec3 load(const Plane& group, std::size_t at, std::size_t stride) {
  return {group[at], group[at + stride], group[at + 2 * stride]};
}
void store(Plane& group, std::size_t at, std::size_t stride, glm::vec3 value) {
  for (int c = 0; c < 3; ++c) group[at + c * stride] = value[c];
}

/// How far from 1 a normal's length may be. The raster's are rounded once, and off by 2⁻²⁴ at most; what
/// bounds a picture's error allows for this (LIGHT_ROUNDING in kernels/clustered_light.cl).
constexpr double kUnitError = 3 * 0x1p-24;

bool isFinite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void addChannels(std::vector<std::string>& names, const std::string& layer, const char* components) {
  for (const char* c = components; *c; ++c) names.push_back(fmt::format("{}.{}", layer, *c));
}

std::vector<std::string> channelNames(const GBuffer& gbuffer) {
  std::vector<std::string> names;
  addChannels(names, "P", "XYZ");
  addChannels(names, "N", "XYZ");
  names.push_back("Z");
  addChannels(names, "Pcam", "XYZ");
  addChannels(names, "Ncam", "XYZ");
  addChannels(names, "diffuse", "RGB");
  if (!gbuffer.specular.empty()) {
    addChannels(names, "specular", "RGB");
    names.push_back("shininess");
  }
  if (!gbuffer.ambient.empty()) addChannels(names, "ambient", "RGB");
  if (!gbuffer.emission.empty()) addChannels(names, "emission", "RGB");
  if (!gbuffer.geometric_normal.empty()) addChannels(names, "Ng", "XYZ");
  if (!gbuffer.lift.empty()) names.push_back("lift");
  return names;
}

/// A file's pixels by the names of its channels.
struct Channels {
  const LayerFile& file;

  std::size_t count() const { return std::size_t(file.size.x) * file.size.y; }

  /// The place of a channel, case ignored; -1: none.
  int find(const std::string& name) const {
    for (std::size_t i = 0; i < file.channels.size(); ++i)
      if (equalIgnoringCase(file.channels[i], name)) return int(i);
    return -1;
  }

  /// The places of three channels; all -1 if the file has none of them. Throws InputError if it has some.
  std::array<int, 3> findThree(const std::string& layer, const char* components) const {
    std::vector<std::string> names;
    addChannels(names, layer, components);
    const std::array<int, 3> places{find(names[0]), find(names[1]), find(names[2])};
    const auto missing = std::find(places.begin(), places.end(), -1);
    if (missing != places.end() && std::count(places.begin(), places.end(), -1) < 3) {
      throw InputError(fmt::format("{}: channel {}: missing, expected {} {} {}", file.path,
                                   names[missing - places.begin()], names[0], names[1], names[2]));
    }
    return places;
  }

  float value(std::size_t pixel, int place) const {
    return file.values[pixel * file.channels.size() + place];
  }
  glm::vec3 three(std::size_t pixel, const std::array<int, 3>& places) const {
    return {value(pixel, places[0]), value(pixel, places[1]), value(pixel, places[2])};
  }

  /// A reflectance, radiance, exponent or lift. A value below 0, as filters with negative lobes produce,
  /// becomes 0. Throws InputError where the value isn't finite.
  float coefficient(std::size_t pixel, int place) const {
    const float v = value(pixel, place);
    if (!std::isfinite(v)) {
      throw InputError(fmt::format("{}: channel {}: pixel {},{} is {}, expected a finite number", file.path,
                                   file.channels[place], pixel % file.size.x, pixel / file.size.x, v));
    }
    return v < 0.0f ? 0.0f : v;
  }
  glm::vec3 color(std::size_t pixel, const std::array<int, 3>& places, glm::vec3 fallback) const {
    if (places[0] < 0) return fallback;
    return {coefficient(pixel, places[0]), coefficient(pixel, places[1]), coefficient(pixel, places[2])};
  }
};

bool isThere(const std::array<int, 3>& places) { return places[0] >= 0; }

/// World positions of up to about a thousand pixels that show something.
std::vector<glm::dvec3> visiblePoints(const Channels& channels, const std::array<int, 3>& position,
                                      const std::array<int, 3>& normal) {
  std::vector<glm::dvec3> points;
  if (!isThere(position)) return points;
  for (std::size_t p = 0; p < channels.count(); p += 1 + channels.count() / 1000) {
    const glm::vec3 point = channels.three(p, position), n = channels.three(p, normal);
    if (isFinite(point) && isFinite(n) && n != glm::vec3(0.0f)) points.push_back(point);
  }
  return points;
}

/// Finds the view-space positions and normals of a file's pixels.
class Surface {
 public:
  Surface(const Channels& channels, GBuffer& gbuffer) : channels_(channels) {
    const LayerFile& file = channels.file;
    normal_ = channels.findThree("N", "XYZ");
    position_ = channels.findThree("P", "XYZ");
    geometric_normal_ = channels.findThree("Ng", "XYZ");
    depth_ = channels.find("Z");
    if (!isThere(normal_)) throw InputError(file.path + ": channel N.X: missing, expected N.X N.Y N.Z");
    const auto header = readCamera(file.attributes, file.picture_size, file.path,
                                   visiblePoints(channels, position_, normal_));
    if (header) gbuffer.camera = header->camera;
    gbuffer.knows_camera = header && header->half_extent;
    world_to_view_ = glm::inverse(gbuffer.camera.camera_to_world);

    const auto view_position = channels.findThree("Pcam", "XYZ"),
               view_normal = channels.findThree("Ncam", "XYZ");
    if (header && header->is_exact && isThere(view_position) && isThere(view_normal)) {
      position_ = view_position;
      normal_ = view_normal;
      in_view_space_ = true;
    }
    if (isThere(position_)) return;
    if (depth_ < 0)
      throw InputError(file.path + ": channel P.X: missing, expected P.X P.Y P.Z, or Z and a camera");
    if (!header || !header->half_extent) {
      throw InputError(
          file.path +
          ": attribute worldToNDC: Z without P needs worldToCamera and worldToNDC of a centred projection");
    }
    parallel_ = header->camera.orthographic;
    half_extent_ = *header->half_extent;
  }

  /// False for background.
  bool at(std::size_t pixel, glm::vec3& position, glm::vec3& normal) const {
    normal = channels_.three(pixel, normal_);
    if (!isFinite(normal) || normal == glm::vec3(0.0f)) return false;
    if (depth_ >= 0 && !std::isfinite(channels_.value(pixel, depth_))) return false;
    position = isThere(position_) ? channels_.three(pixel, position_) : unproject(pixel);
    if (!isFinite(position)) return false;
    if (in_view_space_) {
      // Normals that this program wrote must keep their bits; another program may have changed them.
      const double length = glm::length(glm::dvec3(normal));
      if (std::abs(length - 1) > kUnitError) normal = glm::vec3(glm::dvec3(normal) / length);
      return true;
    }
    if (isThere(position_)) position = glm::vec3(world_to_view_ * glm::dvec4(position, 1.0));
    normal = glm::vec3(glm::normalize(glm::dmat3(world_to_view_) * glm::dvec3(normal)));
    return true;
  }

  bool hasGeometricNormals() const { return isThere(geometric_normal_); }

  /// The packed geometric normal of a pixel, view space; `normal` where the file has none there. What
  /// addRow() wrote is restored to the bit, although it went through world space and float (see packNormal).
  std::uint32_t geometricNormalAt(std::size_t pixel, glm::vec3 normal) const {
    const glm::vec3 geometric_normal = channels_.three(pixel, geometric_normal_);
    if (!isFinite(geometric_normal) || geometric_normal == glm::vec3(0.0f)) return packNormal(normal);
    return packNormal(glm::dmat3(world_to_view_) * glm::dvec3(geometric_normal));
  }

 private:
  /// The view-space point that lies at depth |Z| behind the centre of a pixel; not finite for Z = 0.
  glm::vec3 unproject(std::size_t pixel) const {
    const std::size_t column = pixel % channels_.file.size.x, row = pixel / channels_.file.size.x;
    const glm::dvec2 centre{double(column) + channels_.file.crop_origin.x + 0.5,
                            double(row) + channels_.file.crop_origin.y + 0.5};
    const double depth = std::abs(channels_.value(pixel, depth_));
    if (depth == 0) return glm::vec3(kInfinity);
    const glm::dvec2 screen = (2.0 * centre / glm::dvec2(channels_.file.picture_size) - 1.0) * half_extent_;
    const double scale = parallel_ ? 1.0 : depth;
    return {screen.x * scale, -screen.y * scale, -depth};
  }

  const Channels& channels_;
  std::array<int, 3> position_{};
  std::array<int, 3> normal_{};
  std::array<int, 3> geometric_normal_{};
  int depth_ = -1;
  bool in_view_space_ = false;
  glm::dmat4 world_to_view_{1.0};
  bool parallel_ = false;
  glm::dvec2 half_extent_{0.0};
};

/// A G-buffer of a file's size that shows nothing, with all groups but geometric normals and lifts.
GBuffer emptyGBuffer(const LayerFile& file) {
  GBuffer gbuffer;
  gbuffer.width = file.size.x;
  gbuffer.height = file.size.y;
  gbuffer.tiles_x = (file.size.x + kTileSize - 1) / kTileSize;
  gbuffer.tiles_y = (file.size.y + kTileSize - 1) / kTileSize;
  gbuffer.picture_size = file.picture_size;
  gbuffer.crop_origin = file.crop_origin;
  const std::size_t stride = gbuffer.pixels();
  for (Plane* group : {&gbuffer.position, &gbuffer.normal, &gbuffer.diffuse, &gbuffer.ambient}) {
    group->assign(3 * stride, 0.0f);
  }
  gbuffer.specular.assign(4 * stride, 0.0f);
  std::fill(gbuffer.position.begin() + std::ptrdiff_t(2 * stride), gbuffer.position.end(), -kInfinity);
  return gbuffer;
}

/// Appends a row of pixels, channels as in channelNames().
void addRow(const GBuffer& gbuffer, int y, std::vector<float>& values) {
  const glm::dmat4& to_world = gbuffer.camera.camera_to_world;
  const std::size_t stride = gbuffer.pixels();
  const auto add = [&](glm::vec3 v) { values.insert(values.end(), {v.x, v.y, v.z}); };
  for (int x = 0; x < gbuffer.width; ++x) {
    const std::size_t at = gbuffer.index(x, y);
    const glm::vec3 position = load(gbuffer.position, at, stride), normal = load(gbuffer.normal, at, stride);
    // Background has no world position and gets 0; N = 0 and Z = +inf distinguish it from a surface at 0.
    add(isFinite(position) ? glm::vec3(to_world * glm::dvec4(position, 1.0)) : glm::vec3(0.0f));
    add(glm::vec3(glm::dmat3(to_world) * glm::dvec3(normal)));
    values.push_back(-position.z);
    add(position);
    add(normal);
    add(load(gbuffer.diffuse, at, stride));
    if (!gbuffer.specular.empty()) {
      add(load(gbuffer.specular, at, stride));
      values.push_back(gbuffer.specular[at + 3 * stride]);
    }
    if (!gbuffer.ambient.empty()) add(load(gbuffer.ambient, at, stride));
    if (!gbuffer.emission.empty()) add(load(gbuffer.emission, at, stride));
    if (!gbuffer.geometric_normal.empty()) {
      const bool shows = normal != glm::vec3(0.0f);
      add(shows ? glm::vec3(glm::dmat3(to_world) * unpackNormal(gbuffer.geometric_normal[at]))
                : glm::vec3(0.0f));
    }
    if (!gbuffer.lift.empty()) values.push_back(gbuffer.lift[at]);
  }
}

}  // namespace

void writeGBuffer(const GBuffer& gbuffer, const std::string& path, const Metadata& metadata,
                  const std::string& format, const std::string& compression) {
  if (outputFormat(path, format).extension != "exr") {
    throw InputError(path + ": a G-buffer has many float channels, expected .exr");
  }
  const WriteOptions options{.format = "exr",
                             .compression = compression,
                             .picture_size = gbuffer.picture_size,
                             .crop_origin = gbuffer.crop_origin,
                             .exr = cameraAttributes(gbuffer.camera, gbuffer.picture_size)};
  Image rows{gbuffer.width, 0, channelNames(gbuffer), {}};
  ImageWriter file(path, gbuffer.width, gbuffer.height, rows.channels, metadata, options);
  // Some rows at a time: all of them together would take more memory than the G-buffer.
  constexpr int kRows = 64;
  for (int y = 0; y < gbuffer.height; y += kRows) {
    rows.height = std::min(kRows, gbuffer.height - y);
    rows.pixels.clear();
    for (int row = y; row < y + rows.height; ++row) addRow(gbuffer, row, rows.pixels);
    file.write(rows);
  }
  file.close();
}

GBuffer readGBuffer(const std::string& path) {
  const LayerFile file = readLayers(path);
  const Channels channels{file};
  constexpr int kGroupChannels = 3 + 3 + 3 + 4 + 3 + 3 + 1 + 1;
  requireMemory(double(channels.count()) * kGroupChannels * sizeof(float), path);

  GBuffer gbuffer = emptyGBuffer(file);
  const Surface surface(channels, gbuffer);
  const auto diffuse = channels.findThree("diffuse", "RGB"), specular = channels.findThree("specular", "RGB");
  const auto ambient = channels.findThree("ambient", "RGB"), emission = channels.findThree("emission", "RGB");
  const int shininess = channels.find("shininess"), lift = channels.find("lift");
  const std::size_t stride = gbuffer.pixels();
  if (surface.hasGeometricNormals()) gbuffer.geometric_normal.resize(stride);
  const bool glows = emission[0] >= 0;
  if (glows) gbuffer.emission.assign(3 * stride, 0.0f);
  if (lift >= 0) gbuffer.lift.resize(stride);
  for (std::size_t p = 0; p < channels.count(); ++p) {
    glm::vec3 position, normal;
    if (!surface.at(p, position, normal)) continue;
    const std::size_t at = gbuffer.index(int(p % file.size.x), int(p / file.size.x));
    store(gbuffer.position, at, stride, position);
    store(gbuffer.normal, at, stride, normal);
    const glm::vec3 reflectance = channels.color(p, diffuse, glm::vec3(0.8f));
    store(gbuffer.diffuse, at, stride, reflectance);
    store(gbuffer.specular, at, stride, channels.color(p, specular, glm::vec3(0.0f)));
    if (shininess >= 0) gbuffer.specular[at + 3 * stride] = channels.coefficient(p, shininess);
    store(gbuffer.ambient, at, stride, channels.color(p, ambient, reflectance));
    if (glows) store(gbuffer.emission, at, stride, channels.color(p, emission, glm::vec3(0.0f)));
    if (surface.hasGeometricNormals()) gbuffer.geometric_normal[at] = surface.geometricNormalAt(p, normal);
    if (lift >= 0) gbuffer.lift[at] = channels.coefficient(p, lift);
  }
  return gbuffer;
}

}  // namespace luciole
