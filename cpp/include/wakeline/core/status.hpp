// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "wakeline/core/types.hpp"
#include "wakeline/simd/pack.hpp"
#include "wakeline/simd/scalar.hpp"

namespace wakeline {

/// Result of one step. With any value but `kOk` nothing was changed.
enum class [[nodiscard]] Status : std::uint8_t{
    kOk = 0,
    kMissed = 1,               ///< no measurement in this scan: predicted only
    kNotStarted = 2,           ///< the estimator has no belief yet
    kNotFinite = 3,            ///< an input or a result is not finite, or an input is out of range
    kNotPositiveDefinite = 4,  ///< a covariance is not positive definite
    kNegativeTimeStep = 5,     ///< the time step is negative
    kGated = 6,                ///< the measurement is outside the gate: predicted only
};

/// The status in words, for messages and logs.
constexpr const char* to_string(Status status) noexcept {
  switch (status) {
    case Status::kOk:
      return "ok";
    case Status::kMissed:
      return "missed: no measurement";
    case Status::kNotStarted:
      return "not started";
    case Status::kNotFinite:
      return "not finite";
    case Status::kNotPositiveDefinite:
      return "covariance not positive definite";
    case Status::kNegativeTimeStep:
      return "negative time step";
    case Status::kGated:
      return "gated: measurement outside the gate";
  }
  return "unknown";
}

/// Whether a step was done.
constexpr bool ok(Status status) noexcept { return status == Status::kOk; }

/// The first of the two that is not `kOk`.
constexpr Status first_failure(Status a, Status b) noexcept { return ok(a) ? b : a; }

/// `kOk` where the condition holds, else `otherwise`.
constexpr Status ok_or(bool condition, Status otherwise) noexcept {
  return condition ? Status::kOk : otherwise;
}

/// The status of a lane; a `Status` has one.
constexpr Status lane(Status status, int) noexcept { return status; }
/// The status itself: it has one lane.
constexpr Status first_failure_of_lanes(Status status) noexcept { return status; }

/// A `Status` for each lane of a pack.
template <class Scalar>
class [[nodiscard]] LaneStatus {
 public:
  LaneStatus() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): the same in every lane.
  LaneStatus(Status status) noexcept : code_(double(status)) {}

  friend MaskOf<Scalar> operator==(const LaneStatus& status, Status code) noexcept {
    return status.code_ == Scalar(double(code));
  }
  friend MaskOf<Scalar> ok(const LaneStatus& status) noexcept { return status.code_ == Scalar(0); }
  friend LaneStatus select(const MaskOf<Scalar>& condition, const LaneStatus& a,
                           const LaneStatus& b) noexcept {
    return LaneStatus(select(condition, a.code_, b.code_));
  }
  friend LaneStatus first_failure(const LaneStatus& a, const LaneStatus& b) noexcept {
    return select(ok(a), b, a);
  }
  friend Status lane(const LaneStatus& status, int k) noexcept {
    return static_cast<Status>(lane(status.code_, k));
  }
  friend Status first_failure_of_lanes(const LaneStatus& status) noexcept {
    Status first = Status::kOk;
    for (int k = 0; k < kLanesOf<Scalar>; ++k) first = first_failure(first, lane(status, k));
    return first;
  }

 private:
  explicit LaneStatus(const Scalar& code) noexcept : code_(code) {}
  Scalar code_ = Scalar(0);
};

/// `kOk` in the lanes where the condition holds, else `otherwise`.
template <class Real, int Lanes>
LaneStatus<Pack<Real, Lanes>> ok_or(const PackMask<Real, Lanes>& condition,
                                    Status otherwise) noexcept {
  using Result = LaneStatus<Pack<Real, Lanes>>;
  return select(condition, Result(Status::kOk), Result(otherwise));
}

/// `Status`, or one for each lane.
template <class Scalar>
using StatusOf = std::conditional_t<kLanesOf<Scalar> == 1, Status, LaneStatus<Scalar>>;

/// Largest magnitude of an input: a time step (s), a position (m), a velocity (m/s), an
/// acceleration (m/s²) or an angle (rad). An estimator rejects a larger one with `kNotFinite`, as
/// it does NaN, so that nothing computed from it overflows, in `float` either.
inline constexpr double kLargestInput = 1e9;

/// True when |x| <= `kLargestInput`; false for NaN.
template <class Scalar>
MaskOf<Scalar> in_range(const Scalar& x) noexcept {
  using std::abs;
  return abs(x) <= Scalar(RealOf<Scalar>(kLargestInput));
}

/// The same of every element of a vector.
template <class Scalar, int N>
MaskOf<Scalar> in_range(const Vec<Scalar, N>& x) noexcept {
  MaskOf<Scalar> all_in_range = in_range(x[0]);
  for (int k = 1; k < N; ++k) all_in_range = all_in_range && in_range(x[k]);
  return all_in_range;
}

/// `kOk` for a time step from 0 to `kLargestInput` seconds.
template <class Scalar>
StatusOf<Scalar> check_time_step(Scalar dt_s) noexcept {
  return first_failure(ok_or(in_range(dt_s), Status::kNotFinite),
                       ok_or(!(dt_s < Scalar(0)), Status::kNegativeTimeStep));
}

/// Result of one measurement update; converts to true when it succeeded.
template <int M, class Scalar = double>
struct [[nodiscard]] Step {
  StatusOf<Scalar> status = Status::kNotStarted;
  Vec<Scalar, M> innovation = Vec<Scalar, M>::Zero();  ///< measured minus predicted, angles wrapped
  Mat<Scalar, M, M> innovation_covariance = Mat<Scalar, M, M>::Identity();
  Scalar nis = std::numeric_limits<RealOf<Scalar>>::quiet_NaN();  ///< normalised innovation
                                                                  ///< squared, chi-square, M dof
  Scalar log_likelihood = -std::numeric_limits<RealOf<Scalar>>::infinity();

  explicit operator bool() const noexcept requires(kLanesOf<Scalar> == 1) {
    return status == Status::kOk;
  }
};

/// A likelihood, peak exp(-nis / 2). The peak of an impossible hypothesis is 0.
template <class Scalar = double>
struct Likelihood {
  Scalar peak = Scalar(0);
  Scalar nis = std::numeric_limits<RealOf<Scalar>>::infinity();

  [[nodiscard]] Scalar value() const noexcept {
    using std::exp;
    return peak * exp(-nis / 2);
  }
};

/// A step whose likelihood N(v; 0, S) is still in two factors, so that a mixture needs only one
/// logarithm.
template <int M, class Scalar = double>
struct [[nodiscard]] Correction {
  StatusOf<Scalar> status = Status::kNotStarted;
  Vec<Scalar, M> innovation = Vec<Scalar, M>::Zero();
  Mat<Scalar, M, M> innovation_covariance = Mat<Scalar, M, M>::Identity();
  Scalar nis = std::numeric_limits<RealOf<Scalar>>::quiet_NaN();
  Scalar peak = Scalar(0);  ///< (2 pi)^(-M/2) / sqrt(det S)

  explicit operator bool() const noexcept requires(kLanesOf<Scalar> == 1) {
    return status == Status::kOk;
  }

  [[nodiscard]] Likelihood<Scalar> likelihood() const noexcept {
    const auto done = ok(status);
    return {select(done, peak, Scalar(0)), select(done, nis, Likelihood<Scalar>{}.nis)};
  }

  /// The same as a `Step` with the logarithm of the likelihood.
  [[nodiscard]] Step<M, Scalar> scored() const noexcept {
    using std::log;
    Step<M, Scalar> step{status, innovation, innovation_covariance, nis};
    step.log_likelihood = select(ok(status), log(peak) - nis / 2, step.log_likelihood);
    return step;
  }
};

/// A step that failed with this status.
template <int M, class Scalar>
Step<M, Scalar> failed_step(const StatusOf<Scalar>& status) noexcept {
  Step<M, Scalar> step;
  step.status = status;
  return step;
}

/// Replaces a step by a failed one in the given lanes.
template <int M, class Scalar>
Step<M, Scalar> failed_where(const MaskOf<Scalar>& lanes, const StatusOf<Scalar>& why,
                             const Step<M, Scalar>& step) noexcept {
  Step<M, Scalar> result = failed_step<M, Scalar>(select(lanes, why, step.status));
  const MaskOf<Scalar> kept = !lanes;
  assign_where(kept, result.innovation, step.innovation);
  assign_where(kept, result.innovation_covariance, step.innovation_covariance);
  result.nis = select(kept, step.nis, result.nis);
  result.log_likelihood = select(kept, step.log_likelihood, result.log_likelihood);
  return result;
}

}  // namespace wakeline
