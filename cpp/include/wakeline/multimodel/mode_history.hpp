// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/in_place_array.hpp"
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
/// spread of the mixture.
///
/// Where the turn rate is part of the state (`CoordinatedTurnRate`), a mode is a guess of it: a
/// hypothesis that switches to a mode with another prior rate, or another deviation of it, takes
/// that up and learns its rate from there. Vessels need not turn at the rates of a grid then.
///
/// Has the face of `Imm`, over filters of one kind; storage is in place, no
/// heap: at most `Capacity` hypotheses, twice. In a missed scan the mode probabilities follow the
/// chain, as far as there is room and except for segments still too short to end.
///
/// Over filters of packs (`Ekf<CoordinatedTurn, Pack<double, kNativeLanes<double>>>`) the
/// hypotheses of a mode are filtered side by side, in the lanes of one filter; the face is that
/// over filters of numbers, and so are the results, to rounding, which may decide among hypotheses
/// of equal probability which of them are kept.
///
/// Source: G. A. Ackerson, K. S. Fu, IEEE Trans. AC-15, 1970 (the tree); J. K. Tugnait, Automatica
/// 18, 1982 (detection and estimation over it); D. J. Salmond, SPIE 1305, 1990 (joining around the
/// heaviest).
template <class FilterType, int K = kRuntimeModes, int Capacity = 256>
class ModeHistory {
 public:
  using Filter = FilterType;
  using Lanes = typename Filter::Scalar;  ///< of hypotheses side by side, or a number of one
  using Scalar = RealOf<Lanes>;
  static constexpr int kModels = K;
  static constexpr auto kComponents = Filter::kComponents;
  static constexpr int kStates = Filter::kStates;
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
        transition_(ModeMatrix<Scalar, K>::Zero(bank.size(), bank.size())),
        ways_out_(ModeMatrix<int, K>::Zero(bank.size(), bank.size())) {
    if (chain.modes() != bank.size())
      refuse("a ModeHistory needs one mode of its chain for each filter, got " +
             std::to_string(chain.modes()) + " modes and " + std::to_string(bank.size()) +
             " filters");
    require(tree.max_branches <= Capacity, "max_branches",
            ("at most the capacity of " + std::to_string(Capacity)).c_str(), tree.max_branches);
    require(tree.max_hypotheses >= bank.size(), "max_hypotheses",
            ("at least the number of modes, " + std::to_string(bank.size())).c_str(),
            tree.max_hypotheses);
    for (int k = 1; k < bank.size(); ++k)
      require(same_prior_rate(0, k) || tree.pseudo_bayes_order != 1, "pseudo_bayes_order",
              "2 or more where each mode learns a turn rate of its own, as order 1 keeps one "
              "belief for all",
              tree.pseudo_bayes_order);
  }

  /// Filters like `prototype` at the turn rates of a grid; of those that learn theirs, the
  /// straightest has a tenth of the deviation of the prior, as a straight is straight. At a start
  /// it has a probability of 0.9.
  ModeHistory(const HistoryTree& tree, const TurnRateGrid& grid_rad_s, const ModeChain<K>& chain,
              const Filter& prototype)
      : ModeHistory(tree, chain, bank_about(grid_rad_s, prototype)) {
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
  /// One over a state with turn rate gives every mode that rate. Where a filter refuses it nothing
  /// changes.
  template <class StartType>
  Status start(const StartType& belief) noexcept {
    Hypotheses& next = spare();
    for (int k = 0; k < bank_.size(); ++k) {
      Filter& filter = bank_.filter(k);
      if (const Status status = lane(filter.start(belief.template cast<Lanes>()), 0);
          status != Status::kOk)
        return status;
      Hypothesis& hypothesis = at(next, k);
      put({&k, 1, k}, filter.estimate(), next);
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
    Gaussian<kM, Lanes> reading = sensor.observe(z).template cast<Lanes>();
    InPlaceArray<Correction<kM, Lanes>, kMostRows> corrections;
    std::array<Lanes, kMostRows> weights;
    const Rows rows(hypotheses());
    Hypotheses& next = spare();
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const Row& row = rows[r];
      Filter& filter = filter_of(row, present_beliefs());
      ::new (corrections.place(r)) Correction<kM, Lanes>(filter.correct(sensor, reading));
      weights[r] = probability_of(row, present());
      go_on(row, filter.estimate(), next);
    }
    const std::span<const Correction<kM, Lanes>> taken = corrections.first(rows.size());
    const std::span<Lanes> weighed(weights.data(), rows.size());
    Step<kM, Scalar> step = mixed_step<kM, Scalar>(taken, weighed);
    step.log_likelihood =
        reweigh<kMostRows, Scalar>(weighed, [&](std::size_t r) { return taken[r].likelihood(); });
    if (step.log_likelihood == kImpossible<Scalar>)
      return failed_step<kM, Scalar>(first_failure_of_lanes(failure_of(taken)));
    for (std::size_t r = 0; r < rows.size(); ++r) set_probability(rows[r], weights[r], next);
    take(count_);
    if (!pooled()) reduce();
    return step;
  }

  /// What the hypotheses think of a reading, without taking it.
  template <class Sensor>
  [[nodiscard]] Evidence<Scalar> evidence(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) const noexcept {
    Evidence<Lanes> evidence;
    const auto reading = sensor.observe(z).template cast<Lanes>();
    const Rows rows(hypotheses());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      Filter filter = bank_.filter(rows[r].mode);
      (void)filter.assign(side_by_side(rows[r], present_beliefs()));
      evidence.add(probability_of(rows[r], present()), filter.compare(sensor, reading));
    }
    return {sum_to<Scalar>(evidence.likelihood), least_to<Scalar>(evidence.least_nis)};
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
    const Rows rows(hypotheses());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const LaneBelief before = side_by_side(rows[r], present_beliefs());
      Filter& filter = bank_.filter(rows[r].mode);
      (void)filter.assign(before);
      const Lanes weight = probability_of(rows[r], present());
      const Lanes posterior = weight * absorb(filter, before, readings, none, weight, share);
      total += sum_to<Scalar>(posterior);
      go_on(rows[r], filter.estimate(), next);
      set_probability(rows[r], posterior, next);
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
  static constexpr double kStraightPart = 0.1;
  static constexpr int kTurnRateRow = index_of(kComponents, Component::kTurnRate);  ///< or -1
  using Hypotheses = std::array<Hypothesis, kCapacity>;
  using Indices = std::array<int, kCapacity>;

  using LaneBelief = StateBelief<kComponents, Lanes>;
  static constexpr int kLanes = kLanesOf<Lanes>;
  static constexpr std::size_t kMostRows =
      kCapacity / kLanes + (kLanes > 1 ? static_cast<std::size_t>(kModeCapacity<K>) : 0);

  /// Hypotheses of one mode, by their numbers, as many as there are lanes or fewer: the last one
  /// stands in all lanes that are left over.
  struct Row {
    const int* first;
    int count;
    int mode;

    int operator[](int of_lane) const noexcept { return first[std::min(of_lane, count - 1)]; }
  };

  /// All hypotheses in rows.
  class Rows {
   public:
    explicit Rows(std::span<const Hypothesis> hypotheses) noexcept {
      std::array<int, kModeCapacity<K> + 1> begin{};
      for (const Hypothesis& hypothesis : hypotheses) ++at(begin, hypothesis.mode() + 1);
      for (int mode = 0; mode < kModeCapacity<K>; ++mode) at(begin, mode + 1) += at(begin, mode);
      std::array<int, kModeCapacity<K> + 1> end = begin;
      for (std::size_t i = 0; i < hypotheses.size(); ++i)
        at(order_, at(end, hypotheses[i].mode())++) = static_cast<int>(i);
      for (int mode = 0; mode < kModeCapacity<K>; ++mode)
        for (int i = at(begin, mode); i < at(end, mode); i += kLanes)
          rows_[size_++] = {&at(order_, i), std::min(kLanes, at(end, mode) - i), mode};
    }
    Rows(const Rows&) = delete;
    Rows& operator=(const Rows&) = delete;

    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    const Row& operator[](std::size_t k) const noexcept { return rows_[k]; }

   private:
    Indices order_;
    std::array<Row, kMostRows> rows_;
    std::size_t size_ = 0;
  };

  [[nodiscard]] auto present_beliefs() const noexcept {
    return [this](int i) -> const BeliefType& { return at(present(), i).belief; };
  }

  /// Each lane of a row takes `belief_of(i)` of its hypothesis.
  template <class BeliefOf>
  [[gnu::flatten]] static LaneBelief side_by_side(const Row& row,
                                                  const BeliefOf& belief_of) noexcept {
    const BeliefType* of_lane[kLanes];
    for (int k = 0; k < kLanes; ++k) of_lane[k] = &belief_of(row[k]);
    LaneBelief belief;
    Gaussian<kStates, Lanes>& lanes = belief;
    gather_lanes([&](int k) -> const BeliefType& { return *of_lane[k]; }, lanes);
    return belief;
  }

  /// Takes the beliefs of a row out of their lanes.
  [[gnu::flatten]] static void put(const Row& row, const Gaussian<kStates, Lanes>& lanes,
                                   Hypotheses& hypotheses) noexcept {
    BeliefType* of_lane[kLanes];
    for (int k = 0; k < kLanes; ++k) of_lane[k] = &at(hypotheses, row[k]).belief;
    scatter_lanes(lanes, row.count, [&](int k) -> BeliefType& { return *of_lane[k]; });
  }

  /// The hypotheses of a row go on in their modes with other beliefs.
  void go_on(const Row& row, const Gaussian<kStates, Lanes>& lanes,
             Hypotheses& next) const noexcept {
    put(row, lanes, next);
    for (int of_lane = 0; of_lane < row.count; ++of_lane) {
      const int i = row[of_lane];
      at(next, i).segment_s = at(present(), i).segment_s;
      at(next, i).modes = at(present(), i).modes;
    }
  }

  static void set_probability(const Row& row, const Lanes& probability,
                              Hypotheses& hypotheses) noexcept {
    for (int of_lane = 0; of_lane < row.count; ++of_lane)
      at(hypotheses, row[of_lane]).probability = lane(probability, of_lane);
  }

  /// Zero in lanes that are left over.
  static Lanes probability_of(const Row& row, const Hypotheses& of) noexcept {
    return lanes_of<Lanes>([&](int of_lane) {
      return of_lane < row.count ? at(of, row[of_lane]).probability : Scalar(0);
    });
  }

  /// The filter of its mode, with the beliefs of a row.
  template <class BeliefOf>
  Filter& filter_of(const Row& row, const BeliefOf& belief_of) noexcept {
    Filter& filter = bank_.filter(row.mode);
    (void)filter.assign(side_by_side(row, belief_of));
    return filter;
  }

  /// Predicts the first `count` of some hypotheses, each from `before(i)`. Where one fails none is
  /// to be used.
  template <class Before, class... Known>
  Status move(Hypotheses& hypotheses, int count, const Before& before, Scalar dt_s,
              const Known&... acceleration_mps2) noexcept {
    const Rows rows({hypotheses.data(), static_cast<std::size_t>(count)});
    for (std::size_t r = 0; r < rows.size(); ++r) {
      Filter& filter = filter_of(rows[r], before);
      const Status status = first_failure_of_lanes(
          filter.predict(Lanes(dt_s), acceleration_mps2.template cast<Lanes>()...));
      if (status != Status::kOk) return status;
      put(rows[r], filter.estimate(), hypotheses);
    }
    return Status::kOk;
  }

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
      spare() = present();
      if (const Status status =
              move(spare(), count_, present_beliefs(), dt_s, acceleration_mps2...);
          status != Status::kOk)
        return status;
      reduce();
    }
    if (dt_s != transition_step_s_) prepare(dt_s);
    std::array<Switch, kCapacity> switches;
    const int switching = pooled() ? 0 : likeliest_switches(dt_s, switches);
    const BeliefType pool = pooled() ? estimate() : BeliefType{};
    Hypotheses& next = spare();
    for (int i = 0; i < count_; ++i) {
      const Hypothesis& before = at(present(), i);
      Hypothesis& stays = at(next, i);
      const int mode = before.mode();
      stays.probability = before.probability;
      if (pooled())
        stays.probability = arriving(mode);
      else if (may_switch(before, dt_s))
        stays.probability *= transition_(mode, mode);
      stays.segment_s = before.segment_s + dt_s;
      stays.modes = followed_by(before.modes, mode);
    }
    for (int s = 0; s < switching; ++s) {
      const Switch& change = at(switches, s);
      Hypothesis& switched = at(next, count_ + s);
      switched.probability = change.probability;
      switched.segment_s = dt_s;
      switched.modes = followed_by(at(present(), change.from).modes, change.mode);
      if constexpr (kTurnRateRow >= 0) {
        const Hypothesis& from = at(present(), change.from);
        switched.belief = from.belief;
        if (!same_prior_rate(from.mode(), change.mode))
          forget_turn_rate(switched.belief, change.mode);
      }
    }
    const auto before = [&](int i) -> const BeliefType& {
      if (pooled()) return pool;
      if (i < count_) return at(present(), i).belief;
      return kTurnRateRow >= 0 ? at(next, i).belief
                               : at(present(), at(switches, i - count_).from).belief;
    };
    if (const Status status = move(next, count_ + switching, before, dt_s, acceleration_mps2...);
        status != Status::kOk)
      return status;
    for (int s = 0; s < switching; ++s)
      spread(at(next, count_ + s).belief, at(next, at(switches, s).from).belief.mean);
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
    bool full = false;
    for (int from = 0; from < count_ && room > 0; ++from) {
      const Hypothesis& hypothesis = at(present(), from);
      if (!may_switch(hypothesis, dt_s)) continue;
      for (int way = 0; way < bank_.size() - 1; ++way) {
        const int mode = ways_out_(hypothesis.mode(), way);
        const Scalar probability = hypothesis.probability * transition_(hypothesis.mode(), mode);
        const Switch change{probability, from, mode};
        if (!(probability > Scalar(0))) break;
        if (count == room) {
          if (!better(change, chosen.front())) break;
          std::pop_heap(chosen.begin(), chosen.begin() + count--, better);
        }
        at(chosen, count++) = change;
        if (count < room) continue;
        // A heap from here on, whose front is the first to go.
        if (!full)
          std::make_heap(chosen.begin(), chosen.begin() + count, better);
        else
          std::push_heap(chosen.begin(), chosen.begin() + count, better);
        full = true;
      }
    }
    return count;
  }

  /// Keeps the chain's transition over one step, and the ways out of each mode, likeliest first.
  void prepare(Scalar dt_s) noexcept {
    transition_ = chain_.transition(double(dt_s)).template cast<Scalar>();
    transition_step_s_ = dt_s;
    for (int mode = 0; mode < bank_.size(); ++mode) {
      auto ways = ways_out_.row(mode);
      int count = 0;
      for (int to = 0; to < bank_.size(); ++to)
        if (to != mode) {
          int at_way = count++;
          for (; at_way > 0 && transition_(mode, ways[at_way - 1]) < transition_(mode, to);
               --at_way)
            ways[at_way] = ways[at_way - 1];
          ways[at_way] = to;
        }
    }
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

  static Bank bank_about(const TurnRateGrid& grid_rad_s, const Filter& prototype) {
    Bank bank(prototype, grid_rad_s.size());
    bank.for_each([&](int k, Filter& filter, auto&) {
      expect_turn_rate(filter, grid_rad_s[k], k == grid_rad_s.straightest() ? kStraightPart : 1.0);
    });
    return bank;
  }

  /// Whether two modes assume the same of a turn rate that is not known.
  [[nodiscard]] bool same_prior_rate(int a, int b) const noexcept {
    if constexpr (kTurnRateRow < 0) return true;
    const auto& one = bank_.filter(a).motion();
    const auto& other = bank_.filter(b).motion();
    constexpr auto kRate = Component::kTurnRate;
    return prior_mean(one, kRate) == prior_mean(other, kRate) &&
           prior_variance(one, kRate) == prior_variance(other, kRate);
  }

  /// Takes the mode's prior for what is known of the turn rate.
  void forget_turn_rate(BeliefType& belief, int mode) const noexcept {
    const auto& motion = bank_.filter(mode).motion();
    belief.mean[kTurnRateRow] = Scalar(prior_mean(motion, Component::kTurnRate));
    belief.covariance.row(kTurnRateRow).setZero();
    belief.covariance.col(kTurnRateRow).setZero();
    belief.covariance(kTurnRateRow, kTurnRateRow) =
        Scalar(prior_variance(motion, Component::kTurnRate));
  }

  /// The switch may have come later in the scan: adds a part of u d, d the way from the mean that
  /// is without the switch, u uniform over one scan, whose variance is 1/12. A turn rate is that of
  /// the mode whenever the switch came.
  void spread(BeliefType& belief, const Vec<Scalar, kStates>& without) const noexcept {
    Vec<Scalar, kStates> d = belief.mean - without;
    if constexpr (kTurnRateRow >= 0) d[kTurnRateRow] = Scalar(0);
    const Scalar variance = Scalar(tree_.switch_time_spread / 12.0);
    for (int j = 0; j < kStates; ++j) belief.covariance.col(j) += variance * (d[j] * d);
  }

  /// Joins the similar hypotheses of each mode, around the heaviest of them, and keeps the
  /// likeliest, in that order.
  void reduce() noexcept {
    const Clusters clusters(*this);
    Hypotheses& next = spare();
    const int kept = std::min(clusters.count, tree_.max_hypotheses);
    for (int i = 0; i < kept; ++i) {
      const Cluster& cluster = at(clusters.cluster, i);
      const auto member = [&](std::size_t k) -> auto& {
        return at(present(), clusters.member[static_cast<std::size_t>(cluster.first) + k]);
      };
      Hypothesis& joint = at(next, i) = member(0);
      if (cluster.members == 1) continue;
      joint.belief = joined(static_cast<std::size_t>(cluster.members), member).belief;
      joint.probability = cluster.probability;
    }
    take(kept);
  }

  /// Hypotheses that join, from `first` on in a list of them. The likelier cluster comes first.
  struct Cluster {
    Scalar probability;
    int first;
    int members;

    bool operator<(const Cluster& other) const noexcept {
      return probability != other.probability ? probability > other.probability
                                              : first < other.first;
    }
  };

  /// All clusters that are not negligible, the likeliest first, at least that one.
  class Clusters {
   public:
    explicit Clusters(const ModeHistory& tree) noexcept
        : tree_(tree), limits_(tree.tree_), rows_(tree.hypotheses()) {
      Scalar likeliest = Scalar(0);
      for (const Hypothesis& one : tree_.hypotheses())
        likeliest = std::max(likeliest, one.probability);
      const Lanes dropped = std::min(Scalar(limits_.negligible_probability), likeliest / 2);
      for (std::size_t r = 0; r < rows_.size(); ++r) {
        const Lanes probability = tree_.probability_of(rows_[r], tree_.present());
        free_[r] = select(probability > dropped, probability, Lanes(0));
        segment_s_[r] = lanes_of<Lanes>([&](int of_lane) { return one(r, of_lane).segment_s; });
        gather_lanes<kStates>([&](int of_lane) { return one(r, of_lane).belief.mean.data(); },
                              mean_[r].data());
      }
      for (std::size_t r = 0; r < rows_.size(); r = end_) {
        end_ = r + 1;
        while (end_ < rows_.size() && rows_[end_].mode == rows_[r].mode) ++end_;
        while (take_heaviest(r)) {
        }
      }
      std::sort(cluster.begin(), cluster.begin() + count);
    }

    std::array<Cluster, kCapacity> cluster;
    Indices member;
    int count = 0;

   private:
    const Hypothesis& one(std::size_t row, int of_lane) const noexcept {
      return at(tree_.present(), rows_[row][of_lane]);
    }

    /// Makes a cluster of the heaviest free hypothesis of the mode of rows `begin` to `end_`; false
    /// when none is free.
    bool take_heaviest(std::size_t begin) noexcept {
      Lanes greatest = free_[begin];
      for (std::size_t r = begin + 1; r < end_; ++r) greatest = at_least(free_[r], greatest);
      const Scalar heaviest = greatest_of_lanes(greatest);
      if (!(heaviest > Scalar(0))) return false;
      std::size_t row = begin;
      while (none(free_[row] == Lanes(heaviest))) ++row;
      const int of_lane = std::countr_zero(bits_of(free_[row] == Lanes(heaviest)));
      const Hypothesis& center = one(row, of_lane);
      const int first = taken_;
      at(member, taken_++) = rows_[row][of_lane];
      Scalar probability = heaviest;
      const bool by_past = limits_.pseudo_bayes_order > 0;
      const bool by_distance = !by_past && limits_.sibling_distance > 0.0;
      Cholesky<kStates, Scalar> center_factor;
      if (by_distance) center_factor = factor_of(row, of_lane);
      for (std::size_t r = begin; r < end_; ++r) {
        const MaskOf<Lanes> left = free_[r] > Lanes(0);
        if (none(left)) continue;
        const MaskOf<Lanes> own = lane_number_ == Lanes(r == row ? of_lane : kLanes);
        MaskOf<Lanes> alike = own;
        if (by_past)
          alike = own || same_past(center, r);
        else if (center_factor.ok())
          alike = own || near(center, center_factor, r);
        const MaskOf<Lanes> joins = left && alike;
        unsigned others = bits_of(joins);
        if (r == row) others &= ~(1u << of_lane);
        for (; others != 0; others &= others - 1) {
          const int k = std::countr_zero(others);
          at(member, taken_++) = rows_[r][k];
          probability += lane(free_[r], k);
        }
        free_[r] = select(joins, Lanes(0), free_[r]);
      }
      at(cluster, count++) = {probability, first, taken_ - first};
      return true;
    }

    /// Which of a row have the same last modes, as a pseudo-Bayes tree wants it.
    MaskOf<Lanes> same_past(const Hypothesis& center, std::size_t r) const noexcept {
      const int forgotten = 64 - 4 * (limits_.pseudo_bayes_order - 1);
      return lanes_of<Lanes>([&](int of_lane) {
               return Scalar((center.modes ^ one(r, of_lane).modes) << forgotten == 0);
             }) > Lanes(0);
    }

    /// Which of a row are near one of the same mode, by the Cholesky factor of its covariance.
    MaskOf<Lanes> near(const Hypothesis& center, const Cholesky<kStates, Scalar>& factor,
                       std::size_t r) const noexcept {
      const auto siblings = segment_s_[r] == Lanes(center.segment_s);
      const Lanes distance = select(siblings, Lanes(Scalar(limits_.sibling_distance)),
                                    Lanes(Scalar(limits_.merge_distance)));
      const Vec<Lanes, kStates> d = mean_[r] - center.belief.mean.template cast<Lanes>();
      return factor.squared_norms(d) < distance * distance;
    }

    /// Cholesky factor of the covariance of a hypothesis; of its row all at once, when the first is
    /// needed.
    Cholesky<kStates, Scalar> factor_of(std::size_t row, int of_lane) noexcept {
      if (!std::exchange(factored_[row], true)) {
        Mat<Lanes, kStates, kStates> covariance;
        gather_lanes<kStates * kStates>([&](int k) { return one(row, k).belief.covariance.data(); },
                                        covariance.data());
        factor_[row].compute(covariance);
      }
      return factor_[row].of_lane(of_lane);
    }

    const ModeHistory& tree_;
    const HistoryTree& limits_;
    const Rows rows_;
    const Lanes lane_number_ = lanes_of<Lanes>([](int of_lane) { return Scalar(of_lane); });
    std::array<Lanes, kMostRows> free_;  ///< probability of what is in no cluster yet, else 0
    std::array<Lanes, kMostRows> segment_s_;
    std::array<Vec<Lanes, kStates>, kMostRows> mean_;
    std::array<Cholesky<kStates, Lanes>, kMostRows> factor_;
    std::array<bool, kMostRows> factored_{};
    std::size_t end_ = 0;
    int taken_ = 0;
  };

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
      sum.mean += part(i).probability / total * part(i).belief.mean;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec<Scalar, kStates> d = part(i).belief.mean - sum.mean;
      sum.covariance +=
          part(i).probability / total * (part(i).belief.covariance + d * d.transpose());
    }
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
  ModeMatrix<int, K> ways_out_;
  Scalar transition_step_s_ = Scalar(-1);
  std::array<Hypotheses, 2> buffers_;
  std::size_t now_ = 0;
  int count_ = 0;
  bool started_ = false;
};

}  // namespace wakeline
