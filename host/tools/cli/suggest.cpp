#include "tools/cli/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace luciole {
namespace {

bool isOption(const std::string& argument) { return argument.size() > 1 && argument[0] == '-'; }

std::vector<std::string> optionNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> commandNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* inner :
       command.get_subcommands([](const CLI::App* one) { return !one->get_name().empty(); }))
    names.push_back(inner->get_name());
  return names;
}

/// The program and the commands in it that were typed, outermost first.
std::vector<const CLI::App*> typedCommands(const CLI::App& app) {
  std::vector<const CLI::App*> commands{&app};
  while (!commands.back()->get_subcommands().empty())
    commands.push_back(commands.back()->get_subcommands().back());
  return commands;
}

}  // namespace

CLI::Validator oneOf(const std::vector<std::string>& names) {
  return {[names](std::string& typed) -> std::string {
            if (std::find(names.begin(), names.end(), typed) != names.end()) return "";
            return fmt::format("'{}' is none of {}{}", typed, fmt::join(names, ", "),
                               didYouMean(typed, names));
          },
          fmt::format("{{{}}}", fmt::join(names, ","))};
}

std::string describeUnexpected(const CLI::App& app) {
  const std::vector<const CLI::App*> commands = typedCommands(app);
  std::string path;
  for (const CLI::App* command : commands) {
    if (command != &app) path += " " + command->get_name();
    const std::vector<std::string> left = command->remaining();
    if (left.empty()) continue;
    const std::string help = fmt::format(" (see luciole help{})", path);
    const auto option = std::find_if(left.begin(), left.end(), isOption);
    if (option != left.end()) {
      const std::string name = option->substr(0, option->find('='));
      const std::string suggestion = didYouMean(name, optionNames(*command));
      return fmt::format("{}: no option {}{}", path, name, suggestion.empty() ? help : suggestion);
    }
    const std::vector<std::string> inner = commandNames(*command);
    if (inner.empty() || command->get_require_subcommand_min() == 0)
      return fmt::format("{}: '{}' is more than it takes{}", path, left.front(), help);
    const std::string suggestion = didYouMean(left.front(), inner);
    return fmt::format("{}: no command {}{}", path, left.front(), suggestion.empty() ? help : suggestion);
  }
  return "";
}

}  // namespace luciole
