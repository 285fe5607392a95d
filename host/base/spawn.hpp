#pragma once

#include <spawn.h>
#include <sys/types.h>

#include <string>
#include <vector>

namespace luciole {

/// The file that PATH leads to for a program's name; empty where there is none.
std::string programFile(const std::string& name);

/// Starts a program file in a process of its own. It takes signals, whatever this process does with them.
/// arguments: the first is its name. flags: more of posix_spawnattr_setflags. Sets `child`. Returns 0, or the
/// error's number.
int spawnProgram(const std::string& path, std::vector<std::string> arguments,
                 const posix_spawn_file_actions_t& actions, short flags, pid_t& child);

}  // namespace luciole
