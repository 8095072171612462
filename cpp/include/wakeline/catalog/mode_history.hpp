// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "wakeline/catalog/belief.hpp"
#include "wakeline/catalog/filters.hpp"
#include "wakeline/catalog/sensors.hpp"
#include "wakeline/catalog/type_list.hpp"
#include "wakeline/multimodel/mode_history.hpp"

namespace wakeline {

/// A large value, kept apart. Copies are copies of the value; to assign one allocates nothing.
template <class Value>
class Apart {
 public:
  explicit Apart(const Value& value) : value_(std::make_unique<Value>(value)) {}
  Apart(const Apart& other) : Apart(*other) {}
  Apart& operator=(const Apart& other) {
    *value_ = *other;
    return *this;
  }
  ~Apart() = default;

  Value& operator*() noexcept { return *value_; }
  const Value& operator*() const noexcept { return *value_; }

 private:
  std::unique_ptr<Value> value_;
};

/// True for a filter that knows its turn rate or learns it from a prior.
template <class Filter>
    struct HasTurnRate : std::bool_constant < requires(const Filter& filter) {
  filter.motion().turn_rate_rad_s;
} || kLearnsTurnRate < Filter >> {};

/// `ModeHistory` over one of some filters that know or learn a turn rate, chosen at run time: each
/// step dispatches once and then runs the template.
template <class FilterList>
class AnyModeHistoryOf {
  template <class Filter>
  using HistoryOf = ModeHistory<Filter>;

 public:
  using Scalar = double;
  using Filter = AnyFilterOf<FilterList>;
  using Chain = ModeChain<kRuntimeModes>;
  using Probability = ModeVector<double, kRuntimeModes>;
  using Variant = AsVariant<Mapped<HistoryOf, Selected<HasTurnRate, FilterList>>>;

  /// Throws as `ModeHistory` does, and where the filter has no turn rate, or deviations are given
  /// for one that knows it.
  AnyModeHistoryOf(const HistoryTree& tree, const TurnRateGrid& grid_rad_s, const Chain& chain,
                   const Filter& filter,
                   const std::optional<TurnRateGrid::Rates>& grid_std_rad_s = {});

  /// Throws as `ModeHistory` does, and where the filters are not of one kind that has a turn rate.
  AnyModeHistoryOf(const HistoryTree& tree, const Chain& chain, const std::vector<Filter>& filters);

  void set_initial_mode_probability(const Probability& probability);
  Status start(const AnyBelief& belief) noexcept;
  Status start(const Gaussian<4>& kinematics) noexcept;
  Status predict(double dt_s) noexcept;
  Status predict(double dt_s, const Vec<double, 2>& acceleration_mps2) noexcept;
  template <int M>
  Step<M> update(const AnySensorOf<M>& sensor, const Vec<double, M>& z) noexcept;
  double update(std::span<const Alternative<Fix>> readings, double none,
                std::span<double> share) noexcept;
  [[nodiscard]] Evidence<double> evidence(const Fix& sensor,
                                          const Vec<double, 2>& z) const noexcept;
  void archive(Archive& fields);

  [[nodiscard]] AnyBelief estimate() const noexcept;
  [[nodiscard]] const Probability& mode_probability() const noexcept;
  [[nodiscard]] std::size_t hypotheses() const noexcept;
  [[nodiscard]] bool started() const noexcept;
  [[nodiscard]] const Variant& variant() const noexcept { return *history_; }
  /// None of one over filters that differ in more than their turn rates.
  [[nodiscard]] const std::optional<TurnRateGrid>& grid_rad_s() const noexcept {
    return grid_rad_s_;
  }
  /// True when it takes linear sensors only.
  [[nodiscard]] bool linear() const noexcept { return linear_; }

 private:
  static Variant over_filter(const HistoryTree& tree, const TurnRateGrid& grid_rad_s,
                             const std::optional<TurnRateGrid::Rates>& grid_std_rad_s,
                             const Chain& chain, const Filter& filter);
  static Variant over_filters(const HistoryTree& tree, const Chain& chain,
                              const std::vector<Filter>& filters);

  Apart<Variant> history_;
  std::optional<TurnRateGrid> grid_rad_s_;
  bool linear_;
};

using AnyModeHistory = AnyModeHistoryOf<Filters>;

// Out of class, to be compiled once
// -----------------------------------------------------------------

template <class FilterList>
auto AnyModeHistoryOf<FilterList>::over_filter(
    const HistoryTree& tree, const TurnRateGrid& grid_rad_s,
    const std::optional<TurnRateGrid::Rates>& grid_std_rad_s, const Chain& chain,
    const Filter& filter) -> Variant {
  return std::visit(
      [&]<class Kind>(const Kind& prototype) -> Variant {
        if constexpr (HasTurnRate<Kind>::value) {
          if (!grid_std_rad_s) return ModeHistory<Kind>(tree, grid_rad_s, chain, prototype);
          if constexpr (kLearnsTurnRate<Kind>)
            return ModeHistory<Kind>(tree, grid_rad_s, *grid_std_rad_s, chain, prototype);
          else
            reject(
                "grid_std_rad_s is for a filter over CoordinatedTurnRate, which learns its turn "
                "rate; this one knows it");
        } else {
          reject(
              "filter must be one over CoordinatedTurn, whose turn rate is known, or over "
              "CoordinatedTurnRate, which learns it");
        }
      },
      filter.variant());
}

template <class FilterList>
auto AnyModeHistoryOf<FilterList>::over_filters(const HistoryTree& tree, const Chain& chain,
                                                const std::vector<Filter>& filters) -> Variant {
  if (filters.empty() || filters.size() > kMaxModes)
    reject("filters must be 1 to " + std::to_string(kMaxModes) + " filters, got " +
           std::to_string(filters.size()));
  return std::visit(
      [&]<class Kind>(const Kind&) -> Variant {
        if constexpr (HasTurnRate<Kind>::value) {
          std::vector<Kind> bank;
          for (std::size_t k = 0; k < filters.size(); ++k) {
            const auto* const filter = std::get_if<Kind>(&filters[k].variant());
            if (filter == nullptr || filters[k].linear() != filters.front().linear())
              reject("filters must be of one kind over one motion model; filter " +
                     std::to_string(k) + " differs from the first");
            bank.push_back(*filter);
          }
          return ModeHistory<Kind>(tree, chain, UniformBank<Kind>(std::span<const Kind>(bank)));
        } else {
          reject("filters must be over CoordinatedTurn or CoordinatedTurnRate");
        }
      },
      filters.front().variant());
}

template <class FilterList>
AnyModeHistoryOf<FilterList>::AnyModeHistoryOf(
    const HistoryTree& tree, const TurnRateGrid& grid_rad_s, const Chain& chain,
    const Filter& filter, const std::optional<TurnRateGrid::Rates>& grid_std_rad_s)
    : history_(over_filter(tree, grid_rad_s, grid_std_rad_s, chain, filter)),
      grid_rad_s_(grid_rad_s),
      linear_(filter.linear()) {}

template <class FilterList>
AnyModeHistoryOf<FilterList>::AnyModeHistoryOf(const HistoryTree& tree, const Chain& chain,
                                               const std::vector<Filter>& filters)
    : history_(over_filters(tree, chain, filters)), linear_(filters.front().linear()) {}

template <class FilterList>
void AnyModeHistoryOf<FilterList>::set_initial_mode_probability(const Probability& probability) {
  std::visit([&](auto& history) { history.set_initial_mode_probability(probability); }, *history_);
}

template <class FilterList>
Status AnyModeHistoryOf<FilterList>::start(const AnyBelief& belief) noexcept {
  return std::visit(
      [&]<class History>(History& history) {
        if constexpr (History::kStates != 4)
          if (belief.states() == History::kStates)
            return history.start(belief.template fixed<History::kStates>());
        return history.start(kinematics_of(belief));
      },
      *history_);
}

template <class FilterList>
Status AnyModeHistoryOf<FilterList>::start(const Gaussian<4>& kinematics) noexcept {
  return std::visit([&](auto& history) { return history.start(kinematics); }, *history_);
}

template <class FilterList>
Status AnyModeHistoryOf<FilterList>::predict(double dt_s) noexcept {
  return std::visit([&](auto& history) { return history.predict(dt_s); }, *history_);
}

template <class FilterList>
Status AnyModeHistoryOf<FilterList>::predict(double dt_s,
                                             const Vec<double, 2>& acceleration_mps2) noexcept {
  return std::visit([&](auto& history) { return history.predict(dt_s, acceleration_mps2); },
                    *history_);
}

template <class FilterList>
template <int M>
Step<M> AnyModeHistoryOf<FilterList>::update(const AnySensorOf<M>& sensor,
                                             const Vec<double, M>& z) noexcept {
  return std::visit([&](auto& history) { return history.update(sensor, z); }, *history_);
}

template <class FilterList>
double AnyModeHistoryOf<FilterList>::update(std::span<const Alternative<Fix>> readings, double none,
                                            std::span<double> share) noexcept {
  return std::visit(
      [&](auto& history) { return history.template update<Fix>(readings, none, share); },
      *history_);
}

template <class FilterList>
Evidence<double> AnyModeHistoryOf<FilterList>::evidence(const Fix& sensor,
                                                        const Vec<double, 2>& z) const noexcept {
  return std::visit([&](const auto& history) { return history.evidence(sensor, z); }, *history_);
}

template <class FilterList>
void AnyModeHistoryOf<FilterList>::archive(Archive& fields) {
  std::visit([&](auto& history) { history.archive(fields); }, *history_);
}

template <class FilterList>
AnyBelief AnyModeHistoryOf<FilterList>::estimate() const noexcept {
  return std::visit(
      []<class History>(const History& history) {
        return any_belief<typename History::Filter::Motion>(history.estimate());
      },
      *history_);
}

template <class FilterList>
auto AnyModeHistoryOf<FilterList>::mode_probability() const noexcept -> const Probability& {
  return std::visit(
      [](const auto& history) -> const auto& { return history.mode_probability(); }, *history_);
}

template <class FilterList>
std::size_t AnyModeHistoryOf<FilterList>::hypotheses() const noexcept {
  return std::visit([](const auto& history) { return history.hypotheses().size(); }, *history_);
}

template <class FilterList>
bool AnyModeHistoryOf<FilterList>::started() const noexcept {
  return std::visit([](const auto& history) { return history.started(); }, *history_);
}

}  // namespace wakeline
