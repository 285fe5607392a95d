#pragma once

#include "lighting/kept_shadows.hpp"
#include "luciole/array_memory.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/image.hpp"
#include "raster/rasterize.hpp"

namespace luciole {

/// The planes of a part of a picture as screens take them (ScreenFrame); those that they don't name may be
/// empty.
struct ScreenMemory {
  RawArray<float> before, after;  ///< a screen's colours r g b
  RawArray<float> from_eye, depth, normal;
  RawArray<int> object, material;
};

/// Memory of the last band, to be reused by the next one: the system takes as long to clear fresh memory as
/// its pixels take to be shaded.
struct RecycledMemory {
  GBuffer gbuffer;
  Plane color;
  Image picture;
  ScreenMemory screens = {};
  KeptGeometry geometry = {};
};

/// What a picture leaves for the next one of the same scene, whose meshes, textures and holes are the same.
/// It saves time and changes no bit.
struct KeptPicture {
  KeptShadows shadows = {};
  RecycledMemory recycled = {};
  bool scene_is_valid = false;  ///< a picture has checked it, and it stays valid at every pose
};

}  // namespace luciole
