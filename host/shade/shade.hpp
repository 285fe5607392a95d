#pragma once

#include <string>

#include "kernels/shared.h"
#include "lights/cull.hpp"
#include "luciole/gbuffer.hpp"

namespace luciole {

/// A G-buffer's groups on the device. A group that the G-buffer lacks is a buffer of 16 bytes.
struct GBufferBuffers {
  Buffer<const float> position, normal, diffuse, specular, ambient, emission;
  Buffer<const uint> surface_normal, model, tangent;
  Buffer<const float> lift;
};

/// What kernels take as surface_normal: the unbent normals where the G-buffer has them, else the geometric.
inline const PackedNormals& surfaceNormals(const GBuffer& gbuffer) {
  return gbuffer.unbent_normal.empty() ? gbuffer.geometric_normal : gbuffer.unbent_normal;
}

/// The planes of a G-buffer, borrowed (see Buffer), with the surface normals, lift, models and tangents given
/// instead of its own. unlit: the diffuse colour takes the place of ambient.
GBufferBuffers borrowedGBuffer(OpenedDevice& device, const GBuffer& gbuffer,
                               const PackedNormals& surface_normal, const Plane& lift,
                               const ModelPlane& model, const PackedNormals& tangent, bool unlit);

/// What a program that shades is compiled for.
struct ShadeProgram {
  std::string defines;    ///< featureDefines() and mathDefines()
  std::string user_text;  ///< with Feature::kUserModels: see makeKernel()
};

struct ShadeArguments {
  const ShadeFrame& frame;
  const GBufferBuffers& gbuffer;
  Buffer<const ShadeLight> lights;  ///< frame.light_count
  Buffer<const float> luminaires;   ///< LightSet::luminaires, with Feature::kProfiles only
  const LightLists& lists;          ///< with Feature::kLightLists only
  Buffer<const ShadowMap> shadow_maps;
  Buffer<const ShadowFace> shadow_faces;
  Buffer<const ShadowTexel> shadow_texels;  ///< frame.texel_count
  Buffer<const uint> pair_bits;             ///< PairShadows::lit, with Feature::kExact only
  Buffer<const uint> ray_bits;              ///< PairShadows::unsure, with Feature::kSoftExact only
  Buffer<const uint> first_share;           ///< likewise
  Buffer<const float> shares;               ///< likewise
  Buffer<float> image;              ///< out: planes r, g, b, and the shadow layer with Feature::kOutputShadow
  Buffer<uint> faulty_pixels = {};  ///< one, to be raised, with Feature::kUserModels only
};

/// Launches kernels/shade/shade.cl on every pixel of the G-buffer and waits for it. Throws as makeKernel()
/// and launch().
void shade(OpenedDevice& device, const ShadeProgram& program, const ShadeArguments& arguments);

}  // namespace luciole
