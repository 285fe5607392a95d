#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <fstream>
#include <map>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cl/kernel_source.hpp"
#include "cl/launch.hpp"
#include "kernels/guarded_buffer.hpp"
#include "long_run.hpp"

// Kernels of the tests' own, in files beside the tests, that call one function of kernels/*.clh for every
// lane.
namespace luciole::test {

inline constexpr int kAllLanes[] = {1, 4, 8, 16};

/// The lanes at which whole passes and pictures are tried: the narrowest and the widest. Kernels' functions
/// are tried at every width, as are the pictures with stored hashes and random ones. LUCIOLE_LONG tries all
/// here, too.
inline std::vector<int> widths() {
  return longRun() ? std::vector<int>{1, 4, 8, 16} : std::vector<int>{1, 16};
}

/// The program with every feature is tried with all lanes, those with fewer, which the same lines make, with
/// the extremes.
inline std::vector<int> lanesFor(const std::string& defines) {
  return defines.empty() ? std::vector<int>{1, 4, 8, 16} : std::vector<int>{1, 16};
}

/// The default device with that many lanes, opened once a process. Only at 16 lanes, the width of most
/// processors, are its programs optimized: the others, compiled sooner, have the same bits.
/// LUCIOLE_LONG has all of them optimized.
inline OpenedDevice& deviceWithLanes(int lanes) {
  static std::map<int, OpenedDevice> devices;
  OpenedDevice& device = devices[lanes];
  if (!device.context()) {
    openDevice(",lanes=" + std::to_string(lanes), device);
    device.optimizes &= lanes == 16 || longRun();
  }
  return device;
}

/// tests/kernels/`file` with the includes from kernels/ put in place.
inline std::string probeSource(const std::string& file) {
  std::ifstream stream(std::filesystem::path(LUCIOLE_SOURCE_DIR) / "tests" / "kernels" / file);
  if (!stream) throw std::runtime_error("no file tests/kernels/" + file);
  std::stringstream text;
  text << stream.rdbuf();
  return expandKernelSource(file, text.str());
}

/// One value for each case.
using Column = std::vector<float>;

/// What a kernel reads beside the columns: the name of its argument, and the struct or the elements there.
struct ProbeInput {
  template <class Struct>
  ProbeInput(const char* of_argument, const Struct& value)
      : name(of_argument), bytes(std::as_bytes(std::span(&value, 1))), argument(argumentOf<Struct>) {}
  template <class Element>
  ProbeInput(const char* of_argument, const std::vector<Element>& values)
      : name(of_argument), bytes(std::as_bytes(std::span(values))), argument(argumentOf<Element>) {}

  const char* name;
  std::span<const std::byte> bytes;
  KernelArgument (*argument)(const char* name, const GuardedBuffer& buffer);

 private:
  template <class Element>
  static KernelArgument argumentOf(const char* name, const GuardedBuffer& buffer) {
    return {name, buffer.as<const Element>()};
  }
};

/// Runs kernel `name` of tests/kernels/`file`, whose arguments are in, out, stride and those of `more`: a
/// work-item reads LANES cases from the columns of `in`, and writes as many of `outputs` columns, `stride`
/// floats apart. Throws std::runtime_error where the kernel wrote past the end of a buffer.
inline std::vector<Column> probe(OpenedDevice& device, const std::string& file, const char* name,
                                 const std::vector<Column>& in, std::size_t outputs,
                                 const std::vector<ProbeInput>& more = {}, const std::string& defines = "") {
  constexpr std::size_t kMostLanes = 16;
  const std::size_t cases = in.at(0).size();
  const std::size_t stride = (cases + kMostLanes - 1) / kMostLanes * kMostLanes;
  std::vector<float> columns;
  for (const Column& column : in) {
    columns.insert(columns.end(), column.begin(), column.end());
    columns.resize(columns.size() + stride - cases, column.back());
  }
  const GuardedBuffer output(device, outputs * stride * sizeof(float));
  std::deque<std::pair<std::string, GuardedBuffer>> inputs;
  std::vector<KernelArgument> arguments{{"stride", uint(stride)}, {"out", output.as<float>()}};
  const auto add = [&](const ProbeInput& input) {
    inputs.emplace_back(input.name, GuardedBuffer(device, input.bytes));
    arguments.push_back(input.argument(input.name, inputs.back().second));
  };
  add({"in", columns});
  for (const ProbeInput& input : more) add(input);
  Kernel kernel = makeKernelFromSource(device, probeSource(file), name, defines);
  launch(device, kernel, arguments, {.items = stride / std::size_t(device.description.lanes)});
  const auto expectIntact = [&](const std::string& argument, const GuardedBuffer& buffer) {
    if (!buffer.intact(device))
      throw std::runtime_error(std::string(name) + " wrote past the end of " + argument);
  };
  expectIntact("out", output);
  for (const auto& [argument, buffer] : inputs) expectIntact(argument, buffer);
  std::vector<float> values(outputs * stride);
  download(device, output.as<float>(), values);
  std::vector<Column> out;
  for (std::size_t i = 0; i < outputs; ++i)
    out.emplace_back(values.begin() + i * stride, values.begin() + i * stride + cases);
  return out;
}

}  // namespace luciole::test
