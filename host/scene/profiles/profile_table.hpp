#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "luciole/light.hpp"

namespace luciole {

/// A file's table as it stands there: candela over its vertical angles, for each of its horizontal ones.
/// Angles ascend; degrees.
struct ProfileTable {
  PhotometricType type = PhotometricType::kC;
  std::vector<double> vertical = {}, horizontal = {};
  std::vector<float> candela = {};  ///< [horizontal][vertical], ≥ 0 and finite
  double lamp_lumens = 0.0;
};

/// The profile of a table whose angles leave out what symmetry repeats:
/// - type C, horizontal: 0 alone, 0 to 90, 0 to 180, 90 to 270, or all around;
/// - types A and B, both: 0 to 90 instead of −90 to 90.
/// Returns the reason why there is none, or "". O(entries).
std::string makeProfile(const ProfileTable& table, LightProfile& profile);

/// The entries that a file may have: of so many numbers of text, and not more than kMostEntries.
inline constexpr std::size_t kMostEntries = std::size_t(1) << 22;

/// The profile in a file's bytes. name: the file's, for messages and by its end the format. See
/// readLightProfile().
std::shared_ptr<const LightProfile> parseLightProfile(std::string_view text, const std::string& name,
                                                      std::vector<Warning>& warnings);

/// The tables of IES LM-63 and of EULUMDAT.
ProfileTable parseIes(std::string_view text, const std::string& name, std::vector<Warning>& warnings);
ProfileTable parseEulumdat(std::string_view text, const std::string& name, std::vector<Warning>& warnings);

}  // namespace luciole
