// Which pixels each light's shadows leave lit: exactly, by rays that go together.
//
// All rays between a tile's points and a light share an end. So instead of a ray for each pair, a walk through a tree over the scene's triangles
// finds what lies in the beam between them: most beams hold nothing, or a triangle that hides all of the points.
//
// In: planes of a G-buffer, light lists, lights and the tree. Out: for each entry of the lists kPairWords words, a bit for each pixel of the tile: the
// light reaches it. Where the scene has materials with holes, or lights of a size, also as many words of the pixels for which rays decide: those
// from which a texture is between, and those for which no single triangle, or the absence of any, decides about all of a light.
//
//   the tile's points in clusters, clusters in bundles (beam_points.clh)
//   └─ for each light of the tile's list, for each bundle
//        the last triangles that hid much from this light; then
//        a walk with the beam of the bundle (beam.clh) until kBatch candidates are found
//        └─ for each cluster: its candidates (blockers.clh), and alone the rest of the walk
//
// A work-item takes a run of tiles, and remembers from one to the next what hid much from a light. Cost: a walk of some 10 nodes and blocks of 16
// triangles for each bundle and light; 30 instructions for each candidate and row of points.
#include "beam.clh"
#include "beam_points.clh"
#include "blockers.clh"
#include "features.clh"
#include "hole_masks.clh"
#include "lanes.clh"
#include "math.clh"
#include "shared.h"

// A walk for a whole bundle ends where that many candidates are found: clusters go on alone.
enum { kBatch = 64, kRoom = kBatch + 2 * kTreeWidth };

// A triangle is remembered as one that hides much if it hides that part of a cluster's points.
enum { kMuch = 4 };

#define NO_TRIANGLE 0xffffffffu

// Triangles that hid much from a light in the tiles before: kTreeWidth references for each of some lights, or NO_TRIANGLE. Lights whose numbers
// are alike share a place.
enum { kLightsRemembered = 128 };
typedef struct {
  uint light[kLightsRemembered];
  uint reference[kLightsRemembered][kTreeWidth];
  uint next[kLightsRemembered];  // to be replaced
} Memory;

// Triangles that may hide points of a bundle, turned so that D > 0, by right, up, ahead.
typedef struct {
  float edge[3][3][kRoom] ALIGNED;
  float shift[3][kRoom] ALIGNED;
  float normal[3][kRoom] ALIGNED;
  float offset[kRoom] ALIGNED;
  float rounding[kRoom] ALIGNED;
  float across[kRoom] ALIGNED;
  float own[kRoom] ALIGNED;
#if SOFT_EXACT
  float blur[3][kRoom] ALIGNED;
  uint straddles[kRoom / kTreeWidth];  // bits
#endif
  uint reference[kRoom];
  uint holes[kRoom / kTreeWidth];  // bits: a texture decides
  uint clear[kRoom / kTreeWidth];  // bits: the light is clear of the plane
  uint count;
} Candidates;

// What all of a tile's walks share.
typedef struct {
  __global const float *nodes;
  __global const int *children;
  __global const float *blocks;
  __global const uint *block_bits;
  HoleMasks masks;
  int root;
  float most[3];  // the largest |x|, |y|, |z| in the tree
  TilePoints *tile;
  Memory *memory;
  Candidates *candidates;
  uint place;  // in the memory, of the light at hand
} Scene;

// What is left of a tile's points for a light.
typedef struct {
  ushort left[kMaxRows];    // bits of the points that nothing is known to hide
  ushort unsure[kMaxRows];  // of those for which rays decide
} Remaining;

INLINE uint count_points(const ushort *left, uint first_row, uint end_row) {
  uint count = 0;
  for (uint row = first_row; row < end_row; ++row) count += popcount((uint)left[row]);
  return count;
}

INLINE void remember(const Scene *scene, uint reference) {
  Memory *memory = scene->memory;
  uint *references = memory->reference[scene->place];
  for (uint i = 0; i < kTreeWidth; ++i)
    if (references[i] == reference) return;
  references[memory->next[scene->place]++ % kTreeWidth] = reference;
}

// Appends the candidates among some triangles. hollow: bits of those with holes.
INLINE void append(Candidates *to, const Triangles *t, const uint *references, uint hollow) {
  uint bits = t->candidates, at = to->count;
  UNROLLED(i, 3) {
    store_chosen(to->edge[i][0] + at, t->edge[i].x, bits);
    store_chosen(to->edge[i][1] + at, t->edge[i].y, bits);
    store_chosen(to->edge[i][2] + at, t->edge[i].z, bits);
    store_chosen(to->shift[i] + at, t->shift[i], bits);
    store_chosen(to->normal[i] + at, t->normal[i], bits);
  }
  store_chosen(to->offset + at, t->offset, bits);
  store_chosen(to->rounding + at, t->rounding, bits);
  store_chosen(to->across + at, t->across, bits);
  store_chosen(to->own + at, t->own, bits);
#if SOFT_EXACT
  UNROLLED(i, 3) store_chosen(to->blur[i] + at, t->blur[i], bits);
#endif
  for (; bits; bits &= bits - 1, ++at) {
    uint lane = lowest_bit(bits), word = at / kTreeWidth, bit = 1u << at % kTreeWidth;
    to->reference[at] = references[lane];
    to->clear[word] = (to->clear[word] & ~bit) | (t->clear >> lane & 1 ? bit : 0);
    if (HOLES) to->holes[word] = (to->holes[word] & ~bit) | (hollow >> lane & 1 ? bit : 0);
#if SOFT_EXACT
    to->straddles[word] = (to->straddles[word] & ~bit) | (t->straddles >> lane & 1 ? bit : 0);
#endif
  }
  to->count = at;
}

INLINE floatL part_of(const float *values, uint at) { return *(const floatL *)(values + at); }

// Decides a candidate and a point that it hides unless floats are wrong: whether its edges hold the point, if they are `unsure`, and whether it is
// before the point, if the light isn't clear of its plane.
WORK bool hides_exactly(const Scene *scene, float4 light, uint reference, uint point, bool unsure, bool clear) {
  const TilePoints *tile = scene->tile;
  float4 start = (float4)(tile->place[0][point], tile->place[1][point], tile->place[2][point], 0.0f);
  return (!unsure || edges_hold(scene->blocks, reference, light, start)) && (clear || is_before(scene->blocks, reference, light, start));
}

// The points of a row that are inside of a candidate's edges, or may be; in *sure those that certainly are.
INLINE uint inside_edges(const Outlook *outlook, const float *const *places, const Candidates *c, uint at, uint row, uint *sure) {
  uint inside = 0;
  *sure = 0;
  floatL rounding = c->rounding[at];
  for (uint i = 0; i < kTreeWidth; i += LANES) {
    uint point = row * kTreeWidth + i;
    floatL right = part_of(places[0], point) - outlook->from[outlook->axis[0]];
    floatL up = part_of(places[1], point) - outlook->from[outlook->axis[1]];
    floatL ahead = part_of(places[2], point) - outlook->from[outlook->axis[2]];
    floatL least = INFINITY;
    UNROLLED(e, 3) {
      floatL value = fma_lanes((floatL)(c->edge[e][0][at]), right,
                               fma_lanes((floatL)(c->edge[e][1][at]), up,
                                         fma_lanes((floatL)(c->edge[e][2][at]), ahead, (floatL)(c->shift[e][at]))));
      least = min_lanes(least, value);
    }
    inside |= lane_bits(least >= -rounding) << i;
    *sure |= lane_bits(least > rounding) << i;
  }
  return inside;
}

// Of points inside of a candidate's edges, those that it hides.
INLINE uint hidden_inside(const Scene *scene, const Outlook *outlook, const Candidates *c, uint at, uint row, uint inside, uint sure) {
  const TilePoints *tile = scene->tile;
  uint beyond = 0;
  for (uint i = 0; i < kTreeWidth; i += LANES) {
    uint point = row * kTreeWidth + i;
    floatL height = fma_lanes((floatL)(c->normal[0][at]), part_of(tile->place[0], point),
                              fma_lanes((floatL)(c->normal[1][at]), part_of(tile->place[1], point),
                                        fma_lanes((floatL)(c->normal[2][at]), part_of(tile->place[2], point), (floatL)(-c->offset[at]))));
    beyond |= lane_bits(height > max_lanes(part_of(tile->tolerance, point), (floatL)(c->own[at]))) << i;
  }
  inside &= beyond;
  bool clear = c->clear[at / kTreeWidth] >> at % kTreeWidth & 1;
  for (uint unsure = clear ? inside & ~sure : inside; unsure; unsure &= unsure - 1) {
    uint bit = lowest_bit(unsure);
    if (!hides_exactly(scene, outlook->place, c->reference[at], row * kTreeWidth + bit, !(sure >> bit & 1), clear)) inside &= ~(1u << bit);
  }
  return inside;
}

#if SOFT_EXACT
// The points of a row that a candidate hides from all of a light of a size; in *some those that it may hide from a part of it.
INLINE uint hidden_from_all(const Scene *scene, const Outlook *outlook, const float *const *places, const Candidates *c, uint at, uint row,
                            uint *some) {
  const TilePoints *tile = scene->tile;
  bool straddles = c->straddles[at / kTreeWidth] >> at % kTreeWidth & 1, clear = c->clear[at / kTreeWidth] >> at % kTreeWidth & 1;
  floatL rounding = c->rounding[at];
  uint all = 0;
  *some = 0;
  for (uint i = 0; i < kTreeWidth; i += LANES) {
    uint point = row * kTreeWidth + i;
    floatL right = part_of(places[0], point) - outlook->from[outlook->axis[0]];
    floatL up = part_of(places[1], point) - outlook->from[outlook->axis[1]];
    floatL ahead = part_of(places[2], point) - outlook->from[outlook->axis[2]];
    floatL most = INFINITY, least = INFINITY, reversed = -INFINITY;
    UNROLLED(e, 3) {
      floatL value = fma_lanes((floatL)(c->edge[e][0][at]), right,
                               fma_lanes((floatL)(c->edge[e][1][at]), up,
                                         fma_lanes((floatL)(c->edge[e][2][at]), ahead, (floatL)(c->shift[e][at]))));
      floatL blur = c->blur[e][at] + rounding;
      most = min_lanes(most, value + blur);
      least = min_lanes(least, value - blur);
      reversed = max_lanes(reversed, value - blur);
    }
    floatL height = fma_lanes((floatL)(c->normal[0][at]), part_of(tile->place[0], point),
                              fma_lanes((floatL)(c->normal[1][at]), part_of(tile->place[1], point),
                                        fma_lanes((floatL)(c->normal[2][at]), part_of(tile->place[2], point), (floatL)(-c->offset[at]))));
    floatL nearest = max_lanes(part_of(tile->tolerance, point), (floatL)(c->own[at]));
    intL beyond = height > nearest, part = beyond & (most >= 0.0f);
    if (straddles) part |= (abs_lanes(height) > nearest) & ((most >= 0.0f) | (reversed <= 0.0f));
    *some |= lane_bits(part) << i;
    if (clear && !straddles) all |= lane_bits(beyond & (least > 0.0f)) << i;
  }
  return all;
}

// Of a light of a size: takes from what is left of a cluster's points those that one of some candidates hides from all of it, and marks those that
// one may hide from a part. bits, holes: of candidates [at, at + kTreeWidth). Returns how many are hidden.
INLINE uint test_from_all(const Scene *scene, const Outlook *outlook, const float *const *places, const Candidates *c, uint at, uint bits, uint holes,
                          const Cluster *cluster, Remaining *remaining, uint all) {
  uint hits = 0;
  for (; bits; bits &= bits - 1) {
    uint bit = lowest_bit(bits), hidden = 0;
    bool hollow = holes >> bit & 1;
    for (uint row = cluster->first_row; row < cluster->end_row; ++row) {
      uint left = remaining->left[row];
      if (!left) continue;
      uint some, points = hidden_from_all(scene, outlook, places, c, at + bit, row, &some) & left;
      remaining->unsure[row] |= (ushort)(some & left);
      if (hollow) continue;
      remaining->left[row] &= (ushort)~points;
      hidden += popcount(points);
    }
    if (hidden * kMuch >= all && !hollow) remember(scene, c->reference[at + bit]);
    hits += hidden;
  }
  return hits;
}
#endif

// Whether nothing is left of a cluster's points but such as rays decide about.
INLINE bool rays_decide(const Cluster *cluster, const Remaining *remaining) {
  uint left = 0;
  for (uint row = cluster->first_row; row < cluster->end_row; ++row) left |= remaining->left[row] & ~remaining->unsure[row];
  return !left;
}

// kSolid, kHole or kMixed where a candidate with holes meets the ray to a point that it hides.
INLINE uint opacity_for(const Scene *scene, const Outlook *outlook, const Candidates *c, uint at, uint point) {
  const TilePoints *tile = scene->tile;
  const uint *axis = outlook->axis;
  float s[3], edges[3];
  for (uint i = 0; i < 3; ++i) s[i] = tile->place[axis[i]][point] - outlook->from[axis[i]];
  UNROLLED(e, 3) edges[e] = fma(c->edge[e][0][at], s[0], fma(c->edge[e][1][at], s[1], fma(c->edge[e][2][at], s[2], c->shift[e][at])));
  uint reference = c->reference[at], block = BLOCK_OF(reference);
  return opacity_at(&scene->masks, block, SLOT_OF(reference), scene->block_bits[block] >> kTreeWidth, edges, c->rounding[at]);
}

// Of the points of a row that a candidate with holes may hide, those that it hides. Marks those for which its texture decides.
INLINE uint hidden_by_hollow(const Scene *scene, const Outlook *outlook, const Candidates *c, uint at, uint row, uint points, Remaining *remaining) {
  uint hidden = 0;
  for (; points; points &= points - 1) {
    uint bit = lowest_bit(points), opacity = opacity_for(scene, outlook, c, at, row * kTreeWidth + bit);
    if (opacity == kSolid) hidden |= 1u << bit;
    if (opacity == kMixed) remaining->unsure[row] |= (ushort)(1u << bit);
  }
  return hidden;
}

// Which of LANES candidates, from `first` on and of those in `inside`, hide a point; or only some of them, if one without holes certainly does.
INLINE uint hiding_point(const Scene *scene, const Outlook *outlook, const Candidates *c, uint first, uint clear, uint holes, uint point,
                         uint inside, uint sure) {
  const TilePoints *tile = scene->tile;
  floatL height = fma_lanes(part_of(c->normal[0], first), (floatL)(tile->place[0][point]),
                            fma_lanes(part_of(c->normal[1], first), (floatL)(tile->place[1][point]),
                                      fma_lanes(part_of(c->normal[2], first), (floatL)(tile->place[2][point]), -part_of(c->offset, first))));
  inside &= lane_bits(height > max_lanes((floatL)(tile->tolerance[point]), part_of(c->own, first)));
  uint hiding = inside & sure & clear;
  for (uint unsure = hiding & ~holes ? 0 : inside & ~hiding; unsure; unsure &= unsure - 1) {
    uint bit = lowest_bit(unsure);
    if (hides_exactly(scene, outlook->place, c->reference[first + bit], point, !(sure >> bit & 1), clear >> bit & 1)) hiding |= 1u << bit;
  }
  return hiding;
}

// Tests candidates [at, at + kTreeWidth), of those in `bits`, against the points of a cluster that are left, one point after another. Returns how
// many are hidden, and a triangle without holes that hides one, if any, in *found.
INLINE uint test_points(const Scene *scene, const Outlook *outlook, const Candidates *c, uint at, uint bits, uint holes, const Cluster *cluster,
                        Remaining *remaining, uint *found) {
  const TilePoints *tile = scene->tile;
  const uint *axis = outlook->axis;
  uint clear = c->clear[at / kTreeWidth], hits = 0;
  for (uint i = 0; i < kTreeWidth; i += LANES) {
    uint first = at + i;
    floatL edge[3][3], shift[3], rounding = part_of(c->rounding, first);
    UNROLLED(e, 3) {
      UNROLLED(j, 3) edge[e][j] = part_of(c->edge[e][j], first);
      shift[e] = part_of(c->shift[e], first);
    }
    for (uint row = cluster->first_row; row < cluster->end_row; ++row) {
      uint hidden = 0;
      for (uint points = remaining->left[row]; points; points &= points - 1) {
        uint bit = lowest_bit(points), point = row * kTreeWidth + bit;
        floatL right = tile->place[axis[0]][point] - outlook->from[axis[0]];
        floatL up = tile->place[axis[1]][point] - outlook->from[axis[1]];
        floatL ahead = tile->place[axis[2]][point] - outlook->from[axis[2]];
        floatL least = INFINITY;
        UNROLLED(e, 3) least = min_lanes(least, fma_lanes(edge[e][0], right, fma_lanes(edge[e][1], up, fma_lanes(edge[e][2], ahead, shift[e]))));
        uint inside = lane_bits(least >= -rounding) & bits >> i;
        if (!inside) continue;
        uint hiding = hiding_point(scene, outlook, c, first, clear >> i, holes >> i, point, inside, lane_bits(least > rounding));
        if (hiding & ~(holes >> i)) {
          hidden |= 1u << bit;
          *found = c->reference[first + lowest_bit(hiding & ~(holes >> i))];
          continue;
        }
        for (; HOLES && hiding && !(hidden >> bit & 1); hiding &= hiding - 1)
          hidden |= hidden_by_hollow(scene, outlook, c, first + lowest_bit(hiding), row, 1u << bit, remaining);
      }
      remaining->left[row] &= (ushort)~hidden;
      hits += popcount(hidden);
    }
  }
  return hits;
}

// Of the candidates [at, at + kTreeWidth), the bits of those that may hide a point of a target, and in *covers of those that hide all.
INLINE uint choose_candidates(const Outlook *outlook, const Target *target, const Candidates *c, uint at, uint *covers) {
  uint bits = 0;
  *covers = 0;
  for (uint i = 0; i < kTreeWidth; i += LANES) {
    vec3L edge[3];
    floatL shift[3], normal[3], blur[3];
    intL straddles = 0;
    UNROLLED(e, 3) blur[e] = 0.0f;
#if SOFT_EXACT
    straddles = lanes_of_bits(c->straddles[at / kTreeWidth] >> i);
    UNROLLED(e, 3) blur[e] = part_of(c->blur[e], at + i);
#endif
    UNROLLED(e, 3) {
      edge[e].x = part_of(c->edge[e][0], at + i);
      edge[e].y = part_of(c->edge[e][1], at + i);
      edge[e].z = part_of(c->edge[e][2], at + i);
      shift[e] = part_of(c->shift[e], at + i);
      normal[e] = part_of(c->normal[e], at + i);
    }
    intL in, covered, beyond, all_beyond;
    test_planes(normal, part_of(c->offset, at + i), part_of(c->own, at + i), &target->bounds, &beyond, &all_beyond);
    if (has_size(outlook)) {
      beyond |= straddles;
      all_beyond &= ~straddles;
    }
    if (target->narrow) {
      test_rectangle(edge, shift, part_of(c->across, at + i), blur, straddles, &target->sides, outlook, &in, &covered);
      beyond &= in;
      all_beyond &= covered;
      *covers |= lane_bits(all_beyond) << i;
    }
    bits |= lane_bits(beyond) << i;
  }
  return bits;
}

// Tests all candidates against a cluster's points. target: what is left of the cluster; 0 if the candidates were chosen for it. Returns whether
// any point is left.
WORK bool test_candidates(const Scene *scene, const Outlook *outlook, const Target *target, const Candidates *c, const Cluster *cluster,
                          Remaining *remaining) {
  const float *const places[3] = {scene->tile->place[outlook->axis[0]], scene->tile->place[outlook->axis[1]], scene->tile->place[outlook->axis[2]]};
  uint all = count_points(remaining->left, cluster->first_row, cluster->end_row), left = all;
  for (uint at = 0; at < c->count; at += kTreeWidth) {
    uint bits = c->count - at < kTreeWidth ? (1u << (c->count - at)) - 1 : 0xffff, holes = HOLES ? c->holes[at / kTreeWidth] : 0;
    if (target) {
      uint covers;
      bits &= choose_candidates(outlook, target, c, at, &covers);
      covers &= bits & ~holes & c->clear[at / kTreeWidth];
      if (covers) {
        for (uint row = cluster->first_row; row < cluster->end_row; ++row) remaining->left[row] = 0;
        remember(scene, c->reference[at + lowest_bit(covers)]);
        return false;
      }
      if (!bits) continue;
    }
#if SOFT_EXACT
    if (has_size(outlook)) {
      left -= test_from_all(scene, outlook, places, c, at, bits, holes, cluster, remaining, all);
      if (!left) return false;
      continue;
    }
#endif
    uint rows = 0;
    for (uint row = cluster->first_row; row < cluster->end_row; ++row) rows += remaining->left[row] ? 1 : 0;
    // One point against kTreeWidth triangles takes twice as long as one triangle against a row of points.
    if (2 * left <= popcount(bits) * rows) {
      uint found = NO_TRIANGLE, hits = test_points(scene, outlook, c, at, bits, holes, cluster, remaining, &found);
      left -= hits;
      if (found != NO_TRIANGLE && hits * kMuch >= all) remember(scene, found);
      if (!left) return false;
      continue;
    }
    for (; bits; bits &= bits - 1) {
      uint bit = lowest_bit(bits), hidden = 0, any = 0;
      bool hollow = holes >> bit & 1;
      // Most candidates hide nothing: first the edges alone, of all rows.
      ushort inside[kTreeWidth], sure[kTreeWidth];
      for (uint row = cluster->first_row; row < cluster->end_row; ++row) {
        uint certain, some = inside_edges(outlook, places, c, at + bit, row, &certain) & remaining->left[row];
        inside[row - cluster->first_row] = (ushort)some;
        sure[row - cluster->first_row] = (ushort)certain;
        any |= some;
      }
      if (!any) continue;
      for (uint row = cluster->first_row; row < cluster->end_row; ++row) {
        uint some = inside[row - cluster->first_row];
        if (!some) continue;
        uint points = hidden_inside(scene, outlook, c, at + bit, row, some, sure[row - cluster->first_row]);
        if (HOLES && hollow) points = hidden_by_hollow(scene, outlook, c, at + bit, row, points, remaining);
        remaining->left[row] &= (ushort)~points;
        hidden += popcount(points);
      }
      if (!hollow && hidden * kMuch >= all) remember(scene, c->reference[at + bit]);
      left -= hidden;
      if (!left) return false;
    }
  }
  return true;
}

// A walk through the tree: references of nodes, and of blocks as their complements.
typedef struct {
  int stack[kMaxTreeDepth * (kTreeWidth - 1) + 1];
  uint height;
} BeamWalk;

// Adds what may hide points of the beam to the candidates. Returns true if a triangle covers the beam. hollow: bits of those with holes.
INLINE bool take_blockers(const Scene *scene, const Outlook *outlook, const Beam *beam, const Blockers *blockers, uint hollow,
                          Candidates *candidates) {
  Triangles triangles;
  if (!meet(beam, outlook, scene->blocks, blockers, &triangles)) return false;
  uint covers = triangles.covers & ~hollow;
  if (covers) {
    remember(scene, blockers->reference[lowest_bit(covers)]);
    return true;
  }
  append(candidates, &triangles, blockers->reference, hollow);
  return false;
}

// Goes on with a walk, until `batch` candidates are found or it ends. Returns true if a triangle covers the beam.
WORK bool find_candidates(const Scene *scene, const Outlook *outlook, const Beam *beam, BeamWalk *walk, Candidates *candidates, uint batch) {
  candidates->count = 0;
  while (walk->height && candidates->count < batch) {
    int reference = walk->stack[--walk->height];
    if (reference >= 0) {
      uint touched = touched_children(beam, scene->nodes + reference * (kNodeRows * kTreeWidth));
      for (; touched; touched &= touched - 1)
        walk->stack[walk->height++] = scene->children[reference * kTreeWidth + lowest_bit(touched)];
      continue;
    }
    uint block = ~reference, bits = scene->block_bits[block];
    for (uint i = 0; i < kTreeWidth; i += LANES) {
      Blockers blockers;
      load_blockers(outlook, scene->blocks, block, i, bits >> i, &blockers);
      if (take_blockers(scene, outlook, beam, &blockers, HOLES ? bits >> (kTreeWidth + i) : 0, candidates)) return true;
    }
  }
  return false;
}

// Those triangles that hid much from this light lately. Returns true if one covers the beam.
INLINE bool recall(const Scene *scene, const Outlook *outlook, const Beam *beam, Candidates *candidates) {
  candidates->count = 0;
  for (uint i = 0; i < kTreeWidth; i += LANES) {
    uint references[LANES], used = 0;
    for (uint lane = 0; lane < LANES; ++lane) {
      uint reference = scene->memory->reference[scene->place][i + lane];
      bool is_one = reference != NO_TRIANGLE;
      used |= is_one ? 1u << lane : 0;
      references[lane] = is_one ? reference : 0;
    }
    if (!used) continue;
    Blockers blockers;
    gather_blockers(outlook, scene->blocks, references, used, &blockers);
    // None of them has holes.
    if (take_blockers(scene, outlook, beam, &blockers, 0, candidates)) return true;
  }
  return false;
}

INLINE void hide_all(const Cluster *cluster, Remaining *remaining) {
  for (uint row = cluster->first_row; row < cluster->end_row; ++row) remaining->left[row] = 0;
}

INLINE Rectangle bound_cluster(const Scene *scene, const Outlook *outlook, bool narrow, const Cluster *cluster, const Remaining *remaining) {
  return narrow ? bound_rows(scene->tile, outlook, cluster->first_row, cluster->end_row, remaining->left) : no_rectangle();
}

// Goes to the end of a walk for one cluster.
WORK void finish_cluster(const Scene *scene, const Outlook *outlook, bool narrow, const Cluster *cluster, BeamWalk *walk, Candidates *candidates,
                         Remaining *remaining) {
  Beam beam;
  uint left = 0;
  while (walk->height) {
    if (has_size(outlook) && rays_decide(cluster, remaining)) return;
    // A beam to half of the points meets less.
    uint now = count_points(remaining->left, cluster->first_row, cluster->end_row);
    if (left == 0 || 2 * now <= left) {
      Target target = make_target(outlook, narrow, &cluster->bounds, bound_cluster(scene, outlook, narrow, cluster, remaining));
      make_beam(&beam, outlook, &target);
      left = now;
    }
    if (find_candidates(scene, outlook, &beam, walk, candidates, 1)) {
      hide_all(cluster, remaining);
      return;
    }
    if (candidates->count && !test_candidates(scene, outlook, 0, candidates, cluster, remaining)) return;
  }
}

// The clusters of a bundle that have points left, each with its target.
typedef struct {
  uint count;
  const Cluster *cluster[kMaxClusters];
  Target target[kMaxClusters];
} Active;

// The beam to all of them, which are of a bundle with these bounds.
INLINE void beam_to_all(const Outlook *outlook, const PointBounds *bounds, const Active *active, Beam *beam) {
  Rectangle rectangle = no_rectangle();
  for (uint i = 0; i < active->count; ++i) grow_rectangle(&rectangle, &active->target[i].sides);
  Target target = {true, rectangle, *bounds};
  make_beam(beam, outlook, &target);
}

// Tests candidates against all clusters, and leaves those active that have points left. Returns whether any are.
INLINE bool test_all(const Scene *scene, const Outlook *outlook, const Candidates *candidates, Active *active, Remaining *remaining) {
  uint count = 0;
  for (uint i = 0; i < active->count; ++i) {
    if (!test_candidates(scene, outlook, active->target + i, candidates, active->cluster[i], remaining)) continue;
    active->cluster[count] = active->cluster[i];
    active->target[count++] = active->target[i];
  }
  active->count = count;
  return count > 0;
}

// Takes from what is left of a bundle's points those that a light doesn't reach.
WORK void shade_bundle(const Scene *scene, float4 place, float size, const PointBounds *bounds, uint first, uint end, Remaining *remaining) {
  TilePoints *tile = scene->tile;
  Active active;
  active.count = 0;
  for (uint i = first; i < end; ++i) {
    const Cluster *cluster = tile->cluster + i;
    if (!count_points(remaining->left, cluster->first_row, cluster->end_row)) continue;
    active.cluster[active.count++] = cluster;
  }
  if (!active.count) return;
  Outlook outlook;
  for (uint axis = 0; axis < 3; ++axis) outlook.most[axis] = scene->most[axis];
  Candidates *candidates = scene->candidates;
  BeamWalk walk;
  if (!look(place, size, &bounds->box, &outlook)) {
    // The light is amid the points or near them. It may still be beside each cluster.
    for (uint i = 0; i < active.count; ++i) {
      const Cluster *cluster = active.cluster[i];
      bool narrow = look(place, size, &cluster->bounds.box, &outlook);
      walk.height = 1;
      walk.stack[0] = scene->root;
      finish_cluster(scene, &outlook, narrow, cluster, &walk, candidates, remaining);
    }
    return;
  }
  for (uint i = 0; i < active.count; ++i) {
    const Cluster *cluster = active.cluster[i];
    active.target[i] = make_target(&outlook, true, &cluster->bounds, bound_cluster(scene, &outlook, true, cluster, remaining));
  }
  Beam beam;
  beam_to_all(&outlook, bounds, &active, &beam);
  bool covered = recall(scene, &outlook, &beam, candidates);
  if (!covered && candidates->count) {
    uint before = active.count;
    if (!test_all(scene, &outlook, candidates, &active, remaining)) return;
    if (active.count < before) beam_to_all(&outlook, bounds, &active, &beam);
  }
  if (!covered) {
    walk.height = 1;
    walk.stack[0] = scene->root;
    covered = find_candidates(scene, &outlook, &beam, &walk, candidates, kBatch);
  }
  if (covered) {
    for (uint i = 0; i < active.count; ++i) hide_all(active.cluster[i], remaining);
    return;
  }
  if (candidates->count && !test_all(scene, &outlook, candidates, &active, remaining)) return;
  for (uint i = 0; i < active.count && walk.height; ++i) {
    BeamWalk rest;
    rest.height = walk.height;
    for (uint j = 0; j < walk.height; ++j) rest.stack[j] = walk.stack[j];
    finish_cluster(scene, &outlook, true, active.cluster[i], &rest, candidates, remaining);
  }
}

// Sets `remaining` to the points that a light may shine on: those in its range that face it. Margins make up for rounding and for the lift, so that
// this misses none that shading lights. Returns how many there are.
INLINE uint find_receivers(const TilePoints *tile, const BeamLight *light, Remaining *remaining) {
  uint rows = tile->cluster_count ? tile->cluster[0].end_row : 0, count = 0;
  for (uint i = 1; i < tile->cluster_count; ++i) rows = max(rows, tile->cluster[i].end_row);
  bool parallel = light->place.w == 0.0f;
  float reach = light->reach + tile->most_lift, reach2 = 1.00001f * reach * reach;
  for (uint row = 0; row < rows; ++row) {
    uint receives = 0;
    for (uint i = 0; i < kTreeWidth; i += LANES) {
      uint point = row * kTreeWidth + i;
      vec3L n = {part_of(tile->normal[0], point), part_of(tile->normal[1], point), part_of(tile->normal[2], point)};
      intL faces;
      if (parallel) {
        faces = dot3s(n, light->place) > -1e-5f;
      } else {
        vec3L way = {light->place.x - part_of(tile->place[0], point), light->place.y - part_of(tile->place[1], point),
                     light->place.z - part_of(tile->place[2], point)};
        floatL length = abs_lanes(way.x) + abs_lanes(way.y) + abs_lanes(way.z);
        faces = dot3(n, way) > -1e-5f * length - tile->most_lift;
        faces &= !(dot3(way, way) > reach2);
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

// Writes bits of points to those of their pixels.
INLINE void write_pixels(const TilePoints *tile, const ushort *left, const ushort *masked, uint keep, __global uint *words) {
  for (uint i = 0; i < kPairWords; ++i) words[i] = 0;
  for (uint i = 0; i < tile->cluster_count; ++i) {
    const Cluster *cluster = tile->cluster + i;
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

// Finds the light's place in the memory.
INLINE void recall_light(Scene *scene, uint light) {
  Memory *memory = scene->memory;
  scene->place = light % kLightsRemembered;
  if (memory->light[scene->place] == light) return;
  memory->light[scene->place] = light;
  memory->next[scene->place] = 0;
  for (uint i = 0; i < kTreeWidth; ++i) memory->reference[scene->place][i] = NO_TRIANGLE;
}

// Decides the pairs of a tile. All but `number`: see beam_shadows().
WORK void shade_tile(uint number, Scene scene, ToTree to_tree, __global const float *position, __global const float *normal, __global const float *lift,
                     uint plane_stride, __global const BeamLight *lights, uint light_count, __global const uint *list_starts,
                     __global const ListEntry *list, __global uint *lit, __global uint *unsure, __global uint *receivers) {
  uint entry = LIGHT_LISTS ? list_starts[number] : number * light_count;
  uint end = LIGHT_LISTS ? list_starts[number + 1] : entry + light_count;
  if (entry == end) return;
  TilePoints tile;
  scene.tile = &tile;
  load_points(&tile, &to_tree, position, normal, lift, plane_stride, number * kTilePixels);
  make_bundles(&tile);
  for (; entry < end; ++entry) {
    uint index = LIGHT_LISTS ? list[entry].light : entry - number * light_count;
    BeamLight light = lights[index];
    Remaining remaining;
    uint received = light.casts ? find_receivers(&tile, &light, &remaining) : 0;
    if (received) {
      recall_light(&scene, index);
      uint first = 0;
      for (uint i = 0; i < tile.bundle_count; ++i) {
        shade_bundle(&scene, light.place, light.size, tile.bundle + i, first, tile.bundle_end[i], &remaining);
        first = tile.bundle_end[i];
      }
      write_pixels(&tile, remaining.left, remaining.unsure, 0xffff, lit + entry * kPairWords);
      if (UNSURE_PAIRS) write_pixels(&tile, remaining.left, remaining.unsure, 0, unsure + entry * kPairWords);
      if (SOFT_EXACT) receivers[entry] = light.size > 0.0f ? received : 0;
    } else {
      for (uint i = 0; i < kPairWords; ++i) lit[entry * kPairWords + i] = 0;
      for (uint i = 0; UNSURE_PAIRS && i < kPairWords; ++i) unsure[entry * kPairWords + i] = 0;
      if (SOFT_EXACT) receivers[entry] = 0;
    }
  }
}

// position, normal: planes x y z, `plane_stride` floats each; lift: a plane, metres, read with LIFT only. nodes, children, blocks, block_bits,
// root: see TriangleTree; with HOLES block_bits, hole_texels, hole_triangles, first_hole_triangle: see HoleMasks. to_tree_x, y, z: the rows of the
// rotation from view space to the tree's axes; w of the first: the tree's scale. tree_most: the largest |x|, |y|, |z| in the tree. tiles: of the
// G-buffer; a work-item takes kBeamRun of them. lit: kPairWords words for each entry, a bit for each pixel of the tile; 0 for lights that cast no
// shadow. unsure: as many, with HOLES or SOFT_EXACT only: not set in `lit`, and rays decide. receivers: a number for each entry, with SOFT_EXACT
// only: of pixels that a light of a size may reach; 0 for other lights.
__kernel void beam_shadows(uint plane_stride, __global const float *position, __global const float *normal, __global const float *lift,
                           float4 to_tree_x, float4 to_tree_y, float4 to_tree_z, __global const BeamLight *lights, uint light_count,
                           __global const uint *list_starts, __global const ListEntry *list, __global const float *nodes,
                           __global const int *children, __global const float *blocks, __global const uint *block_bits, __global const uchar *hole_texels,
                           __global const HoleTriangle *hole_triangles, __global const uint *first_hole_triangle, int root, float4 tree_most, uint tiles, __global uint *lit, __global uint *unsure,
                           __global uint *receivers) {
  Memory memory;
  for (uint i = 0; i < kLightsRemembered; ++i) memory.light[i] = NO_TRIANGLE;
  // Lanes beyond the last candidate are computed with, too.
  Candidates candidates;
  for (uint i = 0; i < sizeof(Candidates) / sizeof(uint); ++i) ((uint *)&candidates)[i] = 0;
  Scene scene = {nodes, children, blocks, block_bits, {hole_texels, hole_triangles, first_hole_triangle}, root, {tree_most.x, tree_most.y, tree_most.z}, 0, &memory, &candidates, 0};
  ToTree to_tree = {to_tree_x, to_tree_y, to_tree_z, to_tree_x.w};
  uint first = get_global_id(0) * kBeamRun;
  for (uint tile = first; tile < tiles && tile < first + kBeamRun; ++tile)
    shade_tile(tile, scene, to_tree, position, normal, lift, plane_stride, lights, light_count, list_starts, list, lit, unsure, receivers);
}
