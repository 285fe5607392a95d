// --trace: the file that Perfetto and chrome://tracing open, held against the Trace Event Format and against
// --stats of the same run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using nlohmann::json;

/// A complete event, in nanoseconds.
struct Span {
  std::string name, category, track;  ///< track: its process's name and its own
  std::int64_t begin, end;
  json arguments;

  bool holds(const Span& other) const { return begin <= other.begin && other.end <= end; }
};

/// The complete events of a trace. Expects what the format demands: every event is a complete one or
/// metadata, with the members and the types that it has to have, and every process and thread has a name.
std::vector<Span> spansOf(const json& trace) {
  std::map<json, std::string> processes, threads;
  for (const json& event : trace.at("traceEvents")) {
    EXPECT_TRUE(event.at("name").is_string()) << event;
    EXPECT_TRUE(event.at("pid").is_number_integer() && event.at("tid").is_number_integer()) << event;
    if (event.at("ph") != "M") {
      EXPECT_EQ(event.at("ph"), "X") << event;
      continue;
    }
    if (event["name"] == "process_name") processes[event["pid"]] = event.at("args").at("name");
    if (event["name"] == "thread_name") threads[{event["pid"], event["tid"]}] = event.at("args").at("name");
    if (event["name"] == "thread_sort_index") {
      EXPECT_TRUE(event.at("args").at("sort_index").is_number_integer());
    }
  }
  std::vector<Span> spans;
  for (const json& event : trace["traceEvents"]) {
    if (event["ph"] != "X") continue;
    const double begin = event.at("ts"), length = event.at("dur");
    EXPECT_GE(begin, 0) << event;
    EXPECT_GE(length, 0) << event;
    EXPECT_TRUE(!event.contains("args") || event["args"].is_object()) << event;
    EXPECT_TRUE(processes.count(event["pid"]) && threads.count({event["pid"], event["tid"]})) << event;
    const std::int64_t first = std::llround(1000 * begin);
    spans.push_back({event["name"], event.at("cat"),
                     processes[event["pid"]] + "/" + threads[{event["pid"], event["tid"]}], first,
                     first + std::llround(1000 * length), event.value("args", json::object())});
  }
  return spans;
}

/// Expects that events of a track nest or don't overlap.
void expectNested(std::vector<Span> spans) {
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) {
    return std::tuple(a.track, a.begin, -a.end) < std::tuple(b.track, b.begin, -b.end);
  });
  std::vector<Span> open;
  for (const Span& span : spans) {
    while (!open.empty() && (open.back().track != span.track || open.back().end <= span.begin))
      open.pop_back();
    if (!open.empty()) {
      EXPECT_TRUE(open.back().holds(span))
          << open.back().name << " and " << span.name << " on " << span.track;
    }
    open.push_back(span);
  }
}

/// Stages in which a kernel runs.
const std::map<std::string, std::set<std::string>> kStagesOfKernels{{"find_lights", {"cull", "count lights"}},
                                                                    {"scan_lists", {"cull", "count lights"}},
                                                                    {"count_in_range", {"count lights"}},
                                                                    {"beam_shadows", {"beam shadows"}},
                                                                    {"shade", {"shade"}}};

/// Expects each kernel within one of its stages, and commands between their queueing and their end.
void expectKernelsInStages(const std::vector<Span>& spans, const std::set<std::string>& kernels) {
  std::set<std::string> found;
  for (const Span& span : spans) {
    if (span.category != "device") continue;
    EXPECT_EQ(span.track.rfind("device/", 0), 0u) << span.track;
    const double queued = span.arguments.at("queued_us"), submitted = span.arguments.at("submitted_us");
    EXPECT_LE(queued, submitted);
    EXPECT_LE(submitted, double(span.begin) / 1000);
    EXPECT_GE(span.arguments.at("clock_error_us"), 0);
    const auto stages = kStagesOfKernels.find(span.name);
    if (stages == kStagesOfKernels.end()) {
      EXPECT_GT(span.arguments.at("bytes"), 0) << span.name;
      continue;
    }
    found.insert(span.name);
    EXPECT_GT(span.arguments.at("work_items"), 0);
    EXPECT_TRUE(span.arguments.at("defines").is_string());
    EXPECT_TRUE(std::any_of(spans.begin(), spans.end(),
                            [&](const Span& stage) {
                              return stage.category == "stage" && stages->second.count(stage.name) &&
                                     stage.holds(span);
                            }))
        << span.name << " from " << span.begin << " to " << span.end;
  }
  EXPECT_EQ(found, kernels);
}

/// Expects the stages of the statistics, and their time, in the trace.
void expectStages(const std::vector<Span>& spans, const std::vector<json>& stats) {
  std::map<std::string, double> told;
  for (const json& one : stats)
    for (const json& stage : one["stages"]) told[stage["name"]] += stage["milliseconds"].get<double>();
  EXPECT_FALSE(told.empty());
  std::map<std::string, std::int64_t> traced;
  std::map<std::string, int> count;
  for (const Span& span : spans) {
    // Compiling runs the stages on one tile of nothing, which are no work on the picture.
    const bool compiles = span.track == "luciole/kernel compiler" && span.name != "compile kernels";
    if (span.category != "stage" || compiles) continue;
    traced[span.name] += span.end - span.begin;
    ++count[span.name];
  }
  for (const auto& [name, milliseconds] : told) {
    // Both are sums of the same whole nanoseconds: half a step of the clock each is more than they round.
    EXPECT_NEAR(1e-6 * double(traced[name]), milliseconds, 0.5e-6 * count[name]) << name;
  }
  EXPECT_EQ(traced.size(), told.size());
}

class TraceOption : public ProgramTest {
 protected:
  TraceOption() { writeText(folder / "scene.json", kSmallScene); }

  json parsed(const std::string& file) { return json::parse(readText(folder / file)); }

  /// The trace of a command, after what holds for every trace was expected of it.
  std::vector<Span> traceOf(const std::string& line, const std::vector<std::string>& stats,
                            const std::set<std::string>& kernels) {
    const std::string whole = "luciole " + line + " --trace trace.json";
    EXPECT_EQ(told(whole), "");
    const json trace = parsed("trace.json");
    EXPECT_EQ(trace.at("otherData").at("command"), whole);
    EXPECT_EQ(trace.at("displayTimeUnit"), "ms");
    const std::vector<Span> spans = spansOf(trace);
    expectNested(spans);
    expectKernelsInStages(spans, kernels);
    std::vector<json> all;
    for (const std::string& file : stats) all.push_back(parsed(file));
    expectStages(spans, all);
    for (const Span& span : spans) {
      if (span.name == "frame") continue;  // which holds writing the statistics, too
      EXPECT_LE(double(span.end), 1e6 * all.back()["wall_milliseconds"].get<double>()) << span.name;
    }
    return spans;
  }
};

const std::set<std::string> kAllKernels{"find_lights", "scan_lists", "count_in_range", "beam_shadows",
                                        "shade"};

std::size_t countOf(const std::vector<Span>& spans, const std::string& name, const std::string& track) {
  return std::size_t(std::count_if(spans.begin(), spans.end(), [&](const Span& span) {
    return span.name == name && span.track == track;
  }));
}

const Span& firstOf(const std::vector<Span>& spans, const std::string& name) {
  const auto found =
      std::find_if(spans.begin(), spans.end(), [&](const Span& span) { return span.name == name; });
  if (found == spans.end()) throw std::logic_error("no event " + name);
  return *found;
}

TEST_F(TraceOption, OfAPictureHasItsStagesSamplesThreadsAndKernels) {
  const auto spans =
      traceOf("render scene.json --samples 3 --samples-shading all --quiet -o a.tif --stats s.json",
              {"s.json"}, kAllKernels);
  EXPECT_EQ(countOf(spans, "sample", "luciole/main"), 3u);
  EXPECT_EQ(countOf(spans, "band", "luciole/main"), 1u);
  EXPECT_EQ(firstOf(spans, "band").arguments["pixels"], 96 * 54);
  const json& picture = firstOf(spans, "picture").arguments;
  EXPECT_EQ(picture["lights"], 203);
  EXPECT_EQ(picture["samples"], 3);
  EXPECT_EQ(countOf(spans, "open device", "luciole/device opener"), 1u);
  EXPECT_EQ(countOf(spans, "compile kernels", "luciole/kernel compiler"), 1u);
  EXPECT_EQ(countOf(spans, "load OpenImageIO", "luciole/main"), 1u) << "for the TIFF";
}

TEST_F(TraceOption, OfFramesHasEachOnTheSameTracks) {
  const auto spans = traceOf("render scene.json --frames 3-5 --quiet -o f.#.png --stats s.#.json",
                             {"s.3.json", "s.4.json", "s.5.json"}, kAllKernels);
  EXPECT_EQ(countOf(spans, "frame", "luciole/main"), 3u);
  EXPECT_EQ(firstOf(spans, "frame").arguments["frame"], 3);
  EXPECT_EQ(countOf(spans, "compile kernels", "luciole/kernel compiler"), 3u);
}

TEST_F(TraceOption, OfGBufferShadeAndReferenceHasTheirStages) {
  traceOf("gbuffer scene.json --quiet -o g.exr --stats s.json", {"s.json"}, {});
  traceOf("gbuffer scene.json --shading gouraud --quiet -o v.exr --stats s.json", {"s.json"},
          {"find_lights", "scan_lists", "beam_shadows", "shade"});
  traceOf("shade g.exr --scene scene.json --quiet -o a.png --stats s.json", {"s.json"}, kAllKernels);
  traceOf("reference scene.json --size 24x16 --quiet -o r.exr --stats s.json", {"s.json"}, {});
}

TEST_F(TraceOption, ChangesNoPicture) {
  succeed(
      "luciole render scene.json --quiet -o a.exr && luciole render scene.json --quiet -o b.exr --trace "
      "t.json");
  succeed("luciole compare a.exr b.exr --max-abs 0");
}

TEST_F(TraceOption, GoesToStandardOutput) {
  EXPECT_FALSE(spansOf(json::parse(succeed("luciole render scene.json --quiet -o a.png --trace -"))).empty());
}

TEST_F(TraceOption, IsWrittenWholeOrNotAtAll) {
  refuse("luciole render missing.json -o a.png --trace t.json", 2, "missing.json");
  EXPECT_FALSE(std::filesystem::exists(folder / "t.json"));
  refuse("luciole render scene.json -o a.png --trace none/t.json", 2, "none/t.json: no such folder");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png")) << "before any work";
  refuse("luciole render scene.json -o a.png --trace a.png", 2, "--trace a.png: is the picture's own file");
  refuse("luciole render scene.json -o a.png --stats - --trace -", 2, "--trace -: is the file of --stats");
}

}  // namespace
}  // namespace luciole::test
