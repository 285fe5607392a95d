// The manual page and the shells' completions hold what --help shows, and work in groff and in the shells.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using Words = std::set<std::string>;

std::vector<std::string> linesOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

Words wordsOf(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t i = 0; (i = text.find(what, i)) != std::string::npos; i += by.size())
    text.replace(i, what.size(), by);
  return text;
}

/// What --help of a command shows: a line for each command, argument and option, two spaces in.
struct Help {
  std::vector<std::string> commands, arguments;
  Words options;
  std::map<std::string, std::vector<std::string>> choices;  ///< of an option by its name
};

Help parseHelp(const std::string& text) {
  const std::regex command("^  ([a-z][-a-z0-9]*) .*"), argument("^  ([A-Z]+) .*");
  const std::regex option(R"(^  (-[A-Za-z])?,? *(--[a-z][-a-z0-9]*)?( [^{ ]*\{([^}]*)\})?.*)");
  Help help;
  for (const std::string& line : linesOf(text)) {
    std::smatch match;
    if (std::regex_match(line, match, command)) {
      help.commands.push_back(match[1]);
    } else if (std::regex_match(line, match, argument)) {
      help.arguments.push_back(match[1]);
    } else if (line.rfind("  -", 0) == 0 && std::regex_match(line, match, option)) {
      for (const int i : {1, 2}) {
        if (!match[i].matched) continue;
        help.options.insert(match[i]);
        std::istringstream choices(match[4]);
        for (std::string choice; std::getline(choices, choice, ',');)
          help.choices[match[i]].push_back(choice);
      }
    }
  }
  return help;
}

class ManualPage : public ProgramTest {
 protected:
  /// The help of the program, under "", and of each command and each command's commands: "scale merge".
  std::map<std::string, Help> allHelp(const std::string& path = "") {
    std::map<std::string, Help> all;
    const Help help = parseHelp(succeed("luciole " + path + " --help"));
    EXPECT_THAT(help.options, testing::Contains("--help")) << path;
    all[path] = help;
    for (const std::string& inner : help.commands)
      all.merge(allHelp(path.empty() ? inner : path + " " + inner));
    return all;
  }

  /// The page's text without fonts, and its characters as they are printed.
  std::string plainPage() {
    std::string page = succeed("luciole man");
    for (const char* font : {"\\fB", "\\fI", "\\fR", "\\:", "\\&"}) page = replaced(page, font, "");
    for (const auto& [escape, character] : {std::pair("\\-", "-"), {"\\(aq", "'"}, {"\\(rs", "\\"}})
      page = replaced(page, escape, character);
    return page;
  }

  /// A script that the program printed, in a file.
  std::string completion(const std::string& shell) {
    writeText(folder / ("luciole." + shell), succeed("luciole completion " + shell));
    return folder / ("luciole." + shell);
  }

  /// Runs a shell script in the test's folder, for at most two minutes. Shells find the program, but no
  /// settings of the user's, and leave none.
  std::string runScript(const std::string& shell, const std::string& script) {
    writeText(folder / "script", script);
    return succeed(
        "export HOME=$PWD XDG_CONFIG_HOME=$PWD XDG_DATA_HOME=$PWD XDG_CACHE_HOME=$PWD "
        "PATH='" +
        std::filesystem::path(LUCIOLE_BINARY).parent_path().string() + "':\"$PATH\"; timeout 120 " + shell +
        " script");
  }
};

using Completion = ManualPage;

TEST_F(ManualPage, HasEveryCommandArgumentAndOptionOfTheHelp) {
  const std::string page = plainPage();
  const std::map<std::string, Help> all = allHelp();
  EXPECT_GE(all.size(), 13u);
  for (const auto& [path, help] : all) {
    const std::string head = path.empty() ? ".SH OPTIONS\n" : ".SS \"luciole " + path + "\"\n";
    const std::size_t begin = page.find(head);
    ASSERT_NE(begin, std::string::npos) << path;
    const std::string section = page.substr(begin, page.find("\n.S", begin + 1) - begin);
    std::string tags;  // the lines below .TP
    const std::vector<std::string> lines = linesOf(section);
    for (std::size_t i = 1; i < lines.size(); ++i)
      if (lines[i - 1] == ".TP") tags += " " + replaced(lines[i], ", ", " ");
    for (const std::string& option : help.options)
      EXPECT_THAT(wordsOf(tags), testing::Contains(option)) << path;
    for (const std::string& argument : help.arguments)
      EXPECT_THAT(wordsOf(tags), testing::Contains(argument)) << path;
    for (const auto& [option, choices] : help.choices)
      for (const std::string& choice : choices)
        EXPECT_THAT(section, testing::HasSubstr(choice)) << path << " " << option;
  }
}

TEST_F(ManualPage, GivesGroffAndManNothingToWarnOf) {
  LUCIOLE_NEEDS_PROGRAM("groff", "groff-base");
  const Outcome groff = run("luciole man | groff -man -Tutf8 -ww");
  EXPECT_EQ(groff.err, "");
  EXPECT_THAT(groff.out, testing::HasSubstr("luciole render scene.json -o picture.png\n"));
  // Narrower than any terminal that it is read in: no word is too long for a line.
  EXPECT_EQ(told("luciole man | groff -man -Tutf8 -ww -rLL=60n"), "");
  if (!programIsThere("man")) return;
  EXPECT_EQ(told("luciole man > luciole.1 && MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z ./luciole.1"),
            "");
}

TEST_F(ManualPage, ItsExamplesWork) {
  writeText(folder / "scene.json", kSmallScene);
  int examples = 0;
  const std::string page = plainPage();
  for (const std::string& line : linesOf(page.substr(page.find(".SH EXAMPLES")))) {
    if (line.rfind("luciole ", 0) != 0) continue;
    succeed(line);
    ++examples;
  }
  EXPECT_GE(examples, 5);
}

TEST_F(ManualPage, HasEveryEnvironmentVariableThatIsRead) {
  const std::string page = plainPage();
  const std::regex name("\"([A-Z][A-Z0-9_]{3,})\"");
  int variables = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::string(LUCIOLE_SOURCE_DIR) + "/host")) {
    const std::string source = entry.is_regular_file() ? readText(entry.path()) : "";
    if (source.find("getenv(") == std::string::npos) continue;
    for (auto i = std::sregex_iterator(source.begin(), source.end(), name); i != std::sregex_iterator();
         ++i) {
      EXPECT_THAT(page, testing::HasSubstr((*i)[1].str())) << entry.path();
      ++variables;
    }
  }
  EXPECT_GE(variables, 5);
}

TEST_F(Completion, BashOffersWhatTheHelpShows) {
  const std::map<std::string, Help> all = allHelp();
  // A line of answers for each line that is completed.
  std::string script =
      "source '" + completion("bash") +
      "'\nask() { COMP_WORDS=(\"$@\") COMP_CWORD=$(($# - 1)); _luciole; echo \"${COMPREPLY[*]}\"; }\n";
  std::vector<std::pair<std::string, std::vector<std::string>>> expected;
  const auto ask = [&](const std::string& line, const std::vector<std::string>& answers) {
    script += "ask luciole " + line + "\n";
    expected.emplace_back(line, answers);
  };
  for (const auto& [path, help] : all) {
    ask(path + " -", {help.options.begin(), help.options.end()});
    for (const auto& [option, choices] : help.choices) {
      std::vector<std::string> quoted;
      for (const std::string& choice : choices) quoted.push_back(replaced(choice, " ", "\\ "));
      ask(path + " " + option + " ''", quoted);
    }
  }
  ask("''", all.at("").commands);
  ask("re", {"render", "reference", "relight"});
  ask("render --shad", {"--shading", "--shadows", "--shadow-memory", "--shadow-size"});
  ask("render scene.json --shading fl", {"flat"});
  ask("render --shading = ph", {"phong"});  // as bash divides --shading=ph
  ask("render --shading =", {"flat", "gouraud", "phong"});
  ask("bench --only --only", {});  // an option's name is no value
  ask("completion f", {"fish"});
  ask("help dev", {"devices"});
  ask("scale mer", {"merge"});
  ask("scale scene.json mer", {});
  ask("render --samples ''", {});
  for (const char* file : {"first.json", "first.png", "first one.GLB"}) writeText(folder / file, "");
  std::filesystem::create_directory(folder / "first-folder");
  ask("render first", {"first.json", "first one.GLB", "first-folder"});
  ask("compare first.", {"first.json", "first.png"});
  ask("compare first.png first.p", {"first.png"});
  ask("compare first.png first.png first.p", {});
  ask("render 'first\\ o'", {"first one.GLB"});
  ask("render first.json -o first.p", {"first.png"});
  ask("shade g.exr --scene first.", {"first.json"});
  ask("relight in.exr --lights first.", {"first.json"});
  ask("scale merge first.p", {"first.png"});
  ask("scale merge a b first.p", {"first.png"});
  const std::vector<std::string> answers = linesOf(runScript("bash --norc", script));
  ASSERT_EQ(answers.size(), expected.size());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    std::string all_expected;
    for (const std::string& word : expected[i].second) all_expected += " " + word;
    EXPECT_THAT(wordsOf(answers[i]), wordsOf(all_expected)) << expected[i].first;
  }
}

TEST_F(Completion, FishOffersWhatTheHelpShows) {
  LUCIOLE_NEEDS_PROGRAM("fish", "fish");
  EXPECT_EQ(told("fish --no-execute '" + completion("fish") + "'"), "");
  const std::map<std::string, Help> all = allHelp();
  for (const char* file : {"first.json", "first.png"}) writeText(folder / file, "");
  std::string script = "source '" + completion("fish") + "'\n";
  std::vector<std::pair<std::string, Words>> expected;
  const auto ask = [&](const std::string& line, const Words& answers) {
    script += "complete -C\"luciole " + line + "\" | string replace -r '\\t.*' ''\necho ==\n";
    expected.emplace_back(line, answers);
  };
  for (const auto& [path, help] : all) {
    ask(path + " -", help.options);
    for (const auto& [option, choices] : help.choices)
      ask(path + " " + option + " ", {choices.begin(), choices.end()});
  }
  ask("", {all.at("").commands.begin(), all.at("").commands.end()});
  ask("ren", {"render"});
  ask("help dev", {"devices"});
  ask("completion f", {"fish"});
  ask("scale mer", {"merge"});
  ask("render --shading=fl", {"--shading=flat"});
  ask("render --samples first", {});
  ask("devices first", {});
  ask("render first", {"first.json"});
  ask("compare first", {"first.json", "first.png"});
  ask("render first.json -o first", {"first.json", "first.png"});
  ask("shade g.exr --scene first", {"first.json"});
  std::vector<Words> answers(1);
  for (const std::string& line : linesOf(runScript("fish --no-config", script))) {
    if (line == "==")
      answers.emplace_back();
    else
      answers.back().insert(line);
  }
  ASSERT_EQ(answers.size(), expected.size() + 1);
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_THAT(answers[i], expected[i].second) << expected[i].first;
}

TEST_F(Completion, ShellsAreToldWhatTheHelpShows) {
  for (const auto& [path, help] : allHelp()) {
    Words options, valued, first;
    for (const std::string& line : linesOf(succeed("luciole complete -- " + path + " -"))) {
      const std::size_t tab = line.find('\t');
      ASSERT_LT(tab + 1, line.size()) << path << ": no description: " << line;
      const bool takes_value = line[tab - 1] == '=';
      (takes_value ? valued : options).insert(line.substr(0, tab - takes_value));
    }
    for (const auto& [option, choices] : help.choices) {
      EXPECT_TRUE(valued.count(option) || option[1] != '-') << path << " " << option;
      std::string list;
      for (const std::string& choice : choices) list += choice + "\n";
      EXPECT_EQ(succeed("luciole complete -- " + path + " " + option + " ''"), list) << path;
    }
    options.merge(valued);
    EXPECT_EQ(options, help.options) << path;
    for (const std::string& line : linesOf(succeed("luciole complete -- " + path + " ''")))
      if (line.find('\t') != std::string::npos) first.insert(line.substr(0, line.find('\t')));
    EXPECT_EQ(first, Words(help.commands.begin(), help.commands.end())) << path;
  }
}

TEST_F(Completion, ZshCompletesLinesThatAreTyped) {
  LUCIOLE_NEEDS_PROGRAM("zsh", "zsh");
  const std::string script = completion("zsh");
  EXPECT_EQ(told("zsh -n '" + script + "'"), "");
  for (const char* file : {"first.json", "first.png"}) writeText(folder / file, "");
  // A shell on a terminal, into which lines with tabs are typed. Its program tells what it is called with.
  std::string session =
      "zmodload zsh/zpty\nzpty shell zsh -f -i\nzpty -w shell \"PS1=; autoload -U compinit; compinit -D -u; "
      "source " +
      script + "; luciole() { print -r -- called \\\"\\$*\\\" }\"\n";
  std::string expected;
  for (const auto& [typed, completed] : {std::pair("ren\\t", "render"),
                                         {"render fir\\t", "render first.json"},
                                         {"compare first.p\\t", "compare first.png"},
                                         {"render --shading fl\\t", "render --shading flat"},
                                         {"render --exp\\t4", "render --exposure=4"},
                                         {"bench --only man\\t", "bench --only many lights"},
                                         {"scale mer\\t-", "scale merge -"},
                                         {"scale first.j\\t--che\\t9", "scale first.json --check-pixels=9"},
                                         {"scale merge --pl\\tx", "scale merge --plot=x"},
                                         {"help dev\\t", "help devices"},
                                         {"completion f\\t", "completion fish"}}) {
    session += std::string("zpty -w shell $'luciole ") + typed + "'\n";
    expected += std::string("called ") + completed + "\n";
  }
  session += "zpty -w shell exit\nwhile zpty -r shell line; do print -rn -- $line; done\n";
  std::string called;
  for (std::string line : linesOf(runScript("zsh -f", session))) {
    line = replaced(line, "\r", "");
    while (!line.empty() && line.back() == ' ') line.pop_back();
    if (line.rfind("called ", 0) == 0) called += line + "\n";
  }
  EXPECT_EQ(called, expected);
}

}  // namespace
}  // namespace luciole::test
