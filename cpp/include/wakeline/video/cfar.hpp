// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Constant-false-alarm-rate (CFAR) detection along the range of a sweep. A cell is compared with
// the `train_cells` on each side of it, outside the `guard_cells` next to it, which are excluded
// because a target covers several cells.
//
//     cell averaging       a > f * (mean of the training cells) + d
//     ordered statistic    a > f * (k-th smallest of the training cells) + d,  k = ceil(rank * N)
//
// After a linear or square-law detector the threshold is set by a factor f, after a logarithmic one
// by an offset d, with f = 1.
//
// At the ends of the sweep the training cells are those that exist, with the same factor. Integer
// arithmetic: the factor, divided by the number of cells where a mean is used, is rounded up to 16
// binary places; the rest is exact.
//
// Source: H. Finn, R. Johnson, "Adaptive detection mode with threshold control as a function of
// spatially sampled clutter-level estimates", RCA Review 29 (1968), 414-464; H. Rohling, "Radar
// CFAR thresholding in clutter and multiple target situations", IEEE Trans. AES 19 (1983), 608-621.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/video/kernels.hpp"

namespace wakeline {

/// The statistic of the training cells that a cell is compared with.
enum class CfarKind : std::uint8_t { kCellAveraging, kOrderedStatistic };

/// Names of the kinds.
constexpr std::array<Word<CfarKind>, 2> words_of(CfarKind) noexcept {
  return {{{"cell_averaging", CfarKind::kCellAveraging},
           {"ordered_statistic", CfarKind::kOrderedStatistic}}};
}

/// Distribution of noise amplitudes: exponential after a square-law detector, Rayleigh after a
/// linear one.
enum class Noise : std::uint8_t { kExponential, kRayleigh };

/// The threshold that follows the amplitudes about a cell.
struct CfarSettings {
  CfarKind kind = CfarKind::kCellAveraging;
  int train_cells = 16;
  int guard_cells = 4;
  double threshold_factor = 3.0;
  int threshold_offset = 0;
  double rank = 0.75;
  int least_amplitude = 1;

  static constexpr auto fields() noexcept {
    using C = CfarSettings;
    return field_table(
        field("kind", &C::kind,
              "What the training cells are compared by: their mean or their k-th smallest."),
        field("train_cells", &C::train_cells, between(1, 128), "cells",
              "Training cells on each side."),
        field("guard_cells", &C::guard_cells, between(0, 4096), "cells",
              "Cells left out on each side, next to the cell."),
        field("threshold_factor", &C::threshold_factor, above_to(0, 1000), "1",
              "Factor of the mean or of the k-th smallest."),
        field("threshold_offset", &C::threshold_offset, between(0, 65535), "counts",
              "Added to that; what a logarithmic receiver needs."),
        field("rank", &C::rank, above_to(0, 1), "1",
              "k over the number of training cells; of the ordered statistic only."),
        field("least_amplitude", &C::least_amplitude, between(1, 65535), "counts",
              "Smaller amplitudes are never detected."));
  }

  void validate() const { validate_fields(*this); }

  /// Rank k of the training cell that is compared, of `count` that exist.
  [[nodiscard]] int rank_of(int count) const noexcept {
    return std::clamp(static_cast<int>(std::ceil(rank * count - 1e-9)), 1, std::max(count, 1));
  }
};

/// Probability of a detection in independent noise, with all N training cells.
///
///     cell averaging     exponential   (1 + f / N)^-N
///                        Rayleigh      (1 + f² b / N)^-N,   b = pi/4 + (1 - pi/4) / N
///     ordered statistic  exponential   prod_{i<k} (N - i) / (N - i + f)
///                        Rayleigh      the same with f²
///
/// The second approximates the square of a mean of Rayleigh amplitudes by a gamma distribution:
/// with N = 16 to 32, the true rate is 10 to 30 % above 1e-4 to 1e-6. It is exact for N = 1 and in
/// the limit of large N; the others are exact.
[[nodiscard]] inline double false_alarm_probability(const CfarSettings& cfar, Noise noise) {
  cfar.validate();
  const double n = 2.0 * cfar.train_cells;
  const double f = cfar.threshold_factor;
  const double power = noise == Noise::kExponential ? f : f * f;
  if (cfar.kind == CfarKind::kCellAveraging) {
    const double b =
        noise == Noise::kExponential ? 1.0 : kPi<double> / 4 + (1.0 - kPi<double> / 4) / n;
    return std::pow(1.0 + power * b / n, -n);
  }
  double probability = 1.0;
  for (int i = 0; i < cfar.rank_of(2 * cfar.train_cells); ++i)
    probability *= (n - i) / (n - i + power);
  return probability;
}

/// The threshold factor f for a probability, the inverse of `false_alarm_probability`:
///
///     cell averaging     exponential   f  = N (p^(-1/N) - 1)
///                        Rayleigh      f² = N (p^(-1/N) - 1) / b
///     ordered statistic  by bisection
///
/// Throws `std::invalid_argument` when the probability is not in (0, 1) or needs a factor above
/// 1000.
[[nodiscard]] inline double threshold_factor(CfarSettings cfar, Noise noise, double probability) {
  require(probability > 0.0 && probability < 1.0, "probability", "between 0 and 1", probability);
  double low = 0.0;
  double high = cfar.threshold_factor = 1000.0;
  require(false_alarm_probability(cfar, noise) <= probability, "probability",
          "one that a threshold factor of 1000 reaches", probability);
  if (cfar.kind == CfarKind::kCellAveraging) {
    const double n = 2.0 * cfar.train_cells;
    const double power = n * (std::pow(probability, -1.0 / n) - 1.0);
    const double b = kPi<double> / 4 + (1.0 - kPi<double> / 4) / n;
    return noise == Noise::kExponential ? power : std::sqrt(power / b);
  }
  while (high - low > 1e-12 * high) {
    const double middle = cfar.threshold_factor = 0.5 * (low + high);
    (false_alarm_probability(cfar, noise) > probability ? low : high) = middle;
  }
  return high;
}

/// Offset in decibels above the mean level of noise, after a logarithmic receiver, that noise
/// exceeds with a probability: 10 lg(-ln p) + 10 γ / ln 10, γ = 0.5772. Exact for a known mean,
/// i.e. for many training cells. Throws `std::invalid_argument` unless 0 < p < 1.
[[nodiscard]] inline double threshold_offset_db(double probability) {
  require(probability > 0.0 && probability < 1.0, "probability", "between 0 and 1", probability);
  constexpr double kMeanOfNoise_dB = 2.506815718;
  return 10.0 * std::log10(-std::log(probability)) + kMeanOfNoise_dB;
}

namespace detail {

/// Histogram of the cells of a sliding window: the k-th smallest is a few steps from the last one.
class SlidingHistogram {
 public:
  void insert(std::uint8_t amplitude) noexcept {
    ++cells_[amplitude];
    below_ += amplitude < level_;
  }
  void erase(std::uint8_t amplitude) noexcept {
    --cells_[amplitude];
    below_ -= amplitude < level_;
  }
  /// The k-th smallest, k from 1 to the number of cells.
  [[nodiscard]] std::uint8_t kth(int k) noexcept {
    while (below_ >= k) below_ -= cells_[static_cast<std::size_t>(--level_)];
    while (below_ + cells_[static_cast<std::size_t>(level_)] < k)
      below_ += cells_[static_cast<std::size_t>(level_++)];
    return static_cast<std::uint8_t>(level_);
  }

 private:
  std::array<std::uint16_t, 256> cells_{};
  int level_ = 0;
  int below_ = 0;  ///< number of cells below the level
};

/// The cells of a sliding window, at most 256, sorted: for amplitudes too many for a histogram. A
/// position is found by counting all smaller cells, without unpredictable branches.
class SortedWindow {
 public:
  SortedWindow() { cells_.fill(kPad); }

  void insert(std::uint16_t amplitude) noexcept {
    std::uint16_t* const place = cells_.data() + less_than(amplitude);
    std::copy_backward(place, cells_.data() + count_, cells_.data() + count_ + 1);
    *place = amplitude;
    ++count_;
  }
  void erase(std::uint16_t amplitude) noexcept {
    std::uint16_t* const place = cells_.data() + less_than(amplitude);
    std::copy(place + 1, cells_.data() + count_, place);
    cells_[--count_] = kPad;
  }
  /// The k-th smallest, k from 1 to the number of cells.
  [[nodiscard]] std::uint16_t kth(int k) const noexcept {
    return cells_[static_cast<std::size_t>(k - 1)];
  }

 private:
  static constexpr std::uint16_t kPad = 65535;  // never less than an amplitude
  static constexpr std::size_t kLanes = 16;

  [[nodiscard]] std::size_t less_than(std::uint16_t amplitude) const noexcept {
    std::uint16_t less = 0;
    for (std::size_t first = 0; first < count_; first += kLanes)
      for (std::size_t i = first; i < first + kLanes; ++i)
        less = static_cast<std::uint16_t>(less + (cells_[i] < amplitude));
    return less;
  }

  std::array<std::uint16_t, 256 + kLanes> cells_;
  std::size_t count_ = 0;
};

}  // namespace detail

/// Computes the thresholds of the cells of a sweep. Amplitudes of 8 or 16 bits.
template <class Amplitude = std::uint8_t>
class Cfar {
  static_assert(std::is_same_v<Amplitude, std::uint8_t> || std::is_same_v<Amplitude, std::uint16_t>,
                "a radar's amplitudes have 8 or 16 bits: std::uint8_t or std::uint16_t");

 public:
  static constexpr Amplitude kMost = std::numeric_limits<Amplitude>::max();

  /// Allocates all memory. Throws `std::invalid_argument` when a setting is invalid.
  Cfar(const CfarSettings& settings, int max_cells) : settings_(settings) {
    settings.validate();
    require(max_cells >= 1 && max_cells <= kMaxCells, "max_cells", "1 to 65536", max_cells);
    require(settings.least_amplitude <= kMost, "least_amplitude",
            "an amplitude of as many bits as the sweep's", settings.least_amplitude);
    sums_.resize(static_cast<std::size_t>(max_cells) + 1);
    const bool averaging = settings.kind == CfarKind::kCellAveraging;
    for (int count = 0; count <= 2 * settings.train_cells; ++count) {
      const double weight = settings.threshold_factor / (averaging ? std::max(count, 1) : 1);
      weight_.push_back(static_cast<std::uint32_t>(std::ceil(kOne * weight - 1e-9)));
      rank_.push_back(settings.rank_of(count));
    }
  }

  [[nodiscard]] const CfarSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] int max_cells() const noexcept { return static_cast<int>(sums_.size()) - 1; }

  /// For each cell the amplitude that it has to exceed; the largest amplitude, which none exceeds,
  /// for a cell without training cells. At most `max_cells` of both.
  void thresholds(std::span<const Amplitude> amplitude, std::span<Amplitude> threshold) noexcept {
    if (settings_.kind == CfarKind::kCellAveraging)
      average(amplitude, threshold.data());
    else
      order(amplitude, threshold.data());
    if (settings_.threshold_offset > 0) raise(threshold.first(amplitude.size()));
  }

  static constexpr int kMaxCells = 65536;

 private:
  // Sums are modulo the range of Sum; the difference over a window is correct because it fits.
  static constexpr bool kNarrow = sizeof(Amplitude) == 1;
  using Sum = std::conditional_t<kNarrow, std::uint16_t, std::uint32_t>;
  using Product = std::conditional_t<kNarrow, std::uint32_t, std::uint64_t>;
  static constexpr int kPlaces = 16;
  static constexpr double kOne = 1 << kPlaces;

  /// Lower bound of thresholds before the offset.
  [[nodiscard]] Amplitude floor() const noexcept {
    const int all_in_all = settings_.least_amplitude - 1;
    return static_cast<Amplitude>(std::max(all_in_all - settings_.threshold_offset, 0));
  }

  [[nodiscard]] Amplitude limited(std::uint64_t level) const noexcept {
    return static_cast<Amplitude>(
        std::min<std::uint64_t>(std::max<std::uint64_t>(level, floor()), kMost));
  }

  /// Adds the offset, saturating at the largest amplitude.
  void raise(std::span<Amplitude> threshold) const noexcept {
    const auto offset = static_cast<Amplitude>(std::min<int>(settings_.threshold_offset, kMost));
    for (Amplitude& level : threshold)
      level = static_cast<Amplitude>(level + std::min<Amplitude>(offset, kMost - level));
  }

  void average(std::span<const Amplitude> amplitude, Amplitude* threshold) noexcept {
    const int cells = static_cast<int>(amplitude.size());
    const int guard = settings_.guard_cells;
    const int reach = guard + settings_.train_cells;
    detail::running_sums(amplitude, sums_.data());
    const int inner_first = std::min(reach, cells);
    const int inner_last = std::max(inner_first, cells - reach);
    for (int i = 0; i < inner_first; ++i) threshold[i] = average_at_edge(i, cells);
    average_inside(inner_first, inner_last, threshold);
    for (int i = inner_last; i < cells; ++i) threshold[i] = average_at_edge(i, cells);
  }

  [[nodiscard]] Amplitude average_at_edge(int i, int cells) const noexcept {
    const int guard = settings_.guard_cells;
    const int reach = guard + settings_.train_cells;
    const int left_first = std::max(i - reach, 0), left_last = std::max(i - guard, 0);
    const int right_first = std::min(i + guard + 1, cells);
    const int right_last = std::min(i + reach + 1, cells);
    const int count = left_last - left_first + right_last - right_first;
    if (count == 0) return kMost;
    const Sum* sums = sums_.data();
    const auto sum =
        static_cast<Sum>(sums[left_last] - sums[left_first] + sums[right_last] - sums[right_first]);
    return limited(std::uint64_t{sum} * weight_[static_cast<std::size_t>(count)] >> kPlaces);
  }

  /// Cells from `reach` on, where all training cells exist.
  void average_inside(int first, int last, Amplitude* threshold) const noexcept {
    if (first >= last) return;
    const int guard = settings_.guard_cells;
    const int reach = guard + settings_.train_cells;
    const std::uint32_t weight = weight_.back();
    if (weight > std::numeric_limits<std::uint16_t>::max()) {
      for (int i = first; i < last; ++i) threshold[i] = average_at_edge(i, last + reach);
      return;
    }
    detail::mean_thresholds<Amplitude, Sum, Product>(
        sums_.data(), settings_.train_cells, reach + guard + 1, static_cast<std::uint16_t>(weight),
        floor(), last - first, threshold + first);
  }

  void order(std::span<const Amplitude> amplitude, Amplitude* threshold) noexcept {
    const int cells = static_cast<int>(amplitude.size());
    const int guard = settings_.guard_cells;
    const int reach = guard + settings_.train_cells;
    const Amplitude* a = amplitude.data();
    std::conditional_t<kNarrow, detail::SlidingHistogram, detail::SortedWindow> window;
    int count = 0;
    const auto enter = [&](int i) noexcept {
      if (i < 0 || i >= cells) return;
      window.insert(a[i]);
      ++count;
    };
    const auto leave = [&](int i) noexcept {
      if (i < 0 || i >= cells) return;
      window.erase(a[i]);
      --count;
    };
    for (int i = guard + 1; i < reach; ++i) enter(i);  // all of cell 0 except the last
    for (int i = 0; i < cells; ++i) {
      enter(i + reach);
      enter(i - guard - 1);
      if (count == 0) {
        threshold[i] = kMost;
      } else {
        const int k = rank_[static_cast<std::size_t>(count)];
        threshold[i] = limited(std::uint64_t{window.kth(k)} * weight_.front() >> kPlaces);
      }
      leave(i + guard + 1);
      leave(i - reach);
    }
  }

  CfarSettings settings_;
  std::vector<Sum> sums_;
  std::vector<std::uint32_t> weight_;  ///< by the number of training cells: factor / count * 2^16
  std::vector<int> rank_;              ///< by the number of training cells
};

}  // namespace wakeline
