#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <string>
#include <vector>

#include "image/oiio.hpp"
#include "luciole/gbuffer.hpp"

// EXR files as other programs write them.
namespace luciole::test {

constexpr auto kHalf = OIIO::TypeDesc::HALF;
constexpr auto kFloat = OIIO::TypeDesc::FLOAT;

struct ForeignChannel {
  std::string name;
  OIIO::TypeDesc::BASETYPE type = OIIO::TypeDesc::FLOAT;
  std::function<float(int x, int y)> value;
};

struct ForeignPart {
  std::vector<ForeignChannel> channels;
  std::function<void(OIIO::ImageSpec&)> header;
};

/// Writes an EXR of parts, each width × height pixels unless its header says otherwise.
inline void writeForeignParts(const std::string& path, int width, int height,
                              const std::vector<ForeignPart>& parts) {
  std::vector<OIIO::ImageSpec> specs;
  for (const ForeignPart& part : parts) {
    OIIO::ImageSpec spec(width, height, int(part.channels.size()), OIIO::TypeDesc::FLOAT);
    spec.channelnames.clear();
    for (const ForeignChannel& channel : part.channels) {
      spec.channelnames.push_back(channel.name);
      spec.channelformats.emplace_back(channel.type);
    }
    if (part.header) part.header(spec);
    specs.push_back(spec);
  }
  const auto output = OIIO::ImageOutput::create("exr");
  ASSERT_TRUE(specs.size() > 1 ? output->open(path, int(specs.size()), specs.data())
                               : output->open(path, specs.front()))
      << output->geterror();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) {
      ASSERT_TRUE(output->open(path, specs[i], OIIO::ImageOutput::AppendSubimage)) << output->geterror();
    }
    std::vector<float> values;
    for (int y = 0; y < specs[i].height; ++y)
      for (int x = 0; x < specs[i].width; ++x)
        for (const ForeignChannel& channel : parts[i].channels) values.push_back(channel.value(x, y));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data())) << output->geterror();
  }
  ASSERT_TRUE(output->close()) << output->geterror();
}

/// Three channels of a layer: NAME.X …, with components such as "XYZ".
inline void addLayer(std::vector<ForeignChannel>& channels, const std::string& name, const char* components,
                     OIIO::TypeDesc::BASETYPE type, const std::function<glm::vec3(int x, int y)>& value) {
  for (int c = 0; c < 3; ++c)
    channels.push_back({name.empty() ? std::string(1, components[c]) : name + "." + components[c], type,
                        [value, c](int x, int y) { return value(x, y)[c]; }});
}

/// What a G-buffer's pixels hold, as other programs have it.
struct Surfaces {
  const GBuffer& gbuffer;

  glm::vec3 three(const Plane& plane, int x, int y) const {
    const std::size_t at = gbuffer.index(x, y), stride = gbuffer.pixels();
    return {plane[at], plane[at + stride], plane[at + 2 * stride]};
  }
  bool shows(int x, int y) const { return std::isfinite(three(gbuffer.position, x, y).z); }
  /// View space: −z ahead. 0 where nothing is.
  glm::vec3 viewPosition(int x, int y) const {
    return shows(x, y) ? three(gbuffer.position, x, y) : glm::vec3(0.0f);
  }
  glm::vec3 viewNormal(int x, int y) const { return three(gbuffer.normal, x, y); }
  glm::vec3 position(int x, int y) const {
    if (!shows(x, y)) return glm::vec3(0.0f);
    return glm::vec3(gbuffer.camera.camera_to_world * glm::dvec4(viewPosition(x, y), 1.0));
  }
  glm::vec3 normal(int x, int y) const {
    return glm::vec3(glm::dmat3(gbuffer.camera.camera_to_world) * glm::dvec3(viewNormal(x, y)));
  }
  /// Along the view axis; `hole` where nothing is.
  float depth(int x, int y, float hole) const { return shows(x, y) ? -viewPosition(x, y).z : hole; }
};

constexpr OIIO::TypeDesc kMatrixType(OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::MATRIX44);

/// A matrix for row vectors, as OpenEXR has them, which is GLM's for column vectors as it lies in memory.
inline void addMatrix(OIIO::ImageSpec& spec, const std::string& name, const glm::dmat4& matrix) {
  const glm::mat4 single(matrix);
  spec.attribute(name, kMatrixType, glm::value_ptr(single));
}

}  // namespace luciole::test
