#pragma once

#include <CL/opencl.hpp>
#include <map>
#include <string>
#include <vector>

namespace luciole {

/// An argument as the kernel's source declares it.
struct DeclaredArgument {
  std::string name, type;
  cl_kernel_arg_address_qualifier space;
  bool is_const;  ///< what it points to
};

/// The arguments of kernels, in order, by the kernels' names.
using KernelArguments = std::map<std::string, std::vector<DeclaredArgument>>;

/// A program that is built for a device.
struct Program {
  cl::Program program;
  /// Of all its kernels, if it was built from a binary: OpenCL provides them only for programs built from
  /// source.
  KernelArguments arguments;
  /// Its description (describeProgram) until it is on the list of what PoCL has kept (pocl_cache.hpp).
  std::string unlisted = {};
  bool is_quick = false;      ///< compiled without optimization
  bool is_of_a_user = false;  ///< has a text of a user's
};

}  // namespace luciole
