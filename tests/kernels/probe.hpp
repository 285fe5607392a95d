#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "cl/device.hpp"
#include "cl/kernel_source.hpp"
#include "raster/gbuffer.hpp"

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

/// Runs kernel `name` of tests/kernels/`file`, whose arguments are (in, out, stride, more…): a work-item
/// reads LANES cases from the columns of `in`, and writes as many of `outputs` columns, `stride` floats
/// apart.
inline std::vector<Column> probe(Device& device, const std::string& file, const char* name,
                                 const std::vector<Column>& in, std::size_t outputs,
                                 const std::vector<cl::Buffer>& more = {}, const std::string& defines = "") {
  constexpr std::size_t kMostLanes = 16;
  const std::size_t cases = in.at(0).size();
  const std::size_t stride = (cases + kMostLanes - 1) / kMostLanes * kMostLanes;
  Plane columns;
  for (const Column& column : in) {
    columns.insert(columns.end(), column.begin(), column.end());
    columns.resize(columns.size() + stride - cases, column.back());
  }
  const cl::Buffer input = inputBuffer(device, columns),
                   output = deviceBuffer(device, outputs * stride * sizeof(float));
  Kernel kernel = makeKernelFromSource(device, probeSource(file), name, defines);
  kernel.setArg(0, input);
  kernel.setArg(1, output);
  kernel.setArg(2, static_cast<cl_uint>(stride));
  for (std::size_t i = 0; i < more.size(); ++i) kernel.setArg(static_cast<cl_uint>(3 + i), more[i]);
  launch(device, kernel, stride / device.description.lanes, 1);
  std::vector<float> values(outputs * stride);
  readBuffer(device, output, values.data(), values.size() * sizeof(float));
  std::vector<Column> out;
  for (std::size_t i = 0; i < outputs; ++i)
    out.emplace_back(values.begin() + i * stride, values.begin() + i * stride + cases);
  return out;
}

}  // namespace luciole::test
