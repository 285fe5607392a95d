#include "lighting/draw_maps.hpp"

#include <utility>
#include <vector>

#include "lighting/stages.hpp"
#include "shadow/maps/draw_shadow_maps.hpp"
#include "shadow/maps/find_needed.hpp"

namespace luciole {

void borrowMaps(OpenedDevice& device, MapScene& maps) {
  maps.maps = borrowed(device, maps.host.maps);
  maps.faces = borrowed(device, maps.host.faces);
  maps.texels = borrowed(device, maps.host.texels);
}

std::vector<std::uint32_t> findTexels(const StageInput& input) {
  const GBufferBuffers& planes = input.points.buffers;
  const LightSet& lights = input.pass.lights;
  const MapScene& maps = input.lighting.maps;
  return findNeeded(input.device, featureDefines(featuresFor(kForLookups, input.compiled)),
                    {.plane_stride = input.points.stride,
                     .position = planes.position,
                     .normal = planes.normal,
                     .lift = planes.lift,
                     .lights = lights.light_buffer,
                     .light_count = lights.frame.light_count,
                     .lists = input.lists,
                     .shadow_maps = maps.maps,
                     .shadow_faces = maps.faces},
                    maps.host.bin_count);
}

void drawMaps(OpenedDevice& device, const Scene& scene, std::span<const std::uint32_t> needed,
              MapScene& maps) {
  giveBack(maps.faces);
  giveBack(maps.texels);
  const std::vector<IndexRange> drawn = drawNeeded(scene, needed, maps.host);
  const std::vector<IndexRange> faces(drawn.empty() ? 0 : 1, {0, maps.host.faces.size()});
  refresh(device, maps.host.faces, faces, maps.faces);
  refresh(device, maps.host.texels, drawn, maps.texels);
}

ShadowMaps takeMaps(MapScene& maps) {
  giveBack(maps.faces);
  giveBack(maps.texels);
  return std::move(maps.host);
}

}  // namespace luciole
