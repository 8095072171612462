// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>

#include "wakeline/core/archive.hpp"
#include "wakeline/filter/belief.hpp"
#include "wakeline/multimodel/history_tree.hpp"
#include "wakeline/multimodel/mixture.hpp"
#include "wakeline/multimodel/turn_rate_grid.hpp"
#include "wakeline/multimodel/uniform_bank.hpp"

namespace wakeline {

/// A tree of mode histories: each hypothesis is one filter with its own past of modes, and nothing
/// is mixed.
///
/// `predict` lets every hypothesis stay in its mode or, where its present segment is long enough,
/// switch to another one; the likeliest switches that there is room for are followed. `update`
/// weighs each hypothesis by its likelihood, joins those of one mode that have become alike, and
/// keeps the likeliest. An Imm of the same modes mixes in every scan, and pays for it with the
/// spread of the mixture. Has the face of `Imm`, over filters of one kind; storage is in place, no
/// heap: at most `Capacity` hypotheses, twice. In a missed scan the mode probabilities follow the
/// chain, as far as there is room and except for segments still too short to end.
///
/// Source: G. A. Ackerson, K. S. Fu, IEEE Trans. AC-15, 1970 (the tree); J. K. Tugnait, Automatica
/// 18, 1982 (detection and estimation over it); D. J. Salmond, SPIE 1305, 1990 (joining around the
/// heaviest).
template <class FilterType, int K = kRuntimeModes, int Capacity = 256>
class ModeHistory {
 public:
  using Filter = FilterType;
  using Scalar = typename Filter::Scalar;
  static constexpr int kModels = K;
  static constexpr auto kComponents = Filter::kComponents;
  using Bank = UniformBank<Filter, K>;
  using Probability = ModeVector<Scalar, K>;
  using BeliefType = StateBelief<kComponents, Scalar>;

  /// A history of modes up to now, and what follows from it.
  struct Hypothesis {
    BeliefType belief;
    Scalar probability = Scalar(0);
    Scalar segment_s = Scalar(0);  ///< time since it came into its mode
    std::uint64_t modes = 0;       ///< the last 16, four bits each, the present one lowest

    [[nodiscard]] int mode() const noexcept { return static_cast<int>(modes & 0xF); }
  };

  /// One mode of the chain for each filter of the bank. Throws `std::invalid_argument` when a
  /// parameter makes no sense or the tree does not fit into `Capacity`.
  ModeHistory(const HistoryTree& tree, const ModeChain<K>& chain, const Bank& bank)
      : tree_(validated(tree)),
        chain_(chain),
        bank_(bank),
        initial_(Probability::Constant(bank.size(), Scalar(1) / Scalar(bank.size()))),
        probability_(initial_),
        transition_(ModeMatrix<Scalar, K>::Zero(bank.size(), bank.size())) {
    if (chain.modes() != bank.size())
      throw std::invalid_argument(
          "a ModeHistory needs one mode of its chain for each filter, got " +
          std::to_string(chain.modes()) + " modes and " + std::to_string(bank.size()) + " filters");
    require(tree.max_branches <= Capacity, "max_branches",
            ("at most the capacity of " + std::to_string(Capacity)).c_str(), tree.max_branches);
    require(tree.max_hypotheses >= bank.size(), "max_hypotheses",
            ("at least the number of modes, " + std::to_string(bank.size())).c_str(),
            tree.max_hypotheses);
  }

  /// Filters like `prototype` at the turn rates of a grid; at a start the straightest has a
  /// probability of 0.9.
  ModeHistory(const HistoryTree& tree, const TurnRateGrid& grid_rad_s, const ModeChain<K>& chain,
              const Filter& prototype)
      : ModeHistory(tree, chain, Bank(prototype, grid_rad_s.size())) {
    bank_.for_each([&](int k, Filter& filter, auto&) { set_turn_rate(filter, grid_rad_s[k]); });
    const int modes = grid_rad_s.size();
    initial_.setConstant(Scalar(0.1 / (modes - 1)));
    initial_[grid_rad_s.straightest()] = Scalar(0.9);
    probability_ = initial_;
  }

  /// Mode probabilities that a start begins with. Throws unless they sum to 1.
  void set_initial_mode_probability(const Probability& probability) {
    require_distribution("initial_mode_probability", probability, bank_.size());
    initial_ = probability;
    if (!started_) probability_ = initial_;
  }

  /// Begins a hypothesis in every mode with the belief, over the state or over `[x, vx, y, vy]`.
  /// Where a filter refuses it nothing changes.
  template <class StartType>
  Status start(const StartType& belief) noexcept {
    Hypotheses& next = spare();
    for (int k = 0; k < bank_.size(); ++k) {
      Filter& filter = bank_.filter(k);
      if (const Status status = filter.start(belief); status != Status::kOk) return status;
      Hypothesis& hypothesis = at(next, k);
      hypothesis.belief = filter.estimate();
      hypothesis.probability = initial_[k];
      hypothesis.segment_s = std::numeric_limits<Scalar>::infinity();
      hypothesis.modes = static_cast<std::uint64_t>(k);
    }
    started_ = true;
    take(bank_.size());
    return Status::kOk;
  }

  /// Branches and predicts.
  Status predict(Scalar dt_s) noexcept { return branch_and_move(dt_s); }

  /// The same under a known acceleration, [north, east]; see `Control`.
  Status predict(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    return branch_and_move(dt_s, acceleration_mps2);
  }

  /// Corrects every hypothesis by a reading, weighs them, joins and cuts. The innovation of the
  /// step is that of the moment-matched prediction, its log-likelihood that of the mixture. A
  /// hypothesis whose update fails is dropped; where all fail nothing changes.
  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> update(const Sensor& sensor,
                                             const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    constexpr int kM = Sensor::kMeasurements;
    if (!started_) return failed_step<kM, Scalar>(Status::kNotStarted);
    const Gaussian<kM, Scalar> reading = sensor.observe(z);
    std::array<Correction<kM, Scalar>, kCapacity> corrections;
    std::array<Scalar, kCapacity> weights{};
    Hypotheses& next = spare();
    for (std::size_t i = 0; i < size(); ++i) {
      next[i] = present()[i];
      Filter& filter = filter_of(next[i]);
      corrections[i] = filter.correct(sensor, reading);
      if (corrections[i]) next[i].belief = filter.estimate();
      weights[i] = next[i].probability;
    }
    const std::span<const Correction<kM, Scalar>> taken(corrections.data(), size());
    Step<kM, Scalar> step =
        mixed_step<kM, Scalar>(taken, std::span<const Scalar>(weights.data(), size()));
    step.log_likelihood = reweigh<kCapacity, Scalar>(
        {weights.data(), size()}, [&](std::size_t i) { return taken[i].likelihood(); });
    if (step.log_likelihood == kImpossible<Scalar>)
      return failed_step<kM, Scalar>(failure_of(taken));
    for (std::size_t i = 0; i < size(); ++i) next[i].probability = weights[i];
    take(count_);
    if (!pooled()) reduce();
    return step;
  }

  /// What the hypotheses think of a reading, without taking it.
  template <class Sensor>
  [[nodiscard]] Evidence<Scalar> evidence(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) const noexcept {
    Evidence<Scalar> evidence;
    const Gaussian<Sensor::kMeasurements, Scalar> reading = sensor.observe(z);
    for (int k = 0; k < bank_.size(); ++k) {
      Filter filter = bank_.filter(k);
      for (const Hypothesis& hypothesis : hypotheses()) {
        if (hypothesis.mode() != k) continue;
        (void)filter.assign(hypothesis.belief);
        evidence.add(hypothesis.probability, filter.compare(sensor, reading));
      }
    }
    return evidence;
  }

  /// Probabilistic data association, as of `Imm`: every hypothesis takes in all readings that may
  /// be the target's own.
  template <class Sensor>
  Scalar update(std::span<const Alternative<Sensor, Scalar>> readings, Scalar none,
                std::span<Scalar> share) noexcept {
    for (Scalar& part : share) part = Scalar(0);
    if (!started_) return Scalar(0);
    Hypotheses& next = spare();
    Scalar total = Scalar(0);
    for (std::size_t i = 0; i < size(); ++i) {
      next[i] = present()[i];
      Filter& filter = filter_of(next[i]);
      next[i].probability *=
          absorb(filter, present()[i].belief, readings, none, next[i].probability, share);
      next[i].belief = filter.estimate();
      total += next[i].probability;
    }
    if (!(total > Scalar(0)) || !std::isfinite(total)) return Scalar(0);
    for (Scalar& part : share) part /= total;
    take(count_);
    if (!pooled()) reduce();
    return total;
  }

  /// Saves or restores the hypotheses.
  void archive(Archive& fields) {
    bool started = started_;
    int count = count_;
    fields(started);
    fields(count);
    if (count < int(started) || count > tree_.max_branches ||
        (pooled() && started && count != bank_.size()))
      return fields.fail();
    Hypotheses& hypotheses = fields.loading() ? spare() : present();
    bool sound = true;
    for (int i = 0; i < count; ++i) {
      Hypothesis& hypothesis = at(hypotheses, i);
      fields(hypothesis.belief.mean);
      fields(hypothesis.belief.covariance);
      fields(hypothesis.probability);
      fields(hypothesis.segment_s);
      fields(hypothesis.modes);
      sound = sound && hypothesis.mode() < bank_.size() && hypothesis.probability >= Scalar(0) &&
              hypothesis.probability <= Scalar(1) && (!pooled() || hypothesis.mode() == i);
    }
    if (!sound) fields.fail();
    if (!fields.loading() || !fields.ok()) return;
    started_ = started;
    now_ = 1 - now_;
    count_ = count;
    weigh_modes();
  }

  /// The moment-matched estimate.
  [[nodiscard]] BeliefType estimate() const noexcept {
    return joined(
               size(), [&](std::size_t i) -> auto& { return present()[i]; })
        .belief;
  }

  [[nodiscard]] const Probability& mode_probability() const noexcept { return probability_; }
  [[nodiscard]] const Probability& initial_mode_probability() const noexcept { return initial_; }
  [[nodiscard]] const HistoryTree& tree() const noexcept { return tree_; }
  [[nodiscard]] const ModeChain<K>& chain() const noexcept { return chain_; }
  [[nodiscard]] const Bank& bank() const noexcept { return bank_; }
  [[nodiscard]] bool started() const noexcept { return started_; }

  /// What is believed at present.
  [[nodiscard]] std::span<const Hypothesis> hypotheses() const noexcept {
    return {buffers_[now_].data(), size()};
  }

 private:
  static constexpr std::size_t kCapacity = static_cast<std::size_t>(Capacity);
  static_assert(kMaxModes <= 16, "a mode has four bits of a history");
  using Hypotheses = std::array<Hypothesis, kCapacity>;
  using Indices = std::array<int, kCapacity>;

  /// A switch of a hypothesis to another mode.
  struct Switch {
    Scalar probability;
    int from;
    int mode;
  };

  template <class... Known>
  Status branch_and_move(Scalar dt_s, const Known&... acceleration_mps2) noexcept {
    if (!started_) return Status::kNotStarted;
    if (const Status status = check_time_step(dt_s); status != Status::kOk) return status;
    if (!pooled() && count_ > tree_.max_hypotheses) {  // the last scan was missed
      for (const Hypothesis& hypothesis : hypotheses())
        if (const Status status = filter_of(hypothesis).predict(dt_s, acceleration_mps2...);
            status != Status::kOk)
          return status;
      reduce();
    }
    if (dt_s != transition_step_s_) {
      transition_ = chain_.transition(double(dt_s)).template cast<Scalar>();
      transition_step_s_ = dt_s;
    }
    std::array<Switch, kCapacity> switches;
    const int switching = pooled() ? 0 : likeliest_switches(dt_s, switches);
    const BeliefType pool = pooled() ? estimate() : BeliefType{};
    Hypotheses& next = spare();
    const auto move = [&](Hypothesis& hypothesis) {
      Filter& filter = filter_of(hypothesis);
      const Status status = filter.predict(dt_s, acceleration_mps2...);
      hypothesis.belief = filter.estimate();
      return status;
    };
    for (int i = 0; i < count_; ++i) {
      Hypothesis& stays = at(next, i) = at(present(), i);
      const int mode = stays.mode();
      if (pooled()) {
        stays.belief = pool;
        stays.probability = arriving(mode);
      } else if (may_switch(stays, dt_s)) {
        stays.probability *= transition_(mode, mode);
      }
      stays.segment_s += dt_s;
      stays.modes = followed_by(stays.modes, mode);
      if (const Status status = move(stays); status != Status::kOk) return status;
    }
    for (int s = 0; s < switching; ++s) {
      const Switch& change = at(switches, s);
      const Hypothesis& before = at(present(), change.from);
      Hypothesis& switches_now = at(next, count_ + s);
      switches_now = {before.belief, change.probability, dt_s,
                      followed_by(before.modes, change.mode)};
      if (const Status status = move(switches_now); status != Status::kOk) return status;
      spread(switches_now.belief, at(next, change.from).belief.mean);
    }
    take(count_ + switching);
    return Status::kOk;
  }

  /// Fills in the likeliest switches that there is room for; returns how many.
  int likeliest_switches(Scalar dt_s, std::array<Switch, kCapacity>& chosen) const noexcept {
    const auto better = [](const Switch& a, const Switch& b) {
      if (a.probability != b.probability) return a.probability > b.probability;
      return a.from != b.from ? a.from < b.from : a.mode < b.mode;
    };
    const int room = tree_.max_branches - count_;
    int count = 0;
    for (int from = 0; from < count_ && room > 0; ++from) {
      const Hypothesis& hypothesis = at(present(), from);
      if (!may_switch(hypothesis, dt_s)) continue;
      for (int mode = 0; mode < bank_.size(); ++mode) {
        const Scalar probability = hypothesis.probability * transition_(hypothesis.mode(), mode);
        const Switch change{probability, from, mode};
        if (mode == hypothesis.mode() || !(probability > Scalar(0))) continue;
        if (count == room) {
          if (!better(change, chosen.front())) continue;
          std::pop_heap(chosen.begin(), chosen.begin() + count--, better);
        }
        at(chosen, count++) = change;
        std::push_heap(chosen.begin(), chosen.begin() + count, better);
      }
    }
    return count;
  }

  /// The first-order pseudo-Bayes estimator has one belief, from which every mode sets out.
  [[nodiscard]] bool pooled() const noexcept { return tree_.pseudo_bayes_order == 1; }

  /// Probability of a mode by the chain.
  [[nodiscard]] Scalar arriving(int mode) const noexcept {
    Scalar sum = Scalar(0);
    for (int before = 0; before < bank_.size(); ++before)
      sum += probability_[before] * transition_(before, mode);
    return sum;
  }

  /// Whether the present segment is long enough, to the nearest scan.
  [[nodiscard]] bool may_switch(const Hypothesis& hypothesis, Scalar dt_s) const noexcept {
    return tree_.min_segment_s <= 0.0 ||
           hypothesis.segment_s + dt_s / 2 > Scalar(tree_.min_segment_s);
  }

  static std::uint64_t followed_by(std::uint64_t modes, int mode) noexcept {
    return modes << 4 | static_cast<std::uint64_t>(mode);
  }

  /// The switch may have come later in the scan: adds a part of u d, d the way from the mean that
  /// is without the switch, u uniform over one scan, whose variance is 1/12.
  void spread(BeliefType& belief, const Vec<Scalar, BeliefType::kStates>& without) const noexcept {
    const Vec<Scalar, BeliefType::kStates> d = belief.mean - without;
    const Scalar variance = Scalar(tree_.switch_time_spread / 12.0);
    for (int j = 0; j < BeliefType::kStates; ++j) belief.covariance.col(j) += variance * (d[j] * d);
  }

  /// Joins similar hypotheses, and keeps the likeliest.
  void reduce() noexcept {
    join();
    cut();
  }

  /// Joins the similar hypotheses of each mode, around the heaviest of them.
  void join() noexcept {
    Indices order;
    const int count = ordered(order, [](const Hypothesis& a, const Hypothesis& b) {
      return a.mode() != b.mode() ? a.mode() < b.mode() : a.probability > b.probability;
    });
    Indices cluster;
    Hypotheses& next = spare();
    int joints = 0;
    for (int a = 0; a < count; ++a) {
      if (at(order, a) < 0) continue;
      const int members = gather(a, count, order, cluster);
      const auto member = [&](std::size_t i) -> auto& { return at(present(), cluster[i]); };
      Hypothesis& joint = at(next, joints++);
      joint = member(0);
      if (members == 1) continue;
      const auto [belief, probability] = joined(static_cast<std::size_t>(members), member);
      joint.belief = belief;
      joint.probability = probability;
    }
    take(joints);
  }

  /// Keeps the likeliest, in that order.
  void cut() noexcept {
    Indices order;
    const int count = ordered(order, [](const Hypothesis& a, const Hypothesis& b) {
      return a.probability > b.probability;
    });
    const int kept = std::min(count, tree_.max_hypotheses);
    for (int i = 0; i < kept; ++i) at(spare(), i) = at(present(), at(order, i));
    take(kept);
  }

  /// Fills in the hypotheses that are not negligible, at least the likeliest, in an order; returns
  /// how many.
  template <class Before>
  int ordered(Indices& order, Before&& before) const noexcept {
    int count = 0;
    Scalar likeliest = Scalar(0);
    for (const Hypothesis& hypothesis : hypotheses())
      likeliest = std::max(likeliest, hypothesis.probability);
    const Scalar negligible = std::min(Scalar(tree_.negligible_probability), likeliest / 2);
    for (int i = 0; i < count_; ++i)
      if (at(present(), i).probability > negligible) at(order, count++) = i;
    std::sort(order.begin(), order.begin() + count, [&](int i, int j) {
      const Hypothesis& a = at(present(), i);
      const Hypothesis& b = at(present(), j);
      return before(a, b) || (!before(b, a) && i < j);
    });
    return count;
  }

  /// Takes `order[a]` and the hypotheses similar to it out of the order, into `cluster`; returns
  /// how many.
  int gather(int a, int count, Indices& order, Indices& cluster) const noexcept {
    const Hypothesis& heaviest = at(present(), at(order, a));
    int members = 0;
    at(cluster, members++) = at(order, a);
    Cholesky<BeliefType::kStates, Scalar> factor;
    for (int b = a + 1; b < count; ++b) {
      int& index = at(order, b);
      if (index < 0) continue;
      const Hypothesis& other = at(present(), index);
      if (other.mode() != heaviest.mode()) break;
      if (tree_.pseudo_bayes_order > 0 ? !same_past(heaviest, other)
                                       : !near(heaviest, other, factor))
        continue;
      at(cluster, members++) = index;
      index = -1;
    }
    return members;
  }

  /// Whether the last modes of a pseudo-Bayes tree are the same.
  [[nodiscard]] bool same_past(const Hypothesis& a, const Hypothesis& b) const noexcept {
    return (a.modes ^ b.modes) << (64 - 4 * (tree_.pseudo_bayes_order - 1)) == 0;
  }

  /// Whether two hypotheses of one mode may join; `factor` is of the first one's covariance, once
  /// it is needed.
  bool near(const Hypothesis& a, const Hypothesis& b,
            Cholesky<BeliefType::kStates, Scalar>& factor) const noexcept {
    const bool siblings = a.segment_s == b.segment_s;
    const Scalar distance = Scalar(siblings ? tree_.sibling_distance : tree_.merge_distance);
    if (!(distance > Scalar(0))) return false;
    if (!factor.ok()) factor.compute(a.belief.covariance);
    return factor.ok() && factor.squared_norm(b.belief.mean - a.belief.mean) < distance * distance;
  }

  struct Joint {
    BeliefType belief;
    Scalar probability;
  };

  /// Moment matching of hypotheses `part(0 .. count - 1)`.
  template <class Part>
  static Joint joined(std::size_t count, Part&& part) noexcept {
    Scalar total = Scalar(0);
    for (std::size_t i = 0; i < count; ++i) total += part(i).probability;
    BeliefType sum = zero_like(BeliefType{});
    for (std::size_t i = 0; i < count; ++i)
      add_mean(sum, part(i).probability / total, part(i).belief, sum);
    for (std::size_t i = 0; i < count; ++i)
      add_spread(sum, part(i).probability / total, part(i).belief, sum);
    return {sum, total};
  }

  /// Makes the first `count` of the spare hypotheses the present ones, with probabilities that sum
  /// to 1.
  void take(int count) noexcept {
    now_ = 1 - now_;
    count_ = count;
    Scalar total = Scalar(0);
    for (const Hypothesis& hypothesis : hypotheses()) total += hypothesis.probability;
    for (int i = 0; i < count_; ++i) at(present(), i).probability /= total;
    weigh_modes();
  }

  void weigh_modes() noexcept {
    probability_.setZero();
    for (const Hypothesis& hypothesis : hypotheses())
      probability_[hypothesis.mode()] += hypothesis.probability;
  }

  /// The filter of its mode, with its belief.
  Filter& filter_of(const Hypothesis& hypothesis) noexcept {
    Filter& filter = bank_.filter(hypothesis.mode());
    (void)filter.assign(hypothesis.belief);
    return filter;
  }

  template <class Array>
  static auto& at(Array& array, int i) noexcept {
    return array[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] std::size_t size() const noexcept { return static_cast<std::size_t>(count_); }
  Hypotheses& present() noexcept { return buffers_[now_]; }
  [[nodiscard]] const Hypotheses& present() const noexcept { return buffers_[now_]; }
  Hypotheses& spare() noexcept { return buffers_[1 - now_]; }

  HistoryTree tree_;
  ModeChain<K> chain_;
  Bank bank_;  ///< each mode's filter; the belief in it is of no hypothesis
  Probability initial_;
  Probability probability_;
  ModeMatrix<Scalar, K> transition_;
  Scalar transition_step_s_ = Scalar(-1);
  std::array<Hypotheses, 2> buffers_;
  std::size_t now_ = 0;
  int count_ = 0;
  bool started_ = false;
};

}  // namespace wakeline
