// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Several numbers in one register, as a Scalar for everything else in the library.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#include "wakeline/simd/scalar.hpp"
#include "wakeline/simd/unroll.hpp"

// A namespace per instruction set, so that code compiled for different ones can be linked together.
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#define WAKELINE_INSTRUCTION_SET avx512
#define WAKELINE_REGISTER_BYTES 64
#elif defined(__AVX2__) && defined(__FMA__)
#define WAKELINE_INSTRUCTION_SET avx2
#define WAKELINE_REGISTER_BYTES 32
#elif defined(__AVX2__)
#define WAKELINE_INSTRUCTION_SET avx2_unfused
#define WAKELINE_REGISTER_BYTES 32
#elif defined(__SSE2__)
#define WAKELINE_INSTRUCTION_SET sse2
#define WAKELINE_REGISTER_BYTES 16
#elif defined(__ARM_NEON)
#define WAKELINE_INSTRUCTION_SET neon
#define WAKELINE_REGISTER_BYTES 16
#else
#define WAKELINE_INSTRUCTION_SET portable
#define WAKELINE_REGISTER_BYTES 16
#endif

namespace wakeline {
inline namespace WAKELINE_INSTRUCTION_SET {

/// Lanes of the widest register of the target instruction set. A wider pack works but is slower.
template <class Real>
inline constexpr int kNativeLanes = WAKELINE_REGISTER_BYTES / int(sizeof(Real));

/// A boolean for each lane of a `Pack`: the bits of a lane are all set or all clear.
template <class Real, int Lanes>
class PackMask {
  using Integer = std::conditional_t<sizeof(Real) == 8, std::int64_t, std::int32_t>;

 public:
  using Raw [[gnu::vector_size(sizeof(Real) * Lanes)]] = Integer;
  Raw raw;

  PackMask() = default;
  explicit PackMask(Raw bits) noexcept : raw(bits) {}
  // NOLINTNEXTLINE(google-explicit-constructor): a truth about all lanes.
  PackMask(bool everywhere) noexcept : raw(Integer(everywhere ? -1 : 0) - Raw{}) {}

  /// Lane k is bit k.
  static PackMask of_bits(unsigned bits) noexcept {
    Raw bit_of_lane;
    for (int k = 0; k < Lanes; ++k) bit_of_lane[k] = Integer(1) << k;
    return PackMask(Raw((bit_of_lane & Integer(bits)) != 0));
  }

  [[nodiscard]] bool operator[](int lane) const noexcept { return raw[lane] != 0; }
  void set(int lane, bool truth) noexcept { raw[lane] = truth ? -1 : 0; }

  friend PackMask operator&&(PackMask a, PackMask b) noexcept { return PackMask(a.raw & b.raw); }
  friend PackMask operator||(PackMask a, PackMask b) noexcept { return PackMask(a.raw | b.raw); }
  friend PackMask operator!(PackMask a) noexcept { return PackMask(~a.raw); }

  /// Bit k is lane k.
  friend unsigned bits_of(PackMask mask) noexcept {
    [[maybe_unused]] constexpr int kBytes = int(sizeof(Raw));
    [[maybe_unused]] constexpr bool kDouble = sizeof(Real) == 8;
#if defined(__AVX512DQ__)
    if constexpr (kBytes == 64 && kDouble) return _mm512_movepi64_mask((__m512i)mask.raw);
    if constexpr (kBytes == 64 && !kDouble) return _mm512_movepi32_mask((__m512i)mask.raw);
#endif
#if defined(__AVX__)
    if constexpr (kBytes == 32 && kDouble) return unsigned(_mm256_movemask_pd((__m256d)mask.raw));
    if constexpr (kBytes == 32 && !kDouble) return unsigned(_mm256_movemask_ps((__m256)mask.raw));
#endif
#if defined(__SSE2__)
    if constexpr (kBytes == 16 && kDouble) return unsigned(_mm_movemask_pd((__m128d)mask.raw));
    if constexpr (kBytes == 16 && !kDouble) return unsigned(_mm_movemask_ps((__m128)mask.raw));
#endif
    unsigned bits = 0;
    for (int k = 0; k < Lanes; ++k) bits |= unsigned(mask.raw[k] & 1) << k;
    return bits;
  }
  friend bool any(PackMask mask) noexcept { return bits_of(mask) != 0; }
  friend bool none(PackMask mask) noexcept { return !any(mask); }
  friend bool all(PackMask mask) noexcept { return !any(!mask); }
};

/// `Lanes` numbers, with every operation lane by lane: a `Scalar` of the filters. Comparisons
/// return a `PackMask`; `select` replaces a branch.
template <class Real, int Lanes>
class Pack {
  static_assert(std::floating_point<Real> && Lanes > 1 && (Lanes & (Lanes - 1)) == 0);

 public:
  using Raw [[gnu::vector_size(sizeof(Real) * Lanes)]] = Real;
  using Mask = PackMask<Real, Lanes>;
  Raw raw;

  Pack() = default;
  explicit Pack(Raw numbers) noexcept : raw(numbers) {}
  /// The same number in each lane.
  template <class Number>
  requires(std::is_arithmetic_v<Number>)
      // NOLINTNEXTLINE(google-explicit-constructor): what a constant in a formula means.
      Pack(Number number)
  noexcept : raw(Real(number) - Raw{}) {}

  /// Lane k is `number(k)`.
  template <class Function>
  static Pack of(const Function& number) noexcept {
    Pack pack;
    for (int k = 0; k < Lanes; ++k) pack.raw[k] = Real(number(k));
    return pack;
  }

  /// Loads or stores consecutive numbers.
  static Pack load(const Real* from) noexcept {
    Pack pack;
    std::memcpy(&pack.raw, from, sizeof pack.raw);
    return pack;
  }
  friend void store(Pack a, Real* to) noexcept { std::memcpy(to, &a.raw, sizeof a.raw); }
  friend void store(Pack a, double* to) noexcept requires(std::same_as<Real, float>) {
    using Doubles [[gnu::vector_size(sizeof(double) * Lanes)]] = double;
    const Doubles numbers = __builtin_convertvector(a.raw, Doubles);
    std::memcpy(to, &numbers, sizeof numbers);
  }

  [[nodiscard]] Real operator[](int lane) const noexcept { return raw[lane]; }
  void set(int lane, Real number) noexcept { raw[lane] = number; }

  friend Pack operator+(Pack a, Pack b) noexcept { return Pack(a.raw + b.raw); }
  friend Pack operator-(Pack a, Pack b) noexcept { return Pack(a.raw - b.raw); }
  friend Pack operator*(Pack a, Pack b) noexcept { return Pack(a.raw * b.raw); }
  friend Pack operator/(Pack a, Pack b) noexcept { return Pack(a.raw / b.raw); }
  friend Pack operator-(Pack a) noexcept { return Pack(-a.raw); }
  friend Pack operator+(Pack a) noexcept { return a; }
  Pack& operator+=(Pack b) noexcept { return *this = *this + b; }
  Pack& operator-=(Pack b) noexcept { return *this = *this - b; }
  Pack& operator*=(Pack b) noexcept { return *this = *this * b; }
  Pack& operator/=(Pack b) noexcept { return *this = *this / b; }

  friend Mask operator<(Pack a, Pack b) noexcept { return compared(a.raw < b.raw); }
  friend Mask operator<=(Pack a, Pack b) noexcept { return compared(a.raw <= b.raw); }
  friend Mask operator>(Pack a, Pack b) noexcept { return compared(a.raw > b.raw); }
  friend Mask operator>=(Pack a, Pack b) noexcept { return compared(a.raw >= b.raw); }
  friend Mask operator==(Pack a, Pack b) noexcept { return compared(a.raw == b.raw); }
  friend Mask operator!=(Pack a, Pack b) noexcept { return compared(a.raw != b.raw); }

  friend Pack select(Mask condition, Pack a, Pack b) noexcept {
    return Pack(condition.raw ? a.raw : b.raw);
  }
  // Returns the first operand when one is NaN. (On `raw`, because compilers recognise it as one
  // instruction.)
  friend Pack min(Pack a, Pack b) noexcept { return Pack(b.raw < a.raw ? b.raw : a.raw); }
  friend Pack max(Pack a, Pack b) noexcept { return Pack(b.raw > a.raw ? b.raw : a.raw); }
  friend Pack abs(Pack a) noexcept { return from_bits(a.bits() & ~sign_bit()); }
  /// The magnitude of a with the sign of b.
  friend Pack copysign(Pack a, Pack b) noexcept {
    return from_bits((a.bits() & ~sign_bit()) | (b.bits() & sign_bit()));
  }
  friend Mask isnan(Pack a) noexcept { return a != a; }
  friend Mask isfinite(Pack a) noexcept { return a - a == Pack(0); }
  friend Pack sqrt(Pack a) noexcept { return Pack(square_root(a.raw)); }

  // Newton's method from the processor's approximation where there is one, which is faster than a
  // division.
  friend Pack reciprocal(Pack a) noexcept {
#if defined(__AVX512F__)
    if constexpr (sizeof(Raw) == 64) {
      Pack y;
      if constexpr (sizeof(Real) == 8) {
        y = Pack((Raw)_mm512_maskz_rcp14_pd(__mmask8(-1), (__m512d)a.raw));
        y = y + y * (Real(1) - a * y);
      } else {
        y = Pack((Raw)_mm512_maskz_rcp14_ps(__mmask16(-1), (__m512)a.raw));
      }
      return y + y * (Real(1) - a * y);
    }
#endif
    return Real(1) / a;
  }
  friend Pack inverse_sqrt(Pack a) noexcept {
#if defined(__AVX512F__)
    if constexpr (sizeof(Raw) == 64) {
      const Pack half = a * Real(0.5);
      Pack y;
      if constexpr (sizeof(Real) == 8) {
        y = Pack((Raw)_mm512_maskz_rsqrt14_pd(__mmask8(-1), (__m512d)a.raw));
        y = y + y * (Real(0.5) - half * y * y);
      } else {
        y = Pack((Raw)_mm512_maskz_rsqrt14_ps(__mmask16(-1), (__m512)a.raw));
      }
      return y + y * (Real(0.5) - half * y * y);
    }
#endif
    return Real(1) / sqrt(a);
  }

  /// The nearest integer, halves to even.
  friend Pack round_to_even(Pack a) noexcept {
    // Adding a number whose last bit is worth 1 rounds; larger numbers have no fractional part.
    const Pack shift = copysign(Pack(kFirstInteger), a);
    return select(abs(a) < Pack(kFirstInteger), copysign((a + shift) - shift, a), a);
  }
  friend Pack floor(Pack a) noexcept {
    const Pack rounded = round_to_even(a);
    return rounded - select(rounded > a, Pack(1), Pack(0));
  }

  friend Real lane(const Pack& a, int k) noexcept { return a.raw[k]; }
  // Summed in the order of the lanes, so that the result is the same on every machine.
  friend Real sum_of_lanes(Pack a) noexcept {
    Real sum = a.raw[0];
    for (int k = 1; k < Lanes; ++k) sum += a.raw[k];
    return sum;
  }
  friend Real least_of_lanes(Pack a) noexcept {
    Real least = a.raw[0];
    for (int k = 1; k < Lanes; ++k) least = a.raw[k] < least ? a.raw[k] : least;
    return least;
  }
  friend Real greatest_of_lanes(Pack a) noexcept { return -least_of_lanes(-a); }

  /// The bit patterns as integers.
  [[nodiscard]] typename Mask::Raw bits() const noexcept { return (typename Mask::Raw)raw; }
  static Pack from_bits(typename Mask::Raw bits) noexcept { return Pack((Raw)bits); }

 private:
  static constexpr Real kFirstInteger = sizeof(Real) == 8 ? Real(0x1p52) : Real(0x1p23);

  static typename Mask::Raw sign_bit() noexcept { return Pack(Real(-0.0)).bits(); }

  template <class Bits>
  static Mask compared(Bits bits) noexcept {
    return Mask((typename Mask::Raw)bits);
  }

  static Raw square_root(Raw a) noexcept {
    [[maybe_unused]] constexpr bool kDouble = std::same_as<Real, double>;
    [[maybe_unused]] constexpr int kBytes = int(sizeof(Raw));
#if defined(__AVX512F__)
    if constexpr (kBytes == 64) {
      if constexpr (kDouble)
        return (Raw)_mm512_maskz_sqrt_pd(__mmask8(-1), (__m512d)a);
      else
        return (Raw)_mm512_maskz_sqrt_ps(__mmask16(-1), (__m512)a);
    }
#endif
#if defined(__AVX__)
    if constexpr (kBytes == 32) {
      if constexpr (kDouble)
        return (Raw)_mm256_sqrt_pd((__m256d)a);
      else
        return (Raw)_mm256_sqrt_ps((__m256)a);
    }
#endif
#if defined(__SSE2__)
    if constexpr (kBytes == 16) {
      if constexpr (kDouble)
        return (Raw)_mm_sqrt_pd((__m128d)a);
      else
        return (Raw)_mm_sqrt_ps((__m128)a);
    }
#elif defined(__aarch64__)
    if constexpr (kBytes == 16) {
      if constexpr (kDouble)
        return (Raw)vsqrtq_f64((float64x2_t)a);
      else
        return (Raw)vsqrtq_f32((float32x4_t)a);
    }
#endif
    for (int k = 0; k < Lanes; ++k) a[k] = std::sqrt(a[k]);
    return a;
  }
};

/// Lanes of two registers in the order `From`; those of `b` follow those of `a`.
template <int... From, class Raw, class Integers>
[[gnu::always_inline]] inline Raw shuffled(Raw a, Raw b, Integers) noexcept {
#if defined(__clang__)
  return __builtin_shufflevector(a, b, From...);
#else
  return __builtin_shuffle(a, b, Integers{From...});
#endif
}

/// Swaps the elements of `upper` in every second block of `Size` lanes with those of `lower` in the
/// other blocks.
template <int Size, class Real, int Lanes, int... Lane>
[[gnu::always_inline]] inline void swap_blocks(Pack<Real, Lanes>& upper, Pack<Real, Lanes>& lower,
                                               std::integer_sequence<int, Lane...>) noexcept {
  using Integers = typename PackMask<Real, Lanes>::Raw;
  const auto a = upper.raw, b = lower.raw;
  upper.raw = shuffled<((Lane & Size) ? Lanes + Lane - Size : Lane)...>(a, b, Integers{});
  lower.raw = shuffled<((Lane & Size) ? Lanes + Lane : Lane + Size)...>(a, b, Integers{});
}

/// Transposes the off-diagonal blocks of `Size` x `Size` within each block of twice that size.
template <int Size, class Real, int Lanes>
[[gnu::always_inline]] inline void swap_blocks(Pack<Real, Lanes> (&rows)[Lanes]) noexcept {
  unroll<Lanes>([&](auto row) {
    if constexpr ((row.value & Size) == 0)
      swap_blocks<Size>(rows[row.value], rows[row.value + Size],
                        std::make_integer_sequence<int, Lanes>{});
  });
}

/// Transposes a square of as many rows as lanes.
template <class Real, int Lanes>
[[gnu::always_inline]] inline void transpose(Pack<Real, Lanes> (&rows)[Lanes]) noexcept {
  swap_blocks<1>(rows);
  if constexpr (Lanes > 2) swap_blocks<2>(rows);
  if constexpr (Lanes > 4) swap_blocks<4>(rows);
  if constexpr (Lanes > 8) swap_blocks<8>(rows);
  static_assert(Lanes <= 16);
}

/// Stores the elements of lanes `First` and `First + 1`.
template <int First, class Real, int Lanes, class Number>
[[gnu::always_inline]] inline void store_pair(Pack<Real, Lanes> pack, Number* to) noexcept {
#if defined(__AVX512DQ__)
  if constexpr (First > 0 && sizeof(pack) == 64 && std::same_as<Real, double>) {
    // One instruction; GCC 12 would use a shuffle and a store.
    _mm_storeu_pd(to, _mm512_maskz_extractf64x2_pd(__mmask8(-1), (__m512d)pack.raw, First / 2));
    return;
  }
#endif
  using Pair [[gnu::vector_size(2 * sizeof(Real))]] = Real;
  using Numbers [[gnu::vector_size(2 * sizeof(Number))]] = Number;
  const Numbers numbers =
      __builtin_convertvector((Pair{pack.raw[First], pack.raw[First + 1]}), Numbers);
  std::memcpy(to, &numbers, sizeof numbers);
}

/// Stores two numbers of each lane at `place(lane)`, from the last lane to the first. Without wider
/// alignment, whole registers would cross cache lines, and such a store takes as long as six
/// others.
template <class Real, int Lanes, class Place>
[[gnu::always_inline]] inline void store_pairs(Pack<Real, Lanes> first, Pack<Real, Lanes> second,
                                               const Place& place) noexcept {
  swap_blocks<1>(first, second, std::make_integer_sequence<int, Lanes>{});
  unroll<Lanes>([&](auto before) {
    constexpr int kLane = Lanes - 1 - before.value;
    if constexpr ((kLane & 1) != 0)
      store_pair<kLane - 1>(second, place(kLane));
    else
      store_pair<kLane>(first, place(kLane));
  });
}

/// Calls the function with the first index of each block of `Lanes` that together cover `Size`
/// numbers; the last block may overlap the one before.
template <int Size, int Lanes, class Function>
[[gnu::always_inline]] inline void unroll_blocks(const Function& function) noexcept {
  unroll<Size / Lanes>([&](auto block) { function(Index<block.value * Lanes>{}); });
  if constexpr (Size > Lanes && Size % Lanes != 0) function(Index<Size - Lanes>{});
}

/// `packs[k]` is number k of the arrays that `array(lane)` gives.
template <int Size, class Array, class Packs>
requires(kLanesIn<Packs> > 1)
    [[gnu::always_inline]] inline void gather_lanes(const Array& array, Packs packs) noexcept {
  using PackType = std::decay_t<decltype(packs[0])>;
  constexpr int kLanes = kLanesOf<PackType>;
  unroll_blocks<Size, kLanes>([&](auto first) {
    PackType rows[kLanes];
    unroll<kLanes>([&](int k) { rows[k] = PackType::load(array(k) + first.value); });
    transpose(rows);
    unroll<kLanes>([&](int k) { packs[first.value + k] = rows[k]; });
  });
  if constexpr (Size < kLanes)
    unroll<Size>([&](int k) { packs[k] = PackType::of([&](int lane) { return array(lane)[k]; }); });
}

/// The reverse, for the first `count` lanes.
template <int Size, class Array, class Packs>
requires(kLanesIn<Packs> > 1)
    [[gnu::always_inline]] inline void scatter_lanes(Packs packs, int count,
                                                     const Array& array) noexcept {
  using PackType = std::decay_t<decltype(packs[0])>;
  constexpr int kLanes = kLanesOf<PackType>;
  unroll_blocks<Size, kLanes>([&](auto first) {
    PackType rows[kLanes];
    unroll<kLanes>([&](int k) { rows[k] = packs[first.value + k]; });
    transpose(rows);
    unroll<kLanes>([&](int k) {
      if (k < count) store(rows[k], array(k) + first.value);
    });
  });
  if constexpr (Size < kLanes)
    for (int k = 0; k < count; ++k) unroll<Size>([&](int i) { array(k)[i] = lane(packs[i], k); });
}

/// `sums[k]` is the sum of the lanes of `packs[k]`, in lane order. Stores whole registers: there
/// must be room for `Size` rounded up to a multiple of the lanes.
template <int Size, class Real, int Lanes>
[[gnu::always_inline]] inline void sum_lanes(const Pack<Real, Lanes>* packs, Real* sums) noexcept {
  unroll<(Size + Lanes - 1) / Lanes>([&](auto block) {
    constexpr int kFirst = block.value * Lanes;
    Pack<Real, Lanes> rows[Lanes];
    unroll<Lanes>([&](auto k) {
      rows[k] = kFirst + k.value < Size ? packs[kFirst + k.value] : Pack<Real, Lanes>(0);
    });
    transpose(rows);
    unroll<Lanes - 1>([&](auto k) { rows[0] += rows[k.value + 1]; });
    store(rows[0], sums + kFirst);
  });
}

}  // namespace WAKELINE_INSTRUCTION_SET

template <class Number, int Lanes>
struct ScalarTraits<Pack<Number, Lanes>> {
  using Real = Number;
  using Mask = PackMask<Number, Lanes>;
  static constexpr int kLanes = Lanes;

  template <class Function>
  static Pack<Number, Lanes> of(const Function& number) noexcept {
    return Pack<Number, Lanes>::of(number);
  }
  static Pack<Number, Lanes> load(const Number* from) noexcept {
    return Pack<Number, Lanes>::load(from);
  }
};

}  // namespace wakeline

/// Lets Eigen use a pack as a scalar.
template <class Real, int Lanes>
struct Eigen::NumTraits<wakeline::Pack<Real, Lanes>>
    : Eigen::GenericNumTraits<wakeline::Pack<Real, Lanes>> {
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
