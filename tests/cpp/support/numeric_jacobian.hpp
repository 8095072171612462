// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <type_traits>
#include <utility>

namespace wakeline::test {

/// Jacobian of `function` at `point` by central differences,
///
///     J(:, i) = (f(x + h e_i) - f(x - h e_i)) / 2h,   h = eps^(1/3) * max(1, |x_i|),
///
/// with an error of the order of eps^(2/3): about 4e-11 in double and 2e-5 in float, times the size
/// of f.
///
/// function    fixed-size vector (N) -> fixed-size vector (M), of the same scalar as the point
/// difference  how two values of the function are subtracted; a bearing needs one that wraps
template <class Function, class Point, class Difference = std::minus<>>
auto numeric_jacobian(const Function& function, const Eigen::MatrixBase<Point>& point,
                      Difference difference = {}) {
  using Scalar = typename Point::Scalar;
  using Input = typename Point::PlainObject;
  using Output = typename std::decay_t<decltype(function(std::declval<Input>()))>::PlainObject;
  Eigen::Matrix<Scalar, Output::RowsAtCompileTime, Input::RowsAtCompileTime> jacobian;
  const Scalar step = std::cbrt(std::numeric_limits<Scalar>::epsilon());
  for (Eigen::Index i = 0; i < point.size(); ++i) {
    const Scalar h = step * std::max(Scalar(1), std::abs(point(i)));
    Input ahead = point;
    Input behind = point;
    ahead(i) += h;
    behind(i) -= h;
    const Output change = difference(Output(function(ahead)), Output(function(behind)));
    jacobian.col(i) = change / (ahead(i) - behind(i));
  }
  return jacobian;
}

}  // namespace wakeline::test
