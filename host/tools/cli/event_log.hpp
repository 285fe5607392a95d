#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string_view>

namespace luciole {

/// The fields of an event besides its time and name, in order.
using EventFields = nlohmann::ordered_json;

/// Writes to standard error by as few system calls as it takes, one as a rule, so that the lines of several
/// processes that share a file stay whole. What can't be written is lost. Takes no memory.
void writeError(std::string_view text) noexcept;

/// Adds the option --log to a command.
CLI::Option* addLogOption(CLI::App& command);

/// Whether a command line has --log json. Called before it is parsed, so that errors of parsing are events,
/// too.
bool asksForEvents(int argument_count, char** arguments);

/// From here on standard error gets events alone, each a line of JSON; see logEvent().
void startEventLog();

/// Whether startEventLog() was called.
bool logsEvents();

/// Writes an event at once: {"time": "2026-01-31T12:34:56.789Z", "event": name, and the fields}. Bytes of a
/// text that are no UTF-8 become U+FFFD. Without an event log it does nothing.
void logEvent(const char* name, const EventFields& fields = EventFields::object());

/// Writes the last event, `end`, with the status that the process will have. Later calls of logEvent() block
/// for ever.
void logEnd(int status) noexcept;

/// Milliseconds rounded to the microsecond, as in events.
double eventMilliseconds(double milliseconds);

/// Writes the event `error` of a process that ends at once, taking no memory.
void logFailure(const char* message, int status) noexcept;

}  // namespace luciole
