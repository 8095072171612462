// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>

#include "wakeline/batch/threads.hpp"
#include "wakeline/core/component.hpp"
#include "wakeline/core/state_belief.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/filter/concept.hpp"
#include "wakeline/gating/chi_square_gate.hpp"
#include "wakeline/gating/radius_gate.hpp"
#include "wakeline/measurement/concept.hpp"
#include "wakeline/measurement/own_ship.hpp"
#include "wakeline/simd/flatten.hpp"
#include "wakeline/simd/pack_math.hpp"

namespace wakeline {

/// R recordings of T scans with M numbers each, in the caller's memory, row-major.
struct RunInput {
  std::size_t runs = 0;
  std::size_t scans = 0;
  const double* z = nullptr;                  ///< (R, T, M); NaN for a missed scan
  const double* dt_s = nullptr;               ///< (T), before each scan
  const double* own_m = nullptr;              ///< (T, 2) north and east of own ship, or null
  const double* own_mps = nullptr;            ///< (T, 2) velocity of own ship, or null
  const double* acceleration_mps2 = nullptr;  ///< (T, 2) known acceleration, or null
  const double* covariance = nullptr;         ///< (R, T, M, M) of readings, or null
  const RadiusGate* gate = nullptr;  ///< of a `PositionSensor`, about its prediction; or null
  const ChiSquareGate* nis_gate = nullptr;  ///< of the innovation; or null
  /// Readings outside the gate in a row, after which it stays open until one is inside; 0: never.
  int reopen_after = 0;
};

/// Destination of the results of N states and K models, in the caller's memory.
struct RunOutput {
  std::size_t states = 0;
  std::size_t models = 0;              ///< 0 for a single filter
  double* mean = nullptr;              ///< (R, T, N)
  double* covariance = nullptr;        ///< (R, T, N, N)
  double* mode_probability = nullptr;  ///< (R, T, K)
  double* turn_rate_rad_s = nullptr;   ///< (R, T, K), null unless models have variable turn rates
  double* innovation = nullptr;        ///< (R, T, M)
  double* nis = nullptr;               ///< (R, T)
  double* log_likelihood = nullptr;    ///< (R, T)
  std::uint8_t* status = nullptr;      ///< (R, T)
};

/// True for an estimator with models of variable turn rates.
template <class Estimator>
inline constexpr bool kHasTurnRates = requires(const Estimator& estimator) {
  estimator.turn_rates_rad_s();
};

/// The sensor with own ship's position and velocity at a scan.
template <class Sensor>
Sensor seen_from(const Sensor& sensor, const RunInput& in, std::size_t scan) noexcept {
  Sensor moved = sensor;
  if (OwnShip* own = own_ship_of(moved)) {
    if (in.own_m != nullptr) {
      own->north_m = in.own_m[2 * scan];
      own->east_m = in.own_m[2 * scan + 1];
    }
    if (in.own_mps != nullptr) {
      own->vnorth_mps = in.own_mps[2 * scan];
      own->veast_mps = in.own_mps[2 * scan + 1];
    }
  }
  return moved;
}

/// Several runs in the lanes of a `Scalar`: run `first`, `first + 1`, ... With fewer runs than
/// lanes, the last run is repeated, and its results are written repeatedly.
template <class Scalar>
class RunLanes {
 public:
  static constexpr int kLanes = kLanesOf<Scalar>;

  RunLanes(const RunInput& in, std::size_t first) noexcept {
    for (int lane = 0; lane < kLanes; ++lane)
      row_[lane] = std::min(first + static_cast<std::size_t>(lane), in.runs - 1) * in.scans;
  }

  /// Address of the `size` numbers of a lane's run at a scan, among those of all runs and scans.
  template <class Number>
  [[nodiscard]] Number* place(Number* of, std::size_t size, int lane,
                              std::size_t scan) const noexcept {
    return of + (row_[lane] + scan) * size;
  }

  /// Number k of the `size` numbers of each run at a scan.
  [[nodiscard]] Scalar load(const double* from, std::size_t size, std::size_t scan,
                            std::size_t k) const noexcept {
    return lanes_of<Scalar>(
        [&](int lane) { return RealOf<Scalar>(place(from, size, lane, scan)[k]); });
  }

  void write(std::uint8_t* to, std::size_t scan, const StatusOf<Scalar>& status) const noexcept {
    for (int k = kLanes - 1; k >= 0; --k)
      *place(to, 1, k, scan) = static_cast<std::uint8_t>(lane(status, k));
  }

 private:
  std::size_t row_[kLanes];  ///< first scan of each lane's run, among all runs and scans
};

/// Destination of `size` numbers per scan of several runs side by side; may be null.
template <class Scalar>
class RunColumn {
 public:
  RunColumn(const RunLanes<Scalar>& lanes, double* to, std::size_t size) noexcept : size_(size) {
    for (int lane = 0; lane < kLanes; ++lane)
      first_[lane] = size > 0 ? lanes.place(to, size, lane, 0) : nullptr;
  }

  /// Prefetches the memory of a scan. Called for every scan, though many share a cache line, so
  /// that neither the line nor its page is evicted.
  [[gnu::always_inline]] void fetch(std::size_t scan) const noexcept {
    constexpr std::size_t kLine = 64 / sizeof(double);
    for (std::size_t k = 0; k < size_; k += kLine)
      for (int lane = 0; lane < kLanes; ++lane)
        __builtin_prefetch(first_[lane] + scan * size_ + k, 1);
  }

  void write(std::size_t scan, const Scalar& number) const noexcept { write(scan, &number, 1); }
  /// Column by column; for a covariance the same as row by row.
  template <class Matrix>
  void write(std::size_t scan, const Eigen::PlainObjectBase<Matrix>& numbers) const noexcept {
    write(scan, numbers.data(), static_cast<std::size_t>(numbers.size()));
  }

 private:
  static constexpr int kLanes = kLanesOf<Scalar>;

  [[gnu::always_inline]] void write(std::size_t scan, const Scalar* numbers,
                                    std::size_t count) const noexcept {
    assert(count == size_);
    const auto place = [&](int lane, std::size_t k) { return first_[lane] + scan * size_ + k; };
    std::size_t k = 0;
    if constexpr (kLanes > 1)
      for (; k + 2 <= count; k += 2)
        store_pairs(numbers[k], numbers[k + 1], [&](int lane) { return place(lane, k); });
    for (; k < count; ++k)
      for (int run = kLanes - 1; run >= 0; --run) *place(run, k) = double(lane(numbers[k], run));
  }

  double* first_[kLanes];  ///< address of the first scan of each lane's run
  std::size_t size_;
};

/// Estimated position, [north, east], of an estimator of fixed components or of one whose belief
/// has a `kinematics_of`.
template <class Estimator>
auto estimated_position(const Estimator& estimator) noexcept {
  const auto& belief = estimator.estimate();
  using Belief = std::decay_t<decltype(belief)>;
  if constexpr (
      !requires { Belief::kComponents; } && requires { Estimator::kComponents; })
    return marginal<kPosition, Estimator::kComponents>(belief).mean;
  else
    return position_of(belief).mean;
}

/// The gates of several runs side by side, each with its readings outside in a row.
template <class Scalar>
class RunGate {
 public:
  explicit RunGate(const RunInput& in) noexcept : in_(in) {}

  /// True where so many readings in a row were outside that the next one is used wherever it is.
  [[nodiscard]] MaskOf<Scalar> open() const noexcept {
    return outside_in_a_row_ >= Scalar(RealOf<Scalar>(in_.reopen_after)) && in_.reopen_after > 0;
  }

  /// True of a normalised innovation squared of `dof` numbers inside `nis_gate`; false for NaN.
  [[nodiscard]] MaskOf<Scalar> contains(const Scalar& nis, int dof) noexcept {
    if (dof != dof_) {
      dof_ = dof;
      threshold_ = in_.nis_gate->threshold(dof);
    }
    return nis <= Scalar(RealOf<Scalar>(threshold_));
  }

  void note(const MaskOf<Scalar>& read, const MaskOf<Scalar>& outside) noexcept {
    outside_in_a_row_ =
        select(read, select(outside, outside_in_a_row_ + Scalar(1), Scalar(0)), outside_in_a_row_);
  }

 private:
  const RunInput& in_;
  Scalar outside_in_a_row_ = Scalar(0);
  int dof_ = 0;
  double threshold_ = 0.0;
};

/// `to = from` of an estimator, not inlined: it is rare, and inlined it would keep a second
/// estimator in the registers of the loop.
template <class To, class From>
[[gnu::cold, gnu::noinline]] void assign_apart(To& to, const From& from) noexcept {
  to = from;
}

/// An observer of a run that does nothing.
struct Unwatched {
  template <class Estimator>
  void predicted(std::size_t, const Estimator&) const noexcept {}
  template <class Estimator>
  void updated(std::size_t, const Estimator&) const noexcept {}
};

/// A prediction under a known acceleration, not inlined: few recordings have one, and inlined it
/// would double the code of the loop.
template <class Estimator, class Scalar>
[[gnu::noinline]] WAKELINE_FLATTEN StatusOf<Scalar> predict_pushed(
    Estimator& estimator, Scalar dt_s, const double* push_mps2) noexcept {
  check_takes_acceleration<Estimator>();
  return estimator.predict(dt_s, Vec<Scalar, 2>(push_mps2[0], push_mps2[1]));
}

/// Runs the recordings `first`, `first + 1`, ... through a started estimator, one in each lane of
/// its scalar. A failed step is reported in its status: a rejected reading leaves the prediction, a
/// rejected time step leaves everything unchanged. Lanes are independent. `watch` is called after
/// each prediction and at the end of each scan.
template <class Estimator, class Sensor, class Watch = Unwatched>
void run_side_by_side(Estimator& estimator, const Sensor& sensor, const RunInput& in,
                      std::size_t first, const RunOutput& out, const Watch& watch = {}) noexcept {
  using Scalar = typename Estimator::Scalar;
  using Mask = MaskOf<Scalar>;
  constexpr int kM = Sensor::kMeasurements;
  const Scalar kNaN = std::numeric_limits<RealOf<Scalar>>::quiet_NaN();
  const RunLanes<Scalar> lanes(in, first);
  const RunColumn<Scalar> mean(lanes, out.mean, out.states),
      covariance(lanes, out.covariance, out.states * out.states),
      mode_probability(lanes, out.mode_probability, out.models),
      turn_rates(lanes, out.turn_rate_rad_s,
                 kHasTurnRates<Estimator> && out.turn_rate_rad_s != nullptr ? out.models : 0),
      innovation(lanes, out.innovation, kM), nis(lanes, out.nis, 1),
      log_likelihood(lanes, out.log_likelihood, 1);
  RunGate<Scalar> gate(in);
  std::optional<Estimator> before;  // the update, which a gate may undo
  for (std::size_t scan = 0; scan < in.scans; ++scan) {
    const Scalar dt_s = in.dt_s[scan];
    StatusOf<Scalar> status = in.acceleration_mps2 != nullptr
                                  ? predict_pushed(estimator, dt_s, in.acceleration_mps2 + 2 * scan)
                                  : estimator.predict(dt_s);
    watch.predicted(scan, estimator);

    Vec<Scalar, kM> z;
    Mask missed = true;
    for (int m = 0; m < kM; ++m) {
      z[m] = lanes.load(in.z, kM, scan, static_cast<std::size_t>(m));
      missed = missed && z[m] != z[m];
    }
    Sensor seen = seen_from(sensor, in, scan);
    if constexpr (requires { seen.set_covariance(in.covariance); })
      if (in.covariance != nullptr) {
        const auto numbers = static_cast<std::size_t>(seen.numbers());
        seen.set_covariance(lanes.place(in.covariance, numbers * numbers, 0, scan));
      }
    const Mask read = ok(status) && !missed;
    const Mask open = gate.open();
    Mask outside = false;
    if constexpr (PositionSensor<Sensor>)
      if (in.gate != nullptr)
        outside = read && !in.gate->template contains<Scalar>(estimated_position(estimator),
                                                              seen.position(z).mean);
    if (in.nis_gate != nullptr) assign_apart(before, estimator);
    Mask used = read && (open || !outside);
    Step<kM, Scalar> step = failed_step<kM, Scalar>(Status::kMissed);
    step.innovation.setConstant(kNaN);
    step.log_likelihood = kNaN;
    while (any(used)) {
      // A NaN reading changes nothing in its lane.
      for (int m = 0; m < kM; ++m) z[m] = select(used, z[m], kNaN);
      const auto taken = estimator.update(seen, z);
      const Mask done = ok(taken.status) && used;
      if (in.nis_gate != nullptr) {
        // Some estimators use only the position of a reading.
        int dof = int(taken.innovation.size());
        if constexpr (requires { seen.numbers_in(z); }) dof = seen.numbers_in(z);
        const Mask beyond = done && !gate.contains(taken.nis, dof);
        outside = outside || beyond;
        if (any(beyond && !open)) {
          assign_apart(estimator, *before);
          used = used && (open || !beyond);
          continue;
        }
      }
      for (int m = 0; m < taken.innovation.size(); ++m)
        step.innovation[m] = select(done, taken.innovation[m], kNaN);
      step.nis = select(done, taken.nis, kNaN);
      step.log_likelihood = select(done, taken.log_likelihood, kNaN);
      step.status = select(missed, step.status, taken.status);
      break;
    }
    step.status = select(outside && !open, StatusOf<Scalar>(Status::kGated), step.status);
    gate.note(read, outside);
    status = first_failure(status, step.status);
    watch.updated(scan, estimator);

    const auto belief = estimator.estimate();
    assert(static_cast<std::size_t>(belief.mean.size()) == out.states);
    mean.write(scan, belief.mean);
    covariance.write(scan, belief.covariance);
    if constexpr (requires { estimator.mode_probability(); })
      mode_probability.write(scan, estimator.mode_probability());
    if constexpr (kHasTurnRates<Estimator>) turn_rates.write(scan, estimator.turn_rates_rad_s());
    innovation.write(scan, step.innovation);
    nis.write(scan, step.nis);
    log_likelihood.write(scan, step.log_likelihood);
    for (const RunColumn<Scalar>* column :
         {&mean, &covariance, &mode_probability, &turn_rates, &innovation, &nis, &log_likelihood})
      column->fetch(scan + 2);
    lanes.write(out.status, scan, status);
  }
}

/// The same with every call inlined into one function, which is fastest for lanes.
template <class Estimator, class Sensor>
[[gnu::noinline]] WAKELINE_FLATTEN void run_lanes_side_by_side(Estimator& estimator,
                                                               const Sensor& sensor,
                                                               const RunInput& in,
                                                               std::size_t first,
                                                               const RunOutput& out) noexcept {
  run_side_by_side(estimator, sensor, in, first, out);
}

/// All runs: `begin(first)` returns an estimator started with the beliefs of the runs `first`,
/// `first + 1`, ..., as many as its scalar has lanes. Results do not depend on the number of
/// threads.
template <class Begin, class Sensor, class Pool = Threads>
void run_batch(const Begin& begin, const Sensor& sensor, const RunInput& in, const RunOutput& out,
               const Pool& pool = {}) {
  using Estimator = decltype(begin(std::size_t(0)));
  constexpr std::size_t kLanes = kLanesOf<typename Estimator::Scalar>;
  pool((in.runs + kLanes - 1) / kLanes, [&](std::size_t group) noexcept {
    Estimator estimator = begin(group * kLanes);
    if constexpr (kLanes > 1)
      run_lanes_side_by_side(estimator, sensor, in, group * kLanes, out);
    else
      run_side_by_side(estimator, sensor, in, group * kLanes, out);
  });
}

}  // namespace wakeline
