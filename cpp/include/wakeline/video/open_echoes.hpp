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
#include "wakeline/video/echo.hpp"

namespace wakeline::detail {

/// Connects the runs of sweep after sweep into echoes, and closes those that no sweep touches any
/// more. Two cells are of one echo when at most `gap_cells` cells and `gap_sweeps` sweeps lie
/// between them.
///
/// Echoes are sets of a union-find whose members are the slots of a fixed pool; the runs of the
/// last sweeps say which echo they are of. An open echo has a run in one of them, so their number
/// is bounded by that of runs, and with it the memory.
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
    cursor_.resize(depth);
    const std::size_t slots = runs * (recent_.size() + heads_.size());
    echoes_.resize(slots);
    set_.resize(slots);
    free_.reserve(slots);
    merged_.reserve(slots);
    clear();
  }

  // A copy of a vector has not the room that was reserved.
  OpenEchoes(OpenEchoes&&) = default;
  OpenEchoes& operator=(OpenEchoes&&) = default;

  /// Never more echoes than this are open.
  [[nodiscard]] std::size_t capacity() const noexcept { return echoes_.size(); }
  [[nodiscard]] std::size_t open() const noexcept { return echoes_.size() - free_.size(); }

  /// The beam moves on to another sweep; `first` after sweeps that are missing.
  void begin_sweep(const BeamPlace& beam, bool first) noexcept {
    beam_ = beam;
    first_ = first;
    for (std::size_t k = 0; k < cursor_.size(); ++k) {
      const Runs& before = sweep(k + 1);
      cursor_[k] = {before.data(), before.data() + before.size()};
    }
  }

  /// The beam has passed north: azimuths begin anew.
  void pass_north() noexcept {
    for (Echo& echo : echoes_) echo.began.azimuth_rad -= 2 * kPi<double>;
  }

  /// A run of this sweep; runs come by range, more than `gap_cells` apart.
  void add(const EchoRun& run, bool touches_last_cell) noexcept {
    int echo = touched_by(run);
    if (echo == kNone) echo = begin_echo();
    Echo& grown = slot(echo);
    grown.add(run, beam_);
    grown.last_sweep = count_;
    grown.touches_last_cell |= touches_last_cell;
    sweep(0).push_back({run.first, run.last, echo});
  }

  /// Closes what the sweep has left behind: calls `close(echo)`.
  template <class Close>
  void end_sweep(Close&& close) noexcept {
    resolve();
    keep_head();
    if (!settings_.closed_circle) cut_long_echoes(close);
    retire(close);
  }

  /// Lets a missing sweep pass as an empty one.
  template <class Close>
  void skip_sweep(Close&& close) noexcept {
    begin_sweep(beam_, false);
    end_sweep(close);
  }

  /// Sweeps are missing: closes all echoes but those that wait for the circle to be closed. What
  /// follows is no longer its beginning.
  template <class Close>
  void interrupt(Close&& close) noexcept {
    count_ = std::max(count_, static_cast<std::int64_t>(heads_.size()));
    for (std::size_t k = 1; k < recent_.size(); ++k) {
      for (const Run& run : sweep(k)) {
        Echo& echo = slot(run.echo);
        echo.cut = true;
        if (!echo.held) close_once(run.echo, close);
      }
      sweep(k).clear();
    }
  }

  /// Closes all echoes. Those at the end of a closed circle are joined with those at its beginning
  /// when at most `missing` sweeps are missing between; -1 when it is not complete.
  template <class Close>
  void finish(int missing, Close&& close) noexcept {
    if (settings_.closed_circle && missing >= 0) {
      join_circle(missing);
      resolve();
      for (std::size_t k = 1; k < recent_.size(); ++k) {
        for (const Run& run : sweep(k)) close_once(run.echo, close);
        sweep(k).clear();
      }
    }
    interrupt(close);
    for (Runs& sweep : heads_) {
      for (const Run& run : sweep) {
        if (missing < 0) slot(run.echo).cut = true;
        close_once(run.echo, close);
      }
      sweep.clear();
    }
    clear();
  }

 private:
  static constexpr int kNone = -1;
  static constexpr std::int64_t kClosed = -1;

  struct Run {
    int first;
    int last;
    int echo;
  };
  using Runs = std::vector<Run>;

  /// How far the runs of an earlier sweep have been looked at.
  struct Cursor {
    const Run* at;
    const Run* end;
  };

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
    while (true) {
      int& set = set_[static_cast<std::size_t>(echo)];
      if (set == echo) return echo;
      set = set_[static_cast<std::size_t>(set)];
      echo = set;
    }
  }

  [[nodiscard]] int united(int echo, int other) noexcept {
    if (echo == kNone || echo == other) return other;
    slot(echo).add(slot(other));
    set_[static_cast<std::size_t>(other)] = echo;
    merged_.push_back(other);
    return echo;
  }

  /// Makes all runs point to their sets' roots, and the other slots free.
  void resolve() noexcept {
    if (merged_.empty()) return;
    for (Runs& sweep : recent_)
      for (Run& run : sweep) run.echo = root(run.echo);
    for (Runs& sweep : heads_)
      for (Run& run : sweep) run.echo = root(run.echo);
    free_.insert(free_.end(), merged_.begin(), merged_.end());
    merged_.clear();
  }

  // One sweep -------------------------------------------------------------------------------------

  /// The echo of the recent runs that a run touches: one, whatever they were before.
  [[nodiscard]] int touched_by(const EchoRun& run) noexcept {
    const int reach = settings_.gap_cells + 1;
    int echo = kNone;
    for (Cursor& before : cursor_) {
      const Run*& at = before.at;
      while (at != before.end && at->last + reach < run.first) ++at;
      for (const Run* near = at; near != before.end && near->first - reach <= run.last; ++near)
        echo = united(echo, root(near->echo));
    }
    return echo;
  }

  [[nodiscard]] int begin_echo() noexcept {
    const int echo = free_.back();
    free_.pop_back();
    set_[static_cast<std::size_t>(echo)] = echo;
    slot(echo) = Echo{.began = beam_, .first_sweep = count_, .cut = first_ && !closing()};
    return echo;
  }

  /// True while the sweeps are those that the end of a closed circle will be joined with.
  [[nodiscard]] bool closing() const noexcept {
    return count_ < static_cast<std::int64_t>(heads_.size());
  }

  void keep_head() noexcept {
    if (!closing()) return;
    Runs& head = heads_[static_cast<std::size_t>(count_)];
    head = sweep(0);
    for (const Run& run : head) slot(run.echo).held = true;
  }

  template <class Close>
  void cut_long_echoes(Close&& close) noexcept {
    for (const Run& run : sweep(0)) {
      Echo& echo = slot(run.echo);
      if (count_ - echo.first_sweep + 1 < settings_.max_sweeps) continue;
      echo.cut = true;
      close(std::as_const(echo));
      echo = Echo{.began = beam_, .first_sweep = count_ + 1, .last_sweep = count_, .cut = true};
    }
  }

  /// The oldest sweep is forgotten; an echo that nothing later has touched is over.
  template <class Close>
  void retire(Close&& close) noexcept {
    Runs& oldest = sweep(recent_.size() - 1);
    const std::int64_t age = count_ - static_cast<std::int64_t>(recent_.size()) + 1;
    for (const Run& run : oldest)
      if (slot(run.echo).last_sweep == age && !slot(run.echo).held) close_once(run.echo, close);
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
    const int reach = settings_.gap_cells + 1;
    const Run* at = tail.data();
    const Run* const end = at + tail.size();
    for (const Run& run : head) {
      while (at != end && at->last + reach < run.first) ++at;
      for (const Run* near = at; near != end && near->first - reach <= run.last; ++near)
        join(root(near->echo), root(run.echo));
    }
  }

  /// Joins an echo at the end of the circle with one at the beginning, as if seen a turn later.
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
  std::vector<Runs> recent_;  ///< a ring: the runs of this sweep and of those that it may touch
  std::vector<Runs> heads_;   ///< those of the first sweeps of a circle
  std::vector<Cursor> cursor_;
  std::vector<Echo> echoes_;
  std::vector<int> set_;
  std::vector<int> free_;
  std::vector<int> merged_;
  std::size_t newest_ = 0;
  std::int64_t count_ = 0;  ///< of sweeps before this one
  BeamPlace beam_;
  bool first_ = false;
};

}  // namespace wakeline::detail
