// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Elementary functions of packs. A template with `using std::exp;` and then `exp(x)` finds these
// for a pack and the standard ones for a number.
//
// Each function equals its standard namesake lane by lane over the whole range, including subnormal
// numbers, infinities, zeros of either sign and NaN. Lanes are independent. With fused multiply-add
// the accuracy is the same, though the last bit may differ. Largest error in units in the last
// place, for `float` and `double`:
//
//     log 0.9   exp 1.1   sin, cos 1.2   expm1, hypot 1.3   atan, atan2 1.6
//
// Method: the argument is reduced to a short interval around zero by subtracting a multiple of a
// constant that is stored in several parts whose products are exact (Cody and Waite, Software
// Manual for the Elementary Functions, 1980). On the interval a polynomial of least maximum
// relative error (Remez exchange in 200 bits, coefficients then rounded) is added as a correction
// to the leading terms, so that its rounding error is negligible.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <type_traits>

#include "wakeline/simd/pack.hpp"

namespace wakeline {
inline namespace WAKELINE_INSTRUCTION_SET {

/// Sine and cosine of one angle.
template <class Scalar>
struct SinCos {
  Scalar sin, cos;
};

namespace pack_detail {

template <class Real>
struct Format {
  static constexpr bool kIsDouble = sizeof(Real) == 8;
  using Integer = std::conditional_t<kIsDouble, std::uint64_t, std::uint32_t>;
  static constexpr int kBits = 8 * int(sizeof(Real));
  static constexpr int kMantissaBits = std::numeric_limits<Real>::digits - 1;
  static constexpr int kBias = std::numeric_limits<Real>::max_exponent - 1;
  static constexpr Integer kMantissa = (Integer(1) << kMantissaBits) - 1;
  static constexpr Integer kSign = Integer(1) << (kBits - 1);
  /// Adding this to a smaller number leaves its nearest integer in the low bits of the sum.
  static constexpr Real kRounding = Real(Integer(3) << (kMantissaBits - 1));
  /// Replacing its mantissa by an integer adds that integer.
  static constexpr Real kCounting = Real(Integer(1) << kMantissaBits);
};

/// Bits of each lane, unsigned, so that shifts bring in zeros.
template <class Real, int Lanes>
using Bits [[gnu::vector_size(sizeof(Real) * Lanes)]] = typename Format<Real>::Integer;

template <class Real, int Lanes>
[[gnu::always_inline]] inline Bits<Real, Lanes> to_bits(Pack<Real, Lanes> x) noexcept {
  return (Bits<Real, Lanes>)x.raw;
}

template <class Real, int Lanes>
[[gnu::always_inline]] inline Pack<Real, Lanes> of_bits(Bits<Real, Lanes> bits) noexcept {
  return Pack<Real, Lanes>((typename Pack<Real, Lanes>::Raw)bits);
}

/// c[First] + c[First + Step] x + c[First + 2 Step] x^2 + ..., by Horner's rule.
template <std::size_t First, std::size_t Step, class Real, int Lanes, std::size_t N>
[[gnu::always_inline]] inline Pack<Real, Lanes> horner(Pack<Real, Lanes> x,
                                                       const std::array<Real, N>& c) noexcept {
  if constexpr (First + Step >= N)
    return c[First];
  else
    return c[First] + x * horner<First + Step, Step>(x, c);
}

/// c[0] + c[1] x + c[2] x^2 + ..., with even and odd powers side by side where there are many.
template <class Real, int Lanes, std::size_t N>
[[gnu::always_inline]] inline Pack<Real, Lanes> polynomial(Pack<Real, Lanes> x,
                                                           const std::array<Real, N>& c) noexcept {
  if constexpr (N <= 4)
    return horner<0, 1>(x, c);
  else
    return horner<0, 2>(x * x, c) + x * horner<1, 2>(x * x, c);
}

/// The polynomials, each with its contribution to the error of the function.
template <class Real>
struct Coefficients;

template <>
struct Coefficients<double> {
  /// (e^r - 1 - r - r^2/2) / r^3, |r| <= ln(2)/2: 2^-55.2 of e^r - 1.
  static constexpr std::array kExponential{
      0x1.555555555553ep-3,  0x1.5555555553b10p-5,  0x1.1111111118cf5p-7,
      0x1.6c16c179fddbdp-10, 0x1.a01a0171b73b8p-13, 0x1.a019b3a0017cfp-16,
      0x1.71de975b1286fp-19, 0x1.2897625b425c6p-22, 0x1.ae4931ba5c2f4p-26};
  /// (2 atanh(s) - 2 s) / s^3 of s^2, s <= tan(pi/8)^2: 2^-59.5 of 2 atanh(s).
  static constexpr std::array kLogarithm{
      0x1.5555555555592p-1, 0x1.999999997fd37p-2, 0x1.24924941f8dd2p-2, 0x1.c71c5202a6fb6p-3,
      0x1.7466405e6ebf9p-3, 0x1.39a192f4853dcp-3, 0x1.2f0708260b693p-3};
  /// (sin(r) - r) / r^3 of r^2, |r| <= pi/4: 2^-57.9 of sin(r).
  static constexpr std::array kSine{-0x1.5555555555548p-3,  0x1.111111110f7c9p-7,
                                    -0x1.a01a019bfd107p-13, 0x1.71de35670c735p-19,
                                    -0x1.ae5e59f144ee8p-26, 0x1.5d8fa1ee89b1dp-33};
  /// (cos(r) - 1 + r^2/2) / r^4 of r^2, |r| <= pi/4: 2^-64.2.
  static constexpr std::array kCosine{0x1.555555555554cp-5,  -0x1.6c16c16c1517ep-10,
                                      0x1.a01a019cb1be1p-16, -0x1.27e4f809f01dbp-22,
                                      0x1.1ee9ebe86d5d7p-29, -0x1.8fae9be9d57f5p-37};
  /// (atan(t) - t) / t^3 of t^2, |t| <= 9/16: 2^-57.8 of atan(t).
  static constexpr std::array kArctangent{
      -0x1.555555555551cp-2, 0x1.99999999928bep-3, -0x1.2492492221cf6p-3, 0x1.c71c70ed04dcbp-4,
      -0x1.745d00bbea9c2p-4, 0x1.3b12304d04825p-4, -0x1.10ff9b72b79d4p-4, 0x1.e0c57fdfc06b7p-5,
      -0x1.a8b42d57d3da9p-5, 0x1.6b2e4e2491d93p-5, -0x1.13d48d0749cb3p-5, 0x1.3ac1b53dc6340p-6,
      -0x1.7dd89dae6e277p-8};

  // Constants in parts: all but the last have few enough bits for exact small multiples.
  static constexpr double kLog2e = 0x1.71547652b82fep+0;
  static constexpr std::array kLn2{0x1.62e42fefa3800p-1, 0x1.ef35793c76730p-45};
  static constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
  static constexpr std::array kHalfPi{0x1.921fb54440000p+0, 0x1.68c234c4c0000p-39,
                                      0x1.98a2e03707345p-77};
  static constexpr std::array kQuarterPi{0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55};
  /// Up to this magnitude multiples of the parts of pi/2 are exact.
  static constexpr double kLargestAngle = 1e5;
  /// Outside this range e^x is 0 or infinite.
  static constexpr double kLowestPower = -746, kHighestPower = 710;
};

template <>
struct Coefficients<float> {
  /// 2^-26.1
  static constexpr std::array kExponential{0x1.5554b8p-3F, 0x1.5555bap-5F, 0x1.122370p-7F,
                                           0x1.6c5572p-10F};
  /// 2^-30.2
  static constexpr std::array kLogarithm{0x1.55557ap-1F, 0x1.995eb4p-2F, 0x1.31e3b2p-2F};
  /// 2^-28.0
  static constexpr std::array kSine{-0x1.555546p-3F, 0x1.11073ap-7F, -0x1.99438cp-13F};
  /// 2^-33.3
  static constexpr std::array kCosine{0x1.55554ap-5F, -0x1.6c0c8ap-10F, 0x1.9a020ap-16F};
  /// 2^-29.7
  static constexpr std::array kArctangent{-0x1.555546p-2F, 0x1.99923ap-3F,  -0x1.23f59ep-3F,
                                          0x1.baec22p-4F,  -0x1.348b56p-4F, 0x1.0cb84cp-5F};

  static constexpr float kLog2e = 0x1.715476p+0F;
  static constexpr std::array kLn2{0x1.62e400p-1F, 0x1.7f7d1cp-20F};
  static constexpr float kTwoOverPi = 0x1.45f306p-1F;
  static constexpr std::array kHalfPi{0x1.921c00p+0F, 0x1.daa200p-15F, 0x1.0b4612p-34F};
  static constexpr std::array kQuarterPi{0x1.921fb0p-1F, 0x1.5110b4p-23F};
  static constexpr float kLargestAngle = 400;
  static constexpr float kLowestPower = -104, kHighestPower = 89;
};

/// `result`, with `function(x...)` in the lanes where the mask is set.
template <class Real, int Lanes, class Function, class... Packs>
[[gnu::noinline, gnu::cold]] Pack<Real, Lanes> replaced(PackMask<Real, Lanes> mask,
                                                        Pack<Real, Lanes> result, Function function,
                                                        Packs... x) noexcept {
  for (int k = 0; k < Lanes; ++k)
    if (mask[k]) result.set(k, function(x[k]...));
  return result;
}

/// x = n ln(2) + high - low, with the nearest integer n.
template <class Real, int Lanes>
struct PowerOfTwo {
  Pack<Real, Lanes> n, high, low;
};

template <class Real, int Lanes>
[[gnu::always_inline]] inline PowerOfTwo<Real, Lanes> reduced_power(Pack<Real, Lanes> x) noexcept {
  using Number = Pack<Real, Lanes>;
  using Constant = Coefficients<Real>;
  const Number n =
      (x * Number(Constant::kLog2e) + Format<Real>::kRounding) - Number(Format<Real>::kRounding);
  return {n, x - n * Constant::kLn2[0], n * Constant::kLn2[1]};
}

/// 2^n where that is a normal number.
template <class Real, int Lanes>
[[gnu::always_inline]] inline Pack<Real, Lanes> power_of_two(Pack<Real, Lanes> n) noexcept {
  using F = Format<Real>;
  return of_bits<Real, Lanes>(to_bits(n + (F::kRounding + F::kBias)) << F::kMantissaBits);
}

/// p 2^n, rounded once, for p near 1 and any n from underflow to overflow.
template <class Real, int Lanes>
[[gnu::always_inline]] inline Pack<Real, Lanes> scaled(Pack<Real, Lanes> p,
                                                       Pack<Real, Lanes> n) noexcept {
#if defined(__AVX512F__)
  if constexpr (sizeof(p) == 64) {
    using Raw = typename Pack<Real, Lanes>::Raw;
    if constexpr (sizeof(Real) == 8)
      return Pack<Real, Lanes>(
          (Raw)_mm512_maskz_scalef_pd(__mmask8(-1), (__m512d)p.raw, (__m512d)n.raw));
    else
      return Pack<Real, Lanes>(
          (Raw)_mm512_maskz_scalef_ps(__mmask16(-1), (__m512)p.raw, (__m512)n.raw));
  }
#endif
  // 2^n may overflow or underflow, but is a product of two powers of about half the exponent.
  using F = Format<Real>;
  const Bits<Real, Lanes> exponents = to_bits(n + (F::kRounding + 2 * F::kBias));
  const Bits<Real, Lanes> half = exponents >> 1;
  return p * of_bits<Real, Lanes>(half << F::kMantissaBits) *
         of_bits<Real, Lanes>((exponents - half) << F::kMantissaBits);
}

/// An angle as `quarter_turns` (in the low bits) and a rest |r| <= pi/4, r = high - low.
template <class Real, int Lanes>
struct ReducedAngle {
  Bits<Real, Lanes> quarter_turns;
  Pack<Real, Lanes> high, low;
};

template <class Real, int Lanes>
[[gnu::always_inline]] inline ReducedAngle<Real, Lanes> reduced_angle(
    Pack<Real, Lanes> x) noexcept {
  using Number = Pack<Real, Lanes>;
  using Constant = Coefficients<Real>;
  const Number shifted = x * Number(Constant::kTwoOverPi) + Format<Real>::kRounding;
  const Number n = shifted - Format<Real>::kRounding;
  const Number exact = x - n * Constant::kHalfPi[0];
  const Number second = n * Constant::kHalfPi[1];
  const Number high = exact - second;
  return {to_bits(shifted), high, (second - (exact - high)) + n * Constant::kHalfPi[2]};
}

template <class Real, int Lanes>
[[gnu::always_inline]] inline SinCos<Pack<Real, Lanes>> sin_cos_within(
    ReducedAngle<Real, Lanes> a) noexcept {
  using Number = Pack<Real, Lanes>;
  using F = Format<Real>;
  using Constant = Coefficients<Real>;
  const Number r = a.high - a.low;
  const Number z = r * r;
  const Number sine = a.high - (a.low - r * z * polynomial(z, Constant::kSine));
  const Number half = Number(Real(0.5)) * z;
  const Number near_one = 1 - half;
  const Number cosine =
      near_one + (((1 - near_one) - half) + z * z * polynomial(z, Constant::kCosine));

  const Bits<Real, Lanes> odd = -(a.quarter_turns & 1);
  const PackMask<Real, Lanes> swap((typename PackMask<Real, Lanes>::Raw)odd);
  const auto negated_if_second_bit = [](Number value, Bits<Real, Lanes> turns) {
    return of_bits<Real, Lanes>(to_bits(value) ^ ((turns << (F::kBits - 2)) & F::kSign));
  };
  return {negated_if_second_bit(select(swap, cosine, sine), a.quarter_turns),
          negated_if_second_bit(select(swap, sine, cosine), a.quarter_turns + 1)};
}

}  // namespace pack_detail

/// e^x. Reduced by ln(2); 2^n enters through the exponent.
template <class Real, int Lanes>
[[gnu::always_inline]] inline Pack<Real, Lanes> exp(Pack<Real, Lanes> x) noexcept {
  using Number = Pack<Real, Lanes>;
  using Constant = pack_detail::Coefficients<Real>;
  const auto [n, high, low] = pack_detail::reduced_power(
      max(min(x, Number(Constant::kHighestPower)), Number(Constant::kLowestPower)));
  const Number r = high - low;
  const Number q = pack_detail::polynomial(r, Constant::kExponential);
  return pack_detail::scaled(1 + (r + r * r * (Real(0.5) + r * q)), n);
}

/// e^x - 1, accurate near zero too: 2^n (e^r - 1) + (2^n - 1), in which the large terms are summed
/// without error.
template <class Real, int Lanes>
[[gnu::always_inline]] inline Pack<Real, Lanes> expm1(Pack<Real, Lanes> x) noexcept {
  using Number = Pack<Real, Lanes>;
  using Constant = pack_detail::Coefficients<Real>;
  constexpr Real kMinusOneBelow = -2 * std::numeric_limits<Real>::digits;
  const auto [n, high, low] = pack_detail::reduced_power(
      max(min(x, Number(Constant::kHighestPower)), Number(kMinusOneBelow)));
  const Number r = high - low;
  const Number z = r * r;
  const Number q = pack_detail::polynomial(r, Constant::kExponential);
  const Number rest = Real(0.5) * z + (z * r * q + ((high - r) - low));
  // Computed at half scale because 2^n may overflow.
  const Number scale = pack_detail::power_of_two(n - 1);
  const Number offset = scale - Real(0.5);
  const Number sum = offset + scale * r;
  const Number error = (offset - sum) + scale * r;
  const Number result = 2 * (sum + (error + scale * rest));
  return select(abs(x) < Number(std::numeric_limits<Real>::epsilon() / 2), x, result);
}

/// Natural logarithm: with x = 2^e (1 + f) and s = f / (2 + f), log(1 + f) = 2 atanh(s), written as
/// f - f^2/2 + ... (the arrangement of FDLIBM, Sun Microsystems, 1993).
template <class Real, int Lanes>
[[gnu::always_inline]] inline Pack<Real, Lanes> log(Pack<Real, Lanes> x) noexcept {
  using Number = Pack<Real, Lanes>;
  using F = pack_detail::Format<Real>;
  using Bits = pack_detail::Bits<Real, Lanes>;
  using Constant = pack_detail::Coefficients<Real>;
  using Limits = std::numeric_limits<Real>;
  const auto subnormal = x < Number(Limits::min());
  const Number normal = select(subnormal, x * F::kCounting, x);
  // Relative to sqrt(1/2), where a mantissa reaches the next exponent.
  const Bits start = pack_detail::to_bits(Number(std::numbers::sqrt2_v<Real> / 2));
  const Bits from_start =
      pack_detail::to_bits(normal) - start + (typename F::Integer(F::kBias) << F::kMantissaBits);
  const Number f =
      pack_detail::of_bits<Real, Lanes>((from_start & F::kMantissa) + start) - Number(1);
  const Number e = pack_detail::of_bits<Real, Lanes>((from_start >> F::kMantissaBits) |
                                                     pack_detail::to_bits(Number(F::kCounting))) -
                   select(subnormal, Number(F::kCounting + F::kBias + F::kMantissaBits),
                          Number(F::kCounting + F::kBias));

  const Number s = f / (2 + f);
  const Number z = s * s;
  const Number half_square = Number(Real(0.5)) * f * f;
  const Number rest = s * (half_square + z * pack_detail::polynomial(z, Constant::kLogarithm));
  const Number finite =
      e * Constant::kLn2[0] - ((half_square - (rest + e * Constant::kLn2[1])) - f);

  const Number positive = select(x < Number(Limits::infinity()), finite, x);
  const Number at_zero = select(x == Number(0), Number(-Limits::infinity()), positive);
  return select(x < Number(0), Number(Limits::quiet_NaN()), at_zero);
}

/// Sine and cosine of an angle in radians. Reduced by pi/2; lanes with |x| above 100000 (`float`:
/// 400) are computed one by one.
template <class Real, int Lanes>
[[gnu::always_inline]] inline SinCos<Pack<Real, Lanes>> sin_cos(Pack<Real, Lanes> x) noexcept {
  auto result = pack_detail::sin_cos_within(pack_detail::reduced_angle(x));
  const auto large = abs(x) > Pack<Real, Lanes>(pack_detail::Coefficients<Real>::kLargestAngle);
  if (any(large)) [[unlikely]] {
    result.sin = pack_detail::replaced(
        large, result.sin, [](Real a) { return std::sin(a); }, x);
    result.cos = pack_detail::replaced(
        large, result.cos, [](Real a) { return std::cos(a); }, x);
  }
  return result;
}

/// Sine of each lane, as `sin_cos`.
template <class Real, int Lanes>
[[gnu::always_inline]] inline Pack<Real, Lanes> sin(Pack<Real, Lanes> x) noexcept {
  return sin_cos(x).sin;
}

/// Cosine of each lane, as `sin_cos`.
template <class Real, int Lanes>
[[gnu::always_inline]] inline Pack<Real, Lanes> cos(Pack<Real, Lanes> x) noexcept {
  return sin_cos(x).cos;
}

/// The angle of (x, y), from -pi to pi. The ratio of the smaller to the larger magnitude gives
/// atan(a/b), or above 9/16 pi/4 + atan((a - b) / (a + b)), with one division; reflections give the
/// other octants.
template <class Real, int Lanes>
[[gnu::always_inline]] inline Pack<Real, Lanes> atan2(Pack<Real, Lanes> y,
                                                      Pack<Real, Lanes> x) noexcept {
  using Number = Pack<Real, Lanes>;
  using F = pack_detail::Format<Real>;
  using Constant = pack_detail::Coefficients<Real>;
  const Number width = abs(x), height = abs(y);
  const auto steep = height > width;
  const auto backward = copysign(Number(1), x) < Number(0);
  const Number a = select(steep, width, height), b = select(steep, height, width);
  const auto diagonal = 16 * a > 9 * b;
  const Number numerator = select(diagonal, a - b, a);
  const Number denominator = select(diagonal, a + b, select(b == Number(0), Number(1), b));

  Number eighths = select(diagonal, Number(1), Number(0));
  eighths = select(steep, 2 - eighths, eighths);
  eighths = select(backward, 4 - eighths, eighths);
  // Each of these reflects the angle.
  const pack_detail::Bits<Real, Lanes> mirrored =
      ((pack_detail::Bits<Real, Lanes>)steep.raw ^ pack_detail::to_bits(x)) & F::kSign;
  const Number t =
      pack_detail::of_bits<Real, Lanes>(pack_detail::to_bits(numerator) ^ mirrored) / denominator;
  const Number z = t * t;
  const Number rest =
      eighths * Constant::kQuarterPi[1] + t * z * pack_detail::polynomial(z, Constant::kArctangent);
  Number angle = copysign(eighths * Constant::kQuarterPi[0] + (t + rest), y);

  const auto large = b > Number(std::numeric_limits<Real>::max() / 16);
  if (any(large)) [[unlikely]]
    angle = pack_detail::replaced(
        large, angle, [](Real v, Real u) { return std::atan2(v, u); }, y, x);
  return angle;
}

/// Arc tangent of each lane, as `atan2`.
template <class Real, int Lanes>
[[gnu::always_inline]] inline Pack<Real, Lanes> atan(Pack<Real, Lanes> x) noexcept {
  return atan2(x, Pack<Real, Lanes>(1));
}

/// sqrt(x^2 + y^2). Lanes whose squares would overflow or lose bits are computed one by one.
template <class Real, int Lanes>
[[gnu::always_inline]] inline Pack<Real, Lanes> hypot(Pack<Real, Lanes> x,
                                                      Pack<Real, Lanes> y) noexcept {
  using Number = Pack<Real, Lanes>;
  using Limits = std::numeric_limits<Real>;
  const Number square = x * x + y * y;
  const Number root = sqrt(square);
  // Squares of smaller numbers may lose bits, those of larger ones may overflow.
  constexpr Real kSmall = Limits::min() / (Limits::epsilon() * Limits::epsilon());
  const auto safe = square >= Number(kSmall) && square <= Number(Limits::max());
  if (!all(safe)) [[unlikely]] {
    const auto replace = !safe && (x != Number(0) || y != Number(0));
    return pack_detail::replaced(
        replace, root, [](Real u, Real v) { return std::hypot(u, v); }, x, y);
  }
  return root;
}

}  // namespace WAKELINE_INSTRUCTION_SET
}  // namespace wakeline
