#include "base/did_you_mean.hpp"

#include <gtest/gtest.h>

#include <tuple>

namespace luciole::test {
namespace {

TEST(EditDistance, CountsLettersInsertedLeftOutReplacedAndSwapped) {
  for (const auto& [a, b, distance] : {std::tuple{"", "", 0u},
                                       {"abc", "abc", 0u},
                                       {"", "abc", 3u},
                                       {"shadow", "shadows", 1u},
                                       {"smples", "samples", 1u},
                                       {"pfc", "pcf", 1u},
                                       {"kitten", "sitting", 3u},
                                       {"ca", "abc", 3u},  // no letter is edited twice
                                       {"ab", "ba", 1u},
                                       {"abcd", "badc", 2u}}) {
    EXPECT_EQ(editDistance(a, b), distance) << a << " " << b;
    EXPECT_EQ(editDistance(b, a), distance) << b << " " << a;
  }
}

TEST(DidYouMean, NamesTheNearestOrNone) {
  const std::vector<std::string> names{"--shadows", "--shadow-memory", "--shading", "--size", "--samples"};
  EXPECT_EQ(didYouMean("--shadow", names), "; did you mean --shadows?");
  EXPECT_EQ(didYouMean("-size", names), "; did you mean --size?");
  EXPECT_EQ(didYouMean("--sahding", names), "; did you mean --shading?");
  EXPECT_EQ(didYouMean("--shadow-m", names), "; did you mean --shadow-memory?");
  EXPECT_EQ(didYouMean("--frobnicate", names), "");
  EXPECT_EQ(didYouMean("--s", names), "") << "one letter says nothing";
  EXPECT_EQ(didYouMean("", names), "");
  EXPECT_EQ(didYouMean("x", {"y"}), "") << "all of it is wrong";
}

}  // namespace
}  // namespace luciole::test
