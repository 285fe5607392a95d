#include "base/trace.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "base/clock.hpp"

namespace luciole::test {
namespace {

using testing::ElementsAre;

std::vector<std::string> namesOf(const Trace& trace) {
  std::vector<std::string> names;
  for (const TraceEvent& event : trace.events) names.push_back(event.name);
  return names;
}

const std::string& trackOf(const Trace& trace, std::size_t event) {
  return trace.tracks[trace.events[event].track].name;
}

TEST(Trace, RecordsNothingBeforeItStartsNorAfterItsEnd) {
  {
    const TraceSpan early("early");
    startTrace();
  }
  { const TraceSpan inside("inside"); }
  Trace trace;
  {
    const TraceSpan late("late");
    trace = endTrace();
  }
  { const TraceSpan after("after"); }
  EXPECT_THAT(namesOf(trace), ElementsAre("inside"));
  EXPECT_FALSE(isTracing());
  startTrace();
  EXPECT_THAT(namesOf(endTrace()), ElementsAre());
}

TEST(Trace, SpansNestAndTellTheirTimesAndArguments) {
  startTrace();
  const std::int64_t before = nanosecondsSinceStart();
  {
    const TraceSpan outer("outer", {{"count", 3}, {"share", 0.5}, {"name", "a"}});
    const TraceSpan inner("inner");
  }
  const std::int64_t after = nanosecondsSinceStart();
  const Trace trace = endTrace();
  ASSERT_THAT(namesOf(trace), ElementsAre("inner", "outer"));
  const TraceEvent &inner = trace.events[0], &outer = trace.events[1];
  EXPECT_LE(before, outer.begin);
  EXPECT_LE(outer.begin, inner.begin);
  EXPECT_LE(inner.begin, inner.end);
  EXPECT_LE(inner.end, outer.end);
  EXPECT_LE(outer.end, after);
  EXPECT_EQ(inner.track, outer.track);
  EXPECT_EQ(trackOf(trace, 0), "main");
  EXPECT_TRUE(inner.arguments.empty());
  EXPECT_EQ(outer.arguments, (TraceArguments{{"count", std::int64_t(3)}, {"share", 0.5}, {"name", "a"}}));
}

TEST(Trace, EachThreadHasATrackAndThoseOfANameShareOneAfterEachOther) {
  startTrace();
  const auto record = [](const char* thread_name) {
    const TraceThread thread(thread_name);
    const TraceSpan span("work");
  };
  std::thread(record, "loader").join();
  std::thread(record, "loader").join();
  {
    // At once.
    const TraceThread has_one_already("ignored");
    std::thread other([&] {
      const TraceThread thread("loader");
      std::thread(record, "loader").join();
      const TraceSpan span("work");
    });
    other.join();
    const TraceSpan span("work");
  }
  std::thread([] { const TraceSpan span("work"); }).join();
  const Trace trace = endTrace();
  ASSERT_EQ(trace.events.size(), 6u);
  std::vector<std::string> tracks;
  for (std::size_t i = 0; i < trace.events.size(); ++i) tracks.push_back(trackOf(trace, i));
  EXPECT_THAT(tracks, ElementsAre("loader", "loader", "loader", "loader", "main", "worker 1"));
  EXPECT_EQ(trace.events[0].track, trace.events[1].track);
  EXPECT_NE(trace.events[2].track, trace.events[3].track) << "they lived at once";
}

TEST(Trace, AnyThreadsMayRecordAtOnce) {
  constexpr int kThreads = 4, kSpans = 500;
  startTrace();
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([] {
      const TraceThread thread("crowd");
      for (int k = 0; k < kSpans; ++k) const TraceSpan span("work", {{"name", "one of many"}});
    });
  }
  for (std::thread& thread : threads) thread.join();
  const Trace trace = endTrace();
  EXPECT_EQ(trace.events.size(), std::size_t(kThreads * kSpans));
  for (const TraceEvent& event : trace.events) EXPECT_LE(event.begin, event.end);
}

}  // namespace
}  // namespace luciole::test
