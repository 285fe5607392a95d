#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "shared_files.hpp"

namespace luciole::test {

struct Outcome {
  int status = -1;  ///< exit status, or 128 + signal
  std::string out, err;
};

/// Runs a shell line in `folder` as a person would type it, with "luciole" as the program.
inline Outcome runLine(const TemporaryFolder& folder, const std::string& line) {
  const std::string out = folder / ".stdout", err = folder / ".stderr";
  const std::string command = "cd '" + folder.path().string() +
                              "' && luciole() { '" LUCIOLE_BINARY "' \"$@\"; } && { " + line + "; } >'" +
                              out + "' 2>'" + err + "' </dev/null";
  const int status = std::system(command.c_str());
  Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), readText(out),
                  readText(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return outcome;
}

/// Whether a text is exactly one line that says something.
inline bool isOneLine(const std::string& text) {
  return text.size() > 1 && text.back() == '\n' && std::count(text.begin(), text.end(), '\n') == 1;
}

/// A small scene that uses something of everything.
inline constexpr const char* kSmallScene = R"({
  "camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0]}, "size": [96, 54],
  "background": [0.2, 0.3, 0.4], "ambient": [0.1, 0.1, 0.1],
  "fog": {"mode": "exp2", "density": 0.05, "color": [0.2, 0.3, 0.4]},
  "materials": {"stone": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}},
  "objects": [{"primitive": "plane", "scale": 10, "material": "stone"},
              {"primitive": "sphere", "translate": [0, 1, 0], "material": "stone"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "color": [0.5, 0.5, 0.5], "shadow": true},
             {"type": "point", "position": [1, 2, 2], "range": 4, "color": [1, 0.5, 0.2]},
             {"type": "spot", "position": [-2, 4, 2], "target": [0, 0, 0], "cutoff": 30, "exponent": 4, "shadow": true}],
  "light_fields": [{"count": 200, "seed": 3, "min": [-4, 0, -4], "max": [4, 2, 4], "range": 0.8, "intensity": 0.5}]
})";

}  // namespace luciole::test
