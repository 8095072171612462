// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Forecast of the position of an object drifting in wind and current, with its uncertainty: the
// search area.
#pragma once

#include <cmath>
#include <cstdint>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/chi_square.hpp"
#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/filter/belief.hpp"
#include "wakeline/navigation/leeway.hpp"

namespace wakeline {

/// Drift of an object: v = k U + C + r, U the wind, C the current, both [north, east] m/s, with
/// their uncertainties.
struct DriftModel {
  double leeway = 0.0385;
  double leeway_std = 0.00375;
  double wind_std_mps = 1.5;
  double current_std_mps = 0.1;
  double residual_std_mps = 0.05;
  double residual_time_s = 1800.0;

  static constexpr auto fields() noexcept {
    using D = DriftModel;
    return field_table(
        field("leeway", &D::leeway, kNotNegative, "1",
              "Leeway factor k: speed through the water over that of the wind."),
        field("leeway_std", &D::leeway_std, kNotNegative, "1",
              "Standard deviation of the factor, which stays the same during a forecast."),
        field("wind_std_mps", &D::wind_std_mps, kNotNegative, "m/s",
              "Standard deviation of the wind, per axis, of an error that lasts."),
        field("current_std_mps", &D::current_std_mps, kNotNegative, "m/s",
              "Standard deviation of the current, per axis, of an error that lasts."),
        field("residual_std_mps", &D::residual_std_mps, kNotNegative, "m/s",
              "Standard deviation of the residual drift, per axis, which wanders (Gauss-Markov)."),
        field("residual_time_s", &D::residual_time_s, kPositive, "s",
              "Correlation time of the residual drift."));
  }

  /// The leeway factor of a kind of object; other parameters have their defaults.
  static DriftModel of(FloatingObject object) noexcept {
    DriftModel model;
    model.leeway = leeway_factor(object).middle();
    model.leeway_std = leeway_factor(object).std();
    return model;
  }

  void validate() const { validate_fields(*this); }
};

/// The ellipse that contains a Gaussian position with a given probability.
struct UncertaintyEllipse {
  double semi_major_m = 0.0;
  double semi_minor_m = 0.0;
  double major_axis_rad = 0.0;  ///< direction of the long axis, 0 .. pi clockwise from north
  double area_m2 = 0.0;

  /// For a positive semidefinite covariance (2, 2) and a probability below 1.
  static UncertaintyEllipse of(const Mat<double, 2, 2>& covariance_m2,
                               double probability) noexcept {
    const double threshold = chi_square_quantile(probability, 2.0);
    const double half_sum = covariance_m2.trace() / 2;
    const double half_difference = (covariance_m2(0, 0) - covariance_m2(1, 1)) / 2;
    const double spread = std::hypot(half_difference, covariance_m2(1, 0));
    const double major = std::sqrt(threshold * (half_sum + spread));
    const double minor = std::sqrt(threshold * std::fmax(half_sum - spread, 0.0));
    const double axis = std::atan2(covariance_m2(1, 0), half_difference) / 2;
    return {major, minor, axis < 0 ? axis + kPi<double> : axis, kPi<double> * major * minor};
  }
};

/// The position of a drifting object as a Gaussian:
///     P = P0 + s_k² W Wᵀ + ((k² + s_k²) s_u² + s_c²) t² I + 2 s_r² T² (t/T - 1 + exp(-t/T)) I,
/// W the integral of the wind so far. Mean and covariance are exact for the model and independent
/// of the division into steps.
class DriftForecast {
 public:
  /// Throws `std::invalid_argument` when a parameter or the start is invalid.
  DriftForecast(const DriftModel& model, const Gaussian<2>& start) : model_(model), start_(start) {
    model.validate();
    const Mat<double, 2, 2>& p = start.covariance;
    require(check(start) == Status::kOk, "determinant of the start's covariance",
            "that of a positive definite matrix, and the mean finite",
            p(0, 0) * p(1, 1) - p(1, 0) * p(0, 1));
  }

  /// Advances by a time step under a wind and a current, [north, east] m/s. A number that is not
  /// `in_range` gives `kNotFinite` and changes nothing.
  Status advance(double dt_s, const Vec<double, 2>& wind_mps,
                 const Vec<double, 2>& current_mps) noexcept {
    if (const Status status = check_time_step(dt_s); status != Status::kOk) return status;
    if (!in_range(wind_mps) || !in_range(current_mps)) return Status::kNotFinite;
    elapsed_s_ += dt_s;
    wind_run_m_ += dt_s * wind_mps;
    current_run_m_ += dt_s * current_mps;
    return Status::kOk;
  }

  [[nodiscard]] double elapsed_s() const noexcept { return elapsed_s_; }
  [[nodiscard]] const DriftModel& model() const noexcept { return model_; }
  [[nodiscard]] const Gaussian<2>& start() const noexcept { return start_; }

  /// The present position, [north, east] m.
  [[nodiscard]] Gaussian<2> position() const noexcept {
    const auto squared = [](double x) { return x * x; };
    const double steps = elapsed_s_ / model_.residual_time_s;
    const double wandered = 2 * squared(model_.residual_std_mps * model_.residual_time_s) *
                            (steps + std::expm1(-steps));
    const double lasting =
        (squared(model_.leeway) + squared(model_.leeway_std)) * squared(model_.wind_std_mps) +
        squared(model_.current_std_mps);
    Gaussian<2> now = start_;
    now.mean += wind_drift_mps(wind_run_m_, model_.leeway) + current_run_m_;
    now.covariance += squared(model_.leeway_std) * wind_run_m_ * wind_run_m_.transpose();
    now.covariance.diagonal().array() += lasting * squared(elapsed_s_) + wandered;
    return now;
  }

 private:
  DriftModel model_;
  Gaussian<2> start_;
  double elapsed_s_ = 0.0;
  Vec<double, 2> wind_run_m_ = Vec<double, 2>::Zero();
  Vec<double, 2> current_run_m_ = Vec<double, 2>::Zero();
};

/// A random sample of the drifting object, with its own leeway, errors of wind and current, and
/// random motion. A cloud of particles has the moments of `DriftForecast` and can represent what an
/// ellipse cannot, e.g. a coast.
class DriftParticle {
 public:
  /// Particle `index` of the cloud of a seed; the same two numbers give the same particle.
  /// Arguments as for `DriftForecast`, unchecked.
  DriftParticle(const DriftModel& model, const Gaussian<2>& start, std::uint64_t seed,
                std::uint64_t index) noexcept
      : time_s_(model.residual_time_s),
        residual_std_mps_(model.residual_std_mps),
        random_(mixed(mixed(seed) + index)) {
    position_m_ = start.mean + semidefinite_root<2, double>(start.covariance) * normals();
    leeway_ = model.leeway + model.leeway_std * normals()[0];
    wind_error_mps_ = model.wind_std_mps * normals();
    current_error_mps_ = model.current_std_mps * normals();
    residual_mps_ = residual_std_mps_ * normals();
  }

  /// Advances by a time step under a wind and a current, [north, east] m/s; unchecked.
  void advance(double dt_s, const Vec<double, 2>& wind_mps,
               const Vec<double, 2>& current_mps) noexcept {
    position_m_ += dt_s * (wind_drift_mps(wind_mps + wind_error_mps_, leeway_) + current_mps +
                           current_error_mps_);
    wander(dt_s);
  }

  [[nodiscard]] const Vec<double, 2>& position_m() const noexcept { return position_m_; }

 private:
  /// Integrates the Gauss-Markov velocity over a step, exactly.
  void wander(double dt_s) noexcept {
    const double x = dt_s / time_s_;
    const double rest = -std::expm1(-x);  // 1 - exp(-x)
    Mat<double, 2, 2> noise;              // of [displacement, velocity] per unit variance
    noise(0, 0) = time_s_ * time_s_ *
                  (x < 1e-3 ? x * x * x * (2.0 / 3 - x / 2) : 2 * (x - rest) - rest * rest);
    noise(0, 1) = noise(1, 0) = time_s_ * rest * rest;
    noise(1, 1) = rest * (2 - rest);
    const Mat<double, 2, 2> root = residual_std_mps_ * semidefinite_root<2, double>(noise);
    const Vec<double, 2> first = normals(), second = normals();
    position_m_ += time_s_ * rest * residual_mps_ + root(0, 0) * first;
    residual_mps_ += -rest * residual_mps_ + root(1, 0) * first + root(1, 1) * second;
  }

  static constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15u;

  /// One number of SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, 2014): the same on every machine.
  static std::uint64_t mixed(std::uint64_t bits) noexcept {
    bits += kGolden;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    return bits ^ (bits >> 31);
  }

  /// Uniform in the open interval (0, 1).
  double uniform() noexcept {
    const std::uint64_t bits = mixed(random_);
    random_ += kGolden;
    return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52;
  }

  /// Two independent standard normal numbers (Box-Muller).
  Vec<double, 2> normals() noexcept {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    const double angle = 2 * kPi<double> * uniform();
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }

  double time_s_;
  double residual_std_mps_;
  std::uint64_t random_;
  Vec<double, 2> position_m_;
  double leeway_;
  Vec<double, 2> wind_error_mps_;
  Vec<double, 2> current_error_mps_;
  Vec<double, 2> residual_mps_;
};

}  // namespace wakeline
