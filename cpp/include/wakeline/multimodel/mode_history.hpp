// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/in_place_array.hpp"
#include "wakeline/filter/belief.hpp"
#include "wakeline/multimodel/history_tree.hpp"
#include "wakeline/multimodel/hypothesis_clusters.hpp"
#include "wakeline/multimodel/hypothesis_rows.hpp"
#include "wakeline/multimodel/likeliest.hpp"
#include "wakeline/multimodel/mixture.hpp"
#include "wakeline/multimodel/turn_rate_grid.hpp"
#include "wakeline/multimodel/uniform_bank.hpp"
#include "wakeline/simd/flatten.hpp"

namespace wakeline {

/// A tree of mode histories: each hypothesis is a filter with its own sequence of modes; nothing is
/// mixed.
///
/// `predict` lets every hypothesis stay in its mode or, when its present segment is long enough,
/// switch to another one; the most probable switches within the capacity are followed. `update`
/// weights each hypothesis by its likelihood, merges similar ones of the same mode and keeps the
/// most probable. An Imm of the same modes mixes in every scan, which increases its covariance by
/// the spread of the mixture.
///
/// Where the turn rate is part of the state (`CoordinatedTurnRate`), a mode is a prior of it: a
/// hypothesis that switches to a mode with a different prior rate or standard deviation restarts
/// its rate from there. The target need not turn at the rates of a grid then.
///
/// Has the interface of `Imm`, over filters of one kind; storage is in place, no heap: at most
/// `Capacity` hypotheses, twice. In a missed scan the mode probabilities follow the chain, within
/// the capacity and except for segments that are too short to end.
///
/// Over filters of packs (`Ekf<CoordinatedTurn, Pack<double, kNativeLanes<double>>>`) the
/// hypotheses of a mode are processed in the lanes of one filter. The interface is that over scalar
/// filters, and the results are equal to rounding, which may decide which of equally probable
/// hypotheses are kept.
///
/// Source: G. A. Ackerson, K. S. Fu, IEEE Trans. AC-15, 1970 (the tree); J. K. Tugnait, Automatica
/// 18, 1982 (detection and estimation with it); D. J. Salmond, SPIE 1305, 1990 (merging around the
/// most probable).
template <class FilterType, int K = kRuntimeModes, int Capacity = 256>
class ModeHistory {
  static_assert(
      !requires(const FilterType& filter) { filter.memory(); },
      "wakeline: a hypothesis of a ModeHistory is only a belief; a filter with further state "
      "(an alpha-beta filter and its gain schedule) cannot be its model");

 public:
  using Filter = FilterType;
  using Lanes = typename Filter::Scalar;  ///< hypotheses side by side, or a single number
  using Scalar = RealOf<Lanes>;
  static constexpr int kModels = K;
  static constexpr auto kComponents = Filter::kComponents;
  static constexpr int kStates = Filter::kStates;
  using Bank = UniformBank<Filter, K>;
  using Probability = ModeVector<Scalar, K>;
  using BeliefType = StateBelief<kComponents, Scalar>;

  /// A sequence of modes up to now, and the belief given it.
  struct Hypothesis {
    BeliefType belief;
    Scalar probability = Scalar(0);
    Scalar segment_s = Scalar(0);  ///< time since it entered its mode
    std::uint64_t modes = 0;       ///< the last 16, four bits each, the present one lowest

    [[nodiscard]] int mode() const noexcept { return static_cast<int>(modes & 0xF); }
  };

  /// One mode of the chain for each filter of the bank. Throws `std::invalid_argument` when a
  /// parameter is invalid or the tree does not fit into `Capacity`.
  ModeHistory(const HistoryTree& tree, const ModeChain<K>& chain, const Bank& bank)
      : tree_(validated(tree)),
        chain_(chain),
        bank_(bank),
        initial_(Probability::Constant(bank.size(), Scalar(1) / Scalar(bank.size()))),
        probability_(initial_),
        transition_(ModeMatrix<Scalar, K>::Zero(bank.size(), bank.size())) {
    if (chain.modes() != bank.size())
      reject("a ModeHistory needs one mode of its chain for each filter, got " +
             std::to_string(chain.modes()) + " modes and " + std::to_string(bank.size()) +
             " filters");
    require(tree.max_branches <= Capacity, "max_branches",
            ("at most the capacity of " + std::to_string(Capacity)).c_str(), tree.max_branches);
    require(tree.max_hypotheses >= bank.size(), "max_hypotheses",
            ("at least the number of modes, " + std::to_string(bank.size())).c_str(),
            tree.max_hypotheses);
    for (int k = 1; k < bank.size(); ++k)
      require(same_prior_rate(0, k) || tree.pseudo_bayes_order != 1, "pseudo_bayes_order",
              "2 or more where each mode has its own prior turn rate, because order 1 keeps one "
              "belief for all",
              tree.pseudo_bayes_order);
  }

  /// With copies of `prototype` at the turn rates of a grid. If they estimate their rate, the
  /// straightest has a tenth of the prior standard deviation. The straightest starts with
  /// probability 0.9.
  ModeHistory(const HistoryTree& tree, const TurnRateGrid& grid_rad_s, const ModeChain<K>& chain,
              const Filter& prototype)
      : ModeHistory(tree, grid_rad_s, usual_deviations(grid_rad_s, prototype), chain, prototype) {}

  /// The same with a standard deviation for each rate (rad/s): nearly zero for rates at which
  /// vessels are known to turn, more for those between. Throws as above, and unless there is one
  /// for each rate, positive where filters estimate their rate.
  ModeHistory(const HistoryTree& tree, const TurnRateGrid& grid_rad_s,
              const TurnRateGrid::Rates& grid_std_rad_s, const ModeChain<K>& chain,
              const Filter& prototype)
      : ModeHistory(tree, chain, bank_about(grid_rad_s, grid_std_rad_s, prototype)) {
    const int modes = grid_rad_s.size();
    initial_.setConstant(Scalar(0.1 / (modes - 1)));
    initial_[grid_rad_s.straightest()] = Scalar(0.9);
    probability_ = initial_;
  }

  /// Default standard deviations of the rates of a grid.
  static TurnRateGrid::Rates usual_deviations(const TurnRateGrid& grid_rad_s,
                                              const Filter& prototype) {
    TurnRateGrid::Rates std_rad_s =
        TurnRateGrid::Rates::Constant(grid_rad_s.size(), turn_rate_std_rad_s(prototype));
    std_rad_s[grid_rad_s.straightest()] *= kStraightPart;
    return std_rad_s;
  }

  /// Sets the mode probabilities at a start. Throws unless they sum to 1.
  void set_initial_mode_probability(const Probability& probability) {
    require_distribution("initial_mode_probability", probability, bank_.size());
    initial_ = made_distribution(probability);
    if (!started_) probability_ = initial_;
  }

  /// Starts a hypothesis in every mode with the belief, over the state or over `[x, vx, y, vy]`. A
  /// belief over a state with turn rate gives every mode that rate. Where a filter rejects it,
  /// nothing changes.
  template <class StartType>
  Status start(const StartType& belief) noexcept {
    Leaves& next = spare();
    next.clear();
    for (int k = 0; k < bank_.size(); ++k) {
      Filter& filter = bank_.filter(k);
      if (const Status status = lane(filter.start(belief.template cast<Lanes>()), 0);
          status != Status::kOk)
        return status;
      Row& row = next.row_of(next.append(k));
      row.set_beliefs(filter.estimate());
      row.set_past(0, initial_[k], std::numeric_limits<Scalar>::infinity(),
                   static_cast<std::uint64_t>(k));
    }
    started_ = true;
    take();
    return Status::kOk;
  }

  /// Branches and predicts.
  Status predict(Scalar dt_s) noexcept { return branch_and_move(dt_s); }

  /// The same under a known acceleration, [north, east]; see `Control`.
  Status predict(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    return branch_and_move(dt_s, acceleration_mps2);
  }

  /// Updates every hypothesis with a reading, reweights, merges and prunes them. The innovation of
  /// the step is that of the moment-matched prediction, its log-likelihood that of the mixture. A
  /// hypothesis whose update fails is dropped; where all fail, nothing changes. A reading that is
  /// not `in_range` returns `kNotFinite`.
  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> update(const Sensor& sensor,
                                             const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    constexpr int kM = Sensor::kMeasurements;
    if (!started_) return failed_step<kM, Scalar>(Status::kNotStarted);
    Gaussian<kM, Lanes> reading = sensor.observe(z).template cast<Lanes>();
    reject_out_of_range(reading.mean);
    InPlaceArray<Correction<kM, Lanes>, Leaves::kMostRows> corrections;
    std::array<Lanes, Leaves::kMostRows> weights;
    const std::span<const Row> before = present().all();
    Leaves& next = spare();
    next.clear();
    for (std::size_t r = 0; r < before.size(); ++r) {
      ::new (corrections.place(r))
          Correction<kM, Lanes>(correct(sensor, reading, before[r], next.append_pasts(before[r])));
      weights[r] = load<Lanes>(before[r].probability.data());
    }
    const std::span<const Correction<kM, Lanes>> taken = corrections.first(before.size());
    const std::span<Lanes> weighed(weights.data(), before.size());
    Step<kM, Scalar> step = mixed_step<kM, Scalar>(taken, weighed);
    step.log_likelihood = reweigh<Leaves::kMostRows, Scalar>(
        weighed, [&](std::size_t r) { return taken[r].likelihood(); });
    if (step.log_likelihood == kImpossible<Scalar>)
      return failed_step<kM, Scalar>(first_failure_of_lanes(failure_of(taken)));
    for (std::size_t r = 0; r < weighed.size(); ++r)
      store(weights[r], next.all()[r].probability.data());
    now_ = 1 - now_;
    prune_and_normalise();
    return step;
  }

  /// The likelihood of a reading under all hypotheses, without an update.
  template <class Sensor>
  [[nodiscard]] Evidence<Scalar> evidence(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) const noexcept {
    Evidence<Lanes> evidence;
    const auto reading = sensor.observe(z).template cast<Lanes>();
    for (const Row& row : present().all()) {
      Filter filter = bank_.filter(row.mode);
      (void)filter.assign(row.beliefs());
      evidence.add(load<Lanes>(row.probability.data()), filter.compare(sensor, reading));
    }
    return {sum_to<Scalar>(evidence.likelihood), least_to<Scalar>(evidence.least_nis)};
  }

  /// Probabilistic data association, as in `Imm`: every hypothesis is updated with all readings
  /// that may be the target's.
  template <class Sensor>
  Scalar update(std::span<const Alternative<Sensor, Scalar>> readings, Scalar none,
                std::span<Scalar> share) noexcept {
    for (Scalar& part : share) part = Scalar(0);
    if (!started_) return Scalar(0);
    Leaves& next = spare();
    next.clear();
    Scalar total = Scalar(0);
    for (const Row& row : present().all()) {
      LaneBelief before;
      before = row.beliefs();
      Filter& filter = filter_of(row);
      const Lanes weight = load<Lanes>(row.probability.data());
      const Lanes posterior = weight * absorb(filter, before, readings, none, weight, share);
      total += sum_to<Scalar>(posterior);
      Row& after = next.append_pasts(row);
      after.set_beliefs(filter.estimate());
      store(posterior, after.probability.data());
    }
    if (!(total > Scalar(0)) || !std::isfinite(total)) {
      std::ranges::fill(share, Scalar(0));
      return Scalar(0);
    }
    for (Scalar& part : share) part /= total;
    for (Row& row : next.all())
      store(load<Lanes>(row.probability.data()) / Lanes(total), row.probability.data());
    now_ = 1 - now_;
    prune_and_normalise();
    return total;
  }

  /// Saves or restores the hypotheses; fails with different tree parameters.
  void archive(Archive& fields) {
    fields.rules(tree_);
    bool started = started_;
    int count = present().size();
    fields(started);
    fields(count);
    if (count < int(started) || count > tree_.max_branches ||
        (pooled() && started && count != bank_.size()))
      return fields.fail();
    auto next = hypotheses().begin();
    Leaves& loaded = spare();
    if (fields.loading()) loaded.clear();
    bool sound = true;
    int mode = 0;
    Scalar sum = Scalar(0);
    for (int i = 0; i < count; ++i) {
      Hypothesis hypothesis;
      if (!fields.loading()) hypothesis = *next++;
      fields(hypothesis.belief.mean);
      fields(hypothesis.belief.covariance);
      fields(hypothesis.probability);
      fields(hypothesis.segment_s);
      fields(hypothesis.modes);
      sound = sound && hypothesis.mode() >= mode && hypothesis.mode() < bank_.size() &&
              hypothesis.probability >= Scalar(0) && hypothesis.probability <= Scalar(1) &&
              (!pooled() || hypothesis.mode() == i);
      sum += hypothesis.probability;
      if (!sound || !fields.loading()) continue;
      mode = hypothesis.mode();
      const int place = loaded.append(mode);
      Row& row = loaded.row_of(place);
      row.set_belief(Leaves::lane_of(place), hypothesis.belief);
      row.set_past(Leaves::lane_of(place), hypothesis.probability, hypothesis.segment_s,
                   hypothesis.modes);
    }
    if (!sound || (started && !(sum > Scalar(0)))) fields.fail();
    if (!fields.loading() || !fields.ok()) return;
    started_ = started;
    now_ = 1 - now_;
    weigh_modes();
  }

  /// The moment-matched estimate.
  [[nodiscard]] BeliefType estimate() const noexcept {
    BeliefType joint;
    Vec<Lanes, kStates> mean = Vec<Lanes, kStates>::Zero();
    for (const Row& row : present().all()) {
      const Lanes probability = load<Lanes>(row.probability.data());
      unroll<kStates>([&](int i) { mean[i] += probability * row.mean_lanes(i); });
    }
    unroll<kStates>([&](int i) { joint.mean[i] = sum_to<Scalar>(mean[i]); });
    Mat<Lanes, kStates, kStates> covariance = Mat<Lanes, kStates, kStates>::Zero();
    for (const Row& row : present().all()) {
      const Lanes probability = load<Lanes>(row.probability.data());
      Vec<Lanes, kStates> d;
      unroll<kStates>([&](int i) { d[i] = row.mean_lanes(i) - Lanes(joint.mean[i]); });
      unroll_lower<kStates>([&](int i, int j) {
        covariance(i, j) += probability * (row.covariance_lanes(i, j) + d[i] * d[j]);
      });
    }
    unroll_lower<kStates>([&](int i, int j) {
      joint.covariance(i, j) = joint.covariance(j, i) = sum_to<Scalar>(covariance(i, j));
    });
    return joint;
  }

  [[nodiscard]] const Probability& mode_probability() const noexcept { return probability_; }
  [[nodiscard]] const Probability& initial_mode_probability() const noexcept { return initial_; }
  [[nodiscard]] const HistoryTree& tree() const noexcept { return tree_; }
  [[nodiscard]] const ModeChain<K>& chain() const noexcept { return chain_; }
  [[nodiscard]] const Bank& bank() const noexcept { return bank_; }
  [[nodiscard]] bool started() const noexcept { return started_; }

  /// The present hypotheses by mode, as a range.
  [[nodiscard]] auto hypotheses() const noexcept { return Hypotheses{present()}; }

 private:
  static constexpr std::size_t kCapacity = static_cast<std::size_t>(Capacity);
  static_assert(kMaxModes <= 16, "a mode has four bits of a history");
  static constexpr double kStraightPart = 0.1;
  static constexpr int kTurnRateRow = index_of(kComponents, Component::kTurnRate);  ///< or -1
  using LaneBelief = StateBelief<kComponents, Lanes>;
  using Leaves = HypothesisRows<kStates, Lanes, Capacity, kModeCapacity<K>>;
  using Row = typename Leaves::Row;

  /// The hypotheses of several rows, one by one.
  class Hypotheses {
   public:
    /// Over the hypotheses in use.
    class Iterator {
     public:
      using iterator_concept = std::forward_iterator_tag;
      using iterator_category = std::input_iterator_tag;
      using value_type = Hypothesis;
      using difference_type = std::ptrdiff_t;

      Iterator() = default;
      explicit Iterator(const Row* row) noexcept : row_(row) {}

      Hypothesis operator*() const noexcept {
        const auto k = static_cast<std::size_t>(lane_);
        Hypothesis one;
        one.belief = row_->belief(lane_);
        one.probability = row_->probability[k];
        one.segment_s = row_->segment_s[k];
        one.modes = row_->modes[k];
        return one;
      }
      Iterator& operator++() noexcept {
        if (++lane_ == row_->count) {
          ++row_;
          lane_ = 0;
        }
        return *this;
      }
      Iterator operator++(int) noexcept {
        const Iterator before = *this;
        ++*this;
        return before;
      }
      bool operator==(const Iterator&) const = default;

     private:
      const Row* row_ = nullptr;
      int lane_ = 0;
    };

    explicit Hypotheses(const Leaves& leaves) noexcept : leaves_(leaves) {}

    [[nodiscard]] std::size_t size() const noexcept {
      return static_cast<std::size_t>(leaves_.size());
    }
    [[nodiscard]] Iterator begin() const noexcept { return Iterator(leaves_.all().data()); }
    [[nodiscard]] Iterator end() const noexcept {
      return Iterator(leaves_.all().data() + leaves_.all().size());
    }

   private:
    const Leaves& leaves_;
  };

  /// The filter of its mode, with the beliefs of a row.
  Filter& filter_of(const Row& row) noexcept {
    Filter& filter = bank_.filter(row.mode);
    (void)filter.assign(row.beliefs());
    return filter;
  }

  /// Updates the beliefs of a row and writes them to another.
  template <class Sensor, int M>
  WAKELINE_FLATTEN Correction<M, Lanes> correct(const Sensor& sensor,
                                                const Gaussian<M, Lanes>& reading,
                                                const Row& before, Row& after) noexcept {
    Filter& filter = filter_of(before);
    const Correction<M, Lanes> correction =
        with_model(sensor, [&](const auto& model) { return filter.correct(model, reading); });
    after.set_beliefs(filter.estimate());
    return correction;
  }

  /// Predicts all hypotheses. After a failure of any none may be used.
  template <class... Known>
  WAKELINE_FLATTEN Status move(Leaves& leaves, Scalar dt_s,
                               const Known&... acceleration_mps2) noexcept {
    for (Row& row : leaves.all()) {
      Filter& filter = bank_.filter(row.mode);
      const Status status = first_failure_of_lanes(predict_from(
          filter, row.beliefs(), Lanes(dt_s), acceleration_mps2.template cast<Lanes>()...));
      if (status != Status::kOk) return status;
      row.set_beliefs(filter.estimate());
    }
    return Status::kOk;
  }

  /// A switch of the hypothesis at a place to another mode.
  struct Switch {
    Scalar probability;
    int from;
    int mode;
    int to = 0;     ///< its place after the switch
    int next = -1;  ///< index of the next switch to that mode, or -1
  };

  template <class... Known>
  Status branch_and_move(Scalar dt_s, const Known&... acceleration_mps2) noexcept {
    if (!started_) return Status::kNotStarted;
    if (const Status status = check_time_step(dt_s); status != Status::kOk) return status;
    if (!pooled() && present().size() > tree_.max_hypotheses) {  // the last scan was missed
      spare() = present();  // predicted first: if that fails, nothing is merged
      if (const Status status = move(spare(), dt_s, acceleration_mps2...); status != Status::kOk)
        return status;
      reduce();
    }
    if (dt_s != transition_step_s_) prepare(dt_s);
    std::array<Switch, kCapacity> room;
    const std::span<Switch> switches = likeliest_switches(dt_s, room);
    Leaves& next = spare();
    branch(switches, dt_s, next);
    if (const Status status = move(next, dt_s, acceleration_mps2...); status != Status::kOk)
      return status;
    for (const Switch& change : switches) spread(change, next);
    take();
    return Status::kOk;
  }

  /// Every hypothesis stays, and those that switch also do that. Beliefs are those before the scan.
  void branch(std::span<Switch> switches, Scalar dt_s, Leaves& next) const noexcept {
    std::array<int, static_cast<std::size_t>(kModeCapacity<K>)> first;  // into each mode
    first.fill(-1);
    for (int s = static_cast<int>(switches.size()) - 1; s >= 0; --s)
      at(switches, s).next = std::exchange(at(first, at(switches, s).mode), s);
    BeliefType pool;
    if (pooled()) pool = estimate();
    next.clear();
    for (int mode = 0; mode < bank_.size(); ++mode) {
      for (const Row& row : present().of_mode(mode)) {
        Row& stays = next.append_pasts(row);
        if (pooled()) {
          stays.set_belief(0, pool);
          stays.probability[0] = arriving(mode);
        } else {
          stays.copy_beliefs(row);
          stay(stays, dt_s);
        }
      }
      for (int s = at(first, mode); s >= 0; s = at(switches, s).next)
        at(switches, s).to = follow(at(switches, s), next);
    }
    for (Row& row : next.all()) age_segments(row, dt_s);
  }

  /// The most probable switches within the capacity.
  std::span<Switch> likeliest_switches(Scalar dt_s,
                                       std::array<Switch, kCapacity>& room) const noexcept {
    if (pooled() || present().size() >= tree_.max_branches) return {};
    const auto left = static_cast<std::size_t>(tree_.max_branches - present().size());
    Likeliest<Switch> likeliest(std::span<Switch>(room).first(left));
    std::array<Lanes, Leaves::kMostRows> leaving;  // probabilities of leaving
    const std::span<const Row> rows = present().all();
    for (std::size_t r = 0; r < rows.size(); ++r) {
      leaving[r] =
          select(may_switch(rows[r], dt_s), load<Lanes>(rows[r].probability.data()), Lanes(0));
      for (const Exit& exit : exits(rows[r].mode)) {
        const Lanes probability = leaving[r] * Lanes(exit.probability);
        for (int k = 0; k < rows[r].count; ++k)
          likeliest.count(lane(probability, k), std::popcount(exit.modes));
      }
    }
    likeliest.cut();
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (const Exit& exit : exits(rows[r].mode)) {
        const Lanes probability = leaving[r] * Lanes(exit.probability);
        const auto likely = probability >= Lanes(likeliest.least()) && probability > Lanes(0);
        for_each_bit(bits_of(likely), [&](int k) {
          for_each_bit(exit.modes, [&](int to) {
            likeliest.add({lane(probability, k), static_cast<int>(r) * Leaves::kLanes + k, to});
          });
        });
      }
    return likeliest.items();
  }

  /// The hypotheses of a row stay in their mode.
  void stay(Row& row, Scalar dt_s) const noexcept {
    const Lanes probability = load<Lanes>(row.probability.data());
    store(select(may_switch(row, dt_s), probability * Lanes(transition_(row.mode, row.mode)),
                 probability),
          row.probability.data());
  }

  /// Follows a switch. Returns the new place.
  int follow(const Switch& change, Leaves& next) const noexcept {
    const Row& before = present().row_of(change.from);
    const auto lane_before = static_cast<std::size_t>(Leaves::lane_of(change.from));
    Gaussian<kStates, Scalar> belief = before.belief(Leaves::lane_of(change.from));
    if constexpr (kTurnRateRow >= 0)
      if (!same_prior_rate(before.mode, change.mode)) forget_turn_rate(belief, change.mode);
    const int place = next.append(change.mode);
    Row& row = next.row_of(place);
    row.set_belief(Leaves::lane_of(place), belief);
    row.set_past(Leaves::lane_of(place), change.probability, Scalar(0), before.modes[lane_before]);
    return place;
  }

  /// One more scan in the same mode.
  static void age_segments(Row& row, Scalar dt_s) noexcept {
    store(load<Lanes>(row.segment_s.data()) + Lanes(dt_s), row.segment_s.data());
    for (std::uint64_t& modes : row.modes)
      modes = modes << 4 | static_cast<std::uint64_t>(row.mode);
  }

  /// Caches the chain's transition over one step and the exits of each mode.
  void prepare(Scalar dt_s) noexcept {
    transition_ = chain_.transition(double(dt_s)).template cast<Scalar>();
    transition_step_s_ = dt_s;
    for (int from = 0; from < bank_.size(); ++from) {
      Exits& exits = at(exits_, from);
      exits.count = 0;
      for (int to = 0; to < bank_.size(); ++to) {
        if (to == from) continue;
        std::size_t k = 0;
        while (k < exits.count && exits.exit[k].probability != transition_(from, to)) ++k;
        if (k == exits.count) exits.exit[exits.count++] = {transition_(from, to), 0};
        exits.exit[k].modes |= 1u << to;
      }
    }
  }

  /// Modes to which a mode is left with the same probability, a bit each.
  struct Exit {
    Scalar probability;
    unsigned modes;
  };
  struct Exits {
    std::array<Exit, static_cast<std::size_t>(kModeCapacity<K>)> exit;
    std::size_t count = 0;
  };
  [[nodiscard]] std::span<const Exit> exits(int mode) const noexcept {
    return std::span(at(exits_, mode).exit).first(at(exits_, mode).count);
  }

  /// True for the first-order pseudo-Bayes estimator, which has one belief for all modes.
  [[nodiscard]] bool pooled() const noexcept { return tree_.pseudo_bayes_order == 1; }

  /// Probability of a mode predicted by the chain.
  [[nodiscard]] Scalar arriving(int mode) const noexcept {
    Scalar sum = Scalar(0);
    for (int before = 0; before < bank_.size(); ++before)
      sum += probability_[before] * transition_(before, mode);
    return sum;
  }

  /// True where the present segment is long enough, to the nearest scan.
  [[nodiscard]] MaskOf<Lanes> may_switch(const Row& row, Scalar dt_s) const noexcept {
    return Lanes(Scalar(tree_.min_segment_s <= 0.0 ? 1 : 0)) > Lanes(0) ||
           load<Lanes>(row.segment_s.data()) + Lanes(dt_s / 2) > Lanes(Scalar(tree_.min_segment_s));
  }

  static Bank bank_about(const TurnRateGrid& grid_rad_s, const TurnRateGrid::Rates& grid_std_rad_s,
                         const Filter& prototype) {
    grid_rad_s.require_for_each("grid_std_rad_s", grid_std_rad_s.size());
    if constexpr (kLearnsTurnRate<Filter>)
      for (const double std_rad_s : grid_std_rad_s)
        require_positive("every deviation of grid_std_rad_s", std_rad_s);
    Bank bank(prototype, grid_rad_s.size());
    for (int k = 0; k < bank.size(); ++k)
      expect_turn_rate(bank.filter(k), grid_rad_s[k], grid_std_rad_s[k]);
    return bank;
  }

  /// True when two modes have the same prior of an unknown turn rate.
  [[nodiscard]] bool same_prior_rate(int a, int b) const noexcept {
    if constexpr (kTurnRateRow < 0) return true;
    const auto& one = bank_.filter(a).motion();
    const auto& other = bank_.filter(b).motion();
    constexpr auto kRate = Component::kTurnRate;
    return prior_mean(one, kRate) == prior_mean(other, kRate) &&
           prior_variance(one, kRate) == prior_variance(other, kRate);
  }

  /// Resets the turn rate to the mode's prior.
  void forget_turn_rate(Gaussian<kStates, Scalar>& belief, int mode) const noexcept {
    const auto& motion = bank_.filter(mode).motion();
    belief.mean[kTurnRateRow] = Scalar(prior_mean(motion, Component::kTurnRate));
    belief.covariance.row(kTurnRateRow).setZero();
    belief.covariance.col(kTurnRateRow).setZero();
    belief.covariance(kTurnRateRow, kTurnRateRow) =
        Scalar(prior_variance(motion, Component::kTurnRate));
  }

  /// The switch may have occurred later in the scan: adds a part of u d, d the difference from the
  /// mean without the switch, u uniform over one scan with variance 1/12. The turn rate is that of
  /// the mode whenever the switch occurred.
  void spread(const Switch& change, Leaves& next) const noexcept {
    const int mode = present().row_of(change.from).mode;
    const int stayed = change.from + Leaves::kLanes * (next.begin(mode) - present().begin(mode));
    const Row& without = next.row_of(stayed);
    const auto lane_without = static_cast<std::size_t>(Leaves::lane_of(stayed));
    Row& row = next.row_of(change.to);
    const auto of_lane = static_cast<std::size_t>(Leaves::lane_of(change.to));
    Vec<Scalar, kStates> d;
    unroll<kStates>([&](auto i) {
      constexpr auto k = static_cast<std::size_t>(i.value);
      d[i] = i == kTurnRateRow ? Scalar(0) : row.mean[k][of_lane] - without.mean[k][lane_without];
    });
    const Scalar variance = Scalar(tree_.switch_time_spread / 12.0);
    unroll_lower<kStates>(
        [&](int i, int j) { row.of_covariance(i, j)[of_lane] += variance * (d[i] * d[j]); });
  }

  /// After an update: prunes the tree and normalises the probabilities.
  void prune_and_normalise() noexcept {
    if (pooled())
      normalise();
    else
      reduce();
  }

  /// Merges similar hypotheses of each mode, then keeps the most probable.
  void reduce() noexcept {
    HypothesisClusters clusters(present(), tree_);
    spare().clear();
    for (int mode = 0; mode < bank_.size(); ++mode) clusters.append_joined(mode, spare());
    now_ = 1 - now_;
    if (present().size() > tree_.max_hypotheses) {
      copy_likeliest(present(), tree_.max_hypotheses, spare());
      now_ = 1 - now_;
    }
    normalise();
  }

  /// Swaps spare and present hypotheses.
  void take() noexcept {
    now_ = 1 - now_;
    normalise();
  }

  /// Normalises the probabilities.
  void normalise() noexcept {
    Lanes sum = Lanes(0);
    for (const Row& row : present().all()) sum += load<Lanes>(row.probability.data());
    const Scalar total = sum_of_lanes(sum);
    const Lanes scale = reciprocal(total);
    for (Row& row : present().all()) {
      const Lanes probability = load<Lanes>(row.probability.data());
      store(part_of(probability, Lanes(total), scale), row.probability.data());
    }
    weigh_modes();
  }

  void weigh_modes() noexcept {
    for (int mode = 0; mode < bank_.size(); ++mode) {
      Lanes sum = Lanes(0);
      for (const Row& row : present().of_mode(mode)) sum += load<Lanes>(row.probability.data());
      probability_[mode] = sum_of_lanes(sum);
    }
  }

  template <class Array>
  static auto& at(Array& array, int i) noexcept {
    return array[static_cast<std::size_t>(i)];
  }
  Leaves& present() noexcept { return buffers_[now_]; }
  [[nodiscard]] const Leaves& present() const noexcept { return buffers_[now_]; }
  Leaves& spare() noexcept { return buffers_[1 - now_]; }

  HistoryTree tree_;
  ModeChain<K> chain_;
  Bank bank_;  ///< the filter of each mode; its belief is scratch
  Probability initial_;
  Probability probability_;
  ModeMatrix<Scalar, K> transition_;
  Scalar transition_step_s_ = Scalar(-1);
  std::array<Exits, static_cast<std::size_t>(kModeCapacity<K>)> exits_;
  std::array<Leaves, 2> buffers_;
  std::size_t now_ = 0;
  bool started_ = false;
};

}  // namespace wakeline
