// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include "wakeline/core/angle.hpp"
#include "wakeline/multimodel/turn_grid_imm.hpp"

namespace wakeline {

/// Which models of a `LikelyModelSetImm` are active. Source: the model-set rules of X. R. Li, Y.
/// Zhang, "Multiple-model estimation with variable structure, part V", IEEE Trans. AES-36, 2000.
struct LikelyModelSet {
  using Rates = TurnRateGrid::Rates;

  TurnRateGrid grid_rad_s = TurnRateGrid::evenly(deg(4.0), 2);  ///< of all models
  double unlikely_threshold = 0.03;  ///< a model less probable than this leaves
  double likely_threshold = 0.1;     ///< one at least as probable has its neighbours join it
  double initial_straight_probability = 0.9;  ///< at a start, of the straightest model

  /// The rates of the models to be active, NaN for those at rest, from the rates and mode
  /// probabilities of the last update. The most probable model always has its neighbours with it.
  template <class Probability>
  [[nodiscard]] Rates chosen(const Rates& rates, const Probability& mu) const noexcept {
    Eigen::Index best = 0;
    for (Eigen::Index k = 1; k < rates.size(); ++k)
      if (mu[k] > mu[best]) best = k;
    const auto is_active = [&](Eigen::Index k) { return !std::isnan(rates[k]); };
    const auto is_principal = [&](Eigen::Index k) {
      return k >= 0 && k < rates.size() && is_active(k) &&
             (k == best || !(double(mu[k]) < likely_threshold));
    };
    Rates next = grid_rad_s.rates_rad_s();
    for (Eigen::Index k = 0; k < rates.size(); ++k)
      if (!(is_active(k) && !(double(mu[k]) < unlikely_threshold)) && !is_principal(k) &&
          !is_principal(k - 1) && !is_principal(k + 1))
        next[k] = std::numeric_limits<double>::quiet_NaN();
    return next;
  }

  /// Throws `std::invalid_argument` on a parameter that makes no sense.
  void validate() const {
    require_probability("unlikely_threshold", unlikely_threshold);
    require_probability("likely_threshold", likely_threshold);
    require(unlikely_threshold <= likely_threshold, "unlikely_threshold",
            "at most likely_threshold", unlikely_threshold);
    require_probability("initial_straight_probability", initial_straight_probability);
  }
};

/// Turn models that join and leave by their probability: an Imm over the part of a grid of turn
/// rates that is likely. All are active at a start. A model that joins begins with what the chain
/// brings it from the others; the chain leaves a model as often as with all of them, but to the
/// active ones only. Has the face of `Imm`; a model at rest has probability 0.
template <class BankType>
class LikelyModelSetImm : public TurnGridImm<BankType> {
  using Base = TurnGridImm<BankType>;

 public:
  using typename Base::Bank;
  using typename Base::Probability;
  using typename Base::Rates;
  using typename Base::Scalar;
  static constexpr int kModels = BankType::kModels;

  /// Throws `std::invalid_argument` when a parameter makes no sense or there is not one filter for
  /// each turn rate.
  LikelyModelSetImm(const LikelyModelSet& set, const ModeChain<BankType::kModels>& chain,
                    const BankType& bank)
      : Base(chain, bank, validated(set).grid_rad_s.rates_rad_s()), set_(set) {
    const int straight = set.grid_rad_s.straightest();
    this->initial_.setConstant(
        Scalar((1.0 - set.initial_straight_probability) / (bank.size() - 1)));
    this->initial_[straight] = Scalar(set.initial_straight_probability);
  }

  /// Over filters like `prototype`, whose turn rate does not matter.
  template <class Filter>
  LikelyModelSetImm(const LikelyModelSet& set, const ModeChain<kRuntimeModes>& chain,
                    const Filter& prototype) requires(BeliefFilter<Filter>)
      : LikelyModelSetImm(set, chain, Bank(prototype, set.grid_rad_s.size())) {}

  /// Chooses the models, mixes and predicts.
  Status predict(Scalar dt_s) noexcept { return step(dt_s); }
  /// The same under a known acceleration, [north, east]; see `Control`.
  Status predict(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    return step(dt_s, acceleration_mps2);
  }

  [[nodiscard]] const LikelyModelSet& grid() const noexcept { return set_; }

  /// Saves or restores beliefs, mode probabilities and which models are active.
  void archive(Archive& fields) {
    Base::archive_if(fields, [&](const Rates& rates) {
      bool any = false;
      for (Eigen::Index k = 0; k < rates.size(); ++k) {
        if (std::isnan(rates[k])) continue;
        if (rates[k] != set_.grid_rad_s[static_cast<int>(k)]) return false;
        any = true;
      }
      return any;
    });
  }

 private:
  template <class... Known>
  Status step(Scalar dt_s, const Known&... acceleration_mps2) noexcept {
    return Base::move_and_predict([&](bool) { choose(); }, [](bool) {}, dt_s, acceleration_mps2...);
  }

  void choose() noexcept {
    const Rates before = this->turn_rates_rad_s();
    Probability& mu = this->probability_;
    const Rates next = set_.chosen(before, mu);
    const auto joined = this->estimate();
    Scalar total = Scalar(0);
    Scalar left = Scalar(0);
    for (Eigen::Index k = 0; k < next.size(); ++k) (std::isnan(next[k]) ? left : total) += mu[k];
    this->set_rates(next);
    this->bank_.for_each([&](int k, auto& filter, auto&) {
      if (std::isnan(before[k])) (void)filter.assign(joined);
    });
    if (left > Scalar(0))
      for (Eigen::Index k = 0; k < next.size(); ++k)
        mu[k] = std::isnan(next[k]) ? Scalar(0) : mu[k] / total;
  }

  LikelyModelSet set_;
};

template <class Filter>
LikelyModelSetImm(const LikelyModelSet&, const ModeChain<kRuntimeModes>&, const Filter&)
    -> LikelyModelSetImm<UniformBank<Filter>>;

}  // namespace wakeline
