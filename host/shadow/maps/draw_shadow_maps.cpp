#include "shadow/maps/draw_shadow_maps.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>

#include "raster/rasterize.hpp"
#include "shadow/maps/meshlets_seen.hpp"

namespace luciole {
namespace {

static_assert(kShadowBin == kBinSize);  // so that lookups and drawing share bins

constexpr float kNever = std::numeric_limits<float>::infinity();

/// The drawing that a face needs.
struct FaceUpdate {
  std::size_t face;
  bool moves;  ///< its rectangle grows: it gets a new place
  std::vector<bool> bins_to_draw;
  glm::ivec2 kept_first;  ///< if it moves: the old rectangle, whose texels are copied
  glm::ivec2 kept_count;
};

/// The drawing that a face needs; nothing if none. Updates its depths and its rectangle. expects_more: see
/// ShadowMaps.
std::optional<FaceUpdate> faceUpdate(std::size_t index, const ShadowFace& lookup,
                                     std::span<const std::uint32_t> needed, bool expects_more,
                                     PlannedFace& face) {
  const int side = int(lookup.bins);
  if (face.farthest.empty()) face.farthest.assign(std::size_t(side) * side, kNever);
  FaceUpdate task{index, false, std::vector<bool>(face.farthest.size()), face.first, face.count};
  bool any = false;
  glm::ivec2 first(side), last(-1);
  for (int bin = 0; bin < side * side; ++bin) {
    const std::uint32_t bits = needed[lookup.first_bin + bin];
    const float depth = bits == kNotNeeded ? kNever : std::bit_cast<float>(bits);
    if (depth < face.farthest[bin]) {
      face.farthest[bin] = expects_more ? 0.5f * depth : depth;
      task.bins_to_draw[bin] = any = true;
    }
    if (face.farthest[bin] == kNever) continue;
    first = glm::min(first, glm::ivec2(bin % side, bin / side));
    last = glm::max(last, glm::ivec2(bin % side, bin / side));
  }
  if (!any) return std::nullopt;
  const auto isInRectangle = [&](const glm::ivec2& bin) {
    return glm::all(glm::greaterThanEqual(bin * kBinSize, face.first)) &&
           glm::all(glm::lessThan(bin * kBinSize, face.first + face.count));
  };
  if (isInRectangle(first) && isInRectangle(last)) return task;
  task.moves = true;
  const int margin = expects_more ? 1 : 0;
  const glm::ivec2 from = glm::max(first - margin, 0) * kBinSize,
                   to = glm::min((last + 1 + margin) * kBinSize, face.view.size);
  face.first = from;
  face.count = to - from;
  return task;
}

/// Draws again all bins that a face has drawn so far, at a new place.
FaceUpdate fullRedraw(std::size_t index, const PlannedFace& face) {
  FaceUpdate task{index, true, std::vector<bool>(face.farthest.size()), {}, glm::ivec2(0)};
  for (std::size_t bin = 0; bin < face.farthest.size(); ++bin)
    task.bins_to_draw[bin] = face.farthest[bin] != kNever;
  return task;
}

std::size_t area(const glm::ivec2& size) { return std::size_t(size.x) * size.y; }

/// Copies the old rectangle of a face that moves. old_place, place: the indices of the first texels of the
/// old rectangle and of the new one.
void copyKept(const FaceUpdate& task, const PlannedFace& face, std::size_t old_place, std::size_t place,
              ShadowMaps& maps) {
  const glm::ivec2 from = task.kept_first - face.first;
  for (int y = 0; y < task.kept_count.y; ++y)
    std::copy_n(maps.texels.data() + old_place + std::size_t(y) * task.kept_count.x, task.kept_count.x,
                maps.texels.data() + place + std::size_t(from.y + y) * face.count.x + from.x);
}

/// Appends the texels that a face's task draws or moves. `place`: as in drawFace.
void addDrawn(const FaceUpdate& task, const PlannedFace& face, std::size_t place,
              std::vector<IndexRange>& drawn) {
  if (task.moves) {
    drawn.push_back({place, area(face.count)});
    return;
  }
  const int side = (face.view.size.x + kBinSize - 1) / kBinSize;
  const auto width = std::size_t(face.count.x);
  for (int bin = 0; bin < side * side; ++bin) {
    if (!task.bins_to_draw[bin]) continue;
    const glm::ivec2 first = glm::ivec2(bin % side, bin / side) * kBinSize - face.first;
    const glm::ivec2 count = glm::min(face.count - first, kBinSize);
    drawn.push_back({place + std::size_t(first.y) * width + std::size_t(first.x), std::size_t(count.x),
                     std::size_t(count.y), width});
  }
}

/// Draws a task. `place`: the index of the first texel of the face's rectangle.
void drawFace(const Scene& scene, const FaceUpdate& task, const PlannedFace& face, std::size_t place,
              ShadowMaps& maps) {
  View view = face.view;
  view.crop_origin = face.first;
  view.crop_size = face.count;
  const int side = (view.size.x + kBinSize - 1) / kBinSize;
  WantedBins bins{binGrid(view), {}};
  for (int y = 0; y < bins.count.y; ++y) {
    for (int x = 0; x < bins.count.x; ++x) {
      const int bin = (bins.first.y + y) * side + bins.first.x + x;
      bins.farthest.push_back(task.bins_to_draw[bin] ? face.farthest[bin] : kNever);
    }
  }
  const std::vector<std::uint32_t> seen = meshletsSeen(maps.meshlets, view, bins, scene.lights[face.light]);
  rasterizeDepth(scene, maps.meshlets, seen, view, bins.farthest,
                 std::span(maps.texels).subspan(place, area(face.count)));
}

}  // namespace

std::vector<IndexRange> drawNeeded(const Scene& scene, std::span<const std::uint32_t> needed,
                                   ShadowMaps& maps) {
  std::vector<FaceUpdate> tasks;
  std::size_t held = maps.texels.size(), total = held;
  for (std::size_t i = 0; i < maps.planned.size(); ++i) {
    if (auto task = faceUpdate(i, maps.faces[i], needed, maps.expects_more, maps.planned[i])) {
      if (task->moves) total += area(maps.planned[i].count);
      tasks.push_back(std::move(*task));
    }
  }
  // A rectangle that moves leaves its old place unused. Where that would take more texels than planned, all
  // rectangles get new places and are drawn again.
  if (total > maps.planned_texels) {
    held = 0;
    tasks.clear();
    for (std::size_t i = 0; i < maps.planned.size(); ++i)
      if (maps.planned[i].count.x > 0) tasks.push_back(fullRedraw(i, maps.planned[i]));
  }
  total = held;
  const auto placeOf = [&](const ShadowFace& lookup, const glm::ivec2& first) {
    return std::size_t(uint(lookup.first + uint(first.y) * lookup.width + uint(first.x)));
  };
  std::vector<std::size_t> old_places;  // one a task; unused where nothing is kept
  for (const FaceUpdate& task : tasks) {
    old_places.push_back(placeOf(maps.faces[task.face], task.kept_first));
    if (!task.moves) continue;
    const PlannedFace& face = maps.planned[task.face];
    ShadowFace& lookup = maps.faces[task.face];
    lookup.width = uint(face.count.x);
    lookup.first = uint(total) - uint(face.first.y) * lookup.width - uint(face.first.x);
    total += area(face.count);
  }
  maps.texels.resize(total);
  std::vector<std::size_t> places;
  std::vector<IndexRange> drawn;
  for (const FaceUpdate& task : tasks) {
    const PlannedFace& face = maps.planned[task.face];
    places.push_back(placeOf(maps.faces[task.face], face.first));
    addDrawn(task, face, places.back(), drawn);
  }
  tbb::parallel_for(std::size_t(0), tasks.size(), [&](std::size_t i) {
    const FaceUpdate& task = tasks[i];
    const PlannedFace& face = maps.planned[task.face];
    if (task.moves) copyKept(task, face, old_places[i], places[i], maps);
    drawFace(scene, task, face, places[i], maps);
  });
  return drawn;
}

}  // namespace luciole
