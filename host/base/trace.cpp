#include "base/trace.hpp"

#include <atomic>
#include <mutex>
#include <optional>
#include <utility>

#include "base/clock.hpp"

namespace luciole {
namespace {

/// The one of the process.
struct Recorder {
  std::atomic<bool> is_on = false;
  std::mutex mutex;         ///< guards what follows
  Trace trace;              ///< its tracks stay when a trace ends: threads know their own by index
  std::vector<bool> taken;  ///< by track: whether a thread or a device has it now
  int workers = 0;
};

Recorder& recorder() {
  static Recorder one;
  return one;
}

/// The calling thread's track.
thread_local std::optional<std::size_t> own_track;

/// The first track of this name that is free, or a new one. The mutex must be held.
std::size_t takeTrack(Recorder& all, const TraceTrack& track) {
  std::vector<TraceTrack>& tracks = all.trace.tracks;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (all.taken[i] || tracks[i].name != track.name || tracks[i].is_device != track.is_device) continue;
    all.taken[i] = true;
    return i;
  }
  tracks.push_back(track);
  all.taken.push_back(true);
  return tracks.size() - 1;
}

void record(std::optional<std::size_t> track, TraceEvent&& event) {
  Recorder& all = recorder();
  const std::lock_guard lock(all.mutex);
  if (!track && !own_track) own_track = takeTrack(all, {"worker " + std::to_string(++all.workers), false});
  event.track = track ? *track : *own_track;
  all.trace.events.push_back(std::move(event));
}

}  // namespace

void startTrace() {
  Recorder& all = recorder();
  const std::lock_guard lock(all.mutex);
  if (!own_track) own_track = takeTrack(all, {"main", false});
  all.is_on = true;
}

bool isTracing() { return recorder().is_on.load(std::memory_order_relaxed); }

Trace endTrace() {
  Recorder& all = recorder();
  const std::lock_guard lock(all.mutex);
  all.is_on = false;
  return {all.trace.tracks, std::exchange(all.trace.events, {})};
}

void traceEvent(TraceEvent&& event) {
  if (!isTracing()) return;
  const std::size_t track = event.track;
  record(track, std::move(event));
}

void traceEvent(const char* name, const char* category, std::int64_t begin, std::int64_t end) {
  if (isTracing()) record({}, {name, category, 0, begin, end, {}});
}

std::size_t deviceTrack(const std::string& name) {
  Recorder& all = recorder();
  const std::lock_guard lock(all.mutex);
  return takeTrack(all, {name, true});
}

TraceArguments traceArguments(std::initializer_list<TraceArgument> arguments) {
  TraceArguments all;
  for (const auto& [name, value] : arguments) {
    if (const auto* text = std::get_if<std::string_view>(&value))
      all.emplace_back(name, std::string(*text));
    else if (const auto* number = std::get_if<double>(&value))
      all.emplace_back(name, *number);
    else
      all.emplace_back(name, std::get<std::int64_t>(value));
  }
  return all;
}

TraceSpan::TraceSpan(const char* name, std::initializer_list<TraceArgument> arguments)
    : event_{{}, kTracePart, 0, 0, 0, {}}, is_recorded_(isTracing()) {
  if (!is_recorded_) return;
  event_.name = name;
  event_.arguments = traceArguments(arguments);
  event_.begin = nanosecondsSinceStart();
}

TraceSpan::~TraceSpan() {
  if (!is_recorded_ || !isTracing()) return;
  event_.end = nanosecondsSinceStart();
  record({}, std::move(event_));
}

TraceThread::TraceThread(const char* name) : has_track_(isTracing() && !own_track) {
  if (!has_track_) return;
  Recorder& all = recorder();
  const std::lock_guard lock(all.mutex);
  own_track = takeTrack(all, {name, false});
}

TraceThread::~TraceThread() {
  if (!has_track_) return;
  Recorder& all = recorder();
  const std::lock_guard lock(all.mutex);
  all.taken[*own_track] = false;
  own_track.reset();
}

}  // namespace luciole
