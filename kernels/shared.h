// What host and device share, compiled by both: constants, and structs that hold only float, int, uint and 4-vectors
// (OpenCL's float3 is 16 bytes, GLM's vec3 is 12). tests/cl/struct_layout_test.cpp compares every offset.
#ifndef LUCIOLE_SHARED_H
#define LUCIOLE_SHARED_H

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
  kTileSize = 16,                        // pixels a side of the squares that a G-buffer is stored in
  kTilePixels = kTileSize * kTileSize,   // in Z order
  kSquaresPerTile = 16,                  // of 4×4 pixels
};

// Rows of pixels that a work-item of shade.cl takes on. Without lists a row meets all lights: it fills its places alone, and one
// row's sums stay in registers.
#define ROWS_PER_ITEM(lanes, lists) ((lanes) == 1 || !(lists) ? 1 : 4)

// The square of a pixel in its tile, by its place in the planes.
#define SQUARE_OF_PIXEL(place) ((place) / (kTilePixels / kSquaresPerTile) % kSquaresPerTile)

// An entry of a tile's light list.
typedef struct {
  uint light;    // its index
  uint squares;  // bit i: the light may light square i
} ListEntry;
SHARED_SIZE(ListEntry, 8);

// Entries that are kept for a tile while lists are counted.
enum { kFoundPerTile = 64 };

// What leaves a light out of a list: that it is out of range, and by choice (bits) that no point lies in a spot's cone, and that
// every point faces away from it, which is right where no light gives ambient light.
enum { kByRange = 0, kByCone = 1, kByFacing = 2 };

// The tree over the lights has so many children a node.
enum { kTreeArity = 16 };

enum { kPointLight = 0, kDirectionalLight = 1, kSpotLight = 2 };

#define kNoShadow 0xffffffffu

// Lights whose contributions to a pixel may be added one by one, see long_sum.clh.
enum { kSumBlock = 128 };

// A light as the shade stage sees it. View space, metres, linear colours with the intensity multiplied in.
typedef struct {
  float4 position;     // xyz place; w: 1 / range², 0 where the light reaches everywhere. Directional: xyz unit, towards the light
  float4 direction;    // xyz unit, the way a spot shines; w: cosine of its cutoff
  float4 diffuse;      // rgb; w: spot exponent
  float4 specular;     // rgb; w: scale of the cone ramp, 1 / (cos inner − cos cutoff)
  float4 ambient;      // rgb; w: unused, 0
  float4 attenuation;  // constant, linear (1/m), quadratic (1/m²); w: unused, 0
  uint kind;           // kPointLight …
  uint khr_window;     // 1: the range window is 1 − (d/r)⁴; 0: its square
  uint cone;           // 1: spot falls off as a cone ramp; 0: as cos^exponent
  uint shadow;         // index of the light's shadow map, or kNoShadow
} ShadeLight;
SHARED_SIZE(ShadeLight, 112);

// Shadow depths are reversed: depth = depth_scale / w + depth_offset grows towards the light, 0 where nothing was drawn.
// w is the homogeneous coordinate of the lookup: 1 for a parallel map, metres in front of the light otherwise.
// A planar map takes a view-space position p to texels by (to_map_x · (p,1), to_map_y · (p,1)) / (to_map_w · (p,1)); its
// parallel kind has its depth in to_map_z · (p,1) instead. A cube's rows x, y, z give the vector from the light to p in
// world axes; the six faces lie one after another in the order +x −x +y −y +z −z.
typedef struct {
  float4 to_map_x;
  float4 to_map_y;
  float4 to_map_z;
  float4 to_map_w;
  float depth_scale;   // metres
  float depth_offset;
  float texel;         // a texel's side in metres at w = 1
  float face_scale;    // cube: texels per unit of tangent, from the middle of a face
  uint offset;         // of the first depth in the shadow buffer, in floats
  uint size;           // texels a side; rows lie one after another
  uint kind;           // kParallelMap …
  uint pad;
} ShadowMap;
SHARED_SIZE(ShadowMap, 96);

enum { kParallelMap = 0, kPerspectiveMap = 1, kCubeMap = 2 };

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
  uint blinn;          // 1: N·H, 0: R·V
  uint light_count;
  uint plane_stride;   // floats from a plane to the next of its group
  uint fog_radial;     // 1: fog by distance from the eye, 0: by depth along the view axis
  uint pad;
} ShadeFrame;
SHARED_SIZE(ShadeFrame, 112);

#undef SHARED_SIZE
#ifdef __cplusplus
}  // namespace luciole
#endif
#endif
