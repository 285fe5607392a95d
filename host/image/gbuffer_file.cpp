#include "image/gbuffer_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "error.hpp"
#include "image/camera_header.hpp"
#include "image/oiio.hpp"
#include "image/picture_file.hpp"
#include "machine_memory.hpp"
#include "raster/packed_normal.hpp"

namespace luciole {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The three components that a group holds for one pixel, and back. `at` is GBuffer::index, `stride`
/// GBuffer::pixels.
glm::vec3 load(const Plane& group, std::size_t at, std::size_t stride) {
  return {group[at], group[at + stride], group[at + 2 * stride]};
}
void store(Plane& group, std::size_t at, std::size_t stride, glm::vec3 value) {
  for (int c = 0; c < 3; ++c) group[at + c * stride] = value[c];
}

/// What rounding a unit vector's components, and making it unit in float, leaves of its length at the most.
constexpr double kUnitError = 1e-6;

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
  if (!gbuffer.facet.empty()) addChannels(names, "Ng", "XYZ");
  if (!gbuffer.lift.empty()) names.push_back("lift");
  return names;
}

/// A file's pixels and where its channels lie in them.
struct Pixels {
  std::string path;
  int width = 0;
  std::size_t count = 0;
  std::vector<std::string> channels;
  /// Made unwritten, so that what a damaged file promises and doesn't hold takes no memory.
  std::unique_ptr<float[]> values;

  /// The place of a channel, case ignored; -1: none.
  int find(const std::string& name) const {
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (OIIO::Strutil::iequals(channels[i], name)) return int(i);
    }
    return -1;
  }

  /// The places of three channels; all -1 if the file has none of them. Throws InputError if it has some.
  std::array<int, 3> findThree(const std::string& layer, const char* components) const {
    std::vector<std::string> names;
    addChannels(names, layer, components);
    const std::array<int, 3> places{find(names[0]), find(names[1]), find(names[2])};
    const auto missing = std::find(places.begin(), places.end(), -1);
    if (missing != places.end() && std::count(places.begin(), places.end(), -1) < 3) {
      throw InputError(fmt::format("{}: channel {}: missing, expected {} {} {}", path,
                                   names[missing - places.begin()], names[0], names[1], names[2]));
    }
    return places;
  }

  float value(std::size_t pixel, int place) const { return values[pixel * channels.size() + place]; }
  glm::vec3 three(std::size_t pixel, const std::array<int, 3>& places) const {
    return {value(pixel, places[0]), value(pixel, places[1]), value(pixel, places[2])};
  }

  /// A reflectance, radiance, exponent or lift: below 0, as filters with negative lobes leave it, is 0. Not
  /// finite: InputError.
  float coefficient(std::size_t pixel, int place) const {
    const float v = value(pixel, place);
    if (!std::isfinite(v)) {
      throw InputError(fmt::format("{}: channel {}: pixel {},{} is {}, expected a finite number", path,
                                   channels[place], pixel % width, pixel / width, v));
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
std::vector<glm::dvec3> visiblePoints(const Pixels& file, const std::array<int, 3>& position,
                                      const std::array<int, 3>& normal) {
  std::vector<glm::dvec3> points;
  if (!isThere(position)) return points;
  for (std::size_t p = 0; p < file.count; p += 1 + file.count / 1000) {
    const glm::vec3 point = file.three(p, position), n = file.three(p, normal);
    if (isFinite(point) && isFinite(n) && n != glm::vec3(0.0f)) points.push_back(point);
  }
  return points;
}

/// How to find the view-space position and normal of a pixel.
class Surface {
 public:
  Surface(const Pixels& file, const OIIO::ImageSpec& spec, GBuffer& gbuffer) : file_(file) {
    normal_ = file.findThree("N", "XYZ");
    position_ = file.findThree("P", "XYZ");
    facet_ = file.findThree("Ng", "XYZ");
    depth_ = file.find("Z");
    if (!isThere(normal_)) throw InputError(file.path + ": channel N.X: missing, expected N.X N.Y N.Z");
    const auto header = readCamera(spec, file.path, visiblePoints(file, position_, normal_));
    if (header) gbuffer.camera = header->camera;
    gbuffer.knows_camera = header && header->half_extent;
    world_to_view_ = glm::inverse(gbuffer.camera.camera_to_world);

    const auto view_position = file.findThree("Pcam", "XYZ"), view_normal = file.findThree("Ncam", "XYZ");
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
    picture_size_ = {spec.full_width, spec.full_height};
    first_pixel_ = {spec.x - spec.full_x, spec.y - spec.full_y};
  }

  /// False for background.
  bool at(std::size_t pixel, glm::vec3& position, glm::vec3& normal) const {
    normal = file_.three(pixel, normal_);
    if (!isFinite(normal) || normal == glm::vec3(0.0f)) return false;
    if (depth_ >= 0 && !std::isfinite(file_.value(pixel, depth_))) return false;
    position = isThere(position_) ? file_.three(pixel, position_) : unproject(pixel);
    if (!isFinite(position)) return false;
    if (in_view_space_) {
      // Ours are unit already and stay to the bit what they were; other programs may have changed them.
      const double length = glm::length(glm::dvec3(normal));
      if (std::abs(length - 1) > kUnitError) normal = glm::vec3(glm::dvec3(normal) / length);
      return true;
    }
    if (isThere(position_)) position = glm::vec3(world_to_view_ * glm::dvec4(position, 1.0));
    normal = glm::vec3(glm::normalize(glm::dmat3(world_to_view_) * glm::dvec3(normal)));
    return true;
  }

  bool hasFacets() const { return isThere(facet_); }

  /// The facet of a pixel whose view-space normal is given. What addRow() wrote comes back to the bit, though
  /// world space and float lie between, see packNormal().
  std::uint32_t facetAt(std::size_t pixel, glm::vec3 normal) const {
    const glm::vec3 facet = file_.three(pixel, facet_);
    if (!isFinite(facet) || facet == glm::vec3(0.0f)) return packNormal(normal);
    return packNormal(glm::dmat3(world_to_view_) * glm::dvec3(facet));
  }

 private:
  /// The view-space point that lies at depth |Z| behind the centre of a pixel; not finite for Z = 0.
  glm::vec3 unproject(std::size_t pixel) const {
    const glm::dvec2 centre{double(pixel % file_.width) + first_pixel_.x + 0.5,
                            double(pixel / file_.width) + first_pixel_.y + 0.5};
    const double depth = std::abs(file_.value(pixel, depth_));
    if (depth == 0) return glm::vec3(kInfinity);
    const glm::dvec2 screen = (2.0 * centre / glm::dvec2(picture_size_) - 1.0) * half_extent_;
    const double scale = parallel_ ? 1.0 : depth;
    return {screen.x * scale, -screen.y * scale, -depth};
  }

  const Pixels& file_;
  std::array<int, 3> position_{};
  std::array<int, 3> normal_{};
  std::array<int, 3> facet_{};
  int depth_ = -1;
  bool in_view_space_ = false;
  glm::dmat4 world_to_view_{1.0};
  bool parallel_ = false;
  glm::dvec2 half_extent_{0.0};
  glm::ivec2 picture_size_{0};
  glm::ivec2 first_pixel_{0};
};

/// All groups but facets and lifts, showing nothing.
GBuffer emptyGBuffer(const OIIO::ImageSpec& spec) {
  GBuffer gbuffer;
  gbuffer.width = spec.width;
  gbuffer.height = spec.height;
  gbuffer.tiles_x = (spec.width + kTileSize - 1) / kTileSize;
  gbuffer.tiles_y = (spec.height + kTileSize - 1) / kTileSize;
  gbuffer.picture_size = {spec.full_width, spec.full_height};
  gbuffer.crop_origin = {spec.x - spec.full_x, spec.y - spec.full_y};
  const std::size_t stride = gbuffer.pixels();
  for (Plane* group :
       {&gbuffer.position, &gbuffer.normal, &gbuffer.diffuse, &gbuffer.ambient, &gbuffer.emission}) {
    group->assign(3 * stride, 0.0f);
  }
  gbuffer.specular.assign(4 * stride, 0.0f);
  std::fill(gbuffer.position.begin() + std::ptrdiff_t(2 * stride), gbuffer.position.end(), -kInfinity);
  return gbuffer;
}

/// Adds a row of pixels, channels as channelNames() says.
void addRow(const GBuffer& gbuffer, int y, std::vector<float>& values) {
  const glm::dmat4& to_world = gbuffer.camera.camera_to_world;
  const std::size_t stride = gbuffer.pixels();
  const auto add = [&](glm::vec3 v) { values.insert(values.end(), {v.x, v.y, v.z}); };
  for (int x = 0; x < gbuffer.width; ++x) {
    const std::size_t at = gbuffer.index(x, y);
    const glm::vec3 position = load(gbuffer.position, at, stride), normal = load(gbuffer.normal, at, stride);
    // Background has no place in the world; its 0 is told from a surface by N = 0 and Z = +inf.
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
    if (!gbuffer.facet.empty()) {
      const bool shows = normal != glm::vec3(0.0f);
      add(shows ? glm::vec3(glm::dmat3(to_world) * unpackNormal(gbuffer.facet[at])) : glm::vec3(0.0f));
    }
    if (!gbuffer.lift.empty()) values.push_back(gbuffer.lift[at]);
  }
}

}  // namespace

void writeGBuffer(const GBuffer& gbuffer, const std::string& path, const Metadata& metadata,
                  const std::string& format) {
  if (outputFormat(path, format).extension != "exr") {
    throw InputError(path + ": a G-buffer has many float channels, expected .exr");
  }
  OIIO::ImageSpec spec(gbuffer.width, gbuffer.height, 0, OIIO::TypeDesc::FLOAT);
  spec.channelnames = channelNames(gbuffer);
  spec.nchannels = int(spec.channelnames.size());
  setWindow(gbuffer.crop_origin, gbuffer.picture_size, spec);
  spec.attribute("compression", "zip");
  for (const auto& [name, value] : metadata) spec.attribute(name, value);
  writeCamera(gbuffer.camera, gbuffer.picture_size, spec);

  PictureFile file(path, "exr", spec);
  // Some rows at a time: all of them together would take more memory than the G-buffer.
  constexpr int kRows = 64;
  std::vector<float> values;
  for (int y = 0; y < gbuffer.height; y += kRows) {
    const int end = std::min(y + kRows, gbuffer.height);
    values.clear();
    for (int row = y; row < end; ++row) addRow(gbuffer, row, values);
    file.write(values.data(), end - y);
  }
  file.close();
}

GBuffer readGBuffer(const std::string& path) {
  const auto input = openPicture(path, path);
  const OIIO::ImageSpec spec = input->spec();
  Pixels file{path, spec.width, std::size_t(spec.width) * spec.height, spec.channelnames, {}};
  constexpr int kGroupChannels = 3 + 3 + 3 + 4 + 3 + 3 + 1 + 1;
  requireMemory(double(file.count) * (spec.nchannels + kGroupChannels) * sizeof(float), path);
  file.values = std::make_unique_for_overwrite<float[]>(file.count * spec.nchannels);
  readValues(*input, path, OIIO::TypeDesc::FLOAT, file.values.get());

  GBuffer gbuffer = emptyGBuffer(spec);
  const Surface surface(file, spec, gbuffer);
  const auto diffuse = file.findThree("diffuse", "RGB"), specular = file.findThree("specular", "RGB");
  const auto ambient = file.findThree("ambient", "RGB"), emission = file.findThree("emission", "RGB");
  const int shininess = file.find("shininess"), lift = file.find("lift");
  const std::size_t stride = gbuffer.pixels();
  if (surface.hasFacets()) gbuffer.facet.resize(stride);
  if (lift >= 0) gbuffer.lift.resize(stride);
  for (std::size_t p = 0; p < file.count; ++p) {
    glm::vec3 position, normal;
    if (!surface.at(p, position, normal)) continue;
    const std::size_t at = gbuffer.index(int(p % spec.width), int(p / spec.width));
    store(gbuffer.position, at, stride, position);
    store(gbuffer.normal, at, stride, normal);
    const glm::vec3 reflectance = file.color(p, diffuse, glm::vec3(0.8f));
    store(gbuffer.diffuse, at, stride, reflectance);
    store(gbuffer.specular, at, stride, file.color(p, specular, glm::vec3(0.0f)));
    if (shininess >= 0) gbuffer.specular[at + 3 * stride] = file.coefficient(p, shininess);
    store(gbuffer.ambient, at, stride, file.color(p, ambient, reflectance));
    store(gbuffer.emission, at, stride, file.color(p, emission, glm::vec3(0.0f)));
    if (surface.hasFacets()) gbuffer.facet[at] = surface.facetAt(p, normal);
    if (lift >= 0) gbuffer.lift[at] = file.coefficient(p, lift);
  }
  return gbuffer;
}

}  // namespace luciole
