#include "render/lighting.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "culling/cull.hpp"
#include "culling/exact_reason.hpp"
#include "gbuffer/packed_normal.hpp"
#include "render/count_in_range.hpp"
#include "render/find_needed.hpp"
#include "render/seen_rounding.hpp"
#include "render/shade.hpp"
#include "render/shade_tiles.hpp"
#include "shadow/draw_shadow_maps.hpp"

namespace luciole {
namespace {

float4 color4(const glm::vec3& color) { return {color.x, color.y, color.z, 0}; }

/// log2 of the pixels in a square of this side.
unsigned groupLog2(int tile_size) { return tile_size == 4 ? 4 : tile_size == 8 ? 6 : 8; }

ShadeFrame makeFrame(const Scene& scene, const Camera& camera, const ShadeSettings& settings) {
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
  frame.model = static_cast<uint>(settings.model);
  return frame;
}
static_assert(int(FogMode::kLinear) == kFogLinear && int(FogMode::kExp) == kFogExp &&
              int(FogMode::kExp2) == kFogExp2);

/// The index, among all tiles' squares, of the square that holds the pixel at a place in the planes.
std::size_t squareOf(std::size_t place) {
  return place / kTilePixels * kSquaresPerTile + SQUARE_OF_PIXEL(place);
}

/// How many of the lights that `counts` says the pixels of each square are shaded with: those in its list, or
/// without lists all.
template <class Predicate>
std::vector<std::uint32_t> squareLengths(Device& device, const LightLists* lists, std::size_t tiles,
                                         const LightArray& lights, Predicate&& counts) {
  if (!lists)
    return std::vector<std::uint32_t>(tiles * kSquaresPerTile,
                                      std::uint32_t(std::count_if(lights.begin(), lights.end(), counts)));
  std::vector<std::uint32_t> lengths(tiles * kSquaresPerTile);
  std::vector<uint> starts(lists->tiles + 1);
  std::vector<ListEntry> entries(lists->entries);
  download(device, lists->starts, starts);
  download(device, lists->list, entries);
  for (std::size_t tile = 0; tile < tiles; ++tile)
    for (std::size_t entry = starts[tile]; entry < starts[tile + 1]; ++entry)
      for (int square = 0; square < kSquaresPerTile && counts(lights[entries[entry].light]); ++square)
        lengths[tile * kSquaresPerTile + square] += entries[entry].squares >> square & 1;
  return lengths;
}

/// Number of pixel-light pairs that the shade kernel computes: a row of lanes with a covered pixel goes
/// through the lights of its square in all its lanes.
std::uint64_t evaluatedPairs(const GBuffer& gbuffer, const std::vector<std::uint32_t>& square_lengths,
                             int lanes) {
  const float* depth = gbuffer.position.data() + 2 * gbuffer.pixels();
  std::uint64_t pairs = 0;
  for (std::size_t row = 0; row < gbuffer.pixels(); row += lanes) {
    bool covered = false;
    for (int lane = 0; lane < lanes; ++lane)
      covered |= depth[row + lane] > -std::numeric_limits<float>::infinity();
    if (covered) pairs += std::uint64_t(lanes) * square_lengths[squareOf(row)];
  }
  return pairs;
}

/// The shading normals, packed: they stand in for geometric normals in a G-buffer that has none.
PackedNormals packNormals(const GBuffer& gbuffer) {
  const std::size_t pixels = gbuffer.pixels();
  PackedNormals packed(pixels);
  tbb::parallel_for(std::size_t(0), pixels, [&](std::size_t i) {
    const glm::dvec3 normal(gbuffer.normal[i], gbuffer.normal[i + pixels], gbuffer.normal[i + 2 * pixels]);
    if (normal != glm::dvec3(0.0)) packed[i] = packNormal(normal);
  });
  return packed;
}

void cullLights(Device& device, const Lighting& lighting, const GBufferBuffers& buffers, std::size_t pixels,
                unsigned tests, LightLists& lists) {
  cull(device,
       {.position = buffers.position,
        .normal = buffers.normal,
        .plane_stride = pixels,
        .group_log2 = lighting.group_log2,
        .lights = lighting.lights,
        .light_count = lighting.frame.light_count,
        .tree = lighting.tree,
        .tree_stride = lighting.host_tree.stride,
        .tests = tests},
       lists);
}

/// Borrows the buffers of lights and shadow maps from their arrays on the host.
void uploadLighting(Device& device, Lighting& lighting) {
  lighting.lights = borrowed(device, lighting.host_lights);
  lighting.tree = borrowed(device, lighting.host_tree.planes);
  lighting.shadow_maps = borrowed(device, lighting.host_shadows.maps);
  lighting.shadow_faces = borrowed(device, lighting.host_shadows.faces);
  lighting.shadow_texels = borrowed(device, lighting.host_shadows.texels);
}

Lookups lookupsOf(const Lighting& lighting, const GBufferBuffers& buffers, const LightLists& lists,
                  std::size_t pixels) {
  return {.plane_stride = pixels,
          .position = buffers.position,
          .normal = buffers.normal,
          .lift = buffers.lift,
          .lights = lighting.lights,
          .light_count = lighting.frame.light_count,
          .lists = lists,
          .shadow_maps = lighting.shadow_maps,
          .shadow_faces = lighting.shadow_faces};
}

/// Draws those parts of the shadow maps that shading the G-buffer will read and that aren't drawn yet.
void drawShadowMaps(Device& device, const Scene& scene, Lighting& lighting, const std::string& defines,
                    const GBufferBuffers& buffers, const LightLists& lists, std::size_t pixels,
                    Stats& stats) {
  ShadowMaps& shadows = lighting.host_shadows;
  const std::vector<std::uint32_t> needed = timed(stats, Stage::kFindShadowTexels, [&] {
    return findNeeded(device, defines, lookupsOf(lighting, buffers, lists, pixels), shadows.bin_count);
  });
  timed(stats, Stage::kShadowMaps, [&] {
    giveBack(lighting.shadow_faces);
    giveBack(lighting.shadow_texels);
    const std::vector<IndexRange> drawn = drawNeeded(scene, needed, shadows);
    const std::vector<IndexRange> faces(drawn.empty() ? 0 : 1, {0, shadows.faces.size()});
    refresh(device, shadows.faces, faces, lighting.shadow_faces);
    refresh(device, shadows.texels, drawn, lighting.shadow_texels);
  });
}

/// The exact shadows of all entries of the lists. Sets `traced` to the pairs that took rays.
PairShadows decideShadows(Device& device, const Scene& scene, const Lighting& lighting,
                          const FeatureSet& features, const GBuffer& gbuffer, const GBufferBuffers& buffers,
                          const LightLists& lists, TracedPairs& traced, Stats& stats) {
  PairShadows shadows = timed(stats, Stage::kBeamShadows, [&] {
    return beamShadows(device, featureDefines(beamFeatures(features)),
                       {.plane_stride = gbuffer.pixels(),
                        .position = buffers.position,
                        .normal = buffers.normal,
                        .lift = buffers.lift,
                        .lists = lists,
                        .beams = lighting.beams,
                        .holes = features.has(Feature::kHoles),
                        .soft = features.has(Feature::kSoftExact)});
  });
  if (!shadows.unsure.empty())
    traced = timed(stats, Stage::kShadowRays, [&] {
      return tracePairs(device, scene, lighting.beams, gbuffer, lists, features.has(Feature::kSoftExact),
                        shadows);
    });
  return shadows;
}

/// How many lights have each pixel in their range.
Plane lightsInRange(Device& device, Lighting& lighting, const GBufferBuffers& buffers, std::size_t pixels) {
  cullLights(device, lighting, buffers, pixels, kByRange, lighting.lists_in_range);
  Plane result(pixels);
  const Buffer<float> counts = borrowedForOutput(device, result);
  countInRange(device, {.position = buffers.position,
                        .plane_stride = pixels,
                        .lights = lighting.lights,
                        .lists = lighting.lists_in_range,
                        .counts = counts});
  download(device, counts, result);
  return result;
}

/// Whether culling and shading go together, without lists in memory: where nothing else reads them and there
/// are many lights. A few are faster by lists, whose rows of pixels are lit four side by side. A device of
/// single lanes has far more threads than a picture has blocks of tiles.
bool needsNoLists(const Device& device, const Lighting& lighting, const FeatureSet& features,
                  const PixelCounts& counts) {
  return features.has(Feature::kLightLists) && features.has(Feature::kLongSums) && !features.shadows() &&
         !counts.list_length && lighting.group_log2 == 4 && device.description.lanes > 1;
}

/// Fills in the counts that are asked for. lists: that pixels were shaded with; null if with all lights.
void countLights(Device& device, Lighting& lighting, const LightLists* lists, const GBuffer& gbuffer,
                 const GBufferBuffers& buffers, const PixelCounts& counts, LitPlanes& lit) {
  const std::size_t pixels = gbuffer.pixels();
  if (counts.in_range) lit.light_count = lightsInRange(device, lighting, buffers, pixels);
  if (!counts.evaluated && !counts.list_length) return;
  const auto lengthsOf = [&](auto&& counted) {
    return squareLengths(device, lists, pixels / kTilePixels, lighting.host_lights, counted);
  };
  const std::vector<std::uint32_t> square_lengths = lengthsOf([](const ShadeLight&) { return true; });
  if (counts.evaluated) {
    const int lanes = device.description.lanes;
    lit.evaluated = evaluatedPairs(gbuffer, square_lengths, lanes);
    if (lighting.features.has(Feature::kExact))
      lit.by_beams = evaluatedPairs(
          gbuffer, lengthsOf([](const ShadeLight& light) { return light.shadow == kExactShadow; }), lanes);
    if (lighting.features.shadowMaps())
      lit.by_maps = evaluatedPairs(
          gbuffer, lengthsOf([](const ShadeLight& light) { return light.shadow < kExactShadow; }), lanes);
  }
  if (!counts.list_length) return;
  lit.list_length.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) lit.list_length[i] = float(square_lengths[squareOf(i)]);
}

/// The lights that clusters may stand for.
std::vector<std::uint32_t> clusterable(const Scene& scene, const LightUse& use) {
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (exactReason(scene.lights[i], use) == ExactReason::kNone) chosen.push_back(std::uint32_t(i));
  return chosen;
}

/// The clusters of these lights in the camera's view space. color: Light::diffuse or Light::specular.
LightClusters clustersOf(const Scene& scene, const Camera& camera, const std::vector<std::uint32_t>& chosen,
                         glm::vec3 Light::*color) {
  const glm::dmat4 world_to_view = worldToView(camera);
  std::vector<UnboundedLight> lights(chosen.size());
  tbb::parallel_for(std::size_t(0), chosen.size(), [&](std::size_t i) {
    const Light& light = scene.lights[chosen[i]];
    lights[i] = {glm::dvec3(world_to_view * glm::dvec4(light.position, 1)), glm::dvec3(light.*color),
                 light.attenuation.z};
  });
  return buildLightClusters(lights);
}

/// Fills in the clusters that the features need.
void prepareClusters(const Scene& scene, const Camera& camera, const FeatureSet& features,
                     const ShadeSettings& settings, Lighting& lighting) {
  const std::vector<std::uint32_t> chosen = clusterable(scene, lightUse(settings));
  const bool one_color = std::all_of(chosen.begin(), chosen.end(), [&](std::uint32_t light) {
    return scene.lights[light].diffuse == scene.lights[light].specular;
  });
  lighting.clusters = clustersOf(scene, camera, chosen, &Light::diffuse);
  if (features.has(Feature::kClusteredHighlights) && !one_color)
    lighting.highlight_clusters = clustersOf(scene, camera, chosen, &Light::specular);
  lighting.clustered_lights = chosen.size();
  lighting.light_error = settings.light_error;
}

/// Lights the G-buffer by clusters, and sets the bounds. Returns planes r g b of that light and the
/// G-buffer's emission together.
Plane lightByClusters(Device& device, const Lighting& lighting, const FeatureSet& features,
                      const ShadeFrame& frame, const GBuffer& gbuffer, const GBufferBuffers& buffers,
                      LitPlanes& lit) {
  Plane light(3 * gbuffer.pixels());
  lit.light_error.resize(light.size());
  {
    const Buffer<float> light_buffer = borrowedForOutput(device, light);
    const Buffer<float> bound_buffer = borrowedForOutput(device, lit.light_error);
    lit.clustered =
        clusteredLight(device, featureDefines(clusterFeatures(features)) + lighting.math_defines,
                       {.frame = frame,
                        .gbuffer = buffers,
                        .tiles_x = gbuffer.tiles_x,
                        .tiles_y = gbuffer.tiles_y,
                        .clusters = lighting.clusters,
                        .highlights = lighting.highlight_clusters.rows.empty() ? lighting.clusters
                                                                               : lighting.highlight_clusters,
                        .light_error = clusteredError(lighting.light_error, frame, features),
                        .light = light_buffer,
                        .bound = bound_buffer});
    download(device, light_buffer, light);
    download(device, bound_buffer, lit.light_error);
  }
  if (!gbuffer.emission.empty())
    tbb::parallel_for(std::size_t(0), light.size(), [&](std::size_t i) { light[i] += gbuffer.emission[i]; });
  return light;
}

}  // namespace

void prepareLighting(Device& device, const Scene& scene, const Camera& camera, const View& view,
                     const FeatureSet& features, const ShadeSettings& settings, Lighting& lighting,
                     Stats& stats, KeptShadows* kept) {
  KeptShadows none;
  if (!kept) kept = &none;
  lighting.features = features;
  lighting.math_defines = mathDefines(settings);
  lighting.unlit = !scene.lighting;
  lighting.frame = makeFrame(scene, camera, settings);
  lighting.group_log2 = groupLog2(settings.tile_size);
  if (features.shadowMaps())
    timed(stats, Stage::kShadowMaps, [&] {
      lighting.host_shadows =
          planShadowMaps(scene, view, settings.shadows, settings.shadow_limits, settings.shadow_ways);
      takeMaps(scene, *kept, lighting.host_shadows);
    });
  if (features.has(Feature::kExact))
    timed(stats, Stage::kTriangleTree, [&] {
      updateTree(scene, glm::dvec3(camera.camera_to_world[3]), features.has(Feature::kHoles), *kept);
    });
  timed(stats, Stage::kWaitForDevice, [&] { awaitDevice(device); });
  timed(stats, Stage::kPrepareLights, [&] {
    if (scene.lighting) {
      const bool clustered = features.has(Feature::kClusteredLights);
      if (clustered) prepareClusters(scene, camera, features, settings, lighting);
      std::vector<std::uint32_t> order;
      if (lighting.clustered_lights < scene.lights.size()) order = spatialOrder(scene.lights);
      if (clustered)
        std::erase_if(order, [&](std::uint32_t light) {
          return exactReason(scene.lights[light], lightUse(settings)) == ExactReason::kNone;
        });
      lighting.host_lights = prepareLights(scene, order, camera, lighting.host_shadows);
      if (features.has(Feature::kExact)) {
        std::vector<std::uint8_t> casts;
        for (const std::uint32_t light : order)
          casts.push_back(shadowWay(scene, light, settings) == ShadowWay::kBeams);
        prepareBeams(device, scene, camera, kept->tree, features.has(Feature::kHoles) ? kept->masks : nullptr,
                     order, casts, lighting.host_lights,
                     features.has(Feature::kSoftExact) ? settings.soft_samples : 0, lighting.beams);
      }
      lighting.light_order = std::move(order);
    }
    lighting.frame.light_count = static_cast<uint>(lighting.host_lights.size());
    lighting.host_tree = buildLightTree(lighting.host_lights);
    uploadLighting(device, lighting);
  });
  std::size_t floats = lighting.host_tree.planes.size();
  for (const LightClusters* clusters : {&lighting.clusters, &lighting.highlight_clusters})
    floats += clusters->rows.size() + clusters->light_rows.size();
  lighting.bytes = lighting.host_lights.size() * sizeof(ShadeLight) + floats * sizeof(float);
}

LitPlanes lightGBuffer(Device& device, const Scene& scene, Lighting& lighting, const FeatureSet& features,
                       const GBuffer& gbuffer, const PixelCounts& counts, Stats& stats, Plane used) {
  const std::size_t pixels = gbuffer.pixels();
  const std::string defines = featureDefines(features) + lighting.math_defines;
  const std::string lookup_defines = featureDefines(lookupFeatures(features));
  PackedNormals packed;
  if ((features.shadowMaps() || features.has(Feature::kNormalMaps)) && gbuffer.geometric_normal.empty())
    packed = packNormals(gbuffer);
  const PackedNormals& geometric_normal = packed.empty() ? gbuffer.geometric_normal : packed;
  Plane level;  // lifts of 0, for a G-buffer without lifts
  if (features.has(Feature::kLift) && gbuffer.lift.empty()) level.resize(pixels);
  const Plane& lift = level.empty() ? gbuffer.lift : level;
  ModelPlane of_picture;  // the picture's model, for a G-buffer without models
  if (features.has(Feature::kMaterialModels) && gbuffer.model.empty()) of_picture.resize(pixels);
  const ModelPlane& model = of_picture.empty() ? gbuffer.model : of_picture;
  Plane emission;  // with the light of clusters
  GBufferBuffers buffers = borrowedGBuffer(device, gbuffer, geometric_normal, lift, model, lighting.unlit);
  LitPlanes lit;
  lit.color = std::move(used);
  const bool together = needsNoLists(device, lighting, features, counts);
  const bool culled = features.has(Feature::kLightLists) && !together;
  const LightLists none;
  const LightLists& lists = culled ? lighting.lists : none;
  if (culled) {
    const unsigned tests = kByCone | (features.has(Feature::kLightAmbient) ? 0 : kByFacing);
    timed(stats, Stage::kCull, [&] { cullLights(device, lighting, buffers, pixels, tests, lighting.lists); });
    lit.list_entries = lists.entries;
  }
  if (features.shadowMaps() && !lighting.host_shadows.maps.empty())
    drawShadowMaps(device, scene, lighting, lookup_defines, buffers, lists, pixels, stats);
  const ShadowMaps& shadows = lighting.host_shadows;
  if (features.has(Feature::kExact))
    lit.pairs = decideShadows(device, scene, lighting, features, gbuffer, buffers, lists, lit.traced, stats);
  // Without lights of a size tracePairs() has set the bits of those that were unsure.
  if (!features.has(Feature::kSoftExact)) lit.pairs.unsure = {};
  const Buffer<const uint> pair_bits = borrowed(device, lit.pairs.lit),
                           ray_bits = borrowed(device, lit.pairs.unsure),
                           first_share = borrowed(device, lit.pairs.first_share);
  const Buffer<const float> shares = borrowed(device, lit.pairs.shares);
  ShadeFrame frame = lighting.frame;
  frame.plane_stride = static_cast<uint>(pixels);
  frame.texel_count = static_cast<uint>(std::max<std::size_t>(shadows.texels.size(), 1));
  if (features.has(Feature::kClusteredLights)) {
    emission = timed(stats, Stage::kClusteredLight, [&] {
      return lightByClusters(device, lighting, features, frame, gbuffer, buffers, lit);
    });
    buffers.emission = borrowed(device, emission);
  }
  lit.color.resize(pixels * (features.has(Feature::kOutputShadow) ? 4 : 3));
  const Buffer<float> image = borrowedForOutput(device, lit.color);
  timed(stats, Stage::kShade, [&] {
    if (together) {
      const TileBlock block = chooseBlock(gbuffer.tiles_x, gbuffer.tiles_y, device.description.compute_units);
      const TileCounts tiles = shadeTiles(device, defines,
                                          {.frame = frame,
                                           .gbuffer = buffers,
                                           .tiles_x = gbuffer.tiles_x,
                                           .tiles_y = gbuffer.tiles_y,
                                           .block = block,
                                           .lights = lighting.lights,
                                           .tree = lighting.tree,
                                           .tree_stride = lighting.host_tree.stride,
                                           .image = image});
      lit.list_entries = tiles.entries;
      lit.evaluated = tiles.pairs;
      return;
    }
    shade(device, defines,
          {.frame = frame,
           .gbuffer = buffers,
           .lights = lighting.lights,
           .lists = lists,
           .shadow_maps = lighting.shadow_maps,
           .shadow_faces = lighting.shadow_faces,
           .shadow_texels = lighting.shadow_texels,
           .pair_bits = pair_bits,
           .ray_bits = ray_bits,
           .first_share = first_share,
           .shares = shares,
           .image = image});
  });
  timed(stats, Stage::kReadBack, [&] { download(device, image, lit.color); });
  if (features.has(Feature::kClusteredLights) || lighting.vertex_error)
    boundSeenLight(gbuffer, frame, features, emission.empty() ? gbuffer.emission : emission, lit.color,
                   lighting.vertex_error, lit.light_error);
  PixelCounts missing = counts;
  if (together) missing.evaluated = false;
  if (missing.in_range || missing.evaluated || missing.list_length)
    timed(stats, Stage::kCountLights,
          [&] { countLights(device, lighting, culled ? &lists : nullptr, gbuffer, buffers, missing, lit); });
  const std::size_t planes = gbuffer.position.size() + gbuffer.normal.size() + gbuffer.diffuse.size() +
                             gbuffer.specular.size() + gbuffer.ambient.size() + gbuffer.emission.size() +
                             geometric_normal.size() + lift.size() + model.size() + emission.size() +
                             lit.light_error.size() + lit.color.size();
  stats.device_bytes =
      std::max(stats.device_bytes, planes * sizeof(float) + lighting.bytes + lists.bytes +
                                       shadows.texels.size() * sizeof(ShadowTexel) +
                                       (lit.pairs.lit.size() + lit.pairs.unsure.size() +
                                        lit.pairs.first_share.size() + lit.pairs.shares.size()) *
                                           sizeof(uint));
  return lit;
}

void compileKernels(Device& device, const FeatureSet& features, const ShadeSettings& settings) {
  GBuffer empty;  // one tile of background
  empty.tiles_x = empty.tiles_y = 1;
  empty.position.assign(3 * kTilePixels, -std::numeric_limits<float>::infinity());
  // All groups must be there, because the kernel loads a row's values before it knows that it is background.
  for (Plane* group : {&empty.normal, &empty.diffuse, &empty.ambient, &empty.emission})
    group->assign(3 * kTilePixels, 0.0f);
  empty.specular.assign(4 * kTilePixels, 0.0f);
  Lighting lighting;
  lighting.math_defines = mathDefines(settings);
  lighting.group_log2 = groupLog2(settings.tile_size);
  // An empty map, so that find_needed.cl is launched, and compiled, too.
  if (features.shadowMaps()) {
    lighting.host_shadows.maps.emplace_back();
    lighting.host_shadows.faces.emplace_back();
    lighting.host_shadows.bin_count = 1;
  }
  if (features.has(Feature::kExact)) {
    const Scene nothing;
    prepareBeams(device, nothing, {}, std::make_shared<const TriangleTree>(buildTriangleTree(nothing, {})),
                 nullptr, {}, {}, {}, features.has(Feature::kSoftExact) ? settings.soft_samples : 0,
                 lighting.beams);
  }
  uploadLighting(device, lighting);
  Stats ignored;
  lightGBuffer(device, {}, lighting, features, empty, {}, ignored);
}

}  // namespace luciole
