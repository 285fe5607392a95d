#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cl/device.hpp"
#include "tools/devices/host_arithmetic.hpp"

namespace luciole {

/// An operation of which a device gives other bits than the standard fixes, by the first case that shows it.
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

/// What a device makes of hardOperands().
struct ArithmeticCheck {
  std::vector<std::string> wrong;  ///< a line for each operation that is (see describe())
  /// Of all results, NaNs and denormals made one: two devices with the same one compute alike.
  std::string sha256;
};

/// Runs every operation that kernels are made of on the device. Throws MachineError.
ArithmeticCheck checkArithmetic(OpenedDevice& device);

/// The same, without running anything where this version of the program has checked this device with this
/// driver and these lanes before: luciole/checks in the user's cache remembers. Throws MachineError.
ArithmeticCheck knownArithmetic(OpenedDevice& device);

/// The PictureHash of a small picture that the device makes of a scene of its own: lights of all kinds,
/// highlights, fog and culling, without shadows. Throws MachineError.
std::string checkPicture(OpenedDevice& device);

/// What checkPicture() gives on a device that computes as the standard says.
extern const char* const kCheckedPicture;

}  // namespace luciole
