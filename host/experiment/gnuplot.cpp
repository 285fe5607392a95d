#include "experiment/gnuplot.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "error.hpp"

extern char** environ;

namespace luciole {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// A nameless file, open for reading and writing, with `content` in it.
File scratchFile(const std::string& content) {
  File file(std::tmpfile());
  if (!file || std::fwrite(content.data(), 1, content.size(), file.get()) != content.size() ||
      std::fflush(file.get()) != 0 || lseek(fileno(file.get()), 0, SEEK_SET) != 0)
    throw MachineError(fmt::format("gnuplot: can't make a temporary file: {}", std::strerror(errno)));
  return file;
}

std::string contentOf(std::FILE* file) {
  std::rewind(file);
  std::string content;
  std::array<char, 65536> part;
  for (std::size_t n; (n = std::fread(part.data(), 1, part.size(), file)) > 0;)
    content.append(part.data(), n);
  return content;
}

/// The first line that says something.
std::string firstLine(const std::string& text) {
  const std::size_t start = text.find_first_not_of(" \n");
  if (start == std::string::npos) return "no reason given";
  return text.substr(start, text.find('\n', start) - start);
}

}  // namespace

void requireGnuplot() { runGnuplot(""); }

std::string runGnuplot(const std::string& script) {
  const File input = scratchFile(script), output = scratchFile(""), complaints = scratchFile("");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(input.get()), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(output.get()), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(complaints.get()), STDERR_FILENO);
  char name[] = "gnuplot", default_settings[] = "-d";
  char* const arguments[] = {name, default_settings, nullptr};
  pid_t process = 0;
  const int failure = posix_spawnp(&process, name, &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure == ENOENT) throw MachineError("gnuplot is needed for a plot; apt-get install gnuplot-nox");
  if (failure != 0) throw MachineError(fmt::format("gnuplot: can't start: {}", std::strerror(failure)));
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw MachineError("gnuplot: " + firstLine(contentOf(complaints.get())));
  return contentOf(output.get());
}

std::string gnuplotString(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') quoted += '\'';
    quoted += static_cast<unsigned char>(c) < ' ' || c == 127 ? '?' : c;
  }
  return quoted + "'";
}

}  // namespace luciole
