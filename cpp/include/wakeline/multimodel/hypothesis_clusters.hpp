// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/multimodel/history_tree.hpp"
#include "wakeline/multimodel/hypothesis_rows.hpp"
#include "wakeline/multimodel/likeliest.hpp"
#include "wakeline/multimodel/mixture.hpp"
#include "wakeline/simd/flatten.hpp"

namespace wakeline {

/// Merges similar hypotheses of each mode by moment matching, around the most probable one that is
/// in no cluster yet. Negligible hypotheses are dropped, but never all. Source: D. J. Salmond, SPIE
/// 1305, 1990.
template <class Rows>
class HypothesisClusters {
 public:
  HypothesisClusters(const Rows& rows, const HistoryTree& limits) noexcept
      : rows_(rows), limits_(limits) {
    const std::span<const Row> all = rows.all();
    Lanes likeliest = Lanes(0);
    for (const Row& row : all) likeliest = at_least(load<Lanes>(row.probability.data()), likeliest);
    const Lanes dropped =
        std::max(std::min(Scalar(limits.negligible_probability), greatest_of_lanes(likeliest) / 2),
                 kLeastWeight<Scalar>);
    for (std::size_t r = 0; r < all.size(); ++r) {
      const Lanes probability = load<Lanes>(all[r].probability.data());
      const auto kept = probability > dropped;
      weights_[r] = select(kept, probability, Lanes(0));
      free_[r] = bits_of(kept);
    }
  }

  /// Appends the clusters of a mode, in the order of their likeliest members.
  WAKELINE_FLATTEN void append_joined(int mode, Rows& to) noexcept {
    const auto begin = static_cast<std::size_t>(rows_.begin(mode));
    const std::span<const Row> rows = rows_.of_mode(mode);
    if (by_distance())
      for (std::size_t r = 0; r < rows.size(); ++r)
        factors_[r].compute(rows[r].beliefs().covariance);
    std::array<int, Rows::kCapacity> places;
    const int candidates = weightiest_first<Lanes>(std::span(weights_).subspan(begin, rows.size()),
                                                   rows_.begin(mode), places);
    for (int k = 0; k < candidates; ++k) {
      const int place = places[static_cast<std::size_t>(k)];
      if ((free_[static_cast<std::size_t>(Rows::row_number(place))] >> Rows::lane_of(place) & 1u) !=
          0)
        append_around(place, to);
    }
  }

 private:
  using Row = typename Rows::Row;
  using Lanes = typename Rows::Lanes;
  using Scalar = RealOf<Lanes>;
  static constexpr int kStates = Rows::kStates;

  [[nodiscard]] bool by_past() const noexcept { return limits_.pseudo_bayes_order > 0; }
  [[nodiscard]] bool by_distance() const noexcept {
    return !by_past() && limits_.sibling_distance > 0.0;
  }

  /// Appends the cluster of the free hypotheses similar to the one at `place`.
  void append_around(int place, Rows& to) noexcept {
    const Row& own = rows_.row_of(place);
    const int next = to.append(own.mode);
    Row& row = to.row_of(next);
    row.set_past(Rows::lane_of(next), own, Rows::lane_of(place));
    if (take_similar(place) > 1)
      join(place, row, Rows::lane_of(next));
    else
      row.set_belief(Rows::lane_of(next), own.belief(Rows::lane_of(place)));
  }

  /// Marks the free hypotheses similar to the one at `place`, and that one, as `taken_`. Returns
  /// their number.
  int take_similar(int place) noexcept {
    const auto own_lane = static_cast<std::size_t>(Rows::lane_of(place));
    const Row& own = rows_.row_of(place);
    const std::span<const Row> rows = rows_.of_mode(own.mode);
    const auto first = static_cast<std::size_t>(rows_.begin(own.mode));
    const auto own_row = static_cast<std::size_t>(Rows::row_number(place)) - first;
    const bool joins = by_distance() && (bits_of(factors_[own_row].ok()) >> own_lane & 1u) != 0;
    int members = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      unsigned& free = free_[first + r];
      unsigned alike = r == own_row ? 1u << own_lane : 0u;
      if (free != alike) {
        if (by_past())
          alike |= free & bits_of(same_past(own.modes[own_lane], rows[r]));
        else if (joins)
          alike |= free & bits_of(nearby(own, own_lane, rows[r], factors_[own_row]));
      }
      taken_[r] = alike;
      free &= ~alike;
      members += std::popcount(alike);
    }
    return members;
  }

  /// Moment matching of the marked hypotheses, by sums about the mean of the one at `place`.
  void join(int place, Row& to, int to_lane) const noexcept {
    const Row& own = rows_.row_of(place);
    const auto own_lane = static_cast<std::size_t>(Rows::lane_of(place));
    const std::span<const Row> rows = rows_.of_mode(own.mode);
    const auto first = static_cast<std::size_t>(rows_.begin(own.mode));
    constexpr int kSums = 1 + kStates + kStates * (kStates + 1) / 2;
    Lanes sums[kSums];
    unroll<kSums>([&](int k) { sums[k] = Lanes(0); });
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (taken_[r] == 0) continue;
      const Lanes weight = select(mask_of_bits<Lanes>(taken_[r]), weights_[first + r], Lanes(0));
      const Vec<Lanes, kStates> d = away(rows[r], own, own_lane);
      sums[0] += weight;
      unroll<kStates>([&](int i) { sums[1 + i] += weight * d[i]; });
      int k = 1 + kStates;
      unroll_lower<kStates>([&](int i, int j) {
        sums[k++] += weight * (rows[r].covariance_lanes(i, j) + d[i] * d[j]);
      });
    }
    alignas(Lanes) std::array<Scalar, kSums + kLanesOf<Lanes> - 1> sum;
    sum_lanes<kSums>(sums, sum.data());
    const Scalar scale = Scalar(1) / sum[0];
    Vec<Scalar, kStates> shift;
    Gaussian<kStates, Scalar> joint;
    unroll<kStates>([&](auto i) {
      constexpr auto k = static_cast<std::size_t>(i.value);
      shift[i] = scale * sum[1 + k];
      joint.mean[i] = own.mean[k][own_lane] + shift[i];
    });
    std::size_t k = 1 + kStates;
    unroll_lower<kStates>(
        [&](int i, int j) { joint.covariance(i, j) = scale * sum[k++] - shift[i] * shift[j]; });
    to.set_belief(to_lane, joint);
    to.probability[static_cast<std::size_t>(to_lane)] = sum[0];
  }

  /// Differences of the means of a row from the mean of a hypothesis of its mode.
  static Vec<Lanes, kStates> away(const Row& row, const Row& own, std::size_t own_lane) noexcept {
    Vec<Lanes, kStates> d;
    unroll<kStates>([&](auto i) {
      d[i] = row.mean_lanes(i) - Lanes(own.mean[static_cast<std::size_t>(i.value)][own_lane]);
    });
    return d;
  }

  /// The lanes of a row with the same last modes, as required in a pseudo-Bayes tree.
  [[nodiscard]] MaskOf<Lanes> same_past(std::uint64_t modes, const Row& row) const noexcept {
    const int forgotten = 64 - 4 * (limits_.pseudo_bayes_order - 1);
    return lanes_of<Lanes>([&](int k) {
             return Scalar((modes ^ row.modes[static_cast<std::size_t>(k)]) << forgotten == 0);
           }) > Lanes(0);
  }

  /// The lanes of a row near a hypothesis of the same mode, by its covariance.
  [[nodiscard]] MaskOf<Lanes> nearby(const Row& own, std::size_t own_lane, const Row& row,
                                     const Cholesky<kStates, Lanes>& factor) const noexcept {
    const auto siblings = load<Lanes>(row.segment_s.data()) == Lanes(own.segment_s[own_lane]);
    return factor.squared_norms(away(row, own, own_lane), static_cast<int>(own_lane)) <
           select(siblings, squared_sibling_distance_, squared_merge_distance_);
  }

  const Rows& rows_;
  const HistoryTree& limits_;
  const Lanes squared_sibling_distance_ =
      Scalar(limits_.sibling_distance) * Scalar(limits_.sibling_distance);
  const Lanes squared_merge_distance_ =
      Scalar(limits_.merge_distance) * Scalar(limits_.merge_distance);
  std::array<Lanes, Rows::kMostRows> weights_;  ///< probability, 0 for dropped ones
  std::array<unsigned, Rows::kMostRows> free_;  ///< in no cluster yet, a bit per lane
  // For the rows of one mode:
  std::array<unsigned, Rows::kMostRows> taken_;  ///< in the current cluster, a bit per lane
  std::array<Cholesky<kStates, Lanes>, Rows::kMostRows> factors_;  ///< of the covariances
};

}  // namespace wakeline
