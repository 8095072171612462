// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The constant errors of a radar, from vessels whose positions are known by their reports.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/track/radar.hpp"

namespace wakeline {

/// Parameters of `Calibration`.
struct CalibrationConfig {
  double range_gate_m = 400.0;
  double bearing_gate_rad = deg(8.0);
  double position_offset_std_m = 2.0;
  double max_gap_s = 60.0;
  double max_range_std_m = 3.0;
  double max_bearing_std_rad = deg(0.5);
  double max_time_std_s = 0.5;
  int min_matches = 40;
  int max_matches = 50000;
  int max_waiting_plots = 20000;
  int max_vessels = 500;

  static constexpr auto fields() noexcept {
    using C = CalibrationConfig;
    return field_table(
        field("range_gate_m", &C::range_gate_m, between(1, 1e5), "m",
              "Largest range offset that is looked for."),
        field("bearing_gate_rad", &C::bearing_gate_rad, above_to(0, deg(180)), "rad",
              "Largest bearing offset that is looked for."),
        field("position_offset_std_m", &C::position_offset_std_m, between(0.01, 1e4), "m",
              "Expected constant offset of a vessel's echo from its reported position, per axis; "
              "the offsets measured correct it."),
        field("max_gap_s", &C::max_gap_s, between(0.01, 3600), "s",
              "Longest time between two reports of a vessel that is interpolated."),
        field("max_range_std_m", &C::max_range_std_m, between(1e-3, 1e6), "m",
              "A range offset is determined up to this standard deviation."),
        field("max_bearing_std_rad", &C::max_bearing_std_rad, above_to(0, deg(180)), "rad",
              "A bearing offset is determined up to this standard deviation."),
        field("max_time_std_s", &C::max_time_std_s, between(1e-3, 1e5), "s",
              "A time offset is determined up to this standard deviation."),
        field("min_matches", &C::min_matches, between(10, 1e6), "plots",
              "Least number of plots of reported vessels."),
        field("max_matches", &C::max_matches, between(100, 1e7), "pairs",
              "Room for pairs of plot and reported vessel; when it is full, every other pair "
              "of the past and of the future is left out."),
        field("max_waiting_plots", &C::max_waiting_plots, between(100, 1e7), "plots",
              "Room for plots that wait for the next reports."),
        field("max_vessels", &C::max_vessels, between(1, 1e5), "vessels",
              "Room for reported vessels; others are left out."));
  }

  friend bool operator==(const CalibrationConfig&, const CalibrationConfig&) = default;

  void validate() const { validate_fields(*this); }
};

/// A position of a vessel that plots are compared with: reported by it (AIS, GNSS), or that of its
/// track by another radar.
struct ReferenceReport {
  std::int64_t vessel = 0;  ///< such as its MMSI
  double time_s = 0.0;
  double north_m = 0.0;
  double east_m = 0.0;
  double vnorth_mps = std::numeric_limits<double>::quiet_NaN();  ///< NaN where unknown
  double veast_mps = std::numeric_limits<double>::quiet_NaN();
  double position_std_m = 5.0;  ///< per axis, of the part that varies from report to report
  /// Of [north, east] by a track, in place of `position_std_m`; zero: that.
  Mat<double, 2, 2> covariance = Mat<double, 2, 2>::Zero();
  /// [north, east] of the antenna of the other radar, whose offsets are unknown; NaN: none, the
  /// position is right but for its errors.
  Vec<double, 2> antenna_m = Vec<double, 2>::Constant(std::numeric_limits<double>::quiet_NaN());

  [[nodiscard]] bool is_of_radar() const noexcept { return antenna_m.allFinite(); }

  [[nodiscard]] Mat<double, 2, 2> errors_m2() const noexcept {
    if (!covariance.isZero(0.0)) return covariance;
    return position_std_m * position_std_m * Mat<double, 2, 2>::Identity();
  }

  [[nodiscard]] bool is_valid() const noexcept {
    return std::isfinite(time_s) && in_range(north_m) && in_range(east_m) &&
           position_std_m >= 0.0 && in_range(position_std_m) && is_finite(covariance) &&
           covariance.diagonal().minCoeff() >= 0.0 &&
           covariance(0, 0) * covariance(1, 1) >= covariance(0, 1) * covariance(1, 0) &&
           (is_of_radar() ? in_range(antenna_m) : antenna_m.array().isNaN().any());
  }
};

/// Why an offset is determined or not.
enum class CalibrationVerdict : std::uint8_t {
  kDetermined,
  kFewMatches,    ///< too few plots of reported vessels, or no more than by chance
  kPoorGeometry,  ///< its standard deviation is above the limit
  kNearGate,      ///< it is so large that plots of the vessels may be outside the gate
};

/// Names of the verdicts.
constexpr std::array<Word<CalibrationVerdict>, 4> words_of(CalibrationVerdict) noexcept {
  return {{{"determined", CalibrationVerdict::kDetermined},
           {"few matches", CalibrationVerdict::kFewMatches},
           {"poor geometry", CalibrationVerdict::kPoorGeometry},
           {"near gate", CalibrationVerdict::kNearGate}}};
}

/// One offset of the radar.
struct CalibratedOffset {
  double value = std::numeric_limits<double>::quiet_NaN();  ///< measured minus reference
  double std = std::numeric_limits<double>::infinity();
  CalibrationVerdict verdict = CalibrationVerdict::kFewMatches;

  [[nodiscard]] bool determined() const noexcept {
    return verdict == CalibrationVerdict::kDetermined;
  }
};

/// A vessel that took part in a calibration.
struct CalibrationVessel {
  std::int64_t vessel = 0;
  double matches = 0.0;          ///< plots of the vessel
  double along_offset_m = 0.0;   ///< echo minus reported position, in the direction of its course
  double across_offset_m = 0.0;  ///< to starboard
};

/// A plot near a reported vessel.
struct CalibrationMatch {
  std::int64_t vessel = 0;
  double time_s = 0.0;   ///< of the plot, by the radar's clock
  double range_m = 0.0;  ///< of the reported position from the antenna
  double bearing_rad = 0.0;
  double range_error_m = 0.0;  ///< of the plot, measured minus reported
  double bearing_error_rad = 0.0;
  double range_rest_m = 0.0;  ///< the same without the offsets of radar and vessel
  double bearing_rest_rad = 0.0;
  double probability = 0.0;  ///< that the plot is the vessel's
};

/// Result of a calibration.
struct CalibrationResult {
  CalibratedOffset range_m, bearing_rad, time_s;
  /// Of the other radar, measured minus true, where the reference is tracks of one.
  CalibratedOffset other_range_m, other_bearing_rad;
  Mat<double, 3, 3> covariance = Mat<double, 3, 3>::Zero();  ///< of range, bearing and time
  double matches = 0.0;                                      ///< plots of reported vessels
  double range_scale = 1.0;  ///< errors found over those expected (`Radar`, reports)
  double bearing_scale = 1.0;
  double correlation_scans = 1.0;    ///< plots that count as one, for their errors are correlated
  double vessel_offset_std_m = 0.0;  ///< of the constant offsets of the vessels, per axis
  std::vector<CalibrationVessel> vessels;  ///< those with a match
  std::vector<CalibrationMatch> pairs;     ///< all within the gate

  /// The parameters of a radar with the offsets that were determined.
  [[nodiscard]] Radar applied_to(Radar radar) const noexcept {
    if (range_m.determined()) radar.range_offset_m = range_m.value;
    if (bearing_rad.determined()) radar.bearing_offset_rad = bearing_rad.value;
    if (time_s.determined()) radar.time_offset_s = time_s.value;
    return radar;
  }
};

/// How the offsets of another radar, in range and bearing, show in the residuals of range and
/// bearing: what it sees at `from_other` is at `from_this` of this radar.
inline Mat<double, 2, 2> shown_offsets(const Vec<double, 2>& from_other,
                                       const Vec<double, 2>& from_this) noexcept {
  const double other_m = from_other.norm(), range_m = from_this.norm();
  const Vec<double, 2> u = from_this / range_m, v = from_other / std::max(other_m, 1.0);
  const double along = u.dot(v), aside = u[0] * v[1] - u[1] * v[0];
  Mat<double, 2, 2> shown;
  shown << 1.0 - along, other_m * aside, -aside / range_m, 1.0 - other_m / range_m * along;
  return shown;
}

/// Range, bearing and time offset of a radar, from its plots of vessels whose positions are known
/// by their reports (AIS, GNSS), or by the tracks of another radar.
///
/// A plot of a vessel at its reported position, interpolated to the time of the plot, differs from
/// it by
///
///     range:   b_r - r' t + u_r . o     bearing:   b_a - a' t + u_a . o / r
///
/// and noise. b_r, b_a and t are the offsets of the radar (measured minus true); r' and a' the
/// rates of range and bearing; o the constant offset of the vessel's echo from the reported
/// position, along and across its course, which is estimated with them as N(0, s² I); u_r and u_a
/// the directions of sight and across it. s² is estimated, too, with `position_offset_std_m` as if
/// it had been found in one direction of one vessel. With fewer than three vessels s is taken for
/// so large that only geometry separates the offsets of radar and vessel: one vessel on a steady
/// course determines none. The noise is that of the radar, of the reports and of the interpolation;
/// its size and its correlation from plot to plot are estimated from the residuals, so that the
/// standard deviations of the offsets hold for echoes that wander about the hull.
/// A third of the radar's `extent_std_m` is taken for an error of each vessel that never averages
/// out; with fewer than three vessels `position_offset_std_m` as well, for an echo on the near side
/// of a hull turns with the aspect. So vessels near the antenna do not determine the bearing.
///
/// A track of another radar has the offsets of that radar, o_r in range and o_a in bearing, as N(0,
/// gate²). The offsets found are then those of this radar less those of the other one, which show
/// in
///
///     range:     (1 - cos g) o_r + r_o sin g o_a
///     bearing:   -sin g / r o_r + (1 - r_o / r cos g) o_a
///
/// where r_o is the range from the other antenna and g the angle by which its line of sight is
/// clockwise of that of this one. Radars at one place do not show them; where radars are apart,
/// `other_range_m` and `other_bearing_rad` are found too, if the geometry allows.
///
/// Which plots are the vessels' is unknown: all in a wide gate are candidates. The offsets with the
/// most plots of the most vessels are found first, by votes on a grid; then the equations are
/// solved by least squares with weights, the probability that a plot is the vessel's, in a gate
/// that narrows.
///
/// A plot is compared with the reports before and after it. Reports and plots are given as they
/// come, or all plots first, of which the last `max_waiting_plots` wait for reports; of a vessel
/// only the last two reports are kept, so that one given long before the plots of its time is
/// compared with none. Memory is bounded, and taken by the constructor but for the results. Only
/// times and values that are finite are taken.
class Calibration {
 public:
  /// Throws `std::invalid_argument` for parameters out of range. The offsets of the radar are not
  /// used.
  explicit Calibration(const Radar& radar, const CalibrationConfig& config = {})
      : radar_(validated(radar)), config_(validated(config)) {
    waiting_.reserve(static_cast<std::size_t>(config.max_waiting_plots));
    candidates_.reserve(static_cast<std::size_t>(config.max_matches));
    vessels_.reserve(static_cast<std::size_t>(config.max_vessels));
    slot_of_.reserve(static_cast<std::size_t>(config.max_vessels));
  }

  /// Takes a report. `kNotFinite` for one without a finite time or position, or of one vessel too
  /// many; `kNegativeTimeStep` for one that is not after the last one of the vessel.
  Status report(const ReferenceReport& report) {
    if (!report.is_valid()) return Status::kNotFinite;
    const auto known = slot_of_.find(report.vessel);
    if (known == slot_of_.end()) {
      if (std::ssize(vessels_) == config_.max_vessels) return Status::kNotFinite;
      slot_of_.emplace(report.vessel, static_cast<int>(vessels_.size()));
      vessels_.push_back({.last = report});
      return Status::kOk;
    }
    Vessel& vessel = vessels_[static_cast<std::size_t>(known->second)];
    if (!(report.time_s > vessel.last.time_s)) return Status::kNegativeTimeStep;
    vessel.append(report, config_.max_gap_s);
    for (const Plot& plot : waiting_) match(known->second, plot);
    return Status::kOk;
  }

  /// Takes plots; those that are not finite are left out.
  void plots(std::span<const Plot> plots) noexcept {
    for (const Plot& plot : plots) {
      if (!std::isfinite(plot.time_s) || !in_range(plot.range_m) || !(plot.range_m > 0.0) ||
          !in_range(plot.bearing_rad) || !in_range(plot.own.position<double>()) ||
          !in_range(plot.own.velocity<double>()))
        continue;
      for (int slot = 0; slot < std::ssize(vessels_); ++slot) match(slot, plot);
      wait(plot);
    }
  }

  /// The offsets from all that was given so far.
  [[nodiscard]] CalibrationResult solve() const;

  [[nodiscard]] const Radar& radar() const noexcept { return radar_; }
  [[nodiscard]] const CalibrationConfig& config() const noexcept { return config_; }

 private:
  static constexpr int kOffsets = 5;  // range, bearing, time; range, bearing of the other radar
  using Offsets = Vec<double, kOffsets>;
  using Covariance = Mat<double, kOffsets, kOffsets>;
  using Pair = Vec<double, 2>;  // range, bearing; or along, across
  using Lever = Mat<double, kOffsets, 2>;

  static constexpr int kRangeBins = 40, kBearingBins = 32;
  static constexpr double kGate = 11.0;           // d² at which a plot is as likely another's
  static constexpr double kPriorDegrees = 1.0;    // weight of the expected offset of vessels
  static constexpr double kFewestOfVessel = 3.0;  // plots
  static constexpr int kFewVessels = 2;           // for which the offsets are as good as unknown
  static constexpr double kUnknownOffset_m = 100.0;
  static constexpr double kContrast = 3.0;  // of matches over those expected by chance
  static constexpr double kSlow_mps = 1.0;  // below, a course means nothing
  static constexpr int kLags = 40;
  static constexpr double kLasting =
      1.0 / 3.0;  // share of the extent of an echo that never averages out

  /// The last two reports of a vessel and the way between them.
  struct Vessel {
    ReferenceReport before = {}, last = {};
    bool interpolated = false;
    bool smooth = false;     // a cubic with the reported velocities, else a line
    double bend_mps2 = 0.0;  // how much the velocity changes
    Pair slope_mps = Pair::Zero(), velocity_mps = Pair::Zero();

    void append(const ReferenceReport& report, double max_gap_s) noexcept {
      before = last;
      last = report;
      const double step_s = last.time_s - before.time_s;
      const Pair slope{(last.north_m - before.north_m) / step_s,
                       (last.east_m - before.east_m) / step_s};
      const Pair change{last.vnorth_mps - before.vnorth_mps, last.veast_mps - before.veast_mps};
      smooth = change.allFinite();
      const bool follows = interpolated;
      interpolated = step_s <= max_gap_s;
      bend_mps2 = smooth    ? change.norm() / step_s
                  : follows ? (slope - slope_mps).norm() / step_s
                            : 0.0;
      velocity_mps = follows ? Pair(0.5 * (slope + slope_mps)) : slope;
      slope_mps = slope;
    }

    [[nodiscard]] bool covers(double time_s) const noexcept {
      return interpolated && time_s > before.time_s && time_s <= last.time_s;
    }
  };

  /// A plot near the interpolated position of a vessel.
  struct Candidate {
    int vessel;
    double time_s;
    double range_m, bearing_rad;
    Pair residual;            // measured minus reported
    Pair rate;                // of range and bearing
    Pair from_other;          // from the antenna of another radar, as it sees it; 0: reported
    Mat<double, 2, 2> other;  // how the offsets of that radar show
    Pair sight;               // towards the vessel, along and across its course
    Pair variance;            // of the residuals

    /// What the offsets of radar and vessel leave of the residual.
    [[nodiscard]] Pair rest(const Offsets& radar, const Pair& vessel_m) const noexcept {
      return residual - Pair{row(0).dot(radar) + sight.dot(vessel_m),
                             row(1).dot(radar) + cross().dot(vessel_m)};
    }
    /// The derivative of the residual of range (0) or bearing (1) by the offsets of the radar.
    [[nodiscard]] Offsets row(int k) const noexcept {
      return Offsets{k == 0 ? 1.0 : 0.0, k == 0 ? 0.0 : 1.0, -rate[k], other(k, 0), other(k, 1)};
    }
    [[nodiscard]] Pair cross() const noexcept { return Pair{-sight[1], sight[0]} / range_m; }

    /// The same with equations that are linear about these offsets of the other radar.
    [[nodiscard]] Candidate about(const Offsets& radar) const noexcept {
      const Pair off = radar.tail<2>();
      const double seen_m = from_other.norm(), c = std::cos(off[1]), s = std::sin(off[1]);
      const Pair from = (1.0 - off[0] / seen_m) * Pair{c * from_other[0] + s * from_other[1],
                                                       c * from_other[1] - s * from_other[0]};
      const Pair d =
          range_m * Pair{std::cos(bearing_rad), std::sin(bearing_rad)} - from_other + from;
      Candidate moved = *this;
      moved.other = shown_offsets(from, d);
      moved.residual -= Pair{d.norm() - range_m, wrap_angle(std::atan2(d[1], d[0]) - bearing_rad)} +
                        off - moved.other * off;
      return moved;
    }
  };

  /// Normal equations of a vessel.
  struct Normal {
    Covariance radar = Covariance::Zero();
    Lever both = Lever::Zero();
    Mat<double, 2, 2> vessel = Mat<double, 2, 2>::Zero();
    Offsets radar_side = Offsets::Zero();
    Pair vessel_side = Pair::Zero();

    void add(const Offsets& row, const Pair& own, double value, double weight) noexcept {
      radar.noalias() += weight * row * row.transpose();
      both.noalias() += weight * row * own.transpose();
      vessel.noalias() += weight * own * own.transpose();
      radar_side += weight * value * row;
      vessel_side += weight * value * own;
    }
  };

  /// What `solve` improves from step to step.
  struct Solution {
    Offsets offsets = Offsets::Zero();
    Covariance covariance = Covariance::Zero();
    std::vector<Candidate> candidates;
    std::vector<Pair> vessel_m;   // offset of each vessel
    std::vector<Lever> lever;     // how much of what a vessel shows is taken for its offset
    std::vector<double> matches;  // plots of each vessel
    std::vector<double> weight;   // of each candidate
    Pair scale = Pair::Ones();    // variance found over expected
    double correlation = 1.0;
    double vessel_variance_m2 = 0.0;
    double total = 0.0;
    bool solved = false;

    /// Of the residuals of range and bearing of a candidate in the normal equations.
    [[nodiscard]] Pair weights_of(std::size_t k) const noexcept {
      return weight[k] / correlation * candidates[k].variance.cwiseProduct(scale).cwiseInverse();
    }
  };

  void wait(const Plot& plot) noexcept {
    if (waiting_.size() < waiting_.capacity()) {
      waiting_.push_back(plot);
      return;
    }
    waiting_[oldest_] = plot;
    oldest_ = (oldest_ + 1) % waiting_.size();
  }

  void match(int slot, const Plot& plot) noexcept;
  void keep(const Candidate& candidate) noexcept;
  [[nodiscard]] Offsets voted() const;
  void weigh(Solution& s, const Pair& slack) const;
  void balance(Solution& s) const;
  void spread(Solution& s) const;
  [[nodiscard]] double by_chance(const Solution& s) const noexcept;
  void inflate(Solution& s) const;
  void widen(Solution& s) const;
  [[nodiscard]] Solution solution() const;

  Radar radar_;
  CalibrationConfig config_;
  std::vector<Vessel> vessels_;
  std::unordered_map<std::int64_t, int> slot_of_;
  std::vector<Plot> waiting_;  // a ring
  std::size_t oldest_ = 0;
  std::vector<Candidate> candidates_;
  std::uint64_t seen_ = 0, stride_ = 1;
};

// Pairs of plot and vessel ------------------------------------------------------------------------

inline void Calibration::match(int slot, const Plot& plot) noexcept {
  const Vessel& vessel = vessels_[static_cast<std::size_t>(slot)];
  if (!vessel.covers(plot.time_s)) return;
  const ReferenceReport &a = vessel.before, &b = vessel.last;
  const double step_s = b.time_s - a.time_s, u = (plot.time_s - a.time_s) / step_s;
  const Pair p{a.north_m, a.east_m}, q{b.north_m, b.east_m};
  Pair place = (1.0 - u) * p + u * q, velocity = vessel.velocity_mps;
  if (vessel.smooth) {  // cubic Hermite
    const Pair v = step_s * Pair{a.vnorth_mps, a.veast_mps},
               w = step_s * Pair{b.vnorth_mps, b.veast_mps};
    const Pair bend = 3.0 * (q - p) - 2.0 * v - w, twist = 2.0 * (p - q) + v + w;
    place = p + u * (v + u * (bend + u * twist));
    velocity = ((1.0 - u) * v + u * w) / step_s;  // the slope of the cubic has the reports' errors
  }
  const Pair d = place - plot.own.position<double>();
  const double range_m = d.norm();
  if (!(range_m > 1.0)) return;
  const double bearing_rad = std::atan2(d[1], d[0]);
  const Pair residual{plot.range_m - range_m, wrap_angle(plot.bearing_rad - bearing_rad)};
  if (std::fabs(residual[0]) > config_.range_gate_m ||
      std::fabs(residual[1]) > config_.bearing_gate_rad)
    return;
  const Pair relative = velocity - plot.own.velocity<double>();
  const double speed_mps = velocity.norm();
  const Pair course = speed_mps > kSlow_mps ? Pair(velocity / speed_mps) : Pair(1.0, 0.0);
  const Pair towards = d / range_m;
  // The chord of an arc of that bend is off by bend u (1 - u) T² / 2; a cubic by less.
  const double arc_m = 0.5 * vessel.bend_mps2 * u * (1.0 - u) * step_s * step_s;
  const double way_m = vessel.smooth ? 0.25 * arc_m : arc_m;
  const double even_m2 = way_m * way_m + radar_.extent_std_m * radar_.extent_std_m +
                         plot.own.position_std_m * plot.own.position_std_m;
  const Mat<double, 2, 2> place_m2 = (1.0 - u) * (1.0 - u) * a.errors_m2() + u * u * b.errors_m2() +
                                     even_m2 * Mat<double, 2, 2>::Identity();
  const Pair aside{-towards[1], towards[0]};
  keep({.vessel = slot,
        .time_s = plot.time_s,
        .range_m = range_m,
        .bearing_rad = bearing_rad,
        .residual = residual,
        .rate = {towards.dot(relative),
                 (towards[0] * relative[1] - towards[1] * relative[0]) / range_m},
        .from_other = b.is_of_radar() ? Pair(place - b.antenna_m) : Pair(0.0, 0.0),
        .other = Mat<double, 2, 2>::Zero(),
        .sight = {towards.dot(course), course[0] * towards[1] - course[1] * towards[0]},
        .variance = {radar_.range_std_m * radar_.range_std_m + towards.dot(place_m2 * towards),
                     radar_.bearing_std_rad * radar_.bearing_std_rad +
                         plot.own.heading_std_rad * plot.own.heading_std_rad +
                         aside.dot(place_m2 * aside) / (range_m * range_m)}});
}

inline void Calibration::keep(const Candidate& candidate) noexcept {
  if (seen_++ % stride_ != 0) return;
  if (candidates_.size() == candidates_.capacity()) {
    for (std::size_t k = 0; 2 * k < candidates_.size(); ++k) candidates_[k] = candidates_[2 * k];
    candidates_.erase(
        candidates_.begin() + static_cast<std::ptrdiff_t>((candidates_.size() + 1) / 2),
        candidates_.end());
    stride_ *= 2;
  }
  candidates_.push_back(candidate);
}

// The offsets -------------------------------------------------------------------------------------

/// Range and bearing offset with the most votes: the sum over vessels of the logarithm of how many
/// of its plots are there, as many times as anywhere, so that no vessel in clutter outvotes others.
inline Calibration::Offsets Calibration::voted() const {
  using Grid = Eigen::Array<double, kRangeBins, kBearingBins>;
  std::vector<Grid> counts(vessels_.size(), Grid::Zero());
  const double range_step = 2.0 * config_.range_gate_m / kRangeBins;
  const double bearing_step = 2.0 * config_.bearing_gate_rad / kBearingBins;
  for (const Candidate& c : candidates_) {
    const int i = std::clamp(static_cast<int>((c.residual[0] + config_.range_gate_m) / range_step),
                             0, kRangeBins - 1);
    const int j =
        std::clamp(static_cast<int>((c.residual[1] + config_.bearing_gate_rad) / bearing_step), 0,
                   kBearingBins - 1);
    counts[static_cast<std::size_t>(c.vessel)](i, j) += 1.0;
  }
  Grid votes = Grid::Zero();
  for (const Grid& count : counts) {
    const double level = 1.0 + 9.0 * count.mean();
    for (int i = 0; i < kRangeBins; ++i)
      for (int j = 0; j < kBearingBins; ++j) {
        double votes_near = 0.0;
        for (int k = std::max(i - 1, 0); k <= std::min(i + 1, kRangeBins - 1); ++k)
          for (int l = std::max(j - 1, 0); l <= std::min(j + 1, kBearingBins - 1); ++l)
            votes_near += (k == i && l == j ? 1.0 : 0.5) * count(k, l);
        votes(i, j) += std::log1p(votes_near / level);
      }
  }
  Eigen::Index i = 0, j = 0;
  votes.maxCoeff(&i, &j);
  Offsets offsets = Offsets::Zero();
  offsets[0] = (static_cast<double>(i) + 0.5) * range_step - config_.range_gate_m;
  offsets[1] = (static_cast<double>(j) + 0.5) * bearing_step - config_.bearing_gate_rad;
  return offsets;
}

/// The probability of each candidate to be the vessel's; `slack` adds to the variances.
inline void Calibration::weigh(Solution& s, const Pair& slack) const {
  s.total = 0.0;
  std::fill(s.matches.begin(), s.matches.end(), 0.0);
  for (std::size_t k = 0; k < s.candidates.size(); ++k) {
    const Candidate& c = s.candidates[k];
    const auto vessel = static_cast<std::size_t>(c.vessel);
    const Pair rest = c.rest(s.offsets, s.vessel_m[vessel]);
    const Pair variance = c.variance.cwiseProduct(s.scale) + slack;
    const double d2 = rest.cwiseAbs2().cwiseQuotient(variance).sum();
    s.weight[k] = 1.0 / (1.0 + std::exp(0.5 * (d2 - kGate)));
    s.matches[vessel] += s.weight[k];
    s.total += s.weight[k];
  }
}

/// Weighted least squares for the offsets of radar and vessels, and the variance of the latter.
inline void Calibration::balance(Solution& s) const {
  std::vector<Normal> normal(vessels_.size());
  for (std::size_t k = 0; k < s.candidates.size(); ++k) {
    if (s.weight[k] < 1e-6) continue;
    const Candidate& c = s.candidates[k];
    Normal& n = normal[static_cast<std::size_t>(c.vessel)];
    const Pair weight = s.weights_of(k);
    n.add(c.row(0), c.sight, c.residual[0], weight[0]);
    n.add(c.row(1), c.cross(), c.residual[1], weight[1]);
  }
  // Without any geometry the offsets of the radar have a wide prior, so that they remain finite.
  const Offsets unknown{1e6, kPi<double>, 1e4, config_.range_gate_m, config_.bearing_gate_rad};
  Covariance information = unknown.cwiseAbs2().cwiseInverse().asDiagonal();
  Offsets side = Offsets::Zero();
  const Mat<double, 2, 2> prior = Mat<double, 2, 2>::Identity() / s.vessel_variance_m2;
  std::vector<Mat<double, 2, 2>> own(normal.size());
  s.lever.resize(normal.size());
  for (std::size_t v = 0; v < normal.size(); ++v) {
    own[v] = Cholesky<2>(normal[v].vessel + prior)
                 .solve(Mat<double, 2, 2>(Mat<double, 2, 2>::Identity()));
    s.lever[v] = normal[v].both * own[v];
    information += normal[v].radar - s.lever[v] * normal[v].both.transpose();
    side += normal[v].radar_side - s.lever[v] * normal[v].vessel_side;
  }
  const Offsets size = information.diagonal().cwiseSqrt();  // metres, radians, seconds
  const Covariance even =
      size.cwiseInverse().asDiagonal() * information * size.cwiseInverse().asDiagonal();
  const Cholesky<kOffsets> factor(even);
  if (!factor.ok()) return;
  const Covariance inverse = factor.solve(Covariance(Covariance::Identity()));
  s.covariance = size.cwiseInverse().asDiagonal() * inverse * size.cwiseInverse().asDiagonal();
  s.offsets = s.covariance * side;
  double vessels = 0.0, squares = 0.0;
  for (std::size_t v = 0; v < normal.size(); ++v) {
    s.vessel_m[v] = own[v] * (normal[v].vessel_side - normal[v].both.transpose() * s.offsets);
    if (s.matches[v] < kFewestOfVessel) continue;
    vessels += 1.0;
    squares += s.vessel_m[v].squaredNorm() + own[v].trace() +
               (s.lever[v].transpose() * s.covariance * s.lever[v]).trace();
  }
  const double expected = config_.position_offset_std_m * config_.position_offset_std_m;
  s.vessel_variance_m2 = (kPriorDegrees * expected + squares) / (kPriorDegrees + 2.0 * vessels);
  if (vessels <= kFewVessels)
    s.vessel_variance_m2 = std::max(expected, kUnknownOffset_m * kUnknownOffset_m);
  s.solved = true;
}

/// Size of the residuals over that expected, and over how many plots of a vessel they last.
inline void Calibration::spread(Solution& s) const {
  Pair squares = Pair::Zero();
  double count = 0.0;
  std::array<double, kLags + 1> products{};
  std::vector<std::array<Pair, kLags>> past(vessels_.size());
  std::vector<int> known(vessels_.size(), 0);
  for (std::size_t k = 0; k < s.candidates.size(); ++k) {
    const Candidate& c = s.candidates[k];
    const auto v = static_cast<std::size_t>(c.vessel);
    const Pair rest = c.rest(s.offsets, s.vessel_m[v]);
    squares += s.weight[k] * rest.cwiseAbs2().cwiseQuotient(c.variance);
    count += s.weight[k];
    if (s.weight[k] < 0.5) continue;
    const Pair e = rest.cwiseQuotient(c.variance.cwiseProduct(s.scale).cwiseSqrt());
    products[0] += e.squaredNorm();
    for (int lag = 1; lag <= std::min(known[v], kLags); ++lag)
      products[static_cast<std::size_t>(lag)] +=
          e.dot(past[v][static_cast<std::size_t>((known[v] - lag) % kLags)]);
    past[v][static_cast<std::size_t>(known[v]++ % kLags)] = e;
  }
  if (count < 10.0 || !(products[0] > 0.0)) return;
  s.scale = (squares / count).cwiseMax(0.01).cwiseMin(25.0);
  s.correlation = 1.0;  // the sum of the correlations, up to the first that is none
  const double shows = std::min(0.05, 2.0 / std::sqrt(2.0 * count));
  for (int lag = 1; lag <= kLags; ++lag) {
    const double correlation = products[static_cast<std::size_t>(lag)] / products[0];
    if (correlation < shows) break;
    s.correlation += 2.0 * correlation;
  }
}

/// How many candidates would be matches if all lay evenly in the gate.
inline double Calibration::by_chance(const Solution& s) const noexcept {
  const double gate = 4.0 * config_.range_gate_m * config_.bearing_gate_rad;
  double share = 0.0;
  for (const Candidate& c : s.candidates)
    share += std::min(
        1.0, kPi<double> * kGate * std::sqrt(c.variance.cwiseProduct(s.scale).prod()) / gate);
  return share;
}

/// Enlarges the standard deviations where residuals last for longer than their mean correlation
/// says, as the errors of another radar's smoothed tracks do: they show in some combinations of the
/// offsets more than in others. The covariance of the offsets is A⁻¹ M A⁻¹, where
///
///     M = n / (n - p) Σ g gᵀ,   g = Σ w e (a - L u)
///
/// g is the score of the plots of a minute of one vessel: e are their residuals of weight w, a the
/// derivatives by the offsets and u by the offset of the vessel, of which L is eliminated. n such
/// sums determine p unknowns; fewer than 4 p say too little. A⁻¹ has taken B = Σ w (a - L u) (a - L
/// u)ᵀ for M. Source: P. Huber, Proc. Fifth Berkeley Symposium, 1967; with groups K.-Y. Liang, S.
/// Zeger, Biometrika 73, 1986.
inline void Calibration::inflate(Solution& s) const {
  constexpr double kGroup_s = 60.0, kSumsPerUnknown = 4.0;
  Covariance scores = Covariance::Zero(), taken = Covariance::Zero();
  std::vector<Offsets> score(vessels_.size(), Offsets::Zero());
  std::vector<double> group(vessels_.size(), 0.0);
  double sums = 0.0, unknowns = kOffsets;
  const auto close = [&](std::size_t v) {
    if (score[v].isZero(0.0)) return;
    scores.noalias() += score[v] * score[v].transpose();
    score[v].setZero();
    sums += 2.0;  // range and bearing
  };
  for (std::size_t k = 0; k < s.candidates.size(); ++k) {
    const Candidate& c = s.candidates[k];
    const auto v = static_cast<std::size_t>(c.vessel);
    if (s.weight[k] < 1e-6 || s.matches[v] < kFewestOfVessel) continue;
    if (const double now = std::floor(c.time_s / kGroup_s); now != group[v]) {
      close(v);
      group[v] = now;
    }
    const Pair rest = c.rest(s.offsets, s.vessel_m[v]), weight = s.weights_of(k);
    const Offsets by_range = c.row(0) - s.lever[v] * c.sight;
    const Offsets by_bearing = c.row(1) - s.lever[v] * c.cross();
    score[v] += weight[0] * rest[0] * by_range + weight[1] * rest[1] * by_bearing;
    taken.noalias() += weight[0] * by_range * by_range.transpose() +
                       weight[1] * by_bearing * by_bearing.transpose();
  }
  for (std::size_t v = 0; v < vessels_.size(); ++v) {
    close(v);
    unknowns += s.matches[v] >= kFewestOfVessel ? 2.0 : 0.0;
  }
  if (sums < kSumsPerUnknown * unknowns) return;
  scores *= sums / (sums - unknowns);
  const Covariance excess = s.covariance * (scores - taken) * s.covariance;
  const Offsets factor =
      (1.0 + excess.diagonal().cwiseQuotient(s.covariance.diagonal()).cwiseMax(0.0).array()).sqrt();
  s.covariance = factor.asDiagonal() * s.covariance * factor.asDiagonal();
}

/// Adds what never averages out: an echo is on the near side of a hull, and on one end more than on
/// the other; of few vessels no spread shows how far.
inline void Calibration::widen(Solution& s) const {
  double vessels = 0.0, information = 0.0, leverage = 0.0;
  for (const double matches : s.matches) vessels += matches >= kFewestOfVessel ? 1.0 : 0.0;
  for (std::size_t k = 0; k < s.candidates.size(); ++k) {
    const double weight = s.weight[k] / s.candidates[k].variance[1];
    information += weight;
    leverage += weight / s.candidates[k].range_m;
  }
  const double lasting_m = kLasting * radar_.extent_std_m;
  const double unknown_m = vessels > kFewVessels ? 0.0 : config_.position_offset_std_m;
  const double variance_m2 =
      (lasting_m * lasting_m + unknown_m * unknown_m) / std::max(vessels, 1.0);
  s.covariance(0, 0) += variance_m2;
  s.covariance(1, 1) += variance_m2 * leverage * leverage / (information * information);
}

inline Calibration::Solution Calibration::solution() const {
  Solution s;
  s.offsets = voted();
  s.candidates = candidates_;
  s.vessel_m.assign(vessels_.size(), Pair::Zero());
  s.matches.assign(vessels_.size(), 0.0);
  s.weight.assign(s.candidates.size(), 0.0);
  s.vessel_variance_m2 = config_.position_offset_std_m * config_.position_offset_std_m;
  const Pair bin{2.0 * config_.range_gate_m / kRangeBins,
                 2.0 * config_.bearing_gate_rad / kBearingBins};
  double width = 1.0;  // of the slack, in bins
  for (int step = 0; step < 60; ++step, width *= 0.7) {
    for (std::size_t k = 0; k < candidates_.size(); ++k)
      if (!candidates_[k].from_other.isZero(0.0)) s.candidates[k] = candidates_[k].about(s.offsets);
    weigh(s, width > 0.01 ? Pair(width * width * bin.cwiseAbs2()) : Pair::Zero());
    if (s.total < kFewestOfVessel) break;
    const Offsets before = s.offsets;
    balance(s);
    if (width < 0.1) spread(s);
    const Offsets change = s.offsets - before;
    if (width < 1e-4 && change.cwiseAbs2().cwiseQuotient(s.covariance.diagonal()).sum() < 1e-8)
      break;
  }
  if (s.solved) {
    inflate(s);
    widen(s);
  } else {
    s.offsets.setZero();
  }
  return s;
}

inline CalibrationResult Calibration::solve() const {
  const Solution s = solution();
  CalibrationResult result;
  result.matches = s.total;
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    const Candidate& c = candidates_[k];
    const auto v = static_cast<std::size_t>(c.vessel);
    const Pair rest = s.candidates[k].rest(s.offsets, s.vessel_m[v]);
    result.pairs.push_back({vessels_[v].last.vessel, c.time_s, c.range_m, c.bearing_rad,
                            c.residual[0], c.residual[1], rest[0], rest[1], s.weight[k]});
  }
  if (!s.solved) return result;
  result.covariance = s.covariance.topLeftCorner<3, 3>();
  result.range_scale = std::sqrt(s.scale[0]);
  result.bearing_scale = std::sqrt(s.scale[1]);
  result.correlation_scans = s.correlation;
  result.vessel_offset_std_m = std::sqrt(s.vessel_variance_m2);
  for (std::size_t v = 0; v < vessels_.size(); ++v)
    if (s.matches[v] >= kFewestOfVessel)
      result.vessels.push_back(
          {vessels_[v].last.vessel, s.matches[v], s.vessel_m[v][0], s.vessel_m[v][1]});
  const bool enough = s.total >= config_.min_matches && s.total >= kContrast * by_chance(s);
  constexpr double kOfGate = 0.8;  // nearer to it, errors of plots have been cut off
  const bool is_near_gate = std::abs(s.offsets[0]) > kOfGate * config_.range_gate_m ||
                            std::abs(s.offsets[1]) > kOfGate * config_.bearing_gate_rad;
  const auto offset = [&](int k, double limit) -> CalibratedOffset {
    const double std = std::sqrt(s.covariance(k, k));
    return {s.offsets[k], std,
            !enough           ? CalibrationVerdict::kFewMatches
            : !(std <= limit) ? CalibrationVerdict::kPoorGeometry
            : is_near_gate    ? CalibrationVerdict::kNearGate
                              : CalibrationVerdict::kDetermined};
  };
  result.range_m = offset(0, config_.max_range_std_m);
  result.bearing_rad = offset(1, config_.max_bearing_std_rad);
  result.time_s = offset(2, config_.max_time_std_s);
  result.other_range_m = offset(3, config_.max_range_std_m);
  result.other_bearing_rad = offset(4, config_.max_bearing_std_rad);
  return result;
}

}  // namespace wakeline
