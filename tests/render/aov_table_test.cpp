#include "render/aov_table.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace luciole::test {
namespace {

TEST(AovTable, DescribesEveryLayerOnceAndInOrder) {
  std::set<std::string> names, channels;
  for (std::size_t i = 0; i < kAovCount; ++i) {
    const AovRow& row = aovTable()[i];
    EXPECT_EQ(row.aov, Aov(i)) << row.name;
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    for (const std::string& channel : row.channels) EXPECT_TRUE(channels.insert(channel).second) << channel;
  }
}

}  // namespace
}  // namespace luciole::test
