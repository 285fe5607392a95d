#include "tools/cli/option_names.hpp"

#include <cstddef>
#include <string_view>

namespace luciole {
namespace {

struct OptionName {
  std::string_view field;  ///< of the library; ends in ": " where the message begins with it
  std::string_view option;
  std::string_view hint = "";  ///< ends the message
};

constexpr OptionName kOptionNames[] = {
    {"settings.crop: ", "--crop "},
    {"settings.size", "--size"},
    {"settings.shade.confidence: ", "--confidence "},
    {"settings.aovs: ", "--aov: "},
    {"changes: ", "--set "},
    {"device: ", "--device ", " (see luciole devices)"},
    {"options.format", "--format"},
    {"options.half", "--half"},
    {"options.compression", "--compression"},
    {"options.alpha", "--alpha"},
    {"options.bits", "--bits"},
    {"request.layers", "luciole relight --channels"},
    {"request.albedo", "--albedo"},
    {"request.camera_to_world or request.camera",
     "luciole relight --camera-to-world or a camera in the scene of --lights"},
    {"request.camera", "a camera in the scene of luciole relight --lights"},
};

}  // namespace

std::string withOptionNames(std::string message) {
  for (const OptionName& name : kOptionNames) {
    const std::size_t at = message.find(name.field);
    if (at == std::string::npos || (name.field.ends_with(": ") && at != 0)) continue;
    message.replace(at, name.field.size(), name.option);
    message += name.hint;
    break;
  }
  return message;
}

}  // namespace luciole
