#include "raster/list_items.hpp"

#include <gtest/gtest.h>

namespace luciole::test {
namespace {

/// The lists that an item goes into: none, one or several.
template <class Visit>
void visitLists(std::size_t item, std::size_t list_count, Visit visit) {
  for (std::size_t list = item % 5; list < list_count; list += 3 + item % 7) visit(list);
}

class ListItems : public testing::TestWithParam<std::size_t> {};

TEST_P(ListItems, EveryListHasItsItemsInOrder) {
  constexpr std::size_t kLists = 11;
  std::vector<std::vector<std::uint32_t>> expected(kLists);
  for (std::size_t i = 0; i < GetParam(); ++i)
    visitLists(i, kLists, [&](std::size_t list) { expected[list].push_back(std::uint32_t(i)); });
  const ItemLists lists =
      listItems(GetParam(), kLists, [](std::size_t item, auto visit) { visitLists(item, kLists, visit); });
  ASSERT_EQ(lists.starts.size(), kLists + 1);
  for (std::size_t list = 0; list < kLists; ++list) {
    const auto items = lists.list(list);
    EXPECT_EQ(std::vector<std::uint32_t>(items.begin(), items.end()), expected[list]) << list;
  }
}

// 4096 items are counted together, and from 64 · 4096 on more.
INSTANTIATE_TEST_SUITE_P(Items, ListItems, testing::Values(0, 1, 4095, 4096, 4097, 50000, 64 * 4096 + 1),
                         testing::PrintToStringParamName());

TEST(ListItemsOfNoLists, AreNone) {
  const ItemLists lists = listItems(3, 0, [](std::size_t, auto) {});
  EXPECT_EQ(lists.starts, std::vector<std::size_t>{0});
  EXPECT_TRUE(lists.items.empty());
}

}  // namespace
}  // namespace luciole::test
