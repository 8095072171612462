// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/multimodel/imm.hpp"
#include "wakeline/multimodel/turn_rate_grid.hpp"
#include "wakeline/multimodel/uniform_bank.hpp"

namespace wakeline {

/// An Imm whose models change their turn rates between two scans: what the estimators of paper B
/// share. The grid moves at the beginning of `predict`, once after each update and with the mode
/// probabilities of that; a missed scan does not move it. A step that fails moves nothing. A model
/// whose turn rate is NaN is at rest.
template <class BankType>
class TurnGridImm : public Imm<BankType> {
  using Base = Imm<BankType>;

 public:
  using typename Base::Bank;
  using typename Base::Probability;
  using typename Base::Scalar;
  static constexpr int kModels = Base::kModels;
  using Rates = ModeVector<double, kModels>;

  /// As of `Imm`; the grid is the initial one.
  template <class BeliefType>
  Status start(const BeliefType& belief) noexcept {
    const Rates before = rates_;
    set_rates(initial_rates_);
    const Status status = Base::start(belief);
    if (status == Status::kOk)
      seen_ = false;
    else
      set_rates(before);
    return status;
  }

  /// As of `Imm`.
  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> update(const Sensor& sensor,
                                             const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    const auto step = Base::update(sensor, z);
    if (step) seen_ = true;
    return step;
  }

  /// As of `Imm`; the grid moves after it when there was a reading that may be the target's own.
  template <class Sensor>
  Scalar update(std::span<const Alternative<Sensor, Scalar>> readings, Scalar none,
                std::span<Scalar> share) noexcept {
    const Scalar total = Base::update(readings, none, share);
    if (total > Scalar(0) && !readings.empty()) seen_ = true;
    return total;
  }

  /// Turn rates of the models, rad/s, positive to starboard; NaN for one at rest.
  [[nodiscard]] const Rates& turn_rates_rad_s() const noexcept { return rates_; }

 protected:
  /// Throws `std::invalid_argument` unless there is one filter for each turn rate.
  TurnGridImm(const ModeChain<kModels>& chain, const Bank& bank, const Rates& initial)
      : Base(chain, bank), initial_rates_(initial), rates_(initial) {
    if (initial.size() != bank.size())
      throw std::invalid_argument("this estimator needs " + std::to_string(initial.size()) +
                                  " filters, got " + std::to_string(bank.size()));
    this->bank_.for_each([&](int k, auto& filter, auto&) { set_turn_rate(filter, rates_[k]); });
  }

  /// `move()` where the grid may move, then a step of the Imm; `undo()` where that fails.
  template <class Move, class Undo, class... Known>
  Status move_and_predict(Move&& move, Undo&& undo, Scalar dt_s,
                          const Known&... acceleration_mps2) noexcept {
    if (!seen_ || !this->started_ || check_time_step(dt_s) != Status::kOk)
      return Base::mix_and_move(dt_s, acceleration_mps2...);
    const Rates rates = rates_;
    const Probability probability = this->probability_;
    move();
    const Status status = Base::mix_and_move(dt_s, acceleration_mps2...);
    if (status == Status::kOk) {
      seen_ = false;
    } else {
      undo();
      set_rates(rates);
      this->probability_ = probability;
    }
    return status;
  }

  void set_rates(const Rates& rates) noexcept {
    if constexpr (requires { this->bank_.set_active(0, true); }) {
      for (int k = 0; k < this->bank_.size(); ++k) {
        if (std::isnan(rates[k]) == std::isnan(rates_[k])) continue;
        this->bank_.set_active(k, !std::isnan(rates[k]));
        this->active_changed();
      }
    }
    this->bank_.for_each([&](int k, auto& filter, auto&) {
      if (rates[k] != rates_[k]) set_turn_rate(filter, rates[k]);
    });
    rates_ = rates;
  }

  /// Saves or restores beliefs, mode probabilities and such turn rates.
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
  bool seen_ = false;  ///< there was an update since the grid moved last
};

}  // namespace wakeline
