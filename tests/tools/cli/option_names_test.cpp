#include "tools/cli/option_names.hpp"

#include <gtest/gtest.h>

namespace luciole::test {
namespace {

TEST(OptionNames, TakeThePlaceOfFieldsOfTheLibrary) {
  EXPECT_EQ(withOptionNames("settings.crop: 0,0,9,9: not inside"), "--crop 0,0,9,9: not inside");
  EXPECT_EQ(withOptionNames("settings.aovs: a map shows one object"), "--aov: a map shows one object");
  EXPECT_EQ(withOptionNames("a.png: .png has no 16-bit floats (options.half), expected .exr"),
            "a.png: .png has no 16-bit floats (--half), expected .exr");
  EXPECT_EQ(withOptionNames("device: 7: there are 2 devices"),
            "--device 7: there are 2 devices (see luciole devices)");
}

TEST(OptionNames, LeaveWhatAFileIsCalled) {
  EXPECT_EQ(withOptionNames("my device: x.json: not there"), "my device: x.json: not there");
  EXPECT_EQ(withOptionNames("changes.json: not there"), "changes.json: not there");
}

}  // namespace
}  // namespace luciole::test
