// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/multimodel/mode_chain.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "support/matrix_assert.hpp"

namespace wakeline::mode_chain_test {
namespace {

using test::matrices_near;
using Two = ModeChain<2>;
using Three = ModeChain<3>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const Three::Matrix kStaying{{0.95, 0.03, 0.02}, {0.10, 0.80, 0.10}, {0.02, 0.08, 0.90}};

template <class Function>
std::string complaint(const Function& f) {
  try {
    f();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

template <int K>
void expect_stochastic(const ModeMatrix<double, K>& p) {
  EXPECT_TRUE((p.array() >= 0.0).all() && (p.array() <= 1.0).all()) << p;
  for (Eigen::Index i = 0; i < p.rows(); ++i) EXPECT_NEAR(p.row(i).sum(), 1.0, 1e-14);
}

// The docstring of filterpy gives the matrix transposed: a matrix whose columns sum to 1 must not
// pass for one.
TEST(ModeChain, RowsThatDoNotSumToOneAreNamed) {
  const std::string message = complaint([] { Two(Two::Matrix{{0.9, 0.1}, {0.3, 0.8}}); });
  EXPECT_NE(message.find("row 1 of the mode chain must sum to 1, sums to 1.1"), std::string::npos)
      << message;
  EXPECT_NE(message.find("rows: mode before"), std::string::npos) << message;
  EXPECT_NE(complaint([] { Two(Two::Matrix{{0.9, 0.4}, {0.1, 0.6}}); }), "") << "transposed";
  // As of 32 bits.
  const std::string near = complaint([] { Two(Two::Matrix{{0.9 + 2e-8, 0.1}, {0.2, 0.8}}); });
  EXPECT_NE(near.find("row 0 of the mode chain must sum to 1, sums to 1.00000002"),
            std::string::npos)
      << near;
}

TEST(ModeChain, InvalidProbabilitiesAreRejected) {
  for (const double bad : {-0.1, 1.1, kNan}) {
    const std::string message = complaint([&] { Two(Two::Matrix{{bad, 1.0 - bad}, {0.1, 0.9}}); });
    EXPECT_NE(message.find("mode chain must be a probability"), std::string::npos) << message;
  }
}

// vortex-vkf compares the sum of a row with 1.0 exactly.
TEST(ModeChain, RoundingOfTheRowsIsForgiven) {
  const double third = 1.0 / 3.0;
  EXPECT_NO_THROW(Three(Three::Matrix::Constant(third)));
  EXPECT_NO_THROW(Three(Three::Matrix{{0.7, 0.1, 0.2}, {0.1, 0.1, 0.8}, {0.3, 0.6, 0.1}}));
}

TEST(ModeChain, PerPredictionIsTheMatrixWhateverTheStep) {
  const Three chain(kStaying);
  EXPECT_FALSE(chain.continuous());
  for (const double dt : {0.0, 1.0, 3600.0})
    EXPECT_TRUE(matrices_near(chain.transition(dt), kStaying, {0, 0}));
}

/// Laws of every chain in continuous time.
template <int K>
void expect_continuous(const ModeChain<K>& chain) {
  ASSERT_TRUE(chain.continuous());
  const auto identity = ModeMatrix<double, K>::Identity(chain.modes(), chain.modes());
  EXPECT_TRUE(matrices_near(chain.transition(0.0), identity, {0, 0}));
  for (const double a : {1e-6, 0.1, 2.5, 60.0, 3600.0})
    for (const double b : {1e-3, 2.5, 30.0, 86400.0}) {
      const ModeMatrix<double, K> both = chain.transition(a) * chain.transition(b);
      EXPECT_TRUE(matrices_near(chain.transition(a + b), both, {.absolute = 1e-12, .relative = 0}))
          << a << " + " << b;
      expect_stochastic<K>(chain.transition(a + b));
    }
}

TEST(ModeChain, StepsOfTimeAddUp) {
  expect_continuous(Three::from_sojourn_s({60.0, 30.0, 10.0}));
  expect_continuous(Two::from_sojourn_s({1e-3, 1e9}));
  expect_continuous(Three(kStaying, 2.5));
  expect_continuous(ModeChain<1>::from_sojourn_s({5.0}));
  expect_continuous(ModeChain<kRuntimeModes>::from_sojourn_s({60.0, 30.0, 10.0, 20.0}));
}

TEST(ModeChain, TakesAWholeNumberOfSeconds) {
  const Three chain = Three::from_sojourn_s({60.0, 30.0, 10.0});
  EXPECT_TRUE(matrices_near(chain.transition(2), chain.transition(2.0), {0, 0}));
}

TEST(ModeChain, StaysForTheSojournTime) {
  const double times[] = {60.0, 30.0, 10.0};
  const Three chain = Three::from_sojourn_s({times[0], times[1], times[2]});
  const Three::Matrix p = chain.transition(1e-6);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR((1.0 - p(i, i)) / 1e-6 * times[i], 1.0, 1e-6) << "leaves at the rate 1 / time";
    EXPECT_NEAR(p(i, (i + 1) % 3) / p(i, (i + 2) % 3), 1.0, 1e-6) << "to each other mode alike";
  }
  // In the long run each mode has its share of the time.
  for (const double dt : {1e5, 1e9, 1e300}) {
    const Three::Matrix late = chain.transition(dt);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(late(i, j), times[j] / 100.0, 1e-9) << dt;
  }
}

TEST(ModeChain, WithItsPeriodHasTheMatrixOverIt) {
  for (const double period : {1e-3, 2.5, 3600.0}) {
    const Three chain(kStaying, period);
    EXPECT_TRUE(
        matrices_near(chain.transition(period), kStaying, {.absolute = 1e-12, .relative = 0}));
    EXPECT_TRUE(matrices_near(chain.transition(2 * period), (kStaying * kStaying).eval(),
                              {.absolute = 1e-12, .relative = 0}));
    const Three::Matrix half = chain.transition(period / 2);
    EXPECT_TRUE(matrices_near((half * half).eval(), kStaying, {.absolute = 1e-12, .relative = 0}));
  }
  using Five = ModeChain<5>;
  Five::Matrix papers = Five::Matrix::Constant(0.025);
  papers.diagonal().setConstant(0.9);
  EXPECT_TRUE(
      matrices_near(Five(papers, 3.0).transition(3.0), papers, {.absolute = 1e-12, .relative = 0}));
  EXPECT_TRUE(
      matrices_near(Two(Two::Matrix::Identity(), 3.0).transition(99.0), Two::Matrix::Identity()));
}

TEST(ModeChain, AMatrixWithoutAContinuousTimeChainIsRejected) {
  const auto says_so = [](const auto& matrix) {
    using Chain = ModeChain<std::decay_t<decltype(matrix)>::RowsAtCompileTime>;
    const std::string message = complaint([&] { Chain(matrix, 2.5); });
    EXPECT_NE(message.find("leave out the period"), std::string::npos) << matrix << "\n" << message;
    EXPECT_NO_THROW((Chain(matrix))) << "once per prediction it is fine";
  };
  says_so(Two::Matrix{{0.1, 0.9}, {0.9, 0.1}});  // negative eigenvalue
  says_so(Two::Matrix{{0.5, 0.5}, {0.5, 0.5}});  // singular
  says_so(Two::Matrix{{0.0, 1.0}, {1.0, 0.0}});
  says_so(
      Three::Matrix{{0.9, 0.1, 0.0},
                    {0.0, 0.9, 0.1},
                    {0.1, 0.0, 0.9}});  // goes from 0 to 2 only through 1, yet not in one period
  EXPECT_THROW(Two(Two::Matrix{{0.9, 0.1}, {0.1, 0.9}}, 0.0), std::invalid_argument);
  EXPECT_THROW(Two(Two::Matrix{{0.9, 0.1}, {0.1, 0.9}}, kNan), std::invalid_argument);
}

TEST(ModeChain, AChainThatRarelyStaysIsReportedAsSuch) {
  const Three round =
      Three::from_generator(Three::Matrix{{-1.0, 1.0, 0.0}, {0.0, -1.0, 1.0}, {1.0, 0.0, -1.0}});
  EXPECT_NO_THROW(Three(round.transition(1.0), 1.0));
  for (const double period : {1.9, 10.0, 100.0}) {
    const std::string message = complaint([&] { Three(round.transition(period), period); });
    EXPECT_NE(message.find("or of one that rarely stays over it"), std::string::npos) << message;
  }
}

TEST(ModeChain, ItsGeneratorMakesItAnew) {
  const Three chains[] = {Three::from_sojourn_s({60.0, 30.0, 7.0}), Three(kStaying, 2.5)};
  for (const Three& chain : chains) {
    const Three same = Three::from_generator(*chain.generator_per_s());
    ASSERT_TRUE(same.continuous());
    EXPECT_TRUE(matrices_near(*same.generator_per_s(), *chain.generator_per_s(), {0, 0}));
    for (const double dt : {0.0, 2.5, 3600.0})
      EXPECT_TRUE(matrices_near(same.transition(dt), chain.transition(dt), {0, 0}));
  }
  EXPECT_FALSE(Three(kStaying).generator_per_s().has_value());
}

TEST(ModeChain, AMatrixThatIsNotAGeneratorIsRejected) {
  const auto says = [](const Two::Matrix& matrix, const char* words) {
    const std::string message = complaint([&] { Two::from_generator(matrix); });
    EXPECT_NE(message.find(words), std::string::npos) << matrix << "\n" << message;
  };
  says(Two::Matrix{{-0.5, 0.4}, {0.25, -0.25}}, "sum of a row of the generator must be 0");
  says(Two::Matrix{{0.5, -0.5}, {0.25, -0.25}}, "every rate of the generator off its diagonal");
  says(Two::Matrix{{kNan, 0.5}, {0.25, -0.25}}, "sum of a row of the generator must be 0");
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  says(Two::Matrix{{-kInfinity, 0.5}, {0.25, -0.25}}, "generator of a mode chain must be finite");
  using Any = ModeChain<kRuntimeModes>;
  EXPECT_NE(complaint([] { Any::from_generator(Any::Matrix::Zero(2, 3)); }), "");
}

TEST(ModeChain, PrintsEnoughDigitsInMessages) {
  EXPECT_EQ(complaint([] { (void)Two::staying(1.0 + 2e-8); }),
            "stay_probability must be a probability between 0 and 1, got 1.00000002");
}

TEST(ModeChain, InvalidSojournTimesAreRejected) {
  for (const double bad : {0.0, -1.0, kNan, std::numeric_limits<double>::infinity()})
    EXPECT_NE(complaint([&] {
                (void)Two::from_sojourn_s({10.0, bad});
              }).find("every time of sojourn_s must be finite and positive"),
              std::string::npos);
  EXPECT_NE(complaint([] {
              (void)Two::from_sojourn_s({10.0, 1e-310});
            }),
            "")
      << "leaves more often than a number can say";
}

TEST(ModeChain, TooFewOrTooManyModesAreRejected) {
  using Any = ModeChain<kRuntimeModes>;
  EXPECT_EQ(complaint([] {
              (void)Three::from_sojourn_s({10.0, 20.0});
            }),
            "a mode chain needs 3 mean sojourn times, got 2");
  EXPECT_EQ(complaint([] { (void)Any::from_sojourn_s({}); }),
            "a mode chain needs 1 to 16 mean sojourn times, got 0");
  EXPECT_EQ(complaint([] { (void)Any::from_sojourn_s(ModeVector<double, kRuntimeModes>()); }),
            "a mode chain needs 1 to 16 mean sojourn times, got 0");
  EXPECT_EQ(
      complaint([] {
        (void)Any::from_sojourn_s({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17});
      }),
      "a mode chain needs 1 to 16 mean sojourn times, got 17");
  EXPECT_EQ(complaint([] { (void)Any(Any::Matrix()); }), "a mode chain needs 1 to 16 modes, got 0");
  EXPECT_EQ(complaint([] { (void)Any(Any::Matrix(Any::Matrix::Constant(2, 4, 0.25))); }),
            "a mode chain needs a square matrix, got 2 x 4");
}

}  // namespace
}  // namespace wakeline::mode_chain_test
