// Compiles kernels/check_arithmetic.clh for the host. This file has options of its own (host/CMakeLists.txt):
// integers wrap around, as in OpenCL, and pragmas of OpenCL are no mistakes.
#include "tools/devices/host_arithmetic.hpp"

#include <bit>
#include <cmath>
#include <cstddef>

#include "kernels/shared.h"

// Where a processor has fma, fma_lanes() leaves the choice of instructions to OpenCL's compiler. Here it
// calls fma().
#undef __FMA__
#undef __ARM_FEATURE_FMA
#define STANDARD_ONLY
#define LANES 1
#define __global  // NOLINT(bugprone-reserved-identifier): a word of OpenCL C

namespace luciole {
namespace {

// NOLINTBEGIN(readability-identifier-naming): functions of OpenCL C
using std::fma;
using std::sqrt;
inline int as_int(float value) { return std::bit_cast<int>(value); }
inline float as_float(int bits) { return std::bit_cast<float>(bits); }
inline float convert_float(int value) { return float(value); }
inline int convert_int(float value) { return int(value); }
inline uint clz(uint bits) { return uint(std::countl_zero(bits)); }
// NOLINTEND(readability-identifier-naming)

#include "kernels/check_arithmetic.clh"

#define NAME_FLOAT(name, expression) {name, true},
#define NAME_INTEGER(name, expression) {name, false},
constexpr CheckedOperation kOperations[] = {EACH_FLOAT_OPERATION(NAME_FLOAT)
                                                EACH_INTEGER_OPERATION(NAME_INTEGER)};

}  // namespace

std::span<const CheckedOperation> checkedOperations() { return kOperations; }

std::vector<std::uint32_t> hostArithmetic(std::span<const Operands> cases) {
  std::vector<std::uint32_t> results(std::size(kOperations) * cases.size());
  for (std::size_t at = 0; at < cases.size(); ++at) {
    const auto [a, b, c] = cases[at];
    const int i = as_int(a), j = as_int(b);
    std::uint32_t* result = results.data() + at;
#define COMPUTE_FLOAT(name, expression)                      \
  *result = std::bit_cast<std::uint32_t>(float(expression)); \
  result += cases.size();
#define COMPUTE_INTEGER(name, expression)   \
  *result = std::uint32_t(int(expression)); \
  result += cases.size();
    EACH_FLOAT_OPERATION(COMPUTE_FLOAT)
    EACH_INTEGER_OPERATION(COMPUTE_INTEGER)
  }
  return results;
}

}  // namespace luciole
