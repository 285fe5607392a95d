#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "luciole/image.hpp"

// Cryptomatte: mattes of things by their names. "Cryptomatte Specification", version 1.2, Psyop, 2018, after
// J. Friedman and A. Jones, "Fully automatic ID mattes with support for motion blur and transparency",
// SIGGRAPH 2015.
namespace luciole {

/// A pixel has the six names that cover most of it, two in a layer: TYPENAME00.R and .B name them, .G and .A
/// say how much they cover.
inline constexpr int kCryptomatteRanks = 6;

/// The names of the layers.
inline constexpr const char* kCryptoObject = "CryptoObject";
inline constexpr const char* kCryptoMaterial = "CryptoMaterial";

/// The names of the 2 · kCryptomatteRanks channels, by rank: one that names, and one that says how much.
std::vector<std::string> cryptomatteChannels(const std::string& type_name);

/// MurmurHash3_x86_32 with the seed 0 (A. Appleby, public domain).
std::uint32_t murmurHash(std::string_view text);

/// The number that stands for a name, by the conversion uint32_to_float32: never denormal, infinite or NaN.
float cryptomatteId(std::string_view name);

/// The header's attributes for mattes of these names. Bytes that aren't UTF-8 are replaced in the manifest.
Metadata cryptomatteTexts(const std::string& type_name, const std::vector<std::string>& names);

}  // namespace luciole
