#include "lights/fog_cull.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "scene/bounds.hpp"
#include "scene/models.hpp"

namespace luciole {
namespace {

constexpr double kHalfStep = 0.5 / 255 / 12.92;
/// Relative margin of distances and colours, larger than the kernels' rounding errors.
constexpr double kSlack = 0x1p-20;

double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

/// Upper bounds of the factors by which a surface reflects, for each channel: of ambient light, and of the
/// lights' diffuse and specular colours.
struct ReflectanceBound {
  glm::dvec3 ambient{0.0}, diffuse{0.0}, specular{0.0};

  void include(const ReflectanceBound& other) {
    ambient = glm::max(ambient, other.ambient);
    diffuse = glm::max(diffuse, other.diffuse);
    specular = glm::max(specular, other.specular);
  }
};

/// An object that fog hides unless it is brighter than assumedColor().
struct Candidate {
  std::uint32_t object;
  Bounds box;    ///< world
  double depth;  ///< the least of the box along the view axis
  ReflectanceBound response;
};

/// Upper bounds of the light at points of a box, for any normal.
struct LightSum {
  glm::dvec3 ambient{0.0}, diffuse{0.0}, specular{0.0};
};

/// The parameters of a picture that all candidates share.
struct FogContext {
  const Scene& scene;
  glm::dvec3 eye;
  double emission = 0;  ///< the scene's brightest
  /// Factor of colours for fogLimit(): the exposure, times more for the part of the half step that the
  /// contrast of background and fog takes.
  double gain = 0;
};

/// Texels are at most 1, vertex colours may be more. In a scene without lighting the diffuse colour takes the
/// place of the ambient one.
ReflectanceBound reflectanceBound(const Scene& scene, const Object& object, Model model) {
  const Mesh& mesh = scene.meshes[object.mesh];
  glm::dvec3 tint(mesh.colors.empty() ? 1.0 : 0.0);
  for (const glm::vec4& color : mesh.colors) tint = glm::max(tint, glm::dvec3(color));
  ReflectanceBound response;
  const auto include = [&](const Material& material) {
    const glm::dvec3 diffuse(material.diffuse);
    const glm::dvec3 ambient = scene.lighting ? glm::dvec3(material.ambient) : diffuse;
    ReflectanceBound own{.ambient = ambient * tint};
    for (int c = 0; c < 3; ++c) {
      const ModelBounds most =
          modelBounds(material.model.value_or(model), material.specular[c], material.shininess);
      own.diffuse[c] = most.diffuse * diffuse[c] * tint[c];
      own.specular[c] = most.specular;
    }
    response.include(own);
  };
  if (object.material >= 0) {
    include(scene.materials[object.material]);
    return response;
  }
  std::vector<bool> is_covered(scene.materials.size());
  for (const std::uint32_t material : mesh.triangle_materials) {
    if (!is_covered[material]) include(scene.materials[material]);
    is_covered[material] = true;
  }
  return response;
}

/// Upper bound of the share of a light's colours that reaches points of a box; 0 if it is out of range.
double attenuationBound(const Light& light, const Bounds& box, const glm::dvec3& eye) {
  if (light.kind == LightKind::kDirectional) return 1;
  const glm::dvec3 nearest = glm::clamp(light.position, box.low, box.high);
  const glm::dvec3 farthest = glm::max(glm::abs(box.low - eye), glm::abs(box.high - eye));
  // Rounding of the kernels' positions, which is relative to their distance from the eye.
  const double lost = kSlack * (glm::length(farthest) + glm::distance(light.position, eye));
  const double distance = std::max(glm::distance(light.position, nearest) - lost, 0.0);
  if (distance >= light.range) return 0;
  const double window = 1 - std::pow(distance / light.range, 4);
  const glm::dvec3 attenuation(light.attenuation);
  const double strength = (light.window == RangeWindow::kSmooth ? window * window : window) /
                          (attenuation.x + distance * (attenuation.y + distance * attenuation.z));
  return std::min(strength, 0x1p100);  // the kernels' own cap, see kernels/shade/falloff.clh
}

/// Upper bound of the colour of surfaces with this response in this light, without exposure.
double brightestColor(const FogContext& fogged, const ReflectanceBound& response, const LightSum& light) {
  const glm::dvec3 ambient(fogged.scene.lighting ? fogged.scene.ambient : glm::vec3(1.0f));
  const glm::dvec3 color = (ambient + light.ambient) * response.ambient + light.diffuse * response.diffuse +
                           light.specular * response.specular;
  return (1 + kSlack) * (largest(color) + fogged.emission);
}

/// The brightness that every colour is assumed to have before lights are looked at. At least that of the fog,
/// because a black surface differs from the fog by as much.
double assumedColor(const FogContext& fogged) {
  return std::max({1.0, fogged.emission, largest(glm::dvec3(fogged.scene.fog.color))});
}

/// Least depth of a box along the view axis. A distance from the eye is never smaller, so it serves radial
/// fog as well.
double nearestDepth(const Bounds& box, const View& view) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec4 p((corner & 1 ? box.high : box.low).x, (corner & 2 ? box.high : box.low).y,
                       (corner & 4 ? box.high : box.low).z, 1.0);
    nearest = std::min(nearest, -(view.world_to_view * p).z);
  }
  return nearest;
}

/// Whether the first vertex of an object is nearer than a depth, and so its box as well.
bool hasNearVertex(const Scene& scene, const Object& object, const View& view, double depth) {
  const std::vector<glm::vec3>& positions = scene.meshes[object.mesh].positions;
  if (positions.empty()) return false;
  const glm::dvec4 p = view.world_to_view * (object.object_to_world * glm::dvec4(positions[0], 1));
  return -p.z <= (1 - kSlack) * depth;
}

/// Appends to `seen` the candidates that may be bright enough to be visible through the fog. lights: all that
/// may reach them. Tests the box around all candidates; if it may be visible, divides them into halves, each
/// with the lights that reach the box. Changes the candidates' order.
void addBright(const FogContext& fogged, std::span<Candidate> candidates,
               const std::vector<const Light*>& lights, std::vector<std::uint32_t>& seen) {
  Bounds box;
  double depth = std::numeric_limits<double>::infinity();
  ReflectanceBound response;
  for (const Candidate& candidate : candidates) {
    box.low = glm::min(box.low, candidate.box.low);
    box.high = glm::max(box.high, candidate.box.high);
    depth = std::min(depth, candidate.depth);
    response.include(candidate.response);
  }
  LightSum sum;
  std::vector<const Light*> reaching;
  for (const Light* light : lights) {
    const double strength = attenuationBound(*light, box, fogged.eye);
    if (strength == 0) continue;
    reaching.push_back(light);
    sum.ambient += strength * glm::dvec3(light->ambient);
    sum.diffuse += strength * glm::dvec3(light->diffuse);
    sum.specular += strength * glm::dvec3(light->specular);
  }
  const double brightest = std::max(assumedColor(fogged), brightestColor(fogged, response, sum));
  if ((1 - kSlack) * depth > fogLimit(fogged.scene.fog, brightest * fogged.gain)) return;
  if (candidates.size() == 1) {
    seen.push_back(candidates[0].object);
    return;
  }
  const glm::dvec3 size = box.high - box.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t half = candidates.size() / 2;
  std::nth_element(candidates.begin(), candidates.begin() + std::ptrdiff_t(half), candidates.end(),
                   [&](const Candidate& a, const Candidate& b) {
                     return a.box.low[axis] + a.box.high[axis] < b.box.low[axis] + b.box.high[axis];
                   });
  addBright(fogged, candidates.first(half), reaching, seen);
  addBright(fogged, candidates.subspan(half), reaching, seen);
}

}  // namespace

double fogLimit(const Fog& fog, double brightest) {
  const double infinite = std::numeric_limits<double>::infinity();
  const double share = kHalfStep / brightest;
  const double density = std::min({fog.density.x, fog.density.y, fog.density.z});
  switch (fog.mode) {
    case FogMode::kNone:
      return infinite;
    case FogMode::kLinear:
      return fog.end > fog.start ? fog.end - share * (fog.end - fog.start) : infinite;
    case FogMode::kExp:
      return density > 0 ? -std::log(share) / density : infinite;
    case FogMode::kExp2:
      return density > 0 ? std::sqrt(-std::log(share)) / density : infinite;
  }
  return infinite;
}

std::vector<std::uint32_t> objectsInSight(const Scene& scene, const View& view, float exposure, Model model) {
  if (environmentOf(scene)) return allObjects(scene);  // no sky has the fog's colour everywhere
  FogContext fogged{scene, glm::dvec3(glm::inverse(view.world_to_view)[3])};
  for (const Material& material : scene.materials)
    fogged.emission = std::max(fogged.emission, largest(glm::dvec3(material.emission)));
  const double exposed = std::exp2(std::max(exposure, 0.0f));
  const glm::dvec3 contrast = glm::abs(glm::dvec3(scene.background) - glm::dvec3(scene.fog.color));
  const double left = kHalfStep - exposed * largest(contrast);
  fogged.gain = exposed * kHalfStep / left;
  const double limit = fogLimit(scene.fog, assumedColor(fogged) * fogged.gain);
  if (left <= 0 || !std::isfinite(limit)) return allObjects(scene);
  std::vector<std::uint32_t> seen;
  std::vector<Candidate> candidates;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    if (hasNearVertex(scene, scene.objects[i], view, limit)) {
      seen.push_back(i);
      continue;
    }
    const Bounds box = objectBounds(scene, scene.objects[i]);
    const double depth = nearestDepth(box, view);
    if (depth <= limit)
      seen.push_back(i);
    else
      candidates.push_back({i, box, depth, reflectanceBound(scene, scene.objects[i], model)});
  }
  if (candidates.empty()) return seen;
  std::vector<const Light*> lights;
  if (scene.lighting)
    for (const Light& light : scene.lights) lights.push_back(&light);
  addBright(fogged, candidates, lights, seen);
  std::sort(seen.begin(), seen.end());
  return seen;
}

}  // namespace luciole
