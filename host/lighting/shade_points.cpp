#include "lighting/stages.hpp"
#include "shade/shade.hpp"

namespace luciole {
namespace {

ShadeProgram programOf(const StageInput& input) {
  return {featureDefines(input.compiled) + input.lighting.math_defines,
          userTextFor(input.compiled, input.lighting.user_text)};
}

}  // namespace

void shadeByLists(const StageInput& input, const ShadeFrame& frame, const PairShadows& pairs,
                  const ShadedBuffers& out) {
  const MapScene& maps = input.lighting.maps;
  shade(input.device, programOf(input),
        {.frame = frame,
         .gbuffer = input.points.buffers,
         .lights = input.pass.lights.light_buffer,
         .luminaires = input.pass.lights.luminaire_buffer,
         .lists = input.lists,
         .shadow_maps = maps.maps,
         .shadow_faces = maps.faces,
         .shadow_texels = maps.texels,
         .pair_bits = pairs.lit,
         .ray_bits = pairs.unsure,
         .first_share = pairs.first_share,
         .shares = pairs.shares,
         .image = out.image,
         .faulty_pixels = out.faulty_pixels});
}

TileCounts shadeByTiles(const StageInput& input, const ShadeFrame& frame, const ShadedBuffers& out) {
  const int tiles_x = input.pass.gbuffer.tiles_x, tiles_y = input.pass.gbuffer.tiles_y;
  const LightSet& lights = input.pass.lights;
  return shadeTiles(input.device, programOf(input),
                    {.frame = frame,
                     .gbuffer = input.points.buffers,
                     .tiles_x = tiles_x,
                     .tiles_y = tiles_y,
                     .block = chooseBlock(tiles_x, tiles_y, input.device.description.compute_units),
                     .lights = lights.light_buffer,
                     .luminaires = lights.luminaire_buffer,
                     .tree = lights.tree_buffer,
                     .tree_stride = lights.tree.stride,
                     .image = out.image,
                     .faulty_pixels = out.faulty_pixels});
}

}  // namespace luciole
