#include "tools/devices/check_device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <filesystem>

#include "kernels/probe.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Where in results an operation's result of a case lies.
std::size_t placeOf(const std::string& operation, std::size_t which, std::size_t cases) {
  std::size_t at = which;
  for (const CheckedOperation& one : checkedOperations()) {
    if (one.name == operation) return at;
    at += cases;
  }
  throw std::logic_error("no operation " + operation);
}

/// The lines of a device that computes with these options of its compiler.
std::string wrongWith(const std::string& options, int lanes = 8) {
  OpenedDevice device;
  openDevice(",lanes=" + std::to_string(lanes), device);
  device.arithmetic += options;
  std::string lines;
  for (const std::string& line : checkArithmetic(device).wrong) lines += line + "\n";
  return lines;
}

TEST(CheckArithmetic, EveryWidthComputesAsTheHostDoesAndHasOneHash) {
  OpenedDevice& first = deviceWithLanes(1);
  const ArithmeticCheck check = checkArithmetic(first);
  EXPECT_EQ(check.sha256.size(), 64u);
  for (const int lanes : kAllLanes) {
    const ArithmeticCheck wide = checkArithmetic(deviceWithLanes(lanes));
    EXPECT_THAT(wide.wrong, IsEmpty()) << lanes;
    EXPECT_EQ(wide.sha256, check.sha256) << lanes;
  }
  EXPECT_EQ(wrongWith(" -DOWN_QUOTIENTS"), "");
}

TEST(CheckArithmetic, DenormalsMayBeKept) {
  OpenedDevice device;
  openDevice("", device);
  device.arithmetic = "-cl-fp32-correctly-rounded-divide-sqrt";
  const ArithmeticCheck check = checkArithmetic(device);
  EXPECT_THAT(check.wrong, IsEmpty());
  EXPECT_EQ(check.sha256, checkArithmetic(deviceWithLanes(device.description.lanes)).sha256);
}

// Results as each kind of device that computes otherwise might give them.
TEST(WrongOperations, AreNamedWithWhatIsGotAndExpected) {
  const std::vector<Operands> cases = hardOperands();
  const std::vector<std::uint32_t> right = hostArithmetic(cases);
  EXPECT_THAT(wrongOperations(cases, right), IsEmpty());
  for (const CheckedOperation& operation : checkedOperations()) {
    // One bit, in the last case in which it isn't a NaN.
    std::vector<std::uint32_t> results = right;
    std::size_t which = cases.size() - 1;
    const auto size = [&] { return results[placeOf(operation.name, which, cases.size())] & 0x7fffffff; };
    while (operation.is_float && (size() >= 0x7f800000 || size() < 0x00800000)) --which;
    results[placeOf(operation.name, which, cases.size())] ^= 1;
    const std::vector<WrongOperation> wrong = wrongOperations(cases, results);
    ASSERT_EQ(wrong.size(), 1u) << operation.name;
    EXPECT_EQ(wrong[0].name, operation.name);
    EXPECT_EQ(wrong[0].got ^ wrong[0].expected, 1u);
    EXPECT_EQ(wrong[0].operands, cases[which]);
  }
}

TEST(WrongOperations, AnyNanAndAFlushedDenormalAreRight) {
  const std::vector<Operands> cases{{0x1p-126f, 0.5f, 0}, {INFINITY, INFINITY, 0}};
  std::vector<std::uint32_t> results = hostArithmetic(cases);
  ASSERT_EQ(results[placeOf("a * b", 0, 2)], 0x00400000u);
  results[placeOf("a * b", 0, 2)] = 0;
  results[placeOf("a - b", 1, 2)] = 0xffc01234;
  EXPECT_THAT(wrongOperations(cases, results), IsEmpty());
  results[placeOf("a * b", 0, 2)] = 0x80000000;
  EXPECT_EQ(wrongOperations(cases, results).size(), 1u) << "the sign of a zero counts";
}

TEST(WrongOperations, ALineTellsAll) {
  EXPECT_EQ(describe({"a / b", {1, 3, 0}, true, 0x3eaaaaaa, 0x3eaaaaab}),
            "a / b of a = 1, b = 3 and c = 0 gives 0.333333313 (0x3eaaaaaa), not 0.333333343 (0x3eaaaaab)");
}

// Devices that compute otherwise, made of PoCL by its compiler's options.
TEST(CheckArithmetic, ADeviceThatComputesOtherwiseIsFound) {
  EXPECT_THAT(wrongWith(" -cl-finite-math-only -cl-unsafe-math-optimizations"), HasSubstr("a / b of a = "));
  const std::string wrong = wrongWith(" -DEXP2_DEGREE=5");
  for (const char* operation : {"2^(a b) of", "e^-a of", "(1 - a)^b of"})
    EXPECT_THAT(wrong, HasSubstr(operation));
  for (const char* operation : {"a / b of", "log2(1 - a) of"}) EXPECT_THAT(wrong, Not(HasSubstr(operation)));
}

TEST(KnownArithmetic, IsRememberedForADeviceItsOptionsAndLanes) {
  const TemporaryFolder folder;
  const char* const before = std::getenv("XDG_CACHE_HOME");
  const std::string kept = before ? before : "";
  setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
  const auto files = [&] {
    const std::filesystem::path place = folder.path() / "luciole" / "checks";
    std::vector<std::string> paths;
    if (!std::filesystem::exists(place)) return paths;
    for (const auto& entry : std::filesystem::directory_iterator(place)) paths.push_back(entry.path());
    return paths;
  };
  OpenedDevice& device = deviceWithLanes(4);
  const ArithmeticCheck check = knownArithmetic(device);
  EXPECT_THAT(check.wrong, IsEmpty());
  ASSERT_EQ(files().size(), 1u);
  std::string known(64, 'e');
  known += "\na / b is wrong\n";
  writeText(files()[0], known);
  EXPECT_THAT(knownArithmetic(device).wrong, ElementsAre("a / b is wrong"));
  EXPECT_EQ(knownArithmetic(device).sha256, std::string(64, 'e'));
  EXPECT_EQ(knownArithmetic(deviceWithLanes(8)).sha256, check.sha256);
  EXPECT_EQ(files().size(), 2u);
  for (const std::string& file : files()) writeText(file, "damaged");
  EXPECT_EQ(knownArithmetic(device).sha256, check.sha256);
  setenv("XDG_CACHE_HOME", "/proc/nowhere", 1);
  EXPECT_EQ(knownArithmetic(device).sha256, check.sha256) << "without a cache it checks each time";
  if (before)
    setenv("XDG_CACHE_HOME", kept.c_str(), 1);
  else
    unsetenv("XDG_CACHE_HOME");
}

TEST(CheckPicture, HasItsHashAtEveryWidthAndWithOwnQuotientsAndDenormals) {
  for (const int lanes : kAllLanes) EXPECT_EQ(checkPicture(deviceWithLanes(lanes)), kCheckedPicture) << lanes;
  for (const char* arithmetic :
       {"-cl-denorms-are-zero -DOWN_QUOTIENTS", "-cl-fp32-correctly-rounded-divide-sqrt"}) {
    OpenedDevice device;
    openDevice("", device);
    device.arithmetic = arithmetic;
    EXPECT_EQ(checkPicture(device), kCheckedPicture) << arithmetic;
  }
}

}  // namespace
}  // namespace luciole::test
