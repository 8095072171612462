// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <utility>

#include "wakeline/catalog/motions.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// A belief whose layout is known at run time, without heap.
struct AnyBelief {
  using Mean = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kStateRoom, 1>;
  using Covariance =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kStateRoom, kStateRoom>;

  StateLayout layout = StateLayout::kKinematics;
  Mean mean = Vec<double, 4>::Zero();
  Covariance covariance = Mat<double, 4, 4>::Identity();

  [[nodiscard]] int states() const noexcept { return static_cast<int>(mean.size()); }

  /// As one of a size known at compile time.
  template <int N>
  [[nodiscard]] Gaussian<N> fixed() const noexcept {
    return {mean, covariance};
  }
};

/// A belief over the state of a motion model.
template <class Motion>
AnyBelief any_belief(const Gaussian<kStatesOf<Motion>>& belief) noexcept {
  return {kLayoutOf<Motion>, belief.mean, belief.covariance};
}

/// Rows of a layout in another one: `rows(from, to)[i]` is where `from` holds row i of `to`, or -1.
/// Of a layout made at run time they are valid until the next call in this thread.
inline const auto& rows_between(StateLayout from, StateLayout to) noexcept {
  using RowsOf = std::array<int, static_cast<std::size_t>(kMaxStates)>;
  constexpr auto kLayouts = static_cast<std::size_t>(kStateLayouts.count);
  constexpr auto rows_in = [](const StateRows& from_rows, const StateRows& to_rows) {
    RowsOf rows{};
    for (int i = 0; i < to_rows.states; ++i) {
      const auto k = static_cast<std::size_t>(i);
      rows[k] = from_rows.row_of(to_rows.components[k]);
    }
    return rows;
  };
  static constexpr auto kRows = [rows_in] {
    std::array<std::array<RowsOf, kLayouts>, kLayouts> rows{};
    for (std::size_t a = 0; a < kLayouts; ++a)
      for (std::size_t b = 0; b < kLayouts; ++b)
        rows[a][b] = rows_in(kStateLayouts.rows[a], kStateLayouts.rows[b]);
    return rows;
  }();
  const auto search = [&]() __attribute__((cold, noinline))->const RowsOf& {
    static thread_local RowsOf rows;
    rows = rows_in(rows_of(from), rows_of(to));
    return rows;
  };
  if (is_of_catalog(from) && is_of_catalog(to)) [[likely]]
    return kRows[static_cast<std::size_t>(from)][static_cast<std::size_t>(to)];
  return search();
}

/// True where a state holds position and velocity.
inline bool has_kinematics(StateLayout layout) noexcept {
  const auto& row = rows_between(layout, StateLayout::kKinematics);
  return std::none_of(row.begin(), row.begin() + 4, [](int from) { return from < 0; });
}

/// A belief with independent states, N(0, 1), to fill up `kMaxStates`: what is computed of it is
/// that of the belief, whatever its size.
inline Gaussian<kMaxStates> filled_up(const AnyBelief& belief) noexcept {
  Gaussian<kMaxStates> filled;
  for (int j = 0; j < belief.states(); ++j) {
    filled.mean[j] = belief.mean[j];
    for (int i = 0; i < belief.states(); ++i) filled.covariance(i, j) = belief.covariance(i, j);
  }
  return filled;
}

/// The reverse.
inline AnyBelief cut_to(StateLayout layout, const Gaussian<kMaxStates>& filled) noexcept {
  const int states = states_of(layout);
  AnyBelief belief{layout, AnyBelief::Mean(states), AnyBelief::Covariance(states, states)};
  for (int j = 0; j < states; ++j) {
    belief.mean[j] = filled.mean[j];
    for (int i = 0; i < states; ++i) belief.covariance(i, j) = filled.covariance(i, j);
  }
  return belief;
}

// What mixing asks of a belief; see `StateBelief`.

/// Keeps a belief as it is: `AnyBelief` has no triangle to leave out.
inline void keep_lower(const AnyBelief& belief, AnyBelief& kept) noexcept { kept = belief; }
/// Nothing is missing in an `AnyBelief`.
inline void complete(AnyBelief&) noexcept {}

/// A belief of the same layout with mean and covariance of zero.
inline AnyBelief zero_like(const AnyBelief& belief) noexcept {
  AnyBelief zero = belief;
  zero.mean.setZero();
  zero.covariance.setZero();
  return zero;
}

/// Adds the weighted mean of a part; components that it lacks are those of `own`.
inline void add_mean(AnyBelief& sum, double weight, const AnyBelief& part,
                     const AnyBelief& own) noexcept {
  const auto& row = rows_between(part.layout, own.layout);
  for (int i = 0; i < own.states(); ++i) {
    const int from = row[static_cast<std::size_t>(i)];
    sum.mean[i] += weight * (from >= 0 ? part.mean[from] : own.mean[i]);
  }
}

/// `add_spread` between beliefs of one layout, of N states.
template <int N>
void add_spread_within(AnyBelief& sum, double weight, const AnyBelief& part) noexcept {
  const double* p = part.covariance.data();
  double* covariance = sum.covariance.data();
  double d[N];
  for (int i = 0; i < N; ++i) d[i] = part.mean[i] - sum.mean[i];
  for (int j = 0; j < N; ++j)
    for (int i = 0; i < N; ++i) covariance[N * j + i] += weight * (p[N * j + i] + d[i] * d[j]);
}

/// Adds the weighted covariance of a part and the spread of its mean about that of the sum.
inline void add_spread(AnyBelief& sum, double weight, const AnyBelief& part,
                       const AnyBelief& own) noexcept {
  if (part.layout == own.layout) {
    [&]<int... Less>(std::integer_sequence<int, Less...>) {
      (void)((own.states() == Less + 1 && (add_spread_within<Less + 1>(sum, weight, part), true)) ||
             ...);
    }
    (std::make_integer_sequence<int, kMaxStates>{});
    return;
  }
  const auto& row = rows_between(part.layout, own.layout);
  const auto from = [&](int i) { return row[static_cast<std::size_t>(i)]; };
  double d[kMaxStates];
  for (int i = 0; i < own.states(); ++i)
    d[i] = (from(i) >= 0 ? part.mean[from(i)] : own.mean[i]) - sum.mean[i];
  for (int j = 0; j < own.states(); ++j)
    for (int i = 0; i < own.states(); ++i) {
      const double p = from(i) >= 0 && from(j) >= 0 ? part.covariance(from(i), from(j))
                       : from(i) < 0 && from(j) < 0 ? own.covariance(i, j)
                                                    : 0.0;
      sum.covariance(i, j) += weight * (p + d[i] * d[j]);
    }
}

/// The part of a belief that is about position and velocity.
inline Gaussian<4> kinematics_of(const AnyBelief& belief) noexcept {
  const auto& row = rows_between(belief.layout, StateLayout::kKinematics);
  const auto from = [&](int i) { return row[static_cast<std::size_t>(i)]; };
  Gaussian<4> kinematics;
  for (int i = 0; i < 4; ++i) {
    kinematics.mean[i] = belief.mean[from(i)];
    for (int j = 0; j < 4; ++j) kinematics.covariance(i, j) = belief.covariance(from(i), from(j));
  }
  return kinematics;
}

}  // namespace wakeline
