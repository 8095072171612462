// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// The least-squares line through the last plots of a target, as it stands at present.
///
/// Its errors are linear in those of the plots and in the acceleration that a line leaves out, so
/// that both are known beforehand: per unit variance of the plots, per axis, and per m/s².
template <class Scalar = double>
struct Line {
  int plots = 0;
  Vec<Scalar, 2> position_m = Vec<Scalar, 2>::Zero();    ///< north and east, at present
  Vec<Scalar, 2> velocity_mps = Vec<Scalar, 2>::Zero();  ///< the slope

  Scalar position_factor = Scalar(0);  ///< variance of the position over that of a plot
  Scalar cross_factor = Scalar(0);     ///< covariance of position and velocity over it, 1/s
  Scalar velocity_factor = Scalar(0);  ///< variance of the velocity over it, 1/s²
  Mat<Scalar, 2, 2> plot_covariance_m2 = Mat<Scalar, 2, 2>::Zero();  ///< mean of the plots'

  /// Position (s²) and velocity (s) of the line minus those of a target under 1 m/s² that lasts
  /// since the oldest plot or longer.
  Vec<Scalar, 2> steady_lag = Vec<Scalar, 2>::Zero();
  /// The same under 1 m/s² that began at the last plot but one: what no earlier plot can tell.
  Vec<Scalar, 2> onset_lag = Vec<Scalar, 2>::Zero();

  /// Of the parabola through the same plots, three or more: its acceleration, m/s², and the
  /// variance of that over a plot's, 1/s⁴.
  Vec<Scalar, 2> acceleration_mps2 = Vec<Scalar, 2>::Zero();
  Scalar acceleration_factor = Scalar(0);
  Scalar onset_acceleration = Scalar(0);  ///< that it sees of the onset's 1 m/s²

  /// The parabola through the same plots, as it stands at present, in place of the line: the line
  /// less what it lags behind, which is independent of it.
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
  /// this standard deviation per axis that began at the last plot but one.
  [[nodiscard]] Gaussian<4, Scalar> belief(Scalar acceleration_std_mps2) const noexcept {
    Gaussian<4, Scalar> belief;
    Mat<Scalar, 2, 2> factors;
    factors << position_factor, cross_factor, cross_factor, velocity_factor;
    const Vec<Scalar, 2> lag = acceleration_std_mps2 * onset_lag;
    for (int i = 0; i < 2; ++i) {
      belief.mean[2 * i] = position_m[i];
      belief.mean[2 * i + 1] = velocity_mps[i];
      for (int j = 0; j < 2; ++j)
        belief.covariance.template block<2, 2>(2 * i, 2 * j) = plot_covariance_m2(i, j) * factors;
      belief.covariance.template block<2, 2>(2 * i, 2 * i) += lag * lag.transpose();
    }
    mirror_lower<Scalar, 4>(belief.covariance);
    return belief;
  }
};

/// Memory of the last plots of a target, and the least-squares line through the last n of them for
/// every n, all in one pass.
///
/// The pass goes from the newest plot to the oldest with running means, so that every line costs
/// the same few operations. Plots count with the times they have: steps may be irregular, and a
/// missed scan is a gap. One that comes within `kSameTime_s` of the newest joins it: both become
/// their mean. With a regular period T, before the next plot is taken, the position factor is
/// 2(2n+1)/(n(n-1)) and the steady lag of the position -T²(n+1)(n+2)/12. Storage is in place, no
/// heap.
template <int Capacity = 16, class ScalarType = double>
class LineBank {
 public:
  static_assert(Capacity >= 2, "wakeline: a line needs two plots");
  using Scalar = ScalarType;
  static constexpr int kCapacity = Capacity;
  static constexpr double kSameTime_s = 1e-3;  ///< sooner than any radar looks again
  using Lines = std::array<Line<Scalar>, static_cast<std::size_t>(Capacity - 1)>;

  /// Remembers at most `max_plots`. Throws `std::invalid_argument` unless that is 2 to `Capacity`.
  explicit LineBank(int max_plots = Capacity) : max_plots_(max_plots) {
    require(max_plots >= 2 && max_plots <= Capacity, "max_plots",
            ("2 to " + std::to_string(Capacity)).c_str(), max_plots);
  }

  /// Forgets all plots.
  void clear() noexcept {
    size_ = 0;
    elapsed_s_ = Scalar(0);
  }

  /// Lets time pass.
  void advance(Scalar dt_s) noexcept { elapsed_s_ += dt_s; }

  /// The same under a known acceleration, [north, east], constant during the step. The plots move
  /// to where they would lie had the target always had the velocity that it has now, so that the
  /// line is exact again.
  void advance(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    advance(dt_s);
    Scalar age = elapsed_s_;
    for (int k = 0; k < size_; ++k) {
      latest(k).position_m += dt_s * (dt_s / 2 - age) * acceleration_mps2;
      age += latest(k).gap_s;
    }
  }

  /// Remembers a plot of the present time.
  void add(const Gaussian<2, Scalar>& plot) noexcept {
    if (size_ > 0 && elapsed_s_ < Scalar(kSameTime_s)) {
      Plot& newest = latest(0);
      newest.position_m = (newest.position_m + plot.mean) / 2;
      newest.covariance_m2 = (newest.covariance_m2 + plot.covariance) / 4;
      return;
    }
    newest_ = (newest_ + 1) % max_plots_;
    size_ = std::min(size_ + 1, max_plots_);
    latest(0) = {plot.mean, plot.covariance, elapsed_s_};
    elapsed_s_ = Scalar(0);
  }

  /// Plots that are remembered.
  [[nodiscard]] int size() const noexcept { return size_; }
  [[nodiscard]] int max_plots() const noexcept { return max_plots_; }
  /// Lines that there are: through the last 2, 3, ..., `size()` plots.
  [[nodiscard]] int lines() const noexcept { return std::max(size_ - 1, 0); }
  /// Time since the newest plot.
  [[nodiscard]] Scalar elapsed_s() const noexcept { return elapsed_s_; }

  /// Fills `lines[0 .. lines() - 1]` with the lines through the last 2, 3, ... plots at present.
  void fit(Lines& lines) const noexcept {
    if (size_ == 0) return;
    const Vec<Scalar, 2> origin = latest(0).position_m;  // small numbers: nothing cancels
    Sums sums;
    Scalar age = Scalar(0);
    for (int k = 0; k < size_; ++k) {
      const Plot& plot = latest(k);
      sums.add(age, plot.position_m - origin, plot.covariance_m2);
      if (k > 0) {
        Line<Scalar>& line = lines[static_cast<std::size_t>(k - 1)];
        line = sums.line(elapsed_s_, latest(0).gap_s);
        line.position_m += origin;
      }
      age += plot.gap_s;
    }
  }

  /// Saves or restores the plots; a memory of another length, or of times that cannot be, fails.
  void archive(Archive& fields) {
    LineBank bank = *this;
    fields(bank.max_plots_);
    fields(bank.size_);
    fields(bank.newest_);
    fields(bank.elapsed_s_);
    const auto within = [&](int k, int least, int most) { return k >= least && k <= most; };
    bool sound = bank.max_plots_ == max_plots_ && within(bank.size_, 0, max_plots_) &&
                 within(bank.newest_, 0, max_plots_ - 1) && bank.elapsed_s_ >= Scalar(0);
    for (Plot& plot : bank.plots_) {
      fields(plot.position_m);
      fields(plot.covariance_m2);
      fields(plot.gap_s);
      sound = sound && plot.gap_s >= Scalar(0);
    }
    if (!sound) fields.fail();
    if (fields.loading() && fields.ok()) *this = bank;
  }

 private:
  struct Plot {
    Vec<Scalar, 2> position_m = Vec<Scalar, 2>::Zero();
    Mat<Scalar, 2, 2> covariance_m2 = Mat<Scalar, 2, 2>::Zero();
    Scalar gap_s = Scalar(0);  ///< time since the plot before
  };

  /// Means and centred sums over plots of ages a (s before the newest) at places p: what a line
  /// needs, whatever the time since then.
  struct Sums {
    int plots = 0;
    Scalar age = Scalar(0);
    Vec<Scalar, 2> place = Vec<Scalar, 2>::Zero();
    Mat<Scalar, 2, 2> covariance = Mat<Scalar, 2, 2>::Zero();
    Scalar bow = Scalar(0);  ///< mean of a²/2: the track of 1 m/s²
    Scalar age_age = Scalar(0);
    Vec<Scalar, 2> age_place = Vec<Scalar, 2>::Zero();
    Scalar age_bow = Scalar(0);
    Scalar bow_bow = Scalar(0);
    Vec<Scalar, 2> bow_place = Vec<Scalar, 2>::Zero();

    void add(Scalar a, const Vec<Scalar, 2>& p, const Mat<Scalar, 2, 2>& r) noexcept {
      const Scalar b = a * a / 2;
      const Scalar weight = Scalar(1) / Scalar(++plots);
      const Scalar away = a - age;
      const Scalar older = away - weight * away;  // away from the new mean
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
    [[nodiscard]] Line<Scalar> line(Scalar elapsed, Scalar gap) const noexcept {
      const Scalar inverse = Scalar(1) / age_age;
      const Scalar mean_age = elapsed + age;  // at present
      Line<Scalar> line;
      line.plots = plots;
      line.velocity_mps = -inverse * age_place;
      line.position_m = place + mean_age * line.velocity_mps;
      line.velocity_factor = inverse;
      line.cross_factor = mean_age * inverse;
      line.position_factor = Scalar(1) / Scalar(plots) + mean_age * line.cross_factor;
      line.plot_covariance_m2 = covariance;
      const Scalar slope = -inverse * age_bow;
      const Scalar bend = bow + age * slope;  // of the line at the newest plot
      line.steady_lag = {bend + elapsed * (slope - elapsed / 2), slope - elapsed};
      // Of an acceleration since the second plot, the newest one alone has felt anything.
      const Scalar second = elapsed + gap;
      const Scalar pull = age * inverse;  // of the newest plot on the slope
      const Scalar felt = gap * gap / 2;
      line.onset_lag = {(Scalar(1) / Scalar(plots) + mean_age * pull) * felt - second * second / 2,
                        pull * felt - second};
      if (plots > 2) {
        // Beside a very long gap the bow of the other plots is lost in rounding.
        const Scalar lost = 16 * std::numeric_limits<Scalar>::epsilon() * bow_bow;
        line.acceleration_factor = Scalar(1) / std::max(bow_bow + slope * age_bow, lost);
        line.acceleration_mps2 = line.acceleration_factor * (bow_place + slope * age_place);
        line.onset_acceleration = -line.acceleration_factor * bend * felt;
      }
      return line;
    }
  };

  /// The k-th plot, counted back from the newest.
  [[nodiscard]] const Plot& latest(int k) const noexcept {
    const int slot = newest_ - k;
    return plots_[static_cast<std::size_t>(slot < 0 ? slot + max_plots_ : slot)];
  }
  Plot& latest(int k) noexcept { return const_cast<Plot&>(std::as_const(*this).latest(k)); }

  std::array<Plot, static_cast<std::size_t>(Capacity)> plots_{};
  int max_plots_;
  int size_ = 0;
  int newest_ = 0;
  Scalar elapsed_s_ = Scalar(0);  ///< since the newest plot
};

}  // namespace wakeline
