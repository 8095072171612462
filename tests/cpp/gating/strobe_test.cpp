// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/gating/strobe.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/gating/strobe_echo.hpp"
#include "wakeline/motion/constant_velocity.hpp"

namespace wakeline::strobe_test {
namespace {

using Point = Vec<double, 2>;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Point polar(double range_m, double bearing_rad) { return range_m * towards(bearing_rad); }

/// A picture with its memory.
template <std::unsigned_integral Amplitude = std::uint8_t>
struct Picture {
  std::vector<Amplitude> memory;
  AmplitudeImage<Amplitude> image;

  Picture(int sweeps, int cells, double first_azimuth_rad, double step_rad, double start_m,
          double cell_m)
      : memory(static_cast<std::size_t>(sweeps) * static_cast<std::size_t>(cells)),
        image{memory.data(), sweeps, cells, first_azimuth_rad, step_rad, start_m, cell_m} {}

  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;

  Amplitude& at(int sweep, int cell) {
    return memory[static_cast<std::size_t>(sweep) * static_cast<std::size_t>(image.cells) +
                  static_cast<std::size_t>(cell)];
  }

  void fill(Amplitude amplitude) { std::fill(memory.begin(), memory.end(), amplitude); }

  void sprinkle(test::Draw& draw, double density) {
    for (Amplitude& a : memory)
      a = draw.uniform(0, 1) < density ? static_cast<Amplitude>(1 + draw.uniform(0, 200)) : 0;
  }

  /// A blob of `half` cells each way, brightest in the middle.
  void blob(int sweep, int cell, int half, int peak = 200) {
    for (int s = -half; s <= half; ++s)
      for (int c = -half; c <= half; ++c) {
        const int row = (sweep + s + image.sweeps) % image.sweeps;
        at(row, cell + c) = static_cast<Amplitude>(peak - 20 * (std::abs(s) + std::abs(c)));
      }
  }
};

constexpr double kTurn = 2 * kPi<double>;

/// Half a degree by 10 m, from 500 m to 2500 m, all round.
struct Round : Picture<> {
  explicit Round(double first_azimuth_rad = 0.0)
      : Picture(720, 200, first_azimuth_rad, kTurn / 720, 500.0, 10.0) {}
};

/// A sector of 90 degrees from north to east.
struct Quadrant : Picture<> {
  Quadrant() : Picture(180, 200, deg(0.25), deg(0.5), 500.0, 10.0) {}
};

Mat<double, 2, 2> covariance(double nn, double ne, double ee) {
  Mat<double, 2, 2> matrix;
  matrix << nn, ne, ne, ee;
  return matrix;
}

/// Calls `test(picture, strobe, predicted)` for many pictures, strobes of each shape and places,
/// inside and outside, near the antenna and far.
template <class Test>
void for_many_strobes(std::uint64_t seed, double density, const Test& test) {
  test::Draw draw(seed);
  for (int k = 0; k < 60; ++k) {
    const bool round = k % 2 == 0;
    const int sweeps = static_cast<int>(draw.uniform(3, 120));
    // A turn need not be a whole number of steps.
    const double turn = kTurn * sweeps / (sweeps + draw.uniform(-0.4, 0.4));
    const double span = round ? (k % 4 == 0 ? kTurn : turn) : draw.uniform(0.1, 6.0);
    Picture<> picture(sweeps, static_cast<int>(draw.uniform(1, 60)), draw.uniform(-7, 7),
                      span / sweeps, k % 3 == 0 ? 0.0 : draw.uniform(0, 300), draw.uniform(1, 20));
    picture.sprinkle(draw, density);
    for (int s = 0; s < 10; ++s) {
      const Point predicted = polar(draw.uniform(0, 800), draw.uniform(-4, 4));
      test(picture, RadiusGate{draw.uniform(1, 300)}, predicted);
      test(picture, CovarianceStrobe{400 * draw.definite<2>(), draw.uniform(0.5, 20)}, predicted);
      test(picture, RangeBearingWindow{draw.uniform(1, 300), draw.uniform(0.01, kPi<double>)},
           predicted);
    }
  }
}

// Shapes

TEST(Strobe, ShapesAreShapes) {
  static_assert(StrobeShape<RadiusGate>);
  static_assert(StrobeShape<CovarianceStrobe>);
  static_assert(StrobeShape<RangeBearingWindow>);
}

TEST(Strobe, ChordHoldsWhatTheShapeContains) {
  test::Draw draw(1);
  int inside = 0;
  for_many_strobes(2, 0.0, [&](const Picture<>&, const auto& strobe, const Point& predicted) {
    const double bearing = draw.uniform(-4, 4);
    const double range = draw.uniform(0, 1000);
    const StrobeChord chord = strobe.chord(predicted, bearing);
    const bool held = chord.near_m <= range && range <= chord.far_m;
    EXPECT_EQ(held, strobe.contains(predicted, polar(range, bearing)));
    inside += held;
    const double off = std::abs(wrap_angle(bearing - std::atan2(predicted[1], predicted[0])));
    EXPECT_TRUE(chord.empty() || off <= strobe.half_angle_rad(predicted) + 1e-12);
  });
  EXPECT_GT(inside, 100);
}

TEST(Strobe, CovarianceOfARoundErrorIsACircle) {
  const Point predicted(900.0, -400.0);
  const CovarianceStrobe ellipse{covariance(100, 0, 100), 9.0};
  const RadiusGate circle{30.0};
  for (double bearing = -0.47; bearing < -0.36; bearing += 0.01) {
    const StrobeChord a = ellipse.chord(predicted, bearing);
    const StrobeChord b = circle.chord(predicted, bearing);
    EXPECT_EQ(a.empty(), b.empty());
    if (a.empty()) continue;
    EXPECT_NEAR(a.near_m, b.near_m, 1e-9);
    EXPECT_NEAR(a.far_m, b.far_m, 1e-9);
  }
}

TEST(Strobe, InvalidShapesAreRejected) {
  EXPECT_NO_THROW((CovarianceStrobe{covariance(4, 1, 9), 9.21}.validate()));
  EXPECT_THROW((CovarianceStrobe{covariance(4, 7, 9), 9.21}.validate()), std::invalid_argument);
  EXPECT_THROW((CovarianceStrobe{covariance(kNan, 0, 9), 9.21}.validate()), std::invalid_argument);
  EXPECT_THROW((CovarianceStrobe{covariance(4, 1, 9), -1.0}.validate()), std::invalid_argument);
  EXPECT_NO_THROW((RangeBearingWindow{50, 0.1}.validate()));
  EXPECT_THROW((RangeBearingWindow{0, 0.1}.validate()), std::invalid_argument);
  EXPECT_THROW((RangeBearingWindow{50, 3.2}.validate()), std::invalid_argument);
  EXPECT_NO_THROW((StrobeSettings{10, 9}.validate()));
  EXPECT_THROW((StrobeSettings{0, 0}.validate()), std::invalid_argument);
  EXPECT_THROW((StrobeSettings{10, 10}.validate()), std::invalid_argument);
  EXPECT_THROW((StrobeSettings{10, -1}.validate()), std::invalid_argument);
}

// Which cells, which echoes: against the plainest of programs

TEST(StrobeEcho, WeighsTheCellsWhoseCentresAreInside) {
  int some = 0;
  for_many_strobes(3, 0.5, [&](const Picture<>& picture, const auto& strobe, const Point& p) {
    const AmplitudeImage<>& image = picture.image;
    int strobe_cells = 0, cells = 0;
    double weight = 0, squares = 0, range = 0;
    Point direction = Point::Zero();
    for (int s = 0; s < image.sweeps; ++s)
      for (int c = 0; c < image.cells; ++c) {
        if (!strobe.contains(p, image.position(s, c))) continue;
        ++strobe_cells;
        const double a = image.row(s)[static_cast<std::size_t>(c)];
        cells += a > 0;
        weight += a;
        squares += a * a;
        range += a * image.range_m(c);
        direction += a * towards(image.azimuth_rad(s));
      }
    const StrobeEcho echo = strobe_echo(image, strobe, p);
    EXPECT_EQ(echo.strobe_cells, strobe_cells);
    EXPECT_EQ(echo.cells, cells);
    EXPECT_EQ(echo.total_amplitude, weight);
    EXPECT_EQ(static_cast<bool>(echo), cells > 0);
    if (cells == 0) return;
    ++some;
    range /= weight;
    double range_spread = 0, common = 0;
    const double bearing = std::atan2(direction[1], direction[0]);
    for (int s = 0; s < image.sweeps; ++s)
      for (int c = 0; c < image.cells; ++c)
        if (strobe.contains(p, image.position(s, c))) {
          const double w = image.row(s)[static_cast<std::size_t>(c)] / weight;
          range_spread += w * std::pow(image.range_m(c) - range, 2);
          common += w * (image.range_m(c) - range) * std::sin(image.azimuth_rad(s) - bearing);
        }
    EXPECT_NEAR(echo.range_m, range, 1e-8);
    EXPECT_NEAR(wrap_angle(echo.bearing_rad - bearing), 0, 1e-8);
    const double n = weight * weight / squares;
    EXPECT_NEAR(echo.covariance(0, 0), std::pow(image.cell_m, 2) / 12 + range_spread / n, 1e-6);
    EXPECT_NEAR(echo.covariance(0, 1), common / n, 1e-7);
    EXPECT_NEAR(echo.covariance(1, 1),
                std::pow(image.azimuth_step_rad, 2) / 12 + 2 * (1 - direction.norm() / weight) / n,
                1e-9);
    EXPECT_TRUE(test::is_covariance(echo.covariance));
    EXPECT_TRUE(test::is_covariance(echo.position().covariance));
  });
  EXPECT_GT(some, 300);
}

/// Cells that are painted and inside, joined by walking from one to the next.
int count_echoes(const AmplitudeImage<>& image, const std::set<std::pair<int, int>>& inside) {
  std::set<std::pair<int, int>> left = inside;
  int echoes = 0;
  while (!left.empty()) {
    ++echoes;
    std::vector<std::pair<int, int>> open{*left.begin()};
    left.erase(left.begin());
    while (!open.empty()) {
      const auto [sweep, cell] = open.back();
      open.pop_back();
      for (int s = sweep - 1; s <= sweep + 1; ++s)
        for (int c = cell - 1; c <= cell + 1; ++c) {
          const int row = image.full_circle() ? (s + image.sweeps) % image.sweeps : s;
          if (left.erase({row, c})) open.emplace_back(row, c);
        }
    }
  }
  return echoes;
}

TEST(StrobeEcho, CountsEchoesThatDoNotTouch) {
  int several = 0;
  for_many_strobes(4, 0.15, [&](const Picture<>& picture, const auto& strobe, const Point& p) {
    const AmplitudeImage<>& image = picture.image;
    std::set<std::pair<int, int>> inside;
    bool touches = false;
    const auto counts = [&](int s, int c) { return image.row(s)[static_cast<std::size_t>(c)] > 0; };
    const auto holds = [&](int s, int c) { return strobe.contains(p, image.position(s, c)); };
    for (int s = 0; s < image.sweeps; ++s)
      for (int c = 0; c < image.cells; ++c)
        if (counts(s, c) && holds(s, c)) inside.emplace(s, c);
    for (const auto& [sweep, cell] : inside)
      for (int s = sweep - 1; s <= sweep + 1; ++s)
        for (int c = std::max(cell - 1, 0); c <= std::min(cell + 1, image.cells - 1); ++c) {
          const int row = image.full_circle() ? (s + image.sweeps) % image.sweeps : s;
          if (row < 0 || row >= image.sweeps) continue;
          touches = touches || (counts(row, c) && !holds(row, c));
        }
    const StrobeEcho echo = strobe_echo<2048>(image, strobe, p);
    EXPECT_EQ(echo.echoes, count_echoes(image, inside));
    EXPECT_EQ(echo.touches_edge, touches);
    several += echo.echoes > 1;
  });
  EXPECT_GT(several, 100);
}

// Where the echo is

TEST(StrobeEcho, CentreOfASymmetricBlobIsItsCentre) {
  Round picture;
  picture.blob(100, 120, 2);
  const Point centre = picture.image.position(100, 120);
  const StrobeEcho echo = strobe_echo(picture.image, RadiusGate{90.0}, centre + Point(8, -5));
  EXPECT_EQ(echo.status, StrobeStatus::kOk);
  EXPECT_EQ(echo.cells, 25);
  EXPECT_EQ(echo.echoes, 1);
  EXPECT_EQ(echo.peak_amplitude, 200);
  EXPECT_FALSE(echo.cut || echo.touches_edge);
  EXPECT_TRUE(test::matrices_near(echo.position().mean, centre, {.absolute = 1e-8}));
}

TEST(StrobeEcho, TurnsWithThePicture) {
  Round picture;
  test::Draw draw(5);
  picture.sprinkle(draw, 0.3);
  const double range = 1400.0;
  const StrobeEcho still = strobe_echo(picture.image, RadiusGate{60.0}, polar(range, 1.0));
  for (int step = 0; step < 720; step += 7) {
    // The picture turned, as another first azimuth and as other rows: across north as elsewhere.
    const double turn = step * picture.image.azimuth_step_rad;
    AmplitudeImage<> turned = picture.image;
    turned.first_azimuth_rad += turn;
    Round rolled;
    std::rotate_copy(picture.memory.begin(), picture.memory.end() - step * 200,
                     picture.memory.end(), rolled.memory.begin());
    for (const AmplitudeImage<>& image : {turned, rolled.image}) {
      const StrobeEcho echo = strobe_echo(image, RadiusGate{60.0}, polar(range, 1.0 + turn));
      EXPECT_EQ(echo.status, still.status);
      EXPECT_EQ(echo.cells, still.cells);
      EXPECT_EQ(echo.echoes, still.echoes);
      EXPECT_NEAR(echo.range_m, still.range_m, 1e-8);
      EXPECT_NEAR(wrap_angle(echo.bearing_rad - turn - still.bearing_rad), 0.0, 1e-10);
      EXPECT_LT(test::covariance_difference(echo.covariance, still.covariance), 1e-7);
    }
  }
}

TEST(StrobeEcho, BeamDoesNotShortenTheRange) {
  // A point at 20 km in a beam of 2.5 degrees: a Gaussian arc.
  Picture<> picture(1440, 200, 0.0, kTurn / 1440, 19'000.0, 10.0);
  Point plane = Point::Zero();
  double total = 0.0;
  for (int s = 0; s < 40; ++s) {
    const double off = (s - 20) * 0.25 / 1.06;  // standard deviations of the beam
    picture.at(s, 100) = static_cast<std::uint8_t>(250 * std::exp(-0.5 * off * off));
    plane += picture.at(s, 100) * picture.image.position(s, 100);
    total += picture.at(s, 100);
  }
  const Point truth = picture.image.position(20, 100);
  const StrobeEcho echo =
      strobe_echo(picture.image, RangeBearingWindow{100.0, deg(5.0)}, truth, {2, 0});
  EXPECT_NEAR((echo.position().mean - truth).norm(), 0.0, 0.5);
  EXPECT_NEAR(echo.range_m, truth.norm(), 1e-7);
  EXPECT_LT((plane / total).norm(), truth.norm() - 3.0);
}

TEST(StrobeEcho, ShipAcrossIsPutItsLengthSquaredOver24Ranges) {
  Picture<> picture(7200, 3000, 0.0, kTurn / 7200, 0.0, 0.5);
  const double range = 600.0, length = 120.0;
  for (double y = -length / 2; y <= length / 2; y += 0.05)
    picture.at(static_cast<int>(std::lround(1200 + std::atan2(y, range) / (kTurn / 7200))),
               static_cast<int>(std::hypot(range, y) / 0.5)) = 100;
  const Point truth = polar(range, 1200 * (kTurn / 7200));
  const StrobeEcho echo = strobe_echo(picture.image, RadiusGate{100.0}, truth);
  EXPECT_NEAR(echo.range_m - range, length * length / (24 * range), 0.3);
}

TEST(StrobeEcho, PedestalIsTakenFromEveryCell) {
  Round picture;
  picture.fill(10);
  picture.at(100, 120) = 60;
  picture.at(100, 121) = 110;
  const Point near = picture.image.position(100, 120);
  const StrobeEcho echo = strobe_echo(picture.image, RadiusGate{50.0}, near, {11, 10});
  EXPECT_EQ(echo.cells, 2);
  EXPECT_EQ(echo.total_amplitude, 170);
  EXPECT_NEAR(echo.range_m, picture.image.range_m(120) + 10.0 * 100 / 150, 1e-9);
}

// What else there may be

TEST(StrobeEcho, OneOfTwoEchoes) {
  Round picture;
  picture.blob(100, 120, 1, 200);
  picture.blob(100, 128, 1, 100);
  const Point strong = picture.image.position(100, 120);
  const Point weak = picture.image.position(100, 128);
  const Point predicted = picture.image.position(100, 126);
  const auto measured = [&](EchoChoice several) {
    const StrobeEcho echo =
        strobe_echo(picture.image, RadiusGate{90.0}, predicted, {.several = several});
    EXPECT_EQ(echo.status, StrobeStatus::kSeveralEchoes);
    EXPECT_EQ(echo.echoes, 2);
    return echo;
  };
  const StrobeEcho nearest = measured(EchoChoice::kNearest);
  const StrobeEcho strongest = measured(EchoChoice::kStrongest);
  const StrobeEcho all = measured(EchoChoice::kAll);
  EXPECT_TRUE(test::matrices_near(nearest.position().mean, weak, {.absolute = 1e-8}));
  EXPECT_TRUE(test::matrices_near(strongest.position().mean, strong, {.absolute = 1e-8}));
  EXPECT_EQ(all.cells, nearest.cells + strongest.cells);
  EXPECT_NEAR(
      all.range_m * all.total_amplitude,
      nearest.range_m * nearest.total_amplitude + strongest.range_m * strongest.total_amplitude,
      1e-6);
  EXPECT_GT(all.covariance(0, 0), nearest.covariance(0, 0));
}

TEST(StrobeEcho, EchoThatExtendsPastTheStrobe) {
  Round picture;
  picture.blob(100, 120, 2);
  const Point off = picture.image.position(100, 117);
  EXPECT_EQ(strobe_echo(picture.image, RadiusGate{24.5}, off).status, StrobeStatus::kTouchesEdge);
  EXPECT_EQ(strobe_echo(picture.image, RadiusGate{80.0}, off).status, StrobeStatus::kOk);
  // Only of the echo that was measured.
  picture.blob(100, 105, 1, 60);
  const RadiusGate both{105.0};
  const Point between = picture.image.position(100, 115);
  EXPECT_TRUE(
      strobe_echo(picture.image, both, between, {.several = EchoChoice::kAll}).touches_edge);
  EXPECT_FALSE(
      strobe_echo(picture.image, both, between, {.several = EchoChoice::kStrongest}).touches_edge);
}

TEST(StrobeEcho, NothingThere) {
  Round picture;
  const Point predicted = picture.image.position(100, 120);
  const StrobeEcho echo = strobe_echo(picture.image, RadiusGate{50.0}, predicted);
  EXPECT_EQ(echo.status, StrobeStatus::kEmpty);
  EXPECT_FALSE(echo);
  EXPECT_GT(echo.strobe_cells, 0);
  EXPECT_EQ(echo.echoes, 0);
  EXPECT_TRUE(std::isnan(echo.range_m));
  EXPECT_FALSE(is_finite(echo.position().mean));
  // Too weak, and between the cells.
  picture.fill(9);
  EXPECT_EQ(strobe_echo(picture.image, RadiusGate{50.0}, predicted, {10, 0}).status,
            StrobeStatus::kEmpty);
  const StrobeEcho between =
      strobe_echo(picture.image, RadiusGate{4.0}, polar(predicted.norm() + 5, deg(50)));
  EXPECT_EQ(between.status, StrobeStatus::kEmpty);
  EXPECT_EQ(between.strobe_cells, 0);
}

TEST(StrobeEcho, AllSaturated) {
  Round picture;
  picture.fill(255);
  const Point predicted = picture.image.position(100, 120);
  const StrobeEcho echo = strobe_echo(picture.image, RangeBearingWindow{52.0, deg(2.2)}, predicted);
  EXPECT_EQ(echo.status, StrobeStatus::kTouchesEdge);
  EXPECT_EQ(echo.echoes, 1);
  EXPECT_EQ(echo.cells, 11 * 9);
  EXPECT_TRUE(test::matrices_near(echo.position().mean, predicted, {.absolute = 1e-8}));
  // A strobe of the whole picture and more.
  const StrobeEcho whole = strobe_echo<1>(picture.image, RadiusGate{kInfinity}, predicted);
  EXPECT_EQ(whole.status, StrobeStatus::kCut);
  EXPECT_EQ(whole.cells, 720 * 200);
  EXPECT_EQ(whole.echoes, 1);
}

TEST(StrobeEcho, TooManyEchoesToSeparate) {
  Round picture;
  for (int s = 0; s < 720; s += 2)
    for (int c = 0; c < 200; c += 2) picture.at(s, c) = 100;
  const Point predicted = picture.image.position(100, 120);
  for (const EchoChoice several : {EchoChoice::kAll, EchoChoice::kNearest}) {
    const StrobeEcho echo = strobe_echo(picture.image, RangeBearingWindow{505.0, deg(45.1)},
                                        predicted, {.several = several});
    EXPECT_EQ(echo.status, StrobeStatus::kCrowded);
    EXPECT_TRUE(echo);
    EXPECT_EQ(echo.echoes, 0);
    EXPECT_EQ(echo.cells, 91 * 51);
    EXPECT_TRUE(test::matrices_near(echo.position().mean, predicted, {.absolute = 1e-7}));
  }
}

// The borders of the picture

TEST(StrobeEcho, BeforeTheFirstCellAndAfterTheLast) {
  Round picture;
  picture.fill(100);
  const auto at = [&](double range_m) {
    return strobe_echo(picture.image, RadiusGate{100.0}, polar(range_m, 0.01));
  };
  EXPECT_EQ(at(390.0).status, StrobeStatus::kOutside);
  EXPECT_EQ(at(2610.0).status, StrobeStatus::kOutside);
  EXPECT_TRUE(at(2610.0).cut);
  for (const double range_m : {450.0, 550.0, 2450.0, 2550.0}) {
    const StrobeEcho echo = at(range_m);
    EXPECT_TRUE(echo) << range_m;
    EXPECT_TRUE(echo.cut) << range_m;
  }
  EXPECT_FALSE(at(610.0).cut);
  EXPECT_FALSE(at(2390.0).cut);
}

TEST(StrobeEcho, BordersOfASector) {
  Quadrant picture;
  picture.blob(2, 100, 1);
  picture.blob(177, 100, 1);
  const auto at = [&](double bearing_rad) {
    return strobe_echo(picture.image, RadiusGate{60.0}, polar(1505.0, bearing_rad));
  };
  EXPECT_EQ(at(deg(1.25)).status, StrobeStatus::kCut);
  EXPECT_EQ(at(deg(-0.2)).status, StrobeStatus::kCut);
  EXPECT_EQ(at(deg(88.75)).status, StrobeStatus::kCut);
  EXPECT_EQ(at(deg(90.2)).status, StrobeStatus::kCut);
  EXPECT_EQ(at(deg(45)).status, StrobeStatus::kEmpty);
  EXPECT_FALSE(at(deg(45)).cut);
  for (const double bearing_deg : {-3.0, 93.0, 180.0, -90.0})
    EXPECT_EQ(at(deg(bearing_deg)).status, StrobeStatus::kOutside) << bearing_deg;
}

TEST(StrobeEcho, CutReportsMissingCells) {
  test::Draw draw(8);
  Picture<> picture(20, 10, 1.0, 0.05, 200.0, 20.0);
  picture.fill(1);
  int cut = 0;
  for (int k = 0; k < 300; ++k) {
    const Point predicted = polar(draw.uniform(50, 600), draw.uniform(0.5, 2.5));
    const CovarianceStrobe strobe{draw.uniform(10, 1000) * draw.definite<2>(), 5.0};
    // The cells of the picture and all around it, as if it went on.
    bool missing = false, some = false;
    for (int s = -1; s <= 20; ++s)
      for (int c = -10; c < 100; ++c)
        if (strobe.contains(predicted, picture.image.position(s, c)))
          (s >= 0 && s < 20 && c >= 0 && c < 10 ? some : missing) = true;
    const StrobeEcho echo = strobe_echo(picture.image, strobe, predicted);
    EXPECT_EQ(static_cast<bool>(echo), some);
    EXPECT_TRUE(!some || echo.cut == missing);
    cut += some && missing;
  }
  EXPECT_GT(cut, 30);
}

TEST(StrobeEcho, AntennaInside) {
  Picture<> picture(360, 100, 0.0, kTurn / 360, 0.0, 10.0);
  const RadiusGate strobe{300.0};
  const Point predicted(-40.0, 30.0);
  // One echo behind the antenna as seen from the prediction, across the first sweep.
  picture.blob(0, 10, 3);
  const StrobeEcho echo = strobe_echo(picture.image, strobe, predicted);
  EXPECT_EQ(echo.status, StrobeStatus::kOk);
  EXPECT_TRUE(test::matrices_near(echo.position().mean, Point(105.0, 0.0), {.absolute = 1e-8}));
  // A ring is one echo; it has a place all the same, if no good one.
  for (int s = 0; s < 360; ++s) picture.at(s, 20) = 50;
  const StrobeEcho ring = strobe_echo(picture.image, strobe, predicted);
  EXPECT_EQ(ring.echoes, 2);
  EXPECT_TRUE(ring);
  EXPECT_TRUE(is_finite(ring.position().mean));
  // At the antenna itself.
  const StrobeEcho here = strobe_echo(picture.image, RadiusGate{150.0}, Point(0, 0));
  EXPECT_TRUE(test::matrices_near(here.position().mean, Point(105.0, 0.0), {.absolute = 1e-8}));
}

TEST(StrobeEcho, WhatIsNotFiniteIsInvalid) {
  Round picture;
  picture.fill(100);
  const Point p(1000.0, 0.0);
  const auto invalid = [](const StrobeEcho& echo) {
    return !echo && echo.status == StrobeStatus::kInvalid;
  };
  EXPECT_TRUE(invalid(strobe_echo(picture.image, RadiusGate{50}, Point(kNan, 0))));
  EXPECT_TRUE(invalid(strobe_echo(picture.image, RadiusGate{50}, Point(0, kInfinity))));
  EXPECT_TRUE(invalid(strobe_echo(picture.image, RadiusGate{kNan}, p)));
  EXPECT_TRUE(invalid(strobe_echo(picture.image, RadiusGate{-1}, p)));
  EXPECT_TRUE(invalid(strobe_echo(picture.image, CovarianceStrobe{covariance(4, 7, 9)}, p)));
  EXPECT_TRUE(invalid(strobe_echo(picture.image, CovarianceStrobe{covariance(-4, 0, -9)}, p)));
  EXPECT_TRUE(invalid(strobe_echo(picture.image, CovarianceStrobe{covariance(kNan, 0, 9)}, p)));
  EXPECT_TRUE(invalid(strobe_echo(picture.image, RangeBearingWindow{kNan, 0.1}, p)));
  EXPECT_TRUE(invalid(strobe_echo(picture.image, RangeBearingWindow{10, kNan}, p)));
  AmplitudeImage<> image = picture.image;
  image.cell_m = 0.0;
  EXPECT_TRUE(invalid(strobe_echo(image, RadiusGate{50}, p)));
  image = picture.image;
  image.azimuth_step_rad = kNan;
  EXPECT_TRUE(invalid(strobe_echo(image, RadiusGate{50}, p)));
  image = picture.image;
  image.sweeps = 0;
  EXPECT_EQ(strobe_echo(image, RadiusGate{50}, p).status, StrobeStatus::kOutside);
  for (const double far : {1e9, 1e100, 1e300})
    EXPECT_EQ(strobe_echo(picture.image, RadiusGate{50}, Point(far, -far)).status,
              StrobeStatus::kOutside);
}

TEST(StrobeEcho, StatusInWords) {
  std::set<std::string> words;
  for (int status = 0; status <= 7; ++status)
    words.insert(to_string(static_cast<StrobeStatus>(status)));
  EXPECT_EQ(words.size(), 8u);
  EXPECT_FALSE(words.contains("unknown"));
}

TEST(StrobeEcho, SixteenBitsSeeFinerDifferences) {
  Picture<std::uint16_t> picture(720, 200, 0.0, kTurn / 720, 500.0, 10.0);
  picture.at(100, 120) = 20'000;
  picture.at(100, 121) = 60'000;
  const StrobeEcho echo =
      strobe_echo(picture.image, RadiusGate{50.0}, picture.image.position(100, 120));
  EXPECT_EQ(echo.peak_amplitude, 60'000);
  EXPECT_EQ(echo.total_amplitude, 80'000);
  EXPECT_NEAR(echo.range_m, picture.image.range_m(120) + 7.5, 1e-9);
}

TEST(StrobeEcho, TakesNoMemoryFromTheHeap) {
  Round picture;
  test::Draw draw(6);
  picture.sprinkle(draw, 0.4);
  const Point predicted = picture.image.position(719, 50);
  test::NoHeap fence;
  for (const EchoChoice several : {EchoChoice::kAll, EchoChoice::kNearest}) {
    const StrobeSettings settings{.several = several};
    const StrobeEcho circle = strobe_echo(picture.image, RadiusGate{400.0}, predicted, settings);
    const StrobeEcho ellipse = strobe_echo(
        picture.image, CovarianceStrobe{covariance(900, 200, 400)}, predicted, settings);
    EXPECT_TRUE(circle && ellipse);
    EXPECT_GT(ellipse.fix().covariance_m2(0, 0), 0.0);
  }
  EXPECT_EQ(fence.allocations(), 0);
}

// Predict, strobe, update

/// A blob that moves at 10 m/s past a radar of 0.1 degree by 6 m, plots every 3 s: the scans until
/// its echo is lost, 60 when it never is.
int scans_held(double radius_m, double& worst_error_m) {
  test::Draw draw(7);
  Ekf estimator(ConstantVelocity{.noise = WhiteAcceleration{0.05}});
  const Point start(1500.0, -900.0), velocity(2.0, 9.8);
  Mat<double, 4, 4> prior = Mat<double, 4, 4>::Identity() * 25.0;
  EXPECT_EQ(estimator.start({{start[0], velocity[0] + 1.0, start[1], velocity[1] - 1.0}, prior}),
            Status::kOk);
  worst_error_m = 0.0;
  for (int scan = 1; scan <= 60; ++scan) {
    Picture<> picture(3600, 500, 0.0, kTurn / 3600, 0.0, 6.0);
    const Point truth = start + scan * 3.0 * velocity;
    const int sweep = static_cast<int>(std::lround(std::atan2(truth[1], truth[0]) / deg(0.1)));
    for (int s = sweep - 20; s <= sweep + 20; ++s)
      for (int c = 0; c < 500; ++c) {
        const int row = (s + 3600) % 3600;
        const double d2 = (picture.image.position(row, c) - truth).squaredNorm() / (8.0 * 8.0);
        if (d2 < 4.0)
          picture.at(row, c) =
              static_cast<std::uint8_t>(200 * std::exp(-0.5 * d2) * draw.uniform(0.5, 1.0));
      }
    EXPECT_EQ(estimator.predict(3.0), Status::kOk);
    const Vec<double, 4> mean = estimator.estimate().mean;
    const StrobeEcho echo =
        strobe_echo(picture.image, RadiusGate{radius_m}, Point(mean[0], mean[2]));
    if (!echo) {
      EXPECT_EQ(echo.status, StrobeStatus::kEmpty);
      return scan;
    }
    EXPECT_TRUE(estimator.update(echo.fix(), echo.position().mean));
    worst_error_m = std::max(worst_error_m, (Point(mean[0], mean[2]) - truth).norm());
  }
  return 60;
}

TEST(StrobeEcho, HoldsAMovingTarget) {
  double error_m = 0.0;
  EXPECT_EQ(scans_held(30.0, error_m), 60);
  EXPECT_LT(error_m, 6.0);
}

TEST(StrobeEcho, LosesItWhenTooNarrow) {
  double error_m = 0.0;
  EXPECT_LT(scans_held(1.5, error_m), 60);
}

// Strobes of several tracks

TEST(Rivals, EachCellBelongsToOneStrobe) {
  test::Draw draw(11);
  for (int run = 0; run < 20; ++run) {
    Round picture;
    picture.sprinkle(draw, 0.4);
    std::vector<Point> centres;
    std::vector<double> radii;
    const Point middle = polar(1200.0, draw.uniform(-4, 4));
    for (int k = 0; k < 3; ++k) {
      centres.push_back(middle + Point(draw.uniform(-80, 80), draw.uniform(-80, 80)));
      radii.push_back(draw.uniform(20, 120));
    }
    double shares = 0.0, whole = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      std::vector<RivalStrobe> rivals;
      for (std::size_t r = 0; r < 3; ++r)
        if (r != k) rivals.push_back({centres[r], radii[r], r < k});
      const StrobeEcho echo = strobe_echo(picture.image, RadiusGate{radii[k]}, centres[k],
                                          {.least_share = 0.0}, rivals);
      shares += echo.total_amplitude;
    }
    for (int sweep = 0; sweep < picture.image.sweeps; ++sweep)
      for (int cell = 0; cell < picture.image.cells; ++cell)
        for (std::size_t k = 0; k < 3; ++k)
          if ((picture.image.position(sweep, cell) - centres[k]).norm() <= radii[k]) {
            whole += picture.at(sweep, cell);
            break;
          }
    EXPECT_EQ(shares, whole) << run;
  }
}

TEST(Rivals, AnEchoNearAnotherCentreIsNotMeasured) {
  Round picture;
  picture.blob(0, 100, 2);
  const Point echo = picture.image.position(0, 100);
  const Point near = echo + Point(8.0, 3.0), far = echo + Point(-60.0, 0.0);
  const RadiusGate strobe{90.0};
  const RivalStrobe at_near{near, 90.0, false}, at_far{far, 90.0, false};
  const StrobeEcho own = strobe_echo(picture.image, strobe, near, {}, std::span(&at_far, 1));
  EXPECT_EQ(own.status, StrobeStatus::kOk);
  EXPECT_FALSE(own.shared);
  EXPECT_LT((own.position().mean - echo).norm(), 0.5) << "all of it, for it has nearly all";
  const StrobeEcho others = strobe_echo(picture.image, strobe, far, {}, std::span(&at_near, 1));
  EXPECT_EQ(others.status, StrobeStatus::kEmpty);
}

TEST(Rivals, AnEchoBetweenTwoCentresIsShared) {
  Round picture;
  for (int cell = 92; cell <= 108; ++cell) picture.blob(0, cell, 1);
  const Point left = picture.image.position(0, 94), right = picture.image.position(0, 106);
  const RivalStrobe at_left{left, 100.0, false}, at_right{right, 100.0, true};
  const StrobeEcho a =
      strobe_echo(picture.image, RadiusGate{100.0}, left, {}, std::span(&at_right, 1));
  const StrobeEcho b =
      strobe_echo(picture.image, RadiusGate{100.0}, right, {}, std::span(&at_left, 1));
  EXPECT_TRUE(a.shared);
  EXPECT_TRUE(b.shared);
  EXPECT_LT((a.position().mean - left).norm(), 15.0);
  EXPECT_LT((b.position().mean - right).norm(), 15.0);
}

}  // namespace
}  // namespace wakeline::strobe_test
