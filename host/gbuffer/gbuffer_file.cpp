#include "luciole/gbuffer_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "gbuffer/camera_header.hpp"
#include "gbuffer/packed_normal.hpp"
#include "image/file_format.hpp"
#include "luciole/error.hpp"
#include "luciole/planes.hpp"

namespace luciole {
namespace {

/// The vector components of a pixel in a group. `at` is GBuffer::index, `stride`
/// GBuffer::pixels.
glm::vec3 load(const Plane& group, std::size_t at, std::size_t stride) {
  return {group[at], group[at + stride], group[at + 2 * stride]};
}

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
  if (!gbuffer.unbent_normal.empty()) addChannels(names, "Nunbent", "XYZ");
  if (!gbuffer.lift.empty()) names.push_back("lift");
  if (!gbuffer.model.empty()) names.push_back("model");
  return names;
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
    for (const PackedNormals* group : {&gbuffer.geometric_normal, &gbuffer.unbent_normal}) {
      if (group->empty()) continue;
      const bool shows = normal != glm::vec3(0.0f);
      add(shows ? glm::vec3(glm::dmat3(to_world) * unpackNormal((*group)[at])) : glm::vec3(0.0f));
    }
    if (!gbuffer.lift.empty()) values.push_back(gbuffer.lift[at]);
    if (!gbuffer.model.empty()) values.push_back(float(gbuffer.model[at]));
  }
}

}  // namespace

void passRows(const GBuffer& gbuffer, const std::function<void(const Image& rows)>& take) {
  Image rows{gbuffer.width, 0, channelNames(gbuffer), {}};
  // Some rows at a time: all of them together would take more memory than the G-buffer.
  constexpr int kRows = 64;
  for (int y = 0; y < gbuffer.height; y += kRows) {
    rows.height = std::min(kRows, gbuffer.height - y);
    rows.pixels.clear();
    for (int row = y; row < y + rows.height; ++row) addRow(gbuffer, row, rows.pixels);
    take(rows);
  }
}

void writeGBuffer(const GBuffer& gbuffer, const std::string& path, const Metadata& metadata,
                  const std::string& format, const std::string& compression) {
  if (outputFormat(path, format).extension != "exr") {
    throw InputError(path + ": a G-buffer has many float channels, expected .exr");
  }
  const WriteOptions options{
      .format = "exr",
      .compression = compression,
      .picture_size = gbuffer.picture_size,
      .crop_origin = gbuffer.crop_origin,
      .display = gbuffer.display,
      .exr = cameraAttributes(gbuffer.camera, gbuffer.picture_size, gbuffer.display.pixel_aspect)};
  ImageWriter file(path, gbuffer.width, gbuffer.height, channelNames(gbuffer), metadata, options);
  passRows(gbuffer, [&](const Image& rows) { file.write(rows); });
  file.close();
}

}  // namespace luciole
