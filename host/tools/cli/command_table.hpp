#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

namespace luciole {

/// The kind of an option's value, for completion.
enum class ValueKind {
  kNone,    ///< there is none: a flag
  kWord,    ///< a number, or other text without a list of choices
  kChoice,  ///< one of OptionEntry::choices
  kScene,   ///< a scene file
  kFile     ///< any file or folder
};

/// An option, or an argument that has a place instead of a name.
struct OptionEntry {
  std::vector<std::string> names;  ///< "-o", "--output"; none for an argument
  std::string value;               ///< what --help calls the value, such as TEXT or SCENE; empty for a flag
  ValueKind kind = ValueKind::kNone;
  std::vector<std::string> choices;
  std::string limits;    ///< "1 to 1024", or what else a validator says of itself; may be empty
  std::string standard;  ///< the default; may be empty
  std::string description;
  std::vector<std::string> needs, excludes;  ///< names of other options
  bool required = false, repeatable = false;
};

/// A command, or a command's command. The program itself is one too.
struct CommandEntry {
  std::string path;  ///< "render", "scale merge"; empty for the program
  std::string description, footer;
  std::vector<OptionEntry> arguments, options;
  std::vector<std::pair<std::string, std::string>> commands;  ///< names and descriptions of those inside
};

/// The endings of scene files, without the dot.
inline const std::vector<std::string> kSceneEndings{"json", "obj", "gltf", "glb"};

/// Everything that --help of the program and of its commands shows, in its order: the program itself first,
/// each command before those inside it.
std::vector<CommandEntry> commandTable(const CLI::App& program);

}  // namespace luciole
