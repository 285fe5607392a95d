#pragma once

#include <concepts>
#include <type_traits>

#include "luciole/scene.hpp"

// Visits a scene field by field. Each function names all members of a struct in a structured binding, so
// adding a member to the struct is a compile error here until it is named.
namespace luciole {

template <class T, class Struct>
concept Is = std::same_as<std::remove_const_t<T>, Struct>;

/// Calls `visit` once, with all members of a struct that a scene is made of.
template <Is<TextureUse> T, class Visit>
void withFields(T& use, Visit&& visit) {
  auto& [texture, wrap_u, wrap_v, nearest_magnified, nearest_minified, mips] = use;
  visit(texture, wrap_u, wrap_v, nearest_magnified, nearest_minified, mips);
}
template <Is<Material> T, class Visit>
void withFields(T& material, Visit&& visit) {
  auto& [name, ambient, diffuse, specular, emission, shininess, diffuse_map, emission_map, normal_map,
         normal_scale, alpha_map, alpha, alpha_cutoff, blended, double_sided, colored_emission, model, facets,
         emits] = material;
  visit(name, ambient, diffuse, specular, emission, shininess, diffuse_map, emission_map, normal_map,
        normal_scale, alpha_map, alpha, alpha_cutoff, blended, double_sided, colored_emission, model, facets,
        emits);
}
template <Is<Facets> T, class Visit>
void withFields(T& surface, Visit&& visit) {
  auto& [f0, alpha] = surface;
  visit(f0, alpha);
}
template <Is<Mesh> T, class Visit>
void withFields(T& mesh, Visit&& visit) {
  auto& [name, positions, normals, uvs, emission_uvs, tangents, normal_uvs, lightmap_uvs, colors, triangles,
         triangle_materials, sources, divided] = mesh;
  visit(name, positions, normals, uvs, emission_uvs, tangents, normal_uvs, lightmap_uvs, colors, triangles,
        triangle_materials, sources, divided);
}
template <Is<Object> T, class Visit>
void withFields(T& object, Visit&& visit) {
  auto& [mesh, object_to_world, material, name, emits] = object;
  visit(mesh, object_to_world, material, name, emits);
}
template <Is<Light> T, class Visit>
void withFields(T& light, Visit&& visit) {
  auto& [kind, over_pi, luminaire, position, direction, ambient, diffuse, specular, attenuation, range,
         window, falloff, cutoff, inner_cone, exponent, shadow, radius, half_angle, group, cell, name] =
      light;
  visit(kind, over_pi, luminaire, position, direction, ambient, diffuse, specular, attenuation, range, window,
        falloff, cutoff, inner_cone, exponent, shadow, radius, half_angle, group, cell, name);
}
template <Is<LightProfile> T, class Visit>
void withFields(T& profile, Visit&& visit) {
  auto& [name, type, polar, azimuth, candela, peak, lumens, lamp_lumens] = profile;
  visit(name, type, polar, azimuth, candela, peak, lumens, lamp_lumens);
}
template <Is<Luminaire> T, class Visit>
void withFields(T& luminaire, Visit&& visit) {
  auto& [profile, up] = luminaire;
  visit(profile, up);
}
template <Is<SkyLevel> T, class Visit>
void withFields(T& level, Visit&& visit) {
  auto& [width, height, texels] = level;
  visit(width, height, texels);
}
template <Is<Sky> T, class Visit>
void withFields(T& sky, Visit&& visit) {
  auto& [name, levels] = sky;
  visit(name, levels);
}
template <Is<SkyCell> T, class Visit>
void withFields(T& cell, Visit&& visit) {
  auto& [direction, light, solid_angle] = cell;
  visit(direction, light, solid_angle);
}
template <Is<LightSource> T, class Visit>
void withFields(T& source, Visit&& visit) {
  auto& [kind, shadow, count, group, radiance, name, sky, rotate, divided, cells, position, direction, up,
         width, height] = source;
  visit(kind, shadow, count, group, radiance, name, sky, rotate, divided, cells, position, direction, up,
        width, height);
}
template <Is<Fog> T, class Visit>
void withFields(T& fog, Visit&& visit) {
  auto& [mode, radial, density, start, end, color] = fog;
  visit(mode, radial, density, start, end, color);
}
template <Is<Camera> T, class Visit>
void withFields(T& camera, Visit&& visit) {
  auto& [name, camera_to_world, orthographic, fov_y, half_height, shift, pixel_aspect, near, far, target,
         up] = camera;
  visit(name, camera_to_world, orthographic, fov_y, half_height, shift, pixel_aspect, near, far, target, up);
}
template <Is<MipLevel> T, class Visit>
void withFields(T& level, Visit&& visit) {
  auto& [width, height, texels] = level;
  visit(width, height, texels);
}
template <Is<Texture> T, class Visit>
void withFields(T& texture, Visit&& visit) {
  auto& [name, levels, alpha_varies, kind, linear] = texture;
  visit(name, levels, alpha_varies, kind, linear);
}
template <Is<CurveKey> T, class Visit>
void withFields(T& key, Visit&& visit) {
  auto& [frame, value, slope_in, slope_out] = key;
  visit(frame, value, slope_in, slope_out);
}
template <Is<Curve> T, class Visit>
void withFields(T& curve, Visit&& visit) {
  auto& [interpolation, keys] = curve;
  visit(interpolation, keys);
}
template <Is<MovingNode> T, class Visit>
void withFields(T& node, Visit&& visit) {
  auto& [parent, before, translate, rotate, quaternion, scale] = node;
  visit(parent, before, translate, rotate, quaternion, scale);
}
template <Is<Attachment> T, class Visit>
void withFields(T& attachment, Visit&& visit) {
  auto& [index, node, after, mesh, hidden_colors] = attachment;
  visit(index, node, after, mesh, hidden_colors);
}
template <Is<CameraMotion> T, class Visit>
void withFields(T& motion, Visit&& visit) {
  auto& [camera, orbits, eye, target, up, fov_y] = motion;
  visit(camera, orbits, eye, target, up, fov_y);
}
template <Is<LightMotion> T, class Visit>
void withFields(T& motion, Visit&& visit) {
  auto& [light, position, direction, target, color, intensity, range, rotate, ambient, diffuse, specular,
         own_intensity] = motion;
  visit(light, position, direction, target, color, intensity, range, rotate, ambient, diffuse, specular,
        own_intensity);
}
template <Is<MorphTarget> T, class Visit>
void withFields(T& target, Visit&& visit) {
  auto& [vertices, positions, normals, tangents] = target;
  visit(vertices, positions, normals, tangents);
}
template <Is<RestShape> T, class Visit>
void withFields(T& rest, Visit&& visit) {
  auto& [positions, normals, targets, first_influence, influence_joints, influence_weights] = rest;
  visit(positions, normals, targets, first_influence, influence_joints, influence_weights);
}
template <Is<Joint> T, class Visit>
void withFields(T& joint, Visit&& visit) {
  auto& [node, after] = joint;
  visit(node, after);
}
template <Is<Deformation> T, class Visit>
void withFields(T& deformation, Visit&& visit) {
  auto& [mesh, rest, tangents, weights, weight_curves, joints, world_to_mesh, pose] = deformation;
  visit(mesh, rest, tangents, weights, weight_curves, joints, world_to_mesh, pose);
}
template <Is<Animation> T, class Visit>
void withFields(T& animation, Visit&& visit) {
  auto& [frame_rate, curves, nodes, objects, attached_cameras, attached_lights, cameras, lights, sources,
         deformations, no_mesh] = animation;
  visit(frame_rate, curves, nodes, objects, attached_cameras, attached_lights, cameras, lights, sources,
        deformations, no_mesh);
}
template <Is<Warning> T, class Visit>
void withFields(T& warning, Visit&& visit) {
  auto& [text, kind, repaired] = warning;
  visit(text, kind, repaired);
}
template <Is<Shader> T, class Visit>
void withFields(T& shader, Visit&& visit) {
  auto& [path, text] = shader;
  visit(path, text);
}
template <Is<Scene> T, class Visit>
void withFields(T& scene, Visit&& visit) {
  auto& [name, warnings, missing_textures, ignored_extensions, variants, animations, textures, materials,
         user_models, meshes, objects, lights, source_lights, sources, luminaires, light_groups, cameras,
         size, background, ambient, fog, says_light, adds_camera, adds_lights, lighting, animation] = scene;
  visit(name, warnings, missing_textures, ignored_extensions, variants, animations, textures, materials,
        user_models, meshes, objects, lights, source_lights, sources, luminaires, light_groups, cameras, size,
        background, ambient, fog, says_light, adds_camera, adds_lights, lighting, animation);
}

}  // namespace luciole
