#include "cl/device.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "cl/kernel_source.hpp"

namespace luciole {
namespace {

using testing::HasSubstr;

const std::vector<DeviceDescription> kDevices{{"Intel(R) OpenCL", "Arc A770", "1", 1},
                                              {"NVIDIA CUDA", "NVIDIA H200", "2", 1},
                                              {"Portable Computing Language", "pthread-EPYC", "3", 16},
                                              {"Portable Computing Language", "cuda-H200", "3", 1}};

template <class Error, class Function>
std::string messageOf(Function&& function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "another kind of error: " << error.what();
  }
  return "";
}

TEST(SelectDevice, PoclFirstByDefault) {
  EXPECT_EQ(selectDevice(kDevices, ""), 2u);
  EXPECT_EQ(selectDevice(std::span(kDevices).first(2), ""), 0u) << "and the first where there is no PoCL";
}

TEST(SelectDevice, ByNumber) {
  for (std::size_t i = 0; i < kDevices.size(); ++i) EXPECT_EQ(selectDevice(kDevices, std::to_string(i)), i);
}

TEST(SelectDevice, ByAnyPartOfPlatformOrNameIgnoringCase) {
  EXPECT_EQ(selectDevice(kDevices, "h200"), 1u);
  EXPECT_EQ(selectDevice(kDevices, "CUDA-H"), 3u);
  EXPECT_EQ(selectDevice(kDevices, "intel"), 0u);
  EXPECT_EQ(selectDevice(kDevices, "Portable"), 2u);
}

TEST(SelectDevice, LanesSuffixIsNoPartOfTheName) {
  EXPECT_EQ(selectDevice(kDevices, "h200,lanes=8"), 1u);
  EXPECT_EQ(selectDevice(kDevices, "3,lanes=1"), 3u);
  EXPECT_EQ(selectDevice(kDevices, ",lanes=4"), 2u);
}

TEST(SelectDevice, WhatDoesNotFitIsNamed) {
  for (const char* selector : {"4", "99999999999999999999999", "Radeon", "-1"}) {
    const std::string message = messageOf<InputError>([&] { selectDevice(kDevices, selector); });
    EXPECT_THAT(message, HasSubstr(std::string("--device ") + selector)) << selector;
    EXPECT_THAT(message, HasSubstr("luciole devices")) << selector;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(SelectDevice, WithoutAnyDeviceItSaysWhatToInstall) {
  EXPECT_THAT(messageOf<MachineError>([] { selectDevice({}, ""); }), HasSubstr("pocl-opencl-icd"));
}

TEST(OpenDevice, LanesAreTheDevicesOwnOrForced) {
  Device own;
  openDevice("", own);
  const std::vector<DeviceDescription> all = listDevices();
  EXPECT_EQ(own.description.lanes, all[selectDevice(all, "")].lanes);
  EXPECT_THAT(own.description.lanes, testing::AnyOf(1, 4, 8, 16));
  for (const int lanes : {1, 4, 8, 16}) {
    Device device;
    openDevice(",lanes=" + std::to_string(lanes), device);
    EXPECT_EQ(device.description.lanes, lanes);
    EXPECT_EQ(device.description.name, own.description.name);
  }
}

TEST(OpenDevice, OtherLanesAreRefused) {
  for (const char* selector : {",lanes=2", ",lanes=0", ",lanes=", ",lanes=8x", ",lanes=-4", ",lanes=32"}) {
    Device device;
    EXPECT_THAT(messageOf<InputError>([&] { openDevice(selector, device); }), HasSubstr("1, 4, 8 or 16"))
        << selector;
  }
}

TEST(StartDevice, IsOpenOnceAwaited) {
  Device own, started;
  openDevice("", own);
  startDevice("", started);
  awaitDevice(started);
  EXPECT_EQ(started.description.name, own.description.name);
  EXPECT_GT(started.milliseconds_to_open, 0);
  std::vector<int> back(1);
  readBuffer(started, inputBuffer(started, std::vector<int>{7}), back.data(), sizeof(int));
  EXPECT_EQ(back, std::vector<int>{7});
  awaitDevice(own);  // nothing to wait for
}

TEST(StartDevice, ErrorsReachEveryThreadThatAwaits) {
  Device device;
  startDevice("no such device", device);
  for (int i = 0; i < 2; ++i)
    EXPECT_THAT(messageOf<InputError>([&] { awaitDevice(device); }), HasSubstr("no device has this"));
}

TEST(StartDevice, ItsThreadEndsBeforeTheDevice) {
  Device device;
  startDevice("", device);
}

TEST(MakeKernel, CompileErrorNamesTheRealFileAndLine) {
  Device device;
  openDevice("", device);
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

TEST(MakeKernel, ErrorInAnIncludedFileNamesThatFile) {
  Device device;
  openDevice("", device);
  // A number in place of the name of a function.
  const std::string text = "#define distance_falloff 1\n#include \"falloff.clh\"\n";
  EXPECT_THAT(messageOf<MachineError>(
                  [&] { makeKernelFromSource(device, expandKernelSource("broken.cl", text), "probe", ""); }),
              HasSubstr("kernels/falloff.clh:"));
}

TEST(MakeKernel, ProgramsAreBuiltOnceADevice) {
  Device device;
  openDevice("", device);
  const std::string source = "__kernel void probe(__global float *out) { *out = VALUE; }\n";
  makeKernelFromSource(device, source, "probe", "-DVALUE=1");
  makeKernelFromSource(device, source, "probe", "-DVALUE=1");
  EXPECT_EQ(device.programs.size(), 1u);
  makeKernelFromSource(device, source, "probe", "-DVALUE=2");
  EXPECT_EQ(device.programs.size(), 2u);
}

TEST(MakeKernel, ARefusedArgumentIsToldWithKernelNumberAndTheErrorsName) {
  Device device;
  openDevice("", device);
  Kernel kernel = makeKernelFromSource(
      device, "__kernel void probe(__global float *out, uint count) { *out = count; }\n", "probe", "");
  kernel.setArg(1, cl_uint(3));
  for (const auto& [number, error] :
       {std::pair(cl_uint(2), "CL_INVALID_ARG_INDEX"), {1, "CL_INVALID_ARG_SIZE"}}) {
    const std::string message = messageOf<MachineError>([&] { kernel.setArg(number, cl_double(3)); });
    EXPECT_THAT(message, HasSubstr(fmt::format("kernel 'probe', argument {}: clSetKernelArg", number)));
    EXPECT_THAT(message, HasSubstr(error));
    EXPECT_THAT(message, HasSubstr(device.description.name));
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(Launch, WhatTheDeviceRefusesIsToldWithTheKernel) {
  Device device;
  openDevice("", device);
  Kernel kernel =
      makeKernelFromSource(device, "__kernel void probe(__global float *out) { *out = 1; }\n", "probe", "");
  // Without its argument.
  EXPECT_THAT(messageOf<MachineError>([&] { launch(device, kernel, 1, 1); }),
              testing::AllOf(HasSubstr("kernel 'probe'"), HasSubstr("CL_INVALID_KERNEL_ARGS")));
}

TEST(Launch, GroupsGetNoLargerThanTheDeviceTakes) {
  Device device;
  openDevice("", device);
  const std::string text =
      "__kernel void probe(__global uint *out) { out[get_global_id(0)] = get_local_size(0); }\n";
  Kernel kernel = makeKernelFromSource(device, text, "probe", "");
  const std::size_t most = device.device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>(),
                    items = std::bit_ceil(8 * most);
  const cl::Buffer sizes = deviceBuffer(device, items * sizeof(cl_uint));
  kernel.setArg(0, sizes);
  launch(device, kernel, items, items);
  std::vector<cl_uint> back(items);
  readBuffer(device, sizes, back.data(), items * sizeof(cl_uint));
  EXPECT_EQ(back, std::vector<cl_uint>(items, cl_uint(std::bit_floor(most))));
}

TEST(KernelSource, IncludesAppearOnceAndLinesKeepTheirNumbers) {
  const std::string source =
      expandKernelSource("own.cl", "#include \"math.clh\"\n#include \"lanes.clh\"\nlast line");
  EXPECT_THAT(source, testing::StartsWith("#line 1 \"kernels/own.cl\"\n#line 1 \"kernels/math.clh\"\n"));
  EXPECT_THAT(source, testing::EndsWith("#line 2 \"kernels/own.cl\"\n\nlast line"));
  const std::size_t first = source.find("#line 1 \"kernels/lanes.clh\"");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(source.find("#line 1 \"kernels/lanes.clh\"", first + 1), std::string::npos);
  EXPECT_EQ(source.find("#include"), std::string::npos);
}

TEST(KernelSource, AnUnknownFileIsAMistakeOfTheProgram) {
  EXPECT_THROW(kernelSource("no_such.cl"), std::logic_error);
  EXPECT_THROW(expandKernelSource("own.cl", "#include \"no_such.clh\"\n"), std::logic_error);
}

TEST(Buffers, EmptyOnesAreAllowedAndBytesSurvive) {
  Device device;
  openDevice("", device);
  inputBuffer(device, std::vector<float>{});
  deviceBuffer(device, 0);
  const std::vector<int> values{1, 2, 3};
  std::vector<int> back(3);
  readBuffer(device, inputBuffer(device, values), back.data(), 12);
  EXPECT_EQ(back, values);
}

TEST(Buffers, TooManyBytesAreAMachineError) {
  Device device;
  openDevice("", device);
  EXPECT_NE(messageOf<MachineError>([&] { deviceBuffer(device, std::size_t(1) << 60); }), "");
}

}  // namespace
}  // namespace luciole
