// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/multimodel/turn_grid_imm.hpp"

namespace wakeline {

/// When the window of a `SwitchingGridImm` moves, by the probabilities mu of its three models and
/// the threshold t.
enum class SwitchRule : std::uint8_t {
  kSymmetric,  ///< left if mu_left > t, right if mu_right > t, else it stays
  kLiteral,    ///< as printed: left if mu_left > t, stays if mu_centre > t, else right
};

/// What happens to the models when the window moves.
enum class SwitchCarry : std::uint8_t {
  kSlot,      ///< each slot keeps its estimate and probability, under its new turn rate
  kIdentity,  ///< each model that stays keeps them; the entering one begins with the combined
              ///< estimate and the probability of the leaving one
};

/// Names of the rules.
constexpr std::array<Word<SwitchRule>, 2> words_of(SwitchRule) noexcept {
  return {{{"symmetric", SwitchRule::kSymmetric}, {"literal", SwitchRule::kLiteral}}};
}
/// Names of what the places keep.
constexpr std::array<Word<SwitchCarry>, 2> words_of(SwitchCarry) noexcept {
  return {{{"slot", SwitchCarry::kSlot}, {"identity", SwitchCarry::kIdentity}}};
}

/// Motion of the window of a `SwitchingGridImm`. With the paper's threshold of 0.7 the window often
/// moves too late; with kSlot it loses the models' information at each move. Source: paper B, step
/// 1.2.
struct SwitchingGrid {
  static constexpr int kLeastRates = 3;

  TurnRateGrid grid_rad_s = TurnRateGrid::evenly(deg(5.0), 2);
  double threshold = 0.5;
  SwitchRule rule = SwitchRule::kSymmetric;
  SwitchCarry carry = SwitchCarry::kIdentity;
  std::optional<int> initial_centre = {};
  double initial_centre_probability = 0.9;

  static constexpr auto fields() noexcept {
    using S = SwitchingGrid;
    return field_table(
        field("grid_rad_s", &S::grid_rad_s, "Turn rates of the whole grid, three or more."),
        field("threshold", &S::threshold, kProbability, "1",
              "Probability t of a side above which the window moves."),
        field("rule", &S::rule,
              "When the window moves; the printed rule drifts to starboard while undecided."),
        field("carry", &S::carry, "What the models take along."),
        field("initial_centre", &S::initial_centre,
              "Index of the centre at a start; when left out, the straightest but the ends."),
        field("initial_centre_probability", &S::initial_centre_probability, kProbability, "1",
              "Probability of the centre at a start."));
  }

  [[nodiscard]] int initial() const noexcept {
    return initial_centre.value_or(
        std::max(1, std::min(grid_rad_s.straightest(), grid_rad_s.size() - 2)));
  }

  /// Direction of the centre: -1, 0 or 1, within the grid.
  template <class Place, class Probability>
  [[nodiscard]] Place direction(Place centre, const Probability& mu) const noexcept {
    const Place first = 1, last = grid_rad_s.size() - 2;
    const auto to_left = mu[0] > threshold;
    const auto to_right = rule == SwitchRule::kSymmetric ? mu[2] > threshold : !(mu[1] > threshold);
    return select(to_left, select(centre > first, Place(-1), Place(0)),
                  select(to_right && centre < last, Place(1), Place(0)));
  }

  /// Throws `std::invalid_argument` when a parameter is invalid.
  void validate() const {
    validate_fields(*this);
    TurnRateGrid::require_count(grid_rad_s.size(), kLeastRates);
    require(initial() >= 1 && initial() <= grid_rad_s.size() - 2, "initial_centre",
            "the index of a turn rate with one on each side", initial());
  }
};

/// Three turn models in a window that follows the target over a fixed grid of turn rates (SGMM).
/// Has the interface of `Imm`. Source: paper B, step 1.2.
template <class BankType>
class SwitchingGridImm : public TurnGridImm<BankType> {
  using Base = TurnGridImm<BankType>;
  using BeliefType = std::decay_t<decltype(std::declval<const BankType&>().empty_estimate())>;

 public:
  using typename Base::Bank;
  using typename Base::Probability;
  using typename Base::Scalar;
  static constexpr int kModels = BankType::kModels;
  /// An index in the grid, or one per lane.
  using Place = std::conditional_t<kLanesOf<Scalar> == 1, int, Scalar>;

  /// Throws `std::invalid_argument` when a parameter is invalid or there are not three filters.
  SwitchingGridImm(const SwitchingGrid& grid, const ModeChain<BankType::kModels>& chain,
                   const BankType& bank)
      : Base(chain, bank, window<double>(validated(grid), grid.initial())),
        grid_(grid),
        centre_(grid.initial()) {
    Probability initial =
        Probability::Constant(bank.size(), Scalar((1.0 - grid.initial_centre_probability) / 2.0));
    initial[1] = Scalar(grid.initial_centre_probability);
    this->set_initial_mode_probability(initial);
  }

  /// With copies of `prototype`, whose turn rate is replaced.
  template <class Filter>
  SwitchingGridImm(const SwitchingGrid& grid, const ModeChain<3>& chain,
                   const Filter& prototype) requires(BeliefFilter<Filter>)
      : SwitchingGridImm(grid, chain, Bank(prototype)) {}

  /// As in `Imm`; the window is reset to the initial one.
  template <class StartType>
  StatusOf<Scalar> start(const StartType& belief) noexcept {
    const StatusOf<Scalar> status = Base::start(belief);
    centre_ = select(ok(status), Place(grid_.initial()), centre_);
    return status;
  }

  /// Moves the window, mixes and predicts.
  StatusOf<Scalar> predict(Scalar dt_s) noexcept { return step(dt_s); }
  /// The same under a known acceleration, [north, east]; see `Control`.
  StatusOf<Scalar> predict(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    return step(dt_s, acceleration_mps2);
  }

  /// Index of the window's centre in the grid.
  [[nodiscard]] Place centre() const noexcept { return centre_; }
  [[nodiscard]] const SwitchingGrid& grid() const noexcept { return grid_; }

  /// Saves or restores beliefs, mode probabilities and the window; fails with different parameters.
  void archive(Archive& fields) {
    fields.rules(grid_.grid_rad_s.size(), grid_.grid_rad_s.rates_rad_s(), grid_.threshold,
                 grid_.rule, grid_.carry, grid_.initial());
    int centre = centre_;
    fields(centre);
    if (centre < 1 || centre > grid_.grid_rad_s.size() - 2) fields.fail();
    if (fields.ok()) centre_ = centre;
    Base::archive_if(fields, [&](const typename Base::Rates& rates) {
      return (rates.array() == window<double>(grid_, centre_).array()).all();
    });
  }

 private:
  /// Turn rates of the window about an index.
  template <class Rate>
  static ModeVector<Rate, kModels> window(const SwitchingGrid& grid, const Place& centre) noexcept {
    ModeVector<Rate, kModels> rates(3);
    for (int k = 0; k < 3; ++k)
      rates[k] = lanes_of<Rate>(
          [&](int lane_of) { return grid.grid_rad_s[int(lane(centre, lane_of)) - 1 + k]; });
    return rates;
  }

  template <class... Known>
  StatusOf<Scalar> step(Scalar dt_s, const Known&... acceleration_mps2) noexcept {
    const Place before = centre_;
    BeliefType left_out;
    const auto move = [&](const MaskOf<Scalar>& lanes) {
      const Place direction = select(lanes, grid_.direction(centre_, this->probability_), Place(0));
      if (none(direction != Place(0))) return;
      if (grid_.carry == SwitchCarry::kIdentity) {
        left_out = shifted(direction, this->estimate());
        const Probability mu = this->probability_;
        for (int k = 0; k < 3; ++k)
          this->probability_[k] = select(direction > Place(0), mu[(k + 1) % 3],
                                         select(direction < Place(0), mu[(k + 2) % 3], mu[k]));
      }
      centre_ += direction;
      this->set_rates(window<TurnRate<Scalar>>(grid_, centre_));
    };
    const auto undo = [&](const MaskOf<Scalar>& lanes) {
      const Place back = select(lanes, before - centre_, Place(0));
      if (none(back != Place(0))) return;
      if (grid_.carry == SwitchCarry::kIdentity) (void)shifted(back, left_out);
      centre_ += back;
    };
    return Base::move_and_predict(move, undo, dt_s, acceleration_mps2...);
  }

  /// Where a direction is not 0, gives each filter the belief of its neighbour in that direction,
  /// and the last one `entering`; returns the belief that was dropped.
  BeliefType shifted(const Place& direction, const BeliefType& entering) noexcept {
    const auto to_left = direction < Place(0);
    const auto to_right = direction > Place(0);
    BeliefType leaving = entering;
    this->bank_.for_each([&](int k, auto& filter, auto& before) {
      before = filter.estimate();
      if (k == 1) return;
      const auto leaves = k == 0 ? to_right : to_left;
      if constexpr (kLanesOf<Scalar> == 1) {
        if (leaves) leaving = before;
      } else {
        assign_where(leaves, leaving, before);
      }
    });
    this->bank_.for_each([&](int k, auto& filter, auto&) {
      if (k != 1) this->assign_in(k == 2 ? to_right : to_left, filter, entering);
      this->bank_.for_each_before([&](int i, const auto& before) {
        if (i - k == 1 || k - i == 1) this->assign_in(i > k ? to_right : to_left, filter, before);
      });
    });
    return leaving;
  }

  SwitchingGrid grid_;
  Place centre_;
};

/// Over three filters of the given kind.
template <class Filter>
SwitchingGridImm(const SwitchingGrid&, const ModeChain<3>&, const Filter&)
    -> SwitchingGridImm<UniformBank<Filter, 3>>;

}  // namespace wakeline
