// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <type_traits>
#include <utility>

#include "wakeline/simd/unroll.hpp"

namespace wakeline {

/// What the library requires of a scalar type: `float`, `double`, or a pack, which specialises
/// this.
template <class Scalar>
struct ScalarTraits {
  using Real = Scalar;              ///< type of one element
  using Mask = bool;                ///< result of a comparison
  static constexpr int kLanes = 1;  ///< number of elements

  template <class Function>
  static Scalar of(const Function& number) noexcept {
    return number(0);
  }
  static Scalar load(const Real* from) noexcept { return *from; }
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

/// The greater one; `bound` where the value is NaN.
template <class Scalar>
constexpr Scalar at_least(Scalar value, Scalar bound) noexcept {
  return select(value > bound, value, bound);
}

/// 1 / x and 1 / sqrt(x) of a positive number, accurate to one or two units in the last place.
template <class Scalar>
Scalar reciprocal(Scalar x) noexcept {
  return Scalar(1) / x;
}
/// One over the square root.
template <class Scalar>
Scalar inverse_sqrt(Scalar x) noexcept {
  using std::sqrt;
  return Scalar(1) / sqrt(x);
}

/// Lane k is `number(k)`.
template <class Scalar, class Function>
Scalar lanes_of(const Function& number) noexcept {
  return ScalarTraits<Scalar>::of(number);
}

/// Loads a number, or as many consecutive ones as there are lanes.
template <class Scalar>
Scalar load(const RealOf<Scalar>* from) noexcept {
  return ScalarTraits<Scalar>::load(from);
}

/// Number of lanes of the elements of an array of scalars.
template <class Scalars>
inline constexpr int kLanesIn = kLanesOf<std::decay_t<decltype(std::declval<Scalars&>()[0])>>;

/// `scalars[k]` is element k of the arrays `array(lane)`; `scatter_lanes` is the reverse for the
/// first `count` lanes.
template <int Size, class Array, class Scalars>
requires(kLanesIn<Scalars> == 1)
    [[gnu::always_inline]] inline void gather_lanes(const Array& array, Scalars scalars) noexcept {
  unroll<Size>([&](int k) { scalars[k] = array(0)[k]; });
}
/// Copies numbers of one lane to an array.
template <int Size, class Array, class Scalars>
requires(kLanesIn<Scalars> == 1)
    [[gnu::always_inline]] inline void scatter_lanes(Scalars scalars, int,
                                                     const Array& array) noexcept {
  unroll<Size>([&](int k) { array(0)[k] = scalars[k]; });
}

/// Reductions over all lanes.
template <class Scalar>
requires(kLanesOf<Scalar> == 1) constexpr Scalar sum_of_lanes(Scalar x) noexcept { return x; }
/// The least lane; a number has one.
template <class Scalar>
requires(kLanesOf<Scalar> == 1) constexpr Scalar least_of_lanes(Scalar x) noexcept { return x; }
/// The greatest lane; a number has one.
template <class Scalar>
requires(kLanesOf<Scalar> == 1) constexpr Scalar greatest_of_lanes(Scalar x) noexcept { return x; }

/// `sums[k]` is the sum of the lanes of `scalars[k]`.
template <int Size, class Scalar>
requires(kLanesOf<Scalar> == 1)
    [[gnu::always_inline]] inline void sum_lanes(const Scalar* scalars, Scalar* sums) noexcept {
  unroll<Size>([&](int k) { sums[k] = scalars[k]; });
}

/// `fold(x)` where `Result` is one number and x a pack; x where both have the same lanes.
template <class Result, class Scalar, class Fold>
Result fold_to(Scalar x, const Fold& fold) noexcept {
  if constexpr (kLanesOf<Result> == kLanesOf<Scalar>)
    return x;
  else
    return fold(x);
}
/// Sum of the lanes, in packs of the width of the result.
template <class Result, class Scalar>
Result sum_to(Scalar x) noexcept {
  return fold_to<Result>(x, [](const auto& lanes) { return sum_of_lanes(lanes); });
}
/// Least of the lanes, in packs of the width of the result.
template <class Result, class Scalar>
Result least_to(Scalar x) noexcept {
  return fold_to<Result>(x, [](const auto& lanes) { return least_of_lanes(lanes); });
}

/// Reductions over the lanes of a mask; a `bool` has one.
constexpr bool all(bool mask) noexcept { return mask; }
/// Whether a lane is true.
constexpr bool any(bool mask) noexcept { return mask; }
/// Whether no lane is true.
constexpr bool none(bool mask) noexcept { return !mask; }
constexpr unsigned bits_of(bool mask) noexcept { return mask; }  ///< bit k is lane k

/// The mask whose lane k is bit k.
template <class Scalar>
MaskOf<Scalar> mask_of_bits(unsigned bits) noexcept {
  if constexpr (kLanesOf<Scalar> == 1)
    return bits != 0;
  else
    return MaskOf<Scalar>::of_bits(bits);
}

/// Stores a number, or as many consecutive ones as there are lanes.
template <class Scalar>
void store(Scalar value, Scalar* to) noexcept {
  *to = value;
}

/// Element k of a pack, or the number itself.
template <class Scalar>
constexpr Scalar lane(Scalar value, int) noexcept {
  return value;
}

}  // namespace wakeline
