#include "scene/lights/light_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <new>
#include <utility>

#include "base/machine_memory.hpp"
#include "base/random.hpp"
#include "luciole/error.hpp"
#include "scene/bounds.hpp"
#include "scene/lights/light_places.hpp"
#include "scene/lights/light_range.hpp"

namespace luciole {
namespace {

void appendLights(const LightField& field, const std::function<glm::dvec3(std::uint64_t&)>& placeOf,
                  std::vector<Light>& lights) {
  const bool listed = field.shape == FieldShape::kList;
  std::uint64_t place_state = field.seed;
  // Looks have their own random stream, so that changing them moves no light.
  std::uint64_t look_state = ~field.seed;
  for (std::uint64_t i = 0; i < field.count; ++i) {
    Light light;
    if (listed) {
      light = field.list[i];
    } else {
      light.position = placeOf(place_state);
    }
    light.group = field.group;
    if (field.as_listed) {
      lights.push_back(light);
      continue;
    }
    const double pick = nextUniform(look_state) * static_cast<double>(field.colors.size());
    const double intensity = between(field.intensity.x, field.intensity.y, nextUniform(look_state));
    const double range_u = nextUniform(look_state);
    if (!listed) light.diffuse = field.colors[static_cast<std::size_t>(pick)];
    light.diffuse *= static_cast<float>(intensity);
    light.specular = light.diffuse;
    light.shadow = field.shadow;
    if (light.kind != LightKind::kDirectional) {
      if (field.attenuation) light.attenuation = *field.attenuation;
      if (std::isfinite(field.range.y))
        light.range = static_cast<float>(between(field.range.x, field.range.y, range_u));
      if (field.cutoff > 0) light.range = rangeForCutoff(light, field.cutoff);
    }
    lights.push_back(light);
  }
}

}  // namespace

std::optional<FieldShape> fieldShapeNamed(std::string_view name) {
  constexpr std::pair<std::string_view, FieldShape> kShapes[]{
      {"box", FieldShape::kBox},         {"ball", FieldShape::kBall},         {"sphere", FieldShape::kSphere},
      {"surface", FieldShape::kSurface}, {"clusters", FieldShape::kClusters}, {"curve", FieldShape::kCurve}};
  for (const auto& [known, shape] : kShapes)
    if (name == known) return shape;
  return std::nullopt;
}

LightField fieldInBox(FieldShape shape, const Bounds& box) {
  const glm::dvec3 sides = box.high - box.low;
  const double longest = std::max({sides.x, sides.y, sides.z});
  const double average = (sides.x + sides.y + sides.z) / 3;
  LightField field;
  field.shape = shape;
  field.low = box.low;
  field.high = box.high;
  field.center = box.low + 0.5 * sides;
  field.offset = longest / 100;
  field.clusters = 32;
  field.colors = {
      {1.0f, 0.55f, 0.2f}, {1.0f, 0.8f, 0.5f}, {0.4f, 0.6f, 1.0f}, {0.5f, 1.0f, 0.6f}, {1.0f, 0.35f, 0.5f}};
  if (shape == FieldShape::kBall || shape == FieldShape::kSphere) field.radius = average / 2;
  if (shape == FieldShape::kClusters) field.radius = average / 10;
  if (shape == FieldShape::kCurve) field.radius = average / 50;
  for (const glm::dvec3& share :
       {glm::dvec3(0.1, 0.5, 0.1), {0.9, 0.3, 0.3}, {0.1, 0.7, 0.5}, {0.9, 0.3, 0.7}, {0.1, 0.5, 0.9}})
    field.points.push_back(box.low + share * sides);
  return field;
}

void expandLightField(const LightField& field, Scene& scene) {
  std::vector<Light>& lights = scene.lights;
  if (field.count > kMostLights || lights.size() > kMostLights - field.count) {
    throw InputError(fmt::format("light field: {} lights and {} more; a scene may have {} at most",
                                 lights.size(), field.count, kMostLights));
  }
  // A light and its place.
  requireMemory(double(field.count) * (sizeof(Light) + sizeof(glm::dvec3)),
                fmt::format("a light field of {} lights", field.count));
  try {
    const std::size_t before = lights.size();
    lights.reserve(before + field.count);
    appendLights(field, lightPlaces(field, scene), lights);
    if (field.no_range) spreadEverywhere(std::span(lights).subspan(before), fieldPlaces(field, scene));
  } catch (const std::bad_alloc&) {
    throw MachineError(fmt::format("light field: no memory for {} lights", field.count));
  }
}

std::vector<glm::dvec3> fieldPlaces(const LightField& field, const Scene& scene) {
  LightField other = field;
  ++other.seed;
  const std::function<glm::dvec3(std::uint64_t&)> placeOf = lightPlaces(other, scene);
  std::uint64_t state = other.seed;
  std::vector<glm::dvec3> places(kMeasuredPlaces);
  for (glm::dvec3& place : places) place = placeOf(state);
  return places;
}

void expandLightFields(std::span<const LightField> fields, Scene& scene) {
  std::uint64_t count = scene.lights.size();
  for (const LightField& field : fields) count += std::min(field.count, kMostLights);
  try {
    if (count <= kMostLights) scene.lights.reserve(count);
  } catch (const std::bad_alloc&) {
    // The field that doesn't fit will say so.
  }
  for (const LightField& field : fields) expandLightField(field, scene);
}

}  // namespace luciole
