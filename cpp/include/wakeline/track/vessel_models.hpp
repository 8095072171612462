// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/motion/wandering_course.hpp"
#include "wakeline/multimodel/model_group_imm.hpp"
#include "wakeline/track/radar.hpp"

namespace wakeline {

/// The motion models that a tracker uses by default: cruising, steady, restless and turning, and
/// those of agile craft: weaving, turning to port and turning to starboard. The noise of the first
/// four grows with the square of the speed, so that one set serves a drifting ferry and a boat at
/// play.
///
/// A vessel that cruises is a ship under way, which keeps course and speed for a quarter of an
/// hour; the others are craft, which do anything at any time. Most vessels are taken for ships when
/// they are first seen, and for craft as soon as they move like craft; one that goes steadily for
/// long enough is taken for a ship again. Few craft are agile: these go straight and turn at once,
/// at a fixed rate, again and again. As craft seldom become agile or cease to be, a vessel that has
/// turned like that is expected to turn again. `ships()` is another set, where ships alter course
/// as ships do and no craft is agile.
struct VesselModels {
  double cruising_psd_m2s3 = 1e-4;
  double cruising_course_psd_rad2s = 1e-6;
  double steady_psd_m2s3 = 0.005;
  double steady_course_psd_rad2s = 0.004;
  double restless_psd_m2s3 = 0.2;
  double restless_course_psd_rad2s = 0.08;
  double turning_psd_m2s3 = 3.0;
  double turning_course_psd_rad2s = 0.05;
  double turn_rate_psd_rad2s3 = 0.0003;
  double prior_turn_rate_std_rad_s = 0.2;
  double cruising_probability = 0.95;
  double cruising_sojourn_s = 900.0;
  double settling_s = 600.0;
  double steady_sojourn_s = 300.0;
  double restless_sojourn_s = 100.0;
  double turning_sojourn_s = 80.0;
  double weaving_psd_m2s3 = 0.1;
  double agile_turn_psd_m2s3 = 1.2;
  double agile_turn_rate_rad_s = 0.13;
  double agile_probability = 0.05;
  double agile_time_s = 1000.0;
  double weaving_sojourn_s = 10.0;
  double agile_turn_sojourn_s = 5.0;

  static constexpr auto fields() noexcept {
    using V = VesselModels;
    return field_table(
        field("cruising_psd_m2s3", &V::cruising_psd_m2s3, between(0, 1e4), "m²/s³",
              "Acceleration noise of a cruising vessel at rest."),
        field("cruising_course_psd_rad2s", &V::cruising_course_psd_rad2s, between(0, 100), "rad²/s",
              "Course noise of a cruising vessel."),
        field("steady_psd_m2s3", &V::steady_psd_m2s3, between(0, 1e4), "m²/s³",
              "Acceleration noise of a steady vessel at rest."),
        field("steady_course_psd_rad2s", &V::steady_course_psd_rad2s, between(0, 100), "rad²/s",
              "Course noise of a steady vessel."),
        field("restless_psd_m2s3", &V::restless_psd_m2s3, between(0, 1e4), "m²/s³",
              "Acceleration noise of a restless vessel at rest."),
        field("restless_course_psd_rad2s", &V::restless_course_psd_rad2s, between(0, 100), "rad²/s",
              "Course noise of a restless vessel."),
        field("turning_psd_m2s3", &V::turning_psd_m2s3, between(0, 1e4), "m²/s³",
              "Acceleration noise of a turning vessel at rest."),
        field("turning_course_psd_rad2s", &V::turning_course_psd_rad2s, between(0, 100), "rad²/s",
              "Course noise of a turning vessel."),
        field("turn_rate_psd_rad2s3", &V::turn_rate_psd_rad2s3,
              Rule{.low = 1e-9, .high = 100.0, .or_zero = true}, "rad²/s³",
              "Noise of the turn rate of a turning vessel."),
        field("prior_turn_rate_std_rad_s", &V::prior_turn_rate_std_rad_s, between(1e-6, 10),
              "rad/s",
              "Standard deviation of the turn rate before it is known and in the long run."),
        field("cruising_probability", &V::cruising_probability, kProbability, "1",
              "Probability that a new vessel is cruising."),
        field("cruising_sojourn_s", &V::cruising_sojourn_s, kTime, "s",
              "Mean time until a cruising vessel does something else."),
        field("settling_s", &V::settling_s, kTime, "s",
              "Mean time until a steady vessel is taken to cruise."),
        field("steady_sojourn_s", &V::steady_sojourn_s, kTime, "s",
              "Mean time until a steady vessel becomes restless or turns."),
        field("restless_sojourn_s", &V::restless_sojourn_s, kTime, "s",
              "Mean time for which a vessel is restless."),
        field("turning_sojourn_s", &V::turning_sojourn_s, kTime, "s",
              "Mean time for which a vessel turns."),
        field("weaving_psd_m2s3", &V::weaving_psd_m2s3, between(0, 1e4), "m²/s³",
              "Acceleration noise of an agile vessel that goes straight."),
        field("agile_turn_psd_m2s3", &V::agile_turn_psd_m2s3, between(0, 1e4), "m²/s³",
              "Acceleration noise of an agile vessel in a turn."),
        field("agile_turn_rate_rad_s", &V::agile_turn_rate_rad_s, between(0, 10), "rad/s",
              "Turn rate of an agile vessel, to port or to starboard."),
        field("agile_probability", &V::agile_probability, kProbability, "1",
              "Probability that a vessel which does not cruise is agile."),
        field("agile_time_s", &V::agile_time_s, kTime, "s",
              "Mean time for which a vessel is agile."),
        field("weaving_sojourn_s", &V::weaving_sojourn_s, kTime, "s",
              "Mean time until an agile vessel turns."),
        field("agile_turn_sojourn_s", &V::agile_turn_sojourn_s, kTime, "s",
              "Mean time for which an agile vessel turns."));
  }

  /// Of ships under way: straight for twenty minutes, alterations of course within a minute. Three
  /// minutes after one their speed and course are known again (see cpp/docs/theory/a823.md); a boat
  /// at play is followed, its course less well.
  static constexpr VesselModels ships() noexcept {
    return {.cruising_psd_m2s3 = 2e-5,
            .steady_psd_m2s3 = 0.01,
            .steady_course_psd_rad2s = 0.001,
            .restless_psd_m2s3 = 0.1,
            .restless_course_psd_rad2s = 0.02,
            .turning_psd_m2s3 = 0.002,
            .turning_course_psd_rad2s = 0.001,
            .turn_rate_psd_rad2s3 = 3e-6,
            .prior_turn_rate_std_rad_s = 0.05,
            .cruising_probability = 0.98,
            .cruising_sojourn_s = 1200.0,
            .settling_s = 80.0,
            .steady_sojourn_s = 600.0,
            .restless_sojourn_s = 60.0,
            .turning_sojourn_s = 60.0,
            .agile_probability = 0.0};
  }

  friend bool operator==(const VesselModels&, const VesselModels&) = default;

  void validate() const { validate_fields(*this); }

  [[nodiscard]] WanderingCourse cruising(double max_speed_mps) const noexcept {
    return {cruising_psd_m2s3, cruising_course_psd_rad2s, max_speed_mps};
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

  [[nodiscard]] WanderingCourse weaving(double max_speed_mps) const noexcept {
    return {weaving_psd_m2s3, 0.0, max_speed_mps};
  }
  [[nodiscard]] CoordinatedTurn port_turn() const noexcept {
    return {-agile_turn_rate_rad_s, WhiteAcceleration{agile_turn_psd_m2s3}};
  }
  [[nodiscard]] CoordinatedTurn starboard_turn() const noexcept {
    return {agile_turn_rate_rad_s, WhiteAcceleration{agile_turn_psd_m2s3}};
  }

  /// Who stops cruising is in the other modes as often as vessels that do not cruise are. Craft
  /// change to each other mode at equal rates, and a steady one also to cruising and to weaving; an
  /// agile vessel turns to either side alike, and is a common craft again after a time.
  [[nodiscard]] ModeChain<7> chain() const {
    Mat<double, 7, 7> generator_per_s = Mat<double, 7, 7>::Zero();
    generator_per_s.row(0).tail<6>() = share_of_others().transpose() / cruising_sojourn_s;
    generator_per_s.block<3, 3>(1, 1).colwise() = 0.5 * (1.0 / craft_sojourn_s()).matrix();
    generator_per_s(1, 0) = 1.0 / settling_s;
    generator_per_s(1, 4) = agile_probability / agile_time_s;
    generator_per_s.block<3, 3>(4, 1).rowwise() = share_of_craft().transpose() / agile_time_s;
    generator_per_s.row(4).tail<2>().setConstant(0.5 / weaving_sojourn_s);
    generator_per_s.col(4).tail<2>().setConstant(1.0 / agile_turn_sojourn_s);
    generator_per_s.diagonal().setZero();
    generator_per_s.diagonal() = -generator_per_s.rowwise().sum();
    return ModeChain<7>::from_generator(generator_per_s);
  }

  [[nodiscard]] Vec<double, 7> initial_mode_probability() const noexcept {
    Vec<double, 7> probability;
    probability << cruising_probability, (1.0 - cruising_probability) * share_of_others();
    return probability;
  }

 private:
  [[nodiscard]] Eigen::Array3d craft_sojourn_s() const noexcept {
    return {steady_sojourn_s, restless_sojourn_s, turning_sojourn_s};
  }
  /// How much of its time a craft that is not agile spends in each of its modes.
  [[nodiscard]] Vec<double, 3> share_of_craft() const noexcept {
    return craft_sojourn_s() / craft_sojourn_s().sum();
  }
  /// The same of an agile one.
  [[nodiscard]] Vec<double, 3> share_of_agile() const noexcept {
    const Vec<double, 3> sojourn_s{weaving_sojourn_s, 0.5 * agile_turn_sojourn_s,
                                   0.5 * agile_turn_sojourn_s};
    return sojourn_s / sojourn_s.sum();
  }
  /// The same of all vessels that do not cruise.
  [[nodiscard]] Vec<double, 6> share_of_others() const noexcept {
    Vec<double, 6> share;
    share << (1.0 - agile_probability) * share_of_craft(), agile_probability * share_of_agile();
    return share;
  }
};

/// The estimator made of them, of which the agile ones rest where they are unlikely.
using VesselImm =
    ModelGroupImm<FilterBank<Ekf<WanderingCourse>, Ekf<WanderingCourse>, Ekf<WanderingCourse>,
                             Ekf<CoordinatedTurnRate>>,
                  FilterBank<Ekf<WanderingCourse>, Ekf<WanderingCourse>, Ekf<WanderingCourse>,
                             Ekf<CoordinatedTurnRate>, Ekf<WanderingCourse>, Ekf<CoordinatedTurn>,
                             Ekf<CoordinatedTurn>>>;

/// The estimator of a tracker for this radar. Throws `std::invalid_argument` on a setting that
/// makes no sense.
#ifdef WAKELINE_USES_COMPILED_TRACKER
VesselImm vessel_imm(const Radar& radar, const VesselModels& models = {});
#else
inline VesselImm vessel_imm(const Radar& radar, const VesselModels& models = {}) {
  radar.validate();
  models.validate();
  const double max_speed_mps = radar.max_speed_mps;
  VesselImm::All imm(models.chain(), Ekf(models.cruising(max_speed_mps)),
                     Ekf(models.steady(max_speed_mps)), Ekf(models.restless(max_speed_mps)),
                     Ekf(models.turning(max_speed_mps)), Ekf(models.weaving(max_speed_mps)),
                     Ekf(models.port_turn()), Ekf(models.starboard_turn()));
  imm.set_initial_mode_probability(models.initial_mode_probability());
  return VesselImm(imm);
}
#endif

}  // namespace wakeline
