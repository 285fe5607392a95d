#pragma once

namespace luciole {

/// From here on SIGHUP, SIGINT and SIGTERM, those that the process isn't told to ignore, end it in order, at
/// once, whatever it is doing: nothing is left of files that aren't whole (base/cleanup.hpp), an error says
/// which signal it was, and the event log ends. The exit status is 128 + the signal's number, as shells have
/// it; after SIGINT they also see that it was that, and stop their own loops. To be called before any thread
/// is started but after startEventLog().
void awaitSignals();

/// The process ends by itself: a signal changes nothing any more. If one came before, this doesn't return.
void ignoreSignals();

}  // namespace luciole
