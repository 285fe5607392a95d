#include "shadow/exact/beam_frame.hpp"

namespace luciole {
namespace {

float4 rowOf(const glm::mat3& matrix, int row) { return {matrix[0][row], matrix[1][row], matrix[2][row], 0}; }

}  // namespace

BeamFrame beamFrame(const BeamScene& beams, std::size_t plane_stride) {
  BeamFrame frame{};
  frame.to_tree_x = rowOf(beams.view_to_tree, 0);
  frame.to_tree_y = rowOf(beams.view_to_tree, 1);
  frame.to_tree_z = rowOf(beams.view_to_tree, 2);
  frame.tree_most = beams.largest_coordinates;
  frame.tree_scale = beams.tree->scale;
  frame.tree_root = beams.tree->root;
  frame.tiles = uint(plane_stride / kTilePixels);
  frame.plane_stride = uint(plane_stride);
  return frame;
}

std::vector<KernelArgument> withTriangleTree(const BeamScene& beams, std::vector<KernelArgument> others) {
  others.insert(others.end(), {{"nodes", beams.nodes},
                               {"children", beams.children},
                               {"blocks", beams.blocks},
                               {"block_bits", beams.block_bits},
                               {"hole_texels", beams.hole_texels},
                               {"hole_triangles", beams.hole_triangles},
                               {"first_hole_triangle", beams.first_hole_triangle}});
  return others;
}

}  // namespace luciole
