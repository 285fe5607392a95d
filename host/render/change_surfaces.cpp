#include "render/change_surfaces.hpp"

#include "gbuffer/tangent_plane.hpp"
#include "lighting/count_picture.hpp"

namespace luciole {

void changeSurfaces(OpenedDevice& device, const SurfaceProgram& program, GBuffer& points, Stats& stats) {
  if (program.user_text.empty()) return;
  timed(stats, Stage::kWaitForDevice, [&] { awaitDevice(device); });
  const std::uint64_t faulty =
      timed(stats, Stage::kChangeSurfaces, [&] { return surface(device, program, points); });
  if (faulty > 0) addCount(stats, kFaultySurfaces, faulty);
}

void changeSurfaces(ReadyPicture& picture, GBuffer& points) {
  changeSurfaces(picture.device, picture.plan.surface, points, picture.stats);
}

void prepareForSurfaces(const SurfaceProgram& program, GBuffer& gbuffer) {
  const std::size_t pixels = gbuffer.pixels();
  const auto add = [&](unsigned group, std::size_t components, Plane& plane) {
    if (program.changes(group) && plane.empty()) plane.resize(components * pixels);
  };
  add(kSpecularGroup, 4, gbuffer.specular);
  add(kAmbientGroup, 3, gbuffer.ambient);
  add(kEmissionGroup, 3, gbuffer.emission);
  if (program.changes(kNormalGroup) && gbuffer.unbent_normal.empty()) {
    gbuffer.unbent_normal = packedNormals(gbuffer);
    gbuffer.geometric_normal = PackedNormals();
  }
  if ((program.read & kTangentGroup) && gbuffer.tangent.empty()) gbuffer.tangent = tangentsOf(gbuffer);
}

}  // namespace luciole
