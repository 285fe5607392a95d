#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace luciole {

/// An operation of kernels/check_arithmetic.clh.
struct CheckedOperation {
  const char* name;
  bool is_float;  ///< its results are floats, otherwise integers
};

/// All of them, in the order in which the kernel stores them.
std::span<const CheckedOperation> checkedOperations();

/// Numbers a, b and c.
using Operands = std::array<float, 3>;

/// The bits that each operation gives for each case, operation by operation, as the host computes them by
/// IEEE 754 from the kernels' own text.
std::vector<std::uint32_t> hostArithmetic(std::span<const Operands> cases);

}  // namespace luciole
