#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "luciole/scene.hpp"
#include "scene/glowing_patches.hpp"
#include "scene/sky_cells.hpp"
#include "scene/source_fault.hpp"

namespace luciole {
namespace {

/// Adds a point of a flat face: it shines as the cosine of the angle to `direction`, and gives a surface
/// radiance · area · cos · cos / (π d²) of its diffuse colour.
void addEmitter(const glm::dvec3& place, const glm::dvec3& direction, const glm::vec3& radiance, double area,
                const Light& like, std::vector<Light>& lights) {
  Light light = like;
  light.kind = LightKind::kSpot;
  light.position = place;
  light.direction = direction;
  light.diffuse = light.specular = glm::vec3(glm::dvec3(radiance) * area / glm::pi<double>());
  light.attenuation = {0.0f, 0.0f, 1.0f};
  light.cutoff = glm::pi<double>() / 2;
  light.exponent = 1;
  light.cell = float(area);
  light.over_pi = true;
  lights.push_back(light);
}

/// Points of a rectangle, −½ to ½ a side: each is the middle of a rectangle of the same area. Rows have as
/// many of them as make these about square.
std::vector<glm::dvec2> rectanglePoints(std::uint32_t count, double aspect) {
  const auto rows = std::uint32_t(std::clamp(std::round(std::sqrt(count / aspect)), 1.0, double(count)));
  std::vector<glm::dvec2> points;
  for (std::uint32_t row = 0; row < rows; ++row) {
    const std::uint64_t begin = std::uint64_t(count) * row / rows,
                        end = std::uint64_t(count) * (row + 1) / rows;
    for (std::uint64_t i = begin; i < end; ++i)
      points.emplace_back((double(i - begin) + 0.5) / double(end - begin) - 0.5,
                          double(begin + end) / 2 / count - 0.5);
  }
  return points;
}

/// Points of a disc of the diameter 1, of the same area each: H. Vogel's spiral ("A better way to construct
/// the sunflower head", 1979).
std::vector<glm::dvec2> discPoints(std::uint32_t count) {
  const double golden = glm::pi<double>() * (3 - std::sqrt(5.0));
  std::vector<glm::dvec2> points;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double radius = 0.5 * std::sqrt((i + 0.5) / count);
    points.emplace_back(radius * std::cos(golden * i), radius * std::sin(golden * i));
  }
  return points;
}

void addFace(const LightSource& source, const Light& like, std::vector<Light>& lights) {
  const glm::dvec3 across = glm::normalize(glm::cross(source.up, source.direction));
  const glm::dvec3 up = glm::cross(source.direction, across);
  const bool is_disc = source.kind == SourceKind::kDisc;
  const double area = source.width * source.height * (is_disc ? glm::pi<double>() / 4 : 1) / source.count;
  for (const glm::dvec2& at :
       is_disc ? discPoints(source.count) : rectanglePoints(source.count, source.width / source.height))
    addEmitter(source.position + across * (source.width * at.x) + up * (source.height * at.y),
               source.direction, source.radiance, area, like, lights);
}

void addSky(LightSource& source, const Light& like, std::vector<Light>& lights) {
  if (source.divided != source.count) source.cells = skyCells(*source.sky, source.count);
  source.divided = source.count;
  const double cosine = std::cos(source.rotate), sine = std::sin(source.rotate);
  for (const SkyCell& cell : source.cells) {
    const glm::dvec3& d = cell.direction;
    Light light = like;
    light.kind = LightKind::kDirectional;
    light.direction = -glm::dvec3(cosine * d.x + sine * d.z, d.y, cosine * d.z - sine * d.x);
    light.diffuse = light.specular = cell.light * source.radiance;
    light.cell = cell.solid_angle;
    light.over_pi = true;
    lights.push_back(light);
  }
}

/// How far a light lies above its own surface: shadow rays end before it. A share of the side of its patch,
/// or of the whole surface's extent, beside which the rounding of float places is small.
double liftOf(const GlowingPatch& patch, double extent) {
  return std::max(1e-3 * std::sqrt(patch.area), 0x1p-12 * extent);
}

/// Adds the lights of an object's triangles that glow, of one material or of all.
void addGlow(const Scene& scene, const Object& object, std::optional<std::uint32_t> material,
             std::uint32_t count, std::vector<Light>& lights) {
  const std::vector<GlowingPatch> patches = glowingPatches(scene, object, material, count);
  Light like;
  like.shadow = true;
  like.name = object.name;
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const GlowingPatch& patch : patches) {
    low = glm::min(low, patch.place);
    high = glm::max(high, patch.place);
  }
  for (const GlowingPatch& patch : patches)
    for (const double side : {1.0, -1.0}) {
      if (side < 0 && !patch.double_sided) continue;
      const glm::dvec3 normal = side * patch.normal;
      addEmitter(patch.place + normal * liftOf(patch, glm::length(high - low)), normal, patch.radiance,
                 patch.area, like, lights);
    }
}

/// Adds the lights of all that glows of an object, where it or a material of it emits.
void addGlow(const Scene& scene, const Object& object, std::vector<Light>& lights) {
  if (object.emits > 0) {
    addGlow(scene, object, std::nullopt, object.emits, lights);
    return;
  }
  std::vector<std::uint32_t> materials = scene.meshes[object.mesh].triangle_materials;
  if (object.material >= 0) materials = {std::uint32_t(object.material)};
  std::sort(materials.begin(), materials.end());
  materials.erase(std::unique(materials.begin(), materials.end()), materials.end());
  for (const std::uint32_t material : materials)
    if (scene.materials[material].emits > 0)
      addGlow(scene, object, material, scene.materials[material].emits, lights);
}

}  // namespace

const LightSource* environmentOf(const Scene& scene) {
  const auto found = std::find_if(scene.sources.begin(), scene.sources.end(), [](const LightSource& source) {
    return source.kind == SourceKind::kEnvironment;
  });
  return found == scene.sources.end() ? nullptr : &*found;
}

void clearLights(Scene& scene) {
  scene.sources.clear();
  for (Object& object : scene.objects) object.emits = 0;
  for (Material& material : scene.materials) material.emits = 0;
  scene.lights.clear();
  scene.source_lights = 0;
}

void setLightCounts(Scene& scene, std::uint32_t count) {
  const auto set = [count](auto& things, auto member) {
    for (auto& thing : things)
      if (thing.*member > 0) thing.*member = count;
  };
  set(scene.sources, &LightSource::count);
  set(scene.objects, &Object::emits);
  set(scene.materials, &Material::emits);
  addSourceLights(scene);
}

void addSourceLights(Scene& scene) {
  const std::size_t own = scene.lights.size() - std::min(scene.source_lights, scene.lights.size());
  std::vector<bool> cast;  // whether those before did
  for (std::size_t i = own; i < scene.lights.size(); ++i) cast.push_back(scene.lights[i].shadow);
  scene.lights.resize(own);
  for (std::size_t i = 0; i < scene.sources.size(); ++i) {
    LightSource& source = scene.sources[i];
    if (const std::string fault = sourceFault(source, scene.light_groups.size()); !fault.empty())
      throw InputError(fmt::format("{}: sources[{}].{}", scene.name, i, fault));
    if (source.count == 0) continue;
    Light like;
    like.shadow = source.shadow;
    like.group = source.group;
    like.name = source.name;
    if (source.kind == SourceKind::kEnvironment)
      addSky(source, like, scene.lights);
    else
      addFace(source, like, scene.lights);
  }
  const bool some_emits = std::any_of(scene.materials.begin(), scene.materials.end(),
                                      [](const Material& material) { return material.emits > 0; });
  for (const Object& object : scene.objects) {
    if (object.emits == 0 && !some_emits) continue;
    const std::size_t before = scene.lights.size();
    addGlow(scene, object, scene.lights);
    if (object.emits == 0 || scene.lights.size() > before) continue;
    const Warning dark{
        fmt::format("{}: object '{}' emits, but no area of it glows", scene.name, forMessage(object.name)),
        "no area glows"};
    if (std::find(scene.warnings.begin(), scene.warnings.end(), dark) == scene.warnings.end())
      scene.warnings.push_back(dark);
  }
  scene.source_lights = scene.lights.size() - own;
  for (std::size_t i = 0; i < cast.size() && cast.size() == scene.source_lights; ++i)
    scene.lights[own + i].shadow = cast[i];
}

}  // namespace luciole
