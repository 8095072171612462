// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Detection of an object by a search unit that passes it. Sources: B. O. Koopman, Search and
// Screening, 1946 (lateral range, the inverse cube law); IAMSAR Manual, volume II (sweep width,
// coverage, probability of detection).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// Laws of the probability p(x) that an object is detected which a unit passes at the lateral range
/// x. The sweep width W is the integral of p over x from -infinity to infinity.
enum class DetectionLaw : unsigned char {
  kDefiniteRange,  ///< p = 1 up to W/2
  kInverseCube,    ///< p = 1 - exp(-W²/(4 pi x²))
  kExponential     ///< p = exp(-2 |x|/W)
};

/// Names of the laws.
constexpr std::array<Word<DetectionLaw>, 3> words_of(DetectionLaw) noexcept {
  return {{{"definite_range", DetectionLaw::kDefiniteRange},
           {"inverse_cube", DetectionLaw::kInverseCube},
           {"exponential", DetectionLaw::kExponential}}};
}

/// -log(1 - p(x)) at a lateral range, for a positive sweep width; it adds up over passes.
inline double pass_potential(DetectionLaw law, double lateral_range_m,
                             double sweep_width_m) noexcept {
  const double x = std::abs(lateral_range_m) / sweep_width_m;
  switch (law) {
    case DetectionLaw::kDefiniteRange:
      return x <= 0.5 ? std::numeric_limits<double>::infinity() : 0.0;
    case DetectionLaw::kInverseCube:
      return 1 / (4 * kPi<double> * x * x);
    case DetectionLaw::kExponential:
      return -std::log(-std::expm1(-2 * x));
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// p(x): the probability of detection on a whole straight pass.
inline double pass_probability(DetectionLaw law, double lateral_range_m,
                               double sweep_width_m) noexcept {
  return -std::expm1(-pass_potential(law, lateral_range_m, sweep_width_m));
}

/// The potential of a part of a pass, in which the object moves straight from one position to
/// another relative to the unit. With s along the motion and x across, the share of the whole pass
/// is
///     (s2/sqrt(s2² + x²) - s1/sqrt(s1² + x²)) / 2,
/// exact for the inverse cube law, whose rate of detection falls with the third power of the
/// distance, and used for the exponential law too. Within the definite range the object is
/// detected. Below 0.1 % of the sweep width x counts as that.
inline double leg_potential(DetectionLaw law, const Vec<double, 2>& from_m,
                            const Vec<double, 2>& to_m, double sweep_width_m) noexcept {
  const Vec<double, 2> motion = to_m - from_m;
  const double length = motion.norm();
  if (!(length > 0.0)) return 0.0;
  const double s1 = from_m.dot(motion) / length, s2 = to_m.dot(motion) / length;
  const double across = std::abs(from_m[0] * motion[1] - from_m[1] * motion[0]) / length;
  if (law == DetectionLaw::kDefiniteRange) {
    const double along = std::max({0.0, s1, -s2});  // of the nearest point from the foot
    return pass_potential(law, std::sqrt(across * across + along * along), sweep_width_m);
  }
  const double x = std::max(across, 1e-3 * sweep_width_m);
  const double share = (s2 / std::sqrt(s2 * s2 + x * x) - s1 / std::sqrt(s1 * s1 + x * x)) / 2;
  return share * pass_potential(law, x, sweep_width_m);
}

/// Probability of detection (POD) in an area that is swept by even parallel tracks with a coverage
/// C = sweep width / track spacing: min(1, C) for the definite range, erf(sqrt(pi) C / 2) for the
/// inverse cube law, the mean over the area for the exponential law.
inline double parallel_track_pod(DetectionLaw law, double coverage) noexcept {
  if (!(coverage > 0.0)) return coverage == 0.0 ? 0.0 : coverage;
  switch (law) {
    case DetectionLaw::kDefiniteRange:
      return std::min(1.0, coverage);
    case DetectionLaw::kInverseCube:
      return std::erf(std::sqrt(kPi<double>) / 2 * coverage);
    case DetectionLaw::kExponential:
      break;
  }
  constexpr int points = 64;
  const int tracks = 1 + static_cast<int>(10 * std::min(coverage, 50.0));
  double missed = 0.0;
  for (int k = 0; k < points; ++k) {
    const double x = (k + 0.5) / (2 * points);  // from the nearest track, in spacings
    double potential = 0.0;
    for (int j = 0; j < tracks; ++j)
      potential += pass_potential(law, j + x, coverage) + pass_potential(law, j + 1 - x, coverage);
    missed += std::exp(-potential);
  }
  return 1 - missed / points;
}

/// POD of random search with a coverage C = effort by area: 1 - exp(-C), of any law.
inline double random_search_pod(double coverage) noexcept { return -std::expm1(-coverage); }

}  // namespace wakeline
