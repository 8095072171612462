// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A tree of mode histories over the filter chosen at run time.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "any_filter.hpp"
#include "support/types.hpp"
#include "wakeline/multimodel/mode_history.hpp"

namespace wakeline::python {

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

/// `wakeline::ModeHistory` over one of the filters that know or learn a turn rate: each step
/// dispatches once and then runs the template.
class AnyModeHistory {
 public:
  using Scalar = double;
  using Variant =
      std::variant<ModeHistory<Ekf<CoordinatedTurn>>, ModeHistory<Ukf<CoordinatedTurn>>,
                   ModeHistory<SquareRootUkf<CoordinatedTurn>>,
                   ModeHistory<Ekf<CoordinatedTurnRate>>, ModeHistory<Ukf<CoordinatedTurnRate>>,
                   ModeHistory<SquareRootUkf<CoordinatedTurnRate>>>;

  /// Throws as `ModeHistory` does, and where the filter has no turn rate, or deviations are told of
  /// one that knows its own.
  AnyModeHistory(const HistoryTree& tree, const TurnRateGrid& grid_rad_s,
                 const ModeChain<kRuntimeModes>& chain, const AnyFilter& filter,
                 const std::optional<TurnRateGrid::Rates>& grid_std_rad_s = {});

  /// Throws as `ModeHistory` does, and where the filters are not of one kind that has a turn rate.
  AnyModeHistory(const HistoryTree& tree, const ModeChain<kRuntimeModes>& chain,
                 const std::vector<AnyFilter>& filters);

  void set_initial_mode_probability(const ModeVector<double, kRuntimeModes>& probability) {
    std::visit([&](auto& history) { history.set_initial_mode_probability(probability); },
               *history_);
  }

  Status start(const AnyBelief& belief) noexcept {
    return std::visit(
        [&]<class History>(History& history) {
          if constexpr (History::kStates != 4)
            if (belief.states() == History::kStates)
              return history.start(Gaussian<History::kStates>{belief.mean, belief.covariance});
          return history.start(kinematics_of(belief));
        },
        *history_);
  }

  Status start(const Gaussian<4>& kinematics) noexcept {
    return std::visit([&](auto& history) { return history.start(kinematics); }, *history_);
  }

  template <class... Known>
  Status predict(double dt_s, const Known&... acceleration_mps2) noexcept {
    return std::visit([&](auto& history) { return history.predict(dt_s, acceleration_mps2...); },
                      *history_);
  }

  template <class Sensor>
  Step<Sensor::kMeasurements> update(const Sensor& sensor,
                                     const Vec<double, Sensor::kMeasurements>& z) noexcept {
    return std::visit([&](auto& history) { return history.update(sensor, z); }, *history_);
  }

  template <class Sensor>
  double update(std::span<const Alternative<Sensor>> readings, double none,
                std::span<double> share) noexcept {
    return std::visit(
        [&](auto& history) { return history.template update<Sensor>(readings, none, share); },
        *history_);
  }

  template <class Sensor>
  [[nodiscard]] Evidence<double> evidence(
      const Sensor& sensor, const Vec<double, Sensor::kMeasurements>& z) const noexcept {
    return std::visit([&](const auto& history) { return history.evidence(sensor, z); }, *history_);
  }

  void archive(Archive& fields) {
    std::visit([&](auto& history) { history.archive(fields); }, *history_);
  }

  [[nodiscard]] AnyBelief estimate() const noexcept {
    return std::visit(
        []<class History>(const History& history) {
          const auto belief = history.estimate();
          return AnyBelief{kLayoutOf<typename History::Filter::Motion>, belief.mean,
                           belief.covariance};
        },
        *history_);
  }

  [[nodiscard]] const ModeVector<double, kRuntimeModes>& mode_probability() const noexcept {
    return std::visit(
        [](const auto& history) -> const auto& { return history.mode_probability(); }, *history_);
  }

  [[nodiscard]] const Variant& variant() const noexcept { return *history_; }
  /// None of one over filters that differ in more than their turn rates.
  [[nodiscard]] const std::optional<TurnRateGrid>& grid_rad_s() const noexcept {
    return grid_rad_s_;
  }

  [[nodiscard]] std::size_t hypotheses() const noexcept {
    return std::visit([](const auto& history) { return history.hypotheses().size(); }, *history_);
  }

  [[nodiscard]] bool started() const noexcept {
    return std::visit([](const auto& history) { return history.started(); }, *history_);
  }

  /// True when it takes linear sensors only.
  [[nodiscard]] bool linear() const noexcept { return linear_; }

 private:
  Apart<Variant> history_;
  std::optional<TurnRateGrid> grid_rad_s_;
  bool linear_;
};

/// Adds `ModeHistory`.
void define_mode_history(py::module_& m);

}  // namespace wakeline::python
