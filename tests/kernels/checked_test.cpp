#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include "base/embedded_files.hpp"
#include "tools/cli/run_program.hpp"

// The kernels under Oclgrind, which interprets them and reports data races between work-items, decisions on
// values that were never written, and accesses outside a buffer.
namespace luciole::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

struct Checked {
  std::string reports;
  std::set<std::string> kernels;  ///< those that ran
};

/// Runs tests/kernels/checked_pictures.cpp under Oclgrind. Left to the compiler's passes, as PoCL's are,
/// kernels hold vectors of which some elements are never written nor used, and Oclgrind 21.10 with LLVM 14
/// doesn't know those; nor does it know the compiler's own reductions.
/// counted: also find out which kernels ran, by its counts of instructions. These damage its memory where a
/// kernel calls many functions.
Checked runChecked(const std::string& argument, bool counted = true) {
  const TemporaryFolder folder;
  const Outcome outcome = runLine(
      folder, std::string("oclgrind --data-races --uninitialized --check-api --max-errors 3 --log reports") +
                  (counted ? " --inst-counts" : "") +
                  " --build-options '-disable-llvm-passes -DSTANDARD_ONLY' '" LUCIOLE_CHECKED_PICTURES "' " +
                  argument);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  Checked checked{readText(folder / "reports"), {}};
  const std::regex ran("for kernel '(\\w+)'");
  for (std::sregex_iterator it(outcome.out.begin(), outcome.out.end(), ran), end; it != end; ++it)
    checked.kernels.insert((*it)[1]);
  return checked;
}

std::set<std::string> allKernels() {
  std::set<std::string> names;
  const std::regex declared("__kernel void (\\w+)");
  for (const EmbeddedFile& file : embeddedKernels()) {
    const std::string text(file.text);
    for (std::sregex_iterator it(text.begin(), text.end(), declared), end; it != end; ++it)
      names.insert((*it)[1]);
  }
  return names;
}

TEST(CheckedKernels, AMistakeIsReported) {
  LUCIOLE_NEEDS_PROGRAM("oclgrind", "oclgrind");
  EXPECT_THAT(runChecked("race").reports, HasSubstr("data race"));
  EXPECT_THAT(runChecked("uninitialized").reports, HasSubstr("uninitialized value"));
  EXPECT_THAT(runChecked("overrun").reports, HasSubstr("Invalid write"));
}

/// The kernels that a picture must run for its check to count. Pictures 3, with exact shadows, 6, with soft
/// ones, and 4 and 8, with none, run all of them together.
std::set<std::string> kernelsToRun(int picture) {
  if (picture == 4 || picture == 8) return {"shade_tiles"};
  std::set<std::string> names{"shade", "count_in_range"};
  if (picture >= 15) names.insert({"beam_shadows", "pair_rays"});
  if (picture == 17) names.insert("open_pairs");
  if (picture == 3 || picture == 6) {
    names = allKernels();
    names.erase("shade_tiles");
    names.erase("clustered_light");
    names.erase("sampled_light");
    names.erase("light_rays");  // of no picture: CheckedRays
    names.erase("ray_starts");
    names.erase("pair_rays");  // of soft exact shadows
    names.erase("open_pairs");
    names.erase("check_arithmetic");  // of no picture: cli/check_device_test.cpp
    if (picture == 3) {
      names.erase("pair_visibility");
      names.erase("find_needed");
    } else {
      names.erase("beam_shadows");
    }
  }
  return names;
}

class CheckedPictures : public testing::TestWithParam<int> {};

TEST_P(CheckedPictures, HaveNoReports) {
  LUCIOLE_NEEDS_PROGRAM("oclgrind", "oclgrind");
  const Checked checked = runChecked(std::to_string(GetParam()));
  EXPECT_EQ(checked.reports, "");
  EXPECT_THAT(checked.kernels, IsSupersetOf(kernelsToRun(GetParam())));
}

class CheckedClusters : public testing::TestWithParam<int> {};

TEST_P(CheckedClusters, HaveNoReports) {
  LUCIOLE_NEEDS_PROGRAM("oclgrind", "oclgrind");
  // The program fails where the kernel gives no light.
  EXPECT_EQ(runChecked("clusters" + std::to_string(GetParam()), false).reports, "");
}

class CheckedRays : public testing::TestWithParam<int> {};

TEST_P(CheckedRays, HaveNoReports) {
  LUCIOLE_NEEDS_PROGRAM("oclgrind", "oclgrind");
  // The program fails where all rays are lit, or none.
  EXPECT_EQ(runChecked("rays" + std::to_string(GetParam()), false).reports, "");
}

class CheckedSamples : public testing::TestWithParam<int> {};

TEST_P(CheckedSamples, HaveNoReports) {
  LUCIOLE_NEEDS_PROGRAM("oclgrind", "oclgrind");
  // The program fails where the kernel gives no light.
  EXPECT_EQ(runChecked("sampled" + std::to_string(GetParam()), false).reports, "");
}

INSTANTIATE_TEST_SUITE_P(Lanes, CheckedSamples, testing::Values(1, 4, 8), testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Lanes, CheckedRays, testing::Values(1, 4, 8), testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Lanes, CheckedClusters, testing::Values(1, 4, 8), testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Number, CheckedPictures, testing::Range(0, 18), testing::PrintToStringParamName());

}  // namespace
}  // namespace luciole::test
