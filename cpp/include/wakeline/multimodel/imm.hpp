// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "wakeline/core/in_place_array.hpp"
#include "wakeline/filter/belief.hpp"
#include "wakeline/multimodel/mixture.hpp"
#include "wakeline/multimodel/mode_chain.hpp"
#include "wakeline/simd/flatten.hpp"
#include "wakeline/simd/scalar.hpp"

namespace wakeline {

/// The interacting multiple model estimator (IMM), over filters of any kinds and state sizes.
///
/// `predict` mixes and predicts; the mode probabilities are then those predicted by the chain. A
/// missed scan is a `predict` without `update`. `update` weights each mode by its likelihood, in
/// the log domain. A component that only some filters have (the turn rate, which a straight model
/// lacks) is mixed only among those that have it. A filter whose update fails keeps its prediction
/// and has no weight in that scan; where all fail, nothing changes. A reading that is not
/// `in_range` returns `kNotFinite`. Source: H. A. P. Blom, Y. Bar-Shalom, IEEE Trans. AC-33, 1988;
/// Bar-Shalom, Li, Kirubarajan, 11.6.6; paper A, (7)-(16).
template <class BankType>
class Imm {
 public:
  using Bank = BankType;
  using Scalar = typename Bank::Scalar;
  static constexpr int kModels = Bank::kModels;
  using Probability = ModeVector<Scalar, kModels>;

  /// Throws `std::invalid_argument` unless there is one mode of the chain for each filter.
  template <class... Filters>
  requires(kModels != kRuntimeModes) explicit Imm(const ModeChain<kModels>& chain,
                                                  const Filters&... filters)
      : Imm(chain, Bank(filters...)) {}

  Imm(const ModeChain<kModels>& chain, const std::type_identity_t<Bank>& bank)
      : bank_(bank),
        initial_(Probability::Constant(bank.size(), Scalar(1) / Scalar(bank.size()))),
        probability_(initial_),
        chain_(chain),
        jumps_(chain),
        weight_(ModeMatrix<Scalar, kModels>::Zero(bank.size(), bank.size())),
        transition_(weight_) {
    if (chain.modes() != bank.size())
      reject("chain must have " + std::to_string(bank.size()) + " modes, one for each model, got " +
             std::to_string(chain.modes()));
  }

  /// Sets the mode probabilities at a start (default: uniform). Throws unless they sum to 1.
  void set_initial_mode_probability(const Probability& probability) {
    require_distribution("initial_mode_probability", probability, bank_.size());
    initial_ = made_distribution(probability);
    if (!started_) probability_ = initial_;
  }

  /// Starts every filter with the belief, over its own state or over `[x, vx, y, vy]`. Where one
  /// rejects it, nothing changes.
  template <class BeliefType>  // not inlined: GCC 12 fails on what its branches leave of a mask
  [[gnu::noinline]] StatusOf<Scalar> start(const BeliefType& belief) noexcept {
    StatusOf<Scalar> status = Status::kOk;
    bank_.for_each([&](int, auto& filter, auto& before) {
      before = filter.estimate();
      status = first_failure(status, filter.start(belief));
    });
    if (started_ && !all(ok(status))) restore(!ok(status));
    if (none(ok(status))) return status;
    started_ = true;
    for (int mode = 0; mode < bank_.size(); ++mode)
      probability_[mode] = select(ok(status), initial_[mode], probability_[mode]);
    return status;
  }

  /// Mixing and prediction: equations (7)-(11) of paper A.
  StatusOf<Scalar> predict(Scalar dt_s) noexcept { return mix_and_move(dt_s); }

  /// The same under a known acceleration, [north, east]; see `Control`.
  StatusOf<Scalar> predict(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    return mix_and_move(dt_s, acceleration_mps2);
  }

  /// Filtering and mode probabilities: equations (12)-(14) of paper A. The innovation of the step
  /// is that of the moment-matched prediction, its log-likelihood that of the mixture.
  template <class Sensor>
  WAKELINE_FLATTEN Step<Sensor::kMeasurements, Scalar> update(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    constexpr int kM = Sensor::kMeasurements;
    if (!started_) return failed_step<kM, Scalar>(Status::kNotStarted);
    Gaussian<kM, Scalar> reading = sensor.observe(z);
    reject_out_of_range(reading.mean);
    InPlaceArray<Correction<kM, Scalar>, static_cast<std::size_t>(kModeCapacity<kModels>)> each;
    if constexpr (kMayRest)
      for (int mode = 0; mode < bank_.size(); ++mode)
        if (none(bank_.active(mode))) ::new (each.place(mode)) Correction<kM, Scalar>();
    bank_.for_each([&](int mode, auto& filter, auto&) {
      ::new (each.place(mode)) Correction<kM, Scalar>(
          with_model(sensor, [&](const auto& model) { return filter.correct(model, reading); }));
    });

    const auto count = static_cast<std::size_t>(bank_.size());
    const std::span<const Correction<kM, Scalar>> parts = each.first(count);
    const std::span<Scalar> weights(probability_.data(), count);
    Step<kM, Scalar> step = mixed_step<kM, Scalar>(parts, weights);
    step.log_likelihood = reweigh<kModeCapacity<kModels>, Scalar>(
        weights, [&](std::size_t mode) { return parts[mode].likelihood(); });
    const auto impossible = step.log_likelihood == Scalar(kImpossible<Scalar>);
    if (any(impossible)) [[unlikely]]
      step = failed_where(impossible, failure_of(parts), step);
    return step;
  }

  /// Calls `f(mode, belief)` for each mode in use.
  template <class Function>
  void for_each_mode(const Function& function) const noexcept {
    bank_.for_each_belief(function);
  }

  /// Probabilistic data association: every mode is updated with all readings that may be the
  /// target's, weighted by their likelihoods under the mode, and with the hypothesis that none is.
  ///
  /// `none` and each `weight` are the weights of the hypotheses before their likelihoods (e.g. 1 -
  /// PD PG and PD / clutter density). Returns the sum of weight times likelihood over modes and
  /// hypotheses, and writes the contribution of each reading to `share`; returns 0 and changes
  /// nothing when all are impossible. Source: Bar-Shalom, Li, Multitarget-Multisensor Tracking,
  /// 1995, 4.5 (IMM-PDA).
  template <class Sensor>
  Scalar update(std::span<const Alternative<Sensor, Scalar>> readings, Scalar none,
                std::span<Scalar> share) noexcept {
    for (Scalar& part : share) part = Scalar(0);
    if (!started_) return Scalar(0);
    Probability posterior = Probability::Zero(bank_.size());
    bank_.for_each([&](int mode, auto& filter, auto& before) {
      before = filter.estimate();
      posterior[mode] =
          probability_[mode] * absorb(filter, before, readings, none, probability_[mode], share);
    });
    Scalar total = Scalar(0);
    for (int mode = 0; mode < bank_.size(); ++mode) total += posterior[mode];
    using std::isfinite;
    const auto possible = total > Scalar(0) && isfinite(total);
    if (!all(possible)) [[unlikely]]
      restore(!possible);
    const auto of_total = [&](Scalar part, Scalar otherwise) {
      return select(possible, part / total, otherwise);
    };
    for (int mode = 0; mode < bank_.size(); ++mode)
      probability_[mode] = of_total(posterior[mode], probability_[mode]);
    for (Scalar& part : share) part = of_total(part, Scalar(0));
    return select(possible, total, Scalar(0));
  }

  /// Starts with these mode probabilities, each filter as `assign_filter(Index<mode>, filter)`
  /// leaves it.
  template <class Assign>
  void assign(const Probability& probability, const Assign& assign_filter) noexcept {
    probability_ = probability;
    started_ = true;
    unroll<kModels>([&](auto mode) { assign_filter(mode, bank_.template get<mode.value>()); });
  }

  /// Copies the states of scalar estimators over the same models, all started, into the lanes: lane
  /// k from `of_lane(k)`.
  template <class OfLane>
  [[gnu::always_inline]] void gather(const OfLane& of_lane) noexcept {
    gather_lanes<kModels>([&](int k) { return of_lane(k).probability_.data(); },
                          probability_.data());
    unroll<kModels>([&](auto mode) {
      gather_lanes(
          [&](int k) -> const auto& {
            return of_lane(k).bank_.template get<mode.value>().estimate();
          },
          bank_.template get<mode.value>().to_assign());
    });
    started_ = true;
  }

  /// `gather` reversed, for the first `count` lanes.
  template <class OfLane>
  [[gnu::always_inline]] void scatter(int count, const OfLane& of_lane) const noexcept {
    scatter_lanes<kModels>(probability_.data(), count,
                           [&](int k) { return of_lane(k).probability_.data(); });
    unroll<kModels>([&](auto mode) {
      const auto& belief = bank_.template get<mode.value>().estimate();
      using Lane = decltype(of_lane(0).bank_.template get<mode.value>().to_assign());
      std::array<std::remove_reference_t<Lane>*, kLanesOf<Scalar>> each{};
      for (int k = 0; k < count; ++k)
        each[std::size_t(k)] = &of_lane(k).bank_.template get<mode.value>().to_assign();
      scatter_lanes(
          belief, count, [&](int k) -> auto& { return *each[std::size_t(k)]; });
    });
  }

  /// Saves or restores beliefs and mode probabilities.
  void archive(Archive& fields) {
    fields(probability_);
    fields(started_);
    bank_.for_each([&](int, auto& filter, auto&) { filter.archive(fields); });
  }

  /// The moment-matched estimate, over the state where all filters share one, else over `[x, vx, y,
  /// vy]`: equations (15) and (16) of paper A.
  [[nodiscard]] WAKELINE_FLATTEN auto estimate() const noexcept {
    return moment_matched(bank_, probability_);
  }

  [[nodiscard]] const Probability& mode_probability() const noexcept { return probability_; }
  [[nodiscard]] const Probability& initial_mode_probability() const noexcept { return initial_; }
  [[nodiscard]] const Bank& bank() const noexcept { return bank_; }
  [[nodiscard]] const ModeChain<kModels>& chain() const noexcept { return chain_; }
  [[nodiscard]] bool started() const noexcept { return started_; }

  /// One of the filters with its belief.
  template <int Index>
  [[nodiscard]] const auto& filter() const noexcept {
    return bank_.template get<Index>();
  }

 protected:
  template <class>
  friend class Imm;
  template <class>
  friend class ImmSmoother;

  template <class... Known>
  WAKELINE_FLATTEN StatusOf<Scalar> mix_and_move(Scalar dt_s,
                                                 const Known&... acceleration_mps2) noexcept {
    if (!started_) return Status::kNotStarted;
    StatusOf<Scalar> status = check_time_step(dt_s);
    if (none(ok(status))) return status;
    Probability expected = weigh_transitions(dt_s);
    bank_.for_each([](int, auto& filter, auto& before) { keep_lower(filter.estimate(), before); });
    bank_.for_each([&](int mode, auto& filter, auto& before) {
      const auto start = mixed(mode, before);
      status = first_failure(status,
                             in_use(mode, predict_from(filter, start, dt_s, acceleration_mps2...)));
    });
    for (int mode = 0; mode < bank_.size(); ++mode)
      probability_[mode] = select(ok(status), expected[mode], probability_[mode]);
    if (!all(ok(status))) [[unlikely]]
      restore(!ok(status));
    return status;
  }

  /// Restores every filter to its state before the step, in the given lanes.
  [[gnu::cold, gnu::noinline]] void restore(const MaskOf<Scalar>& lanes) noexcept {
    bank_.for_each([&](int, auto& filter, auto& before) {
      complete(before);
      assign_in(lanes, filter, before);
    });
  }

  /// Replaces the belief of a filter in the given lanes, unchecked.
  template <class Filter, class BeliefType>
  static void assign_in(const MaskOf<Scalar>& lanes, Filter& filter,
                        const BeliefType& belief) noexcept {
    if constexpr (kLanesOf<Scalar> == 1) {
      if (lanes) (void)filter.assign(belief);
    } else {
      filter.assign_in(lanes, belief);
    }
  }

  Bank bank_;
  Probability initial_;
  Probability probability_;
  bool started_ = false;

  /// To be called when models of the bank are activated or deactivated.
  void active_changed() noexcept { transition_step_s_ = Scalar(-1); }

 private:
  static constexpr bool kMayRest = requires(const Bank& bank) { bank.active(0); };

  /// The status of a filter; ignored in lanes where it is inactive.
  StatusOf<Scalar> in_use(int mode, const StatusOf<Scalar>& status) const noexcept {
    if constexpr (kMayRest && kLanesOf<Scalar> != 1)
      return select(bank_.active(mode), status, StatusOf<Scalar>(Status::kOk));
    else
      return status;
  }

  /// Removes inactive modes from the transition: the probability of staying is unchanged, that of
  /// leaving goes to active modes.
  template <class RestingBank>
  void leave_out_resting(const RestingBank& bank) noexcept {
    for (int i = 0; i < bank.size(); ++i) {
      Scalar resting = Scalar(0);
      Scalar leaving = Scalar(0);
      for (int j = 0; j < bank.size(); ++j) {
        const auto rests = !bank.active(j);
        resting += select(rests, transition_(i, j), Scalar(0));
        transition_(i, j) = select(rests, Scalar(0), transition_(i, j));
        if (j != i) leaving += transition_(i, j);
      }
      if (none(resting > Scalar(0))) continue;
      const auto leaves = leaving > Scalar(0);
      transition_(i, i) += select(leaves, Scalar(0), resting);
      const Scalar scale = (leaving + resting) / select(leaves, leaving, Scalar(1));
      for (int j = 0; j < bank.size(); ++j)
        if (j != i)
          transition_(i, j) = select(leaves, transition_(i, j) * scale, transition_(i, j));
    }
  }

  /// The chain's transition over a step, or over the step of each lane.
  [[gnu::noinline]] void read_transition(Scalar dt_s) noexcept {
    if constexpr (kLanesOf<Scalar> == 1)
      transition_ = chain_.transition(double(dt_s)).template cast<Scalar>();
    else
      transition_ = chain_.transition(dt_s, jumps_);
  }

  /// Fills `weight_(i, j) = P(mode i before | mode j now)` and returns P(mode j now).
  Probability weigh_transitions(Scalar dt_s) noexcept {
    if (any(dt_s != transition_step_s_)) [[unlikely]] {
      read_transition(dt_s);
      if constexpr (kMayRest) leave_out_resting(bank_);
      transition_step_s_ = dt_s;
    }
    Probability expected = Probability::Zero(bank_.size());
    for (int j = 0; j < bank_.size(); ++j) {
      for (int i = 0; i < bank_.size(); ++i) {
        weight_(i, j) = transition_(i, j) * probability_[i];
        expected[j] += weight_(i, j);
      }
      const auto reachable = expected[j] > Scalar(kLeastWeight<Scalar>);
      expected[j] = select(reachable, expected[j], Scalar(0));
      const Scalar scale = reciprocal(select(reachable, expected[j], Scalar(1)));
      for (int i = 0; i < bank_.size(); ++i)
        weight_(i, j) = select(reachable, weight_(i, j) * scale, Scalar(i == j));
    }
    return expected;
  }

  /// The mixed initial belief of one mode: the moments of all beliefs weighted by the mode's
  /// origin.
  template <class BeliefType>
  WAKELINE_FLATTEN BeliefType mixed(int mode, const BeliefType& own) const noexcept {
    BeliefType result = zero_like(own);
    bank_.for_each_before(
        [&](int i, const auto& before) { add_mean(result, weight_(i, mode), before, own); });
    bank_.for_each_before(
        [&](int i, const auto& before) { add_spread(result, weight_(i, mode), before, own); });
    return result;
  }

  /// One estimator mostly takes steps of one length; lanes take steps of many.
  struct NoJumps {
    explicit NoJumps(const ModeChain<kModels>&) noexcept {}
  };

  ModeChain<kModels> chain_;
  [[no_unique_address]] std::conditional_t<kLanesOf<Scalar> == 1, NoJumps,
                                           typename ModeChain<kModels>::Jumps>
      jumps_;
  ModeMatrix<Scalar, kModels> weight_;
  ModeMatrix<Scalar, kModels> transition_;
  Scalar transition_step_s_ = Scalar(-1);
};

/// Over the given filters.
template <int K, class... Filters>
Imm(const ModeChain<K>&, const Filters&...) -> Imm<FilterBank<Filters...>>;

/// Over the filters of a bank.
template <int K, class Bank>
requires requires { Bank::kModels; }
Imm(const ModeChain<K>&, const Bank&)->Imm<Bank>;

}  // namespace wakeline
