// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Storage of the hypotheses of a tree of mode histories.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "wakeline/core/types.hpp"

namespace wakeline {

/// Hypotheses of one mode side by side, up to the number of lanes of a filter. Unused lanes repeat
/// the belief of another and have probability 0.
template <int N, class Lanes>
struct HypothesisRow {
  using Scalar = RealOf<Lanes>;
  static constexpr int kLanes = kLanesOf<Lanes>;
  using Numbers = std::array<Scalar, kLanes>;  ///< one for each hypothesis

  int mode;
  int count;
  std::array<std::uint64_t, kLanes> modes;  ///< the last 16, four bits each, the present one lowest
  alignas(Lanes) Numbers probability;
  alignas(Lanes) Numbers segment_s;  ///< time since it entered its mode
  alignas(Lanes) std::array<Numbers, N> mean;
  alignas(Lanes) std::array<Numbers, N*(N + 1) / 2> covariance;  ///< lower triangle, by columns

  Numbers& of_covariance(int row, int column) noexcept {
    return covariance[static_cast<std::size_t>(row + column * (2 * N - 1 - column) / 2)];
  }
  const Numbers& of_covariance(int row, int column) const noexcept {
    return const_cast<HypothesisRow*>(this)->of_covariance(row, column);
  }

  [[nodiscard]] Lanes mean_lanes(int i) const noexcept {
    return load<Lanes>(mean[static_cast<std::size_t>(i)].data());
  }
  [[nodiscard]] Lanes covariance_lanes(int row, int column) const noexcept {
    return load<Lanes>(of_covariance(row, column).data());
  }

  /// All beliefs, one per lane.
  [[nodiscard, gnu::always_inline]] Gaussian<N, Lanes> beliefs() const noexcept {
    Gaussian<N, Lanes> lanes;
    unroll<N>([&](int i) { lanes.mean[i] = mean_lanes(i); });
    unroll_lower<N>([&](int i, int j) {
      lanes.covariance(i, j) = lanes.covariance(j, i) = covariance_lanes(i, j);
    });
    return lanes;
  }

  [[gnu::always_inline]] void set_beliefs(const Gaussian<N, Lanes>& lanes) noexcept {
    unroll<N>([&](int i) { store(lanes.mean[i], mean[static_cast<std::size_t>(i)].data()); });
    unroll_lower<N>(
        [&](int i, int j) { store(lanes.covariance(i, j), of_covariance(i, j).data()); });
  }

  [[gnu::always_inline]] void copy_beliefs(const HypothesisRow& from) noexcept {
    unroll<N>([&](int i) { store(from.mean_lanes(i), mean[static_cast<std::size_t>(i)].data()); });
    unroll_lower<N>(
        [&](int i, int j) { store(from.covariance_lanes(i, j), of_covariance(i, j).data()); });
  }

  /// The belief of one hypothesis.
  [[nodiscard, gnu::always_inline]] Gaussian<N, Scalar> belief(int k) const noexcept {
    const auto lane = static_cast<std::size_t>(k);
    Gaussian<N, Scalar> one;
    unroll<N>([&](int i) { one.mean[i] = mean[static_cast<std::size_t>(i)][lane]; });
    unroll_lower<N>([&](int i, int j) {
      one.covariance(i, j) = one.covariance(j, i) = of_covariance(i, j)[lane];
    });
    return one;
  }

  /// Sets the belief of lane k; for the first lane also those of all others.
  [[gnu::always_inline]] void set_belief(int k, const Gaussian<N, Scalar>& one) noexcept {
    if (k == 0) {
      unroll<N>(
          [&](int i) { store(Lanes(one.mean[i]), mean[static_cast<std::size_t>(i)].data()); });
      unroll_lower<N>(
          [&](int i, int j) { store(Lanes(one.covariance(i, j)), of_covariance(i, j).data()); });
      return;
    }
    const auto lane = static_cast<std::size_t>(k);
    unroll<N>([&](int i) { mean[static_cast<std::size_t>(i)][lane] = one.mean[i]; });
    unroll_lower<N>([&](int i, int j) { of_covariance(i, j)[lane] = one.covariance(i, j); });
  }

  /// Sets probability and history of lane k.
  void set_past(int k, Scalar its_probability, Scalar in_mode_s, std::uint64_t its_modes) noexcept {
    const auto lane = static_cast<std::size_t>(k);
    probability[lane] = its_probability;
    segment_s[lane] = in_mode_s;
    modes[lane] = its_modes;
  }
  void set_past(int k, const HypothesisRow& from, int of) noexcept {
    const auto lane = static_cast<std::size_t>(of);
    set_past(k, from.probability[lane], from.segment_s[lane], from.modes[lane]);
  }
};

/// At most `Capacity` hypotheses, in separate rows for each mode, one mode after the other. The
/// place of a hypothesis is the number of its lane among those of all rows.
template <int N, class LanesType, int Capacity, int Modes>
class HypothesisRows {
 public:
  using Lanes = LanesType;
  using Scalar = RealOf<Lanes>;
  using Row = HypothesisRow<N, Lanes>;
  static constexpr int kStates = N;
  static constexpr int kLanes = kLanesOf<Lanes>;
  static constexpr auto kCapacity = static_cast<std::size_t>(Capacity);
  static constexpr std::size_t kMostRows =
      kCapacity / kLanes + (kLanes > 1 ? static_cast<std::size_t>(Modes) : 0);

  void clear() noexcept {
    begin_.fill(0);
    end_.fill(0);
    rows_used_ = size_ = 0;
  }

  /// Appends a hypothesis and returns its place. Those of a mode must be appended consecutively.
  int append(int mode) noexcept {
    if (at(end_, mode) == at(begin_, mode) || at(rows_, at(end_, mode) - 1).count == kLanes)
      add_row(mode).count = 0;
    ++size_;
    return (rows_used_ - 1) * kLanes + at(rows_, rows_used_ - 1).count++;
  }
  /// Appends a copy of one hypothesis of a row.
  int append(int mode, const Row& from, int of_lane) noexcept {
    const int place = append(mode);
    row_of(place).set_belief(lane_of(place), from.belief(of_lane));
    row_of(place).set_past(lane_of(place), from, of_lane);
    return place;
  }
  /// Appends the hypotheses of a row without their beliefs.
  Row& append_pasts(const Row& from) noexcept {
    Row& row = add_row(from.mode);
    row.count = from.count;
    row.probability = from.probability;
    row.segment_s = from.segment_s;
    row.modes = from.modes;
    size_ += from.count;
    return row;
  }

  [[nodiscard]] std::span<Row> all() noexcept {
    return {rows_.data(), static_cast<std::size_t>(rows_used_)};
  }
  [[nodiscard]] std::span<const Row> all() const noexcept {
    return {rows_.data(), static_cast<std::size_t>(rows_used_)};
  }

  /// The rows of a mode.
  [[nodiscard]] std::span<const Row> of_mode(int mode) const noexcept {
    return all().subspan(static_cast<std::size_t>(begin(mode)),
                         static_cast<std::size_t>(end(mode) - begin(mode)));
  }
  /// Index of the first row of a mode; `end` is one past its last.
  [[nodiscard]] int begin(int mode) const noexcept { return at(begin_, mode); }
  [[nodiscard]] int end(int mode) const noexcept { return at(end_, mode); }

  /// Number of hypotheses.
  [[nodiscard]] int size() const noexcept { return size_; }

  [[nodiscard]] Row& row_of(int place) noexcept { return at(rows_, row_number(place)); }
  [[nodiscard]] const Row& row_of(int place) const noexcept { return at(rows_, row_number(place)); }
  static int row_number(int place) noexcept { return static_cast<int>(unsigned(place) / kLanes); }
  static int lane_of(int place) noexcept { return static_cast<int>(unsigned(place) % kLanes); }

 private:
  Row& add_row(int mode) noexcept {
    Row& row = at(rows_, rows_used_);
    if (at(end_, mode) == at(begin_, mode)) at(begin_, mode) = rows_used_;
    at(end_, mode) = ++rows_used_;
    row.mode = mode;
    row.modes.fill(0);
    row.probability.fill(Scalar(0));
    row.segment_s.fill(Scalar(0));
    return row;
  }

  template <class Array>
  static auto& at(Array& array, int i) noexcept {
    return array[static_cast<std::size_t>(i)];
  }

  std::array<Row, kMostRows> rows_;
  std::array<int, static_cast<std::size_t>(Modes)> begin_{}, end_{};  ///< rows of each mode
  int rows_used_ = 0;
  int size_ = 0;
};

/// Copies the `most` most probable hypotheses, in their order.
template <class Rows>
void copy_likeliest(const Rows& from, int most, Rows& to) noexcept {
  std::array<int, Rows::kCapacity> places;
  auto end = places.begin();
  for (std::size_t r = 0; r < from.all().size(); ++r)
    for (int k = 0; k < from.all()[r].count; ++k) *end++ = static_cast<int>(r) * Rows::kLanes + k;
  const auto likelier = [&](int a, int b) {
    const auto probability = [&](int place) {
      return from.row_of(place).probability[static_cast<std::size_t>(Rows::lane_of(place))];
    };
    return probability(a) != probability(b) ? probability(a) > probability(b) : a < b;
  };
  const auto cut = places.begin() + std::min<std::ptrdiff_t>(most, end - places.begin());
  std::nth_element(places.begin(), cut, end, likelier);
  std::sort(places.begin(), cut);
  to.clear();
  std::for_each(places.begin(), cut, [&](int place) {
    to.append(from.row_of(place).mode, from.row_of(place), Rows::lane_of(place));
  });
}

}  // namespace wakeline
