#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kernels/probe.hpp"

namespace luciole::test {
namespace {

constexpr int kEvenPoints = 32, kDensePoints = 24;
// The tables have 7 digits: half a step of the last is 5e-8 for a coordinate below 1, and half a float's step
// 3e-8.
constexpr double kTableError = 8e-8;

void expectAtGoldenAngle(int point, double radius, float x, float y) {
  const double angle = point * std::numbers::pi * (3 - std::sqrt(5.0));
  EXPECT_NEAR(x, radius * std::cos(angle), kTableError) << "point " << point;
  EXPECT_NEAR(y, radius * std::sin(angle), kTableError) << "point " << point;
}

std::vector<Column> discPoints() {
  Column numbers;
  for (int i = 0; i < kEvenPoints; ++i) numbers.push_back(float(i));
  return probe(deviceWithLanes(1), "disc_probe.cl", "probe_disc", {numbers}, 4);
}

TEST(DiscKernels, EvenPointsAreVogels) {
  const std::vector<Column> points = discPoints();
  for (int i = 0; i < kEvenPoints; ++i)
    expectAtGoldenAngle(i, std::sqrt((i + 0.5) / kEvenPoints), points[0][i], points[1][i]);
}

TEST(DiscKernels, DensePointsLieAtEqualStepsFromTheMiddle) {
  const std::vector<Column> points = discPoints();
  for (int i = 0; i < kDensePoints; ++i)
    expectAtGoldenAngle(i, (i + 0.5) / kDensePoints, points[2][i], points[3][i]);
}

}  // namespace
}  // namespace luciole::test
