// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A number that counts what is done with it, as a Scalar for everything else in the library: the
// same template that is timed tells how much arithmetic one step is.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "wakeline/simd/scalar.hpp"

namespace wakeline::bench {

/// Operations as the formulas have them. Comparisons, selections, signs and rounding are free; a
/// fused multiply-add is two.
struct FlopCount {
  std::int64_t additions = 0;  ///< and subtractions
  std::int64_t products = 0;
  std::int64_t divisions = 0;
  std::int64_t roots = 0;
  std::int64_t functions = 0;  ///< exp, log, sin, cos, atan2

  [[nodiscard]] std::int64_t flops() const noexcept { return additions + products; }
};

class Counted {
 public:
  double value;
  inline static FlopCount count;  ///< of all numbers, of one thread

  Counted() = default;
  template <class Number>
  requires(std::is_arithmetic_v<Number>)
      // NOLINTNEXTLINE(google-explicit-constructor): a constant in a formula.
      Counted(Number number)
  noexcept : value(double(number)) {}
  explicit operator double() const noexcept { return value; }

  friend Counted operator+(Counted a, Counted b) noexcept {
    return ++count.additions, Counted(a.value + b.value);
  }
  friend Counted operator-(Counted a, Counted b) noexcept {
    return ++count.additions, Counted(a.value - b.value);
  }
  friend Counted operator*(Counted a, Counted b) noexcept {
    return ++count.products, Counted(a.value * b.value);
  }
  friend Counted operator/(Counted a, Counted b) noexcept {
    return ++count.divisions, Counted(a.value / b.value);
  }
  friend Counted operator-(Counted a) noexcept { return Counted(-a.value); }
  Counted& operator+=(Counted b) noexcept { return *this = *this + b; }
  Counted& operator-=(Counted b) noexcept { return *this = *this - b; }
  Counted& operator*=(Counted b) noexcept { return *this = *this * b; }
  Counted& operator/=(Counted b) noexcept { return *this = *this / b; }

  friend bool operator==(Counted a, Counted b) noexcept { return a.value == b.value; }
  friend auto operator<=>(Counted a, Counted b) noexcept { return a.value <=> b.value; }

  friend Counted abs(Counted a) noexcept { return Counted(std::abs(a.value)); }
  friend Counted nearbyint(Counted a) noexcept { return Counted(std::nearbyint(a.value)); }
  friend Counted floor(Counted a) noexcept { return Counted(std::floor(a.value)); }
  friend bool isfinite(Counted a) noexcept { return std::isfinite(a.value); }
  friend Counted sqrt(Counted a) noexcept { return ++count.roots, Counted(std::sqrt(a.value)); }
  friend Counted exp(Counted a) noexcept { return ++count.functions, Counted(std::exp(a.value)); }
  friend Counted log(Counted a) noexcept { return ++count.functions, Counted(std::log(a.value)); }
  friend Counted sin(Counted a) noexcept { return ++count.functions, Counted(std::sin(a.value)); }
  friend Counted cos(Counted a) noexcept { return ++count.functions, Counted(std::cos(a.value)); }
  friend Counted atan2(Counted a, Counted b) noexcept {
    return ++count.functions, Counted(std::atan2(a.value, b.value));
  }
};

}  // namespace wakeline::bench

namespace wakeline {

template <>
struct ScalarTraits<bench::Counted> {
  using Real = double;
  using Mask = bool;
  static constexpr int kLanes = 1;

  template <class Function>
  static bench::Counted of(const Function& number) noexcept {
    return bench::Counted(number(0));
  }
};

}  // namespace wakeline

template <>
struct Eigen::NumTraits<wakeline::bench::Counted>
    : Eigen::GenericNumTraits<wakeline::bench::Counted> {
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };
};
