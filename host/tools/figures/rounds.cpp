#include "tools/figures/rounds.hpp"

namespace luciole {

std::vector<RoundFigures> runInRounds(std::size_t rows, int rounds, const std::string& what,
                                      const OnProgress& on_progress,
                                      const std::function<std::vector<double>(std::size_t row)>& run) {
  std::vector<RoundFigures> results(rows);
  const std::size_t runs = rows * std::size_t(rounds);
  for (std::size_t done = 0; done < runs; ++done) {
    if (on_progress) on_progress(what, done, runs);
    const std::size_t round = done / rows, row = (done + round) % rows;
    const std::vector<double> figures = run(row);
    results[row].figures.resize(figures.size());
    for (std::size_t i = 0; i < figures.size(); ++i) results[row].figures[i].push_back(figures[i]);
  }
  return results;
}

}  // namespace luciole
