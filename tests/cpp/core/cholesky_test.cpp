// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/core/cholesky.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <type_traits>
#include <utility>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/simd/pack.hpp"

namespace wakeline::cholesky_test {
namespace {

using test::Draw;
using test::matrices_identical;
using test::matrices_near;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Calls `f(integral_constant N)` for sizes N that are unrolled and one that is not.
template <class Function>
void for_sizes(const Function& f) {
  [&]<int... N>(std::integer_sequence<int, N...>) { (f(std::integral_constant<int, N>{}), ...); }
  (std::integer_sequence<int, 1, 2, 4, 6>{});
}

template <class Scalar>
class CholeskyOf : public ::testing::Test {
 protected:
  static constexpr test::Tolerance kTolerance{
      .absolute = 4e3 * static_cast<double>(std::numeric_limits<Scalar>::epsilon()),
      .relative = 4e3 * static_cast<double>(std::numeric_limits<Scalar>::epsilon())};
};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(CholeskyOf, Scalars, );

TYPED_TEST(CholeskyOf, FactorSolutionAndDeterminant) {
  using Scalar = TypeParam;
  Draw draw(1);
  for_sizes([&](auto size) {
    constexpr int N = decltype(size)::value;
    using Matrix = Mat<Scalar, N, N>;
    const Matrix a = draw.definite<N>().template cast<Scalar>();
    const Cholesky<N, Scalar> cholesky(a);
    ASSERT_TRUE(cholesky.ok());
    const Matrix lower = cholesky.lower();
    EXPECT_TRUE(matrices_near(Matrix(lower * lower.transpose()), a, this->kTolerance));
    EXPECT_TRUE(lower.isLowerTriangular(Scalar(0)));
    EXPECT_TRUE((lower.diagonal().array() > Scalar(0)).all());

    Mat<Scalar, N, 2> b;
    for (int k = 0; k < 2; ++k) b.col(k) = draw.normals<N>().template cast<Scalar>();
    EXPECT_TRUE(matrices_near((a * cholesky.template solve<2>(b)).eval(), b, this->kTolerance));
    EXPECT_TRUE(
        matrices_near((lower * cholesky.template whiten<2>(b)).eval(), b, this->kTolerance));
    EXPECT_NEAR(cholesky.log_determinant(), 2.0 * lower.diagonal().array().log().sum(),
                4e3 * static_cast<double>(std::numeric_limits<Scalar>::epsilon()));
  });
}

// vortex-vkf drew its sigma points from matrixLLT(), whose upper triangle still holds the input.
TEST(Cholesky, ReadsTheLowerTriangleAndLeavesNothingAboveIt) {
  Mat<double, 3, 3> a;
  a << 4, 1, 2, 1, 5, 3, 2, 3, 6;
  Mat<double, 3, 3> spoilt = a;
  spoilt(0, 1) = spoilt(0, 2) = spoilt(1, 2) = kNan;
  EXPECT_TRUE(matrices_identical(Cholesky<3>(spoilt).lower(), Cholesky<3>(a).lower()));
  EXPECT_EQ(Cholesky<3>(a).lower()(0, 2), 0.0);
}

TEST(Cholesky, NormsByOneLaneAreThoseByItsMatrix) {
  using Lanes = Pack<double, kNativeLanes<double>>;
  Draw draw(2);
  Mat<double, 4, 4> each[kNativeLanes<double>];
  for (auto& matrix : each) matrix = draw.definite<4>();
  each[1](3, 3) = -1.0;
  Mat<Lanes, 4, 4> all;
  for (int k = 0; k < 16; ++k)
    all.data()[k] = Lanes::of([&](int of_lane) { return each[of_lane].data()[k]; });
  const Cholesky<4, Lanes> factors(all);
  for (int of_lane = 0; of_lane < kNativeLanes<double>; ++of_lane) {
    const Cholesky<4> expected(each[of_lane]);
    ASSERT_EQ(factors.ok()[of_lane], expected.ok()) << of_lane;
    if (!expected.ok()) continue;
    Vec<Lanes, 4> v;  // several vectors, of one matrix
    for (int k = 0; k < 4; ++k) v[k] = Lanes::of([&](int i) { return k - 2.0 * i; });
    for (int i = 0; i < kNativeLanes<double>; ++i) {
      const Vec<double, 4> alone(v[0][i], v[1][i], v[2][i], v[3][i]);
      const double norm = expected.squared_norm(alone);
      EXPECT_NEAR(factors.squared_norms(v, of_lane)[i], norm, 1e-12 * norm);
    }
  }
}

TEST(Cholesky, RejectsWhatIsNotPositiveDefinite) {
  using Matrix = Mat<double, 3, 3>;
  EXPECT_FALSE(Cholesky<3>(Matrix(Matrix::Zero())).ok());
  EXPECT_FALSE(Cholesky<3>(Matrix(-Matrix::Identity())).ok());
  EXPECT_FALSE(Cholesky<3>(Matrix(Matrix::Ones())).ok()) << "semidefinite";
  Matrix indefinite = Matrix::Identity();
  indefinite(2, 0) = indefinite(0, 2) = 1.0001;
  EXPECT_FALSE(Cholesky<3>(indefinite).ok());
  indefinite(2, 0) = indefinite(0, 2) = 0.9999;
  EXPECT_TRUE(Cholesky<3>(indefinite).ok());
}

TEST(Cholesky, RejectsWhatIsNotFinite) {
  for (const double bad : {kNan, kInfinity, -kInfinity})
    for (int column = 0; column < 3; ++column)
      for (int row = column; row < 3; ++row) {
        Mat<double, 3, 3> a = Mat<double, 3, 3>::Identity();
        a(row, column) = bad;
        EXPECT_FALSE(Cholesky<3>(a).ok()) << bad << " at " << row << ", " << column;
      }
}

TYPED_TEST(CholeskyOf, SemidefiniteRootOfEveryRank) {
  using Scalar = TypeParam;
  for_sizes([&](auto size) {
    constexpr int N = decltype(size)::value;
    Draw draw(N);
    using Matrix = Mat<Scalar, N, N>;
    for (int rank = 0; rank <= N; ++rank)
      for (int repeat = 0; repeat < 20; ++repeat) {
        Matrix a = Matrix::Zero();
        for (int k = 0; k < rank; ++k) {
          const Vec<Scalar, N> v = draw.normals<N>().template cast<Scalar>();
          a += v * v.transpose();
        }
        const Matrix root = semidefinite_root<N, Scalar>(a);
        const double rounding = 10 * this->kTolerance.absolute;  // of a rank that is nearly lower
        EXPECT_TRUE(matrices_near(Matrix(root * root.transpose()), a, {rounding, rounding}))
            << "rank " << rank;
      }
  });
}

TEST(SemidefiniteRoot, LeavesOutDirectionsWithoutVarianceWhereverTheyStand) {
  Mat<double, 3, 3> a = Mat<double, 3, 3>::Zero();
  a(1, 1) = 4.0;
  EXPECT_TRUE(matrices_identical(
      (semidefinite_root<3, double>(a) * semidefinite_root<3, double>(a).transpose()).eval(), a));
  a(0, 0) = 1e-30;  // small is not zero
  EXPECT_DOUBLE_EQ((semidefinite_root<3, double>(a)(0, 0)), 1e-15);
}

TEST(SemidefiniteRoot, EqualsTheCholeskyFactorWhereThereIsOne) {
  const Mat<double, 5, 5> a = Draw(3).definite<5>();
  EXPECT_TRUE(matrices_near(semidefinite_root<5, double>(a), Cholesky<5>(a).lower()));
}

TEST(IsFinite, FindsAnyElement) {
  Mat<double, 2, 3> matrix = Mat<double, 2, 3>::Constant(1e308);
  EXPECT_TRUE(is_finite(matrix)) << "large numbers are finite, and so is their absence of a sum";
  for (const double bad : {kNan, kInfinity, -kInfinity})
    for (int k = 0; k < 6; ++k) {
      Mat<double, 2, 3> spoilt = matrix;
      spoilt(k % 2, k / 2) = bad;
      EXPECT_FALSE(is_finite(spoilt)) << bad << " at " << k;
    }
  matrix(0, 0) = kInfinity;
  matrix(1, 1) = -kInfinity;
  EXPECT_FALSE(is_finite(matrix));
}

TYPED_TEST(CholeskyOf, CheckReportsWhatIsWrongWithABelief) {
  using Scalar = TypeParam;
  Gaussian<3, Scalar> good;
  good.covariance = Draw(4).definite<3>().template cast<Scalar>();
  EXPECT_EQ(check(good), Status::kOk);

  Gaussian<3, Scalar> belief = good;
  belief.mean[1] = Scalar(kNan);
  EXPECT_EQ(check(belief), Status::kNotFinite);
  belief = good;
  belief.covariance(0, 2) = Scalar(kInfinity);  // the upper triangle counts too
  EXPECT_EQ(check(belief), Status::kNotFinite);
  belief = good;
  belief.covariance(0, 1) += Scalar(0.01);
  EXPECT_EQ(check(belief), Status::kNotPositiveDefinite) << "not symmetric";
  belief = good;
  belief.covariance(0, 1) *= 1 + 2 * std::numeric_limits<Scalar>::epsilon();
  EXPECT_EQ(check(belief), Status::kOk) << "symmetric but for rounding";
  belief = good;
  belief.covariance(2, 2) = Scalar(-1);
  EXPECT_EQ(check(belief), Status::kNotPositiveDefinite);
  belief.covariance.setZero();
  EXPECT_EQ(check(belief), Status::kNotPositiveDefinite);
}

}  // namespace
}  // namespace wakeline::cholesky_test
