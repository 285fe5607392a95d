#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "base/write_file.hpp"
#include "tools/cli/command_table.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/suggest.hpp"

namespace luciole {
namespace {

std::string withBackslashBefore(std::string_view special, std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (special.find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

/// One word of bash or zsh.
std::string shellQuoted(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

/// One word of fish, whose single quotes know \\ and \'.
std::string fishQuoted(std::string_view text) { return "'" + withBackslashBefore("\\'", text) + "'"; }

template <class Quote>
std::string quotedWords(const std::vector<std::string>& words, Quote quote) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + quote(word);
  return line;
}

std::vector<std::string> allNames(const std::vector<OptionEntry>& options) {
  std::vector<std::string> names;
  for (const OptionEntry& option : options)
    names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

std::vector<std::string> namesOfCommands(const CommandEntry& command) {
  std::vector<std::string> names;
  for (const auto& [name, description] : command.commands) names.push_back(name);
  return names;
}

/// "a|b" of the endings of scene files.
std::string sceneEndings() { return fmt::format("{}", fmt::join(kSceneEndings, "|")); }

std::string scriptHead(std::string_view shell) {
  return fmt::format("# Completion of luciole {} for {}, made by: luciole completion {}\n\n", LUCIOLE_VERSION,
                     shell, shell);
}

// bash

/// "COMMAND WORD", the key by which the script finds what a value may be.
std::string bashKey(const CommandEntry& command, const std::string& word) {
  return shellQuoted(command.path.empty() ? word : command.path + " " + word);
}

std::string bashOffers(const OptionEntry& option) {
  switch (option.kind) {
    case ValueKind::kChoice:
      return fmt::format("offers=({}) ", quotedWords(option.choices, shellQuoted));
    case ValueKind::kScene:
      return "files=scenes ";
    case ValueKind::kFile:
      return "files=any ";
    default:
      return "";
  }
}

constexpr const char* kBashFunction = R"(
_luciole() {
  local current=${COMP_WORDS[COMP_CWORD]} path='' place=1 option='' files='' word
  local -a commands options offers
  COMPREPLY=()
  [[ $current != = ]] || current=  # of --size=640 bash makes three words
  _luciole_words ''
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if [[ $word == = ]]; then
      continue
    elif [[ $option ]]; then
      option=
    elif [[ $word == -?* ]]; then
      _luciole_value "${path:+$path }$word" && option=$word
    elif [[ " ${commands[*]} " == *" $word "* ]]; then
      path+=${path:+ }$word place=1
      _luciole_words "$path"
    else
      ((++place))
    fi
  done
  if [[ $option ]]; then
    _luciole_value "${path:+$path }$option"
  elif [[ $current == -* ]]; then
    offers=("${options[@]}") files=
  else
    _luciole_value "${path:+$path }$place"
    ((place > 1)) || offers+=("${commands[@]}")
  fi
  for word in "${offers[@]}"; do
    printf -v word %q "$word"
    [[ $word != "$current"* ]] || COMPREPLY+=("$word")
  done
  [[ $files ]] || return 0
  compopt -o filenames 2>/dev/null
  current=${current#[\"\']} current=${current//\\/}
  while IFS= read -r word; do
    [[ $files == any || -d ${word/#\~/$HOME} || ${word,,} =~ \.(@ENDINGS@)$ ]] && COMPREPLY+=("$word")
  done < <(compgen -f -- "$current")
  return 0
}
complete -F _luciole luciole
)";

std::string bashCompletion(const std::vector<CommandEntry>& table) {
  std::string words, values;
  for (const CommandEntry& command : table) {
    words += fmt::format("    {}) commands=({}) options=({}) ;;\n", shellQuoted(command.path),
                         quotedWords(namesOfCommands(command), shellQuoted),
                         quotedWords(allNames(command.options), shellQuoted));
    for (const OptionEntry& option : command.options) {
      if (option.kind == ValueKind::kNone) continue;
      std::string keys;
      for (const std::string& name : option.names)
        keys += (keys.empty() ? "" : " | ") + bashKey(command, name);
      values += fmt::format("    {}) {};;\n", keys, bashOffers(option));
    }
    for (std::size_t i = 0; i < command.arguments.size(); ++i) {
      const OptionEntry& argument = command.arguments[i];
      const std::string key =
          argument.repeatable ? bashKey(command, "") + "[1-9]*" : bashKey(command, std::to_string(i + 1));
      values += fmt::format("    {}) {};;\n", key, bashOffers(argument));
    }
  }
  std::string function = kBashFunction;
  const std::string_view place = "@ENDINGS@";
  function.replace(function.find(place), place.size(), sceneEndings());
  return scriptHead("bash") +
         "# What may follow the commands typed so far.\n_luciole_words() {\n  case $1 in\n" + words +
         "  esac\n}\n\n"
         "# What the value of an option of a command may be, or the argument in that place. Fails where "
         "there is none.\n"
         "_luciole_value() {\n  offers=() files=\n  case $1 in\n" +
         values + "    *) return 1 ;;\n  esac\n}\n" + function;
}

// zsh

constexpr const char* kZshEnter =
    R"(# Completes what follows the first command typed, by the function of that name with PREFIX before it. Fails where
# none of the commands was typed.
_luciole_enter() {  # PREFIX COMMAND...
  local prefix=$1
  local -i i
  shift
  for ((i = 2; i < CURRENT; ++i)); do
    (( $argv[(Ie)$words[i]] )) || continue
    shift $((i - 1)) words
    ((CURRENT -= i - 1))
    ${prefix}_$words[1]
    return 0
  done
  return 1
}
)";

constexpr const char* kZshEnd = R"(
# As a file of $fpath, or sourced.
if [[ ${funcstack[1]-} == _luciole ]]; then
  _luciole "$@"
else
  compdef _luciole luciole
fi
)";

std::string zshFunction(const CommandEntry& command) {
  std::string name = command.path.empty() ? "_luciole" : "_luciole_" + command.path;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

std::string zshAction(const OptionEntry& option) {
  switch (option.kind) {
    case ValueKind::kChoice: {
      const auto escape = [](const std::string& choice) { return withBackslashBefore("\\ :()", choice); };
      return "(" + quotedWords(option.choices, escape) + ")";
    }
    case ValueKind::kScene:
      return "_files -g \"(#i)*.(" + sceneEndings() + ")(-.)\"";
    case ValueKind::kFile:
      return "_files";
    default:
      return " ";
  }
}

/// The specifications of _arguments for an option, one for each of its names.
std::vector<std::string> zshSpecifications(const OptionEntry& option) {
  const bool takes_value = option.kind != ValueKind::kNone;
  const std::string once = option.names.size() < 2 ? "" : fmt::format("({})", fmt::join(option.names, " "));
  std::vector<std::string> specifications;
  for (const std::string& name : option.names) {
    std::string one = (option.repeatable ? "*" : once) + name;
    if (takes_value && name.starts_with("--")) one += "=";
    one += "[" + withBackslashBefore("\\[]:", option.description) + "]";
    if (takes_value) one += ":" + withBackslashBefore("\\:", option.value) + ":" + zshAction(option);
    specifications.push_back(one);
  }
  return specifications;
}

std::string zshCommand(const CommandEntry& command) {
  const std::string name = zshFunction(command);
  std::string text;
  std::vector<std::string> specifications;
  for (const OptionEntry& option : command.options)
    for (const std::string& one : zshSpecifications(option)) specifications.push_back(one);
  for (std::size_t i = 0; i < command.arguments.size(); ++i) {
    const OptionEntry& argument = command.arguments[i];
    const std::string place =
        argument.repeatable ? "*:" : fmt::format("{}:{}", i + 1, argument.required ? "" : ":");
    const bool or_command = i == 0 && !command.commands.empty();
    specifications.push_back(place + argument.value + ":" +
                             (or_command ? name + "_first" : zshAction(argument)));
  }
  if (!command.commands.empty()) {
    std::vector<std::string> described;
    for (const auto& [inner, description] : command.commands)
      described.push_back(shellQuoted(inner + ":" + description));
    text +=
        fmt::format("\n{}_commands() {{\n  local -a names=(\n    {}\n  )\n  _describe command names\n}}\n",
                    name, fmt::join(described, "\n    "));
    if (command.arguments.empty())
      specifications.push_back("1:command:" + name + "_commands");
    else
      text += fmt::format("\n{0}_first() {{\n  _alternative 'commands:command:{0}_commands' {1}\n}}\n", name,
                          shellQuoted("arguments:" + command.arguments.front().value + ":" +
                                      zshAction(command.arguments.front())));
  }
  text += fmt::format("\n{}() {{\n", name);
  if (!command.commands.empty())
    text += fmt::format("  _luciole_enter {} {} && return\n", name, fmt::join(namesOfCommands(command), " "));
  text += "  _arguments";
  for (const std::string& one : specifications) text += " \\\n    " + shellQuoted(one);
  return text + "\n}\n";
}

std::string zshCompletion(const std::vector<CommandEntry>& table) {
  std::string script = "#compdef luciole\n" + scriptHead("zsh") + kZshEnter;
  for (const CommandEntry& command : table) script += zshCommand(command);
  return script + kZshEnd;
}

// fish

std::string fishOffers(const OptionEntry& option) {
  switch (option.kind) {
    case ValueKind::kNone:
      return "";
    case ValueKind::kChoice:
      return " -x -a " + fishQuoted(quotedWords(option.choices, fishQuoted));
    case ValueKind::kScene:
      return " -x -a '(__luciole_scenes)'";
    case ValueKind::kFile:
      return " -r -F";
    default:
      return " -x";
  }
}

std::string fishArgument(const OptionEntry& argument) {
  if (argument.kind == ValueKind::kFile) return " -F";
  return argument.kind == ValueKind::kWord ? " -f"
                                           : fishOffers(argument).substr(3);  // no option to require it
}

std::string fishCompletion(const std::vector<CommandEntry>& table) {
  std::string known, lines;
  for (const CommandEntry& command : table) {
    const std::string line =
        "complete -c luciole -n " + fishQuoted("__luciole_after " + fishQuoted(command.path));
    for (const auto& [name, description] : command.commands) {
      known += " " + fishQuoted(command.path + " " + name);
      lines += fmt::format("{} -a {} -d {}\n", line, name, fishQuoted(description));
    }
    for (const OptionEntry& argument : command.arguments) lines += line + fishArgument(argument) + "\n";
    for (const OptionEntry& option : command.options) {
      lines += line;
      for (const std::string& name : option.names)
        lines += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      lines += fishOffers(option) + " -d " + fishQuoted(option.description) + "\n";
    }
  }
  return scriptHead("fish") +
         "# Whether these are the commands typed so far.\n"
         "function __luciole_after\n    set -l path\n    for word in (commandline -opc)[2..-1]\n"
         "        switch \"$path $word\"\n            case" +
         known +
         "\n                set -a path $word\n        end\n    end\n    test \"$path\" = \"$argv\"\nend\n\n"
         "function __luciole_scenes\n"
         "    __fish_complete_path (commandline -ct) | string match -r -i " +
         fishQuoted("^.*(?:/|\\.(?:" + sceneEndings() + "))(?:\\t.*)?$") +
         "\nend\n\ncomplete -c luciole -f\n" + lines;
}

}  // namespace

void addCompletionCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("completion",
                         "a script for a shell to complete these commands by, such as: source "
                         "<(luciole completion bash)");
  auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "whose: bash, zsh or fish")
      ->required()
      ->check(oneOf({"bash", "zsh", "fish"}));
  command->callback([&app, shell] {
    const std::vector<CommandEntry> table = commandTable(app);
    writeTextFile("-", *shell == "bash"  ? bashCompletion(table)
                       : *shell == "zsh" ? zshCompletion(table)
                                         : fishCompletion(table));
  });
}

}  // namespace luciole
