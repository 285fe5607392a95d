#include "shade/surface.hpp"

#include <utility>
#include <vector>

#include "cl/launch.hpp"
#include "kernels/shared.h"
#include "shaders/shader_text.hpp"

namespace luciole {
namespace {

/// The members of Surface that come from planes, and the planes' groups.
constexpr std::pair<const char*, unsigned> kMembers[] = {
    {"normal", kNormalGroup},     {"diffuse", kDiffuseGroup},   {"specular", kSpecularGroup},
    {"exponent", kSpecularGroup}, {"ambient", kAmbientGroup},   {"emission", kEmissionGroup},
    {"tangent", kTangentGroup},   {"bitangent", kTangentGroup}, {"uv", kUvGroup},
    {"object", kObjectGroup},     {"material", kMaterialGroup}};
/// The groups that functions can change.
constexpr unsigned kChangeable =
    kNormalGroup | kDiffuseGroup | kSpecularGroup | kAmbientGroup | kEmissionGroup;

float4 rowOf(const glm::dmat4& camera_to_world, int row) {
  return {float(camera_to_world[0][row]), float(camera_to_world[1][row]), float(camera_to_world[2][row]),
          float(camera_to_world[3][row])};
}

unsigned groupsOf(const GBuffer& gbuffer) {
  const auto bit = [](const auto& plane, unsigned group) { return plane.empty() ? 0u : group; };
  return kNormalGroup | kDiffuseGroup | bit(gbuffer.specular, kSpecularGroup) |
         bit(gbuffer.ambient, kAmbientGroup) | bit(gbuffer.emission, kEmissionGroup) |
         bit(gbuffer.lift, kLiftGroup) | bit(gbuffer.tangent, kTangentGroup) | bit(gbuffer.uv, kUvGroup) |
         bit(gbuffer.object, kObjectGroup) | bit(gbuffer.material, kMaterialGroup);
}

/// A group of a G-buffer, and what takes its place.
struct NewGroup {
  Plane& group;
  Plane changed;
  Buffer<float> buffer;

  /// is_changed: else nothing takes its place.
  NewGroup(OpenedDevice& device, Plane& old, bool is_changed)
      : group(old), changed(is_changed ? old.size() : 0), buffer(borrowedForOutput(device, changed)) {}

  void take(OpenedDevice& device) {
    if (changed.empty()) return;
    download(device, buffer, changed);
    group = std::move(changed);
  }
};

}  // namespace

SurfaceProgram surfaceProgram(std::span<const Shader> surfaces) {
  SurfaceProgram program;
  for (const Shader& shader : surfaces) {
    const ShaderFacts facts = shaderFacts(shader, ShaderKind::kSurface);
    for (const auto& [member, group] : kMembers) {
      if (facts.named.contains(member)) program.read |= group;
      if (facts.changed.contains(member)) program.changed |= group & kChangeable;
    }
  }
  program.user_text = shaderProgram(surfaces, ShaderKind::kSurface);
  return program;
}

void addGroups(const SurfaceProgram& program, PlaneSet& planes) {
  const auto add = [&](unsigned group, bool& is_wanted) { is_wanted |= (program.read & group) != 0; };
  add(kSpecularGroup, planes.specular);
  add(kAmbientGroup, planes.ambient);
  add(kEmissionGroup, planes.emission);
  add(kTangentGroup, planes.tangent);
  add(kUvGroup, planes.uv);
  add(kObjectGroup, planes.object);
  add(kMaterialGroup, planes.material);
}

std::uint64_t surface(OpenedDevice& device, const SurfaceProgram& program, GBuffer& gbuffer) {
  Kernel kernel = makeKernel(device, "shade/surface.cl", "surface", {}, program.user_text);
  const glm::dmat4& to_world = gbuffer.camera.camera_to_world;
  const unsigned given = groupsOf(gbuffer), changed = program.changed & given;
  const SurfaceFrame frame{.to_world_x = rowOf(to_world, 0),
                           .to_world_y = rowOf(to_world, 1),
                           .to_world_z = rowOf(to_world, 2),
                           .eye = gbuffer.camera.orthographic ? float4{0, 0, 1, 0} : float4{0, 0, 0, 1},
                           .plane_stride = uint(gbuffer.pixels()),
                           .given = given,
                           .changed = changed,
                           .pad = 0};
  const bool is_turned = (changed & kNormalGroup) != 0;
  NewGroup normal(device, gbuffer.normal, is_turned), lift(device, gbuffer.lift, is_turned),
      diffuse(device, gbuffer.diffuse, changed & kDiffuseGroup),
      specular(device, gbuffer.specular, changed & kSpecularGroup),
      ambient(device, gbuffer.ambient, changed & kAmbientGroup),
      emission(device, gbuffer.emission, changed & kEmissionGroup);
  const Buffer<uint> faulty_pixels = makeBuffer<uint>(device, 1);
  fill(device, faulty_pixels, 0);
  launch(device, kernel,
         {{"frame", frame},
          {"position", borrowed(device, gbuffer.position)},
          {"normal", borrowed(device, gbuffer.normal)},
          {"diffuse", borrowed(device, gbuffer.diffuse)},
          {"specular", borrowed(device, gbuffer.specular)},
          {"ambient", borrowed(device, gbuffer.ambient)},
          {"emission", borrowed(device, gbuffer.emission)},
          {"lift", borrowed(device, gbuffer.lift)},
          {"tangent", borrowed(device, gbuffer.tangent)},
          {"uv", borrowed(device, gbuffer.uv)},
          {"object", borrowed(device, gbuffer.object)},
          {"material", borrowed(device, gbuffer.material)},
          {"new_normal", normal.buffer},
          {"new_diffuse", diffuse.buffer},
          {"new_specular", specular.buffer},
          {"new_ambient", ambient.buffer},
          {"new_emission", emission.buffer},
          {"new_lift", lift.buffer},
          {"faulty_pixels", faulty_pixels}},
         {.items = gbuffer.pixels() / std::size_t(device.description.lanes)});
  for (NewGroup* group : {&normal, &lift, &diffuse, &specular, &ambient, &emission}) group->take(device);
  std::vector<uint> faulty(1);
  download(device, faulty_pixels, faulty);
  return faulty[0];
}

}  // namespace luciole
