#include <gtest/gtest.h>

#include <bit>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <vector>

#include "cl/kernel_source.hpp"
#include "cl/launch.hpp"
#include "kernels/shared.h"

namespace luciole {
namespace {

/// Runs a kernel of struct_layout.cl, whose argument `out` takes the `count` numbers that it reports.
std::vector<uint> report(const char* kernel_name, std::size_t count,
                         std::vector<KernelArgument> arguments = {}) {
  std::ifstream file(LUCIOLE_SOURCE_DIR "/tests/cl/struct_layout.cl");
  std::stringstream text;
  text << file.rdbuf();
  OpenedDevice device;
  openDevice("", device);
  Kernel kernel =
      makeKernelFromSource(device, expandKernelSource("struct_layout.cl", text.str()), kernel_name, "");
  const Buffer<uint> out = makeBuffer<uint>(device, count);
  arguments.push_back({"out", out});
  launch(device, kernel, arguments, {.items = 1});
  std::vector<uint> reported(count);
  download(device, out, reported);
  return reported;
}

void expectLayout(const char* kernel, const std::vector<std::size_t>& host) {
  const std::vector<uint> device = report(kernel, host.size());
  EXPECT_EQ(std::vector<std::size_t>(device.begin(), device.end()), host);
}

TEST(StructLayout, ShadeLight) {
  expectLayout("report_shade_light",
               {sizeof(ShadeLight), offsetof(ShadeLight, position), offsetof(ShadeLight, direction),
                offsetof(ShadeLight, diffuse), offsetof(ShadeLight, specular), offsetof(ShadeLight, ambient),
                offsetof(ShadeLight, attenuation), offsetof(ShadeLight, kind),
                offsetof(ShadeLight, khr_window), offsetof(ShadeLight, cone), offsetof(ShadeLight, shadow)});
}

TEST(StructLayout, ListEntry) {
  expectLayout("report_list_entry",
               {sizeof(ListEntry), offsetof(ListEntry, light), offsetof(ListEntry, squares)});
}

TEST(StructLayout, ShadowMap) {
  expectLayout(
      "report_shadow_map",
      {sizeof(ShadowMap), offsetof(ShadowMap, to_map_x), offsetof(ShadowMap, to_map_y),
       offsetof(ShadowMap, to_map_z), offsetof(ShadowMap, depth_scale), offsetof(ShadowMap, depth_offset),
       offsetof(ShadowMap, kind), offsetof(ShadowMap, first_face), offsetof(ShadowMap, face_count),
       offsetof(ShadowMap, penumbra_scale), offsetof(ShadowMap, filter_radius), offsetof(ShadowMap, pad)});
}

TEST(StructLayout, ShadowFace) {
  expectLayout("report_shadow_face",
               {sizeof(ShadowFace), offsetof(ShadowFace, scale), offsetof(ShadowFace, middle_x),
                offsetof(ShadowFace, middle_y), offsetof(ShadowFace, low), offsetof(ShadowFace, high),
                offsetof(ShadowFace, first), offsetof(ShadowFace, width), offsetof(ShadowFace, first_bin),
                offsetof(ShadowFace, bins), offsetof(ShadowFace, pad0), offsetof(ShadowFace, pad1),
                offsetof(ShadowFace, pad2)});
}

TEST(StructLayout, ShadowTexel) {
  expectLayout("report_shadow_texel",
               {sizeof(ShadowTexel), offsetof(ShadowTexel, depth), offsetof(ShadowTexel, slopes)});
}

TEST(StructLayout, BeamLight) {
  expectLayout("report_beam_light",
               {sizeof(BeamLight), offsetof(BeamLight, place), offsetof(BeamLight, reach),
                offsetof(BeamLight, casts), offsetof(BeamLight, size), offsetof(BeamLight, number)});
}

TEST(StructLayout, HoleTriangle) {
  expectLayout(
      "report_hole_triangle",
      {sizeof(HoleTriangle), offsetof(HoleTriangle, a_x), offsetof(HoleTriangle, a_y),
       offsetof(HoleTriangle, ab_x), offsetof(HoleTriangle, ab_y), offsetof(HoleTriangle, ac_x),
       offsetof(HoleTriangle, ac_y), offsetof(HoleTriangle, extent), offsetof(HoleTriangle, slack),
       offsetof(HoleTriangle, solid_from), offsetof(HoleTriangle, hole_to),
       offsetof(HoleTriangle, first_texel), offsetof(HoleTriangle, width), offsetof(HoleTriangle, height),
       offsetof(HoleTriangle, wrap_u), offsetof(HoleTriangle, wrap_v), offsetof(HoleTriangle, pad)});
}

TEST(StructLayout, ShadeFrame) {
  expectLayout(
      "report_shade_frame",
      {sizeof(ShadeFrame), offsetof(ShadeFrame, ambient), offsetof(ShadeFrame, background),
       offsetof(ShadeFrame, fog_color), offsetof(ShadeFrame, fog_density), offsetof(ShadeFrame, eye),
       offsetof(ShadeFrame, fog_end), offsetof(ShadeFrame, fog_scale), offsetof(ShadeFrame, fog_mode),
       offsetof(ShadeFrame, model), offsetof(ShadeFrame, light_count), offsetof(ShadeFrame, plane_stride),
       offsetof(ShadeFrame, fog_radial), offsetof(ShadeFrame, texel_count)});
}

TEST(StructLayout, SurfaceFrame) {
  expectLayout(
      "report_surface_frame",
      {sizeof(SurfaceFrame), offsetof(SurfaceFrame, to_world_x), offsetof(SurfaceFrame, to_world_y),
       offsetof(SurfaceFrame, to_world_z), offsetof(SurfaceFrame, eye), offsetof(SurfaceFrame, plane_stride),
       offsetof(SurfaceFrame, given), offsetof(SurfaceFrame, changed), offsetof(SurfaceFrame, pad)});
}

TEST(StructLayout, CullFrame) {
  expectLayout("report_cull_frame",
               {sizeof(CullFrame), offsetof(CullFrame, plane_stride), offsetof(CullFrame, tree_stride),
                offsetof(CullFrame, light_count), offsetof(CullFrame, group_log2), offsetof(CullFrame, tests),
                offsetof(CullFrame, fill)});
}

TEST(StructLayout, TilePairs) {
  expectLayout("report_tile_pairs",
               {sizeof(TilePairs), offsetof(TilePairs, unsure), offsetof(TilePairs, soft_unsure),
                offsetof(TilePairs, soft_lit), offsetof(TilePairs, soft_dark)});
}

TEST(StructLayout, BeamFrame) {
  expectLayout("report_beam_frame",
               {sizeof(BeamFrame), offsetof(BeamFrame, to_tree_x), offsetof(BeamFrame, to_tree_y),
                offsetof(BeamFrame, to_tree_z), offsetof(BeamFrame, tree_most),
                offsetof(BeamFrame, tree_scale), offsetof(BeamFrame, tree_root), offsetof(BeamFrame, tiles),
                offsetof(BeamFrame, plane_stride), offsetof(BeamFrame, light_count),
                offsetof(BeamFrame, pad0), offsetof(BeamFrame, pad1), offsetof(BeamFrame, pad2)});
}

TEST(StructLayout, ShadeTilesFrame) {
  expectLayout("report_shade_tiles_frame",
               {sizeof(ShadeTilesFrame), offsetof(ShadeTilesFrame, shade),
                offsetof(ShadeTilesFrame, tree_stride), offsetof(ShadeTilesFrame, tiles_x),
                offsetof(ShadeTilesFrame, tiles_y), offsetof(ShadeTilesFrame, block_width),
                offsetof(ShadeTilesFrame, block_height), offsetof(ShadeTilesFrame, run_stride),
                offsetof(ShadeTilesFrame, pad0), offsetof(ShadeTilesFrame, pad1)});
}

TEST(StructLayout, ScreenFrame) {
  expectLayout(
      "report_screen_frame",
      {sizeof(ScreenFrame), offsetof(ScreenFrame, eye), offsetof(ScreenFrame, to_eye),
       offsetof(ScreenFrame, pixel_base), offsetof(ScreenFrame, pixel_slope),
       offsetof(ScreenFrame, plane_stride), offsetof(ScreenFrame, row_stride), offsetof(ScreenFrame, columns),
       offsetof(ScreenFrame, rows), offsetof(ScreenFrame, first_x), offsetof(ScreenFrame, first_y),
       offsetof(ScreenFrame, width), offsetof(ScreenFrame, height), offsetof(ScreenFrame, inner_left),
       offsetof(ScreenFrame, inner_top), offsetof(ScreenFrame, inner_right),
       offsetof(ScreenFrame, inner_bottom), offsetof(ScreenFrame, pad0), offsetof(ScreenFrame, pad1)});
}

TEST(StructLayout, ClusterFrame) {
  expectLayout(
      "report_cluster_frame",
      {sizeof(ClusterFrame), offsetof(ClusterFrame, shade), offsetof(ClusterFrame, light_count),
       offsetof(ClusterFrame, levels), offsetof(ClusterFrame, light_error), offsetof(ClusterFrame, tiles_x)});
}

TEST(StructLayout, FrameArrivesByValue) {
  ShadeFrame frame{};
  frame.ambient.x = 1.5f;
  frame.eye.w = -2.25f;
  frame.fog_end = 7;
  frame.fog_mode = 42;
  frame.texel_count = 43;
  EXPECT_EQ(report("report_frame_argument", 5, {{"frame", frame}}),
            (std::vector<uint>{std::bit_cast<uint>(1.5f), std::bit_cast<uint>(-2.25f),
                               std::bit_cast<uint>(7.0f), 42, 43}));
}

}  // namespace
}  // namespace luciole
