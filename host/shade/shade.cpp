#include "shade/shade.hpp"

#include "cl/launch.hpp"
#include "kernels/shared.h"

namespace luciole {

GBufferBuffers borrowedGBuffer(OpenedDevice& device, const GBuffer& gbuffer,
                               const PackedNormals& surface_normal, const Plane& lift,
                               const ModelPlane& model, const PackedNormals& tangent, bool unlit) {
  // One buffer, also if unlit: two OpenCL buffers in the same host memory are undefined behaviour.
  const Buffer<const float> diffuse = borrowed(device, gbuffer.diffuse);
  return {.position = borrowed(device, gbuffer.position),
          .normal = borrowed(device, gbuffer.normal),
          .diffuse = diffuse,
          .specular = borrowed(device, gbuffer.specular),
          .ambient = unlit ? diffuse : borrowed(device, gbuffer.ambient),
          .emission = borrowed(device, gbuffer.emission),
          .surface_normal = borrowed(device, surface_normal),
          .model = borrowed(device, model),
          .tangent = borrowed(device, tangent),
          .lift = borrowed(device, lift)};
}

void shade(OpenedDevice& device, const ShadeProgram& program, const ShadeArguments& arguments) {
  Kernel kernel = makeKernel(device, "shade/shade.cl", "shade", program.defines, program.user_text);
  const GBufferBuffers& gbuffer = arguments.gbuffer;
  const auto lanes = std::size_t(device.description.lanes);
  const std::size_t pixels_per_item = lanes * ROWS_PER_ITEM(lanes, arguments.lists.tiles > 0);
  // A group is a tile: its work-items share a light list.
  launch(device, kernel,
         {{"frame", arguments.frame},
          {"position", gbuffer.position},
          {"normal", gbuffer.normal},
          {"diffuse", gbuffer.diffuse},
          {"specular", gbuffer.specular},
          {"ambient", gbuffer.ambient},
          {"emission", gbuffer.emission},
          {"surface_normal", gbuffer.surface_normal},
          {"lift", gbuffer.lift},
          {"model", gbuffer.model},
          {"tangent", gbuffer.tangent},
          {"lights", arguments.lights},
          {"luminaires", arguments.luminaires},
          {"list_starts", arguments.lists.starts},
          {"list", arguments.lists.list},
          {"shadow_maps", arguments.shadow_maps},
          {"shadow_faces", arguments.shadow_faces},
          {"shadow_texels", arguments.shadow_texels},
          {"pair_bits", arguments.pair_bits},
          {"ray_bits", arguments.ray_bits},
          {"first_share", arguments.first_share},
          {"shares", arguments.shares},
          {"image", arguments.image},
          {"faulty_pixels", arguments.faulty_pixels}},
         {.items = arguments.frame.plane_stride / pixels_per_item, .group = kTilePixels / pixels_per_item});
  finish(device);
}

}  // namespace luciole
