#pragma once

namespace luciole {

/// From now on SIGHUP, SIGINT and SIGTERM, unless they are ignored, end the process at once but cleanly:
/// incomplete files are removed (base/cleanup.hpp), an error names the signal, and the event log ends. The
/// exit status is 128 + the signal's number. After SIGINT the process ends by that signal, so that shells
/// stop their loops. Call it before any thread is started but after startEventLog().
void awaitSignals();

/// The process ends now: signals are ignored from here on. Doesn't return if one came before.
void ignoreSignals();

}  // namespace luciole
