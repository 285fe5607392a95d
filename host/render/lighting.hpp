#pragma once

#include <optional>
#include <string>
#include <vector>

#include "culling/cull.hpp"
#include "culling/light_clusters.hpp"
#include "culling/light_tree.hpp"
#include "culling/shade_lights.hpp"
#include "gbuffer/gbuffer.hpp"
#include "raster/view.hpp"
#include "render/beam_shadows.hpp"
#include "render/clustered_light.hpp"
#include "render/features.hpp"
#include "render/pair_rays.hpp"
#include "render/stats.hpp"
#include "scene/scene.hpp"
#include "shadow/kept_shadows.hpp"

namespace luciole {

/// What all G-buffers of one picture share: lights and shadow maps in the camera's view space, on the host
/// and on the device, and device memory that each G-buffer reuses. Buffers are borrowed from the members
/// before them, so a Lighting can't be copied.
struct Lighting {
  FeatureSet features;
  std::string math_defines;  ///< as by mathDefines
  ShadeFrame frame{};        ///< all but plane_stride and texel_count, which depend on the G-buffer
  unsigned group_log2 = 0;   ///< see CullArguments
  bool unlit = false;      ///< the scene switches lighting off: the diffuse colour takes the place of ambient
  LightArray host_lights;  ///< those that are summed by themselves
  std::vector<std::uint32_t> light_order;  ///< the scene's index of each
  LightTree host_tree;
  ShadowMaps host_shadows;
  BeamScene beams;  ///< with Feature::kExact only
  Buffer<const ShadeLight> lights;
  Buffer<const float> tree;
  Buffer<const ShadowMap> shadow_maps;
  Buffer<const ShadowFace> shadow_faces;
  Buffer<const ShadowTexel> shadow_texels;  ///< those drawn so far
  LightLists lists;                         ///< of the last G-buffer that was shaded by lists
  LightLists lists_in_range;                ///< lists by range alone, to count lights in range
  LightClusters clusters;                   ///< of diffuse light, with Feature::kClusteredLights only
  LightClusters highlight_clusters;         ///< of specular light, where its colours are others
  std::size_t clustered_lights = 0;         ///< that they stand for
  float light_error = 0;                    ///< see ShadeSettings
  /// With Gouraud shading and clusters: the largest bound of any vertex, r g b. A pixel mixes vertices by
  /// weights that add up to 1, and maps don't make it brighter, so it is a bound for each pixel.
  std::optional<glm::vec3> vertex_error;
  std::size_t bytes = 0;  ///< of lights and tree on the device

  Lighting() = default;
  Lighting(const Lighting&) = delete;
  Lighting& operator=(const Lighting&) = delete;
};

/// Fills `lighting` for a scene seen by a view of `camera`, and plans the shadow maps that the features need;
/// none is drawn yet. kept: of the picture before this one, or null: see KeptShadows. The device may still be
/// opening: this waits for it as late as possible. Adds the times of its stages to `stats`. Throws
/// MachineError, and what opening the device throws.
void prepareLighting(Device& device, const Scene& scene, const Camera& camera, const View& view,
                     const FeatureSet& features, const ShadeSettings& settings, Lighting& lighting,
                     Stats& stats, KeptShadows* kept = nullptr);

/// A lit G-buffer: planes of pixels() floats.
struct LitPlanes {
  Plane color;  ///< r g b, then with Feature::kOutputShadow the shadow layer
  /// Bounds of the error of `color` that clusters of lights make, r g b; 0 for background. Empty where none
  /// do.
  Plane light_error;
  ClusteredLightCounts clustered;
  Plane light_count;  ///< lights in range of each pixel, if asked for
  Plane
      list_length;  ///< lights in the list of each pixel's square, if asked for; all where there are no lists
  std::uint64_t list_entries =
      0;                        ///< of Lighting::lists, or where none were made, of those that shading found
  PairShadows pairs;            ///< with Feature::kExact: the shadows of the entries of Lighting::lists
  TracedPairs traced;           ///< of these, the pairs of a pixel and a light that took rays
  std::uint64_t evaluated = 0;  ///< pixel-light pairs that the shade kernel went through, if asked for
  std::uint64_t by_beams = 0;   ///< of these, with lights whose shadows are exact
  std::uint64_t by_maps = 0;    ///< and with lights that have shadow maps
};

/// What lightGBuffer() shall count in addition. Each costs time.
struct PixelCounts {
  bool evaluated = false;    ///< LitPlanes::evaluated
  bool in_range = false;     ///< LitPlanes::light_count
  bool list_length = false;  ///< LitPlanes::list_length
};

/// Culls and shades one G-buffer: together where there are many lights and nothing but shading reads their
/// lists, that is without shadows and without counting how long lists are. Draws those parts of the scene's
/// shadow maps that it looks up and that weren't drawn before. features: those that the lighting was prepared
/// for, or fewer. Adds the times of its stages to `stats`, and raises stats.device_bytes to what it needs.
/// `used`: a plane that is done with, whose memory the colours take. Throws MachineError.
LitPlanes lightGBuffer(Device& device, const Scene& scene, Lighting& lighting, const FeatureSet& features,
                       const GBuffer& gbuffer, const PixelCounts& counts, Stats& stats, Plane used = {});

/// Compiles the kernels for these features down to machine code, by lighting one tile of background: OpenCL
/// compiles a kernel at its first launch. Throws MachineError.
void compileKernels(Device& device, const FeatureSet& features, const ShadeSettings& settings);

}  // namespace luciole
