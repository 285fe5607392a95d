#pragma once

#include "luciole/scene.hpp"
#include "render/plan.hpp"

namespace luciole {

/// The work of a picture, estimated.
struct PictureWork {
  double pixels = 0;
  int samples = 1;
  int passes = 1;             ///< of rasterization over the samples: one for all if they share points
  int bands = 1;              ///< in which they are rasterized, see bandHeight
  double shadings = 1;        ///< points that are shaded for a pixel, if it is covered
  double triangles = 0;       ///< drawn
  double mesh_triangles = 0;  ///< loaded
  double texels = 0;          ///< loaded
  double decoded_texels = 0;  ///< the most that are decoded at the same time, a texture a thread
  double textured = 0;        ///< pixels that show a surface of a scene with textures
  bool frames_scene = false;  ///< a camera or lights are chosen, by rays
  double lights = 0;
  double list_entries = 0;   ///< of all tiles' light lists
  double tree_levels = 0;    ///< of the tree over the lights that every tile walks; 0 without lists
  double pairs = 0;          ///< points that are shaded, times the lights that they are shaded with
  double shadow_pairs = 0;   ///< of these, with lights that have shadow maps
  double beam_pairs = 0;     ///< and with those whose shadows are exact
  double sampling = 0;       ///< of lights that are sampled: milliseconds
  int soft_samples = 0;      ///< of a light of a size, if exact shadows have any
  double shadow_texels = 0;  ///< drawn
  double shadow_faces = 0;
  ShadowMethod shadows = ShadowMethod::kOff;
  double scene_bytes = 0;       ///< of meshes and textures
  double pixel_bytes = 0;       ///< of a band's pixels, see bytesPerPixel
  double shadow_map_bytes = 0;  ///< of the texels drawn
};

/// The work of the planned picture. Deterministic. O(vertices), and up to 10⁸ tests of lights, in parallel.
/// Throws as renderBands does.
PictureWork pictureWork(const Scene& scene, const RenderSettings& settings, const PicturePlan& plan);

}  // namespace luciole
