#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/write_file.hpp"
#include "tools/cli/command_table.hpp"
#include "tools/cli/commands.hpp"

namespace luciole {
namespace {

using Terms = std::vector<std::pair<const char*, const char*>>;

constexpr const char* kManualParagraphs[] = {
    "A SCENE is a Luciole scene (.json), an .obj with its .mtl, a .gltf or a .glb file. One without a camera "
    "or "
    "lights is framed and lit so that its first picture shows something.",
    "A file appears whole or not at all, in the place that its symbolic links lead to. A FIFO, a device or "
    "standard output gets it as it comes. Where an option says so, - is standard input or output.",
    "An error is one line that names the file, the place in it and what was expected. A misspelt command, "
    "option "
    "or choice gets a suggestion."};

const Terms kManualStatuses{
    {"0", "done"},
    {"1", "a comparison failed: a limit of compare was passed, or devices --check found other bits"},
    {"2", "the input or the arguments are wrong"},
    {"3", "the machine can't: no OpenCL device, no more memory, a full disk"}};

const Terms kManualVariables{
    {"SLURM_ARRAY_TASK_ID, SLURM_ARRAY_TASK_COUNT, SLURM_ARRAY_TASK_MIN, SLURM_ARRAY_TASK_MAX, "
     "SLURM_ARRAY_TASK_STEP",
     "in a task of a Slurm job array, which part of the frames or points is this task's, unless --shard says "
     "it"},
    {"SLURM_STEP_NUM_TASKS", "must not be more than 1 then: several processes would do the same part"},
    {"XDG_DATA_HOME, HOME, XDG_DATA_DIRS",
     "in the folders fonts of these places DejaVuSans.ttf is looked for, which labels are drawn with"},
    {"PATH", "where the programs ffmpeg, which makes films, and oclgrind, for check-model, are looked for"},
    {"POCL_CACHE_DIR", "read by PoCL: where it keeps the kernels that it compiled"},
    {"POCL_KERNEL_CACHE", "read by PoCL: 0 lets it keep none"},
    {"LUCIOLE_HELPERS",
     "0: no process but the command's own compiles kernels. Otherwise another may compile some of them "
     "meanwhile, and the first picture is made by a general program, or by kernels that are compiled in a "
     "third of the time, with the same bits, but run slower: then one compiles the fast ones when the "
     "command has ended, at the lowest priority, for some seconds"},
    {"LUCIOLE_OPTIMIZE",
     "0: PoCL optimizes no kernels. Most are compiled in a third to half of the time, with the same bits, "
     "but run slower: for many small pictures with kernels of their own, as tests make them"},
    {"LUCIOLE_GENERAL",
     "1: pictures are lit by a general program wherever it can, with the same bits, in 1.1 to 1.6 times the "
     "time: for many pictures of scenes that differ, which then share what is compiled"},
    {"XDG_CACHE_HOME, HOME", "the folder of caches is the first, or .cache in the second"},
    {"OCL_ICD_VENDORS", "read by the OpenCL loader: where it looks for devices' drivers"}};

const Terms kManualFiles{
    {"~/.cache/pocl/kcache",
     "kernels that PoCL compiled; without them the next start takes a second longer. luciole-programs there "
     "lists those of this program"},
    {"~/.cache/luciole/programs", "kernels of platforms that don't keep them themselves, at most 64 MiB"},
    {"~/.cache/luciole/checks", "for each device and driver, whether it computes as every other does"},
    {".NAME.lock",
     "beside frames that several runs share: which frames are being made; the last run to end removes it"}};

/// In the order in which they can be tried, with a file scene.json at hand.
const Terms kManualExamples{
    {"A picture, and one with smooth edges and soft shadows that keeps all of its range:",
     "luciole render scene.json -o picture.png\n"
     "luciole render scene.json --samples 4 --shadows soft -o soft.exr"},
    {"A picture a frame:", "luciole render scene.json --frames 1-4 -o 'frame.####.png'"},
    {"How wrong a picture is, pixel by pixel:",
     "luciole reference scene.json -o truth.exr\n"
     "luciole render scene.json -o ours.exr\n"
     "luciole compare truth.exr ours.exr --error-map error.png"},
    {"A G-buffer, lit later:",
     "luciole gbuffer scene.json -o surfaces.exr\n"
     "luciole shade surfaces.exr --scene scene.json --exposure 1 -o brighter.png"},
    {"Another program's picture, lit again by its layers:",
     "luciole relight surfaces.exr --lights scene.json -o again.png"},
    {"Groups of lights weighed anew, without shading:",
     "luciole render scene.json --light-groups -o groups.exr\n"
     "luciole mix groups.exr --light-mixer rest=0.5 -o mixed.png"},
    {"A thousand lights in what the camera sees:",
     "luciole generate lights scene.json --count 1000 -o many.json\n"
     "luciole render many.json -o many.png"}};

/// The code point whose UTF-8 starts at text[i]. Moves i to its last byte.
unsigned codePointAt(std::string_view text, std::size_t& i) {
  const unsigned first = (unsigned char)text[i];
  const std::size_t more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : 1;
  unsigned code = first & (0x3fu >> more);
  for (std::size_t k = 0; k < more && i + 1 < text.size(); ++k)
    code = code << 6 | ((unsigned char)text[++i] & 0x3fu);
  return code;
}

/// Text that roff prints as it is. Lists without spaces may be broken after their separators.
std::string roff(std::string_view text) {
  std::string escaped;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if ((unsigned char)c >= 0x80) {
      escaped += fmt::format("\\[u{:04X}]", codePointAt(text, i));
      continue;
    }
    switch (c) {
      case '\\':
        escaped += "\\(rs";
        break;
      case '-':
        escaped += "\\-";
        break;
      case '\'':
        escaped += "\\(aq";
        break;
      case '"':
        escaped += "\\(dq";
        break;
      case '`':
        escaped += "\\(ga";
        break;
      case '^':
        escaped += "\\(ha";
        break;
      case '~':
        escaped += "\\(ti";
        break;
      case '.':
        escaped += escaped.empty() ? "\\&." : ".";
        break;  // at the start of a line it would be a request
      case '\n':
        escaped += ' ';
        break;
      default:
        escaped += c;
    }
    const bool separates = c == ',' || c == '|' || c == '/';
    if (separates && i + 1 < text.size() && text[i + 1] != ' ') escaped += "\\:";
  }
  return escaped;
}

std::string boldRoff(std::string_view text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italicRoff(std::string_view text) { return "\\fI" + roff(text) + "\\fR"; }

/// Whether the choices stand beside the option's name, where others have what their value is called.
bool showsChoices(const OptionEntry& option) {
  return !option.names.empty() && !option.choices.empty() &&
         fmt::format("{}", fmt::join(option.choices, "|")).size() <= 40;
}

std::string roffValue(const OptionEntry& option) {
  return (showsChoices(option) ? boldRoff(fmt::format("{}", fmt::join(option.choices, "|")))
                               : italicRoff(option.value)) +
         (option.repeatable ? " ..." : "");
}

/// What --help says in brackets and capitals, in words.
std::string remarksOn(const OptionEntry& option) {
  std::vector<std::string> remarks;
  const std::string choices = fmt::format("{}", fmt::join(option.choices, ", "));
  if (!choices.empty() && !showsChoices(option) && option.description.find(choices) == std::string::npos)
    remarks.push_back("one of " + choices);
  if (!option.limits.empty()) remarks.push_back(option.limits);
  if (!option.standard.empty()) remarks.push_back("default: " + option.standard);
  if (!option.needs.empty()) remarks.push_back(fmt::format("needs {}", fmt::join(option.needs, ", ")));
  if (!option.excludes.empty())
    remarks.push_back(fmt::format("not with {}", fmt::join(option.excludes, ", ")));
  if (option.required && !option.names.empty()) remarks.push_back("required");
  return remarks.empty() ? "" : fmt::format("({})", fmt::join(remarks, "; "));
}

std::string roffOption(const OptionEntry& option) {
  std::string tag;
  for (const std::string& name : option.names) tag += (tag.empty() ? "" : ", ") + boldRoff(name);
  if (!option.value.empty()) tag += (tag.empty() ? "" : " ") + roffValue(option);
  const std::string remarks = remarksOn(option);
  const std::string separator = option.description.empty() || remarks.empty() ? "" : " ";
  const std::string text = roff(option.description + separator + remarks);
  return fmt::format(".TP\n{}\n{}{}", tag, text, text.empty() ? "" : "\n");
}

/// The command with what it demands: luciole render SCENE -o TEXT [options].
std::string roffUsage(const CommandEntry& command) {
  std::string usage = boldRoff(command.path.empty() ? "luciole" : "luciole " + command.path);
  for (const OptionEntry& argument : command.arguments)
    usage += argument.required ? " " + roffValue(argument) : " [" + roffValue(argument) + "]";
  bool has_more = false;
  for (const OptionEntry& option : command.options) {
    if (option.required) usage += fmt::format(" {} {}", boldRoff(option.names.front()), roffValue(option));
    has_more |= !option.required && option.names.back() != "--help";
  }
  return usage + (has_more ? fmt::format(" [{}]", italicRoff("options")) : "");
}

std::string roffTerms(const Terms& terms) {
  std::string text;
  for (const auto& [term, meaning] : terms)
    text += fmt::format(".TP\n{}\n{}\n", boldRoff(term), roff(meaning));
  return text;
}

/// Lines that stay apart.
std::string roffLines(std::string_view lines) {
  std::string text;
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    text += roff(lines.substr(0, end)) + "\n";
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  return text;
}

std::string roffExamples() {
  std::string text;
  for (const auto& [what, lines] : kManualExamples)
    text += fmt::format(".PP\n{}\n.PP\n.RS 4\n.EX\n{}.EE\n.RE\n", roff(what), roffLines(lines));
  return text;
}

/// The page in the man macros (man 7 man). It has no date, so that one version always makes the same page.
std::string manualPage(const std::vector<CommandEntry>& table) {
  std::string page = ".TH LUCIOLE 1 \"\" \"luciole " + roff(LUCIOLE_VERSION) + "\" \"User Commands\"\n";
  // No hyphens, and no even margin: a long word among a line's few leaves no even gaps. groff 1.23's macros
  // set the adjustment anew at each paragraph, to what the string AD says.
  page += ".nh\n.ds AD l\n.ad l\n";
  page += ".SH NAME\nluciole \\- light scenes of very many lights on any OpenCL device\n.SH SYNOPSIS\n";
  for (const CommandEntry& command : table)
    if (command.commands.empty() || !command.arguments.empty()) page += roffUsage(command) + "\n.br\n";
  page += fmt::format(".SH DESCRIPTION\n{}\n", roff(table.front().description));
  for (const char* paragraph : kManualParagraphs) page += fmt::format(".PP\n{}\n", roff(paragraph));
  page += ".SH OPTIONS\n";
  for (const OptionEntry& option : table.front().options) page += roffOption(option);
  page += ".SH COMMANDS\n";
  for (const CommandEntry& command : table) {
    if (command.path.empty()) continue;
    page += fmt::format(".SS \"luciole {}\"\n{}\n", roff(command.path), roff(command.description));
    for (const OptionEntry& argument : command.arguments) page += roffOption(argument);
    for (const auto& [name, description] : command.commands)
      page += fmt::format(".TP\n{}\n{}\n", boldRoff(name), roff(description));
    for (const OptionEntry& option : command.options) page += roffOption(option);
    if (!command.footer.empty()) page += fmt::format(".PP\n.EX\n{}.EE\n", roffLines(command.footer));
  }
  page += ".SH EXIT STATUS\n" + roffTerms(kManualStatuses);
  page += ".SH ENVIRONMENT\n" + roffTerms(kManualVariables);
  page += ".SH FILES\n" + roffTerms(kManualFiles);
  page += ".SH EXAMPLES\n" + roffExamples();
  page += ".SH SEE ALSO\n.BR clinfo (1),\n.BR ffmpeg (1),\n.BR oiiotool (1)\n";
  return page;
}

}  // namespace

void addManCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("man", "all of this as a manual page: luciole man | man -l -");
  command->callback([&app] { writeTextFile("-", manualPage(commandTable(app))); });
}

}  // namespace luciole
