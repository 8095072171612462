// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/multimodel/turn_grid_imm.hpp"

namespace wakeline {

/// The motion of the three turn rates of an `AdaptiveGridImm`: left, centre and right in `[-max,
/// max]`.
///
/// The paper's rule has centre_threshold 0.3, centre_gain 1, kept_spacing_rad_s 0 and
/// least_move_rad_s 0. Its grid can collapse to half of min_spacing_rad_s on each side, where the
/// rates may be too similar to distinguish, and does not open again. The defaults keep it open and
/// move its centre slowly. Source: paper B, step 1.1; centre_gain, kept_spacing_rad_s and
/// least_move_rad_s are additions.
struct AdaptiveGrid {
  using Rates = std::array<double, 3>;

  double max_turn_rate_rad_s = deg(5.0);
  std::optional<Rates> initial_turn_rates_rad_s = std::nullopt;
  double min_spacing_rad_s = deg(2.0);
  double kept_spacing_rad_s = deg(3.0);
  double least_move_rad_s = deg(0.1);
  double centre_threshold = 0.8;
  double centre_gain = 0.3;
  double unlikely_threshold = 0.25;
  double likely_threshold = 0.75;
  double initial_centre_probability = 0.9;

  static constexpr auto fields() noexcept {
    using A = AdaptiveGrid;
    return field_table(
        field("max_turn_rate_rad_s", &A::max_turn_rate_rad_s, kPositive, "rad/s",
              "Greatest turn rate to either side."),
        field("initial_turn_rates_rad_s", &A::initial_turn_rates_rad_s,
              "Turn rates at a start, none less than the one before it; when left out, half the "
              "greatest to each side and 0."),
        field("min_spacing_rad_s", &A::min_spacing_rad_s, kPositive, "rad/s",
              "Spacing r below which a side counts as this far from the centre."),
        field("kept_spacing_rad_s", &A::kept_spacing_rad_s, kNotNegative, "rad/s",
              "Least spacing between a side and the centre, but for the greatest turn rate."),
        field("least_move_rad_s", &A::least_move_rad_s, kNotNegative, "rad/s",
              "A grid that would move less stays."),
        field("centre_threshold", &A::centre_threshold, kProbability, "1",
              "A centre less probable than this, t1, moves."),
        field("centre_gain", &A::centre_gain, kProbability, "1",
              "Share of the way to the mean turn rate that the centre moves."),
        field("unlikely_threshold", &A::unlikely_threshold, kProbability, "1",
              "A side less probable than this, t2, comes nearer."),
        field("likely_threshold", &A::likely_threshold, kProbability, "1",
              "A side more probable than this, t3, moves away."),
        field("initial_centre_probability", &A::initial_centre_probability, kProbability, "1",
              "Probability of the centre at a start."));
  }

  [[nodiscard]] Rates initial() const noexcept {
    return initial_turn_rates_rad_s.value_or(
        Rates{-max_turn_rate_rad_s / 2, 0.0, max_turn_rate_rad_s / 2});
  }

  /// The next rates, given the mode probabilities of the last update; vectors of three numbers or
  /// three packs.
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

  /// Throws `std::invalid_argument` when a parameter is invalid.
  void validate() const {
    validate_fields(*this);
    const std::string within =
        "within max_turn_rate_rad_s, " + number_text(max_turn_rate_rad_s) + " to either side";
    double before = -max_turn_rate_rad_s;
    for (const double rate : initial()) {
      require(std::abs(rate) <= max_turn_rate_rad_s, "every rate of initial_turn_rates_rad_s",
              within.c_str(), rate);
      require(rate >= before, "every rate of initial_turn_rates_rad_s",
              "not less than the one before it", rate);
      before = rate;
    }
    require(unlikely_threshold <= likely_threshold, "unlikely_threshold",
            "at most likely_threshold", unlikely_threshold);
    require_probability("initial_centre_probability", initial_centre_probability);
  }
};

/// Three turn models with rates that follow the target (AGMM): an Imm of three models where a fixed
/// grid needs five or more. The models keep their estimates and probabilities when the grid moves.
/// Has the interface of `Imm`. Source: paper B, step 1.1; X. R. Li, V. P. Jilkov, IEEE Trans.
/// AES-41, 2005.
template <class BankType>
class AdaptiveGridImm : public TurnGridImm<BankType> {
  using Base = TurnGridImm<BankType>;

 public:
  using typename Base::Bank;
  using typename Base::Scalar;
  static constexpr int kModels = BankType::kModels;

  /// Throws `std::invalid_argument` when a parameter is invalid or there are not three filters.
  AdaptiveGridImm(const AdaptiveGrid& grid, const ModeChain<BankType::kModels>& chain,
                  const BankType& bank)
      : Base(chain, bank, to_vector(validated(grid).initial())), grid_(grid) {
    const double side = (1.0 - grid.initial_centre_probability) / 2.0;
    this->set_initial_mode_probability(
        to_vector({side, grid.initial_centre_probability, side}).template cast<Scalar>());
  }

  /// With copies of `prototype`, whose turn rate is replaced.
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

  /// Saves or restores beliefs, mode probabilities and turn rates; fails with different grid
  /// parameters.
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

/// Over three filters of the given kind.
template <class Filter>
AdaptiveGridImm(const AdaptiveGrid&, const ModeChain<3>&, const Filter&)
    -> AdaptiveGridImm<UniformBank<Filter, 3>>;

}  // namespace wakeline
