// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Hard and soft iron of a magnetic compass, and their calibration from a turn. Iron that is fixed
// to the vessel adds a constant to the field that it measures (hard iron) and distorts the earth's
// field (soft iron): over a turn the measured field describes an ellipse instead of a circle.
#pragma once

#include <cmath>
#include <utility>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// The field that a compass measures along the body [forward, starboard], in any unit:
///
///     m = S [cos ψ, -sin ψ] + b,    ψ the magnetic heading,
///
/// b the hard iron, S the soft iron times the horizontal field of the earth, symmetric and positive
/// definite. A turn cannot show a rotation in S, which is a constant error of all headings (the
/// lubber error of the mounting).
struct CompassEllipse {
  Vec<double, 2> hard_iron = Vec<double, 2>::Zero();
  Mat<double, 2, 2> soft_iron = Mat<double, 2, 2>::Identity();

  /// The field at a heading.
  [[nodiscard]] Vec<double, 2> field(double heading_rad) const noexcept {
    return soft_iron * Vec<double, 2>(std::cos(heading_rad), -std::sin(heading_rad)) + hard_iron;
  }

  /// The magnetic heading at which a field is measured, in [-pi, pi].
  [[nodiscard]] double heading_rad(const Vec<double, 2>& field) const noexcept {
    const Vec<double, 2> m = field - hard_iron;
    const Mat<double, 2, 2>& s = soft_iron;  // adj(S) m is S⁻¹ m times a positive number
    return std::atan2(s(1, 0) * m[0] - s(0, 0) * m[1], s(1, 1) * m[0] - s(0, 1) * m[1]);
  }
};

/// Calibration of a compass from the fields measured in a turn of any rate: the ellipse of least
/// squared algebraic distance,
///
///     (x² + y²)/2 + p (x² - y²)/2 + q xy + d x + e y + f = 0,
///
/// which is linear in its five parameters and does not depend on the origin, adjusted for the noise
/// of the readings: the moments are less what it adds to them, its variance is that which explains
/// the residuals. Without that half a turn with a noise of 2 % of the field has an error of 4.5
/// degrees instead of 1.5. Readings are taken one by one; only their moments are kept. Source: A.
/// Kukush, I. Markovsky, S. Van Huffel, "Consistent estimation in an implicit quadratic measurement
/// error model", Comp. Stat. Data Anal. 47, 2004.
class CompassCalibration {
 public:
  /// Takes a reading [forward, starboard] of the turn. One that is not `in_range` is left out.
  Status add(const Vec<double, 2>& field) noexcept {
    if (!in_range(field)) return Status::kNotFinite;
    if (count_ == 0) first_ = field;
    const double x = field[0] - first_[0], y = field[1] - first_[1], square = (x * x + y * y) / 2;
    const Vec<double, 5> row((x * x - y * y) / 2, x * y, x, y, 1.0);
    moments_.normal += row * row.transpose();
    moments_.right -= square * row;
    moments_.squares += square * square;
    ++count_;
    return Status::kOk;
  }

  [[nodiscard]] long readings() const noexcept { return count_; }

  /// The ellipse, with the standard deviation of the headings that it corrects.
  struct Fit {
    Status status = Status::kNotStarted;  ///< `kNotPositiveDefinite`: the readings show no ellipse
    CompassEllipse ellipse{};
    double heading_std_rad = kPi<double>;  ///< by the error of the ellipse, at the worst heading
  };

  /// Needs six readings over at least part of a turn; a short arc shows in `heading_std_rad`.
  [[nodiscard]] Fit fit() const noexcept {
    Fit result;
    if (count_ < 6) return result;
    result.status = Status::kNotPositiveDefinite;
    Mat<double, 5, 5> root;  // of the covariance of the shape
    Moments moments = moments_;
    double variance = 0.0, before;
    Vec<double, 5> shape;
    int pass = 0;
    do {
      const Vec<double, 5> scale = moments.normal.diagonal().cwiseSqrt();
      if (!(scale.minCoeff() > 0)) return result;
      const auto unscaled = scale.cwiseInverse().asDiagonal();
      const Cholesky<5> factor(unscaled * moments.normal * unscaled);
      if (!factor.ok()) return result;
      shape = unscaled * factor.solve<1>(Vec<double, 5>(unscaled * moments.right));
      const double residual = moments_.residual(shape) / static_cast<double>(count_ - 5);
      root = std::sqrt(residual) * Mat<double, 5, 5>(factor.whiten<5>(unscaled)).transpose();
      before = std::exchange(variance, residual / moments_.squared_slope(shape));
      moments = moments_.without_noise(variance);
    } while (std::abs(variance - before) > 1e-6 * variance && ++pass < kMostPasses);
    result.status = ellipse_of(shape, result.ellipse);
    if (result.status == Status::kOk)
      result.heading_std_rad = heading_std_rad(shape, result.ellipse, root);
    return result;
  }

 private:
  static constexpr int kMostPasses = 50;

  /// Sums over the readings of the products of [(x² - y²)/2, xy, x, y, 1] and of -(x² + y²)/2.
  struct Moments {
    Mat<double, 5, 5> normal = Mat<double, 5, 5>::Zero();
    Vec<double, 5> right = Vec<double, 5>::Zero();
    double squares = 0.0;

    /// The sum of the squared algebraic distances.
    [[nodiscard]] double residual(const Vec<double, 5>& shape) const noexcept {
      return std::fmax(squares - 2 * shape.dot(right) + shape.dot(normal * shape), 0.0);
    }

    /// The mean squared slope of the algebraic distance at the readings.
    [[nodiscard]] double squared_slope(const Vec<double, 5>& shape) const noexcept {
      const Mat<double, 3, 3> line = normal.bottomRightCorner<3, 3>();
      const Vec<double, 3> along_x(1 + shape[0], shape[1], shape[2]);
      const Vec<double, 3> along_y(shape[1], 1 - shape[0], shape[3]);
      return (along_x.dot(line * along_x) + along_y.dot(line * along_y)) / normal(4, 4);
    }

    /// Less what normal noise of that variance, per axis, adds to their means.
    [[nodiscard]] Moments without_noise(double variance) const noexcept {
      const double count = normal(4, 4), x = normal(2, 4), y = normal(3, 4);
      const double squared = normal(2, 2) + normal(3, 3) - 2 * count * variance;
      Moments less = *this;
      less.normal.diagonal() -=
          variance *
          Vec<double, 5>(squared + count * variance, squared + count * variance, count, count, 0);
      const auto subtract = [&](int row, int column, double sum) {
        less.normal(row, column) -= variance * sum;
        less.normal(column, row) -= variance * sum;
      };
      subtract(0, 2, x);
      subtract(0, 3, -y);
      subtract(1, 2, y);
      subtract(1, 3, x);
      less.right +=
          variance * Vec<double, 5>(3 * normal(0, 4), 3 * normal(1, 4), 2 * x, 2 * y, count);
      return less;
    }
  };

  /// The ellipse of the five parameters: with M = [1 + p, q; q, 1 - p]/2 it is
  /// (m - b)ᵀ M (m - b) = k, so that S = (M / k)^(-1/2).
  Status ellipse_of(const Vec<double, 5>& shape, CompassEllipse& ellipse) const noexcept {
    const double a = (1 + shape[0]) / 2, c = (1 - shape[0]) / 2, b = shape[1] / 2;
    const double det = a * c - b * b;
    if (!(det > 0)) return Status::kNotPositiveDefinite;
    const Vec<double, 2> line = shape.segment<2>(2);
    const Vec<double, 2> centre =
        -Vec<double, 2>(c * line[0] - b * line[1], a * line[1] - b * line[0]) / (2 * det);
    const double k = -(line.dot(centre) / 2 + shape[4]);
    if (!(k > 0)) return Status::kNotPositiveDefinite;
    ellipse.hard_iron = first_ + centre;
    // The root of a 2 x 2 matrix A is (A + √det I) / √(trace + 2 √det); M⁻¹ = adj(M) / det.
    const double root = std::sqrt(det);
    Mat<double, 2, 2> adjugate;
    adjugate << c + root, -b, -b, a + root;
    ellipse.soft_iron = std::sqrt(k / det / (1 + 2 * root)) * adjugate;
    return Status::kOk;
  }

  /// The largest standard deviation of a corrected heading, for a root of the covariance of the
  /// parameters: each of its columns moves the ellipse, and with it the heading of a field.
  [[nodiscard]] double heading_std_rad(const Vec<double, 5>& shape, const CompassEllipse& ellipse,
                                       const Mat<double, 5, 5>& root) const noexcept {
    constexpr int kHeadings = 24;
    constexpr double kStep = 1e-3;  // of a standard deviation
    Vec<double, kHeadings> variance = Vec<double, kHeadings>::Zero();
    for (int k = 0; k < 5; ++k) {
      CompassEllipse moved;
      if (ellipse_of(shape + kStep * root.col(k), moved) != Status::kOk) return kPi<double>;
      for (int n = 0; n < kHeadings; ++n) {
        const double heading = 2 * kPi<double> * n / kHeadings;
        const double change =
            wrap_angle(moved.heading_rad(ellipse.field(heading)) - heading) / kStep;
        variance[n] += change * change;
      }
    }
    return std::fmin(std::sqrt(variance.maxCoeff()), kPi<double>);
  }

  long count_ = 0;
  Vec<double, 2> first_ = Vec<double, 2>::Zero();
  Moments moments_;
};

}  // namespace wakeline
