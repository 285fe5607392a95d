#include "tools/cli/command_table.hpp"

#include <algorithm>
#include <set>

#include "base/split.hpp"
#include "tools/cli/picture_options.hpp"

namespace luciole {
namespace {

/// The text between the first `open` and the last `close`. Empty where they aren't.
std::string textBetween(const std::string& text, const std::string& open, char close) {
  const std::size_t first = text.find(open), last = text.rfind(close);
  if (first == std::string::npos || last == std::string::npos || last < first) return "";
  return text.substr(first + open.size(), last - first - open.size());
}

/// What an option's value is by its type, as CLI11 names it: TEXT, INT ... or what the option calls it.
ValueKind kindOfType(const std::string& type) {
  for (const char* file : {"TEXT", "FILE", "PATH", "DIR", "FOLDER"})
    if (type.find(file) != std::string::npos) return ValueKind::kFile;
  return ValueKind::kWord;
}

std::vector<std::string> sortedNames(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::sort(names.begin(), names.end());  // the set is in the order of addresses
  return names;
}

OptionEntry entryOf(const CLI::Option& option) {
  OptionEntry entry;
  for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
  entry.description = option.get_description();
  entry.needs = sortedNames(option.get_needs());
  entry.excludes = sortedNames(option.get_excludes());
  entry.required = option.get_required();
  const int most_values = option.get_items_expected_max();
  if (most_values == 0) return entry;
  entry.repeatable = most_values > 1;
  entry.standard = option.get_default_str();
  // CLI11 appends what the validators say: "TEXT:{on,off}", "INT:INT in [1 - 1024]".
  const std::string type_and_checks = option.get_type_name();
  const std::size_t colon = type_and_checks.find(':');
  const std::string type = type_and_checks.substr(0, colon);
  const std::string checks = colon == std::string::npos ? "" : type_and_checks.substr(colon + 1);
  entry.value = entry.names.empty()                ? option.get_name(true)
                : option.get_option_text().empty() ? type
                                                   : option.get_option_text();
  const bool is_scene = entry.value == "SCENE" || option.get_name() == "--scene";
  const std::string choices = textBetween(checks, "{", '}'), range = textBetween(checks, " in [", ']');
  if (!choices.empty()) {
    entry.kind = ValueKind::kChoice;
    entry.choices = split(choices, ',');
    return entry;
  }
  entry.kind = is_scene ? ValueKind::kScene : kindOfType(type_and_checks);
  entry.limits = range.empty() ? checks : range;
  if (const std::size_t dash = range.find(" - "); dash != std::string::npos)
    entry.limits.replace(dash, 3, " to ");
  return entry;
}

/// The commands in this one that --help shows.
std::vector<const CLI::App*> innerCommands(const CLI::App& command) {
  return command.get_subcommands(
      [](const CLI::App* one) { return !one->get_name().empty() && !one->get_group().empty(); });
}

void addEntries(const CLI::App& command, const std::string& path, std::vector<CommandEntry>& table) {
  CommandEntry entry;
  entry.path = path;
  entry.description = command.get_description();
  entry.footer = command.get_footer();
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;  // --help hides it
    OptionEntry one = entryOf(*option);
    (one.names.empty() ? entry.arguments : entry.options).push_back(std::move(one));
  }
  for (const CLI::App* inner : innerCommands(command))
    entry.commands.emplace_back(inner->get_name(), inner->get_description());
  table.push_back(std::move(entry));
  for (const CLI::App* inner : innerCommands(command))
    addEntries(*inner, path.empty() ? inner->get_name() : path + " " + inner->get_name(), table);
}

}  // namespace

std::vector<CommandEntry> commandTable(const CLI::App& program) {
  std::vector<CommandEntry> table;
  addEntries(program, "", table);
  // An argument COMMAND is one of the program's: help has it.
  for (CommandEntry& command : table) {
    for (OptionEntry& argument : command.arguments) {
      if (argument.value != "COMMAND") continue;
      argument.kind = ValueKind::kChoice;
      for (const auto& [name, description] : table.front().commands) argument.choices.push_back(name);
    }
  }
  return table;
}

}  // namespace luciole
