// Constants and structs that host and device share: both compile this file. Structs hold only float, int,
// uint and 4-vectors, because OpenCL's float3 has 16 bytes and GLM's vec3 has 12.
// tests/cl/struct_layout_test.cpp compares every offset.
#ifndef LUCIOLE_SHARED_H
#define LUCIOLE_SHARED_H

#include "models.h"

#ifdef __cplusplus
namespace luciole {
typedef unsigned int uint;
struct alignas(16) float4 {
  float x, y, z, w;
};
#define SHARED_SIZE(type, bytes) static_assert(sizeof(type) == (bytes), "host and device disagree on " #type)
#else
#define SHARED_SIZE(type, bytes) typedef char type##_size_check[sizeof(type) == (bytes) ? 1 : -1]
#endif

enum {
  kTileSize = 16,                       // pixels a side of the squares that a G-buffer is stored in
  kTilePixels = kTileSize * kTileSize,  // in Z order
  kSquaresPerTile = 16,                 // of 4×4 pixels
};

// Rows of pixels that a work-item of shade.cl takes. Several rows of one tile keep all ABREAST places filled
// even if each meets few lights. Without lists a row meets all lights and fills them alone, and the sums of a
// single row stay in registers.
#define ROWS_PER_ITEM(lanes, lists) ((lanes) == 1 || !(lists) ? 1 : 4)

// The square of its tile, 0 to kSquaresPerTile − 1, that a pixel belongs to. place: its index in a plane, or
// in its tile.
#define SQUARE_OF_PIXEL(place) ((place) / (kTilePixels / kSquaresPerTile) % kSquaresPerTile)

// Tiles that a work-item of shade_tiles.cl takes at most.
enum { kBlockTiles = 16 };

// Of such blocks as follow each other side by side in the order of work-items.
enum { kBlockRun = 8 };

// An entry of a tile's light list.
typedef struct {
  uint light;    // its index
  uint squares;  // bit i: the light may light square i
} ListEntry;
SHARED_SIZE(ListEntry, 8);

// How many entries of a tile counting keeps: a list that isn't longer need not be found again when lists are
// written.
enum { kFoundPerTile = 128 };

// The tests by which culling leaves a light out of a list, as bits. Range is always tested: kByRange asks for
// no other.
// - kByCone: no point lies in a spot's cone.
// - kByFacing: every point faces away from the light. Only right where no light gives ambient light.
enum { kByRange = 0, kByCone = 1, kByFacing = 2 };

// Children of a node in the tree over the lights.
enum { kTreeArity = 16 };

// The tree over a scene's triangles (host/shadow/exact/triangle_tree.hpp): children of a node, and triangles
// of a block, which is a leaf.
enum { kTreeWidth = 16 };

// Rows of kTreeWidth floats of a node: low x, high x, low y, high y, low z, high z of each child's box. A
// child that isn't there has low = +∞ and high = −∞.
enum { kNodeRows = 6 };

// Rows of kTreeWidth floats of a block: coordinate a of corner v of its triangles is row kCornerRows + 3·v +
// a. Of the planes there are unit normal x y z and the offset n·p of their points p; all 0 for a triangle
// without area. Then CORNER_ROUNDING·(|x| + |y| + |z|) of the corner for which that is largest: what is
// nearer to the plane may be on either side of it.
enum { kCornerRows = 0, kPlaneRows = 9, kRoundingRow = 13, kBlockRows = 14 };
#define CORNER_ROUNDING 0x1p-21f

// Nodes on any way from that tree's root, at most. A walk that takes a reference from its stack and puts up
// to kTreeWidth there needs kMaxTreeDepth·(kTreeWidth − 1) + 1 places.
enum { kMaxTreeDepth = 40 };

// Tiles that a work-item of beam_shadows.cl takes, one after another.
enum { kBeamRun = 8 };

// Tiles side by side that a work-item of clustered_light.cl takes, one after another.
enum { kClusterRun = 8 };

// A light whose rays the tree's triangles may block, in the tree's space.
typedef struct {
  float4 place;  // xyz of a light with w = 1; with w = 0 the unit direction towards a light at infinity
  float reach;   // its range; +∞: everywhere
  uint casts;    // 1: it casts shadows
  float size;   // what its samples lie in: the radius of a sphere, or with w = 0 how far unit vectors towards
                // them are off; 0: it has none
  uint number;  // its index in the scene
} BeamLight;
SHARED_SIZE(BeamLight, 32);

// What a texture says where a ray meets a triangle with holes (hole_masks.clh): that it must be looked up,
// that the surface is there, or that it isn't.
enum { kMixed = 0, kSolid = 1, kHole = 2 };

enum { kWrapRepeat = 0, kWrapMirrored = 1, kWrapClamped = 2 };

// Where the corners of a triangle with holes lie on its material's mask, in texels, and what the mask means.
typedef struct {
  float a_x, a_y;       // corner a
  float ab_x, ab_y;     // from there to b
  float ac_x, ac_y;     // and to c
  float extent;         // the largest magnitude of these four, or 1
  float slack;          // how far rounding moves a place
  float solid_from;     // the surface is there from this value on
  float hole_to;        // and isn't up to this one
  uint first_texel;     // of the mask
  uint width, height;   // of the mask; 0: there is none
  uint wrap_u, wrap_v;  // kWrapRepeat …
  uint pad;
} HoleTriangle;
SHARED_SIZE(HoleTriangle, 64);

// Pixels beyond each end of a row of a screen's planes, which hold the row's last one. At least the largest
// radius of a screen, and as many as align rows to lanes.
enum { kScreenPad = 16 };

// The part of a picture that a screen is drawn on. Pixel (x, y) of the part lies in a plane at y · row_stride
// + kScreenPad + x.
typedef struct {
  float4 eye;            // in the world, metres; w unused
  float4 to_eye;         // the direction to it from a place p from the eye on is xyz + w · p
  float pixel_base;      // metres that a pixel is wide: pixel_base + pixel_slope · depth
  float pixel_slope;     //
  uint plane_stride;     // floats of a plane
  int row_stride;        // floats of a row
  int columns, rows;     // of the part
  int first_x, first_y;  // its top left corner in the whole picture
  int width, height;     // of the whole picture
  int inner_left, inner_top, inner_right, inner_bottom;  // of the part: its pixels without the margin
  int pad0, pad1;
} ScreenFrame;
SHARED_SIZE(ScreenFrame, 96);

enum { kPointLight = 0, kDirectionalLight = 1, kSpotLight = 2 };

// Values of ShadeLight.shadow that aren't a map's index: the light casts no shadow, or beam_shadows.cl
// decides its shadows.
#define kNoShadow 0xffffffffu
#define kExactShadow 0xfffffffeu

// Floats of a luminaire, and of an axis of its profile before the lines (profile.clh).
enum { kLuminaireFloats = 12, kAxisHeader = 4 };

// How many lights' contributions to a pixel are added one by one at most, see long_sum.clh.
enum { kSumBlock = 128 };

// A light as kernels see it. View space, metres, linear colours with the intensity multiplied in.
typedef struct {
  float4 position;  // xyz place; w: 1 / range², 0 where the light reaches everywhere. Directional: xyz unit,
                    // towards the light
  float4 direction;    // xyz unit, the way a spot shines; w: cosine of its cutoff
  float4 diffuse;      // rgb; w: spot exponent
  float4 specular;     // rgb; w: scale of the cone ramp, 1 / (cos inner − cos cutoff)
  float4 ambient;      // rgb; w: the number of its luminaire + 1 (profile.clh); 0: it has none
  float4 attenuation;  // constant, linear (1/m), quadratic (1/m²); w: Light::cell
  uint kind;           // kPointLight …
  uint khr_window;     // 1: the range window is 1 − (d/r)⁴; 0: its square
  uint cone;           // 1: spot falls off as a cone ramp; 0: as cos^exponent
  uint shadow;         // index of the light's shadow map, kNoShadow or kExactShadow
} ShadeLight;
SHARED_SIZE(ShadeLight, 112);

// Lights that clusters may stand for: point lights without range whose attenuation is quadratic·d² alone
// (light_clusters.hpp). They lie in the leaves of a balanced binary tree whose inner nodes are clusters.
//
// A cluster is a column of a row of kClusterSlots: the two children of a node, their four and their eight
// children come in this order, from slots 0, 2 and 6 on. So one vector tests three levels. Row 0 is the
// root's, and has CLUSTER_TOP_LEVELS levels; all others, of which a walk meets most at the tree's bottom,
// have three. The rows of a level follow each other, after those of the levels above: the nodes of a row's
// last level have their own rows in the same order, or are leaves.
enum { kClusterSlots = 16, kRowClusters = 14, kLeafLights = 8 };

// Levels in row 0 of a tree that has so many, 1 or more, below its root.
#define CLUSTER_TOP_LEVELS(levels) (((levels) + 2) % 3 + 1)

// Fields of a cluster, kClusterSlots floats each; view space, metres. The lights are at δ from the centre,
// and q is a channel of a light's diffuse colour over its quadratic attenuation. Bounds hold for every
// channel.
enum {
  kClusterCentre = 0,    // 3: xyz
  kClusterExtent = 3,    // 3: |xyz| of any δ, at most
  kClusterRadius = 6,    // |δ| of any light, at most
  kClusterAbsolute = 7,  // 4: bounds of Σ q·|δ|ʲ, j = 0 … 3
  kClusterHarmonic = 11,  // 4: bounds of |Σ q·Yⱼ(δ)|, j = 1 … 4: Y₁ to Y₄ are the solid harmonics of a
                          // degree, |Yⱼ(δ)| = |δ|ʲ
  // Bounds for a channel's lights, each light's share its q; E is the mean over them, n any direction.
  kClusterDeviation = 15,  // √E(n·δ)²
  kClusterPower = 16,  // 4: 6|Eδ|, E(24(n·δ)² − 3|δ|²), 32|E Y₃(δ)| + 24|E δ|δ|²|, √E|δ|⁴
  kClusterMoments = 20,  // of each channel
};

// Moments of a channel: Σ q, Σ q·δ, Σ q·δδ (xx xy xz yy yz zz).
enum {
  kMoment0 = 0,
  kMoment1 = 1,
  kMoment2 = 4,
  kMoments = 10,
  kClusterFields = kClusterMoments + 3 * kMoments
};

// Fields of a light of the leaves, kClusterSlots floats each. A row of lights is two leaves side by side:
// lights 0 to 7 and 8 to 15. Slots without a light are 0.
enum {
  kLightPlace = 0,    // 3: xyz
  kLightRest = 3,     // 3: what rounding took from it
  kLightFalloff = 6,  // what 1/d² is held below, as attenuation is below 2¹⁰⁰
  kLightColor = 7,    // 3: rgb over quadratic attenuation
  kLightMost = 10,    // the largest of them
  kLightFields
};

// Where a light's shadow map is looked up. (u, v) are tangents from the light, right and up of the face's
// axis, or for a parallel map metres; depths are reversed and grow towards the light, 0 where nothing was
// drawn.
// - Cube: rows x, y, z give the vector from the light to the view-space position p, in world axes; the faces
//   are those of +x −x +y −y +z −z.
// - Perspective: rows x, y, z give the same right, up and ahead of the light; one face.
// - Parallel: rows x, y give metres right and up, row z the depth; the faces are cascades, the finest first.
typedef struct {
  float4 to_map_x;
  float4 to_map_y;
  float4 to_map_z;
  float depth_scale;   // depth = depth_scale / w + depth_offset, w metres ahead of the light
  float depth_offset;  // parallel: depth a metre, and depth_scale its square
  uint kind;           // kParallelMap …
  uint first_face;     // index of its first ShadowFace
  uint face_count;
  float penumbra_scale;  // by the light's size: a blocker nearer by a depth of d has a penumbra of
                         // penumbra_scale·d in u and v
  float filter_radius;   // texels around a lookup that it may read
  uint pad;
} ShadowMap;
SHARED_SIZE(ShadowMap, 80);

enum { kParallelMap = 0, kPerspectiveMap = 1, kCubeMap = 2 };

// One square picture from a light. (u, v) lies at texel (middle_x + scale·u, middle_y − scale·v), counted
// from its top left corner; a texel's centre is at .5. Memory holds a rectangle of the picture, row by row.
// Of that rectangle only those bins of kShadowBin × kShadowBin texels are drawn that a lookup may read.
typedef struct {
  float scale;  // texels per unit of u and v
  float middle_x;
  float middle_y;
  float low, high;  // texels: lookups from low to high, in x and y, find all the texels they need
  uint first;       // where in the shadow buffer texel (0, 0) would be, modulo 2³²
  uint width;       // texels in a row of the rectangle; 0: nothing was drawn
  uint first_bin;   // of its bins among those of all faces
  uint bins;        // a side
  uint pad0, pad1, pad2;
} ShadowFace;
SHARED_SIZE(ShadowFace, 48);

enum { kShadowBin = 64 };  // texels a side

// What a texel's centre sees.
typedef struct {
  float depth;
  uint slopes;  // the surface's steps of depth a texel: right and down, each the upper 16 bits of a float
} ShadowTexel;
SHARED_SIZE(ShadowTexel, 8);

// Words of beam_shadows.cl's result for an entry of a light list: a bit for each pixel of the tile.
enum { kPairWords = kTilePixels / 32 };

// Of pairs whose share of a light the host decides, in place of the share.
#define OPEN_SHARE (-1.0f)

// How far a point may lie off its surface, as a share of its distance from the eye. A float position is
// rounded in view space, and again relative to the eye, by 2⁻²⁴ each. Thirty-two times that leaves room for
// G-buffers of other programs, which have rounded in world space, and for turning it to the axes of the tree
// over the triangles.
#define POINT_ERROR 0x1p-18f

// find_needed.cl's result for a bin that no lookup reads. As a float's bits it would be NaN, so no depth has
// it.
#define kNotNeeded 0xffffffffu

// kPhongModel …
#define MODEL_NUMBER(name, typed, shown, meaning, diffuse, specular) k##name##Model,
enum { EACH_MODEL(MODEL_NUMBER) kModelCount };
#undef MODEL_NUMBER

enum { kNoFog = 0, kFogLinear = 1, kFogExp = 2, kFogExp2 = 3 };

// What holds for a whole picture.
typedef struct {
  float4 ambient;      // rgb, global
  float4 background;   // rgb
  float4 fog_color;    // rgb
  float4 fog_density;  // rgb, 1/m
  float4 eye;          // homogeneous, view space: (0,0,0,1), or (0,0,1,0) for a parallel view
  float fog_end;       // metres
  float fog_scale;     // 1 / (end − start), 1/m
  uint fog_mode;       // kNoFog …
  uint model;          // kPhongModel …
  uint light_count;
  uint plane_stride;  // floats from a plane to the next of its group
  uint fog_radial;    // 1: fog by distance from the eye, 0: by depth along the view axis
  uint texel_count;   // of the shadow maps, at least 1
} ShadeFrame;
SHARED_SIZE(ShadeFrame, 112);

// What follows are the kernels' arguments that aren't buffers.

// Of find_lights() in cull.cl.
typedef struct {
  uint plane_stride;  // floats from a plane of the G-buffer to the next
  uint tree_stride;   // floats from a plane of the tree over the lights to the next
  uint light_count;
  uint group_log2;  // 4, 6 or 8, for 1, 4 or 16 squares that share their lights
  uint tests;       // kByRange …
  uint fill;        // 0: count and keep; 1: write the lists
} CullFrame;
SHARED_SIZE(CullFrame, 24);

// Of beam_shadows.cl.
typedef struct {
  float4 to_tree_x, to_tree_y, to_tree_z;  // xyz: the rows of the rotation from view space to the tree's axes
  float4 tree_most;                        // xyz: the largest |x|, |y|, |z| in the tree
  float tree_scale;                        // the tree's units a metre, a power of two
  int tree_root;                           // TriangleTree::root
  uint tiles;                              // of the G-buffer
  uint plane_stride;                       // floats from a plane of the G-buffer to the next
  uint light_count;
  uint pad0, pad1, pad2;
} BeamFrame;
SHARED_SIZE(BeamFrame, 96);

// Groups of a G-buffer's planes, as bits.
enum {
  kNormalGroup = 1,
  kDiffuseGroup = 2,
  kSpecularGroup = 4,
  kAmbientGroup = 8,
  kEmissionGroup = 16,
  kLiftGroup = 32,
  kTangentGroup = 64,
  kUvGroup = 128,
  kObjectGroup = 256,
  kMaterialGroup = 512
};

// Of surface.cl.
typedef struct {
  float4 to_world_x, to_world_y, to_world_z;  // xyz: the rows of the rotation from view space to the world's
                                              // axes; w: the eye, metres
  float4 eye;                                 // ShadeFrame::eye
  uint plane_stride;                          // floats from a plane of the G-buffer to the next
  uint given, changed;                        // groups that there are, and that are written: kNormalGroup …
  uint pad;
} SurfaceFrame;
SHARED_SIZE(SurfaceFrame, 80);

// Pairs of a tile's pixels and the lights of its list.
typedef struct {
  uint unsure;               // rays decide
  uint soft_unsure;          // of these, with lights of a size
  uint soft_lit, soft_dark;  // with lights of a size, decided without rays: all is lit, or dark
} TilePairs;
SHARED_SIZE(TilePairs, 16);

// Of shade_tiles.cl. A block is what a work-item takes: kBlockTiles together or fewer.
typedef struct {
  ShadeFrame shade;
  uint tree_stride;                // floats from a plane of the tree over the lights to the next
  uint tiles_x, tiles_y;           // of the G-buffer
  uint block_width, block_height;  // tiles
  uint run_stride;                 // see shade_tiles()
  uint pad0, pad1;
} ShadeTilesFrame;
SHARED_SIZE(ShadeTilesFrame, 144);

// Of clustered_light.cl.
typedef struct {
  ShadeFrame shade;
  uint light_count;   // of the tree of clusters
  uint levels;        // of that tree
  float light_error;  // E > 0: a channel's bound shall be E·max(least_value, its light) at most
  float least_value;
  uint tiles_x;  // of the G-buffer
  uint pad[3];
} ClusterFrame;
SHARED_SIZE(ClusterFrame, 144);

#undef SHARED_SIZE
#ifdef __cplusplus
}  // namespace luciole
#endif
#endif
