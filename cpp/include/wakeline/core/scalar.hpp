// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace wakeline {

/// What the rest of the library asks of a type of numbers: `float`, `double`, or a pack of them,
/// which specialises this.
template <class Scalar>
struct ScalarTraits {
  using Real = Scalar;              ///< one number of it
  using Mask = bool;                ///< what a comparison gives
  static constexpr int kLanes = 1;  ///< numbers in it
};

template <class Scalar>
using RealOf = typename ScalarTraits<Scalar>::Real;
template <class Scalar>
using MaskOf = typename ScalarTraits<Scalar>::Mask;
template <class Scalar>
inline constexpr int kLanesOf = ScalarTraits<Scalar>::kLanes;

/// `a` where the condition holds, else `b`.
template <class Scalar>
constexpr Scalar select(bool condition, Scalar a, Scalar b) noexcept {
  return condition ? a : b;
}

/// The greater one; `bound` where the value is not a number.
template <class Scalar>
constexpr Scalar at_least(Scalar value, Scalar bound) noexcept {
  return select(value > bound, value, bound);
}

/// 1 / x and 1 / sqrt(x) of a positive number, to the last bit or two.
template <class Scalar>
Scalar reciprocal(Scalar x) noexcept {
  return Scalar(1) / x;
}
template <class Scalar>
Scalar inverse_sqrt(Scalar x) noexcept {
  using std::sqrt;
  return Scalar(1) / sqrt(x);
}

/// Over the lanes of a mask, of which a `bool` has one.
constexpr bool all(bool mask) noexcept { return mask; }
constexpr bool any(bool mask) noexcept { return mask; }
constexpr bool none(bool mask) noexcept { return !mask; }

/// Writes a number, or as many as there are lanes in a row.
template <class Scalar>
void store(Scalar value, Scalar* to) noexcept {
  *to = value;
}

/// One number of many, or the number itself.
template <class Scalar>
constexpr Scalar lane(Scalar value, int) noexcept {
  return value;
}

}  // namespace wakeline
