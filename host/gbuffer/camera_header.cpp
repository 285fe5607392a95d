#include "gbuffer/camera_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "luciole/pose.hpp"
#include "luciole/validate_scene.hpp"

namespace luciole {
namespace {

constexpr char kPose[] = "luciole:cameraToWorld";
constexpr char kProjection[] = "luciole:projection";
constexpr char kLens[] = "luciole:lens";
constexpr char kName[] = "luciole:cameraName";
constexpr char kWorldToCamera[] = "worldToCamera", kWorldToNdc[] = "worldToNDC";

/// Turns −z ahead into +z ahead, and back.
glm::dmat4 mirrorZ() {
  glm::dmat4 mirror{1.0};
  mirror[2][2] = -1.0;
  return mirror;
}

/// Camera space with +z ahead to OpenEXR's NDC; z runs from 0 at the near plane to 1 at the far plane.
glm::dmat4 cameraToNdc(const Camera& camera, const glm::dvec2& half_extent) {
  const double depth = camera.far - camera.near;
  glm::dmat4 m{0.0};
  m[0][0] = 0.5 / half_extent.x;
  m[1][1] = -0.5 / half_extent.y;
  const int homogeneous = camera.orthographic ? 3 : 2;  // w is 1, or z
  m[homogeneous][0] = 0.5 + 0.5 * camera.shift.x;
  m[homogeneous][1] = 0.5 - 0.5 * camera.shift.y;
  m[homogeneous][3] = 1.0;
  m[2][2] = camera.orthographic ? 1.0 / depth : std::isfinite(depth) ? camera.far / depth : 1.0;
  m[3][2] = -camera.near * m[2][2];
  return m;
}

/// The attribute of that name among texts or matrices.
template <class T>
std::optional<T> findNamed(const std::vector<std::pair<std::string, T>>& attributes,
                           std::string_view wanted) {
  for (const auto& [name, value] : attributes)
    if (equalIgnoringCase(name, wanted)) return value;
  return {};
}

std::optional<glm::dmat4> findMatrix(const ExrAttributes& attributes, std::string_view name) {
  const auto matrix = findNamed(attributes.matrices, name);
  return matrix ? std::optional(glm::dmat4(*matrix)) : std::nullopt;
}

std::string findText(const ExrAttributes& attributes, std::string_view name) {
  return findNamed(attributes.texts, name).value_or("");
}

/// `count` finite numbers and nothing else, but that the last may be "inf" where `may_be_infinite`.
std::vector<double> parseNumbers(std::istringstream text, std::size_t count, const std::string& path,
                                 const char* attribute, bool may_be_infinite = false) {
  std::vector<double> numbers;
  bool all_finite = true;
  for (std::string word; text >> word;) {
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    const bool is_last_infinity = may_be_infinite && numbers.size() + 1 == count && word == "inf";
    all_finite = all_finite && error == std::errc() && end == word.data() + word.size() &&
                 (std::isfinite(number) || is_last_infinity);
    numbers.push_back(number);
  }
  if (numbers.size() != count || !all_finite) {
    throw InputError(fmt::format("{}: attribute {}: expected {} finite numbers", path, attribute, count));
  }
  return numbers;
}

/// Scales and shears are refused: they would change distances, and so the light.
void checkRigid(const glm::dmat4& m, const std::string& path, const char* attribute) {
  if (isRigid(m)) return;
  throw InputError(fmt::format("{}: attribute {}: expected a rotation and a translation", path, attribute));
}

Camera parseOwn(const ExrAttributes& attributes, const std::string& path) {
  Camera camera;
  camera.name = findText(attributes, kName);
  camera.camera_to_world =
      glm::make_mat4(parseNumbers(std::istringstream(findText(attributes, kPose)), 16, path, kPose).data());
  checkRigid(camera.camera_to_world, path, kPose);

  std::istringstream projection(findText(attributes, kProjection));
  std::string kind;
  projection >> kind;
  camera.orthographic = kind == "parallel";
  if (!camera.orthographic && kind != "perspective") {
    throw InputError(
        fmt::format("{}: attribute {}: '{}', expected perspective or parallel", path, kProjection, kind));
  }
  const std::vector<double> numbers =
      parseNumbers(std::move(projection), 3, path, kProjection, !camera.orthographic);
  (camera.orthographic ? camera.half_height : camera.fov_y) = numbers[0];
  camera.near = numbers[1];
  camera.far = numbers[2];
  const bool opening_ok = numbers[0] > 0 && (camera.orthographic || numbers[0] < 3.14159);
  if (!opening_ok || !(camera.near > 0) || !(camera.far > camera.near)) {
    throw InputError(
        fmt::format("{}: attribute {}: expected an opening > 0 and 0 < near < far", path, kProjection));
  }
  if (const auto text = findNamed(attributes.texts, kLens)) {
    const std::vector<double> lens = parseNumbers(std::istringstream(*text), 3, path, kLens);
    camera.shift = {lens[0], lens[1]};
    camera.pixel_aspect = lens[2];
    if (const std::string fault = cameraFault(camera); !fault.empty())
      throw InputError(fmt::format("{}: attribute {}: {}", path, kLens, fault));
  }
  return camera;
}

bool isParallel(const glm::dmat4& to_ndc) { return std::abs(to_ndc[2][3]) <= 1e-6 * std::abs(to_ndc[3][3]); }

/// Whether the view axis goes through the picture's middle, to within a thousandth of the picture. A float
/// matrix times the inverse of another has an error of a few 1e-7 near the origin, which grows with the
/// camera's distance.
bool isCentred(const glm::dmat4& to_ndc) {
  const glm::dvec4 middle = to_ndc[isParallel(to_ndc) ? 3 : 2] / to_ndc[isParallel(to_ndc) ? 3 : 2].w;
  return std::abs(middle.x - 0.5) < 1e-3 && std::abs(middle.y - 0.5) < 1e-3;
}

/// Whether a projection takes x to x, y to y and neither to w, as far as floats tell.
bool isUpright(const glm::dmat4& to_ndc) {
  const double most = 1e-3 * std::max(std::abs(to_ndc[0][0]), std::abs(to_ndc[1][1]));
  return std::abs(to_ndc[0][1]) <= most && std::abs(to_ndc[1][0]) <= most && std::abs(to_ndc[0][3]) <= most &&
         std::abs(to_ndc[1][3]) <= most;
}

/// A number of a float matrix, or the whole one that it is by less than `noise`.
double withoutNoise(double value, double whole, double noise) {
  return std::abs(value - whole) < noise ? whole : value;
}

/// Reads opening, shift and aspect of a projection into the camera. `to_ndc`: camera space with +z ahead to
/// NDC. aspect: of the picture, its width by its height.
void readProjection(const glm::dmat4& to_ndc, double aspect, CameraHeader& header) {
  const bool parallel = isParallel(to_ndc);
  const glm::dvec4 middle = to_ndc[parallel ? 3 : 2];
  const glm::dvec2 half{0.5 * middle.w / to_ndc[0][0], -0.5 * middle.w / to_ndc[1][1]};
  // A column of a rotation's product has a float's noise; where the axis of a parallel view goes through the
  // picture depends on the camera's place, too.
  const double noise = parallel ? 2e-3 : 2e-5;
  const glm::dvec2 shift(withoutNoise(2 * middle.x / middle.w - 1, 0, noise),
                         withoutNoise(1 - 2 * middle.y / middle.w, 0, noise));
  if (!isUpright(to_ndc) || !(half.x > 0) || !(half.y > 0) || !std::isfinite(half.x) ||
      !std::isfinite(half.y) || !glm::all(glm::lessThanEqual(glm::abs(shift), glm::dvec2(kMostLensShift))))
    return;
  header.half_extent = half;
  header.camera.shift = shift;
  header.camera.pixel_aspect =
      std::clamp(withoutNoise(half.x / (half.y * aspect), 1, 1e-3), 1 / kMostPixelAspect, kMostPixelAspect);
  header.camera.orthographic = parallel;
  if (parallel) {
    header.camera.half_height = half.y;
  } else {
    header.camera.fov_y = 2 * std::atan(half.y);
  }
}

/// Whether the matrices are for column vectors, as pbrt writes them. For a rotation alone the projection
/// decides.
bool isTransposed(const glm::dmat4& world_to_camera, const std::optional<glm::dmat4>& world_to_ndc) {
  if (!isRigid(glm::transpose(world_to_camera))) return false;
  if (!isRigid(world_to_camera)) return true;
  return world_to_ndc && !isCentred(*world_to_ndc * glm::inverse(world_to_camera)) &&
         isCentred(glm::transpose(*world_to_ndc) * world_to_camera);
}

/// Whether camera space has +z ahead (see readCamera).
bool looksAlongPlusZ(const glm::dmat4& world_to_camera, const std::optional<glm::dmat4>& to_ndc,
                     std::span<const glm::dvec3> visible_points) {
  if (to_ndc && std::abs((*to_ndc)[2][3]) > 1e-6 * std::abs((*to_ndc)[3][3])) return (*to_ndc)[2][3] > 0;
  if (!visible_points.empty()) {
    std::size_t positive = 0;
    for (const glm::dvec3& point : visible_points)
      positive += (world_to_camera * glm::dvec4(point, 1.0)).z > 0;
    return 2 * positive >= visible_points.size();
  }
  return glm::determinant(glm::dmat3(world_to_camera)) < 0;
}

}  // namespace

bool isRigid(const glm::dmat4& m) {
  // A float matrix of a rotation is orthogonal to within a few 6e-8, and text of other tools to about six
  // digits.
  const glm::dmat3 rotation(m);
  const glm::dmat3 product = glm::transpose(rotation) * rotation;
  bool rigid = m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rigid = rigid && std::abs(product[i][j] - (i == j ? 1.0 : 0.0)) <= 1e-4;
    rigid = rigid && std::isfinite(m[3][i]);
  }
  return rigid;
}

glm::dvec2 halfExtent(const Camera& camera, glm::ivec2 picture_size, double pixel_aspect) {
  const double height = camera.orthographic ? camera.half_height : std::tan(camera.fov_y / 2);
  return {height * (camera.pixel_aspect * pixel_aspect) * picture_size.x / picture_size.y, height};
}

ExrAttributes cameraAttributes(const Camera& camera, glm::ivec2 picture_size, double pixel_aspect) {
  const glm::dmat4 world_to_camera = mirrorZ() * glm::inverse(camera.camera_to_world);
  const glm::dmat4 to_ndc = cameraToNdc(camera, halfExtent(camera, picture_size, pixel_aspect));
  const double* pose = glm::value_ptr(camera.camera_to_world);
  std::string text;
  for (int i = 0; i < 16; ++i) text += fmt::format("{}{:.17g}", i ? " " : "", pose[i]);
  ExrAttributes attributes;
  attributes.matrices = {{kWorldToCamera, glm::mat4(world_to_camera)},
                         {kWorldToNdc, glm::mat4(to_ndc * world_to_camera)}};
  attributes.texts = {
      {kPose, text},
      {kProjection,
       fmt::format("{} {:.17g} {:.17g} {:.17g}", camera.orthographic ? "parallel" : "perspective",
                   camera.orthographic ? camera.half_height : camera.fov_y, camera.near, camera.far)}};
  if (camera.shift != glm::dvec2(0) || camera.pixel_aspect != 1)
    attributes.texts.emplace_back(
        kLens, fmt::format("{:.17g} {:.17g} {:.17g}", camera.shift.x, camera.shift.y, camera.pixel_aspect));
  if (!camera.name.empty()) attributes.texts.emplace_back(kName, camera.name);
  return attributes;
}

std::optional<CameraHeader> readCamera(const ExrAttributes& attributes, glm::ivec2 picture_size,
                                       const std::string& path, std::span<const glm::dvec3> visible_points,
                                       double pixel_aspect) {
  CameraHeader header;
  if (findNamed(attributes.texts, kPose)) {
    header.camera = parseOwn(attributes, path);
    header.is_exact = true;
    header.half_extent = halfExtent(header.camera, picture_size, pixel_aspect);
    return header;
  }
  std::optional<glm::dmat4> world_to_camera = findMatrix(attributes, kWorldToCamera);
  if (!world_to_camera) return {};
  auto world_to_ndc = findMatrix(attributes, kWorldToNdc);
  if (isTransposed(*world_to_camera, world_to_ndc)) {
    world_to_camera = glm::transpose(*world_to_camera);
    if (world_to_ndc) world_to_ndc = glm::transpose(*world_to_ndc);
  }
  checkRigid(*world_to_camera, path, "worldToCamera");
  std::optional<glm::dmat4> to_ndc;
  if (world_to_ndc) to_ndc = *world_to_ndc * glm::inverse(*world_to_camera);
  if (!looksAlongPlusZ(*world_to_camera, to_ndc, visible_points)) {
    world_to_camera = mirrorZ() * *world_to_camera;
    if (to_ndc) to_ndc = *to_ndc * mirrorZ();
  }
  header.camera.camera_to_world = glm::inverse(mirrorZ() * *world_to_camera);
  if (to_ndc) readProjection(*to_ndc, pixel_aspect * picture_size.x / picture_size.y, header);
  return header;
}

}  // namespace luciole
