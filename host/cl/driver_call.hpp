#pragma once

#include <CL/opencl.hpp>
#include <exception>
#include <utility>

namespace luciole {

/// Calls OpenCL and passes on its cl::Error. Any other exception, such as bad_alloc of a compiler written in
/// C++, has unwound a driver's C code and left its locks taken, so further calls of the driver could block
/// for ever. So the program ends then, by std::terminate(), whose handler can see the exception. `call` must
/// not own an OpenCL object that existed before the call.
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
