#include "cl/device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

#include "messages.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

const std::vector<DeviceDescription> kDevices{{"Intel(R) OpenCL", "Arc A770", "1", 1},
                                              {"NVIDIA CUDA", "NVIDIA H200", "2", 1},
                                              {"Portable Computing Language", "pthread-EPYC", "3", 16},
                                              {"Portable Computing Language", "cuda-H200", "3", 1}};

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
    EXPECT_THAT(message, HasSubstr(std::string("device: ") + selector)) << selector;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(SelectDevice, WithoutAnyDeviceItSaysWhatToInstall) {
  EXPECT_THAT(messageOf<MachineError>([] { selectDevice({}, ""); }), HasSubstr("pocl-opencl-icd"));
}

TEST(OpenDevice, LanesAreTheDevicesOwnOrForced) {
  OpenedDevice own;
  openDevice("", own);
  const std::vector<DeviceDescription> all = listDevices();
  EXPECT_EQ(own.description.lanes, all[selectDevice(all, "")].lanes);
  EXPECT_THAT(own.description.lanes, testing::AnyOf(1, 4, 8, 16));
  for (const int lanes : {1, 4, 8, 16}) {
    OpenedDevice device;
    openDevice(",lanes=" + std::to_string(lanes), device);
    EXPECT_EQ(device.description.lanes, lanes);
    EXPECT_EQ(device.description.name, own.description.name);
  }
}

TEST(OpenDevice, OtherLanesAreRefused) {
  for (const char* selector : {",lanes=2", ",lanes=0", ",lanes=", ",lanes=8x", ",lanes=-4", ",lanes=32"}) {
    OpenedDevice device;
    EXPECT_THAT(messageOf<InputError>([&] { openDevice(selector, device); }), HasSubstr("1, 4, 8 or 16"))
        << selector;
  }
}

TEST(StartDevice, IsOpenOnceAwaited) {
  OpenedDevice own, started;
  openDevice("", own);
  startDevice("", started);
  awaitDevice(started);
  EXPECT_EQ(started.description.name, own.description.name);
  EXPECT_GT(started.milliseconds_to_open, 0);
  finish(started);
  awaitDevice(own);  // nothing to wait for
}

TEST(StartDevice, ErrorsReachEveryThreadThatAwaits) {
  OpenedDevice device;
  startDevice("no such device", device);
  for (int i = 0; i < 2; ++i)
    EXPECT_THAT(messageOf<InputError>([&] { awaitDevice(device); }), HasSubstr("no device has this"));
}

TEST(StartDevice, ItsThreadEndsBeforeTheDevice) {
  OpenedDevice device;
  startDevice("", device);
}

}  // namespace
}  // namespace luciole::test
