// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "wakeline/core/angle.hpp"
#include "wakeline/gating/run_labels.hpp"
#include "wakeline/video/echo.hpp"

namespace wakeline::detail {

/// Joins the runs of consecutive sweeps into echoes and closes an echo when no later sweep can be
/// connected with it. Two cells belong to one echo when at most `gap_cells` cells and `gap_sweeps`
/// sweeps are between them.
///
/// Echoes are the sets of a union-find over the slots of a fixed pool; the runs of the last sweeps
/// hold the slot of their echo. An open echo has a run in one of these sweeps, so the number of
/// runs bounds the number of open echoes and the memory.
class OpenEchoes {
 public:
  struct Settings {
    int max_cells = 0;
    int gap_cells = 0;
    int gap_sweeps = 0;
    int max_sweeps = 0;
    bool closed_circle = false;
  };

  explicit OpenEchoes(const Settings& settings) : settings_(settings) {
    const std::size_t runs = (static_cast<std::size_t>(settings.max_cells) + 1) / 2;
    const auto depth = static_cast<std::size_t>(settings.gap_sweeps) + 1;
    recent_.resize(depth + 1);
    if (settings.closed_circle) heads_.resize(depth);
    for (Runs& sweep : recent_) sweep.reserve(runs + 1);
    for (Runs& sweep : heads_) sweep.reserve(runs + 1);
    earlier_.resize(depth);
    const std::size_t slots = runs * (recent_.size() + heads_.size());
    echoes_.resize(slots);
    set_.resize(slots);
    free_.reserve(slots);
    merged_.reserve(slots);
    clear();
  }

  // No copies: a copied vector lacks the reserved capacity.
  OpenEchoes(OpenEchoes&&) = default;
  OpenEchoes& operator=(OpenEchoes&&) = default;

  /// Largest possible number of open echoes.
  [[nodiscard]] std::size_t capacity() const noexcept { return echoes_.size(); }
  [[nodiscard]] std::size_t open() const noexcept { return echoes_.size() - free_.size(); }

  /// How many sweeps there have been since the first of the open echoes began, with that one; 0
  /// when there is none.
  [[nodiscard]] std::int64_t open_sweeps() const noexcept {
    std::int64_t most = 0;
    for (const Runs& sweep : recent_)
      for (const LabelledRun& run : sweep)
        most = std::max(most, count_ - echoes_[static_cast<std::size_t>(run.label)].first_sweep);
    return most;
  }

  /// Starts a sweep; `first` is true for one that follows missing sweeps.
  void begin_sweep(const BeamPlace& beam, bool first) noexcept {
    beam_ = beam;
    first_ = first;
    for (std::size_t k = 0; k < earlier_.size(); ++k) {
      earlier_[k] = EarlierRuns(sweep(k + 1));
    }
  }

  /// The beam passes north: azimuths restart at zero.
  void pass_north() noexcept {
    for (Echo& echo : echoes_) echo.began.azimuth_rad -= 2 * kPi<double>;
  }

  /// Adds a run of this sweep; runs are added in order of range, more than `gap_cells` apart.
  void add(const EchoRun& run, bool touches_last_cell) noexcept {
    int echo = connected_with(run);
    if (echo == kNone) echo = begin_echo();
    Echo& grown = slot(echo);
    grown.add(run, beam_);
    grown.last_sweep = count_;
    grown.touches_last_cell |= touches_last_cell;
    sweep(0).push_back({run.first, run.last, echo});
  }

  /// Ends the sweep: calls `close(echo)` for every echo that no later sweep can be connected with.
  template <class Close>
  void end_sweep(Close&& close) noexcept {
    resolve();
    keep_head();
    if (!settings_.closed_circle) cut_long_echoes(close);
    retire(close);
  }

  /// Processes a missing sweep as an empty one.
  template <class Close>
  void skip_sweep(Close&& close) noexcept {
    begin_sweep(beam_, false);
    end_sweep(close);
  }

  /// Called where sweeps are missing: closes all echoes except those that wait for the circle to be
  /// closed. The sweeps that follow are not part of the beginning of the circle.
  template <class Close>
  void interrupt(Close&& close) noexcept {
    count_ = std::max(count_, static_cast<std::int64_t>(heads_.size()));
    for (std::size_t k = 1; k < recent_.size(); ++k) {
      for (const LabelledRun& run : sweep(k)) {
        Echo& echo = slot(run.label);
        echo.cut = true;
        if (!echo.held) close_once(run.label, close);
      }
      sweep(k).clear();
    }
  }

  /// Closes all echoes. Those at the end of a closed circle are joined with those at its beginning.
  /// `missing` is the number of sweeps missing between end and beginning, or -1 when the circle is
  /// not complete.
  template <class Close>
  void finish(int missing, Close&& close) noexcept {
    if (settings_.closed_circle && missing >= 0) {
      join_circle(missing);
      resolve();
      for (std::size_t k = 1; k < recent_.size(); ++k) {
        for (const LabelledRun& run : sweep(k)) close_once(run.label, close);
        sweep(k).clear();
      }
    }
    interrupt(close);
    for (Runs& sweep : heads_) {
      for (const LabelledRun& run : sweep) {
        if (missing < 0) slot(run.label).cut = true;
        close_once(run.label, close);
      }
      sweep.clear();
    }
    clear();
  }

 private:
  static constexpr int kNone = -1;
  static constexpr std::int64_t kClosed = -1;

  using Runs = std::vector<LabelledRun>;

  [[nodiscard]] Echo& slot(int echo) noexcept { return echoes_[static_cast<std::size_t>(echo)]; }

  /// Runs of the sweep `back` sweeps ago.
  [[nodiscard]] Runs& sweep(std::size_t back) noexcept {
    const std::size_t place = newest_ + back;
    return recent_[place < recent_.size() ? place : place - recent_.size()];
  }

  void clear() noexcept {
    for (Runs& sweep : recent_) sweep.clear();
    for (Runs& sweep : heads_) sweep.clear();
    free_.clear();
    for (std::size_t k = echoes_.size(); k-- > 0;) free_.push_back(static_cast<int>(k));
    count_ = 0;
  }

  // Union-find ------------------------------------------------------------------------------------

  [[nodiscard]] int root(int echo) noexcept {
    return find_root(echo, [this](int label) -> int& { return set_[std::size_t(label)]; });
  }

  [[nodiscard]] int united(int echo, int other) noexcept {
    if (echo == kNone || echo == other) return other;
    slot(echo).add(slot(other));
    set_[static_cast<std::size_t>(other)] = echo;
    merged_.push_back(other);
    return echo;
  }

  /// Sets the label of every run to its root and frees the other slots.
  void resolve() noexcept {
    if (merged_.empty()) return;
    for (Runs& sweep : recent_)
      for (LabelledRun& run : sweep) run.label = root(run.label);
    for (Runs& sweep : heads_)
      for (LabelledRun& run : sweep) run.label = root(run.label);
    free_.insert(free_.end(), merged_.begin(), merged_.end());
    merged_.clear();
  }

  // One sweep -------------------------------------------------------------------------------------

  /// Joins all echoes of the last sweeps that a run is connected with into one and returns it.
  [[nodiscard]] int connected_with(const EchoRun& run) noexcept {
    int echo = kNone;
    for (EarlierRuns& runs : earlier_)
      runs.for_each_connected(run.first, run.last, settings_.gap_cells,
                              [&](int label) { echo = united(echo, root(label)); });
    return echo;
  }

  [[nodiscard]] int begin_echo() noexcept {
    const int echo = free_.back();
    free_.pop_back();
    set_[static_cast<std::size_t>(echo)] = echo;
    slot(echo) = Echo{.began = beam_, .first_sweep = count_, .cut = first_ && !closing()};
    return echo;
  }

  /// True in the first sweeps of a closed circle, which its end will be joined with.
  [[nodiscard]] bool closing() const noexcept {
    return count_ < static_cast<std::int64_t>(heads_.size());
  }

  void keep_head() noexcept {
    if (!closing()) return;
    Runs& head = heads_[static_cast<std::size_t>(count_)];
    head = sweep(0);
    for (const LabelledRun& run : head) slot(run.label).held = true;
  }

  template <class Close>
  void cut_long_echoes(Close&& close) noexcept {
    for (const LabelledRun& run : sweep(0)) {
      Echo& echo = slot(run.label);
      if (count_ - echo.first_sweep + 1 < settings_.max_sweeps) continue;
      echo.cut = true;
      close(std::as_const(echo));
      echo = Echo{.began = beam_, .first_sweep = count_ + 1, .last_sweep = count_, .cut = true};
    }
  }

  /// Drops the oldest sweep and closes the echoes that have no later run.
  template <class Close>
  void retire(Close&& close) noexcept {
    Runs& oldest = sweep(recent_.size() - 1);
    const std::int64_t age = count_ - static_cast<std::int64_t>(recent_.size()) + 1;
    for (const LabelledRun& run : oldest)
      if (slot(run.label).last_sweep == age && !slot(run.label).held) close_once(run.label, close);
    oldest.clear();
    newest_ = (newest_ == 0 ? recent_.size() : newest_) - 1;
    ++count_;
  }

  template <class Close>
  void close_once(int echo, Close&& close) noexcept {
    Echo& closed = slot(echo);
    if (closed.last_sweep == kClosed) return;
    if (closed.cells > 0) close(std::as_const(closed));
    closed.last_sweep = kClosed;
    free_.push_back(echo);
  }

  // The closed circle -----------------------------------------------------------------------------

  void join_circle(int missing) noexcept {
    for (std::size_t k = 1; k < recent_.size(); ++k)
      for (std::size_t h = 0; h < heads_.size(); ++h)
        if (k + h + static_cast<std::size_t>(missing) < recent_.size()) join(sweep(k), heads_[h]);
  }

  void join(const Runs& tail, const Runs& head) noexcept {
    EarlierRuns runs(tail);
    for (const LabelledRun& run : head)
      runs.for_each_connected(run.first, run.last, settings_.gap_cells,
                              [&](int label) { join(root(label), root(run.label)); });
  }

  /// Joins an echo at the end of the circle with one at its beginning, moved to one revolution
  /// later.
  void join(int tail, int head) noexcept {
    if (tail == head) return;
    if (!slot(head).turned) {
      slot(head).began.azimuth_rad += 2 * kPi<double>;
      slot(head).began.time_s = slot(tail).began.time_s;
    }
    (void)united(tail, head);
    slot(tail).turned = true;
  }

  Settings settings_;
  std::vector<Runs> recent_;  ///< ring of the runs of this sweep and of those it may connect with
  std::vector<Runs> heads_;   ///< runs of the first sweeps of a closed circle
  std::vector<EarlierRuns> earlier_;
  std::vector<Echo> echoes_;
  std::vector<int> set_;
  std::vector<int> free_;
  std::vector<int> merged_;
  std::size_t newest_ = 0;
  std::int64_t count_ = 0;  ///< sweeps before this one
  BeamPlace beam_;
  bool first_ = false;
};

}  // namespace wakeline::detail
