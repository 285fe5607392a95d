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
///
/// It has nothing but glTF's core and that extension. Lamps are nodes that share their mesh: a light needs a
/// node of its own anyway, so EXT_mesh_gpu_instancing would save none, and where a viewer doesn't know it,
/// all balls but one would be gone, or as a required extension the whole file.
GltfDocument lightsAsset(std::uint64_t count, std::uint64_t seed);

}  // namespace luciole
