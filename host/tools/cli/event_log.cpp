#include "tools/cli/event_log.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <mutex>
#include <string>
#include <string_view>

#include "base/clock.hpp"
#include "base/dump_utf8.hpp"
#include "tools/cli/suggest.hpp"

namespace luciole {
namespace {

bool is_logging = false;

/// Of whoever writes an event.
std::mutex writing;

/// The time as ISO 8601 has it, in UTC, to the millisecond.
std::array<char, 80> timeText() {
  std::timespec now{};
  std::timespec_get(&now, TIME_UTC);
  std::tm parts{};
  gmtime_r(&now.tv_sec, &parts);
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02d-%02dT%02d:%02d:%02d.%03dZ", parts.tm_year + 1900,
                parts.tm_mon + 1, parts.tm_mday, parts.tm_hour, parts.tm_min, parts.tm_sec,
                int(now.tv_nsec / 1'000'000));
  return text;
}

}  // namespace

void writeError(std::string_view text) noexcept {
  while (!text.empty()) {
    const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    text.remove_prefix(std::size_t(written));
  }
}

CLI::Option* addLogOption(CLI::App& command) {
  return command
      .add_option_function<std::string>(
          "--log", [](const std::string&) {},
          "json: tell on standard error what happens as lines of JSON, and nothing else")
      ->check(oneOf({"json"}));
}

bool asksForEvents(int argument_count, char** arguments) {
  for (int i = 1; i < argument_count; ++i) {
    const std::string_view argument = arguments[i];
    if (argument == "--log=json") return true;
    if (argument == "--log" && i + 1 < argument_count && !std::strcmp(arguments[i + 1], "json")) return true;
  }
  return false;
}

void startEventLog() { is_logging = true; }

bool logsEvents() { return is_logging; }

void logEvent(const char* name, const EventFields& fields) {
  if (!is_logging) return;
  EventFields event{{"time", timeText().data()}, {"event", name}};
  event.update(fields);
  const std::string line = dumpUtf8(std::move(event)) + "\n";
  const std::lock_guard lock(writing);
  writeError(line);
}

double eventMilliseconds(double milliseconds) { return std::round(milliseconds * 1000) / 1000; }

void logEnd(int status) noexcept {
  if (!is_logging) return;
  std::array<char, 200> line{};
  writing.lock();
  const int length = std::snprintf(line.data(), line.size(),
                                   R"({"time":"%s","event":"end","status":%d,"milliseconds":%.3f})"
                                   "\n",
                                   timeText().data(), status, millisecondsSinceStart());
  writeError({line.data(), std::size_t(length)});
}

void logFailure(const char* message, int status) noexcept {
  std::array<char, 200> text{};  // without what JSON would have to escape
  for (std::size_t i = 0; i + 1 < text.size() && message[i]; ++i)
    text[i] = message[i] == '"' || message[i] == '\\' || static_cast<unsigned char>(message[i]) < ' '
                  ? '\''
                  : message[i];
  std::array<char, 400> line{};
  const int length = std::snprintf(line.data(), line.size(),
                                   R"({"time":"%s","event":"error","message":"%s","status":%d})"
                                   "\n",
                                   timeText().data(), text.data(), status);
  writeError({line.data(), std::size_t(length)});
}

}  // namespace luciole
