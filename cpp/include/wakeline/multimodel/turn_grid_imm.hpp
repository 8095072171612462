// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/multimodel/imm.hpp"
#include "wakeline/multimodel/turn_rate_grid.hpp"
#include "wakeline/multimodel/uniform_bank.hpp"

namespace wakeline {

/// An Imm whose models change their turn rates between scans: the common part of the estimators of
/// paper B. The grid moves at the start of `predict`, once after each update and with its mode
/// probabilities; a missed scan does not move it. A step that fails moves nothing. A model with
/// turn rate NaN is inactive.
template <class BankType>
class TurnGridImm : public Imm<BankType> {
  using Base = Imm<BankType>;

 public:
  using typename Base::Bank;
  using typename Base::Probability;
  using typename Base::Scalar;
  static constexpr int kModels = Base::kModels;
  using Rates = ModeVector<TurnRate<Scalar>, kModels>;

  /// As in `Imm`; the grid is reset to the initial one.
  template <class BeliefType>
  StatusOf<Scalar> start(const BeliefType& belief) noexcept {
    const Rates before = rates_;
    set_rates(initial_rates_);
    const StatusOf<Scalar> status = Base::start(belief);
    const auto failed = !ok(status);
    seen_ = seen_ && failed;
    if (any(failed)) [[unlikely]]
      set_rates(failed, before);
    return status;
  }

  /// As in `Imm`.
  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> update(const Sensor& sensor,
                                             const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    const auto step = Base::update(sensor, z);
    seen_ = seen_ || ok(step.status);
    return step;
  }

  /// As in `Imm`; the grid moves afterwards if a reading may be the target's.
  template <class Sensor>
  Scalar update(std::span<const Alternative<Sensor, Scalar>> readings, Scalar none,
                std::span<Scalar> share) noexcept {
    const Scalar total = Base::update(readings, none, share);
    if (!readings.empty()) seen_ = seen_ || total > Scalar(0);
    return total;
  }

  /// Turn rates of the models, rad/s, positive to starboard; NaN for an inactive one.
  [[nodiscard]] const Rates& turn_rates_rad_s() const noexcept { return rates_; }

 protected:
  /// Throws `std::invalid_argument` unless the numbers of filters and turn rates agree.
  TurnGridImm(const ModeChain<kModels>& chain, const Bank& bank,
              const ModeVector<double, kModels>& initial)
      : Base(chain, bank),
        initial_rates_(initial.template cast<TurnRate<Scalar>>()),
        rates_(initial_rates_) {
    if (initial.size() != bank.size())
      reject("this estimator needs " + std::to_string(initial.size()) + " filters, got " +
             std::to_string(bank.size()));
    this->bank_.for_each([&](int k, auto& filter, auto&) { set_turn_rate(filter, rates_[k]); });
  }

  /// `move(lanes)` where the grid may move, then a step of the Imm; `undo(lanes)` where that fails.
  template <class Move, class Undo, class... Known>
  StatusOf<Scalar> move_and_predict(Move&& move, Undo&& undo, Scalar dt_s,
                                    const Known&... acceleration_mps2) noexcept {
    const MaskOf<Scalar> moves = seen_ && ok(check_time_step(dt_s)) && this->started_;
    const Rates rates = rates_;
    const Probability probability = this->probability_;
    if (any(moves)) move(moves);
    const StatusOf<Scalar> status = Base::mix_and_move(dt_s, acceleration_mps2...);
    seen_ = seen_ && !ok(status);
    if (const auto failed = moves && !ok(status); any(failed)) [[unlikely]] {
      undo(failed);
      set_rates(failed, rates);
      for (Eigen::Index k = 0; k < rates.size(); ++k)
        this->probability_[k] = select(failed, probability[k], this->probability_[k]);
    }
    return status;
  }

  void set_rates(const Rates& rates) noexcept {
    using std::isnan;
    if constexpr (requires { this->bank_.set_active(0, true); }) {
      const bool some_rest = any(isnan(rates.sum() + rates_.sum()));
      for (int k = 0; some_rest && k < this->bank_.size(); ++k) {
        const MaskOf<Scalar> rests = isnan(rates[k]), rested = isnan(rates_[k]);
        if (none((rests && !rested) || (rested && !rests))) continue;
        this->bank_.set_active(k, !rests);
        this->active_changed();
      }
    }
    this->bank_.for_each([&](int k, auto& filter, auto&) {
      // An inactive model is activated with its previous rate: comparisons with NaN are false.
      if (any(rates[k] < rates_[k] || rates[k] > rates_[k])) set_turn_rate(filter, rates[k]);
    });
    rates_ = rates;
  }

  /// The same in the given lanes.
  void set_rates(const MaskOf<Scalar>& lanes, const Rates& rates) noexcept {
    Rates next = rates_;
    for (Eigen::Index k = 0; k < rates.size(); ++k) next[k] = select(lanes, rates[k], rates_[k]);
    set_rates(next);
  }

  /// Saves or restores beliefs, mode probabilities and valid turn rates.
  template <class Valid>
  void archive_if(Archive& fields, const Valid& valid) {
    Rates rates = rates_;
    fields(rates);
    fields(seen_);
    if (!valid(rates)) fields.fail();
    if (fields.ok()) set_rates(rates);
    Base::archive(fields);
  }

 private:
  Rates initial_rates_;
  Rates rates_;
  MaskOf<Scalar> seen_ = false;  ///< there was an update since the last move of the grid
};

}  // namespace wakeline
