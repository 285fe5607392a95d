#include "shadow/exact/light_rays.hpp"

#include <tbb/parallel_for.h>

#include <atomic>
#include <bit>
#include <optional>

#include "shadow/exact/beam_frame.hpp"

namespace luciole {

void traceLightRays(OpenedDevice& device, const std::string& defines, const RayArguments& arguments,
                    const Buffer<uint>& lit, const Buffer<uint>& unsure) {
  const BeamScene& beams = arguments.beams;
  RayFrame frame{};
  frame.tree_most = beams.largest_coordinates;
  frame.tree_root = beams.tree->root;
  frame.rays = uint(arguments.ray_count);
  frame.start_stride = uint(arguments.start_stride);
  Kernel kernel = makeKernel(device, "exact/light_rays.cl", "light_rays", defines);
  launch(device, kernel,
         withTriangleTree(beams, {{"frame", frame},
                                  {"rays", arguments.rays},
                                  {"starts", arguments.starts},
                                  {"lights", arguments.lights},
                                  {"lit", lit},
                                  {"unsure", unsure}}),
         {.items = (arguments.ray_count + kRayRun - 1) / kRayRun});
}

void rayStarts(OpenedDevice& device, const std::string& defines, const RayStartArguments& arguments,
               const Buffer<float>& starts) {
  Kernel kernel = makeKernel(device, "exact/ray_starts.cl", "ray_starts", defines);
  launch(device, kernel,
         {{"frame", beamFrame(arguments.beams, arguments.plane_stride)},
          {"position", arguments.position},
          {"normal", arguments.normal},
          {"lift", arguments.lift},
          {"starts", starts}},
         {.items = arguments.plane_stride / std::size_t(device.description.lanes)});
}

std::size_t settleRays(const BeamScene& beams, std::span<const LightRay> rays, std::span<const float> starts,
                       std::span<const BeamLight> lights, const HoleTest& is_hole,
                       std::span<const uint> unsure, std::span<uint> lit) {
  const std::size_t stride = starts.size() / 3;
  std::atomic<std::size_t> count = 0;
  tbb::parallel_for(std::size_t(0), unsure.size(), [&](std::size_t word) {
    std::optional<std::size_t> likely;
    for (uint left = unsure[word]; left != 0; left &= left - 1) {
      const int bit = std::countr_zero(left);
      const LightRay& ray = rays[word * 32 + std::size_t(bit)];
      const glm::vec3 start(starts[ray.point], starts[ray.point + stride], starts[ray.point + 2 * stride]);
      if (countUnblocked(*beams.tree, start, {&lights[ray.light].place, 1}, is_hole, likely) > 0)
        lit[word] |= 1u << bit;
      ++count;
    }
  });
  return count;
}

}  // namespace luciole
