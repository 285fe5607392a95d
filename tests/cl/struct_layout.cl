// Where this device's compiler puts every member of the shared structs: per struct its size, then the
// offsets, in the order of their declaration.
#include "shared.h"

#define OFFSET(member) (uint)((__private char*)&value.member - (__private char*)&value)

__kernel void report_shade_light(__global uint* out) {
  ShadeLight value;
  *out++ = sizeof(ShadeLight);
  *out++ = OFFSET(position);
  *out++ = OFFSET(direction);
  *out++ = OFFSET(diffuse);
  *out++ = OFFSET(specular);
  *out++ = OFFSET(ambient);
  *out++ = OFFSET(attenuation);
  *out++ = OFFSET(kind);
  *out++ = OFFSET(khr_window);
  *out++ = OFFSET(cone);
  *out++ = OFFSET(shadow);
}

__kernel void report_list_entry(__global uint* out) {
  ListEntry value;
  *out++ = sizeof(ListEntry);
  *out++ = OFFSET(light);
  *out++ = OFFSET(squares);
}

__kernel void report_shadow_map(__global uint* out) {
  ShadowMap value;
  *out++ = sizeof(ShadowMap);
  *out++ = OFFSET(to_map_x);
  *out++ = OFFSET(to_map_y);
  *out++ = OFFSET(to_map_z);
  *out++ = OFFSET(depth_scale);
  *out++ = OFFSET(depth_offset);
  *out++ = OFFSET(kind);
  *out++ = OFFSET(first_face);
  *out++ = OFFSET(face_count);
  *out++ = OFFSET(penumbra_scale);
  *out++ = OFFSET(filter_radius);
  *out++ = OFFSET(pad);
}

__kernel void report_shadow_face(__global uint* out) {
  ShadowFace value;
  *out++ = sizeof(ShadowFace);
  *out++ = OFFSET(scale);
  *out++ = OFFSET(middle_x);
  *out++ = OFFSET(middle_y);
  *out++ = OFFSET(low);
  *out++ = OFFSET(high);
  *out++ = OFFSET(first);
  *out++ = OFFSET(width);
  *out++ = OFFSET(first_bin);
  *out++ = OFFSET(bins);
  *out++ = OFFSET(pad0);
  *out++ = OFFSET(pad1);
  *out++ = OFFSET(pad2);
}

__kernel void report_shadow_texel(__global uint* out) {
  ShadowTexel value;
  *out++ = sizeof(ShadowTexel);
  *out++ = OFFSET(depth);
  *out++ = OFFSET(slopes);
}

__kernel void report_beam_light(__global uint* out) {
  BeamLight value;
  *out++ = sizeof(BeamLight);
  *out++ = OFFSET(place);
  *out++ = OFFSET(reach);
  *out++ = OFFSET(casts);
  *out++ = OFFSET(size);
  *out++ = OFFSET(number);
}

__kernel void report_hole_triangle(__global uint* out) {
  HoleTriangle value;
  *out++ = sizeof(HoleTriangle);
  *out++ = OFFSET(a_x);
  *out++ = OFFSET(a_y);
  *out++ = OFFSET(ab_x);
  *out++ = OFFSET(ab_y);
  *out++ = OFFSET(ac_x);
  *out++ = OFFSET(ac_y);
  *out++ = OFFSET(extent);
  *out++ = OFFSET(slack);
  *out++ = OFFSET(solid_from);
  *out++ = OFFSET(hole_to);
  *out++ = OFFSET(first_texel);
  *out++ = OFFSET(width);
  *out++ = OFFSET(height);
  *out++ = OFFSET(wrap_u);
  *out++ = OFFSET(wrap_v);
  *out++ = OFFSET(pad);
}

__kernel void report_shade_frame(__global uint* out) {
  ShadeFrame value;
  *out++ = sizeof(ShadeFrame);
  *out++ = OFFSET(ambient);
  *out++ = OFFSET(background);
  *out++ = OFFSET(fog_color);
  *out++ = OFFSET(fog_density);
  *out++ = OFFSET(eye);
  *out++ = OFFSET(fog_end);
  *out++ = OFFSET(fog_scale);
  *out++ = OFFSET(fog_mode);
  *out++ = OFFSET(model);
  *out++ = OFFSET(light_count);
  *out++ = OFFSET(plane_stride);
  *out++ = OFFSET(fog_radial);
  *out++ = OFFSET(texel_count);
}

__kernel void report_surface_frame(__global uint* out) {
  SurfaceFrame value;
  *out++ = sizeof(SurfaceFrame);
  *out++ = OFFSET(to_world_x);
  *out++ = OFFSET(to_world_y);
  *out++ = OFFSET(to_world_z);
  *out++ = OFFSET(eye);
  *out++ = OFFSET(plane_stride);
  *out++ = OFFSET(given);
  *out++ = OFFSET(changed);
  *out++ = OFFSET(pad);
}

__kernel void report_cull_frame(__global uint* out) {
  CullFrame value;
  *out++ = sizeof(CullFrame);
  *out++ = OFFSET(plane_stride);
  *out++ = OFFSET(tree_stride);
  *out++ = OFFSET(light_count);
  *out++ = OFFSET(group_log2);
  *out++ = OFFSET(tests);
  *out++ = OFFSET(fill);
}

__kernel void report_tile_pairs(__global uint* out) {
  TilePairs value;
  *out++ = sizeof(TilePairs);
  *out++ = OFFSET(unsure);
  *out++ = OFFSET(soft_unsure);
  *out++ = OFFSET(soft_lit);
  *out++ = OFFSET(soft_dark);
}

__kernel void report_beam_frame(__global uint* out) {
  BeamFrame value;
  *out++ = sizeof(BeamFrame);
  *out++ = OFFSET(to_tree_x);
  *out++ = OFFSET(to_tree_y);
  *out++ = OFFSET(to_tree_z);
  *out++ = OFFSET(tree_most);
  *out++ = OFFSET(tree_scale);
  *out++ = OFFSET(tree_root);
  *out++ = OFFSET(tiles);
  *out++ = OFFSET(plane_stride);
  *out++ = OFFSET(light_count);
  *out++ = OFFSET(pad0);
  *out++ = OFFSET(pad1);
  *out++ = OFFSET(pad2);
}

__kernel void report_shade_tiles_frame(__global uint* out) {
  ShadeTilesFrame value;
  *out++ = sizeof(ShadeTilesFrame);
  *out++ = OFFSET(shade);
  *out++ = OFFSET(tree_stride);
  *out++ = OFFSET(tiles_x);
  *out++ = OFFSET(tiles_y);
  *out++ = OFFSET(block_width);
  *out++ = OFFSET(block_height);
  *out++ = OFFSET(run_stride);
  *out++ = OFFSET(pad0);
  *out++ = OFFSET(pad1);
}

__kernel void report_screen_frame(__global uint* out) {
  ScreenFrame value;
  *out++ = sizeof(ScreenFrame);
  *out++ = OFFSET(eye);
  *out++ = OFFSET(to_eye);
  *out++ = OFFSET(pixel_base);
  *out++ = OFFSET(pixel_slope);
  *out++ = OFFSET(plane_stride);
  *out++ = OFFSET(row_stride);
  *out++ = OFFSET(columns);
  *out++ = OFFSET(rows);
  *out++ = OFFSET(first_x);
  *out++ = OFFSET(first_y);
  *out++ = OFFSET(width);
  *out++ = OFFSET(height);
  *out++ = OFFSET(inner_left);
  *out++ = OFFSET(inner_top);
  *out++ = OFFSET(inner_right);
  *out++ = OFFSET(inner_bottom);
  *out++ = OFFSET(pad0);
  *out++ = OFFSET(pad1);
}

__kernel void report_cluster_frame(__global uint* out) {
  ClusterFrame value;
  *out++ = sizeof(ClusterFrame);
  *out++ = OFFSET(shade);
  *out++ = OFFSET(light_count);
  *out++ = OFFSET(levels);
  *out++ = OFFSET(light_error);
  *out++ = OFFSET(tiles_x);
}

// The members of a frame that came by value, as shade() gets it: a wrong layout of arguments shows here only.
__kernel void report_frame_argument(__global uint* out, ShadeFrame frame) {
  out[0] = as_uint(frame.ambient.x);
  out[1] = as_uint(frame.eye.w);
  out[2] = as_uint(frame.fog_end);
  out[3] = frame.fog_mode;
  out[4] = frame.texel_count;
}
