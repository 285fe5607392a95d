#include "tools/bench/speed_table.hpp"

#include <algorithm>

namespace luciole {

SpeedCell quotient(double over, double under, const std::string& why) {
  if (under == 0) return NoValue{why};
  return over / under;
}

SpeedCell ratio(const std::vector<double>& over, const std::vector<double>& under) {
  if (std::find(under.begin(), under.end(), 0.0) != under.end())
    return NoValue{"a time is too short to be measured"};
  std::vector<double> ratios;
  for (std::size_t i = 0; i < over.size(); ++i) ratios.push_back(over[i] / under[i]);
  return summarize(ratios);
}

}  // namespace luciole
