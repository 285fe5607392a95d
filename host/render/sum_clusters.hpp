#pragma once

#include "render/clustered_light.hpp"
#include "render/light_set.hpp"
#include "render/points.hpp"

namespace luciole {

/// The light of clusters: planes r g b, a float for each point.
struct ClusterLight {
  Plane light;  ///< as it leaves the surface, and the G-buffer's emission with it
  Plane bound;  ///< how far each value may be from the truth, seen through the fog; 0 for background
  ClusteredLightCounts counts;
};

/// Lights the points by the set's clusters. features, math_defines: of the program that shades. frame: of the
/// points. Throws MachineError.
ClusterLight sumClusters(Device& device, const ClusterSet& clusters, const Points& points,
                         const ShadeFrame& frame, const FeatureSet& features,
                         const std::string& math_defines);

}  // namespace luciole
