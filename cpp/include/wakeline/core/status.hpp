// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>

#include "wakeline/core/types.hpp"

namespace wakeline {

/// What became of one step. Anything but `kOk` means: nothing was changed.
enum class Status : std::uint8_t {
  kOk = 0,
  kMissed = 1,               ///< no measurement in this scan: predicted only
  kNotStarted = 2,           ///< the estimator has no belief yet
  kNotFinite = 3,            ///< an input or a result is infinite or not a number
  kNotPositiveDefinite = 4,  ///< a covariance is not positive definite
  kNegativeTimeStep = 5,     ///< time would run backwards
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
  }
  return "unknown";
}

/// What one measurement update has found; converts to true when it succeeded.
template <int M, class Scalar = double>
struct [[nodiscard]] Step {
  Status status = Status::kNotStarted;
  Vec<Scalar, M> innovation = Vec<Scalar, M>::Zero();  ///< measured minus predicted, angles wrapped
  Mat<Scalar, M, M> innovation_covariance = Mat<Scalar, M, M>::Identity();
  Scalar nis = std::numeric_limits<Scalar>::quiet_NaN();  ///< normalised innovation squared,
                                                          ///< chi-square with M dof
  Scalar log_likelihood = -std::numeric_limits<Scalar>::infinity();

  explicit operator bool() const noexcept { return status == Status::kOk; }
};

/// A step that could not be done, and why.
template <int M, class Scalar>
Step<M, Scalar> failed_step(Status status) noexcept {
  Step<M, Scalar> step;
  step.status = status;
  return step;
}

}  // namespace wakeline
