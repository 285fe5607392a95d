// Which pixels each light's shadows leave lit: exactly, by rays that go together.
//
// All rays between a tile's points and a light share an end. So instead of a ray for each pair, a walk
// through a tree over the scene's triangles finds what lies in the beam between them: most beams hold
// nothing, or a triangle that hides all of the points.
//
// In: planes of a G-buffer, light lists, lights and the tree. Out: for each entry of the lists kPairWords
// words, a bit for each pixel of the tile: the light reaches it. Where the scene has materials with holes, or
// lights of a size, also as many words of the pixels for which rays decide: those from which a texture is
// between, and those for which no single triangle, or the absence of any, decides about all of a light.
//
//   the tile's points in clusters, clusters in bundles (beam_points.clh)
//   └─ for each light of the tile's list, for each bundle
//        the last triangles that hid much from this light; then
//        a walk with the beam of the bundle (beam.clh) until kCandidateBatch candidates are found
//        └─ for each cluster: its candidates (blockers.clh, candidates.clh), and alone the rest of the walk
//
// A work-item takes a run of tiles, and remembers from one to the next what hid much from a light. Cost: a
// walk of some 10 nodes and blocks of 16 triangles for each bundle and light; 15 instructions for each
// candidate and row of points.
#include "exact/beam.clh"
#include "exact/beam_points.clh"
#include "exact/blockers.clh"
#include "exact/candidates.clh"
#include "exact/hole_masks.clh"
#include "features.clh"
#include "lanes.clh"
#include "math.clh"
#include "shared.h"

// A walk through the tree: references of nodes, and of blocks as their complements.
typedef struct {
  int stack[kMaxTreeDepth * (kTreeWidth - 1) + 1];
  uint height;
} BeamWalk;

// Adds what may hide points of the beam to the candidates. Returns true if a triangle covers the beam.
// holed: bits of those with holes.
INLINE bool take_blockers(const Scene* scene, const LightView* view, const Beam* beam,
                          const Blockers* blockers, uint holed, Candidates* candidates) {
  Triangles triangles;
  if (!test_triangles(beam, view, scene->blocks, blockers, &triangles)) return false;
  uint covers = triangles.covers & ~holed;
  if (covers) {
    remember_blocker(scene, reference_of(blockers, lowest_bit(covers)));
    return true;
  }
  append_candidates(candidates, &triangles, blockers, holed);
  return false;
}

// Goes on with a walk, until `batch` candidates are found or it ends. Returns true if a triangle covers the
// beam.
SHARED_WORK bool find_candidates(const Scene* scene, const LightView* view, const Beam* beam, BeamWalk* walk,
                                 Candidates* candidates, uint batch) {
  candidates->count = 0;
  int* stack = walk->stack;
  uint height = walk->height;
  bool covered = false;
  while (height && !covered && candidates->count < batch) {
    int reference = stack[--height];
    if (reference >= 0) {
      uint touched = touched_children(beam, scene->nodes + reference * (kNodeRows * kTreeWidth));
      for (; touched; touched &= touched - 1)
        stack[height++] = scene->children[reference * kTreeWidth + lowest_bit(touched)];
      continue;
    }
    uint block = ~reference, bits = scene->block_bits[block];
    for (uint i = 0; i < kTreeWidth && !covered; i += LANES) {
      Blockers blockers;
      load_blockers(view, scene->blocks, block, i, bits >> i, &blockers);
      covered = take_blockers(scene, view, beam, &blockers, HOLES ? bits >> (kTreeWidth + i) : 0, candidates);
    }
  }
  walk->height = height;
  return covered;
}

// Finds candidates among the triangles in the cache, which hid much from this light in the tiles before.
// Returns true if one covers the beam.
INLINE bool test_remembered(const Scene* scene, const LightView* view, const Beam* beam,
                            Candidates* candidates) {
  candidates->count = 0;
  for (uint i = 0; i < kTreeWidth; i += LANES) {
    uint references[LANES], used = 0;
    for (uint lane = 0; lane < LANES; ++lane) {
      uint reference = scene->cache->reference[scene->cache_slot][i + lane];
      bool is_one = reference != NO_TRIANGLE;
      used |= is_one ? 1u << lane : 0;
      references[lane] = is_one ? reference : 0;
    }
    if (!used) continue;
    Blockers blockers;
    gather_blockers(view, scene->blocks, references, used, &blockers);
    // None of them has holes.
    if (take_blockers(scene, view, beam, &blockers, 0, candidates)) return true;
  }
  return false;
}

INLINE void hide_all(const Cluster* cluster, Remaining* remaining) {
  for (uint row = cluster->first_row; row < cluster->end_row; ++row) remaining->left[row] = 0;
}

INLINE Target target_of(const Scene* scene, const LightView* view, const Cluster* cluster,
                        const Remaining* remaining) {
  return make_target(view, &cluster->bounds,
                     bound_rows(scene->tile, cluster->first_row, cluster->end_row, remaining->left));
}

// Goes on with a walk to its end, for the points of one cluster alone.
SHARED_WORK void finish_cluster(const Scene* scene, const LightView* view, const Cluster* cluster,
                                BeamWalk* walk, Candidates* candidates, Remaining* remaining) {
  Beam beam;
  uint left = 0;
  while (walk->height) {
    if (has_size(view) && rays_decide(cluster, remaining)) return;
    // A beam to half of the points meets less.
    uint now = count_points(remaining->left, cluster->first_row, cluster->end_row);
    if (left == 0 || 2 * now <= left) {
      Target target = target_of(scene, view, cluster, remaining);
      make_beam(&beam, view, &target);
      left = now;
    }
    if (find_candidates(scene, view, &beam, walk, candidates, 1)) {
      hide_all(cluster, remaining);
      return;
    }
    if (candidates->count && !test_candidates(scene, view, 0, candidates, cluster, remaining)) return;
  }
}

// The clusters of a bundle that have points left, each with what a triangle has to cover to hide all of them.
typedef struct {
  uint count;
  const Cluster* cluster[kMaxClusters];
  Target target[kMaxClusters];
} Active;

// The beam to all of them, which are of a bundle with these bounds.
INLINE void beam_to_all(const LightView* view, const PointBounds* bounds, const Active* active, Beam* beam) {
  Rectangle rectangle = no_rectangle();
  for (uint i = 0; i < active->count; ++i) grow_rectangle(&rectangle, &active->target[i].rectangle);
  Target target = {rectangle, *bounds};
  make_beam(beam, view, &target);
}

// Tests candidates against all clusters, and leaves those active that have points left. Returns whether any
// are.
INLINE bool test_all(const Scene* scene, const LightView* view, const Candidates* candidates, Active* active,
                     Remaining* remaining) {
  uint count = 0;
  for (uint i = 0; i < active->count; ++i) {
    if (!test_candidates(scene, view, active->target + i, candidates, active->cluster[i], remaining))
      continue;
    active->cluster[count] = active->cluster[i];
    active->target[count++] = active->target[i];
  }
  active->count = count;
  return count > 0;
}

// Removes from `remaining` those points of a cluster that a light doesn't reach. Returns false and does
// nothing if the light is amid the points or too near them (see view_light()).
SHARED_WORK bool shadow_cluster(const Scene* scene, float4 place, float size, const Cluster* points,
                                Remaining* remaining) {
  LightView view;
  for (uint axis = 0; axis < 3; ++axis) view.most[axis] = scene->most[axis];
  if (!view_light(place, size, &points->bounds.box, &view)) return false;
  project_rows(scene->tile, &view, points->first_row, points->end_row, remaining->left);
  BeamWalk walk;
  walk.height = 1;
  walk.stack[0] = scene->root;
  finish_cluster(scene, &view, points, &walk, scene->candidates, remaining);
  return true;
}

// The same for a light that is amid the points: one point after another.
SHARED_WORK void shadow_points(const Scene* scene, float4 place, float size, const Cluster* cluster,
                               Remaining* remaining) {
  for (uint row = cluster->first_row; row < cluster->end_row; ++row) {
    uint lit = 0;
    for (uint points = remaining->left[row]; points; points &= points - 1) {
      uint point = row * kTreeWidth + lowest_bit(points);
      PointBox box;
      for (uint axis = 0; axis < 3; ++axis) box.low[axis] = box.high[axis] = scene->tile->place[axis][point];
      Cluster alone = {row, row + 1, false, bounds_of(&box)};
      remaining->left[row] = (ushort)(points & (0 - points));
      // Nothing hides a point from a light at the same place.
      shadow_cluster(scene, place, size, &alone, remaining);
      lit |= remaining->left[row];
    }
    remaining->left[row] = (ushort)lit;
  }
}

// Removes from `remaining` those points of clusters [first, end), a bundle, that a light doesn't reach.
// bounds: of the bundle.
SHARED_WORK void shadow_bundle(const Scene* scene, float4 place, float size, const PointBounds* bounds,
                               uint first, uint end, Remaining* remaining) {
  // Find the clusters that have points left.
  TilePoints* tile = scene->tile;
  Active active;
  active.count = 0;
  for (uint i = first; i < end; ++i) {
    const Cluster* cluster = tile->cluster + i;
    if (!count_points(remaining->left, cluster->first_row, cluster->end_row)) continue;
    active.cluster[active.count++] = cluster;
  }
  if (!active.count) return;
  // View the light from the bundle. If it is amid the points, take the clusters one by one.
  LightView view;
  for (uint axis = 0; axis < 3; ++axis) view.most[axis] = scene->most[axis];
  Candidates* candidates = scene->candidates;
  BeamWalk walk;
  if (!view_light(place, size, &bounds->box, &view)) {
    for (uint i = 0; i < active.count; ++i)
      if (!shadow_cluster(scene, place, size, active.cluster[i], remaining))
        shadow_points(scene, place, size, active.cluster[i], remaining);
    return;
  }
  // Project the points, and make the bundle's beam.
  for (uint i = 0; i < active.count; ++i) {
    const Cluster* cluster = active.cluster[i];
    project_rows(tile, &view, cluster->first_row, cluster->end_row, remaining->left);
    active.target[i] = target_of(scene, &view, cluster, remaining);
  }
  Beam beam;
  beam_to_all(&view, bounds, &active, &beam);
  // Test what hid much from this light in the tiles before.
  bool covered = test_remembered(scene, &view, &beam, candidates);
  if (!covered && candidates->count) {
    uint before = active.count;
    if (!test_all(scene, &view, candidates, &active, remaining)) return;
    if (active.count < before) beam_to_all(&view, bounds, &active, &beam);
  }
  // Walk the tree until enough candidates are found.
  if (!covered) {
    walk.height = 1;
    walk.stack[0] = scene->root;
    covered = find_candidates(scene, &view, &beam, &walk, candidates, kCandidateBatch);
  }
  if (covered) {
    for (uint i = 0; i < active.count; ++i) hide_all(active.cluster[i], remaining);
    return;
  }
  // Test them, and finish the walk for each cluster that has points left.
  if (candidates->count && !test_all(scene, &view, candidates, &active, remaining)) return;
  for (uint i = 0; i < active.count && walk.height; ++i) {
    BeamWalk rest;
    rest.height = walk.height;
    for (uint j = 0; j < walk.height; ++j) rest.stack[j] = walk.stack[j];
    finish_cluster(scene, &view, active.cluster[i], &rest, candidates, remaining);
  }
}

// Sets `remaining` to the points that a light may shine on: those in its range that face it. Margins make up
// for rounding and for the lift, so that this misses none that shading lights. Returns how many there are.
INLINE uint find_receivers(const TilePoints* tile, const BeamLight* light, Remaining* remaining) {
  uint rows = tile->cluster_count ? tile->cluster[0].end_row : 0, count = 0;
  for (uint i = 1; i < tile->cluster_count; ++i) rows = max(rows, tile->cluster[i].end_row);
  bool parallel = light->place.w == 0.0f;
  float reach = light->reach + tile->most_lift, reach2 = 1.00001f * reach * reach;
  for (uint row = 0; row < rows; ++row) {
    uint receives = 0;
    for (uint i = 0; i < kTreeWidth; i += LANES) {
      uint point = row * kTreeWidth + i;
      vec3L n = {lanes_at(tile->normal[0], point), lanes_at(tile->normal[1], point),
                 lanes_at(tile->normal[2], point)};
      intL faces;
      if (parallel) {
        faces = dot3s(n, light->place) > -1e-5f;
      } else {
        vec3L to_light = {light->place.x - lanes_at(tile->place[0], point),
                          light->place.y - lanes_at(tile->place[1], point),
                          light->place.z - lanes_at(tile->place[2], point)};
        floatL length = abs_lanes(to_light.x) + abs_lanes(to_light.y) + abs_lanes(to_light.z);
        faces = dot3(n, to_light) > -1e-5f * length - tile->most_lift;
        faces &= !(dot3(to_light, to_light) > reach2);
      }
      receives |= lane_bits(faces) << i;
    }
    receives &= tile->used[row];
    remaining->left[row] = (ushort)receives;
    remaining->unsure[row] = 0;
    count += popcount(receives);
  }
  return count;
}

// Writes bits of points to a tile's words, each to the bit of its pixel: of the points that are `left`, with
// keep = 0xffff those that are not in `masked`, with keep = 0 those that are.
INLINE void write_pixels(const TilePoints* tile, const ushort* left, const ushort* masked, uint keep,
                         __global uint* words) {
  for (uint i = 0; i < kPairWords; ++i) words[i] = 0;
  for (uint i = 0; i < tile->cluster_count; ++i) {
    const Cluster* cluster = tile->cluster + i;
    for (uint row = cluster->first_row; row < cluster->end_row; ++row) {
      uint bits = left[row] & (masked[row] ^ keep);
      if (cluster->whole) {
        uint pixel = tile->pixel[row * kTreeWidth];
        words[pixel / 32] |= bits << pixel % 32;
        continue;
      }
      for (; bits; bits &= bits - 1) {
        uint pixel = tile->pixel[row * kTreeWidth + lowest_bit(bits)];
        words[pixel / 32] |= 1u << pixel % 32;
      }
    }
  }
}

// Selects the light's slot of the cache, and clears it if another light had it.
INLINE void select_cache_slot(Scene* scene, uint light) {
  BlockerCache* cache = scene->cache;
  scene->cache_slot = light % kCachedLights;
  if (cache->light[scene->cache_slot] == light) return;
  cache->light[scene->cache_slot] = light;
  cache->next[scene->cache_slot] = 0;
  for (uint i = 0; i < kTreeWidth; ++i) cache->reference[scene->cache_slot][i] = NO_TRIANGLE;
}

// Bits of a word's pixels in an entry's squares: other pixels are never shaded with its light. word: of the
// entry's.
INLINE uint listed_pixels(uint squares, uint word) {
  uint of_word = squares >> SQUARE_OF_PIXEL(word * 32);
  return (of_word & 1 ? 0xffffu : 0) | (of_word & 2 ? 0xffff0000u : 0);
}

// Takes the pixels that aren't shaded from an entry's words of unsure pairs, and counts all of its pairs.
// lit: its words. received: pixels that the light may reach.
INLINE void count_pairs(__global const uint* lit, __global uint* unsure, uint squares, bool sized,
                        uint received, __global TilePairs* counts) {
  uint lit_pairs = 0, by_rays = 0, listed = 0;
  for (uint i = 0; i < kPairWords; ++i) {
    lit_pairs += popcount(lit[i]);
    by_rays += popcount(unsure[i]);
    unsure[i] &= listed_pixels(squares, i);
    listed += popcount(unsure[i]);
  }
  counts->unsure += listed;
  if (!sized) return;
  counts->soft_unsure += listed;
  counts->soft_lit += lit_pairs;
  counts->soft_dark += received - lit_pairs - by_rays;
}

// The buffers of a G-buffer, its lights and its pairs: see beam_shadows().
typedef struct {
  __global const float *position, *normal, *lift;
  __global const BeamLight* lights;
  __global const uint* list_starts;
  __global const ListEntry* list;
  __global uint *lit, *unsure;
  __global TilePairs* counts;
} PairBuffers;

// Decides the pairs of a tile.
WORK void shadow_tile(uint number, const BeamFrame* frame, Scene scene, PairBuffers buffers) {
  uint entry = LIGHT_LISTS ? buffers.list_starts[number] : number * frame->light_count;
  uint end = LIGHT_LISTS ? buffers.list_starts[number + 1] : entry + frame->light_count;
  if (UNSURE_PAIRS) {
    TilePairs none = {0, 0, 0, 0};
    buffers.counts[number] = none;
  }
  if (entry == end) return;
  // Load the tile's points.
  TilePoints tile;
  scene.tile = &tile;
  load_points(&tile, frame, buffers.position, buffers.normal, buffers.lift, number * kTilePixels);
  make_bundles(&tile);
  for (; entry < end; ++entry) {
    uint index = LIGHT_LISTS ? buffers.list[entry].light : entry - number * frame->light_count;
    __global uint* lit = buffers.lit + entry * kPairWords;
    __global uint* unsure = buffers.unsure + entry * kPairWords;
    // Find the points that the light may shine on, and remove those that it doesn't reach.
    BeamLight light = buffers.lights[index];
    Remaining remaining;
    uint received = light.casts ? find_receivers(&tile, &light, &remaining) : 0;
    if (received) {
      select_cache_slot(&scene, index);
      uint first = 0;
      for (uint i = 0; i < tile.bundle_count; ++i) {
        shadow_bundle(&scene, light.place, light.size, tile.bundle + i, first, tile.bundle_end[i],
                      &remaining);
        first = tile.bundle_end[i];
      }
      write_pixels(&tile, remaining.left, remaining.unsure, 0xffff, lit);
      if (UNSURE_PAIRS) {
        write_pixels(&tile, remaining.left, remaining.unsure, 0, unsure);
        count_pairs(lit, unsure, LIGHT_LISTS ? buffers.list[entry].squares : 0xffff,
                    SOFT_EXACT && light.size > 0.0f, received, buffers.counts + number);
      }
    } else {
      for (uint i = 0; i < kPairWords; ++i) lit[i] = 0;
      for (uint i = 0; UNSURE_PAIRS && i < kPairWords; ++i) unsure[i] = 0;
    }
  }
}

// position, normal: planes x y z; lift: a plane, metres, read with LIFT only. nodes, children, blocks,
// block_bits: see TriangleTree; with HOLES block_bits, hole_texels, hole_triangles, first_hole_triangle: see
// HoleMasks. A work-item takes kBeamRun tiles.
// - lit: kPairWords words for each entry, a bit for each pixel of the tile; 0 for lights that cast no shadow.
// - unsure: as many, with HOLES or SOFT_EXACT only: not set in `lit`, and rays decide.
// - counts: of each tile, likewise.
KERNEL void beam_shadows(BeamFrame frame, __global const float* position, __global const float* normal,
                         __global const float* lift, __global const BeamLight* lights,
                         __global const uint* list_starts, __global const ListEntry* list,
                         __global const float* nodes, __global const int* children,
                         __global const float* blocks, __global const uint* block_bits,
                         __global const uchar* hole_texels, __global const HoleTriangle* hole_triangles,
                         __global const uint* first_hole_triangle, __global uint* lit, __global uint* unsure,
                         __global TilePairs* counts) {
  BlockerCache cache;
  for (uint i = 0; i < kCachedLights; ++i) cache.light[i] = NO_TRIANGLE;
  // Lanes beyond the last candidate are computed with, too.
  Candidates candidates;
  for (uint i = 0; i < sizeof(Candidates) / sizeof(uint); ++i) ((uint*)&candidates)[i] = 0;
  HoleMasks masks = {hole_texels, hole_triangles, first_hole_triangle};
  float4 most = frame.tree_most;
  Scene scene = {nodes, children, blocks,      block_bits, masks, frame.tree_root, {most.x, most.y, most.z},
                 0,     &cache,   &candidates, 0};
  PairBuffers buffers = {position, normal, lift, lights, list_starts, list, lit, unsure, counts};
  uint first = work_item() * kBeamRun;
  for (uint tile = first; tile < frame.tiles && tile < first + kBeamRun; ++tile)
    shadow_tile(tile, &frame, scene, buffers);
}
