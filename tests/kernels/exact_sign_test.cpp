#include "kernels/exact/exact_sign.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <ostream>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "kernels/probe.hpp"

namespace luciole::test {
namespace {

using Point = std::array<float, 3>;
using Case = std::array<Point, 4>;

struct Signs {
  int orientation, along;
  bool operator==(const Signs&) const = default;
};

std::ostream& operator<<(std::ostream& stream, const Signs& signs) {
  return stream << "orientation " << signs.orientation << ", along " << signs.along;
}

/// Adds up products of three floats in one fixed-point number that holds every bit of any of them.
class ExactSum {
 public:
  void add(int sign, float x, float y, float z) {
    __int128 product = sign;
    int exponent = 0;
    for (const float factor : {x, y, z}) {
      int own = 0;
      product *= std::int64_t(std::ldexp(std::frexp(double(factor), &own), 24));
      exponent += own - 24;
    }
    if (product == 0) return;
    // 2⁻¹⁴⁹ is 2²³ times 2⁻¹⁷².
    const int shift = exponent + 3 * 172;
    auto bits = static_cast<unsigned __int128>(product < 0 ? -product : product) << shift % 32;
    for (std::size_t i = shift / 32; bits != 0; ++i, bits >>= 32) {
      const auto digit = static_cast<std::int64_t>(bits & 0xffffffff);
      digits_.at(i) += product < 0 ? -digit : digit;
    }
  }
  int sign() const {
    std::int64_t carry = 0, any = 0;
    for (const std::int64_t digit : digits_) {
      any |= (digit + carry) & 0xffffffff;
      carry = (digit + carry) >> 32;
    }
    return carry < 0 ? -1 : (any | carry) != 0;
  }

 private:
  std::array<std::int64_t, 32> digits_{};  ///< times 2³²ⁱ; carried over only at the end
};

/// sum += sign · det(p, q, r), as six products.
void addDeterminant(ExactSum& sum, int sign, const Point& p, const Point& q, const Point& r) {
  for (int x = 0; x < 3; ++x) {
    const int y = (x + 1) % 3, z = (x + 2) % 3;
    sum.add(sign, p[x], q[y], r[z]);
    sum.add(-sign, p[x], q[z], r[y]);
  }
}

/// What is right, by determinants of the points themselves: no difference is taken.
Signs signsOf(const Case& points) {
  const auto& [a, b, c, l] = points;
  ExactSum orientation, along;
  addDeterminant(orientation, 1, a, b, c);
  addDeterminant(orientation, -1, l, b, c);
  addDeterminant(orientation, -1, a, l, c);
  addDeterminant(orientation, -1, a, b, l);
  addDeterminant(along, 1, a, b, l);
  addDeterminant(along, -1, c, b, l);
  addDeterminant(along, -1, a, c, l);
  return {orientation.sign(), -along.sign()};
}

std::vector<Signs> signsOf(const std::vector<Case>& cases) {
  std::vector<Signs> signs;
  for (const Case& points : cases) signs.push_back(signsOf(points));
  return signs;
}

float4 vectorOf(const Point& point) { return {point[0], point[1], point[2], NAN}; }

Signs hostSigns(const Case& points) {
  const float4 a = vectorOf(points[0]), b = vectorOf(points[1]), c = vectorOf(points[2]),
               l = vectorOf(points[3]);
  return {orientation(a, b, c, l), orientation_along(a, b, c, l)};
}

Signs hostSignsByIntegers(const Case& points) {
  const float4 a = vectorOf(points[0]), b = vectorOf(points[1]), c = vectorOf(points[2]),
               l = vectorOf(points[3]);
  return {determinant_sign_by_integers(a, b, l, c, l), -determinant_sign_by_integers(a, b, c, l, float4{})};
}

std::vector<Signs> deviceSigns(const std::vector<Case>& cases, int lanes, const std::string& defines) {
  std::vector<Column> in(12);
  for (const Case& points : cases)
    for (std::size_t i = 0; i < in.size(); ++i) in[i].push_back(points[i / 3][i % 3]);
  const std::vector<Column> out =
      probe(deviceWithLanes(lanes), "exact_sign_probe.cl", "probe_exact_sign", in, 2, {}, defines);
  std::vector<Signs> signs;
  for (std::size_t i = 0; i < cases.size(); ++i) signs.push_back({int(out[0][i]), int(out[1][i])});
  return signs;
}

/// Tells the first difference.
void expectEqual(const std::vector<Signs>& signs, const std::vector<Signs>& expected,
                 const std::vector<Case>& cases, const std::string& where) {
  ASSERT_EQ(signs.size(), expected.size());
  for (std::size_t i = 0; i < signs.size(); ++i) {
    if (signs[i] == expected[i]) continue;
    std::string points;
    for (int k = 0; k < 12; ++k) points += fmt::format(" {:a}", cases[i][k / 3][k % 3]);
    ASSERT_EQ(signs[i], expected[i]) << where << ", case " << i << ":" << points;
  }
}

/// On the host and on the device, with and without doubles.
void expectSigns(const std::vector<Case>& cases, const std::vector<Signs>& expected) {
  std::vector<Signs> host, integers;
  for (const Case& points : cases) {
    host.push_back(hostSigns(points));
    integers.push_back(hostSignsByIntegers(points));
  }
  expectEqual(host, expected, cases, "host");
  expectEqual(integers, expected, cases, "host, by integers");
  for (const int lanes : {1, 16})
    for (const char* defines : {"", "-DNO_DOUBLES"})
      expectEqual(deviceSigns(cases, lanes, defines), expected, cases,
                  fmt::format("device, {} lanes {}", lanes, defines));
}

/// Any finite float is as likely as any other.
float anyFloat(std::mt19937& random) {
  for (;;) {
    const float value = std::bit_cast<float>(std::uint32_t(random()));
    if (std::isfinite(value)) return value;
  }
}

float withExponent(float value, int exponent) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value) & 0x807fffff;
  return std::bit_cast<float>(bits | std::uint32_t(std::clamp(exponent, 0, 254)) << 23);
}

/// Points of random bits: of all exponents, of eight that follow each other, at the ends of the range, or
/// with coordinates in common.
std::vector<Case> anyPoints(std::mt19937& random, int count) {
  constexpr float kEnds[] = {0, 0x1p-149f, 0x1.fffffcp-127f, 0x1p-126f, 0x1p127f, 0x1.fffffep127f};
  std::vector<Case> cases(count);
  for (Case& points : cases) {
    const unsigned kind = random() % 4;
    const int least = int(random() % 254);
    for (Point& point : points)
      for (float& x : point) {
        x = anyFloat(random);
        if (kind == 1) x = withExponent(x, least + int(random() % 8));
        if (kind == 2) x = std::copysign(kEnds[random() % std::size(kEnds)], x);
        if (kind == 3 && random() % 3 == 0) x = points[0][random() % 3];
      }
  }
  return cases;
}

/// Coordinates up to `most`.
Case wholeNumbers(std::mt19937& random, int most) {
  Case points{};
  for (Point& point : points)
    for (float& x : point) x = float(int(random() % (2 * most + 1)) - most);
  return points;
}

/// times 2^exponent
Case scaled(Case points, int exponent) {
  for (Point& point : points)
    for (float& x : point) x = std::ldexp(x, exponent);
  return points;
}

using WholeRow = std::array<__int128, 3>;

WholeRow wholeDifference(const Point& p, const Point& q) {
  WholeRow row{};
  for (int x = 0; x < 3; ++x) row[x] = std::int64_t(p[x]) - std::int64_t(q[x]);
  return row;
}

int wholeSign(const WholeRow& p, const WholeRow& q, const WholeRow& r) {
  __int128 sum = 0;
  for (int x = 0; x < 3; ++x) {
    const int y = (x + 1) % 3, z = (x + 2) % 3;
    sum += p[x] * (q[y] * r[z] - q[z] * r[y]);
  }
  return sum > 0 ? 1 : sum < 0 ? -1 : 0;
}

/// Of whole numbers up to 2²⁴: below 2⁷⁸.
Signs wholeSigns(const Case& points) {
  const auto& [a, b, c, l] = points;
  return {wholeSign(wholeDifference(a, l), wholeDifference(b, l), wholeDifference(c, l)),
          -wholeSign(wholeDifference(a, c), wholeDifference(b, c), wholeDifference(l, {}))};
}

TEST(ExactSignKernels, OfWholeNumbersTimesAPowerOfTwo) {
  std::mt19937 random(1);
  std::vector<Case> cases;
  std::vector<Signs> expected;
  for (int i = 0; i < 40000; ++i) {
    const Case points = wholeNumbers(random, 1 << random() % 24);
    cases.push_back(scaled(points, int(random() % 250) - 149));
    expected.push_back(wholeSigns(points));
  }
  expectSigns(cases, expected);
  expectEqual(signsOf(cases), expected, cases, "the sum that other tests compare with");
}

TEST(ExactSignKernels, OfAnyFinitePoints) {
  std::mt19937 random(2);
  const std::vector<Case> cases = anyPoints(random, 100000);
  expectSigns(cases, signsOf(cases));
}

TEST(ExactSignKernels, AreZeroInAPlaneAndTellWhatIsOneUlpBesideIt) {
  std::mt19937 random(3);
  std::vector<Case> inside, beside;
  for (int i = 0; i < 10000; ++i) {
    Case points = wholeNumbers(random, 1 << 10);
    auto& [a, b, c, l] = points;
    const int across = int(random() % 17) - 8, along = int(random() % 17) - 8;
    for (int x = 0; x < 3; ++x) c[x] = l[x] + float(across) * (a[x] - l[x]) + float(along) * (b[x] - l[x]);
    points = scaled(points, int(random() % 230) - 130);
    inside.push_back(points);
    float& moved = points[random() % 4][random() % 3];
    moved = std::nextafter(moved, random() % 2 ? INFINITY : -INFINITY);
    beside.push_back(points);
  }
  std::vector<Signs> expected = signsOf(inside);
  for (Signs& signs : expected) signs.orientation = 0;
  expectSigns(inside, expected);
  expected = signsOf(beside);
  expectSigns(beside, expected);
  EXPECT_GT(
      std::count_if(expected.begin(), expected.end(), [](Signs signs) { return signs.orientation != 0; }),
      9000);
}

TEST(ExactSignKernels, FlipWhereTwoPointsAreSwapped) {
  std::mt19937 random(4);
  std::vector<Case> cases;
  std::vector<Signs> expected;
  for (const Case& points : anyPoints(random, 20000)) {
    const Signs signs = hostSigns(points);
    const auto expectSwapped = [&](int i, int k, int along) {
      Case swapped = points;
      std::swap(swapped[i], swapped[k]);
      cases.push_back(swapped);
      expected.push_back({-signs.orientation, along});
    };
    expectSwapped(0, 1, -signs.along);
    expectSwapped(1, 2, -signs.along);
    expectSwapped(0, 2, -signs.along);
    const auto& [a, b, c, l] = points;
    expectSwapped(2, 3, signsOf(Case{a, b, l, c}).along);
  }
  expectSigns(cases, expected);
}

TEST(ExactSignKernels, OfAFarLightAreThoseAlongItsDirection) {
  std::mt19937 random(5);
  std::vector<Case> cases;
  std::vector<Signs> expected;
  while (cases.size() < 10000) {
    Case points = wholeNumbers(random, 1 << 8);
    const int along = wholeSigns(points).along;
    if (along == 0) continue;
    // With l = 2⁴⁰·d, det(p − l, q − l, r − l) = det(p − r, q − r, r) − 2⁴⁰·det(p − r, q − r, d): below 2³⁰,
    // less a whole number of 2⁴⁰.
    for (float& x : points[3]) x = std::ldexp(x, 40);
    cases.push_back(points);
    expected.push_back({along, along});
  }
  expectSigns(cases, expected);
}

// In units of the large coordinates the determinant is −12, of at most 16, whatever the exponent of the small
// one.
TEST(ExactSignKernels, FillTheIntegersOfAnyLength) {
  std::vector<Case> cases;
  for (int exponent = -149; exponent <= 127; ++exponent) {
    const float large = 0x1.fffffep127f, small = std::ldexp(1.0f, exponent);
    const Point a{large, large, small}, b{large, -large, large}, c{-large, large, large},
        l{-large, -large, -large};
    cases.push_back({a, b, c, l});
    cases.push_back({b, a, c, l});
  }
  std::vector<Signs> expected = signsOf(cases);
  for (std::size_t i = 0; i < cases.size(); ++i) expected[i].orientation = i % 2 == 0 ? -1 : 1;
  expectSigns(cases, expected);
}

/// det(a − l, b − l, c − l) in doubles, and the sum of the magnitudes of its products.
std::pair<double, double> doubleDeterminant(const Case& points) {
  const auto& [a, b, c, l] = points;
  double determinant = 0, magnitudes = 0;
  for (int x = 0; x < 3; ++x) {
    const int y = (x + 1) % 3, z = (x + 2) % 3;
    const auto difference = [&l = l](const Point& p, int i) { return double(p[i]) - l[i]; };
    const double left = difference(b, y) * difference(c, z), right = difference(b, z) * difference(c, y);
    determinant += difference(a, x) * (left - right);
    magnitudes += std::abs(difference(a, x)) * (std::abs(left) + std::abs(right));
  }
  return {determinant, magnitudes};
}

// Found by a search among determinants of two products of nearly 1 each, where all ten roundings go the wrong
// way: those of differences by nearly half an ulp, because the light is near 2⁻³⁸.
constexpr Case kWrongInDoubles[] = {
    {{{0x1.0c09e2p+0f, -0x1.12e65p+0f, 0x1.23bdf8p-38f},
      {-0x1.edd608p-38f, 0x1.094626p+0f, -0x1.0c742ap+0f},
      {-0x1.013bc2p+0f, -0x1.dbbc1p-39f, 0x1.0afaeep+0f},
      {-0x1.edd608p-38f, -0x1.dbbc1p-39f, 0x1.23bdf8p-38f}}},
    {{{0x1.0b0caep+0f, -0x1.0c17bap+0f, 0x1.8d3bfp-39f},
      {-0x1.348904p-37f, 0x1.0d0b52p+0f, -0x1.0d7436p+0f},
      {-0x1.0797ecp+0f, 0x1.1469f8p-38f, 0x1.0906aep+0f},
      {-0x1.348904p-37f, 0x1.1469f8p-38f, 0x1.8d3bfp-39f}}},
    {{{0x1.0c765cp+0f, -0x1.07ed48p+0f, 0x1.5895f8p-38f},
      {-0x1.bd3b04p-37f, 0x1.11085ep+0f, -0x1.12770ap+0f},
      {-0x1.0b4ea2p+0f, 0x1.b551f8p-38f, 0x1.082b78p+0f},
      {-0x1.bd3b04p-37f, 0x1.b551f8p-38f, 0x1.5895f8p-38f}}},
};

TEST(ExactSignKernels, AreRightWhereDoublesAreWrongByMoreThanHalfTheBound) {
  const std::vector<Case> cases(std::begin(kWrongInDoubles), std::end(kWrongInDoubles));
  for (const Case& points : cases) {
    const auto [determinant, magnitudes] = doubleDeterminant(points);
    EXPECT_GT(determinant, 4.3 * 0x1p-53 * magnitudes);
    EXPECT_EQ(signsOf(points).orientation, -1);
  }
  expectSigns(cases, signsOf(cases));
}

// In each the determinant is 2⁻¹²⁷ or, with the denormal taken for 0, of the other sign.
TEST(ExactSignKernels, AreRightWhereADenormalTakenForZeroTurnsThem) {
  constexpr float kNormal = 0x1p-126f, kDenormal = 0x1.fffffcp-127f;
  std::vector<Case> cases;
  for (const float side : {1.0f, -1.0f})
    for (const int exponent : {-60, 0, 60}) {
      const float far = std::ldexp(1.0f, exponent);
      cases.push_back({{{kNormal, side * kDenormal, 0}, {far, side * 0.5f * far, 0}, {0, 0, far}, {}}});
      cases.push_back({{{kNormal, side * kDenormal, 0}, {far, side * 0.5f * far, 0}, {}, {0, 0, far}}});
    }
  expectSigns(cases, signsOf(cases));
}

}  // namespace
}  // namespace luciole::test
