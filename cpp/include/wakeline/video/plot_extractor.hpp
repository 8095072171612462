// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "wakeline/core/amplitude_image.hpp"
#include "wakeline/core/angle.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/video/cfar.hpp"
#include "wakeline/video/land_mask.hpp"
#include "wakeline/video/open_echoes.hpp"
#include "wakeline/video/runs.hpp"
#include "wakeline/video/static_clutter_map.hpp"
#include "wakeline/video/sweep.hpp"
#include "wakeline/video/video_plot.hpp"

namespace wakeline {

/// Thresholds, sizes and gaps of echoes.
struct PlotExtractorSettings {
  CfarSettings cfar = {};
  int max_sweep_cells = 4096;
  int gap_cells = 0;
  int gap_sweeps = 0;
  int min_cells = 2;
  int max_cells = 100'000'000;
  double max_range_extent_m = 1e6;
  double max_bearing_extent_rad = 2 * kPi<double>;
  int max_sweeps = 1024;
  bool closed_circle = false;

  static constexpr auto fields() noexcept {
    using P = PlotExtractorSettings;
    return field_table(
        field("cfar", &P::cfar, "Detection along a sweep."),
        field("max_sweep_cells", &P::max_sweep_cells, between(1, 65536), "cells",
              "Longer sweeps are rejected."),
        field("gap_cells", &P::gap_cells, between(0, 64), "cells",
              "Cells that may be missing within an echo, along range."),
        field("gap_sweeps", &P::gap_sweeps, between(0, 8), "sweeps",
              "Sweeps that may be missing within an echo."),
        field("min_cells", &P::min_cells, at_least(1), "cells", "Smaller echoes give no plot."),
        field("max_cells", &P::max_cells, at_least(1), "cells",
              "Larger echoes give no plot; at least min_cells."),
        field("max_range_extent_m", &P::max_range_extent_m, kPositive, "m",
              "Longer echoes give no plot."),
        field("max_bearing_extent_rad", &P::max_bearing_extent_rad, kPositive, "rad",
              "Wider echoes give no plot."),
        field("max_sweeps", &P::max_sweeps, at_least(1), "sweeps",
              "An echo is closed after so many sweeps, and what follows is another one."),
        field("closed_circle", &P::closed_circle,
              "Each turn is a separate picture: echoes of its first sweeps wait for the last ones "
              "and are joined with them, at the time of these, and max_sweeps does not apply. Else "
              "turns follow each other without a seam."));
  }

  void validate() const {
    validate_fields(*this);
    require(max_cells >= min_cells, "max_cells", "not less than min_cells", max_cells);
  }
};

/// Result of a sweep.
enum class SweepStatus : std::uint8_t {
  kOk = 0,
  kGap = 1,              ///< used; sweeps before it are missing: open echoes were closed
  kReversed = 2,         ///< used; the antenna turned back: open echoes were closed
  kGeometryChanged = 3,  ///< used; start range or cell length changed: open echoes were closed
  kRepeated = 4,         ///< rejected: same azimuth as the last one
  kTooLong = 5,          ///< rejected: more cells than `max_sweep_cells`
  kInvalid = 6,          ///< rejected: see `Sweep::valid`
};

/// Whether a sweep was rejected.
[[nodiscard]] constexpr bool rejected(SweepStatus status) noexcept {
  return status >= SweepStatus::kRepeated;
}

/// The status as text, for messages and logs.
constexpr const char* to_string(SweepStatus status) noexcept {
  switch (status) {
    case SweepStatus::kOk:
      return "ok";
    case SweepStatus::kGap:
      return "sweeps are missing before it";
    case SweepStatus::kReversed:
      return "the antenna went back";
    case SweepStatus::kGeometryChanged:
      return "start range or cell length changed";
    case SweepStatus::kRepeated:
      return "rejected: the same azimuth again";
    case SweepStatus::kTooLong:
      return "rejected: too many cells";
    case SweepStatus::kInvalid:
      return "rejected: not a radar's sweep";
  }
  return "unknown";
}

/// Counts since the extractor was constructed.
struct ExtractionCounts {
  std::int64_t sweeps = 0;  ///< used
  std::int64_t gaps = 0;
  std::int64_t reversals = 0;
  std::int64_t geometry_changes = 0;
  std::int64_t repeated = 0;
  std::int64_t too_long = 0;
  std::int64_t invalid = 0;
  std::int64_t plots = 0;
  std::int64_t too_small = 0;  ///< echoes, like the next ones
  std::int64_t too_large = 0;
  std::int64_t cut = 0;  ///< plots that may be parts of echoes
};

/// Converts sweeps to plots, each as soon as its echo is complete.
///
///     threshold (Cfar, StaticClutterMap, LandMask) -> runs of cells above -> echoes -> VideoPlot
///
/// Sweeps follow each other clockwise, `azimuth_width_rad` apart, revolution after revolution;
/// north is not special. Two cells belong to one echo when they share an edge or a corner, or when
/// at most `gap_cells` and `gap_sweeps` are between them. An echo is complete when `gap_sweeps` + 1
/// sweeps are not connected with it.
///
/// Sweeps are missing when an azimuth is more than 1.5 widths after the last. Up to `gap_sweeps`
/// missing ones are processed as empty sweeps; more close the open echoes, as do a backward step of
/// the antenna and a change of start range or cell length. A sweep at the azimuth of the last one
/// (within a thousandth of its width) and an invalid one are rejected and change nothing. A sweep
/// of zeros has no detections; with a factor of 1 or more neither has a fully saturated one,
/// because none of its cells exceeds the others.
///
/// All memory is allocated at construction; no picture needs more, whatever the number and size of
/// its echoes. An extractor can be moved, not copied.
template <class Amplitude = std::uint8_t>
class PlotExtractor {
 public:
  /// Throws `std::invalid_argument` when a setting is invalid.
  explicit PlotExtractor(const PlotExtractorSettings& settings, LandMask land = {},
                         StaticClutterMap clutter = {})
      : settings_((settings.validate(), settings)),
        cfar_(settings.cfar, settings.max_sweep_cells),
        land_(std::move(land)),
        clutter_(std::move(clutter)),
        echoes_({.max_cells = settings.max_sweep_cells,
                 .gap_cells = settings.gap_cells,
                 .gap_sweeps = settings.gap_sweeps,
                 .max_sweeps = settings.max_sweeps,
                 .closed_circle = settings.closed_circle}) {
    threshold_.resize(static_cast<std::size_t>(settings.max_sweep_cells));
    plots_.reserve(2 * echoes_.capacity());
  }

  [[nodiscard]] const PlotExtractorSettings& settings() const noexcept { return settings_; }
  [[nodiscard]] const ExtractionCounts& counts() const noexcept { return counts_; }
  [[nodiscard]] const StaticClutterMap& clutter() const noexcept { return clutter_; }
  [[nodiscard]] const LandMask& land() const noexcept { return land_; }

  /// Replaces the excluded areas from the next sweep on. Frees and allocates memory.
  void set_land(LandMask land) noexcept { land_ = std::move(land); }

  /// Status of the last sweep.
  [[nodiscard]] SweepStatus status() const noexcept { return status_; }

  /// Number of echoes that are not complete.
  [[nodiscard]] std::size_t open_echoes() const noexcept { return echoes_.open(); }

  /// Angle that the beam has swept since the first of these echoes began: plots that are still to
  /// come are in it or ahead of it. 0 when there is none.
  [[nodiscard]] double open_extent_rad() const noexcept {
    return static_cast<double>(echoes_.open_sweeps()) * width_rad_;
  }

  /// Processes a sweep; returns the plots of the echoes completed by it, valid until the next call.
  std::span<const VideoPlot> process(const Sweep<Amplitude>& sweep) noexcept {
    plots_.clear();
    status_ = admit(sweep);
    if (rejected(status_)) return plots_;
    ++counts_.sweeps;
    const bool first = !running_ || status_ == SweepStatus::kGap;
    remember(sweep);
    find_thresholds(sweep);
    echoes_.begin_sweep({compass_angle(sweep.azimuth_rad), sweep.azimuth_width_rad, sweep.time_s},
                        first);
    connect(sweep.amplitude);
    echoes_.end_sweep(report());
    return plots_;
  }

  /// After the last sweep: returns the plots of all open echoes. The extractor can then process
  /// other sweeps; counts and clutter map are kept.
  std::span<const VideoPlot> finish() noexcept {
    plots_.clear();
    close_all();
    return plots_;
  }

 private:
  static constexpr double kTurn = 2 * kPi<double>;
  static constexpr double kSameAzimuth = 1e-3;  // widths

  [[nodiscard]] auto report() noexcept {
    return [this](const detail::Echo& echo) noexcept { report_echo(echo); };
  }

  void report_echo(const detail::Echo& echo) noexcept {
    if (echo.cells < settings_.min_cells) {
      ++counts_.too_small;
      return;
    }
    const VideoPlot plot = echo.plot(start_range_m_, cell_m_);
    if (plot.cells > settings_.max_cells || plot.range_extent_m > settings_.max_range_extent_m ||
        plot.bearing_extent_rad > settings_.max_bearing_extent_rad) {
      ++counts_.too_large;
      return;
    }
    ++counts_.plots;
    counts_.cut += plot.cut;
    plots_.push_back(plot);
  }

  // Where the beam goes ---------------------------------------------------------------------------

  [[nodiscard]] SweepStatus admit(const Sweep<Amplitude>& sweep) noexcept {
    if (!sweep.valid()) return ++counts_.invalid, SweepStatus::kInvalid;
    if (sweep.amplitude.size() > threshold_.size())
      return ++counts_.too_long, SweepStatus::kTooLong;
    if (!running_) return SweepStatus::kOk;
    const double step = wrap_angle(sweep.azimuth_rad - azimuth_rad_) / sweep.azimuth_width_rad;
    if (std::fabs(step) <= kSameAzimuth) return ++counts_.repeated, SweepStatus::kRepeated;
    if (sweep.start_range_m != start_range_m_ || sweep.cell_m != cell_m_) {
      close_all();
      return ++counts_.geometry_changes, SweepStatus::kGeometryChanged;
    }
    if (step < 0.0) {
      close_all();
      return ++counts_.reversals, SweepStatus::kReversed;
    }
    if (settings_.closed_circle && turned_rad_ + (step + 0.5) * sweep.azimuth_width_rad > kTurn)
      close_all();
    return move_on(sweep, step);
  }

  /// Processes missing sweeps.
  [[nodiscard]] SweepStatus move_on(const Sweep<Amplitude>& sweep, double step) noexcept {
    if (!running_) return SweepStatus::kOk;
    if (compass_angle(sweep.azimuth_rad) < compass_angle(azimuth_rad_)) echoes_.pass_north();
    const double missing = missing_in(step);
    if (missing > settings_.gap_sweeps) {
      echoes_.interrupt(report());
      return ++counts_.gaps, SweepStatus::kGap;
    }
    for (int k = 0; k < static_cast<int>(missing); ++k) echoes_.skip_sweep(report());
    return SweepStatus::kOk;
  }

  /// Number of missing sweeps in a step of so many widths.
  [[nodiscard]] static double missing_in(double step) noexcept {
    return std::max(std::ceil(step - 0.5) - 1.0, 0.0);
  }

  void remember(const Sweep<Amplitude>& sweep) noexcept {
    turned_rad_ = running_ ? turned_rad_ + compass_angle(sweep.azimuth_rad - azimuth_rad_) : 0.0;
    azimuth_rad_ = sweep.azimuth_rad;
    width_rad_ = sweep.azimuth_width_rad;
    start_range_m_ = sweep.start_range_m;
    cell_m_ = sweep.cell_m;
    running_ = true;
  }

  void close_all() noexcept {
    const double missing = missing_in((kTurn - turned_rad_) / width_rad_);
    echoes_.finish(missing <= settings_.gap_sweeps ? static_cast<int>(missing) : -1, report());
    running_ = false;
  }

  // What it sees ----------------------------------------------------------------------------------

  void find_thresholds(const Sweep<Amplitude>& sweep) noexcept {
    const std::span<Amplitude> threshold(threshold_.data(), sweep.amplitude.size());
    cfar_.thresholds(sweep.amplitude, threshold);
    clutter_.lift_and_learn(sweep, threshold);
    land_.lift(sweep, threshold);
  }

  void connect(std::span<const Amplitude> amplitude) noexcept {
    const Amplitude* threshold = threshold_.data();
    const int last_cell = static_cast<int>(amplitude.size()) - 1;
    if (settings_.gap_cells == 0) {
      detail::for_each_run(amplitude, threshold, [&](int first, int last) noexcept {
        echoes_.add(detail::add_up<Amplitude>(amplitude.data(), nullptr, first, last),
                    last == last_cell);
      });
      return;
    }
    int from = -1;
    int to = -1;
    const auto add = [&]() noexcept {
      if (from >= 0)
        echoes_.add(detail::add_up(amplitude.data(), threshold, from, to), to == last_cell);
    };
    detail::for_each_run(amplitude, threshold, [&](int first, int last) noexcept {
      if (from < 0 || first - to - 1 > settings_.gap_cells) {
        add();
        from = first;
      }
      to = last;
    });
    add();
  }

  PlotExtractorSettings settings_;
  Cfar<Amplitude> cfar_;
  LandMask land_;
  StaticClutterMap clutter_;
  detail::OpenEchoes echoes_;
  std::vector<Amplitude> threshold_;
  std::vector<VideoPlot> plots_;
  ExtractionCounts counts_;
  SweepStatus status_ = SweepStatus::kOk;
  bool running_ = false;     ///< there was a sweep before
  double turned_rad_ = 0.0;  ///< since the first one
  double azimuth_rad_ = 0.0;
  double width_rad_ = 1.0;
  double start_range_m_ = 0.0;
  double cell_m_ = 1.0;
};

/// The plots of a picture taken at one time. A full circle is closed: an echo across its seam gives
/// one plot. Allocates; throws `std::invalid_argument` when a setting is invalid.
template <class Amplitude>
[[nodiscard]] std::vector<VideoPlot> extract_plots(const AmplitudeImage<Amplitude>& image,
                                                   PlotExtractorSettings settings,
                                                   double time_s = 0.0, LandMask land = {}) {
  settings.max_sweep_cells = image.cells;
  settings.closed_circle = image.full_circle();
  PlotExtractor<Amplitude> extractor(settings, std::move(land));
  std::vector<VideoPlot> plots;
  const auto keep = [&](std::span<const VideoPlot> closed) {
    plots.insert(plots.end(), closed.begin(), closed.end());
  };
  for (int k = 0; k < image.sweeps; ++k)
    keep(extractor.process({.time_s = time_s,
                            .azimuth_rad = image.azimuth_rad(k),
                            .azimuth_width_rad = image.azimuth_step_rad,
                            .start_range_m = image.start_range_m,
                            .cell_m = image.cell_m,
                            .amplitude = image.row(k)}));
  keep(extractor.finish());
  return plots;
}

}  // namespace wakeline
