#pragma once

#include <CL/opencl.hpp>
#include <exception>
#include <utility>

namespace luciole {

/// Calls OpenCL, and throws its cl::Error. Any other exception, as bad_alloc of a compiler written in C++,
/// has come through a driver's C code and left its locks taken: who asks it again, or releases what it made,
/// may wait for ever. So the program ends then, by std::terminate(), whose handler can look at the exception.
/// Nothing in `call` may own an object of OpenCL that was there before the call.
template <class Call>
decltype(auto) callDriver(Call&& call) {
  try {
    return std::forward<Call>(call)();
  } catch (const cl::Error&) {
    throw;
  } catch (...) {
    std::terminate();
  }
}

}  // namespace luciole
