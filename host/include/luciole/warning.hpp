#pragma once

#include <string>

namespace luciole {

/// What a file asks for and the picture won't show, or a fault of the file that was mended.
struct Warning {
  std::string text = {};  ///< one line, which begins with the file's name
  /// The same for warnings that differ in place and value alone, such as "unknown material". Of each kind a
  /// terminal shows ten at most.
  std::string kind = {};
  /// The file breaks its format's rules, and a value was taken that common viewers take; or a mesh's points
  /// or lines aren't drawn. --strict makes it an error.
  bool repaired = false;
};

inline bool operator==(const Warning& a, const Warning& b) {
  return a.text == b.text && a.kind == b.kind && a.repaired == b.repaired;
}

}  // namespace luciole
