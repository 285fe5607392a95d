#include "render/shade.hpp"

namespace luciole {
namespace {

/// Work-items of one tile: they share its light list.
std::size_t rowsPerTile(const Device& device) {
  return kTilePixels / static_cast<std::size_t>(device.description.lanes);
}

}  // namespace

GBufferBuffers uploadGBuffer(Device& device, const GBuffer& gbuffer, const PackedNormals& facet,
                            const Plane& lift, bool unlit) {
  // One buffer for both: what two do to the same host memory, OpenCL leaves undefined.
  const cl::Buffer diffuse = inputBuffer(device, gbuffer.diffuse);
  return {inputBuffer(device, gbuffer.position),
          inputBuffer(device, gbuffer.normal),
          diffuse,
          inputBuffer(device, gbuffer.specular),
          unlit ? diffuse : inputBuffer(device, gbuffer.ambient),
          inputBuffer(device, gbuffer.emission),
          inputBuffer(device, facet),
          inputBuffer(device, lift)};
}

void shade(Device& device, const std::string& defines, const ShadeArguments& arguments) {
  Kernel kernel = makeKernel(device, "shade.cl", "shade", defines);
  kernel.setArg(0, arguments.frame);
  kernel.setArg(1, arguments.gbuffer.position);
  kernel.setArg(2, arguments.gbuffer.normal);
  kernel.setArg(3, arguments.gbuffer.diffuse);
  kernel.setArg(4, arguments.gbuffer.specular);
  kernel.setArg(5, arguments.gbuffer.ambient);
  kernel.setArg(6, arguments.gbuffer.emission);
  kernel.setArg(7, arguments.gbuffer.facet);
  kernel.setArg(8, arguments.gbuffer.lift);
  kernel.setArg(9, arguments.lights);
  kernel.setArg(10, arguments.lists.starts);
  kernel.setArg(11, arguments.lists.list);
  kernel.setArg(12, arguments.shadow_maps);
  kernel.setArg(13, arguments.shadow_faces);
  kernel.setArg(14, arguments.shadow_texels);
  kernel.setArg(15, arguments.pair_bits);
  kernel.setArg(16, arguments.image);
  const std::size_t rows = ROWS_PER_ITEM(device.description.lanes, arguments.lists.tiles > 0);
  launch(device, kernel, arguments.frame.plane_stride / device.description.lanes / rows,
         rowsPerTile(device) / rows);
  finish(device);
}

void countInRange(Device& device, const CountInRangeArguments& arguments) {
  Kernel kernel = makeKernel(device, "count_in_range.cl", "count_in_range", "");
  kernel.setArg(0, arguments.position);
  kernel.setArg(1, static_cast<cl_uint>(arguments.plane_stride));
  kernel.setArg(2, arguments.lights);
  kernel.setArg(3, arguments.lists.starts);
  kernel.setArg(4, arguments.lists.list);
  kernel.setArg(5, arguments.counts);
  launch(device, kernel, arguments.plane_stride / device.description.lanes, rowsPerTile(device));
}

}  // namespace luciole
