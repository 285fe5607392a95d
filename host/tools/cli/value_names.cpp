#include <map>
#include <string>

#include "tools/cli/commands.hpp"

namespace luciole {
namespace {

/// What stands for the value of an option that takes a text, wherever the option has no list of values.
const std::map<std::string, std::string> kValueNames{
    {"output", "FILE"},    {"stats", "FILE"},  {"json", "FILE"},         {"diff", "FILE"},
    {"error-map", "FILE"}, {"plot", "FILE"},   {"side-by-side", "FILE"}, {"gbuffer", "FILE"},
    {"scene", "FILE"},     {"csv", "FILE"},    {"reference", "FILE"},    {"size", "WxH"},
    {"crop", "X,Y,W,H"},   {"camera", "NAME"}, {"format", "NAME"},       {"device", "NAME"},
    {"field", "NAME"},     {"shape", "NAME"},  {"frames", "FRAMES"},     {"shard", "I/N"},
    {"exposure", "STOPS"}, {"aov", "LAYERS"},  {"probe", "X,Y"},         {"lights", "COUNTS"},
    {"trace", "FILE"},     {"screen", "FILE"}};

}  // namespace

void nameValues(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    const bool is_text = type.starts_with("TEXT") && type.find(":{") == std::string::npos;
    const auto named = kValueNames.find(option->get_single_name());
    if (is_text && named != kValueNames.end()) option->type_name(named->second);
  }
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) nameValues(*command);
}

}  // namespace luciole
