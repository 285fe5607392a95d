#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace luciole {

/// Lists of items, stored one after another.
struct ItemLists {
  std::vector<std::size_t> starts;   ///< where each list starts in `items`, and the end of the last
  std::vector<std::uint32_t> items;  ///< in ascending order within a list

  std::span<const std::uint32_t> list(std::size_t i) const {
    return std::span(items).subspan(starts[i], starts[i + 1] - starts[i]);
  }
};

/// Puts items 0 to item_count − 1 into lists: for_each_list(item, visit) calls visit(list) with every list
/// that the item goes into. It is called twice for each item, in parallel. The result does not depend on the
/// number of threads. O(entries + lists).
template <class ForEachList>
ItemLists listItems(std::size_t item_count, std::size_t list_count, ForEachList for_each_list) {
  // Count, prefix sum and fill, by runs of items. In each list a run's entries follow those of the run before
  // it. The number of runs doesn't depend on the machine; it is at most 65, which bounds the table of counts.
  const std::size_t run_size = std::max<std::size_t>(4096, item_count / 64);
  const std::size_t runs = (item_count + run_size - 1) / run_size;
  // [run][list]: first the count, then where to write next
  std::vector<std::size_t> places(runs * list_count);
  const auto for_each_entry = [&](std::size_t run, auto visit) {
    const std::size_t end = std::min(item_count, (run + 1) * run_size);
    std::size_t* own = places.data() + run * list_count;
    for (std::size_t i = run * run_size; i < end; ++i)
      for_each_list(i, [&](std::size_t list) { visit(own[list], std::uint32_t(i)); });
  };
  tbb::parallel_for(std::size_t(0), runs, [&](std::size_t run) {
    for_each_entry(run, [](std::size_t& count, std::uint32_t) { ++count; });
  });
  ItemLists lists;
  lists.starts.resize(list_count + 1);
  std::size_t total = 0;
  for (std::size_t list = 0; list < list_count; ++list) {
    lists.starts[list] = total;
    for (std::size_t run = 0; run < runs; ++run) {
      const std::size_t entries = places[run * list_count + list];
      places[run * list_count + list] = total;
      total += entries;
    }
  }
  lists.starts.back() = total;
  lists.items.resize(total);
  tbb::parallel_for(std::size_t(0), runs, [&](std::size_t run) {
    for_each_entry(run, [&](std::size_t& place, std::uint32_t item) { lists.items[place++] = item; });
  });
  return lists;
}

}  // namespace luciole
