#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

/// A timeline of the process's threads and devices, recorded from startTrace() to endTrace(), for --trace.
/// Any thread may record. Otherwise nothing is recorded or allocated.
namespace luciole {

/// A track of the timeline: a thread, or a device's queue. Its events are nested or don't overlap.
struct TraceTrack {
  std::string name;
  bool is_device = false;
};

using TraceArguments = std::vector<std::pair<std::string, std::variant<std::int64_t, double, std::string>>>;

/// An event of a track. Times are nanosecondsSinceStart().
struct TraceEvent {
  std::string name;
  const char* category;  ///< one of the three below
  std::size_t track;     ///< index into Trace::tracks
  std::int64_t begin, end;
  TraceArguments arguments{};  ///< further details
};

/// Categories of events: a stage as --stats has it, a part of one, and a command of a device.
inline constexpr const char *kTraceStage = "stage", *kTracePart = "part", *kTraceDevice = "device";

struct Trace {
  std::vector<TraceTrack> tracks;
  std::vector<TraceEvent> events;  ///< in the order in which they ended
};

/// An argument that allocates nothing. It refers to its texts.
struct TraceArgument {
  const char* name;
  std::variant<std::int64_t, double, std::string_view> value;
};

/// Starts recording. The calling thread's track is "main"; those of threads that no TraceThread names are
/// "worker 1", "worker 2" … in the order in which they first record.
void startTrace();

/// Whether events are recorded now.
bool isTracing();

/// Ends recording and returns the trace.
Trace endTrace();

/// Records an event on its track.
void traceEvent(TraceEvent&& event);
/// Records an event of the calling thread, from `begin` to `end`.
void traceEvent(const char* name, const char* category, std::int64_t begin, std::int64_t end);

/// A new track for a device of this name.
std::size_t deviceTrack(const std::string& name);

TraceArguments traceArguments(std::initializer_list<TraceArgument> arguments);

/// Records the time from its construction to its destruction, as a part of a stage.
class TraceSpan {
 public:
  explicit TraceSpan(const char* name, std::initializer_list<TraceArgument> arguments = {});
  ~TraceSpan();
  TraceSpan(const TraceSpan&) = delete;
  TraceSpan& operator=(const TraceSpan&) = delete;

 private:
  TraceEvent event_;
  bool is_recorded_;
};

/// Names the calling thread's track during its lifetime. Threads of one name whose lifetimes don't overlap
/// share a track, so that a film doesn't get one for each frame.
class TraceThread {
 public:
  explicit TraceThread(const char* name);
  ~TraceThread();
  TraceThread(const TraceThread&) = delete;
  TraceThread& operator=(const TraceThread&) = delete;

 private:
  bool has_track_;
};

}  // namespace luciole
