#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cl/device.hpp"
#include "tools/devices/host_arithmetic.hpp"

namespace luciole {

/// An operation whose result on a device differs from the standard's, with the first case that shows it.
struct WrongOperation {
  std::string name;
  Operands operands;
  bool is_float;
  std::uint32_t got, expected;
};

/// The cases that checkArithmetic() tries: signed zeroes, ones and their neighbours, ties, numbers at which
/// integers end, infinities and NaN, each with each, and numbers at random whose products all but cancel.
std::vector<Operands> hardOperands();

/// Compares results of the kernel check_arithmetic, operation by operation, with hostArithmetic(). A NaN is
/// as good as any other, and a denormal as a zero. Returns each operation that is wrong, once.
std::vector<WrongOperation> wrongOperations(std::span<const Operands> cases,
                                            std::span<const std::uint32_t> results);

/// A line that says what is wrong: "a / b of a = 1, b = 3 and c = 0 gives 0.3333333 (0x3eaaaaaa), not ...".
std::string describe(const WrongOperation& wrong);

/// A device's results for hardOperands().
struct ArithmeticCheck {
  std::vector<std::string> wrong;  ///< a line for each operation that is (see describe())
  /// Of all results, with one NaN and denormals flushed: devices with the same hash compute alike.
  std::string sha256;
};

/// Runs every operation that kernels are made of on the device. Throws MachineError.
ArithmeticCheck checkArithmetic(OpenedDevice& device);

/// The same, from luciole/checks in the user's cache if this version of the program has checked this device
/// with this driver and these lanes before. Throws MachineError.
ArithmeticCheck knownArithmetic(OpenedDevice& device);

/// The PictureHash of a small picture that the device makes of a scene of its own: lights of all kinds,
/// highlights, fog and culling, without shadows. Throws MachineError.
std::string checkPicture(OpenedDevice& device);

/// The result of checkPicture() on a device that conforms to the standard.
extern const char* const kCheckedPicture;

}  // namespace luciole
