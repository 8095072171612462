// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>
#include <type_traits>
#include <utility>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/core/in_place_array.hpp"
#include "wakeline/multimodel/turn_grid_imm.hpp"

namespace wakeline {

/// The active models of a `LikelyModelSetImm`. Source: the model-set rules of X. R. Li, Y. Zhang,
/// "Multiple-model estimation with variable structure, part V", IEEE Trans. AES-36, 2000.
struct LikelyModelSet {
  TurnRateGrid grid_rad_s = TurnRateGrid::evenly(deg(4.0), 2);
  double unlikely_threshold = 0.03;
  double likely_threshold = 0.1;
  double initial_straight_probability = 0.9;

  static constexpr auto fields() noexcept {
    using L = LikelyModelSet;
    return field_table(
        field("grid_rad_s", &L::grid_rad_s, "Turn rates of all models."),
        field("unlikely_threshold", &L::unlikely_threshold, kProbability, "1",
              "A model less probable than this leaves."),
        field("likely_threshold", &L::likely_threshold, kProbability, "1",
              "The neighbours of a model at least as probable join it."),
        field("initial_straight_probability", &L::initial_straight_probability, kProbability, "1",
              "Probability of the straightest model at a start."));
  }

  /// The turn rates of the models to be active, NaN for inactive ones, from the rates and mode
  /// probabilities of the last update. The neighbours of the most probable model are always active.
  template <class Rates, class Probability>
  [[nodiscard]] Rates chosen(const Rates& rates, const Probability& mu) const noexcept {
    using Number = std::decay_t<decltype(rates[0])>;
    using std::isnan;
    const Eigen::Index count = rates.size();
    Number greatest = Number(mu[0]);
    for (Eigen::Index k = 1; k < count; ++k) greatest = at_least(Number(mu[k]), greatest);
    std::array<MaskOf<Number>, kMaxModes> active, principal;
    MaskOf<Number> found = false;
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const MaskOf<Number> best = Number(mu[k]) == greatest && !found;
      found = found || best;
      active[i] = !isnan(rates[k]);
      principal[i] = active[i] && (best || !(Number(mu[k]) < Number(likely_threshold)));
    }
    Rates next = rates;
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      MaskOf<Number> stays =
          principal[i] || (active[i] && !(Number(mu[k]) < Number(unlikely_threshold)));
      if (k > 0) stays = stays || principal[i - 1];
      if (k + 1 < count) stays = stays || principal[i + 1];
      next[k] = select(stays, Number(grid_rad_s[static_cast<int>(k)]),
                       Number(std::numeric_limits<double>::quiet_NaN()));
    }
    return next;
  }

  /// Throws `std::invalid_argument` when a parameter is invalid.
  void validate() const {
    validate_fields(*this);
    require(unlikely_threshold <= likely_threshold, "unlikely_threshold",
            "at most likely_threshold", unlikely_threshold);
  }
};

/// Turn models activated and deactivated by their probability: an Imm over the likely part of a
/// grid of turn rates. All are active at a start. A model is activated with the belief mixed by the
/// chain from the others; a model is left as often as in the full chain, but for active models
/// only. Has the interface of `Imm`; an inactive model has probability 0 and keeps its last belief.
template <class BankType>
class LikelyModelSetImm : public TurnGridImm<BankType> {
  using Base = TurnGridImm<BankType>;
  static_assert(
      requires(BankType & bank) { bank.set_active(0, true); },
      "wakeline: a LikelyModelSetImm activates and deactivates its models and needs a bank for "
      "that, "
      "such as a UniformBank with a number of filters given at run time");

 public:
  using typename Base::Bank;
  using typename Base::Probability;
  using typename Base::Rates;
  using typename Base::Scalar;
  static constexpr int kModels = BankType::kModels;

  /// Throws `std::invalid_argument` when a parameter is invalid or the numbers of filters and turn
  /// rates differ.
  LikelyModelSetImm(const LikelyModelSet& set, const ModeChain<BankType::kModels>& chain,
                    const BankType& bank)
      : Base(chain, bank, validated(set).grid_rad_s.rates_rad_s()), set_(set) {
    const int straight = set.grid_rad_s.straightest();
    Probability initial = Probability::Constant(
        bank.size(), Scalar((1.0 - set.initial_straight_probability) / (bank.size() - 1)));
    initial[straight] = Scalar(set.initial_straight_probability);
    this->set_initial_mode_probability(initial);
  }

  /// With copies of `prototype`, whose turn rate is replaced.
  template <class Filter>
  LikelyModelSetImm(const LikelyModelSet& set, const ModeChain<kRuntimeModes>& chain,
                    const Filter& prototype) requires(BeliefFilter<Filter>)
      : LikelyModelSetImm(set, chain, Bank(prototype, set.grid_rad_s.size())) {}

  /// Selects the models, mixes and predicts.
  StatusOf<Scalar> predict(Scalar dt_s) noexcept { return step(dt_s); }
  /// The same under a known acceleration, [north, east]; see `Control`.
  StatusOf<Scalar> predict(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    return step(dt_s, acceleration_mps2);
  }

  [[nodiscard]] const LikelyModelSet& grid() const noexcept { return set_; }

  /// Saves or restores beliefs, including those of inactive models, mode probabilities and the
  /// active set; fails with different parameters.
  void archive(Archive& fields) {
    fields.rules(set_.grid_rad_s.size(), set_.grid_rad_s.rates_rad_s(), set_.unlikely_threshold,
                 set_.likely_threshold);
    Base::archive_if(fields, [&](const Rates& rates) {
      bool any = false;
      for (Eigen::Index k = 0; k < rates.size(); ++k) {
        if (std::isnan(rates[k])) continue;
        if (rates[k] != set_.grid_rad_s[static_cast<int>(k)]) return false;
        any = true;
      }
      return any;
    });
    const Rates& rates = this->turn_rates_rad_s();
    for (int k = 0; k < this->bank_.size(); ++k)
      if (std::isnan(rates[k])) this->bank_.filter(k).archive(fields);
  }

 private:
  using BeliefType = std::decay_t<decltype(std::declval<const BankType&>().empty_estimate())>;

  /// The models before some were activated, and the last beliefs of these.
  struct Before {
    Rates rates;
    InPlaceArray<BeliefType, static_cast<std::size_t>(kModeCapacity<kModels>)> rested;
  };

  template <class... Known>
  StatusOf<Scalar> step(Scalar dt_s, const Known&... acceleration_mps2) noexcept {
    Before before;
    const auto undo = [&](const MaskOf<Scalar>& lanes) {
      for_each_joined(before.rates, [&](int k, auto& filter, const MaskOf<Scalar>& joined) {
        const auto count = static_cast<std::size_t>(k) + 1;
        this->assign_in(lanes && joined, filter, before.rested.first(count).back());
      });
    };
    return Base::move_and_predict([&](const MaskOf<Scalar>& lanes) { choose(lanes, before); }, undo,
                                  dt_s, acceleration_mps2...);
  }

  void choose(const MaskOf<Scalar>& lanes, Before& before) noexcept {
    using std::isnan;
    before.rates = this->turn_rates_rad_s();
    const auto joint = this->estimate();
    this->set_rates(lanes, set_.chosen(before.rates, this->probability_));
    for_each_joined(before.rates, [&](int k, auto& filter, const MaskOf<Scalar>& joined) {
      *::new (before.rested.place(k)) BeliefType = filter.estimate();
      this->assign_in(joined, filter, joint);
    });
    const Rates& now = this->turn_rates_rad_s();
    Probability& mu = this->probability_;
    Scalar total = Scalar(0);
    Scalar left = Scalar(0);
    for (Eigen::Index k = 0; k < now.size(); ++k) {
      total += select(isnan(now[k]), Scalar(0), mu[k]);
      left += select(isnan(now[k]), mu[k], Scalar(0));
    }
    for (Eigen::Index k = 0; k < now.size(); ++k)
      mu[k] = select(left > Scalar(0), select(isnan(now[k]), Scalar(0), mu[k] / total), mu[k]);
  }

  /// Calls `f(k, filter, joined)` for each model that was inactive before and is active now, in the
  /// lanes `joined`.
  template <class Function>
  void for_each_joined(const Rates& before, const Function& function) noexcept {
    using std::isnan;
    const Rates& now = this->turn_rates_rad_s();
    this->bank_.for_each([&](int k, auto& filter, auto&) {
      const MaskOf<Scalar> joined = isnan(before[k]) && !isnan(now[k]);
      if (any(joined)) function(k, filter, joined);
    });
  }

  LikelyModelSet set_;
};

/// Over filters of the given kind, one for each turn rate of the grid.
template <class Filter>
LikelyModelSetImm(const LikelyModelSet&, const ModeChain<kRuntimeModes>&, const Filter&)
    -> LikelyModelSetImm<UniformBank<Filter>>;

}  // namespace wakeline
