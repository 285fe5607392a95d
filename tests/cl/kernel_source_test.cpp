#include "cl/kernel_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace luciole::test {
namespace {

TEST(KernelSource, IncludesAppearOnceAndLinesKeepTheirNumbers) {
  const std::string source =
      expandKernelSource("own.cl", "#include \"math.clh\"\n#include \"lanes.clh\"\nlast line");
  EXPECT_THAT(source, testing::StartsWith("#line 1 \"kernels/own.cl\"\n#line 1 \"kernels/math.clh\"\n"));
  EXPECT_THAT(source, testing::EndsWith("#line 2 \"kernels/own.cl\"\n\nlast line"));
  const std::size_t first = source.find("#line 1 \"kernels/lanes.clh\"");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(source.find("#line 1 \"kernels/lanes.clh\"", first + 1), std::string::npos);
  EXPECT_EQ(source.find("#include"), std::string::npos);
}

TEST(KernelSource, AnUnknownFileIsAMistakeOfTheProgram) {
  EXPECT_THROW(kernelSource("no_such.cl"), std::logic_error);
  EXPECT_THROW(expandKernelSource("own.cl", "#include \"no_such.clh\"\n"), std::logic_error);
}

}  // namespace
}  // namespace luciole::test
