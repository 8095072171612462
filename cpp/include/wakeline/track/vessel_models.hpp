// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/motion/wandering_course.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/track/radar.hpp"

namespace wakeline {

/// The motion models that a tracker uses unless told otherwise: steady, restless and turning. Their
/// noise grows with the square of the speed, so that one set serves a drifting ferry and a boat at
/// play; `ships()` is another, for ships under way.
struct VesselModels {
  double steady_psd_m2s3 = 0.005;          ///< acceleration of a steady vessel at rest
  double steady_course_psd_rad2s = 0.004;  ///< wander of its course
  double restless_psd_m2s3 = 0.2;
  double restless_course_psd_rad2s = 0.055;
  double turning_psd_m2s3 = 3.0;
  double turning_course_psd_rad2s = 0.05;
  double turn_rate_psd_rad2s3 = 0.0003;    ///< wander of the rate of turn
  double prior_turn_rate_std_rad_s = 0.2;  ///< rate of turn before it is known, and in the long run
  double steady_sojourn_s = 300.0;         ///< mean time in each mode
  double restless_sojourn_s = 90.0;
  double turning_sojourn_s = 80.0;

  /// Of ships under way: straight for most of an hour, alterations of course within a minute. A
  /// radar that sees them miles away then has their speed and course within a minute (see
  /// cpp/docs/theory/a823.md); a boat at play is lost by them.
  static constexpr VesselModels ships() noexcept {
    return {.steady_psd_m2s3 = 2e-5,
            .steady_course_psd_rad2s = 1e-6,
            .restless_psd_m2s3 = 0.01,
            .restless_course_psd_rad2s = 0.001,
            .turning_psd_m2s3 = 0.002,
            .turning_course_psd_rad2s = 0.001,
            .turn_rate_psd_rad2s3 = 3e-6,
            .prior_turn_rate_std_rad_s = 0.05,
            .steady_sojourn_s = 3000.0,
            .restless_sojourn_s = 60.0,
            .turning_sojourn_s = 60.0};
  }

  void validate() const {
    require_not_negative("steady_psd_m2s3", steady_psd_m2s3);
    require_not_negative("steady_course_psd_rad2s", steady_course_psd_rad2s);
    require_not_negative("restless_psd_m2s3", restless_psd_m2s3);
    require_not_negative("restless_course_psd_rad2s", restless_course_psd_rad2s);
    require_not_negative("turning_psd_m2s3", turning_psd_m2s3);
    require_not_negative("turning_course_psd_rad2s", turning_course_psd_rad2s);
    require_not_negative("turn_rate_psd_rad2s3", turn_rate_psd_rad2s3);
    require_positive("prior_turn_rate_std_rad_s", prior_turn_rate_std_rad_s);
    require_positive("steady_sojourn_s", steady_sojourn_s);
    require_positive("restless_sojourn_s", restless_sojourn_s);
    require_positive("turning_sojourn_s", turning_sojourn_s);
  }

  [[nodiscard]] WanderingCourse steady(double max_speed_mps) const noexcept {
    return {steady_psd_m2s3, steady_course_psd_rad2s, max_speed_mps};
  }
  [[nodiscard]] WanderingCourse restless(double max_speed_mps) const noexcept {
    return {restless_psd_m2s3, restless_course_psd_rad2s, max_speed_mps};
  }
  /// The wander of the rate of turn and its return balance at the prior.
  [[nodiscard]] CoordinatedTurnRate turning(double max_speed_mps) const noexcept {
    const double prior_variance = prior_turn_rate_std_rad_s * prior_turn_rate_std_rad_s;
    return {.noise = WhiteAcceleration{turning_psd_m2s3},
            .turn_rate_psd_rad2s3 = turn_rate_psd_rad2s3,
            .prior_turn_rate_std_rad_s = prior_turn_rate_std_rad_s,
            .course_psd_rad2s = turning_course_psd_rad2s,
            .max_speed_mps = max_speed_mps,
            .turn_rate_time_s =
                turn_rate_psd_rad2s3 > 0.0 ? 2.0 * prior_variance / turn_rate_psd_rad2s3 : 0.0};
  }
};

/// The estimator made of them.
using VesselImm =
    Imm<FilterBank<Ekf<WanderingCourse>, Ekf<WanderingCourse>, Ekf<CoordinatedTurnRate>>>;

/// The estimator of a tracker for this radar. A start believes in each mode as much as the chain in
/// the long run. Throws `std::invalid_argument` on a setting that makes no sense.
inline VesselImm vessel_imm(const Radar& radar, const VesselModels& models = {}) {
  radar.validate();
  models.validate();
  const Vec<double, 3> sojourn_s{models.steady_sojourn_s, models.restless_sojourn_s,
                                 models.turning_sojourn_s};
  VesselImm imm(ModeChain<3>::from_sojourn_s(sojourn_s), Ekf(models.steady(radar.max_speed_mps)),
                Ekf(models.restless(radar.max_speed_mps)),
                Ekf(models.turning(radar.max_speed_mps)));
  imm.set_initial_mode_probability(sojourn_s / sojourn_s.sum());
  return imm;
}

}  // namespace wakeline
