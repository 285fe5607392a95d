#include "raster/shading_points.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/shared.h"
#include "raster/empty_gbuffer.hpp"
#include "raster/resolve_square.hpp"
#include "raster/sample_coverage.hpp"

namespace luciole {
namespace {

/// The attributes of a triangle's plane at a place of the picture, inside the triangle or not.
struct PlaneAttributes {
  glm::dvec3 position;
  glm::dvec3 normal;  ///< unit
  glm::dvec2 uv;
  glm::dvec2 emission_uv;
  glm::dvec3 color;
};

PlaneAttributes planeAttributes(const SeenSurface& seen, const glm::dvec3& p) {
  const Weights weights = weightsInPlane(seen.surface, p);
  const auto at = [&](const auto& values) {
    return values.first + weights[1] * values.to_second + weights[2] * values.to_third;
  };
  const Surface& surface = seen.surface;
  return {surface.corner + weights[1] * surface.edge1 + weights[2] * surface.edge2,
          glm::normalize(at(seen.normal)), at(seen.uv), at(seen.emission_uv), at(seen.color)};
}

/// The cosine between facets below which they are taken to differ, to save time.
constexpr double kMostBentCosine = 0.97;

/// Whether two triangles of one object and material agree at the place p (see ViewPlane::at): normals and
/// colours within kSameShade, positions and texture coordinates within half a pixel along x and along y.
bool agreeAt(const SeenSurface& a, const SeenSurface& b, const glm::dvec3& p, const ViewPlane& plane) {
  // What isn't finite agrees with nothing.
  const PlaneAttributes of_a = planeAttributes(a, p), of_b = planeAttributes(b, p);
  if (!(glm::distance(of_a.normal, of_b.normal) <= kSameShade)) return false;
  if (!(glm::distance(of_a.color, of_b.color) <= kSameShade)) return false;
  if (a.has_normal_map || a.has_tangent) {
    const glm::dvec4 tangent = tangentAt(a.surface, weightsInPlane(a.surface, p)),
                     other = tangentAt(b.surface, weightsInPlane(b.surface, p));
    if (!(glm::distance(tangent, other) <= kSameShade)) return false;
  }
  const PlaneAttributes right = planeAttributes(a, p + glm::dvec3(0.5 * plane.scale.x, 0, 0));
  const PlaneAttributes below = planeAttributes(a, p + glm::dvec3(0, 0.5 * plane.scale.y, 0));
  const auto near = [&](const auto& value) {
    return glm::distance(value(of_a), value(of_b)) <=
           glm::distance(value(of_a), value(right)) + glm::distance(value(of_a), value(below));
  };
  return near([](const PlaneAttributes& at) { return at.position; }) &&
         near([](const PlaneAttributes& at) { return at.uv; }) &&
         near([](const PlaneAttributes& at) { return at.emission_uv; });
}

int cornersInCommon(const glm::uvec3& a, const glm::uvec3& b) {
  int common = 0;
  for (int i = 0; i < 3; ++i) common += a[i] == b[0] || a[i] == b[1] || a[i] == b[2];
  return common;
}

/// Samples of a pixel that share a point.
struct SampleGroup {
  std::uint32_t triangle;
  std::int32_t samples;
  glm::ivec2 sum;      ///< of the samples' places, as in SamplePattern
  glm::ivec2 squares;  ///< the sum of their squares
  std::int32_t first;  ///< its first sample
  bool merged;         ///< into another group
};

/// Attributes of a group's triangle that tell most groups apart.
struct GroupTraits {
  const PlacedObject* object;
  const Material* material;
  glm::uvec3 corners;
  bool front_facing;
};

/// The state of grouping samples, one for each thread.
struct Grouping {
  const SampledView& sampled;
  SurfaceCache& surfaces;
  std::vector<std::uint32_t> labels{};
  std::vector<SampleGroup> groups{};
  std::vector<GroupTraits> traits{};  ///< of the groups
};

/// Whether two of a pixel's groups, by their index, see the same surface.
bool sameSurface(Grouping& grouping, std::size_t first, std::size_t second, const glm::ivec2& pixel) {
  const GroupTraits &of_first = grouping.traits[first], &of_second = grouping.traits[second];
  if (of_first.object != of_second.object || of_first.material != of_second.material ||
      of_first.front_facing != of_second.front_facing)
    return false;
  // All that is interpolated comes from the vertices.
  if (grouping.sampled.shading != Shading::kFlat && cornersInCommon(of_first.corners, of_second.corners) >= 2)
    return true;
  const SampleGroup &a = grouping.groups[first], &b = grouping.groups[second];
  const glm::dvec2 mean = glm::dvec2(a.sum + b.sum) / double((a.samples + b.samples) * kSubpixels);
  const ViewPlane& plane = grouping.sampled.plane;
  const glm::dvec3 normal = grouping.surfaces[a.triangle].facing_normal;
  if (glm::dot(normal, grouping.surfaces[b.triangle].facing_normal) < kMostBentCosine) return false;
  const SeenSurface of_a = grouping.surfaces[a.triangle];  // a copy: the cache may give its place to b
  return agreeAt(of_a, grouping.surfaces[b.triangle], plane.at(pixel.x + mean.x, pixel.y + mean.y), plane);
}

/// Fills grouping.groups from the labels of a pixel's samples: a group for each triangle, in the order of
/// their first samples.
void groupByTriangle(const std::uint32_t* labels, Grouping& grouping) {
  const SamplePattern& pattern = grouping.sampled.pattern;
  std::vector<std::uint32_t>& left = grouping.labels;
  left.assign(labels, labels + pattern.count);
  grouping.groups.clear();
  for (int first = 0; first < pattern.count; ++first) {
    const std::uint32_t triangle = left[first];
    if (triangle == kNoTriangle) continue;
    std::int32_t samples = 0, x = 0, y = 0, x2 = 0, y2 = 0;
    for (int i = first; i < pattern.count; ++i) {
      const std::int32_t same = left[i] == triangle;
      samples += same;
      x += same * pattern.x[i];
      y += same * pattern.y[i];
      x2 += same * pattern.x[i] * pattern.x[i];
      y2 += same * pattern.y[i] * pattern.y[i];
      left[i] = same ? kNoTriangle : left[i];
    }
    grouping.groups.push_back({triangle, samples, {x, y}, {x2, y2}, first, false});
  }
}

/// Sets grouping.traits, and merges groups that see the same surface, each into the one with the most
/// samples. A group keeps its triangle, gets the samples of those merged into it, and the first of all their
/// first samples.
void mergeGroups(const glm::ivec2& pixel, Grouping& grouping) {
  std::vector<SampleGroup>& groups = grouping.groups;
  std::sort(groups.begin(), groups.end(), [](const SampleGroup& a, const SampleGroup& b) {
    return a.samples != b.samples ? a.samples > b.samples : a.first < b.first;
  });
  grouping.traits.clear();
  for (const SampleGroup& group : groups) {
    const Surface& surface = grouping.surfaces[group.triangle].surface;
    grouping.traits.push_back({surface.object, surface.material, surface.corners, surface.front_facing});
  }
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (groups[i].merged) continue;
    SampleGroup joined = groups[i];
    for (std::size_t j = i + 1; j < groups.size(); ++j) {
      if (groups[j].merged || !sameSurface(grouping, i, j, pixel)) continue;
      groups[j].merged = true;
      joined.samples += groups[j].samples;
      joined.sum += groups[j].sum;
      joined.squares += groups[j].squares;
      joined.first = std::min(joined.first, groups[j].first);
    }
    groups[i] = joined;
  }
}

/// Where a group's point lies, from the pixel's place, and the samples' standard deviation, both in pixels.
struct GroupPlace {
  glm::vec2 mean;
  glm::vec2 spread;
};

GroupPlace placeOf(const SampleGroup& group, const Material& material, const std::uint32_t* labels,
                   const SamplePattern& pattern) {
  const double count = group.samples, fine = kSubpixels;
  const glm::dvec2 mean = glm::dvec2(group.sum) / count;
  if (!hasHoles(material)) {
    const glm::dvec2 variance = glm::max(glm::dvec2(group.squares) / count - mean * mean, glm::dvec2(0.0));
    return {glm::vec2(mean / fine), glm::vec2(glm::sqrt(variance) / fine)};
  }
  // The mean may lie in a hole: the nearest sample on the triangle stands for it.
  glm::dvec2 nearest(0.0);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < pattern.count; ++i) {
    if (labels[i] != group.triangle) continue;
    const glm::dvec2 sample(pattern.x[i], pattern.y[i]), way = sample - mean;
    if (glm::dot(way, way) < least) {
      least = glm::dot(way, way);
      nearest = sample;
    }
  }
  return {glm::vec2(nearest / fine), glm::vec2(0.0f)};
}

bool allEqual(const std::uint32_t* labels, int count) {
  std::uint32_t differ = 0;
  for (int i = 1; i < count; ++i) differ |= labels[i] ^ labels[0];
  return differ == 0;
}

/// ViewPlane::at of pixels, or places between them, that come in `place`.
void toPlane(const ViewPlane& plane, SquarePlace& place) {
  for (int i = 0; i < kSquarePixels; ++i) {
    place.x[i] = plane.offset.x + plane.scale.x * place.x[i];
    place.y[i] = plane.offset.y + plane.scale.y * place.y[i];
  }
}

ResolveInput resolveInput(const SampledView& sampled) {
  return {sampled.scene,  sampled.objects,           sampled.plane, sampled.shading, sampled.vertex_colors,
          sampled.planes, sampled.view.world_to_view};
}

/// Groups the samples of a part of a strip, resolves the pixels' first points, and appends the others to
/// `further`, and all labels of the pixels wanted to `kept`.
void shareStrip(const PixelRectangle& part, const glm::ivec2& bin_origin, const StripSamples& samples,
                const ResolveInput& input, Grouping& grouping, SharedSamples& out,
                std::vector<ShadingPoint>& further, std::vector<std::uint32_t>& kept) {
  const SamplePattern& pattern = grouping.sampled.pattern;
  const glm::ivec2 crop = out.gbuffer.crop_origin;
  SampleGroup whole{kNoTriangle, pattern.count, glm::ivec2(0), glm::ivec2(0), 0, false};
  for (int i = 0; i < pattern.count; ++i) {
    const glm::ivec2 sample(pattern.x[i], pattern.y[i]);
    whole.sum += sample;
    whole.squares += sample * sample;
  }
  // Most pixels see one triangle, and neighbours the same.
  GroupPlace whole_place{};
  std::uint32_t whole_object = kNoObject, whole_labels = 0;
  const auto indexOf = [&](const PlacedObject* object) {
    return std::uint32_t(object - grouping.sampled.objects.data());
  };
  const auto takeWhole = [&](const std::uint32_t* labels) {
    whole.triangle = labels[0];
    whole_labels = std::uint32_t(2 * kept.size()) | 1u;
    kept.push_back(labels[0]);
    if (labels[0] == kNoTriangle) return;
    const Surface& surface = grouping.surfaces[labels[0]].surface;
    whole_place = placeOf(whole, *surface.material, labels, pattern);
    whole_object = indexOf(surface.object);
  };
  forEachSquare(part, crop, [&](const glm::ivec2& square) {
    Lanes<std::uint32_t> triangles;
    SquarePlace at;
    bool any = false;
    for (int lane = 0; lane < kSquarePixels; ++lane) {
      const glm::ivec2 pixel = square + glm::ivec2(kSquareLayout.x[lane], kSquareLayout.y[lane]);
      triangles[lane] = kNoTriangle;
      at.x[lane] = pixel.x;
      at.y[lane] = pixel.y;
      if (!part.contains(pixel)) continue;
      const std::uint32_t* labels = samples.labels(pixel - bin_origin, pattern);
      const std::uint32_t number = std::uint32_t(pixel.y - crop.y) * std::uint32_t(out.gbuffer.width) +
                                   std::uint32_t(pixel.x - crop.x);
      const auto takeFirst = [&](const SampleGroup& group, const GroupPlace& place, std::uint32_t object) {
        triangles[lane] = group.triangle;
        at.x[lane] += place.mean.x;
        at.y[lane] += place.mean.y;
        at.spread_x[lane] = place.spread.x;
        at.spread_y[lane] = place.spread.y;
        out.samples[number] = std::uint16_t(group.samples);
        out.objects[number] = object;
        any = true;
      };
      const bool wanted = grouping.sampled.inner.contains(pixel);
      if (allEqual(labels, pattern.count)) {
        if (whole_labels == 0 || labels[0] != whole.triangle) takeWhole(labels);
        out.labels.places[number] = whole_labels;
        if (labels[0] != kNoTriangle) takeFirst(whole, whole_place, whole_object);
        continue;
      }
      if (wanted) {
        out.labels.places[number] = std::uint32_t(2 * kept.size());
        kept.insert(kept.end(), labels, labels + pattern.count);
      }
      groupByTriangle(labels, grouping);
      mergeGroups(pixel, grouping);
      for (std::size_t i = 0; i < grouping.groups.size(); ++i) {
        const SampleGroup& group = grouping.groups[i];
        if (group.merged) continue;
        if (group.first != 0 && !wanted) continue;
        const GroupPlace place = placeOf(group, *grouping.traits[i].material, labels, pattern);
        if (group.first == 0) {
          takeFirst(group, place, indexOf(grouping.traits[i].object));
          continue;
        }
        further.push_back({number, group.triangle, place.mean.x, place.mean.y, place.spread.x, place.spread.y,
                           std::uint32_t(group.samples)});
      }
    }
    if (!any) return;
    toPlane(input.plane, at);
    resolveSquare(input, at, triangles, grouping.surfaces,
                  out.gbuffer.index(square.x - crop.x, square.y - crop.y), out.gbuffer);
  });
  finishSquares();
}

/// Orders points by triangle: those of one beside each other are cheap to resolve, and see the same lights.
void sortByTriangle(std::vector<ShadingPoint>& list) {
  std::vector<std::uint64_t> keys(list.size());  // triangle, then place in the list
  for (std::size_t i = 0; i < list.size(); ++i) keys[i] = std::uint64_t(list[i].triangle) << 32 | i;
  std::sort(keys.begin(), keys.end());
  std::vector<ShadingPoint> sorted(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) sorted[i] = list[std::uint32_t(keys[i])];
  list = std::move(sorted);
}

/// Calls visit(part, row) for each strip of a bin that touches the crop: the part of it that does, and its
/// first row in the bin.
template <class Visit>
void forEachStrip(const SampledView& sampled, int bin, Visit visit) {
  const View& view = sampled.view;
  const int rows = stripRows(sampled.pattern);
  const glm::ivec2 origin = sampled.bins.origin(bin);
  for (int row = 0; row < kBinSize; row += rows) {
    const glm::ivec2 first = origin + glm::ivec2(0, row);
    const PixelRectangle part{glm::max(first, view.crop_origin), glm::min(first + glm::ivec2(kBinSize, rows),
                                                                          view.crop_origin + view.crop_size)};
    if (part.first.y < part.end.y) visit(part, row);
  }
}

void drawRows(const SampledView& sampled, int bin, int row, std::span<std::uint8_t> covering,
              StripSamples& samples) {
  const HoleTest holes{sampled.scene, sampled.objects, sampled.plane, std::nullopt};
  drawStrip(sampled.setup.triangles, sampled.bins, bin, row, holes, sampled.pattern, covering, samples);
}

}  // namespace

SampledView setupSamples(const Scene& scene, std::span<const std::uint32_t> objects, const View& view,
                         Margin margin, int samples, Shading shading, PlaneSet planes,
                         std::span<const glm::vec3> vertex_colors) {
  checkView(view);
  const bool lit_vertices = shading == Shading::kGouraud && !vertex_colors.empty();
  planes.emission |= lit_vertices;
  const SamplePattern pattern = samplePattern(samples);
  View sampled = view;
  const int side = margin == Margin::kTiles ? kTileSize : 1;
  const glm::ivec2 end = view.crop_origin + view.crop_size;
  sampled.crop_origin = glm::max(view.crop_origin - 1, glm::ivec2(0)) / side * side;
  sampled.crop_size = glm::min((end + side) / side * side, view.size) - sampled.crop_origin;
  sampled.sample = pattern.origin;
  sampled.reach = pattern.reach;
  Geometry geometry = transformObjects(scene, objects, sampled, lit_vertices);
  RasterSetup setup = setupTriangles(scene, geometry, sampled, FaceCulling::kBackFaces);
  Bins bins = binTriangles(setup.triangles, sampled);
  return {scene,
          shading,
          planes,
          vertex_colors,
          pattern,
          sampled,
          {view.crop_origin, end},
          viewPlane(sampled),
          std::move(geometry.objects),
          geometry.triangle_count,
          std::move(setup),
          std::move(bins)};
}

SharedSamples shareSamples(const SampledView& sampled, RasterCounts& counts) {
  const View& view = sampled.view;
  const ResolveInput input = resolveInput(sampled);
  SharedSamples shared;
  shared.gbuffer = emptyGBuffer(view, sampled.planes);
  shared.samples.resize(std::size_t(view.crop_size.x) * view.crop_size.y);
  shared.objects.assign(shared.samples.size(), kNoObject);
  shared.labels.places.resize(shared.samples.size());
  counts.covering.resize(sampled.triangle_count);
  const int rows = stripRows(sampled.pattern), strips = kBinSize / rows;
  shared.further.resize(std::size_t(sampled.bins.size()) * strips);
  shared.labels.strips.resize(shared.further.size());
  tbb::enumerable_thread_specific<StripSamples> tables;
  tbb::enumerable_thread_specific<SurfaceCache> caches([&] { return SurfaceCache(input); });
  tbb::parallel_for(0, sampled.bins.size(), [&](int bin) {
    if (sampled.bins.list(bin).empty()) return;
    StripSamples& samples = tables.local();
    Grouping grouping{sampled, caches.local()};
    forEachStrip(sampled, bin, [&](const PixelRectangle& part, int row) {
      drawRows(sampled, bin, row, counts.covering, samples);
      const std::size_t strip = std::size_t(bin) * strips + row / rows;
      std::vector<ShadingPoint>& list = shared.further[strip];
      shareStrip(part, sampled.bins.origin(bin), samples, input, grouping, shared, list,
                 shared.labels.strips[strip]);
      sortByTriangle(list);
    });
  });
  setCounts(sampled.triangle_count, sampled.setup, counts);
  return shared;
}

void visitSamples(const SampledView& sampled,
                  const std::function<void(const glm::ivec2&, std::span<const std::uint32_t>)>& visit) {
  std::vector<std::uint8_t> covering(sampled.triangle_count);
  tbb::enumerable_thread_specific<StripSamples> tables;
  tbb::parallel_for(0, sampled.bins.size(), [&](int bin) {
    if (sampled.bins.list(bin).empty()) return;
    StripSamples& samples = tables.local();
    forEachStrip(sampled, bin, [&](const PixelRectangle& part, int row) {
      drawRows(sampled, bin, row, covering, samples);
      const glm::ivec2 first = glm::max(part.first, sampled.inner.first),
                       end = glm::min(part.end, sampled.inner.end);
      for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x)
          visit({x, y}, {samples.labels(glm::ivec2(x, y) - sampled.bins.origin(bin), sampled.pattern),
                         std::size_t(sampled.pattern.count)});
    });
  });
}

std::vector<std::size_t> chosenInBins(const SampledView& sampled, std::span<const std::uint8_t> chosen) {
  std::vector<std::size_t> counts(sampled.bins.size());
  tbb::parallel_for(0, sampled.bins.size(), [&](int bin) {
    forEachRow(sampled.view, sampled.bins.origin(bin), [&](int, std::size_t in_crop, int count) {
      for (int i = 0; i < count; ++i) counts[bin] += chosen[in_crop + i];
    });
  });
  return counts;
}

PointLists everySample(const SampledView& sampled, const SampleLabels& labels,
                       std::span<const std::uint8_t> chosen, int first_bin, int end_bin) {
  const View& view = sampled.view;
  const SamplePattern& pattern = sampled.pattern;
  const int rows = stripRows(pattern), strips = kBinSize / rows;
  PointLists points(std::size_t(end_bin - first_bin) * strips);
  tbb::parallel_for(first_bin, end_bin, [&](int bin) {
    if (sampled.bins.list(bin).empty()) return;
    forEachStrip(sampled, bin, [&](const PixelRectangle& part, int row) {
      std::vector<ShadingPoint>& list = points[std::size_t(bin - first_bin) * strips + row / rows];
      const std::vector<std::uint32_t>& kept = labels.strips[std::size_t(bin) * strips + row / rows];
      for (int y = part.first.y; y < part.end.y; ++y)
        for (int x = part.first.x; x < part.end.x; ++x) {
          const glm::uvec2 in_crop(x - view.crop_origin.x, y - view.crop_origin.y);
          const std::uint32_t number = in_crop.y * std::uint32_t(view.crop_size.x) + in_crop.x;
          if (!chosen[number]) continue;
          const std::uint32_t* first = kept.data() + labels.places[number] / 2;
          const int step = labels.places[number] & 1 ? 0 : 1;
          for (int i = 0; i < pattern.count; ++i)
            if (first[i * step] != kNoTriangle)
              list.push_back({number, first[i * step], float(pattern.x[i]) / kSubpixels,
                              float(pattern.y[i]) / kSubpixels, 0, 0, 1});
        }
    });
  });
  return points;
}

GBuffer gatherPoints(const SampledView& sampled, const PointLists& points, std::size_t first, std::size_t end,
                     GBuffer recycled) {
  std::vector<std::span<const ShadingPoint>> tiles;
  for (std::size_t list = first; list < end; ++list) {
    const std::span<const ShadingPoint> items(points[list]);
    for (std::size_t at = 0; at < items.size(); at += kTilePixels)
      tiles.push_back(items.subspan(at, std::min<std::size_t>(kTilePixels, items.size() - at)));
  }
  GBuffer gbuffer = emptyPoints(sampled.view, {1, int(tiles.size())}, sampled.planes, std::move(recycled));
  const ResolveInput input = resolveInput(sampled);
  const View& view = sampled.view;
  tbb::enumerable_thread_specific<SurfaceCache> caches([&] { return SurfaceCache(input); });
  tbb::parallel_for(std::size_t(0), tiles.size(), [&](std::size_t number) {
    SurfaceCache& surfaces = caches.local();
    const std::span<const ShadingPoint> tile = tiles[number];
    for (std::size_t begin = 0; begin < tile.size(); begin += kSquarePixels) {
      Lanes<std::uint32_t> triangles;
      SquarePlace at;
      for (int lane = 0; lane < kSquarePixels; ++lane) {
        const ShadingPoint& point = tile[std::min(begin + lane, tile.size() - 1)];
        triangles[lane] = begin + lane < tile.size() ? point.triangle : kNoTriangle;
        const std::uint32_t width = std::uint32_t(view.crop_size.x);
        at.x[lane] = view.crop_origin.x + int(point.pixel % width) + double(point.x);
        at.y[lane] = view.crop_origin.y + int(point.pixel / width) + double(point.y);
        at.spread_x[lane] = point.spread_x;
        at.spread_y[lane] = point.spread_y;
      }
      toPlane(input.plane, at);
      resolveSquare(input, at, triangles, surfaces, number * kTilePixels + begin, gbuffer);
    }
    finishSquares();
  });
  return gbuffer;
}

}  // namespace luciole
