// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <span>

#include "wakeline/multimodel/imm.hpp"
#include "wakeline/simd/unroll.hpp"

namespace wakeline {

/// An IMM with a group of models that rests while it is unlikely: a variable set of models.
///
/// `AllBank` holds the models of `CoreBank` and, after them, those of the group. While the group
/// rests, what leads to it in the chain leads to the core instead. The probability that it would
/// have is then a share of that of all but the first model, which returns at the rate at which the
/// group is left to its share of what leaves the first model. The group joins when that probability
/// exceeds `kJoining`, with the belief of all but the first model together, and rests again below
/// `kResting`. So it joins when the first model becomes unlikely, and where it then turns out not
/// to fit, not again before a while has passed.
/// Source: X. R. Li, X. Zhi, Y. Zhang, IEEE Trans. AES-35, 1999 (model-group switching).
template <class CoreBank, class AllBank>
class ModelGroupImm {
 public:
  using Core = Imm<CoreBank>;
  using All = Imm<AllBank>;
  using Scalar = double;
  using Probability = typename All::Probability;
  static constexpr int kCore = Core::kModels;
  static constexpr int kModels = All::kModels;
  static constexpr double kJoining = 0.01;   ///< probability above which the group joins,
  static constexpr double kResting = 0.002;  ///< and below which it rests
  static constexpr int kGroup = kModels - kCore;
  static_assert(kGroup > 0);

  /// Throws `std::invalid_argument` unless the chain is in continuous time.
  explicit ModelGroupImm(const All& all) : all_(all), core_(core_of(all)) {
    const auto generator_per_s = all.chain().generator_per_s();
    if (!generator_per_s) reject("chain must be in continuous time for a group of models");
    of_group_ = generator_per_s->row(0).template tail<kGroup>();
    const double joining_per_s = of_group_.sum(), left_per_s = -(*generator_per_s)(0, 0);
    if (joining_per_s > 0.0) of_group_ /= joining_per_s;
    prior_share_ = share_ = left_per_s > 0.0 ? joining_per_s / left_per_s : 0.0;
    leaving_per_s_ =
        of_group_.dot(generator_per_s->template bottomLeftCorner<kGroup, kCore>().rowwise().sum());
  }

  /// Starts without the group. Where a filter rejects the belief, nothing changes.
  template <class BeliefType>
  Status start(const BeliefType& belief) noexcept {
    const Status status = core_.start(belief);
    if (status != Status::kOk) return status;
    joined_ = false;
    share_ = prior_share_;
    return status;
  }

  Status predict(double dt_s) noexcept {
    choose_models(dt_s);
    return visit(*this, [&](auto& imm) { return imm.predict(dt_s); });
  }

  /// `Imm::update`.
  template <class Sensor>
  Step<Sensor::kMeasurements> update(const Sensor& sensor,
                                     const Vec<double, Sensor::kMeasurements>& z) noexcept {
    return visit(*this, [&](auto& imm) { return imm.update(sensor, z); });
  }

  /// The same by several readings.
  template <class Sensor>
  double update(std::span<const Alternative<Sensor>> readings, double none,
                std::span<double> share) noexcept {
    return visit(*this, [&](auto& imm) { return imm.update(readings, none, share); });
  }

  /// Has the group join or rest for a step; part of `predict`.
  void choose_models(double dt_s) noexcept {
    if (check_time_step(dt_s) != Status::kOk) return;
    if (joined_) {
      if (all_.mode_probability().template tail<kGroup>().sum() < kResting) rest();
    } else {
      share_ = prior_share_ + (share_ - prior_share_) * std::exp(-leaving_per_s_ * dt_s);
      if (share_ * (1.0 - core_.mode_probability()[0]) > kJoining) join();
    }
  }

  /// Calls `f(mode, belief)` for each mode in use.
  template <class Function>
  void for_each_mode(const Function& function) const noexcept {
    visit(*this, [&](const auto& imm) { imm.for_each_mode(function); });
  }

  /// Of all modes; 0 of those that rest.
  [[nodiscard]] Probability mode_probability() const noexcept {
    if (joined_) return all_.mode_probability();
    Probability probability = Probability::Zero();
    probability.template head<kCore>() = core_.mode_probability();
    return probability;
  }

  /// The moment-matched estimate over the modes in use.
  [[nodiscard]] auto estimate() const noexcept {
    return visit(*this, [](const auto& imm) { return imm.estimate(); });
  }

  /// Saves or restores beliefs and mode probabilities.
  void archive(Archive& fields) {
    fields(joined_);
    fields(share_);
    visit(*this, [&](auto& imm) { imm.archive(fields); });
  }

  /// Takes the beliefs and probabilities of another with the same parameters.
  void copy_state_from(const ModelGroupImm& other) noexcept {
    joined_ = other.joined_;
    share_ = other.share_;
    if (joined_)
      all_.gather([&](int) -> const All& { return other.all_; });
    else
      core_.gather([&](int) -> const Core& { return other.core_; });
  }

  [[nodiscard]] bool started() const noexcept {
    return visit(*this, [](const auto& imm) { return imm.started(); });
  }
  /// Whether the group has joined.
  [[nodiscard]] bool joined() const noexcept { return joined_; }
  /// The Imm with the group, and that without; the one that is not in use is as it was left.
  [[nodiscard]] const All& all() const noexcept { return all_; }
  [[nodiscard]] All& all() noexcept { return all_; }
  [[nodiscard]] const Core& core() const noexcept { return core_; }
  [[nodiscard]] Core& core() noexcept { return core_; }

 private:
  template <class Self, class Function>
  static decltype(auto) visit(Self& self, const Function& function) noexcept {
    return self.joined_ ? function(self.all_) : function(self.core_);
  }

  static Core core_of(const All& all) {
    return [&]<std::size_t... Index>(std::index_sequence<Index...>) {
      Core core(all.chain().template first<kCore>(), all.template filter<int(Index)>()...);
      typename Core::Probability initial = all.initial_mode_probability().template head<kCore>();
      auto others = initial.template tail<kCore - 1>();
      if (const double sum = others.sum(); sum > 0.0)
        others *= (1.0 - initial[0]) / sum;
      else
        others.setConstant((1.0 - initial[0]) / (kCore - 1));
      core.set_initial_mode_probability(initial);
      return core;
    }
    (std::make_index_sequence<kCore>{});
  }

  void join() noexcept {
    typename Core::Probability of_others = core_.mode_probability();
    const double first = of_others[0];
    of_others[0] = 0.0;
    of_others /= 1.0 - first;
    Probability probability;
    probability << (1.0 - share_) * of_others, share_ * of_group_;
    probability *= 1.0 - first;
    probability[0] = first;
    const auto common = moment_matched(core_.bank(), of_others);
    all_.assign(probability, [&](auto mode, auto& filter) {
      if constexpr (mode.value < kCore)
        filter.to_assign() = core_.template filter<mode.value>().estimate();
      else
        (void)filter.start(common);
    });
    joined_ = true;
  }

  void rest() noexcept {
    const auto& before = all_.mode_probability();
    const double group = before.template tail<kGroup>().sum();
    share_ = before[0] < 1.0 ? group / (1.0 - before[0]) : prior_share_;
    typename Core::Probability probability = before.template head<kCore>();
    probability /= probability.sum();
    core_.assign(probability, [&](auto mode, auto& filter) {
      filter.to_assign() = all_.template filter<mode.value>().estimate();
    });
    joined_ = false;
  }

  All all_;
  Core core_;
  Vec<double, kGroup> of_group_;  ///< how the group's probability is shared when it joins
  double leaving_per_s_;          ///< rate at which the group is left
  double prior_share_;            ///< of the group in what leaves the first model
  double share_;  ///< of the group in the probability of all but the first, while it rests
  bool joined_ = false;
};

}  // namespace wakeline
