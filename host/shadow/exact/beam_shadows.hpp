#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cl/buffer.hpp"
#include "kernels/shared.h"
#include "lights/cull.hpp"
#include "luciole/scene.hpp"
#include "shadow/exact/hole_masks.hpp"
#include "shadow/exact/light_samples.hpp"
#include "shadow/exact/triangle_tree.hpp"

namespace luciole {

/// The triangle tree and samples of exact shadows, on the host and on the device. Buffers are borrowed from
/// the members before them, so it can't be copied.
struct BeamScene {
  std::shared_ptr<const TriangleTree> tree;
  std::shared_ptr<const HoleMasks> masks;  ///< null where no triangle has holes
  glm::mat3 view_to_tree{1.0f};            ///< a rotation
  float4 largest_coordinates{};            ///< the largest |x|, |y|, |z| in the tree
  int soft_samples = 0;                    ///< of each light of a size; 0: none has one
  std::vector<LightSample> samples;        ///< makeLightSamples(), with lights of a size only
  std::vector<float> cosines;              ///< quarterCosines(), likewise
  Buffer<const float> nodes, blocks;
  Buffer<const int> children;
  Buffer<const uint> block_bits;
  Buffer<const unsigned char> hole_texels;
  Buffer<const HoleTriangle> hole_triangles;
  Buffer<const uint> first_hole_triangle;
  Buffer<const float> quarter_cosines;

  BeamScene() = default;
  BeamScene(const BeamScene&) = delete;
  BeamScene& operator=(const BeamScene&) = delete;
};

/// Fills `beams` for what a camera sees. tree: of the scene, its origin the camera's eye. masks: of the tree,
/// or null where no triangle has holes. soft_samples: of lights of a size; 0: they count as points, or for
/// directional lights as single directions. Throws MachineError.
void prepareBeams(OpenedDevice& device, const Camera& camera, std::shared_ptr<const TriangleTree> tree,
                  std::shared_ptr<const HoleMasks> masks, int soft_samples, BeamScene& beams);

/// A light in the tree's space. casts: its shadow is computed by beams.
BeamLight beamLight(const Light& light, bool casts, const BeamScene& beams);

struct BeamArguments {
  std::size_t plane_stride;      ///< floats in a plane
  Buffer<const float> position;  ///< G-buffer planes x, y, z; view space, metres
  Buffer<const float> normal;    ///< G-buffer planes x, y, z; view space, unit
  Buffer<const float> lift;      ///< a plane, metres, with Feature::kLift only
  const LightLists& lists;       ///< with Feature::kLightLists only
  Buffer<const BeamLight> lights;
  const BeamScene& beams;
  bool holes;  ///< with Feature::kHoles
  bool soft;   ///< with Feature::kSoftExact
};

/// The exact shadows of all entries of the lists; without lists of each tile and light, tile by tile.
/// They stay on the device: kPairWords words for each entry, a bit for each pixel of its tile.
struct PairShadows {
  Buffer<uint> lit;
  Buffer<uint> unsure;  ///< to be decided by tracePairs(). Empty if no triangle has holes and no light a size
  /// With lights of a size only, by tracePairs(): for each word of `unsure` the index of its first bit's
  /// share; and the share of the light, in [0, 1], that reaches each unsure pair.
  Buffer<uint> first_share;
  Buffer<float> shares;
  Buffer<TilePairs> counts;  ///< of each tile; empty where `unsure` is
};

/// Launches kernels/exact/beam_shadows.cl and waits for it. defines: of featuresFor(kForBeams). Throws
/// MachineError, also if the words don't fit into memory or there are 2²⁹ entries or more.
PairShadows beamShadows(OpenedDevice& device, const std::string& defines, const BeamArguments& arguments);

}  // namespace luciole
