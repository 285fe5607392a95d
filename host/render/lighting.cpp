#include "render/lighting.hpp"

#include "render/cull.hpp"
#include "render/shade.hpp"

namespace luciole {
namespace {

float4 color4(const glm::vec3& color) { return {color.x, color.y, color.z, 0}; }

ShadeFrame makeFrame(const Scene& scene, const Camera& camera, bool blinn) {
  ShadeFrame frame{};
  frame.ambient = color4(scene.lighting ? scene.ambient : glm::vec3(1.0f));
  frame.background = color4(scene.background);
  frame.fog_color = color4(scene.fog.color);
  frame.fog_density = color4(scene.fog.density);
  frame.eye = camera.orthographic ? float4{0, 0, 1, 0} : float4{0, 0, 0, 1};
  frame.fog_end = scene.fog.end;
  frame.fog_scale = 1.0f / (scene.fog.end - scene.fog.start);
  frame.fog_mode = static_cast<uint>(scene.fog.mode);
  frame.fog_radial = scene.fog.radial;
  frame.blinn = blinn;
  frame.light_count = scene.lighting ? static_cast<uint>(scene.lights.size()) : 0;
  return frame;
}
static_assert(int(FogMode::kLinear) == kFogLinear && int(FogMode::kExp) == kFogExp &&
              int(FogMode::kExp2) == kFogExp2);

/// Pixel-light pairs: a row of lanes with any covered pixel goes through its tile's whole list.
std::uint64_t evaluatedPairs(const GBuffer& gbuffer, int lanes, const std::vector<cl_uint>& starts,
                             std::size_t all_lights) {
  std::uint64_t pairs = 0;
  const float* depth = gbuffer.position.data() + 2 * gbuffer.pixels();
  for (std::size_t row = 0; row < gbuffer.pixels(); row += lanes) {
    bool covered = false;
    for (int lane = 0; lane < lanes; ++lane)
      covered |= depth[row + lane] > -std::numeric_limits<float>::infinity();
    const std::size_t tile = row / kTilePixels;
    if (covered)
      pairs += std::uint64_t(lanes) * (starts.empty() ? all_lights : starts[tile + 1] - starts[tile]);
  }
  return pairs;
}

GBufferBuffers uploadGBuffer(Device& device, const GBuffer& gbuffer, bool unlit) {
  return {inputBuffer(device, gbuffer.position),
          inputBuffer(device, gbuffer.normal),
          inputBuffer(device, gbuffer.diffuse),
          inputBuffer(device, gbuffer.specular),
          inputBuffer(device, unlit ? gbuffer.diffuse : gbuffer.ambient),
          inputBuffer(device, gbuffer.emission)};
}

}  // namespace

void prepareLighting(Device& device, const Scene& scene, const Camera& camera, const View& view,
                     const FeatureSet& features, const ShadeSettings& settings, Lighting& lighting,
                     Stats& stats) {
  lighting.features = features;
  lighting.math_defines = mathDefines(settings);
  lighting.unlit = !scene.lighting;
  lighting.frame = makeFrame(scene, camera, settings.blinn);
  if (features.shadows())
    lighting.host_shadows =
        timed(stats, "shadow maps", [&] { return drawShadowMaps(scene, view, settings.shadow_size); });
  timed(stats, "prepare lights", [&] {
    if (scene.lighting) lighting.host_lights = prepareLights(scene, camera, lighting.host_shadows);
    lighting.lights = inputBuffer(device, lighting.host_lights.lights);
    lighting.reach = inputBuffer(device, lighting.host_lights.reach);
    lighting.shadow_maps = inputBuffer(device, lighting.host_shadows.maps);
    lighting.shadow_depths = inputBuffer(device, lighting.host_shadows.depths);
  });
  lighting.bytes = lighting.host_lights.lights.size() * sizeof(ShadeLight) +
                   (lighting.host_lights.reach.size() + lighting.host_shadows.depths.size()) * sizeof(float);
}

LitPlanes lightGBuffer(Device& device, const Lighting& lighting, const FeatureSet& features,
                       const GBuffer& gbuffer, bool count_in_range, Stats& stats) {
  const std::size_t pixels = gbuffer.pixels();
  const std::string defines = featureDefines(features) + lighting.math_defines;
  const GBufferBuffers buffers = uploadGBuffer(device, gbuffer, lighting.unlit);
  LitPlanes lit;
  LightLists lists;
  std::vector<cl_uint> starts;
  if (features.has(Feature::kLightLists)) {
    lists = timed(stats, "cull", [&] {
      return cull(device, {.position = buffers.position,
                           .plane_stride = pixels,
                           .reach = lighting.reach,
                           .reach_stride = lighting.host_lights.reach_stride});
    });
    starts.resize(pixels / kTilePixels + 1);
    readBuffer(device, lists.starts, starts.data(), starts.size() * sizeof(cl_uint));
    lit.list_entries = lists.entries;
  }
  ShadeFrame frame = lighting.frame;
  frame.plane_stride = static_cast<uint>(pixels);
  lit.color.resize(pixels * (features.has(Feature::kOutputShadow) ? 4 : 3));
  const cl::Buffer image = deviceBuffer(device, lit.color.size() * sizeof(float));
  timed(stats, "shade", [&] {
    shade(device, defines,
          {.frame = frame,
           .gbuffer = buffers,
           .lights = lighting.lights,
           .lists = lists,
           .shadow_maps = lighting.shadow_maps,
           .shadow_depths = lighting.shadow_depths,
           .image = image});
  });
  timed(stats, "read back",
        [&] { readBuffer(device, image, lit.color.data(), lit.color.size() * sizeof(float)); });
  if (count_in_range) {
    lit.light_count.resize(pixels);
    const cl::Buffer counts = deviceBuffer(device, pixels * sizeof(float));
    countInRange(device, defines,
                 {.position = buffers.position,
                  .plane_stride = pixels,
                  .lights = lighting.lights,
                  .light_count = frame.light_count,
                  .lists = lists,
                  .counts = counts});
    readBuffer(device, counts, lit.light_count.data(), pixels * sizeof(float));
  }
  lit.evaluated = evaluatedPairs(gbuffer, device.description.lanes, starts, frame.light_count);
  const std::size_t planes = gbuffer.position.size() + gbuffer.normal.size() + gbuffer.diffuse.size() +
                             gbuffer.specular.size() + gbuffer.ambient.size() + gbuffer.emission.size() +
                             lit.color.size();
  stats.device_bytes = std::max(stats.device_bytes, planes * sizeof(float) + lighting.bytes + lists.bytes);
  return lit;
}

void compileKernels(Device& device, const FeatureSet& features, const ShadeSettings& settings, Stats& stats) {
  timed(stats, "compile kernels", [&] {
    GBuffer empty;  // one tile of background
    empty.tiles_x = empty.tiles_y = 1;
    empty.position.assign(3 * kTilePixels, -std::numeric_limits<float>::infinity());
    Lighting lighting;
    lighting.math_defines = mathDefines(settings);
    for (cl::Buffer* buffer :
         {&lighting.lights, &lighting.reach, &lighting.shadow_maps, &lighting.shadow_depths})
      *buffer = deviceBuffer(device, 0);
    Stats ignored;
    lightGBuffer(device, lighting, features, empty, false, ignored);
  });
}

}  // namespace luciole
