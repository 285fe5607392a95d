// Shading: lights a G-buffer by light lists, or without lists by all lights.
//
//   I = ambient·Ka + emission
//       + Σ lights falloff·spot·profile·( Ia·Ka + visibility·( Id·Kd·max(N·L,0) + Is·Ks·(R·V)ⁿ ) )
//
// seen through fog. Other models than Phong's change the inner brackets (reflect()). The sums over the lights
// leave the material out: it is multiplied once at the end.
//
// In: the planes of a G-buffer, tile by tile (view space, metres, linear colours), and for each tile the list
// of its lights (cull.cl). Out: 3 planes of linear colour, a float for each pixel, and one more with
// OUTPUT_SHADOW. A work-item shades ROWS rows of LANES pixels. The pixels of a row share their lights: those
// that the list has for their 4×4 square. Pairs of a row and a light are taken ABREAST at a time, whatever
// row they belong to. Cost: some 100 instructions for a pair of LANES pixels and a light without a shadow. A
// lookup in a shadow map costs about as much again for each texel that it reads. A light that culling may
// leave out adds exactly zero: the picture does not depend on whether a list holds it.
#include "lanes.clh"
#include "shade/shading.clh"
#include "shared.h"

#define ROWS ROWS_PER_ITEM(LANES, LIGHT_LISTS)
#define EACH_ROW(row) _Pragma("unroll") for (uint row = 0; row < ROWS; ++row)

// Capacity of the queue of pairs. With a single lane each pair is shaded as it comes.
#define QUEUE (LANES == 1 ? 1 : 128)

// Lights ROWS rows. first: their first pixel. All else: see shade().
WORK void shade_rows(ShadeFrame frame, Planes planes, __global const ShadeLight* lights,
                     __global const float* luminaires, __global const uint* list_starts,
                     __global const ListEntry* list, Shadows shadows, uint first, __global float* image) {
  uint tile = first / kTilePixels;
  uint stride = frame.plane_stride;
  uint entry = LIGHT_LISTS ? list_starts[tile] : 0;
  uint end = LIGHT_LISTS ? list_starts[tile + 1] : frame.light_count;
  // With fewer lights than that, one block takes them all.
  bool long_sums = LONG_SUMS && end - entry > kSumBlock;
  // Load the rows, and prefetch the next ones.
  Pixels rows[ROWS];
  uint square[ROWS];  // of each row, as a bit; none for background
  EACH_ROW(row) {
    uint pixel = first + row * LANES;
    start_row(rows + row, &frame, pixel, &planes, LIT, long_sums);
    square[row] = any_lane(rows[row].covered) ? 1u << SQUARE_OF_PIXEL(pixel) : 0;
  }
  if (first + 2 * ROWS * LANES <= stride) prefetch_rows(first + ROWS * LANES, ROWS, stride, &planes);

  uint light_of[QUEUE], row_of[QUEUE], entry_of[QUEUE];
  while (LIT && entry < end) {
    // Fill the queue with pairs of a light and a row that it may light.
    uint pairs = 0;
    for (; entry < end && pairs + ROWS <= QUEUE; ++entry) {
      uint light = LIGHT_LISTS ? list[entry].light : entry;
      uint squares = LIGHT_LISTS ? list[entry].squares : 0xffffffff;
      EACH_ROW(row) {
        light_of[pairs] = light;
        row_of[pairs] = row;
        if (EXACT) entry_of[pairs] = LIGHT_LISTS ? entry : tile * frame.light_count + entry;
        pairs += (squares & square[row]) ? 1 : 0;
      }
    }
    // Light them ABREAST at a time.
    for (uint pair = 0; pair < pairs; pair += ABREAST) {
      Pixels* pixels[ABREAST];
      __global const ShadeLight* light[ABREAST];
      uint met_by[ABREAST];
      EACH_ABREAST(k, ABREAST) {
        uint at = min(pair + k, pairs - 1);
        pixels[k] = rows + (ROWS == 1 ? 0 : row_of[at]);
        light[k] = lights + light_of[at];
        met_by[k] = EXACT ? entry_of[at] : 0;
      }
      add_lights(ABREAST, pixels, light, pairs - pair, met_by, luminaires, &shadows, frame.model, long_sums);
    }
  }

  EACH_ROW(row)
    finish_row(rows + row, &frame, first + row * LANES, &planes, LIT, long_sums, square[row] != 0, image);
}

// Planes have frame.plane_stride elements each. specular: r, g, b and the shininess; surface_normal: as
// packNormal() packs it; lift: metres; model: see load_models(); tangent: see Planes. list_starts, list: see
// cull.cl; luminaires: see profile.clh; without LIGHT_LISTS every pixel meets all frame.light_count lights.
// image: planes r, g, b, and with OUTPUT_SHADOW a fourth: the mean visibility, in [0, 1], of the lights with
// shadows that reach the pixel's front. faulty_pixels: see Planes.
KERNEL void shade(ShadeFrame frame, __global const float* position, __global const float* normal,
                  __global const float* diffuse, __global const float* specular,
                  __global const float* ambient, __global const float* emission,
                  __global const uint* surface_normal, __global const float* lift, __global const uint* model,
                  __global const uint* tangent, __global const ShadeLight* lights,
                  __global const float* luminaires, __global const uint* list_starts,
                  __global const ListEntry* list, __global const ShadowMap* shadow_maps,
                  __global const ShadowFace* shadow_faces, __global const ShadowTexel* shadow_texels,
                  __global const uint* pair_bits, __global const uint* ray_bits,
                  __global const uint* first_share, __global const float* shares, __global float* image,
                  __global uint* faulty_pixels) {
  Planes planes = {position,       normal, diffuse, specular,      ambient, emission,
                   surface_normal, lift,   model,   faulty_pixels, tangent};
  Shadows shadows = {shadow_maps, shadow_faces, shadow_texels, frame.texel_count,
                     pair_bits,   ray_bits,     first_share,   shares};
  shade_rows(frame, planes, lights, luminaires, list_starts, list, shadows, work_item() * (ROWS * LANES),
             image);
}
