#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace luciole {

/// The vectors one after another, copied in parallel into the memory of `all`.
template <class Vector>
Vector concatenate(const std::vector<Vector>& parts, Vector all = {}) {
  std::vector<std::size_t> starts(parts.size());
  std::size_t total = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    starts[i] = total;
    total += parts[i].size();
  }
  all.resize(total);
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) {
    std::copy(parts[i].begin(), parts[i].end(), all.begin() + std::ptrdiff_t(starts[i]));
  });
  return all;
}

}  // namespace luciole
