// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <span>

#include "wakeline/core/amplitude_image.hpp"
#include "wakeline/core/angle.hpp"
#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/gating/rival_strobe.hpp"
#include "wakeline/gating/strobe.hpp"
#include "wakeline/gating/strobe_cells.hpp"
#include "wakeline/gating/strobe_labels.hpp"
#include "wakeline/gating/strobe_sums.hpp"
#include "wakeline/measurement/fix.hpp"
#include "wakeline/measurement/polar.hpp"

namespace wakeline {

/// Result of a strobe. Up to `kCrowded` there is a measurement. Where several of these apply the
/// status is the last one; `StrobeEcho` has each of them separately.
enum class StrobeStatus : std::uint8_t {
  kOk = 0,             ///< one echo, entirely inside
  kCut = 1,            ///< part of the strobe is outside the picture
  kTouchesEdge = 2,    ///< the echo extends past the strobe: only the part inside was measured
  kSeveralEchoes = 3,  ///< two or more echoes that are not connected
  kCrowded = 4,        ///< more echoes than can be separated: the centre of mass of all
  kEmpty = 5,          ///< no cell inside exceeds the threshold
  kOutside = 6,  ///< no cell of the picture is inside, and the strobe extends past the picture
  kInvalid = 7,  ///< prediction, strobe or picture is not finite or invalid
};

/// The status as text, for messages and logs.
constexpr const char* to_string(StrobeStatus status) noexcept {
  switch (status) {
    case StrobeStatus::kOk:
      return "ok";
    case StrobeStatus::kCut:
      return "cut";
    case StrobeStatus::kTouchesEdge:
      return "touches edge";
    case StrobeStatus::kSeveralEchoes:
      return "several echoes";
    case StrobeStatus::kCrowded:
      return "crowded";
    case StrobeStatus::kEmpty:
      return "empty";
    case StrobeStatus::kOutside:
      return "outside";
    case StrobeStatus::kInvalid:
      return "invalid";
  }
  return "unknown";
}

/// Which of several echoes in a strobe is measured.
enum class EchoChoice : std::uint8_t {
  kAll,        ///< the centre of mass of all, as in the paper
  kNearest,    ///< the one with its centre nearest to the prediction
  kStrongest,  ///< the one with the largest total weight
};

/// Names of the choices.
constexpr std::array<Word<EchoChoice>, 3> words_of(EchoChoice) noexcept {
  return {{{"all", EchoChoice::kAll},
           {"nearest", EchoChoice::kNearest},
           {"strongest", EchoChoice::kStrongest}}};
}

/// The fields of what evaluates strobes.
template <class Settings>
constexpr auto strobe_echo_fields() noexcept {
  using S = Settings;
  return field_table(
      field("least_amplitude", &S::least_amplitude, at_least(1), "counts",
            "Least amplitude of a cell that counts: above the noise."),
      field("pedestal", &S::pedestal, at_least(0), "counts",
            "Amplitude subtracted from that of a cell to weigh it; below least_amplitude."),
      field("several", &S::several, "Which of several echoes in a strobe is measured."),
      field("least_share", &S::least_share, between(0, 0.5), "1",
            "Share of an echo's weight that a strobe must have of an echo shared with rivals. "
            "With less of it the echo is the rivals', with all but less of it the strobe's."));
}

/// Selection and weight of the cells in a strobe.
///
/// A cell is used from `least_amplitude` on, with the weight amplitude - pedestal. With noise in
/// every cell, a least amplitude of 1 draws the centre of mass towards the centre of the strobe,
/// which is the prediction: set it above the noise.
struct StrobeSettings {
  int least_amplitude = 1;
  int pedestal = 0;
  EchoChoice several = EchoChoice::kAll;
  double least_share = 0.25;

  static constexpr auto fields() noexcept { return strobe_echo_fields<StrobeSettings>(); }

  /// Throws `std::invalid_argument` unless 0 <= pedestal < least_amplitude.
  void validate() const {
    validate_fields(*this);
    require(pedestal < least_amplitude, "pedestal", "below least_amplitude", pedestal);
  }
};

/// The echo in a strobe as a measurement; converts to true when there is one, else range and
/// bearing are NaN.
struct StrobeEcho {
  StrobeStatus status = StrobeStatus::kInvalid;
  double range_m = std::numeric_limits<double>::quiet_NaN();  ///< of the centre of mass
  double bearing_rad =
      std::numeric_limits<double>::quiet_NaN();  ///< clockwise from north, 0 to 2 pi
  Mat<double, 2, 2> covariance = Mat<double, 2, 2>::Identity();  ///< of range_m and bearing_rad
  double total_amplitude = 0.0;
  int peak_amplitude = 0;
  int cells = 0;  ///< number of measured cells
  int echoes =
      0;  ///< number of echoes in the strobe, measured or not; 0 when they cannot be separated
  int strobe_cells = 0;       ///< cells of the picture inside the strobe, whatever their amplitude
  bool touches_edge = false;  ///< the measured echo extends past the strobe
  bool shared = false;        ///< only a part of the echo was measured: the other is a rival's
  bool cut = false;           ///< part of the strobe is outside the picture

  /// Share of the cells of the strobe that were measured: near 1 for an echo that fills it.
  [[nodiscard]] double filled() const noexcept {
    return strobe_cells > 0 ? double(cells) / strobe_cells : 0.0;
  }

  explicit operator bool() const noexcept { return status <= StrobeStatus::kCrowded; }

  /// Position [north, east] relative to the antenna with covariance to first order, m and m².
  [[nodiscard]] Gaussian<2> position() const noexcept {
    const Vec<double, 2> u = towards(bearing_rad);
    Mat<double, 2, 2> jacobian;
    jacobian << u[0], -range_m * u[1], u[1], range_m * u[0];
    Gaussian<2> position{range_m * u, jacobian * covariance * jacobian.transpose()};
    mirror_lower<double, 2>(position.covariance);
    return position;
  }

  /// The sensor for the measurement `position().mean` with its covariance.
  [[nodiscard]] Fix fix() const noexcept { return {position().covariance}; }
};

namespace detail {

/// Evaluates one strobe on one picture.
template <int kEchoes, class Image, class Strobe>
class StrobeEvaluation {
  using Amplitude = AmplitudeOf<Image>;
  static_assert(sizeof(Amplitude) <= 2, "amplitudes are of 8 or 16 bits");

 public:
  StrobeEvaluation(const Image& image, const Strobe& strobe, const Vec<double, 2>& predicted_m,
                   const StrobeSettings& settings, std::span<const RivalStrobe> rivals) noexcept
      : image_(image),
        settings_(settings),
        predicted_m_(predicted_m),
        rivals_(rivals),
        cells_(image, strobe, predicted_m),
        range_m_(predicted_m.norm()),
        bearing_rad_(std::atan2(predicted_m[1], predicted_m[0])) {}

  StrobeEcho evaluate() noexcept {
    StrobeEcho echo;
    for (int row = 0; row < cells_.rows(); ++row) add_sweep(cells_.sweep(row), echo);
    if (cells_.closes()) labels_.close_circle();
    echo.cut = echo.cut || cells_.cut_sideways();
    if (all_.all.cells > 0) report(echo);
    if (echo.status == StrobeStatus::kInvalid) report_empty(echo);
    return echo;
  }

 private:
  [[nodiscard]] bool counts(Amplitude amplitude) const noexcept {
    return amplitude >= settings_.least_amplitude && amplitude > settings_.pedestal;
  }

  void add_sweep(int sweep, StrobeEcho& echo) noexcept {
    labels_.start_row();
    const CellSpan span = cells_.span(sweep);
    echo.cut = echo.cut || span.cut;
    echo.strobe_cells += span.size();
    const Amplitude* row = image_.row(sweep).data();
    for (int cell = span.first; cell <= span.last; ++cell) {
      if (!counts(row[cell])) continue;
      const int first = cell;
      while (cell < span.last && counts(row[cell + 1])) ++cell;
      const ClaimedSums sums = claimed(sweep, first, cell, span);
      all_ += sums;
      labels_.add(first, cell, sums);
    }
  }

  /// The sums over a run; those over cells without a rival run by run.
  [[nodiscard]] ClaimedSums claimed(int sweep, int first, int last,
                                    const CellSpan& span) const noexcept {
    ClaimedSums sums{sum_run(sweep, first, last), {}};
    sums.all.extends_outside = continues(sweep, first, last, span) ||
                               continues_beside(cells_.beside(sweep, -1), first, last) ||
                               continues_beside(cells_.beside(sweep, 1), first, last);
    if (rivals_.empty()) {
      sums.own = sums.all;
      return sums;
    }
    const Vec<double, 2> u = towards(image_.azimuth_rad(sweep));
    const auto own = [&](int cell) {
      return !is_rivals(image_.range_m(cell) * u, predicted_m_, rivals_);
    };
    for (int cell = first; cell <= last; ++cell) {
      if (!own(cell)) continue;
      const int from = cell;
      while (cell < last && own(cell + 1)) ++cell;
      sums.own += sum_run(sweep, from, cell);
    }
    sums.own.extends_outside = sums.all.extends_outside;
    return sums;
  }

  [[nodiscard]] StrobeSums sum_run(int sweep, int first, int last) const noexcept {
    const Amplitude* row = image_.row(sweep).data();
    const Vec<double, 2> u = towards(image_.azimuth_rad(sweep) - bearing_rad_);
    StrobeSums sums{};
    for (int cell = first; cell <= last; ++cell) {
      const double weight = row[cell] - settings_.pedestal;
      const double range = image_.range_m(cell) - range_m_;
      sums.weight += weight;
      sums.squares += weight * weight;
      sums.range += weight * range;
      sums.range2 += weight * range * range;
      sums.amplitude += row[cell];
      sums.peak = std::max<int>(sums.peak, row[cell]);
    }
    sums.along = sums.weight * u[0];
    sums.across = sums.weight * u[1];
    sums.range_along = sums.range * u[0];
    sums.range_across = sums.range * u[1];
    sums.cells = last - first + 1;
    return sums;
  }

  /// True when a cell adjacent to first .. last in `sweep` is above the threshold but not inside.
  [[nodiscard]] bool continues(int sweep, int first, int last,
                               const CellSpan& inside) const noexcept {
    const std::span<const Amplitude> row = image_.row(sweep);
    for (int cell = std::max(first - 1, 0); cell <= std::min(last + 1, image_.cells - 1); ++cell)
      if (!inside.holds(cell) && counts(row[static_cast<std::size_t>(cell)])) return true;
    return false;
  }

  [[nodiscard]] bool continues_beside(int sweep, int first, int last) const noexcept {
    return sweep >= 0 && continues(sweep, first, last, cells_.span(sweep));
  }

  /// An echo, or a branch of one, that is not the rivals'.
  [[nodiscard]] bool is_own(int echo) const noexcept {
    return labels_.is_whole(echo) && labels_.sums(echo).own.cells > 0 &&
           labels_.sums(echo).share() >= settings_.least_share;
  }

  [[nodiscard]] bool is_shared(const ClaimedSums& sums) const noexcept {
    return sums.share() < 1.0 - settings_.least_share;
  }

  /// What is measured of an echo that is not the rivals': all, or the own part of a shared one.
  [[nodiscard]] const StrobeSums& measured(const ClaimedSums& sums) const noexcept {
    return is_shared(sums) ? sums.own : sums.all;
  }

  /// The echo to be measured; there is at least one.
  [[nodiscard]] int chosen() const noexcept {
    int best = -1;
    for (int echo = 0; echo < labels_.size(); ++echo)
      if (is_own(echo) &&
          (best < 0 || preferred(measured(labels_.sums(echo)), measured(labels_.sums(best)))))
        best = echo;
    return best;
  }

  [[nodiscard]] bool preferred(const StrobeSums& a, const StrobeSums& b) const noexcept {
    if (settings_.several == EchoChoice::kStrongest) return a.weight > b.weight;
    return distance2(a) < distance2(b);
  }

  [[nodiscard]] double distance2(const StrobeSums& sums) const noexcept {
    const Vec<double, 2> u = towards(bearing_rad_ + sums.mean_bearing());
    return ((range_m_ + sums.mean_range()) * u - predicted_m_).squaredNorm();
  }

  void report(StrobeEcho& echo) const noexcept {
    if (!labels_.full())
      for (int k = 0; k < labels_.size(); ++k) echo.echoes += is_own(k);
    const bool one_of_several = echo.echoes > 1 && settings_.several != EchoChoice::kAll;
    StrobeSums sums{};
    if (labels_.full() || (rivals_.empty() && !one_of_several)) {
      sums = all_.own;
      echo.shared = all_.own.cells < all_.all.cells;
    } else {
      const int only = one_of_several ? chosen() : -1;
      for (int k = 0; k < labels_.size(); ++k) {
        if (!is_own(k) || (one_of_several && k != only)) continue;
        sums += measured(labels_.sums(k));
        echo.shared = echo.shared || is_shared(labels_.sums(k));
      }
    }
    if (sums.cells == 0) return;
    measure(sums, echo);
    echo.status = labels_.full()      ? StrobeStatus::kCrowded
                  : echo.echoes > 1   ? StrobeStatus::kSeveralEchoes
                  : echo.touches_edge ? StrobeStatus::kTouchesEdge
                  : echo.cut          ? StrobeStatus::kCut
                                      : StrobeStatus::kOk;
  }

  void measure(const StrobeSums& sums, StrobeEcho& echo) const noexcept {
    echo.range_m = range_m_ + sums.mean_range();
    echo.bearing_rad = compass_angle(bearing_rad_ + sums.mean_bearing());
    echo.covariance = sums.spread() / sums.effective_cells();
    echo.covariance(0, 0) += image_.cell_m * image_.cell_m / 12.0;
    echo.covariance(1, 1) += image_.azimuth_step_rad * image_.azimuth_step_rad / 12.0;
    echo.total_amplitude = sums.amplitude;
    echo.peak_amplitude = sums.peak;
    echo.cells = sums.cells;
    echo.touches_edge = sums.extends_outside;
  }

  void report_empty(StrobeEcho& echo) const noexcept {
    const bool outside = echo.strobe_cells == 0 && (echo.cut || !cells_.prediction_in_picture());
    echo.cut = echo.cut || outside;
    echo.status = outside ? StrobeStatus::kOutside : StrobeStatus::kEmpty;
  }

  const Image& image_;
  const StrobeSettings& settings_;
  const Vec<double, 2>& predicted_m_;
  std::span<const RivalStrobe> rivals_;
  StrobeCells<Image, Strobe> cells_;
  double range_m_;
  double bearing_rad_;
  ClaimedSums all_{};
  StrobeLabels<kEchoes> labels_;
};

/// True when the geometry of a picture is finite and its steps are positive.
template <PolarPicture Image>
bool is_valid(const Image& image) noexcept {
  return image.azimuth_step_rad > 0.0 && std::isfinite(image.azimuth_step_rad) &&
         image.cell_m > 0.0 && std::isfinite(image.cell_m) &&
         std::isfinite(image.first_azimuth_rad) && std::isfinite(image.start_range_m);
}

}  // namespace detail

/// The echo inside a strobe about a predicted position [north, east] (m, from the antenna): the
/// centre of mass of the amplitudes of the cells whose centres are inside.
///
/// The centre is that of range and of bearing (of their unit vectors), not of north and east: the
/// beam spreads a small target along an arc, whose centre of mass in the plane is short of it by r
/// sb²/2, metres at long range. For a target of width L the result is L²/(24 r) too far instead,
/// the smaller error from r = L / (3.5 sb) on.
///
/// With the weighted covariance S of range and bearing over the cells and the effective number of
/// cells n = (Σw)² / Σw², the covariance is that of a video plot,
///
///     R = S / n + diag(cell², step²) / 12.
///
/// Cells that share an edge or a corner belong to one echo. Up to `kEchoes` echoes are separated;
/// this bounds the memory, 230 bytes each on the stack. A strobe smaller than the distance of two
/// cells may contain no cell centre and is then empty.
///
/// With strobes of other tracks, `rivals`, a cell inside several strobes belongs to the one with
/// the nearest centre. An echo of which this strobe has all but less than `least_share` of the
/// weight is measured as a whole; one of which it has less than that is the rivals' and is ignored;
/// of any other only the cells of this strobe are measured, and the echo is `shared`.
///
/// Source: Grinyak, Trofimov, "Multi-model tracking of moving vessels with a fuzzy criterion of
/// maneuver detection".
template <int kEchoes = 256, PolarPicture Image, StrobeShape Strobe>
[[nodiscard]] StrobeEcho strobe_echo(const Image& image, const Strobe& strobe,
                                     const Vec<double, 2>& predicted_m,
                                     const StrobeSettings& settings = {},
                                     std::span<const RivalStrobe> rivals = {}) noexcept {
  if (!is_finite(predicted_m) || !detail::is_valid(image) ||
      !(strobe.half_angle_rad(predicted_m) >= 0.0))
    return {};
  if (image.sweeps <= 0 || image.cells <= 0) return {.status = StrobeStatus::kOutside, .cut = true};
  return detail::StrobeEvaluation<kEchoes, Image, Strobe>(image, strobe, predicted_m, settings,
                                                          rivals)
      .evaluate();
}

}  // namespace wakeline
