#include "figures/stage_figures.hpp"

namespace luciole {

double stageTime(const Stats& stats, Stage stage) {
  for (const auto& [known, milliseconds] : stats.stages)
    if (known == stage) return milliseconds;
  return 0;
}

double countOf(const Stats& stats, std::string_view name) {
  for (const auto& [known, count] : stats.counts)
    if (known == name) return double(count);
  return 0;
}

}  // namespace luciole
