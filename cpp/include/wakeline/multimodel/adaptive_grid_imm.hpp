// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>

#include "wakeline/core/angle.hpp"
#include "wakeline/multimodel/turn_grid_imm.hpp"

namespace wakeline {

/// How the three turn rates of an `AdaptiveGridImm` move: left, centre and right in `[-max, max]`.
///
/// The printed rule is that of centre_threshold 0.3, centre_gain 1, kept_spacing_rad_s 0 and
/// least_move_rad_s 0. Its grid collapses to half of min_spacing_rad_s to each side, where the
/// rates may differ too little to be told apart, and nothing opens it again. The defaults keep it
/// open and move its centre with patience. Source: paper B, step 1.1; centre_gain,
/// kept_spacing_rad_s and least_move_rad_s are additions.
struct AdaptiveGrid {
  using Rates = std::array<double, 3>;

  double max_turn_rate_rad_s = deg(5.0);
  /// Where they begin, none less than the one before it; not printed. Half the maximum to each side
  /// when left out.
  std::optional<Rates> initial_turn_rates_rad_s = std::nullopt;
  double min_spacing_rad_s = deg(2.0);      ///< r; not printed
  double kept_spacing_rad_s = deg(3.0);     ///< no side comes nearer, but for the maximum
  double least_move_rad_s = deg(0.1);       ///< a grid that would move less stays, which saves time
  double centre_threshold = 0.8;            ///< t1: a centre less probable than this moves
  double centre_gain = 0.3;                 ///< how far towards the mean rate: 1 is all the way
  double unlikely_threshold = 0.25;         ///< t2: a side less probable than this comes nearer
  double likely_threshold = 0.75;           ///< t3: a side more probable than this goes further
  double initial_centre_probability = 0.9;  ///< of the centre at a start; not printed

  [[nodiscard]] Rates initial() const noexcept {
    return initial_turn_rates_rad_s.value_or(
        Rates{-max_turn_rate_rad_s / 2, 0.0, max_turn_rate_rad_s / 2});
  }

  /// The next rates, given the mode probabilities of the last update: vectors of three numbers, or
  /// of three packs.
  template <class Vector>
  [[nodiscard]] Vector moved(const Vector& rates, const Vector& probability) const noexcept {
    using Number = std::decay_t<decltype(rates[0])>;
    using std::abs;
    const Number left = rates[0], centre = rates[1], right = rates[2];
    const Number mu_left = probability[0], mu_centre = probability[1], mu_right = probability[2];
    const Number mean = mu_left * left + mu_centre * centre + mu_right * right;
    const Number next = select(mu_centre < Number(centre_threshold),
                               centre + centre_gain * (mean - centre), centre);
    const auto left_leads = mu_left > mu_centre && mu_left > mu_right;
    const auto right_leads = mu_right > mu_centre && mu_right > mu_left;
    const auto centre_leads = !(left_leads || right_leads);
    const auto spacing = [&](Number now, Number mu, const auto& leads) {
      const Number wide = at_least(now, Number(min_spacing_rad_s));
      const Number opened = select(leads && mu > Number(likely_threshold), 2.0 * wide, wide);
      const Number closed =
          select(centre_leads && mu < Number(unlikely_threshold), wide / 2.0, opened);
      return at_least(closed, Number(kept_spacing_rad_s));
    };
    const auto clipped = [&](Number rate) {
      const Number greatest = max_turn_rate_rad_s;
      return at_least(select(rate < greatest, rate, greatest), -greatest);
    };
    Vector wanted = rates;
    wanted[0] = clipped(next - spacing(centre - left, mu_left, left_leads));
    wanted[1] = clipped(next);
    wanted[2] = clipped(next + spacing(right - centre, mu_right, right_leads));
    const auto is_far = [&](int k) {
      return Number(abs(wanted[k] - rates[k])) >= Number(least_move_rad_s);
    };
    const auto moves = is_far(0) || is_far(1) || is_far(2);
    for (int k = 0; k < 3; ++k) wanted[k] = select(moves, wanted[k], rates[k]);
    return wanted;
  }

  /// Throws `std::invalid_argument` on a parameter that makes no sense.
  void validate() const {
    require_positive("max_turn_rate_rad_s", max_turn_rate_rad_s);
    std::ostringstream within;
    within.precision(kMessageDigits);
    within << "within max_turn_rate_rad_s, " << max_turn_rate_rad_s << " to either side";
    double before = -max_turn_rate_rad_s;
    for (const double rate : initial()) {
      require(std::abs(rate) <= max_turn_rate_rad_s, "every rate of initial_turn_rates_rad_s",
              within.str().c_str(), rate);
      require(rate >= before, "every rate of initial_turn_rates_rad_s",
              "not less than the one before it", rate);
      before = rate;
    }
    require_positive("min_spacing_rad_s", min_spacing_rad_s);
    require_not_negative("kept_spacing_rad_s", kept_spacing_rad_s);
    require_not_negative("least_move_rad_s", least_move_rad_s);
    require_probability("centre_threshold", centre_threshold);
    require_probability("centre_gain", centre_gain);
    require_probability("unlikely_threshold", unlikely_threshold);
    require_probability("likely_threshold", likely_threshold);
    require(unlikely_threshold <= likely_threshold, "unlikely_threshold",
            "at most likely_threshold", unlikely_threshold);
    require_probability("initial_centre_probability", initial_centre_probability);
  }
};

/// Three turn models whose rates move with the target (AGMM): an Imm of three where a fixed grid
/// needs five or more. Slots keep their estimates and probabilities when the grid moves. Has the
/// face of `Imm`. Source: paper B, step 1.1; X. R. Li, V. P. Jilkov, IEEE Trans. AES-41, 2005.
template <class BankType>
class AdaptiveGridImm : public TurnGridImm<BankType> {
  using Base = TurnGridImm<BankType>;

 public:
  using typename Base::Bank;
  using typename Base::Scalar;
  static constexpr int kModels = BankType::kModels;

  /// Throws `std::invalid_argument` when a parameter makes no sense or there are not three filters.
  AdaptiveGridImm(const AdaptiveGrid& grid, const ModeChain<BankType::kModels>& chain,
                  const BankType& bank)
      : Base(chain, bank, to_vector(validated(grid).initial())), grid_(grid) {
    const double side = (1.0 - grid.initial_centre_probability) / 2.0;
    this->set_initial_mode_probability(
        to_vector({side, grid.initial_centre_probability, side}).template cast<Scalar>());
  }

  /// Over filters like `prototype`, whose turn rate does not matter.
  template <class Filter>
  AdaptiveGridImm(const AdaptiveGrid& grid, const ModeChain<3>& chain,
                  const Filter& prototype) requires(BeliefFilter<Filter>)
      : AdaptiveGridImm(grid, chain, Bank(prototype)) {}

  /// Moves the grid, mixes and predicts.
  StatusOf<Scalar> predict(Scalar dt_s) noexcept { return step(dt_s); }
  /// The same under a known acceleration, [north, east]; see `Control`.
  StatusOf<Scalar> predict(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    return step(dt_s, acceleration_mps2);
  }

  [[nodiscard]] const AdaptiveGrid& grid() const noexcept { return grid_; }

  /// Saves or restores beliefs, mode probabilities and turn rates; those of another grid fail.
  void archive(Archive& fields) {
    fields.rules(grid_.max_turn_rate_rad_s, grid_.initial(), grid_.min_spacing_rad_s,
                 grid_.kept_spacing_rad_s, grid_.least_move_rad_s, grid_.centre_threshold,
                 grid_.centre_gain, grid_.unlikely_threshold, grid_.likely_threshold);
    Base::archive_if(fields, [&](const typename Base::Rates& rates) {
      return rates.allFinite() && rates.cwiseAbs().maxCoeff() <= grid_.max_turn_rate_rad_s;
    });
  }

 private:
  static ModeVector<double, kModels> to_vector(const AdaptiveGrid::Rates& rates) noexcept {
    ModeVector<double, kModels> vector(3);
    for (int k = 0; k < 3; ++k) vector[k] = rates[static_cast<std::size_t>(k)];
    return vector;
  }

  template <class... Known>
  StatusOf<Scalar> step(Scalar dt_s, const Known&... acceleration_mps2) noexcept {
    const auto move = [&](const MaskOf<Scalar>& lanes) {
      const typename Base::Rates mu = this->probability_.template cast<TurnRate<Scalar>>();
      this->set_rates(lanes, grid_.moved(this->turn_rates_rad_s(), mu));
    };
    return Base::move_and_predict(
        move, [](const MaskOf<Scalar>&) {}, dt_s, acceleration_mps2...);
  }

  AdaptiveGrid grid_;
};

template <class Filter>
AdaptiveGridImm(const AdaptiveGrid&, const ModeChain<3>&, const Filter&)
    -> AdaptiveGridImm<UniformBank<Filter, 3>>;

}  // namespace wakeline
