#include "tools/cli/trace_json.hpp"

#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>
#include <variant>

#include "base/dump_utf8.hpp"

namespace luciole {
namespace {

using TraceJson = nlohmann::ordered_json;

constexpr int kHost = 1, kDevice = 1000;  ///< processes

int processOf(const TraceTrack& track) { return track.is_device ? kDevice : kHost; }

/// A track's number. That of the process, 1, makes it the main thread, which the first is.
std::size_t threadOf(std::size_t track) { return track + 1; }

TraceJson metadata(const char* name, int process, std::size_t thread, const TraceJson& arguments) {
  return {{"name", name}, {"ph", "M"}, {"pid", process}, {"tid", thread}, {"args", arguments}};
}

double microseconds(std::int64_t nanoseconds) { return double(nanoseconds) / 1000; }

TraceJson eventJson(const TraceEvent& event, const TraceTrack& track) {
  TraceJson json{{"name", event.name},
                 {"cat", event.category},
                 {"ph", "X"},
                 {"ts", microseconds(event.begin)},
                 {"dur", microseconds(event.end - event.begin)},
                 {"pid", processOf(track)},
                 {"tid", threadOf(event.track)}};
  for (const auto& [name, value] : event.arguments)
    std::visit([&json, &key = name](const auto& one) { json["args"][key] = one; }, value);
  return json;
}

}  // namespace

std::string traceJson(const Trace& trace, const std::string& command) {
  TraceJson events = TraceJson::array();
  events.push_back(metadata("process_name", kHost, 0, {{"name", "luciole"}}));
  events.push_back(metadata("process_name", kDevice, 0, {{"name", "device"}}));
  for (std::size_t i = 0; i < trace.tracks.size(); ++i) {
    const int process = processOf(trace.tracks[i]);
    events.push_back(metadata("thread_name", process, threadOf(i), {{"name", trace.tracks[i].name}}));
    events.push_back(metadata("thread_sort_index", process, threadOf(i), {{"sort_index", i}}));
  }
  for (const TraceEvent& event : trace.events) events.push_back(eventJson(event, trace.tracks[event.track]));
  TraceJson json;
  json["traceEvents"] = std::move(events);
  json["displayTimeUnit"] = "ms";
  json["otherData"] = {{"version", LUCIOLE_VERSION}, {"command", command}};
  return dumpUtf8(std::move(json)) + "\n";
}

}  // namespace luciole
