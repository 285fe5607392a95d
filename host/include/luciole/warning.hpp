#pragma once

#include <string>

namespace luciole {

/// A request of a file that the picture doesn't show, or a fault of the file that was repaired.
struct Warning {
  std::string text = {};  ///< one line, which begins with the file's name
  /// Equal for warnings that differ in place and value alone: "unknown material". The command line shows ten
  /// of each kind.
  std::string kind = {};
  /// The file breaks its format's rules, and a value was taken that common viewers take; or a mesh's points
  /// or lines aren't drawn. An error with LoadSettings::strict.
  bool repaired = false;
};

inline bool operator==(const Warning& a, const Warning& b) {
  return a.text == b.text && a.kind == b.kind && a.repaired == b.repaired;
}

}  // namespace luciole
