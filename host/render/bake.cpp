#include "render/bake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "luciole/error.hpp"
#include "raster/lift.hpp"
#include "raster/surface_ids.hpp"
#include "raster/texture_space.hpp"
#include "render/change_surfaces.hpp"
#include "render/dilate.hpp"
#include "render/render.hpp"
#include "render/validate.hpp"
#include "scene/bounds.hpp"
#include "shade/features.hpp"

namespace luciole {
namespace {

/// Texels around charts that get their neighbours' light: a copy of a sixteenth of the size is clean, too.
constexpr int kSeamTexels = 16;
/// Texels may belong to two triangles where charts touch. Beyond this share of them charts lie on each other.
constexpr double kMostOverlap = 0.01;

/// Throws InputError for what a map can't have.
void checkBake(const Scene& scene, std::uint32_t object, const BakeSettings& bake,
               const RenderSettings& settings) {
  validate(scene, settings);
  if (object >= scene.objects.size())
    throw InputError(
        fmt::format("object: {}, but the number of objects is {}", object, scene.objects.size()));
  if (wantsSurfaceIds(settings))
    throw InputError(
        "settings.aovs: a map shows one object; render makes object_id, material_id and cryptomatte");
  if (!bake.eye) return;
  if (!(std::isfinite(bake.eye->x) && std::isfinite(bake.eye->y) && std::isfinite(bake.eye->z)))
    throw InputError(fmt::format("bake.eye: ({}, {}, {}), expected finite numbers", bake.eye->x, bake.eye->y,
                                 bake.eye->z));
  const ShadowMethod shadows = settings.shade.shadows;
  if (shadows == ShadowMethod::kHard || shadows == ShadowMethod::kPcf || shadows == ShadowMethod::kSoft)
    throw InputError(
        "settings.shade.shadows: maps of a sun follow a camera, which bake.eye isn't; expected kExact, "
        "kSoftExact or kOff");
}

/// A camera that sees all of the object: from the eye, or parallel from outside of it.
Camera bakeCamera(const Scene& scene, std::uint32_t object, const BakeSettings& bake) {
  Camera camera;
  if (bake.eye) {
    camera.camera_to_world[3] = glm::dvec4(*bake.eye, 1);
    return camera;
  }
  const Bounds box = objectBounds(scene, scene.objects[object]);
  const double radius = std::max(0.5 * glm::length(box.high - box.low), 1e-6);
  const glm::dvec3 middle = 0.5 * (box.low + box.high);
  camera.orthographic = true;
  camera.half_height = radius;
  camera.near = radius;
  camera.far = 3 * radius;
  camera.camera_to_world[3] = glm::dvec4(middle + glm::dvec3(0, 0, 2 * radius), 1);
  return camera;
}

/// Takes from surfaces what depends on where they are seen from, or what colour they are.
void keepLightOnly(const BakeSettings& bake, GBuffer& gbuffer) {
  if (!bake.eye) std::fill(gbuffer.specular.begin(), gbuffer.specular.end(), 0.0f);
  if (!bake.irradiance) return;
  for (Plane* color : {&gbuffer.diffuse, &gbuffer.ambient}) std::fill(color->begin(), color->end(), 1.0f);
  std::fill(gbuffer.emission.begin(), gbuffer.emission.end(), 0.0f);
}

std::vector<std::uint8_t> shownTexels(const GBuffer& gbuffer) {
  std::vector<std::uint8_t> shows(std::size_t(gbuffer.width) * gbuffer.height);
  for (int y = 0; y < gbuffer.height; ++y)
    for (int x = 0; x < gbuffer.width; ++x)
      shows[std::size_t(y) * gbuffer.width + x] =
          std::isfinite(gbuffer.position[gbuffer.index(x, y) + 2 * gbuffer.pixels()]);
  return shows;
}

/// Throws InputError where charts lie on each other. Returns a warning of texels where they touch, or "".
std::string checkOverlap(const std::string& name, const TextureSpace& space) {
  const std::string some = fmt::format("{} of {} texels of {} lie in more than one triangle",
                                       space.overlapping, space.covered, name);
  if (double(space.overlapping) > kMostOverlap * double(space.covered))
    throw InputError(some +
                     ": its charts overlap, expected texture coordinates of which no two places share one");
  return space.overlapping > 0 ? some : "";
}

}  // namespace

Image bakeMap(OpenedDevice& device, const Scene& scene, std::uint32_t object, const BakeSettings& bake,
              RenderSettings settings, Stats& stats) {
  settings.camera = {};
  checkBake(scene, object, bake, settings);
  settings.camera = bakeCamera(scene, object, bake);
  if (bake.eye && settings.shade.shadows == ShadowMethod::kAuto)
    settings.shade.shadows = ShadowMethod::kExact;
  const SurfaceTraits traits = materialTraits(scene);
  const SurfaceProgram program = surfaceProgram(settings.surfaces);
  settings.surfaces.clear();  // they come before what is kept of the light
  TextureSpace space = timed(stats, Stage::kRasterize, [&] {
    PlaneSet planes{.specular = true,
                    .ambient = true,
                    .emission = true,
                    .geometric_normal = !traits.normal_maps,
                    .unbent_normal = traits.normal_maps,
                    .lift = hasBentCorners(scene),
                    .model = traits.models.to_ulong() > 1};
    addGroups(program, planes);
    return rasterizeTextureSpace(scene, object, settings.size, settings.camera, planes);
  });
  const std::string warning = checkOverlap(objectNames(scene)[object], space);
  prepareForSurfaces(program, space.gbuffer);
  changeSurfaces(device, program, space.gbuffer, stats);
  keepLightOnly(bake, space.gbuffer);
  Image map = shadeGBuffer(device, scene, space.gbuffer, settings, stats);
  if (!warning.empty()) stats.warnings.push_back(warning);
  timed(stats, Stage::kResolve, [&] {
    if (!settings.alpha) dilate(map, shownTexels(space.gbuffer), kSeamTexels);
  });
  return map;
}

}  // namespace luciole
