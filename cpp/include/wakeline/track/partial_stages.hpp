// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The stages of a scan of bearings or ranges alone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "wakeline/track/part_of_position.hpp"
#include "wakeline/track/picture.hpp"

namespace wakeline {

/// Changes a picture by bearings or ranges alone. All memory is taken by the constructor.
template <class Estimator, class Steps>
class PartialStages {
 public:
  explicit PartialStages(Picture<Estimator, Steps>& picture) : picture_(picture) {
    const auto plots = static_cast<std::size_t>(picture.config.max_plots);
    slots_.reserve(picture.estimators.size());
    parts_.reserve(picture.estimators.size());
    value_likelihood_.reserve(plots);
    value_best_.reserve(plots);
  }

  ScanReport process(const PartialScan& given) noexcept {
    PartialScan scan = given;
    if (!scan.is_valid()) return picture_.rejected(Status::kNotFinite);
    if (const Status status = picture_.status_of_time(scan.time_s); status != Status::kOk)
      return picture_.rejected(status);
    const auto sensor = static_cast<std::size_t>(scan.sensor);
    scan.time_s = picture_.time_of(picture_.partial_clock[sensor], scan.time_s);
    double& before_s = picture_.partial_time_s[sensor];
    const double periods = std::abs(scan.time_s - before_s) / picture_.longest_period_s();
    scan.std /= std::sqrt(std::clamp(periods, kLeastPartialPeriods, 1.0));
    before_s = std::max(before_s, scan.time_s);
    picture_.clear_results();
    const std::span<const double> values = scan.values.first(
        std::min(scan.values.size(), static_cast<std::size_t>(picture_.config.max_plots)));
    picture_.plot_track_id.assign(values.size(), 0);
    const double extent_m = picture_.state().radar.extent_std_m;
    const auto is_inside = [&](const PartOfPosition& part, double value) {
      return scan.is_usable(value) && part.squared_distance(value) <= kPartialGate;
    };
    // How likely each value is by all tracks, and by the one by which it is likeliest.
    value_likelihood_.assign(values.size(), 0.0);
    value_best_.assign(values.size(), 0.0);
    slots_.clear();
    parts_.clear();
    for (const int slot : picture_.tracks.slots()) {
      const Track& track = picture_.tracks.at(slot);
      if (!track.active()) continue;
      const PartOfPosition& part =
          parts_.emplace_back(scan, position_in(picture_.belief_at(track, scan.time_s)), extent_m);
      for (std::size_t k = 0; k < values.size(); ++k) {
        if (!is_inside(part, values[k])) continue;
        const double likelihood = part.likelihood(values[k]);
        value_likelihood_[k] += likelihood;
        if (likelihood > value_best_[k]) {
          value_best_[k] = likelihood;
          picture_.plot_track_id[k] = track.id;
        }
      }
      slots_.push_back(slot);
    }
    const auto others_than = [&](const PartOfPosition& part, std::size_t k) {
      return std::max(value_likelihood_[k] - part.likelihood(values[k]), 0.0) + scan.false_per_unit;
    };
    for (std::size_t place = 0; place < slots_.size(); ++place) {
      const int slot = slots_[place];
      Track& track = picture_.tracks.at(slot);
      const PartOfPosition& part = parts_[place];
      double ratio = 0.0;  // of the values to being false or another target's
      for (std::size_t k = 0; k < values.size(); ++k)
        if (is_inside(part, values[k])) ratio += part.likelihood(values[k]) / others_than(part, k);
      double& in_view = track.in_view[static_cast<std::size_t>(scan.sensor)];
      const double detection = kPartialDetection * in_view;
      const double seen = in_view * (1.0 - kPartialDetection + kPartialDetection * ratio);
      in_view = kViewMemory * seen / (seen + 1.0 - in_view) + (1.0 - kViewMemory) * 0.5;
      if (ratio == 0.0) continue;
      picture_.predict_to(track, scan.time_s);
      const double late_s = track.time_s - scan.time_s;
      const TimeAlignment alignment = picture_.alignment_over(track, late_s);
      std::array<Alternative<Fix>, kMaxAlternatives> readings;
      std::array<double, kMaxAlternatives> share;
      std::size_t count = 0;
      for (std::size_t k = 0; k < values.size() && count < readings.size(); ++k) {
        if (!is_inside(part, values[k])) continue;
        const Gaussian<2> fix = part.fix(values[k]);
        readings[count++] = {Fix{fix.covariance + alignment.added_m2(late_s)},
                             fix.mean + late_s * track.velocity(),
                             detection * part.per_fix() / others_than(part, k)};
      }
      Estimator& estimator = picture_.estimator_at(slot);
      (void)estimator.update(std::span<const Alternative<Fix>>(readings.data(), count),
                             1.0 - detection, std::span(share.data(), count));
      track.kinematics = kinematics_of(estimator.estimate());
    }
    const auto used = std::count_if(values.begin(), values.end(),
                                    [&](double value) { return scan.is_usable(value); });
    return {Status::kOk, picture_.plot_track_id, picture_.events,
            static_cast<int>(std::ssize(scan.values) - used)};
  }

 private:
  static constexpr double kPartialGate = 9.0;           ///< squared standard deviations
  static constexpr double kPartialDetection = 0.7;      ///< a target in view gives a value
  static constexpr double kLeastPartialPeriods = 0.01;  ///< between two scans of such a sensor
  static constexpr double kViewMemory = 0.98;           ///< from scan to scan of such a sensor

  Picture<Estimator, Steps>& picture_;
  std::vector<int> slots_;                ///< of the tracks that are shown
  std::vector<PartOfPosition> parts_;     ///< what the sensor sees of them
  std::vector<double> value_likelihood_;  ///< by value, of all tracks
  std::vector<double> value_best_;        ///< and of the likeliest
};

}  // namespace wakeline
