#include "tools/bench/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "base/threads.hpp"
#include "lighting/stats.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

/// The caller's environment with some variables set.
std::vector<std::string> changedEnvironment(const Environment& changes) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry; ++entry) {
    const std::string text = *entry;
    const bool changed = std::any_of(changes.begin(), changes.end(), [&](const auto& change) {
      return text.starts_with(change.first + "=");
    });
    if (!changed) all.push_back(text);
  }
  for (const auto& [name, value] : changes) all.push_back(name + "=" + value);
  return all;
}

/// The strings as a null-terminated array for C. They must outlive it.
std::vector<char*> pointersTo(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

struct Ended {
  int status = 0;       ///< as waitpid tells it
  std::string message;  ///< what was said on standard error
};

std::string readAll(int file) {
  std::string text;
  char buffer[4096];
  for (ssize_t got; (got = read(file, buffer, sizeof buffer)) != 0;) {
    if (got > 0) text.append(buffer, std::size_t(got));
    if (got < 0 && errno != EINTR) break;
  }
  return text;
}

Ended runToEnd(const std::string& program, std::vector<std::string> arguments,
               std::vector<std::string> environment) {
  arguments.insert(arguments.begin(), program);
  int message[2];
  if (pipe2(message, O_CLOEXEC) != 0) throw MachineError(fmt::format("no pipe: {}", std::strerror(errno)));
  posix_spawn_file_actions_t streams;
  posix_spawn_file_actions_init(&streams);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO})
    posix_spawn_file_actions_addopen(&streams, stream, "/dev/null", O_RDWR, 0);
  posix_spawn_file_actions_adddup2(&streams, message[1], STDERR_FILENO);
  pid_t child = 0;
  auto lock = holdSignals();
  const int error = posix_spawn(&child, program.c_str(), &streams, nullptr, pointersTo(arguments).data(),
                                pointersTo(environment).data());
  posix_spawn_file_actions_destroy(&streams);
  close(message[1]);
  Ended ended;
  if (error == 0) {
    // Not before it is gone is its folder removed.
    const Cleanup killing([child] {
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
    });
    lock.unlock();
    ended.message = readAll(message[0]);
    while (waitpid(child, &ended.status, 0) < 0 && errno == EINTR) continue;
  }
  close(message[0]);
  if (error != 0) throw MachineError(fmt::format("{}: cannot be run: {}", program, std::strerror(error)));
  return ended;
}

}  // namespace

ScratchFolder::ScratchFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "luciole-XXXXXX").string();
  if (!mkdtemp(pattern.data()))
    throw MachineError(fmt::format("{}: no temporary folder can be made: {}", pattern, std::strerror(errno)));
  path_ = pattern;
  cleanup_.emplace([this] { remove(); });
}

ScratchFolder::~ScratchFolder() {
  remove();
  cleanup_.reset();
}

void ScratchFolder::remove() const {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Environment kernelCacheIn(const ScratchFolder& folder) {
  return {{"POCL_CACHE_DIR", folder / "pocl"}, {"XDG_CACHE_HOME", folder / "other"}};
}

std::vector<std::string> sameThreads() {
  if (!threadLimit()) return {};
  return {"--threads", std::to_string(*threadLimit())};
}

double runChild(const std::string& program, const std::vector<std::string>& arguments,
                const Environment& environment) {
  Ended ended;
  const double milliseconds =
      millisecondsOf([&] { ended = runToEnd(program, arguments, changedEnvironment(environment)); });
  const auto& [status, message] = ended;
  if (status != 0)
    throw MachineError(fmt::format("{} {}: failed with {} {}: {}", program, fmt::join(arguments, " "),
                                   WIFEXITED(status) ? "exit status" : "signal",
                                   WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status),
                                   message.substr(0, message.find('\n'))));
  return milliseconds;
}

}  // namespace luciole
