// Small pictures of random scenes, for a checking OpenCL runtime to watch the kernels that light them.
//
//   checked_pictures NUMBER    one of the pictures, any number
//   checked_pictures clustersL a picture by clusters of lights, L pixels side by side
//   checked_pictures raysL     rays from a G-buffer to lights, L boxes and triangles side by side
//   checked_pictures sampledL  a picture of sampled lights, L pixels side by side
//   checked_pictures MISTAKE   a kernel of mistake_probe.cl
#include <algorithm>
#include <bit>
#include <charconv>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <string_view>
#include <utility>

#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"
#include "lighting/light_gbuffer.hpp"
#include "luciole/primitives.hpp"
#include "raster/view.hpp"
#include "scene/models.hpp"
#include "shade/clustered_light.hpp"
#include "shadow/exact/light_rays.hpp"
#include "tools/bench/pair_visibility.hpp"

namespace luciole::test {
namespace {

constexpr int kWidth = 17, kHeight = 17;  // tiles cut on both sides

/// Buffers with the host's bytes in place look unwritten to Oclgrind 21.10, so they are copied.
void openChecked(int lanes, OpenedDevice& device) {
  openDevice(",lanes=" + std::to_string(lanes), device);
  device.shares_host_memory = false;
}

/// A box and a wall, for shadows.
void addObjects(const Camera& camera, Scene& scene) {
  scene.materials.emplace_back();
  scene.meshes.push_back(makePrimitive({.kind = PrimitiveKind::kBox}, 0));
  for (const auto& [depth, side] : {std::pair(-8.0, 2.0), std::pair(-25.0, 20.0)}) {
    const glm::dmat4 place = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, depth));
    scene.objects.push_back({0, camera.camera_to_world * glm::scale(place, glm::dvec3(side)), -1});
  }
}

/// Those of odd numbers have shadows that start above facets. Fifteen in a row have every fog with rows of 1,
/// 4 and 8 pixels (Oclgrind 21.10 takes a vector of 16 for unwritten where a function is called with it),
/// every shadow method with each of them, and either choice of all else. Three more have soft exact shadows,
/// the last one behind a material with holes.
///
/// One a process: where a buffer takes the place of a smaller one that was freed, Oclgrind 21.10 takes its
/// end for unwritten. That is also why nothing is rendered here, which lights more than one G-buffer.
void lightPicture(unsigned number) {
  constexpr int kLanes[] = {1, 4, 8};
  OpenedDevice device;
  openChecked(kLanes[number % 3], device);
  Random random(number);
  Camera camera = randomCamera(random);
  camera.orthographic = number % 4 == 3;
  const auto method =
      number < 15 ? static_cast<ShadowMethod>((number + number / 3) % 5) : ShadowMethod::kSoftExact;
  Scene scene = randomScene(camera, method == ShadowMethod::kOff ? kSumBlock + 2 : 12, random);
  for (std::size_t i = 0; i < scene.lights.size(); i += 2) scene.lights[i].shadow = true;
  if (method == ShadowMethod::kSoftExact)
    for (std::size_t i = 0; i < scene.lights.size(); i += 4)
      scene.lights[i].radius = scene.lights[i].half_angle = 0.2;
  scene.fog = randomFog(static_cast<FogMode>(number / 3 % 4), random);
  addObjects(camera, scene);
  // Its holes only the host knows.
  if (number == 17) scene.materials.back().alpha = scene.materials.back().alpha_cutoff = 0.5f;
  ShadeSettings settings;
  settings.shadows = method;
  settings.shadow_layer = true;
  settings.shadow_limits.size = 64;
  settings.model = kAllModels[(number + number / 4) % std::size(kAllModels)];
  settings.culling = number % 4 == 1 ? Culling::kNone : Culling::kTiles;

  // A point takes up to half a second. Beams take many together.
  const bool by_beams = method == ShadowMethod::kExact || method == ShadowMethod::kSoftExact;
  GBuffer gbuffer = randomGBuffer(camera, kWidth, kHeight, by_beams ? 0.3 : 0.9, random);
  if (number % 2 == 1) gbuffer.lift.resize(gbuffer.pixels(), 0.25f);
  const View view = cameraView(camera, {kWidth, kHeight});
  const FeatureSet features = neededFeatures(
      scene, camera, {.specular = true, .emission = true, .smooth = !gbuffer.lift.empty()}, settings);
  Lighting lighting;
  Stats stats;
  prepareLighting(device, scene, camera, view, features, settings, lighting, stats);
  // Without shadows, and if nobody asks for lists, many lights are culled and shaded by one kernel but for
  // single lanes. Its buffer of counts is freed, so nothing may be culled after it.
  const bool by_lists = features.shadows() || device.description.lanes == 1;
  lightGBuffer(device, scene, lighting,
               {lighting.lights, features, gbuffer, {.in_range = by_lists, .list_length = by_lists}}, stats);
  const ShadowMaps& shadows = lighting.maps.host;
  if (shadows.texels.empty()) return;
  std::vector<MapPair> pairs;
  for (std::uint32_t pixel = 0; pixel < 37; ++pixel)
    pairs.push_back({pixel, pixel / 9 % std::uint32_t(shadows.maps.size())});
  GBuffer with_facets = gbuffer;
  with_facets.geometric_normal.resize(gbuffer.pixels());
  pairVisibility(device, featureDefines(features) + mathDefines(settings), with_facets, shadows, pairs);
}

/// Makes of each two pixels side by side one point.
void pairPixels(GBuffer& gbuffer) {
  for (int y = 0; y < gbuffer.height; ++y)
    for (int x = 1; x < gbuffer.width; x += 2)
      for (Plane* plane : {&gbuffer.position, &gbuffer.normal, &gbuffer.diffuse, &gbuffer.specular,
                           &gbuffer.ambient, &gbuffer.emission})
        for (std::size_t at = 0; at < plane->size(); at += gbuffer.pixels())
          (*plane)[at + gbuffer.index(x, y)] = (*plane)[at + gbuffer.index(x - 1, y)];
}

/// Returns whether it gives any light.
bool lightByClusters(int lanes) {
  OpenedDevice device;
  openChecked(lanes, device);
  Random random(1);
  const Camera camera;
  // A point takes up to a second.
  GBuffer gbuffer = randomGBuffer(camera, kWidth, 9, 0.7, random);
  pairPixels(gbuffer);  // lit in groups
  // Half of the highlights are wide: series stand for those of lights and of clusters.
  const auto exponents = gbuffer.specular.end() - std::ptrdiff_t(gbuffer.pixels());
  std::fill(exponents, exponents + std::ptrdiff_t(gbuffer.pixels() / 2), 4.0f);
  std::vector<UnboundedLight> lights;
  for (int i = 0; i < 150; ++i) lights.push_back({10.0 * random.direction(), 0.1 * random.color(), 1});
  // So near each other that a series stands for the highlights of a cluster.
  for (int i = 0; i < 50; ++i)
    lights.push_back({20.0 * (glm::dvec3(0, 0, 1) + 0.005 * random.direction()), 20.0 * random.color(), 1});
  const LightClusters clusters = buildLightClusters(lights);
  ShadeFrame frame{};
  frame.plane_stride = uint(gbuffer.pixels());
  frame.eye = {0, 0, 0, 1};
  Plane light(3 * gbuffer.pixels()), bound(3 * gbuffer.pixels());
  const Buffer<float> light_buffer = borrowedForOutput(device, light);
  clusteredLight(device, mathDefines({}),
                 {.frame = frame,
                  .gbuffer = borrowedGBuffer(device, gbuffer, {}, {}, {}, {}, false),
                  .tiles_x = gbuffer.tiles_x,
                  .tiles_y = gbuffer.tiles_y,
                  .clusters = clusters,
                  .highlights = clusters,
                  .light_error = 1.0f / 16,
                  .light = light_buffer,
                  .bound = borrowedForOutput(device, bound)});
  download(device, light_buffer, light);
  return std::any_of(light.begin(), light.end(), [](float value) { return value > 0; });
}

/// Returns whether nothing blocks some of the rays, and something others.
bool traceRays(int lanes) {
  OpenedDevice device;
  openChecked(lanes, device);
  Random random(static_cast<unsigned>(lanes));
  const Camera camera = randomCamera(random);
  Scene scene;
  addObjects(camera, scene);
  BeamScene beams;
  prepareBeams(
      device, camera,
      std::make_shared<const TriangleTree>(buildTriangleTree(scene, glm::dvec3(camera.camera_to_world[3]))),
      nullptr, 0, beams);
  const GBuffer gbuffer = randomGBuffer(camera, kWidth, kHeight, 0.3, random);
  std::vector<BeamLight> lights;
  std::vector<LightRay> rays;
  for (uint i = 0; i < 75; ++i) {
    Light light;
    light.kind = i % 5 == 0 ? LightKind::kDirectional : LightKind::kPoint;
    light.direction = random.direction();
    light.position = camera.camera_to_world * glm::dvec4(10.0 * random.direction(), 1);
    lights.push_back(beamLight(light, true, beams));
    rays.push_back({i % 40, i});
  }
  std::vector<uint> lit(wordsForRays(rays.size()));
  FeatureSet features;
  const std::string defines = featureDefines(features);
  const Buffer<float> starts = makeBuffer<float>(device, 3 * gbuffer.pixels());
  rayStarts(device, defines,
            {.plane_stride = gbuffer.pixels(),
             .position = borrowed(device, gbuffer.position),
             .normal = borrowed(device, gbuffer.normal),
             .lift = {},
             .beams = beams},
            starts);
  const Buffer<uint> lit_buffer = makeBuffer<uint>(device, lit.size());
  traceLightRays(device, defines,
                 {.rays = borrowed(device, rays),
                  .ray_count = rays.size(),
                  .starts = starts,
                  .start_stride = gbuffer.pixels(),
                  .lights = borrowed(device, lights),
                  .beams = beams},
                 lit_buffer, {});
  download(device, lit_buffer, lit);
  int count = 0;
  for (const uint word : lit) count += std::popcount(word);
  return count > 0 && count < int(rays.size());
}

/// Returns whether some pixels get light, by picks that aren't sure.
bool lightBySamples(int lanes) {
  OpenedDevice device;
  openChecked(lanes, device);
  Random random(static_cast<unsigned>(lanes));
  const Camera camera = randomCamera(random);
  Scene scene;
  addObjects(camera, scene);
  scene.fog = randomFog(FogMode::kExp, random);
  for (int i = 0; i < 500; ++i) {
    Light light{.attenuation = {0, 0, 1}};
    light.diffuse = light.specular = 0.1 * random.color();
    light.position = camera.camera_to_world * glm::dvec4(10.0 * random.direction(), 1);
    light.shadow = i % 3 > 0;
    light.cell = 0.01f;
    // Not both kinds: oclgrind takes what a second launch writes to memory of the first for uninitialized.
    if (lanes == 4) light.kind = LightKind::kDirectional;
    light.direction = random.direction();
    if (lanes != 4 && i % 2 == 1) {
      light.kind = LightKind::kSpot;
      light.cutoff = glm::radians(90.0);
      light.exponent = 1;
    }
    scene.lights.push_back(light);
  }
  ShadeSettings settings;
  settings.shadows = ShadowMethod::kExact;
  settings.light_error = 0.5f;
  settings.always_clusters = true;
  // Each point is a group by itself.
  const GBuffer gbuffer = randomGBuffer(camera, 4, 1, 0, random);
  const View view = cameraView(camera, {4, 1});
  const FeatureSet features = neededFeatures(scene, camera, {.specular = true, .emission = true}, settings,
                                             {.sampled = true, .directions = true});
  Lighting lighting;
  Stats stats;
  prepareLighting(device, scene, camera, view, features, settings, lighting, stats);
  const LitPlanes lit =
      lightGBuffer(device, scene, lighting, {lighting.lights, features, gbuffer, {}}, stats);
  const auto isAny = [](const Plane& plane) {
    return std::any_of(plane.begin(), plane.end(), [](float value) { return value > 0; });
  };
  return isAny(lit.color) && isAny(lit.half_width);
}

void makeMistake(const char* mistake) {
  OpenedDevice device;
  openChecked(1, device);
  Kernel kernel = makeKernelFromSource(device, probeSource("mistake_probe.cl"), mistake, "");
  const Buffer<float> values = makeBuffer<float>(device, 16);
  launch(device, kernel, {{"values", values}}, {.items = 16, .group = 16});
  finish(device);
}

}  // namespace
}  // namespace luciole::test

int main(int, char** words) {
  const std::string_view word = words[1];
  unsigned number = 0;
  if (std::from_chars(word.data(), word.data() + word.size(), number).ec == std::errc()) {
    luciole::test::lightPicture(number);
  } else if (constexpr std::string_view kClusters = "clusters";
             word.substr(0, kClusters.size()) == kClusters) {
    return luciole::test::lightByClusters(word.back() - '0') ? 0 : 1;
  } else if (word.substr(0, 4) == "rays") {
    return luciole::test::traceRays(word.back() - '0') ? 0 : 1;
  } else if (word.substr(0, 7) == "sampled") {
    return luciole::test::lightBySamples(word.back() - '0') ? 0 : 1;
  } else {
    luciole::test::makeMistake(words[1]);
  }
}
