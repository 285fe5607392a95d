#include "bench/shadow_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "bench/shadow_scenes.hpp"
#include "bench/shadow_truth.hpp"
#include "bench/variants.hpp"
#include "raster/rasterize.hpp"
#include "rays/shadow_rays.hpp"
#include "render/lighting.hpp"
#include "render/pair_visibility.hpp"
#include "render/render.hpp"
#include "render/stats.hpp"

namespace luciole {
namespace {

constexpr glm::ivec2 kJudgedSize(1280, 720);

struct Method {
  const char* name;
  ShadowMethod method;
};
constexpr Method kMethods[] = {
    {"hard", ShadowMethod::kHard}, {"pcf", ShadowMethod::kPcf}, {"exact", ShadowMethod::kExact}};

/// A scene as its first camera sees it, and the truth about its shadows by rays. The rays refer to the scene,
/// so this may not be moved.
struct Judged {
  Scene scene;
  GBuffer gbuffer, flat;
  RayScene rays;
  std::vector<LightPair> pairs;
  TracedShadows truth;
};

GBuffer drawn(const Scene& scene, glm::ivec2 size, Shading shading) {
  const ShadeSettings settings;
  const FeatureSet features = neededFeatures(scene, scene.cameras.front(), materialTraits(scene), settings);
  GBuffer gbuffer = rasterize(scene, allObjects(scene), cameraView(scene.cameras.front(), size), shading,
                              neededPlanes(features));
  gbuffer.camera = scene.cameras.front();
  return gbuffer;
}

std::unique_ptr<const Judged> judgeScene(const Scene& scene, glm::ivec2 size) {
  auto judged = std::make_unique<Judged>();
  judged->scene = scene;
  judged->gbuffer = drawn(scene, size, Shading::kPhong);
  judged->flat = drawn(scene, size, Shading::kFlat);
  judged->rays = buildShadowRays(judged->scene, glm::dvec3(judged->gbuffer.camera.camera_to_world[3]));
  judged->pairs = facingPairs(scene, judged->gbuffer);
  judged->truth = traceTruth(scene, judged->rays, judged->gbuffer, judged->pairs);
  return judged;
}

/// A texel's side across the light's rays at a point (see TexelSide).
TexelSide texelSides(const Scene& scene, const ShadowMaps& shadows) {
  return [&](std::uint32_t index, const glm::dvec3& point) {
    const Light& light = scene.lights[index];
    const ShadowMap& map = shadows.maps[shadows.map_of_light[index]];
    const ShadowFace* faces = shadows.faces.data() + map.first_face;
    const glm::dvec3 way = point - light.position;
    if (map.kind == kCubeMap)
      return std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)}) / faces[0].scale;
    if (map.kind == kPerspectiveMap) return glm::dot(way, light.direction) / faces[0].scale;
    // The finest cascade that holds it.
    for (uint cascade = 0; cascade + 1 < map.face_count; ++cascade) {
      const PlannedFace& face = shadows.planned[map.first_face + cascade];
      const glm::dvec4 clip = face.view.projection * (face.view.world_to_view * glm::dvec4(point, 1));
      const double rim = faces[cascade].high / (0.5 * face.view.size.x) - 1;
      if (std::abs(clip.x) < rim && std::abs(clip.y) < rim) return 1.0 / faces[cascade].scale;
    }
    return 1.0 / faces[map.face_count - 1].scale;
  };
}

/// The exact shadows of the pairs. A pair that culling left out gets the truth, because the light adds
/// nothing there.
std::vector<float> exactVisibility(Device& device, const Judged& judged, const Lighting& lighting,
                                   const LitPlanes& lit) {
  std::vector<uint> starts(lighting.lists.tiles + 1);
  std::vector<ListEntry> list(lighting.lists.entries);
  download(device, lighting.lists.starts, starts);
  download(device, lighting.lists.list, list);
  const std::vector<std::uint32_t>& order = lighting.beams.order;
  std::vector<std::uint32_t> device_light(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) device_light[order[i]] = i;
  std::vector<float> visibility;
  for (std::size_t i = 0; i < judged.pairs.size(); ++i) {
    const LightPair& pair = judged.pairs[i];
    const std::size_t tile = pair.pixel / kTilePixels, place = pair.pixel % kTilePixels;
    const auto end = list.begin() + starts[tile + 1];
    const auto entry =
        std::lower_bound(list.begin() + starts[tile], end, device_light[pair.light],
                         [](const ListEntry& e, std::uint32_t light) { return e.light < light; });
    const bool listed = entry != end && entry->light == device_light[pair.light] &&
                        (entry->squares >> SQUARE_OF_PIXEL(place) & 1) != 0;
    const uint* bits = lit.pair_bits.data() + std::size_t(entry - list.begin()) * kPairWords;
    visibility.push_back(listed ? float(bits[place / 32] >> place % 32 & 1) : float(judged.truth.lit[i]));
  }
  return visibility;
}

struct Verdict {
  ShadowErrors errors;
  std::size_t faces = 0;     ///< that were drawn to
  std::size_t texels = 0;    ///< that were drawn
  std::uint64_t traced = 0;  ///< pairs that took a ray
};

Verdict judgeMaps(Device& device, const Judged& judged, const ShadeSettings& settings) {
  const Scene& scene = judged.scene;
  const Camera& camera = judged.gbuffer.camera;
  const FeatureSet features = neededFeatures(scene, camera, materialTraits(scene), settings);
  Lighting lighting;
  Stats stats;
  prepareLighting(device, scene, camera, cameraView(camera, judged.gbuffer.picture_size), features, settings,
                  lighting, stats);
  const LitPlanes lit = lightGBuffer(device, scene, lighting, features, judged.gbuffer, {}, stats);
  const bool exact = settings.shadows == ShadowMethod::kExact;
  // Where there are no maps, edges are as wide as a hard map's texels.
  const ShadowMaps unused = exact ? planShadowMaps(scene, cameraView(camera, judged.gbuffer.picture_size),
                                                   ShadowMethod::kHard, settings.shadow_limits)
                                  : ShadowMaps{};
  const ShadowMaps& shadows = exact ? unused : lighting.host_shadows;
  std::vector<MapPair> map_pairs;
  for (const LightPair& pair : judged.pairs)
    map_pairs.push_back({pair.pixel, shadows.map_of_light[pair.light]});
  const std::vector<float> visibility =
      exact ? exactVisibility(device, judged, lighting, lit)
            : pairVisibility(device, featureDefines(features) + mathDefines(settings), judged.gbuffer,
                             shadows, map_pairs);
  const std::vector<std::uint8_t> edges =
      nearEdges(scene, judged.rays, judged.gbuffer, judged.flat, judged.pairs, judged.truth.lit,
                texelSides(scene, shadows));
  Verdict verdict{.errors = judge(judged.truth.lit, edges, visibility),
                  .texels = shadows.texels.size(),
                  .traced = lit.traced};
  for (const PlannedFace& face : shadows.planned) verdict.faces += face.count.x > 0;
  return verdict;
}

/// Milliseconds that Embree takes for the pairs in the usual way: rays start a little off the surface, so
/// that no filter needs to recognize their own triangle, and holes in masks are ignored. Making the rays
/// isn't counted.
double rayMilliseconds(const Judged& judged, const RayScene& solid) {
  constexpr double kLift = 1e-3;           // of the distance to the eye
  constexpr std::size_t kBlock = 1 << 20;  // pairs
  const GBuffer& gbuffer = judged.gbuffer;
  const glm::dmat4 view_to_world = gbuffer.camera.camera_to_world;
  const std::size_t stride = gbuffer.pixels();
  double milliseconds = 0;
  for (std::size_t first = 0; first < judged.pairs.size(); first += kBlock) {
    std::vector<ShadowRay> rays(std::min(kBlock, judged.pairs.size() - first));
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const LightPair& pair = judged.pairs[first + i];
      const auto at = [&](const Plane& plane) {
        return glm::dvec3(plane[pair.pixel], plane[stride + pair.pixel], plane[2 * stride + pair.pixel]);
      };
      const glm::dvec3 p = at(gbuffer.position);
      const glm::dvec3 from(view_to_world *
                            glm::dvec4(p + kLift * glm::length(p) * at(judged.flat.normal), 1));
      const Light& light = judged.scene.lights[pair.light];
      const bool directional = light.kind == LightKind::kDirectional;
      const glm::dvec3 way = directional ? -light.direction : light.position - from;
      rays[i] = {from, glm::normalize(way),
                 directional ? std::numeric_limits<double>::infinity() : glm::length(way)};
    }
    std::vector<std::uint8_t> blocked(rays.size());
    const auto start = std::chrono::steady_clock::now();
    areBlocked(solid, rays, blocked);
    milliseconds +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  return milliseconds;
}

/// What a row of the table is measured with.
struct MethodRow {
  const Judged* judged;
  ShadeSettings settings;
};

/// Milliseconds of drawing (with planning, and finding what to draw), of lookups (shading less shading
/// without shadows), of both together, and of Embree's rays.
std::vector<double> timeMaps(Device& device, const MethodRow& row) {
  RenderSettings settings;
  settings.shade = row.settings;
  Stats with, without;
  shadeGBuffer(device, row.judged->scene, row.judged->gbuffer, settings, with);
  settings.shade.shadows = ShadowMethod::kOff;
  shadeGBuffer(device, row.judged->scene, row.judged->gbuffer, settings, without);
  const double draw = stageTime(with, Stage::kFindShadowTexels) + stageTime(with, Stage::kShadowMaps);
  const double look_up = stageTime(with, Stage::kBeamShadows) + stageTime(with, Stage::kHoleRays) +
                         stageTime(with, Stage::kShade) - stageTime(without, Stage::kShade);
  const double rays = rayMilliseconds(*row.judged, buildRayScene(row.judged->scene, row.judged->rays.origin));
  return {draw, look_up, draw + look_up, rays};
}

/// The sizes of maps to try: all for a scene of the user's, only the default for makeShadowScenes().
std::vector<int> sizesFor(const SpeedInput& input) {
  if (input.shadow_size) return {*input.shadow_size};
  if (!input.scene) return {ShadowLimits{}.size};
  return {std::begin(kShadowSizes), std::end(kShadowSizes)};
}

SpeedCell percent(std::uint64_t part, std::uint64_t whole, const std::string& why_none) {
  return quotient(100.0 * double(part), double(whole), why_none);
}

/// A row's cells, with empty ones for the times.
std::vector<SpeedCell> countedCells(const Judged& judged, const Verdict& verdict) {
  const ShadowErrors& errors = verdict.errors;
  const std::string none =
      fmt::format("{}: no surface in the picture faces a light that casts shadows", judged.scene.name);
  const auto ofPairs = [&](std::uint64_t part) { return percent(part, judged.pairs.size(), none); };
  const auto ofSome = [&](std::uint64_t part, std::uint64_t whole, const char* kind) {
    return percent(part, whole,
                   judged.pairs.empty() ? none : fmt::format("{}: no pair is {}", judged.scene.name, kind));
  };
  return {double(judged.pairs.size()),
          double(verdict.faces),
          1e-6 * double(verdict.texels),
          {},
          {},
          {},
          {},
          NoValue{none},
          ofPairs(verdict.traced),
          ofSome(errors.wrongly_dark, errors.lit, "lit away from edges"),
          ofSome(errors.wrongly_lit, errors.dark, "dark away from edges"),
          ofPairs(errors.edges),
          ofSome(errors.wrong_edges, errors.edges, "near an edge")};
}

}  // namespace

ShadowErrors shadowErrors(Device& device, const Scene& scene, glm::ivec2 size,
                          const ShadeSettings& settings) {
  return judgeMaps(device, *judgeScene(scene, size), settings).errors;
}

SpeedTable measureShadowErrors(const SpeedInput& input) {
  const glm::ivec2 size = input.size.value_or(kJudgedSize);
  std::vector<std::unique_ptr<const Judged>> judged;
  if (input.scene) {
    judged.push_back(judgeScene(*input.scene, size));
  } else {
    for (const Scene& scene : makeShadowScenes()) judged.push_back(judgeScene(scene, size));
  }
  SpeedTable table{.name = "shadow errors",
                   .measured = fmt::format(
                       "pairs of a pixel and a light that faces it, {} x {} pixels, against rays by Embree; "
                       "its time is for rays without holes, the tree not counted",
                       size.x, size.y),
                   .columns = {{"pairs", "pairs", 0},
                               {"faces", "faces drawn", 0},
                               {"million_texels", "million texels", 2},
                               {"draw_milliseconds", "draw, ms", 1},
                               {"look_up_milliseconds", "look up, ms", 1},
                               {"milliseconds", "both, ms", 1},
                               {"ray_milliseconds", "Embree, ms", 1},
                               {"times_rays", "times Embree", 2},
                               {"traced_percent", "rays, % of pairs", 2},
                               {"wrongly_dark_percent", "wrongly dark, % of lit", 4},
                               {"wrongly_lit_percent", "wrongly lit, % of dark", 4},
                               {"edge_percent", "edges, %", 2},
                               {"wrong_edge_percent", "wrong there, %", 2}}};
  std::vector<MethodRow> rows;
  for (const auto& one : judged) {
    for (const Method& method : kMethods) {
      for (const int map_size : sizesFor(input)) {
        MethodRow row{one.get(), {}};
        row.settings.shadows = method.method;
        row.settings.shadow_limits.size = map_size;
        table.rows.push_back({fmt::format("{}, {} {}", one->scene.name, method.name, map_size),
                              countedCells(*one, judgeMaps(input.device, *one, row.settings))});
        rows.push_back(row);
      }
    }
  }
  const auto rounds = runInRounds(rows.size(), input.repeats, table.name, input.on_progress,
                                  [&](std::size_t row) { return timeMaps(input.device, rows[row]); });
  for (std::size_t row = 0; row < rounds.size(); ++row) {
    for (std::size_t i = 0; i < 4; ++i) table.rows[row].cells[3 + i] = rounds[row].summary(i);
    if (!rows[row].judged->pairs.empty())
      table.rows[row].cells[7] = ratio(rounds[row].figures[2], rounds[row].figures[3]);
  }
  return table;
}

}  // namespace luciole
