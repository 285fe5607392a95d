#include "render/clustered_light.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "scene/model.hpp"

namespace luciole {
namespace {

/// From so many lights on clusters pay, at the errors that people choose. Below, the walk through the tree
/// costs more than the lights.
constexpr std::size_t kFewestClustered = 2000;

/// Interim: the double-precision sums below, rounded to float, err by far less.
constexpr double kInterimError = 0x1p-18;

std::vector<float> onHost(Device& device, const Buffer<const float>& buffer, std::size_t count) {
  std::vector<float> values(buffer.count >= count ? count : 0);
  if (!values.empty()) download(device, buffer, values);
  return values;
}

glm::dvec3 xyz(const float4& v) { return {v.x, v.y, v.z}; }

}  // namespace

ClusteredLightCounts clusteredLight(Device& device, const std::string&,
                                    const ClusteredLightArguments& arguments) {
  const ShadeFrame& frame = arguments.frame;
  const std::size_t n = frame.plane_stride;
  const std::vector<float> position = onHost(device, arguments.gbuffer.position, 3 * n),
                           normal = onHost(device, arguments.gbuffer.normal, 3 * n),
                           diffuse = onHost(device, arguments.gbuffer.diffuse, 3 * n),
                           specular = onHost(device, arguments.gbuffer.specular, 4 * n);
  const auto at = [n](const std::vector<float>& group, std::size_t i) {
    return glm::dvec3(group[i], group[i + n], group[i + 2 * n]);
  };
  std::vector<float> light(3 * n), bound(3 * n);
  tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
    if (!std::isfinite(position[i + 2 * n])) return;
    const glm::dvec3 p = at(position, i), facing = at(normal, i), kd = at(diffuse, i);
    const glm::dvec3 to_eye = glm::normalize(xyz(frame.eye) - double(frame.eye.w) * p);
    glm::dvec3 sum(0.0);
    for (const ShadeLight& one : arguments.clusters.lights) {
      const glm::dvec3 way = xyz(one.position) - p;
      const double d2 = glm::dot(way, way);
      if (!(d2 > 0)) continue;
      const glm::dvec3 to_light = way / std::sqrt(d2);
      const double cosine = glm::dot(facing, to_light);
      if (!(cosine > 0)) continue;
      const double strength = 1 / (double(one.attenuation.z) * d2);
      sum += kd * xyz(one.diffuse) * (strength * cosine);
      if (specular.empty()) continue;
      const glm::dvec3 half_way = to_light + to_eye;
      const double lobe = frame.model == uint(Model::kBlinnPhong)
                              ? glm::dot(facing, half_way) / std::max(glm::length(half_way), 1e-300)
                              : glm::dot(2 * cosine * facing - to_light, to_eye);
      const double highlight = std::pow(std::clamp(lobe, 0.0, 1.0), double(specular[i + 3 * n]));
      sum += at(specular, i) * xyz(one.specular) * (strength * highlight);
    }
    for (int c = 0; c < 3; ++c) {
      light[i + c * n] = float(sum[c]);
      bound[i + c * n] = float(kInterimError * sum[c]);
    }
  });
  bytes::write(device, arguments.light.memory, light.data(), {0, light.size() * sizeof(float)});
  bytes::write(device, arguments.bound.memory, bound.data(), {0, bound.size() * sizeof(float)});
  return {.clusters = 0, .lights = n * arguments.clusters.lights.size(), .redone = 0};
}

bool clustersPay(std::size_t lights, float) { return lights >= kFewestClustered; }

}  // namespace luciole
