#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

/// What the process did when, in which thread and on the device: recorded from startTrace() on, for --trace.
/// Any thread may record. Without a trace nothing is recorded, and nothing allocated.
namespace luciole {

/// A line of the picture that a trace makes: a thread, or a device's queue. What lies on it nests or doesn't
/// overlap.
struct TraceTrack {
  std::string name;
  bool is_device = false;
};

using TraceArguments = std::vector<std::pair<std::string, std::variant<std::int64_t, double, std::string>>>;

/// Something that was done. Times are nanosecondsSinceStart().
struct TraceEvent {
  std::string name;
  const char* category;  ///< one of the three below
  std::size_t track;     ///< index into Trace::tracks
  std::int64_t begin, end;
  TraceArguments arguments{};  ///< what else it tells
};

/// Categories of events: a stage as --stats has it, a part of one, and a command of a device.
inline constexpr const char *kTraceStage = "stage", *kTracePart = "part", *kTraceDevice = "device";

struct Trace {
  std::vector<TraceTrack> tracks;
  std::vector<TraceEvent> events;  ///< in the order in which they ended
};

/// A part of TraceArguments that allocates nothing, as long as what it names lives.
struct TraceArgument {
  const char* name;
  std::variant<std::int64_t, double, std::string_view> value;
};

/// Starts recording. The calling thread's track is "main"; those of threads that no TraceThread names are
/// "worker 1", "worker 2" … in the order in which they first record.
void startTrace();

/// Whether what happens is recorded.
bool isTracing();

/// Ends recording and gives what was recorded.
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

/// Names the calling thread's track as long as it lives. Threads of one name that don't live at once share a
/// track, so that a film has not one for each frame.
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
