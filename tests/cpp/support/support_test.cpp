// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The test helpers themselves: an assertion that cannot fail proves nothing.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <string>

#include "support/golden.hpp"
#include "support/malloc_fence.hpp"
#include "support/matrix_assert.hpp"
#include "support/numeric_jacobian.hpp"

namespace {

using wakeline::test::matrices_identical;
using wakeline::test::matrices_near;
using wakeline::test::NoHeap;
using wakeline::test::numeric_jacobian;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(MatrixAssert, NamesTheElementThatDiffersMost) {
  const Eigen::Matrix2d expected{{1.0, 2.0}, {3.0, 4.0}};
  const Eigen::Matrix2d actual{{1.0, 2.1}, {3.5, 4.0}};
  EXPECT_TRUE(matrices_near(expected, expected));
  const auto result = matrices_near(actual, expected);
  ASSERT_FALSE(result);
  EXPECT_NE(std::string(result.message()).find("element (1, 0) is 3.5, expected 3"),
            std::string::npos);
  EXPECT_NE(std::string(result.message()).find("2 of 4 elements differ"), std::string::npos);
}

TEST(MatrixAssert, ToleranceIsAbsolutePlusRelative) {
  const Eigen::Vector2d expected{0.0, 1000.0};
  EXPECT_TRUE(
      matrices_near(Eigen::Vector2d{1e-3, 1000.9}, expected, {.absolute = 1e-3, .relative = 1e-3}));
  EXPECT_FALSE(
      matrices_near(Eigen::Vector2d{1e-3, 1000.9}, expected, {.absolute = 1e-3, .relative = 0.0}));
}

TEST(MatrixAssert, NanAgreesWithNanOnly) {
  EXPECT_TRUE(matrices_near(Eigen::Vector2d{kNan, 1.0}, Eigen::Vector2d{kNan, 1.0}));
  EXPECT_FALSE(matrices_near(Eigen::Vector2d{kNan, 1.0}, Eigen::Vector2d{0.0, 1.0}));
  EXPECT_FALSE(matrices_near(Eigen::Vector2d{0.0, 1.0}, Eigen::Vector2d{kNan, 1.0}));
}

TEST(MatrixAssert, ShapesMustAgree) {
  const Eigen::MatrixXd column = Eigen::MatrixXd::Zero(2, 1);
  EXPECT_FALSE(matrices_near(column, column.transpose()));
}

TEST(MatrixAssert, IdenticalMeansTheSameBits) {
  EXPECT_TRUE(matrices_identical(Eigen::Vector2d{kNan, 1.0}, Eigen::Vector2d{kNan, 1.0}));
  EXPECT_FALSE(matrices_identical(Eigen::Vector2d{0.0, 1.0}, Eigen::Vector2d{-0.0, 1.0}));
  EXPECT_FALSE(matrices_identical(Eigen::Vector2d{0.1 + 0.2, 1.0}, Eigen::Vector2d{0.3, 1.0}));
}

TEST(NoHeap, CountsEveryWayToTheHeap) {
  const NoHeap fence;
  EXPECT_EQ(fence.allocations(), 0);
  void* volatile block =
      std::malloc(16);  // volatile: the compiler may not leave the allocation out
  std::free(block);
  EXPECT_EQ(fence.allocations(), 1);
  block = std::calloc(2, 16);
  std::free(block);
  EXPECT_EQ(fence.allocations(), 2);
  block = ::operator new(64);
  ::operator delete(block);
  EXPECT_EQ(fence.allocations(), 3);
  block = ::operator new (64, std::align_val_t{64});
  ::operator delete (block, std::align_val_t{64});
  EXPECT_EQ(fence.allocations(), 4);
}

TEST(NoHeap, CountsFromItsOwnStart) {
  const NoHeap outer;
  void* volatile block = std::malloc(16);
  std::free(block);
  const NoHeap inner;
  EXPECT_EQ(inner.allocations(), 0);
  EXPECT_EQ(outer.allocations(), 1);
}

TEST(NoHeap, FixedSizeEigenNeedsNoHeap) {
  const Eigen::Matrix4d matrix = Eigen::Matrix4d::Random();
  const NoHeap fence;
  const Eigen::Matrix4d product = matrix * matrix.transpose();
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_GE(product.trace(), 0.0);
}

#ifdef NDEBUG
TEST(NoHeap, SeesDynamicEigen) {
  const NoHeap fence;
  const Eigen::VectorXd vector = Eigen::VectorXd::Ones(8);
  const double* volatile data = vector.data();
  EXPECT_EQ(fence.allocations(), 1);
  EXPECT_EQ(data[7], 1.0);
}
#else
TEST(NoHeapDeathTest, StopsDynamicEigenWhereItHappens) {
  EXPECT_DEATH(
      {
        const NoHeap fence;
        const Eigen::VectorXd vector = Eigen::VectorXd::Ones(8);
      },
      "malloc");
}
#endif

TEST(NumericJacobian, AgreesWithTheAnalyticOne) {
  const auto polar = [](const Eigen::Vector2d& p) {
    return Eigen::Vector2d{p.norm(), std::atan2(p.y(), p.x())};
  };
  const Eigen::Vector2d point{3000.0, 4000.0};
  const Eigen::Matrix2d expected{{0.6, 0.8}, {-0.8 / 5000.0, 0.6 / 5000.0}};
  EXPECT_TRUE(matrices_near(numeric_jacobian(polar, point), expected,
                            {.absolute = 1e-9, .relative = 1e-9}));
}

TEST(NumericJacobian, UsesTheGivenDifference) {
  constexpr double kPi = 3.14159265358979323846;
  const auto bearing = [](const Eigen::Vector2d& p) {
    return Eigen::Matrix<double, 1, 1>{std::atan2(p.y(), p.x())};
  };
  const auto wrapped = [](const auto& a, const auto& b) {
    return Eigen::Matrix<double, 1, 1>{std::remainder(a(0) - b(0), 2.0 * kPi)};
  };
  const Eigen::Vector2d seam{-1.0, 0.0};
  const Eigen::RowVector2d expected{0.0, -1.0};
  EXPECT_TRUE(matrices_near(numeric_jacobian(bearing, seam, wrapped), expected,
                            {.absolute = 1e-8, .relative = 0.0}));
}

TEST(Golden, HoldsTheReferenceRuns) {
  const auto reference = wakeline::test::golden("multiple_models.json");
  ASSERT_FALSE(reference.at("cases").empty());
  const Eigen::MatrixXd z = wakeline::test::to_matrix(reference["cases"][0].at("z"));
  EXPECT_EQ(z.rows(), 60);
  EXPECT_EQ(z.cols(), 2);
}

}  // namespace
