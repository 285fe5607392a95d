#pragma once

#include <string>

#include "cl/device.hpp"
#include "culling/cull.hpp"
#include "gbuffer/gbuffer.hpp"
#include "kernels/shared.h"

namespace luciole {

/// A G-buffer's groups on the device. Absent groups are small dummies.
struct GBufferBuffers {
  cl::Buffer position, normal, diffuse, specular, ambient, emission, facet, lift;
};

/// Brings a G-buffer, its triangles' normals and its lift to the device; where that shares the host's memory,
/// all must outlive the result. unlit: the diffuse colour takes the place of ambient.
GBufferBuffers uploadGBuffer(Device& device, const GBuffer& gbuffer, const PackedNormals& facet,
                             const Plane& lift, bool unlit);

struct ShadeArguments {
  const ShadeFrame& frame;
  const GBufferBuffers& gbuffer;
  const cl::Buffer& lights;         ///< ShadeLight[frame.light_count]
  const LightLists& lists;          ///< with Feature::kLightLists only
  const cl::Buffer& shadow_maps;    ///< ShadowMap[]
  const cl::Buffer& shadow_faces;   ///< ShadowFace[]
  const cl::Buffer& shadow_texels;  ///< ShadowTexel[frame.texel_count]
  const cl::Buffer& pair_bits;      ///< see classify.cl, with Feature::kExact only
  const cl::Buffer& image;          ///< out: planes r, g, b, and the shadow layer with Feature::kOutputShadow
};

/// Launches kernels/shade.cl on every pixel of the G-buffer. defines: the program's features
/// (featureDefines).
void shade(Device& device, const std::string& defines, const ShadeArguments& arguments);

struct CountInRangeArguments {
  const cl::Buffer& position;
  std::size_t plane_stride;
  const cl::Buffer& lights;
  const LightLists& lists;
  const cl::Buffer& counts;  ///< out: one float a pixel
};

/// Launches kernels/count_in_range.cl: how many lights reach each pixel.
void countInRange(Device& device, const CountInRangeArguments& arguments);

}  // namespace luciole
