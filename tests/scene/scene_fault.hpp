#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "luciole/scene.hpp"

namespace luciole::test {

/// What is wrong with a scene that a loader let through; empty: nothing.
inline std::string sceneFault(const Scene& scene) {
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    if (static_cast<int>(i) == scene.animation.no_mesh) continue;
    const std::size_t count = mesh.positions.size();
    if (mesh.triangles.empty()) return "a mesh without triangles";
    if (mesh.normals.size() != count) return "normals are missing";
    if (!mesh.uvs.empty() && mesh.uvs.size() != count) return "as many uvs as vertices expected";
    if (!mesh.colors.empty() && mesh.colors.size() != count) return "as many colours as vertices expected";
    if (mesh.triangle_materials.size() != mesh.triangles.size()) return "a material a triangle expected";
    for (const glm::uvec3& t : mesh.triangles) {
      if (t.x >= count || t.y >= count || t.z >= count) return "a triangle's vertex is out of range";
    }
    for (const std::uint32_t material : mesh.triangle_materials) {
      if (material >= scene.materials.size()) return "a triangle's material is out of range";
    }
    for (const glm::vec3& p : mesh.positions) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        return "a position is not finite";
    }
    for (const glm::vec3& n : mesh.normals) {
      // A unit vector rounded to float: each component is off by 2^-24 at most, so the length by less than
      // 2^-23.
      if (!(std::abs(glm::length(glm::dvec3(n)) - 1) < 1.0 / (1 << 23))) return "a normal is not unit";
    }
  }
  for (const Material& material : scene.materials) {
    for (const TextureUse& use :
         {material.diffuse_map, material.emission_map, material.normal_map, material.alpha_map}) {
      if (use.texture >= static_cast<int>(scene.textures.size())) return "a texture is out of range";
    }
  }
  for (const Texture& texture : scene.textures) {
    if (texture.levels.empty()) return "a texture was not decoded";
  }
  for (const Object& object : scene.objects) {
    if (object.mesh >= scene.meshes.size()) return "an object's mesh is out of range";
  }
  for (const Deformation& deformation : scene.animation.deformations) {
    if (deformation.mesh >= scene.meshes.size()) return "a deformed mesh is out of range";
    const Mesh& mesh = scene.meshes[deformation.mesh];
    if (mesh.sources.size() != mesh.positions.size()) return "a source a vertex expected";
    for (const std::uint32_t source : mesh.sources)
      if (source >= deformation.rest->positions.size()) return "a vertex's source is out of range";
    for (const Joint& joint : deformation.joints)
      if (joint.node >= static_cast<int>(scene.animation.nodes.size()))
        return "a joint's node is out of range";
  }
  for (const Attachment& attachment : scene.animation.objects) {
    if (attachment.index >= scene.objects.size()) return "an attached object is out of range";
    if (attachment.node >= scene.animation.nodes.size()) return "an attached object's node is out of range";
  }
  return "";
}

}  // namespace luciole::test
