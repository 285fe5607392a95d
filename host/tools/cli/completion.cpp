// Shells complete by asking the program: `luciole complete -- WORD...`, with the words typed so far, prints
// what may take the place of the last one. A line is a word, and after a tab what it is. A word that ends in
// = is an option that takes a value. A line that begins with / stands for files: with these endings, apart by
// |, or any.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/write_file.hpp"
#include "tools/cli/command_table.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/suggest.hpp"

namespace luciole {
namespace {

constexpr std::string_view kBash = R"bash(_luciole() {
  local current=${COMP_WORDS[COMP_CWORD]} files word
  COMPREPLY=()
  [[ $current != = ]] || current=  # of --size=640 bash makes three words
  while IFS= read -r word; do
    word=${word%%$'\t'*}
    [[ $word != /* ]] || { files=${word#/}; continue; }
    printf -v word %q "${word%=}"
    [[ $word != "$current"* ]] || COMPREPLY+=("$word")
  done < <(command "${COMP_WORDS[0]/#\~/$HOME}" complete -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
  [[ ${files+set} ]] || return 0
  compopt -o filenames 2>/dev/null
  current=${current#[\"\']} current=${current//\\/}
  while IFS= read -r word; do
    [[ ! $files || -d ${word/#\~/$HOME} || ${word,,} =~ \.($files)$ ]] && COMPREPLY+=("$word")
  done < <(compgen -f -- "$current")
  return 0
}
complete -F _luciole luciole
)bash";

constexpr std::string_view kZsh = R"zsh(_luciole() {
  local line described files=-  # no files
  local -a whole valued
  for line in ${(f)"$(command ${~words[1]} complete -- "${(@Q)words[2,CURRENT]}" 2>/dev/null)"}; do
    described=${${line%%$'\t'*}//:/\\:}
    [[ $line != *$'\t'* ]] || described+=:${line#*$'\t'}
    case $line in
      /*) files=${line#/} ;;
      *=$'\t'*) valued+=($described) ;;
      *) whole+=($described) ;;
    esac
  done
  _describe -t words word whole
  _describe -t options option valued -S ''
  [[ $files != - ]] || return 0
  [[ $PREFIX != --*=* ]] || compset -P '*='
  if [[ -n $files ]]; then _files -g "(#i)*.($files)(-.)"; else _files; fi
}

# As a file of $fpath, or sourced.
if [[ ${funcstack[1]-} == _luciole ]]; then
  _luciole "$@"
else
  compdef _luciole luciole
fi
)zsh";

constexpr std::string_view kFish = R"fish(function __luciole_offers
    set -l words (commandline -opc)
    set -l current (commandline -ct)
    set -l option (string match -r -- '^--[^=]*=' $current)
    for line in (command $words[1] complete -- $words[2..-1] "$current" 2>/dev/null)
        if not string match -q '/*' -- $line
            string replace -r '=(\t|$)' '$1' -- $line
            continue
        end
        set -l endings (string sub -s 2 -- $line)
        for path in (__fish_complete_path (string replace -r -- '^--[^=]*=' '' "$current"))
            test -z "$endings"; or string match -q -r -i "^[^\t]*(/|\.($endings))(\t|\$)" -- $path; or continue
            echo "$option$path"
        end
    end
end
complete -c luciole -f -a '(__luciole_offers)'
)fish";

const OptionEntry* findOption(const CommandEntry& command, const std::string& name) {
  for (const OptionEntry& option : command.options)
    if (std::find(option.names.begin(), option.names.end(), name) != option.names.end()) return &option;
  return nullptr;
}

const CommandEntry* findInner(const std::vector<CommandEntry>& table, const CommandEntry& command,
                              const std::string& name) {
  const std::string path = command.path.empty() ? name : command.path + " " + name;
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const auto& one) { return one.path == path; });
  return found == table.end() || name.empty() ? nullptr : &*found;
}

/// The lines for a value, or for an argument. before: what of the word comes before it.
std::string offerValues(const OptionEntry& option, const std::string& before = "") {
  std::string lines;
  for (const std::string& choice : option.choices) lines += before + choice + "\n";
  if (option.kind == ValueKind::kScene) lines += fmt::format("/{}\n", fmt::join(kSceneEndings, "|"));
  if (option.kind == ValueKind::kFile) lines += "/\n";
  return lines;
}

std::string offerOptions(const CommandEntry& command) {
  std::string lines;
  for (const OptionEntry& option : command.options)
    for (const std::string& name : option.names) {
      const bool valued = option.kind != ValueKind::kNone && name.starts_with("--");
      lines += fmt::format("{}{}\t{}\n", name, valued ? "=" : "", option.description);
    }
  return lines;
}

/// words: those typed after the program's name; the last one is completed.
std::string offers(const std::vector<CommandEntry>& table, std::vector<std::string> words) {
  const std::string current = words.empty() || words.back() == "=" ? "" : words.back();
  if (!words.empty()) words.pop_back();
  const CommandEntry* command = &table.front();
  const OptionEntry* open = nullptr;  // the option whose value comes next
  std::size_t place = 0;              // of the next argument
  for (const std::string& word : words) {
    if (word == "=") continue;
    if (std::exchange(open, nullptr)) continue;
    const std::string name = word.substr(0, word.find('='));
    if (const OptionEntry* option = findOption(*command, name)) {
      if (option->kind != ValueKind::kNone && name == word) open = option;
    } else if (const CommandEntry* inner = findInner(table, *command, word)) {
      command = inner;
      place = 0;
    } else if (!word.starts_with('-') || word == "-") {
      ++place;
    }
  }
  if (open) return offerValues(*open);
  if (const std::size_t end = current.find('='); current.starts_with("--") && end != std::string::npos) {
    const OptionEntry* option = findOption(*command, current.substr(0, end));
    return option ? offerValues(*option, current.substr(0, end + 1)) : "";
  }
  if (current.starts_with('-')) return offerOptions(*command);
  std::string lines;
  if (place == 0)
    for (const auto& [name, description] : command->commands)
      lines += fmt::format("{}\t{}\n", name, description);
  const std::vector<OptionEntry>& arguments = command->arguments;
  if (place < arguments.size()) return lines + offerValues(arguments[place]);
  return !arguments.empty() && arguments.back().repeatable ? lines + offerValues(arguments.back()) : lines;
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
  command->callback([shell] {
    const std::string head = *shell == "zsh" ? "#compdef luciole\n" : "";
    writeTextFile(
        "-", fmt::format("{}# Completion of luciole {} for {}, made by: luciole completion {}\n\n{}", head,
                         LUCIOLE_VERSION, *shell, *shell,
                         *shell == "bash"  ? kBash
                         : *shell == "zsh" ? kZsh
                                           : kFish));
  });
  CLI::App* complete =
      app.add_subcommand("complete", "what those scripts ask")->group("");  // --help hides it
  auto words = std::make_shared<std::vector<std::string>>();
  complete->add_option("WORD", *words);
  complete->callback([&app, words] { writeTextFile("-", offers(commandTable(app), *words)); });
}

}  // namespace luciole
