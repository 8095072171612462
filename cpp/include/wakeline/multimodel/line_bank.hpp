// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/simd/unroll.hpp"

namespace wakeline {

/// The least-squares line through the last plots of a target, extrapolated to the present.
///
/// Its errors are linear in those of the plots and in the acceleration that a line ignores, so both
/// are known in advance: per unit variance of the plots, per axis, and per m/s².
template <class Scalar = double>
struct Line {
  int plots = 0;
  Vec<Scalar, 2> position_m = Vec<Scalar, 2>::Zero();    ///< north and east, at present
  Vec<Scalar, 2> velocity_mps = Vec<Scalar, 2>::Zero();  ///< the slope

  Scalar position_factor = Scalar(0);  ///< variance of the position over that of a plot
  Scalar cross_factor = Scalar(0);     ///< covariance of position and velocity over it, 1/s
  Scalar velocity_factor = Scalar(0);  ///< variance of the velocity over it, 1/s²
  Mat<Scalar, 2, 2> plot_covariance_m2 =
      Mat<Scalar, 2, 2>::Zero();  ///< mean of the plot covariances

  /// Position (s²) and velocity (s) of the line minus those of a target with 1 m/s² since the
  /// oldest plot or longer.
  Vec<Scalar, 2> steady_lag = Vec<Scalar, 2>::Zero();
  /// The same with 1 m/s² since the last plot but one, which no earlier plot can show.
  Vec<Scalar, 2> onset_lag = Vec<Scalar, 2>::Zero();

  /// For the parabola through the same plots, three or more: its acceleration, m/s², and the
  /// variance of that relative to a plot's, 1/s⁴.
  Vec<Scalar, 2> acceleration_mps2 = Vec<Scalar, 2>::Zero();
  Scalar acceleration_factor = Scalar(0);
  Scalar onset_acceleration = Scalar(0);  ///< its response to an onset of 1 m/s²

  /// The parabola through the same plots, as a line at present: the line minus its lag, which is
  /// independent of it.
  [[nodiscard]] Line parabola() const noexcept {
    Line curved = *this;
    curved.position_m -= steady_lag[0] * acceleration_mps2;
    curved.velocity_mps -= steady_lag[1] * acceleration_mps2;
    curved.position_factor += steady_lag[0] * steady_lag[0] * acceleration_factor;
    curved.cross_factor += steady_lag[0] * steady_lag[1] * acceleration_factor;
    curved.velocity_factor += steady_lag[1] * steady_lag[1] * acceleration_factor;
    curved.onset_lag -= onset_acceleration * steady_lag;
    curved.steady_lag.setZero();
    return curved;
  }

  /// The line as a belief over `[x, vx, y, vy]`: the noise of its plots, and an acceleration of
  /// this standard deviation per axis since the last plot but one.
  [[nodiscard]] Gaussian<4, Scalar> belief(Scalar acceleration_std_mps2) const noexcept {
    Gaussian<4, Scalar> belief;
    belief.mean = mean();
    for_each_covariance(acceleration_std_mps2, [&](int row, int column, Scalar element) {
      belief.covariance(row, column) = belief.covariance(column, row) = element;
    });
    return belief;
  }

  /// Its mean.
  [[nodiscard]] Vec<Scalar, 4> mean() const noexcept {
    return {position_m[0], velocity_mps[0], position_m[1], velocity_mps[1]};
  }

  /// Calls `f(row, column, element)` for each element of the lower triangle of its covariance.
  template <class Function>
  void for_each_covariance(Scalar acceleration_std_mps2, const Function& function) const noexcept {
    const Scalar factor[3] = {position_factor, cross_factor, velocity_factor};
    const Scalar lag[2] = {acceleration_std_mps2 * onset_lag[0],
                           acceleration_std_mps2 * onset_lag[1]};
    unroll_lower<4>([&](auto row, auto column) {
      constexpr int kRowAxis = row.value / 2, kColumnAxis = column.value / 2;
      constexpr int kRow = row.value % 2, kColumn = column.value % 2;
      Scalar element = plot_covariance_m2(kRowAxis, kColumnAxis) * factor[kRow + kColumn];
      if constexpr (kRowAxis == kColumnAxis) element += lag[kRow] * lag[kColumn];
      function(row, column, element);
    });
  }

  /// Assigns another line through the same number of plots where the condition holds.
  friend void assign_where(const MaskOf<Scalar>& condition, Line& target,
                           const Line& value) noexcept {
    const auto take = [&](auto Line::*member) {
      if constexpr (requires { (target.*member).data(); })
        assign_where(condition, target.*member, value.*member);
      else
        target.*member = select(condition, value.*member, target.*member);
    };
    target.plots = value.plots;
    take(&Line::position_m);
    take(&Line::velocity_mps);
    take(&Line::position_factor);
    take(&Line::cross_factor);
    take(&Line::velocity_factor);
    take(&Line::plot_covariance_m2);
    take(&Line::steady_lag);
    take(&Line::onset_lag);
    take(&Line::acceleration_mps2);
    take(&Line::acceleration_factor);
    take(&Line::onset_acceleration);
  }
};

/// Stores the last plots of a target and computes the least-squares lines through the last n of
/// them for every n in one pass.
///
/// The pass goes from the newest plot to the oldest with running means, so that every line costs
/// the same few operations. Plots have their own times: steps may be irregular, and a missed scan
/// is a gap. A plot within a sixteenth of the last step after the newest (two unsynchronised
/// radars), or within a millisecond, is merged with it: both are replaced by their mean at the mean
/// of their times, because the line through two such plots has practically no information on the
/// velocity and may predict kilometres off. With a regular period T, before the next plot is added,
/// the position factor is 2(2n+1)/(n(n-1)) and the steady lag of the position -T²(n+1)(n+2)/12.
/// Storage is in place, no heap. Each lane of a pack has its own plots, times and number of plots.
template <int Capacity = 16, class ScalarType = double>
class LineBank {
 public:
  static_assert(Capacity >= 2, "wakeline: a line needs two plots");
  using Scalar = ScalarType;
  using Mask = MaskOf<Scalar>;
  static constexpr int kCapacity = Capacity;
  static constexpr double kSameTime_s = 1e-3;  ///< shorter than any radar's revisit time
  static constexpr double kSameStep =
      1.0 / 16;  ///< part of a step; larger than missed scans produce
  using Lines = std::array<Line<Scalar>, static_cast<std::size_t>(Capacity - 1)>;

  /// A stored plot.
  struct Plot {
    Vec<Scalar, 2> position_m = Vec<Scalar, 2>::Zero();
    Mat<Scalar, 2, 2> covariance_m2 = Mat<Scalar, 2, 2>::Zero();
    Scalar gap_s = Scalar(0);  ///< time since the plot before

    friend void assign_where(const Mask& condition, Plot& target, const Plot& value) noexcept {
      assign_where(condition, target.position_m, value.position_m);
      assign_where(condition, target.covariance_m2, value.covariance_m2);
      target.gap_s = select(condition, value.gap_s, target.gap_s);
    }
  };

  /// The state changed by `add` and by `advance` without an acceleration.
  struct Latest {
    Plot newest;
    Scalar size;
    Scalar elapsed_s;
    Mask entered = false;  ///< return value of `add`
  };

  /// Stores at most `max_plots`. Throws `std::invalid_argument` unless that is 2 to `Capacity`.
  explicit LineBank(int max_plots = Capacity) : max_plots_(max_plots) {
    require(max_plots >= 2 && max_plots <= Capacity, "max_plots",
            ("2 to " + std::to_string(Capacity)).c_str(), max_plots);
  }

  /// Removes all plots.
  void clear() noexcept { size_ = elapsed_s_ = Scalar(0); }

  /// Advances the time.
  void advance(Scalar dt_s) noexcept { elapsed_s_ += dt_s; }

  /// The same under a known acceleration, [north, east], constant during the step. The plots are
  /// moved as if the target always had its present velocity, so that the line is exact again.
  void advance(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    advance(dt_s);
    Scalar age = elapsed_s_;
    for (Plot& plot : remembered()) {
      plot.position_m += dt_s * (dt_s / Scalar(2) - age) * acceleration_mps2;
      age += plot.gap_s;
    }
  }

  /// Adds a plot of the present time in the given lanes; false where it was merged with the newest
  /// one.
  Mask add(const Gaussian<2, Scalar>& plot, const Mask& lanes = true) noexcept {
    const Mask joining = lanes && joins();
    if (any(joining)) join(plot, joining);
    const Mask enters = lanes && !joining;
    if (any(enters)) enter(plot, enters);
    return enters;
  }

  /// The state needed to undo the next `add` or `advance`.
  [[nodiscard]] Latest before_change() const noexcept { return {plots_[0], size_, elapsed_s_}; }
  [[nodiscard]] LineBank before_change(const Vec<Scalar, 2>&) const noexcept { return *this; }

  /// Undoes it in the given lanes.
  void take_back(const Mask& lanes, const Latest& before) noexcept {
    for (std::size_t k = 1; k < plots_.size(); ++k)
      assign_where(lanes && before.entered, plots_[k - 1], plots_[k]);
    assign_where(lanes, plots_[0], before.newest);
    size_ = select(lanes, before.size, size_);
    elapsed_s_ = select(lanes, before.elapsed_s, elapsed_s_);
  }
  void take_back(const Mask& lanes, const LineBank& before) noexcept {
    for (std::size_t k = 0; k < plots_.size(); ++k)
      assign_where(lanes, plots_[k], before.plots_[k]);
    size_ = select(lanes, before.size_, size_);
    elapsed_s_ = select(lanes, before.elapsed_s_, elapsed_s_);
  }

  /// Largest number of stored plots in any lane.
  [[nodiscard]] int size() const noexcept {
    return static_cast<int>(double(greatest_of_lanes(size_)));
  }
  /// True when at least this many plots are stored.
  [[nodiscard]] Mask holds(int plots) const noexcept { return size_ >= Scalar(plots); }
  /// True when a plot of the present time would be merged with the newest one.
  [[nodiscard]] Mask joins() const noexcept {
    const Scalar apart_s = at_least(Scalar(kSameStep) * plots_[0].gap_s, Scalar(kSameTime_s));
    return holds(1) && elapsed_s_ < apart_s;
  }
  [[nodiscard]] int max_plots() const noexcept { return max_plots_; }
  /// Number of lines: through the last 2, 3, ..., `size()` plots.
  [[nodiscard]] int lines() const noexcept { return std::max(size() - 1, 0); }
  /// Number of lines in each lane.
  [[nodiscard]] Scalar lines_of_lanes() const noexcept {
    return at_least(size_ - Scalar(1), Scalar(0));
  }
  /// Time since the newest plot.
  [[nodiscard]] Scalar elapsed_s() const noexcept { return elapsed_s_; }

  /// Computes the lines through the last 2, 3, ... plots at present into `lines[0 .. lines() - 1]`.
  /// In a lane without enough plots the line is zero.
  void fit(Lines& lines) const noexcept {
    const Vec<Scalar, 2> origin = plots_[0].position_m;  // small numbers avoid cancellation
    Sums sums;
    Scalar age = Scalar(0);
    for (const Plot& plot : remembered()) {
      sums.add(age, plot.position_m - origin, plot.covariance_m2);
      if (sums.plots > 1) {
        Line<Scalar>& line = lines[static_cast<std::size_t>(sums.plots - 2)];
        sums.draw(elapsed_s_, plots_[0].gap_s, line);
        line.position_m += origin;
        if (const Mask held = holds(sums.plots); !all(held))
          assign_where(!held, line, Line<Scalar>{sums.plots});
      }
      age += plot.gap_s;
    }
  }

  /// Saves or restores the plots; fails for a different length or invalid times.
  void archive(Archive& fields) {
    LineBank bank = *this;
    int size = bank.size();
    fields(bank.max_plots_);
    fields(size);
    fields(bank.elapsed_s_);
    bank.size_ = Scalar(size);
    bool sound = bank.max_plots_ == max_plots_ && size >= 0 && size <= max_plots_ &&
                 bank.elapsed_s_ >= Scalar(0);
    for (Plot& plot : std::span(bank.plots_).template first<Capacity>()) {
      fields(plot.position_m);
      fields(plot.covariance_m2);
      fields(plot.gap_s);
      sound = sound && plot.gap_s >= Scalar(0);
    }
    if (!sound) fields.fail();
    if (fields.loading() && fields.ok()) *this = bank;
  }

 private:
  /// Means and centred sums over plots of ages a (s before the newest) at positions p: what a line
  /// needs, independent of the time since then.
  struct Sums {
    int plots = 0;
    Scalar age = Scalar(0);
    Vec<Scalar, 2> place = Vec<Scalar, 2>::Zero();
    Mat<Scalar, 2, 2> covariance = Mat<Scalar, 2, 2>::Zero();
    Scalar bow = Scalar(0);  ///< mean of a²/2: the path under 1 m/s²
    Scalar age_age = Scalar(0);
    Vec<Scalar, 2> age_place = Vec<Scalar, 2>::Zero();
    Scalar age_bow = Scalar(0);
    Scalar bow_bow = Scalar(0);
    Vec<Scalar, 2> bow_place = Vec<Scalar, 2>::Zero();

    static Scalar one_over(int number) noexcept {
      return RealOf<Scalar>(1) / RealOf<Scalar>(number);
    }

    void add(Scalar a, const Vec<Scalar, 2>& p, const Mat<Scalar, 2, 2>& r) noexcept {
      const Scalar b = a * a / Scalar(2);
      const Scalar weight = one_over(++plots);
      const Scalar away = a - age;
      const Scalar older = away - weight * away;  // relative to the new mean
      age += weight * away;
      age_age += older * away;
      age_place += older * (p - place);
      age_bow += older * (b - bow);
      const Scalar higher = (Scalar(1) - weight) * (b - bow);
      bow_bow += higher * (b - bow);
      bow_place += higher * (p - place);
      place += weight * (p - place);
      bow += weight * (b - bow);
      covariance += weight * (r - covariance);
    }

    /// The line `elapsed` after the newest plot, which came `gap` after the one before it.
    void draw(Scalar elapsed, Scalar gap, Line<Scalar>& line) const noexcept {
      const Scalar share = one_over(plots);
      const Scalar inverse = reciprocal(age_age);
      const Scalar mean_age = elapsed + age;  // at present
      line.plots = plots;
      line.velocity_mps = -inverse * age_place;
      line.position_m = place + mean_age * line.velocity_mps;
      line.velocity_factor = inverse;
      line.cross_factor = mean_age * inverse;
      line.position_factor = share + mean_age * line.cross_factor;
      line.plot_covariance_m2 = covariance;
      const Scalar slope = -inverse * age_bow;
      const Scalar bend = bow + age * slope;  // of the line at the newest plot
      line.steady_lag = {bend + elapsed * (slope - elapsed / Scalar(2)), slope - elapsed};
      // With an acceleration since the second plot, only the newest one is affected.
      const Scalar second = elapsed + gap;
      const Scalar pull = age * inverse;  // influence of the newest plot on the slope
      const Scalar felt = gap * gap / Scalar(2);
      line.onset_lag = {(share + mean_age * pull) * felt - second * second / Scalar(2),
                        pull * felt - second};
      if (plots == 2) {
        line.acceleration_mps2.setZero();
        line.acceleration_factor = line.onset_acceleration = Scalar(0);
      } else {
        // With a very long gap the curvature of the other plots is lost in rounding.
        const Scalar lost = 16 * std::numeric_limits<RealOf<Scalar>>::epsilon() * bow_bow;
        line.acceleration_factor = reciprocal(at_least(bow_bow + slope * age_bow, lost));
        line.acceleration_mps2 = line.acceleration_factor * (bow_place + slope * age_place);
        line.onset_acceleration = -line.acceleration_factor * bend * felt;
      }
    }
  };

  /// Merges a plot with the newest one.
  void join(const Gaussian<2, Scalar>& plot, const Mask& lanes) noexcept {
    Plot& newest = plots_[0];
    const Scalar later_s = elapsed_s_ / Scalar(2);
    const Plot mean{(newest.position_m + plot.mean) / Scalar(2),
                    (newest.covariance_m2 + plot.covariance) / Scalar(4), newest.gap_s + later_s};
    assign_where(lanes, newest, mean);
    elapsed_s_ = select(lanes, later_s, elapsed_s_);
  }

  /// Shifts the plots by one. The one without room is kept behind the others, for an undo.
  void enter(const Gaussian<2, Scalar>& plot, const Mask& lanes) noexcept {
    for (int k = size(); k > 0; --k)
      assign_where(lanes, plots_[static_cast<std::size_t>(k)],
                   plots_[static_cast<std::size_t>(k - 1)]);
    assign_where(lanes, plots_[0], Plot{plot.mean, plot.covariance, elapsed_s_});
    size_ = select(lanes && !holds(max_plots_), size_ + Scalar(1), size_);
    elapsed_s_ = select(lanes, Scalar(0), elapsed_s_);
  }

  /// The plots of the fullest lane.
  [[nodiscard]] std::span<const Plot> remembered() const noexcept {
    return {plots_.data(), static_cast<std::size_t>(size())};
  }
  std::span<Plot> remembered() noexcept {
    return {plots_.data(), static_cast<std::size_t>(size())};
  }

  std::array<Plot, static_cast<std::size_t>(Capacity + 1)> plots_{};  ///< newest first
  int max_plots_;
  Scalar size_ = Scalar(0);       ///< number of plots stored in each lane
  Scalar elapsed_s_ = Scalar(0);  ///< since the newest plot
};

}  // namespace wakeline
