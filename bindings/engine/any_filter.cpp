// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "any_filter.hpp"

#include <algorithm>

#include "wakeline/multimodel/turn_rate_grid.hpp"

namespace wakeline::python {
namespace {

constexpr std::array kTurnComponents = CoordinatedTurnRate::kComponents;

/// Where each layout holds the components of each other one: `rows(from, to)[i]`, -1 where it does
/// not.
const int* rows(StateLayout from, StateLayout to) noexcept {
  static constexpr auto k44 = rows_of(kKinematics, kKinematics);
  static constexpr auto k45 = rows_of(kKinematics, kTurnComponents);
  static constexpr auto k46 = rows_of(kKinematics, kAccelerationKinematics);
  static constexpr auto k54 = rows_of(kTurnComponents, kKinematics);
  static constexpr auto k55 = rows_of(kTurnComponents, kTurnComponents);
  static constexpr auto k56 = rows_of(kTurnComponents, kAccelerationKinematics);
  static constexpr auto k64 = rows_of(kAccelerationKinematics, kKinematics);
  static constexpr auto k65 = rows_of(kAccelerationKinematics, kTurnComponents);
  static constexpr auto k66 = rows_of(kAccelerationKinematics, kAccelerationKinematics);
  static constexpr const int* kRows[3][3] = {
      {k44.row, k45.row, k46.row}, {k54.row, k55.row, k56.row}, {k64.row, k65.row, k66.row}};
  return kRows[static_cast<int>(from)][static_cast<int>(to)];
}

template <class Filter>
Gaussian<Filter::kStates> fixed(const AnyBelief& belief) noexcept {
  return {belief.mean, belief.covariance};
}

/// `add_spread` between beliefs of one layout, of N states.
template <int N>
void add_spread_alike(AnyBelief& sum, double weight, const AnyBelief& part) noexcept {
  const double* p = part.covariance.data();
  double* covariance = sum.covariance.data();
  double d[N];
  for (int i = 0; i < N; ++i) d[i] = part.mean[i] - sum.mean[i];
  for (int j = 0; j < N; ++j)
    for (int i = 0; i < N; ++i) covariance[N * j + i] += weight * (p[N * j + i] + d[i] * d[j]);
}

}  // namespace

AnyBelief zero_like(const AnyBelief& belief) noexcept {
  AnyBelief zero = belief;
  zero.mean.setZero();
  zero.covariance.setZero();
  return zero;
}

void add_mean(AnyBelief& sum, double weight, const AnyBelief& part, const AnyBelief& own) noexcept {
  const int* row = rows(part.layout, own.layout);
  for (int i = 0; i < own.states(); ++i)
    sum.mean[i] += weight * (row[i] >= 0 ? part.mean[row[i]] : own.mean[i]);
}

void add_spread(AnyBelief& sum, double weight, const AnyBelief& part,
                const AnyBelief& own) noexcept {
  if (part.layout == own.layout) {
    if (own.layout == StateLayout::kKinematics) return add_spread_alike<4>(sum, weight, part);
    if (own.layout == StateLayout::kTurn) return add_spread_alike<5>(sum, weight, part);
    return add_spread_alike<6>(sum, weight, part);
  }
  const int* row = rows(part.layout, own.layout);
  double d[kMaxStates];
  for (int i = 0; i < own.states(); ++i)
    d[i] = (row[i] >= 0 ? part.mean[row[i]] : own.mean[i]) - sum.mean[i];
  for (int j = 0; j < own.states(); ++j)
    for (int i = 0; i < own.states(); ++i) {
      const double p = row[i] >= 0 && row[j] >= 0 ? part.covariance(row[i], row[j])
                       : row[i] < 0 && row[j] < 0 ? own.covariance(i, j)
                                                  : 0.0;
      sum.covariance(i, j) += weight * (p + d[i] * d[j]);
    }
}

Status AnyFilter::start(const AnyBelief& belief) noexcept {
  return std::visit(
      [&]<class Filter>(Filter& filter) {
        if (belief.layout == kLayoutOf<typename Filter::Motion>)
          return filter.start(fixed<Filter>(belief));
        if constexpr (Filter::kStates != 4)
          if (belief.layout == StateLayout::kKinematics)
            return filter.start(Gaussian<4>{belief.mean, belief.covariance});
        return Status::kNotStarted;
      },
      filter_);
}

Gaussian<4> kinematics_of(const AnyBelief& belief) noexcept {
  const int* row = rows(belief.layout, StateLayout::kKinematics);
  Gaussian<4> kinematics;
  for (int i = 0; i < 4; ++i) {
    kinematics.mean[i] = belief.mean[row[i]];
    for (int j = 0; j < 4; ++j) kinematics.covariance(i, j) = belief.covariance(row[i], row[j]);
  }
  return kinematics;
}

Status AnyFilter::start(const Gaussian<4>& kinematics) noexcept {
  return std::visit([&](auto& filter) { return filter.start(kinematics); }, filter_);
}

void AnyFilter::archive(Archive& fields) {
  std::visit([&](auto& filter) { filter.archive(fields); }, filter_);
}

Status AnyFilter::assign(const AnyBelief& belief) noexcept {
  return std::visit(
      [&]<class Filter>(Filter& filter) { return filter.assign(fixed<Filter>(belief)); }, filter_);
}

Status AnyFilter::predict(double dt_s) noexcept {
  return std::visit([&](auto& filter) { return filter.predict(dt_s); }, filter_);
}

Status AnyFilter::predict(double dt_s, const Vec<double, 2>& acceleration_mps2) noexcept {
  return std::visit([&](auto& filter) { return filter.predict(dt_s, acceleration_mps2); }, filter_);
}

bool AnyFilter::turns() const noexcept {
  return std::visit(
      [](const auto& filter) {
        return requires { filter.motion().turn_rate_rad_s; };
      },
      filter_);
}

void AnyFilter::set_turn_rate(double turn_rate_rad_s) noexcept {
  std::visit(
      [&](auto& filter) {
        if constexpr (requires { filter.motion().turn_rate_rad_s; })
          wakeline::set_turn_rate(filter, turn_rate_rad_s);
      },
      filter_);
}

AnyBelief AnyFilter::estimate() const noexcept {
  return std::visit(
      [](const auto& filter) {
        const auto belief = filter.estimate();
        AnyBelief result;
        result.layout = kLayoutOf<typename std::decay_t<decltype(filter)>::Motion>;
        result.mean = belief.mean;
        result.covariance = belief.covariance;
        return result;
      },
      filter_);
}

bool AnyFilter::started() const noexcept {
  return std::visit([](const auto& filter) { return filter.started(); }, filter_);
}

StateLayout AnyFilter::layout() const noexcept {
  return std::visit([]<class Filter>(const Filter&) { return kLayoutOf<typename Filter::Motion>; },
                    filter_);
}

AnyFilterBank::AnyFilterBank(const std::vector<AnyFilter>& filters) {
  if (filters.empty() || filters.size() > kMaxModes)
    throw std::invalid_argument("filters must be 1 to " + std::to_string(kMaxModes) +
                                " filters, got " + std::to_string(filters.size()));
  for (const AnyFilter& filter : filters) slots_.push_back({filter, filter.estimate(), true});
  const StateLayout first = filters.front().layout();
  const bool same = std::all_of(filters.begin(), filters.end(),
                                [&](const AnyFilter& filter) { return filter.layout() == first; });
  if (same) empty_ = filters.front().estimate();
  empty_ = zero_like(empty_);
}

}  // namespace wakeline::python
