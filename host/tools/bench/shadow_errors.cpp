#include "tools/bench/shadow_errors.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>

#include "kernels/shared.h"
#include "lighting/light_gbuffer.hpp"
#include "lighting/stats.hpp"
#include "raster/rasterize.hpp"
#include "rays/shadow_rays.hpp"
#include "render/plan.hpp"
#include "tools/bench/pair_visibility.hpp"
#include "tools/bench/shadow_scenes.hpp"
#include "tools/bench/shadow_truth.hpp"
#include "tools/bench/variants.hpp"

namespace luciole {
namespace {

constexpr glm::ivec2 kJudgedSize(1280, 720);
constexpr int kMoreSamples = 16;
constexpr int kFrames = 24;             ///< of rows that show a moving camera
constexpr double kStepOfFrames = 0.02;  ///< metres

/// Pictures of halls, beside makeShadowScenes().
struct Hall {
  int lamps;
  glm::ivec2 size;
};
constexpr int kSampledLamps = 30;  ///< of the halls that are timed with kMoreSamples and kFrames, too
const Hall kHalls[] = {
    {1, kJudgedSize}, {30, {320, 180}}, {30, kJudgedSize}, {30, {1920, 1080}}, {1000, kJudgedSize}};

struct Method {
  const char* name;
  ShadowMethod method;
};
constexpr Method kMethods[] = {{"hard", ShadowMethod::kHard},
                               {"pcf", ShadowMethod::kPcf},
                               {"exact", ShadowMethod::kExact},
                               {"auto", ShadowMethod::kAuto}};

/// A scene as its first camera sees it, and the truth about its shadows by rays. The rays refer to the scene,
/// so this may not be moved.
struct Judged {
  Scene scene;
  GBuffer gbuffer, flat;
  RayScene rays;   ///< of the truth
  RayScene solid;  ///< without holes, for Embree's own row
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
  judged->solid = buildRayScene(judged->scene, judged->rays.origin);
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

/// Sets the visibility of the pairs with lights whose shadows are exact. A pair that culling left out gets
/// the truth, because the light adds nothing there.
void addExactVisibility(OpenedDevice& device, const Judged& judged, const Lighting& lighting,
                        const LitPlanes& lit, std::vector<float>& visibility) {
  const LightSet& lights = lighting.lights;
  std::vector<uint> starts(lighting.lists.tiles + 1);
  std::vector<ListEntry> list(lighting.lists.entries);
  download(device, lighting.lists.starts, starts);
  download(device, lighting.lists.list, list);
  std::vector<uint> words(lit.pairs.lit.count);
  download(device, lit.pairs.lit, words);
  std::vector<std::uint32_t> device_light(lights.order.size());
  for (std::uint32_t i = 0; i < lights.order.size(); ++i) device_light[lights.order[i]] = i;
  for (std::size_t i = 0; i < judged.pairs.size(); ++i) {
    const LightPair& pair = judged.pairs[i];
    if (!lights.beam_lights[device_light[pair.light]].casts) continue;
    const std::size_t tile = pair.pixel / kTilePixels, place = pair.pixel % kTilePixels;
    const auto end = list.begin() + starts[tile + 1];
    const auto entry =
        std::lower_bound(list.begin() + starts[tile], end, device_light[pair.light],
                         [](const ListEntry& e, std::uint32_t light) { return e.light < light; });
    const bool listed = entry != end && entry->light == device_light[pair.light] &&
                        (entry->squares >> SQUARE_OF_PIXEL(place) & 1) != 0;
    const uint* bits = words.data() + std::size_t(entry - list.begin()) * kPairWords;
    visibility[i] = listed ? float(bits[place / 32] >> place % 32 & 1) : float(judged.truth.lit[i]);
  }
}

/// Sets the visibility of the pairs with lights that have maps.
void addMapVisibility(OpenedDevice& device, const Judged& judged, const Lighting& lighting,
                      std::vector<float>& visibility) {
  std::vector<MapPair> map_pairs;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < judged.pairs.size(); ++i) {
    const LightPair& pair = judged.pairs[i];
    const std::uint32_t map = lighting.maps.host.map_of_light[pair.light];
    if (map == kNoShadow) continue;
    map_pairs.push_back({pair.pixel, map});
    indices.push_back(i);
  }
  const std::vector<float> seen =
      pairVisibility(device, featureDefines(lighting.features) + lighting.math_defines, judged.gbuffer,
                     lighting.maps.host, map_pairs);
  for (std::size_t i = 0; i < indices.size(); ++i) visibility[indices[i]] = seen[i];
}

struct Verdict {
  ShadowErrors errors;
  std::size_t faces = 0;         ///< that were drawn to
  std::size_t texels = 0;        ///< that were drawn
  std::uint64_t traced = 0;      ///< pairs that took a ray
  std::size_t exact_lights = 0;  ///< whose shadows beams told
};

/// Whether each pair is near an edge, for maps of this size. Edges are as wide as a hard map's texels, also
/// where there are no maps.
std::vector<std::uint8_t> edgesOf(const Judged& judged, const ShadowLimits& limits) {
  const ShadowMaps maps =
      planShadowMaps(judged.scene, cameraView(judged.gbuffer.camera, judged.gbuffer.picture_size),
                     ShadowMethod::kHard, limits);
  return nearEdges(judged.scene, judged.rays, judged.gbuffer, judged.flat, judged.pairs, judged.truth.lit,
                   texelSides(judged.scene, maps));
}

RenderSettings pictureOf(const Judged& judged, const ShadeSettings& shade, int samples) {
  RenderSettings settings;
  settings.size = judged.gbuffer.picture_size;
  settings.camera = judged.gbuffer.camera;
  settings.samples = samples;
  settings.shade = shade;
  return settings;
}

Verdict judgeShadows(OpenedDevice& device, const Judged& judged, const std::vector<std::uint8_t>& edges,
                     const ShadeSettings& given) {
  const Scene& scene = judged.scene;
  const Camera& camera = judged.gbuffer.camera;
  const PicturePlan plan = planPicture(scene, pictureOf(judged, given, 1));
  const FeatureSet& features = plan.features;
  Lighting lighting;
  Stats stats;
  prepareLighting(device, scene, camera, plan.view, features, plan.shade, lighting, stats);
  const LitPlanes lit =
      lightGBuffer(device, scene, lighting, {lighting.lights, features, judged.gbuffer}, stats);
  std::vector<float> visibility(judged.pairs.size());
  if (features.shadowMaps()) addMapVisibility(device, judged, lighting, visibility);
  if (features.has(Feature::kExact)) addExactVisibility(device, judged, lighting, lit, visibility);
  Verdict verdict{.errors = judge(judged.truth.lit, edges, visibility), .traced = lit.traced.pairs};
  verdict.texels = lighting.maps.host.texels.size();
  for (const PlannedFace& face : lighting.maps.host.planned) verdict.faces += face.count.x > 0;
  for (const BeamLight& light : lighting.lights.beam_lights) verdict.exact_lights += light.casts;
  return verdict;
}

/// What Embree says of the pairs, and the milliseconds that it takes, in the usual way: rays start a little
/// off the surface, so that no filter needs to recognize their own triangle, and holes in masks are ignored.
/// Sixteen rays of a packet start in 4 × 4 pixels and go to one light. Making them isn't counted.
struct BareRays {
  std::vector<float> visibility;
  double milliseconds = 0;
};
BareRays bareRays(const Judged& judged) {
  constexpr double kLift = 1e-3;           // of the distance to the eye
  constexpr std::size_t kBlock = 1 << 20;  // pairs
  const GBuffer& gbuffer = judged.gbuffer;
  const glm::dmat4 view_to_world = gbuffer.camera.camera_to_world;
  const std::size_t stride = gbuffer.pixels();
  BareRays result{std::vector<float>(judged.pairs.size())};
  for (std::size_t first = 0; first < judged.pairs.size(); first += kBlock) {
    std::vector<ShadowRay> rays(std::min(kBlock, judged.pairs.size() - first));
    tbb::parallel_for(std::size_t(0), rays.size(), [&](std::size_t i) {
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
    });
    std::vector<std::uint8_t> blocked(rays.size());
    result.milliseconds += millisecondsOf([&] { areBlocked(judged.solid, rays, blocked); });
    for (std::size_t i = 0; i < rays.size(); ++i) result.visibility[first + i] = blocked[i] ? 0.0f : 1.0f;
  }
  return result;
}

/// What a row of the table is measured with.
struct ShadowRow {
  const Judged* judged;
  ShadeSettings settings;
  int samples = 1;
  int frames = 1;       ///< more: the camera goes kStepOfFrames from one to the next
  bool embree = false;  ///< bareRays instead of a picture
};

/// Milliseconds of getting ready (planning and drawing maps, and building the tree of triangles), and of
/// telling each pair's shadow (finding what maps must show, beams, rays through holes, and shading). A
/// frame's share of them.
std::vector<double> timeShadows(OpenedDevice& device, const ShadowRow& row) {
  if (row.embree) {
    const double ready = millisecondsOf([&] { buildRayScene(row.judged->scene, row.judged->rays.origin); });
    const double tell = bareRays(*row.judged).milliseconds;
    return {ready, tell};
  }
  Stats stats;
  KeptPicture kept;
  RenderSettings picture = pictureOf(*row.judged, row.settings, row.samples);
  for (int frame = 0; frame < row.frames; ++frame) {
    renderBands(
        device, row.judged->scene, picture, [](const Image&) {}, stats, &kept);
    glm::dmat4& place = picture.camera.camera_to_world;
    place[3] -= kStepOfFrames * place[2];
  }
  const auto perFrame = [&](std::initializer_list<Stage> stages) {
    double sum = 0;
    for (const Stage stage : stages) sum += stageTime(stats, stage);
    return sum / row.frames;
  };
  return {perFrame({Stage::kTriangleTree, Stage::kShadowMaps}),
          perFrame({Stage::kFindShadowTexels, Stage::kBeamShadows, Stage::kShadowRays, Stage::kShade})};
}

/// The sizes of maps to try: all for a scene of the user's, only the default for makeShadowScenes().
std::vector<int> sizesFor(const SpeedInput& input) {
  if (input.shadow_size) return {*input.shadow_size};
  if (!input.scene) return {ShadowLimits{}.size};
  return {std::begin(kShadowSizes), std::end(kShadowSizes)};
}

/// A row's cells, with empty ones for the times.
std::vector<SpeedCell> countedCells(const Judged& judged, const Verdict& verdict) {
  const ShadowErrors& errors = verdict.errors;
  const std::string none =
      fmt::format("{}: no surface in the picture faces a light that casts shadows", judged.scene.name);
  const auto ofPairs = [&](double part) { return quotient(100 * part, double(judged.pairs.size()), none); };
  const auto ofSome = [&](std::uint64_t part, std::uint64_t whole, const char* kind) {
    return quotient(100.0 * double(part), double(whole),
                    judged.pairs.empty() ? none : fmt::format("{}: no pair is {}", judged.scene.name, kind));
  };
  return {double(judged.pairs.size()),
          double(verdict.exact_lights),
          double(verdict.faces),
          1e-6 * double(verdict.texels),
          {},
          {},
          {},
          NoValue{none},
          ofPairs(double(verdict.traced)),
          ofSome(errors.wrongly_dark, errors.lit, "lit away from edges"),
          ofSome(errors.wrongly_lit, errors.dark, "dark away from edges"),
          ofPairs(double(errors.edges)),
          ofSome(errors.wrong_edges, errors.edges, "near an edge"),
          ofPairs(errors.brighter)};
}

/// Adds the scene's rows: each method with each size of maps that matters to it, then Embree.
void addRows(const SpeedInput& input, const Judged& judged, const std::vector<int>& sizes, SpeedTable& table,
             std::vector<ShadowRow>& rows) {
  const std::string picture =
      fmt::format("{}, {}x{}", judged.scene.name, judged.gbuffer.width, judged.gbuffer.height);
  std::vector<std::uint8_t> edges;
  for (const int size : sizes) {
    const ShadowLimits limits{.size = size};
    edges = edgesOf(judged, limits);
    for (const Method& method : kMethods) {
      if (method.method == ShadowMethod::kExact && size != sizes.back()) continue;
      ShadowRow row{.judged = &judged, .settings = {}};
      row.settings.shadows = method.method;
      row.settings.shadow_limits = limits;
      table.rows.push_back({fmt::format("{}, {} {}", picture, method.name, size),
                            countedCells(judged, judgeShadows(input.device, judged, edges, row.settings))});
      rows.push_back(row);
    }
  }
  Verdict embree{.errors = judge(judged.truth.lit, edges, bareRays(judged).visibility)};
  table.rows.push_back({picture + ", Embree", countedCells(judged, embree)});
  rows.push_back({.judged = &judged, .settings = {}, .embree = true});
}

/// Adds rows of kMoreSamples, and of kFrames, for those from `first` on.
void addMoreRows(std::size_t first, SpeedTable& table, std::vector<ShadowRow>& rows) {
  const std::size_t end = rows.size();
  const auto addMore = [&](std::size_t like, int samples, int frames, const std::string& of) {
    rows.push_back(rows[like]);
    rows.back().samples = samples;
    rows.back().frames = frames;
    table.rows.push_back(
        {table.rows[like].name + ", " + of,
         std::vector<SpeedCell>(table.columns.size(),
                                NoValue{"errors are counted with one sample and in one frame"})});
  };
  for (std::size_t i = first; i < end; ++i) {
    if (rows[i].embree) continue;
    addMore(i, kMoreSamples, 1, fmt::format("{} samples", kMoreSamples));
    addMore(i, 1, kFrames, fmt::format("each of {} frames", kFrames));
  }
}

/// The first row like this one, but with Embree or without shadows.
std::size_t rivalOf(const std::vector<ShadowRow>& rows, const ShadowRow& row, bool embree) {
  const auto is_rival = [&](const ShadowRow& other) {
    return other.judged == row.judged && other.embree == embree &&
           (embree || (other.samples == row.samples && other.frames == row.frames &&
                       other.settings.shadows == ShadowMethod::kOff));
  };
  return std::size_t(std::find_if(rows.begin(), rows.end(), is_rival) - rows.begin());
}

/// Times all rows, with pictures without shadows beside them, and fills in the table's cells.
void timeRows(const SpeedInput& input, std::vector<ShadowRow> rows, SpeedTable& table) {
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    ShadowRow off = rows[i];
    off.settings.shadows = ShadowMethod::kOff;
    if (!off.embree && rivalOf(rows, off, false) == rows.size()) rows.push_back(off);
  }
  const auto rounds = runInRounds(rows.size(), input.repeats, table.name, input.on_progress,
                                  [&](std::size_t row) { return timeShadows(input.device, rows[row]); });
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<double>& ready = rounds[i].figures[0];
    std::vector<double> tell = rounds[i].figures[1], both = ready;
    for (std::size_t k = 0; k < tell.size(); ++k) {
      if (!rows[i].embree) tell[k] -= rounds[rivalOf(rows, rows[i], false)].figures[1][k];
      both[k] += tell[k];
    }
    std::vector<SpeedCell>& cells = table.rows[i].cells;
    cells[4] = summarize(ready);
    cells[5] = summarize(tell);
    cells[6] = summarize(both);
    if (rows[i].samples > 1 || rows[i].frames > 1) {
      cells[7] = NoValue{"Embree's row is for one sample and one frame"};
    } else if (!rows[i].judged->pairs.empty()) {
      cells[7] = ratio(rows[i].embree ? tell : both, rounds[rivalOf(rows, rows[i], true)].figures[1]);
    }
  }
}

}  // namespace

ShadowErrors shadowErrors(OpenedDevice& device, const Scene& scene, glm::ivec2 size,
                          const ShadeSettings& settings) {
  const auto judged = judgeScene(scene, size);
  return judgeShadows(device, *judged, edgesOf(*judged, settings.shadow_limits), settings).errors;
}

SpeedTable measureShadowErrors(const SpeedInput& input) {
  const glm::ivec2 size = input.size.value_or(kJudgedSize);
  SpeedTable table{.name = "shadow errors",
                   .measured =
                       "pairs of a pixel and a light that faces it, against rays by Embree; Embree's own "
                       "row is for rays without holes, and times Embree doesn't count its tree",
                   .columns = {{"pairs", "pairs", 0},
                               {"exact_lights", "exact lights", 0},
                               {"faces", "faces drawn", 0},
                               {"million_texels", "million texels", 2},
                               {"draw_milliseconds", "tree or maps, ms", 1},
                               {"look_up_milliseconds", "beams or lookups, ms", 1},
                               {"milliseconds", "both, ms", 1},
                               {"times_rays", "times Embree", 2},
                               {"traced_percent", "rays, % of pairs", 2},
                               {"wrongly_dark_percent", "wrongly dark, % of lit", 4},
                               {"wrongly_lit_percent", "wrongly lit, % of dark", 4},
                               {"edge_percent", "edges, %", 2},
                               {"wrong_edge_percent", "wrong there, %", 2},
                               {"brighter_percent", "brighter by, % of pairs", 4}}};
  std::vector<std::unique_ptr<const Judged>> judged;
  std::vector<ShadowRow> rows;
  const auto add = [&](const Scene& scene, glm::ivec2 of_scene, bool more) {
    const std::size_t first = rows.size();
    judged.push_back(judgeScene(scene, of_scene));
    addRows(input, *judged.back(), sizesFor(input), table, rows);
    if (more) addMoreRows(first, table, rows);
  };
  if (input.scene) {
    add(*input.scene, size, true);
  } else {
    for (const Scene& scene : makeShadowScenes()) add(scene, size, false);
    for (const Hall& hall : kHalls)
      add(makeLampHall(hall.lamps), input.size.value_or(hall.size),
          hall.lamps == kSampledLamps && hall.size == kJudgedSize);
  }
  timeRows(input, std::move(rows), table);
  return table;
}

}  // namespace luciole
