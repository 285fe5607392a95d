#include "cl/launch.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

#include "cl/kernel_source.hpp"
#include "messages.hpp"
#include "setting.hpp"

namespace luciole::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A device of the test's own.
struct WithDevice : testing::Test {
  OpenedDevice device;
  WithDevice() { openDevice("", device); }
};

using MakeKernel = WithDevice;

TEST_F(MakeKernel, CompileErrorNamesTheRealFileAndLine) {
  // Line 4, after an include of many lines that includes more.
  const std::string text =
      "// a probe\n#include \"math.clh\"\n__kernel void probe(__global float *out) {\n  *out = "
      "no_such_thing;\n}\n";
  const std::string message = messageOf<MachineError>(
      [&] { makeKernelFromSource(device, expandKernelSource("broken.cl", text), "probe", ""); });
  EXPECT_THAT(message, HasSubstr("kernels/broken.cl:4"));
  EXPECT_THAT(message, HasSubstr("no_such_thing"));
  EXPECT_THAT(message, HasSubstr("'probe'"));
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST_F(MakeKernel, ErrorInAnIncludedFileNamesThatFile) {
  // A number in place of the name of a function.
  const std::string text = "#define distance_falloff 1\n#include \"shade/falloff.clh\"\n";
  EXPECT_THAT(messageOf<MachineError>(
                  [&] { makeKernelFromSource(device, expandKernelSource("broken.cl", text), "probe", ""); }),
              HasSubstr("kernels/shade/falloff.clh:"));
}

TEST_F(MakeKernel, TheCompilersWarningsAreNotPrinted) {
  // No driver has kept a program of this define.
  const std::string defines =
      fmt::format("-DMOMENT={}", std::chrono::steady_clock::now().time_since_epoch().count());
  testing::internal::CaptureStderr();
  makeKernelFromSource(device,
                       "__kernel void probe(__global int *out) { *out = 1.5 + (int)MOMENT; int x = 1e20; }\n",
                       "probe", defines);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(MakeKernel, ProgramsAreBuiltOnceADevice) {
  const std::string source = "__kernel void probe(__global float *out) { *out = VALUE; }\n";
  makeKernelFromSource(device, source, "probe", "-DVALUE=1");
  makeKernelFromSource(device, source, "probe", "-DVALUE=1");
  EXPECT_EQ(device.programs.size(), 1u);
  makeKernelFromSource(device, source, "probe", "-DVALUE=2");
  EXPECT_EQ(device.programs.size(), 2u);
}

TEST_F(MakeKernel, WithoutOptimizationThereIsAnotherProgramOfTheSameBits) {
  if (device.pocl_cache.empty()) GTEST_SKIP() << "the default device isn't PoCL's";
  // No driver has kept programs of this define.
  const std::string defines =
      fmt::format("-DMOMENT={}", std::chrono::steady_clock::now().time_since_epoch().count());
  const std::string source =
      "__kernel void probe(__global float *out) { *out = sqrt(1.0f / (float)(MOMENT % 1000 + 1)) + 0.1f * "
      "(float)(MOMENT % 977); }\n";
  float values[] = {3, 3};
  for (const int optimizes : {0, 1}) {
    const Setting setting("LUCIOLE_OPTIMIZE", std::to_string(optimizes));
    OpenedDevice opened;
    openDevice("", opened);
    Kernel kernel = makeKernelFromSource(opened, source, "probe", defines);
    EXPECT_EQ(hasQuickPrograms(opened), !optimizes) << "LUCIOLE_OPTIMIZE=" << optimizes;
    std::vector<float> value(1, 3.0f);
    const Buffer<float> out = borrowedForOutput(opened, value);
    launch(opened, kernel, {{"out", out}}, {.items = 1});
    download(opened, out, value);
    values[optimizes] = value[0];
  }
  EXPECT_NE(values[0], 3);
  EXPECT_EQ(values[0], values[1]);
}

TEST_F(MakeKernel, AKernelThatTheProgramLacksIsTold) {
  const std::string source = "__kernel void probe(__global float *out) { *out = 1; }\n";
  EXPECT_THAT(messageOf<MachineError>([&] { makeKernelFromSource(device, source, "prob", ""); }),
              AllOf(HasSubstr("kernel 'prob'"), HasSubstr("CL_INVALID_KERNEL_NAME")));
}

TEST_F(MakeKernel, ArgumentsAreThoseOfTheSource) {
  const Kernel kernel = makeKernelFromSource(
      device,
      "typedef struct { float x; } Own;\n"
      "__kernel void probe(__global const Own *in, Own own, uint count, __constant float4 *fixed,\n"
      "                    __global float *restrict out, __local int *scratch) { *out = in->x; }\n",
      "probe", "");
  const std::vector<DeclaredArgument> expected{{"in", "Own*", CL_KERNEL_ARG_ADDRESS_GLOBAL, true},
                                               {"own", "Own", CL_KERNEL_ARG_ADDRESS_PRIVATE, false},
                                               {"count", "uint", CL_KERNEL_ARG_ADDRESS_PRIVATE, false},
                                               {"fixed", "float4*", CL_KERNEL_ARG_ADDRESS_CONSTANT, true},
                                               {"out", "float*", CL_KERNEL_ARG_ADDRESS_GLOBAL, false},
                                               {"scratch", "int*", CL_KERNEL_ARG_ADDRESS_LOCAL, false}};
  ASSERT_EQ(kernel.arguments.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(kernel.arguments[i].name, expected[i].name);
    EXPECT_EQ(kernel.arguments[i].type, expected[i].type) << expected[i].name;
    EXPECT_EQ(kernel.arguments[i].space, expected[i].space) << expected[i].name;
    EXPECT_EQ(kernel.arguments[i].is_const, expected[i].is_const) << expected[i].name;
  }
}

/// A kernel that writes scale · (in[i] + offset) to out[i].
struct Launch : WithDevice {
  const std::vector<float> values{1, 2, 3, 4};
  Buffer<const float> in = borrowed(device, values);
  Buffer<float> out = makeBuffer<float>(device, 4);
  Kernel kernel = makeKernelFromSource(
      device,
      "__kernel void probe(__global const float *in, float scale, uint offset, __global float *out) {\n"
      "  out[get_global_id(0)] = scale * (in[get_global_id(0)] + offset);\n"
      "}\n",
      "probe", "");

  void run(const std::vector<KernelArgument>& arguments) { launch(device, kernel, arguments, {.items = 4}); }
  /// What is wrong with the arguments.
  std::string mistake(const std::vector<KernelArgument>& arguments) {
    return messageOf<std::logic_error>([&] { run(arguments); });
  }
};

TEST_F(Launch, ArgumentsAreFoundByNameInAnyOrder) {
  run({{"out", out}, {"offset", 10u}, {"in", in}, {"scale", 2.0f}});
  std::vector<float> back(4);
  download(device, out, back);
  EXPECT_EQ(back, (std::vector<float>{22, 24, 26, 28}));
}

TEST_F(Launch, ABufferThatMayBeWrittenMayBeRead) {
  const Buffer<float> same = makeBuffer<float>(device, 4);
  fill(device, same, 5.0f);
  run({{"in", same}, {"scale", 1.0f}, {"offset", 1u}, {"out", out}});
  std::vector<float> back(4);
  download(device, out, back);
  EXPECT_EQ(back, std::vector<float>(4, 6.0f));
}

TEST_F(Launch, AMissingArgumentIsNamed) {
  EXPECT_EQ(mistake({{"in", in}, {"scale", 2.0f}, {"out", out}}),
            "kernel 'probe', argument 'offset' is missing");
}

TEST_F(Launch, AMisspeltArgumentIsNamed) {
  EXPECT_EQ(mistake({{"in", in}, {"scala", 2.0f}, {"offset", 1u}, {"out", out}}),
            "kernel 'probe', argument 'scala' is none of its arguments");
}

TEST_F(Launch, AnArgumentThatIsGivenTwiceIsNamed) {
  EXPECT_EQ(mistake({{"in", in}, {"scale", 2.0f}, {"scale", 2.0f}, {"offset", 1u}, {"out", out}}),
            "kernel 'probe', argument 'scale' is given twice");
}

TEST_F(Launch, AValueOfAnotherTypeIsRefusedThoughItIsAsLarge) {
  EXPECT_EQ(mistake({{"in", in}, {"scale", 2u}, {"offset", 1u}, {"out", out}}),
            "kernel 'probe', argument 'scale' is a float, not a uint");
}

TEST_F(Launch, ABufferOfAnotherTypeIsRefused) {
  EXPECT_EQ(
      mistake({{"in", makeBuffer<ShadeLight>(device, 4)}, {"scale", 2.0f}, {"offset", 1u}, {"out", out}}),
      "kernel 'probe', argument 'in' is a float*, not a ShadeLight*");
}

TEST_F(Launch, AValueInPlaceOfABufferIsRefused) {
  EXPECT_EQ(mistake({{"in", 1.0f}, {"scale", 2.0f}, {"offset", 1u}, {"out", out}}),
            "kernel 'probe', argument 'in' is a float*, not a float");
}

TEST_F(Launch, ABufferToReadIsRefusedWhereTheKernelMayWrite) {
  EXPECT_EQ(mistake({{"in", in}, {"scale", 2.0f}, {"offset", 1u}, {"out", in}}),
            "kernel 'probe', argument 'out' isn't const, but the buffer may only be read");
}

TEST_F(Launch, LocalMemoryIsRefused) {
  Kernel local = makeKernelFromSource(
      device, "__kernel void probe(__local float *scratch) { *scratch = 1; }\n", "probe", "");
  EXPECT_EQ(messageOf<std::logic_error>([&] {
              launch(device, local, {{"scratch", out}}, {.items = 1});
            }),
            "kernel 'probe', argument 'scratch' is in local memory, where launch() puts nothing");
}

TEST_F(Launch, MistakesShowWithoutAnyWorkItems) {
  EXPECT_THROW(launch(device, kernel, {}, {.items = 0}), std::logic_error);
}

TEST_F(Launch, AValueThatTheDeviceRefusesIsToldWithKernelArgumentAndTheErrorsName) {
  KernelArgument offset("offset", 1u);
  offset.value.resize(2 * sizeof(uint));  // as if host and device disagreed
  const std::string message = messageOf<MachineError>([&] {
    run({{"in", in}, {"scale", 2.0f}, offset, {"out", out}});
  });
  EXPECT_THAT(message,
              AllOf(HasSubstr(device.description.name), HasSubstr("kernel 'probe', argument 'offset'"),
                    HasSubstr("clSetKernelArg"), HasSubstr("CL_INVALID_ARG_SIZE")));
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST_F(Launch, WhatTheQueueRefusesIsToldWithTheKernel) {
  // Groups that don't divide the items.
  EXPECT_THAT(messageOf<MachineError>([&] {
                launch(device, kernel, {{"in", in}, {"scale", 2.0f}, {"offset", 1u}, {"out", out}},
                       {.items = 3, .group = 2});
              }),
              AllOf(HasSubstr("kernel 'probe'"), HasSubstr("CL_INVALID_WORK_GROUP_SIZE")));
}

TEST_F(Launch, AQueueThatFailsLaterIsToldWithTheKernel) {
  run({{"in", in}, {"scale", 2.0f}, {"offset", 1u}, {"out", out}});
  finish(device);
  const cl::CommandQueue queue = device.queue;
  device.queue = {};  // none: as good as one that failed
  EXPECT_THAT(messageOf<MachineError>([&] { finish(device); }),
              AllOf(HasSubstr("kernel 'probe'"), HasSubstr("CL_INVALID_COMMAND_QUEUE")));
  device.queue = queue;
}

TEST_F(Launch, GroupsGetNoLargerThanTheDeviceTakes) {
  Kernel sizes = makeKernelFromSource(
      device, "__kernel void probe(__global uint *out) { out[get_global_id(0)] = get_local_size(0); }\n",
      "probe", "");
  const std::size_t most = device.device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>(),
                    items = std::bit_ceil(8 * most);
  std::vector<uint> back(items);
  const Buffer<uint> found = borrowedForOutput(device, back);
  launch(device, sizes, {{"out", found}}, {.items = items, .group = items});
  download(device, found, back);
  EXPECT_EQ(back, std::vector<uint>(items, uint(std::bit_floor(most))));
}

TEST_F(Launch, ManyWorkItemsRunOnceEachInRowsForWhichPoclCompilesNoSecondKernel) {
  Kernel rows =
      makeKernelFromSource(device,
                           "__kernel void probe(__global uint *runs, __global uint *widths) {\n"
                           "  size_t i = get_global_id(1) * get_global_size(0) + get_global_id(0);\n"
                           "  runs[i] += 1;\n"
                           "  widths[i] = get_global_size(0);\n"
                           "}\n",
                           "probe", "");
  // Just below PoCL's limit and above it, a picture of 3840 x 2160 pixels, and what can't be divided.
  constexpr std::size_t kPrime = 65'537;
  for (const WorkItems work :
       {WorkItems{65'535}, WorkItems{65'536}, WorkItems{3840 * 2160, 16}, WorkItems{kPrime}}) {
    std::vector<uint> runs(work.items, 0), widths(work.items, 0);
    const Buffer<uint> of_runs = borrowedForOutput(device, runs),
                       of_widths = borrowedForOutput(device, widths);
    fill(device, of_runs, 0u);
    launch(device, rows, {{"runs", of_runs}, {"widths", of_widths}}, work);
    download(device, of_runs, runs);
    download(device, of_widths, widths);
    EXPECT_EQ(runs, std::vector<uint>(work.items, 1));
    if (work.items != kPrime) {
      EXPECT_LT(widths.front(), 65'536u);
    }
  }
}

}  // namespace
}  // namespace luciole::test
