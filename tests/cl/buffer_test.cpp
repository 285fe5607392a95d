#include "cl/buffer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "cl/launch.hpp"
#include "messages.hpp"

namespace luciole::test {
namespace {

using Bytes = std::array<std::uint64_t, 3>;

/// With memory that is the host's, as a CPU has it, and as if it had memory of its own.
struct Buffers : testing::TestWithParam<bool> {
  OpenedDevice device;
  Buffers() {
    openDevice("", device);
    device.shares_host_memory = GetParam();
  }

  bool shared() const { return GetParam(); }
  template <class T>
  std::vector<std::remove_const_t<T>> content(const Buffer<T>& buffer) {
    std::vector<std::remove_const_t<T>> values(buffer.count);
    download(device, buffer, values);
    return values;
  }
  /// Bytes since the last call: up, down, made.
  Bytes traffic() {
    const Traffic now = trafficOf(device), before = std::exchange(last, now);
    return {now.bytes_up - before.bytes_up, now.bytes_down - before.bytes_down,
            now.bytes_made - before.bytes_made};
  }
  Traffic last;
};

std::vector<int> numbers(std::size_t count) {
  std::vector<int> values(count);
  std::iota(values.begin(), values.end(), 1);
  return values;
}

TEST_P(Buffers, ValuesGoToTheDeviceAndBack) {
  const std::vector<int> values = numbers(300);
  EXPECT_EQ(content(borrowed(device, values)), values);
}

TEST_P(Buffers, PartsComeBackByElements) {
  const std::vector<int> values = numbers(300);
  std::vector<int> part(7);
  download(device, borrowed(device, values), part, 290);
  EXPECT_EQ(part, (std::vector<int>{291, 292, 293, 294, 295, 296, 297}));
}

TEST_P(Buffers, EmptyOnesAreAllowed) {
  const std::vector<int> none;
  std::vector<int> out;
  EXPECT_EQ(borrowed(device, none).count, 0u);
  EXPECT_EQ(borrowedForOutput(device, out).count, 0u);
  EXPECT_NE(makeBuffer<int>(device, 0).memory.handle(), nullptr);
}

TEST_P(Buffers, TooManyBytesAreAMachineError) {
  EXPECT_NE(messageOf<MachineError>([&] { makeBuffer<char>(device, std::size_t(1) << 60); }), "");
}

TEST_P(Buffers, InputLiesInTheHostsArrayWhereMemoryIsShared) {
  const std::vector<int> values = numbers(300);
  const Buffer<const int> buffer = borrowed(device, values);
  const void* const place = buffer.memory.handle.getInfo<CL_MEM_HOST_PTR>();
  EXPECT_EQ(place == values.data(), shared());
  EXPECT_EQ(buffer.memory.loan != nullptr, shared());
}

TEST_P(Buffers, OutputLiesInTheHostsArrayWhereMemoryIsShared) {
  std::vector<int> values(300);
  const Buffer<int> buffer = borrowedForOutput(device, values);
  fill(device, buffer, 42);
  download(device, buffer, values);
  EXPECT_EQ(values, std::vector<int>(300, 42));
  EXPECT_EQ(traffic()[1], shared() ? 0u : 1200u);
}

TEST_P(Buffers, BytesAreCountedWhereTheyAreCopied) {
  const std::vector<int> values = numbers(300);
  const Buffer<const int> buffer = borrowed(device, values);
  EXPECT_EQ(traffic(), (shared() ? Bytes{} : Bytes{1200, 0, 1200}));
  content(buffer);
  EXPECT_EQ(traffic(), (shared() ? Bytes{} : Bytes{0, 1200, 0}));
  makeBuffer<int>(device, 100);
  EXPECT_EQ(traffic(), (Bytes{0, 0, 400}));
}

TEST_P(Buffers, ReservedMemoryStaysWhileItIsLargeEnough) {
  Buffer<int> buffer;
  for (const std::size_t count : {100, 50, 100}) reserve(device, count, buffer);
  EXPECT_EQ(buffer.count, 100u);
  EXPECT_EQ(traffic(), (Bytes{0, 0, 400}));
  reserve(device, 101, buffer);
  EXPECT_EQ(traffic(), (Bytes{0, 0, 404}));
}

TEST_P(Buffers, RefreshBringsWhatChangedAndNoMore) {
  std::vector<int> values = numbers(300);
  Buffer<const int> buffer = borrowed(device, values);
  traffic();
  giveBack(buffer);
  values[10] = values[11] = values[200] = -1;
  const std::vector<IndexRange> changed{{10, 1}, {11, 1}, {200, 1}};
  refresh(device, values, changed, buffer);
  EXPECT_EQ(traffic(), (shared() ? Bytes{} : Bytes{12, 0, 0}));
  EXPECT_EQ(content(buffer), values);
}

TEST_P(Buffers, RefreshBringsRectangles) {
  std::vector<int> values = numbers(300);
  Buffer<const int> buffer = borrowed(device, values);
  traffic();
  giveBack(buffer);
  // Of rows of 20 from element 7 on: columns 3 and 4 of the first three, 11 and 12 of the sixth and seventh.
  for (const std::size_t first : {10, 30, 50, 118, 138}) values[first] = values[first + 1] = -1;
  const std::vector<IndexRange> changed{{10, 2, 3, 20}, {118, 2, 2, 20}};
  refresh(device, values, changed, buffer);
  EXPECT_EQ(traffic(), (shared() ? Bytes{} : Bytes{40, 0, 0}));
  EXPECT_EQ(content(buffer), values);
}

TEST_P(Buffers, RefreshKeepsWhatWasThereWhereItGrows) {
  std::vector<int> values = numbers(300);
  Buffer<const int> buffer = borrowed(device, values);
  traffic();
  giveBack(buffer);
  values.resize(400, -1);
  const std::vector<IndexRange> changed{{300, 100}};
  refresh(device, values, changed, buffer);
  EXPECT_EQ(traffic(), (shared() ? Bytes{} : Bytes{400, 0, 1600}));
  EXPECT_EQ(content(buffer), values);
}

TEST_P(Buffers, RefreshFillsABufferThatWasEmpty) {
  std::vector<int> values;
  Buffer<const int> buffer = borrowed(device, values);
  giveBack(buffer);
  values = numbers(300);
  const std::vector<IndexRange> changed{{0, 300}};
  refresh(device, values, changed, buffer);
  EXPECT_EQ(content(buffer), values);
}

TEST_P(Buffers, ABorrowedOneWaitsForTheKernelsThatWriteToItBeforeItGoes) {
  // Long enough to be running still when it has been queued.
  Kernel kernel = makeKernelFromSource(device,
                                       "__kernel void probe(uint rounds, __global uint *out) {\n"
                                       "  uint x = 1;\n"
                                       "  for (uint i = 0; i < rounds; ++i) x = x * 1664525 + 1013904223;\n"
                                       "  *out = x | 1;\n"
                                       "}\n",
                                       "probe", "");
  std::vector<uint> values(4, 0);
  launch(device, kernel, {{"rounds", 100000000u}, {"out", borrowedForOutput(device, values)}}, {.items = 1});
  EXPECT_EQ(values[0] != 0, shared());
  finish(device);
}

INSTANTIATE_TEST_SUITE_P(Memory, Buffers, testing::Bool(),
                         [](const auto& test) { return test.param ? "Shared" : "Apart"; });

template <class Values>
concept Borrowable = requires(OpenedDevice& device, Values&& values) {
  borrowed(device, std::forward<Values>(values));
};
static_assert(Borrowable<const std::vector<int>&> && Borrowable<std::span<int>>);
static_assert(!Borrowable<std::vector<int>>, "it is gone when the buffer is used");

static_assert(std::is_convertible_v<Buffer<float>, Buffer<const float>>);
static_assert(!std::is_convertible_v<Buffer<const float>, Buffer<float>>,
              "what may only be read isn't written");
static_assert(!std::is_convertible_v<Buffer<float>, Buffer<const uint>>);

}  // namespace
}  // namespace luciole::test
