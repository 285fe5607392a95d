#include "tools/info/picture_work.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include "kernels/shared.h"
#include "render/memory.hpp"
#include "shade/clustered_light.hpp"
#include "shade/sampled_light.hpp"
#include "shade/shadow_ways.hpp"
#include "tools/info/scene_info.hpp"

namespace luciole {
namespace {

constexpr int kGridSide = 64;       ///< pixels a side of the grid, at most
constexpr double kMostTests = 1e8;  ///< of lights at points of the grid

/// A point that the picture shows; world space.
struct SeenPoint {
  glm::dvec3 position, normal;
  double square = 0, tile = 0;  ///< radii around it of what a square and a tile of the picture show, metres
};

/// Whether a square or tile of this radius around a point keeps a light in its list. Follows
/// kernels/lights/cull.cl.
bool reaches(const Light& light, const SeenPoint& point, double radius, bool by_facing) {
  if (light.kind == LightKind::kDirectional) return !by_facing || glm::dot(point.normal, light.direction) < 0;
  const glm::dvec3 way = point.position - light.position;
  const double distance = glm::length(way);
  if (distance >= light.range + radius || (by_facing && glm::dot(point.normal, way) >= radius)) return false;
  if (light.kind == LightKind::kPoint) return true;
  const double along = glm::dot(way, light.direction);
  const double across = std::sqrt(std::max(distance * distance - along * along, 0.0));
  return across * std::cos(light.cutoff) - along * std::sin(light.cutoff) < radius;
}

/// The surfaces that a grid of pixels shows. Sets `grid` to its number of pixels.
std::vector<SeenPoint> seenPoints(const Scene& scene, const RenderSettings& settings, double& grid) {
  const double shrink = std::min(1.0, double(kGridSide) / std::max(settings.size.x, settings.size.y));
  const glm::ivec2 size = glm::max(glm::ivec2(glm::round(glm::dvec2(settings.size) * shrink)), glm::ivec2(1));
  const Camera& camera = settings.camera;
  const GBuffer seen =
      rasterize(scene, allObjects(scene), cameraView(camera, size), Shading::kPhong, PlaneSet{});
  const auto vectorAt = [&](const Plane& plane, std::size_t i) {
    return glm::dvec3(plane[i], plane[i + seen.pixels()], plane[i + 2 * seen.pixels()]);
  };
  const glm::dmat3 rotation(camera.camera_to_world);
  std::vector<SeenPoint> points;
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const std::size_t i = seen.index(x, y);
      const glm::dvec3 place = vectorAt(seen.position, i), normal = vectorAt(seen.normal, i);
      if (!std::isfinite(place.z)) continue;
      const double pixel =
          2 * std::sqrt(camera.pixel_aspect) *
          (camera.orthographic ? camera.half_height : -place.z * std::tan(camera.fov_y / 2)) /
          settings.size.y;
      // Half the diagonal of what a square of pixels shows, longer the more the surface slants.
      const glm::dvec3 back = camera.orthographic ? glm::dvec3(0, 0, 1) : -glm::normalize(place);
      const double stretch = 1 / std::max(std::abs(glm::dot(normal, back)), 0.1);
      const double radius = 0.5 * pixel * std::sqrt(1 + stretch * stretch);
      points.push_back({glm::dvec3(camera.camera_to_world * glm::dvec4(place, 1)), rotation * normal,
                        settings.shade.tile_size * radius, double(kTileSize) * radius});
    }
  }
  grid = double(size.x) * size.y;
  return points;
}

/// How many lights there are on average for a point that is seen.
struct MeanLights {
  double square = 0;                 ///< in the list of its square
  double by_maps = 0, by_beams = 0;  ///< of these, those with shadows of either kind
  double tile = 0;                   ///< in that of its tile
};

/// Clusters count as the lights that would be as much work.
MeanLights meanLights(const Scene& scene, const View& view, const std::vector<SeenPoint>& points,
                      const FeatureSet& features, const ShadeSettings& settings) {
  struct Counts {
    std::size_t square = 0, by_maps = 0, by_beams = 0, tile = 0;
  };
  if (points.empty() || !scene.lighting) return {};
  const bool culled = features.has(Feature::kLightLists), by_facing = !features.has(Feature::kLightAmbient);
  const UseConditions conditions = useConditions(settings);
  const bool clustered = features.has(Feature::kClusteredLights);
  const double tests = double(points.size()) * double(scene.lights.size());
  const std::size_t step = std::size_t(std::ceil(std::max(tests / kMostTests, 1.0)));
  std::vector<Counts> counts((points.size() + step - 1) / step);
  tbb::parallel_for(std::size_t(0), counts.size(), [&](std::size_t i) {
    const SeenPoint& point = points[i * step];
    for (std::size_t k = 0; k < scene.lights.size(); ++k) {
      const Light& light = scene.lights[k];
      if (!isSummed(lightUse(light, conditions), features)) continue;
      if (culled && !reaches(light, point, point.tile, by_facing)) continue;
      ++counts[i].tile;
      if (culled && !reaches(light, point, point.square, by_facing)) continue;
      ++counts[i].square;
      const ShadowWay way = shadowWay(scene, k, settings);
      counts[i].by_maps += way == ShadowWay::kMap;
      counts[i].by_beams += way == ShadowWay::kBeams;
    }
  });
  MeanLights mean;
  for (const Counts& each : counts) {
    mean.square += double(each.square) / double(counts.size());
    mean.by_maps += double(each.by_maps) / double(counts.size());
    mean.by_beams += double(each.by_beams) / double(counts.size());
    mean.tile += double(each.tile) / double(counts.size());
  }
  if (clustered)
    mean.square += clusteredWork({countUses(scene.lights, conditions)[std::size_t(LightUse::kClustered)],
                                  settings.light_error, features.has(Feature::kClusteredHighlights)},
                                 view);
  return mean;
}

template <class T, class Allocator>
double bytesOf(const std::vector<T, Allocator>& values) {
  return double(values.size() * sizeof(T));
}

double sceneBytes(const Scene& scene) {
  double bytes = 0;
  const auto add = [&](const Mesh& mesh) {
    bytes += bytesOf(mesh.positions) + bytesOf(mesh.normals) + bytesOf(mesh.uvs) +
             bytesOf(mesh.emission_uvs) + bytesOf(mesh.tangents) + bytesOf(mesh.normal_uvs) +
             bytesOf(mesh.lightmap_uvs) + bytesOf(mesh.colors) + bytesOf(mesh.triangles) +
             bytesOf(mesh.triangle_materials);
  };
  for (const Mesh& mesh : scene.meshes) {
    add(mesh);
    if (mesh.divided) add(*mesh.divided);
  }
  for (const Texture& texture : scene.textures)
    for (const MipLevel& level : texture.levels) bytes += bytesOf(level.texels);
  return bytes;
}

/// About the most texels that are decoded at the same time.
double decodedTexels(const Scene& scene) {
  double largest = 0;
  for (const Texture& texture : scene.textures)
    if (!texture.levels.empty())
      largest = std::max(largest, double(texture.levels[0].width) * texture.levels[0].height);
  return largest * double(std::min<std::size_t>(scene.textures.size(), std::thread::hardware_concurrency()));
}

/// The vertices that Gouraud shading lights.
double litVertices(const Scene& scene) {
  double vertices = 0;
  for (const Object& object : scene.objects) {
    const Mesh& mesh = scene.meshes[object.mesh];
    vertices += double((mesh.divided ? *mesh.divided : mesh).positions.size());
  }
  return vertices;
}

}  // namespace

PictureWork pictureWork(const Scene& scene, const RenderSettings& settings, const PicturePlan& plan) {
  const View view = cameraView(settings.camera, settings.size);
  const SceneInfo info = sceneInfo(scene);
  double grid = 0;
  const std::vector<SeenPoint> points = seenPoints(scene, settings, grid);
  const ShadeSettings& shade = plan.shade;
  const MeanLights mean = meanLights(scene, view, points, plan.features, shade);
  const double pixels = double(settings.size.x) * settings.size.y, covered = double(points.size()) / grid;
  const bool gouraud = settings.shading == Shading::kGouraud;
  const int passes = plan.shares_samples ? 1 : settings.samples;
  const double shadings = shadedPoints(scene, settings.size, settings.samples, plan.shares_samples);
  const double shaded = gouraud ? litVertices(scene) : pixels * covered * shadings;
  PictureWork work{.pixels = pixels,
                   .samples = settings.samples,
                   .passes = passes,
                   .shadings = shadings,
                   .triangles = double(info.triangles),
                   .mesh_triangles = double(info.mesh_triangles),
                   .texels = double(info.texels),
                   .decoded_texels = decodedTexels(scene),
                   .textured = info.texels > 0 ? pixels * covered : 0,
                   .frames_scene = scene.adds_camera || scene.adds_lights,
                   .lights = double(scene.lights.size()),
                   .pairs = shaded * mean.square,
                   .scene_bytes = sceneBytes(scene)};
  if (plan.features.sampledLight()) {
    const UseConditions conditions = useConditions(shade);
    const LightUseCounts counts = countUses(scene.lights, conditions);
    for (const LightUse use : {LightUse::kSampled, LightUse::kSampledDirection})
      if (!isSummed(use, plan.features))
        work.sampling += sampledMilliseconds(
            {counts[std::size_t(use)], countCasting(scene.lights, use, conditions), shaded, work.triangles},
            shade);
  }
  if (plan.features.has(Feature::kLightLists)) {
    work.list_entries = shaded / double(kTilePixels) * mean.tile;
    work.tree_levels = std::log(double(scene.lights.size())) / std::log(double(kTreeArity));
  }
  const double pixel_bytes = double(plan.pixel_bytes);
  const int rows = std::min(bandHeight(settings.size, std::size_t(pixel_bytes)), settings.size.y);
  work.bands = (settings.size.y + rows - 1) / rows;
  work.pixel_bytes =
      pixel_bytes * settings.size.x * rows + (gouraud ? shaded * double(kGBufferBytesPerPixel) : 0);
  if (!plan.features.shadows()) return work;
  work.shadows = settings.shade.shadows;
  work.shadow_pairs = shaded * mean.by_maps;
  work.beam_pairs = shaded * mean.by_beams;
  if (plan.features.has(Feature::kSoftExact)) work.soft_samples = shade.soft_samples;
  if (!plan.features.shadowMaps()) return work;
  const ShadowMaps maps = planShadowMaps(scene, view, shade.shadows, shade.shadow_limits, shade.shadow_ways);
  work.shadow_texels = 0.5 * double(maps.planned_texels);  // a camera sees about half of what lights do
  work.shadow_faces = double(maps.planned.size());
  work.shadow_map_bytes = work.shadow_texels * double(sizeof(ShadowTexel));
  return work;
}

}  // namespace luciole
