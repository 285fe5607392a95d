#include "gbuffer/gbuffer_input.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/machine_memory.hpp"
#include "base/picture_size.hpp"
#include "base/text_file.hpp"
#include "base/utf8.hpp"
#include "gbuffer/camera_header.hpp"
#include "gbuffer/file_view.hpp"
#include "gbuffer/layer_planes.hpp"
#include "gbuffer/packed_normal.hpp"
#include "gbuffer/rebuild_normals.hpp"
#include "kernels/shared.h"
#include "luciole/error.hpp"
#include "luciole/gbuffer_file.hpp"
#include "luciole/planes.hpp"
#include "scene/models.hpp"

namespace luciole {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Whether a depth means infinity: Blender writes 1e10, Arnold 1e30. Nothing of a scene is farther than 1e18.
bool isFar(float depth) { return std::abs(depth) == 1e10f || !(std::abs(depth) < 1e20f); }

/// Normals whose lengths differ from 1 by less keep their bits. The rasterizer's are rounded once, and off by
/// 2⁻²⁴ at most. The bounds of light errors allow for this much (LIGHT_ROUNDING in
/// kernels/clusters/clustered_light.cl).
constexpr double kUnitError = 3 * 0x1p-24;

/// The numbers of background pixels by reason, counted by all threads.
struct Holes {
  std::atomic<std::size_t> zero{0}, infinite{0}, nan{0}, far{0};

  std::size_t count() const { return zero + infinite + nan + far; }
  std::string reasons() const {
    std::vector<std::string> reasons;
    for (const auto& [count, reason] : {std::pair(zero.load(), "zero"), std::pair(nan.load(), "NaN"),
                                        std::pair(infinite.load(), "infinite"), std::pair(far.load(), "far")})
      if (count > 0) reasons.emplace_back(reason);
    return fmt::format("{}", fmt::join(reasons, ", "));
  }
};

/// A reflectance, radiance, exponent or lift. A value below 0, as filters with negative lobes produce,
/// becomes 0. Throws InputError where the value isn't finite.
float coefficient(const LayerPlanes& layer, std::size_t pixel, int component, const PicturePart& part,
                  const std::string& path) {
  const float v = layer.value(pixel, component);
  if (!std::isfinite(v)) {
    const std::size_t width = std::size_t(part.size.x);
    throw InputError(fmt::format("{}: channel {}: pixel {},{} is {}, expected a finite number", path,
                                 layer.names[component], pixel % width, pixel / width, v));
  }
  return v < 0.0f ? 0.0f : v;
}

/// Turns a file's layers into a G-buffer.
class Conversion {
 public:
  Conversion(const std::string& path, const GBufferRequest& request)
      : path_(path),
        request_(request),
        reader_(path),
        found_(findLayers(reader_.parts(), request.layers, path)) {
    const FoundLayer& main =
        found_[Role::kPosition].isThere() ? found_[Role::kPosition] : found_[Role::kDepth];
    part_ = reader_.parts()[std::size_t(main.part)];
    // Some writers put attributes of all parts into the first part alone.
    for (const PicturePart& part : reader_.parts()) {
      ExrAttributes& all = part_.attributes;
      all.texts.insert(all.texts.end(), part.attributes.texts.begin(), part.attributes.texts.end());
      all.matrices.insert(all.matrices.end(), part.attributes.matrices.begin(),
                          part.attributes.matrices.end());
    }
    readPlanes();
    if (glm::any(glm::greaterThan(glm::abs(part_.crop_origin), glm::ivec2(kLargestSide))))
      throw InputError(
          fmt::format("{}: the data window begins ({}, {}) pixels from the display window, expected {} "
                      "at most",
                      path, part_.crop_origin.x, part_.crop_origin.y, kLargestSide));
    findCamera();
  }

  GBufferInput convert() {
    GBufferInput input;
    GBuffer& gbuffer = input.gbuffer;
    makeEmpty(gbuffer);
    fillGeometry(gbuffer);
    if (!normal_) edges_ = dropEdges(gbuffer);
    fillMaterials(gbuffer);
    if (request_.color) input.color = color();
    input.notes = notes();
    return input;
  }

 private:
  std::size_t pixels() const { return std::size_t(part_.size.x) * std::size_t(part_.size.y); }
  LayerPlanes planes(Role role) const { return reader_.planes(found_[role]); }

  /// Whether the file's specular layer counts.
  bool shines() const {
    return found_.layout == &layouts().front() || found_[Role::kShininess].isThere() ||
           found_[Role::kShininess].constant;
  }

  /// Whether positions and normals are read that are in this program's view space already.
  bool hasOwnView() const {
    if (!found_[Role::kViewPosition].isThere() || !found_[Role::kViewNormal].isThere() ||
        request_.layers.contains(Role::kPosition) || request_.layers.contains(Role::kNormal) ||
        request_.camera_to_world)
      return false;
    const auto header =
        readCamera(part_.attributes, part_.picture_size, path_, {}, part_.display.pixel_aspect);
    return header && header->is_exact;
  }

  void readPlanes() {
    const bool own_view = hasOwnView();
    const Role position = own_view ? Role::kViewPosition : Role::kPosition,
               normal = own_view ? Role::kViewNormal : Role::kNormal;
    std::vector<FoundLayer> wanted{found_[position], found_[normal]};
    for (std::size_t role = 0; role < kRoleCount; ++role) {
      if (Role(role) == Role::kPosition || Role(role) == Role::kNormal || Role(role) == Role::kViewPosition ||
          Role(role) == Role::kViewNormal)
        continue;
      if (Role(role) == Role::kColor && !request_.color) continue;
      if (Role(role) == Role::kSpecular && !shines()) continue;
      wanted.push_back(found_.layers[role]);
    }
    if (request_.color) {
      if (!found_[Role::kColor].isThere())
        throw InputError(path_ +
                         ": no layer that is known to hold the picture; request.layers "
                         "color=NAME says which does");
      alpha_layer_ = alphaOf(found_[Role::kColor]);
      wanted.push_back(alpha_layer_);
    }
    reader_.read(wanted);
    position_ = planes(position);
    normal_ = planes(normal);
    depth_ = planes(Role::kDepth);
    own_view_ = own_view;
  }

  /// The channel A beside a picture's R, G and B, if there is one.
  FoundLayer alphaOf(const FoundLayer& color) const {
    FoundLayer alpha;
    const std::vector<std::string>& channels = reader_.parts()[std::size_t(color.part)].channels;
    const std::string& red = channels[std::size_t(color.channels[0])];
    const std::string wanted = red.substr(0, red.size() - 1) + "A";
    for (std::size_t c = 0; c < channels.size(); ++c)
      if (equalIgnoringCase(channels[c], wanted))
        alpha = {.name = wanted, .part = color.part, .channels = {int(c), -1, -1}};
    return alpha;
  }

  /// Positions of up to about a thousand pixels that show something, as the file has them.
  std::vector<SeenPoint> seenPoints() const {
    std::vector<SeenPoint> points;
    if (!position_) return points;
    for (std::size_t p = 0; p < pixels(); p += 1 + pixels() / 1000) {
      const glm::vec3 point = position_.vector(p), normal = normal_ ? normal_.vector(p) : point;
      const bool is_far = depth_ && isFar(depth_.value(p));
      if (!isFinite(point) || !isFinite(normal) || normal == glm::vec3(0.0f) || is_far) continue;
      points.push_back({point, screenOf(p)});
    }
    return points;
  }

  /// The centre of a pixel on the screen (see SeenPoint).
  glm::dvec2 screenOf(std::size_t pixel) const {
    const std::size_t width = std::size_t(part_.size.x), column = pixel % width, row = pixel / width;
    const glm::dvec2 centre{double(column) + part_.crop_origin.x + 0.5,
                            double(row) + part_.crop_origin.y + 0.5};
    const glm::dvec2 screen = 2.0 * centre / glm::dvec2(part_.picture_size) - 1.0;
    return {screen.x, -screen.y};
  }

  void findCamera() {
    const std::vector<SeenPoint> points = own_view_ ? std::vector<SeenPoint>() : seenPoints();
    view_ = findView({.path = path_,
                      .attributes = part_.attributes,
                      .picture_size = part_.picture_size,
                      .pixel_aspect = part_.display.pixel_aspect,
                      .points = points,
                      .usual = found_.layout->space,
                      .space = request_.space,
                      .camera_to_world = request_.camera_to_world,
                      .camera = request_.camera,
                      .has_positions = bool(position_),
                      .has_view_space = own_view_});
  }

  /// A G-buffer of the file's size that shows nothing, with the groups that it will have.
  void makeEmpty(GBuffer& gbuffer) const {
    const bool knows_unbent = found_[Role::kUnbentNormal].isThere();
    constexpr int kGroupChannels = 3 + 3 + 3 + 4 + 3 + 3 + 1 + 1 + 1;
    requireMemory(double(pixels()) * kGroupChannels * sizeof(float), path_);
    gbuffer.width = part_.size.x;
    gbuffer.height = part_.size.y;
    gbuffer.tiles_x = (part_.size.x + kTileSize - 1) / kTileSize;
    gbuffer.tiles_y = (part_.size.y + kTileSize - 1) / kTileSize;
    gbuffer.picture_size = part_.picture_size;
    gbuffer.crop_origin = part_.crop_origin;
    gbuffer.display = part_.display;
    gbuffer.camera = view_.camera;
    gbuffer.knows_camera = view_.knows_camera;
    allocatePlanes({.specular = true,
                    .ambient = true,
                    .emission = found_[Role::kEmission].isThere(),
                    .geometric_normal = found_[Role::kGeometricNormal].isThere() && !knows_unbent,
                    .unbent_normal = knows_unbent,
                    .lift = found_[Role::kLift].isThere(),
                    .model = found_[Role::kModel].isThere()},
                   gbuffer);
  }

  void fillGeometry(GBuffer& gbuffer) {
    const std::size_t stride = gbuffer.pixels();
    tbb::parallel_for(0, gbuffer.height, [&](int y) {
      for (int x = 0; x < gbuffer.width; ++x) {
        const std::size_t pixel = std::size_t(y) * gbuffer.width + x, place = gbuffer.index(x, y);
        glm::vec3 position, normal{0.0f};
        if (!surfaceAt(pixel, position, normal)) continue;
        storePixel(position, place, stride, gbuffer.position);
        storePixel(normal, place, stride, gbuffer.normal);
      }
    });
  }

  /// The view-space position and normal of a pixel. False where it shows nothing.
  bool surfaceAt(std::size_t pixel, glm::vec3& position, glm::vec3& normal) {
    const auto isHole = [&](glm::vec3 v, bool zero_counts) {
      if (std::isnan(v.x) || std::isnan(v.y) || std::isnan(v.z)) return ++holes_.nan;
      if (!isFinite(v)) return ++holes_.infinite;
      return v == glm::vec3(0.0f) && zero_counts ? ++holes_.zero : std::size_t(0);
    };
    if (normal_ && isHole(normal = normal_.vector(pixel), true)) return false;
    if (depth_) {
      const float depth = depth_.value(pixel);
      if (isHole(glm::vec3(depth), !position_)) return false;
      if (isFar(depth) && ++holes_.far) return false;
    }
    position = position_ ? position_.vector(pixel) : unproject(pixel);
    if (isHole(position, !normal_)) return false;
    if (view_.in_view_space) {
      // Normals that this program wrote must keep their bits; another program may have changed them.
      const double length = glm::length(glm::dvec3(normal));
      if (std::abs(length - 1) > kUnitError) normal = glm::vec3(glm::dvec3(normal) / length);
      return true;
    }
    if (position_) position = glm::vec3(view_.to_view * glm::dvec4(position, 1.0));
    if (normal_) normal = glm::vec3(glm::normalize(glm::dmat3(view_.to_view) * glm::dvec3(normal)));
    return true;
  }

  /// The view-space point behind the centre of a pixel.
  glm::vec3 unproject(std::size_t pixel) const {
    const glm::dvec2 on_screen = (screenOf(pixel) - view_.camera.shift) * view_.half_extent;
    double depth = std::abs(depth_.value(pixel));
    if (view_.camera.orthographic) return glm::vec3(glm::dvec3(on_screen, -depth));
    if (found_.layout->depth_is_distance) depth /= glm::length(glm::dvec3(on_screen, 1.0));
    return glm::vec3(glm::dvec3(on_screen * depth, -depth));
  }

  /// Rebuilds normals, and has pixels without one show nothing. Returns how many.
  static std::size_t dropEdges(GBuffer& gbuffer) {
    const std::size_t edges = rebuildNormals(gbuffer), stride = gbuffer.pixels();
    for (std::size_t place = 0; place < stride; ++place) {
      const bool has_normal = gbuffer.normal[place] != 0 || gbuffer.normal[place + stride] != 0 ||
                              gbuffer.normal[place + 2 * stride] != 0;
      if (!has_normal) storePixel({0, 0, -kInfinity}, place, stride, gbuffer.position);
    }
    return edges;
  }

  void fillMaterials(GBuffer& gbuffer) const {
    const LayerPlanes diffuse = planes(Role::kDiffuse), ambient = planes(Role::kAmbient),
                      emission = planes(Role::kEmission), shininess = planes(Role::kShininess),
                      specular = shines() ? planes(Role::kSpecular) : LayerPlanes{},
                      facet = planes(Role::kGeometricNormal), unbent = planes(Role::kUnbentNormal),
                      lift = planes(Role::kLift), model = planes(Role::kModel);
    const std::size_t stride = gbuffer.pixels();
    const float kd = request_.albedo ? float(1 / std::numbers::pi) : 1.0f;
    const auto color = [&](const LayerPlanes& layer, std::size_t pixel, glm::vec3 missing) {
      if (!layer) return missing;
      return glm::vec3(coefficient(layer, pixel, 0, part_, path_), coefficient(layer, pixel, 1, part_, path_),
                       coefficient(layer, pixel, 2, part_, path_));
    };
    tbb::parallel_for(0, gbuffer.height, [&](int y) {
      for (int x = 0; x < gbuffer.width; ++x) {
        const std::size_t pixel = std::size_t(y) * gbuffer.width + x, place = gbuffer.index(x, y);
        if (std::isinf(gbuffer.position[place + 2 * stride])) continue;
        const glm::vec3 reflectance = color(diffuse, pixel, glm::vec3(0.8f));
        storePixel(kd * reflectance, place, stride, gbuffer.diffuse);
        const float exponent = shininess ? coefficient(shininess, pixel, 0, part_, path_)
                                         : found_[Role::kShininess].constant.value_or(0);
        const float ks = request_.albedo ? float((exponent + 2) / (2 * std::numbers::pi)) : 1.0f;
        storePixel(ks * color(specular, pixel, glm::vec3(0.0f)), place, stride, gbuffer.specular);
        gbuffer.specular[place + 3 * stride] = exponent;
        storePixel(color(ambient, pixel, reflectance), place, stride, gbuffer.ambient);
        if (emission) storePixel(color(emission, pixel, {}), place, stride, gbuffer.emission);
        if (unbent)
          gbuffer.unbent_normal[place] = packedAt(unbent, pixel, gbuffer, place);
        else if (facet)
          gbuffer.geometric_normal[place] = packedAt(facet, pixel, gbuffer, place);
        if (lift) gbuffer.lift[place] = coefficient(lift, pixel, 0, part_, path_);
        if (model) gbuffer.model[place] = modelAt(model, pixel);
      }
    });
  }

  std::uint32_t modelAt(const LayerPlanes& model, std::size_t pixel) const {
    const float number = coefficient(model, pixel, 0, part_, path_);
    if (number != std::floor(number) || number > float(kMostModelNumber))
      throw InputError(fmt::format("{}: channel {}: pixel {},{} is {}, expected a model's number, 0 to {}",
                                   path_, model.names[0], pixel % std::size_t(part_.size.x),
                                   pixel / std::size_t(part_.size.x), number, kMostModelNumber));
    return std::uint32_t(number);
  }

  /// The packed normal of a pixel in a layer, view space. What writeGBuffer() wrote is restored to the bit,
  /// although it went through world space and float (see packNormal).
  std::uint32_t packedAt(const LayerPlanes& layer, std::size_t pixel, const GBuffer& gbuffer,
                         std::size_t place) const {
    const glm::vec3 normal = layer.vector(pixel);
    const std::size_t stride = gbuffer.pixels();
    if (!isFinite(normal) || normal == glm::vec3(0.0f))
      return packNormal(glm::vec3(gbuffer.normal[place], gbuffer.normal[place + stride],
                                  gbuffer.normal[place + 2 * stride]));
    return packNormal(glm::dmat3(view_.to_view) * glm::dvec3(normal));
  }

  Image color() const {
    const LayerPlanes layer = planes(Role::kColor), alpha = reader_.planes(alpha_layer_);
    Image image{part_.size.x, part_.size.y, {"R", "G", "B"}, {}, part_.picture_size, part_.crop_origin};
    if (alpha) image.channels.emplace_back("A");
    const std::size_t channels = image.channels.size();
    requireMemory(double(pixels()) * double(channels) * sizeof(float), path_);
    image.pixels.resize(pixels() * channels);
    tbb::parallel_for(std::size_t(0), std::size_t(part_.size.y), [&](std::size_t y) {
      for (std::size_t pixel = y * part_.size.x; pixel < (y + 1) * part_.size.x; ++pixel) {
        for (int c = 0; c < 3; ++c) image.pixels[pixel * channels + c] = layer.value(pixel, c);
        if (alpha) image.pixels[pixel * channels + 3] = alpha.value(pixel);
      }
    });
    return image;
  }

  std::vector<std::string> notes() const {
    std::vector<std::string> taken;
    for (std::size_t i = 0; i < kRoleCount; ++i) {
      const Role role = Role(i);
      const FoundLayer& layer = found_.layers[i];
      if (role == Role::kColor && !request_.color) continue;
      if (layer.constant) taken.push_back(fmt::format("{} {}", kRoleNames[i], *layer.constant));
      if (!layer.isThere()) continue;
      const bool is_left_out = role == Role::kSpecular && !shines();
      const bool is_albedo = role == Role::kDiffuse && found_.layout->is_albedo && !request_.albedo;
      const std::string_view remark = is_left_out ? " (left out: no shininess)"
                                      : is_albedo
                                          ? " (an albedo, taken as Kd; by request.albedo Kd = albedo / pi)"
                                      : role == Role::kDiffuse && request_.albedo ? " (Kd = albedo / pi)"
                                                                                  : "";
      taken.push_back(fmt::format("{} = {}{}", kRoleNames[i],
                                  layer.name.empty() ? "R G B" : forMessage(utf8Of(layer.name)), remark));
    }
    std::vector<std::string> lines;
    lines.push_back(
        fmt::format("{}: named as {}'s: {}", path_, found_.layout->program, fmt::join(taken, ", ")));
    if (part_.display.pixel_aspect != 1)
      lines.push_back(fmt::format("{}: pixels are {} times as wide as high (pixelAspectRatio)", path_,
                                  part_.display.pixel_aspect));
    if (const glm::ivec2 origin = part_.display.origin; origin != glm::ivec2(0))
      lines.push_back(fmt::format("{}: the display window begins at ({}, {})", path_, origin.x, origin.y));
    const std::string space = view_.space == FileSpace::kCamera ? "camera" : "world";
    lines.push_back(fmt::format("{}: {} in {} space, camera {}", path_,
                                position_ ? "positions" : "positions from depths, normals", space,
                                view_.camera_source));
    if (!normal_)
      lines.push_back(
          fmt::format("{}: normals from neighbouring positions; {} pixels at edges have none and show "
                      "nothing",
                      path_, edges_));
    if (const std::size_t holes = holes_.count(); holes > 0)
      lines.push_back(
          fmt::format("{}: {} of {} pixels show nothing ({})", path_, holes, pixels(), holes_.reasons()));
    return lines;
  }

  const std::string& path_;
  const GBufferRequest& request_;
  LayerReader reader_;
  FoundLayers found_;
  PicturePart part_;       ///< whose size, place and camera count
  bool own_view_ = false;  ///< position_ and normal_ are in this program's view space
  LayerPlanes position_, normal_, depth_;
  FoundLayer alpha_layer_;
  FileView view_;
  Holes holes_;
  std::size_t edges_ = 0;
};

}  // namespace

GBufferInput readGBuffer(const std::string& path, const GBufferRequest& request) {
  return Conversion(path, request).convert();
}

GBuffer readGBuffer(const std::string& path) { return readGBuffer(path, {}).gbuffer; }

}  // namespace luciole
