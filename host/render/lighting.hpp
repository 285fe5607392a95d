#pragma once

#include <string>

#include "culling/cull.hpp"
#include "culling/light_tree.hpp"
#include "culling/shade_lights.hpp"
#include "gbuffer/gbuffer.hpp"
#include "raster/view.hpp"
#include "rays/ray_cast.hpp"
#include "render/exact_shadows.hpp"
#include "render/features.hpp"
#include "render/stats.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// What stays the same for all G-buffers of one picture: lights and shadow maps in the camera's view space,
/// on the device; and memory there that one G-buffer leaves to the next. Buffers are borrowed from what
/// stands before them, so host side and device side live together and are not copied.
struct Lighting {
  FeatureSet features;
  std::string math_defines;  ///< as by mathDefines
  ShadeFrame frame{};        ///< all but plane_stride
  unsigned group_log2 = 0;   ///< see CullArguments
  bool unlit = false;  ///< the scene switches lighting off: the diffuse colour takes the place of ambient
  LightArray host_lights;
  LightTree host_tree;
  ShadowMaps host_shadows;
  RayScene shadow_rays;              ///< with Feature::kExact only
  std::vector<std::uint32_t> order;  ///< likewise: the scene's index of each light in host_lights
  Buffer<const ShadeLight> lights;
  Buffer<const float> tree;
  Buffer<const ShadowMap> shadow_maps;
  Buffer<const ShadowFace> shadow_faces;
  Buffer<const ShadowTexel> shadow_texels;  ///< drawn so far
  Buffer<const BoundTexel> shadow_bounds;   ///< likewise
  LightLists lists;                         ///< of the last G-buffer, with Feature::kLightLists
  LightLists lists_in_range;                ///< that its lights in range were counted by
  std::size_t bytes = 0;                    ///< of lights and tree

  Lighting() = default;
  Lighting(const Lighting&) = delete;
  Lighting& operator=(const Lighting&) = delete;
};

/// Fills `lighting` for a scene seen by a view of `camera`, planning the shadow maps that the features ask
/// for. The device may still be opening when it is called.
void prepareLighting(Device& device, const Scene& scene, const Camera& camera, const View& view,
                     const FeatureSet& features, const ShadeSettings& settings, Lighting& lighting,
                     Stats& stats);

/// A lit G-buffer: planes of pixels() floats.
struct LitPlanes {
  Plane color;        ///< r g b, then with Feature::kOutputShadow the shadow layer
  Plane light_count;  ///< lights in range of each pixel, if asked for
  Plane
      list_length;  ///< lights in the list of each pixel's square, if asked for; all where there are no lists
  std::uint64_t list_entries = 0;
  PairBits pair_bits;           ///< of the entries of Lighting::lists, with Feature::kExact
  std::uint64_t traced = 0;     ///< pixel-light pairs whose exact shadow took a ray
  std::uint64_t evaluated = 0;  ///< pixel-light pairs that the shade kernel went through, if asked for
};

/// What lightGBuffer is to count beside.
struct PixelCounts {
  bool evaluated = false;    ///< LitPlanes::evaluated
  bool in_range = false;     ///< LitPlanes::light_count
  bool list_length = false;  ///< LitPlanes::list_length
};

/// Culls and shades one G-buffer, drawing those parts of the scene's shadow maps that it looks at and that
/// weren't drawn before. `features` may leave out some of what the lighting was prepared for.
LitPlanes lightGBuffer(Device& device, const Scene& scene, Lighting& lighting, const FeatureSet& features,
                       const GBuffer& gbuffer, const PixelCounts& counts, Stats& stats);

/// Compiles the kernels for these features down to machine code, which OpenCL does at the first launch.
void compileKernels(Device& device, const FeatureSet& features, const ShadeSettings& settings);

}  // namespace luciole
