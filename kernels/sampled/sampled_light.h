// What host and device share of sampled light (sampled_light.cl).
#ifndef LUCIOLE_SAMPLED_LIGHT_H
#define LUCIOLE_SAMPLED_LIGHT_H

#include "shared.h"

#ifdef __cplusplus
namespace luciole {
#define SHARED_SIZE(type, bytes) static_assert(sizeof(type) == (bytes), "host and device disagree on " #type)
#else
#define SHARED_SIZE(type, bytes) typedef char type##_size_check[sizeof(type) == (bytes) ? 1 : -1]
#endif

// Lights that are picked in each half of a stratum, and pixels of a group: 8 × 8 at most, in which each 4 × 4
// neighbours take different picks.
enum { kPicks = 16, kSampledPixels = 64 };

// Strata of a group, at most.
enum { kMostStrata = 4096 };

// Fields of a sampled light beside those of its row (kLightFields), kClusterSlots floats each, in rows as
// these.
enum {
  kLobeAxis = 0,   // 3: xyz unit, view space: the way it shines; 0: all ways
  kLobeRound = 3,  // it gives max(0, this − axis·L) of its colour: 1 for one that shines all ways, else 0
  kLobeCell = 4,   // what a surface sees of its cell is this times its falloff: Light::cell over quadratic
                   // attenuation
  kLobeFields
};

// In the place of BeamLight::place.w: the light casts no shadow.
#define kNoRay (-1.0f)

// Lights of a group of which a pixel asks two whether it sees them: a node of the tree of clusters.
typedef struct {
  uint level, node;  // below the leaves, too, nodes of a level share the lights evenly
  uint lights;       // 0: the stratum is gone
  float light;       // about the most that it gives a pixel if nothing is between
  float spread;      // the standard deviation of the difference of its two halves, as a share of `light`
  float unshadowed;  // what its picks would give on average if nothing were between: of the largest channels
  float key;         // light · spread: those of the largest are halved
  uint values;       // number of its values in the pool, or kNoValues
  uint first;        // of its lights, in the tree's order
  uint is_new;       // sampled in this round
} Stratum;
SHARED_SIZE(Stratum, 40);
#define kNoValues 0xffffffffu

// Floats of a stratum's values: two halves, r g b of each, of all pixels.
enum { kStratumValues = 6 * kSampledPixels };

// What sampled_light.cl counts of a tile.
enum {
  kSampledRays = 0,
  kSampledStrata,
  kSampledRounds,
  kSampledGroups,
  kMissedPixels,  // of groups whose half widths are larger than allowed
  kSampleCounts = 8
};

// Of sampled_light.cl.
typedef struct {
  ShadeFrame shade;
  float4 to_tree_x, to_tree_y, to_tree_z;  // xyz: the rows of the rotation from view space to the tree's axes
  float4 tree_most;                        // xyz: the largest |x|, |y|, |z| in the tree
  float4 to_pixel;    // xy: pixels by a point's x and y over its depth, or in a parallel view by x and y; zw:
                      // added
  float tree_scale;   // the tree's units a metre, a power of two
  int tree_root;      // TriangleTree::root
  uint light_count;   // of the tree of clusters
  uint levels;        // of that tree
  float light_error;  // E > 0: an interval's half width shall be E·max(least_value, its light)
  float least_value;
  float deviations;  // the half width in standard deviations
  uint seed;
  uint tiles;          // of the G-buffer
  uint pilot;          // rays a pixel that a group begins with
  uint parallel;       // 1: the lights are directional, at unit vectors from the origin
  float largest_cell;  // of kLobeCell
} SampleFrame;
SHARED_SIZE(SampleFrame, 240);

#undef SHARED_SIZE
#ifdef __cplusplus
}  // namespace luciole
#endif
#endif
