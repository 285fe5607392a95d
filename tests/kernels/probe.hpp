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
#include <vector>

#include "cl/device.hpp"
#include "cl/kernel_source.hpp"
#include "kernels/guarded_buffer.hpp"

// Kernels of the tests' own, in files beside the tests, that call one function of kernels/*.clh for every
// lane.
namespace luciole::test {

inline constexpr int kAllLanes[] = {1, 4, 8, 16};

/// The program with every feature is tried with all lanes, those with fewer, which the same lines make, with
/// the extremes.
inline std::vector<int> lanesFor(const std::string& defines) {
  return defines.empty() ? std::vector<int>{1, 4, 8, 16} : std::vector<int>{1, 16};
}

/// The default device with that many lanes, opened once a process.
inline Device& deviceWithLanes(int lanes) {
  static std::map<int, Device> devices;
  Device& device = devices[lanes];
  if (!device.context()) openDevice(",lanes=" + std::to_string(lanes), device);
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

/// The bytes of a struct or of a container's elements, as probe() takes them.
template <class Struct>
std::span<const std::byte> bytesOf(const Struct& value) {
  return std::as_bytes(std::span(&value, 1));
}
template <class Element>
std::span<const std::byte> bytesOf(const std::vector<Element>& values) {
  return std::as_bytes(std::span(values));
}

/// Runs kernel `name` of tests/kernels/`file`, whose arguments are (in, out, stride, more…): a work-item
/// reads LANES cases from the columns of `in`, and writes as many of `outputs` columns, `stride` floats
/// apart. Throws std::runtime_error where the kernel wrote past the end of a buffer.
inline std::vector<Column> probe(Device& device, const std::string& file, const char* name,
                                 const std::vector<Column>& in, std::size_t outputs,
                                 const std::vector<std::span<const std::byte>>& more = {},
                                 const std::string& defines = "") {
  constexpr std::size_t kMostLanes = 16;
  const std::size_t cases = in.at(0).size();
  const std::size_t stride = (cases + kMostLanes - 1) / kMostLanes * kMostLanes;
  std::vector<float> columns;
  for (const Column& column : in) {
    columns.insert(columns.end(), column.begin(), column.end());
    columns.resize(columns.size() + stride - cases, column.back());
  }
  const std::size_t output_bytes = outputs * stride * sizeof(float);
  std::deque<GuardedBuffer> buffers;
  buffers.emplace_back(device, bytesOf(columns));
  const GuardedBuffer& output = buffers.emplace_back(device, output_bytes);
  for (const std::span<const std::byte> bytes : more) buffers.emplace_back(device, bytes);
  Kernel kernel = makeKernelFromSource(device, probeSource(file), name, defines);
  kernel.setArg(0, buffers[0].buffer());
  kernel.setArg(1, output.buffer());
  kernel.setArg(2, static_cast<cl_uint>(stride));
  for (std::size_t i = 0; i < more.size(); ++i)
    kernel.setArg(static_cast<cl_uint>(3 + i), buffers[2 + i].buffer());
  launch(device, kernel, stride / device.description.lanes, 1);
  for (std::size_t i = 0; i < buffers.size(); ++i)
    if (!buffers[i].intact(device))
      throw std::runtime_error(std::string(name) + " wrote past the end of buffer " + std::to_string(i));
  std::vector<float> values(outputs * stride);
  device.queue.enqueueReadBuffer(output.buffer(), CL_TRUE, 0, output_bytes, values.data());
  std::vector<Column> out;
  for (std::size_t i = 0; i < outputs; ++i)
    out.emplace_back(values.begin() + i * stride, values.begin() + i * stride + cases);
  return out;
}

}  // namespace luciole::test
