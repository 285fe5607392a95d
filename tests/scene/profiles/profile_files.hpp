#pragma once

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace luciole::test {

/// What a file of a luminaire says.
struct LampText {
  std::string head = "IESNA:LM-63-2002\n[TEST] made by a test\n[MANUFAC] none\n";
  std::string tilt = "TILT=NONE\n";
  int type = 1;  ///< 1: C, 2: B, 3: A
  double multiplier = 1, ballast = 1, factor = 1;
  std::vector<double> vertical{0, 45, 90}, horizontal{0};
  std::function<double(double vertical, double horizontal)> candela = [](double, double) { return 100; };
};

/// Its text in IES LM-63.
inline std::string iesText(const LampText& lamp) {
  std::string text = lamp.head + lamp.tilt;
  text += fmt::format("2 900 {} {} {} {} 2 0.1 0.2 0\n{} {} 40\n", lamp.multiplier, lamp.vertical.size(),
                      lamp.horizontal.size(), lamp.type, lamp.ballast, lamp.factor);
  text += fmt::format("{}\n{}\n", fmt::join(lamp.vertical, " "), fmt::join(lamp.horizontal, "\n"));
  for (const double horizontal : lamp.horizontal) {
    for (const double vertical : lamp.vertical)
      text += fmt::format("{} ", lamp.candela(vertical, horizontal));
    text += "\n";
  }
  return text;
}

/// The same light in EULUMDAT, of lamps of 2,000 lumens: planes at these angles, of which `stored` (their
/// places in `planes`) have their values told.
inline std::string ldtText(int symmetry, const std::vector<double>& planes, const std::vector<int>& stored,
                           const std::vector<double>& angles,
                           const std::function<double(double vertical, double horizontal)>& candela) {
  std::string text = fmt::format("none\n1\n{}\n{}\n0\n{}\n0\n", symmetry, planes.size(), angles.size());
  text += "report\nlamp\n1\nlamp.ldt\ntoday\n100\n0\n50\n90\n0\n0\n0\n0\n0\n100\n80\n1\n0\n";
  text += "1\n-1\nLED\n2000\n3000\n80\n12,5\n";
  for (int i = 0; i < 10; ++i) text += "0.5\n";
  for (const double plane : planes) text += fmt::format("{}\n", plane);
  for (const double angle : angles) text += fmt::format("{}\n", angle);
  for (const int i : stored)
    for (const double angle : angles) text += fmt::format("{}\n", candela(angle, planes[std::size_t(i)]) / 2);
  return text;
}

inline std::vector<double> evenAngles(double from, double to, int cells) {
  std::vector<double> angles;
  for (int i = 0; i <= cells; ++i) angles.push_back(from + (to - from) * i / cells);
  return angles;
}

}  // namespace luciole::test
