#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "base/did_you_mean.hpp"

namespace luciole {

/// A validator that accepts these names only, and suggests one of them for others.
CLI::Validator oneOf(const std::vector<std::string>& names);

/// Explains why the command line couldn't be parsed: " COMMAND: " and the first argument that the command
/// doesn't take, with a suggestion. Empty if no argument is left over, so that something else is wrong.
std::string describeUnexpected(const CLI::App& app);

}  // namespace luciole
