#pragma once

#include <cstdint>

#include "scene/gltf/write_gltf.hpp"

namespace luciole {

/// The most lights of a lightsAsset().
inline constexpr std::uint64_t kMostAssetLights = 1'000'000;

/// A theatre at night, lit by `count` lights of KHR_lights_punctual: lamps, three of four of them points and
/// the others spots that look down, and beside the first lamp a directional moon. The lamps lie evenly over
/// the ground, in octaves: each has twice as many as the one before, half as high and reaching half as far in
/// area. Every lamp is seen as a ball of its colour. The picture is about as bright for every count, with a
/// radiance of 1 shown as white. The same bits for the same seed on every machine. 1 ≤ count ≤
/// kMostAssetLights.
/// It uses only glTF's core and that extension. Lamps are nodes that share their mesh.
/// EXT_mesh_gpu_instancing would save no nodes, since each light needs one, and viewers without it would show
/// a single ball, or no file at all.
GltfDocument lightsAsset(std::uint64_t count, std::uint64_t seed);

}  // namespace luciole
