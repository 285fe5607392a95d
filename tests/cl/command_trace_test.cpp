// What a trace tells of a device's queue, and that there is no such thing without a trace.
#include "cl/command_trace.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cl/launch.hpp"

namespace luciole::test {
namespace {

constexpr const char* kCountUp =
    "kernel void count_up(global uint* numbers) { numbers[get_global_id(0)] += 1; }";

/// Runs a kernel three times on numbers that are brought there and back.
void countUp(OpenedDevice& device, std::size_t count) {
  std::vector<uint> numbers(count, 7), read(count);
  const Buffer<uint> buffer = makeBuffer<uint>(device, count);
  fill(device, buffer, 7);
  Kernel kernel = makeKernelFromSource(device, kCountUp, "count_up", "-DSOME=1");
  for (int i = 0; i < 3; ++i) launch(device, kernel, {{"numbers", buffer}}, {.items = count, .group = 1});
  download(device, buffer, read);
  for (const uint number : read) ASSERT_EQ(number, 10u);
}

bool isProfiled(const OpenedDevice& device) {
  return (device.queue.getInfo<CL_QUEUE_PROPERTIES>() & CL_QUEUE_PROFILING_ENABLE) != 0;
}

const std::variant<std::int64_t, double, std::string>& argumentOf(const TraceEvent& event,
                                                                  const std::string& name) {
  for (const auto& [known, value] : event.arguments)
    if (known == name) return value;
  throw std::logic_error("no argument " + name);
}

TEST(CommandTrace, WithoutATraceNoQueueIsProfiledAndNoCommandIsNoted) {
  OpenedDevice device;
  openDevice("", device);
  EXPECT_FALSE(isProfiled(device));
  EXPECT_EQ(device.trace, nullptr);
  countUp(device, 64);
  startTrace();  // too late for this device
  countUp(device, 64);
  for (const TraceEvent& event : endTrace().events) EXPECT_STRNE(event.category, kTraceDevice) << event.name;
}

TEST(CommandTrace, TellsEachCommandInItsOrderBetweenItsQueueingAndItsEnd) {
  startTrace();
  OpenedDevice device;
  openDevice("", device);
  EXPECT_TRUE(isProfiled(device));
  const std::int64_t before = nanosecondsSinceStart();
  constexpr std::size_t kCount = 1000;
  countUp(device, kCount);
  const std::int64_t after = nanosecondsSinceStart();
  EXPECT_TRUE(device.trace->commands.empty());
  const Trace trace = endTrace();
  std::vector<std::string> names;
  double last_end = double(before);
  for (const TraceEvent& event : trace.events) {
    if (event.category != std::string(kTraceDevice)) continue;
    names.push_back(event.name);
    EXPECT_TRUE(trace.tracks[event.track].is_device);
    EXPECT_EQ(trace.tracks[event.track].name, device.description.name);
    const double queued = 1e3 * std::get<double>(argumentOf(event, "queued_us"));
    const double submitted = 1e3 * std::get<double>(argumentOf(event, "submitted_us"));
    // Nanoseconds were written as microseconds and read again, at 2⁻⁵³ a time: a millionth of one is much.
    constexpr double kRounding = 1e-6;
    EXPECT_LE(double(before), queued + kRounding);
    EXPECT_LE(queued, submitted + kRounding);
    EXPECT_LE(submitted, double(event.begin) + kRounding);
    EXPECT_LE(last_end, double(event.begin)) << "the queue is in order";
    EXPECT_LE(event.begin, event.end);
    EXPECT_LE(event.end, after);
    last_end = double(event.end);
    // A tie lies within the time that queueing took, and all of this took less.
    EXPECT_LE(1e3 * std::get<double>(argumentOf(event, "clock_error_us")), double(after - before));
    if (event.name == "count_up") {
      EXPECT_EQ(std::get<std::int64_t>(argumentOf(event, "work_items")), std::int64_t(kCount));
      EXPECT_EQ(std::get<std::string>(argumentOf(event, "defines")), "-DSOME=1");
    } else {
      EXPECT_EQ(std::get<std::int64_t>(argumentOf(event, "bytes")), std::int64_t(kCount * sizeof(uint)));
    }
  }
  EXPECT_THAT(names, testing::ElementsAre("upload", "count_up", "count_up", "count_up", "download"));
}

TEST(CommandTrace, TellsWhatOpeningADeviceAndBuildingAProgramTook) {
  startTrace();
  OpenedDevice device;
  startDevice("", device);
  awaitDevice(device);
  countUp(device, 16);
  const Trace trace = endTrace();
  int opened = 0, built = 0;
  for (const TraceEvent& event : trace.events) {
    if (event.name == "open device") {
      ++opened;
      EXPECT_EQ(trace.tracks[event.track].name, "device opener");
      EXPECT_EQ(1e-6 * double(event.end - event.begin), device.milliseconds_to_open);
    }
    if (event.name != "build program") continue;
    ++built;
    EXPECT_EQ(std::get<std::string>(argumentOf(event, "kernel")), "count_up");
  }
  EXPECT_EQ(opened, 1);
  EXPECT_EQ(built, 1);
}

}  // namespace
}  // namespace luciole::test
